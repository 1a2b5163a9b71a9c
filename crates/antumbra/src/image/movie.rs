//! Moving pictures that begin again when they end: `.gif` and animated `.png`.

use super::{Error, SOFTWARE};
use std::io::Write;

/// Pixels, spread over the frames, from which a palette is made.
const SAMPLES: usize = 400_000;
/// Frames that a palette looks at.
const SAMPLED_FRAMES: usize = 32;
/// Colours of a GIF; the last index of 256 is "as before".
const COLORS: usize = 255;
/// Index of a pixel that stays as it was in the frame before.
const SAME: u8 = 255;
/// Bits per channel of the table of nearest colours.
const TABLE_BITS: u32 = 6;

/// Frames of one size, 8 bits per channel in sRGB, from wherever they lie.
pub struct Movie<'a> {
    /// Pixels per row, 1 to 65,535.
    pub width: usize,
    /// Rows, 1 to 65,535.
    pub height: usize,
    /// How many frames.
    pub frames: usize,
    /// Frames per second, more than 0.
    pub rate: f64,
    /// The `3 * width * height` codes of a frame, red, green, blue, rows from the top. May be asked more than once.
    pub frame: &'a mut dyn FnMut(usize) -> Result<Vec<u8>, Error>,
}

impl Movie<'_> {
    fn load(&mut self, k: usize, format: &'static str) -> Result<Vec<u8>, Error> {
        let codes = (self.frame)(k)?;
        if codes.len() == 3 * self.width * self.height {
            return Ok(codes);
        }
        let reason = format!("frame {k} has not {} x {} pixels", self.width, self.height);
        Err(Error::Encode { format, reason })
    }

    /// Width and height as files have them.
    fn size(&self, format: &'static str) -> Result<[u16; 2], Error> {
        let side = |n: usize| u16::try_from(n).ok().filter(|n| *n > 0);
        let (Some(width), Some(height), true) = (side(self.width), side(self.height), self.frames > 0) else {
            let reason = format!("{} frames of {} x {} pixels", self.frames, self.width, self.height);
            return Err(Error::Encode { format, reason });
        };
        Ok([width, height])
    }

    /// Writes an animated PNG that plays for ever: all colours, large files.
    ///
    /// # Errors
    /// Those of the frames; [`Error::Encode`] where there is none, the size does not fit, or `out` refuses.
    pub fn write_apng(mut self, out: &mut dyn Write) -> Result<(), Error> {
        const FORMAT: &str = "APNG";
        let refused = |e: png::EncodingError| Error::Encode { format: FORMAT, reason: e.to_string() };
        let [width, height] = self.size(FORMAT)?.map(u32::from);
        let mut encoder = png::Encoder::new(out, width, height);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_source_gamma(png::ScaledFloat::from_scaled(45455));
        encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
        encoder.set_animated(self.frames as u32, 0).map_err(refused)?;
        encoder.set_frame_delay((1000.0 / self.rate).round().clamp(1.0, 65_535.0) as u16, 1000).map_err(refused)?;
        encoder.add_text_chunk("Software".to_owned(), SOFTWARE.to_owned()).map_err(refused)?;
        let mut writer = encoder.write_header().map_err(refused)?;
        for k in 0..self.frames {
            let codes = self.load(k, FORMAT)?;
            writer.write_image_data(&codes).map_err(refused)?;
        }
        writer.finish().map_err(refused)
    }

    /// Writes a GIF that plays for ever: one palette for all frames and a fixed pattern of dither, so that what does not move
    /// does not flicker; of each frame, only what has changed.
    ///
    /// # Errors
    /// Those of the frames; [`Error::Encode`] where there is none, the size does not fit, or `out` refuses.
    pub fn write_gif(mut self, out: &mut dyn Write) -> Result<(), Error> {
        const FORMAT: &str = "GIF";
        let refused = |e: gif::EncodingError| Error::Encode { format: FORMAT, reason: e.to_string() };
        let [width, height] = self.size(FORMAT)?;
        let palette = Palette::of(&self.samples(FORMAT)?);
        let mut encoder = gif::Encoder::new(out, width, height, &palette.codes()).map_err(refused)?;
        encoder.set_repeat(gif::Repeat::Infinite).map_err(refused)?;
        let mut before: Option<Vec<u8>> = None;
        for k in 0..self.frames {
            let indices = palette.indices(&self.load(k, FORMAT)?, self.width);
            // Times are hundredths of a second: round where frames begin, so that errors do not add up.
            let hundredths = |k: usize| (100.0 * k as f64 / self.rate).round();
            let delay = (hundredths(k + 1) - hundredths(k)).clamp(0.0, 65_535.0) as u16;
            let mut frame = changes(&indices, before.as_deref(), self.width);
            (frame.delay, frame.dispose) = (delay, gif::DisposalMethod::Keep);
            encoder.write_frame(&frame).map_err(refused)?;
            before = Some(indices);
        }
        Ok(())
    }

    /// Pixels of frames spread over the whole movie, as RGBA.
    fn samples(&mut self, format: &'static str) -> Result<Vec<u8>, Error> {
        let looked_at = self.frames.min(SAMPLED_FRAMES);
        let pixels = self.width * self.height;
        let step = (pixels * looked_at).div_ceil(SAMPLES);
        let mut samples = Vec::new();
        for i in 0..looked_at {
            let codes = self.load(i * self.frames / looked_at, format)?;
            // Another grid of pixels in each frame.
            let picked = codes.chunks_exact(3).skip(i % step).step_by(step);
            samples.extend(picked.flat_map(|c| [c[0], c[1], c[2], 255]));
        }
        Ok(samples)
    }
}

