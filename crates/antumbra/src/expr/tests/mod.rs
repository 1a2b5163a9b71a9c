//! Properties of random formulas, checked at points where as much as possible is exact.
mod point;
mod properties;
mod random;
