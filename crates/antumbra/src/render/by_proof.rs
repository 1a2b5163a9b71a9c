//! Shadows by the certified method: blocks of hits that are divided until everything is proved or counted.
use super::pixel::Light;
use super::task::Task;
use crate::eval::Workspace;
use crate::shadow::{self, Receiver, Shaft, ShaftVerdict, shaft, visible, whole_beam};
use crate::trace::{Cost, Piece};

/// Side of the blocks that both passes start with: a power of two.
pub(super) const BLOCK: usize = 32;
/// A part of the picture: column, row and side, which may reach over the picture's border.
pub(super) type Block = (usize, usize, usize);

/// Indices of the pixels of a block, row by row.
pub(super) fn indices(task: &Task, (column, row, side): Block) -> impl Iterator<Item = usize> + use<> {
    let (width, height) = (task.film.width, task.film.height);
    let columns = column..(column + side).min(width);
    (row..(row + side).min(height)).flat_map(move |row| columns.clone().map(move |column| row * width + column))
}

/// Shadows of the hits of the block at `(column, row)`; `receiver_of` gives the proved hit of a pixel, if it has one.
pub(super) fn shadows<'a>(
    task: &Task,
    column: usize,
    row: usize,
    receiver_of: &(dyn Fn(usize) -> Option<&'a Receiver> + 'a),
) -> Vec<Light> {
    let surfaces = task.surfaces();
    let (mut work, mut scratch, mut stack) = (Workspace::default(), shadow::Scratch::default(), Vec::new());
    let mut out = Vec::new();
    // What a shaft costs is booked on the first pixel below it.
    let mut owed = Cost::default();
    let start = |light| ((column, row, BLOCK), light, whole_beam(&surfaces));
    let mut blocks: Vec<(Block, usize, Vec<Piece>)> = (0..task.lights.len()).rev().map(start).collect();
    while let Some((block, light, mut pieces)) = blocks.pop() {
        let rect = &task.lights[light].rect;
        let hits: Vec<(usize, &Receiver)> =
            indices(task, block).filter_map(|index| Some((index, receiver_of(index)?))).collect();
        if hits.is_empty() {
            continue;
        }
        let (column, row, side) = block;
        if hits.len() >= 2 {
            let placed: Vec<(u32, u32, &Receiver)> = hits
                .iter()
                .map(|(index, r)| ((index % task.film.width) as u32, (index / task.film.width) as u32, *r))
                .collect();
            if let Some(fit) = Shaft::fit(&placed)
                && (side <= 4 || !fit.rough())
            {
                let mut open = Vec::new();
                let found = shaft(&surfaces, &fit, rect, &pieces, &mut open, &mut stack, &mut work, &mut owed);
                if found != ShaftVerdict::Open {
                    let visible = f64::from(u8::from(found == ShaftVerdict::Lit));
                    for (index, _) in hits {
                        let initial = std::mem::take(&mut owed);
                        let first_occluded = found == ShaftVerdict::Dark;
                        out.push(Light {
                            index,
                            light,
                            lo: visible,
                            hi: visible,
                            first_occluded,
                            initial,
                            ..Light::default()
                        });
                    }
                    continue;
                }
                pieces = open;
            }
        }
        if side > 2 && hits.len() >= 2 {
            let half = side / 2;
            for (down, right) in [(1, 1), (1, 0), (0, 1), (0, 0)] {
                blocks.push(((column + right * half, row + down * half, half), light, pieces.clone()));
            }
            continue;
        }
        for (index, receiver) in hits {
            let mut cost = Cost::default();
            let bracket =
                visible(&surfaces, receiver, rect, &pieces, task.tolerance, &mut scratch, &mut work, &mut cost);
            out.push(Light {
                index,
                light,
                lo: bracket.lo,
                hi: bracket.hi,
                reason: bracket.reason,
                first_occluded: !bracket.first_free,
                initial: std::mem::take(&mut owed),
                sub: cost,
            });
        }
    }
    out
}
