//! A named plane, and a set of planes of one size.

use super::Error;

/// The numbers of a plane, row by row from the top; the channels of one pixel are neighbours.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Samples {
    /// Double precision: bounds of proofs.
    F64(Vec<f64>),
    /// Single precision: colours and other things that are only looked at.
    F32(Vec<f32>),
    /// Wide counters.
    U64(Vec<u64>),
    /// Counters.
    U32(Vec<u32>),
    /// Codes of up to 65536 kinds.
    U16(Vec<u16>),
    /// Codes of up to 256 kinds, such as verdicts.
    U8(Vec<u8>),
}

impl Samples {
    /// How many numbers there are.
    pub fn len(&self) -> usize {
        match self {
            Self::F64(v) => v.len(),
            Self::F32(v) => v.len(),
            Self::U64(v) => v.len(),
            Self::U32(v) => v.len(),
            Self::U16(v) => v.len(),
            Self::U8(v) => v.len(),
        }
    }

    /// True where there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

macro_rules! samples_from {
    ($($number:ty => $kind:ident),*) => {$(
        impl From<Vec<$number>> for Samples {
            fn from(values: Vec<$number>) -> Self {
                Self::$kind(values)
            }
        }
    )*};
}
samples_from!(f64 => F64, f32 => F32, u64 => U64, u32 => U32, u16 => U16, u8 => U8);

/// Which way an `f64` plane goes when a file format holds only `f32`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Rounding {
    /// To the nearest number: the plane is an estimate.
    #[default]
    Nearest,
    /// Towards minus infinity: the plane is a lower bound and stays one.
    Down,
    /// Towards plus infinity: the plane is an upper bound and stays one.
    Up,
}

impl Rounding {
    /// `value` as `f32`, on the side that this rounding names. NaN stays NaN; infinities stay.
    ///
    /// `as f32` rounds to nearest, so its result is one of the two neighbours of `value` (or `value` itself) and one
    /// step in the wanted direction always suffices. The comparison is exact, since every `f32` is an `f64`. A finite
    /// value beyond the largest `f32` becomes infinite on the outer side and the largest `f32` on the inner side.
    pub fn narrow(self, value: f64) -> f32 {
        let near = value as f32;
        match self {
            Self::Down if f64::from(near) > value => near.next_down(),
            Self::Up if f64::from(near) < value => near.next_up(),
            _ => near,
        }
    }
}

/// One named plane of shape (rows, columns) or (rows, columns, channels), row 0 at the top.
#[derive(Clone, Debug, PartialEq)]
pub struct Plane {
    name: String,
    rows: usize,
    columns: usize,
    channels: usize,
    rounding: Rounding,
    samples: Samples,
}

impl Plane {
    /// A plane of shape (`rows`, `columns`).
    ///
    /// # Errors
    /// As for [`Plane::with_channels`].
    pub fn new(
        name: impl Into<String>,
        rows: usize,
        columns: usize,
        samples: impl Into<Samples>,
    ) -> Result<Self, Error> {
        Self::with_channels(name, rows, columns, 1, samples)
    }

    /// A plane of shape (`rows`, `columns`, `channels`); with one channel it is of shape (`rows`, `columns`).
    ///
    /// # Errors
    /// [`Error::Name`] unless the name is made of `a-z`, `0-9` and `_` and begins with a letter (it becomes the name
    /// of a file and of a channel); [`Error::Length`] unless there are `rows * columns * channels >= 1` samples.
    pub fn with_channels(
        name: impl Into<String>,
        rows: usize,
        columns: usize,
        channels: usize,
        samples: impl Into<Samples>,
    ) -> Result<Self, Error> {
        let (name, samples) = (name.into(), samples.into());
        let spelled = name.starts_with(|c: char| c.is_ascii_lowercase())
            && name.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_');
        if !spelled {
            return Err(Error::Name(name));
        }
        let needed = rows.checked_mul(columns).and_then(|n| n.checked_mul(channels));
        if samples.is_empty() || needed != Some(samples.len()) {
            return Err(Error::Length { name, rows, columns, channels, found: samples.len() });
        }
        Ok(Self { name, rows, columns, channels, rounding: Rounding::Nearest, samples })
    }

    /// The same plane, its numbers being bounds: see [`Rounding`].
    #[must_use]
    pub fn rounded(mut self, rounding: Rounding) -> Self {
        self.rounding = rounding;
        self
    }

    /// The name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Height in pixels.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Width in pixels.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// Numbers per pixel.
    pub fn channels(&self) -> usize {
        self.channels
    }

    /// Which way the numbers go where a file is narrower.
    pub fn rounding(&self) -> Rounding {
        self.rounding
    }

