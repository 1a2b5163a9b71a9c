//! Brackets of the visible fraction against plain sampling, as much as you like:
//! `cargo run --release -p antumbra --example sampling -- [PIXELS] [SIZE] [narrow|wide|all] [SCENE...]`.
//!
//! For each scene the picture is rendered by proof at tolerances of 1/255 and of 1/1024 (`narrow`: the scene's light; `wide`:
//! light four times as wide, with the floor), and for PIXELS random hits, half of them in penumbrae, 65 x 65 points of the light
//! are asked one by one by an independent sampler of rays (`tests/truth`) and held against the brackets of both. Prints the contradictions, which must be none, and what is
//! undecided or open; exits with 1 if there is a contradiction.
#![allow(
    clippy::disallowed_methods,
    reason = "the checker is independent on purpose: it uses other functions than the library"
)]
#[path = "../tests/truth/double.rs"]
mod double;
#[allow(dead_code, reason = "shared with tests that use more of it")]
#[path = "../tests/truth/light.rs"]
mod light;
#[allow(dead_code, reason = "shared with tests that use more of it")]
#[path = "../tests/truth/sampler.rs"]
mod sampler;

use antumbra::render::{Frame, RenderSpec, Renderer, RunSpec, Stats};
use antumbra::scene::{Scene, named};
use light::{found, visible};
use rayon::prelude::*;
use sampler::Judge;
use std::process::ExitCode;
use std::sync::Arc;
use std::time::Duration;

/// Cells of the light along each side.
const GRID: usize = 64;
/// Cells whose equal corners may hide an edge.
const SLACK: f64 = 4.0 / (GRID * GRID) as f64;

/// Brackets of both tolerances are held against the same samples.
const TOLERANCES: [f64; 2] = [1.0 / 255.0, 1.0 / 1024.0];

/// One way to light a scene.
struct Setup {
    word: &'static str,
    light_scale: f64,
    floor: bool,
}

const SETUPS: [Setup; 2] =
    [Setup { word: "narrow", light_scale: 1.0, floor: false }, Setup { word: "wide", light_scale: 4.0, floor: true }];

fn main() -> ExitCode {
    let mut arguments = std::env::args().skip(1);
    let mut number = |default: usize| arguments.next().map_or(Ok(default), |text| text.parse());
    let (Ok(pixels), Ok(size)) = (number(2000), number(512)) else {
        eprintln!("usage: sampling [PIXELS] [SIZE] [narrow|wide|all] [SCENE...], the first two whole numbers");
        return ExitCode::from(2);
    };
    let word = arguments.next().unwrap_or_else(|| "all".to_owned());
    let mut names: Vec<String> = arguments.collect();
    if names.is_empty() {
        names = ["orthocircle", "chubs", "kusner", "mcmullen"].map(str::to_owned).to_vec();
    }
    println!("| scene | light, tolerance | hits | undecided | open | widest | pixels | samples | contradictions |");
    println!("|---|---|---|---|---|---|---|---|---|");
    let mut wrong = 0;
    for name in names {
        let Some(Ok(scene)) = named(&name) else {
            eprintln!("`{name}` is not a scene");
            return ExitCode::from(2);
        };
        let scene = Arc::new(scene);
        for setup in SETUPS.iter().filter(|setup| word == "all" || word == setup.word) {
            wrong += check(&scene, setup, pixels, size);
        }
    }
    if wrong == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

fn render(scene: &Arc<Scene>, setup: &Setup, tolerance: f64, size: usize) -> Option<(Frame, Stats)> {
    let &Setup { light_scale, floor, .. } = setup;
    let spec = RenderSpec { width: size, height: size, tolerance, light_scale, floor, ..RenderSpec::default() };
    let mut renderer = Renderer::new(Arc::clone(scene), spec, RunSpec::default()).ok()?;
    while !renderer.refine(Duration::from_secs(60)) {}
    Some((renderer.frame().clone(), renderer.stats()))
}

/// Prints a line of the table for each tolerance; returns the number of contradictions.
fn check(scene: &Arc<Scene>, setup: &Setup, pixels: usize, size: usize) -> usize {
    let drawn: Option<Vec<_>> = TOLERANCES.iter().map(|&t| render(scene, setup, t, size)).collect();
    let Some(drawn) = drawn else {
        eprintln!("a picture of {size} x {size} cannot be begun");
        return 1;
    };
    let floor = setup.floor.then(|| scene.floor().ok()).flatten();
    let judges: Vec<Judge> = scene.objects.iter().chain(&floor).map(Judge::new).collect();
    // Hits do not depend on the tolerance.
    let frame = &drawn[0].0;
    let rect = scene.lights[0].rect.scaled(setup.light_scale);
    let bracket = |frame: &Frame, i: usize| (frame.lights[0].visible_lo[i], frame.lights[0].visible_hi[i]);
    let (edge, rest): (Vec<usize>, Vec<usize>) = (0..size * size).filter(|&i| frame.verdict[i] == 1).partition(|&i| {
        let (lo, hi) = bracket(frame, i);
        hi > 0.0 && lo < 1.0
    });
    let mut random = fastrand::Rng::with_seed(7);
    let chosen: Vec<usize> = (0..pixels)
        .filter_map(|k| {
            let from = if k % 2 == 0 && !edge.is_empty() || rest.is_empty() { &edge } else { &rest };
            random.choice(from).copied()
        })
        .collect();
    let sampled: Vec<_> = chosen
        .par_iter()
        .map(|&index| {
            let (own, p, before) = found(scene, &judges, frame, index)?;
            Some(visible(&judges, own, &p, before, &rect, GRID))
        })
        .collect();
    let mut wrong = 0;
    for ((frame, stats), tolerance) in drawn.iter().zip(TOLERANCES) {
        let name = format!("{}, 1/{:.0}", if setup.floor { "wide + floor" } else { setup.word }, 1.0 / tolerance);
        let mut contradictions = 0;
        for (&index, shares) in chosen.iter().zip(&sampled) {
            let (lo, hi) = bracket(frame, index);
            let why = match shares {
                None => format!("no hit in [{}, {}]", frame.t_lo[index], frame.t_hi[index]),
                Some(shares) if !shares.agree(lo, hi, SLACK) => format!("[{lo}, {hi}], sampled {shares:?}"),
                Some(_) => continue,
            };
            contradictions += 1;
            eprintln!("{}, {name}: pixel {index}: {why}", scene.name);
        }
        let undecided =
            stats.undecided_resolution + stats.undecided_touching + stats.undecided_domain + stats.undecided_budget;
        println!(
            "| {} | {name} | {} | {undecided} | {} | {:.6} | {} | {} | {contradictions} |",
            scene.name,
            stats.hits,
            stats.brackets_open,
            stats.bracket_width_max,
            chosen.len(),
            chosen.len() * (GRID + 1) * (GRID + 1),
        );
        wrong += contradictions;
    }
    wrong
}