/// The rectangle of a frame that has changed, and in it only the pixels that have.
fn changes(indices: &[u8], before: Option<&[u8]>, width: usize) -> gif::Frame<'static> {
    let height = indices.len() / width;
    let Some(before) = before else {
        let (width, height) = (width as u16, height as u16);
        return gif::Frame { width, height, buffer: indices.to_vec().into(), ..gif::Frame::default() };
    };
    // Left, top, right and bottom; a single pixel where nothing has changed.
    let mut bounds = [width, height, 0, 0];
    for (i, _) in indices.iter().zip(before).enumerate().filter(|(_, (a, b))| a != b) {
        let (column, row) = (i % width, i / width);
        bounds = [bounds[0].min(column), bounds[1].min(row), bounds[2].max(column + 1), bounds[3].max(row + 1)];
    }
    let [left, top, right, bottom] = if bounds[2] == 0 { [0, 0, 1, 1] } else { bounds };
    let changed = |i: usize| if indices[i] == before[i] { SAME } else { indices[i] };
    let buffer: Vec<u8> = (top..bottom).flat_map(|row| (left..right).map(move |c| changed(row * width + c))).collect();
    gif::Frame {
        left: left as u16,
        top: top as u16,
        width: (right - left) as u16,
        height: (bottom - top) as u16,
        transparent: Some(SAME),
        buffer: buffer.into(),
        ..gif::Frame::default()
    }
}

/// The colours of a GIF.
struct Palette {
    colors: Vec<[i32; 3]>,
    /// Index of the colour that is nearest to each cell of the cube of colours.
    nearest: Vec<u8>,
}

