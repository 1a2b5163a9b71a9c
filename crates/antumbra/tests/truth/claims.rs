//! Every claim of every cell of the second-order method at a hit, on random rays judged by an independent sampler; and its
//! brackets against those of the first-order method.
use super::light::{root, sees, sees_finely};
use super::sampler::{Judge, Point, Seen, camera_ray};
use antumbra::eval::Workspace;
use antumbra::geom::strips::Curve;
use antumbra::geom::{Box3, Rect};
use antumbra::scene::{Object, Scene};
use antumbra::shadow::{Bracket, Claim, Known, Penumbra, Receiver, Says, Scratch, Tolerance, visible};
use antumbra::trace::{Cost, Sign, Surface};
use antumbra_interval::Interval;
use antumbra_interval::quadratic::Paraboloid;

/// A hit found by the sampler: where, on which surface, the sign of f before it.
struct Hit {
    point: Point,
    own: usize,
    before: f64,
}

impl Hit {
    fn receiver(&self) -> Receiver {
        Receiver {
            point: Box3(self.point.map(|x| Interval::new(x.hi - 1e-15, x.hi + 1e-15))),
            surface: self.own,
            side: if self.before > 0.0 { Sign::Positive } else { Sign::Negative },
        }
    }
}

fn judges(objects: &[Object]) -> Vec<Judge> {
    objects.iter().map(Judge::new).collect()
}

/// The first hit of a random camera ray.
fn hit(scene: &Scene, judges: &[Judge], random: &mut fastrand::Rng) -> Option<Hit> {
    let (eye, direction) = camera_ray(&scene.view.camera(1.0), [64, 64], 64.0 * random.f64(), 64.0 * random.f64());
    let mut best: Option<(f64, usize, [f64; 2])> = None;
    for (own, judge) in judges.iter().enumerate() {
        if let Seen::Blocked(section) = judge.follow(&eye, &direction, 0.0, 30.0, None)
            && best.is_none_or(|b| section[0] < b.0)
        {
            best = Some((section[0], own, section));
        }
    }
    let (_, own, [a, b]) = best?;
    let ends = [a - 1e-9, b + 1e-9];
    let [before, behind] = ends.map(|t| judges[own].sign(&eye, &direction, t));
    if before * behind >= 0.0 {
        return None;
    }
    let t = root(&judges[own], &eye, &direction, ends);
    Some(Hit { point: std::array::from_fn(|k| eye[k] + direction[k] * t), own, before })
}

fn ask(objects: &[Object], hit: &Hit, light: &Rect, tolerance: Tolerance) -> (Bracket, Vec<Claim>, Cost) {
    let surfaces: Vec<Surface<'_>> =
        objects.iter().map(|o| Surface { function: o.surface.as_ref(), clip: o.clip(), region: o.region() }).collect();
    let (mut scratch, mut work, mut cost) = (Scratch::default(), Workspace::default(), Cost::default());
    scratch.record_claims();
    let (receiver, pieces) = (hit.receiver(), Known::nothing(&surfaces));
    let bracket = visible(&surfaces, &receiver, light, &pieces, tolerance, &mut scratch, &mut work, &mut cost);
    (bracket, scratch.take_claims(), cost)
}

/// What a claim says about `(a, b)` of its part, if anything.
fn verdict(says: &Says, a: f64, b: f64) -> Option<bool> {
    let at = |p: &Paraboloid| p.c + a * (p.l[0] + p.q[0] * a + p.q[2] * b) + b * (p.l[1] + p.q[1] * b);
    // The values here are rounded.
    let slack = |p: &Paraboloid| 1e-14 * p.size();
    match says {
        Says::Lit => Some(true),
        Says::Dark => Some(false),
        Says::Curves(curves) => {
            let free = |c: &Curve| at(&c.lower) > c.error + slack(&c.lower);
            let hidden = |c: &Curve| c.hides && at(&c.upper) < -c.error - slack(&c.upper);
            if curves.iter().any(hidden) {
                Some(false)
            } else if curves.iter().all(free) {
                Some(true)
            } else {
                None
            }
        }
    }
}

/// What is to be checked.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Check {
    /// Whether the scene's floor is there.
    pub(crate) floor: bool,
    /// Factor on the edges of the light.
    pub(crate) scale: f64,
    /// Tolerance of the second-order method; planes get at least 1/255.
    pub(crate) width: f64,
    /// Penumbra hits wanted.
    pub(crate) hits: usize,
    /// Rays for each hit, at least: they are spread over its claims.
    pub(crate) rays: usize,
    /// Rays for each claim, at least.
    pub(crate) each: usize,
    /// Rectangles of the light for one hit: some scenes are not for the second-order method.
    pub(crate) rectangles: u32,
    pub(crate) seed: u64,
}

