//! Pictures of what is known: verdicts, shadow classes, cost, widths of brackets; with a legend.
use super::legend::Legend;
use super::{Frame, LightPlanes};
use crate::image::{COLOR_PLANE, Error, Plane, Planes, linear_from_srgb};
use crate::verdict::{Reason, Verdict};

/// What to show.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Overlay {
    /// What is proved of each pixel.
    Verdict,
    /// Lit, partly, dark, or a bracket that is wider than the tolerance.
    Shadow,
    /// Evaluations, on a logarithmic scale.
    Cost,
    /// Width of the bracket of the visible fraction, on a logarithmic scale.
    Width,
}

impl Overlay {
    /// Every overlay with its name.
    pub const ALL: [(Self, &'static str); 4] =
        [(Self::Verdict, "verdict"), (Self::Shadow, "shadow"), (Self::Cost, "cost"), (Self::Width, "width")];

    /// The overlay of that name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|(_, n)| *n == name).map(|(overlay, _)| overlay)
    }
}

/// Colour (sRGB) and meaning of one kind of pixel.
type Entry = ([u8; 3], String);

const PAPER: [u8; 3] = [24, 24, 28];
const NOTHING: ([u8; 3], &str) = ([54, 58, 70], "no surface");

impl Frame {
    /// A picture of what is known: planes that hold only the colours. Below it, in rows of its own, is a legend where one
    /// [fits](Legend::fits). `tolerance` is the width from which a bracket counts as open.
    ///
    /// # Errors
    /// None for a frame whose planes have the lengths that [`Frame::new`] gave them; the type is that of planes.
    pub fn overlay(&self, overlay: Overlay, tolerance: f64) -> Result<Planes, Error> {
        let legend = self.legend(overlay, tolerance);
        let mut canvas: Vec<[u8; 3]> = legend.kinds.iter().map(|kind| legend.entries[*kind].0).collect();
        let more = legend.rows(self.width, self.height).unwrap_or(0);
        canvas.resize((self.height + more) * self.width, PAPER);
        legend.draw(&mut canvas, self.width, self.height);
        let linear: Vec<f32> =
            canvas.iter().flatten().map(|code| linear_from_srgb(f64::from(*code) / 255.0) as f32).collect();
        let mut planes = Planes::new();
        planes.add(Plane::with_channels(COLOR_PLANE, self.height + more, self.width, 3, linear)?)?;
        Ok(planes)
    }

    /// The kinds of the pixels and their legend.
    #[must_use]
    pub fn legend(&self, overlay: Overlay, tolerance: f64) -> Legend {
        let (entries, kinds) = match overlay {
            Overlay::Verdict => self.by_verdict(),
            Overlay::Shadow => self.by_shadow(tolerance),
            Overlay::Cost => {
                let (mut entries, kinds) =
                    self.by_scale("cost", |i| f64::from(self.cost[i]), |e| format!("{}", 1_u64 << e));
                entries[0].1 += " evaluations";
                (entries, kinds)
            }
            Overlay::Width => {
                let of = |l: &LightPlanes, i: usize| l.visible_hi[i] - l.visible_lo[i];
                let width = |i: usize| self.lights.iter().map(|l| of(l, i)).fold(0.0, f64::max) * 65_536.0;
                let (mut entries, mut kinds) = self.by_scale("width", width, |e| format!("2^{}", e as i32 - 16));
                entries.insert(0, (NOTHING.0, NOTHING.1.to_owned()));
                for (kind, t) in kinds.iter_mut().zip(&self.t_lo) {
                    *kind = if t.is_nan() { 0 } else { *kind + 1 };
                }
                (entries, kinds)
            }
        };
        Legend { entries, kinds }
    }

    fn by_verdict(&self) -> (Vec<Entry>, Vec<usize>) {
        let code = Frame::verdict_code;
        let open = |reason| code(Verdict::Unknown(reason));
        let table: [(u8, [u8; 3], &str); 8] = [
            (code(Verdict::No), [54, 58, 70], "empty (proved)"),
            (code(Verdict::Yes), [226, 196, 150], "hit (proved)"),
            (Frame::PARTLY, [120, 190, 120], "edge (proved)"),
            (open(Reason::Resolution), [240, 200, 40], "undecided: resolution"),
            (open(Reason::Touching), [190, 80, 220], "undecided: touching"),
            (open(Reason::Domain), [230, 70, 60], "undecided: domain"),
            (open(Reason::Budget), [250, 130, 20], "undecided: budget"),
            (Frame::UNSEEN, [0, 0, 0], "not looked at yet"),
        ];
        let kinds = self.verdict.iter().map(|v| table.iter().position(|(c, ..)| c == v).unwrap_or(7)).collect();
        (table.into_iter().map(|(_, color, text)| (color, text.to_owned())).collect(), kinds)
    }

