//! A text put together from pieces of a file: where its errors are in the file.
use crate::expr::{Error, Formula};

/// A text of pieces, each with its place in the file.
pub(super) struct Pieces<'a> {
    file: &'a str,
    text: String,
    /// Where a piece begins, in the text and in the file. What has no place of its own counts to the piece before.
    origins: Vec<(usize, usize)>,
}

impl<'a> Pieces<'a> {
    pub(super) fn of(file: &'a str) -> Self {
        Self { file, text: String::new(), origins: vec![(0, 0)] }
    }

    /// Appends a piece that stands in the file at that place; it may differ from it by the file's escapes.
    pub(super) fn push(&mut self, piece: &str, at: usize) {
        self.origins.push((self.text.len(), at));
        self.text.push_str(piece);
    }

    /// Appends what the file does not say.
    pub(super) fn add(&mut self, words: &str) {
        self.text.push_str(words);
    }

    /// The formula of the text, as written.
    pub(super) fn formula(&self) -> Result<Formula, Error> {
        let place = |at: usize| {
            let (text, file) = self.origins[self.origins.partition_point(|(text, _)| *text <= at) - 1];
            let mut at = (file + at - text).min(self.file.len());
            while !self.file.is_char_boundary(at) {
                at -= 1;
            }
            at
        };
        Formula::parse_as_written(&self.text).map_err(|error| {
            let span = error.span();
            let begin = place(span.start);
            let end = if span.is_empty() { begin } else { place(span.end - 1).max(begin) + 1 };
            let end = (begin..=self.file.len()).find(|i| *i >= end && self.file.is_char_boundary(*i)).unwrap_or(begin);
            error.moved(self.file, begin..end)
        })
    }
}
