//! What a GPU takes for scenes: `cargo run --release -p antumbra-gpu --example gpu_table -- [repeats] [WxH...] [side of the paper's pictures, 0 for none] [scene...]`;
//! without names, for those of the paper. With `--despite` it goes on where the probe fails, for diagnosis. Prints what the probe says, contradictions against the
//! processor, and milliseconds by the clock of the GPU: medians, least and most, of pictures in 32 and in 64 bits that are drawn in turns, after some that do not count.
use antumbra::eval::wgsl::{self, Width};
use antumbra::geom::{Film, Rect};
use antumbra::paper;
use antumbra::render::{Method, RenderSpec, Renderer, RunSpec, Traced};
use antumbra::scene::{Scene, named};
use antumbra::trace::Surface;
use antumbra_gpu::{Gpu, Kernels, Paper, Pixel, Proved, adapters, compare, probe, throughput};
use std::collections::HashMap;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

const SCENES: [&str; 4] = ["orthocircle", "chubs", "mcmullen", "kusner"];
const TOLERANCE: f64 = 1.0 / 255.0;
/// Side of the pictures that are compared with the CPU's.
const COMPARED: usize = 96;

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let repeats: usize = arguments.first().and_then(|s| s.parse().ok()).unwrap_or(20);
    let size = |s: &String| s.split_once('x').and_then(|(w, h)| Some((w.parse().ok()?, h.parse().ok()?)));
    let paper: usize = arguments.iter().skip(1).filter_map(|s| s.parse().ok()).next_back().unwrap_or(512);
    let mut sizes: Vec<(usize, usize)> = arguments.iter().skip(1).filter_map(size).collect();
    if sizes.is_empty() {
        sizes = vec![(512, 512), (1920, 1080), (3840, 2160)];
    }
    let given = arguments.iter().map(String::as_str);
    let mut names: Vec<&str> = given.filter(|s| s.starts_with(|c: char| c.is_ascii_alphabetic())).collect();
    if names.is_empty() {
        names = SCENES.to_vec();
    }
    for adapter in adapters() {
        println!(
            "adapter: {} ({}, {}, driver {}), f64 {}",
            adapter.name, adapter.backend, adapter.kind, adapter.driver, adapter.double
        );
        match adapter.probe {
            Ok(report) => {
                println!("  probe passed, {} cases; subnormals kept: {}", report.cases, report.subnormals);
                for (what, count) in probe::BARE.iter().zip(report.rewritten) {
                    println!("  without a fence, {what} differs in {count}");
                }
            }
            Err(error) => println!("  {error}"),
        }
    }
    let despite = arguments.iter().any(|s| s == "--despite");
    let opened = Gpu::open(true).or_else(|error| {
        if !despite {
            return Err(error);
        }
        println!("\nTHE PROBE FAILED: going on for diagnosis only, nothing below is proved.");
        Gpu::open_untrusted()
    });
    let gpu = match opened {
        Ok(gpu) => gpu,
        Err(error) => {
            println!("no GPU: {error}");
            return;
        }
    };
    rates(&gpu, &names);
    println!(
        "\n| scene, {COMPARED} x {COMPARED} | bits | compiled, s | empty | hits | left to the CPU | lights settled | contradictions |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    for name in &names {
        let scene = scene(name);
        let [single, double] = draw(&gpu, &scene, (COMPARED, COMPARED), 1);
        let mut cpu = renderer(scene, (COMPARED, COMPARED), Method::Certified);
        while !cpu.refine(Duration::from_secs(3600)) {}
        for (bits, drawn) in [(32, single), (64, double)] {
            match drawn.map(|runs| (runs.compiled, compare(&runs.proved, cpu.frame(), TOLERANCE))) {
                Ok((compiled, c)) => {
                    println!(
                        "| {name} | {bits} | {compiled:.2} | {} | {} | {} | {} of {} | {} |",
                        c.empty,
                        c.hits,
                        c.pixels - c.empty - c.hits,
                        c.settled,
                        c.lights,
                        c.contradictions.len()
                    );
                    c.contradictions.iter().take(5).for_each(|text| println!("  {text}"));
                }
                Err(error) => println!("| {name} | {bits} | {error} |"),
            }
        }
    }
    if paper > 0 {
        paper_counts(&gpu, &names);
    }
    println!("\nMilliseconds on the GPU, medians of {repeats}; evaluations in millions.\n");
    table(&gpu, &names, &sizes, repeats);
    if paper > 0 {
        paper_table(&gpu, &names, paper, repeats.min(5));
    }
}

