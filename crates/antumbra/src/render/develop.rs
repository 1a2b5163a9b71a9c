//! From the light of a frame to the picture that is looked at: outlines, exposure, tone. Nothing here is certified.
use super::Frame;
use crate::image::{COLOR_PLANE, Error, Plane, Planes, Rounding};
use crate::scene::{Exposure, Look, Tone};

/// Where the soft tone begins to press.
const SHOULDER: f32 = 0.7;
/// Share of the light that an outline takes.
const INK: f32 = 0.82;
/// The brightest part of what is met, but for one percent of the pixels, becomes this with automatic exposure.
const NEARLY_WHITE: f32 = 0.85;
/// Most stops of automatic exposure.
const MOST_STOPS: f32 = 4.0;

impl Frame {
    /// The colours as they are to be shown, as a plane: linear, for [`crate::image::png_bytes`]. The default look leaves
    /// all but the brightest as they are in the frame.
    ///
    /// # Errors
    /// As [`Frame::planes`].
    pub fn picture(&self, look: &Look) -> Result<Planes, Error> {
        let factor = self.factor(look.exposure);
        let depth = self.depth();
        let mut samples = Vec::with_capacity(3 * self.rgb.len());
        for (index, color) in self.rgb.iter().enumerate() {
            let ink = if look.outline { 1.0 - INK * self.bend(index, depth) } else { 1.0 };
            samples.extend(toned(color.map(|c| c * ink * factor), look.tone));
        }
        let mut planes = Planes::new();
        let plane = Plane::with_channels(COLOR_PLANE, self.height, self.width, 3, samples)?;
        planes.add(plane.rounded(Rounding::Nearest))?;
        Ok(planes)
    }

    fn factor(&self, exposure: Exposure) -> f32 {
        match exposure {
            Exposure::Stops(stops) => core_math::exp2(stops) as f32,
            Exposure::Auto(_) => {
                let met = self.t_lo.iter().zip(&self.rgb).filter(|(t, _)| !t.is_nan());
                let mut light: Vec<f32> = met.map(|(_, [r, g, b])| 0.2126 * r + 0.7152 * g + 0.0722 * b).collect();
                if light.is_empty() {
                    return 1.0;
                }
                let place = (light.len() - 1) * 99 / 100;
                let (_, bright, _) = light.select_nth_unstable_by(place, f32::total_cmp);
                let most = core_math::exp2f(MOST_STOPS);
                (NEARLY_WHITE / bright.max(1e-6)).clamp(1.0 / most, most)
            }
        }
    }

    /// The length by which steps in depth are judged where that is less than the distance itself, as for a camera far away:
    /// a few times the depth of what is met.
    fn depth(&self) -> f64 {
        let met = || self.t_lo.iter().copied().filter(|t| t.is_finite());
        let (near, far) = met().fold((f64::INFINITY, 0.0_f64), |(a, b), t| (a.min(t), b.max(t)));
        if far > near { 3.0 * (far - near) } else { f64::INFINITY }
    }

    /// How much of an outline a pixel is, 0 to 1: it meets something, and a neighbour meets nothing, something far behind
    /// it, or a surface that lies otherwise.
    fn bend(&self, index: usize, depth: f64) -> f32 {
        let here = self.t_lo[index];
        if here.is_nan() {
            return 0.0;
        }
        let (column, row) = (index % self.width, index / self.width);
        let sides = [
            (column > 0).then(|| index - 1),
            (column + 1 < self.width).then(|| index + 1),
            (row > 0).then(|| index - self.width),
            (row + 1 < self.height).then(|| index + self.width),
        ];
        let normal = self.normal[index];
        sides.into_iter().flatten().fold(0.0_f32, |most, at| {
            let there = self.t_lo[at];
            if there.is_nan() {
                return 1.0;
            }
            let cosine: f32 = (0..3).map(|k| normal[k] * self.normal[at][k]).sum();
            let turned = ((0.92 - cosine) / 0.5).clamp(0.0, 1.0);
            let behind = ((((there - here) / here.min(depth)) as f32 - 0.015) / 0.03).clamp(0.0, 1.0);
            most.max(turned).max(behind)
        })
    }
}

/// Soft: above [`SHOULDER`] the largest component x becomes `s + (1 - s)(1 - exp(-(x - s)/(1 - s)))`, smooth at s and below 1.
/// Filmic: the fit of Narkowicz (2016) to the curve of the Academy (ACES), which leaves black and presses the bright.
fn toned(color: [f32; 3], tone: Tone) -> [f32; 3] {
    match tone {
        Tone::Plain => color,
        Tone::Soft => {
            let most = color.into_iter().fold(0.0, f32::max);
            if most <= SHOULDER {
                return color;
            }
            let room = 1.0 - SHOULDER;
            let pressed = SHOULDER + room * (1.0 - core_math::expf(-(most - SHOULDER) / room));
            color.map(|c| c * pressed / most)
        }
        Tone::Filmic => color.map(|x| {
            let x = 0.8 * x.max(0.0);
            ((x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14)).clamp(0.0, 1.0)
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::Samples;

    fn shown(frame: &Frame, look: &Look) -> Vec<f32> {
        match frame.picture(look).unwrap().require(COLOR_PLANE).unwrap().samples() {
            Samples::F32(v) => v.clone(),
            other => panic!("{other:?}"),
        }
    }

    /// A row of four: nothing, a wall, the same wall further on, something far behind.
    fn frame() -> Frame {
        let mut frame = Frame::new(4, 1, 0).unwrap();
        frame.rgb = vec![[0.6; 3], [0.2; 3], [0.2; 3], [0.1; 3]];
        frame.t_lo = vec![f64::NAN, 2.0, 2.01, 5.0];
        frame.normal = vec![[0.0; 3], [0.0, 0.0, 1.0], [0.0, 0.0, 1.0], [0.0, 0.0, 1.0]];
        frame
    }

    #[test]
    fn the_default_look_changes_nothing() {
        let frame = frame();
        assert_eq!(shown(&frame, &Look::default()), frame.rgb.as_flattened());
    }

    #[test]
    fn exposure_tone_and_outline() {
        let frame = frame();
        let look = Look { exposure: Exposure::Stops(1.0), ..Look::default() };
        assert_eq!(shown(&frame, &look)[3], 0.4);
        let auto = shown(&frame, &Look { exposure: Exposure::AUTO, tone: Tone::Plain, ..Look::default() });
        assert!((auto[3] - NEARLY_WHITE).abs() < 1e-6, "the brightest that is met: {}", auto[3]);
        let lines = shown(&frame, &Look { outline: true, ..Look::default() });
        assert_eq!((lines[0], lines[9]), (0.6, 0.1), "neither the backdrop nor what lies behind");
        assert!(lines[3] < 0.05 && lines[6] < 0.05, "{lines:?}");
        for tone in [Tone::Soft, Tone::Filmic] {
            let grey = |x: f32| toned([x; 3], tone)[0];
            assert!(grey(0.0) == 0.0 && grey(50.0) > 0.99, "{tone:?}");
            assert!(grey(1.5) < grey(2.0), "brighter than white is told apart");
        }
        let [r, g, _] = toned([2.0, 1.0, 0.0], Tone::Soft);
        assert!(r < 1.0 && (r - 2.0 * g).abs() < 1e-6, "the hue stays");
    }
}
