//! What a GPU takes for the four scenes of the paper: `cargo run --release -p antumbra-gpu --example gpu_table -- [repeats [WxH... [side of the paper's pictures, 0 for none]]]`.
//! With `--despite` it goes on where the probe fails, for diagnosis. Prints what the probe says, contradictions against the CPU, and milliseconds by the clock of the GPU, medians.
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
/// Side of the pictures in 32 and 64 bits.
const WIDE: usize = 128;

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let repeats: usize = arguments.first().and_then(|s| s.parse().ok()).unwrap_or(20);
    let size = |s: &String| s.split_once('x').and_then(|(w, h)| Some((w.parse().ok()?, h.parse().ok()?)));
    let paper: usize = arguments.iter().skip(1).filter_map(|s| s.parse().ok()).next_back().unwrap_or(512);
    let mut sizes: Vec<(usize, usize)> = arguments.iter().skip(1).filter_map(size).collect();
    if sizes.is_empty() {
        sizes = vec![(512, 512), (1920, 1080), (3840, 2160)];
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
    rates(&gpu);
    println!("\n| scene, {COMPARED} x {COMPARED} | empty | hits | left to the CPU | lights settled | contradictions |");
    println!("|---|---|---|---|---|---|");
    for name in SCENES {
        let scene = scene(name);
        let proved = match draw(&gpu, &scene, (COMPARED, COMPARED), 1) {
            Ok((proved, ..)) => proved,
            Err(error) => {
                println!("| {name} | {error} |");
                continue;
            }
        };
        let mut cpu = renderer(scene, (COMPARED, COMPARED), Method::Certified);
        while !cpu.refine(Duration::from_secs(3600)) {}
        let c = compare(&proved, cpu.frame(), TOLERANCE);
        let open = c.pixels - c.empty - c.hits;
        println!(
            "| {name} | {} | {} | {open} | {} of {} | {} |",
            c.empty,
            c.hits,
            c.settled,
            c.lights,
            c.contradictions.len()
        );
        c.contradictions.iter().take(5).for_each(|text| println!("  {text}"));
    }
    widths(&gpu);
    if paper > 0 {
        paper_counts(&gpu);
    }
    println!("\nMilliseconds on the GPU, medians of {repeats}; evaluations in millions.\n");
    table(&gpu, &sizes, repeats);
    if paper > 0 {
        paper_table(&gpu, paper, repeats.min(5));
    }
}

