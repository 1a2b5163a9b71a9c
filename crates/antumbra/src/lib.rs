//! The heart of Antumbra: from a formula to a certified picture.
#![forbid(unsafe_code)]

pub mod expr;
pub mod image;
pub mod tape;
