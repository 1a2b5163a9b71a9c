//! `antumbra paper`: a table or a figure of the paper, computed anew.

use std::fs;

use antumbra::image::Depth;
use anyhow::Result;
use clap::ValueEnum;

use super::picture_bytes;
use crate::{
    engine::paper,
    options::{Format, PaperOptions},
    output::{Folder, finish, print, remark},
    progress::Progress,
};

/// Computes the exhibit, prints its text and writes its files.
pub(super) fn run(options: &PaperOptions) -> Result<()> {
    let name = options.exhibit.to_possible_value().map_or_else(String::new, |v| v.get_name().to_owned());
    let folder = options.folder.as_deref().map(Folder::open).transpose()?;
    let progress = Progress::new(options.quiet, &name);
    let report = paper::report(options.exhibit, &options.spec, &options.run, &mut |done| progress.set(done))?;
    drop(progress);

    let mut sinks = vec![];
    let mut wrote = vec![];
    if let Some(folder) = &folder {
        for (picture, planes) in &report.pictures {
            let mut sink = folder.sink(&format!("{picture}.png"))?;
            sink.fill(&picture_bytes(planes, Format::Png(Depth::Eight))?)?;
            sinks.push(sink);
            wrote.push(format!("{picture}.png"));
        }
        let mut sink = folder.sink(&format!("{name}.md"))?;
        sink.fill(report.text.as_bytes())?;
        sinks.push(sink);
        wrote.push(format!("{name}.md"));
    }
    finish(sinks)?;
    print(&report.text)?;
    if let (Some(folder), false) = (&folder, options.quiet) {
        let place = fs::canonicalize(folder.path()).unwrap_or_else(|_| folder.path().to_owned());
        remark(&format!("wrote {} in {}", wrote.join(", "), place.display()));
    }
    Ok(())
}
