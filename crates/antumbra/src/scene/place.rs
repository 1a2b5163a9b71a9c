//! Where a key stands in the text of a scene file.
use super::FileError;
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_found() {
        let text = "title = \"t\"\n[[surface]]\nformula = \"x\"\n\n[[surface]]\nformula = \"y\"\nclip = { ball = 1 }\n";
        let line = |key| line_of(text, key);
        assert_eq!((line("title"), line("surface[1].formula"), line("surface[2].formula")), (Some(1), Some(3), Some(6)));
        assert_eq!((line("surface[2].clip.ball"), line("surface[2].outside")), (Some(7), Some(5)));
        assert_eq!((line("light[1]"), line("surface[3].clip"), line_of("[", "a")), (None, Some(2), None));
    }
}