    fn by_shadow(&self, tolerance: f64) -> (Vec<Entry>, Vec<usize>) {
        let entries = [
            NOTHING,
            ([250, 236, 180], "lit (all of each light)"),
            ([214, 96, 60], "penumbra (a part of them)"),
            ([40, 52, 120], "dark (none of any)"),
            ([0, 210, 190], "bracket wider than the tolerance"),
        ];
        let kinds = (0..self.verdict.len()).map(|i| {
            // Of all the light: the bounds of the least and the most visible light.
            let lo = self.lights.iter().map(|l| l.visible_lo[i]).fold(f64::NAN, f64::min);
            let hi = self.lights.iter().map(|l| l.visible_hi[i]).fold(f64::NAN, f64::max);
            let open = |l: &LightPlanes| l.visible_hi[i] - l.visible_lo[i] > tolerance * (1.0 + 1e-9);
            match (lo, hi) {
                _ if lo.is_nan() => 0,
                _ if self.lights.iter().any(open) => 4,
                (1.0, _) => 1,
                (_, 0.0) => 3,
                _ => 2,
            }
        });
        (entries.map(|(color, text)| (color, text.to_owned())).to_vec(), kinds.collect())
    }

    /// Powers of two of a quantity, from dark to bright.
    fn by_scale(
        &self,
        what: &str,
        of: impl Fn(usize) -> f64,
        name: impl Fn(usize) -> String,
    ) -> (Vec<Entry>, Vec<usize>) {
        const STEPS: usize = 17;
        let mut entries: Vec<Entry> = (0..STEPS)
            .map(|e| {
                // Most pixels are on the first steps: those differ more.
                let x = (e as f64 / (STEPS - 1) as f64).sqrt();
                let ramp = |from: f64, to: f64| (255.0 * ((x - from) / (to - from)).clamp(0.0, 1.0)) as u8;
                (
                    [ramp(0.1, 0.7), ramp(0.35, 1.0), ramp(-0.3, 0.5) / 2 + ramp(0.8, 1.0) / 2],
                    format!("{what} from {}", name(e)),
                )
            })
            .collect();
        entries[0].1 = format!("{what} below {}", name(1));
        let kind = |i: usize| {
            let value = of(i);
            // NaN (no surface) and everything below 2 is the first step.
            if value >= 2.0 { (f64::floor(log2(value)) as usize).min(STEPS - 1) } else { 0 }
        };
        let kinds = (0..self.verdict.len()).map(kind).collect();
        (entries, kinds)
    }
}

fn log2(x: f64) -> f64 {
    core_math::log2(x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_overlay_has_a_legend_and_colours_by_kind() {
        let mut frame = Frame::new(300, 300, 1).unwrap();
        frame.verdict.fill(0);
        (frame.verdict[5], frame.t_lo[5]) = (1, 1.0);
        (frame.lights[0].visible_lo[5], frame.lights[0].visible_hi[5]) = (0.25, 0.5);
        frame.cost[5] = 1000;
        for (overlay, name) in Overlay::ALL {
            assert_eq!(Overlay::from_name(name), Some(overlay));
            let planes = frame.overlay(overlay, 0.01).unwrap();
            let plane = planes.require(COLOR_PLANE).unwrap();
            assert!(plane.rows() > 300 + 4 * 14 && plane.columns() == 300);
            let crate::image::Samples::F32(v) = plane.samples() else { panic!("single precision") };
            assert_ne!(v[..3], v[15..18], "{name}: the special pixel looks different");
            let ink = linear_from_srgb(232.0 / 255.0) as f32;
            assert!(v[3 * 300 * 300..].contains(&ink) && !v[..3 * 300 * 300].contains(&ink), "{name}: no letters");
        }
        assert_eq!(frame.by_shadow(0.01).1[5], 4);
        assert_eq!(frame.by_shadow(0.25).1[5], 2);
    }
}
