//! First order against second order: evaluations and seconds of the shadow pass, in one run.
//! `cargo run --release -p antumbra --example penumbrae -- [paper|gallery] [--size 128] [--rectangles 4000] [--first-rectangles 4000] [--jobs N] [SCENE ...]`
//!
//! `paper`: the four scenes, the light as it is and four times as wide, tolerances from 1/255 to 1/65536, both orders, and the
//! exponents. `gallery`: every preset and every surface of the gallery at 1/255, both orders and the automatic choice. Names of
//! scenes choose among them.
//!
//! Rows are shown on standard error as they come, and in order on standard output at the end.
//!
//! Every picture is drawn by one thread; `--jobs` of them are drawn at a time (by default one per processor), so that seconds are
//! those of one thread, undisturbed if there is a processor for each. `--first-rectangles` caps what the first order may
//! spend on one hit: brackets that stay open are counted. The counts are the same on every machine. Brackets of both
//! orders are compared pixel by pixel; disjoint ones would be a contradiction: the program then exits with 1.
use antumbra::render::{Frame, RenderSpec, Renderer, RunSpec, Stats};
use antumbra::scene::{PRESETS, Scene, named, names};
use antumbra::shadow::Penumbra;
use rayon::prelude::*;
use std::error::Error;
use std::process::ExitCode;
use std::sync::Arc;
use std::time::Duration;

type Failure = Box<dyn Error + Send + Sync>;

const TOLERANCES: [u32; 4] = [255, 1024, 4096, 65536];

/// What to draw.
struct Options {
    gallery: bool,
    size: usize,
    rectangles: u32,
    first_rectangles: u32,
    names: Vec<String>,
}

