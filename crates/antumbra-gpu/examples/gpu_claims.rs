//! Everything that a GPU claims of the presets and of the gallery, held against the processor's own pictures:
//! `cargo run --release -p antumbra-gpu --example gpu_claims -- [side of the presets, 0 for none [side of the gallery, 0 for none [scene...]]]`.
//! Prints counts, of kernels in 32 bits and, where there are any, in 64; fails if there is one contradiction. With names only these scenes are looked at.
use antumbra::eval::wgsl::{Refusal, Width};
use antumbra::geom::{Film, Rect};
use antumbra::render::{RenderSpec, Renderer, RunSpec};
use antumbra::scene::{GALLERY, PRESETS, named};
use antumbra::trace::Surface;
use antumbra_gpu::{Comparison, Error, Gpu, Kernels, Machine, compare};
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

const TOLERANCE: f64 = 1.0 / 255.0;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let side = |k: usize, usual: usize| arguments.get(k).and_then(|s| s.parse().ok()).unwrap_or(usual);
    let [presets, gallery] = [side(0, 256), side(1, 64)];
    let wanted = |name: &str| arguments.len() < 3 || arguments[2..].iter().any(|s| s == name);
    let gpu = match Gpu::open(true) {
        Ok(gpu) => gpu,
        Err(error) => {
            println!("no GPU: {error}");
            return ExitCode::FAILURE;
        }
    };
    println!("{}\n", gpu.name());
    println!(
        "| scene | side | bits | pixels settled % | hits | brackets settled % | contradictions | seconds: GPU, processor |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    let preset = |name: &str| presets > 0 && PRESETS.iter().any(|p| p.name == name);
    let others = GALLERY.iter().map(|e| (e.name, gallery)).filter(|(name, _)| !preset(name));
    let scenes = PRESETS.iter().map(|p| (p.name, presets)).chain(others);
    let mut sums: [(Comparison, usize, usize); 2] = Default::default();
    for (name, side) in scenes.filter(|(name, side)| *side > 0 && wanted(name)) {
        let all = match claims(&gpu, name, side) {
            Ok(all) => all,
            Err(error) => {
                println!("| {name} | {side} | failed: {error} |");
                return ExitCode::FAILURE;
            }
        };
        for ((bits, found), (sum, drawn, refused)) in all.into_iter().zip(&mut sums) {
            match found {
                Ok((c, seconds)) => {
                    *drawn += 1;
                    row(name, side, bits, &c, seconds);
                    sum.pixels += c.pixels;
                    sum.empty += c.empty;
                    sum.hits += c.hits;
                    sum.lights += c.lights;
                    sum.settled += c.settled;
                    sum.contradictions.extend(c.contradictions);
                }
                Err(error) => {
                    *refused += 1;
                    println!("| {name} | {side} | {bits} | the processor's: {error} |");
                }
            }
        }
    }
    for ((sum, drawn, refused), bits) in sums.iter().zip([32, 64]) {
        let name = format!("all: {drawn} drawn, {refused} without such kernels");
        row(&name, presets, bits, sum, [0.0; 2]);
    }
    let right = sums.iter().all(|(sum, ..)| sum.contradictions.is_empty());
    if right { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

fn row(name: &str, side: usize, bits: u32, c: &Comparison, [gpu, cpu]: [f64; 2]) {
    let percent = |n: usize, of: usize| 100.0 * n as f64 / of.max(1) as f64;
    println!(
        "| {name} | {side} | {bits} | {:.1} | {} | {:.1} | {} | {gpu:.2}, {cpu:.1} |",
        percent(c.empty + c.hits, c.pixels),
        c.hits,
        percent(c.settled, c.lights),
        c.contradictions.len()
    );
    c.contradictions.iter().take(5).for_each(|text| println!("  {text}"));
}

/// What was found in a width, or why it has no kernels.
type Found = (u32, Result<(Comparison, [f64; 2]), Error>);

/// What the GPU claims of a scene, in 32 and in 64 bits, against the processor's picture of it, and the seconds that each took.
fn claims(gpu: &Gpu, name: &str, side: usize) -> Result<Vec<Found>, Error> {
    let scene = named(name).expect("it is a scene of ours").expect("our scenes are right");
    let objects = scene.objects.iter();
    let surfaces: Vec<Surface<'_>> =
        objects.map(|o| Surface { function: o.surface.as_ref(), clip: o.clip(), region: o.region() }).collect();
    let film = Film { camera: scene.view.camera(1.0), width: side, height: side };
    let lights: Vec<Rect> = scene.lights.iter().map(|l| l.rect).collect();
    let mut proved = Vec::new();
    for (bits, width) in [(32, Width::Single), (64, Width::Double)] {
        if width == Width::Double && !gpu.has_double() {
            continue;
        }
        match Kernels::of_width(gpu, &surfaces, &film, &lights, TOLERANCE, width) {
            Ok(kernels) => {
                let begin = Instant::now();
                let all = kernels.prove(gpu, &AtomicBool::new(false), &mut |_| ())?;
                proved.push((bits, Ok((all, begin.elapsed().as_secs_f64()))));
            }
            Err(error @ (Error::Refused(_) | Error::Scene(_))) => proved.push((bits, Err(error))),
            Err(error) => return Err(error),
        }
    }
    if proved.iter().all(|(_, found)| found.is_err()) {
        return Ok(proved
            .into_iter()
            .map(|(bits, found)| (bits, Err(found.err().unwrap_or(Refusal::NoFormula.into()))))
            .collect());
    }
    let spec = RenderSpec { width: side, height: side, ..RenderSpec::default() };
    let begin = Instant::now();
    let mut cpu =
        Renderer::new(Arc::new(scene.clone()), spec, RunSpec::default()).expect("a picture of this size fits");
    while !cpu.refine(Duration::from_secs(3600)) {}
    let cpu_seconds = begin.elapsed().as_secs_f64();
    let judged = |(bits, found): (u32, Result<_, Error>)| {
        (bits, found.map(|(all, seconds)| (compare(&all, cpu.frame(), TOLERANCE), [seconds, cpu_seconds])))
    };
    Ok(proved.into_iter().map(judged).collect())
}
