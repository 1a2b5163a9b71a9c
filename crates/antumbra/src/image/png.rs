//! `.png`: the picture for eyes, in sRGB.

use super::color::row_8;
use super::{Error, Plane, SOFTWARE, Samples, code_16};
use std::io::Write;

/// Bits per channel of a PNG.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Depth {
    /// 8 bits, dithered: see [`code_8`](super::code_8).
    #[default]
    Eight,
    /// 16 bits, rounded to nearest.
    Sixteen,
}

/// The bytes of a PNG of a plane of linear RGB light: light 0 is black, light 1 is white, more than 1 is white.
///
/// The file says that it is sRGB (chunks `sRGB` and `gAMA`) and which program wrote it
/// (`tEXt Software`). Equal planes give equal bytes.
///
/// # Errors
/// [`Error::NotColor`] unless the plane has three channels of `f32` or `f64`; [`Error::NotANumber`] where one is NaN;
/// [`Error::Encode`] where the encoder refuses (more than 2^31 - 1 rows or columns).
pub fn png_bytes(plane: &Plane, depth: Depth) -> Result<Vec<u8>, Error> {
    png_bytes_noted(plane, depth, None)
}

/// The same with a note to the program (`tEXt Comment`), which [`Still::read`] finds again.
///
/// # Errors
/// As for [`png_bytes`].
pub fn png_bytes_noted(plane: &Plane, depth: Depth, note: Option<&str>) -> Result<Vec<u8>, Error> {
    let codes = png_codes(plane, 0, depth)?;
    let mut bytes = Vec::new();
    let mut write = || {
        let mut writer = header(encoder(&mut bytes, [plane.columns(), plane.rows()], depth)?, note)?;
        writer.write_image_data(&codes)?;
        writer.finish()
    };
    write().map_err(refused)?;
    Ok(bytes)
}

/// A PNG as it was written by [`png_bytes_noted`], read again.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Still {
    /// Pixels per row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Red, green and blue of each pixel, rows from the top; empty where the file has not 8 bits per channel.
    pub codes: Vec<u8>,
    /// The note in the file.
    pub note: Option<String>,
}

impl Still {
    /// Reads the bytes of a whole file.
    ///
    /// # Errors
    /// [`Error::Decode`] where they are not an RGB picture.
    pub fn read(bytes: &[u8]) -> Result<Self, Error> {
        let refused = |reason: String| Error::Decode { name: "PNG".to_owned(), reason };
        let mut reader =
            png::Decoder::new(std::io::Cursor::new(bytes)).read_info().map_err(|e| refused(e.to_string()))?;
        let size = reader.output_buffer_size().ok_or_else(|| refused("it is too large".to_owned()))?;
        let mut codes = vec![0; size];
        reader.next_frame(&mut codes).map_err(|e| refused(e.to_string()))?;
        let info = reader.info();
        if info.color_type != png::ColorType::Rgb {
            return Err(refused("it is not in RGB".to_owned()));
        }
        if info.bit_depth != png::BitDepth::Eight {
            codes.clear();
        }
        let note = info.uncompressed_latin1_text.iter().find(|t| t.keyword == NOTE).map(|t| t.text.clone());
        Ok(Self { width: info.width as usize, height: info.height as usize, codes, note })
    }
}

/// Keyword of the note: one of those that the PNG standard names.
const NOTE: &str = "Comment";

/// What [`png_rows`] wants for the rows of a plane of linear light of which the first is row `first` of the picture: three codes for
/// each pixel, of 16 bits in two bytes.
///
/// # Errors
/// [`Error::NotColor`] and [`Error::NotANumber`] as for [`png_bytes`].
pub fn png_codes(plane: &Plane, first: usize, depth: Depth) -> Result<Vec<u8>, Error> {
    match plane.samples() {
        Samples::F64(v) if plane.channels() == 3 => codes(plane, first, depth, v),
        Samples::F32(v) if plane.channels() == 3 => codes(plane, first, depth, v),
        _ => Err(Error::NotColor(plane.name().to_owned())),
    }
}

