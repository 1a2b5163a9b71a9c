//! Shafts: all hits of a tile of the screen as one linear function.
use super::occluders::Receiver;
use super::policy::{Places, divide_light, rough, size};
use crate::geom::{Box3, Rect, axes, remainder};
use crate::trace::Sign;
use antumbra_interval::Interval;
use antumbra_interval::affine::Affine;

/// A hit at its place on the screen.
#[derive(Clone, Copy, Debug)]
pub struct Placed {
    /// Column and row of the pixel.
    pub place: [u32; 2],
    /// The hit.
    pub receiver: Receiver,
    /// About where it is.
    mid: [f64; 3],
    /// Lower bounds of its coordinates, and of these with their signs turned.
    ends: [f64; 6],
}

impl Placed {
    /// The hit of a pixel, at a column and a row.
    #[must_use]
    pub fn new(place: [u32; 2], receiver: Receiver) -> Self {
        let [x, y, z] = receiver.point.0;
        Self { place, mid: receiver.point.mid().0, ends: [x, y, z, -x, -y, -z].map(Interval::lo), receiver }
    }
}

/// The hits of a tile as a linear function of their place in it.
#[derive(Clone, Debug)]
pub struct Shaft {
    /// Over (t, u, v, i, j): contains every hit of the tile at its (i, j).
    pub(super) apex: [Affine<5>; 3],
    /// Contains every hit.
    pub(super) region: Box3,
    /// What all hits have in common.
    pub(super) surface: usize,
    pub(super) side: Sign,
    /// Extent of the hits.
    pub(super) extent: f64,
    /// Largest error of the linear function.
    roughness: f64,
}

impl Shaft {
    /// Fits a plane through hits; `None` if there are none, or they are on different surfaces or sides.
    ///
    /// The fit is a least-squares one, in plain arithmetic; the remainder is then enclosed: `e_k` bounds
    /// `|P_k - c_k - a_k i - b_k j|` over all hits and all points of their enclosures, so any fit is sound. (`i` is the offset
    /// `di` in pixels over half their extent, and `a_k` exactly that often the slope by pixels: `a_k i` is slope times `di`.)
    #[must_use]
    pub fn fit<'a>(hits: impl Iterator<Item = &'a Placed> + Clone) -> Option<Self> {
        let first = hits.clone().next()?.receiver;
        if hits.clone().any(|hit| hit.receiver.surface != first.surface || hit.receiver.side != first.side) {
            return None;
        }
        let place = Places::of(hits.clone().map(|hit| hit.place));
        let slopes = place.slopes(hits.clone().map(|hit| (hit.place, hit.mid)));
        // The products of slopes and offsets are exact ([`Places::by_symbols`]).
        let rest = remainder(slopes, place.half(), hits.map(|hit| (place.offset(hit.place), hit.ends)))?;
        let (mut extent, mut roughness) = (0.0_f64, 0.0_f64);
        let apex = axes(|k| {
            let [a, b] = place.by_symbols(slopes[k]);
            Affine::<5>::linear(rest[k].mid(), [0.0, 0.0, 0.0, a, b], rest[k].radius())
        });
        let region = Box3(apex.map(|x| x.range()));
        for k in 0..3 {
            extent = extent.max(region[k].width());
            roughness = roughness.max(rest[k].radius());
        }
        Some(Self { apex, region, surface: first.surface, side: first.side, extent, roughness })
    }

    /// Whether to divide the light for all hits of the tile: it is much wider than the tile, and seen under a wide angle.
    #[must_use]
    pub fn narrow_against(&self, light: &Rect) -> bool {
        let unit = Interval::new(-1.0, 1.0);
        divide_light(self.extent, size(light, unit, unit), (light.center - self.region.mid()).length())
    }

    /// Whether a plane fits so badly that dividing the tile is the better idea.
    #[must_use]
    pub fn rough(&self) -> bool {
        rough(self.roughness, self.extent)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::Vec3;

    #[allow(clippy::float_arithmetic, reason = "points to test with")]
    /// Hits on a ball, each known up to `thickness`, at every place of an n x n tile.
    fn cap(n: u32, thickness: f64) -> Vec<Placed> {
        let places = (0..n).flat_map(|j| (0..n).map(move |i| (i, j)));
        let hit = |i: u32, j: u32| {
            let (x, y) = (0.3 + 0.02 * f64::from(i), -0.2 + 0.03 * f64::from(j));
            let z = (1.0 - x * x - y * y).sqrt();
            let point = Box3(Vec3::new(x, y, z).0.map(|c| Interval::new(c - thickness, c + thickness)));
            Placed::new([i, j], Receiver { point, surface: 0, side: Sign::Positive })
        };
        places.map(|(i, j)| hit(i, j)).collect()
    }

    #[test]
    #[allow(clippy::float_arithmetic, reason = "slack of a test")]
    fn a_fit_contains_every_hit_at_its_place_and_is_tight() {
        for thickness in [0.0, 1e-12, 1e-3] {
            let hits = cap(8, thickness);
            let shaft = Shaft::fit(hits.iter()).unwrap();
            let place = Places::of(hits.iter().map(|hit| hit.place));
            let mut used = 0.0_f64;
            for Placed { place: at @ [i, j], receiver, .. } in &hits {
                let ([di, dj], [half_i, half_j]) = (place.offset(*at), place.by_symbols([1.0; 2]));
                let [x, y] = [(di, half_i), (dj, half_j)].map(|(d, half)| Interval::point(d) / Interval::point(half));
                for k in 0..3 {
                    let [_, _, _, a, b] = *shaft.apex[k].coefficients();
                    let form =
                        Interval::point(shaft.apex[k].centre()) + Interval::point(a) * x + Interval::point(b) * y;
                    let rest = (receiver.point[k] - form).magnitude();
                    let error = shaft.apex[k].error();
                    assert!(
                        rest <= error.max(1e-18) * (1.0 + 1e-9) + 1e-15,
                        "hit ({i}, {j}) lies {rest} off, {error} allowed"
                    );
                    if k == 2 {
                        used = used.max(rest / error);
                    }
                }
            }
            assert!(used > 0.99, "the remainder {used} is not used up");
        }
    }

    #[test]
    fn hits_of_different_surfaces_or_sides_are_not_fitted() {
        let mut hits = cap(2, 0.0);
        hits[3].receiver.side = Sign::Negative;
        assert!(Shaft::fit(hits.iter()).is_none() && Shaft::fit([].iter()).is_none());
    }
}
