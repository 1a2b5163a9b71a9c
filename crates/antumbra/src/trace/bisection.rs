//! The paper's stackless bisection (section 2, "Root Searching").
use super::Cost;
use crate::eval::{Inclusion, Workspace};
use crate::geom::{Beam, Fan, section};
use antumbra_interval::Interval;

/// How far the bisection goes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bisection {
    /// Sections narrower than this are not divided further (paper: 1e-5).
    pub width: f64,
}

/// A search and what it may use.
#[derive(Clone, Copy, Debug)]
pub struct Search<'a> {
    /// How far it goes.
    pub bisection: Bisection,
    /// The rays of the beam. Where the natural extension over a box admits a zero, the affine form over these rays is asked
    /// too: it is much nearer to the united extension that the paper speaks of. Pixel beams need it, or they report a rim
    /// of pixels around the surface (Chubs at 512 x 512: 11 % more hits than centre rays have, against 1.6 %).
    pub rays: Option<&'a Fan>,
}

impl From<Bisection> for Search<'_> {
    fn from(bisection: Bisection) -> Self {
        Self { bisection, rays: None }
    }
}

impl Default for Bisection {
    fn default() -> Self {
        Self { width: 1e-5 }
    }
}

/// Sections are counted in 64-bit integers; 2^-50 of any useful interval is below its floating-point spacing anyway.
const DEEPEST: u32 = 50;

/// The first section of `t`, narrower than the limit, in which the inclusion function admits a zero; `None` proves
/// that there is no zero in `t`. A `t` that is narrow enough at once is evaluated as it is.
///
/// The state is the paper's: `ns`, the level (2^ns sections), and `cs`, the current section, here counted from 0. On
/// "perhaps a zero" the section is bisected (`ns + 1`, its first half); on "no zero" the search goes to the next
/// section, and from the second of a pair up one level (`ns - 1`) to the section after the pair.
pub fn first_section(
    f: &dyn Inclusion,
    beam: &Beam,
    t: Interval,
    Search { bisection: Bisection { width }, rays }: Search<'_>,
    work: &mut Workspace,
    cost: &mut Cost,
) -> Option<Interval> {
    let mut admits_zero = |part: Interval| {
        cost.evaluations += 1;
        let region = beam.at(part);
        if !f.range(&region, work).possibly_zero() {
            return false;
        }
        let Some(rays) = rays else { return true };
        cost.evaluations += 1;
        f.beam(rays.at(part), work).range().possibly_zero()
    };
    if t.hi() == f64::INFINITY {
        // Unbounded: cannot be halved. Callers clip to a grid, so this is a beam that runs along its cell's plane.
        return admits_zero(t).then_some(t);
    }
    if t.width() < width {
        return admits_zero(t).then_some(t);
    }
    // Paper: the process starts with ns = 1 and cs = 1, that is, with the first half.
    let (mut ns, mut cs) = (1, 0);
    loop {
        let part = section(t, cs, ns);
        if admits_zero(part) {
            if part.width() < width || ns == DEEPEST {
                return Some(part);
            }
            ns += 1;
            cs *= 2;
            continue;
        }
        if cs % 2 == 0 {
            // First of its pair: on to the second.
            cs += 1;
        } else {
            // Both rejected: one level up, to the section that follows them. (Its own pair's parent may never have
            // been evaluated; so it is in the paper.)
            ns -= 1;
            cs = cs / 2 + 1;
            if cs >= 1 << ns {
                return None;
            }
        }
    }
}
