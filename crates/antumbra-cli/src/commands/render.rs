//! `antumbra render`: one scene, one picture.

use antumbra::{
    image::npy_bytes,
    render::{Method, Stats},
    scene::{Extent, Object, extent},
};
use anyhow::{Result, bail};
use indicatif::HumanCount;
use serde::Serialize;

use super::{
    End, animate, deadline, device, frame_bytes, json_sink, json_text, legend_left_out, picture_bytes, print_json,
    pursue, record::FrameRecord, spent,
};
use crate::{
    bands::{self, Rows},
    failure::Interrupted,
    interrupt::Asking,
    options::RenderOptions,
    output::{Folder, Sink, finish, remark},
    progress::Progress,
    unfinished::Unfinished,
};

/// The JSON of `render`.
#[derive(Serialize)]
struct Record<'a> {
    version: &'static str,
    scene: &'a str,
    /// Width, height.
    size: [usize; 2],
    #[serde(flatten)]
    stats: &'a Stats,
    classes: Classes,
}

/// Hits by the light that reaches them.
#[derive(Serialize)]
struct Classes {
    lit: u64,
    partly: u64,
    dark: u64,
}

/// Renders and writes: every path is tried before the work begins, every file appears after it has ended.
pub(super) fn run(options: &RenderOptions) -> Result<()> {
    if let Some(film) = &options.film {
        return animate::run(options, film);
    }
    // The folder first: the picture may go into it, and it goes away last.
    let folder = options.planes.as_deref().map(Folder::open).transpose()?;
    let mut picture = Sink::open(&options.picture)?;
    let mut json = json_sink(options.json.as_ref())?;

    let rows = bands::rows(options)?;
    let mut unfinished = Unfinished::of(&options.picture, options.format, options.save_every);
    let mut renderer = unfinished.begin(&options.scene.scene, &options.spec, options.run, rows, options.resume)?;
    renderer.color_late();
    // Where a render goes on, its state says whether it is one in bands.
    let mut bands = match renderer.rows_before() {
        0 if renderer.holds_all() => None,
        before => Some(Rows::open(options, before)?),
    };
    let asking = Asking::first(renderer.stop_flag());
    let deadline = deadline(options.budget);
    device::prepare(options.device, options.spec.method, &mut renderer, options.quiet)?;
    let progress = Progress::new(options.quiet, options.spec.method.name());
    let end = loop {
        let end = pursue(&mut renderer, deadline, Some(&progress), &mut |r| unfinished.save_now_and_then(r));
        if let (End::Done, Some(bands), Some((rows, frame))) = (end, &mut bands, renderer.finished_rows()) {
            bands.put(&rows, &frame, options)?;
            unfinished.take_over();
        }
        if end != End::Done || !renderer.next_band() {
            break end;
        }
    };
    drop((progress, asking));
    match end {
        End::Done => {}
        End::Budget => bail!(spent(options.budget, &unfinished.stop(renderer, bands)?)),
        End::Asked => bail!(Interrupted(unfinished.stop(renderer, bands)?)),
    }

    match (&bands, options.overlay) {
        (Some(bands), _) => bands.write_picture(&mut picture)?,
        (None, Some(kind)) => {
            let planes = renderer.frame().overlay(kind, options.spec.tolerance)?;
            picture.fill(&picture_bytes(&planes, options.format)?)?;
        }
        (None, None) => {
            picture.fill(&frame_bytes(renderer.frame(), &options.scene.scene.look, options.format)?)?;
        }
    }
    let mut sinks = vec![picture];
    match (&folder, &bands) {
        (Some(folder), Some(bands)) => {
            for name in bands.planes() {
                let mut sink = folder.sink(&format!("{name}.npy"))?;
                bands.write_plane(name, &mut sink)?;
                sinks.push(sink);
            }
        }
        (Some(folder), None) => {
            for plane in renderer.frame().planes()?.iter() {
                let mut sink = folder.sink(&format!("{}.npy", plane.name()))?;
                sink.fill(&npy_bytes(plane)?)?;
                sinks.push(sink);
            }
        }
        (None, _) => {}
    }
    let stats = renderer.stats();
    if let Some(folder) = &folder {
        let mut sink = folder.sink(FrameRecord::FILE)?;
        sink.fill(json_text(&FrameRecord::new(&options.scene, &options.spec)?)?.as_bytes())?;
        sinks.push(sink);
    }
    let record = json_text(&Record {
        version: env!("CARGO_PKG_VERSION"),
        scene: &options.scene.name,
        size: [options.spec.width, options.spec.height],
        stats: &stats,
        classes: Classes { lit: stats.lit, partly: stats.partly, dark: stats.dark },
    })?;
    if let Some(mut sink) = json.take() {
        sink.fill(record.as_bytes())?;
        sinks.push(sink);
    }
    finish(sinks)?;
    unfinished.done();
    bands.into_iter().for_each(Rows::remove);
    print_json(options.json.as_ref(), &record)?;
    if !options.quiet {
        remark(&summary(options, &stats));
        if let Some(words) = legend_left_out(renderer.frame(), options.overlay) {
            remark(&words);
        }
    }
    Ok(())
}

