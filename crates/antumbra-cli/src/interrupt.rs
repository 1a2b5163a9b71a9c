//! Ctrl-C: remove what is unfinished, say so, exit with 130.
//!
//! The handler runs on a thread of its own and ends the process at once, whatever the renderer is doing. Whoever
//! makes an unfinished file, or turns unfinished files into finished ones, does it while holding [`unfinished`]; so an
//! interrupt comes either before or after it, and never leaves half of it.

use std::{
    fs,
    io::IsTerminal,
    path::PathBuf,
    process,
    sync::{Mutex, MutexGuard, PoisonError},
};

use anyhow::Context;

static UNFINISHED: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// Files and (empty) folders to remove on an interrupt, in the order in which they were made.
pub(crate) fn unfinished() -> MutexGuard<'static, Vec<PathBuf>> {
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Takes over SIGINT.
pub(crate) fn install() -> anyhow::Result<()> {
    ctrlc::set_handler(|| {
        // Held until the process is gone: nothing can be finished any more.
        let paths = unfinished();
        for path in paths.iter().rev() {
            // A failure leaves a file with a name ending in `.part`; there is nobody left to tell.
            let _ = if path.is_dir() { fs::remove_dir(path) } else { fs::remove_file(path) };
        }
        // Clear the line of the progress bar.
        let clear = if std::io::stderr().is_terminal() { "\r\x1b[2K" } else { "" };
        crate::output::remark(&format!("{clear}interrupted: no unfinished file is left"));
        process::exit(130);
    })
    .context("cannot listen for Ctrl-C")
}
