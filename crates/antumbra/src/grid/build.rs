//! Building the grid.
#![deny(clippy::float_arithmetic)]
use crate::eval::{Inclusion, Workspace};
use crate::geom::Box3;
use antumbra_interval::Interval;
use rayon::prelude::*;
use std::ops::Range;

/// `n x n x n` cells that cover a box; a cell is marked unless the inclusion function proved that no zero lies in it.
#[derive(Clone, Debug)]
pub struct Grid {
    n: usize,
    /// Enclosing intervals of the cells along each axis, ascending; neighbours overlap by their rounding errors.
    cells: [Vec<Interval>; 3],
    marked: Vec<bool>,
    bounds: Box3,
}

impl Grid {
    /// Evaluates the inclusion function over each of the `n^3` cells of `bounds` (paper: "the united extension
    /// F(X, Y, Z) is used"), `bounds` being those of the surface's region, which must be bounded. Runs on the threads of the current rayon pool.
    #[must_use]
    pub fn build(f: &dyn Inclusion, bounds: Box3, n: usize) -> Self {
        let cells: [Vec<Interval>; 3] = std::array::from_fn(|axis| slabs(bounds[axis], n));
        let marked = (0..n * n)
            .into_par_iter()
            .flat_map_iter(|layer| {
                let (y, z) = (cells[1][layer % n], cells[2][layer / n]);
                let mut work = Workspace::default();
                let cells_x = &cells[0];
                (0..n).map(move |i| f.range(&Box3([cells_x[i], y, z]), &mut work).possibly_zero())
            })
            .collect();
        Self { n, cells, marked, bounds }
    }

    /// Cells per axis.
    #[must_use]
    pub fn resolution(&self) -> usize {
        self.n
    }

    /// The box that the cells cover.
    #[must_use]
    pub fn bounds(&self) -> Box3 {
        self.bounds
    }

    /// Evaluations that building took.
    #[must_use]
    pub fn evaluations(&self) -> u64 {
        (self.n * self.n * self.n) as u64
    }

    /// How many cells may be crossed.
    #[must_use]
    pub fn marked_count(&self) -> usize {
        self.marked.iter().filter(|m| **m).count()
    }

    /// Whether the surface may cross the cell; false is a proof.
    #[must_use]
    #[inline]
    pub fn possibly_crossed(&self, cell: [usize; 3]) -> bool {
        self.marked[(cell[2] * self.n + cell[1]) * self.n + cell[0]]
    }

    /// The interval of cell `index` along an axis.
    #[must_use]
    #[inline]
    pub fn cell(&self, axis: usize, index: usize) -> Interval {
        self.cells[axis][index]
    }

    /// Indices of all cells along an axis that meet `range`.
    #[must_use]
    #[inline]
    pub fn cells_meeting(&self, axis: usize, range: Interval) -> Range<usize> {
        let cells = &self.cells[axis];
        // Cell ends ascend, so both are searches in a sorted list: first cell that does not end before the range ...
        let start = cells.partition_point(|c| c.hi() < range.lo());
        // ... up to the first cell that begins after it.
        let end = cells.partition_point(|c| c.lo() <= range.hi());
        start..end.max(start)
    }
}

/// `n` intervals that cover `range`, by the enclosed edges `lo + k (hi - lo) / n`.
fn slabs(range: Interval, n: usize) -> Vec<Interval> {
    assert!(range.lo().is_finite() && range.hi().is_finite(), "a grid needs a bounded box");
    let (lo, hi) = (Interval::point(range.lo()), Interval::point(range.hi()));
    let edge = |k: usize| lo + (hi - lo) * (Interval::point(k as f64) / Interval::point(n as f64));
    (0..n).map(|k| edge(k).hull(edge(k + 1))).collect()
}