impl Default for Check {
    fn default() -> Self {
        Self { floor: false, scale: 1.0, width: 1.0 / 255.0, hits: 2, rays: 0, each: 12, rectangles: 300, seed: 17 }
    }
}

/// What was checked, and what was wrong.
#[derive(Debug, Default)]
pub(crate) struct Tally {
    pub(crate) hits: usize,
    /// Hits that see the light neither as a whole nor not at all.
    pub(crate) penumbrae: usize,
    pub(crate) claims: usize,
    /// Rays claimed lit, and dark, that the sampler could judge.
    pub(crate) lit: usize,
    pub(crate) dark: usize,
    /// Rays in the undecided band, and rays that the sampler could not judge.
    pub(crate) undecided: usize,
    pub(crate) unclear: usize,
    /// Rays on which the sampler contradicts a claim at first sight: it looks again with 64 times the samples.
    pub(crate) again: usize,
    /// Second-order brackets wider than the tolerance.
    pub(crate) open: usize,
    /// Of the first and of the second order.
    pub(crate) evaluations: [u64; 2],
    /// Claims that the sampler refutes, and disjoint brackets.
    pub(crate) wrong: Vec<String>,
}

impl Tally {
    pub(crate) fn add(&mut self, o: Self) {
        self.hits += o.hits;
        self.penumbrae += o.penumbrae;
        self.claims += o.claims;
        self.lit += o.lit;
        self.dark += o.dark;
        self.undecided += o.undecided;
        self.unclear += o.unclear;
        self.again += o.again;
        self.open += o.open;
        (0..2).for_each(|k| self.evaluations[k] += o.evaluations[k]);
        self.wrong.extend(o.wrong);
    }
}

/// Looks for penumbra hits and checks what is claimed at them.
pub(crate) fn check(name: &str, scene: &Scene, of: Check) -> Tally {
    let mut tally = Tally::default();
    let mut objects = scene.objects.clone();
    if of.floor {
        objects.push(scene.floor().expect("a scene with a floor"));
    }
    let (judges, light) = (judges(&objects), scene.lights[0].rect.scaled(of.scale));
    let mut random = fastrand::Rng::with_seed(of.seed);
    let tolerance = |width, penumbra| Tolerance { width, rectangles: of.rectangles, penumbra };
    let mut tried = 0;
    while tally.penumbrae < of.hits && tried < 400 * of.hits {
        tried += 1;
        let Some(hit) = hit(scene, &judges, &mut random) else { continue };
        tally.hits += 1;
        let (second, claims, cost) = ask(&objects, &hit, &light, tolerance(of.width, Penumbra::Second));
        // Most hits are lit or dark as a whole.
        if !claims.iter().any(|c| matches!(c.says, Says::Curves(_))) || second.lo == 1.0 || second.hi == 0.0 {
            continue;
        }
        let (first, _, first_cost) = ask(&objects, &hit, &light, tolerance(of.width.max(1.0 / 255.0), Penumbra::First));
        let what = || format!("{name} x{}, floor {}, at {:?}: {second:?}", of.scale, of.floor, hit.point.map(|x| x.hi));
        if !(first.lo <= second.hi && second.lo <= first.hi) {
            tally.wrong.push(format!("{}, but by planes {first:?}", what()));
        }
        tally.penumbrae += 1;
        tally.open += usize::from(second.hi - second.lo > of.width);
        tally.evaluations[0] += first_cost.evaluations;
        tally.evaluations[1] += cost.evaluations;
        for claim in &claims {
            tally.claims += 1;
            for _ in 0..of.each.max(of.rays.div_ceil(claims.len())) {
                let place: [f64; 2] = std::array::from_fn(|_| 2.0 * random.f64() - 1.0);
                let Some(says) = verdict(&claim.says, place[0], place[1]) else {
                    tally.undecided += 1;
                    continue;
                };
                let at = std::array::from_fn(|k| {
                    let (lo, hi) = (claim.part[k].lo(), claim.part[k].hi());
                    0.5 * (lo + hi) + 0.5 * (hi - lo) * place[k]
                });
                let Some(mut seen) = sees(&judges, hit.own, &hit.point, hit.before, &light, at) else {
                    tally.unclear += 1;
                    continue;
                };
                *if says { &mut tally.lit } else { &mut tally.dark } += 1;
                if seen != says {
                    tally.again += 1;
                    seen = sees_finely(&judges, hit.own, &hit.point, hit.before, &light, at).unwrap_or(seen);
                }
                if seen != says {
                    tally.wrong.push(format!("{}: {claim:?} at {place:?} = {at:?}", what()));
                }
            }
        }
    }
    tally
}