impl Palette {
    /// Colours for RGBA samples, by a self-organising map (Dekker 1994, *Kohonen neural networks for optimal colour
    /// quantization*); the few colours that there are, where they are few.
    fn of(samples: &[u8]) -> Self {
        let mut found: Vec<[u8; 3]> = samples.chunks_exact(4).map(|c| [c[0], c[1], c[2]]).collect();
        found.sort_unstable();
        found.dedup();
        if found.len() > COLORS {
            let map = color_quant::NeuQuant::new(1, COLORS, samples).color_map_rgb();
            found = map.chunks_exact(3).take(COLORS).map(|c| [c[0], c[1], c[2]]).collect();
        }
        let colors: Vec<[i32; 3]> = found.into_iter().map(|c| c.map(i32::from)).collect();
        let side = 1_usize << TABLE_BITS;
        let middle = |k: usize| ((2 * k + 1) << (7 - TABLE_BITS)) as i32;
        let cells = (0..side.pow(3)).map(|i| [middle(i / side / side), middle(i / side % side), middle(i % side)]);
        let nearest = cells.map(|cell| {
            let by_distance = colors.iter().enumerate().min_by_key(|(_, c)| distance(**c, cell));
            by_distance.map_or(0, |(index, _)| index as u8)
        });
        Self { nearest: nearest.collect(), colors }
    }

    /// Red, green and blue of all 256 indices.
    fn codes(&self) -> Vec<u8> {
        let mut codes: Vec<u8> = self.colors.iter().flatten().map(|c| *c as u8).collect();
        codes.resize(3 * 256, 0);
        codes
    }

    /// Index of the colour nearest to one that may lie outside of the cube.
    fn nearest(&self, color: [i32; 3]) -> u8 {
        let cell = color.map(|c| (c.clamp(0, 255) >> (8 - TABLE_BITS)) as usize);
        self.nearest[(cell[0] << (2 * TABLE_BITS)) + (cell[1] << TABLE_BITS) + cell[2]]
    }

    /// Indices of a picture. Each pixel takes one of two colours: the nearest, and the one on its other side; how often the
    /// second is right is compared with an ordered pattern that is fixed to the picture.
    fn indices(&self, codes: &[u8], width: usize) -> Vec<u8> {
        let pixel = |(i, code): (usize, &[u8])| {
            let color = [code[0], code[1], code[2]].map(i32::from);
            let first = self.nearest(color);
            let near = self.colors[usize::from(first)];
            let second = self.nearest(std::array::from_fn(|c| 2 * color[c] - near[c]));
            let far = self.colors[usize::from(second)];
            // Where between the two the colour lies, in 64ths: 0 is the first.
            let along: i32 = (0..3).map(|c| (color[c] - near[c]) * (far[c] - near[c])).sum();
            let length = distance(near, far).max(1);
            if 64 * along > i32::from(threshold(i / width, i % width)) * length { second } else { first }
        };
        codes.chunks_exact(3).enumerate().map(pixel).collect()
    }
}

/// Squared distance of colours.
fn distance(a: [i32; 3], b: [i32; 3]) -> i32 {
    (0..3).map(|c| (a[c] - b[c]) * (a[c] - b[c])).sum()
}

