//! The paper's acceleration structure: a regular grid of the cells that the surface may cross, and the walk of a beam
//! through it (paper, "Acceleration Structure" and "Beam Traversal").
mod build;
mod walk;

pub use build::Grid;
pub use walk::{Row, rows};
