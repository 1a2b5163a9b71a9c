//! From linear light to the codes of a picture file: the sRGB transfer, and dither.

use std::sync::LazyLock;

/// The sRGB code in [0, 1] of linear light, by IEC 61966-2-1 (transfer of the standard, no approximation of it).
///
/// Light outside [0, 1] is clamped; NaN gives NaN.
pub fn srgb_from_linear(linear: f64) -> f64 {
    let light = linear.clamp(0.0, 1.0);
    if light <= 0.003_130_8 {
        12.92 * light
    } else if light == 1.0 {
        // 1.055 - 0.055 is not 1 in binary arithmetic; white is exactly white.
        1.0
    } else {
        1.055 * core_math::pow(light, 1.0 / 2.4) - 0.055
    }
}

/// The linear light of an sRGB code in [0, 1]: the inverse of [`srgb_from_linear`].
pub fn linear_from_srgb(code: f64) -> f64 {
    let code = code.clamp(0.0, 1.0);
    if code <= 0.040_45 {
        code / 12.92
    } else if code == 1.0 {
        1.0
    } else {
        core_math::pow((code + 0.055) / 1.055, 2.4)
    }
}

/// The 8-bit sRGB codes of linear light, for a screen: not dithered, at most one code from the nearest. NaN gives 0. About a
/// nanosecond each, after a table of 64 KiB that is made once.
pub fn codes_8(linear: &[f32]) -> Vec<u8> {
    // Fine steps where the transfer is steep: by the square root of the light.
    static TABLE: LazyLock<Vec<u8>> = LazyLock::new(|| {
        let code = |k: usize| {
            let root = k as f64 / 65_535.0;
            (255.0 * srgb_from_linear(root * root)).round() as u8
        };
        (0..=65_535).map(code).collect()
    });
    let table = &*TABLE;
    // A cast saturates, and makes NaN 0.
    linear.iter().map(|light| table[(65_535.0 * light.max(0.0).sqrt()) as u16 as usize]).collect()
}

/// The 16-bit sRGB code nearest to linear light. NaN gives 0.
pub fn code_16(linear: f64) -> u16 {
    (65535.0 * srgb_from_linear(linear)).round() as u16
}

/// The 8-bit sRGB code of linear light, dithered. NaN gives 0.
///
/// Plain rounding shows bands in wide penumbrae. Noise added before rounding removes them; it is a fixed function of
/// the pixel and the channel, so the same picture gives the same file. For the exact code `v` = 255 srgb:
///
/// - `floor(v + 1/2 + n)`, `n` triangular on (-1, 1): the mean of the result is `v` and its variance does not depend
///   on `v` (Lipshitz, Wannamaker and Vanderkooy, *Quantization and Dither*, 1992), so flat areas show no pattern.
///   `n` is the difference of the uniform noises of two neighbours: triangular, and without low frequencies along the
///   row, where the eye would find them first.
/// - within 1/2 of black or white, `floor(v + u)`, `u` uniform on [0, 1): the mean is still `v`, nothing has to be
///   clamped, and `v` = 0 and `v` = 255 stay what they are.
pub fn code_8(linear: f64, row: usize, column: usize, channel: usize) -> u8 {
    let key = noise_key(row, channel);
    code(linear, [column, column.wrapping_add(1)].map(|column| noise(key, column)))
}

/// The codes of [`code_8`] of all channels of the pixels of a row, with the noise of each pixel asked for once.
pub(super) fn row_8(linear: impl Iterator<Item = [f64; 3]>, row: usize, codes: &mut Vec<u8>) {
    let keys = [0, 1, 2].map(|channel| noise_key(row, channel));
    let mut here = keys.map(|key| noise(key, 0));
    for (column, light) in linear.enumerate() {
        let next = keys.map(|key| noise(key, column + 1));
        codes.extend([0, 1, 2].map(|k| code(light[k], [here[k], next[k]])));
        here = next;
    }
}

/// The code under the noise of a pixel and of the one to its right.
fn code(linear: f64, noises: [f64; 2]) -> u8 {
    // A good guess of `v` decides, unless it is nearly between two codes or two forms.
    if let Some(v) = guess(linear)
        && DITHERED_ALIKE.iter().all(|edge| (v - edge).abs() > GUESS)
    {
        let place = dithered(v, noises);
        let above = place - f64::from(place as u8);
        if above > GUESS && above < 1.0 - GUESS {
            return place as u8;
        }
    }
    dithered(255.0 * srgb_from_linear(linear), noises) as u8
}

