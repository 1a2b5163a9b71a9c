//! Pictures as data: named planes of numbers, and the bytes of the files that hold them.
//!
//! A frame is a set of [`Plane`]s of one size. Row 0 is the *top* row of the picture and column 0 its left edge, in
//! memory and in every file. The room knows nothing of scenes or proofs; the only thing it keeps of them is the
//! [`Rounding`] of a plane, so that a bound stays a bound when a file format is narrower than `f64`.
//!
//! | function | file | content |
//! |---|---|---|
//! | [`npy_bytes`], [`npy_header`], [`plane_from_npy`] | `.npy` | one plane, element type kept exactly |
//! | [`png_bytes`], [`png_rows`] | `.png` | a linear RGB plane through the sRGB transfer, 8 bit dithered or 16 bit |
//! | [`Movie`] | `.gif`, `.png` | moving pictures, from frames of 8 bits |
//! | [`exr_bytes`] | `.exr` | linear `R`, `G`, `B` and every other plane as channels of their own |

mod color;
mod exr;
mod movie;
mod npy;
mod plane;
mod png;
mod size;

pub use self::{
    color::{code_8, code_16, codes_8, linear_from_srgb, srgb_from_linear},
    exr::exr_bytes,
    movie::Movie,
    npy::{npy_bytes, npy_header, plane_from_npy},
    plane::{Plane, Planes, Rounding, Samples},
    png::{Depth, Still, png_bytes, png_bytes_noted, png_codes, png_rows},
    size::{MOST_PIXELS, MOST_SIDE, SizeError, check_size},
};

/// Name and version written into the header of every picture.
pub const SOFTWARE: &str = concat!("Antumbra ", env!("CARGO_PKG_VERSION"));

/// Name of the plane that is the picture itself: linear light, shape (rows, columns, 3).
pub const COLOR_PLANE: &str = "rgb";

/// Why planes could not be formed or encoded.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A name that could not be a file name and a channel name everywhere.
    #[error("`{0}` cannot name a plane: use lower-case letters, digits and `_`, beginning with a letter")]
    Name(String),
    /// Two planes of one name.
    #[error("there is a plane `{0}` already")]
    Duplicate(String),
    /// The number of samples does not fit the shape, or the shape is empty.
    #[error("plane `{name}` of shape {rows} x {columns} x {channels} cannot have {found} samples")]
    Length {
        /// Name of the plane.
        name: String,
        /// Rows promised.
        rows: usize,
        /// Columns promised.
        columns: usize,
        /// Channels promised.
        channels: usize,
        /// Samples given.
        found: usize,
    },
    /// A plane of another size than the planes already there.
    #[error("plane `{name}` is {rows} x {columns}, the other planes are not")]
    Size {
        /// Name of the plane.
        name: String,
        /// Its rows.
        rows: usize,
        /// Its columns.
        columns: usize,
    },
    /// No plane of that name.
    #[error("there is no plane `{0}`")]
    Missing(String),
    /// The plane is not a picture.
    #[error("plane `{0}` is not a colour picture: three channels of f32 or f64 are needed")]
    NotColor(String),
    /// A colour that is not a number; drawing it would hide a mistake.
    #[error("plane `{name}` has a colour that is not a number at row {row}, column {column}")]
    NotANumber {
        /// Name of the plane.
        name: String,
        /// Row, from the top.
        row: usize,
        /// Column, from the left.
        column: usize,
    },
    /// The bytes of a file are not a plane.
    #[error("plane `{name}` cannot be read: {reason}")]
    Decode {
        /// Name of the plane.
        name: String,
        /// What is wrong with it.
        reason: String,
    },
    /// The encoder of the file format refused.
    #[error("cannot encode {format}: {reason}")]
    Encode {
        /// The file format.
        format: &'static str,
        /// What the encoder said.
        reason: String,
    },
}
