//! Why the GPU does not do it.
use crate::probe::Doubt;
use antumbra::eval::wgsl::Refusal;

/// Why the GPU does not do it.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Error {
    /// There is no GPU, or no driver for it.
    #[error("no adapter was found (a Vulkan, Metal or Direct3D 12 driver is needed)")]
    NoAdapter,
    /// Its arithmetic is not what proofs need.
    #[error("the adapter `{adapter}` failed the start-up probe: {doubt}")]
    Doubt {
        /// Its name.
        adapter: String,
        /// What is wrong.
        doubt: Doubt,
    },
    /// The formula stays on the CPU.
    #[error(transparent)]
    Refused(#[from] Refusal),
    /// The scene stays on the CPU.
    #[error("{0}")]
    Scene(&'static str),
    /// The driver gave up, ran out of memory, or was reset.
    #[error("the GPU failed: {0}")]
    Failed(String),
    /// Somebody asked to stop.
    #[error("stopped")]
    Stopped,
}
