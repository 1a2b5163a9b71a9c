//! The memory of a batch.
use super::sealed::{Act, Operation};
use super::vector::{Eight, WIDTH};
use super::{Arithmetic, Level, MOST, Packed};

/// Slots of a batch: each holds one number per lane. Scratch memory: keep it, it only grows.
#[derive(Clone, Debug)]
pub struct Block<F> {
    memory: Vec<Eight>,
    vectors: usize,
    /// Slots that hold the same number in all lanes: only their first vector counts.
    uniform: Vec<bool>,
    kind: std::marker::PhantomData<F>,
}

impl<F> Default for Block<F> {
    fn default() -> Self {
        Self { memory: Vec::new(), vectors: 1, uniform: Vec::new(), kind: std::marker::PhantomData }
    }
}

impl<F: Packed> Block<F> {
    /// Makes room for so many slots of so many lanes. What they hold does not matter, and is unknown.
    /// Panics unless there are 1 to [`MOST`] lanes.
    pub fn prepare(&mut self, slots: usize, lanes: usize) {
        assert!((1..=MOST).contains(&lanes), "1 to {MOST} lanes");
        self.vectors = lanes.div_ceil(WIDTH);
        let size = slots * self.size();
        if self.memory.len() < size {
            self.memory.resize(size, Eight::default());
        }
        self.uniform.clear();
        self.uniform.resize(slots, false);
    }

    /// Vectors of a slot.
    #[inline(always)]
    fn size(&self) -> usize {
        self.vectors * F::COMPONENTS
    }

