//! What rewriting brings, surface by surface: `cargo run --release -p antumbra --example forms -- [SIZE] [RUNS] [NAME...]`.
//!
//! Operations (without coordinates and constants) of the formula as a tree, with equal parts shared, simplified for drawing, and in the form in
//! which it is drawn; where that is another form than the written one, evaluations of a certified picture and CPU time (medians of interleaved
//! runs, one thread) in both. A Markdown table.
use antumbra::expr::{Formula, Node};
use antumbra::render::{RenderSpec, Renderer, RunSpec};
use antumbra::scene::{Object, Scene, named, names};
use antumbra::tape::{Op, Tape};
use cpu_time::ProcessTime;
use std::process::ExitCode;
use std::sync::Arc;
use std::time::Duration;

/// Evaluations, and seconds of CPU.
fn picture(scene: &Scene, size: usize) -> (u64, f64) {
    let scene = Arc::new(scene.clone());
    let spec = RenderSpec { width: size, height: size, ..RenderSpec::default() };
    let begin = ProcessTime::now();
    let mut renderer = Renderer::new(scene, spec, RunSpec { threads: Some(1) }).expect("a valid spec");
    while !renderer.refine(Duration::from_secs(1)) {}
    let stats = renderer.stats();
    ((stats.primary_evaluations + stats.shadow_evaluations), begin.elapsed().as_secs_f64())
}

/// Operations of a formula if nothing is shared.
fn of_tree(formula: &Formula) -> u64 {
    let mut sizes: Vec<u64> = vec![];
    for node in formula.graph().nodes() {
        let children = node.children().map(|child| sizes[child.index()]);
        sizes.push(children.fold(u64::from(is_operation(node)), u64::saturating_add));
    }
    sizes[formula.root().index()]
}

fn is_operation(node: &Node) -> bool {
    node.children().next().is_some()
}

fn of_tape(tape: &Tape) -> usize {
    tape.clauses().iter().filter(|clause| !matches!(clause.op, Op::Constant(_) | Op::Axis(_))).count()
}

fn of_objects(scene: &Scene) -> usize {
    scene.objects.iter().filter_map(|o| o.surface.as_tape()).map(of_tape).sum()
}

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

fn main() -> ExitCode {
    let mut arguments = std::env::args().skip(1);
    let mut number = |default: usize| arguments.next().map_or(Ok(default), |text| text.parse());
    let (Ok(size @ 1..), Ok(runs @ 1..)) = (number(96), number(5)) else {
        eprintln!("usage: forms [SIZE] [RUNS] [NAME...], whole numbers");
        return ExitCode::from(2);
    };
    let wanted: Vec<String> = arguments.collect();
    let (mut all, mut changed) = (0, 0);
    println!(
        "| {size} x {size} | tree | shared | simplified | drawn | form | evaluations | drawn / simplified | CPU ms | drawn / simplified |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|");
    for name in names().filter(|name| wanted.is_empty() || wanted.iter().any(|w| w == name)) {
        let Some(Ok(scene)) = named(name) else { continue };
        let plain = Scene { objects: scene.objects.iter().cloned().map(Object::as_written).collect(), ..scene.clone() };
        let texts: Vec<Formula> =
            scene.objects.iter().filter_map(|o| Formula::parse_as_written(&o.text).ok()).collect();
        let tree: u64 = texts.iter().map(of_tree).sum();
        let shared: usize = texts.iter().map(|f| f.graph().nodes().iter().filter(|n| is_operation(n)).count()).sum();
        let writing = scene.objects.iter().map(|o| o.writing().to_string()).collect::<Vec<_>>();
        print!("| {name} | {tree} | {shared} | {} | {} | {} ", of_objects(&plain), of_objects(&scene), writing[0]);
        all += 1;
        if plain.objects.iter().zip(&scene.objects).all(|(a, b)| a.writing() == b.writing()) {
            println!("| | | | |");
            continue;
        }
        changed += 1;
        let (mut counts, mut times) = ([0; 2], [vec![], vec![]]);
        for _ in 0..runs {
            for (k, scene) in [&plain, &scene].into_iter().enumerate() {
                let (count, time) = picture(scene, size);
                counts[k] = count;
                times[k].push(1e3 * time);
            }
        }
        let [before, after] = times.map(median);
        println!(
            "| {} | {:.2} | {before:.0} | {:.2} |",
            counts[0],
            counts[1] as f64 / counts[0] as f64,
            after / before
        );
    }
    println!("\n{changed} of {all} scenes are drawn in another form than the written one.");
    ExitCode::SUCCESS
}
