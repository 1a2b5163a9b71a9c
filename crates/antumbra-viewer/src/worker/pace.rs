//! How large a picture may be that has to be there at once, and by which sizes it grows.

/// What the first picture of a job may take, in seconds, for all its sides together.
const TARGET: f64 = 0.055;
/// Least and most pixels of it.
const LEAST: f64 = 32.0 * 32.0;
const MOST: f64 = 1024.0 * 1024.0;
/// Pixels where nothing is known yet.
const USUAL: f64 = 96.0 * 96.0;

/// Pixels that are drawn in the time of a first picture, as measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pace {
    pixels: f64,
}

impl Default for Pace {
    fn default() -> Self {
        Self { pixels: USUAL }
    }
}

impl Pace {
    /// Takes a measured first picture into account: so many pixels in so many seconds. Goes by at most a factor of 3, and up more
    /// carefully than down.
    pub fn measured(&mut self, pixels: usize, seconds: f64) {
        let wanted = pixels as f64 * TARGET / seconds.max(1e-4);
        let next = wanted.clamp(self.pixels / 3.0, self.pixels * 3.0);
        let next = if next > self.pixels { (next * self.pixels).sqrt() } else { next };
        self.pixels = next.clamp(LEAST, MOST);
    }

    /// The sizes of a picture, the coarse one first, each about twice as fine as the one before, the last one full.
    #[must_use]
    pub fn sizes(&self, full: [usize; 2]) -> Vec<[usize; 2]> {
        let all = (full[0] * full[1]) as f64;
        let mut shrink = (all / self.pixels).sqrt();
        let mut sizes = vec![];
        // A last step of less than 1.5 is not worth one of its own.
        while shrink > 1.5 {
            sizes.push(full.map(|n| ((n as f64 / shrink).round() as usize).max(1)));
            shrink *= 0.5;
        }
        sizes.push(full);
        sizes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_grow_to_the_full_one() {
        let sizes = Pace::default().sizes([800, 600]);
        assert_eq!(*sizes.last().unwrap(), [800, 600]);
        assert!(sizes[0][0] * sizes[0][1] <= 9500, "{sizes:?}");
        assert!(sizes.windows(2).all(|w| w[0][0] < w[1][0] && w[1][0] <= 3 * w[0][0]), "{sizes:?}");
        assert_eq!(Pace::default().sizes([5, 1]), [[5, 1]]);
    }

    #[test]
    fn the_pace_follows_what_is_measured() {
        // Every pixel takes 20 microseconds.
        let mut pace = Pace::default();
        for _ in 0..20 {
            let [w, h] = pace.sizes([2000, 2000])[0];
            pace.measured(w * h, 2e-5 * (w * h) as f64);
        }
        let [w, h] = pace.sizes([2000, 2000])[0];
        let seconds = 2e-5 * (w * h) as f64;
        assert!((0.5 * TARGET..1.2 * TARGET).contains(&seconds), "{seconds}");
        for _ in 0..20 {
            pace.measured(1000, 10.0);
        }
        assert_eq!(pace.pixels, LEAST);
        pace.measured(1000, f64::NAN);
        assert!(pace.pixels.is_finite());
    }
}
