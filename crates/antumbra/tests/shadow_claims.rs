//! Every claim of every cell of the second-order method, on random rays judged by an independent sampler; and its
//! brackets against those of the first-order method.
//!
//! For longer: `ANTUMBRA_CLAIMS=500 cargo test --release --test shadow_claims every_claim -- --nocapture` takes so many penumbra hits per scene
//! and light, and 2000 rays for each hit, and prints what it checked.
#![allow(
    clippy::disallowed_methods,
    reason = "the checker is independent on purpose: it uses other functions than the library"
)]
#[path = "truth/double.rs"]
mod double;
#[path = "truth/light.rs"]
#[allow(dead_code, reason = "other tests use the rest")]
mod light;
#[path = "truth/sampler.rs"]
#[allow(dead_code, reason = "other tests use the rest")]
mod sampler;

use antumbra::eval::Workspace;
use antumbra::geom::strips::Curve;
use antumbra::geom::{Box3, Rect};
use antumbra::scene::{Object, Scene, named};
use antumbra::shadow::{Bracket, Claim, Penumbra, Receiver, Says, Scratch, Tolerance, visible, whole_beam};
use antumbra::trace::{Cost, Sign, Surface};
use antumbra_interval::Interval;
use antumbra_interval::quadratic::Paraboloid;
use light::{root, sees};
use sampler::{Judge, Point, Seen, camera_ray};

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

/// Rectangles for one hit: some of these scenes are not for the second-order method.
const RECTANGLES: u32 = 300;

fn ask(objects: &[Object], hit: &Hit, light: &Rect, width: f64, penumbra: Penumbra) -> (Bracket, Vec<Claim>, Cost) {
    let surfaces: Vec<Surface<'_>> =
        objects.iter().map(|o| Surface { function: o.surface.as_ref(), clip: o.clip(), region: o.region() }).collect();
    let (mut scratch, mut work, mut cost) = (Scratch::default(), Workspace::default(), Cost::default());
    scratch.record_claims();
    let tolerance = Tolerance { width, rectangles: RECTANGLES, penumbra };
    let (receiver, pieces) = (hit.receiver(), whole_beam(&surfaces));
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

#[derive(Debug, Default)]
struct Tally {
    hits: usize,
    penumbrae: usize,
    claims: usize,
    lit: usize,
    dark: usize,
    evaluations: [u64; 2],
}

impl Tally {
    fn add(&mut self, o: &Self) {
        self.hits += o.hits;
        self.penumbrae += o.penumbrae;
        self.claims += o.claims;
        self.lit += o.lit;
        self.dark += o.dark;
        (0..2).for_each(|k| self.evaluations[k] += o.evaluations[k]);
    }
}

/// Rays for each claim; more where `least` asks for so many of each hit.
const RAYS: usize = 12;

/// Penumbra hits of the long run.
fn long_run() -> Option<usize> {
    std::env::var("ANTUMBRA_CLAIMS").ok().map(|text| text.parse().expect("ANTUMBRA_CLAIMS is a number of hits"))
}

fn check(name: &str, scene: &Scene, floor: bool, scale: f64, width: f64, hits: usize, tally: &mut Tally) {
    let least = if long_run().is_some() { 2000 } else { 0 };
    let mut objects = scene.objects.clone();
    if floor {
        objects.push(scene.floor().unwrap());
    }
    let (judges, light) = (judges(&objects), scene.lights[0].rect.scaled(scale));
    let mut random = fastrand::Rng::with_seed(17);
    let (mut found, mut tried) = (0, 0);
    while found < hits && tried < 60 * hits {
        tried += 1;
        let Some(hit) = hit(scene, &judges, &mut random) else { continue };
        tally.hits += 1;
        let (second, claims, cost) = ask(&objects, &hit, &light, width, Penumbra::Second);
        // Most hits are lit or dark as a whole, by one claim.
        if !claims.iter().any(|c| matches!(c.says, Says::Curves(_))) {
            continue;
        }
        found += 1;
        let (first, _, first_cost) = ask(&objects, &hit, &light, width.max(1.0 / 255.0), Penumbra::First);
        let what = || format!("{name} x{scale}, floor {floor}, at {:?}: {second:?}", hit.point.map(|x| x.hi));
        assert!(first.lo <= second.hi && second.lo <= first.hi, "{}, but by planes {first:?}", what());
        tally.penumbrae += 1;
        tally.evaluations[0] += first_cost.evaluations;
        tally.evaluations[1] += cost.evaluations;
        for claim in &claims {
            tally.claims += 1;
            for _ in 0..RAYS.max(least / claims.len()) {
                let place: [f64; 2] = std::array::from_fn(|_| 2.0 * random.f64() - 1.0);
                let Some(says) = verdict(&claim.says, place[0], place[1]) else { continue };
                let at = std::array::from_fn(|k| {
                    let (lo, hi) = (claim.part[k].lo(), claim.part[k].hi());
                    0.5 * (lo + hi) + 0.5 * (hi - lo) * place[k]
                });
                let Some(seen) = sees(&judges, hit.own, &hit.point, hit.before, &light, at) else { continue };
                *if says { &mut tally.lit } else { &mut tally.dark } += 1;
                assert_eq!(seen, says, "{}: {claim:?} at {place:?} = {at:?}", what());
            }
        }
    }
}

#[test]
fn every_claim_holds_on_random_rays() {
    let mut tally = Tally::default();
    for name in ["orthocircle", "chubs", "kusner", "mcmullen"] {
        let scene = named(name).unwrap().unwrap();
        for (scale, width, hits) in [(1.0, 1.0 / 255.0, 5), (1.0, 1.0 / 4096.0, 2), (4.0, 1.0 / 255.0, 2)] {
            let mut of = Tally::default();
            check(name, &scene, false, scale, width, long_run().unwrap_or(hits), &mut of);
            println!("{name}, light x{scale}, 1/{:.0}: {of:?}", 1.0 / width);
            tally.add(&of);
        }
    }
    assert!(tally.penumbrae > 25 && tally.lit > 400 && tally.dark > 200, "{tally:?}");
    assert!(tally.evaluations[1] * 3 < tally.evaluations[0], "{tally:?}");
}

/// Several surfaces, tangents, functions that are no polynomials, kinks.
#[test]
fn claims_of_other_scenes_hold() {
    let mut tally = Tally::default();
    for (name, floor) in [("sphere", true), ("torus", true), ("gyroid", false), ("tangle", true), ("chubs", true)] {
        check(name, &named(name).unwrap().unwrap(), floor, 2.0, 1.0 / 255.0, 2, &mut tally);
    }
    for text in [
        "smooth_union(sphere(0.8), translate(box(0.5), 0.6, 0.2, 0.1), 0.2)",
        "max(x^2 + y^2 - 0.3, abs(z) - 0.7) = 0",
        "sin(5x) + sin(5y) + sin(5z) + 1 = 0",
        "exp(x y) - 1.2 + z^2 - cos(3y) / 4 = 0",
    ] {
        let scene = Scene::from_formula(text).unwrap();
        check(text, &scene, false, 2.0, 1.0 / 255.0, 2, &mut tally);
    }
    assert!(tally.penumbrae > 10 && tally.lit > 150 && tally.dark > 150, "{tally:?}");
}
