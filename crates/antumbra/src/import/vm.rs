//! The text format of Fidget: `name opcode operands`, one clause a line.
//!
//! Only earlier names can be operands, so no file can hold a cycle. A name may be given again; from then on it is the new value.
use super::solid::without_sheets;
use super::{Model, Part, written};
use crate::expr::{
    Axis, Binary, Error, ErrorKind, Formula, Graph, MAX_NODES, NodeId, Unary, cost_of_constant, is_number, number,
};
use crate::geom::{Box3, Clip};
use num_rational::BigRational;
use num_traits::{Signed, Zero};
use std::collections::HashMap;
use std::ops::Range;

/// An operation of the format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Opcode {
    Constant,
    Axis(Axis),
    Unary(Unary),
    Binary(Binary),
    Ceil,
    Round,
    Not,
    Mod,
    Compare,
    And,
    Or,
    /// A hash of the bits of a 32-bit number.
    Hash,
}

/// Every opcode with its number of operands.
const OPCODES: [(&str, Opcode, usize); 33] = [
    ("const", Opcode::Constant, 1),
    ("var-x", Opcode::Axis(Axis::X), 0),
    ("var-y", Opcode::Axis(Axis::Y), 0),
    ("var-z", Opcode::Axis(Axis::Z), 0),
    ("abs", Opcode::Unary(Unary::Abs), 1),
    ("neg", Opcode::Unary(Unary::Neg), 1),
    ("sqrt", Opcode::Unary(Unary::Sqrt), 1),
    ("square", Opcode::Unary(Unary::Sqr), 1),
    ("floor", Opcode::Unary(Unary::Floor), 1),
    ("ceil", Opcode::Ceil, 1),
    ("round", Opcode::Round, 1),
    ("sin", Opcode::Unary(Unary::Sin), 1),
    ("cos", Opcode::Unary(Unary::Cos), 1),
    ("tan", Opcode::Unary(Unary::Tan), 1),
    ("asin", Opcode::Unary(Unary::Asin), 1),
    ("acos", Opcode::Unary(Unary::Acos), 1),
    ("atan", Opcode::Unary(Unary::Atan), 1),
    ("ln", Opcode::Unary(Unary::Ln), 1),
    ("exp", Opcode::Unary(Unary::Exp), 1),
    ("not", Opcode::Not, 1),
    ("rand", Opcode::Hash, 1),
    ("add", Opcode::Binary(Binary::Add), 2),
    ("sub", Opcode::Binary(Binary::Sub), 2),
    ("mul", Opcode::Binary(Binary::Mul), 2),
    ("div", Opcode::Binary(Binary::Div), 2),
    ("min", Opcode::Binary(Binary::Min), 2),
    ("max", Opcode::Binary(Binary::Max), 2),
    ("mod", Opcode::Mod, 2),
    ("atan2", Opcode::Binary(Binary::Atan2), 2),
    ("compare", Opcode::Compare, 2),
    ("and", Opcode::And, 2),
    ("or", Opcode::Or, 2),
    ("mix", Opcode::Hash, 2),
];

/// Whether a word is an opcode of the format.
pub(super) fn is_opcode(word: &str) -> bool {
    OPCODES.iter().any(|(name, ..)| *name == word)
}

/// Most steps of exact arithmetic, as for formulas.
const MAX_STEPS: usize = 1 << 22;

/// Reads a file.
pub(super) fn read(file: &str) -> Result<Model, Error> {
    let mut reader = Reader { file, graph: Graph::new(false), names: HashMap::new(), steps: 0 };
    let mut last = None;
    let mut begin = 0;
    for line in file.split_inclusive('\n') {
        if !line.starts_with('#')
            && let Some(value) = reader.clause(&words(line, begin))?
        {
            last = Some((value, begin));
        }
        begin += line.len();
    }
    let Some((root, at)) = last else {
        let error = Error::new(file, ErrorKind::Empty, 0..0, "there is no operation in this file");
        return Err(error.with_help("a .vm file has one operation a line, such as `r add x2 y2`"));
    };
    let formula = written(file, &without_sheets(&Formula::new(reader.graph, root).compacted()), at)?;
    let title = file.lines().next().and_then(|line| line.strip_prefix('#')).map(|line| line.trim().to_owned());
    let open = Some(Clip::Box(Box3::cube(1.0 / scale(file).unwrap_or(1.0))));
    Ok(Model {
        title: title.filter(|title| !title.is_empty() && title.len() < 100),
        surfaces: vec![Part { formula, clip: None, open }],
    })
}

/// The scale of the view that a comment recommends, as in `# Recommended settings: --scale 0.7`: Fidget shows the cube from -1 to
/// 1, made smaller by it.
fn scale(file: &str) -> Option<f64> {
    let mut words = file.lines().take_while(|line| line.starts_with('#')).flat_map(str::split_whitespace);
    words.find(|word| *word == "--scale")?;
    words.next()?.parse().ok().filter(|scale| (1e-3..=1e3).contains(scale))
}

