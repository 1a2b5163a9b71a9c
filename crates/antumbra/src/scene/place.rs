//! What to say of an error in a scene file: where the key stands, and what to do.
use super::FileError;
use std::ops::Range;
use toml::de::{DeTable, DeValue};

impl FileError {
    /// The message with the line of its key in the text of the file, as far as the key is written there.
    #[must_use]
    pub fn in_text(&self, text: &str) -> String {
        let key = match self {
            Self::Shape { .. } => return self.to_string(),
            Self::Value { key, .. } | Self::Formula { key, .. } => key,
        };
        match line_of(text, key) {
            Some(line) => format!("line {line}, {self}"),
            None => self.to_string(),
        }
    }
}

/// The line, from 1, of a key such as `surface[1].clip.ball`: of the deepest part of it that is written.
fn line_of(text: &str, key: &str) -> Option<usize> {
    let root = DeTable::parse(text).ok()?;
    let (mut table, mut place) = (Some(root.get_ref()), None);
    for part in key.split('.') {
        let (name, number) = match part.strip_suffix(']').and_then(|p| p.split_once('[')) {
            Some((name, number)) => (name, number.parse::<usize>().ok()),
            None => (part, None),
        };
        let Some((written, mut value)) = table.and_then(|t| t.get_key_value(name)) else { break };
        place = Some(written.span().start);
        if let (Some(k), DeValue::Array(list)) = (number, value.get_ref()) {
            let Some(item) = list.get(k.wrapping_sub(1)) else { break };
            (value, place) = (item, Some(item.span().start));
        }
        table = value.get_ref().as_table();
    }
    Some(text[..place?].matches('\n').count() + 1)
}

/// What to do about an error of TOML, where its message does not say it.
pub(super) fn advice(message: &str, text: &str, span: Option<Range<usize>>) -> Option<String> {
    if let Some(near) = suggestion(message) {
        return Some(format!("did you mean `{near}`?"));
    }
    let rest = span.and_then(|span| text.get(span.start..)?.lines().next()).unwrap_or_default();
    let advice = match message {
        m if m.starts_with("string values must be quoted") && rest.trim().is_empty() => "a value is missing after `=`",
        m if m.starts_with("string values must be quoted") => "text stands in quotes, as in title = \"Rings\"",
        m if m.starts_with("missing field `surface`") => "begin a surface with [[surface]], and give it a formula",
        m if m.starts_with("missing field `formula`") => "every [[surface]] needs a formula = \"...\"",
        m if m.starts_with("invalid length") => "points and colours are lists of numbers, such as [1.0, 0.0, 0.5]",
        m if m.starts_with("duplicate key") => "the key is given twice: remove one",
        _ => return None,
    };
    Some(advice.to_owned())
}

/// The known key, or word, that is nearest to an unknown one, out of TOML's message.
fn suggestion(message: &str) -> Option<String> {
    let unknown = message.strip_prefix("unknown field ").or_else(|| message.strip_prefix("unknown variant "));
    let mut names = unknown?.split('`').skip(1).step_by(2);
    let unknown = names.next()?;
    let near = |name: &&str| strsim::damerau_levenshtein(unknown, name);
    names.min_by_key(near).filter(|name| near(name) <= 1 + unknown.len() / 3).map(str::to_owned)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_found() {
        let text = "title = \"t\"\n[[surface]]\nformula = \"x\"\n\n[[surface]]\nformula = \"y\"\nclip = { ball = 1 }\n";
        let line = |key| line_of(text, key);
        assert_eq!(
            (line("title"), line("surface[1].formula"), line("surface[2].formula")),
            (Some(1), Some(3), Some(6))
        );
        assert_eq!((line("surface[2].clip.ball"), line("surface[2].outside")), (Some(7), Some(5)));
        assert_eq!((line("light[1]"), line("surface[3].clip"), line_of("[", "a")), (None, Some(2), None));
    }
}
