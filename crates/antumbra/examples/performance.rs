//! CPU time of the stages of whole certified pictures of the four surfaces of the paper, and how full the lanes of batches were:
//! `cargo run --release -p antumbra --example performance -- [SIZE] [RUNS] [THREADS]`.
//!
//! Times are CPU seconds of the process (medians of interleaved runs, least and most in brackets), one thread; the last columns are the
//! wall time with one thread over that with two, four and so on, up to so many threads (2). A Markdown table.
use antumbra::render::{RenderSpec, Renderer, RunSpec, Stats};
use antumbra::scene::preset;
use cpu_time::ProcessTime;
use std::process::ExitCode;
use std::sync::Arc;
use std::time::{Duration, Instant};

const SCENES: [&str; 4] = ["orthocircle", "chubs", "kusner", "mcmullen"];

/// Seconds of CPU for surfaces, for light, and for all; seconds of the clock for all.
type Times = [f64; 4];

fn picture(name: &str, size: usize, threads: usize) -> (Times, Stats) {
    let scene = Arc::new(preset(name).expect("a preset").expect("a preset"));
    let spec = RenderSpec { width: size, height: size, ..RenderSpec::default() };
    let (clock, all) = (Instant::now(), ProcessTime::now());
    let mut renderer = Renderer::new(scene, spec, RunSpec { threads: Some(threads) }).expect("a valid spec");
    renderer.color_late();
    let (mut surfaces, mut light) = (0.0, 0.0);
    // Alone, a thread stops after every tile, so that each is booked on its pass; several would wait for each other.
    let budget = if threads == 1 { Duration::ZERO } else { Duration::from_secs(1) };
    loop {
        let (stage, _, _) = renderer.activity();
        let begin = ProcessTime::now();
        let done = renderer.refine(budget);
        let seconds = begin.elapsed().as_secs_f64();
        match stage.split(':').next() {
            Some("surface") => surfaces += seconds,
            Some("light") => light += seconds,
            _ => {}
        }
        if done {
            break;
        }
    }
    ([surfaces, light, all.elapsed().as_secs_f64(), clock.elapsed().as_secs_f64()], renderer.stats())
}

fn spread(times: &[Times], which: usize) -> String {
    let mut column: Vec<f64> = times.iter().map(|t| 1e3 * t[which]).collect();
    column.sort_by(f64::total_cmp);
    format!("{:.0} ({:.0}..{:.0})", median(times, which) * 1e3, column[0], column[column.len() - 1])
}

fn median(times: &[Times], which: usize) -> f64 {
    let mut column: Vec<f64> = times.iter().map(|t| t[which]).collect();
    column.sort_by(f64::total_cmp);
    column[column.len() / 2]
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let number = |i: usize, default: usize| arguments.get(i).map_or(Ok(default), |text| text.parse());
    let (Ok(size), Ok(runs @ 1..), Ok(most)) = (number(0, 512), number(1, 5), number(2, 2)) else {
        eprintln!("usage: performance [SIZE] [RUNS] [THREADS], whole numbers");
        return ExitCode::from(2);
    };
    let threads: Vec<usize> = (0..usize::BITS).map(|k| 1 << k).take_while(|t| *t <= most.max(1)).collect();
    let columns: String = threads[1..].iter().map(|t| format!(" {t} threads |")).collect();
    println!("| {size} x {size} | surfaces, ms | light, ms | whole picture, ms | evaluations | lanes full |{columns}");
    println!("|---|---|---|---|---|---|{}", "---|".repeat(threads.len() - 1));
    for name in SCENES {
        let (mut times, mut stats) = (vec![vec![]; threads.len()], Stats::default());
        for _ in 0..runs {
            for (threads, times) in threads.iter().zip(&mut times) {
                let (taken, found) = picture(name, size, *threads);
                times.push(taken);
                stats = found;
            }
        }
        let one = &times[0];
        let faster: String =
            times[1..].iter().map(|times| format!(" {:.2} |", median(one, 3) / median(times, 3))).collect();
        println!(
            "| {name} | {} | {} | {} | {} | {:.0} % |{faster}",
            spread(one, 0),
            spread(one, 1),
            spread(one, 2),
            stats.primary_evaluations + stats.shadow_evaluations,
            100.0 * stats.batched_questions as f64 / stats.batch_lanes.max(1) as f64,
        );
    }
    ExitCode::SUCCESS
}
