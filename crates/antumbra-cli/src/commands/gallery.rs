//! `antumbra gallery`: the surfaces of the gallery, their pictures and a page that shows them.

mod page;

use std::{sync::Arc, time::Duration};

use antumbra::{
    image::{COLOR_PLANE, Depth, png_bytes},
    render::{RenderSpec, Renderer, RunSpec, Stats},
    report::{Report, Sheet, Table},
    scene::{GALLERY, GalleryEntry, Scene},
};
use anyhow::{Context, Result, bail};
use indicatif::HumanCount;
use serde::Serialize;

use super::{complete, json_text, paper::markdown};
use crate::{
    options::GalleryOptions,
    output::{Folder, finish, print, remark},
    progress::Progress,
};

/// Files beside the pictures.
const PAGE: &str = "index.html";
const TABLE: &str = "gallery.md";
const COUNTS: &str = "gallery.json";
const SHEET: &str = "sheet.png";

/// A surface that is drawn.
struct Drawn {
    name: &'static str,
    scene: Arc<Scene>,
    png: Vec<u8>,
    stats: Stats,
}

/// One surface in `gallery.json`.
#[derive(Serialize)]
struct Record<'a> {
    name: &'a str,
    title: &'a str,
    undecided: u64,
    #[serde(flatten)]
    stats: &'a Stats,
}

/// Draws what was asked for. A surface that fails is reported and left out; the others go on, and the command fails at the end.
pub(super) fn run(options: &GalleryOptions) -> Result<()> {
    if options.list {
        let line = |e: &GalleryEntry| Ok(format!("{:<16} {}\n", e.name, e.scene()?.title));
        return print(&GALLERY.iter().map(line).collect::<Result<String>>()?);
    }
    // Every file that comes last is tried first; one that exists stays as it is until then.
    let folder = Folder::open(&options.folder)?;
    let mut files =
        [PAGE, TABLE, COUNTS, SHEET].map(|name| folder.sink(name)).into_iter().collect::<Result<Vec<_>>>()?;

    let (mut sheet, mut drawn, mut failed) = (Sheet::default(), vec![], vec![]);
    for (k, entry) in options.entries.iter().enumerate() {
        let label = format!("{} ({} of {})", entry.name, k + 1, options.entries.len());
        match draw(entry, options, &label, &folder, &mut sheet) {
            Ok(done) => {
                if !options.quiet {
                    remark(&format!("{label}: {}", counts(&done.stats)));
                }
                drawn.push(done);
            }
            Err(error) => {
                remark(&format!("{label} failed: {error:#}"));
                failed.push(entry.name);
            }
        }
    }
    if drawn.is_empty() {
        bail!("no surface was drawn");
    }
    let records: Vec<Record<'_>> = drawn.iter().map(Drawn::record).collect();
    let contents = [
        page::page(&drawn).into_bytes(),
        markdown(&report(&drawn)).into_bytes(),
        json_text(&records)?.into_bytes(),
        png_bytes(sheet.planes(options.columns)?.require(COLOR_PLANE)?, Depth::Eight)?,
    ];
    for (file, content) in files.iter_mut().zip(&contents) {
        file.fill(content)?;
    }
    finish(files)?;
    if !options.quiet {
        remark(&format!(
            "wrote {} pictures, {PAGE}, {TABLE}, {COUNTS} and {SHEET} in {}",
            drawn.len(),
            folder.path().display()
        ));
    }
    if !failed.is_empty() {
        bail!("{} of {} surfaces failed: {}", failed.len(), options.entries.len(), failed.join(", "));
    }
    Ok(())
}

/// Renders one surface and writes its picture.
fn draw(
    entry: &GalleryEntry,
    options: &GalleryOptions,
    label: &str,
    folder: &Folder,
    sheet: &mut Sheet,
) -> Result<Drawn> {
    let scene = Arc::new(entry.scene()?);
    let mut picture = folder.sink(&format!("{}.png", entry.name))?;
    let spec = RenderSpec { floor: options.spec.floor || scene.floor_shown, ..options.spec.clone() };
    let (frame, stats) = render(&scene, spec, options.run, options.budget, &Progress::new(options.quiet, label))?;
    let png = png_bytes(frame.picture(&scene.look)?.require(COLOR_PLANE)?, Depth::Eight)?;
    picture.fill(&png)?;
    finish(vec![picture])?;
    sheet.add(&frame);
    Ok(Drawn { name: entry.name, scene, png, stats })
}

fn render(
    scene: &Arc<Scene>,
    spec: RenderSpec,
    run: RunSpec,
    budget: Option<Duration>,
    progress: &Progress,
) -> Result<(antumbra::render::Frame, Stats)> {
    let mut renderer = Renderer::new(Arc::clone(scene), spec, run)?;
    renderer.color_late();
    complete(&mut renderer, budget, progress).context("not drawn")?;
    Ok((renderer.frame().clone(), renderer.stats()))
}

impl Drawn {
    fn record(&self) -> Record<'_> {
        Record { name: self.name, title: &self.scene.title, undecided: self.stats.undecided(), stats: &self.stats }
    }
}

/// What was proved, in a line.
fn counts(stats: &Stats) -> String {
    format!(
        "{} proved hits, {} proved edges, {} proved empty, {} undecided; {:.1} s",
        HumanCount(stats.proved_hit),
        HumanCount(stats.proved_partly),
        HumanCount(stats.proved_empty),
        HumanCount(stats.undecided()),
        stats.seconds
    )
}

/// The counts of all, as a table.
fn report(drawn: &[Drawn]) -> Report {
    let header = [
        "surface",
        "proved hits",
        "proved edges",
        "proved empty",
        "undecided",
        "of these touching",
        "open brackets",
        "seconds",
    ];
    let row = |d: &Drawn| {
        let s = &d.stats;
        let counts =
            [s.proved_hit, s.proved_partly, s.proved_empty, s.undecided(), s.undecided_touching, s.brackets_open];
        let mut row = vec![d.name.to_owned()];
        row.extend(counts.map(|n| HumanCount(n).to_string()));
        row.push(format!("{:.1}", s.seconds));
        row
    };
    let size =
        drawn.first().map_or_else(String::new, |d| format!("{} x {} pixels each, ", d.stats.width, d.stats.height));
    let threads = drawn.first().map_or(1, |d| d.stats.threads);
    Report {
        title: "Gallery".to_owned(),
        tables: vec![Table {
            caption: format!("{size}threads: {threads}"),
            header: header.map(str::to_owned).to_vec(),
            rows: drawn.iter().map(row).collect(),
        }],
        pictures: vec![],
        notes: vec![
            "Proved hits: the ray through the middle of the pixel meets a surface (or the floor). Proved edges: it misses, \
             but another ray of the pixel meets one. Proved empty: no ray does."
                .to_owned(),
            "Undecided: neither. Touching are those where the formula reaches 0 without a proved change of sign: nodes, cusps, \
             pinch points, double lines and what sticks out of a surface as a line."
                .to_owned(),
            "Open brackets: pairs of a hit and a light whose visible fraction is enclosed, but wider than the tolerance."
                .to_owned(),
        ],
    }
}
