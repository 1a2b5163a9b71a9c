//! Figures 1, 5, 6 and 7.
use super::mosaic::{Tile, mosaic};
use super::runs::{Runs, preset};
use super::table1::{grouped, percent};
use super::{Error, Report, Table};
use crate::paper;
use crate::render::{Method, RenderSpec, Renderer};

/// The surfaces in the order of figure 6.
const SURFACES: [&str; 4] = ["chubs", "kusner", "mcmullen", "orthocircle"];
const BEAMS: Method = Method::Paper(paper::Method::Initial);
const RAYS: Method = Method::Paper(paper::Method::RegularRays);

/// Thin things: the stand-in of the paper's twister, and a wire thinner than a pixel, where the loss is plainest.
const THIN: [&str; 2] = ["twister", "wire3"];

/// Figures 1 and 5: thin surfaces, and their shadows, by rays and by beams.
pub(super) fn rays_and_beams(runs: &mut Runs<'_>, name: &str, floor: bool) -> Result<Report, Error> {
    runs.announce(2 * THIN.len());
    let floor = floor || runs.spec.floor;
    let mut report = Report { title: format!("{}: rays and beams, {}", name, runs.setting()), ..Report::default() };
    let mut table = Table::new(
        "Found",
        [
            "surface",
            "by",
            "hits on the surface",
            "hits on the floor",
            "lit",
            "partly",
            "dark",
            "evaluations",
            "seconds",
        ],
    );
    let mut tiles = vec![];
    for thin in THIN {
        let scene = preset(thin)?;
        for (method, word) in [(RAYS, "rays"), (BEAMS, "beams")] {
            let renderer = runs.render(&scene, RenderSpec { method, floor, ..runs.spec.clone() })?;
            let s = renderer.stats();
            table.row([
                scene.title.clone(),
                word.to_owned(),
                grouped(s.hits - s.floor_hits),
                grouped(s.floor_hits),
                grouped(s.lit),
                grouped(s.partly),
                grouped(s.dark),
                grouped(s.evaluations),
                format!("{:.2}", s.seconds),
            ]);
            let tile = Tile::of(renderer.frame());
            let caption = format!("{}, by {word}", scene.title);
            report.pictures.push(tile.clone().picture(format!("{name}-{thin}-{word}"), caption)?);
            tiles.push(tile);
        }
    }
    report.pictures.push(mosaic(2, &tiles).picture(name, "Left: rays. Right: beams")?);
    report.tables.push(table);
    report.notes.push(
        "The formula of the paper's twister was never published; this one is a twisted elliptic blade, and the wire \
         is ours. Neither picture is exact: rays lose what lies between them; a beam that may meet the surface counts \
         as one that does, so beams draw thin things too wide and their shadows too dark, and never lose them."
            .to_owned(),
    );
    Ok(report)
}

/// Figure 6: the four surfaces.
pub(super) fn surfaces(runs: &mut Runs<'_>) -> Result<Report, Error> {
    runs.announce(SURFACES.len());
    let mut report = Report { title: format!("fig6: the four surfaces, {}", runs.setting()), ..Report::default() };
    let mut table = Table::new("Found", ["surface", "hits", "lit", "partly", "dark", "seconds"]);
    let mut tiles = vec![];
    for name in SURFACES {
        let scene = preset(name)?;
        let renderer = runs.render(&scene, RenderSpec { method: BEAMS, ..runs.spec.clone() })?;
        let s = renderer.stats();
        table.row([
            scene.title.clone(),
            grouped(s.hits),
            grouped(s.lit),
            grouped(s.partly),
            grouped(s.dark),
            format!("{:.2}", s.seconds),
        ]);
        let tile = Tile::of(renderer.frame());
        report.pictures.push(tile.clone().picture(format!("fig6-{name}"), scene.title.clone())?);
        tiles.push(tile);
    }
    let caption = "From left to right and top to bottom: Chubs, Kusner-Schmitt, McMullen and Orthocircle";
    report.pictures.push(mosaic(2, &tiles).picture("fig6", caption)?);
    report.tables.push(table);
    Ok(report)
}

/// Figure 7: which initial beams were blocked, which points are in shadow.
pub(super) fn shadow_tests(runs: &mut Runs<'_>) -> Result<Report, Error> {
    runs.announce(SURFACES.len());
    let mut report = Report { title: format!("fig7: tests and shadows, {}", runs.setting()), ..Report::default() };
    let mut table = Table::new(
        "Pixels whose initial beam was blocked",
        ["surface", "red: in shadow, facing", "dark red: in shadow, turned away", "blue: lit after all", "blue share"],
    );
    let mut tiles = vec![];
    for name in SURFACES {
        let scene = preset(name)?;
        let renderer = runs.render(&scene, RenderSpec { method: BEAMS, ..runs.spec.clone() })?;
        let s = renderer.stats();
        let in_shadow = s.partly + s.dark;
        let blue = s.initial_occluded - in_shadow;
        table.row([
            scene.title.clone(),
            grouped(s.in_shadow_facing),
            grouped(in_shadow - s.in_shadow_facing),
            grouped(blue),
            format!("{:.0} %", percent(blue, s.initial_occluded)),
        ]);
        let pair = [overlay(&renderer), Tile::of(renderer.frame())];
        let caption =
            format!("{}: left, blue and red: initial beam blocked; red: in shadow. Right: picture", scene.title);
        report.pictures.push(mosaic(2, &pair).picture(format!("fig7-{name}"), caption)?);
        tiles.extend(pair);
    }
    report.pictures.push(mosaic(2, &tiles).picture("fig7", "Chubs, Kusner-Schmitt, McMullen and Orthocircle")?);
    report.tables.push(table);
    report.notes.push(
        "Dark red: the surface is turned away from the light there, so its own back blocks the beam and the shading \
         is dark anyway."
            .to_owned(),
    );
    Ok(report)
}

const RED: [f32; 3] = [0.85, 0.04, 0.03];
const DARK_RED: [f32; 3] = [0.22, 0.02, 0.02];
const BLUE: [f32; 3] = [0.03, 0.12, 0.85];

/// The picture in grey, with what the initial beams found in colours.
fn overlay(renderer: &Renderer) -> Tile {
    let frame = renderer.frame();
    let light = &frame.lights[0];
    let rgb = (0..frame.rgb.len())
        .map(|i| {
            // Rec. 709 luminance.
            let [r, g, b] = frame.rgb[i];
            let grey = 0.2126 * r + 0.7152 * g + 0.0722 * b;
            match (light.initial_occluded[i], light.visible_lo[i] < 1.0, light.facing[i] > 0.0) {
                (true, true, true) => RED,
                (true, true, false) => DARK_RED,
                (true, false, _) => BLUE,
                (false, ..) => [grey; 3],
            }
        })
        .collect();
    Tile { width: frame.width, height: frame.height, rgb }
}
