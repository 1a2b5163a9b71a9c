//! What a name in the text stands for: parameters, the user's definitions, the language's own names, in this order.
use super::{
    Axis, Error, ErrorKind,
    function::Builtin,
    lexer::Word,
    syntax::{Callee, Definition, Symbol, Token},
};
use std::{collections::HashMap, ops::Range};

/// Longest name for which a similar one, or a function at its end, is looked for.
const MAX_FUZZY: usize = 40;

/// The language's own constants and coordinates.
const SYMBOLS: &[(&str, Symbol)] = &[
    ("x", Symbol::Axis(Axis::X)),
    ("y", Symbol::Axis(Axis::Y)),
    ("z", Symbol::Axis(Axis::Z)),
    ("pi", Symbol::Pi),
    ("π", Symbol::Pi),
    ("e", Symbol::E),
    ("phi", Symbol::Phi),
    ("φ", Symbol::Phi),
    ("ϕ", Symbol::Phi),
    ("tau", Symbol::Tau),
    ("τ", Symbol::Tau),
];

/// The names that can be used at one place.
pub(crate) struct Names<'a> {
    pub(crate) definitions: &'a [Definition],
    pub(crate) index: &'a HashMap<String, u32>,
    pub(crate) parameters: &'a [String],
}

impl Names<'_> {
    pub(crate) fn lookup(&self, name: &str) -> Option<Token> {
        if let Some(i) = self.parameters.iter().position(|p| p == name) {
            return Some(Token::Name(Symbol::Parameter(i as u32)));
        }
        if let Some(&i) = self.index.get(name) {
            return Some(if self.definitions[i as usize].function {
                Token::Function(Callee::User(i))
            } else {
                Token::Name(Symbol::User(i))
            });
        }
        if let Some((_, symbol)) = SYMBOLS.iter().find(|(n, _)| *n == name) {
            return Some(Token::Name(*symbol));
        }
        Builtin::find(name).map(|f| Token::Function(Callee::Builtin(f)))
    }

    /// Why the name cannot be defined, if so.
    pub(crate) fn taken(&self, name: &str) -> Option<&'static str> {
        Some(match self.lookup(name)? {
            Token::Name(Symbol::User(_)) | Token::Function(Callee::User(_)) => "is already defined",
            Token::Name(Symbol::Axis(_)) => "is a coordinate and cannot be defined",
            Token::Name(_) => "is a constant of the language and cannot be redefined",
            _ => "is a function of the language and cannot be redefined",
        })
    }

    /// An implicit product: every letter a known name of one letter; before a parenthesis the last part may be a function,
    /// as in `xsin(y)`. Gives the parts with their lengths in bytes.
    pub(crate) fn split(&self, name: &str, called: bool) -> Option<Vec<(Token, usize)>> {
        // Longest function first: `xasin(y)` is x times asin.
        let starts = name.char_indices().skip(1).map(|(i, _)| i).filter(|&i| called && name.len() - i <= MAX_FUZZY);
        let tails = starts.filter(|&i| matches!(self.lookup(&name[i..]), Some(Token::Function(_))));
        for cut in tails.chain([name.len()]) {
            let mut parts = vec![];
            for c in name[..cut].chars() {
                let mut buffer = [0; 4];
                match self.lookup(c.encode_utf8(&mut buffer)) {
                    Some(token @ Token::Name(_)) => parts.push((token, c.len_utf8())),
                    _ => break,
                }
            }
            if parts.iter().map(|p| p.1).sum::<usize>() == cut {
                parts.extend(self.lookup(&name[cut..]).map(|token| (token, name.len() - cut)));
                return Some(parts);
            }
        }
        None
    }

    /// The known name that `name` was probably meant to be.
    pub(crate) fn nearest(&self, name: &str) -> Option<String> {
        if name.len() > MAX_FUZZY {
            return None;
        }
        let lower = name.to_lowercase();
        let own = SYMBOLS.iter().map(|(n, _)| *n).chain(Builtin::NAMES.iter().copied());
        let users = self.definitions.iter().map(|d| d.name.as_str()).chain(self.parameters.iter().map(String::as_str));
        let known: Vec<&str> = users.chain(own).collect();
        if let Some(same) = known.iter().find(|n| n.to_lowercase() == lower) {
            return Some((*same).to_owned());
        }
        // One slip for short names, two for longer ones; single letters resemble everything.
        let length = lower.chars().count();
        let most = if length <= 4 { 1 } else { 2 };
        known
            .into_iter()
            .filter(|n| length > 1 && n.chars().count() > 1)
            .map(|n| (strsim::damerau_levenshtein(n, &lower), n))
            .filter(|(distance, _)| *distance <= most)
            .min_by_key(|(distance, _)| *distance)
            .map(|(_, n)| n.to_owned())
    }
}

/// Appends the tokens that the name at `span` stands for; `next` is the word after it.
pub(crate) fn resolve(
    source: &str,
    span: Range<usize>,
    next: Option<Word>,
    names: &Names<'_>,
    out: &mut Vec<(usize, Token, usize)>,
) -> Result<(), Error> {
    let name = &source[span.clone()];
    let called = next == Some(Word::Open);
    match names.lookup(name) {
        Some(Token::Function(_)) if !called => Err(no_arguments(source, span, next)),
        Some(token) => {
            out.push((span.start, token, span.end));
            Ok(())
        }
        // A mistyped long name is never cheaper to read as a product of hundreds of letters.
        None => {
            let parts = names.split(name, called).ok_or_else(|| unknown(source, span.clone(), names, called))?;
            let mut start = span.start;
            for (token, length) in parts {
                out.push((start, token, start + length));
                start += length;
            }
            Ok(())
        }
    }
}

fn no_arguments(source: &str, span: Range<usize>, next: Option<Word>) -> Error {
    let name = &source[span.clone()];
    let help = match next {
        Some(Word::Power | Word::Superscript) => format!("write the power after the argument: `{name}(x)^2`"),
        _ => format!("write `{name}(x)`"),
    };
    Error::new(source, ErrorKind::Arguments, span.clone(), format!("the function `{name}` has no arguments"))
        .with_help(help)
}

fn unknown(source: &str, span: Range<usize>, names: &Names<'_>, called: bool) -> Error {
    let name = &source[span.clone()];
    let shown: String = if name.chars().count() > MAX_FUZZY {
        name.chars().take(MAX_FUZZY).chain("...".chars()).collect()
    } else {
        name.to_owned()
    };
    if matches!(name.to_lowercase().as_str(), "nan" | "inf" | "infinity") {
        return Error::new(source, ErrorKind::NotReal, span.clone(), format!("`{name}` is not a real number"))
            .with_help("constants are real numbers such as `0.5`, `1e-3` or `pi`");
    }
    let kind = if called { "function" } else { "name" };
    let error = Error::new(source, ErrorKind::UnknownName, span.clone(), format!("unknown {kind} `{shown}`"));
    if let Some(nearest) = names.nearest(name) {
        return error.with_help(format!("did you mean `{nearest}`?"));
    }
    let letters = name.trim_end_matches(|c: char| c.is_ascii_digit());
    if letters.len() < name.len() && name.len() <= MAX_FUZZY && names.lookup(letters).is_some() {
        let digits = &name[letters.len()..];
        return error.with_help(format!("write the power `{letters}^{digits}` or the product `{digits}*{letters}`"));
    }
    error.with_help(if called {
        format!("define it before: `{shown}(t) = t^2; ...`")
    } else {
        format!("define it before: `{shown} = 0.5; ...`")
    })
}