/// The words of a line that begins at `begin`, with their places in the file.
fn words(line: &str, begin: usize) -> Vec<(&str, Range<usize>)> {
    let place = |word: &str| {
        // `split_whitespace` gives parts of the line, so the difference of the addresses is the offset.
        let at = begin + (word.as_ptr() as usize - line.as_ptr() as usize);
        at..at + word.len()
    };
    line.split_whitespace().map(|word| (word, place(word))).collect()
}

struct Reader<'a> {
    file: &'a str,
    graph: Graph,
    names: HashMap<&'a str, NodeId>,
    steps: usize,
}

impl<'a> Reader<'a> {
    fn error(&self, kind: ErrorKind, at: Range<usize>, message: impl Into<String>) -> Error {
        Error::new(self.file, kind, at, message)
    }

    /// The value of a line's clause; `None` if the line is blank.
    fn clause(&mut self, words: &[(&'a str, Range<usize>)]) -> Result<Option<NodeId>, Error> {
        let Some(((name, place), rest)) = words.split_first() else { return Ok(None) };
        let Some(((word, at), operands)) = rest.split_first() else {
            let error = self.error(ErrorKind::Syntax, place.clone(), "this line ends before its operation");
            return Err(error.with_help("a line is `name opcode operands`, such as `r add x2 y2`"));
        };
        let Some((_, opcode, count)) = OPCODES.into_iter().find(|(name, ..)| name == word) else {
            return Err(self.unknown_opcode(word, at.clone()));
        };
        if opcode == Opcode::Hash {
            return Err(self.no_function(word, at.clone()));
        }
        // Words after the operands are no part of the format, but comments are common enough.
        let operands =
            &operands[..operands.iter().position(|(word, _)| word.starts_with('#')).unwrap_or(operands.len())];
        if operands.len() != count {
            let end = operands.last().map_or(at.end, |(_, last)| last.end);
            let place = if operands.len() > count { operands[count].1.clone() } else { end..end };
            let wanted = match count {
                0 => "no operand".to_owned(),
                1 => "1 operand".to_owned(),
                n => format!("{n} operands"),
            };
            let message = format!("`{word}` takes {wanted}, not {}", operands.len());
            return Err(self.error(ErrorKind::Arguments, place, message));
        }
        let value = if opcode == Opcode::Constant {
            let (text, place) = &operands[0];
            let q = self.constant(text, place.clone())?;
            self.graph.rational(q)
        } else {
            let mut values = [None; 2];
            for (value, (name, place)) in values.iter_mut().zip(operands) {
                *value = Some(self.operand(name, place.clone())?);
            }
            self.apply(opcode, values, at.start..operands.last().map_or(at.end, |(_, last)| last.end))?
        };
        self.steps += 1 + self.graph.exact(value).map_or(0, cost_of_constant);
        if self.graph.nodes().len() > MAX_NODES || self.steps > MAX_STEPS {
            let message =
                format!("more than {MAX_NODES} operations, or constants that take too long to compute exactly");
            return Err(self.error(ErrorKind::TooLarge, at.clone(), message));
        }
        self.names.insert(name, value);
        Ok(Some(value))
    }

    fn unknown_opcode(&self, word: &str, at: Range<usize>) -> Error {
        let distance = |name: &str| strsim::damerau_levenshtein(word, name);
        let near = OPCODES.iter().map(|(name, ..)| *name).min_by_key(|name| distance(name));
        let help = match near.filter(|near| distance(near) <= 1 + word.len() / 3) {
            _ if word == "recip" => "the text format has no `recip`: write `one const 1` and `r div one a`".to_owned(),
            Some(near) => format!("did you mean `{near}`?"),
            None => "a line is `name opcode operands`, such as `r add x2 y2`".to_owned(),
        };
        self.error(ErrorKind::UnknownName, at, format!("unknown opcode `{word}`")).with_help(help)
    }

    fn no_function(&self, word: &str, at: Range<usize>) -> Error {
        let message = format!("`{word}` hashes the bits of 32-bit numbers: it is no function of real numbers");
        self.error(ErrorKind::Unsupported, at, message).with_help("a model with random parts cannot be imported")
    }

    /// The node of an earlier clause.
    fn operand(&self, name: &str, at: Range<usize>) -> Result<NodeId, Error> {
        if let Some(&id) = self.names.get(name) {
            return Ok(id);
        }
        let own = self.file[..at.start].matches('\n').count();
        let defines = |line: &str| !line.starts_with('#') && line.split_whitespace().next() == Some(name);
        let later = self.file.lines().enumerate().skip(own).find(|(_, line)| defines(line));
        let (message, help) = match later {
            Some((line, _)) if line == own => {
                (format!("`{name}` is defined by itself"), "a line can use earlier lines only".to_owned())
            }
            Some((line, _)) => {
                let message = format!("`{name}` is used before it is defined, in line {}", line + 1);
                (message, "a line can use earlier lines only: move the definition up".to_owned())
            }
            None if is_number(name.trim_start_matches(['+', '-'])) => {
                (format!("`{name}` is no name"), format!("give the number a name first: `c const {name}`"))
            }
            None => {
                let help = "an operand is the name at the beginning of an earlier line";
                (format!("nothing is named `{name}`"), help.to_owned())
            }
        };
        Err(self.error(ErrorKind::UnknownName, at, message).with_help(help))
    }

    /// The exact value of a decimal with a sign.
    fn constant(&self, text: &str, at: Range<usize>) -> Result<BigRational, Error> {
        let digits = text.strip_prefix(['+', '-']).unwrap_or(text);
        if !is_number(digits) {
            return Err(match digits.to_ascii_lowercase().as_str() {
                "nan" | "inf" | "infinity" => {
                    self.error(ErrorKind::NotReal, at, format!("`{text}` is not a real number"))
                }
                _ => self
                    .error(ErrorKind::Number, at, format!("`{text}` is no number"))
                    .with_help("a constant is a decimal such as `-1.5e-3`"),
            });
        }
        let q = number(self.file, at.end - digits.len()..at.end)?;
        Ok(if text.starts_with('-') { -q } else { q })
    }

    /// The operation as one, or as a few, of the graph's: see the table in `docs/imports.md`.
    fn apply(&mut self, opcode: Opcode, values: [Option<NodeId>; 2], at: Range<usize>) -> Result<NodeId, Error> {
        let divisor = match opcode {
            Opcode::Binary(Binary::Div) | Opcode::Mod => values[1].and_then(|b| self.graph.exact(b)),
            _ => None,
        };
        if divisor.is_some_and(Zero::is_zero) {
            let error = self.error(ErrorKind::DivisionByZero, at, "division by a constant that is exactly 0");
            return Err(error.with_help("the formula would be defined nowhere"));
        }
        let g = &mut self.graph;
        Ok(match (opcode, values) {
            (Opcode::Axis(axis), _) => g.axis(axis),
            (Opcode::Unary(op), [Some(a), _]) => g.unary(op, a),
            (Opcode::Binary(op), [Some(a), Some(b)]) => g.binary(op, a, b),
            (Opcode::Ceil, [Some(a), _]) => {
                let a = g.unary(Unary::Neg, a);
                let floor = g.unary(Unary::Floor, a);
                g.unary(Unary::Neg, floor)
            }
            // Halves go away from 0, as `f32::round` has it: sign(a) floor(|a| + 1/2).
            (Opcode::Round, [Some(a), _]) => {
                let (sign, size) = (g.unary(Unary::Sign, a), g.unary(Unary::Abs, a));
                let half = g.rational(BigRational::new(1.into(), 2.into()));
                let sum = g.binary(Binary::Add, size, half);
                let floor = g.unary(Unary::Floor, sum);
                g.binary(Binary::Mul, sign, floor)
            }
            (Opcode::Not, [Some(a), _]) => is_zero(g, a),
            // The remainder of Euclid, from 0 to |b|: a - |b| floor(a / |b|).
            (Opcode::Mod, [Some(a), Some(b)]) => {
                let size = match g.exact(b) {
                    Some(q) if q.is_positive() => b,
                    _ => g.unary(Unary::Abs, b),
                };
                let quotient = g.binary(Binary::Div, a, size);
                let floor = g.unary(Unary::Floor, quotient);
                let whole = g.binary(Binary::Mul, size, floor);
                g.binary(Binary::Sub, a, whole)
            }
            (Opcode::Compare, [Some(a), Some(b)]) => {
                let difference = g.binary(Binary::Sub, a, b);
                g.unary(Unary::Sign, difference)
            }
            // a where a = 0, else b: b sign(a)^2.
            (Opcode::And, [Some(a), Some(b)]) => {
                let sign = g.unary(Unary::Sign, a);
                let nonzero = g.unary(Unary::Sqr, sign);
                g.binary(Binary::Mul, nonzero, b)
            }
            // a where a is not 0, else b: a + b (1 - sign(a)^2).
            (Opcode::Or, [Some(a), Some(b)]) => {
                let zero = is_zero(g, a);
                let rest = g.binary(Binary::Mul, zero, b);
                g.binary(Binary::Add, a, rest)
            }
            _ => unreachable!("the number of operands was checked"),
        })
    }
}

/// 1 where a = 0, else 0: `1 - sign(a)^2`.
fn is_zero(g: &mut Graph, a: NodeId) -> NodeId {
    let sign = g.unary(Unary::Sign, a);
    let (one, nonzero) = (g.integer(1), g.unary(Unary::Sqr, sign));
    g.binary(Binary::Sub, one, nonzero)
}
