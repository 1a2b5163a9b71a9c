//! Where the rays of a fan leave a clip region, to second order.
use super::{Clip, Fan, Sheet};
use antumbra_interval::Interval;
use antumbra_interval::affine::Affine;
use antumbra_interval::round::{div_down, sub_down};

/// Rays of a fan that begin inside a region leave it at a parameter that is nearly linear in the point of the light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Leaving {
    /// Up to this sheet every ray is inside; `None` if that is not proved.
    pub inner: Option<Sheet>,
    /// Beyond this sheet no ray is inside.
    pub outer: Sheet,
}

impl Clip {
    /// Where the fan's rays leave the region, if all of them are **known to be inside at `t = 0`**. `symbols`: the parameters u and
    /// v of the light as forms. `None` where no face is left by all rays.
    ///
    /// A box is left through a face `x_k = b` at `(b - P_k)/D_k`, a ball at the greater root of a quadratic: an affine form of the
    /// light's parameters for each face. Inside means not beyond any of them. For the sheet with the form's slopes the
    /// difference of both is enclosed: so any slopes would do.
    #[must_use]
    pub fn leaving(&self, fan: &Fan, symbols: &[Affine<3>; 2]) -> Option<Leaving> {
        let (mut forms, mut limit) = ([None; 3], f64::INFINITY);
        match self {
            Self::Everywhere => return None,
            Self::Box(b) => {
                for k in 0..3 {
                    let (p, d) = (fan.apex[k], fan.direction[k].range());
                    let face = if d.certainly_positive() {
                        b[k].hi()
                    } else if d.certainly_negative() {
                        b[k].lo()
                    } else {
                        // Along the faces: the nearest parameter at which one is left.
                        for (slope, room) in
                            [(d.hi(), sub_down(b[k].hi(), p.hi())), (-d.lo(), sub_down(p.lo(), b[k].lo()))]
                        {
                            if slope > 0.0 {
                                limit = limit.min(div_down(room, slope));
                            }
                        }
                        continue;
                    };
                    forms[k] = Some(Affine::constant(Interval::point(face) - p) / fan.direction[k]);
                }
            }
            Self::Ball { center, radius } => {
                let (mut a, mut b) = (Affine::ZERO, Affine::ZERO);
                let mut c = -Interval::point(*radius).sqr();
                for k in 0..3 {
                    let q = fan.apex[k] - Interval::point(center[k]);
                    a = a + fan.direction[k].sqr();
                    b = b + fan.direction[k].mul_interval(q);
                    c = c + q.sqr();
                }
                // c <= 0: the roots are real, the greater one at least 0.
                forms[0] = Some(((b.sqr() - a.mul_interval(c)).sqrt() - b) / a);
            }
        }
        let known = || forms.iter().flatten().filter(|form| form.is_known());
        let first = known().min_by(|x, y| x.centre().total_cmp(&y.centre()))?;
        let [_, a, b] = *first.coefficients();
        let slopes = [a / symbols[0].coefficients()[1], b / symbols[1].coefficients()[2]];
        if !slopes.iter().all(|s| s.is_finite()) {
            return None;
        }
        let above = |form: &Affine<3>, sheet: &Sheet| (*form - sheet.form(symbols)).range();
        let rest = above(first, &Sheet { k: 0.0, slopes });
        let (inner, outer) = (Sheet { k: rest.lo(), slopes }, Sheet { k: rest.hi(), slopes });
        if !inner.is_finite() || !outer.is_finite() {
            return None;
        }
        let part = [symbols[0].range(), symbols[1].range()];
        let all_known = forms.iter().flatten().all(Affine::is_known);
        let proved = all_known
            && known().all(|form| form == first || above(form, &inner).lo() >= 0.0)
            && inner.range(part).hi() <= limit;
        Some(Leaving { inner: proved.then_some(inner), outer })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::{Box3, Rect, Vec3};

    fn random(state: &mut u64) -> f64 {
        *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (*state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    #[test]
    fn rays_leave_between_the_sheets_and_these_are_close() {
        let mut s = 4;
        let (mut proved, mut asked) = (0, 0);
        for round in 0..3000 {
            let clip = if round % 2 == 0 {
                Clip::Box(Box3::cube(1.0))
            } else {
                Clip::Ball { center: Vec3::new(0.1, 0.0, -0.1), radius: 1.1 }
            };
            let apex = Vec3::new(0.5 * random(&mut s), 0.5 * random(&mut s), 0.5 * random(&mut s));
            let center = Vec3::new(2.0 * random(&mut s), 2.0 * random(&mut s), 3.0);
            let light = Rect { center, edge_u: Vec3::new(0.5, 0.1, 0.0), edge_v: Vec3::new(0.0, 0.3, 0.2) };
            let width = [1.0, 0.1, 0.01][round % 3];
            let part = [0, 1].map(|_| {
                let middle = (1.0 - width) * random(&mut s);
                Interval::new(middle - width, middle + width)
            });
            let symbols = [Affine::spanning(1, part[0]), Affine::spanning(2, part[1])];
            let Some(found) = clip.leaving(&Fan::towards(apex.to_box(), &light, part[0], part[1]), &symbols) else {
                continue;
            };
            asked += 1;
            proved += usize::from(found.inner.is_some());
            for _ in 0..20 {
                let [u, v] = part.map(|r| r.mid() + 0.5 * (r.hi() - r.lo()) * random(&mut s));
                let d = light.point(u, v) - apex;
                let inside = |t: f64| match clip {
                    Clip::Ball { center, radius } => (apex + d * t - center).length() <= radius,
                    _ => (apex + d * t).0.iter().all(|x| x.abs() <= 1.0),
                };
                let at = |sheet: &Sheet| sheet.k + sheet.slopes[0] * u + sheet.slopes[1] * v;
                assert!(!inside(at(&found.outer) + 1e-9), "{found:?} at {u} {v}");
                if let Some(inner) = &found.inner {
                    assert!(inside(at(inner) - 1e-9), "{found:?} at {u} {v}");
                    let gap = at(&found.outer) - at(inner);
                    assert!(gap <= 0.3 * width * width + 1e-9, "{gap} at width {width}: of second order");
                }
            }
        }
        assert!(asked > 2900 && proved > 2000, "{proved} of {asked}");
    }
}
