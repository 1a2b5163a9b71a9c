//! The numbers that a formula's text defines by name, and the same text with another number.
use super::{
    Error, MAX_SOURCE,
    lexer::words,
    statement::{head, split},
};
use std::ops::Range;

/// Every definition without parameters in the text of a formula, `a = 0.05;` say: its name and the place of what it is
/// defined as. The last statement, the equation, is none. Nothing but the form of the statements is looked at.
///
/// # Errors
/// Where the text has characters that no formula has.
pub fn definitions(source: &str) -> Result<Vec<(String, Range<usize>)>, Error> {
    if source.len() > MAX_SOURCE {
        // The parser has the words for it.
        return super::Formula::parse(source).map(|_| vec![]);
    }
    let words = words(source)?;
    let mut statements = split(&words);
    statements.pop();
    let definition = |statement: &Vec<_>| {
        let head = head(statement).filter(|head| head.parameters.is_none())?;
        let (first, last) = (statement.get(head.body)?, statement.last()?);
        let place: Range<usize> = first.1.start..last.1.end;
        Some((source[head.name].to_owned(), place))
    };
    Ok(statements.iter().filter_map(definition).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn definitions_are_found_with_their_places() {
        let source = "a = 0.05; f(t) = t^2 # b = 3\n μ = -2 +\n  sqrt(2)\nf(x) + a = μ";
        let found = definitions(source).unwrap();
        let shown: Vec<(&str, &str)> = found.iter().map(|(name, place)| (&name[..], &source[place.clone()])).collect();
        assert_eq!(shown, [("a", "0.05"), ("μ", "-2 +\n  sqrt(2)")]);
        assert_eq!(definitions("x = 3").unwrap(), []);
        assert_eq!(definitions("").unwrap(), []);
        assert!(definitions("a = $; x").is_err());
    }
}
