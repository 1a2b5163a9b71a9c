//! What the paper printed, and what an independent program found.

/// A row of Table 1, for pictures of 512 x 512 pixels on an NVIDIA 9600M GT.
pub(super) struct Published {
    /// The preset.
    pub(super) preset: &'static str,
    /// "Beam casting (secs.)".
    pub(super) casting_seconds: f64,
    /// "Pixels in shadow".
    pub(super) in_shadow: u64,
    /// "Initial beams occluded", as it must read: "No. beams" is 49 times this.
    pub(super) occluded: u64,
    /// The same as it is printed, where it is misprinted.
    pub(super) misprint: Option<u64>,
    /// "Time (secs.)" of the method with initial beams.
    pub(super) seconds: f64,
    /// "Time (secs.)" using 49 beams.
    pub(super) seconds_of_49: f64,
    /// "No. beams" using 49 beams: 49 times the hits.
    pub(super) beams_of_49: u64,
    /// "% time saved".
    pub(super) saved: u32,
    /// Of our camera and light: the share of the picture's pixels, in percent, that face the light and are in its
    /// shadow, by centre rays and 7 x 7 points of the light at 512 x 512. From a program that shares no code with this one.
    pub(super) rays_in_shadow: f64,
}

/// Sub-beams of one point.
pub(super) const SUB_BEAMS: u64 = 49;
/// Pixels of the paper's pictures.
pub(super) const PIXELS: u64 = 512 * 512;

impl Published {
    /// Hits, which the paper does not print.
    pub(super) fn hits(&self) -> u64 {
        self.beams_of_49 / SUB_BEAMS
    }

    /// "No. beams" of the method with initial beams.
    pub(super) fn beams(&self) -> u64 {
        self.occluded * SUB_BEAMS
    }
}

/// Table 1.
pub(super) const TABLE_1: [Published; 4] = [
    Published {
        preset: "orthocircle",
        casting_seconds: 1.23,
        in_shadow: 13_328,
        occluded: 14_691,
        misprint: Some(14_961),
        seconds: 1.66,
        seconds_of_49: 4.08,
        beams_of_49: 7_101_962,
        saved: 59,
        rays_in_shadow: 5.42,
    },
    Published {
        preset: "chubs",
        casting_seconds: 1.53,
        in_shadow: 21_932,
        occluded: 27_357,
        misprint: None,
        seconds: 3.82,
        seconds_of_49: 6.57,
        beams_of_49: 7_343_091,
        saved: 42,
        rays_in_shadow: 8.27,
    },
    Published {
        preset: "kusner",
        casting_seconds: 2.24,
        in_shadow: 22_374,
        occluded: 44_979,
        misprint: None,
        seconds: 5.65,
        seconds_of_49: 9.44,
        beams_of_49: 7_395_374,
        saved: 40,
        rays_in_shadow: 6.00,
    },
    Published {
        preset: "mcmullen",
        casting_seconds: 2.28,
        in_shadow: 55_231,
        occluded: 83_386,
        misprint: Some(73_386),
        seconds: 6.84,
        seconds_of_49: 11.06,
        beams_of_49: 8_749_244,
        saved: 38,
        rays_in_shadow: 21.42,
    },
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_printed_numbers_agree_with_each_other() {
        let printed_beams = [719_859, 1_340_493, 2_203_971, 4_085_914];
        for (row, beams) in TABLE_1.iter().zip(printed_beams) {
            assert_eq!(row.beams(), beams, "{}", row.preset);
            assert_eq!(row.hits() * SUB_BEAMS, row.beams_of_49, "{}", row.preset);
            let saved = 100.0 * (1.0 - row.seconds / row.seconds_of_49);
            assert!((saved - f64::from(row.saved)).abs() < 1.0, "{}: {saved}", row.preset);
            assert!(row.in_shadow < row.occluded);
        }
    }
}
