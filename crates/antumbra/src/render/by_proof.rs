//! Shadows by the certified method: blocks of hits that are divided until everything is proved or counted.
use super::given::Given;
use super::pixel::Light;
use super::spare::Scratch;
use super::task::Task;
use crate::shadow::{Asking, Known, Placed, Receiver, Shaft, Tile, look, visibles};
use crate::trace::Cost;
use smallvec::SmallVec;
use std::ops::Range;
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

/// Hits of a block of the picture that look at a light together.
struct Group {
    light: usize,
    /// Column and row of the block.
    corner: [u32; 2],
    /// Which hits, as a section of the order in which they are looked at.
    hits: Range<usize>,
    /// What shafts have found out for all of them.
    sees: Rc<Known>,
    /// What that has cost: it is booked on the first pixel.
    owed: Cost,
}

/// The hits of a tile.
#[derive(Default)]
struct Hits {
    placed: Vec<Placed>,
    pixels: Vec<usize>,
    /// For each light, the hits that ask for it; in the end as their blocks follow each other, row by row in the smallest ones.
    order: Vec<u32>,
}

impl Hits {
    fn of<'a>(&'a self, group: &Group) -> impl Iterator<Item = &'a Placed> + Clone + use<'a> {
        self.order[group.hits.clone()].iter().map(|hit| &self.placed[*hit as usize])
    }

    /// The groups of the quarters of a group's block that have hits.
    fn quarter(&mut self, group: Group, half: u32, quarters: &mut Vec<Group>) {
        let Group { light, corner: [column, row], hits, sees, mut owed } = group;
        let old: SmallVec<[u32; 64]> = self.order[hits.clone()].into();
        let mut end = hits.start;
        for corner in [[column, row], [column + half, row], [column, row + half], [column + half, row + half]] {
            let begin = end;
            for hit in &old {
                let [right, down] = self.placed[*hit as usize].place;
                if (right >= column + half, down >= row + half) == (corner[0] > column, corner[1] > row) {
                    self.order[end] = *hit;
                    end += 1;
                }
            }
            if begin < end {
                let owed = std::mem::take(&mut owed);
                quarters.push(Group { light, corner, hits: begin..end, sees: Rc::clone(&sees), owed });
            }
        }
    }
}

/// Shadows of the hits of the block at `(column, row)`; `receiver_of` gives the proved hit of a pixel, if it has one. Brackets that are
/// given, and narrow enough, are not looked for.
pub(super) fn shadows(
    task: &Task,
    column: usize,
    row: usize,
    receiver_of: &dyn Fn(usize) -> Option<Receiver>,
    given: Option<&Given>,
    Scratch { work, shadows: scratch, .. }: &mut Scratch,
) -> Vec<Light> {
    let surfaces = task.surfaces();
    scratch.begin();
    let mut out = Vec::new();
    let known = |light: usize, index: usize| given.and_then(|g| g.light(light, index));
    let narrow = |[lo, hi]: &[f64; 2]| hi - lo <= task.tolerance.width;
    for light in 0..task.lights.len() {
        for index in indices(task, (column, row, BLOCK)) {
            if let Some([lo, hi]) = known(light, index).filter(narrow) {
                out.push(Light { index, light, lo, hi, first_occluded: lo < 1.0, ..Light::default() });
            }
        }
    }
    let mut hits = Hits::default();
    let proved = |index| Some((index, receiver_of(index)?));
    let proved: Vec<(usize, Receiver)> = indices(task, (column, row, BLOCK)).filter_map(proved).collect();
    let placed = |&(index, receiver): &(usize, Receiver)| {
        let (column, row) = task.place(index);
        Placed::new([column as u32, row as u32], receiver)
    };
    hits.placed.extend(proved.iter().map(placed));
    hits.pixels.extend(proved.iter().map(|(index, _)| index));
    let mut groups = Vec::new();
    let (nothing, corner) = (Rc::new(Known::nothing(&surfaces)), [column as u32, row as u32]);
    for light in 0..task.lights.len() {
        let asks = |index: usize| known(light, index).is_none_or(|bracket| !narrow(&bracket));
        let (begin, all) = (hits.order.len(), (0_u32..).zip(&hits.pixels));
        hits.order.extend(all.filter(|(_, index)| asks(**index)).map(|(hit, _)| hit));
        let section = begin..hits.order.len();
        if !section.is_empty() {
            groups.push(Group { light, corner, hits: section, sees: Rc::clone(&nothing), owed: Cost::default() });
        }
    }
    // Level by level, so that the shafts of all blocks of a level go in lockstep.
    let (mut side, mut done) = (BLOCK as u32, Vec::new());
    while !groups.is_empty() {
        let (mut tiles, mut places) = (Vec::with_capacity(groups.len()), Vec::with_capacity(groups.len()));
        for (place, group) in groups.iter().enumerate().filter(|(_, group)| group.hits.len() >= 2) {
            if let Some(shaft) = Shaft::fit(hits.of(group))
                && (side <= 4 || !shaft.rough())
            {
                tiles.push(Tile { shaft, light: &task.lights[group.light].rect, known: &group.sees });
                places.push(place);
            }
        }
        let mut found = Vec::with_capacity(tiles.len());
        look(&surfaces, &tiles, scratch, work, |known, cost| found.push((known, cost)));
        for (place, (sees, cost)) in places.into_iter().zip(found) {
            groups[place].sees = Rc::new(sees);
            groups[place].owed += cost;
        }
        let whole = std::mem::take(&mut groups);
        for group in whole {
            if side > 2 && group.hits.len() >= 2 && !group.sees.settled() {
                hits.quarter(group, side / 2, &mut groups);
            } else {
                done.push(group);
            }
        }
        side /= 2;
    }
    done.sort_unstable_by_key(|group| group.hits.start);
    let (mut asking, mut places) = (Vec::new(), Vec::new());
    for Group { light, hits: section, sees, owed, .. } in &done {
        let (light, mut owed) = (*light, *owed);
        let settled = sees.settled().then(|| sees.bounds());
        for hit in &hits.order[section.clone()] {
            let (hit, initial) = (*hit as usize, std::mem::take(&mut owed));
            let index = hits.pixels[hit];
            if let Some([lo, hi]) = settled {
                let first_occluded = !(sees.whole() && lo == 1.0);
                out.push(Light { index, light, lo, hi, first_occluded, initial, ..Light::default() });
            } else {
                let (receiver, rect) = (&hits.placed[hit].receiver, &task.lights[light].rect);
                asking.push(Asking { receiver, light: rect, known: sees });
                places.push(out.len());
                out.push(Light { index, light, initial, ..Light::default() });
            }
        }
    }
    let found = visibles(&surfaces, &asking, task.tolerance, scratch, work);
    for (place, (bracket, cost)) in places.into_iter().zip(found) {
        let out = &mut out[place];
        // Both brackets hold, so they meet.
        let [lo, hi] = known(out.light, out.index).unwrap_or([0.0, 1.0]);
        (out.lo, out.hi) = (lo.max(bracket.lo), hi.min(bracket.hi));
        out.reason = bracket.reason.filter(|_| !narrow(&[out.lo, out.hi]));
        (out.first_occluded, out.sub) = (!bracket.first_free, cost);
    }
    // Only that of the other passes is told.
    work.take_occupancy();
    out
}
