//! The same in 64 bits, as `Width::Double` writes it: no functions.
#![expect(non_camel_case_types, reason = "what the arithmetic calls f32 has 64 bits here")]
use antumbra::eval::Number;
use antumbra::eval::wgsl::{self, Width};
use antumbra::expr::{Binary, Unary};
use antumbra_interval::Interval;
use std::ops::{Add, Mul, Neg, Sub};

type f32 = f64;

const FLOOR: f64 = wgsl::FLOOR as f64;

fn ball(k: Interval) -> (f64, f64) {
    Width::Double.ball(k)
}

fn exact(k: Interval) -> Option<f64> {
    Width::Double.exact(k)
}

/// `guess` of `double.wgsl`.
fn guess(c: f64) -> f64 {
    f64::from(super::guess(c as core::primitive::f32))
}

/// Functions that kernels in 64 bits do not have.
#[derive(Clone, Copy)]
enum Function {
    Sqrt,
    Exp,
    Ln,
    Sin,
    Cos,
    Sinh,
    Cosh,
}

macro_rules! none {
    ($kind:ident) => {
        impl<const FLUSH: bool> $kind<FLUSH> {
            fn div(self, _: Self) -> Self {
                panic!("there are no quotients in 64 bits")
            }
            fn inverse(self) -> Self {
                panic!("there are no quotients in 64 bits")
            }
            fn real(self, _: f64, _: f64) -> Self {
                panic!("there are no real powers in 64 bits")
            }
            fn named(self, _: Function) -> Self {
                panic!("there are no functions in 64 bits")
            }
        }
    };
}
none!(Twin);
none!(TwinSlope);

include!("arithmetic.rs");
