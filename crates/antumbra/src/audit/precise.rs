//! Formulas on numbers of 192 bits, as they were written: nothing is rewritten, nothing is compiled, nothing is an interval.
use crate::eval::Number;
use crate::expr::{self, Binary, Formula, Node, Unary};
use crate::geom::Vec3;
use astro_float_num::{BigFloat, Consts, Radix, RoundingMode};

/// Bits of the mantissas.
const BITS: usize = 192;
const NEAREST: RoundingMode = RoundingMode::ToEven;
/// Where a value stands for zero, relative to the values around it.
pub(super) const NOISE: f64 = 1e-40;

/// A number.
#[derive(Clone, Debug)]
pub(super) struct Big(BigFloat);

impl From<f64> for Big {
    fn from(x: f64) -> Self {
        Self(BigFloat::from_f64(x, BITS))
    }
}

impl Big {
    pub(super) fn add(&self, o: &Self) -> Self {
        Self(self.0.add(&o.0, BITS, NEAREST))
    }

    pub(super) fn sub(&self, o: &Self) -> Self {
        Self(self.0.sub(&o.0, BITS, NEAREST))
    }

    pub(super) fn mul(&self, o: &Self) -> Self {
        Self(self.0.mul(&o.0, BITS, NEAREST))
    }

    pub(super) fn div(&self, o: &Self) -> Self {
        Self(self.0.div(&o.0, BITS, NEAREST))
    }

    /// The nearest `f64`, or nearly; NaN stays NaN.
    pub(super) fn rounded(&self) -> f64 {
        let (Some((mantissa, _, sign, exponent, _)), false) = (self.0.as_raw_parts(), self.0.is_zero()) else {
            return if self.0.is_nan() {
                f64::NAN
            } else if self.0.is_inf_pos() {
                f64::INFINITY
            } else if self.0.is_inf_neg() {
                f64::NEG_INFINITY
            } else {
                0.0
            };
        };
        // The value is 0.mantissa times 2^exponent, the most significant word last.
        let top = mantissa.last().copied().unwrap_or(0) as f64 * power_of_two(-64);
        let size = top * power_of_two(exponent.clamp(-1000, 1000));
        if sign.is_negative() { -size } else { size }
    }

    fn is_zero(&self) -> bool {
        self.0.is_zero()
    }

    fn less(&self, o: &Self) -> bool {
        self.0.cmp(&o.0).is_some_and(|c| c < 0)
    }
}

/// A formula ready for values.
pub(super) struct Precise {
    formula: Formula,
    used: Vec<bool>,
    /// Values of the rational constants, by node, and the same rounded.
    constants: Vec<Option<(Big, f64)>>,
}

/// Scratch memory of one thread.
pub(super) struct Scratch {
    cache: Consts,
    big: Vec<Big>,
    small: Vec<f64>,
}

impl Scratch {
    pub(super) fn new() -> Option<Self> {
        Some(Self { cache: Consts::new().ok()?, big: Vec::new(), small: Vec::new() })
    }
}

impl Precise {
    /// Reads a formula.
    ///
    /// # Errors
    /// Where the text is none.
    pub(super) fn parse(text: &str, s: &mut Scratch) -> Result<Self, expr::Error> {
        let formula = Formula::parse_as_written(text)?;
        let graph = formula.graph();
        let used = graph.reachable(formula.root());
        let constants = (0..used.len())
            .map(|i| {
                let (true, Node::Rational(_)) = (used[i], graph.nodes()[i]) else { return None };
                let exact = graph.exact(graph.id(i))?;
                let mut whole = |n: String| Big(BigFloat::parse(&n, Radix::Dec, 2 * BITS, NEAREST, &mut s.cache));
                let value = whole(exact.numer().to_string()).div(&whole(exact.denom().to_string()));
                let rounded = value.rounded();
                Some((value, rounded))
            })
            .collect();
        Ok(Self { used, constants, formula })
    }

