//! Words -> statements -> syntax tree.
//!
//! Parentheses are matched and names resolved here, before the grammar, because whether `a(b+1)` is a call or a product
//! depends on what `a` is, and so does the tree: `a(b+1)^2` is `a(b+1)` squared or `a` times a square.
use super::{
    Error, ErrorKind,
    function::Builtin,
    grammar::EquationParser,
    lexer::{Placed, Word, number, superscript, words},
    name::{self, Names},
    syntax::{Body, Callee, Definition, Program, Token, Tree},
};
use lalrpop_util::ParseError;
use std::{collections::HashMap, ops::Range};

/// Most parameters of a user's function.
const MAX_PARAMETERS: usize = 64;

/// Reads a text of at most `MAX_SOURCE` bytes.
pub(crate) fn read(source: &str) -> Result<Program, Error> {
    let words = words(source)?;
    match_parentheses(source, &words)?;
    let statements = split(&words);
    let Some((equation, definitions)) = statements.split_last() else {
        return Err(Error::new(source, ErrorKind::Empty, 0..0, "the formula is empty")
            .with_help("write an equation in x, y and z: `x^2 + y^2 + z^2 = 1`"));
    };

    let mut reader = Reader { source, tree: Tree::default(), definitions: vec![], index: HashMap::new() };
    for statement in definitions {
        reader.definition(statement)?;
    }
    one_equals(source, equation, 1)?;
    if let Some(head) = head(equation) {
        reader.not_only_a_definition(&head)?;
    }
    let equation = reader.body(equation, &[])?;
    Ok(Program { tree: reader.tree, definitions: reader.definitions, equation })
}

/// The statements before the last, as text that can stand before another one, and the last as one expression in parentheses:
/// `a = b` is `((a) - (b))`. Comments and blanks of the last statement's ends are left out.
pub(crate) fn split_text(source: &str) -> Result<[String; 2], Error> {
    let words = words(source)?;
    match_parentheses(source, &words)?;
    let statements = split(&words);
    let Some(last) = statements.last() else { return Ok([String::new(), String::new()]) };
    let text = |words: &[Placed]| match words {
        [] => "",
        [(_, first), ..] => &source[first.start..words[words.len() - 1].1.end],
    };
    let begin = last[0].1.start;
    // A comment ends with its line.
    let expression = match last.iter().position(|(w, _)| *w == Word::Equals) {
        None => format!("({}\n)", text(last)),
        Some(at) => format!("(({}\n) - ({}\n))", text(&last[..at]), text(&last[at + 1..])),
    };
    Ok([source[..begin].to_owned(), expression])
}

/// Every parenthesis has its partner; at the first that has not, says which one.
fn match_parentheses(source: &str, words: &[Placed]) -> Result<(), Error> {
    let mut open: Vec<Range<usize>> = vec![];
    let unclosed = |span: Range<usize>| {
        Error::new(source, ErrorKind::Parenthesis, span, "this parenthesis is never closed").with_help("add a `)`")
    };
    for (word, span) in words {
        match word {
            Word::Open => open.push(span.clone()),
            Word::Close if open.pop().is_none() => {
                return Err(Error::new(
                    source,
                    ErrorKind::Parenthesis,
                    span.clone(),
                    "this parenthesis closes nothing",
                )
                .with_help("remove it or add a `(` before it"));
            }
            Word::Semicolon => {
                if let Some(span) = open.pop() {
                    return Err(unclosed(span));
                }
            }
            _ => {}
        }
    }
    open.pop().map_or(Ok(()), |span| Err(unclosed(span)))
}

/// Statements end at `;` and at a newline, except inside parentheses, after a word that wants a right side, and before one
/// that wants a left side. No statement is empty.
pub(super) fn split(words: &[Placed]) -> Vec<Vec<Placed>> {
    let mut statements = vec![];
    let mut current: Vec<Placed> = vec![];
    let mut depth = 0_usize;
    // The first word after position i that is not a newline, found once for all.
    let mut next = vec![None; words.len()];
    for i in (1..words.len()).rev() {
        next[i - 1] = if words[i].0 == Word::Newline { next[i] } else { Some(&words[i].0) };
    }
    for (i, (word, span)) in words.iter().enumerate() {
        let binary = |word: &Word| {
            matches!(word, Word::Plus | Word::Minus | Word::Times | Word::Divide | Word::Power | Word::Equals)
        };
        match word {
            Word::Open => depth += 1,
            Word::Close => depth -= 1,
            Word::Newline => {
                let continues =
                    depth > 0 || current.last().is_some_and(|(w, _)| binary(w)) || next[i].is_some_and(binary);
                if !continues {
                    statements.push(std::mem::take(&mut current));
                }
                continue;
            }
            Word::Semicolon => {
                statements.push(std::mem::take(&mut current));
                continue;
            }
            _ => {}
        }
        current.push((*word, span.clone()));
    }
    statements.push(current);
    statements.retain(|s| !s.is_empty());
    statements
}

