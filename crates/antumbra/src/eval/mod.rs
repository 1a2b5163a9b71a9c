//! Evaluators: siblings that run the same tape on different kinds of number. None imports another's answers.
//!
//! | module | a slot holds | answer |
//! |---|---|---|
//! | [`point`] | `f64` | the rounded value: for shading and sampling, never for proofs |
//! | `interval` | [`Interval`] | enclosure of f over a box |
//! | [`gradient`] | interval and three partial derivatives | enclosure of f and of its gradient over a box |
mod gradient;
mod inclusion;
mod interval;
mod machine;
mod point;

pub use gradient::Gradient;
pub use inclusion::{Inclusion, Workspace};
pub use machine::{Number, run};
pub use point::value_at;

#[allow(unused_imports, reason = "named by the table above")]
use antumbra_interval::Interval;
