//! Sound interval arithmetic: enclosures that never fail, in scalar and batched form.
//!
//! An [`Interval`] is a closed set of real numbers. **Promise:** every operation returns an interval that contains the
//! value of the real function at every real point of its operands where the function is defined, whatever rounding,
//! overflow or underflow does. Undefined points contribute nothing (the set semantics of IEEE 1788-2015): the square root of
//! `[-1, 4]` encloses that of `[0, 4]`. What was left out is told by [`Decorated`] arithmetic, which also proves
//! continuity. Results are the same bits on every machine.
//!
//! ```
//! use antumbra_interval::{Decorated, Interval};
//!
//! // x^2 + y^2 - 2 over a box: every real value is inside.
//! let (x, y) = (Interval::new(0.9, 1.1), Interval::new(2.0, 2.25));
//! let f = x.sqr() + y.sqr() - Interval::point(2.0);
//! assert!(f.contains(3.0) && f.certainly_positive());
//!
//! // 1/x changes sign on [-1, 1] without a root: it is not continuous there, and the decoration says so.
//! let pole = Decorated::from(Interval::new(-1.0, 1.0)).recip();
//! assert!(!pole.certainly_continuous());
//! ```
//!
//! # How tight
//!
//! "Steps" are floats between a bound and the tightest float bound, at most, where the operands are bounded. The tests
//! measure them against exact rationals and correctly rounded values, and on the public vectors of ITF1788.
//!
//! | operation | steps | exact where |
//! |---|---|---|
//! | `-`(unary) `abs` `min` `max` `floor` `ceil` `sign` `hull` `intersection` | 0 | always |
//! | `+` `-` `*` `/` `sqr` `recip` `sqrt` `add_point` `mul_point` | 1 (2 for results of size `2^-1023` to `2^-1019`) | a term, factor or dividend is 0; a sum that is 0; signs are never lost |
//! | `mul_add` | 1 | a factor is 0; signs are never lost |
//! | `powi`, \|n\| <= 8 | 3 \|n\| | n = 0, 1; base 0 |
//! | `powi`, \|n\| > 8 | 1 | base 0 or 1 |
//! | `pow` | 1 | exponent 0, base 0 or 1 |
//! | `exp` `ln` `cbrt` `asin` `acos` `atan` `atan2` `sinh` `cosh` `tanh` | 1 | the arguments with rational values (0, +-1) |
//! | `sin` `cos` `tan` | 1, however large the argument; `[-1, 1]` from a width of `2 pi` rounded down | 0; the extrema +-1 |
//! | [`lanes`], portable | as above | as above |
//! | [`lanes`], AVX-512 | 0 | always |
//!
//! # What is assumed
//!
//! - `f64` is IEEE 754 binary64 with `+ - * /` and `sqrt` rounded to nearest and with subnormals: what Rust defines, as
//!   long as nobody changes the processor's control register (which is undefined behaviour in Rust).
//! - `core_math` returns correctly rounded values (the CORE-MATH project proves and tests its functions).
//! - The proof of the outward step is that of Rump, Zimmermann, Boldo and Melquiond (2009), see [`round`].
//!
//! # Building portable programs
//!
//! `core-math-sys` compiles C sources for the machine that builds, unless the environment variable `TARGET_CPU` names
//! another: set `TARGET_CPU=x86-64` for a program that is to run on any x86-64 (this workspace does so in
//! `.cargo/config.toml`). A correctly rounded value does not depend on the choice, only its cost does.
pub mod affine;
mod arith;
mod decoration;
mod elementary;
mod interval;
pub mod lanes;
mod point_jet;
mod power;
pub mod quadratic;
pub mod round;
#[cfg(feature = "serde")]
mod serial;
mod trig;

pub use decoration::{Decorated, Decoration};
pub use interval::Interval;
pub use point_jet::PointJet;
