//! What the paper leaves open: the distance at which shadow beams start, and the number of cells.
use super::published::TABLE_1;
use super::runs::{Runs, preset};
use super::table1::{grouped, percent};
use super::{Error, Report, Table};
use crate::paper;
use crate::render::{Method, RenderSpec};

/// Offsets as fractions of the scene's scale.
const OFFSETS: [f64; 8] = [0.0, 1e-5, 1e-4, 1e-3, 0.003, 0.01, 0.03, 0.1];
/// Cells along each axis.
const GRIDS: [usize; 4] = [8, 16, 32, 64];

/// One table per surface, one row per offset.
pub(super) fn offsets(runs: &mut Runs<'_>) -> Result<Report, Error> {
    runs.announce(OFFSETS.len() * TABLE_1.len());
    let pixels = (runs.spec.width * runs.spec.height) as u64;
    let mut tables = vec![];
    for row in &TABLE_1 {
        let scene = preset(row.preset)?;
        let caption = format!("{} (rays: {:.2} % in shadow, facing)", scene.title, row.rays_in_shadow);
        let mut table = Table::new(
            &caption,
            [
                "offset / scale",
                "offset",
                "lit",
                "partly",
                "dark",
                "in shadow, facing",
                "initial beams occluded",
                "evaluations",
            ],
        );
        for fraction in OFFSETS {
            let offset = fraction * scene.scale();
            let method = Method::Paper(paper::Method::Initial);
            let stats = runs.render(&scene, RenderSpec { method, offset: Some(offset), ..runs.spec.clone() })?.stats();
            table.row([
                format!("{fraction}"),
                format!("{offset:.2e}"),
                grouped(stats.lit),
                grouped(stats.partly),
                grouped(stats.dark),
                format!("{:.2} %", percent(stats.in_shadow_facing, pixels)),
                grouped(stats.initial_occluded),
                grouped(stats.shadow_evaluations),
            ]);
        }
        tables.push(table);
    }
    let notes = vec![
        "Shadow beams start at this distance from the middle of the hit's interval. Too small: surfaces shadow \
         themselves. Too large: thin occluders near the point are missed, and shadows begin too late."
            .to_owned(),
        "\"Rays\": share of all pixels at 512 x 512, by centre rays and 7 x 7 points of the light, from a program \
         that shares no code with this one. The paper's hits lie in front of the surface, the more so the fewer the \
         pixels: that can make shadows larger or smaller, and hide the effect of the offset."
            .to_owned(),
    ];
    Ok(Report { title: format!("Offsets: {}", runs.setting()), tables, pictures: vec![], notes })
}

/// One table, a row for each surface and grid.
pub(super) fn grids(runs: &mut Runs<'_>) -> Result<Report, Error> {
    runs.announce(GRIDS.len() * TABLE_1.len());
    let mut table = Table::new(
        "Cost by grid",
        [
            "surface",
            "cells",
            "grid evaluations",
            "casting evaluations",
            "shadow evaluations",
            "grid s",
            "casting s",
            "shadow s",
            "hits",
            "initial beams occluded",
        ],
    );
    for row in &TABLE_1 {
        let scene = preset(row.preset)?;
        for grid in GRIDS {
            let method = Method::Paper(paper::Method::Initial);
            let stats = runs.render(&scene, RenderSpec { method, grid, ..runs.spec.clone() })?.stats();
            table.row([
                scene.title.clone(),
                format!("{grid}^3"),
                grouped(stats.grid_evaluations),
                grouped(stats.primary_evaluations),
                grouped(stats.shadow_evaluations),
                format!("{:.3}", stats.grid_seconds),
                format!("{:.2}", stats.primary_seconds),
                format!("{:.2}", stats.shadow_seconds),
                grouped(stats.hits),
                grouped(stats.initial_occluded),
            ]);
        }
    }
    let notes = vec!["The paper does not say how many cells its grid has.".to_owned()];
    Ok(Report { title: format!("Grids: {}", runs.setting()), tables: vec![table], pictures: vec![], notes })
}
