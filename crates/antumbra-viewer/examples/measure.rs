//! How long one waits: from a drag to the first picture, to the proof, and for a frame of the window meanwhile.
//!
//! `cargo run --release -p antumbra-viewer --example measure -- [SIZE] [SCENE ...]`
use antumbra::{
    render::{Method, RenderSpec, RunSpec},
    scene::{Orbit, file_named},
};
use antumbra_viewer::{
    host::{Found, Host, Place, SharedHost},
    ui::App,
    worker::{Event, Image, Job, Worker},
};
use eframe::egui;
use egui_kittest::Harness;
use std::{
    error::Error,
    path::Path,
    sync::Arc,
    time::{Duration, Instant},
};

/// Drags of which the median is taken.
const DRAGS: u64 = 15;
/// Time between two steps of a hand.
const STEP: Duration = Duration::from_millis(16);

fn main() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let size = words.first().map_or(Ok(512), |w| w.parse::<usize>())?;
    let scenes: Vec<&str> = match words.get(1..) {
        Some(scenes) if !scenes.is_empty() => scenes.iter().map(String::as_str).collect(),
        _ => vec!["orthocircle", "chubs", "kusner", "mcmullen"],
    };
    let threads = std::thread::available_parallelism()?;
    println!(
        "{size} x {size}, certified, tolerance 1/255, {threads} threads; medians of {DRAGS}, in brackets the worst\n"
    );
    println!(
        "| scene | one step to its picture | its size | hand in motion: pictures per second, latency | all proved after | window frame, worst |"
    );
    println!("|---|---|---|---|---|---|");
    for scene in scenes {
        let steps = steps(scene, size)?;
        let motion = motion(scene, size)?;
        let frames = frames(scene)?;
        println!(
            "| {scene} | {:.0} ms ({:.0}) | {} x {} | {:.0}, {:.0} ms ({:.0}) | {:.2} s | {:.1} ms of {} |",
            1e3 * steps.median,
            1e3 * steps.worst,
            steps.size[0],
            steps.size[1],
            motion.rate,
            1e3 * motion.median,
            1e3 * motion.worst,
            steps.proof,
            1e3 * frames.0,
            frames.1,
        );
    }
    Ok(())
}

/// Jobs of a camera that turns.
struct Turning {
    job: Job,
    orbit: Orbit,
}

impl Turning {
    fn new(name: &str, size: usize) -> Result<Self, Box<dyn Error>> {
        let file = file_named(name).ok_or("there is no scene of that name")??;
        let orbit = Orbit::of(&file.scene(name)?.view);
        let methods = vec![Method::Certified];
        let job = Job { revision: 0, name: name.to_owned(), file, size: [size; 2], methods, overlay: None };
        Ok(Self { job, orbit })
    }

    fn next(&mut self) -> Job {
        self.orbit = self.orbit.turned(0.02, 0.0);
        self.job.revision += 1;
        self.job.file.camera = Some(self.orbit.entry());
        self.job.clone()
    }
}

struct Steps {
    median: f64,
    worst: f64,
    size: [usize; 2],
    proof: f64,
}

fn image(worker: &Worker, revision: u64) -> Result<Image, Box<dyn Error>> {
    loop {
        match worker.wait(Duration::from_secs(600)).ok_or("no answer")? {
            Event::Image(image) if image.revision >= revision => return Ok(*image),
            Event::Refused { refusal, .. } => return Err(refusal.message.into()),
            _ => {}
        }
    }
}

/// One step of a hand, its first picture, then all of the proof.
fn steps(name: &str, size: usize) -> Result<Steps, Box<dyn Error>> {
    let worker = Worker::start(RunSpec::default(), || {})?;
    let mut turning = Turning::new(name, size)?;
    let (mut times, mut last) = (vec![], [0; 2]);
    // The first few find the pace.
    for k in 0..DRAGS + 6 {
        let job = turning.next();
        let (revision, begun) = (job.revision, Instant::now());
        worker.submit(job);
        let first = image(&worker, revision)?;
        if k >= 6 {
            times.push(begun.elapsed().as_secs_f64());
            last = first.size;
        }
    }
    let proof = Instant::now();
    let revision = turning.job.revision;
    let mut job = turning.next();
    job.revision = revision + 1;
    worker.submit(job);
    loop {
        match worker.wait(Duration::from_secs(600)).ok_or("no answer")? {
            Event::Done { revision: r, .. } if r == revision + 1 => break,
            _ => {}
        }
    }
    let proof = proof.elapsed().as_secs_f64();
    times.sort_by(f64::total_cmp);
    Ok(Steps { median: times[times.len() / 2], worst: times[times.len() - 1], size: last, proof })
}

