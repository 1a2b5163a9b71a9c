//! What was measured, as Markdown.
use crate::Skipped;
use crate::intervals::NAMES;
use crate::picture::Errors;
use std::fmt::Write;

/// Seconds, or nanoseconds, of several runs.
#[derive(Clone, Debug, Default)]
pub(crate) struct Times(Vec<f64>);

impl Times {
    pub(crate) fn push(&mut self, time: f64) {
        self.0.push(time);
    }

    fn sorted(&self) -> Vec<f64> {
        let mut sorted = self.0.clone();
        sorted.sort_by(f64::total_cmp);
        sorted
    }

    pub(crate) fn median(&self) -> Option<f64> {
        self.sorted().get(self.0.len() / 2).copied()
    }

    /// Median, least and most.
    fn shown(&self, unit: f64, digits: usize) -> String {
        let sorted = self.sorted();
        match (sorted.first(), sorted.last(), self.median()) {
            (Some(a), Some(b), Some(m)) => {
                format!("{:.digits$} ({:.digits$}..{:.digits$})", m * unit, a * unit, b * unit)
            }
            _ => "-".to_owned(),
        }
    }
}

/// How much longer the one takes than the other, by the medians.
fn ratio(longer: &Times, shorter: &Times) -> String {
    match (longer.median(), shorter.median()) {
        (Some(a), Some(b)) if b > 0.0 => format!("{:.2}", a / b),
        _ => "-".to_owned(),
    }
}

/// Another program's picture, and ours of at most its error.
pub(crate) struct Against {
    errors: Errors,
    pub(crate) tolerance: f64,
    of_ours: Errors,
    pub(crate) theirs: Times,
    pub(crate) ours: Times,
}

impl Against {
    pub(crate) fn new(errors: Errors, (tolerance, of_ours): (f64, Errors)) -> Self {
        Self { errors, tolerance, of_ours, theirs: Times::default(), ours: Times::default() }
    }
}

/// One surface.
pub(crate) struct Row {
    pub(crate) name: &'static str,
    /// Penumbra pixels that were sampled, and those at which the reference was contradicted.
    sampled: (usize, usize),
    pub(crate) surfaces: Times,
    pub(crate) light: Times,
    pub(crate) whole: Times,
    pub(crate) errors: Option<Errors>,
    pub(crate) fidget: Times,
    pub(crate) povray: Option<Result<Against, Skipped>>,
    pub(crate) mesh: Times,
    pub(crate) hierarchy: Times,
    pub(crate) embree: Option<Result<Against, Skipped>>,
    pub(crate) intervals: [Times; 4],
}

impl Row {
    pub(crate) fn new(name: &'static str, sampled: (usize, usize)) -> Self {
        let none = Times::default;
        Self {
            name,
            sampled,
            surfaces: none(),
            light: none(),
            whole: none(),
            errors: None,
            fidget: none(),
            povray: None,
            mesh: none(),
            hierarchy: none(),
            embree: None,
            intervals: [none(), none(), none(), none()],
        }
    }
}

fn rms(e: Errors) -> String {
    format!("{:.5} / {:.3}", e.rms, e.most)
}

/// All tables.
pub(crate) fn table(rows: &[Row], size: usize, runs: u32) -> String {
    let mut out = format!(
        "CPU milliseconds, one thread, {runs} interleaved runs: median (least..most). {size} x {size} pixels.\n"
    );
    let _ = writeln!(
        out,
        "\n**Our certified picture**, brackets of 1/255, and the reference (brackets of 1/65536) against plain sampling.\n"
    );
    let _ = writeln!(
        out,
        "| surface | surfaces | light | whole picture | error: RMS / most | penumbra pixels sampled | contradicted |"
    );
    let _ = writeln!(out, "|---|---|---|---|---|---|---|");
    for row in rows {
        let [s, l, w] = [&row.surfaces, &row.light, &row.whole].map(|t| t.shown(1e3, 0));
        let error = row.errors.map_or("-".to_owned(), rms);
        let _ = writeln!(out, "| {} | {s} | {l} | {w} | {error} | {} | {} |", row.name, row.sampled.0, row.sampled.1);
    }
    let _ = writeln!(
        out,
        "\n**Fidget**: height map and normals of {size}^3 voxels by its compiler, no light, no proof; against our surfaces with coverage.\n"
    );
    let _ = writeln!(out, "| surface | Fidget | ours, surfaces | Fidget / ours |\n|---|---|---|---|");
    for row in rows {
        let (theirs, ours) = (row.fidget.shown(1e3, 0), row.surfaces.shown(1e3, 0));
        let _ = writeln!(out, "| {} | {theirs} | {ours} | {} |", row.name, ratio(&row.fidget, &row.surfaces));
    }
    let _ = writeln!(
        out,
        "\n**POV-Ray**: polynomial, Sturm, 17 x 17 adaptive 2, the whole program; against our whole picture at the widest tolerance with no larger error.\n"
    );
    against(&mut out, rows, "POV-Ray", |row| &row.povray);
    let _ = writeln!(
        out,
        "\n**Embree**: only the 49 shadow rays of every hit, in packets of 16, on a finished mesh of 256^3 samples; against our whole picture.\n"
    );
    against(&mut out, rows, "Embree's rays", |row| &row.embree);
    let _ =
        writeln!(out, "\n| surface | mesh | hierarchy | 1/255: mesh, hierarchy and rays / ours |\n|---|---|---|---|");
    for row in rows {
        let rays = row.embree.as_ref().and_then(|e| e.as_ref().ok()).and_then(|e| e.theirs.median());
        let all = row.mesh.median().zip(row.hierarchy.median()).zip(rays).map(|((m, h), r)| m + h + r);
        let factor = all.zip(row.whole.median()).map_or("-".to_owned(), |(a, w)| format!("{:.2}", a / w));
        let _ =
            writeln!(out, "| {} | {} | {} | {factor} |", row.name, row.mesh.shown(1e3, 0), row.hierarchy.shown(1e3, 0));
    }
    let _ = writeln!(out, "\n**Enclosures over boxes**, nanoseconds each.\n");
    let _ = writeln!(out, "| surface | {} |\n|---|---|---|---|---|", NAMES.join(" | "));
    for row in rows {
        let shown: Vec<String> = row.intervals.iter().map(|t| t.shown(1.0, 1)).collect();
        let _ = writeln!(out, "| {} | {} |", row.name, shown.join(" | "));
    }
    out
}

fn against(out: &mut String, rows: &[Row], name: &str, of: impl Fn(&Row) -> &Option<Result<Against, Skipped>>) {
    let _ =
        writeln!(out, "| surface | {name} | error: RMS / most | our tolerance | our error | ours | {name} / ours |");
    let _ = writeln!(out, "|---|---|---|---|---|---|---|");
    for row in rows {
        match of(row) {
            Some(Ok(a)) => {
                let _ = writeln!(
                    out,
                    "| {} | {} | {} | 1/{:.0} | {} | {} | {} |",
                    row.name,
                    a.theirs.shown(1e3, 0),
                    rms(a.errors),
                    1.0 / a.tolerance,
                    rms(a.of_ours),
                    a.ours.shown(1e3, 0),
                    ratio(&a.theirs, &a.ours),
                );
            }
            Some(Err(Skipped(why))) => {
                let _ = writeln!(out, "| {} | skipped: {why} | | | | | |", row.name);
            }
            None => {}
        }
    }
}
