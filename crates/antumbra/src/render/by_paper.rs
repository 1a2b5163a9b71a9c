//! The passes of the paper's methods: one beam (or ray) per pixel, sub-beams for its shadow.
use super::given::Traced;
use super::pixel::{Known, Light, Pixel};
use super::task::{Asked, Task};
use crate::eval::Workspace;
use crate::geom::{Beam, Vec3};
use crate::grid::Grid;
use crate::paper::{Find, Method, World, shadow};
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
            let beam = beam(task, index, rays);
            let (column, row) = task.place(index);
            let fan = task.film.fan(column..column + 1, row..row + 1);
            let search = Search { bisection: task.settings.bisection, rays: (!rays).then_some(&fan) };
            let mut cost = Cost::default();
            let find = world.nearest(&beam, Interval::NON_NEGATIVE, search, &mut work, &mut cost);
            pixel(task, index, rays, find, cost, &mut work)
        })
        .collect()
}

/// The same where others have done it.
pub(super) fn traced_primary(task: &Task, traced: &Traced, pixels: impl Iterator<Item = usize>) -> Vec<Pixel> {
    let mut work = Workspace::default();
    pixels
        .map(|index| {
            let found = &traced.pixels[index];
            let cost = Cost { beams: 1, evaluations: found.evaluations.into() };
            pixel(task, index, false, found.find.map(|(object, t)| Find { object, t }), cost, &mut work)
        })
        .collect()
}

/// The beam of a pixel, or the ray through its middle.
fn beam(task: &Task, index: usize, ray: bool) -> Beam {
    let (column, row) = task.place(index);
    if ray { task.film.ray(column, row) } else { task.film.beam(column, row) }
}

fn pixel(task: &Task, index: usize, rays: bool, find: Option<Find>, cost: Cost, work: &mut Workspace) -> Pixel {
    let asked = |find: Find| Asked { object: find.object, beam: beam(task, index, rays), t: find.t, before: None };
    let hit = find.map(|find| task.hit(asked(find), work));
    // A ray that misses proves nothing about the rest of its pixel.
    let known = if find.is_none() && !rays { Known::Empty } else { Known::Undecided(Reason::Resolution) };
    let coverage = if known == Known::Empty { [0.0, 0.0] } else { [0.0, 1.0] };
    Pixel { index, known, coverage, hit, edge: None, cost }
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

/// The same where others have done it.
pub(super) fn traced_shadows(task: &Task, traced: &Traced, hits: impl Iterator<Item = usize>) -> Vec<Light> {
    let tiles = (task.settings.sub_beams * task.settings.sub_beams) as f64;
    let lights = || traced.lights.iter().enumerate();
    hits.flat_map(|index| lights().map(move |(light, all)| (index, light, all[index])))
        .map(|(index, light, found)| {
            let visible = 1.0 - f64::from(found.blocked) / tiles;
            let [initial, sub] =
                [0, 1].map(|k| Cost { beams: found.beams[k].into(), evaluations: found.evaluations[k] });
            let first_occluded = found.initial_occluded;
            Light { index, light, lo: visible, hi: visible, reason: None, first_occluded, initial, sub }
        })
        .collect()
}