/// Between them codes are dithered alike.
const DITHERED_ALIKE: [f64; 2] = [0.5, 254.5];

/// An exact code `v` with its noise: in [0, 256), to be rounded down, as a cast does.
fn dithered(v: f64, [u, next]: [f64; 2]) -> f64 {
    let [first, last] = DITHERED_ALIKE;
    // first <= v <= last and |n| < 1 keep the second form within 0..=255.
    if !(first..=last).contains(&v) { v + u } else { v + 0.5 + u - next }
}

/// How far a [`guess`] may be off, with room to spare: a test measures a quarter of it at most.
const GUESS: f64 = 1e-3;

/// About 255 times the sRGB code of linear light in (0, 1), by a table: powers are slow.
fn guess(linear: f64) -> Option<f64> {
    const STEPS: usize = 8192;
    // Fine steps where the transfer is steep: by the square root of the light.
    static TABLE: LazyLock<Vec<f64>> = LazyLock::new(|| {
        let code = |k: usize| 255.0 * srgb_from_linear((k as f64 / STEPS as f64) * (k as f64 / STEPS as f64));
        (0..=STEPS).map(code).collect()
    });
    if !(linear > 0.0 && linear < 1.0) {
        return None;
    }
    let place = linear.sqrt() * STEPS as f64;
    let step = (place as usize).min(STEPS - 1);
    let (a, b) = (TABLE[step], TABLE[step + 1]);
    Some(a + (b - a) * (place - step as f64))
}

/// Uniform noise in [0, 1) of 32 bits of a pixel in the row and channel of that key.
fn noise(key: u64, column: usize) -> f64 {
    (mix(key ^ (column as u64)) >> 32) as f64 / 4_294_967_296.0
}

/// What [`noise`] needs to know of row and channel.
fn noise_key(row: usize, channel: usize) -> u64 {
    mix((row as u64) ^ ((channel as u64) << 48) ^ 0x9e37_79b9_7f4a_7c15)
}

