//! All functions that are compared.
use crate::function::{BITS, Function, Hard, Operands};
use antumbra_interval::Interval;
use rug::Float;
use rug::float::Round;
use rug::ops::PowAssignRound;
use std::cmp::Ordering;

/// A function of MPFR that overwrites its operand.
fn one(x: &Operands<Float>, round: Round, f: fn(&mut Float, Round) -> Ordering) -> (Float, Ordering) {
    let mut value = x[0].clone();
    let side = f(&mut value, round);
    (value, side)
}

macro_rules! unary {
    ($name:literal, $steps:literal, $hard:ident, $defined:expr, $ours:expr, $mpfr:ident, $inari:expr) => {
        Function {
            name: $name,
            arity: 1,
            steps: $steps,
            hard: Hard::$hard,
            defined: |[x, ..]| {
                let defined: fn(f64) -> bool = $defined;
                defined(x)
            },
            ours: |[x, ..]| {
                let ours: fn(Interval) -> Interval = $ours;
                ours(x)
            },
            mpfr: |x, round| one(x, round, Float::$mpfr),
            inari: $inari,
        }
    };
}

macro_rules! binary {
    ($name:literal, $steps:literal, $hard:ident, $defined:expr, $ours:expr, $mpfr:expr, $inari:expr) => {
        Function {
            name: $name,
            arity: 2,
            steps: $steps,
            hard: Hard::$hard,
            defined: |[x, y, _]| {
                let defined: fn(f64, f64) -> bool = $defined;
                defined(x, y)
            },
            ours: |[x, y, _]| {
                let ours: fn(Interval, Interval) -> Interval = $ours;
                ours(x, y)
            },
            mpfr: $mpfr,
            inari: $inari,
        }
    };
}

macro_rules! powers {
    ($($name:literal $n:literal $steps:literal)*) => { vec![$(
        Function {
            name: $name,
            arity: 1,
            steps: $steps,
            hard: Hard::Overflow,
            defined: |[x, ..]| $n >= 0 || x != 0.0,
            ours: |[x, ..]| x.powi($n),
            mpfr: |x, round| {
                let mut value = x[0].clone();
                let side = value.pow_assign_round($n as i32, round);
                (value, side)
            },
            inari: Some(|[x, ..]| x.powi($n)),
        }
    ),*] };
}

/// Every function of the interval crate that rounds, and some that must not.
pub(crate) fn functions() -> Vec<Function> {
    let mut all = arithmetic();
    all.extend(elementary());
    all.extend(powers! {
        "powi 3" 3 9 "powi 4" 4 12 "powi 5" 5 15 "powi 8" 8 24 "powi 9" 9 1 "powi 17" 17 1 "powi 1000" 1000 1
        "powi -1" -1 3 "powi -2" -2 6 "powi -3" -3 9 "powi -8" -8 24 "powi -9" -9 1
    });
    all
}

fn arithmetic() -> Vec<Function> {
    vec![
        binary!(
            "+",
            2,
            No,
            |_, _| true,
            |x, y| x + y,
            |x, round| Float::with_val_round(BITS, &x[0] + &x[1], round),
            Some(|[x, y, _]| x + y)
        ),
        binary!(
            "-",
            2,
            No,
            |_, _| true,
            |x, y| x - y,
            |x, round| Float::with_val_round(BITS, &x[0] - &x[1], round),
            Some(|[x, y, _]| x - y)
        ),
        binary!(
            "*",
            2,
            No,
            |_, _| true,
            |x, y| x * y,
            |x, round| Float::with_val_round(BITS, &x[0] * &x[1], round),
            Some(|[x, y, _]| x * y)
        ),
        binary!(
            "/",
            2,
            No,
            |_, y| y != 0.0,
            |x, y| x / y,
            |x, round| Float::with_val_round(BITS, &x[0] / &x[1], round),
            Some(|[x, y, _]| x / y)
        ),
        Function {
            name: "mul_add",
            arity: 3,
            steps: 1,
            hard: Hard::No,
            defined: |_| true,
            ours: |[x, y, z]| x.mul_add(y, z),
            mpfr: |x, round| Float::with_val_round(BITS, x[0].mul_add_ref(&x[1], &x[2]), round),
            inari: Some(|[x, y, z]| x.mul_add(y, z)),
        },
        unary!("recip", 2, No, |x| x != 0.0, Interval::recip, recip_round, Some(|[x, ..]| x.recip())),
        unary!("sqr", 2, Overflow, |_| true, Interval::sqr, square_round, Some(|[x, ..]| x.sqr())),
        unary!("sqrt", 1, No, |x| x >= 0.0, Interval::sqrt, sqrt_round, Some(|[x, ..]| x.sqrt())),
    ]
}

fn elementary() -> Vec<Function> {
    vec![
        unary!("cbrt", 1, No, |_| true, Interval::cbrt, cbrt_round, None),
        unary!("exp", 1, Overflow, |_| true, Interval::exp, exp_round, Some(|[x, ..]| x.exp())),
        unary!("ln", 1, No, |x| x > 0.0, Interval::ln, ln_round, Some(|[x, ..]| x.ln())),
        unary!("sin", 1, QuarterTurns, |_| true, Interval::sin, sin_round, Some(|[x, ..]| x.sin())),
        unary!("cos", 1, QuarterTurns, |_| true, Interval::cos, cos_round, Some(|[x, ..]| x.cos())),
        unary!("tan", 1, QuarterTurns, |_| true, Interval::tan, tan_round, Some(|[x, ..]| x.tan())),
        unary!("asin", 1, UnitInterval, |x| x.abs() <= 1.0, Interval::asin, asin_round, Some(|[x, ..]| x.asin())),
        unary!("acos", 1, UnitInterval, |x| x.abs() <= 1.0, Interval::acos, acos_round, Some(|[x, ..]| x.acos())),
        unary!("atan", 1, No, |_| true, Interval::atan, atan_round, Some(|[x, ..]| x.atan())),
        unary!("sinh", 1, Overflow, |_| true, Interval::sinh, sinh_round, Some(|[x, ..]| x.sinh())),
        unary!("cosh", 1, Overflow, |_| true, Interval::cosh, cosh_round, Some(|[x, ..]| x.cosh())),
        unary!("tanh", 1, No, |_| true, Interval::tanh, tanh_round, Some(|[x, ..]| x.tanh())),
        binary!(
            "atan2",
            1,
            No,
            |y, x| y != 0.0 || x != 0.0,
            Interval::atan2,
            |x, round| {
                let mut value = x[0].clone();
                let side = value.atan2_round(&x[1], round);
                (value, side)
            },
            Some(|[y, x, _]| y.atan2(x))
        ),
        binary!(
            "pow",
            1,
            Power,
            |x, y| x > 0.0 || (x == 0.0 && y > 0.0),
            Interval::pow,
            |x, round| {
                let mut value = x[0].clone();
                let side = value.pow_assign_round(&x[1], round);
                (value, side)
            },
            Some(|[x, y, _]| x.pow(y))
        ),
    ]
}
