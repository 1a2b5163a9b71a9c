//! Pictures of the GPU against those of the processor: nothing that both claim may be contradictory. Where there is no adapter, they say
//! loudly that they were skipped (and fail if `ANTUMBRA_GPU_REQUIRED` is set).
use antumbra::geom::{Film, Rect};
use antumbra::paper::{self, Settings};
use antumbra::render::{Frame, Method, RenderSpec, Renderer, RunSpec};
use antumbra::scene::{GALLERY, PRESETS, Scene, named};
use antumbra::trace::Surface;
use antumbra_gpu::{Error, Gpu, Kernels, Paper, Pixel, assist, check, compare};
use std::collections::BTreeSet;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

const SIDE: usize = 40;
const TOLERANCE: f64 = 1.0 / 255.0;

fn gpu() -> Option<Gpu> {
    match Gpu::open(true) {
        Ok(gpu) => Some(gpu),
        Err(Error::NoAdapter) if std::env::var_os("ANTUMBRA_GPU_REQUIRED").is_none() => {
            eprintln!("SKIPPED: no adapter here, nothing was run on a GPU");
            None
        }
        Err(error) => panic!("{error}"),
    }
}

fn scene(name: &str) -> Scene {
    named(name).unwrap().unwrap()
}

fn surfaces(scene: &Scene) -> Vec<Surface<'_>> {
    let objects = scene.objects.iter();
    objects.map(|o| Surface { function: o.surface.as_ref(), clip: o.clip(), region: o.region() }).collect()
}

fn film(scene: &Scene, side: usize) -> Film {
    Film { camera: scene.view.camera(1.0), width: side, height: side }
}

fn renderer(scene: Scene, method: Method) -> Renderer {
    sized(scene, SIDE, method)
}

fn sized(scene: Scene, side: usize, method: Method) -> Renderer {
    let spec = RenderSpec { width: side, height: side, method, ..RenderSpec::default() };
    Renderer::new(Arc::new(scene), spec, RunSpec::default()).unwrap()
}

fn finished(mut renderer: Renderer) -> Renderer {
    while !renderer.refine(Duration::from_secs(60)) {}
    renderer
}

/// Presets that the GPU draws, with the least share of pixels and of brackets, in percent, that it has to settle.
const DRAWN: [(&str, usize, usize); 7] = [
    ("orthocircle", 30, 95),
    ("chubs", 40, 90),
    ("mcmullen", 70, 85),
    ("kusner", 70, 80),
    ("sphere", 80, 95),
    ("torus", 60, 90),
    ("links", 50, 80),
];

#[test]
fn presets_are_proved_without_contradictions() {
    let Some(gpu) = gpu() else { return };
    for (name, pixels, brackets) in DRAWN {
        holds(&gpu, name, SIDE, pixels, brackets);
    }
    // Large enough to meet shares that a careless sum of divisions would count twice.
    holds(&gpu, "kusner", 256, 95, 88);
}

/// No contradiction in a picture of that side, and at least that many percent of the pixels and of the brackets settled.
fn holds(gpu: &Gpu, name: &str, side: usize, pixels: usize, brackets: usize) {
    let scene = scene(name);
    let lights: Vec<Rect> = scene.lights.iter().map(|l| l.rect).collect();
    let kernels = Kernels::new(gpu, &surfaces(&scene), &film(&scene, side), &lights, TOLERANCE).unwrap();
    let proved = kernels.prove(gpu, &AtomicBool::new(false), &mut |_| ()).unwrap();
    let cpu = finished(sized(scene, side, Method::Certified));
    let c = compare(&proved, cpu.frame(), TOLERANCE);
    assert!(c.contradictions.is_empty(), "{name}: {:#?}", c.contradictions);
    println!("{name}: {} of {} pixels, {} of {} brackets", c.empty + c.hits, c.pixels, c.settled, c.lights);
    assert!(100 * (c.empty + c.hits) >= pixels * c.pixels, "{name}: {c:?}");
    assert!(100 * c.settled >= brackets * c.lights, "{name}: {c:?}");
}

/// Every surface of the gallery and every preset has kernels, or is sent to the processor for a reason that is told.
#[test]
fn the_gallery_is_drawn_or_refused_with_a_reason() {
    let (mut drawn, mut refused) = (0, Vec::new());
    let names: BTreeSet<&str> = PRESETS.iter().map(|p| p.name).chain(GALLERY.iter().map(|e| e.name)).collect();
    for name in names {
        let scene = scene(name);
        let lights: Vec<Rect> = scene.lights.iter().map(|l| l.rect).collect();
        match check(&surfaces(&scene), &film(&scene, SIDE), &lights) {
            Ok(()) => drawn += 1,
            Err(error @ (Error::Refused(_) | Error::Scene(_))) => refused.push(format!("{name}: {error}")),
            Err(error) => panic!("{name}: {error}"),
        }
    }
    println!("{drawn} are drawn, {} stay on the processor:\n{}", refused.len(), refused.join("\n"));
    assert!(drawn >= 59, "{refused:#?}");
}

