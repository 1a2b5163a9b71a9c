//! Who goes first: the window before everything that is drawn for it.
use thread_priority::{ThreadPriority, ThreadPriorityValue, set_current_thread_priority};

/// Of 100; the usual is about 50. On Linux a niceness of 9.
const BEHIND: u8 = 25;

/// Lets the window's thread go before this one, and before those that this one starts from now on.
pub(crate) fn step_back() {
    if let Ok(value) = ThreadPriorityValue::try_from(BEHIND) {
        // Where the system refuses, everything is as it was.
        let _ = set_current_thread_priority(ThreadPriority::Crossplatform(value));
    }
}
