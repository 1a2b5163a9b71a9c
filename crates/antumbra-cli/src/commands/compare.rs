//! `antumbra compare`: several methods on one scene, in one process.

use std::sync::Arc;

use antumbra::render::{Method, RenderSpec, Renderer, Stats};
use anyhow::Result;
use comfy_table::{CellAlignment, Table, presets::ASCII_MARKDOWN};
use serde::Serialize;

use super::{complete, json_sink, json_text, print_json};
use crate::{
    options::{CompareOptions, JsonTarget},
    output::{finish, print, remark},
    progress::Progress,
};

/// The JSON of `compare`.
#[derive(Serialize)]
struct Comparison<'a> {
    scene: &'a str,
    /// Width, height.
    size: [usize; 2],
    threads: usize,
    methods: Vec<Row>,
}

/// What one method found and cost. The hits are found once, by the first method; `evaluations` and `seconds` are
/// those of the shadows and the hits together, as if each method had found them.
#[derive(Serialize)]
struct Row {
    method: &'static str,
    hits: u64,
    beams: u64,
    initial_beams: u64,
    initial_occluded: u64,
    lit: u64,
    partly: u64,
    dark: u64,
    evaluations: u64,
    primary_evaluations: u64,
    shadow_evaluations: u64,
    primary_seconds: f64,
    shadow_seconds: f64,
    seconds: f64,
}

impl Row {
    fn new(method: &'static str, stats: &Stats) -> Self {
        Self {
            method,
            hits: stats.hits,
            beams: stats.beams,
            initial_beams: stats.initial_beams,
            initial_occluded: stats.initial_occluded,
            lit: stats.lit,
            partly: stats.partly,
            dark: stats.dark,
            evaluations: stats.evaluations,
            primary_evaluations: stats.primary_evaluations,
            shadow_evaluations: stats.shadow_evaluations,
            primary_seconds: stats.primary_seconds,
            shadow_seconds: stats.shadow_seconds,
            seconds: stats.seconds,
        }
    }
}

/// Runs the methods one after the other and prints the table.
pub(super) fn run(options: &CompareOptions) -> Result<()> {
    let mut json = json_sink(options.json.as_ref())?;
    // All methods start from the same hits: proved ones, if the certified method is among them (it needs them).
    let mut order = options.methods.clone();
    order.sort_by_key(|method| *method != Method::Certified);
    let spec = RenderSpec { method: order[0], ..options.spec.clone() };
    let mut renderer = Renderer::new(Arc::clone(&options.scene.scene), spec, options.run)?;
    let mut rows = vec![];
    for method in &order {
        let progress = Progress::new(options.quiet, method.name());
        // For the first method, which has not begun, this changes nothing.
        renderer.restart_shadows(*method);
        complete(&mut renderer, options.budget, &progress)?;
        rows.push(Row::new(method.name(), &renderer.stats()));
    }
    rows.sort_by_key(|row| options.methods.iter().position(|method| method.name() == row.method));
    let table = table(&rows);
    let size = [options.spec.width, options.spec.height];
    let threads = renderer.stats().threads;
    let record = json_text(&Comparison { scene: &options.scene.name, size, threads, methods: rows })?;
    if let Some(mut sink) = json.take() {
        sink.fill(record.as_bytes())?;
        finish(vec![sink])?;
    }
    print_json(options.json.as_ref(), &record)?;
    let heading = format!("{}, {}x{}, threads: {threads}", options.scene.name, size[0], size[1]);
    if options.json == Some(JsonTarget::Stdout) {
        remark(&format!("{heading}\n{table}"));
        Ok(())
    } else {
        print(&format!("{heading}\n{table}\n"))
    }
}

/// One line a method; the ratios say how many times cheaper than the first method it is.
fn table(rows: &[Row]) -> Table {
    let mut table = Table::new();
    table.load_style(ASCII_MARKDOWN).set_header([
        "method",
        "hits",
        "lit",
        "partly",
        "dark",
        "shadow beams",
        "shadow evaluations",
        "primary s",
        "shadow s",
        "total s",
        "fewer evaluations",
        "faster shadow",
        "faster total",
    ]);
    for row in rows {
        let first = &rows[0];
        table.add_row([
            row.method.to_owned(),
            row.hits.to_string(),
            row.lit.to_string(),
            row.partly.to_string(),
            row.dark.to_string(),
            (row.initial_beams + row.beams).to_string(),
            row.shadow_evaluations.to_string(),
            format!("{:.3}", row.primary_seconds),
            format!("{:.3}", row.shadow_seconds),
            format!("{:.3}", row.seconds),
            ratio(first.shadow_evaluations as f64, row.shadow_evaluations as f64),
            ratio(first.shadow_seconds, row.shadow_seconds),
            ratio(first.seconds, row.seconds),
        ]);
    }
    for column in table.column_iter_mut().skip(1) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    table
}

/// `first / this` as `2.0x`; nothing where that says nothing.
fn ratio(first: f64, this: f64) -> String {
    let ratio = first / this;
    if ratio.is_finite() { format!("{ratio:.2}x") } else { "-".to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(method: &'static str, cost: u64) -> Row {
        let seconds = cost as f64 / 100.0;
        let stats =
            Stats { beams: cost, shadow_evaluations: cost, shadow_seconds: seconds, seconds, ..Stats::default() };
        Row::new(method, &stats)
    }

    #[test]
    fn ratios_refer_to_the_first_method() {
        let text = table(&[row("fixed49", 300), row("paper", 120), row("free", 0)]).to_string();
        let line = |name: &str| text.lines().find(|l| l.contains(name)).expect(name).to_owned();
        assert_eq!(line("fixed49").matches("1.00x").count(), 3, "{text}");
        assert_eq!(line("paper").matches("2.50x").count(), 3, "{text}");
        assert!(!line("free").contains("inf"), "{text}");
    }
}
