//! How time and memory grow with the picture, the light, the tolerance, the formula and the number of surfaces:
//! `cargo run --release -p antumbra --example scaling -- [resolution|light|tolerance|formula|surfaces]...`, by default all.
//!
//! CPU seconds of one thread, each picture in a process of its own, and the most memory that this process had at a time (Linux). Counts are
//! the same on every machine. Markdown tables.
use antumbra::render::{RenderSpec, Renderer, RunSpec};
use antumbra::scene::{Scene, SceneFile, named};
use cpu_time::ProcessTime;
use std::error::Error;
use std::fmt::Write;
use std::process::Command;
use std::sync::Arc;
use std::time::Duration;

const SCENES: [&str; 4] = ["orthocircle", "chubs", "kusner", "mcmullen"];
/// Bytes that a picture may take before it is drawn in bands, as `antumbra render` does.
const MEMORY: u64 = 1536 << 20;

type Failure = Box<dyn Error>;
type Table = fn() -> Result<(), Failure>;

/// One picture, as words for another process.
struct Picture {
    scene: String,
    size: usize,
    light: f64,
    tolerance: f64,
    floor: bool,
}

impl Picture {
    fn of(scene: impl Into<String>, size: usize) -> Self {
        Self { scene: scene.into(), size, light: 1.0, tolerance: 1.0 / 255.0, floor: false }
    }
}

/// What it took.
struct Took {
    seconds: f64,
    primary: f64,
    shadow: f64,
    megabytes: f64,
}

impl Took {
    fn evaluations(&self) -> f64 {
        self.primary + self.shadow
    }
}

/// Draws it in a process of its own.
fn measure(picture: &Picture) -> Result<Took, Failure> {
    let Picture { scene, size, light, tolerance, floor } = picture;
    let words = [size.to_string(), light.to_string(), tolerance.to_string(), floor.to_string()];
    let output = Command::new(std::env::current_exe()?).arg("one").arg(scene).args(words).output()?;
    let text = String::from_utf8(output.stdout)?;
    let numbers: Vec<f64> = text.split_whitespace().map(str::parse).collect::<Result<_, _>>()?;
    let [seconds, primary, shadow, megabytes] = numbers[..] else {
        return Err(format!("{scene}: {}", String::from_utf8_lossy(&output.stderr)).into());
    };
    Ok(Took { seconds, primary, shadow, megabytes })
}

/// The other process: a preset, a surface of the gallery, the text of a scene file, or a formula.
fn draw(words: &[String]) -> Result<(), Failure> {
    let [text, size, light, tolerance, floor] = words else { return Err("five words are wanted".into()) };
    let scene = match named(text) {
        Some(scene) => scene?,
        None if text.contains("[[") => SceneFile::parse(text)?.scene("scaling")?,
        None => Scene::from_formula(text)?,
    };
    let (side, lights) = (size.parse()?, scene.lights.len());
    let spec = RenderSpec {
        width: side,
        height: side,
        light_scale: light.parse()?,
        tolerance: tolerance.parse()?,
        floor: floor.parse()?,
        ..RenderSpec::default()
    };
    let begin = ProcessTime::now();
    let rows = if Renderer::bytes(side, side, lights) > MEMORY {
        (MEMORY / Renderer::bytes(side, 1, lights)) as usize / 2
    } else {
        side
    };
    let mut renderer = Renderer::in_bands(Arc::new(scene), spec, RunSpec { threads: Some(1) }, rows)?;
    renderer.color_late();
    loop {
        while !renderer.refine(Duration::from_secs(60)) {}
        if !renderer.next_band() {
            break;
        }
    }
    let (seconds, stats) = (begin.elapsed().as_secs_f64(), renderer.stats());
    let megabytes = most_memory().unwrap_or(f64::NAN);
    println!("{seconds} {} {} {megabytes}", stats.primary_evaluations, stats.shadow_evaluations);
    Ok(())
}

/// Most memory of this process so far, MB.
fn most_memory() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    Some(line.trim().trim_end_matches(" kB").parse::<f64>().ok()? * 1.024e-3)
}

fn resolution() -> Result<(), Failure> {
    println!(
        "\n| scene | size | CPU s | microseconds per pixel | evaluations per pixel | most memory, MB |\n|---|---|---|---|---|---|"
    );
    for scene in SCENES {
        for size in [256, 512, 1024, 2048, 4096] {
            let took = measure(&Picture::of(scene, size))?;
            let pixels = (size * size) as f64;
            println!(
                "| {scene} | {size} | {:.2} | {:.2} | {:.1} | {:.0} |",
                took.seconds,
                1e6 * took.seconds / pixels,
                took.evaluations() / pixels,
                took.megabytes
            );
        }
    }
    Ok(())
}

