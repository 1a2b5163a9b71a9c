//! Cost of certainty: evaluations of the shadow pass against the tolerance, as a table and as a log-log plot:
//! `cargo run --release -p antumbra --example tolerance -- [SIZE] [PLOT.svg]`.
//!
//! The counts are the same on every machine.
use antumbra::render::{RenderSpec, Renderer, RunSpec, Stats};
use antumbra::scene::{PRESETS, Scene, preset};
use plotters::prelude::*;
use std::error::Error;
use std::sync::Arc;
use std::time::Duration;

/// Tolerances as powers of two: 1/64 to 1/4096.
const LEVELS: [u32; 4] = [6, 8, 10, 12];
/// A hue for each scene, of about equal lightness.
const COLORS: [RGBColor; 4] =
    [RGBColor(204, 102, 51), RGBColor(51, 119, 170), RGBColor(85, 136, 51), RGBColor(153, 85, 153)];

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let size: usize = arguments.next().map_or(Ok(256), |text| text.parse())?;
    let plot = arguments.next();
    println!("Shadow evaluations (in brackets: hits left open, and the widest bracket), {size} x {size} pixels");
    println!();
    println!("| scene | {} | exponent |", LEVELS.map(|l| format!("1/{}", 1 << l)).join(" | "));
    println!("|---|{}", "---|".repeat(LEVELS.len() + 1));
    let mut curves = Vec::new();
    for row in &PRESETS[..4] {
        let scene = Arc::new(preset(row.name).ok_or("no such preset")??);
        let mut cells = Vec::new();
        let mut curve = Vec::new();
        for level in LEVELS {
            let stats = shadows(&scene, size, tolerance(level))?;
            let open = match stats.brackets_open {
                0 => String::new(),
                n => format!(" ({n} open, {:.4})", stats.bracket_width_max),
            };
            cells.push(format!("{}{open}", stats.shadow_evaluations));
            curve.push((tolerance(level), stats.shadow_evaluations as f64));
        }
        println!("| {} | {} | {:.2} |", row.title, cells.join(" | "), exponent(&curve));
        curves.push((row.title, curve));
    }
    if let Some(path) = plot {
        draw(&path, &curves)?;
    }
    Ok(())
}

/// `2^-level`.
fn tolerance(level: u32) -> f64 {
    1.0 / f64::from(1_u32 << level)
}

fn shadows(scene: &Arc<Scene>, size: usize, tolerance: f64) -> Result<Stats, Box<dyn Error>> {
    let spec = RenderSpec { width: size, height: size, tolerance, ..RenderSpec::default() };
    let mut renderer = Renderer::new(Arc::clone(scene), spec, RunSpec::default())?;
    while !renderer.refine(Duration::from_secs(60)) {}
    Ok(renderer.stats())
}

/// e of "cost grows as tolerance^-e", between the ends.
fn exponent(curve: &[(f64, f64)]) -> f64 {
    let (first, last) = (curve[0], curve[curve.len() - 1]);
    core_math::log(last.1 / first.1) / core_math::log(first.0 / last.0)
}

fn draw(path: &str, curves: &[(&str, Vec<(f64, f64)>)]) -> Result<(), Box<dyn Error>> {
    let costs = || curves.iter().flat_map(|(_, curve)| curve.iter().map(|p| p.1));
    let (least, most) = (costs().fold(f64::INFINITY, f64::min), costs().fold(0.0, f64::max));
    let root = SVGBackend::new(path, (720, 480)).into_drawing_area();
    root.fill(&WHITE)?;
    let ends = [LEVELS[0], LEVELS[LEVELS.len() - 1]].map(|l| 1.0 / tolerance(l));
    let mut chart = ChartBuilder::on(&root)
        .margin(16)
        .x_label_area_size(44)
        .y_label_area_size(72)
        .build_cartesian_2d((ends[0] * 0.9..ends[1] * 1.1).log_scale(), (least * 0.6..most * 1.6).log_scale())?;
    chart
        .configure_mesh()
        .x_desc("1 / tolerance")
        .y_desc("evaluations of the shadow pass")
        .x_label_formatter(&|x| format!("{x:.0}"))
        .y_label_formatter(&|y| format!("{y:.0e}"))
        .label_style(("sans-serif", 15))
        .max_light_lines(0)
        .bold_line_style(BLACK.mix(0.12))
        .draw()?;
    for ((title, curve), color) in curves.iter().zip(COLORS) {
        let points: Vec<(f64, f64)> = curve.iter().map(|(tolerance, cost)| (1.0 / tolerance, *cost)).collect();
        chart
            .draw_series(LineSeries::new(points.iter().copied(), color.stroke_width(2)))?
            .label(*title)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], color.stroke_width(2)));
        chart.draw_series(points.iter().map(|p| Circle::new(*p, 4, color.filled())))?;
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperLeft)
        .background_style(WHITE.mix(0.85))
        .label_font(("sans-serif", 15))
        .draw()?;
    root.present()?;
    Ok(())
}