    /// The value at a point; NaN where it is undefined. Correct to about 50 digits of the largest intermediate result.
    pub(super) fn value(&self, at: &[Big; 3], s: &mut Scratch) -> Big {
        let graph = self.formula.graph();
        s.big.clear();
        for (i, node) in graph.nodes()[..self.used.len()].iter().enumerate() {
            let value = match *node {
                _ if !self.used[i] => 0.0.into(),
                Node::Rational(_) => self.constants[i].as_ref().map_or_else(nan, |(value, _)| value.clone()),
                Node::Pi => Big(s.cache.pi(BITS, NEAREST)),
                Node::E => Big(s.cache.e(BITS, NEAREST)),
                Node::Axis(axis) => at[axis as usize].clone(),
                Node::Unary(op, a) => unary(op, &s.big[a.index()], &mut s.cache),
                Node::Powi(a, n) => powi(&s.big[a.index()], n),
                Node::Binary(op, a, b) => binary(op, &s.big[a.index()], &s.big[b.index()], &mut s.cache),
            };
            s.big.push(value);
        }
        s.big.pop().unwrap_or_else(|| f64::NAN.into())
    }

    /// About the value: good to scout with.
    pub(super) fn rough(&self, at: Vec3, s: &mut Scratch) -> f64 {
        let graph = self.formula.graph();
        s.small.clear();
        for (i, node) in graph.nodes()[..self.used.len()].iter().enumerate() {
            let value = match *node {
                _ if !self.used[i] => 0.0,
                Node::Rational(_) => self.constants[i].as_ref().map_or(f64::NAN, |(_, rounded)| *rounded),
                Node::Pi => std::f64::consts::PI,
                Node::E => std::f64::consts::E,
                Node::Axis(axis) => at[axis as usize],
                Node::Unary(op, a) => s.small[a.index()].unary(op),
                Node::Powi(a, n) => Number::powi(s.small[a.index()], n),
                Node::Binary(op, a, b) => s.small[a.index()].binary(op, s.small[b.index()]),
            };
            s.small.push(value);
        }
        s.small.pop().unwrap_or(f64::NAN)
    }
}

/// `2^n` for `-1022 <= n <= 1023`.
fn power_of_two(n: i32) -> f64 {
    f64::from_bits(((1023 + n) as u64) << 52)
}

fn nan() -> Big {
    f64::NAN.into()
}

fn unary(op: Unary, a: &Big, cache: &mut Consts) -> Big {
    let one: Big = 1.0.into();
    let x = &a.0;
    let negative = a.less(&0.0.into());
    Big(match op {
        _ if x.is_nan() => return nan(),
        Unary::Neg => x.neg(),
        Unary::Abs => x.abs(),
        Unary::Sign if a.is_zero() => return 0.0.into(),
        Unary::Sign => return if negative { (-1.0).into() } else { one },
        Unary::Floor => x.floor(),
        Unary::Sqr => return a.mul(a),
        Unary::Sqrt if negative => return nan(),
        Unary::Sqrt => x.sqrt(BITS, NEAREST),
        Unary::Cbrt => x.cbrt(BITS, NEAREST),
        Unary::Exp => x.exp(BITS, NEAREST, cache),
        Unary::Ln if negative || a.is_zero() => return nan(),
        Unary::Ln => x.ln(BITS, NEAREST, cache),
        Unary::Sin => x.sin(BITS, NEAREST, cache),
        Unary::Cos => x.cos(BITS, NEAREST, cache),
        Unary::Tan => x.tan(BITS, NEAREST, cache),
        Unary::Asin | Unary::Acos if one.less(&Big(x.abs())) => return nan(),
        Unary::Asin => x.asin(BITS, NEAREST, cache),
        Unary::Acos => x.acos(BITS, NEAREST, cache),
        Unary::Atan => x.atan(BITS, NEAREST, cache),
        Unary::Sinh => x.sinh(BITS, NEAREST, cache),
        Unary::Cosh => x.cosh(BITS, NEAREST, cache),
        Unary::Tanh => x.tanh(BITS, NEAREST, cache),
    })
}

fn powi(a: &Big, n: i32) -> Big {
    if a.0.is_nan() || (n < 0 && a.is_zero()) {
        return nan();
    }
    let power = Big(a.0.powi(n.unsigned_abs() as usize, BITS, NEAREST));
    if n < 0 { Big::from(1.0).div(&power) } else { power }
}

