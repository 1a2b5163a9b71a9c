//! Second-order jets of plain `f64`: for choosing where to look, never a proof.
use super::{Inclusion, Number, Workspace};
use crate::expr::{Binary, Unary};
use crate::geom::Vec3;
use antumbra_interval::Interval;

/// About `f`, `f'` and `f''/2` along a line at one point, all rounded; NaN where undefined.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PointJet {
    /// `f`.
    pub value: f64,
    /// `f'`.
    pub first: f64,
    /// `f''/2`.
    pub second: f64,
}

impl PointJet {
    /// `h(f)`, given `h`, `h'` and `h''` there.
    fn chain(self, value: f64, slope: f64, bend: f64) -> Self {
        let second = slope * self.second + 0.5 * bend * self.first * self.first;
        Self { value, first: slope * self.first, second }
    }

    /// Constant near the point.
    const fn flat(value: f64) -> Self {
        Self { value, first: 0.0, second: 0.0 }
    }

    /// `f^y` for a constant `y`.
    fn power(self, value: f64, y: f64) -> Self {
        let v = self.value;
        self.chain(value, y * value / v, y * (y - 1.0) * value / (v * v))
    }

    fn times(self, o: Self) -> Self {
        Self {
            value: self.value * o.value,
            first: self.value * o.first + self.first * o.value,
            second: self.value * o.second + self.first * o.first + self.second * o.value,
        }
    }

    fn over(self, o: Self) -> Self {
        let value = self.value / o.value;
        let first = (self.first - value * o.first) / o.value;
        Self { value, first, second: (self.second - value * o.second - first * o.first) / o.value }
    }

    fn scaled(self, k: f64) -> Self {
        Self { value: self.value * k, first: self.first * k, second: self.second * k }
    }
}

impl Number for PointJet {
    fn constant(value: Interval) -> Self {
        Self::flat(value.mid())
    }

    #[inline(always)]
    fn unary(self, op: Unary) -> Self {
        match op {
            Unary::Neg => self.scaled(-1.0),
            Unary::Sqr => self.times(self),
            _ => self.function(op),
        }
    }

    fn powi(self, n: i32) -> Self {
        match n {
            0 => Self::flat(self.value.powi_of(0)),
            1 => self,
            2 => self.times(self),
            3 => self.times(self).times(self),
            4 => self.times(self).unary(Unary::Sqr),
            _ => self.power(self.value.powi_of(n), f64::from(n)),
        }
    }

    #[inline(always)]
    fn binary(self, op: Binary, o: Self) -> Self {
        match op {
            Binary::Add => {
                Self { value: self.value + o.value, first: self.first + o.first, second: self.second + o.second }
            }
            Binary::Sub => {
                Self { value: self.value - o.value, first: self.first - o.first, second: self.second - o.second }
            }
            Binary::Mul => self.times(o),
            _ => self.function_of_two(op, o),
        }
    }
}

/// What is rare: apart, so that sums and products are inlined into the interpreter.
impl PointJet {
    fn function(self, op: Unary) -> Self {
        let v = self.value;
        let h = v.unary(op);
        match op {
            Unary::Neg | Unary::Sqr => self.unary(op),
            Unary::Abs => Self { value: h, ..self.scaled(if v < 0.0 { -1.0 } else { 1.0 }) },
            Unary::Sign | Unary::Floor => Self::flat(h),
            Unary::Sqrt => self.chain(h, 0.5 / h, -0.25 / (h * v)),
            Unary::Cbrt => self.power(h, 1.0 / 3.0),
            Unary::Exp => self.chain(h, h, h),
            Unary::Ln => self.chain(h, 1.0 / v, -1.0 / (v * v)),
            Unary::Sin => self.chain(h, v.unary(Unary::Cos), -h),
            Unary::Cos => self.chain(h, -v.unary(Unary::Sin), -h),
            Unary::Tan => self.chain(h, 1.0 + h * h, 2.0 * h * (1.0 + h * h)),
            Unary::Asin | Unary::Acos => {
                let s = 1.0 / (1.0 - v * v);
                let (slope, bend) = (s.sqrt(), v * s * s.sqrt());
                if op == Unary::Asin { self.chain(h, slope, bend) } else { self.chain(h, -slope, -bend) }
            }
            Unary::Atan => {
                let s = 1.0 / (1.0 + v * v);
                self.chain(h, s, -2.0 * v * s * s)
            }
            Unary::Sinh => self.chain(h, v.unary(Unary::Cosh), h),
            Unary::Cosh => self.chain(h, v.unary(Unary::Sinh), h),
            Unary::Tanh => self.chain(h, 1.0 - h * h, -2.0 * h * (1.0 - h * h)),
        }
    }

    fn function_of_two(self, op: Binary, o: Self) -> Self {
        let value = self.value.binary(op, o.value);
        match op {
            Binary::Add | Binary::Sub | Binary::Mul => self.binary(op, o),
            Binary::Div => Self { value, ..self.over(o) },
            Binary::Min => Self { value, ..if self.value <= o.value { self } else { o } },
            Binary::Max => Self { value, ..if self.value >= o.value { self } else { o } },
            Binary::Pow if o.first == 0.0 && o.second == 0.0 => self.power(value, o.value),
            Binary::Pow => Self { value, ..o.times(self.unary(Unary::Ln)).unary(Unary::Exp) },
            Binary::Atan2 if o.value.abs() >= self.value.abs() => Self { value, ..self.over(o).unary(Unary::Atan) },
            Binary::Atan2 => Self { value, ..o.over(self).unary(Unary::Atan).scaled(-1.0) },
        }
    }
}

/// The integer power of plain numbers, under a name that `f64` does not have itself.
trait IntegerPower {
    fn powi_of(self, n: i32) -> f64;
}

impl IntegerPower for f64 {
    fn powi_of(self, n: i32) -> f64 {
        Number::powi(self, n)
    }
}

/// Value and slope from the middle of enclosures at a point, the second derivative from slopes on both sides.
pub(super) fn by_differences(f: &(impl Inclusion + ?Sized), point: [PointJet; 3], work: &mut Workspace) -> PointJet {
    let size = point.iter().map(|x| x.first.abs()).fold(0.0, f64::max);
    let step = 1e-4 / (size + 1e-9);
    let mut slope = |t: f64| {
        let at = Vec3(point.map(|x| x.value + t * x.first)).to_box();
        let gradient = f.gradient(&at, work);
        let first = (0..3).map(|k| gradient.partials[k].mid() * point[k].first).sum::<f64>();
        (gradient.value.mid(), first)
    };
    let ((value, first), (_, before), (_, behind)) = (slope(0.0), slope(-step), slope(step));
    PointJet { value, first, second: 0.25 * (behind - before) / step }
}