/// What the adapter can do, and what an evaluation of each scene's first surface asks of it.
fn rates(gpu: &Gpu) {
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
    for name in SCENES {
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

/// 32 against 64 bits, in one process and in turns.
fn widths(gpu: &Gpu) {
    println!(
        "\n| scene, {WIDE} x {WIDE} | bits | pixels left | brackets left | evaluations: surfaces, light | milliseconds: surfaces, light |"
    );
    println!("|---|---|---|---|---|---|");
    let stop = AtomicBool::new(false);
    for name in SCENES.into_iter().chain(["links", "torus"]) {
        let scene = scene(name);
        let surfaces = surfaces(&scene);
        let film = Film { camera: scene.view.camera(1.0), width: WIDE, height: WIDE };
        let lights: Vec<Rect> = scene.lights.iter().map(|l| l.rect).collect();
        let all = [Width::Single, Width::Double];
        let kernels = all.map(|width| Kernels::of_width(gpu, &surfaces, &film, &lights, TOLERANCE, width));
        let mut runs: [Vec<Proved>; 2] = Default::default();
        for _ in 0..6 {
            for (kernels, runs) in kernels.iter().zip(&mut runs) {
                if let Ok(kernels) = kernels {
                    runs.extend(kernels.prove(gpu, &stop, &mut |_| ()));
                }
            }
        }
        for (runs, bits) in runs.iter().zip([32, 64]) {
            let [_, warm @ ..] = &runs[..] else { continue };
            let (Some(last), clock) = (warm.last(), |f: &dyn Fn(&[f64]) -> f64| {
                1e3 * median(warm.iter().filter(|p| !p.seconds.is_empty()).map(|p| f(&p.seconds)).collect())
            }) else {
                continue;
            };
            let open = last.pixels.iter().filter(|p| matches!(p, Pixel::Open { .. })).count();
            let hit = |k: &usize| matches!(last.pixels[*k], Pixel::Hit { .. });
            let wide = |l: &Vec<[f64; 2]>| (0..l.len()).filter(hit).filter(|k| l[*k][1] - l[*k][0] > TOLERANCE).count();
            println!(
                "| {name} | {bits} | {open} | {} | {}, {} | {:.1}, {:.1} |",
                last.lights.iter().map(wide).sum::<usize>(),
                last.evaluations[0],
                last.evaluations[1],
                clock(&|s| s[0]),
                clock(&|s| s[1..].iter().sum()),
            );
        }
    }
}

fn paper_counts(gpu: &Gpu) {
    println!(
        "\n| the paper, {COMPARED} x {COMPARED}: GPU / CPU | hits | initial beams occluded | pixels in shadow | evaluations: pixels | initial | sub-beams |"
    );
    println!("|---|---|---|---|---|---|---|");
    for name in SCENES {
        let scene = scene(name);
        match draw_paper(gpu, &scene, (COMPARED, COMPARED), paper::Method::Initial, 1) {
            Ok((found, _)) => compare_paper(name, scene, &found),
            Err(error) => println!("| {name} | {error} |"),
        }
    }
}

fn table(gpu: &Gpu, sizes: &[(usize, usize)], repeats: usize) {
    println!(
        "| scene | size | surfaces | whole light | 8 x 8 | 16 x 16 | 32 x 32 | sum | wall, with reading back | pixels open % | brackets wider than 1/255 % of hits | divided hits, parts | evaluations: surfaces, light |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|---|---|");
    for &size in sizes {
        for name in SCENES {
            let scene = scene(name);
            match draw(gpu, &scene, size, repeats) {
                Ok((proved, times, wall)) => row(name, size, &proved, &times, wall),
                Err(error) => println!("| {name} | {}x{} | {error} |", size.0, size.1),
            }
        }
    }
}

fn paper_table(gpu: &Gpu, side: usize, repeats: usize) {
    println!("\nThe paper's method at {0} x {0}, milliseconds, medians of {1}.\n", side, repeats);
    println!(
        "| scene | grid | pixels | initial beams | sub-beams | shadow pass | always 49 | saved % | evaluations: pixels, initial, sub-beams, always 49 (millions) |"
    );
    println!("|---|---|---|---|---|---|---|---|---|");
    for name in SCENES {
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

type Drawn = (Proved, Vec<f64>, f64);

/// Draws it some times: what was proved, median seconds of each pass, and of the whole by the clock on the wall.
fn draw(
    gpu: &Gpu,
    scene: &Scene,
    (width, height): (usize, usize),
    repeats: usize,
) -> Result<Drawn, antumbra_gpu::Error> {
    let surfaces = surfaces(scene);
    let film = Film { camera: scene.view.camera(width as f64 / height as f64), width, height };
    let lights: Vec<Rect> = scene.lights.iter().map(|l| l.rect).collect();
    let begin = Instant::now();
    let kernels = Kernels::new(gpu, &surfaces, &film, &lights, TOLERANCE)?;
    if repeats > 1 {
        let compiled = begin.elapsed().as_secs_f64();
        let begin = Instant::now();
        Kernels::new(gpu, &surfaces, &film, &lights, TOLERANCE)?;
        println!("{}: compiled in {compiled:.3} s, again in {:.4} s", scene.name, begin.elapsed().as_secs_f64());
    }
    let stop = AtomicBool::new(false);
    let mut times: Vec<Vec<f64>> = Vec::new();
    let mut walls = Vec::new();
    let mut proved = kernels.prove(gpu, &stop, &mut |_| ())?;
    for _ in 1..repeats {
        let begin = Instant::now();
        proved = kernels.prove(gpu, &stop, &mut |_| ())?;
        walls.push(begin.elapsed().as_secs_f64());
        times.push(proved.seconds.clone());
    }
    let passes = proved.seconds.len();
    let medians = (0..passes).map(|k| median(times.iter().map(|t| t[k]).collect())).collect();
    Ok((proved, medians, median(walls)))
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}

fn row(name: &str, (width, height): (usize, usize), proved: &Proved, times: &[f64], wall: f64) {
    let ms = |s: f64| format!("{:.3}", 1e3 * s);
    let each: Vec<String> = (0..5).map(|k| times.get(k).map_or("-".to_owned(), |s| ms(*s))).collect();
    let open = proved.pixels.iter().filter(|p| matches!(p, Pixel::Open { .. })).count();
    let hit = |p: &&(usize, &Pixel)| matches!(p.1, Pixel::Hit { .. });
    let hits: Vec<usize> = proved.pixels.iter().enumerate().filter(|p| hit(&p)).map(|p| p.0).collect();
    let wide = |k: &&usize| proved.lights[0][**k][1] - proved.lights[0][**k][0] > TOLERANCE;
    let percent = |n: usize, of: usize| format!("{:.2}", 100.0 * n as f64 / of.max(1) as f64);
    println!(
        "| {name} | {width}x{height} | {} | {} | {} | {} | {} | {} | {:.1}, {:.1} |",
        each.join(" | "),
        ms(times.iter().sum()),
        ms(wall),
        percent(open, proved.pixels.len()),
        percent(hits.iter().filter(wide).count(), hits.len()),
        proved.divided.map(|n| n.to_string()).join(", "),
        proved.evaluations[0] as f64 * 1e-6,
        proved.evaluations[1] as f64 * 1e-6,
    );
}
