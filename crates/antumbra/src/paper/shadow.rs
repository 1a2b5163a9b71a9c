//! Soft shadows by beams (paper, "Soft Shadow Beam Tracing").
use super::{Method, Settings, World};
use crate::eval::Workspace;
use crate::geom::{Beam, Box3, Rect, Vec3};
use crate::trace::Cost;
use antumbra_interval::Interval;

/// What the shadow beams of one point found.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Shadow {
    /// The paper's shadow index: the share of the light that may be blocked, from 0 (lit) to 1 (umbra).
    pub index: f64,
    /// Whether an initial beam was traced and may be blocked: the paper's case 2, "initial beams occluded".
    pub initial_occluded: bool,
    /// Initial beams traced.
    pub initial: Cost,
    /// Sub-beams (or rays) traced; the paper's "No. beams" counts these alone.
    pub sub: Cost,
}

/// One point and its light.
struct Query<'a> {
    world: &'a World<'a>,
    settings: &'a Settings,
    point: Vec3,
    light: &'a Rect,
    /// Parameters from the offset to the light.
    t: Interval,
}

/// The shadow index of `point` under `light`, by the given method. `salt` makes the random rays of different pixels
/// different; the answer depends on nothing else but the arguments.
#[must_use]
pub fn shadow(
    world: &World<'_>,
    settings: &Settings,
    method: Method,
    point: Vec3,
    light: &Rect,
    salt: u64,
    work: &mut Workspace,
) -> Shadow {
    // Beams reach the light at t = 1; the offset is a distance.
    let start = settings.offset / (light.center - point).length();
    let mut out = Shadow::default();
    let Some(t) = Interval::try_new(start.max(0.0), 1.0) else {
        // The light is nearer than the offset (or at the point itself): nothing lies between.
        return out;
    };
    let query = Query { world, settings, point, light, t };
    let n = settings.sub_beams;
    let tiles = (n * n) as f64;
    match method {
        Method::Fixed => out.index = query.sub_beams(work, &mut out.sub, |_, _| true) / tiles,
        Method::Initial => {
            out.initial_occluded = query.blocked(light.whole(), work, &mut out.initial);
            if out.initial_occluded {
                out.index = query.sub_beams(work, &mut out.sub, |_, _| true) / tiles;
            }
        }
        Method::Four => {
            let halves = [Interval::new(-1.0, 0.0), Interval::new(0.0, 1.0)];
            let mut quarters = [[false; 2]; 2];
            for (row, v) in halves.into_iter().enumerate() {
                for (column, u) in halves.into_iter().enumerate() {
                    quarters[row][column] = query.blocked(light.part(u, v), work, &mut out.initial);
                }
            }
            out.initial_occluded = quarters.concat().contains(&true);
            // Halves touched by tile k of n, in exact integers: [k/n, (k+1)/n] against 1/2.
            let touches = |k: usize, half: usize| if half == 0 { 2 * k < n } else { 2 * (k + 1) > n };
            let open = |column: usize, row: usize| {
                (0..2).any(|j| (0..2).any(|i| quarters[j][i] && touches(column, i) && touches(row, j)))
            };
            out.index = query.sub_beams(work, &mut out.sub, open) / tiles;
        }
        Method::Quadtree => {
            // Levels until there are at least n leaves along a side.
            let depth = usize::BITS - (n - 1).leading_zeros();
            let unit = Interval::new(-1.0, 1.0);
            out.index = query.quadtree(unit, unit, depth, work, &mut out);
        }
        Method::RegularRays | Method::RandomRays => {
            let mut blocked = 0.0;
            for k in 0..n * n {
                let (u, v) = match method {
                    Method::RegularRays => (centre(k % n, n), centre(k / n, n)),
                    _ => (random(settings.seed, salt, 2 * k as u64), random(settings.seed, salt, 2 * k as u64 + 1)),
                };
                blocked += f64::from(u8::from(query.blocked(light.point(u, v).to_box(), work, &mut out.sub)));
            }
            out.index = blocked / tiles;
        }
    }
    out
}

impl Query<'_> {
    /// Whether the beam towards this part of the light may be blocked.
    fn blocked(&self, part: Box3, work: &mut Workspace, cost: &mut Cost) -> bool {
        let beam = Beam::towards(self.point, part);
        self.world.possibly_blocked(&beam, self.t, self.settings.bisection.into(), work, cost)
    }

    /// How many of the n x n tiles may be blocked, tracing only those for which `wanted(column, row)`.
    fn sub_beams(&self, work: &mut Workspace, cost: &mut Cost, wanted: impl Fn(usize, usize) -> bool) -> f64 {
        let n = self.settings.sub_beams;
        let mut blocked = 0.0;
        for row in 0..n {
            for column in 0..n {
                if wanted(column, row) && self.blocked(self.light.tile(column, row, n), work, cost) {
                    blocked += 1.0;
                }
            }
        }
        blocked
    }

    /// Blocked share of the light's part `u x v`, divided at most `depth` times. The root counts as an initial beam.
    fn quadtree(&self, u: Interval, v: Interval, depth: u32, work: &mut Workspace, out: &mut Shadow) -> f64 {
        let root = u.width() >= 2.0;
        let cost = if root { &mut out.initial } else { &mut out.sub };
        let blocked = self.blocked(self.light.part(u, v), work, cost);
        if root {
            out.initial_occluded = blocked;
        }
        if !blocked {
            return 0.0;
        }
        if depth == 0 {
            return 1.0;
        }
        // Dyadic edges: exact.
        let halves = |r: Interval| {
            let mid = r.mid();
            [Interval::new(r.lo(), mid), Interval::new(mid, r.hi())]
        };
        let mut sum = 0.0;
        for v in halves(v) {
            for u in halves(u) {
                sum += 0.25 * self.quadtree(u, v, depth - 1, work, out);
            }
        }
        sum
    }
}

/// Parameter of the middle of tile `k` of `n`, in `[-1, 1]`.
fn centre(k: usize, n: usize) -> f64 {
    (2 * k + 1) as f64 / n as f64 - 1.0
}

/// A number in `[-1, 1)` that depends on nothing but the arguments: SplitMix64 (Steele, Lea, Flood 2014) as a hash, so
/// that the picture is the same for any order of the work.
fn random(seed: u64, salt: u64, index: u64) -> f64 {
    let mix = |mut z: u64| {
        z = z.wrapping_add(0x9e37_79b9_7f4a_7c15);
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    };
    let bits = mix(mix(mix(seed) ^ salt) ^ index) >> 11;
    // 53 bits, exact.
    bits as f64 * (1.0 / (1u64 << 52) as f64) - 1.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn random_points_fill_the_light_evenly() {
        let n = 20_000;
        let values: Vec<f64> = (0..n).map(|k| random(7, k / 100, k % 100)).collect();
        let mean = values.iter().sum::<f64>() / n as f64;
        let square = values.iter().map(|v| v * v).sum::<f64>() / n as f64;
        assert!(values.iter().all(|v| (-1.0..1.0).contains(v)));
        assert!(mean.abs() < 0.02 && (square - 1.0 / 3.0).abs() < 0.02, "{mean} {square}");
    }
}
