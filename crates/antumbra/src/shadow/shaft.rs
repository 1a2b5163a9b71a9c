//! Shafts: one test for all hits of a tile of the screen.
use super::known::Part;
use super::occluders::{Receiver, fronts, hides, no_zero};
use super::policy::{halves, long_in_shaft, shaft_slope_pays, size};
use crate::eval::Workspace;
use crate::geom::{Box3, Fan, Passage, Rect};
use crate::trace::{Cost, Piece, Sign, Surface};
use antumbra_interval::Interval;
use antumbra_interval::affine::{Affine, Slope};
use antumbra_interval::round::{add_down, add_up, mul_down, mul_up, sub_down, sub_up};

/// The hits of a tile as a linear function of their place in it.
#[derive(Clone, Debug)]
pub struct Shaft {
    /// Over (t, u, v, i, j): contains every hit of the tile at its (i, j).
    apex: [Affine<5>; 3],
    /// What all hits have in common.
    surface: usize,
    side: Sign,
    /// Extent of the hits.
    extent: f64,
    /// Largest error of the linear function.
    roughness: f64,
}

/// What a shaft test proved of all hits of its tile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ShaftVerdict<'a> {
    /// Every one sees all of the part of the light.
    Lit,
    /// None sees any of it.
    Dark,
    /// Neither: in these pieces of the beam something may be in the way.
    Open(&'a [Piece]),
}

impl Shaft {
    /// Fits a plane through hits `(i, j, receiver)`; `None` if they are on different surfaces or sides.
    ///
    /// The fit is a least-squares one, in plain arithmetic; the remainder is then enclosed: `e_k` bounds
    /// `|P_k - c_k - a_k i - b_k j|` over all hits and all points of their enclosures, so any fit is sound. (`i` is the offset
    /// `di` in pixels over half their extent, and `a_k` exactly that often the slope by pixels: `a_k i` is slope times `di`.)
    #[must_use]
    pub fn fit(hits: &[(u32, u32, &Receiver)]) -> Option<Self> {
        let (_, _, first) = hits.first()?;
        if hits.iter().any(|(_, _, r)| r.surface != first.surface || r.side != first.side) {
            return None;
        }
        let place = super::policy::Places::of(hits.iter().map(|(i, j, _)| (*i, *j)));
        let mut shaft =
            Self { apex: [Affine::ZERO; 3], surface: first.surface, side: first.side, extent: 0.0, roughness: 0.0 };
        for k in 0..3 {
            let [a, b] = place.slopes(hits.iter().map(|(i, j, r)| (*i, *j, r.point[k].mid())));
            let mut rest = Interval::EMPTY;
            for (i, j, receiver) in hits {
                let ([di, dj], point) = (place.offset(*i, *j), receiver.point[k]);
                let below = sub_down(point.lo(), add_up(mul_up(a, di), mul_up(b, dj)));
                let above = sub_up(point.hi(), add_down(mul_down(a, di), mul_down(b, dj)));
                rest = rest.hull(Interval::try_new(below, above)?);
            }
            let [a, b] = place.by_symbols([a, b]);
            let center = rest.mid();
            let error = rest.radius();
            shaft.apex[k] = Affine::linear(center, [0.0, 0.0, 0.0, a, b], error);
            let extent = shaft.apex[k].range().width();
            shaft.extent = shaft.extent.max(extent);
            shaft.roughness = shaft.roughness.max(error);
        }
        Some(shaft)
    }

    /// Whether to divide the light for all hits of the tile: it is much wider than the tile, and seen under a wide angle.
    #[must_use]
    pub fn narrow_against(&self, light: &Rect) -> bool {
        let unit = Interval::new(-1.0, 1.0);
        let middle = Box3(self.apex.map(|x| x.range())).mid();
        super::policy::divide_light(self.extent, size(light, unit, unit), (light.center - middle).length())
    }

    /// Whether a plane fits so badly that dividing the tile is the better idea.
    #[must_use]
    pub fn rough(&self) -> bool {
        super::policy::rough(self.roughness, self.extent)
    }
}

/// Scratch memory.
#[derive(Debug, Default)]
pub(super) struct Scratch {
    open: Vec<Piece>,
    stack: Vec<Piece>,
}

