//! What other forms of formulas bring: `cargo run --release -p antumbra --example forms -- [SIZE] [NAME...]`.
use antumbra::expr::Formula;
use antumbra::render::{RenderSpec, Renderer, RunSpec};
use antumbra::scene::{Object, Scene, named, names};
use antumbra::tape::Tape;
use cpu_time::ProcessTime;
use std::process::ExitCode;
use std::sync::Arc;
use std::time::Duration;

fn picture(scene: &Scene, size: usize) -> (u64, f64) {
    let spec = RenderSpec { width: size, height: size, ..RenderSpec::default() };
    let begin = ProcessTime::now();
    let mut renderer =
        Renderer::new(Arc::new(scene.clone()), spec, RunSpec { threads: Some(1) }).expect("a valid spec");
    while !renderer.refine(Duration::from_secs(1)) {}
    let stats = renderer.stats();
    ((stats.primary_evaluations + stats.shadow_evaluations) as u64, begin.elapsed().as_secs_f64())
}

fn operations(object: &Object) -> usize {
    object.surface.operations()
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let size = arguments.first().and_then(|a| a.parse().ok()).unwrap_or(64);
    println!(
        "| surface | form | text | compiled | chosen | evaluations | chosen | ratio | ms written | ms chosen | ratio | parse |"
    );
    for name in names() {
        if arguments.len() > 1 && !arguments[1..].iter().any(|n| n == name) {
            continue;
        }
        let scene = named(name).expect("a name").expect("a scene");
        let o = &scene.objects[0];
        let begin = ProcessTime::now();
        let o2 = o.clone().with_clip(o.clip());
        let parse = begin.elapsed().as_secs_f64();
        drop(o2);
        let raw = Tape::compile(&Formula::parse_as_written(&o.text).expect("parsed")).expect("short");
        let mut plain = scene.clone();
        plain.objects = scene.objects.iter().cloned().map(Object::as_written).collect();
        if plain.objects.iter().zip(&scene.objects).all(|(a, b)| a.writing() == b.writing()) {
            println!(
                "| {name} | {} | {} | {} | | | | | {:.1} |",
                o.writing(),
                raw.clauses().len(),
                operations(&plain.objects[0]),
                parse * 1e3
            );
            continue;
        }
        let mut times = [vec![], vec![]];
        let mut counts = [0; 2];
        for _ in 0..5 {
            for (k, s) in [&plain, &scene].into_iter().enumerate() {
                let (count, time) = picture(s, size);
                times[k].push(time);
                counts[k] = count;
            }
        }
        let times = times.map(|mut t| {
            t.sort_by(f64::total_cmp);
            t[t.len() / 2] * 1e3
        });
        println!(
            "| {name} | {} | {} | {} | {} | {} | {} | {:.2} | {:.1} | {:.1} | {:.2} | {:.1}",
            o.writing(),
            raw.clauses().len(),
            operations(&plain.objects[0]),
            operations(o),
            counts[0],
            counts[1],
            counts[1] as f64 / counts[0] as f64,
            times[0],
            times[1],
            times[1] / times[0],
            parse * 1e3
        );
    }
    ExitCode::SUCCESS
}