/// The mixing steps of `MurmurHash3`'s 64-bit finaliser (Appleby, public domain), which send every change of a coordinate to
/// all bits.
fn mix(mut h: u64) -> u64 {
    h = (h ^ (h >> 33)).wrapping_mul(0xff51_afd7_ed55_8ccd);
    h = (h ^ (h >> 33)).wrapping_mul(0xc4ce_b9fe_1a85_ec53);
    h ^ (h >> 33)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn transfer_is_the_standard_one() {
        // Values of IEC 61966-2-1: the 8-bit codes of 18 % grey and of half light.
        assert_eq!((255.0 * srgb_from_linear(0.18)).round(), 118.0);
        assert_eq!((255.0 * srgb_from_linear(0.5)).round(), 188.0);
        assert_eq!((srgb_from_linear(0.0), srgb_from_linear(1.0)), (0.0, 1.0));
        assert_eq!((srgb_from_linear(-3.0), srgb_from_linear(f64::INFINITY)), (0.0, 1.0));
        assert!(srgb_from_linear(f64::NAN).is_nan());
        // The two pieces of the standard meet within 1e-7 at the joint.
        assert!((srgb_from_linear(0.003_130_8f64.next_up()) - srgb_from_linear(0.003_130_8)).abs() < 1e-7);
    }

    #[test]
    fn every_16_bit_code_comes_back() {
        for code in 0..=u16::MAX {
            assert_eq!(code_16(linear_from_srgb(f64::from(code) / 65535.0)), code);
        }
    }

    #[test]
    fn guesses_are_good_enough() {
        let mut most = 0.0f64;
        for k in 1..400_000 {
            let light = f64::from(k as f32 / 400_000.0);
            most = most.max((guess(light).unwrap() - 255.0 * srgb_from_linear(light)).abs());
        }
        assert!(most < 0.25 * GUESS, "{most}");
        for k in 0..400_000 {
            let (light, row, column) = (f64::from(k as f32 / 400_000.0), k % 613, k / 613);
            let noises = [column, column + 1].map(|column| noise(noise_key(row, 1), column));
            assert_eq!(code_8(light, row, column, 1), dithered(255.0 * srgb_from_linear(light), noises) as u8);
        }
        assert!([0.0, 1.0, -1.0, f64::NAN].iter().all(|x| guess(*x).is_none()));
    }

    #[test]
    fn codes_of_a_row_are_those_of_its_pixels() {
        let light = |column: usize, channel: usize| (column * 3 + channel) as f64 / 300.0 - 0.01;
        let mut codes = vec![];
        row_8((0..104).map(|column| [0, 1, 2].map(|channel| light(column, channel))), 7, &mut codes);
        for (k, code) in codes.iter().enumerate() {
            assert_eq!(*code, code_8(light(k / 3, k % 3), 7, k / 3, k % 3), "{k}");
        }
        assert_eq!(codes.len(), 3 * 104);
    }

    #[test]
    fn codes_of_a_screen_are_near_the_exact_ones() {
        let light: Vec<f32> = (0..=100_000).map(|k| k as f32 / 100_000.0).collect();
        for (x, code) in light.iter().zip(codes_8(&light)) {
            let exact = 255.0 * srgb_from_linear(f64::from(*x));
            assert!((f64::from(code) - exact).abs() <= 0.55, "{x}: {code} for {exact}");
        }
        assert_eq!(codes_8(&[-1.0, f32::NAN, 2.0, f32::INFINITY, 0.0, 1.0]), [0, 0, 255, 255, 0, 255]);
    }

    #[test]
    fn black_and_white_are_never_dithered() {
        for i in 0..4096 {
            assert_eq!(code_8(0.0, i / 64, i % 64, i % 3), 0);
            assert_eq!(code_8(1.0, i / 64, i % 64, i % 3), 255);
            assert_eq!(code_8(f64::NAN, i / 64, i % 64, i % 3), 0);
        }
    }

    #[test]
    fn dither_preserves_the_mean_of_every_shade() {
        // 256 x 256 draws of variance <= 1/4 + 1/4, minus the correlation along the row: deviation < 0.003.
        for shade in 0..=200 {
            let v = 255.0 * f64::from(shade) / 200.0;
            let linear = linear_from_srgb(v / 255.0);
            let sum: f64 = (0..65536).map(|i| f64::from(code_8(linear, i / 256, i % 256, 1))).sum();
            assert!((sum / 65536.0 - v).abs() < 0.012, "shade {v}: mean {}", sum / 65536.0);
        }
    }

    #[test]
    fn a_slow_gradient_has_no_bands() {
        // Two codes over 1024 columns. Means over 32 x 64 blocks follow the gradient; rounding alone would stay on a
        // step and miss it by up to half a code.
        let exact = |column: usize| 100.0 + 2.0 * (column as f64 + 0.5) / 1024.0;
        for block in 0..16 {
            let (mut mean, mut want) = (0.0, 0.0);
            for row in 0..32 {
                for column in 64 * block..64 * (block + 1) {
                    mean += f64::from(code_8(linear_from_srgb(exact(column) / 255.0), row, column, 0)) / 2048.0;
                    want += exact(column) / 2048.0;
                }
            }
            assert!((mean - want).abs() < 0.06, "block {block}: {mean} for {want}");
        }
    }

    #[test]
    fn dither_uses_three_neighbouring_codes_and_no_more() {
        // v = 100 exactly: triangular noise gives 99, 100, 101 with probability 1/8, 3/4, 1/8.
        let mut histogram = [0u32; 256];
        let linear = linear_from_srgb(100.0 / 255.0);
        (0..65536).for_each(|i| histogram[usize::from(code_8(linear, i / 256, i % 256, 2))] += 1);
        assert_eq!(histogram[99] + histogram[100] + histogram[101], 65536);
        for (code, share) in [(99, 0.125), (100, 0.75), (101, 0.125)] {
            assert!((f64::from(histogram[code]) / 65536.0 - share).abs() < 0.01, "{code}: {}", histogram[code]);
        }
    }

    #[test]
    fn noise_differs_between_channels_and_rows() {
        let noise = |row, column, channel| noise(noise_key(row, channel), column);
        let same = (0..1000).filter(|&i| (noise(0, i, 0) - noise(0, i, 1)).abs() < 1e-3).count();
        assert!(same < 10, "{same}");
        let correlation: f64 = (0..10_000).map(|i| (noise(1, i, 0) - 0.5) * (noise(2, i, 0) - 0.5)).sum::<f64>() / 1e4;
        assert!(correlation.abs() < 0.005, "{correlation}");
    }
}
