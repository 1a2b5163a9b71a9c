//! Which fraction of an area light reaches a point of a surface: certified brackets.
//!
//! A point q of the light is *visible* from the hit p iff the open segment p q leaves p to the viewer's side of the surface
//! and meets no surface inside its region. Three ingredients, no bias and no epsilon:
//!
//! * **Deflation.** Along the segment `p + t D` the function of the surface that was hit is `t g(t)`, since `f(p) = 0`;
//!   near p the sign of the slope g decides, without cancellation. At `t = 0` it is `grad f . D`: the horizon.
//! * **Half planes.** Over a rectangle of the light, f (or g) on a piece of the beam is `k + a u + b v +- e`. Where that is
//!   positive the piece is free, where it is negative the light is hidden: areas of clipped polygons bound the visible
//!   fraction to second order ([`crate::geom::halfplanes`]).
//! * **Subdivision.** The rectangle with the largest unknown area is divided into four; children inherit only the open
//!   pieces of their parent.
//!
//! Where the light is partly visible, the second-order method takes over from the half planes ([`Penumbra`]).
//!
//! [`look`] settles whole tiles of hits at once, [`visibles`] hit by hit, both in lockstep, so that evaluations come in batches.
#![deny(clippy::float_arithmetic)]
mod desk;
mod known;
mod ledger;
mod occluders;
mod policy;
mod rectangle;
mod second;
mod shaft;
mod shafts;
mod visible;

pub use known::{Known, Part};
pub use occluders::Receiver;
pub use second::{Claim, Says};
pub use shaft::{Placed, Shaft};
pub use shafts::{Tile, look};
pub use visible::{Asking, Bracket, Penumbra, Scratch, Tolerance, visible, visibles};
