//! The operators with their true values.
use antumbra::eval::Number;
use antumbra::expr::{Binary, Unary};

/// An operator of the language.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Operator {
    Unary(Unary),
    Powi(i32),
    Binary(Binary),
}

/// Exponents at which integer powers change their way: even and odd, the ends of the type, both sides of 8.
const EXPONENTS: [i32; 25] = [
    i32::MIN,
    i32::MIN + 1,
    -1001,
    -1000,
    -17,
    -9,
    -8,
    -3,
    -2,
    -1,
    0,
    1,
    2,
    3,
    4,
    5,
    7,
    8,
    9,
    16,
    17,
    1000,
    1001,
    i32::MAX - 1,
    i32::MAX,
];

/// What is known of the real value `v` of an operator.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Truth {
    /// `v` rounded to nearest; infinite if v overflows.
    pub(crate) rounded: f64,
    /// Whether v is exactly 0, not only rounded to it.
    zero: bool,
}

impl Truth {
    /// Whether `[lo, hi]` may contain v. Exact: rounding to nearest is monotone, so `lo <= v <= hi` for floats `lo`, `hi`
    /// implies `lo <= rounded <= hi`. A v that underflows keeps its sign in the sign of the rounded zero.
    pub(crate) fn possibly_in(self, lo: f64, hi: f64) -> bool {
        let r = self.rounded;
        if r == 0.0 && !self.zero {
            return if r.is_sign_negative() { lo < 0.0 && hi >= 0.0 } else { lo <= 0.0 && hi > 0.0 };
        }
        lo <= r && r <= hi
    }
}

impl Operator {
    /// Every operator.
    pub(crate) fn all() -> Vec<Self> {
        let unary = Unary::ALL.map(Self::Unary);
        let powers = EXPONENTS.map(Self::Powi);
        let binary = Binary::ALL.map(Self::Binary);
        unary.into_iter().chain(powers).chain(binary).collect()
    }

    pub(crate) fn name(self) -> String {
        match self {
            Self::Unary(op) => format!("{op:?}").to_lowercase(),
            Self::Powi(n) => format!("powi {n}"),
            Self::Binary(op) => format!("{op:?}").to_lowercase(),
        }
    }

    pub(crate) fn is_binary(self) -> bool {
        matches!(self, Self::Binary(_))
    }

    pub(crate) fn apply<N: Number>(self, a: N, b: N) -> N {
        match self {
            Self::Unary(op) => a.unary(op),
            Self::Powi(n) => a.powi(n),
            Self::Binary(op) => a.binary(op, b),
        }
    }

    /// The value at finite numbers `a`, `b`, rounded to nearest by CORE-MATH or by IEEE 754; `None` where it is undefined.
    /// Written down here once more, apart from the evaluators.
    pub(crate) fn truth(self, a: f64, b: f64) -> Option<Truth> {
        // The numbers are real: there is one zero.
        let (a, b) = (a + 0.0, b + 0.0);
        let rounded = match self {
            Self::Unary(op) => match op {
                Unary::Neg => 0.0 - a,
                Unary::Abs => a.abs(),
                Unary::Sign => f64::from(i8::from(a > 0.0) - i8::from(a < 0.0)),
                Unary::Floor => a.floor(),
                Unary::Sqr => a * a,
                Unary::Sqrt => (a >= 0.0).then(|| a.sqrt())?,
                Unary::Cbrt => core_math::cbrt(a),
                Unary::Exp => core_math::exp(a),
                Unary::Ln => (a > 0.0).then(|| core_math::log(a))?,
                Unary::Sin => core_math::sin(a),
                Unary::Cos => core_math::cos(a),
                Unary::Tan => core_math::tan(a),
                Unary::Asin => (a.abs() <= 1.0).then(|| core_math::asin(a))?,
                Unary::Acos => (a.abs() <= 1.0).then(|| core_math::acos(a))?,
                Unary::Atan => core_math::atan(a),
                Unary::Sinh => core_math::sinh(a),
                Unary::Cosh => core_math::cosh(a),
                Unary::Tanh => core_math::tanh(a),
            },
            Self::Powi(n) => (n >= 0 || a != 0.0).then(|| core_math::pow(a, f64::from(n)))?,
            Self::Binary(op) => match op {
                Binary::Add => a + b,
                Binary::Sub => a - b,
                Binary::Mul => a * b,
                Binary::Div => (b != 0.0).then(|| a / b)?,
                Binary::Min => {
                    if a < b {
                        a
                    } else {
                        b
                    }
                }
                Binary::Max => {
                    if a > b {
                        a
                    } else {
                        b
                    }
                }
                Binary::Pow => (a > 0.0 || (a == 0.0 && b > 0.0)).then(|| core_math::pow(a, b))?,
                Binary::Atan2 => (a != 0.0 || b != 0.0).then(|| core_math::atan2(a, b))?,
            },
        };
        Some(Truth { rounded, zero: self.is_zero(a, b) })
    }