/// Bayer's pattern of 8 x 8 pixels, 0 to 63: the bits of column and row, interleaved from the lowest.
fn threshold(row: usize, column: usize) -> u8 {
    (0..3).fold(0, |pattern, bit| {
        let (x, y) = ((column >> bit) as u8 & 1, (row >> bit) as u8 & 1);
        pattern << 2 | (x ^ y) << 1 | y
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: usize = 48;

    /// A disc that moves over a smooth background.
    fn frame(k: usize) -> Vec<u8> {
        (0..SIZE * SIZE)
            .flat_map(|i| {
                let (x, y) = (i % SIZE, i / SIZE);
                let inside = x.abs_diff(10 + 4 * k).pow(2) + y.abs_diff(20).pow(2) < 50;
                if inside { [220, (40 + 3 * y) as u8, 30] } else { [(60 + 2 * y) as u8, (90 + x + y) as u8, 130] }
            })
            .collect()
    }

    fn movie(frame: &mut dyn FnMut(usize) -> Result<Vec<u8>, Error>) -> Movie<'_> {
        Movie { width: SIZE, height: SIZE, frames: 6, rate: 30.0, frame }
    }

    #[test]
    fn the_pattern_has_every_threshold_once() {
        let mut all: Vec<u8> = (0..64).map(|i| threshold(i / 8, i % 8)).collect();
        assert_eq!(all[0..2], [0, 2 << 4]);
        all.sort_unstable();
        assert_eq!(all, (0..64).collect::<Vec<u8>>());
    }

    #[test]
    fn a_gif_is_near_its_frames_and_does_not_flicker() {
        let (mut source, mut bytes) = (|k| Ok(frame(k)), vec![]);
        movie(&mut source).write_gif(&mut bytes).unwrap();
        let mut options = gif::DecodeOptions::new();
        options.set_color_output(gif::ColorOutput::Indexed);
        let mut reader = options.read_info(&bytes[..]).unwrap();
        let palette = reader.global_palette().unwrap().to_vec();
        let (mut canvas, mut shown, mut time) = (vec![0_u8; SIZE * SIZE], vec![], 0);
        while let Some(part) = reader.read_next_frame().unwrap() {
            time += part.delay;
            let (left, top, width) = (usize::from(part.left), usize::from(part.top), usize::from(part.width));
            for (i, index) in part.buffer.iter().enumerate().filter(|(_, index)| Some(**index) != part.transparent) {
                canvas[(top + i / width) * SIZE + left + i % width] = *index;
            }
            shown.push(canvas.clone());
        }
        assert_eq!((shown.len(), time, reader.repeat()), (6, 20, gif::Repeat::Infinite));
        let mut error = 0_u64;
        for (k, indices) in shown.iter().enumerate() {
            let wanted = frame(k);
            for (i, index) in indices.iter().enumerate() {
                let color = &palette[3 * usize::from(*index)..][..3];
                error += (0..3).map(|c| u64::from(color[c].abs_diff(wanted[3 * i + c]))).sum::<u64>();
            }
            // Far from the disc, nothing changes.
            assert_eq!(indices[40 * SIZE..], shown[0][40 * SIZE..]);
        }
        let mean = error as f64 / (6 * SIZE * SIZE * 3) as f64;
        assert!(mean < 4.0, "{mean} codes from the frames in the mean");
    }

    #[test]
    fn few_colours_stay_exactly_themselves() {
        let palette = Palette::of(&[10, 20, 30, 255, 200, 0, 0, 255, 10, 20, 30, 255]);
        assert_eq!(palette.colors, [[10, 20, 30], [200, 0, 0]]);
        assert_eq!(palette.indices(&[10, 20, 30, 200, 0, 0], 2), [0, 1]);
    }

    #[test]
    fn an_apng_has_every_frame() {
        let (mut source, mut bytes) = (|k| Ok(frame(k)), vec![]);
        movie(&mut source).write_apng(&mut bytes).unwrap();
        let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().unwrap();
        let control = reader.info().animation_control.unwrap();
        assert_eq!((control.num_frames, control.num_plays), (6, 0));
        for k in 0..6 {
            let mut codes = vec![0; reader.output_buffer_size().unwrap()];
            reader.next_frame(&mut codes).unwrap();
            assert!(codes == frame(k), "frame {k}");
            assert_eq!(reader.info().frame_control.unwrap().delay_num, 33);
        }
    }

    #[test]
    fn what_is_no_movie_is_refused() {
        let mut short = |_| Ok(vec![0; 7]);
        assert!(movie(&mut short).write_gif(&mut vec![]).unwrap_err().to_string().contains("frame 0 has not 48 x 48"));
        let mut none = |k| Ok(frame(k));
        let empty = Movie { frames: 0, ..movie(&mut none) };
        assert!(matches!(empty.write_apng(&mut vec![]), Err(Error::Encode { .. })));
        let wide = Movie { width: 70_000, ..movie(&mut none) };
        assert!(matches!(wide.write_gif(&mut vec![]), Err(Error::Encode { .. })));
    }
}