/// At most `most` signs of equality.
fn one_equals(source: &str, statement: &[Placed], most: usize) -> Result<(), Error> {
    match statement.iter().filter(|(w, _)| *w == Word::Equals).nth(most) {
        None => Ok(()),
        Some((_, span)) => {
            Err(Error::new(source, ErrorKind::EqualsTwice, span.clone(), "a second `=` in the same statement")
                .with_help("separate statements with `;` or a new line"))
        }
    }
}

/// `name =` or `name(parameters) =`, the beginning of a definition.
pub(super) struct Head {
    pub(super) name: Range<usize>,
    pub(super) parameters: Option<Vec<Range<usize>>>,
    /// Where the right side begins, in words.
    pub(super) body: usize,
}

pub(super) fn head(statement: &[Placed]) -> Option<Head> {
    let word = |i: usize| statement.get(i).map(|(w, _)| *w);
    if word(0) != Some(Word::Name) {
        return None;
    }
    let name = statement[0].1.clone();
    if word(1) == Some(Word::Equals) {
        return Some(Head { name, parameters: None, body: 2 });
    }
    let mut parameters = vec![];
    let mut i = 1;
    while word(i) == Some(if i == 1 { Word::Open } else { Word::Comma }) && word(i + 1) == Some(Word::Name) {
        parameters.push(statement[i + 1].1.clone());
        i += 2;
    }
    (!parameters.is_empty() && word(i) == Some(Word::Close) && word(i + 1) == Some(Word::Equals)).then_some(Head {
        name,
        parameters: Some(parameters),
        body: i + 2,
    })
}

struct Reader<'s> {
    source: &'s str,
    tree: Tree,
    definitions: Vec<Definition>,
    /// Place of a name in `definitions`.
    index: HashMap<String, u32>,
}

impl Reader<'_> {
    fn names<'a>(&'a self, parameters: &'a [String]) -> Names<'a> {
        Names { definitions: &self.definitions, index: &self.index, parameters }
    }

    fn text(&self, span: &Range<usize>) -> &str {
        &self.source[span.clone()]
    }

    fn definition(&mut self, statement: &[Placed]) -> Result<(), Error> {
        let place = statement[0].1.start..statement.last().map_or(0, |(_, s)| s.end);
        let Some(head) = head(statement) else {
            return Err(Error::new(
                self.source,
                ErrorKind::Statement,
                place,
                "only the last statement can be an equation",
            )
            .with_help(
                "those before it define: `a = 0.5` or `f(t) = t^2`; to continue a line, end it with an operator",
            ));
        };
        one_equals(self.source, statement, 1)?;
        let name = self.text(&head.name).to_owned();
        let names = self.names(&[]);
        if let Some(taken) = names.taken(&name) {
            return Err(Error::new(self.source, ErrorKind::Redefinition, head.name, format!("`{name}` {taken}"))
                .with_help("choose another name; the last statement must be the equation of the surface"));
        }
        let spans = head.parameters.clone().unwrap_or_default();
        let mut parameters: Vec<String> = vec![];
        for span in spans {
            let parameter = self.text(&span).to_owned();
            if parameters.contains(&parameter) {
                let message = format!("two parameters are called `{parameter}`");
                return Err(Error::new(self.source, ErrorKind::Redefinition, span, message));
            }
            if Builtin::find(&parameter).is_some() {
                let message = format!("`{parameter}` is a function and cannot be a parameter");
                return Err(Error::new(self.source, ErrorKind::Redefinition, span, message));
            }
            if parameters.len() == MAX_PARAMETERS {
                let message = format!("more than {MAX_PARAMETERS} parameters");
                return Err(Error::new(self.source, ErrorKind::TooLarge, span, message));
            }
            parameters.push(parameter);
        }
        if head.body == statement.len() {
            let end = place.end..place.end;
            return Err(Error::new(self.source, ErrorKind::Syntax, end, "the definition ends after `=`")
                .with_expected(vec!["an expression".into()]));
        }
        let body = self.body(&statement[head.body..], &parameters)?;
        self.index.insert(name.clone(), self.definitions.len() as u32);
        self.definitions.push(Definition { name, function: head.parameters.is_some(), parameters, body });
        Ok(())
    }

    /// The last statement looks like a definition of something new.
    fn not_only_a_definition(&self, head: &Head) -> Result<(), Error> {
        let name = self.text(&head.name);
        let names = self.names(&[]);
        let called = head.parameters.is_some();
        if names.lookup(name).is_some() || names.split(name, called).is_some() || names.nearest(name).is_some() {
            return Ok(());
        }
        let message = format!("the last statement only defines `{name}`");
        Err(Error::new(self.source, ErrorKind::Statement, head.name.clone(), message)
            .with_help("it must be the equation of the surface, in x, y and z"))
    }

    /// Resolves the names of an expression and parses it.
    fn body(&mut self, words: &[Placed], parameters: &[String]) -> Result<Body, Error> {
        let mut tokens: Vec<(usize, Token, usize)> = Vec::with_capacity(words.len());
        for (i, (word, span)) in words.iter().enumerate() {
            let token = match word {
                Word::Number | Word::Superscript => {
                    let value = match word {
                        Word::Number => number(self.source, span.clone())?,
                        _ => superscript(self.source, span.clone())?,
                    };
                    let index = self.tree.numbers.len() as u32;
                    self.tree.numbers.push(value);
                    if *word == Word::Number { Token::Number(index) } else { Token::Superscript(index) }
                }
                Word::Name => {
                    let names = self.names(parameters);
                    let next = words.get(i + 1).map(|(w, _)| *w);
                    name::resolve(self.source, span.clone(), next, &names, &mut tokens)?;
                    continue;
                }
                Word::Plus => Token::Plus,
                Word::Minus => Token::Minus,
                Word::Times => Token::Times,
                Word::Divide => Token::Divide,
                Word::Power => Token::Power,
                Word::Root => Token::Root,
                Word::Open => Token::Open,
                Word::Close => Token::Close,
                Word::Comma => Token::Comma,
                Word::Equals => Token::Equals,
                // Inside parentheses a newline is a blank; elsewhere it never gets here, and nor does `;`.
                Word::Newline | Word::Semicolon => continue,
            };
            tokens.push((span.start, token, span.end));
        }
        let first = self.tree.nodes.len() as u32;
        let (source, definitions) = (self.source, &self.definitions);
        let end = words.last().map_or(0, |(_, s)| s.end);
        let root = EquationParser::new()
            .parse(&mut self.tree, tokens.iter().copied())
            .map_err(|error| syntax_error(source, error, &tokens, end, definitions))?;
        Ok(Body { nodes: first..self.tree.nodes.len() as u32, root })
    }
}