    /// Whether the value is exactly 0.
    fn is_zero(self, a: f64, b: f64) -> bool {
        match self {
            Self::Unary(op) => match op {
                Unary::Exp | Unary::Cosh | Unary::Cos => false,
                Unary::Floor => (0.0..1.0).contains(&a),
                Unary::Ln | Unary::Acos => a == 1.0,
                _ => a == 0.0,
            },
            Self::Powi(n) => n > 0 && a == 0.0,
            Self::Binary(op) => match op {
                Binary::Add => a + b == 0.0,
                Binary::Sub => a - b == 0.0,
                Binary::Mul => a == 0.0 || b == 0.0,
                Binary::Div | Binary::Pow => a == 0.0,
                Binary::Min => (a == 0.0 && b >= 0.0) || (b == 0.0 && a >= 0.0),
                Binary::Max => (a == 0.0 && b <= 0.0) || (b == 0.0 && a <= 0.0),
                Binary::Atan2 => a == 0.0 && b > 0.0,
            },
        }
    }

    /// Whether the operator is undefined somewhere in the box, or discontinuous on it: for bounded boxes, by its definition.
    /// `None` where that takes more than a comparison.
    pub(crate) fn breaks(self, a: [f64; 2], b: [f64; 2]) -> Option<bool> {
        let zero = |[lo, hi]: [f64; 2]| lo <= 0.0 && hi >= 0.0;
        Some(match self {
            Self::Unary(op) => match op {
                Unary::Sign => zero(a) && a[0] != a[1],
                Unary::Floor => a[0].floor() != a[1].floor(),
                Unary::Sqrt => a[0] < 0.0,
                Unary::Ln => a[0] <= 0.0,
                Unary::Asin | Unary::Acos => a[0] < -1.0 || a[1] > 1.0,
                Unary::Tan => {
                    if a[0].abs().max(a[1].abs()) > 1e6 {
                        return None;
                    }
                    // Poles are at (k + 1/2) pi; the quotient is good to 1e-9 here.
                    let half_turns = a.map(|v| v / std::f64::consts::PI + 0.5);
                    if half_turns.iter().any(|v| (v - v.round()).abs() < 1e-9) {
                        return None;
                    }
                    half_turns[0].floor() != half_turns[1].floor()
                }
                _ => false,
            },
            Self::Powi(n) => n < 0 && zero(a),
            Self::Binary(op) => match op {
                Binary::Div => zero(b),
                Binary::Pow => a[0] < 0.0 || (a[0] == 0.0 && b[0] <= 0.0),
                // On the cut, y = 0 belongs to the upper side.
                Binary::Atan2 => (zero(a) && zero(b)) || (b[0] < 0.0 && a[0] < 0.0 && a[1] >= 0.0),
                _ => false,
            },
        })
    }
}