/// Undecided hits are many from one in so many on: edges alone are fewer, but in the smallest pictures.
const MANY: u64 = 10;

/// What was found, what it cost, and where it is.
fn summary(options: &RenderOptions, stats: &Stats) -> String {
    let spec = &options.spec;
    let share = 100.0 * stats.hits as f64 / (spec.width * spec.height) as f64;
    let undecided = stats.hits.saturating_sub(stats.proved_hit + stats.proved_partly);
    let proofs = match spec.method {
        Method::Certified => format!(", {} of them undecided", HumanCount(undecided)),
        Method::Paper(_) => String::new(),
    };
    let per_light = if stats.lights > 1 { format!(" (of {} lights)", stats.lights) } else { String::new() };
    let open = match stats.brackets_open {
        0 => String::new(),
        1 => format!(
            "\n1 bracket is wider than the tolerance ({:.3}): allow more work with --rectangles",
            stats.bracket_width_max
        ),
        n => format!(
            "\n{} brackets are wider than the tolerance (up to {:.3}): allow more work with --rectangles",
            HumanCount(n),
            stats.bracket_width_max
        ),
    };
    let hint = if stats.hits == stats.floor_hits {
        nothing(options, stats)
    } else if undecided == stats.hits && spec.method == Method::Certified {
        "\nno hit is proved: `--overlay verdict` shows why".to_owned()
    } else if undecided > stats.hits / MANY && spec.method == Method::Certified {
        "\nmany hits are undecided: `--overlay verdict` shows where and why".to_owned()
    } else {
        String::new()
    };
    let planes = options.planes.as_deref().map(|p| format!(" and {}/*", p.display())).unwrap_or_default();
    format!(
        "{} hits ({share:.2} %){proofs}: {} lit, {} partly, {} dark{per_light}; {} shadow beams, {} evaluations; {:.2} s ({:.2} primary, {:.2} shadow)\n\
         wrote {}{planes}: {}x{}, {}, threads: {}{open}{hint}",
        HumanCount(stats.hits),
        HumanCount(stats.lit),
        HumanCount(stats.partly),
        HumanCount(stats.dark),
        HumanCount(stats.initial_beams + stats.beams),
        HumanCount(stats.evaluations),
        stats.seconds,
        stats.primary_seconds,
        stats.shadow_seconds,
        options.picture.display(),
        spec.width,
        spec.height,
        spec.method.name(),
        stats.threads,
    )
}

/// Why there is nothing to see: because there is no surface, if that can be proved, or because no pixel meets it.
fn nothing(options: &RenderOptions, stats: &Stats) -> String {
    let objects = &options.scene.scene.objects;
    let nowhere = |o: &Object| extent(o.surface.as_ref()) == Extent::Nowhere;
    if objects.iter().all(nowhere) {
        let [what, has] = if objects.len() == 1 { ["the formula", "has"] } else { ["the formulas", "have"] };
        return format!("\nnothing to see: {what} {has} no zero (proved for |x|, |y|, |z| <= 2^20)");
    }
    if stats.floor_hits == 0 && stats.proved_empty == (stats.width * stats.height) as u64 {
        let advice = "is it inside its clip and in front of the camera? `antumbra scene show` prints both";
        return format!("\nnothing to see: no ray of the picture meets a surface (proved); {advice}");
    }
    "\nnothing to see: no pixel meets a surface".to_owned()
}
