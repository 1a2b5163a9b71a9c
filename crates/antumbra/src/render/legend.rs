//! What the colours of an overlay mean, and how that is written below a picture.
use font8x8::UnicodeFonts;

/// What an overlay shows, for those who draw it themselves.
#[derive(Clone, Debug, PartialEq)]
pub struct Legend {
    /// Colour (sRGB) and meaning of each kind of pixel.
    pub entries: Vec<([u8; 3], String)>,
    /// The kind of each pixel of the frame: an index among the entries.
    pub kinds: Vec<usize>,
}

/// Height of a line, and size of a letter.
const LINE: usize = 14;
const LETTER: usize = 8;
/// Column in which the square of the colour begins, its width, and the column in which the text does.
const SQUARE: usize = 4;
const SIDE: usize = 12;
const TEXT: usize = 22;
/// Between the text and what is right of it.
const GAP: usize = 4;
/// Above and below all lines.
const MARGIN: usize = 4;
const INK: [u8; 3] = [232, 232, 232];

/// An entry in its place: left column, line, and its text in lines.
struct Item {
    left: usize,
    line: usize,
    text: Vec<String>,
}

impl Legend {
    /// Whether the legend fits below a picture of that size: in its width, and not higher than it. It depends on the kind of the overlay
    /// and on the size only, so all pictures of an animation have one or none has. From 256 x 256 on every one fits.
    #[must_use]
    pub fn fits(&self, width: usize, height: usize) -> bool {
        self.rows(width, height).is_some()
    }

    /// Rows that it takes below a picture; `None` where it does not fit.
    pub(super) fn rows(&self, width: usize, height: usize) -> Option<usize> {
        let items = self.items(width)?;
        let lines = items.iter().map(|item| item.line + item.text.len()).max()?;
        Some(lines * LINE + MARGIN).filter(|rows| *rows <= height)
    }

    /// Draws it below a picture, if it fits; the canvas has its rows already.
    pub(super) fn draw(&self, canvas: &mut [[u8; 3]], width: usize, height: usize) {
        let Some(items) = self.items(width).filter(|_| self.fits(width, height)) else { return };
        for (Item { left, line, text }, (color, _)) in items.iter().zip(&self.entries) {
            let top = height + MARGIN - 1 + line * LINE;
            for y in top..top + LETTER {
                canvas[y * width + left + SQUARE..y * width + left + SQUARE + SIDE].fill(*color);
            }
            for (k, text) in text.iter().enumerate() {
                write(canvas, width, left + TEXT, top + k * LINE, text);
            }
        }
    }

    /// Where the entries stand: in columns, if there is room for several; else one below the other, in as many lines as they need.
    fn items(&self, width: usize) -> Option<Vec<Item>> {
        let mut counts = vec![0_usize; self.entries.len()];
        self.kinds.iter().for_each(|kind| counts[*kind] += 1);
        // Room for any number of pixels.
        let digits = self.kinds.len().to_string().len();
        let longest = self.entries.iter().map(|(_, text)| text.len() + 2 + digits).max()?;
        let column = TEXT + longest * LETTER + GAP;
        let columns = (width / column).max(1);
        let per_column = self.entries.len().div_ceil(columns);
        let room = if columns > 1 { longest } else { width.checked_sub(TEXT + GAP)? / LETTER };
        let mut line = 0;
        let item = |(k, ((_, text), count)): (usize, (&([u8; 3], String), usize))| {
            let text = wrap(text, count, digits, room)?;
            if k.is_multiple_of(per_column) {
                line = 0;
            }
            let item = Item { left: k / per_column * column, line, text };
            line += item.text.len();
            Some(item)
        };
        self.entries.iter().zip(counts).enumerate().map(item).collect()
    }
}

/// A text and a count, which takes so many digits, in lines of at most `room` letters; `None` where a word is longer.
fn wrap(text: &str, count: usize, digits: usize, room: usize) -> Option<Vec<String>> {
    let text = format!("{text}:");
    let count = count.to_string();
    let words = text.split(' ').map(|word| (word, word.len())).chain([(count.as_str(), digits)]);
    let mut lines = vec![String::new()];
    for (word, length) in words {
        if length > room {
            return None;
        }
        match lines.last_mut() {
            Some(line) if line.is_empty() => line.push_str(word),
            Some(line) if line.len() + 1 + length <= room => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    Some(lines)
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
    use crate::render::{Frame, Overlay};

    #[test]
    fn words_are_kept_whole_and_counts_have_their_room() {
        let lines = |room| wrap("lit (all of each light)", 7, 5, room);
        assert_eq!(lines(30).unwrap(), ["lit (all of each light): 7"]);
        assert_eq!(lines(29).unwrap(), ["lit (all of each light):", "7"]);
        assert_eq!(lines(12).unwrap(), ["lit (all of", "each light):", "7"]);
        assert_eq!(lines(6), None);
    }

    #[test]
    fn legends_fit_or_are_left_out() {
        for (overlay, name) in Overlay::ALL {
            for side in [1, 25, 26, 64, 128, 255, 256, 300, 512, 1024] {
                let frame = Frame::new(side, side, 1).unwrap();
                let (legend, planes) = (frame.legend(overlay, 0.01), frame.overlay(overlay, 0.01).unwrap());
                let plane = planes.require(crate::image::COLOR_PLANE).unwrap();
                let rows = legend.rows(side, side).unwrap_or(0);
                assert_eq!((plane.columns(), plane.rows()), (side, side + rows), "{name} {side}");
                assert!(rows <= side && legend.fits(side, side) == (rows > 0), "{name} {side}");
                assert!(side < 256 || rows > 0, "{name} {side}: from 256 on there is one");
                assert!(side > 64 || rows == 0, "{name} {side}: nobody could read it");
            }
        }
    }

    #[test]
    fn wide_pictures_have_columns() {
        let legend = Frame::new(1024, 1024, 1).unwrap().legend(Overlay::Cost, 0.01);
        let items = legend.items(1024).unwrap();
        assert!(items.iter().all(|item| item.text.len() == 1));
        let lefts: Vec<usize> = items.iter().map(|item| item.left).collect();
        assert!(lefts.is_sorted() && *lefts.last().unwrap() > 0 && *lefts.last().unwrap() < 1024 - 200, "{lefts:?}");
    }
}
