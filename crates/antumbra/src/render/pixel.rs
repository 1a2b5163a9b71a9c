//! What the passes of the renderer tell it about a pixel.
use crate::geom::Vec3;
use crate::shadow::Receiver;
use crate::trace::Cost;
use crate::verdict::Reason;
use antumbra_interval::Interval;
use serde::{Deserialize, Serialize};

/// A point of a surface that a pixel shows.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(super) struct Hit {
    /// Enclosure of its parameter.
    pub(super) t: Interval,
    /// About where it is.
    pub(super) point: Vec3,
    /// Unit normal, turned to the viewer.
    pub(super) normal: Vec3,
    /// Colour of the surface there, linear Rec. 709. Not certified.
    pub(super) color: [f64; 3],
    /// Index of the surface.
    pub(super) object: usize,
    /// Whether that is the floor.
    pub(super) floor: bool,
    /// The proved hit, where it is one.
    pub(super) receiver: Option<Receiver>,
}

/// What is known of a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Known {
    /// No ray of it meets a surface: proved.
    Empty,
    /// Its centre ray does: proved.
    Hit,
    /// Its centre ray does not, another one does: proved.
    Partly,
    /// Neither.
    Undecided(Reason),
}

/// One pixel after the search for surfaces.
#[derive(Clone, Debug)]
pub(super) struct Pixel {
    pub(super) index: usize,
    pub(super) known: Known,
    /// Bounds of the share of the pixel's rays that meet a surface.
    pub(super) coverage: [f64; 2],
    /// What it shows: where the centre ray hits, else where some other ray does.
    pub(super) hit: Option<Hit>,
    /// Where an edge runs through the pixel: what a grid of rays meets, for smooth edges.
    pub(super) edge: Option<Box<Edge>>,
    pub(super) cost: Cost,
}

/// What is seen of a pixel beside its centre.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Edge {
    /// What a grid of rays meets.
    pub(super) rays: Vec<Option<Hit>>,
    /// Another surface in front of what the centre ray meets, which is neither met by that ray nor excluded from the pixel.
    pub(super) thin: Option<Hit>,
}

/// What reaches one pixel of one light.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Light {
    pub(super) index: usize,
    /// Index of the light.
    pub(super) light: usize,
    /// Bounds of the visible fraction.
    pub(super) lo: f64,
    pub(super) hi: f64,
    /// Why the bounds are further apart than asked for.
    pub(super) reason: Option<Reason>,
    /// The first beam over the whole light was not found free.
    pub(super) first_occluded: bool,
    pub(super) initial: Cost,
    pub(super) sub: Cost,
}
