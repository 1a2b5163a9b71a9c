//! Ctrl-C in the middle of the work: a message, exit code 130, no file.
#![cfg(unix)]

use std::{
    io::Read,
    process::{Command, Stdio},
    thread,
    time::Duration,
};

use crate::bench::Bench;

#[test]
fn ctrl_c_leaves_nothing_behind() {
    let bench = Bench::new();
    let mut child = Command::new(assert_cmd::cargo::cargo_bin("antumbra"))
        .current_dir(bench.path())
        .args(["compare", "mcmullen", "--size", "4096", "--methods", "fixed49", "--threads", "1"])
        .args(["--json", "s.json"])
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    // Its hidden files show that it is listening for Ctrl-C and about to work (the JSON is the last one).
    let begun = |names: Vec<String>| names.iter().any(|n| n.starts_with(".s.json.") && n.ends_with(".part"));
    for _ in 0..3000 {
        if begun(bench.names()) {
            break;
        }
        thread::sleep(Duration::from_millis(10));
    }
    assert!(begun(bench.names()), "{:?}", bench.names());
    assert!(child.try_wait().expect("a child").is_none(), "finished too early to be interrupted");
    let kill = Command::new("sh").args(["-c", &format!("kill -INT {}", child.id())]).status().expect("a shell");
    assert!(kill.success());
    let status = child.wait().expect("a child");
    let mut message = String::new();
    child.stderr.take().expect("a pipe").read_to_string(&mut message).expect("text");
    assert_eq!(status.code(), Some(130), "{message}");
    assert!(message.contains("interrupted"), "{message}");
    assert_eq!(bench.names(), [""; 0]);
}
