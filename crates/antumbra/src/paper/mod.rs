//! The method of "Reliable Soft Shadows over Implicit Surfaces" (Florez-Diaz and Sbert, WSCG 2010), as it is: one beam
//! per pixel, a shadow beam that covers the light, sub-beams where it may be blocked; beside it the variants that the
//! paper mentions and the rays it is compared with.
//!
//! What is proved here: that a pixel is empty, and that a point is fully lit *as seen from the start of its shadow
//! beam*. The rest is not: "may meet a surface" counts as "does", the start is moved off the surface by an offset,
//! and the visible fraction is a count of sub-beams. The certified method has none of these weaknesses.
mod method;
mod shadow;
mod world;

pub use method::{Method, Settings};
pub use shadow::{Shadow, shadow};
pub use world::{Find, World};
