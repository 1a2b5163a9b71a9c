//! Whole pictures.
use antumbra::render::{Frame, Method, RenderSpec, Renderer, RunSpec, Stats};
use antumbra::scene::preset;
use std::sync::Arc;
use std::time::Duration;

const SURFACES: [&str; 4] = ["orthocircle", "chubs", "kusner", "mcmullen"];

fn renderer(scene: &str, method: &str, size: usize, threads: usize) -> Renderer {
    let method = Method::from_name(method).unwrap();
    let spec = RenderSpec { width: size, height: size, method, ..RenderSpec::default() };
    Renderer::new(Arc::new(preset(scene).unwrap().unwrap()), spec, RunSpec { threads: Some(threads) }).unwrap()
}

fn finish(mut renderer: Renderer, budget: Duration) -> (Frame, Stats) {
    while !renderer.refine(budget) {}
    (renderer.frame().clone(), renderer.stats())
}

fn render(scene: &str, method: &str, size: usize) -> (Frame, Stats) {
    finish(renderer(scene, method, size, 2), Duration::MAX)
}

/// "No. beams" of Table 1.
#[test]
fn beams_are_counted_as_in_the_paper() {
    for scene in SURFACES {
        let (_, fixed) = render(scene, "fixed49", 48);
        let (_, paper) = render(scene, "paper", 48);
        assert_eq!(fixed.beams, 49 * fixed.hits, "{scene}");
        assert_eq!(paper.beams, 49 * paper.initial_occluded, "{scene}");
        assert_eq!((fixed.initial_beams, paper.initial_beams), (0, paper.hits), "{scene}");
        assert_eq!(paper.hits, fixed.hits, "{scene}");
        assert!(paper.initial_occluded < paper.hits && paper.shadow_evaluations < fixed.shadow_evaluations, "{scene}");
        assert_eq!(paper.lit + paper.partly + paper.dark, paper.hits, "{scene}");
    }
}

/// A light that one beam proves to be free is free for 49. That a blocked sub-beam blocks the initial beam holds too, for all
/// pixels here; inclusion functions guarantee it only up to rounding and to where their bisections stop, so it is measured.
#[test]
fn methods_agree_about_the_shadow() {
    let mut differing = 0;
    let mut pixels = 0;
    let (mut apart, mut far_apart) = (0.0, 0);
    for scene in SURFACES {
        let (fixed, _) = render(scene, "fixed49", 48);
        let (paper, _) = render(scene, "paper", 48);
        let (four, four_stats) = render(scene, "paper-4", 48);
        let (tree, _) = render(scene, "paper-quadtree", 48);
        for i in 0..48 * 48 {
            let index = |frame: &Frame| frame.lights[0].visible_lo[i].to_bits();
            assert_eq!(paper.lights[0].visible_lo[i].to_bits(), paper.lights[0].visible_hi[i].to_bits());
            if fixed.lights[0].visible_lo[i].is_nan() {
                continue;
            }
            pixels += 1;
            differing += u32::from(index(&fixed) != index(&paper)) + u32::from(index(&fixed) != index(&four));
            // A quadtree has 64 leaves where the others have 49 tiles: shares differ by what a row of tiles makes; by more
            // only where a hit lies right before a cusp, and which beams may be blocked is a matter of rounding.
            let difference = (fixed.lights[0].visible_lo[i] - tree.lights[0].visible_lo[i]).abs();
            apart += difference;
            far_apart += u32::from(difference > 0.35);
        }
        assert_eq!(four_stats.initial_beams, 4 * four_stats.hits, "{scene}");
    }
    assert!(pixels > 4000, "{pixels}");
    assert!(
        apart < 0.02 * f64::from(pixels) && far_apart * 200 < pixels,
        "quadtree: {apart} in all, {far_apart} far apart"
    );
    // 1 in 1000 would already be visible.
    assert!(differing * 1000 <= pixels, "{differing} of {pixels} pixels differ between fixed49, paper and paper-4");
    println!("{differing} of {pixels} pixels differ between fixed49, paper and paper-4");
}

