//! Which of the paper's methods, and its constants.
use crate::trace::Bisection;

/// How the shadow of a light is found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Method {
    /// One initial beam over the whole light; n x n sub-beams if it may be blocked (paper, section 3).
    Initial,
    /// Four initial beams over the quarters of the light, "in the case of a really big light" (paper, section 4);
    /// sub-beams inside a free quarter are not traced.
    Four,
    /// No initial beam: always n x n sub-beams, the paper's baseline ("using 49 beams").
    Fixed,
    /// The light as a quadtree down to at least n x n leaves (the paper's "up to 1.5 times slower" variant).
    Quadtree,
    /// Thin beams, that is rays, to the middles of n x n tiles: the classical method.
    RegularRays,
    /// n x n rays to random points of the light.
    RandomRays,
}

/// The paper's constants, all of them options.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Sub-beams along each side of the light (paper: 7, so 49).
    pub sub_beams: usize,
    /// Distance from the hit at which a shadow beam starts, in units of the scene, "to avoid self intersections".
    pub offset: f64,
    /// Where the bisection of T ends.
    pub bisection: Bisection,
    /// Seed of [`Method::RandomRays`].
    pub seed: u64,
}
