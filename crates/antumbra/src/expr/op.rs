//! The one list of operators, and what each of them means.
//!
//! Every evaluator of the project implements exactly these operators on its own kind of number, and one shared test
//! suite holds all of them against the meanings written here.

/// A coordinate of space.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Axis {
    /// First coordinate.
    X,
    /// Second coordinate.
    Y,
    /// Third coordinate (up).
    Z,
}

/// Operators of one argument `a`. A value outside the stated domain is undefined (the point is not on the surface).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Unary {
    /// `-a`.
    Neg,
    /// `|a|`.
    Abs,
    /// -1, 0 or 1; discontinuous at 0.
    Sign,
    /// Largest integer `<= a`; discontinuous at the integers.
    Floor,
    /// `a * a`.
    Sqr,
    /// Non-negative root; domain `a >= 0`.
    Sqrt,
    /// Real cube root, defined for every `a`.
    Cbrt,
    /// `e^a`.
    Exp,
    /// Natural logarithm; domain `a > 0`.
    Ln,
    /// Sine of `a` radians.
    Sin,
    /// Cosine of `a` radians.
    Cos,
    /// Tangent of `a` radians; undefined at odd multiples of pi/2.
    Tan,
    /// Arc sine in `[-pi/2, pi/2]`; domain `-1 <= a <= 1`.
    Asin,
    /// Arc cosine in `[0, pi]`; domain `-1 <= a <= 1`.
    Acos,
    /// Arc tangent in `(-pi/2, pi/2)`.
    Atan,
    /// Hyperbolic sine.
    Sinh,
    /// Hyperbolic cosine.
    Cosh,
    /// Hyperbolic tangent.
    Tanh,
}

/// Operators of two arguments `a`, `b`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Binary {
    /// `a + b`.
    Add,
    /// `a - b`.
    Sub,
    /// `a * b`.
    Mul,
    /// `a / b`; domain `b != 0`.
    Div,
    /// The smaller one.
    Min,
    /// The larger one.
    Max,
    /// `a^b` for a real exponent, as IEEE 1788 `pow`: `exp(b ln a)` for `a > 0`; `0` for `a = 0, b > 0`; else undefined.
    Pow,
    /// Angle of the point `(x = b, y = a)` in `(-pi, pi]`; undefined at `(0, 0)`, discontinuous on `b < 0, a = 0`.
    Atan2,
}

impl Unary {
    /// Every operator, in the order of declaration.
    pub const ALL: [Self; 18] = [
        Self::Neg,
        Self::Abs,
        Self::Sign,
        Self::Floor,
        Self::Sqr,
        Self::Sqrt,
        Self::Cbrt,
        Self::Exp,
        Self::Ln,
        Self::Sin,
        Self::Cos,
        Self::Tan,
        Self::Asin,
        Self::Acos,
        Self::Atan,
        Self::Sinh,
        Self::Cosh,
        Self::Tanh,
    ];

    /// Whether the operator is defined and continuous for every real argument.
    #[must_use]
    pub const fn is_total_and_continuous(self) -> bool {
        !matches!(self, Self::Sign | Self::Floor | Self::Sqrt | Self::Ln | Self::Tan | Self::Asin | Self::Acos)
    }
}

impl Binary {
    /// Every operator, in the order of declaration.
    pub const ALL: [Self; 8] =
        [Self::Add, Self::Sub, Self::Mul, Self::Div, Self::Min, Self::Max, Self::Pow, Self::Atan2];

    /// Whether the operator is defined and continuous for every pair of real arguments.
    #[must_use]
    pub const fn is_total_and_continuous(self) -> bool {
        matches!(self, Self::Add | Self::Sub | Self::Mul | Self::Min | Self::Max)
    }
}
