//! From a scene to a frame: tiles, threads, cancelling, progress, statistics.
//!
//! *What* to draw is a [`RenderSpec`], *how* to run a [`RunSpec`]. A [`Renderer`] is asked to `refine` for a while, and
//! shows its `frame` and `stats` at any time: command line, viewer, web page and Python use nothing else.
mod bands;
mod book;
mod by_paper;
mod by_proof;
mod coloring;
mod coverage;
mod crease;
mod crew;
mod develop;
mod frame;
mod given;
mod hits;
mod irradiance;
mod legend;
mod likely;
mod overlay;
mod passes;
mod pixel;
mod planes;
mod progress;
mod renderer;
mod shade;
mod spare;
mod spec;
mod state;
mod stats;
mod task;
mod visibility;
mod window;

pub use crew::Clock;
pub(crate) use crew::Crew;
pub use frame::{Frame, LightPlanes};
pub use given::{Given, GivenPixel, Question, Traced, TracedLight, TracedPixel};
pub use legend::Legend;
pub use overlay::Overlay;
pub use renderer::Renderer;
pub use spec::{Error, Method, RenderSpec, RunSpec};
pub use state::{StateError, fingerprint};
pub use stats::Stats;
