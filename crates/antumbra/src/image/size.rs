//! How large a picture may be.

/// Most pixels of a side: what every format can hold (GIF has 16 bits for it).
pub const MOST_SIDE: usize = 65_535;
/// Most pixels altogether: at about 100 bytes each, for all planes, these are 26 GB.
pub const MOST_PIXELS: usize = 1 << 28;

/// Why there is no picture of that size.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SizeError {
    /// A side is 0.
    #[error("a picture needs at least 1 pixel a side")]
    Empty,
    /// A side is longer than [`MOST_SIDE`].
    #[error("too large: at most {MOST_SIDE} pixels a side")]
    Side,
    /// More than [`MOST_PIXELS`].
    #[error("too large: at most {MOST_PIXELS} pixels altogether (16384x16384)")]
    Altogether,
}

/// Checks width and height, in pixels.
///
/// # Errors
/// What is wrong with them.
pub fn check_size([width, height]: [usize; 2]) -> Result<(), SizeError> {
    match width.max(height) {
        _ if width.min(height) == 0 => Err(SizeError::Empty),
        side if side > MOST_SIDE => Err(SizeError::Side),
        // Both sides are checked: no overflow.
        _ if width * height > MOST_PIXELS => Err(SizeError::Altogether),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_limits_are_what_they_say() {
        assert_eq!(check_size([0, usize::MAX]), Err(SizeError::Empty));
        assert_eq!(check_size([1, MOST_SIDE]), Ok(()));
        assert_eq!(check_size([MOST_SIDE + 1, 1]), Err(SizeError::Side));
        assert_eq!(check_size([usize::MAX; 2]), Err(SizeError::Side));
        assert_eq!(check_size([16_384; 2]), Ok(()));
        assert_eq!(check_size([16_384, 16_385]), Err(SizeError::Altogether));
    }
}
