//! A window in which a surface is typed, turned around, and proved while one looks.
//!
//! | module | job |
//! |---|---|
//! | [`model`] | what is looked at, as plain data: scene file, edits, way back; no window, no thread |
//! | [`worker`] | a thread that draws the newest job: coarse at once, then finer, to the proof |
//! | [`thumbnails`], [`export`] | threads for small pictures and for large ones |
//! | [`ui`] | the window itself (egui) |
//!
//! All mathematics is the heart's: the window asks a [`Renderer`](antumbra::render::Renderer) to refine and shows its frames.

pub mod export;
pub mod host;
pub mod model;
mod priority;
pub mod thumbnails;
pub mod ui;
mod window;
pub mod worker;

pub use window::{Error, Options, Report, run};
