//! A plot of the times: one row of dots for each surface, on a logarithmic axis.
use crate::report::{Row, Times};
use plotters::prelude::*;
use std::path::Path;

/// Programs, the times of a row, and colours.
type Series = (&'static str, fn(&Row) -> Option<f64>, RGBColor);

fn theirs(of: &Option<Result<crate::report::Against, crate::Skipped>>) -> Option<f64> {
    of.as_ref()?.as_ref().ok()?.theirs.median()
}

const SERIES: [Series; 5] = [
    ("ours: whole picture, proved", |r| Times::median(&r.whole), RGBColor(200, 60, 40)),
    ("ours: surfaces alone", |r| Times::median(&r.surfaces), RGBColor(240, 160, 60)),
    ("Fidget: height map, no light", |r| Times::median(&r.fidget), RGBColor(60, 120, 200)),
    ("Embree: 49 rays a hit, mesh not counted", |r| theirs(&r.embree), RGBColor(90, 160, 90)),
    ("POV-Ray: 17 x 17 adaptive", |r| theirs(&r.povray), RGBColor(110, 90, 160)),
];

/// Writes the plot as SVG.
pub(crate) fn write(rows: &[Row], path: &Path) -> Result<(), String> {
    draw(rows, path).map_err(|e| e.to_string())
}

fn draw(rows: &[Row], path: &Path) -> Result<(), Box<dyn std::error::Error>> {
    let area = SVGBackend::new(path, (760, 120 + 60 * rows.len() as u32)).into_drawing_area();
    area.fill(&WHITE)?;
    let names: Vec<&str> = rows.iter().map(|r| r.name).collect();
    let mut chart = ChartBuilder::on(&area)
        .margin(16)
        .x_label_area_size(40)
        .y_label_area_size(90)
        .build_cartesian_2d((0.01..100.0).log_scale(), -0.5..rows.len() as f64 - 0.5)?;
    chart
        .configure_mesh()
        .disable_y_mesh()
        .bold_line_style(RGBColor(190, 190, 190))
        .light_line_style(RGBColor(232, 232, 232))
        .x_desc("CPU seconds")
        .y_labels(rows.len())
        .y_label_formatter(&|y| names.get(y.round() as usize).copied().unwrap_or_default().to_owned())
        .draw()?;
    for (k, (name, of, color)) in SERIES.iter().enumerate() {
        let offset = 0.14 * (k as f64 - 2.0);
        let points = rows.iter().enumerate().filter_map(|(i, row)| Some((of(row)?, i as f64 - offset)));
        chart
            .draw_series(points.map(|p| Circle::new(p, 5, color.filled())))?
            .label(*name)
            .legend(|(x, y)| Circle::new((x + 8, y), 5, color.filled()));
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::LowerRight)
        .border_style(RGBColor(170, 170, 170))
        .background_style(WHITE)
        .draw()?;
    area.present()?;
    Ok(())
}
