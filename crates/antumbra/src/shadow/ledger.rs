//! What of a light is settled, and which parts are open: the bookkeeping of a best-first subdivision.
use antumbra_interval::Interval;
use antumbra_interval::round::{add_down, add_up, mul_down, mul_up, sub_down, sub_up};
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// A part of a light that is partly unknown, and `rest`: what its method wants to remember of it.
#[derive(Clone, Debug)]
pub(super) struct Node<T> {
    unknown: f64,
    /// Parameters u, v of the light.
    pub(super) part: [Interval; 2],
    /// Bounds of its visible share of the whole light.
    lit: f64,
    open: f64,
    pub(super) rest: T,
}

impl<T> PartialEq for Node<T> {
    fn eq(&self, o: &Self) -> bool {
        self.cmp(o) == Ordering::Equal
    }
}

impl<T> Eq for Node<T> {}

impl<T> PartialOrd for Node<T> {
    fn partial_cmp(&self, o: &Self) -> Option<Ordering> {
        Some(self.cmp(o))
    }
}

impl<T> Ord for Node<T> {
    /// By the unknown area; equal ones by place, so that the order is always the same.
    fn cmp(&self, o: &Self) -> Ordering {
        self.unknown
            .total_cmp(&o.unknown)
            .then_with(|| o.part[0].lo().total_cmp(&self.part[0].lo()))
            .then_with(|| o.part[1].lo().total_cmp(&self.part[1].lo()))
    }
}

/// Shares of the whole light: they add up to 1.
#[derive(Debug)]
pub(super) struct Ledger<T> {
    /// Bounds of what is certainly lit among the settled parts.
    lit: [f64; 2],
    /// Whether some part is not lit all over.
    shaded: bool,
    heap: BinaryHeap<Node<T>>,
    /// Upper bound of the unknown area of the open parts.
    unknown: f64,
}

impl<T> Default for Ledger<T> {
    fn default() -> Self {
        Self { lit: [0.0; 2], shaded: false, heap: BinaryHeap::new(), unknown: 0.0 }
    }
}

impl<T> Ledger<T> {
    /// Begins anew.
    pub(super) fn clear(&mut self) {
        self.heap.clear();
        (self.lit, self.shaded, self.unknown) = ([0.0; 2], false, 0.0);
    }

    /// Settled parts whose lit area is within the bounds.
    pub(super) fn lit(&mut self, [lo, hi]: [f64; 2]) {
        self.lit = [add_down(self.lit[0], lo), add_up(self.lit[1], hi)];
    }

    /// A settled part that is not lit all over.
    pub(super) fn shaded(&mut self) {
        self.shaded = true;
    }

    /// A part of which the share `lit` is certainly visible, and at most the share `open`.
    pub(super) fn open(&mut self, part: [Interval; 2], [lit, open]: [f64; 2], rest: T) {
        let area = area(part);
        let (lit, open) = (mul_down(area[0], lit), mul_up(area[1], open));
        let unknown = sub_up(open, lit);
        self.unknown = add_up(self.unknown, unknown);
        self.heap.push(Node { unknown, part, lit, open, rest });
    }

    /// Takes out the part with the largest unknown area.
    pub(super) fn next(&mut self) -> Option<Node<T>> {
        let node = self.heap.pop()?;
        // Rounded up, so the sum may creep upwards, by far less than a tolerance.
        self.unknown = if self.heap.is_empty() { 0.0 } else { sub_up(self.unknown, node.unknown) };
        Some(node)
    }

    /// Upper bound of the width of [`Ledger::bounds`], up to rounding.
    pub(super) fn unknown(&self) -> f64 {
        self.unknown
    }

    /// Whether nothing is open.
    pub(super) fn settled(&self) -> bool {
        self.heap.is_empty()
    }

    /// Whether every part is proved lit: rounded sums would not say so.
    pub(super) fn all_lit(&self) -> bool {
        self.settled() && !self.shaded
    }

    /// Bounds of the visible fraction.
    pub(super) fn bounds(&self) -> [f64; 2] {
        if self.all_lit() {
            return [1.0; 2];
        }
        let lo = self.heap.iter().fold(self.lit[0], |sum, node| add_down(sum, node.lit));
        let hi = self.heap.iter().fold(self.lit[1], |sum, node| add_up(sum, node.open));
        [lo.clamp(0.0, 1.0), hi.clamp(0.0, 1.0)]
    }
}

/// Bounds of the share of the light that a part covers: a quarter of its area in parameters.
pub(super) fn area([u, v]: [Interval; 2]) -> [f64; 2] {
    let low = mul_down(sub_down(u.hi(), u.lo()), sub_down(v.hi(), v.lo()));
    let high = mul_up(sub_up(u.hi(), u.lo()), sub_up(v.hi(), v.lo()));
    [mul_down(0.25, low), mul_up(0.25, high)]
}
