//! Input bytes as numbers, boxes, points and tapes. When the bytes end, zeros follow: every generator ends.
use crate::containment::{Operator, power_of_two};
use antumbra::expr::Axis;
use antumbra::tape::{Clause, Op, Tape};
use antumbra_interval::Interval;
use arbitrary::Unstructured;

/// The bytes, and what to make of them.
pub(crate) struct Input<'a>(Unstructured<'a>);

impl<'a> Input<'a> {
    pub(crate) fn new(bytes: &'a [u8]) -> Self {
        Self(Unstructured::new(bytes))
    }

    pub(crate) fn is_spent(&self) -> bool {
        self.0.is_empty()
    }

    fn byte(&mut self) -> u8 {
        self.0.arbitrary().unwrap_or(0)
    }

    fn bits(&mut self) -> u64 {
        self.0.arbitrary().unwrap_or(0)
    }

    /// A number below `n`, which is not 0.
    pub(crate) fn below(&mut self, n: usize) -> usize {
        self.0.int_in_range(0..=n - 1).unwrap_or(0)
    }

    pub(crate) fn pick<T: Copy>(&mut self, from: &[T]) -> T {
        from[self.below(from.len())]
    }

    /// The rest as text; what is no UTF-8 is replaced.
    pub(crate) fn rest_as_text(self) -> String {
        String::from_utf8_lossy(self.0.take_rest()).into_owned()
    }

    /// A finite number: any float, or one of a kind that breaks things.
    pub(crate) fn number(&mut self) -> f64 {
        let kind = self.byte();
        let small = f64::from(self.byte());
        let step = i32::from(self.byte() % 7) - 3;
        let magnitude = match kind & 15 {
            0 => 0.0,
            1 => small,
            2 => nudged(small, step),
            3 => nudged(power_of_two(self.below(2098) as i32 - 1074), step),
            4 => f64::from_bits(self.bits() % f64::INFINITY.to_bits()),
            5 => f64::from_bits(self.bits() % (1 << 52)),
            6 => nudged(f64::MAX, -step.abs()),
            7 => nudged(std::f64::consts::FRAC_PI_2 * small, step),
            8 => nudged(std::f64::consts::FRAC_PI_2 * (self.bits() >> 20) as f64, step),
            9 => nudged(
                [708.0, 709.782712893384, 710.4758600739439, 745.1332191019411][usize::from(kind >> 5 & 3)],
                step,
            ),
            10 => nudged(1.0, step),
            11 => small / 256.0,
            _ => (self.bits() >> 11) as f64 / f64::from(1 << 30) / f64::from(1 << 22),
        };
        if kind & 16 == 0 { magnitude } else { -magnitude }
    }

    /// A multiple of 2^-10 in [-32, 32].
    pub(crate) fn coarse(&mut self) -> f64 {
        let bits = u16::from_le_bytes([self.byte(), self.byte()]);
        f64::from(i32::from(bits) - 32768) / 1024.0
    }

    /// A multiple of 1/8 in [-1, 1], often an end.
    pub(crate) fn symbol(&mut self) -> f64 {
        let k = self.byte();
        match k & 3 {
            0 => 1.0,
            1 => -1.0,
            _ => f64::from(i32::from(k >> 2) % 17 - 8) / 8.0,
        }
    }

    /// Not empty: often a point or a few floats wide, sometimes unbounded.
    pub(crate) fn interval(&mut self) -> Interval {
        let a = self.number();
        let kind = self.byte();
        let b = match kind & 7 {
            0 => a,
            1 => nudged(a, i32::from(kind >> 3) - 16),
            2 => -a,
            3 => (a * (1.0 + f64::from(kind >> 3) / 32.0)).clamp(f64::MIN, f64::MAX),
            4 => (a + power_of_two(i32::from(kind >> 3) - 28)).clamp(f64::MIN, f64::MAX),
            5 if kind & 24 == 0 => [f64::INFINITY, f64::NEG_INFINITY][usize::from(kind >> 5 & 1)],
            _ => self.number(),
        };
        if a <= b { Interval::new(a, b) } else { Interval::new(b, a) }
    }

    /// A box of the size of pictures.
    pub(crate) fn ordinary(&mut self) -> Interval {
        let a = self.coarse() / 8.0;
        let width = self.pick(&[0.0, 1e-15, 1e-9, 1e-4, 0.0078125, 0.25, 2.0]);
        Interval::new(a, a + width)
    }

    /// A finite member: often a bound.
    pub(crate) fn member(&mut self, x: Interval) -> f64 {
        let (lo, hi) = (x.lo().max(f64::MIN), x.hi().min(f64::MAX));
        let kind = self.byte();
        match kind & 3 {
            0 => lo,
            1 => hi,
            2 => self.number().clamp(lo, hi),
            _ => {
                let s = f64::from(kind >> 2) / 63.0;
                (lo * (1.0 - s) + hi * s).clamp(lo, hi)
            }
        }
    }

    /// A tape on the coordinates and four constants, of at most `most` operations; slots are reused.
    pub(crate) fn tape(&mut self, operations: &[Operator], most: usize, constants: [Interval; 4]) -> Tape {
        let length = 1 + self.below(most);
        let mut clauses: Vec<Clause> = vec![];
        for axis in [Axis::X, Axis::Y, Axis::Z] {
            clauses.push(Clause { op: Op::Axis(axis), out: clauses.len() as u32, a: 0, b: 0 });
        }
        for k in 0..4 {
            clauses.push(Clause { op: Op::Constant(k), out: clauses.len() as u32, a: 0, b: 0 });
        }
        let mut slots = clauses.len() as u32;
        for _ in 0..length {
            // Recent slots more often: deep expressions.
            let slot = |input: &mut Self| {
                let k = input.byte();
                if k & 1 == 0 { u32::from(k >> 1) % slots } else { slots - 1 - u32::from(k >> 1) % 3 }
            };
            let (a, b) = (slot(self), slot(self));
            let (op, b) = match self.pick(operations) {
                Operator::Unary(op) => (Op::Unary(op), 0),
                Operator::Powi(n) => (Op::Powi(n), 0),
                Operator::Binary(op) => (Op::Binary(op), b),
            };
            // One in four overwrites an old slot, its operand's perhaps.
            let out = if self.byte() & 3 == 0 { self.below(slots as usize) as u32 } else { slots };
            slots = slots.max(out + 1);
            clauses.push(Clause { op, out, a, b });
        }
        Tape::from_clauses(clauses, constants.to_vec()).expect("every slot is written before it is read")
    }
}

/// `steps` floats further up, or down if negative; finite.
pub(crate) fn nudged(x: f64, steps: i32) -> f64 {
    let moved = (0..steps.abs()).fold(x, |x, _| if steps > 0 { x.next_up() } else { x.next_down() });
    moved.clamp(f64::MIN, f64::MAX)
}
