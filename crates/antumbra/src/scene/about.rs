//! What a scene says about its subject.
use serde::{Deserialize, Serialize};

/// Who found a surface, when, where one reads of it, and what makes it worth a look. All of it is text for people: nothing
/// is computed from it.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct About {
    /// Who found it, or gave this formula.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub author: Option<String>,
    /// Year of that.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub year: Option<i32>,
    /// Where it was published, or comes from.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub source: Option<String>,
    /// A line of history, or what to look at.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub history: Option<String>,
}

impl About {
    /// Author and year in a few words, such as `Arthur Cayley, 1869`; empty if neither is known.
    #[must_use]
    pub fn credit(&self) -> String {
        let year = self.year.map(|y| y.to_string());
        [self.author.clone(), year].into_iter().flatten().collect::<Vec<_>>().join(", ")
    }
}
