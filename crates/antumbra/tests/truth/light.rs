//! A hit found again, and its light by sampling.
use super::double::Double;
use super::sampler::{Judge, Point, SAMPLES, Seen, Shares, camera_ray};
use antumbra::geom::Rect;
use antumbra::render::Frame;
use antumbra::scene::Scene;

/// A proved hit found again: the surface, the point, the sign of f before it. `None` if the sampler cannot find it, which
/// is a failure of the hit.
pub(crate) fn found(scene: &Scene, judges: &[Judge], frame: &Frame, index: usize) -> Option<(usize, Point, f64)> {
    let (column, row) = ((index % frame.width) as f64 + 0.5, (index / frame.width) as f64 + 0.5);
    let camera = scene.view.camera(frame.width as f64 / frame.height as f64);
    let (eye, direction) = camera_ray(&camera, [frame.width, frame.height], column, row);
    // The camera's rays and the constants are enclosed there and rounded here: some units in the last place.
    let wide = 1e-12 * frame.t_hi[index];
    let ends = [frame.t_lo[index] - wide, frame.t_hi[index] + wide];
    judges.iter().enumerate().find_map(|(own, judge)| {
        let [before, behind] = ends.map(|t| judge.sign(&eye, &direction, t));
        (before * behind < 0.0).then(|| {
            let t = root(judge, &eye, &direction, ends);
            (own, std::array::from_fn(|k| eye[k] + direction[k] * t), before)
        })
    })
}

/// The root on `p + t d` between two parameters at which f has opposite signs.
pub(crate) fn root(judge: &Judge, p: &Point, d: &Point, [lo, hi]: [f64; 2]) -> Double {
    let (mut lo, mut hi) = (Double::from(lo), Double::from(hi));
    let first = judge.exact(p, d, lo);
    for _ in 0..80 {
        let middle = (lo + hi) * 0.5.into();
        if judge.exact(p, d, middle) * first > 0.0 { lo = middle } else { hi = middle }
    }
    (lo + hi) * 0.5.into()
}

/// Whether the point `(u, v)` of a light is visible from a point on surface number `own`, whose side is `side`.
pub(crate) fn sees(judges: &[Judge], own: usize, p: &Point, side: f64, light: &Rect, at: [f64; 2]) -> Option<bool> {
    sees_in(SAMPLES, judges, own, p, side, light, at)
}

#[allow(dead_code, reason = "tests of whole brackets have a slack instead")]
/// The same again, where it matters: grazing rays that pass through a solid for less than a section look free at first.
pub(crate) fn sees_finely(
    judges: &[Judge],
    own: usize,
    p: &Point,
    side: f64,
    light: &Rect,
    at: [f64; 2],
) -> Option<bool> {
    sees_in(64 * SAMPLES, judges, own, p, side, light, at)
}

fn sees_in(
    samples: usize,
    judges: &[Judge],
    own: usize,
    p: &Point,
    side: f64,
    light: &Rect,
    [u, v]: [f64; 2],
) -> Option<bool> {
    let (u, v) = (Double::from(u), Double::from(v));
    let d: Point = std::array::from_fn(|k| {
        Double::from(light.center[k]) + u * light.edge_u[k].into() + v * light.edge_v[k].into() - p[k]
    });
    let mut known = true;
    for (index, judge) in judges.iter().enumerate() {
        match judge.follow_in(samples, p, &d, [0.0, 1.0], (index == own).then_some(side)) {
            Seen::Blocked(_) => return Some(false),
            Seen::Unclear => known = false,
            Seen::Clear => {}
        }
    }
    known.then_some(true)
}

/// The visible share of a light, by the corners of `n x n` cells.
pub(crate) fn visible(judges: &[Judge], own: usize, p: &Point, side: f64, light: &Rect, n: usize) -> Shares {
    let place = |k: usize| 2.0 * k as f64 / n as f64 - 1.0;
    Shares::of(n, |i, j| sees(judges, own, p, side, light, [place(i), place(j)]))
}