struct Motion {
    rate: f64,
    median: f64,
    worst: f64,
}

/// A hand in motion for some seconds: a new job every 16 ms, whatever has come of those before.
fn motion(name: &str, size: usize) -> Result<Motion, Box<dyn Error>> {
    let worker = Worker::start(RunSpec::default(), || {})?;
    let mut turning = Turning::new(name, size)?;
    let begun = Instant::now();
    let (mut asked, mut times) = (vec![], vec![]);
    let mut next = begun;
    while begun.elapsed() < Duration::from_secs(4) {
        if Instant::now() >= next {
            let job = turning.next();
            asked.push((job.revision, Instant::now()));
            worker.submit(job);
            next += STEP;
        }
        let left = next.saturating_duration_since(Instant::now());
        if let Some(Event::Image(image)) = worker.wait(left)
            && let Some((_, when)) = asked.iter().find(|(r, _)| *r == image.revision)
            && begun.elapsed() > Duration::from_secs(1)
        {
            times.push(when.elapsed().as_secs_f64());
        }
    }
    if times.is_empty() {
        return Err("no picture while the hand was in motion".into());
    }
    let rate = times.len() as f64 / 3.0;
    times.sort_by(f64::total_cmp);
    Ok(Motion { rate, median: times[times.len() / 2], worst: times[times.len() - 1] })
}

/// Nobody saves anything here.
struct Nothing;

impl Host for Nothing {
    fn find(&self, text: &str) -> Result<Found, String> {
        Err(text.to_owned())
    }

    fn reserve(&self, path: &Path) -> Result<Box<dyn Place>, String> {
        Err(path.display().to_string())
    }
}

/// The longest of the frames of the window while it draws, and their number: panels, textures and triangles, without the GPU.
fn frames(name: &str) -> Result<(f64, u32), Box<dyn Error>> {
    let file = file_named(name).ok_or("there is no scene of that name")??;
    let start = Found { name: name.to_owned(), file, own: false };
    let mut window = Harness::builder().with_size([1280.0, 820.0]).build_eframe(|creation| {
        let host: SharedHost = Arc::new(Nothing);
        App::new(&creation.egui_ctx, host, RunSpec::default(), start).expect("threads start")
    });
    let begun = Instant::now();
    let (mut longest, mut count) = (0.0_f64, 0);
    while begun.elapsed() < Duration::from_secs(6) {
        // A hand turns the picture half of the time.
        let angle = begun.elapsed().as_secs_f32() * 3.0;
        let at = egui::pos2(640.0 + 120.0 * angle.cos(), 400.0 + 60.0 * angle.sin());
        let down = begun.elapsed().as_secs().is_multiple_of(2);
        window.event(egui::Event::PointerMoved(at));
        let modifiers = egui::Modifiers::NONE;
        window.event(egui::Event::PointerButton {
            pos: at,
            button: egui::PointerButton::Primary,
            pressed: down,
            modifiers,
        });
        let frame = Instant::now();
        window.step();
        let output = window.output();
        let triangles = window.ctx.tessellate(output.shapes.clone(), output.pixels_per_point);
        let seconds = frame.elapsed().as_secs_f64();
        std::hint::black_box(triangles);
        count += 1;
        // Fonts are loaded in the first ones.
        if count > 5 {
            longest = longest.max(seconds);
        }
        std::thread::sleep(STEP.saturating_sub(frame.elapsed()));
    }
    assert!(window.state().meter().timings().answers > 0, "something was drawn: {:?}", RenderSpec::default().width);
    Ok((longest, count))
}
