//! Smooth inner edges: where one part of a surface passes before another, where surfaces cross, where a surface bends sharply.
//! Pixels that are proved hit show such an edge as a stair; a grid of rays in each gives its colour. Nothing here is
//! certified, and nothing changes what is.
use super::by_proof::EDGE_RAYS;
use super::pixel::{Edge, Hit};
use super::task::Task;
use crate::eval::Workspace;
use crate::trace::{Cost, Known, Scratch, first_meeting, narrow};

/// Cosine between the normals of neighbours from which they are one smooth surface.
const BEND: f64 = 0.9;
/// Sine of the angle between a surface and the line to the neighbour's hit, up to which that lies on it.
const STEP: f64 = 0.35;

/// Whether an edge runs between the hits of two neighbouring pixels.
pub(super) fn apart(a: &Hit, b: &Hit) -> bool {
    let between = b.point - a.point;
    let off = between.dot(a.normal).abs().max(between.dot(b.normal).abs());
    a.object != b.object || a.normal.dot(b.normal) < BEND || off > STEP * between.length()
}

/// What a grid of rays meets in each of some pixels.
pub(super) fn grids(task: &Task, pixels: &[usize]) -> (Vec<(usize, Edge)>, Cost) {
    let surfaces = task.surfaces();
    let (mut work, mut stack, mut scratch) = (Workspace::default(), Vec::new(), Scratch::default());
    let mut cost = Cost::default();
    let grid = |&index: &usize| {
        let (column, row) = (index % task.film.width, index / task.film.width);
        let fan = task.film.fan(column..column + 1, row..row + 1);
        let open = narrow(&surfaces, &fan, &Known::nothing(&surfaces, &fan), &mut stack, &mut work, &mut cost);
        let mut meet = |k: usize| {
            let ray = task.film.sub_ray(column, row, k % EDGE_RAYS, k / EDGE_RAYS, EDGE_RAYS);
            let found = first_meeting(&surfaces, &ray, &open.open, task.glance, &mut scratch, &mut work, &mut cost)?;
            Some(task.hit(found.surface, &ray, found.t, found.before, &mut work))
        };
        (index, Edge { rays: (0..EDGE_RAYS * EDGE_RAYS).map(&mut meet).collect(), thin: None })
    };
    let edges = pixels.iter().map(grid).collect();
    (edges, cost)
}