/// Writes a PNG piece by piece: `rows` writes the codes of all rows ([`png_codes`]), in any pieces.
///
/// # Errors
/// [`Error::Encode`] where the encoder, `out` or `rows` refuses, or rows are missing.
pub fn png_rows(
    out: impl Write,
    [columns, rows]: [usize; 2],
    depth: Depth,
    write: impl FnOnce(&mut dyn Write) -> std::io::Result<()>,
) -> Result<(), Error> {
    let write = || {
        let mut writer = header(encoder(out, [columns, rows], depth)?, None)?;
        let mut stream = writer.stream_writer()?;
        write(&mut stream)?;
        stream.finish()?;
        writer.finish()
    };
    write().map_err(refused)
}

fn refused(error: png::EncodingError) -> Error {
    Error::Encode { format: "PNG", reason: error.to_string() }
}

fn codes<T: Copy + Into<f64>>(plane: &Plane, first: usize, depth: Depth, light: &[T]) -> Result<Vec<u8>, Error> {
    let mut codes = Vec::with_capacity(light.len() * if depth == Depth::Eight { 1 } else { 2 });
    for (row, light) in (first..).zip(light.chunks_exact(3 * plane.columns())) {
        if let Some(k) = light.iter().position(|x| (*x).into().is_nan()) {
            return Err(Error::NotANumber { name: plane.name().to_owned(), row, column: k / 3 });
        }
        match depth {
            Depth::Eight => row_8(light.chunks_exact(3).map(|x| [x[0], x[1], x[2]].map(T::into)), row, &mut codes),
            Depth::Sixteen => light.iter().for_each(|x| codes.extend(code_16((*x).into()).to_be_bytes())),
        }
    }
    Ok(codes)
}

fn encoder<W: Write>(out: W, size: [usize; 2], depth: Depth) -> Result<png::Encoder<'static, W>, png::EncodingError> {
    // What does not fit is no size of a PNG: the encoder refuses it.
    let [columns, rows] = size.map(|n| u32::try_from(n).unwrap_or(0));
    let mut encoder = png::Encoder::new(out, columns, rows);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(if depth == Depth::Eight { png::BitDepth::Eight } else { png::BitDepth::Sixteen });
    // Dither leaves little to compress: a sixth more bytes in a fortieth of the time, which was a tenth of a whole picture's.
    encoder.set_compression(png::Compression::Fast);
    // 1/2.2, the value that the PNG standard wants beside `sRGB` for programs that know only `gAMA`.
    encoder.set_source_gamma(png::ScaledFloat::from_scaled(45455));
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    encoder.add_text_chunk("Software".to_owned(), SOFTWARE.to_owned())?;
    Ok(encoder)
}

