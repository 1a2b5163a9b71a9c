//! Pictures of what is known: verdicts, shadow classes, cost, widths of brackets; with a legend.
use super::{Frame, LightPlanes};
use crate::image::{COLOR_PLANE, Error, Plane, Planes, linear_from_srgb};
use crate::verdict::{Reason, Verdict};
use font8x8::UnicodeFonts;

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

/// What an overlay shows, for those who draw it themselves.
#[derive(Clone, Debug, PartialEq)]
pub struct Legend {
    /// Colour (sRGB) and meaning of each kind of pixel.
    pub entries: Vec<([u8; 3], String)>,
    /// The kind of each pixel of the frame: an index among the entries.
    pub kinds: Vec<usize>,
}

/// Height of a line of the legend, and size of a letter.
const LINE: usize = 14;
const LETTER: usize = 8;
/// Column in which the text of the legend begins.
const TEXT: usize = 22;
const PAPER: [u8; 3] = [24, 24, 28];
const INK: [u8; 3] = [232, 232, 232];

impl Frame {
    /// A picture of what is known, with a legend below it: planes that hold only the colours. `tolerance` is the width
    /// from which a bracket counts as open.
    ///
    /// # Errors
    /// None for a frame whose planes have the lengths that [`Frame::new`] gave them; the type is that of planes.
    pub fn overlay(&self, overlay: Overlay, tolerance: f64) -> Result<Planes, Error> {
        let Legend { entries, kinds } = self.legend(overlay, tolerance);
        let lines: Vec<String> = entries
            .iter()
            .enumerate()
            .map(|(k, (_, text))| format!("{text}: {}", kinds.iter().filter(|kind| **kind == k).count()))
            .collect();
        // A small picture gets a margin, so that its legend can be read.
        let longest = lines.iter().map(String::len).max().unwrap_or(0);
        let width = self.width.max(TEXT + longest * LETTER + 4);
        let rows = self.height + entries.len() * LINE + 4;
        let mut canvas = vec![PAPER; rows * width];
        for (i, kind) in kinds.iter().enumerate() {
            canvas[i / self.width * width + i % self.width] = entries[*kind].0;
        }
        for (k, ((color, _), line)) in entries.iter().zip(&lines).enumerate() {
            let top = self.height + 3 + k * LINE;
            for y in top..top + LETTER {
                canvas[y * width + 4..y * width + 16].fill(*color);
            }
            write(&mut canvas, width, TEXT, top, line);
        }
        let linear: Vec<f32> =
            canvas.iter().flatten().map(|code| linear_from_srgb(f64::from(*code) / 255.0) as f32).collect();
        let mut planes = Planes::new();
        planes.add(Plane::with_channels(COLOR_PLANE, rows, width, 3, linear)?)?;
        Ok(planes)
    }

    /// The kinds of the pixels and their legend.
    #[must_use]
    pub fn legend(&self, overlay: Overlay, tolerance: f64) -> Legend {
        let (entries, kinds) = match overlay {
            Overlay::Verdict => self.by_verdict(),
            Overlay::Shadow => self.by_shadow(tolerance),
            Overlay::Cost => self.by_scale("evaluations", |i| f64::from(self.cost[i]), |e| format!("{}", 1_u64 << e)),
            Overlay::Width => {
                let of = |l: &LightPlanes, i: usize| l.visible_hi[i] - l.visible_lo[i];
                let width = |i: usize| self.lights.iter().map(|l| of(l, i)).fold(0.0, f64::max) * 65_536.0;
                self.by_scale("bracket width", width, |e| format!("2^{}", e as i32 - 16))
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
            (Frame::PARTLY, [120, 190, 120], "edge: centre missed, other rays hit (proved)"),
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
            ([54, 58, 70], "no surface"),
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
                let x = e as f64 / (STEPS - 1) as f64;
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

/// Writes a line of text.
fn write(canvas: &mut [[u8; 3]], width: usize, left: usize, top: usize, text: &str) {
    for (k, letter) in text.chars().enumerate() {
        let Some(glyph) = font8x8::BASIC_FONTS.get(letter) else { continue };
        for (y, bits) in glyph.into_iter().enumerate() {
            for x in (0..LETTER).filter(|x| bits >> x & 1 == 1) {
                canvas[(top + y) * width + left + k * LETTER + x] = INK;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_overlay_has_a_legend_and_colours_by_kind() {
        let mut frame = Frame::new(200, 3, 1).unwrap();
        frame.verdict.fill(0);
        frame.verdict[5] = 1;
        (frame.lights[0].visible_lo[5], frame.lights[0].visible_hi[5]) = (0.25, 0.5);
        frame.cost[5] = 1000;
        for (overlay, name) in Overlay::ALL {
            assert_eq!(Overlay::from_name(name), Some(overlay));
            let planes = frame.overlay(overlay, 0.01).unwrap();
            let plane = planes.require(COLOR_PLANE).unwrap();
            assert!(plane.rows() > 3 + 4 * LINE && plane.columns() >= 200);
            let crate::image::Samples::F32(v) = plane.samples() else { panic!("single precision") };
            assert_ne!(v[..3], v[15..18], "{name}: the special pixel looks different");
            assert!(
                v[3 * plane.columns() * 3..].contains(&(linear_from_srgb(232.0 / 255.0) as f32)),
                "{name}: no letters"
            );
        }
        assert_eq!(frame.by_shadow(0.01).1[5], 4);
        assert_eq!(frame.by_shadow(0.25).1[5], 2);
    }
}
