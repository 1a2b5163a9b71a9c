//! The web page as a browser would ask for it, over a real connection. The files are stand-ins: this test needs no WebAssembly.

use std::{
    fs,
    io::{BufRead, BufReader, Read, Write},
    net::TcpStream,
    process::{Child, Command, Stdio},
};

use crate::bench::Bench;

/// The program while it serves.
struct Server {
    child: Child,
    address: String,
}

impl Server {
    fn start(bench: &Bench) -> Self {
        fs::create_dir(bench.file("page")).unwrap();
        fs::write(bench.file("page/index.html"), "<!doctype html>").unwrap();
        fs::write(bench.file("page/antumbra.wasm"), b"\0asm").unwrap();
        fs::write(bench.file("secret.txt"), "secret").unwrap();
        let mut child = Command::new(assert_cmd::cargo::cargo_bin!("antumbra"))
            .args(["serve", "page", "--port", "0"])
            .current_dir(bench.file("."))
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let mut line = String::new();
        BufReader::new(child.stdout.take().unwrap()).read_line(&mut line).unwrap();
        let address = line.trim().strip_prefix("http://").unwrap().trim_end_matches('/').to_owned();
        Self { child, address }
    }

    /// Everything that comes back for these bytes.
    fn say(&self, bytes: &[u8]) -> String {
        let mut stream = TcpStream::connect(&self.address).unwrap();
        // The server may hang up before it has read all of them.
        let _ = stream.write_all(bytes);
        let mut answer = Vec::new();
        let _ = stream.read_to_end(&mut answer);
        String::from_utf8_lossy(&answer).into_owned()
    }

    fn get(&self, path: &str) -> String {
        self.say(format!("GET {path} HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n").as_bytes())
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

#[test]
fn the_page_is_served_and_nothing_else() {
    let bench = Bench::new();
    let server = Server::start(&bench);
    assert!(server.address.starts_with("127.0.0.1:"), "for this machine only: {}", server.address);
    let index = server.get("/");
    assert!(index.starts_with("HTTP/1.1 200 OK\r\n") && index.ends_with("\r\n\r\n<!doctype html>"), "{index}");
    let wasm = server.get("/antumbra.wasm");
    for header in [
        "content-type: application/wasm",
        "cross-origin-opener-policy: same-origin",
        "cross-origin-embedder-policy: require-corp",
    ] {
        assert!(wasm.contains(header), "{header} in {wasm}");
    }
    for path in ["/../secret.txt", "/%2e%2e/secret.txt", "/..%2Fsecret.txt", "//secret.txt"] {
        let answer = server.get(path);
        assert!(answer.starts_with("HTTP/1.1 404") && !answer.contains("secret"), "{path}: {answer}");
    }
    let posted = server.say(b"POST / HTTP/1.1\r\nHost: x\r\nContent-Length: 0\r\nConnection: close\r\n\r\n");
    assert!(posted.starts_with("HTTP/1.1 405"), "{posted}");
    let long = format!("GET /{} HTTP/1.1\r\nHost: x\r\n\r\n", "a".repeat(1 << 20));
    let refused = server.say(long.as_bytes());
    assert!(refused.is_empty() || refused.starts_with("HTTP/1.1 4"), "{refused}");
    assert!(server.say(b"nonsense\r\n\r\n").starts_with("HTTP/1.1 400"));
    assert!(server.get("/").starts_with("HTTP/1.1 200"), "it goes on");
}

#[test]
fn a_missing_page_says_how_it_is_made() {
    let bench = Bench::new();
    let refused = bench.antumbra(&["serve", "nowhere"]).assert().code(1);
    refused.stderr(predicates::str::contains("make it with crates/antumbra-web/build"));
}
