//! The walk of a beam through the grid, row by row (paper, "Beam Traversal").
#![deny(clippy::float_arithmetic)]
use super::Grid;
use crate::geom::Beam;
use antumbra_interval::Interval;
use std::ops::Range;

/// The cells of one row of the grid that a beam may touch.
#[derive(Clone, Debug)]
pub struct Row {
    axis: usize,
    index: usize,
    t: Interval,
    across: [(usize, Range<usize>); 2],
}

/// Which way a beam runs: the axis with the largest component among its normalised corner directions (paper), and
/// whether it ascends along it. A heuristic: any choice is sound.
fn main_direction(beam: &Beam) -> (usize, bool) {
    // The largest component of a corner's unit vector belongs to the axis with the largest absolute component of that
    // corner; over all corners of the box this is the axis of the largest mignitude, unless the box is wider than far.
    // Ties and such beams: the largest magnitude.
    let reach = |axis: usize| (beam.direction[axis].abs().lo(), beam.direction[axis].magnitude());
    let axis = (1..3).fold(0, |best, axis| if reach(axis) > reach(best) { axis } else { best });
    (axis, beam.direction[axis].mid() >= 0.0)
}

/// The rows that a beam meets at parameters in `t >= 0`, in the order of its main direction.
pub fn rows<'a>(grid: &'a Grid, beam: &'a Beam, t: Interval) -> impl Iterator<Item = Row> + 'a {
    let (axis, ascending) = main_direction(beam);
    let n = grid.resolution();
    // All rows that the beam can reach at all: its whole extent along the axis.
    let reach = grid.cells_meeting(axis, beam.at(t)[axis]);
    let across = [(axis + 1) % 3, (axis + 2) % 3];
    (0..n).map(move |k| if ascending { k } else { n - 1 - k }).filter(move |k| reach.contains(k)).filter_map(
        move |index| {
            // Paper: T = (Z - z0) / (Z_a - z0), then X = x0 + T (X_a - x0).
            let t = beam.parameters_in(axis, grid.cell(axis, index)).intersection(t);
            if t.is_empty() {
                return None;
            }
            let at = beam.at(t);
            let across = across.map(|axis| (axis, grid.cells_meeting(axis, at[axis])));
            Some(Row { axis, index, t, across })
        },
    )
}

impl Row {
    /// Parameters at which the beam may be in this row.
    #[must_use]
    pub fn t(&self) -> Interval {
        self.t
    }

    /// The marked cells of the row that the beam may touch, as the parameters at which it does:
    /// `T_c`, the intersection of the three slab intervals (paper).
    pub fn crossings<'a>(&'a self, grid: &'a Grid, beam: &'a Beam) -> impl Iterator<Item = Interval> + 'a {
        let [(u, columns), (v, lines)] = &self.across;
        lines.clone().flat_map(move |j| columns.clone().map(move |i| (i, j))).filter_map(move |(i, j)| {
            let mut cell = [0; 3];
            (cell[self.axis], cell[*u], cell[*v]) = (self.index, i, j);
            if !grid.possibly_crossed(cell) {
                return None;
            }
            let t = self
                .t
                .intersection(beam.parameters_in(*u, grid.cell(*u, i)))
                .intersection(beam.parameters_in(*v, grid.cell(*v, j)));
            (!t.is_empty()).then_some(t)
        })
    }
}
