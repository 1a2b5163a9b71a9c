//! Every claim of every cell of the second-order method, on random rays judged by an independent sampler; and its
//! brackets against those of the first-order method. As many as one likes: `examples/claims.rs`.
#![allow(
    clippy::disallowed_methods,
    reason = "the checker is independent on purpose: it uses other functions than the library"
)]
#[path = "truth/claims.rs"]
mod claims;
#[path = "truth/double.rs"]
mod double;
#[path = "truth/light.rs"]
#[allow(dead_code, reason = "other tests use the rest")]
mod light;
#[path = "truth/sampler.rs"]
#[allow(dead_code, reason = "other tests use the rest")]
mod sampler;

use antumbra::scene::{Scene, named};
use claims::{Check, Tally, check};

/// Adds the check of one scene, of which nothing may be wrong.
fn add(tally: &mut Tally, name: &str, scene: &Scene, of: Check) {
    let found = check(name, scene, of);
    println!("{name}, light x{}, 1/{:.0}: {found:?}", of.scale, 1.0 / of.width);
    assert!(found.wrong.is_empty(), "{:#?}", found.wrong);
    tally.add(found);
}

#[test]
fn every_claim_holds_on_random_rays() {
    let mut tally = Tally::default();
    for name in ["orthocircle", "chubs", "kusner", "mcmullen"] {
        let scene = named(name).unwrap().unwrap();
        for (scale, width, hits) in [(1.0, 1.0 / 255.0, 5), (1.0, 1.0 / 4096.0, 2), (4.0, 1.0 / 255.0, 2)] {
            add(&mut tally, name, &scene, Check { scale, width, hits, ..Check::default() });
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
        let scene = named(name).unwrap().unwrap();
        add(&mut tally, name, &scene, Check { floor, scale: 2.0, ..Check::default() });
    }
    for text in [
        "smooth_union(sphere(0.8), translate(box(0.5), 0.6, 0.2, 0.1), 0.2)",
        "max(x^2 + y^2 - 0.3, abs(z) - 0.7) = 0",
        "sin(5x) + sin(5y) + sin(5z) + 1 = 0",
        "exp(x y) - 1.2 + z^2 - cos(3y) / 4 = 0",
    ] {
        let scene = Scene::from_formula(text).unwrap();
        add(&mut tally, text, &scene, Check { scale: 2.0, ..Check::default() });
    }
    assert!(tally.penumbrae > 10 && tally.lit > 150 && tally.dark > 150, "{tally:?}");
}