fn assert_same_bits(a: &Frame, b: &Frame, what: &str) {
    let bits = |plane: &[f64]| plane.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
    for (x, y) in [
        (&a.t_lo, &b.t_lo),
        (&a.t_hi, &b.t_hi),
        (&a.lights[0].visible_lo, &b.lights[0].visible_lo),
        (&a.lights[0].visible_hi, &b.lights[0].visible_hi),
    ] {
        assert_eq!(bits(x), bits(y), "{what}");
    }
    assert_eq!((&a.verdict, &a.cost), (&b.verdict, &b.cost), "{what}");
    assert_eq!((&a.rgb, &a.normal, &a.lights[0].facing), (&b.rgb, &b.normal, &b.lights[0].facing), "{what}");
}

#[test]
fn pictures_are_the_same_for_any_threads_and_budgets() {
    for (scene, method) in [("orthocircle", "paper"), ("chubs", "rays-mc"), ("kusner", "paper-quadtree")] {
        let (reference, stats) = finish(renderer(scene, method, 48, 1), Duration::MAX);
        for (threads, budget) in [(1, Duration::ZERO), (2, Duration::MAX), (3, Duration::from_micros(200))] {
            let (frame, again) = finish(renderer(scene, method, 48, threads), budget);
            assert_same_bits(&reference, &frame, &format!("{scene}, {method}, {threads} threads, {budget:?}"));
            assert_eq!((stats.hits, stats.beams, stats.evaluations), (again.hits, again.beams, again.evaluations));
        }
    }
}

/// Rays hit what covers their pixels' centres. Beams hit a rim more, in which natural intervals over a pixel's beam cannot
/// exclude a zero: it is widest where the surface is nearly singular (Chubs), and shrinks with the pixels.
#[test]
fn hits_are_the_coverage_and_a_rim() {
    // Per cent of all pixels: coverage in large pictures, and the most that the rim may be at 128 x 128.
    for (scene, coverage, most) in
        [("orthocircle", 54.78, 3.5), ("chubs", 57.96, 19.0), ("kusner", 58.13, 6.0), ("mcmullen", 68.06, 7.0)]
    {
        let percent = |method: &str, size: usize| {
            let mut renderer = renderer(scene, method, size, 2);
            // The first quarter is the hits.
            while renderer.progress() < 0.25 {
                renderer.refine(Duration::ZERO);
            }
            100.0 * renderer.stats().hits as f64 / (size * size) as f64
        };
        let rays = percent("rays", 128);
        let (coarse, fine) = (percent("paper", 64) - coverage, percent("paper", 128) - coverage);
        println!("{scene}: rays {rays:.2} %, coverage {coverage:.2} %, rim {coarse:.2} and {fine:.2} %");
        assert!((rays - coverage).abs() < 0.3, "{scene}: rays {rays:.2} %, coverage {coverage:.2} %");
        assert!(fine > 0.0 && fine < most, "{scene}: a rim of {fine:.2} %");
        assert!(fine < 0.75 * coarse, "{scene}: a rim of {fine:.2} % after {coarse:.2} % at half the size");
    }
}

/// Figures 1 and 5: a blade thinner than the distance of the rays.
#[test]
fn rays_miss_what_beams_find() {
    let (beams, _) = render("twister", "paper", 48);
    let (rays, _) = render("twister", "rays", 48);
    let hit = |frame: &Frame, i: usize| !frame.t_lo[i].is_nan();
    let missed = (0..48 * 48).filter(|&i| hit(&beams, i) && !hit(&rays, i)).count();
    let invented = (0..48 * 48).filter(|&i| !hit(&beams, i) && hit(&rays, i)).count();
    assert_eq!(invented, 0, "a ray of the pixel hits where the beam of all its rays was proved to miss");
    assert!(missed > 20, "{missed}");
    println!("twister: rays miss {missed} pixels that beams find");
}

/// The parameters of a hit: nothing before `t_lo`, and centre rays hit where their pixel's beam says that something may be.
#[test]
fn hits_of_rays_lie_behind_the_first_bound_of_beams() {
    for scene in SURFACES {
        let (beams, _) = render(scene, "paper", 48);
        let (rays, _) = render(scene, "rays", 48);
        for i in 0..48 * 48 {
            if rays.t_lo[i].is_nan() {
                continue;
            }
            assert!(beams.t_lo[i] <= rays.t_hi[i], "{scene}, pixel {i}: {} and {}", beams.t_lo[i], rays.t_hi[i]);
        }
    }
}
