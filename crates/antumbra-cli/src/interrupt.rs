//! Ctrl-C: whoever can stop in good order is asked to; else, and the second time, remove what is unfinished, say so, exit
//! with 130.
//!
//! The handler runs on a thread of its own and then ends the process at once, whatever the renderer is doing. Whoever
//! makes an unfinished file, or turns unfinished files into finished ones, does it while holding [`unfinished`]; so an
//! interrupt comes either before or after it, and never leaves half of it.

use std::{
    fs,
    io::IsTerminal,
    path::PathBuf,
    process,
    sync::{
        Arc, Mutex, MutexGuard, PoisonError,
        atomic::{AtomicBool, Ordering},
    },
};

use anyhow::Context;

static UNFINISHED: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());
static ASKED: Mutex<Option<Arc<AtomicBool>>> = Mutex::new(None);

/// Until it is dropped, a first Ctrl-C only sets a flag.
pub(crate) struct Asking;

impl Asking {
    pub(crate) fn first(flag: Arc<AtomicBool>) -> Self {
        *ASKED.lock().unwrap_or_else(PoisonError::into_inner) = Some(flag);
        Self
    }
}

impl Drop for Asking {
    fn drop(&mut self) {
        *ASKED.lock().unwrap_or_else(PoisonError::into_inner) = None;
    }
}

/// Files and (empty) folders to remove on an interrupt, in the order in which they were made.
pub(crate) fn unfinished() -> MutexGuard<'static, Vec<PathBuf>> {
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Takes over SIGINT.
pub(crate) fn install() -> anyhow::Result<()> {
    ctrlc::set_handler(|| {
        // Clear the line of the progress bar.
        let clear = if std::io::stderr().is_terminal() { "\r\x1b[2K" } else { "" };
        if let Some(flag) = ASKED.lock().unwrap_or_else(PoisonError::into_inner).take() {
            flag.store(true, Ordering::Relaxed);
            let words = "stopping when the tiles under way are done; a second Ctrl-C stops at once, and loses them";
            return crate::output::remark(&format!("{clear}{words}"));
        }
        // Held until the process is gone: nothing can be finished any more.
        let paths = unfinished();
        for path in paths.iter().rev() {
            // A failure leaves a file with a name ending in `.part`; there is nobody left to tell.
            let _ = if path.is_dir() { fs::remove_dir(path) } else { fs::remove_file(path) };
        }
        crate::output::remark(&format!("{clear}interrupted: no unfinished file is left"));
        process::exit(130);
    })
    .context("cannot listen for Ctrl-C")
}
