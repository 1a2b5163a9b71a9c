//! Where to cut beams: choices that cost or save time and never touch a proof. The only file of this room with float
//! arithmetic. The constants were measured on the paper's four scenes.
#![allow(clippy::float_arithmetic, reason = "choices of where to cut, never a proof")]
use crate::geom::Rect;
use antumbra_interval::Interval;

/// The slope form is used on pieces with `t_lo <= SLOPE * t_hi`: near the hit, where plain values cancel. Turned nearly
/// off, the Kusner-Schmitt surface costs six times as much.
const SLOPE: f64 = 0.9;
/// The same for shafts.
const SHAFT_SLOPE: f64 = 0.5;
/// A piece is halved while longer than this many widths of its rectangle; at the root of the light ...
const ROOT_ASPECT: f64 = 1.0;
/// ... and below it.
const ASPECT: f64 = 2.0;
/// ... and in shafts.
const SHAFT_ASPECT: f64 = 1.4;
/// Widths grow along the beam as t, but count at least as at this t.
const NEAR: f64 = 0.3;
/// Never halve below this length.
const SHORTEST: f64 = 1e-9;

/// Evaluations that one hit may take with so many rectangles: several times what the hardest hits of the gallery need. It ends what
/// nothing is known of, piece after piece.
pub(super) fn evaluations(rectangles: u32) -> u64 {
    65_536 + 64 * u64::from(rectangles)
}

pub(super) fn slope_pays(t: Interval) -> bool {
    t.lo() <= SLOPE * t.hi()
}

pub(super) fn shaft_slope_pays(t: Interval) -> bool {
    t.lo() <= SHAFT_SLOPE * t.hi()
}

/// Longest edge of the part of the light with half the parameter ranges `u`, `v`.
pub(super) fn size(light: &Rect, u: Interval, v: Interval) -> f64 {
    let edge = |e: crate::geom::Vec3, r: Interval| e.length() * (r.hi() - r.lo());
    edge(light.edge_u, u).max(edge(light.edge_v, v))
}

pub(super) fn long(t: Interval, distance: f64, size: f64, root: bool) -> bool {
    let aspect = if root { ROOT_ASPECT } else { ASPECT };
    let length = t.hi() - t.lo();
    length * distance > aspect * size * t.hi().max(NEAR) && length > SHORTEST
}

/// `tile` is the extent of the hits, `size` that of the light.
pub(super) fn long_in_shaft(t: Interval, distance: f64, size: f64, tile: f64) -> bool {
    let length = t.hi() - t.lo();
    let width = (tile * (1.0 - t.mid())).max(size * t.mid()).max(tile);
    length * distance > SHAFT_ASPECT * width && length > SHORTEST
}

/// A light is divided for all hits of a tile if it is wider than so many tiles, and than this part of its distance: under a small light
/// quadratic models settle most hits in one cell. Measured with lights four times as wide: 4 to 8 % fewer evaluations on three
/// of the four scenes, 6 % more on the fourth, and on all four evaluations of a cheaper kind. Twice divided costs more.
const TILES_IN_LIGHT: f64 = 4.0;
const WIDE: f64 = 0.1;

/// Whether a light of width `size`, at so great a distance, is to be divided for a tile.
pub(super) fn divide_light(tile: f64, size: f64, distance: f64) -> bool {
    size > TILES_IN_LIGHT * tile && size > WIDE * distance
}

/// The two halves of an interval.
pub(super) fn halves(t: Interval) -> [Interval; 2] {
    let mid = t.mid();
    [Interval::new(t.lo(), mid), Interval::new(mid, t.hi())]
}

/// The four quarters of a rectangle.
pub(super) fn quarters(u: Interval, v: Interval) -> [[Interval; 2]; 4] {
    let ([a, b], [c, d]) = (halves(u), halves(v));
    [[a, c], [b, c], [a, d], [b, d]]
}

/// Places of the hits of a tile, and the normal equations of a linear fit.
pub(super) struct Places {
    center: [f64; 2],
    half: [f64; 2],
    moments: [f64; 5],
    count: f64,
}

impl Places {
    pub(super) fn of(places: impl Iterator<Item = [u32; 2]> + Clone) -> Self {
        let (mut lo, mut hi) = ([u32::MAX; 2], [0; 2]);
        for place in places.clone() {
            for k in 0..2 {
                (lo[k], hi[k]) = (lo[k].min(place[k]), hi[k].max(place[k]));
            }
        }
        let (lo, hi) = (lo.map(f64::from), hi.map(f64::from));
        // Exact: sums of small integers, halved.
        let center = [0.5 * (lo[0] + hi[0]), 0.5 * (lo[1] + hi[1])];
        let half = [(0.5 * (hi[0] - lo[0])).max(0.5), (0.5 * (hi[1] - lo[1])).max(0.5)];
        let mut places_of = Self { center, half, moments: [0.0; 5], count: 0.0 };
        for place in places {
            let [x, y] = places_of.offset(place);
            for (m, v) in places_of.moments.iter_mut().zip([x, y, x * x, x * y, y * y]) {
                *m += v;
            }
            places_of.count += 1.0;
        }
        places_of
    }

    /// How far a place is from the middle, in pixels: exact, a multiple of 1/2.
    pub(super) fn offset(&self, [i, j]: [u32; 2]) -> [f64; 2] {
        [f64::from(i) - self.center[0], f64::from(j) - self.center[1]]
    }

    /// At least the magnitudes of all offsets.
    pub(super) fn half(&self) -> [f64; 2] {
        self.half
    }

    /// What slopes by pixels are by symbols that run over the places from -1 to 1. Exact: a slope has 24 bits, half a width at most
    /// 28; over wider places all slopes are 0.
    pub(super) fn by_symbols(&self, [a, b]: [f64; 2]) -> [f64; 2] {
        [a * self.half[0], b * self.half[1]]
    }

    /// Least-squares slopes of three numbers by pixels, of 24 bits each.
    pub(super) fn slopes(&self, hits: impl Iterator<Item = ([u32; 2], [f64; 3])> + Clone) -> [[f64; 2]; 3] {
        let n = self.count;
        let [sx, sy, sxx, sxy, syy] = self.moments;
        let mut sum = [0.0; 3];
        for (_, z) in hits.clone() {
            for k in 0..3 {
                sum[k] += z[k];
            }
        }
        let mean = sum.map(|sum| sum / n);
        let (mut zx, mut zy) = ([0.0; 3], [0.0; 3]);
        for (place, z) in hits {
            let [x, y] = self.offset(place);
            for k in 0..3 {
                zx[k] += (z[k] - mean[k]) * x;
                zy[k] += (z[k] - mean[k]) * y;
            }
        }
        let (xx, xy, yy) = (sxx - sx * sx / n + 1e-9, sxy - sx * sy / n, syy - sy * sy / n + 1e-9);
        let det = xx * yy - xy * xy;
        let exact = self.half.iter().all(|half| *half < f64::from(1 << 27));
        std::array::from_fn(|k| {
            let slopes = [yy * zx[k] - xy * zy[k], xx * zy[k] - xy * zx[k]].map(|above| (above / det) as f32);
            if exact && slopes.iter().all(|s| s.is_finite()) { slopes.map(f64::from) } else { [0.0; 2] }
        })
    }
}

/// A plane fits badly if its error is a quarter of the extent.
pub(super) fn rough(roughness: f64, extent: f64) -> bool {
    4.0 * roughness > extent
}
