//! Brackets of the visible fraction against plain sampling, as much as you like:
//! `cargo run --release -p antumbra --example sampling -- [PIXELS] [SIZE] [narrow|fine|wide|all] [SCENE...]`.
//!
//! For each scene the picture is rendered by proof (narrow light at a tolerance of 1/255 and of 1/1024; light four times as
//! wide, with the floor), and for PIXELS random hits, half of them in penumbrae, 65 x 65 points of the light are asked one by
//! one by an independent sampler of rays (`tests/truth`). Prints the contradictions, which must be none, and what is
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

/// One way to light a scene.
struct Setup {
    word: &'static str,
    name: &'static str,
    tolerance: f64,
    light_scale: f64,
    floor: bool,
}

const SETUPS: [Setup; 3] = [
    Setup { word: "narrow", name: "narrow, 1/255", tolerance: 1.0 / 255.0, light_scale: 1.0, floor: false },
    Setup { word: "fine", name: "narrow, 1/1024", tolerance: 1.0 / 1024.0, light_scale: 1.0, floor: false },
    Setup { word: "wide", name: "wide + floor, 1/255", tolerance: 1.0 / 255.0, light_scale: 4.0, floor: true },
];

fn main() -> ExitCode {
    let mut arguments = std::env::args().skip(1);
    let mut number = |default: usize| arguments.next().map_or(Ok(default), |text| text.parse());
    let (Ok(pixels), Ok(size)) = (number(2000), number(512)) else {
        eprintln!("usage: sampling [PIXELS] [SIZE] [narrow|fine|wide|all] [SCENE...], the first two whole numbers");
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

fn render(scene: &Arc<Scene>, setup: &Setup, size: usize) -> Option<(Frame, Stats)> {
    let &Setup { tolerance, light_scale, floor, .. } = setup;
    let spec = RenderSpec { width: size, height: size, tolerance, light_scale, floor, ..RenderSpec::default() };
    let mut renderer = Renderer::new(Arc::clone(scene), spec, RunSpec::default()).ok()?;
    while !renderer.refine(Duration::from_secs(60)) {}
    Some((renderer.frame().clone(), renderer.stats()))
}

/// Prints a line of the table; returns the number of contradictions.
fn check(scene: &Arc<Scene>, setup: &Setup, pixels: usize, size: usize) -> usize {
    let Some((frame, stats)) = render(scene, setup, size) else {
        eprintln!("a picture of {size} x {size} cannot be begun");
        return 1;
    };
    let floor = setup.floor.then(|| scene.floor().ok()).flatten();
    let judges: Vec<Judge> = scene.objects.iter().chain(&floor).map(Judge::new).collect();
    let planes = &frame.lights[0];
    let rect = scene.lights[0].rect.scaled(setup.light_scale);
    let (edge, rest): (Vec<usize>, Vec<usize>) = (0..size * size)
        .filter(|&i| frame.verdict[i] == 1)
        .partition(|&i| planes.visible_hi[i] > 0.0 && planes.visible_lo[i] < 1.0);
    let mut random = fastrand::Rng::with_seed(7);
    let chosen: Vec<usize> = (0..pixels)
        .filter_map(|k| {
            let from = if k % 2 == 0 && !edge.is_empty() || rest.is_empty() { &edge } else { &rest };
            random.choice(from).copied()
        })
        .collect();
    let contradictions: Vec<String> = chosen
        .par_iter()
        .filter_map(|&index| {
            let (lo, hi) = (planes.visible_lo[index], planes.visible_hi[index]);
            let Some((own, p, before)) = found(scene, &judges, &frame, index) else {
                return Some(format!("pixel {index}: no hit in [{}, {}]", frame.t_lo[index], frame.t_hi[index]));
            };
            let shares = visible(&judges, own, &p, before, &rect, GRID);
            (!shares.agree(lo, hi, SLACK)).then(|| format!("pixel {index}: [{lo}, {hi}], sampled {shares:?}"))
        })
        .collect();
    let undecided =
        stats.undecided_resolution + stats.undecided_touching + stats.undecided_domain + stats.undecided_budget;
    println!(
        "| {} | {} | {} | {undecided} | {} | {:.6} | {} | {} | {} |",
        scene.name,
        setup.name,
        stats.hits,
        stats.brackets_open,
        stats.bracket_width_max,
        chosen.len(),
        chosen.len() * (GRID + 1) * (GRID + 1),
        contradictions.len(),
    );
    contradictions.iter().for_each(|line| eprintln!("{}, {}: {line}", scene.name, setup.name));
    contradictions.len()
}
