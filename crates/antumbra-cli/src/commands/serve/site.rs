//! The files of a page, and what a request is answered.
//!
//! All files are read before the first request: a request names one of them or nothing. No path of a request ever reaches the file
//! system.

use std::{collections::BTreeMap, fs, path::Path};

use anyhow::{Result, anyhow, bail};
use http_body_util::Full;
use hyper::{
    HeaderMap, Method, Response, StatusCode,
    body::Bytes,
    header::{self, HeaderName, HeaderValue},
};

/// What a page may consist of, with its MIME type.
const TYPES: [(&str, &str); 9] = [
    ("html", "text/html; charset=utf-8"),
    ("css", "text/css; charset=utf-8"),
    ("js", "text/javascript; charset=utf-8"),
    ("json", "application/json"),
    ("wasm", "application/wasm"),
    ("svg", "image/svg+xml"),
    ("png", "image/png"),
    ("txt", "text/plain; charset=utf-8"),
    ("webmanifest", "application/manifest+json"),
];

/// Said with every answer. The first three isolate the page from those of others: browsers then give it precise clocks and threads that
/// share memory. The policy lets it load its own files and nothing else.
const HEADERS: [(HeaderName, &str); 7] = [
    (HeaderName::from_static("cross-origin-opener-policy"), "same-origin"),
    (HeaderName::from_static("cross-origin-embedder-policy"), "require-corp"),
    (HeaderName::from_static("cross-origin-resource-policy"), "same-origin"),
    (
        header::CONTENT_SECURITY_POLICY,
        "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; worker-src 'self'; style-src 'self'; \
         img-src 'self' blob: data:; connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
    ),
    (header::X_CONTENT_TYPE_OPTIONS, "nosniff"),
    (header::REFERRER_POLICY, "no-referrer"),
    // Asked again each time, so that a page that was built anew is seen.
    (header::CACHE_CONTROL, "no-cache"),
];

/// Most bytes of all files.
const MOST: u64 = 1 << 28;

