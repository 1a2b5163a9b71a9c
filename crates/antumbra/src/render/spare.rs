//! Memory that threads use again: from tile to tile nothing is allocated but results. What is in it never matters.
use super::task::HitScratch;
use crate::eval::Workspace;
use crate::shadow;
use crate::trace::{self, Brackets, Frusta};
use std::sync::Mutex;

/// Scratch memory of one thread: keep it, it only grows.
#[derive(Debug, Default)]
pub(super) struct Scratch {
    pub(super) work: Workspace,
    pub(super) frusta: Frusta,
    pub(super) rays: trace::Scratch,
    pub(super) brackets: Brackets,
    pub(super) hits: HitScratch,
    pub(super) shadows: shadow::Scratch,
}

/// Scratch memory that no thread has at the moment.
#[derive(Debug, Default)]
pub(super) struct Spare(Mutex<Vec<Scratch>>);

impl Spare {
    /// Some memory, new if there is none.
    pub(super) fn take(&self) -> Scratch {
        self.0.lock().ok().and_then(|mut spare| spare.pop()).unwrap_or_default()
    }

    /// Memory for the next one.
    pub(super) fn give(&self, scratch: Scratch) {
        // Poisoned by a panic elsewhere: then it is dropped.
        if let Ok(mut spare) = self.0.lock() {
            spare.push(scratch);
        }
    }
}