fn binary(op: Binary, a: &Big, b: &Big, cache: &mut Consts) -> Big {
    let zero = Big::from(0.0);
    if a.0.is_nan() || b.0.is_nan() {
        return nan();
    }
    match op {
        Binary::Add => a.add(b),
        Binary::Sub => a.sub(b),
        Binary::Mul => a.mul(b),
        Binary::Div if b.is_zero() => nan(),
        Binary::Div => a.div(b),
        Binary::Min => if b.less(a) { b } else { a }.clone(),
        Binary::Max => if a.less(b) { b } else { a }.clone(),
        Binary::Pow if a.is_zero() && zero.less(b) => zero,
        Binary::Pow if !zero.less(a) => nan(),
        Binary::Pow => Big(a.0.pow(&b.0, BITS, NEAREST, cache)),
        Binary::Atan2 if a.is_zero() && b.is_zero() => nan(),
        Binary::Atan2 => atan2(a, b, cache),
    }
}

/// Angle of the point (b, a).
fn atan2(a: &Big, b: &Big, cache: &mut Consts) -> Big {
    let zero = Big::from(0.0);
    let pi = Big(cache.pi(BITS, NEAREST));
    let half = pi.mul(&0.5.into());
    let mut atan = |y: &Big, x: &Big| Big(y.div(x).0.atan(BITS, NEAREST, cache));
    if Big(a.0.abs()).less(&Big(b.0.abs())) {
        let angle = atan(a, b);
        match (b.less(&zero), a.less(&zero)) {
            (false, _) => angle,
            (true, false) => angle.add(&pi),
            (true, true) => angle.sub(&pi),
        }
    } else {
        let angle = atan(b, a);
        if a.less(&zero) { zero.sub(&half).sub(&angle) } else { half.sub(&angle) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_agree_with_doubles_and_go_beyond_them() {
        let mut s = Scratch::new().unwrap();
        let at = Vec3::new(0.3, -1.7, 2.5);
        let big = at.0.map(Big::from);
        for text in [
            "x^2 + y^2 - z^2 / 7 = 1",
            "sin(x) cos(y) tan(z) + exp(y) ln(z) - sqrt(z) cbrt(y)",
            "asin(x) + acos(x) atan(y) - sinh(x) cosh(y) + tanh(z)",
            "atan2(x, y) + atan2(y, x) + atan2(-x, y) + min(x, y) max(y, z) + abs(y) - floor(z) sign(y)",
            "z^1.5 + pi x^3 - e y^(-3)",
        ] {
            let f = Precise::parse(text, &mut s).unwrap();
            let (value, rough) = (f.value(&big, &mut s).rounded(), f.rough(at, &mut s));
            assert!((value - rough).abs() < 1e-13 * (1.0 + value.abs()), "{text}: {value} {rough}");
        }
        let f = Precise::parse("(1 + x)^2 - 1 - 2x - x^2", &mut s).unwrap();
        assert!(f.value(&[1e-9.into(), 0.0.into(), 0.0.into()], &mut s).rounded().abs() < 1e-55);
        let third = Precise::parse("1/3 - x", &mut s).unwrap();
        let x = Big::from(1.0).div(&3.0.into());
        assert!(third.value(&[x, 0.0.into(), 0.0.into()], &mut s).rounded().abs() < 1e-57);
    }

    #[test]
    fn what_is_undefined_is_no_number() {
        let mut s = Scratch::new().unwrap();
        let zero = [Big::from(0.0), Big::from(0.0), Big::from(0.0)];
        for text in
            ["1/x", "ln(x)", "sqrt(x - 1)", "asin(x + 2)", "atan2(x, y)", "x^(-2)", "(x - 1)^0.5", "min(1/x, 1)"]
        {
            let f = Precise::parse(text, &mut s).unwrap();
            assert!(f.value(&zero, &mut s).rounded().is_nan() && f.rough(Vec3::default(), &mut s).is_nan(), "{text}");
        }
    }
}
