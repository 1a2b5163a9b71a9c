//! What is wrong with a formula, where, and what to do about it.
use annotate_snippets::{AnnotationKind, Level, Renderer, Snippet};
use std::{fmt, ops::Range};

/// The class of an [`Error`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum ErrorKind {
    /// No equation at all: only blanks, comments or separators.
    Empty,
    /// The text is longer than [`super::MAX_SOURCE`], or expands to more operations than [`super::MAX_NODES`].
    TooLarge,
    /// A character that no token begins with.
    StrayCharacter,
    /// A number with too many digits or too large an exponent.
    Number,
    /// `nan` or `inf`: not real numbers.
    NotReal,
    /// A name that nothing defines.
    UnknownName,
    /// A definition of a name that is taken.
    Redefinition,
    /// A function without its arguments, or with the wrong number of them.
    Arguments,
    /// A parenthesis that is not closed or not opened.
    Parenthesis,
    /// More than one `=` in a statement.
    EqualsTwice,
    /// A statement other than the last one that defines nothing, or a last one that only defines something.
    Statement,
    /// Any other violation of the grammar.
    Syntax,
    /// Division by a constant that is exactly 0.
    DivisionByZero,
    /// An operation of another program that has no meaning as a real function, or none that is known here.
    Unsupported,
    /// An integer exponent outside the range of `i32`.
    Exponent,
}

/// Why a text is not a formula.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Error {
    kind: ErrorKind,
    span: Range<usize>,
    line: usize,
    column: usize,
    message: String,
    expected: Vec<String>,
    help: Option<String>,
}

impl Error {
    pub(crate) fn new(source: &str, kind: ErrorKind, span: Range<usize>, message: impl Into<String>) -> Self {
        let before = &source[..span.start];
        let line_start = before.rfind('\n').map_or(0, |i| i + 1);
        Self {
            kind,
            line: before.bytes().filter(|&b| b == b'\n').count() + 1,
            column: before[line_start..].chars().count() + 1,
            span,
            message: message.into(),
            expected: vec![],
            help: None,
        }
    }

    pub(crate) fn with_help(self, help: impl Into<String>) -> Self {
        Self { help: Some(help.into()), ..self }
    }

    pub(crate) fn with_expected(self, expected: Vec<String>) -> Self {
        Self { expected, ..self }
    }

    /// The same error at another place, of another text.
    pub(crate) fn moved(self, source: &str, span: Range<usize>) -> Self {
        let Self { kind, message, expected, help, .. } = self;
        Self { expected, help, ..Self::new(source, kind, span, message) }
    }

    /// Class of the mistake.
    #[must_use]
    pub fn kind(&self) -> ErrorKind {
        self.kind
    }

    /// Place in the source, in bytes; empty at the end of the text.
    #[must_use]
    pub fn span(&self) -> Range<usize> {
        self.span.clone()
    }

    /// Line of the beginning of the place, from 1.
    #[must_use]
    pub fn line(&self) -> usize {
        self.line
    }

    /// Column in characters (Unicode scalar values), from 1.
    #[must_use]
    pub fn column(&self) -> usize {
        self.column
    }

    /// One sentence without full stop.
    #[must_use]
    pub fn message(&self) -> &str {
        &self.message
    }

    /// What could have stood there; empty where that says nothing.
    #[must_use]
    pub fn expected(&self) -> &[String] {
        &self.expected
    }

    /// What to do about it.
    #[must_use]
    pub fn help(&self) -> Option<&str> {
        self.help.as_deref()
    }

    /// The message with the excerpt of `source` (the parsed text) and a caret below the place; several lines of plain text.
    ///
    /// At most 60 characters on each side of the place are shown, so that the excerpt of a formula of one huge line is short.
    #[must_use]
    pub fn render(&self, source: &str) -> String {
        const SIDE: usize = 60;
        let start = self.span.start.min(source.len());
        let line_start = source[..start].rfind('\n').map_or(0, |i| i + 1);
        let line_end = source[start..].find('\n').map_or(source.len(), |i| start + i);
        let from = source[line_start..start].char_indices().rev().nth(SIDE).map_or(line_start, |(i, _)| line_start + i);
        let to = source[start..line_end].char_indices().nth(SIDE).map_or(line_end, |(i, _)| start + i);
        let (head, tail) = (if from > line_start { "..." } else { "" }, if to < line_end { "..." } else { "" });
        let excerpt = format!("{head}{}{tail}", &source[from..to]).replace('\t', " ");
        let place = head.len() + start - from..head.len() + self.span.end.clamp(start, to) - from;

        let mut label = String::new();
        if !self.expected.is_empty() {
            label = format!("expected {}", alternatives(&self.expected));
        }
        let snippet = Snippet::source(excerpt.as_str())
            .line_start(self.line)
            .annotation(AnnotationKind::Primary.span(place).label(label.as_str()));
        let mut group = Level::ERROR.primary_title(self.message.as_str()).element(snippet);
        if let Some(help) = &self.help {
            group = group.element(Level::HELP.message(help.as_str()));
        }
        Renderer::plain().render(&[group])
    }
}

/// "a, b or c".
fn alternatives(words: &[String]) -> String {
    match words {
        [] => String::new(),
        [one] => one.clone(),
        [first @ .., last] => format!("{} or {last}", first.join(", ")),
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "line {}, column {}: {}", self.line, self.column, self.message)?;
        if !self.expected.is_empty() {
            write!(f, "; expected {}", alternatives(&self.expected))?;
        }
        if let Some(help) = &self.help {
            write!(f, " ({help})")?;
        }
        Ok(())
    }
}

impl std::error::Error for Error {}