/// Surfaces with waves, exponentials, quotients and roots, each on few pixels.
#[test]
fn surfaces_of_functions_are_proved_without_contradictions() {
    let Some(gpu) = gpu() else { return };
    for (name, pixels, brackets) in [("gyroid", 20, 0), ("blobs", 60, 85), ("die", 30, 80)] {
        holds(&gpu, name, 24, pixels, brackets);
    }
}

/// A frame of which the GPU proved a part has the same verdicts as one of the processor alone, and brackets within the tolerance.
#[test]
fn the_processor_finishes_what_the_gpu_leaves_open() {
    let Some(gpu) = gpu() else { return };
    for name in ["chubs", "links"] {
        let alone = finished(renderer(scene(name), Method::Certified));
        let mut helped = renderer(scene(name), Method::Certified);
        let share = assist(&gpu, &mut helped, &mut |_| ()).unwrap();
        assert!(share.settled > 0 && share.narrow > 0, "{share:?}");
        let helped = finished(helped);
        let (a, b): (&Frame, &Frame) = (alone.frame(), helped.frame());
        let differ = (0..SIDE * SIDE).filter(|k| a.verdict[*k] != b.verdict[*k]).count();
        assert_eq!(differ, 0, "{name}: verdicts");
        assert_eq!(helped.stats().brackets_open, alone.stats().brackets_open, "{name}");
        for (one, other) in a.lights.iter().zip(&b.lights) {
            for k in (0..SIDE * SIDE).filter(|k| a.verdict[*k] == 1) {
                assert!(one.visible_lo[k] <= other.visible_hi[k] && other.visible_lo[k] <= one.visible_hi[k]);
            }
        }
        // Once begun, it has no use for proofs.
        assert!(matches!(assist(&gpu, &mut { helped }, &mut |_| ()), Err(Error::Scene(_))));
    }
}

/// Planted lies are found.
#[test]
fn the_comparison_finds_what_is_wrong() {
    let Some(gpu) = gpu() else { return };
    let scene = scene("sphere");
    let lights: Vec<Rect> = scene.lights.iter().map(|l| l.rect).collect();
    let kernels = Kernels::new(&gpu, &surfaces(&scene), &film(&scene, SIDE), &lights, TOLERANCE).unwrap();
    let mut proved = kernels.prove(&gpu, &AtomicBool::new(false), &mut |_| ()).unwrap();
    let cpu = finished(renderer(scene, Method::Certified));
    let hit = proved.pixels.iter().position(|p| matches!(p, Pixel::Hit { .. })).unwrap();
    proved.pixels[hit] = Pixel::Empty;
    assert_eq!(compare(&proved, cpu.frame(), TOLERANCE).contradictions.len(), 1);
    let stopped = kernels.prove(&gpu, &AtomicBool::new(true), &mut |_| ());
    assert_eq!(stopped.unwrap_err(), Error::Stopped);
}

/// The paper's counts, but for what 32 bits and the borders of cells make of them: less than a hundredth.
#[test]
fn the_paper_counts_as_the_processor_does() {
    let Some(gpu) = gpu() else { return };
    let usual = RenderSpec::default();
    for name in ["orthocircle", "chubs"] {
        let scene = scene(name);
        let settings = Settings {
            sub_beams: usual.sub_beams,
            offset: RenderSpec::OFFSET * scene.scale(),
            bisection: usual.bisection,
            seed: usual.seed,
        };
        let (film, light) = (film(&scene, SIDE), scene.lights[0].rect);
        let kernels = Paper::new(&gpu, &surfaces(&scene), &film, &light, &settings, usual.grid, false).unwrap();
        let found = kernels.run(&gpu, &AtomicBool::new(false)).unwrap();
        let cpu = finished(renderer(scene, Method::Paper(paper::Method::Initial)));
        let stats = cpu.stats();
        let close = |a: u64, b: u64| 100 * a.abs_diff(b) <= b + 300;
        let hits = found.hits.iter().flatten().count() as u64;
        assert!(close(hits, stats.hits), "{name}: {hits} hits, {}", stats.hits);
        assert!(close(found.initial_occluded as u64, stats.initial_occluded), "{name}: {}", found.initial_occluded);
        let evaluations = found.evaluations[1] + found.evaluations[2];
        assert!(
            20 * evaluations.abs_diff(stats.shadow_evaluations) < stats.shadow_evaluations,
            "{name}: {evaluations}"
        );
    }
}