fn main() -> Result<ExitCode, Failure> {
    let mut options =
        Options { gallery: false, size: 128, rectangles: 4000, first_rectangles: 4000, names: Vec::new() };
    let mut jobs = 0;
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "paper" => options.gallery = false,
            "gallery" => options.gallery = true,
            option if option.starts_with("--") => {
                let value = arguments.next().ok_or_else(|| format!("{option} needs a number"))?;
                let number: u32 = value.parse().map_err(|_| format!("{option}: `{value}` is no number"))?;
                match option {
                    "--size" => options.size = number as usize,
                    "--rectangles" => options.rectangles = number,
                    "--first-rectangles" => options.first_rectangles = number,
                    "--jobs" => jobs = number as usize,
                    _ => {
                        return Err(
                            format!("{option} is none of --size, --rectangles, --first-rectangles, --jobs").into()
                        );
                    }
                }
            }
            name => options.names.push(name.to_owned()),
        }
    }
    let pool = rayon::ThreadPoolBuilder::new().num_threads(jobs).build()?;
    let apart = pool.install(|| if options.gallery { gallery(&options) } else { paper(&options) })?;
    println!();
    println!("{apart} disjoint brackets");
    Ok(if apart == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

impl Options {
    fn scenes(&self, all: impl Iterator<Item = &'static str>) -> Result<Vec<(String, Arc<Scene>)>, Failure> {
        let names = if self.names.is_empty() { all.map(str::to_owned).collect() } else { self.names.clone() };
        let load = |name: String| {
            let scene = named(&name).ok_or_else(|| format!("there is no scene `{name}`"))??;
            Ok((name, Arc::new(scene)))
        };
        names.into_iter().map(load).collect()
    }

    fn run(&self, scene: &Arc<Scene>, spec: &RenderSpec, penumbra: Penumbra) -> Result<(Frame, Stats), Failure> {
        let rectangles = if penumbra == Penumbra::First { self.first_rectangles } else { self.rectangles };
        let spec = RenderSpec { penumbra, rectangles, width: self.size, height: self.size, ..spec.clone() };
        let mut renderer = Renderer::new(Arc::clone(scene), spec, RunSpec { threads: Some(1) })?;
        while !renderer.refine(Duration::from_secs(60)) {}
        Ok((renderer.frame().clone(), renderer.stats()))
    }
}

/// Returns how many brackets of different orders are disjoint.
fn paper(options: &Options) -> Result<usize, Failure> {
    let scenes = options.scenes(PRESETS[..4].iter().map(|p| p.name))?;
    let mut wanted = Vec::new();
    for (name, scene) in &scenes {
        for light in [1.0, 4.0] {
            wanted.extend(TOLERANCES.map(|parts| (name.as_str(), scene, light, parts)));
        }
    }
    let row = |&(name, scene, light_scale, parts): &(&str, &Arc<Scene>, f64, u32)| {
        let tolerance = 1.0 / f64::from(parts);
        let spec = RenderSpec { light_scale, tolerance, ..RenderSpec::default() };
        let first = options.run(scene, &spec, Penumbra::First)?;
        let second = options.run(scene, &spec, Penumbra::Second)?;
        let line = format!(
            "| {name} | {light_scale} x | 1/{parts} | {} | {} | {:.1} | {:.1} | {} |",
            columns(&first.1),
            columns(&second.1),
            first.1.shadow_evaluations as f64 / second.1.shadow_evaluations as f64,
            first.1.shadow_seconds / second.1.shadow_seconds,
            second.1.undecided(),
        );
        eprintln!("{line}");
        Ok((line, disjoint(&first.0, &second.0), second.1.shadow_evaluations as f64))
    };
    let rows: Vec<(String, usize, f64)> = wanted.par_iter().map(row).collect::<Result<_, Failure>>()?;
    println!(
        "| scene | light | tolerance | first: evaluations | open | seconds | second: evaluations | open | seconds | first / second: evaluations | seconds | undecided pixels |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|---|");
    rows.iter().for_each(|(line, ..)| println!("{line}"));
    println!();
    println!("Exponents of the evaluations of the second order against 1/tolerance:");
    for (wanted, rows) in wanted.chunks(TOLERANCES.len()).zip(rows.chunks(TOLERANCES.len())) {
        let (name, _, light, first) = wanted[0];
        let (last, count) = (wanted[wanted.len() - 1].3, rows.len());
        let growth = core_math::log(rows[count - 1].2 / rows[0].2);
        println!("{name}, light {light} x: {:.2}", growth / core_math::log(f64::from(last) / f64::from(first)));
    }
    Ok(rows.iter().map(|(_, apart, _)| apart).sum())
}

fn gallery(options: &Options) -> Result<usize, Failure> {
    let scenes = options.scenes(names())?;
    let row = |(name, scene): &(String, Arc<Scene>)| {
        let run = |penumbra| options.run(scene, &RenderSpec::default(), penumbra);
        let (first, second, auto) = (run(Penumbra::First)?, run(Penumbra::Second)?, run(Penumbra::Auto)?);
        let gain = first.1.shadow_seconds / auto.1.shadow_seconds;
        let [a, b, c] = [&first.1, &second.1, &auto.1].map(columns);
        let loses = if gain < 0.9 { "loses" } else { "" };
        let line = format!("| {name} | {a} | {b} | {c} | {gain:.1} | {loses} |");
        eprintln!("{line}");
        Ok((line, disjoint(&first.0, &second.0) + disjoint(&first.0, &auto.0)))
    };
    let rows: Vec<(String, usize)> = scenes.par_iter().map(row).collect::<Result<_, Failure>>()?;
    println!(
        "| scene | first: evaluations | open | seconds | second: evaluations | open | seconds | auto: evaluations | open | seconds | first / auto: seconds | |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|---|");
    rows.iter().for_each(|(line, _)| println!("{line}"));
    Ok(rows.iter().map(|(_, apart)| apart).sum())
}

fn columns(stats: &Stats) -> String {
    format!("{} | {} | {:.3}", stats.shadow_evaluations, stats.brackets_open, stats.shadow_seconds)
}

fn disjoint(a: &Frame, b: &Frame) -> usize {
    let lights = a.lights.iter().zip(&b.lights);
    lights
        .map(|(a, b)| {
            let (lo, hi) = (a.visible_lo.iter().zip(&b.visible_hi), b.visible_lo.iter().zip(&a.visible_hi));
            lo.zip(hi).filter(|((a_lo, b_hi), (b_lo, a_hi))| a_lo > b_hi || b_lo > a_hi).count()
        })
        .sum()
}