fn header<W: Write>(
    mut encoder: png::Encoder<'_, W>,
    note: Option<&str>,
) -> Result<png::Writer<W>, png::EncodingError> {
    if let Some(note) = note {
        encoder.add_text_chunk(NOTE.to_owned(), note.to_owned())?;
    }
    encoder.write_header()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::{COLOR_PLANE, srgb_from_linear};
    use std::io::Cursor;

    fn decode(bytes: Vec<u8>) -> (png::Reader<Cursor<Vec<u8>>>, Vec<u8>) {
        let mut reader = png::Decoder::new(Cursor::new(bytes)).read_info().unwrap();
        let mut codes = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut codes).unwrap();
        (reader, codes)
    }

    fn ramp() -> (Vec<f32>, Plane) {
        let light: Vec<f32> = (0..16 * 64 * 3).map(|i| (i / 3 % 64) as f32 / 63.0).collect();
        (light.clone(), Plane::with_channels(COLOR_PLANE, 16, 64, 3, light).unwrap())
    }

    #[test]
    fn sixteen_bits_decode_to_the_light_that_went_in() {
        let (light, plane) = ramp();
        let (reader, codes) = decode(png_bytes(&plane, Depth::Sixteen).unwrap());
        assert_eq!((reader.info().width, reader.info().height), (64, 16));
        for (pair, x) in codes.chunks(2).zip(light) {
            let code = f64::from(u16::from_be_bytes([pair[0], pair[1]]));
            assert!((code - 65535.0 * srgb_from_linear(f64::from(x))).abs() <= 0.5);
        }
    }

    #[test]
    fn eight_bits_stay_within_two_codes_and_keep_the_ends() {
        let (light, plane) = ramp();
        let (_, codes) = decode(png_bytes(&plane, Depth::Eight).unwrap());
        for (code, x) in codes.into_iter().zip(light) {
            let v = 255.0 * srgb_from_linear(f64::from(x));
            assert!((f64::from(code) - v).abs() < 1.5, "{code} for {v}");
            assert!((x != 0.0 || code == 0) && (x != 1.0 || code == 255));
        }
    }

    #[test]
    fn the_file_says_what_it_is() {
        let (_, plane) = ramp();
        let (reader, _) = decode(png_bytes(&plane, Depth::Eight).unwrap());
        let info = reader.info();
        assert_eq!(info.srgb, Some(png::SrgbRenderingIntent::Perceptual));
        assert_eq!(info.gama_chunk.unwrap().into_scaled(), 45455);
        let text = &info.uncompressed_latin1_text;
        assert_eq!((text[0].keyword.as_str(), text[0].text.as_str()), ("Software", SOFTWARE));
    }

    #[test]
    fn rows_make_the_picture() {
        let (light, plane) = ramp();
        let some = |rows: std::ops::Range<usize>| {
            let light = light[rows.start * 64 * 3..rows.end * 64 * 3].to_vec();
            Plane::with_channels(COLOR_PLANE, rows.len(), 64, 3, light).unwrap()
        };
        for depth in [Depth::Eight, Depth::Sixteen] {
            let mut bytes = vec![];
            let pieces = [0..5, 5..6, 6..16].map(|part| png_codes(&some(part.clone()), part.start, depth).unwrap());
            png_rows(&mut bytes, [64, 16], depth, |out| pieces.iter().try_for_each(|piece| out.write_all(piece)))
                .unwrap();
            let (reader, codes) = decode(bytes);
            let (whole, expected) = decode(png_bytes(&plane, depth).unwrap());
            assert_eq!(codes, expected);
            assert_eq!(reader.info().srgb, whole.info().srgb);
        }
        let short = png_rows(vec![], [64, 16], Depth::Eight, |out| out.write_all(&[0; 64 * 3]));
        assert!(matches!(short, Err(Error::Encode { .. })), "rows are missing");
    }

    #[test]
    fn a_note_is_found_again() {
        let (_, plane) = ramp();
        let bytes = png_bytes_noted(&plane, Depth::Eight, Some("a note")).unwrap();
        let still = Still::read(&bytes).unwrap();
        assert_eq!((still.width, still.height, still.note.as_deref()), (64, 16, Some("a note")));
        assert_eq!(still.codes, decode(bytes.clone()).1);
        let plain = Still::read(&png_bytes(&plane, Depth::Sixteen).unwrap()).unwrap();
        assert_eq!((plain.note, plain.codes.len()), (None, 0));
        assert!(matches!(Still::read(&bytes[..bytes.len() / 2]), Err(Error::Decode { .. })));
    }

    #[test]
    fn what_is_not_a_picture_is_refused() {
        let grey = Plane::new("t_lo", 1, 1, vec![0.0]).unwrap();
        assert!(matches!(png_bytes(&grey, Depth::Eight), Err(Error::NotColor(_))));
        let codes = Plane::with_channels("rgb", 1, 1, 3, vec![0u8; 3]).unwrap();
        assert!(matches!(png_bytes(&codes, Depth::Eight), Err(Error::NotColor(_))));
        let mut light = vec![0.5f32; 2 * 2 * 3];
        light[10] = f32::NAN;
        let plane = Plane::with_channels("rgb", 2, 2, 3, light).unwrap();
        assert!(matches!(png_bytes(&plane, Depth::Sixteen), Err(Error::NotANumber { row: 1, column: 1, .. })));
    }

    #[test]
    fn bright_and_negative_light_is_clamped() {
        let plane = Plane::with_channels("rgb", 1, 1, 3, vec![-1.0, 7.0, f64::INFINITY]).unwrap();
        assert_eq!(decode(png_bytes(&plane, Depth::Eight).unwrap()).1, [0, 255, 255]);
    }
}
