//! A text put together from pieces of a file: where its errors are in the file.
use crate::expr::{Error, ErrorKind, Formula, is_name};

/// A text of pieces, each with its place in the file.
pub(super) struct Pieces<'a> {
    file: &'a str,
    text: String,
    /// Where a piece begins, in the text and in the file. What has no place of its own counts to the piece before.
    origins: Vec<(usize, usize)>,
    /// The first thing that would have become more than it is in the file.
    refused: Option<Error>,
}

impl<'a> Pieces<'a> {
    pub(super) fn of(file: &'a str) -> Self {
        Self { file, text: String::new(), origins: vec![(0, 0)], refused: None }
    }

    /// Appends a piece that stands in the file at that place; it may differ from it by the file's escapes.
    fn push(&mut self, piece: &str, at: usize) {
        self.origins.push((self.text.len(), at));
        self.text.push_str(piece);
    }

    /// Appends `name parameters = (value); `. The name must be one, and the value an expression of its own: no comment may hide
    /// what follows, no bracket or semicolon may end the definition early.
    pub(super) fn define(&mut self, name: (&str, usize), parameters: &str, value: &[(&str, usize)]) {
        if !is_name(name.0.trim()) {
            self.refuse(
                name.1..name.1 + name.0.len(),
                ErrorKind::Statement,
                "a definition needs a name of letters and digits",
            );
        }
        self.push(name.0, name.1);
        self.add(parameters);
        self.add(" = (");
        let mut depth = 0_i32;
        for (piece, at) in value {
            for (i, c) in piece.char_indices() {
                depth += i32::from(c == '(') - i32::from(c == ')');
                if depth < 0 {
                    self.refuse(at + i..at + i + 1, ErrorKind::Syntax, "there is no opening bracket for this one");
                }
            }
            self.expression(piece, *at);
        }
        if depth > 0 {
            let end = value.last().map_or(name.1, |(piece, at)| at + piece.len());
            self.refuse(end..end, ErrorKind::Syntax, "a bracket is not closed in this definition");
        }
        self.add("); ");
    }

    /// Appends a piece of an expression: what would begin a comment or end a statement is refused.
    pub(super) fn expression(&mut self, piece: &str, at: usize) {
        if let Some((i, c)) = piece.char_indices().find(|(_, c)| matches!(c, '#' | ';' | '\n')) {
            self.refuse(
                at + i..at + i + c.len_utf8(),
                ErrorKind::Syntax,
                &format!("{c:?} does not belong in a formula of this format"),
            );
        }
        self.push(piece, at);
    }

    fn refuse(&mut self, at: std::ops::Range<usize>, kind: ErrorKind, why: &str) {
        let inside = |mut i: usize| {
            i = i.min(self.file.len());
            while !self.file.is_char_boundary(i) {
                i -= 1;
            }
            i
        };
        let at = inside(at.start)..inside(at.end);
        self.refused.get_or_insert_with(|| Error::new(self.file, kind, at, why.to_owned()));
    }

    /// Appends what the file does not say.
    pub(super) fn add(&mut self, words: &str) {
        self.text.push_str(words);
    }

    /// The formula of the text, as written.
    pub(super) fn formula(&self) -> Result<Formula, Error> {
        if let Some(error) = &self.refused {
            return Err(error.clone());
        }
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
