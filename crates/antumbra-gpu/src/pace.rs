//! How much work one dispatch gets: little at first, then what the GPU has shown to finish soon enough. No watchdog fires, and whoever
//! stops does not wait long.
use std::sync::atomic::{AtomicU32, Ordering};

/// Groups of threads of the next dispatch of a kernel.
#[derive(Debug)]
pub(crate) struct Pace(AtomicU32);

/// Dispatches that take less than this may grow, those that take more than four times as long shrink. Seconds.
const AIM: f64 = 0.03;
/// Groups: even a slow GPU does that many in time, each thread being bounded in evaluations.
const LEAST: u32 = 16;
/// Groups: WGSL's limit.
const MOST: u32 = 65_535;

impl Pace {
    /// Begins with that many groups.
    pub(crate) fn new(groups: u32) -> Self {
        Self(AtomicU32::new(groups.clamp(LEAST, MOST)))
    }

    /// So many of those that are left.
    pub(crate) fn next(&self, left: u32) -> u32 {
        left.min(self.0.load(Ordering::Relaxed))
    }

    /// Learns that so many groups took that long.
    pub(crate) fn took(&self, groups: u32, seconds: f64) {
        let now = self.0.load(Ordering::Relaxed);
        if seconds > 4.0 * AIM {
            // To about the aim, at once.
            let fit = f64::from(groups) * AIM / seconds;
            self.0.store((fit as u32).clamp(LEAST, MOST), Ordering::Relaxed);
        } else if seconds < AIM && groups == now {
            self.0.store(now.saturating_mul(2).min(MOST), Ordering::Relaxed);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{LEAST, MOST, Pace};

    #[test]
    fn a_slow_gpu_gets_little_and_a_fast_one_much() {
        let pace = Pace::new(1024);
        for _ in 0..20 {
            let groups = pace.next(1 << 30);
            pace.took(groups, 1e-7 * f64::from(groups));
        }
        assert_eq!(pace.next(1 << 30), MOST);
        assert_eq!(pace.next(7), 7);
        // Ten milliseconds for a group: two dispatches later none takes longer than the least.
        for _ in 0..2 {
            let groups = pace.next(1 << 30);
            pace.took(groups, 1e-2 * f64::from(groups));
        }
        assert_eq!(pace.next(1 << 30), LEAST);
        // The last, small dispatch of a picture does not count as proof of speed.
        pace.took(3, 1e-6);
        assert_eq!(pace.next(1 << 30), LEAST);
    }
}