    /// The numbers: channel `k` of the pixel in row `i`, column `j` is at `(i * columns + j) * channels + k`.
    pub fn samples(&self) -> &Samples {
        &self.samples
    }

    /// The shape as `.npy` states it: two numbers, or three where there are several channels.
    pub fn shape(&self) -> Vec<usize> {
        let mut shape = vec![self.rows, self.columns];
        if self.channels > 1 {
            shape.push(self.channels);
        }
        shape
    }
}

/// Planes of one size and different names, in the order in which they were added.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Planes {
    planes: Vec<Plane>,
}

impl Planes {
    /// No planes yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a plane.
    ///
    /// # Errors
    /// [`Error::Duplicate`] where its name is taken, [`Error::Size`] where its size is not that of the others.
    pub fn add(&mut self, plane: Plane) -> Result<(), Error> {
        if self.get(plane.name()).is_some() {
            return Err(Error::Duplicate(plane.name));
        }
        if let Some(first) = self.planes.first()
            && (first.rows, first.columns) != (plane.rows, plane.columns)
        {
            return Err(Error::Size { name: plane.name, rows: plane.rows, columns: plane.columns });
        }
        self.planes.push(plane);
        Ok(())
    }

    /// The plane of that name.
    pub fn get(&self, name: &str) -> Option<&Plane> {
        self.planes.iter().find(|p| p.name == name)
    }

    /// The plane of that name, or [`Error::Missing`].
    ///
    /// # Errors
    /// [`Error::Missing`] where there is none.
    pub fn require(&self, name: &str) -> Result<&Plane, Error> {
        self.get(name).ok_or_else(|| Error::Missing(name.to_owned()))
    }

    /// All planes, in the order in which they were added.
    pub fn iter(&self) -> impl Iterator<Item = &Plane> {
        self.planes.iter()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shape_and_samples_must_agree() {
        assert!(Plane::new("t_lo", 2, 3, vec![0.0; 6]).is_ok());
        assert!(matches!(Plane::new("t_lo", 2, 3, vec![0.0; 5]), Err(Error::Length { found: 5, .. })));
        assert!(matches!(Plane::new("t_lo", usize::MAX, 3, vec![0u8; 5]), Err(Error::Length { .. })));
        assert!(matches!(Plane::new("t_lo", 0, 3, Vec::<u8>::new()), Err(Error::Length { .. })));
        let normal = Plane::with_channels("normal", 2, 3, 3, vec![0.0; 18]).unwrap();
        assert_eq!((normal.shape(), Plane::new("x", 2, 3, vec![0u8; 6]).unwrap().shape()), (vec![2, 3, 3], vec![2, 3]));
    }

    #[test]
    fn names_are_safe_as_file_names() {
        for bad in ["", "../x", "a b", "_a", "1a", "Normal", "a.b", "é"] {
            assert!(matches!(Plane::new(bad, 1, 1, vec![0u8]), Err(Error::Name(_))), "{bad:?}");
        }
    }

    #[test]
    fn planes_of_one_set_have_one_size_and_different_names() {
        let mut planes = Planes::new();
        planes.add(Plane::new("a", 2, 2, vec![0u8; 4]).unwrap()).unwrap();
        assert!(matches!(planes.add(Plane::new("a", 2, 2, vec![0u8; 4]).unwrap()), Err(Error::Duplicate(_))));
        assert!(matches!(planes.add(Plane::new("b", 1, 4, vec![0u8; 4]).unwrap()), Err(Error::Size { .. })));
        assert!(matches!(planes.require("b"), Err(Error::Missing(_))));
        assert_eq!(planes.iter().count(), 1);
    }

    #[test]
    fn narrowing_keeps_bounds_on_their_side() {
        let mut state = 1u64;
        for _ in 0..100_000 {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let value = f64::from_bits(state);
            if value.is_nan() {
                continue;
            }
            let (lo, hi) = (Rounding::Down.narrow(value), Rounding::Up.narrow(value));
            assert!(f64::from(lo) <= value && value <= f64::from(hi), "{value:e}: {lo:e} {hi:e}");
            assert!(lo == hi || lo.next_up() == hi, "{value:e}: {lo:e} {hi:e} are not neighbours");
        }
        assert_eq!(Rounding::Up.narrow(0.5), 0.5);
        assert_eq!(Rounding::Down.narrow(1e300), f32::MAX);
        assert_eq!(Rounding::Up.narrow(f64::NEG_INFINITY), f32::NEG_INFINITY);
        assert!(Rounding::Down.narrow(f64::NAN).is_nan());
    }
}
