//! Second-order jets of plain `f64`: for choosing where to look, never a proof.
use super::{Inclusion, Number, Workspace};
use crate::expr::{Binary, Unary};
use crate::geom::Vec3;
use antumbra_interval::{Interval, PointJet};

impl Number for PointJet {
    fn constant(value: Interval) -> Self {
        Self::flat(value.mid())
    }

    #[inline(always)]
    fn unary(self, op: Unary) -> Self {
        match op {
            Unary::Neg => -self,
            Unary::Sqr => self.sqr(),
            _ => function(self, op),
        }
    }

    fn powi(self, n: i32) -> Self {
        self.powi(n)
    }

    #[inline(always)]
    fn binary(self, op: Binary, o: Self) -> Self {
        match op {
            Binary::Add => self + o,
            Binary::Sub => self - o,
            Binary::Mul => self * o,
            _ => function_of_two(self, op, o),
        }
    }
}

/// What is rare: apart, so that sums and products are inlined into the interpreter.
fn function(f: PointJet, op: Unary) -> PointJet {
    let v = f.value;
    let h = v.unary(op);
    match op {
        Unary::Neg | Unary::Sqr => f.unary(op),
        Unary::Abs => PointJet { value: h, ..f.scaled(if v < 0.0 { -1.0 } else { 1.0 }) },
        Unary::Sign | Unary::Floor => PointJet::flat(h),
        Unary::Sqrt => f.chain(h, 0.5 / h, -0.25 / (h * v)),
        Unary::Cbrt => f.power(h, 1.0 / 3.0),
        Unary::Exp => f.chain(h, h, h),
        Unary::Ln => f.chain(h, 1.0 / v, -1.0 / (v * v)),
        Unary::Sin => f.chain(h, v.unary(Unary::Cos), -h),
        Unary::Cos => f.chain(h, -v.unary(Unary::Sin), -h),
        Unary::Tan => f.chain(h, 1.0 + h * h, 2.0 * h * (1.0 + h * h)),
        Unary::Asin | Unary::Acos => {
            let s = 1.0 / (1.0 - v * v);
            let (slope, bend) = (s.sqrt(), v * s * s.sqrt());
            if op == Unary::Asin { f.chain(h, slope, bend) } else { f.chain(h, -slope, -bend) }
        }
        Unary::Atan => {
            let s = 1.0 / (1.0 + v * v);
            f.chain(h, s, -2.0 * v * s * s)
        }
        Unary::Sinh => f.chain(h, v.unary(Unary::Cosh), h),
        Unary::Cosh => f.chain(h, v.unary(Unary::Sinh), h),
        Unary::Tanh => f.chain(h, 1.0 - h * h, -2.0 * h * (1.0 - h * h)),
    }
}

fn function_of_two(f: PointJet, op: Binary, o: PointJet) -> PointJet {
    let value = f.value.binary(op, o.value);
    match op {
        Binary::Add | Binary::Sub | Binary::Mul => f.binary(op, o),
        Binary::Div => PointJet { value, ..f / o },
        Binary::Min => PointJet { value, ..if f.value <= o.value { f } else { o } },
        Binary::Max => PointJet { value, ..if f.value >= o.value { f } else { o } },
        Binary::Pow if o.first == 0.0 && o.second == 0.0 => f.power(value, o.value),
        Binary::Pow => PointJet { value, ..(o * f.unary(Unary::Ln)).unary(Unary::Exp) },
        Binary::Atan2 if o.value.abs() >= f.value.abs() => PointJet { value, ..(f / o).unary(Unary::Atan) },
        Binary::Atan2 => PointJet { value, ..(o / f).unary(Unary::Atan).scaled(-1.0) },
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
