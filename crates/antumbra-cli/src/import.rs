//! Scenes from files of other programs.

use std::{fs, io::Read, path::Path, sync::Arc};

use antumbra::import::{self, Format};
use anyhow::{Result, anyhow};

use crate::{
    failure::Usage,
    options::{MAX_FORMULA, NamedScene, explain},
};

/// Whether the extension is that of a format that can be imported.
pub(crate) fn is_known(path: &Path) -> bool {
    Format::of_path(path).is_some()
}

/// The scene in a file, named as its file; the format by its extension, else by what it looks like.
///
/// # Errors
/// Where the file cannot be read; [`Usage`] with file, line, column and advice where its text is not understood.
pub(crate) fn from_file(path: &Path) -> Result<NamedScene> {
    let name = path.display();
    let mut bytes = Vec::new();
    let file = fs::File::open(path).map_err(|e| anyhow!("cannot read `{name}`: {e}"))?;
    file.take(MAX_FORMULA + 1).read_to_end(&mut bytes).map_err(|e| anyhow!("cannot read `{name}`: {e}"))?;
    let text = String::from_utf8(bytes).map_err(|e| Usage(format!("`{name}` is not text in UTF-8: {e}")))?;
    let format = Format::of_path(path).unwrap_or_else(|| Format::of_content(&text));
    let stem = path.file_stem().map_or_else(|| "antumbra".to_owned(), |s| s.to_string_lossy().into_owned());
    let scene = import::scene(&text, format, &stem).map_err(|e| {
        Usage(match &e {
            import::Error::Text(e) => {
                format!("`{name}`, line {}, column {}: {}", e.line(), e.column(), shown(e, &text))
            }
            import::Error::Scene(e) => format!("`{name}`: {}", explain(e, &text)),
        })
    })?;
    Ok(NamedScene { name: name.to_string(), stem, scene: Arc::new(scene), file: None })
}

/// The message with its excerpt, without the word that `main` writes.
fn shown(error: &antumbra::expr::Error, text: &str) -> String {
    let message = error.render(text);
    message.strip_prefix("error: ").unwrap_or(&message).to_owned()
}
