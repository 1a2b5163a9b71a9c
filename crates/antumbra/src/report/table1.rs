//! Table 1: always 49 sub-beams against an initial beam.
use super::published::{PIXELS, Published, TABLE_1};
use super::runs::{Runs, preset};
use super::{Error, Report, Table};
use crate::paper;
use crate::render::{Method, RenderSpec, Renderer, Stats};

/// What we found for one surface.
struct Found {
    title: String,
    fixed: Stats,
    initial: Stats,
    /// Pixels whose initial beam may be blocked and whose surface faces the light.
    occluded_facing: u64,
}

pub(super) fn report(runs: &mut Runs<'_>) -> Result<Report, Error> {
    runs.announce(2 * TABLE_1.len());
    let found = TABLE_1.iter().map(|row| find(runs, row)).collect::<Result<Vec<_>, _>>()?;
    let rows: Vec<_> = found.iter().zip(&TABLE_1).collect();
    let pixels = (runs.spec.width * runs.spec.height) as u64;
    let mut notes = vec![
        "The paper's numbers are for 512 x 512 pixels on an NVIDIA 9600M GT. Its cameras and lights were not published: \
         ours are reconstructions, so shares can be compared, numbers less."
            .to_owned(),
        "\"Facing\" are the hits whose surface is turned to the middle of the light. The others are dark by \
         their shading, and their shadow beams are blocked by their own surface."
            .to_owned(),
        "No. beams, the paper's way: sub-beams only, so 49 times the initial beams blocked; the initial beams (one per \
         hit) are not counted. Hits, the paper's way: its \"No. beams\" using 49, divided by 49."
            .to_owned(),
        "\\* Misprints in the paper, corrected by its own \"No. beams\": 14.961 for 14.691, and 73.386 for 83.386."
            .to_owned(),
    ];
    if runs.spec.sub_beams != 7 {
        notes.push(format!("Here the sub-beams are {0} x {0}, not 7 x 7.", runs.spec.sub_beams));
    }
    Ok(Report {
        title: format!("Table 1: {}", runs.setting()),
        tables: vec![pixel_table(&rows, pixels), beam_table(&rows), time_table(&rows)],
        pictures: vec![],
        notes,
    })
}

/// The two methods on the same hits.
fn find(runs: &mut Runs<'_>, row: &Published) -> Result<Found, Error> {
    let scene = preset(row.preset)?;
    let spec = RenderSpec { method: Method::Paper(paper::Method::Fixed), ..runs.spec.clone() };
    let mut renderer = runs.render(&scene, spec)?;
    let fixed = renderer.stats();
    renderer.restart_shadows(Method::Paper(paper::Method::Initial));
    runs.finish(&mut renderer);
    let occluded_facing = facing_occluded(&renderer);
    Ok(Found { title: scene.title.clone(), fixed, initial: renderer.stats(), occluded_facing })
}

fn facing_occluded(renderer: &Renderer) -> u64 {
    let light = &renderer.frame().lights[0];
    light.initial_occluded.iter().zip(&light.facing).filter(|(occluded, facing)| **occluded && **facing > 0.0).count()
        as u64
}

fn pixel_table(rows: &[(&Found, &Published)], pixels: u64) -> Table {
    let mut table = Table::new(
        "Pixels (share of the picture)",
        [
            "surface",
            "hits",
            "paper",
            "in shadow, facing",
            "in shadow, all",
            "paper",
            "initial beams occluded, facing",
            "all",
            "paper",
        ],
    );
    for (found, paper) in rows {
        let s = &found.initial;
        let ours = |n: u64| format!("{} ({:.1} %)", grouped(n), percent(n, pixels));
        let theirs = |n: u64| format!("{} ({:.1} %)", grouped(n), percent(n, PIXELS));
        table.row([
            found.title.clone(),
            ours(s.hits),
            theirs(paper.hits()),
            ours(s.in_shadow_facing),
            ours(s.partly + s.dark),
            theirs(paper.in_shadow),
            ours(found.occluded_facing),
            ours(s.initial_occluded),
            theirs(paper.occluded) + if paper.misprint.is_some() { " \\*" } else { "" },
        ]);
    }
    table
}

fn beam_table(rows: &[(&Found, &Published)]) -> Table {
    let mut table = Table::new(
        "Beams and evaluations of the inclusion function (shadows only)",
        [
            "surface",
            "beams",
            "paper",
            "beams, using 49",
            "paper",
            "beams saved",
            "paper",
            "evaluations",
            "evaluations, using 49",
            "evaluations saved",
        ],
    );
    for (found, paper) in rows {
        let (ours, fixed) = (&found.initial, &found.fixed);
        table.row([
            found.title.clone(),
            grouped(ours.beams),
            grouped(paper.beams()),
            grouped(fixed.beams),
            grouped(paper.beams_of_49),
            saved(ours.beams as f64, fixed.beams as f64),
            saved(paper.beams() as f64, paper.beams_of_49 as f64),
            grouped(ours.shadow_evaluations),
            grouped(fixed.shadow_evaluations),
            saved(ours.shadow_evaluations as f64, fixed.shadow_evaluations as f64),
        ]);
    }
    table
}

fn time_table(rows: &[(&Found, &Published)]) -> Table {
    let mut table = Table::new(
        "Seconds",
        [
            "surface",
            "grid",
            "beam casting",
            "paper",
            "shadows",
            "paper",
            "shadows, using 49",
            "paper",
            "time saved",
            "paper",
        ],
    );
    let seconds = |s: f64| format!("{s:.2}");
    for (found, paper) in rows {
        let (ours, fixed) = (&found.initial, &found.fixed);
        table.row([
            found.title.clone(),
            format!("{:.3}", fixed.grid_seconds),
            seconds(fixed.primary_seconds),
            seconds(paper.casting_seconds),
            seconds(ours.shadow_seconds),
            seconds(paper.seconds),
            seconds(fixed.shadow_seconds),
            seconds(paper.seconds_of_49),
            saved(ours.shadow_seconds, fixed.shadow_seconds),
            format!("{} %", paper.saved),
        ]);
    }
    table
}

/// "1 234 567", with narrow no-break spaces.
pub(super) fn grouped(n: u64) -> String {
    let digits = n.to_string();
    let mut out = String::new();
    for (i, c) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            out.push('\u{202f}');
        }
        out.push(c);
    }
    out
}

/// Percent of a whole; 0 of nothing.
pub(super) fn percent(part: u64, whole: u64) -> f64 {
    if whole == 0 { 0.0 } else { 100.0 * part as f64 / whole as f64 }
}

/// How much less than `whole` is `part`, in percent.
fn saved(part: f64, whole: f64) -> String {
    if whole > 0.0 { format!("{:.0} %", 100.0 * (1.0 - part / whole)) } else { "-".to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_for_people() {
        assert_eq!(grouped(7), "7");
        assert_eq!(grouped(1_234_567).replace('\u{202f}', " "), "1 234 567");
        assert_eq!((saved(1.0, 4.0), saved(1.0, 0.0)), ("75 %".to_owned(), "-".to_owned()));
        assert_eq!((percent(1, 8), percent(1, 0)), (12.5, 0.0));
    }
}
