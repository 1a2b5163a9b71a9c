//! First order against second order: evaluations and seconds of the shadow pass, in one run.
//! `cargo run --release -p antumbra --example penumbrae -- [SIZE] [paper|presets]`
//!
//! `paper`: the four scenes, the light as it is and four times as wide, tolerances from 1/255 to 1/65536. `presets`: every
//! preset at 1/255, and what the automatic choice makes of it. The counts are the same on every machine. Brackets of both
//! orders are compared pixel by pixel; disjoint ones would be a contradiction: the program then exits with 1.
use antumbra::render::{Frame, RenderSpec, Renderer, RunSpec, Stats};
use antumbra::scene::{PRESETS, Scene, preset};
use antumbra::shadow::Penumbra;
use std::error::Error;
use std::process::ExitCode;
use std::sync::Arc;
use std::time::Duration;

const TOLERANCES: [u32; 4] = [255, 1024, 4096, 65536];

fn main() -> Result<ExitCode, Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let size: usize = arguments.next().map_or(Ok(128), |text| text.parse())?;
    let apart = match arguments.next().as_deref() {
        None | Some("paper") => paper(size)?,
        Some("presets") => presets(size)?,
        Some(other) => return Err(format!("`{other}` is neither `paper` nor `presets`").into()),
    };
    println!();
    println!("{apart} disjoint brackets");
    Ok(if apart == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// Returns how many brackets of different orders are disjoint.
fn paper(size: usize) -> Result<usize, Box<dyn Error>> {
    println!(
        "| scene | light | tolerance | first: evaluations | open | seconds | second: evaluations | open | seconds |"
    );
    println!("|---|---|---|---|---|---|---|---|---|");
    let (mut apart, mut exponents) = (0, Vec::new());
    for row in &PRESETS[..4] {
        let scene = Arc::new(preset(row.name).ok_or("no such preset")??);
        for light_scale in [1.0, 4.0] {
            let light = if light_scale > 1.0 { "4 x" } else { "1 x" };
            let mut curve = Vec::new();
            for parts in TOLERANCES {
                let spec = RenderSpec {
                    width: size,
                    height: size,
                    light_scale,
                    tolerance: 1.0 / f64::from(parts),
                    ..RenderSpec::default()
                };
                let first = run(&scene, &spec, Penumbra::First)?;
                let second = run(&scene, &spec, Penumbra::Second)?;
                apart += disjoint(&first.0, &second.0);
                curve.push((f64::from(parts), second.1.shadow_evaluations as f64));
                println!(
                    "| {} | {light} | 1/{parts} | {} | {} |",
                    row.name,
                    columns(&first.1, true),
                    columns(&second.1, true)
                );
            }
            exponents.push((row.name, light, exponent(&curve)));
        }
    }
    println!();
    println!("Exponents of the cost of the second order against 1/tolerance:");
    for (name, light, exponent) in exponents {
        println!("{name}, light {light}: {exponent:.2}");
    }
    Ok(apart)
}

fn presets(size: usize) -> Result<usize, Box<dyn Error>> {
    println!("| scene | first: evaluations | open | second: evaluations | open | auto: evaluations | open |");
    println!("|---|---|---|---|---|---|---|");
    let mut apart = 0;
    for row in PRESETS {
        let scene = Arc::new(preset(row.name).ok_or("no such preset")??);
        let spec = RenderSpec { width: size, height: size, ..RenderSpec::default() };
        let first = run(&scene, &spec, Penumbra::First)?;
        let second = run(&scene, &spec, Penumbra::Second)?;
        let auto = run(&scene, &spec, Penumbra::Auto)?;
        apart += disjoint(&first.0, &second.0) + disjoint(&first.0, &auto.0);
        let [first, second, auto] = [first.1, second.1, auto.1].map(|stats| columns(&stats, false));
        println!("| {} | {first} | {second} | {auto} |", row.name);
    }
    Ok(apart)
}

fn run(scene: &Arc<Scene>, spec: &RenderSpec, penumbra: Penumbra) -> Result<(Frame, Stats), Box<dyn Error>> {
    let spec = RenderSpec { penumbra, ..spec.clone() };
    let mut renderer = Renderer::new(Arc::clone(scene), spec, RunSpec::default())?;
    while !renderer.refine(Duration::from_secs(60)) {}
    Ok((renderer.frame().clone(), renderer.stats()))
}

fn columns(stats: &Stats, seconds: bool) -> String {
    let counts = format!("{} | {}", stats.shadow_evaluations, stats.brackets_open);
    if seconds { format!("{counts} | {:.2}", stats.shadow_seconds) } else { counts }
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

/// e of "cost grows as (1 / tolerance)^e", between the ends.
fn exponent(curve: &[(f64, f64)]) -> f64 {
    let (first, last) = (curve[0], curve[curve.len() - 1]);
    core_math::log(last.1 / first.1) / core_math::log(last.0 / first.0)
}