/// A table of CPU seconds and shadow evaluations: a row for each scene, a column for each picture.
fn columns<T: Copy>(
    title: &str,
    values: &[T],
    name: impl Fn(T) -> String,
    picture: impl Fn(&str, T) -> Picture,
) -> Result<(), Failure> {
    let heads: Vec<String> = values.iter().map(|v| name(*v)).collect();
    println!("\n| {title} | {} |\n|---|{}", heads.join(" | "), "---|".repeat(values.len()));
    for scene in SCENES {
        let mut row = String::new();
        for value in values {
            let took = measure(&picture(scene, *value))?;
            write!(row, " {:.2} s, {:.0} k |", took.seconds, took.shadow / 1e3)?;
        }
        println!("| {scene} |{row}");
    }
    Ok(())
}

fn light() -> Result<(), Failure> {
    columns(
        "light, times as wide",
        &[0.5, 1.0, 2.0, 4.0, 8.0],
        |k| k.to_string(),
        |scene, light| Picture { light, floor: true, ..Picture::of(scene, 256) },
    )
}

fn tolerance() -> Result<(), Failure> {
    let name = |level: u32| format!("1/{}", 1_u32 << level);
    columns("tolerance", &[4, 6, 8, 10, 12, 14, 16], name, |scene, level| Picture {
        tolerance: 1.0 / f64::from(1_u32 << level),
        ..Picture::of(scene, 256)
    })
}

/// Balls along a spiral, the same for every count up to their number.
fn balls(n: usize) -> impl Iterator<Item = [f64; 3]> {
    (0..n).map(move |k| {
        let (turn, height) = (2.4 * k as f64, (2 * k + 1) as f64 / n as f64 - 1.0);
        let radius = (1.0 - height * height).sqrt();
        [radius * core_math::cos(turn), radius * core_math::sin(turn), height].map(|c| (c * 1e3).round() / 1e3)
    })
}

fn heads(what: &str) {
    println!("\n| {what} | CPU s | evaluations per pixel | microseconds per evaluation |\n|---|---|---|---|");
}

fn row(what: usize, size: usize, took: &Took) {
    println!(
        "| {what} | {:.2} | {:.1} | {:.2} |",
        took.seconds,
        took.evaluations() / (size * size) as f64,
        1e6 * took.seconds / took.evaluations()
    );
}

/// One surface that is longer and longer: a field of so many sources that melt into each other, and the union of as many balls.
fn formula() -> Result<(), Failure> {
    const SIZE: usize = 256;
    for (what, join) in [("sources of one field", true), ("balls in one formula (min)", false)] {
        heads(what);
        for n in [1, 4, 16, 64, 256] {
            let r = 0.9 / (n as f64).sqrt();
            let ball = |[x, y, z]: [f64; 3]| {
                if join {
                    format!("{:.6}/((x - {x})^2 + (y - {y})^2 + (z - {z})^2 + 0.01)", r * r)
                } else {
                    format!("(x - {x})^2 + (y - {y})^2 + (z - {z})^2 - {:.6}", r * r)
                }
            };
            let all: Vec<String> = balls(n).map(ball).collect();
            let text = if join {
                format!("1 - ({}) = 0", all.join(" + "))
            } else {
                let union = all.into_iter().reduce(|a, b| format!("min({a}, {b})")).ok_or("no balls")?;
                format!("{union} = 0")
            };
            row(n, SIZE, &measure(&Picture::of(text, SIZE))?);
        }
    }
    Ok(())
}

/// As many surfaces as balls.
fn surfaces() -> Result<(), Failure> {
    const SIZE: usize = 256;
    heads("surfaces, a ball each");
    for n in [1, 4, 16, 64] {
        let r = 0.9 / (n as f64).sqrt();
        let ball = |[x, y, z]: [f64; 3]| {
            format!("[[surface]]\nformula = \"(x - {x})^2 + (y - {y})^2 + (z - {z})^2 = {:.6}\"\n", r * r)
        };
        row(n, SIZE, &measure(&Picture::of(balls(n).map(ball).collect::<String>(), SIZE))?);
    }
    Ok(())
}

fn main() -> Result<(), Failure> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    if let [first, rest @ ..] = &words[..]
        && first == "one"
    {
        return draw(rest);
    }
    let tables: [(&str, Table); 5] = [
        ("resolution", resolution),
        ("light", light),
        ("tolerance", tolerance),
        ("formula", formula),
        ("surfaces", surfaces),
    ];
    if let Some(word) = words.iter().find(|word| tables.iter().all(|(name, _)| name != word)) {
        return Err(format!("there is no table `{word}`").into());
    }
    for (name, table) in tables {
        if words.is_empty() || words.iter().any(|word| word == name) {
            table()?;
        }
    }
    Ok(())
}
