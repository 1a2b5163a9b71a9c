//! Properties of random formulas, checked at points where as much as possible is exact.
pub(crate) mod point;
mod properties;
pub(crate) mod random;
