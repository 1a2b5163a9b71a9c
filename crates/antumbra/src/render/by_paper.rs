//! The passes of the paper's methods: one beam (or ray) per pixel, sub-beams for its shadow.
use super::pixel::{Known, Light, Pixel};
use super::task::{Asked, Task};
use crate::eval::Workspace;
use crate::geom::Vec3;
use crate::grid::Grid;
use crate::paper::{Method, World, shadow};
use crate::scene::Light as Emitter;
use crate::trace::{Cost, Search, Target};
use crate::verdict::Reason;
use antumbra_interval::Interval;

/// The grids of all objects but the floor, which needs none.
pub(super) fn grids(task: &Task, n: usize) -> Vec<Grid> {
    let objects = &task.objects[..task.objects.len() - usize::from(task.has_floor)];
    objects.iter().map(|o| Grid::build(o.surface.as_ref(), o.clip().bounds(), n)).collect()
}

fn world<'a>(task: &'a Task, grids: &'a [Grid]) -> World<'a> {
    let targets =
        task.objects.iter().zip(grids).map(|(o, grid)| Target { function: o.surface.as_ref(), grid }).collect();
    World { targets, floor: task.has_floor.then_some(task.scene.floor_height) }
}

/// Beam casting (paper, section 3).
pub(super) fn primary(task: &Task, grids: &[Grid], pixels: impl Iterator<Item = usize>, rays: bool) -> Vec<Pixel> {
    let (world, mut work) = (world(task, grids), Workspace::default());
    pixels
        .map(|index| {
            let (column, row) = task.place(index);
            let beam = if rays { task.film.ray(column, row) } else { task.film.beam(column, row) };
            let mut cost = Cost::default();
            let fan = task.film.fan(column..column + 1, row..row + 1);
            let search = Search { bisection: task.settings.bisection, rays: (!rays).then_some(&fan) };
            let find = world.nearest(&beam, Interval::NON_NEGATIVE, search, &mut work, &mut cost);
            let hit =
                find.map(|find| task.hit(Asked { object: find.object, beam, t: find.t, before: None }, &mut work));
            // A ray that misses proves nothing about the rest of its pixel.
            let known = if find.is_none() && !rays { Known::Empty } else { Known::Undecided(Reason::Resolution) };
            let coverage = if known == Known::Empty { [0.0, 0.0] } else { [0.0, 1.0] };
            Pixel { index, known, coverage, hit, edge: None, cost }
        })
        .collect()
}

/// Shadow beams of the given hits.
pub(super) fn shadows(
    task: &Task,
    grids: &[Grid],
    method: Method,
    hits: impl Iterator<Item = (usize, Vec3)>,
) -> Vec<Light> {
    let (world, mut work) = (world(task, grids), Workspace::default());
    let lights = || task.lights.iter().enumerate();
    hits.flat_map(|(index, point)| lights().map(move |(k, light)| (index, point, k, light)))
        .map(|(index, point, light, Emitter { rect, .. })| {
            // Other random rays for each light.
            let (column, row) = task.place(index);
            let salt = (row * task.film.width + column) as u64 ^ (light as u64) << 48;
            let found = shadow(&world, &task.settings, method, point, rect, salt, &mut work);
            let visible = 1.0 - found.index;
            Light {
                index,
                light,
                lo: visible,
                hi: visible,
                reason: None,
                first_occluded: found.initial_occluded,
                initial: found.initial,
                sub: found.sub,
            }
        })
        .collect()
}
