//! `antumbra audit`: the claims of a frame, asked again.

use std::{fmt::Write, fs, path::Path, sync::Arc};

use antumbra::{
    audit::{Audit, AuditSpec, Report, Tally},
    image::{Planes, plane_from_npy},
    render::{Frame, Method, RenderSpec, Renderer},
    scene::{Scene, SceneFile},
};
use anyhow::{Result, anyhow, bail};
use indicatif::HumanCount;
use serde::Serialize;

use super::{complete, json_sink, json_text, print_json, record::FrameRecord};
use crate::{
    options::{AuditOptions, Audited, JsonTarget},
    output::{finish, print, remark},
    progress::Progress,
};

/// Violations that are printed in words; more are only counted.
const PRINTED: usize = 20;

/// The JSON of `audit`.
#[derive(Serialize)]
struct Record<'a> {
    version: &'static str,
    scene: &'a str,
    seed: u64,
    total: Tally,
    #[serde(flatten)]
    report: &'a Report,
}

/// A frame and what it shows.
struct Claimed {
    name: String,
    scene: Arc<Scene>,
    frame: Frame,
    light_scale: f64,
    floor: bool,
}

/// Reads or renders the frame, asks, prints; fails if a claim is wrong.
pub(super) fn run(options: &AuditOptions) -> Result<()> {
    let mut json = json_sink(options.json.as_ref())?;
    let claimed = match &options.audited {
        Audited::Folder(folder) => from_folder(folder)?,
        Audited::Scene(scene, spec) => {
            let progress = Progress::new(options.quiet, "certified");
            let mut renderer = Renderer::new(Arc::clone(&scene.scene), spec.clone(), options.run)?;
            renderer.color_late();
            complete(&mut renderer, options.budget, &progress)?;
            let RenderSpec { light_scale, floor, .. } = *spec;
            let (name, scene, frame) = (scene.name.clone(), Arc::clone(&scene.scene), renderer.frame().clone());
            Claimed { name, scene, frame, light_scale, floor }
        }
    };
    let Claimed { light_scale, floor, .. } = claimed;
    let spec = AuditSpec { pixels: options.pixels, seed: options.seed, light_scale, floor };
    let mut audit = Audit::new(&claimed.scene, &claimed.frame, spec, options.run)?;
    let progress = Progress::new(options.quiet, "audit");
    while !audit.step()? {
        progress.set(audit.progress());
    }
    drop(progress);
    let report = audit.report();
    let total = report.total();
    let record = json_text(&Record {
        version: env!("CARGO_PKG_VERSION"),
        scene: &claimed.name,
        seed: options.seed,
        total,
        report,
    })?;
    if let Some(mut sink) = json.take() {
        sink.fill(record.as_bytes())?;
        finish(vec![sink])?;
    }
    print_json(options.json.as_ref(), &record)?;
    let table = table(&claimed.name, report)?;
    if options.json == Some(JsonTarget::Stdout) {
        remark(table.trim_end())
    } else {
        print(&table)?
    }
    report.violations.iter().take(PRINTED).for_each(|line| remark(line));
    if total.violations > 0 {
        bail!("{} of {} claims are wrong; please report this scene as a bug", total.violations, total.claims);
    }
    Ok(())
}

fn table(name: &str, report: &Report) -> Result<String> {
    let mut out = format!("{name}: {} pixels\n", HumanCount(report.pixels as u64));
    writeln!(out, "{:<12} {:>12} {:>14} {:>9} {:>11}", "claim", "asked", "rays", "unclear", "violations")?;
    let kinds = report.kinds.iter().map(|(kind, tally)| (serde_json::to_value(kind), *tally));
    for (kind, t) in kinds.chain([(Ok("all".into()), report.total())]) {
        let kind = kind?;
        writeln!(
            out,
            "{:<12} {:>12} {:>14} {:>9} {:>11}",
            kind.as_str().unwrap_or_default(),
            HumanCount(t.claims).to_string(),
            HumanCount(t.rays).to_string(),
            HumanCount(t.unclear).to_string(),
            HumanCount(t.violations).to_string()
        )?;
    }
    Ok(out)
}

/// The frame that `render --planes` left in a folder.
fn from_folder(folder: &Path) -> Result<Claimed> {
    let read = |name: &str| {
        let path = folder.join(name);
        fs::read(&path).map_err(|e| {
            anyhow!("cannot read `{}`: {e}; `antumbra render SCENE --planes DIR` writes such folders", path.display())
        })
    };
    let path = folder.join(FrameRecord::FILE);
    let record: FrameRecord = serde_json::from_slice(&read(FrameRecord::FILE)?)
        .map_err(|e| anyhow!("`{}` is not what `render --planes` writes: {e}", path.display()))?;
    if Method::from_name(&record.method) != Some(Method::Certified) {
        bail!(
            "`{}` was drawn by the method `{}`, which proves nothing: there is nothing to audit",
            folder.display(),
            record.method
        );
    }
    let scene = SceneFile::parse(&record.scene_file).and_then(|file| file.scene(&record.scene));
    let scene = Arc::new(scene.map_err(|e| anyhow!("the scene in `{}`: {e}", path.display()))?);
    let mut planes = Planes::new();
    for name in Frame::plane_names(scene.lights.len()) {
        planes.add(plane_from_npy(&name, &read(&format!("{name}.npy"))?)?)?;
    }
    let frame = Frame::from_planes(&planes, scene.lights.len())?;
    if (frame.width, frame.height) != (record.width, record.height) {
        bail!("the planes in `{}` are not of the size that `{}` says", folder.display(), path.display());
    }
    let FrameRecord { scene: name, light_scale, floor, .. } = record;
    Ok(Claimed { name, scene, frame, light_scale, floor })
}