/// The files of a folder by their names.
pub(super) struct Site(BTreeMap<String, (Bytes, &'static str)>);

impl Site {
    /// Reads a folder; folders in it and files of other kinds are left out.
    ///
    /// # Errors
    /// Where the page is not there, with the command that makes it.
    pub(super) fn read(folder: &Path) -> Result<Self> {
        let shown = folder.display();
        let advice = "make it with crates/antumbra-web/build, or name its folder";
        let entries = fs::read_dir(folder).map_err(|e| anyhow!("there is no page in `{shown}` ({e}); {advice}"))?;
        let (mut files, mut total) = (BTreeMap::new(), 0);
        for entry in entries {
            let path = entry.map_err(|e| anyhow!("cannot read `{shown}`: {e}"))?.path();
            let extension = path.extension().and_then(|e| e.to_str()).unwrap_or_default();
            let kind = TYPES.iter().find(|(known, _)| *known == extension).filter(|_| path.is_file());
            if let (Some((_, kind)), Some(name)) = (kind, path.file_name().and_then(|n| n.to_str())) {
                let bytes = fs::read(&path).map_err(|e| anyhow!("cannot read `{}`: {e}", path.display()))?;
                total += bytes.len() as u64;
                if total > MOST {
                    bail!("the files in `{shown}` have more than {MOST} bytes: that is no page of this program");
                }
                files.insert(name.to_owned(), (Bytes::from(bytes), *kind));
            }
        }
        for needed in ["index.html", "antumbra.wasm"] {
            if !files.contains_key(needed) {
                bail!("there is no page in `{shown}` (no {needed}); {advice}");
            }
        }
        Ok(Self(files))
    }

    /// The answer to a request for a path such as `/page.js?x`. What the request's body says does not matter.
    pub(super) fn answer(&self, method: &Method, path: &str) -> Response<Full<Bytes>> {
        let name = path.split('?').next().unwrap_or_default();
        let name = if name == "/" { "index.html" } else { name.strip_prefix('/').unwrap_or_default() };
        let text = "text/plain; charset=utf-8";
        let (status, (body, kind)) = if *method != Method::GET && *method != Method::HEAD {
            (StatusCode::METHOD_NOT_ALLOWED, (Bytes::from_static(b"only GET and HEAD\n"), text))
        } else if let Some(file) = self.0.get(name) {
            (StatusCode::OK, file.clone())
        } else {
            (StatusCode::NOT_FOUND, (Bytes::from_static(b"there is no such file\n"), text))
        };
        let mut headers: HeaderMap = HEADERS.into_iter().map(|(k, v)| (k, HeaderValue::from_static(v))).collect();
        headers.insert(header::CONTENT_TYPE, HeaderValue::from_static(kind));
        headers.insert(header::CONTENT_LENGTH, HeaderValue::from(body.len()));
        if status == StatusCode::METHOD_NOT_ALLOWED {
            headers.insert(header::ALLOW, HeaderValue::from_static("GET, HEAD"));
        }
        // To HEAD as well: hyper sends the headers of it only.
        let mut response = Response::new(Full::new(body));
        *response.status_mut() = status;
        *response.headers_mut() = headers;
        response
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn site() -> (tempfile::TempDir, Site) {
        let outer = tempfile::tempdir().unwrap();
        let page = outer.path().join("page");
        fs::create_dir_all(page.join("inner")).unwrap();
        fs::write(outer.path().join("secret.txt"), "secret").unwrap();
        let files = ["index.html", "antumbra.wasm", "page.js", "key.pem", "inner/deep.txt"];
        files.iter().for_each(|name| fs::write(page.join(name), *name).unwrap());
        let site = Site::read(&page).unwrap();
        (outer, site)
    }

    #[test]
    fn files_have_their_types_and_the_page_is_isolated() {
        let (_kept, site) = site();
        for (path, kind) in [
            ("/", "text/html; charset=utf-8"),
            ("/antumbra.wasm", "application/wasm"),
            ("/page.js?v=1", "text/javascript; charset=utf-8"),
        ] {
            let answer = site.answer(&Method::GET, path);
            let said = |name: &str| answer.headers()[name].to_str().unwrap().to_owned();
            assert_eq!((answer.status(), said("content-type")), (StatusCode::OK, kind.to_owned()), "{path}");
            assert_eq!(said("cross-origin-opener-policy"), "same-origin");
            assert_eq!(said("cross-origin-embedder-policy"), "require-corp");
            assert!(said("content-security-policy").starts_with("default-src 'none'"));
        }
    }

    #[test]
    fn nothing_else_is_reached() {
        let (outer, site) = site();
        let absolute = format!("/{}", outer.path().join("secret.txt").display());
        for path in [
            "/../secret.txt",
            "/%2e%2e/secret.txt",
            "/..%2fsecret.txt",
            "/..\\secret.txt",
            "/./index.html",
            "//index.html",
            "/inner/deep.txt",
            "/inner",
            "/key.pem",
            "/index.html/",
            "/index.html%00",
            "index.html",
            "",
            "*",
            &absolute,
        ] {
            assert_eq!(site.answer(&Method::GET, path).status(), StatusCode::NOT_FOUND, "{path}");
        }
        assert_eq!(site.answer(&Method::POST, "/").status(), StatusCode::METHOD_NOT_ALLOWED);
        assert_eq!(site.answer(&Method::HEAD, "/").status(), StatusCode::OK);
    }

    #[test]
    fn a_folder_without_a_page_is_refused_with_advice() {
        let empty = tempfile::tempdir().unwrap();
        let said = |folder: &Path| Site::read(folder).err().unwrap().to_string();
        assert!(said(empty.path()).contains("(no index.html); make it with crates/antumbra-web/build"));
        assert!(said(&empty.path().join("none")).contains("there is no page in"));
    }
}
