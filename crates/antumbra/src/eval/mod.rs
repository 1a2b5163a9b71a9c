//! Evaluators: one interpreter runs the same tape on different kinds of number, each the enclosure of something else.
//!
//! | kind of number | answer |
//! |---|---|
//! | `f64` ([`value_at`]) | the rounded value: for shading and sampling, never for proofs |
//! | [`Interval`](antumbra_interval::Interval) | enclosure of f over a box |
//! | [`Decorated`](antumbra_interval::Decorated) | the same, and whether f is defined and continuous there |
//! | [`Gradient`] | enclosures of f and of its three partial derivatives over a box |
//! | [`Affine`](antumbra_interval::affine::Affine) | f as a linear function of beam parameters, with an error |
//! | [`Slope`](antumbra_interval::affine::Slope) | f(P + t D) = f(P) + t g: g in affine form |
//! | [`Quadratic`](antumbra_interval::quadratic::Quadratic) | f as a quadratic function of beam parameters, with an error; slopes of it too |
//! | [`Jet`](antumbra_interval::affine::Jet) | f and its first two derivatives along a ray, in affine form; slopes of it too |
//! | [`PointJet`] | the same at a point, rounded: to choose search paths, never for proofs |
//! | [`Dual`](antumbra_interval::affine::Dual) | f and its derivative along a ray, in affine form |
mod batch;
mod enclosure;
mod forms;
mod gradient;
mod inclusion;
mod jet;
mod machine;
mod point;
mod regions;
mod sieve;
pub mod wgsl;

pub use antumbra_interval::PointJet;
pub use batch::{FanPiece, Occupancy, RayPiece, ShaftPiece};
pub use gradient::Gradient;
pub use inclusion::{
    BeamPoint, Inclusion, JetPoint, JetSlopePoint, QuadraticPoint, QuadraticSlopePoint, ShaftPoint, ShaftSlopePoint,
    Workspace, centred_range,
};
pub use machine::{Number, run};
pub use point::value_at;
pub use regions::{RegionCount, Regions};
pub use sieve::Sieve;