type Failure = ParseError<usize, Token, std::convert::Infallible>;

fn syntax_error(
    source: &str,
    failure: Failure,
    tokens: &[(usize, Token, usize)],
    end: usize,
    definitions: &[Definition],
) -> Error {
    let (found, expected) = match failure {
        ParseError::UnrecognizedToken { token, expected } => (Some(token), expected),
        ParseError::ExtraToken { token } => (Some(token), vec![]),
        ParseError::UnrecognizedEof { expected, .. } => (None, expected),
        ParseError::InvalidToken { .. } => (None, vec![]),
        ParseError::User { error } => match error {},
    };
    let expected = simplify(&expected);
    let Some((start, token, stop)) = found else {
        let what = match tokens.last() {
            Some((_, last, _)) => format!("the formula ends after {}", shown(*last, definitions)),
            None => "the formula is empty".into(),
        };
        return Error::new(source, ErrorKind::Syntax, end..end, what).with_expected(expected);
    };
    let before = tokens.iter().position(|t| t.0 == start).and_then(|i| i.checked_sub(1)).map(|i| tokens[i]);
    let span = start..stop;
    let error = |message: String| Error::new(source, ErrorKind::Syntax, span.clone(), message);
    match (before.map(|t| t.1), token) {
        (Some(Token::Number(_) | Token::Close | Token::Name(_) | Token::Superscript(_)), Token::Number(_)) => {
            error("a number cannot follow here without an operator".into()).with_help("write the product with `*`")
        }
        (Some(Token::Open), Token::Close) => error("nothing between the parentheses".into()).with_expected(expected),
        (_, Token::Comma) if !expected.iter().any(|e| e == "an expression") => {
            error("a comma outside of a function's arguments".into())
                .with_help("the decimal point is `.`; statements are separated with `;`")
        }
        (_, Token::Equals) if before.is_some() && !expected.iter().any(|e| e == "an expression") => {
            error("`=` inside parentheses".into()).with_help("an equation has one `=`, outside of all parentheses")
        }
        (None, _) => error(format!("the statement begins with {}", shown(token, definitions))).with_expected(expected),
        (Some(last), _) => {
            error(format!("{} after {}", shown(token, definitions), shown(last, definitions))).with_expected(expected)
        }
    }
}

fn shown(token: Token, definitions: &[Definition]) -> String {
    match token {
        Token::Function(Callee::Builtin(f)) => format!("`{}`", f.name()),
        Token::Function(Callee::User(i)) => format!("`{}`", definitions[i as usize].name),
        other => other.to_string(),
    }
}

/// The parser's terminals in words: what begins an expression is one word.
fn simplify(terminals: &[String]) -> Vec<String> {
    let mut out: Vec<String> = vec![];
    let has = |t: &str| terminals.iter().any(|e| e.trim_matches('"') == t);
    if has("number") && has("(") {
        out.push("an expression".into());
    } else if has("+") && has("*") {
        out.push("an operator".into());
    }
    for (terminal, word) in [("=", "`=`"), (")", "`)`"), (",", "`,`")] {
        if has(terminal) {
            out.push(word.into());
        }
    }
    out
}
