//! `antumbra render`: one scene, one picture.

use antumbra::image::npy_bytes;
use anyhow::Result;
use indicatif::HumanCount;
use serde::Serialize;

use super::{complete, json_sink, json_text, picture_bytes, print_json};
use crate::{
    engine::render::Stats,
    options::{RenderOptions, thread_count},
    output::{Folder, Sink, finish, remark},
    progress::Progress,
};

/// The JSON of `render`.
#[derive(Serialize)]
struct Record<'a> {
    version: &'static str,
    scene: &'a str,
    /// Width, height.
    size: [usize; 2],
    method: &'static str,
    threads: usize,
    #[serde(flatten)]
    stats: &'a Stats,
}

/// Renders and writes: every path is tried before the work begins, every file appears after it has ended.
pub(super) fn run(options: &RenderOptions) -> Result<()> {
    // The folder first: the picture may go into it, and it goes away last.
    let folder = options.planes.as_deref().map(Folder::open).transpose()?;
    let mut picture = Sink::open(&options.picture)?;
    let mut json = json_sink(options.json.as_ref())?;

    let progress = Progress::new(options.quiet, options.spec.method.name());
    let renderer = complete(&options.scene.scene, &options.spec, &options.run, &progress)?;
    drop(progress);

    let planes = renderer.frame()?.planes;
    picture.fill(&picture_bytes(&planes, options.format)?)?;
    let mut sinks = vec![picture];
    if let Some(folder) = &folder {
        for plane in planes.iter() {
            let mut sink = folder.sink(&format!("{}.npy", plane.name()))?;
            sink.fill(&npy_bytes(plane)?)?;
            sinks.push(sink);
        }
    }
    let stats = renderer.stats();
    let record = json_text(&Record {
        version: env!("CARGO_PKG_VERSION"),
        scene: &options.scene.name,
        size: [options.spec.width, options.spec.height],
        method: options.spec.method.name(),
        threads: thread_count(&options.run),
        stats: &stats,
    })?;
    if let Some(mut sink) = json.take() {
        sink.fill(record.as_bytes())?;
        sinks.push(sink);
    }
    finish(sinks)?;
    print_json(options.json.as_ref(), &record)?;
    if !options.quiet {
        remark(&summary(options, &stats));
    }
    Ok(())
}

/// What was found, what it cost, and where it is.
fn summary(options: &RenderOptions, stats: &Stats) -> String {
    let spec = &options.spec;
    let share = 100.0 * stats.hits as f64 / (spec.width * spec.height) as f64;
    let classes: Vec<String> = stats.classes.iter().map(|(name, n)| format!(", {} {name}", HumanCount(*n))).collect();
    let planes = options.planes.as_deref().map(|p| format!(" and {}/*.npy", p.display())).unwrap_or_default();
    format!(
        "{} hits ({share:.2} %){}; {} beams, {} evaluations; {:.2} s ({:.2} primary, {:.2} shadow)\n\
         wrote {}{planes}: {}x{}, {}, threads: {}",
        HumanCount(stats.hits),
        classes.concat(),
        HumanCount(stats.beams),
        HumanCount(stats.evaluations),
        stats.seconds,
        stats.primary_seconds,
        stats.shadow_seconds,
        options.picture.display(),
        spec.width,
        spec.height,
        spec.method.name(),
        thread_count(&options.run),
    )
}
