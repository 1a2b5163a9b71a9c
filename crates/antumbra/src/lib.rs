//! The heart of Antumbra: from a formula to a certified picture.
#![forbid(unsafe_code)]

pub mod audit;
pub mod eval;
pub mod expr;
pub mod geom;
pub mod grid;
pub mod image;
pub mod import;
pub mod paper;
pub mod render;
pub mod report;
pub mod scene;
pub mod shadow;
pub mod tape;
pub mod trace;
pub mod verdict;
