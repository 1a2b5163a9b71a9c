//! Shorter tapes for parts of space.
//!
//! In most places most of a long formula plays no part: of the hundred `min` and `max` of a building nearly all are decided in
//! a small box. [`Valid`](valid::Valid) proves such decisions over a box and pairs the shorter tape with it; [`Regions`] keeps
//! a tree of boxes that overlap, and answers each question with the tape of the smallest box that holds all of the question.
//! The tree grows where questions are asked. One tree serves the tiles of the screen, their beams, the shafts and the shadow
//! beams of all hits.
mod policy;
mod tree;
mod valid;

pub use tree::{RegionCount, Regions};
