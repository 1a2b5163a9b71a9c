//! Who works, and by which clock: what a machine has and a picture does not depend on.
use super::{Error, RunSpec};
use std::sync::OnceLock;
use std::time::{Duration, Instant};

/// Bytes of stack of a thread: searches in lockstep have large states, and where nothing is optimised they are copied often.
const STACK: usize = 16 << 20;

/// Tells the time that has passed since some moment that stays the same; it never goes back.
pub type Clock = fn() -> Duration;

/// The clock of std. There is none on `wasm32-unknown-unknown`, where it panics: programs bring their own.
pub(super) fn std_clock() -> Duration {
    static START: OnceLock<Instant> = OnceLock::new();
    START.get_or_init(Instant::now).elapsed()
}

/// The threads that share the work of a picture.
pub(crate) enum Crew {
    /// Threads of its own.
    Own(rayon::ThreadPool),
    /// Those of rayon's global pool.
    Global,
}

impl RunSpec {
    /// The threads.
    ///
    /// # Errors
    /// [`Error::Threads`].
    pub(crate) fn crew(self) -> Result<Crew, Error> {
        if cfg!(target_family = "wasm") {
            return Ok(Crew::Global);
        }
        let builder = rayon::ThreadPoolBuilder::new().stack_size(STACK).num_threads(self.threads.unwrap_or(0));
        builder.build().map(Crew::Own).map_err(|e| Error::Threads(e.to_string()))
    }
}

impl Crew {
    /// How many they are.
    pub(crate) fn size(&self) -> usize {
        match self {
            Self::Own(pool) => pool.current_num_threads(),
            Self::Global => rayon::current_num_threads(),
        }
    }

    /// Does work whose parallel iterators these threads share.
    pub(crate) fn install<T: Send>(&self, work: impl FnOnce() -> T + Send) -> T {
        match self {
            Self::Own(pool) => pool.install(work),
            Self::Global => work(),
        }
    }
}
