//! Two proofs of one picture must not contradict each other.
use crate::certified::{Pixel, Proved};
use antumbra::render::Frame;

/// How much the GPU settled, and what cannot be true together with the CPU's frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Comparison {
    /// Pixels.
    pub pixels: usize,
    /// Proved empty.
    pub empty: usize,
    /// Proved hit.
    pub hits: usize,
    /// Pairs of a proved hit and a light.
    pub lights: usize,
    /// Of them: brackets no wider than the tolerance.
    pub settled: usize,
    /// What both cannot be right about.
    pub contradictions: Vec<String>,
}

/// Holds what the GPU proved against a finished frame of the certified method.
#[must_use]
pub fn compare(proved: &Proved, frame: &Frame, tolerance: f64) -> Comparison {
    let mut out = Comparison { pixels: proved.pixels.len(), ..Comparison::default() };
    for (index, pixel) in proved.pixels.iter().enumerate() {
        let place = format!("pixel ({}, {})", index % frame.width, index / frame.width);
        let (verdict, t_lo, t_hi) = (frame.verdict[index], frame.t_lo[index], frame.t_hi[index]);
        match *pixel {
            Pixel::Empty => {
                out.empty += 1;
                if matches!(verdict, 1 | Frame::PARTLY) {
                    out.contradictions.push(format!("{place}: proved empty and proved hit at {t_lo}"));
                }
            }
            Pixel::Hit { t, .. } => {
                out.hits += 1;
                if matches!(verdict, 0 | Frame::PARTLY) {
                    out.contradictions.push(format!("{place}: proved hit in {t:?}, and verdict {verdict}"));
                } else if verdict == 1 && (t.hi() < t_lo || t_hi < t.lo()) {
                    out.contradictions.push(format!("{place}: first hit in {t:?} and in [{t_lo}, {t_hi}]"));
                }
                if frame.coverage_hi[index] < 1.0 {
                    out.contradictions.push(format!("{place}: covered, and not"));
                }
            }
            Pixel::Open { from } => {
                if verdict == 1 && t_hi < from {
                    out.contradictions.push(format!("{place}: nothing before {from}, and a hit at {t_hi}"));
                }
            }
        }
        if !matches!(pixel, Pixel::Hit { .. }) {
            continue;
        }
        for (k, (brackets, planes)) in proved.lights.iter().zip(&frame.lights).enumerate() {
            let [lo, hi] = brackets[index];
            out.lights += 1;
            out.settled += usize::from(hi - lo <= tolerance);
            let (other_lo, other_hi) = (planes.visible_lo[index], planes.visible_hi[index]);
            if lo > hi || (verdict == 1 && (lo > other_hi || hi < other_lo)) {
                let found = format!("light {k} visible [{lo}, {hi}] and [{other_lo}, {other_hi}]");
                out.contradictions.push(format!("{place}: {found}"));
            }
        }
    }
    out
}
