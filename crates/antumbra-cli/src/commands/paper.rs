//! `antumbra paper`: a table or a figure of the paper, computed anew.

use std::fs;

use antumbra::{
    image::Depth,
    report::{Report, Table, report},
};
use anyhow::Result;
use comfy_table::{CellAlignment, presets::ASCII_MARKDOWN};

use super::picture_bytes;
use crate::{
    options::{Format, PaperOptions},
    output::{Folder, finish, print, remark},
    progress::Progress,
};

/// Computes the exhibit, prints its text and writes its files.
pub(super) fn run(options: &PaperOptions) -> Result<()> {
    let name = options.exhibit.name();
    let folder = options.folder.as_deref().map(Folder::open).transpose()?;
    let progress = Progress::new(options.quiet, name);
    let report = report(options.exhibit, &options.spec, options.run, &mut |done| progress.set(done))?;
    drop(progress);
    let text = markdown(&report);

    let mut sinks = vec![];
    let mut wrote = vec![];
    if let Some(folder) = &folder {
        for picture in &report.pictures {
            let file = format!("{}.png", picture.name);
            let mut sink = folder.sink(&file)?;
            sink.fill(&picture_bytes(&picture.planes, Format::Png(Depth::Eight))?)?;
            sinks.push(sink);
            wrote.push(file);
        }
        let mut sink = folder.sink(&format!("{name}.md"))?;
        sink.fill(text.as_bytes())?;
        sinks.push(sink);
        wrote.push(format!("{name}.md"));
    }
    finish(sinks)?;
    print(&text)?;
    if let (Some(folder), false) = (&folder, options.quiet) {
        let place = fs::canonicalize(folder.path()).unwrap_or_else(|_| folder.path().to_owned());
        remark(&format!("wrote {} in {}", wrote.join(", "), place.display()));
    }
    Ok(())
}

/// The report as text that reads well as it is and as Markdown.
pub(super) fn markdown(report: &Report) -> String {
    let mut text = format!("# {}\n", report.title);
    for table in &report.tables {
        text += &format!("\n{}\n\n{}\n", table.caption, layout(table));
    }
    for picture in &report.pictures {
        text += &format!("\n![{}]({}.png)\n", picture.caption, picture.name);
    }
    for note in &report.notes {
        text += &format!("\n- {note}\n");
    }
    text
}

fn layout(table: &Table) -> comfy_table::Table {
    let mut out = comfy_table::Table::new();
    out.load_style(ASCII_MARKDOWN).set_header(&table.header);
    for row in &table.rows {
        out.add_row(row);
    }
    for column in out.column_iter_mut().skip(1) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_report_is_markdown() {
        let words = |w: [&str; 2]| w.map(str::to_owned).to_vec();
        let table =
            Table { caption: "Found".into(), header: words(["surface", "hits"]), rows: vec![words(["a", "7"])] };
        let report = Report { title: "T".into(), tables: vec![table], pictures: vec![], notes: vec!["N.".into()] };
        let text = markdown(&report);
        assert!(text.starts_with("# T\n\nFound\n\n| surface |"), "{text}");
        assert!(text.contains("| a       |    7 |") && text.ends_with("\n- N.\n"), "{text}");
    }
}