/// What the adapter can do, and what an evaluation of each scene's first surface asks of it.
fn rates(gpu: &Gpu, names: &[&str]) {
    match throughput(gpu) {
        Ok(t) => {
            let giga = |rate: f64| format!("{:.1}", 1e-9 * rate);
            println!(
                "\nBillions of products and sums per second: 32 bits {}, fenced {}; 64 bits, fenced {}",
                giga(t.bare),
                giga(t.fenced),
                t.double.map_or("none".to_owned(), giga)
            );
        }
        Err(error) => println!("\nno throughput: {error}"),
    }
    println!("\n| scene | operations of a form | of a slope |\n|---|---|---|");
    for name in names {
        let [form, slope] = operations(&scene(name));
        println!("| {name} | {form} | {slope} |");
    }
}

/// Products and sums of the formula as a form and as a slope, counted from the kernel's text; all branches count.
fn operations(scene: &Scene) -> [u64; 2] {
    let Some(tape) = scene.objects[0].surface.as_tape() else { return [0; 2] };
    [wgsl::Kind::Form, wgsl::Kind::Slope].map(|kind| {
        let text = wgsl::function(tape, "value", kind).unwrap_or_default();
        let text = format!("{}{}{text}", wgsl::FORMS, wgsl::FUNCTIONS);
        let one = ["add", "sub", "mul"].map(|name| (name, 1));
        let three = ["add3", "sub3", "mul3"].map(|name| (name, 3));
        let mut known: HashMap<&str, u64> = one.into_iter().chain(three).collect();
        // Functions are written before they are called.
        for function in text.split("\nfn ").skip(1) {
            let (name, body) = function.split_once('(').unwrap_or((function, ""));
            let identifier = |c: char| c.is_ascii_alphanumeric() || c == '_';
            let calls =
                body.match_indices('(').map(|(at, _)| body[..at].rsplit(|c| !identifier(c)).next().unwrap_or(""));
            let count = calls.filter_map(|call| known.get(call)).sum();
            known.entry(name).or_insert(count);
        }
        known.get("value").copied().unwrap_or(0)
    })
}

fn paper_counts(gpu: &Gpu, names: &[&str]) {
    println!(
        "\n| the paper, {COMPARED} x {COMPARED}: GPU / CPU | hits | initial beams occluded | pixels in shadow | evaluations: pixels | initial | sub-beams |"
    );
    println!("|---|---|---|---|---|---|---|");
    for name in names {
        let scene = scene(name);
        match draw_paper(gpu, &scene, (COMPARED, COMPARED), paper::Method::Initial, 1) {
            Ok((found, _)) => compare_paper(name, scene, &found),
            Err(error) => println!("| {name} | {error} |"),
        }
    }
}

fn table(gpu: &Gpu, names: &[&str], sizes: &[(usize, usize)], repeats: usize) {
    println!(
        "| scene | size | bits | surfaces | whole light | 8 x 8 | 16 x 16 | 32 x 32 | sum | wall, with reading back | pixels left | brackets left, of | divided hits, parts | evaluations: surfaces, light |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|---|---|---|");
    for &(width, height) in sizes {
        for name in names {
            let scene = scene(name);
            for (bits, drawn) in [32, 64].into_iter().zip(draw(gpu, &scene, (width, height), repeats)) {
                match drawn {
                    Ok(runs) => println!("| {name} | {width}x{height} | {bits} | {} |", row(&runs)),
                    Err(error) => println!("| {name} | {width}x{height} | {bits} | {error} |"),
                }
            }
        }
    }
}

