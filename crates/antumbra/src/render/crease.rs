//! Smooth inner edges: where one part of a surface passes before another, where surfaces cross, where a surface bends sharply.
//! Pixels that are proved hit show such an edge as a stair; a grid of rays in each gives its colour. Nothing here is
//! certified, and nothing changes what is.
use super::hits::{Fringe, Seen};
use super::pixel::Edge;
use super::spare::Scratch;
use super::task::{Asked, Task};
use super::visibility::EDGE_RAYS;
use crate::eval::Occupancy;
use crate::geom::Beam;
use crate::trace::{Cost, Frustum, Known, Meeting, Ray, first_meetings, narrow};

/// Cosine between the normals of neighbours from which they are one smooth surface.
const BEND: f64 = 0.9;
/// Sine of the angle between a surface and the line to the neighbour's hit, up to which that lies on it.
const STEP: f64 = 0.35;

/// Whether an edge runs between the hits of two neighbouring pixels.
pub(super) fn apart(a: &Seen, b: &Seen) -> bool {
    let between = b.point - a.point;
    let off = between.dot(a.normal).abs().max(between.dot(b.normal).abs());
    a.object() != b.object() || a.normal.dot(b.normal) < BEND || off > STEP * between.length()
}

/// The grids of rays of some pixels, what they cost, and how full their batches were.
pub(super) type Grids = (Vec<(usize, Fringe)>, Cost, Occupancy);

/// What a grid of rays meets in each of some pixels.
pub(super) fn grids(task: &Task, pixels: &[usize], scratch: &mut Scratch) -> Grids {
    const RAYS: usize = EDGE_RAYS * EDGE_RAYS;
    let surfaces = task.surfaces();
    let Scratch { work, frusta, rays, hits, .. } = scratch;
    let fan = |&index: &usize| {
        let (column, row) = task.place(index);
        task.film.fan(column..column + 1, row..row + 1)
    };
    let fans: Vec<_> = pixels.iter().map(fan).collect();
    let nothing: Vec<Known> = fans.iter().map(|fan| Known::nothing(&surfaces, fan)).collect();
    let jobs: Vec<_> = fans.into_iter().zip(&nothing).map(|(fan, parent)| Frustum { fan, parent }).collect();
    let (mut open, mut cost) = (Vec::with_capacity(pixels.len()), Cost::default());
    narrow(&surfaces, &jobs, frusta, work, |_, known, spent| {
        open.push(std::mem::take(known));
        cost += spent;
    });
    let beams: Vec<Beam> = pixels
        .iter()
        .flat_map(|&index| {
            let (column, row) = task.place(index);
            (0..RAYS).map(move |k| task.film.sub_ray(column, row, k % EDGE_RAYS, k / EDGE_RAYS, EDGE_RAYS))
        })
        .collect();
    let ray = |(k, beam): (usize, &Beam)| {
        let known: &Known = &open[k / RAYS];
        Ray { beam: *beam, open: &known.open, inside: known.inside }
    };
    let asked: Vec<Ray<'_>> = beams.iter().enumerate().map(ray).collect();
    let mut met: Vec<(usize, Meeting)> = Vec::with_capacity(beams.len());
    first_meetings(&surfaces, &asked, task.glance, rays, work, |k, meeting, spent| {
        met.extend(meeting.map(|m| (k, m)));
        cost += spent;
    });
    let all: Vec<Asked> =
        met.iter().map(|(k, m)| Asked { object: m.surface, beam: beams[*k], t: m.t, before: m.before }).collect();
    let mut grids = vec![vec![None; RAYS]; pixels.len()];
    task.hits(&all, hits, work, |k, hit| {
        let k = met[k].0;
        grids[k / RAYS][k % RAYS] = Some(hit);
    });
    let edges =
        pixels.iter().zip(grids).map(|(&index, rays)| (index, Fringe::from(&Edge { rays, thin: None }))).collect();
    (edges, cost, work.take_occupancy())
}
