//! Every claim of every cell of the second-order method at many penumbra hits, on many random rays that an independent
//! sampler judges (`tests/truth`); and the brackets of both orders, which must meet.
//! `cargo run --release -p antumbra --example claims -- [--hits 500] [--rays 2000] [--rectangles 4000] [--threads N] [--seed 17] [SCENE ...]`
//!
//! `--hits`: penumbra hits for each scene, light (as it is, four times as wide) and tolerance (1/255, 1/4096). `--rays`: for each
//! hit, at least; every claim gets some. Scenes: names of presets and of the gallery, by default the paper's four. Prints a
//! line for each combination, then every claim that is wrong, and exits with 1 if there is one.
#![allow(
    clippy::disallowed_methods,
    reason = "the checker is independent on purpose: it uses other functions than the library"
)]
#[path = "../tests/truth/claims.rs"]
mod claims;
#[path = "../tests/truth/double.rs"]
mod double;
#[path = "../tests/truth/light.rs"]
#[allow(dead_code, reason = "tests use the rest")]
mod light;
#[path = "../tests/truth/sampler.rs"]
#[allow(dead_code, reason = "tests use the rest")]
mod sampler;

use antumbra::scene::{Scene, named};
use claims::{Check, Tally, check};
use rayon::prelude::*;
use std::error::Error;
use std::process::ExitCode;

/// Hits that one thread looks for at a time, from a seed of their own.
const CHUNK: usize = 5;

fn main() -> Result<ExitCode, Box<dyn Error>> {
    let mut of = Check { hits: 500, rays: 2000, each: 4, rectangles: 4000, ..Check::default() };
    let (mut threads, mut names) = (0, Vec::new());
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        if !argument.starts_with("--") {
            names.push(argument);
            continue;
        }
        let value = arguments.next().ok_or_else(|| format!("{argument} needs a number"))?;
        let number = value.parse().map_err(|_| format!("{argument}: `{value}` is no number"))?;
        match argument.as_str() {
            "--hits" => of.hits = number,
            "--rays" => of.rays = number,
            "--threads" => threads = number,
            "--rectangles" => of.rectangles = u32::try_from(number)?,
            "--seed" => of.seed = number as u64,
            _ => return Err(format!("{argument} is none of --hits, --rays, --rectangles, --threads, --seed").into()),
        }
    }
    if names.is_empty() {
        names = ["orthocircle", "chubs", "kusner", "mcmullen"].map(str::to_owned).to_vec();
    }
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
    println!(
        "| scene | light | tolerance | penumbra hits | claims | rays lit | dark | in the band | not judged | looked at again | wrong | open | evaluations first / second |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|---|---|");
    let mut wrong = Vec::new();
    for name in &names {
        let scene = named(name).ok_or_else(|| format!("there is no scene `{name}`"))??;
        for scale in [1.0, 4.0] {
            for parts in [255, 4096] {
                let of = Check { scale, width: 1.0 / f64::from(parts), ..of };
                let t = pool.install(|| in_chunks(name, &scene, of));
                let ratio = t.evaluations[0] as f64 / t.evaluations[1].max(1) as f64;
                println!(
                    "| {name} | {scale} x | 1/{parts} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {ratio:.1} |",
                    t.penumbrae,
                    t.claims,
                    t.lit,
                    t.dark,
                    t.undecided,
                    t.unclear,
                    t.again,
                    t.wrong.len(),
                    t.open
                );
                wrong.extend(t.wrong);
            }
        }
    }
    println!();
    println!("{} wrong", wrong.len());
    wrong.iter().for_each(|what| println!("{what}"));
    Ok(if wrong.is_empty() { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// The same numbers for any number of threads.
fn in_chunks(name: &str, scene: &Scene, of: Check) -> Tally {
    let chunks: Vec<usize> = (0..of.hits.div_ceil(CHUNK)).collect();
    let found = chunks.into_par_iter().map(|k| {
        let hits = CHUNK.min(of.hits - k * CHUNK);
        check(name, scene, Check { hits, seed: of.seed.wrapping_mul(1_000_003).wrapping_add(k as u64), ..of })
    });
    let mut tally = Tally::default();
    found.collect::<Vec<_>>().into_iter().for_each(|t| tally.add(t));
    tally
}
