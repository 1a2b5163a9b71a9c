//! Pictures of the GPU against those of the processor: nothing that both claim may be contradictory. Where there is no adapter, they say
//! loudly that they were skipped (and fail if `ANTUMBRA_GPU_REQUIRED` is set).
use antumbra::eval::wgsl::Width;
use antumbra::geom::{Film, Rect};
use antumbra::paper;
use antumbra::render::{Frame, Method, RenderSpec, Renderer, RunSpec};
use antumbra::scene::{GALLERY, PRESETS, Scene, named};
use antumbra::trace::Surface;
use antumbra_gpu::{Error, Gpu, Kernels, Machine, Paper, Pixel, assist, check, compare, trace};
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

/// The paper's pictures, drawn with what the GPU has traced, against those of the processor. What differs is what 32 bits do: enclosures are wider by
/// their roundings, so a few more cells and sections stay in question; shadow beams start from points that are rounded. Stated bounds: hits, occluded
/// initial beams and classes of light within a hundredth, evaluations within a twentieth; sections of T that overlap but for what such roundings move; and what both
/// claim as proofs is not contradictory.
#[test]
fn the_paper_counts_as_the_processor_does() {
    let Some(gpu) = gpu() else { return };
    for name in ["orthocircle", "chubs", "links", "sphere"] {
        for method in [paper::Method::Initial, paper::Method::Fixed] {
            let cpu = finished(renderer(scene(name), Method::Paper(method)));
            let mut traced = renderer(scene(name), Method::Paper(method));
            let mut heard = Vec::new();
            trace(&gpu, &mut traced, &mut |done| heard.push(done)).unwrap();
            assert!(heard.is_sorted() && heard.last() == Some(&1.0), "{heard:?}");
            same_counts(name, &finished(traced), &cpu);
        }
    }
}

fn same_counts(name: &str, gpu: &Renderer, cpu: &Renderer) {
    let (a, b) = (gpu.stats(), cpu.stats());
    println!(
        "{name}, {}: hits {} {}, occluded {} {}, lit {} {}, partly {} {}, dark {} {}, beams {} {}, evaluations {:?} {:?}",
        a.method,
        a.hits,
        b.hits,
        a.initial_occluded,
        b.initial_occluded,
        a.lit,
        b.lit,
        a.partly,
        b.partly,
        a.dark,
        b.dark,
        a.beams,
        b.beams,
        [a.grid_evaluations, a.primary_evaluations, a.shadow_evaluations],
        [b.grid_evaluations, b.primary_evaluations, b.shadow_evaluations],
    );
    let near = |what: &str, a: u64, b: u64, part: u64| {
        assert!(part * a.abs_diff(b) <= b + 3 * part, "{name}: {what} {a} on the GPU, {b} on the processor");
    };
    near("hits", a.hits, b.hits, 100);
    near("empty", a.proved_empty, b.proved_empty, 100);
    near("occluded", a.initial_occluded, b.initial_occluded, 100);
    near("lit", a.lit, b.lit, 100);
    near("partly", a.partly, b.partly, 50);
    near("dark", a.dark, b.dark, 50);
    near("initial beams", a.initial_beams, b.initial_beams, 100);
    near("sub-beams", a.beams / 49, b.beams / 49, 100);
    assert_eq!((a.pixel_beams, a.grid_evaluations), (b.pixel_beams, b.grid_evaluations), "{name}");
    near("primary evaluations", a.primary_evaluations, b.primary_evaluations, 20);
    near("shadow evaluations", a.shadow_evaluations, b.shadow_evaluations, 20);
    // Of single pixels: sections of about 1e-5, which roundings of 2^-22 of the parameter may move by one; a sub-beam or two of 49.
    let (a, b) = (gpu.frame(), cpu.frame());
    let both: Vec<usize> = (0..SIDE * SIDE).filter(|k| a.t_lo[*k].is_finite() && b.t_lo[*k].is_finite()).collect();
    let apart = |k: &&usize| (a.t_lo[**k] - b.t_lo[**k]).abs() > 1e-3;
    assert!(100 * both.iter().filter(apart).count() <= both.len() + 200, "{name}: sections are apart");
    for (a, b) in a.lights.iter().zip(&b.lights) {
        let far = |k: &&usize| (a.visible_lo[**k] - b.visible_lo[**k]).abs() > 2.5 / 49.0;
        let (off, all) = (both.iter().filter(far).count(), both.len());
        assert!(100 * off <= all + 200, "{name}: {off} of {all} shadows are apart");
    }
}