/// Tests the beams from all hits of a shaft to a part of a light, in its open pieces.
pub fn shaft<'a>(
    surfaces: &[Surface<'_>],
    shaft: &Shaft,
    light: &Rect,
    part: &Part,
    s: &'a mut super::Scratch,
    work: &mut Workspace,
    cost: &mut Cost,
) -> ShaftVerdict<'a> {
    cost.beams += 1;
    let Scratch { open, stack } = &mut s.shaft;
    let [u, v] = part.part;
    let apex = Box3(shaft.apex.map(|x| x.range()));
    let fan = Fan::towards(apex, light, u, v);
    let receiver = Receiver { point: apex, surface: shaft.surface, side: shaft.side };
    let fronts = fronts(surfaces, &receiver, &fan, work, cost);
    let width = size(light, u, v);
    let (u, v) = (Affine::<5>::spanning(1, u), Affine::<5>::spanning(2, v));
    let direction: [Affine<5>; 3] = std::array::from_fn(|k| {
        (u.mul_f64(light.edge_u[k]) + v.mul_f64(light.edge_v[k])).add_f64(light.center[k]) - shaft.apex[k]
    });
    let directions = Box3(direction.map(|d| d.range()));
    let distance = (0..3).map(|k| directions[k].magnitude()).fold(0.0, f64::max);
    let passages: Vec<Passage> = surfaces.iter().map(|at| at.passage(&apex, &directions)).collect();
    open.clear();
    stack.clear();
    stack.extend(part.pieces.iter().rev());
    while let Some(Piece { surface, t }) = stack.pop() {
        let at = &surfaces[surface];
        let passage = passages[surface];
        let t = t.intersection(passage.outer);
        if t.is_empty() {
            continue;
        }
        let front = fronts[surface];
        cost.evaluations += 1;
        let along = Affine::<5>::spanning(0, t);
        let own = surface == shaft.surface;
        // At t = 0 only the slope tells anything.
        let form = if own && (shaft_slope_pays(t) || t.lo() == 0.0) {
            let point = |k: usize| Slope::coordinate(shaft.apex[k], along, direction[k]);
            at.function.shaft_slope([point(0), point(1), point(2)], work)
        } else {
            let point = |k: usize| along * direction[k] + shaft.apex[k];
            at.function.shaft([point(0), point(1), point(2)], work)
        };
        if form.range() == Interval::ENTIRE {
            let region = Box3(std::array::from_fn(|k| apex[k] + t * directions[k]));
            if no_zero(at.function, &region, work, cost) {
                continue;
            }
        }
        let form = if front.is_some_and(|f| f.sign == Sign::Negative) { -form } else { form };
        let range = form.range();
        if range.certainly_positive() {
            continue;
        }
        let [along, rest @ ..] = *form.coefficients();
        let lowest_at = if along < 0.0 { t.hi() } else { t.lo() };
        let bottom = sub_up(form.centre(), along.abs());
        let top = rest.iter().fold(add_up(bottom, form.error()), |s, a| add_up(s, a.abs()));
        let region = |t| Box3(std::array::from_fn(|k| apex[k] + t * directions[k]));
        if top < 0.0 && hides(at, front, lowest_at, &passage, region, work) {
            return ShaftVerdict::Dark;
        }
        if range.certainly_negative() {
            if own && t.lo() == 0.0 {
                return ShaftVerdict::Dark;
            }
            continue;
        }
        if long_in_shaft(t, distance, width, shaft.extent) {
            let [near, far] = halves(t);
            let (first, second) = if along < 0.0 { (far, near) } else { (near, far) };
            stack.push(Piece { surface, t: second });
            stack.push(Piece { surface, t: first });
        } else {
            open.push(Piece { surface, t });
        }
    }
    if open.is_empty() { ShaftVerdict::Lit } else { ShaftVerdict::Open(open) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::Vec3;

    #[allow(clippy::float_arithmetic, reason = "points to test with")]
    /// Hits on a ball, each known up to `thickness`, at every place of an n x n tile.
    fn cap(n: u32, thickness: f64) -> Vec<(u32, u32, Receiver)> {
        let places = (0..n).flat_map(|j| (0..n).map(move |i| (i, j)));
        let receiver = |i: u32, j: u32| {
            let (x, y) = (0.3 + 0.02 * f64::from(i), -0.2 + 0.03 * f64::from(j));
            let z = (1.0 - x * x - y * y).sqrt();
            let point = Box3(Vec3::new(x, y, z).0.map(|c| Interval::new(c - thickness, c + thickness)));
            Receiver { point, surface: 0, side: Sign::Positive }
        };
        places.map(|(i, j)| (i, j, receiver(i, j))).collect()
    }

    #[test]
    #[allow(clippy::float_arithmetic, reason = "slack of a test")]
    fn a_fit_contains_every_hit_at_its_place_and_is_tight() {
        for thickness in [0.0, 1e-12, 1e-3] {
            let hits = cap(8, thickness);
            let placed: Vec<_> = hits.iter().map(|(i, j, r)| (*i, *j, r)).collect();
            let shaft = Shaft::fit(&placed).unwrap();
            let place = super::super::policy::Places::of(hits.iter().map(|(i, j, _)| (*i, *j)));
            let mut used = 0.0_f64;
            for (i, j, receiver) in &hits {
                let ([di, dj], [half_i, half_j]) = (place.offset(*i, *j), place.by_symbols([1.0; 2]));
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
        hits[3].2.side = Sign::Negative;
        let placed: Vec<_> = hits.iter().map(|(i, j, r)| (*i, *j, r)).collect();
        assert!(Shaft::fit(&placed).is_none() && Shaft::fit(&[]).is_none());
    }
}