fn paper_table(gpu: &Gpu, names: &[&str], side: usize, repeats: usize) {
    println!("\nThe paper's method at {0} x {0}, milliseconds, medians of {1}.\n", side, repeats);
    println!(
        "| scene | grid | pixels | initial beams | sub-beams | shadow pass | always 49 | saved % | evaluations: pixels, initial, sub-beams, always 49 (millions) |"
    );
    println!("|---|---|---|---|---|---|---|---|---|");
    for name in names {
        let scene = scene(name);
        let drawn = draw_paper(gpu, &scene, (side, side), paper::Method::Initial, repeats);
        let always = draw_paper(gpu, &scene, (side, side), paper::Method::Fixed, repeats);
        if let (Ok((found, times)), Ok((fixed, fixed_times))) = (drawn, always) {
            let ms = |s: f64| format!("{:.3}", 1e3 * s);
            let [shadow, all] = [times[2] + times[3], fixed_times[2] + fixed_times[3]];
            let each: Vec<String> = times.iter().map(|t| ms(*t)).collect();
            let millions = |n: u64| n as f64 * 1e-6;
            let [found, fixed] = [&found, &fixed].map(evaluations);
            println!(
                "| {name} | {} | {} | {} | {:.1} | {:.1}, {:.1}, {:.1}, {:.1} |",
                each.join(" | "),
                ms(shadow),
                ms(all),
                100.0 * (1.0 - shadow / all),
                millions(found[0]),
                millions(found[1]),
                millions(found[2]),
                millions(fixed[2]),
            );
        }
    }
}

/// The paper's method some times, and median seconds of its passes.
fn draw_paper(
    gpu: &Gpu,
    scene: &Scene,
    (width, height): (usize, usize),
    method: paper::Method,
    repeats: usize,
) -> Result<(Traced, Vec<f64>), antumbra_gpu::Error> {
    let picture = renderer(scene.clone(), (width, height), Method::Paper(method));
    let kernels = Paper::new(gpu, &picture.question())?;
    let stop = AtomicBool::new(false);
    let mut times: Vec<Vec<f64>> = Vec::new();
    let mut found = kernels.run(gpu, &stop, &mut |_| ())?;
    for _ in 1..repeats {
        found = kernels.run(gpu, &stop, &mut |_| ())?;
        times.push(found.seconds.clone());
    }
    let medians = (0..found.seconds.len()).map(|k| median(times.iter().map(|t| t[k]).collect())).collect();
    Ok((found.traced, medians))
}

/// Evaluations: of pixel beams, of initial beams, of sub-beams.
fn evaluations(traced: &Traced) -> [u64; 3] {
    let pixels = traced.pixels.iter().map(|p| u64::from(p.evaluations)).sum();
    let of_lights = |k: usize| traced.lights.iter().flatten().map(|l| l.evaluations[k]).sum();
    [pixels, of_lights(0), of_lights(1)]
}

fn compare_paper(name: &str, scene: Scene, traced: &Traced) {
    let mut cpu = renderer(scene, (COMPARED, COMPARED), Method::Paper(paper::Method::Initial));
    while !cpu.refine(Duration::from_secs(3600)) {}
    let (stats, planes) = (cpu.stats(), &cpu.frame().lights[0]);
    let hits = traced.pixels.iter().filter(|p| p.find.is_some()).count();
    let occluded = traced.lights[0].iter().filter(|l| l.initial_occluded).count();
    let shadow = traced.lights[0].iter().filter(|l| l.blocked > 0).count();
    let shadow_cpu = planes.visible_lo.iter().filter(|v| **v < 1.0).count();
    let [pixels, initial, sub] = evaluations(traced);
    println!(
        "| {name} | {hits} / {} | {occluded} / {} | {shadow} / {shadow_cpu} | {pixels} / {} | {initial} | {sub} (both {}) |",
        stats.hits, stats.initial_occluded, stats.primary_evaluations, stats.shadow_evaluations,
    );
}

fn renderer(scene: Scene, (width, height): (usize, usize), method: Method) -> Renderer {
    let spec = RenderSpec { width, height, method, ..RenderSpec::default() };
    Renderer::new(Arc::new(scene), spec, RunSpec::default()).expect("a picture of this size fits")
}

fn surfaces(scene: &Scene) -> Vec<Surface<'_>> {
    let of = |o| -> Surface<'_> {
        let o: &antumbra::scene::Object = o;
        Surface { function: o.surface.as_ref(), clip: o.clip(), region: o.region() }
    };
    scene.objects.iter().map(of).collect()
}