/// What the paper's kernels claim as proofs holds: pixels that they call empty are not proved hit by the certified method.
#[test]
fn the_paper_calls_nothing_empty_that_is_proved_hit() {
    let Some(gpu) = gpu() else { return };
    for name in ["chubs", "kusner", "gyroid"] {
        let picture = renderer(scene(name), Method::Paper(paper::Method::Fixed));
        let found = Paper::new(&gpu, &picture.question()).unwrap().run(&gpu, &AtomicBool::new(false), &mut |_| ());
        let proved = finished(renderer(scene(name), Method::Certified));
        let pixels = found.unwrap().traced.pixels;
        let empty: Vec<usize> = (0..pixels.len()).filter(|k| pixels[*k].find.is_none()).collect();
        assert!(name == "gyroid" || empty.len() > SIDE, "{name}: {}", empty.len());
        assert!(empty.iter().all(|k| !matches!(proved.frame().verdict[*k], 1 | Frame::PARTLY)), "{name}");
        for (k, pixel) in pixels.iter().enumerate() {
            let Some((_, t)) = pixel.find else { continue };
            let frame = proved.frame();
            assert!(frame.verdict[k] != 1 || frame.t_hi[k] >= t.lo(), "{name}: {t:?} and before {}", frame.t_hi[k]);
        }
    }
}

/// Pictures that stay on the processor are refused, and the renderer is as it was.
#[test]
fn the_paper_refuses_what_it_does_not_have() {
    let Some(gpu) = gpu() else { return };
    let refused = |spec: RenderSpec, what: &str| {
        let mut picture = Renderer::new(Arc::new(scene("sphere")), spec, RunSpec::default()).unwrap();
        match trace(&gpu, &mut picture, &mut |_| ()) {
            Err(error @ Error::Scene(_)) => assert!(error.to_string().contains(what), "{error}"),
            other => panic!("{other:?}"),
        }
        assert!(picture.takes());
    };
    let small =
        RenderSpec { width: 8, height: 8, method: Method::Paper(paper::Method::Initial), ..RenderSpec::default() };
    refused(RenderSpec { floor: true, ..small.clone() }, "floor");
    refused(RenderSpec { method: Method::Paper(paper::Method::RandomRays), ..small.clone() }, "fixed49");
    refused(RenderSpec { method: Method::Certified, ..small.clone() }, "fixed49");
    // More cells than 32 bits count, more than 64 bits, none.
    let picture = Renderer::new(Arc::new(scene("sphere")), small.clone(), RunSpec::default()).unwrap();
    for cells in [1626, usize::MAX, 0] {
        let question = antumbra::render::Question { cells, ..picture.question() };
        assert!(matches!(Paper::new(&gpu, &question), Err(Error::Scene(text)) if text.contains("grid")), "{cells}");
    }
    // Once begun, it has no use for what others find.
    let begun = finished(Renderer::new(Arc::new(scene("sphere")), small, RunSpec::default()).unwrap());
    assert!(matches!(trace(&gpu, &mut { begun }, &mut |_| ()), Err(Error::Scene(text)) if text.contains("begun")));
}

/// A picture of some size is drawn in the numbers that a sample of it says are better; a small one in 32 bits, as is what has no others.
#[test]
fn the_numbers_of_a_picture_are_chosen_by_measurement() {
    let Some(gpu) = gpu() else { return };
    let share = |name: &str, side: usize| {
        let mut picture = sized(scene(name), side, Method::Certified);
        assist(&gpu, &mut picture, &mut |_| ()).unwrap()
    };
    let small = share("sphere", SIDE);
    assert!(small.measured.is_none() && small.width == Width::Single, "{small:?}");
    // What has functions has no kernels in 64 bits.
    let functions = share("blobs", 160);
    assert!(functions.measured.is_none() && functions.width == Width::Single, "{functions:?}");
    if !gpu.has_double() {
        return;
    }
    let large = share("mcmullen", 160);
    let [single, double] = large.measured.unwrap();
    assert!(single.seconds > 0.0 && double.seconds > 0.0, "{large:?}");
    assert!(double.left < single.left, "{large:?}");
}
