//! Antumbra beside other programs, in one run, interleaved, one thread each: `cd bench && cargo run --release`.
//!
//! CPU seconds, the median of the runs with the least and the most; errors of the visible light against our brackets of 1/65536,
//! which are themselves held against plain sampling. Writes a Markdown table and a plot. A program that is not installed is
//! named as skipped.
//!
//! Debian's povray and libembree-dev are found if they are installed; Fidget and inari come from crates.io.
#[path = "../../crates/antumbra/tests/truth/double.rs"]
mod double;
mod embree;
mod fidget;
mod intervals;
#[allow(dead_code, reason = "tests use the rest")]
#[path = "../../crates/antumbra/tests/truth/light.rs"]
mod light;
mod picture;
mod plot;
mod povray;
mod report;
#[allow(dead_code, reason = "tests use the rest")]
#[path = "../../crates/antumbra/tests/truth/sampler.rs"]
mod sampler;
mod surfaces;

use clap::Parser;
use picture::{Reference, TOLERANCES, certified, rays, scene};
use report::{Against, Row};
use std::path::PathBuf;
use std::process::ExitCode;
use surfaces::SURFACES;

/// Why there is nothing to compare with.
#[derive(Clone, Debug)]
pub(crate) struct Skipped(pub(crate) String);

/// Measures Antumbra beside other programs.
#[derive(Parser)]
struct Arguments {
    /// Pixels along each side; Fidget takes as many voxels along each side.
    #[arg(long, default_value_t = 512)]
    size: usize,
    /// Interleaved runs.
    #[arg(long, default_value_t = 5, value_parser = clap::value_parser!(u32).range(1..))]
    runs: u32,
    /// Where to write the table; a plot is written beside it, as .svg.
    #[arg(long, default_value = "bench.md")]
    output: PathBuf,
    /// Surfaces: orthocircle, chubs, kusner, mcmullen; all of them if none is named.
    surfaces: Vec<String>,
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    if let Some(name) = arguments.surfaces.iter().find(|name| SURFACES.iter().all(|s| s.name != **name)) {
        eprintln!("there is no surface `{name}` here: orthocircle, chubs, kusner or mcmullen");
        return ExitCode::from(2);
    }
    let chosen =
        SURFACES.iter().filter(|s| arguments.surfaces.is_empty() || arguments.surfaces.iter().any(|n| n == s.name));
    let mut rows = Vec::new();
    for surface in chosen {
        eprintln!("{} ...", surface.name);
        rows.push(measure(surface, &arguments));
    }
    let table = report::table(&rows, arguments.size, arguments.runs);
    println!("{table}");
    let plot = arguments.output.with_extension("svg");
    let written = std::fs::write(&arguments.output, &table).map_err(|e| e.to_string());
    match written.and_then(|()| plot::write(&rows, &plot)) {
        Ok(()) => {
            eprintln!("written: {} and {}", arguments.output.display(), plot.display());
            ExitCode::SUCCESS
        }
        Err(e) => {
            eprintln!("{}: {e}", arguments.output.display());
            ExitCode::FAILURE
        }
    }
}

/// All programs on one surface.
fn measure(surface: &surfaces::Surface, arguments: &Arguments) -> Row {
    let (size, scene) = (arguments.size, scene(surface));
    let reference = Reference::of(&scene, size);
    let rays = rays(&scene, size);
    let mut row = Row::new(surface.name, reference.sampled(&scene, 40, 64));
    // Errors do not change from run to run: which of our tolerances are as good as the others?
    let ladder: Vec<_> = TOLERANCES.map(|t| (t, reference.errors_of(&certified(&scene, size, t).0))).into();
    let equal = |rms: f64| ladder.iter().copied().find(|(_, e)| e.rms <= rms).unwrap_or(ladder[ladder.len() - 1]);
    for run in 0..arguments.runs {
        let (frame, ours) = certified(&scene, size, TOLERANCES[2]);
        row.surfaces.push(ours.surfaces);
        row.light.push(ours.light);
        row.whole.push(ours.whole);
        if run == 0 {
            row.errors = Some(reference.errors_of(&frame));
        }
        row.fidget.push(fidget::height_map(surface, &scene, size as u32));
        match povray::run(surface, &scene, size) {
            Ok((seconds, picture)) => {
                let errors = reference.errors(|i| picture[i], |i| reference.facing(i));
                let against = row.povray.get_or_insert_with(|| Ok(Against::new(errors, equal(errors.rms))));
                if let Ok(against) = against {
                    against.theirs.push(seconds);
                    against.ours.push(certified(&scene, size, against.tolerance).1.whole);
                }
            }
            Err(skipped) => row.povray = Some(Err(skipped)),
        }
        match embree::run(surface, &rays, &scene.lights[0].rect) {
            Ok(mesh) => {
                let errors = reference.errors(|i| f64::from(mesh.visible[i]), |_| 1.0);
                let against = row.embree.get_or_insert_with(|| Ok(Against::new(errors, equal(errors.rms))));
                if let Ok(against) = against {
                    against.theirs.push(mesh.rays);
                    against.ours.push(certified(&scene, size, against.tolerance).1.whole);
                }
                row.mesh.push(mesh.mesh);
                row.hierarchy.push(mesh.hierarchy);
            }
            Err(skipped) => row.embree = Some(Err(skipped)),
        }
        for (times, ns) in row.intervals.iter_mut().zip(intervals::run(surface)) {
            times.push(ns);
        }
    }
    row
}