fn scene(name: &str) -> Scene {
    named(name).expect("it is a preset").expect("presets are right")
}

/// A picture's stages wait so long at least for a clock that rises under load; seconds.
const WARM: f64 = 0.5;

/// Pictures of one width, without those that were drawn until the clocks were warm.
#[derive(Default)]
struct Runs {
    /// Seconds until the kernels were compiled: none where they were known.
    compiled: f64,
    /// What is proved: the same every time.
    proved: Proved,
    /// Seconds of the stages.
    stages: Vec<Vec<f64>>,
    /// Seconds by the clock on the wall.
    walls: Vec<f64>,
}

/// Draws it some times, in 32 and in 64 bits in turns.
fn draw(
    gpu: &Gpu,
    scene: &Scene,
    (width, height): (usize, usize),
    repeats: usize,
) -> [Result<Runs, antumbra_gpu::Error>; 2] {
    let surfaces = surfaces(scene);
    let film = Film { camera: scene.view.camera(width as f64 / height as f64), width, height };
    let lights: Vec<Rect> = scene.lights.iter().map(|l| l.rect).collect();
    let compile = |bits: Width| Kernels::of_width(gpu, &surfaces, &film, &lights, TOLERANCE, bits);
    let mut all = [Width::Single, Width::Double].map(|bits| {
        let begin = Instant::now();
        let kernels = compile(bits)?;
        Ok((kernels, Runs { compiled: begin.elapsed().as_secs_f64(), ..Runs::default() }))
    });
    let stop = AtomicBool::new(false);
    let begin = Instant::now();
    let (mut cold, mut left) = (true, repeats);
    while left > 0 {
        for each in &mut all {
            let Ok((kernels, runs)) = each else { continue };
            let begin = Instant::now();
            match kernels.prove(gpu, &stop, &mut |_| ()) {
                Ok(_) if cold => {}
                Ok(proved) => {
                    runs.walls.push(begin.elapsed().as_secs_f64());
                    runs.stages.push(proved.seconds.clone());
                    runs.proved = proved;
                }
                Err(error) => *each = Err(error),
            }
        }
        left -= usize::from(!cold);
        cold = cold && begin.elapsed().as_secs_f64() < WARM;
    }
    all.map(|each| each.map(|(_, runs)| runs))
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}

/// Milliseconds: the median, the least and the most.
fn spread(mut seconds: Vec<f64>) -> String {
    seconds.sort_by(f64::total_cmp);
    let ms = |s: Option<&f64>| s.map_or("-".to_owned(), |s| format!("{:.2}", 1e3 * s));
    format!("{} ({}..{})", ms(seconds.get(seconds.len() / 2)), ms(seconds.first()), ms(seconds.last()))
}

fn row(runs: &Runs) -> String {
    let last = &runs.proved;
    let of = |f: &dyn Fn(&[f64]) -> Option<f64>| runs.stages.iter().filter_map(|s| f(s)).collect::<Vec<f64>>();
    let stages: Vec<String> = (0..5).map(|k| format!("{:.2}", 1e3 * median(of(&|s| s.get(k).copied())))).collect();
    let open = last.pixels.iter().filter(|p| matches!(p, Pixel::Open { .. })).count();
    let hits: Vec<usize> = (0..last.pixels.len()).filter(|k| matches!(last.pixels[*k], Pixel::Hit { .. })).collect();
    let wide = |l: &Vec<[f64; 2]>| hits.iter().filter(|k| l[**k][1] - l[**k][0] > TOLERANCE).count();
    format!(
        "{} | {} | {} | {open} | {}, {} | {} | {:.1}, {:.1}",
        stages.join(" | "),
        spread(of(&|s| (!s.is_empty()).then(|| s.iter().sum()))),
        spread(runs.walls.clone()),
        last.lights.iter().map(wide).sum::<usize>(),
        hits.len() * last.lights.len(),
        last.divided.map(|n| n.to_string()).join(", "),
        last.evaluations[0] as f64 * 1e-6,
        last.evaluations[1] as f64 * 1e-6,
    )
}
