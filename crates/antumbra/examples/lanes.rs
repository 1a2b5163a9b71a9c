//! Nanoseconds per question and lane of batches, on every level of this machine, beside the same questions one by one:
//! `cargo run --release -p antumbra --example lanes`.
//!
//! Each question is a piece of a ray or frustum of the picture's camera in, and an enclosure out: the lanes are filled and read.
//! A second table has the tape alone, coordinates included: what each of several more runs on the same lanes takes.
//! Thread CPU time, the median of several interleaved runs; Markdown tables.
use antumbra::eval::{FanPiece, Gradient, Inclusion, RayPiece, Workspace};
use antumbra::expr::Formula;
use antumbra::geom::{Box3, Film};
use antumbra::scene::{PRESETS, Scene, preset};
use antumbra::tape::Tape;
use antumbra_interval::Interval;
use antumbra_interval::affine::{Affine, Dual};
use antumbra_interval::lanes::Level;
use cpu_time::ThreadTime;
use std::hint::black_box;

/// Questions of one run.
const QUESTIONS: usize = 4096;
/// Runs of which the median is shown.
const RUNS: usize = 15;
/// Runs of the tape on the same lanes, by which it is timed alone.
const AGAIN: usize = 8;

/// The questions of a scene: neighbouring pixels, each at some depth.
struct Questions {
    rays: Vec<RayPiece>,
    points: Vec<RayPiece>,
    fans: Vec<FanPiece>,
    regions: Vec<Box3>,
}

/// A field of sources along a spiral.
fn sources(n: usize) -> String {
    let source = |k: usize| {
        let (turn, height) = (2.4 * k as f64, (2 * k + 1) as f64 / n as f64 - 1.0);
        let radius = (1.0 - height * height).sqrt();
        let [x, y, z] = [radius * core_math::cos(turn), radius * core_math::sin(turn), height];
        format!("0.1/((x - ({x:.3}))^2 + (y - ({y:.3}))^2 + (z - ({z:.3}))^2 + 0.01)")
    };
    format!("1 - ({}) = 0", (0..n).map(source).collect::<Vec<_>>().join(" + "))
}

fn questions(scene: &Scene) -> Questions {
    let film = Film { camera: scene.view.camera(1.0), width: 512, height: 512 };
    let distance = (scene.view.target - film.camera.eye).length();
    let pixel = |k: usize| (200 + k % 64, 200 + k / 64);
    let at = |k: usize| distance * (0.9 + 0.2 * (k * 37 % 101) as f64 / 101.0);
    let piece = |k: usize| Interval::new(at(k), at(k) * 1.003);
    let ray = |k: usize| film.ray(pixel(k).0, pixel(k).1);
    let fan = |k: usize| film.fan(pixel(k).0..pixel(k).0 + 1, pixel(k).1..pixel(k).1 + 1);
    let points = (0..QUESTIONS).map(|k| RayPiece { ray: ray(k), t: Interval::point(at(k)) });
    Questions {
        rays: (0..QUESTIONS).map(|k| RayPiece { ray: ray(k), t: piece(k) }).collect(),
        fans: (0..QUESTIONS).map(|k| FanPiece { fan: fan(k), t: piece(k) }).collect(),
        regions: points.clone().map(|p| p.region().mid().to_box()).collect(),
        points: points.collect(),
    }
}

/// Asks all questions in batches of `n`; in the order interval, affine, dual, gradient.
fn ask(tape: &Tape, form: usize, q: &Questions, n: usize, work: &mut Workspace) {
    let mut ranges = [Interval::ZERO; 64];
    let mut forms = [Affine::<3>::ZERO; 64];
    let mut duals = [Dual { value: Affine::<1>::ZERO, derivative: Affine::ZERO }; 64];
    let mut gradients = [Gradient { value: Interval::ZERO, partials: [Interval::ZERO; 3] }; 64];
    match form {
        0 => q.points.chunks_exact(n).for_each(|part| tape.ranges(part, &mut ranges[..n], work)),
        1 => q.fans.chunks_exact(n).for_each(|part| tape.beams(part, &mut forms[..n], work)),
        2 => q.rays.chunks_exact(n).for_each(|part| tape.rays(part, &mut duals[..n], work)),
        _ => q.regions.chunks_exact(n).for_each(|part| tape.gradients(part, &mut gradients[..n], work)),
    }
    black_box((&ranges, &forms, &duals, &gradients));
}

/// Nanoseconds per question of one pass over all.
fn time(tape: &Tape, form: usize, q: &Questions, n: usize, work: &mut Workspace) -> f64 {
    let begin = ThreadTime::now();
    ask(tape, form, q, n, work);
    begin.elapsed().as_secs_f64() * 1e9 / QUESTIONS as f64
}

/// A row of a table: medians.
fn row(name: &str, times: Vec<Vec<f64>>) -> String {
    let cell = |mut times: Vec<f64>| {
        times.sort_by(f64::total_cmp);
        format!(" {:.1} |", times[RUNS / 2])
    };
    format!("| {name} |{}\n", times.into_iter().map(cell).collect::<String>())
}

fn main() {
    let widths = [1, 8, 16, 32, 64];
    let mut work: Vec<(String, Workspace, &[usize])> = vec![("one by one".into(), Workspace::default(), &widths[..1])];
    for level in Level::all() {
        let name = format!("{level:?}");
        let name = name.split('(').next().unwrap_or_default().to_owned();
        work.push((name, Workspace::on(level), &widths[1..]));
    }
    let heads = work.iter().flat_map(|(name, _, widths)| widths.iter().map(move |n| format!("{name} {n}")));
    let heads = heads.collect::<Vec<_>>();
    let head = |heads: &[String]| format!("| | {} |\n|---|{}\n", heads.join(" | "), "---|".repeat(heads.len()));
    print!("With filling and reading the lanes:\n\n{}", head(&heads));
    let mut alone = head(&heads[1..]);
    let field = Scene::from_formula(&sources(8)).expect("a field");
    let scenes = PRESETS[..4]
        .iter()
        .map(|p| (p.name, p.formula.to_owned(), preset(p.name).expect("a preset").expect("a preset")));
    for (surface, text, scene) in scenes.chain([("field of 8 sources", sources(8), field)]) {
        let formula = Formula::parse(&text).expect("a formula");
        let tape = Tape::compile(formula.surface().formula()).expect("a formula");
        let q = questions(&scene);
        for (form, name) in
            ["interval", "affine (t, i, j)", "affine value and derivative", "gradient"].iter().enumerate()
        {
            let mut whole = vec![Vec::with_capacity(RUNS); heads.len()];
            let mut more = vec![Vec::with_capacity(RUNS); heads.len() - 1];
            for _ in 0..RUNS {
                let mut column = 0;
                for (_, work, widths) in &mut work {
                    for &n in *widths {
                        let once = time(&tape, form, &q, n, work);
                        whole[column].push(once);
                        if column > 0 {
                            work.repeat_tapes(1 + AGAIN);
                            more[column - 1].push((time(&tape, form, &q, n, work) - once) / AGAIN as f64);
                            work.repeat_tapes(1);
                        }
                        column += 1;
                    }
                }
            }
            let name = format!("{surface} {name}");
            print!("{}", row(&name, whole));
            alone += &row(&name, more);
        }
    }
    print!("\nThe tape alone:\n\n{alone}");
}
