//! Where a surface exists: everywhere, in a box, or in a ball.
use super::{Box3, Vec3, vector::axes};
use antumbra_interval::Interval;
use antumbra_interval::round::{div_down, div_up, sub_down};

/// A closed convex region; the surface ends at its border, without caps. The numbers are exact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Clip {
    /// All of space.
    Everywhere,
    /// An axis-aligned box.
    Box(Box3),
    /// A ball.
    Ball {
        /// Centre.
        center: Vec3,
        /// Radius, greater than 0.
        radius: f64,
    },
}

/// Parameters `t >= 0` at which a fan of rays is inside a region.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Passage {
    /// Outside of these no ray is inside; empty if none ever is.
    pub outer: Interval,
    /// At each of these every ray is inside; empty if that is proved of no parameter.
    pub inner: Interval,
}

impl Clip {
    /// The smallest box known to hold the region; unbounded for all of space.
    #[must_use]
    pub fn bounds(&self) -> Box3 {
        match *self {
            Self::Everywhere => Box3([Interval::ENTIRE; 3]),
            Self::Box(b) => b,
            Self::Ball { center, radius } => {
                Box3(center.0.map(|c| Interval::point(c) + Interval::new(-radius, radius)))
            }
        }
    }

    /// Where the rays `P + t D` are inside, for all `P` in `apex` and all `D` in `direction`, `t >= 0`.
    #[must_use]
    pub fn passage(&self, apex: &Box3, direction: &Box3) -> Passage {
        match self {
            Self::Everywhere => Passage { outer: Interval::NON_NEGATIVE, inner: Interval::NON_NEGATIVE },
            Self::Box(b) => box_passage(b, apex, direction),
            Self::Ball { center, radius } => ball_passage(*center, *radius, apex, direction),
        }
    }
}

fn box_passage(b: &Box3, apex: &Box3, direction: &Box3) -> Passage {
    let mut outer = Interval::NON_NEGATIVE;
    let (mut enter, mut leave) = (0.0_f64, f64::INFINITY);
    for k in 0..3 {
        let (p, d) = (apex[k], direction[k]);
        // t d = n with n in b - p: as for beams, only directions of the sign of n matter.
        let n = b[k] - p;
        let d_of_n = if n.certainly_positive() {
            d.intersection(Interval::NON_NEGATIVE)
        } else if n.certainly_negative() {
            d.intersection(-Interval::NON_NEGATIVE)
        } else {
            d
        };
        // With 0 in n, a ray that runs along the faces (d = 0) is inside at every t, though no quotient says so.
        let always = n.possibly_zero() && d.possibly_zero();
        outer = if always { outer } else { outer.intersection(n / d_of_n) };
        // Every ray is on the inner side of the upper face iff t d.hi <= b.hi - p.hi, of the lower iff
        // t (-d.lo) <= p.lo - b.lo.
        for (slope, room) in [(d.hi(), sub_down(b[k].hi(), p.hi())), (-d.lo(), sub_down(p.lo(), b[k].lo()))] {
            if slope > 0.0 {
                // room < 0: never.
                leave = leave.min(if room >= 0.0 { div_down(room, slope) } else { -1.0 });
            } else if room < 0.0 {
                enter = if slope < 0.0 { enter.max(div_up(room, slope)) } else { f64::INFINITY };
            }
        }
    }
    Passage { outer, inner: Interval::try_new(enter, leave).unwrap_or(Interval::EMPTY) }
}