    /// A slot, by its vectors.
    #[inline(always)]
    fn vectors_of(&mut self, slot: usize) -> std::slice::ChunksExactMut<'_, Eight> {
        let size = self.size();
        self.memory[slot * size..][..size].chunks_exact_mut(F::COMPONENTS)
    }

    /// Where the vectors of an operand start, and from one to the next.
    #[inline(always)]
    fn stream(&self, slot: usize) -> (usize, usize) {
        (slot * self.size(), if self.uniform[slot] { 0 } else { F::COMPONENTS })
    }

    /// The number of a uniform slot in all vectors, as some are to be written.
    fn spread(&mut self, slot: usize) {
        if std::mem::replace(&mut self.uniform[slot], false) {
            let size = self.size();
            let (first, rest) = self.memory[slot * size..][..size].split_at_mut(F::COMPONENTS);
            rest.chunks_exact_mut(F::COMPONENTS).for_each(|vector| vector.copy_from_slice(first));
        }
    }

    /// Writes one lane.
    #[inline]
    pub fn set(&mut self, slot: usize, lane: usize, x: F) {
        assert!(lane < self.vectors * WIDTH, "a lane of the block");
        self.spread(slot);
        let part = &mut self.memory[(slot * self.vectors + lane / WIDTH) * F::COMPONENTS..][..F::COMPONENTS];
        for (i, vector) in part.iter_mut().enumerate() {
            vector.0[lane % WIDTH] = x.component(i);
        }
    }

    /// Writes all lanes of a slot, or the first components of them: the others hold anything. The last lane is repeated up to the
    /// end of its vector. Panics if `G` has more components.
    #[inline]
    pub fn load<G: Packed>(&mut self, slot: usize, lanes: usize, of: impl Fn(usize) -> G) {
        self.uniform[slot] = false;
        for (first, vector) in (0..lanes).step_by(WIDTH).zip(self.vectors_of(slot)) {
            let x: [G; WIDTH] = std::array::from_fn(|k| of(usize::min(first + k, lanes - 1)));
            for (i, eight) in vector[..G::COMPONENTS].iter_mut().enumerate() {
                *eight = Eight(std::array::from_fn(|k| x[k].component(i)));
            }
        }
    }

    /// Reads all lanes of a slot.
    #[inline]
    pub fn read(&self, slot: usize, lanes: usize, mut to: impl FnMut(usize, F)) {
        let (start, step) = self.stream(slot);
        for (i, first) in (0..lanes).step_by(WIDTH).enumerate() {
            let part = &self.memory[start + i * step..][..F::COMPONENTS];
            for k in 0..WIDTH.min(lanes - first) {
                to(first + k, F::from_components(|i| part[i].0[k]));
            }
        }
    }

    /// Writes components of all lanes, from `first` on, that stand in a slot of another block. Panics unless that has as many vectors, and
    /// there are so many components.
    pub fn put<G: Packed>(&mut self, slot: usize, first: usize, other: &Block<G>, from: usize) {
        assert_eq!(self.vectors, other.vectors, "blocks of as many lanes");
        self.spread(slot);
        let (start, step) = other.stream(from);
        for (i, to) in self.vectors_of(slot).enumerate() {
            to[first..first + G::COMPONENTS].copy_from_slice(&other.memory[start + i * step..][..G::COMPONENTS]);
        }
    }

    /// Reads one lane.
    #[inline]
    #[must_use]
    pub fn get(&self, slot: usize, lane: usize) -> F {
        assert!(lane < self.vectors * WIDTH, "a lane of the block");
        let (start, step) = self.stream(slot);
        let part = &self.memory[start + lane / WIDTH * step..][..F::COMPONENTS];
        F::from_components(|i| part[i].0[lane % WIDTH])
    }

    /// Writes the same number into all lanes: one vector stands for them.
    pub fn fill(&mut self, slot: usize, x: F) {
        self.uniform[slot] = true;
        if let Some(part) = self.vectors_of(slot).next() {
            for (i, vector) in part.iter_mut().enumerate() {
                *vector = Eight([x.component(i); WIDTH]);
            }
        }
    }

    /// Repeats the last of the lanes in the rest of its vector, so that no operation meets numbers that nobody chose.
    pub fn pad(&mut self, slot: usize, lanes: usize) {
        let x = self.get(slot, lanes - 1);
        for lane in lanes..self.vectors * WIDTH {
            self.set(slot, lane, x);
        }
    }

    /// `slot[out] = op(slot[a], slot[b])` in every lane; the slots may be the same. Operations of one operand take `a`.
    #[inline]
    pub fn arithmetic(&mut self, level: Level, op: Arithmetic, out: usize, a: usize, b: usize) {
        self.act(level, Operation::Arithmetic(op), out, [a, b, b]);
    }

    /// `slot[out] = slot[a]^n` in every lane: by vectors for n from 3 to 8, else lane by lane.
    #[inline]
    pub fn power(&mut self, level: Level, lanes: usize, n: i32, out: usize, a: usize) {
        match n {
            3..=8 => self.act(level, Operation::Power(n as u32), out, [a; 3]),
            _ => self.map(lanes, out, a, |x| x.power(n)),
        }
    }

    /// `slot[out] = p + t d` in every lane: [`Packed::coordinate`].
    #[inline]
    pub fn coordinate(&mut self, level: Level, out: usize, t: usize, d: usize, p: usize) {
        self.act(level, Operation::Coordinate, out, [t, d, p]);
    }

    /// The parameters over intervals, which were loaded into the first components: [`Packed::spanning`].
    #[inline]
    pub fn spanning(&mut self, level: Level, slot: usize) {
        self.act(level, Operation::Spanning, slot, [slot; 3]);
    }

    #[inline]
    fn act(&mut self, level: Level, op: Operation, out: usize, operands: [usize; 3]) {
        // The vector that stands for all is not to be written while others are read for it.
        if self.uniform[out] && operands.contains(&out) {
            self.spread(out);
        }
        self.uniform[out] = false;
        let streams = operands.map(|slot| self.stream(slot));
        let (operands, steps) = (streams.map(|(start, _)| start), streams.map(|(_, step)| step));
        let act = Act { op, out: out * self.size(), operands, steps };
        F::run(level, act, &mut self.memory, self.vectors);
    }

    /// `slot[out] = f(slot[a])`, lane by lane.
    #[inline]
    pub fn map(&mut self, lanes: usize, out: usize, a: usize, f: impl Fn(F) -> F) {
        for lane in 0..lanes {
            let x = f(self.get(a, lane));
            self.set(out, lane, x);
        }
        self.pad(out, lanes);
    }

    /// `slot[out] = f(slot[a], slot[b])`, lane by lane.
    #[inline]
    pub fn map2(&mut self, lanes: usize, out: usize, a: usize, b: usize, f: impl Fn(F, F) -> F) {
        for lane in 0..lanes {
            let x = f(self.get(a, lane), self.get(b, lane));
            self.set(out, lane, x);
        }
        self.pad(out, lanes);
    }
}
