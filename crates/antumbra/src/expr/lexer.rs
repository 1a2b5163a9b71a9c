//! Text -> words with byte spans.
use super::{Error, ErrorKind};
use logos::Logos;
use num_bigint::BigInt;
use num_integer::Integer;
use num_rational::BigRational;
use num_traits::{Pow, Zero};
use std::ops::Range;

/// A token before names are resolved.
#[derive(Logos, Clone, Copy, Debug, PartialEq, Eq)]
#[logos(skip r"[ \t\r\f\u{a0}\u{2009}\u{feff}]+")]
#[logos(skip(r"#[^\n]*", allow_greedy = true))]
pub(crate) enum Word {
    #[regex(r"[0-9]+(\.[0-9]*)?([eE][+-]?[0-9]+)?")]
    #[regex(r"\.[0-9]+([eE][+-]?[0-9]+)?")]
    Number,
    #[regex(r"[\p{L}_][\p{L}0-9_]*")]
    Name,
    #[regex(r"⁻?[⁰¹²³⁴⁵⁶⁷⁸⁹]+")]
    Superscript,
    #[token("+")]
    Plus,
    #[token("-")]
    #[token("−")]
    Minus,
    #[token("*")]
    #[token("·")]
    #[token("⋅")]
    #[token("×")]
    Times,
    #[token("/")]
    #[token("÷")]
    Divide,
    #[token("^")]
    #[token("**")]
    Power,
    #[token("√")]
    Root,
    #[token("(")]
    Open,
    #[token(")")]
    Close,
    #[token(",")]
    Comma,
    #[token("=")]
    #[token("==")]
    Equals,
    #[token(";")]
    Semicolon,
    #[token("\n")]
    Newline,
}

/// A word and its place in bytes.
pub(crate) type Placed = (Word, Range<usize>);

/// The words of a text.
pub(crate) fn words(source: &str) -> Result<Vec<Placed>, Error> {
    let mut out = vec![];
    for (word, span) in Word::lexer(source).spanned() {
        match word {
            Ok(word) => out.push((word, span)),
            Err(()) => return Err(stray(source, span.start)),
        }
    }
    Ok(out)
}

fn stray(source: &str, at: usize) -> Error {
    let c = source[at..].chars().next().unwrap_or('?');
    let shown = if c.is_control() { format!("U+{:04X}", c as u32) } else { format!("`{c}`") };
    let error =
        Error::new(source, ErrorKind::StrayCharacter, at..at + c.len_utf8(), format!("{shown} has no meaning here"));
    match c {
        '[' | ']' | '{' | '}' => error.with_help("group with parentheses: `( )`"),
        '|' => error.with_help("write the absolute value as `abs(...)`"),
        '<' | '>' | '≤' | '≥' => error.with_help("a surface is an equation: use `=`"),
        '∞' => error.with_help("infinity is not a real number"),
        '.' => error.with_help("a decimal point needs a digit beside it: `0.5`"),
        '!' | '%' | '&' | '~' | '@' => {
            error.with_help("the operators are `+ - * / ^` and `=`; for a remainder write `mod(a, b)`")
        }
        _ => error,
    }
}

/// Most digits that a number may have.
const MAX_DIGITS: usize = 2000;
/// Largest absolute value of its exponent of ten. The largest `f64` is below 1e309.
const MAX_EXPONENT: i32 = 400;

/// Whether a text is a decimal literal, without a sign.
pub(crate) fn is_number(text: &str) -> bool {
    let mut words = Word::lexer(text);
    words.next() == Some(Ok(Word::Number)) && words.span() == (0..text.len())
}

/// Whether a text can be a name, and nothing else.
pub(crate) fn is_name(text: &str) -> bool {
    let mut words = Word::lexer(text);
    words.next() == Some(Ok(Word::Name)) && words.span() == (0..text.len())
}

/// The exact value of a decimal literal.
pub(crate) fn number(source: &str, span: Range<usize>) -> Result<BigRational, Error> {
    let text = &source[span.clone()];
    let (mantissa, exponent) = text.split_once(['e', 'E']).unwrap_or((text, "0"));
    let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    if whole.len() + fraction.len() > MAX_DIGITS {
        return Err(Error::new(source, ErrorKind::Number, span, format!("a number of more than {MAX_DIGITS} digits")));
    }
    let exponent =
        exponent.parse::<i32>().ok().filter(|e| e.unsigned_abs() <= MAX_EXPONENT as u32).ok_or_else(|| {
            Error::new(source, ErrorKind::Number, span, "the exponent of this number is too large")
                .with_help(format!("powers of ten go from 1e-{MAX_EXPONENT} to 1e{MAX_EXPONENT}"))
        })?;
    let digits = format!("{whole}{fraction}").parse::<BigInt>().unwrap_or_else(|_| BigInt::zero());
    // value = digits * 10^(exponent - digits after the point)
    let scale = exponent - fraction.len() as i32;
    let power = Pow::pow(BigInt::from(10), scale.unsigned_abs());
    Ok(if scale >= 0 {
        BigRational::from_integer(digits * power)
    } else if digits.is_zero() {
        BigRational::zero()
    } else {
        // The first step of Euclid's algorithm by hand: it makes the cost of the rest that of the digits, not of the power.
        let common = digits.gcd(&(&power % &digits));
        BigRational::new_raw(digits / &common, power / common)
    })
}

/// The value of a superscript such as `⁻²`.
pub(crate) fn superscript(source: &str, span: Range<usize>) -> Result<BigRational, Error> {
    let mut ascii = String::new();
    for c in source[span.clone()].chars() {
        ascii.push(match c {
            '⁻' => '-',
            '¹' => '1',
            '²' => '2',
            '³' => '3',
            // The others are consecutive: U+2070 is 0, U+2074 is 4, ..., U+2079 is 9.
            _ => char::from_digit(c as u32 - 0x2070, 10).unwrap_or('0'),
        });
    }
    if ascii.len() > MAX_DIGITS {
        return Err(Error::new(source, ErrorKind::Number, span, format!("a number of more than {MAX_DIGITS} digits")));
    }
    Ok(BigRational::from_integer(ascii.parse().unwrap_or_else(|_| BigInt::zero())))
}