/// `|P + t D - C|^2 <= r^2` is `a t^2 + 2 b t + c <= 0`: between the roots `(-b -+ sqrt(b^2 - a c)) / a`.
///
/// With `q = P - C`, Lagrange's identity `(q.D)^2 = |q|^2 |D|^2 - |q x D|^2` makes `b^2 - a c = a r^2 - |q x D|^2`. Near the
/// ball's outline `|q x D|` is about `r`, so that its square is narrower than that of `b`, which is about `|q|`: by that
/// quotient, seen from afar. From inside the ball `b^2 - a c` may be the narrower one; the value is in both.
fn ball_passage(center: Vec3, radius: f64, apex: &Box3, direction: &Box3) -> Passage {
    let (mut a, mut b, mut moment) = (Interval::ZERO, Interval::ZERO, Interval::ZERO);
    let square = Interval::point(radius).sqr();
    let mut c = -square;
    let q: [Interval; 3] = axes(|k| apex[k] - Interval::point(center[k]));
    for k in 0..3 {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        a = a + direction[k].sqr();
        b = b + q[k] * direction[k];
        c = c + q[k].sqr();
        moment = moment + (q[i] * direction[j] - q[j] * direction[i]).sqr();
    }
    let discriminant = (b.sqr() - a * c).intersection(a * square - moment);
    if discriminant.certainly_negative() {
        return Passage { outer: Interval::EMPTY, inner: Interval::EMPTY };
    }
    if !a.certainly_positive() {
        return Passage { outer: Interval::NON_NEGATIVE, inner: Interval::EMPTY };
    }
    let root = discriminant.sqrt();
    let (first, last) = ((-b - root) / a, (-b + root) / a);
    let outer = first.hull(last).intersection(Interval::NON_NEGATIVE);
    // Where the discriminant may be negative, some ray may miss the ball.
    let inner = if discriminant.lo() >= 0.0 {
        Interval::try_new(first.hi(), last.lo()).unwrap_or(Interval::EMPTY).intersection(Interval::NON_NEGATIVE)
    } else {
        Interval::EMPTY
    };
    Passage { outer, inner }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn random(state: &mut u64) -> f64 {
        *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (*state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    /// A ball seen from five radii, in directions a 2^-8 of its diameter apart: decided but for the pixels at its outline.
    #[test]
    fn the_outline_of_a_ball_is_a_pixel_wide() {
        let clip = Clip::Ball { center: Vec3::default(), radius: 1.0 };
        let apex = Vec3::new(5.0, 0.0, 0.0).to_box();
        let pixel = 2.0 / 5.0 / 256.0;
        // The tangent of the outline: sin = 1/5.
        let outline = 1.0 / 24.0_f64.sqrt();
        let passage = |middle: f64| {
            let side = |m: f64| Interval::new(m - 0.5 * pixel, m + 0.5 * pixel);
            clip.passage(&apex, &Box3([Interval::point(-1.0), side(middle), side(0.0)]))
        };
        assert!(passage(outline + 1.6 * pixel).outer.is_empty());
        assert!(!passage(outline - 1.6 * pixel).inner.is_empty());
        assert!(!passage(outline).outer.is_empty() && passage(outline).inner.is_empty());
    }

    #[test]
    fn passages_hold_for_sampled_rays_and_are_not_empty_by_laziness() {
        let mut s = 9;
        let mut useful = 0;
        for round in 0..4000 {
            let apex = Box3(std::array::from_fn(|_| {
                let c = 2.0 * random(&mut s);
                Interval::new(c, c + 1e-3 * random(&mut s).abs())
            }));
            let direction = Box3(std::array::from_fn(|k| {
                let c = random(&mut s);
                // Some rays run along faces.
                let (c, width) = if (round / 8) % 7 == k { (0.0, 0.0) } else { (c, 0.05 * random(&mut s).abs()) };
                Interval::new(c, c + width)
            }));
            let (center, radius) = (Vec3::new(0.1, -0.2, 0.3), 1.0);
            let clip = if round % 2 == 0 { Clip::Box(Box3::cube(1.0)) } else { Clip::Ball { center, radius } };
            let passage = clip.passage(&apex, &direction);
            useful += usize::from(!passage.inner.is_empty() && passage.inner.width() > 0.1);
            for _ in 0..20 {
                let t = 2.0 + 2.0 * random(&mut s);
                let inside = |k: f64| {
                    let x: [f64; 3] = std::array::from_fn(|i| {
                        let (p, d) = (apex[i], direction[i]);
                        p.lo() + k * (p.hi() - p.lo()) + t * (d.lo() + k * (d.hi() - d.lo()))
                    });
                    match clip {
                        Clip::Box(_) => x.iter().all(|v| v.abs() <= 1.0),
                        _ => (Vec3(x) - center).length() <= radius,
                    }
                };
                for k in [0.0, 0.5, 1.0] {
                    assert!(!inside(k) || passage.outer.contains(t), "a ray is inside at {t}, outside {passage:?}");
                    assert!(inside(k) || !passage.inner.contains(t), "a ray is outside at {t}, inside {passage:?}");
                }
            }
        }
        assert!(useful > 300, "{useful}");
    }
}
