//! Shadows by the certified method: blocks of hits that are divided until everything is proved or counted.
use super::given::Given;
use super::pixel::Light;
use super::task::Task;
use crate::eval::Workspace;
use crate::geom::Rect;
use crate::shadow::{self, Asking, Known, Part, Receiver, Shaft, ShaftVerdict, shaft, visibles};
use crate::trace::{Cost, Surface};
use std::rc::Rc;

/// Side of the blocks that both passes start with: a power of two.
pub(super) const BLOCK: usize = 32;
/// A part of the picture: column, row and side, which may reach over the picture's border.
pub(super) type Block = (usize, usize, usize);

/// Indices of the pixels of a block, row by row.
pub(super) fn indices(task: &Task, (column, row, side): Block) -> impl Iterator<Item = usize> + use<> {
    let width = task.film.width;
    let columns = column..(column + side).min(width);
    let rows = task.indices(row..(row + side).min(task.window.held().end));
    rows.step_by(width).flat_map(move |left| columns.clone().map(move |column| left + column))
}

/// A hit that no shaft settled.
struct Alone<'a> {
    /// Where its answer goes.
    place: usize,
    receiver: &'a Receiver,
    light: &'a Rect,
    /// What shafts have found out for it and its neighbours.
    sees: Rc<Known>,
}

/// Shadows of the hits of the block at `(column, row)`; `receiver_of` gives the proved hit of a pixel, if it has one. Brackets that are
/// given, and narrow enough, are not looked for.
pub(super) fn shadows<'a>(
    task: &Task,
    column: usize,
    row: usize,
    receiver_of: &(dyn Fn(usize) -> Option<&'a Receiver> + 'a),
    given: Option<&Given>,
) -> Vec<Light> {
    let surfaces = task.surfaces();
    let (mut work, mut scratch) = (Workspace::default(), shadow::Scratch::default());
    let (mut out, mut alone) = (Vec::new(), Vec::new());
    // What a shaft costs is booked on the first pixel below it.
    let mut owed = Cost::default();
    let start = |light| ((column, row, BLOCK), light, Known::nothing(&surfaces));
    let known = |light: usize, index: usize| given.and_then(|g| g.light(light, index));
    let narrow = |[lo, hi]: &[f64; 2]| hi - lo <= task.tolerance.width;
    for light in 0..task.lights.len() {
        for index in indices(task, (column, row, BLOCK)) {
            if let Some([lo, hi]) = known(light, index).filter(narrow) {
                out.push(Light { index, light, lo, hi, first_occluded: lo < 1.0, ..Light::default() });
            }
        }
    }
    let mut blocks: Vec<(Block, usize, Known)> = (0..task.lights.len()).rev().map(start).collect();
    while let Some((block, light, mut sees)) = blocks.pop() {
        let rect = &task.lights[light].rect;
        let hits: Vec<(usize, &Receiver)> = indices(task, block)
            .filter(|index| known(light, *index).is_none_or(|bracket| !narrow(&bracket)))
            .filter_map(|index| Some((index, receiver_of(index)?)))
            .collect();
        if hits.is_empty() {
            continue;
        }
        let (column, row, side) = block;
        if hits.len() >= 2 {
            let placed: Vec<(u32, u32, &Receiver)> = hits
                .iter()
                .map(|(index, r)| {
                    let (column, row) = task.place(*index);
                    (column as u32, row as u32, *r)
                })
                .collect();
            if let Some(fit) = Shaft::fit(&placed)
                && (side <= 4 || !fit.rough())
            {
                look(&surfaces, &fit, rect, &mut sees, &mut scratch, &mut work, &mut owed);
                if sees.settled() {
                    let [lo, hi] = sees.bounds();
                    for (index, _) in hits {
                        let initial = std::mem::take(&mut owed);
                        let first_occluded = !(sees.whole() && lo == 1.0);
                        out.push(Light { index, light, lo, hi, first_occluded, initial, ..Light::default() });
                    }
                    continue;
                }
            }
        }
        if side > 2 && hits.len() >= 2 {
            let half = side / 2;
            for (down, right) in [(1, 1), (1, 0), (0, 1), (0, 0)] {
                blocks.push(((column + right * half, row + down * half, half), light, sees.clone()));
            }
            continue;
        }
        let sees = Rc::new(sees);
        for (index, receiver) in hits {
            let initial = std::mem::take(&mut owed);
            alone.push(Alone { place: out.len(), receiver, light: rect, sees: Rc::clone(&sees) });
            out.push(Light { index, light, initial, ..Light::default() });
        }
    }
    let asking: Vec<Asking<'_>> =
        alone.iter().map(|a| Asking { receiver: a.receiver, light: a.light, known: &a.sees }).collect();
    let found = visibles(&surfaces, &asking, task.tolerance, &mut scratch, &mut work);
    for (Alone { place, .. }, (bracket, cost)) in alone.iter().zip(found) {
        let out = &mut out[*place];
        // Both brackets hold, so they meet.
        let [lo, hi] = known(out.light, out.index).unwrap_or([0.0, 1.0]);
        (out.lo, out.hi) = (lo.max(bracket.lo), hi.min(bracket.hi));
        out.reason = bracket.reason.filter(|_| !narrow(&[out.lo, out.hi]));
        (out.first_occluded, out.sub) = (!bracket.first_free, cost);
    }
    out
}

/// Tests the open parts of a light for all hits of a tile. A light that is wide against the tile is divided once: then the hits
/// inherit what is open of each quarter, or that nothing is.
fn look(
    surfaces: &[Surface<'_>],
    fit: &Shaft,
    light: &Rect,
    sees: &mut Known,
    scratch: &mut shadow::Scratch,
    work: &mut Workspace,
    cost: &mut Cost,
) {
    let mut parts = sees.take_open();
    while let Some(part) = parts.pop() {
        match shaft(surfaces, fit, light, &part, scratch, work, cost) {
            ShaftVerdict::Lit => sees.lit(&part),
            ShaftVerdict::Dark => sees.shaded(),
            ShaftVerdict::Open(open) => {
                let part = Part { pieces: open.to_vec(), ..part };
                if sees.whole() && fit.narrow_against(light) {
                    parts.extend(sees.divide(&part));
                } else {
                    sees.open(part);
                }
            }
        }
    }
}
