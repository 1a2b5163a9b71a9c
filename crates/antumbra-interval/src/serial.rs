//! Intervals in files: their two bounds, bit for bit; read back only where they are an interval (feature `serde`).
use crate::Interval;
use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};

impl Serialize for Interval {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        (self.lo, self.hi).serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Interval {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let (lo, hi) = <(f64, f64)>::deserialize(deserializer)?;
        if (lo, hi) == (f64::INFINITY, f64::NEG_INFINITY) {
            return Ok(Self::EMPTY);
        }
        Self::try_new(lo, hi)
            .ok_or_else(|| D::Error::custom(format!("{lo} and {hi} are not the bounds of an interval")))
    }
}
