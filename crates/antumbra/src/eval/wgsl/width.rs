//! How wide the numbers of a kernel are.
use super::{FLOOR, FORMS, ball, exact};
use antumbra_interval::Interval;
use antumbra_interval::round::sub_up;

/// Bits of the numbers that a kernel computes with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Width {
    /// f32: every GPU has it.
    Single,
    /// f64, of the GPUs that have it: an extension of naga's. Its fence needs whole numbers of 64 bits.
    Double,
}

impl Width {
    /// Text that was written for f32, of kernels or of [`FORMS`] without its head, in this width. Nothing in it knows how many bits its
    /// numbers have.
    #[must_use]
    pub fn text(self, text: &str) -> String {
        match self {
            Self::Single => text.to_owned(),
            Self::Double => text.replace("f32", "f64"),
        }
    }

    /// Balls, affine forms and slopes of this width.
    #[must_use]
    pub fn forms(self) -> String {
        match self {
            Self::Single => FORMS.to_owned(),
            Self::Double => include_str!("double.wgsl").to_owned() + &self.text(include_str!("forms.wgsl")),
        }
    }

    /// `(m, r)` with `|x - m| <= r` for every x in the interval, `r >= FLOOR`: for numbers that get into f32's range only.
    #[must_use]
    pub fn ball(self, k: Interval) -> (f64, f64) {
        if self == Self::Single {
            let (m, r) = ball(k);
            return (m.into(), r.into());
        }
        let m = k.mid();
        (m, sub_up(k.hi(), m).max(sub_up(m, k.lo())).max(FLOOR.into()))
    }

    /// The number, if the interval holds one only and this width holds it as a normal number.
    #[must_use]
    pub fn exact(self, k: Interval) -> Option<f64> {
        match self {
            Self::Single => exact(k).map(f64::from),
            Self::Double => (k.lo() == k.hi() && (k.lo() == 0.0 || k.lo().is_normal())).then_some(k.lo()),
        }
    }

    /// Its bits, of a number of this width: no reader of decimals is to be trusted.
    pub(super) fn number(self, v: f64) -> String {
        match self {
            Self::Single => format!("bitcast<f32>(0x{:08x}u)", (v as f32).to_bits()),
            Self::Double => format!("bitcast<f64>(0x{:016x}lu)", v.to_bits()),
        }
    }
}
