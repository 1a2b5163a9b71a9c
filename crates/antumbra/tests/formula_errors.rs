//! Every mistake has a message, a place and advice.
use antumbra::expr::{Error, ErrorKind, Formula, MAX_SOURCE};

#[track_caller]
fn error(text: &str) -> Error {
    match Formula::parse(text) {
        Ok(formula) => panic!("`{text}` was read as {formula}"),
        Err(error) => error,
    }
}

/// Text, kind, the text at the place, line, column, and what the message, expectation and help contain.
type Row<'a> = (&'a str, ErrorKind, &'a str, usize, usize, &'a str);

#[track_caller]
fn fails(rows: &[Row<'_>]) {
    for &(text, kind, place, line, column, says) in rows {
        let e = error(text);
        let got = (e.kind(), &text[e.span()], e.line(), e.column());
        assert_eq!(got, (kind, place, line, column), "{text}\n{}", e.render(text));
        assert!(e.to_string().contains(says), "{text}\n{}\ndoes not say {says}", e.render(text));
    }
}

#[test]
fn syntax() {
    use ErrorKind::Syntax;
    fails(&[
        ("x +", Syntax, "", 1, 4, "the formula ends after `+`; expected an expression"),
        ("x + * y", Syntax, "*", 1, 5, "`*` after `+`; expected an expression"),
        ("* x", Syntax, "*", 1, 1, "begins with `*`"),
        ("x = ", Syntax, "", 1, 4, "ends after `=`"),
        ("= x", Syntax, "=", 1, 1, "begins with `=`"),
        ("x 2", Syntax, "2", 1, 3, "write the product with `*`"),
        ("1.5.2", Syntax, ".2", 1, 4, "write the product with `*`"),
        ("()", Syntax, ")", 1, 2, "nothing between the parentheses"),
        ("x, y", Syntax, ",", 1, 2, "a comma outside"),
        ("x + 0,5", Syntax, ",", 1, 6, "the decimal point is `.`"),
        ("sin(x = y)", Syntax, "=", 1, 7, "`=` inside parentheses"),
        ("max(x,)", Syntax, ")", 1, 7, "`)` after `,`; expected an expression"),
        ("a = ; x", Syntax, "", 1, 4, "ends after `=`"),
        ("x^", Syntax, "", 1, 3, "ends after `^`"),
        ("x^2 + y^ + z", Syntax, "+", 1, 10, "expected"),
        ("y = 1 +\n\n)", ErrorKind::Parenthesis, ")", 3, 1, "closes nothing"),
        ("x ^^ y", Syntax, "^", 1, 4, "`^` after `^`"),
    ]);
}

#[test]
fn parentheses() {
    use ErrorKind::Parenthesis;
    fails(&[
        ("sin(x + (y - 1)", Parenthesis, "(", 1, 4, "never closed"),
        ("((x + 1)", Parenthesis, "(", 1, 1, "never closed"),
        ("x + 1)", Parenthesis, ")", 1, 6, "closes nothing"),
        ("a = (1 + 2; x", Parenthesis, "(", 1, 5, "never closed"),
        ("x +\n  (y", Parenthesis, "(", 2, 3, "add a `)`"),
    ]);
}

#[test]
fn stray_characters() {
    use ErrorKind::StrayCharacter;
    fails(&[
        ("x $ y", StrayCharacter, "$", 1, 3, "`$` has no meaning here"),
        ("[x]", StrayCharacter, "[", 1, 1, "group with parentheses"),
        ("|x|", StrayCharacter, "|", 1, 1, "abs("),
        ("x < 1", StrayCharacter, "<", 1, 3, "use `=`"),
        ("x + ∞", StrayCharacter, "∞", 1, 5, "not a real number"),
        ("√x + \u{1}", StrayCharacter, "\u{1}", 1, 6, "U+0001"),
        ("x . y", StrayCharacter, ".", 1, 3, "0.5"),
        ("é = 2\n日本 + 😀", StrayCharacter, "😀", 2, 6, "no meaning"),
    ]);
}

#[test]
fn names() {
    use ErrorKind::{Arguments, NotReal, Redefinition, UnknownName};
    fails(&[
        ("x + sqr(y)", UnknownName, "sqr", 1, 5, "did you mean `sqrt`?"),
        ("x + sqroot(y)", UnknownName, "sqroot", 1, 5, "unknown function `sqroot`"),
        ("smoth_union(x, y, 1)", UnknownName, "smoth_union", 1, 1, "did you mean `smooth_union`?"),
        ("Sin(x)", UnknownName, "Sin", 1, 1, "did you mean `sin`?"),
        ("X + 1", UnknownName, "X", 1, 1, "did you mean `x`?"),
        ("x + a", UnknownName, "a", 1, 5, "define it before: `a = 0.5; ...`"),
        ("radius = 2; x = raduis", UnknownName, "raduis", 1, 17, "did you mean `radius`?"),
        ("x2 + y2", UnknownName, "x2", 1, 1, "write the power `x^2`"),
        ("xyw", UnknownName, "xyw", 1, 1, "unknown name `xyw`"),
        ("siin(x) = 0", UnknownName, "siin", 1, 1, "did you mean `sin`?"),
        ("x + nan", NotReal, "nan", 1, 5, "not a real number"),
        ("x + inf", NotReal, "inf", 1, 5, "not a real number"),
        ("x + Infinity", NotReal, "Infinity", 1, 5, "not a real number"),
        ("x = 1; y", Redefinition, "x", 1, 1, "is a coordinate"),
        ("pi = 3; x", Redefinition, "pi", 1, 1, "constant of the language"),
        ("sin(t) = t; x", Redefinition, "sin", 1, 1, "function of the language"),
        ("a = 1; a = 2; x", Redefinition, "a", 1, 8, "already defined"),
        ("f(t, t) = t; x", Redefinition, "t", 1, 6, "two parameters"),
        ("sin x", Arguments, "sin", 1, 1, "write `sin(x)`"),
        ("sin^2(x)", Arguments, "sin", 1, 1, "`sin(x)^2`"),
        ("a = a + 1; x", UnknownName, "a", 1, 5, "unknown name"),
        ("f(t) = g(t); g(t) = t; f(x)", UnknownName, "g", 1, 8, "unknown function"),
    ]);
}

#[test]
fn arguments() {
    use ErrorKind::Arguments;
    fails(&[
        ("sin(x, y)", Arguments, "sin(x, y)", 1, 1, "`sin` takes 1 argument, not 2"),
        ("x + sin()", Arguments, "sin()", 1, 5, "takes 1 argument, not 0"),
        ("atan2(y)", Arguments, "atan2(y)", 1, 1, "atan2(y, x)"),
        ("f(t) = t; f(x, y)", Arguments, "f(x, y)", 1, 11, "`f` takes 1 argument, not 2"),
        ("union()", Arguments, "union()", 1, 1, "at least 1 argument"),
        ("scale(x, 1, 2)", Arguments, "scale(x, 1, 2)", 1, 1, "2 or 4 arguments"),
        ("g(t) = cos(t, 1); x", Arguments, "cos(t, 1)", 1, 8, "1 argument"),
    ]);
}

#[test]
fn statements() {
    use ErrorKind::{Empty, EqualsTwice, Statement};
    fails(&[
        ("", Empty, "", 1, 1, "the formula is empty"),
        (" \n\t# nothing\n ;", Empty, "", 1, 1, "write an equation"),
        ("x = y = z", EqualsTwice, "=", 1, 7, "a second `=`"),
        ("a = 1 = 2; x", EqualsTwice, "=", 1, 7, "a second `=`"),
        ("x + 1; y", Statement, "x + 1", 1, 1, "only the last statement"),
        ("a = 0.5", Statement, "a", 1, 1, "only defines `a`"),
        ("f(t) = t^2", Statement, "f", 1, 1, "only defines `f`"),
    ]);
}

#[test]
fn constants() {
    use ErrorKind::{DivisionByZero, Exponent, Number};
    fails(&[
        ("x/0", DivisionByZero, "0", 1, 3, "exactly 0"),
        ("x/(0.1 + 0.2 - 0.3)", DivisionByZero, "0.1 + 0.2 - 0.3", 1, 4, "exactly 0"),
        ("x + 0^-1", DivisionByZero, "-1", 1, 7, "exactly 0"),
        ("a = 1; y/(z - z)", DivisionByZero, "y/(z - z)", 1, 8, "0 everywhere"),
        ("mod(x, 0)", DivisionByZero, "mod(x, 0)", 1, 1, "exactly 0"),
        ("scale(x, 0)", DivisionByZero, "scale(x, 0)", 1, 1, "exactly 0"),
        ("smooth_union(x, y, 0)", DivisionByZero, "smooth_union(x, y, 0)", 1, 1, "exactly 0"),
        ("x + 1e999999999", Number, "1e999999999", 1, 5, "too large"),
        ("x + 1e99999999999999999999", Number, "1e99999999999999999999", 1, 5, "too large"),
        ("x + 1e-401", Number, "1e-401", 1, 5, "1e-400"),
        ("x^3000000000", Exponent, "3000000000", 1, 3, "2147483647"),
    ]);
    let digits = format!("x + {}", "1".repeat(2001));
    assert_eq!((error(&digits).kind(), error(&digits).column()), (Number, 5));
}

#[test]
fn excerpts() {
    let text = "a = 1\nx^2 + sqr(y) = a";
    assert_eq!(
        error(text).render(text),
        "error: unknown function `sqr`\n  |\n2 | x^2 + sqr(y) = a\n  |       ^^^\n  |\n  = help: did you mean `sqrt`?"
    );
    let text = "x +";
    assert_eq!(
        error(text).render(text),
        "error: the formula ends after `+`\n  |\n1 | x +\n  |    ^ expected an expression"
    );
    // One huge line: a short excerpt around the place.
    let text = format!("{}y w {}", "x + ".repeat(1000), "+ x".repeat(1000));
    let shown = error(&text).render(&text);
    assert!(shown.contains("x + y w + x") && shown.len() < 400, "{shown}");
    // Places of several bytes and lines, tabs, the empty text.
    for text in ["", "é\té", "(\n\n√√√", "x\n+\n\n\n💥", "ππ ππ ππq", "sin(\n\n)", "\t\tx )"] {
        assert!(error(text).render(text).starts_with("error: "), "{text}");
    }
}

#[test]
fn huge_inputs_are_errors_or_work() {
    let large = "x+".repeat(5 * MAX_SOURCE);
    assert_eq!(error(&large).kind(), ErrorKind::TooLarge);

    // The largest text: half a million operations.
    let sum = "x+".repeat(MAX_SOURCE / 2 - 1) + "y";
    assert_eq!(Formula::parse(&sum).unwrap().graph().nodes().len(), MAX_SOURCE / 2 + 2);

    // Exact sums of many different denominators grow: an error instead of minutes.
    let sum: String = (0..100_000).map(|k| format!("1e-{}+", 10 + k % 89)).collect();
    assert_eq!(error(&(sum + "x")).kind(), ErrorKind::TooLarge);

    // f_k doubles: 2^60 operations.
    let mut text = "f0(t) = sin(t) + cos(t)\n".to_owned();
    for k in 1..60 {
        text += &format!("f{k}(t) = f{}(f{}(t + {k}))\n", k - 1, k - 1);
    }
    text += "f59(x)";
    let e = error(&text);
    assert_eq!((e.kind(), e.line()), (ErrorKind::TooLarge, 61));

    let deep = format!("{}x{}", "translate(".repeat(20_000), ", 1, 0, 0)".repeat(20_000));
    assert!(
        Formula::parse(&deep).is_ok_and(|f| f.to_string() == "x - 20000") || error(&deep).kind() == ErrorKind::TooLarge
    );
}

#[test]
fn deep_nesting_works() {
    const DEPTH: usize = 100_000;
    let check = |text: String| {
        let formula = Formula::parse(&text).unwrap_or_else(|e| panic!("{}", e.render(&text)));
        let printed = formula.to_string();
        assert_eq!(Formula::parse(&printed).unwrap(), formula);
        assert!(formula.surface().formula().graph().nodes().len() <= formula.graph().nodes().len());
        assert!(!formula.derivative(antumbra::expr::Axis::X).formula().graph().nodes().is_empty());
        antumbra::tape::Tape::compile(&formula).unwrap();
        antumbra::tape::Tape::compile(&Formula::parse_as_written(&text).unwrap()).unwrap();
    };
    let nested = |open: &str, inner: &str, close: &str| open.repeat(DEPTH) + inner + &close.repeat(DEPTH);
    check(nested("(", "x", ")"));
    check(nested("-", "x", ""));
    check(nested("sin(", "x", ")"));
    check(nested("√", "x", ""));
    check(nested("2^", "x", ""));
    check(nested("x+(", "y", ")"));
    check(nested("(", "x", "+y)"));
    check(nested("1/(1+", "x", ")"));
    check(nested("abs(x-", "y", ")"));
    check(nested("", "x", "^2"));
    // A chain of definitions, each calling the one before.
    let mut chain = "f0(t) = t + x\n".to_owned();
    for k in 1..DEPTH / 4 {
        chain += &format!("f{k}(t) = f{}(t) + y\n", k - 1);
    }
    check(chain + &format!("f{}(z)", DEPTH / 4 - 1));
}

#[test]
fn nasty_texts_never_panic() {
    const PARTS: &[&str] = &[
        "x",
        "y",
        "z",
        "a",
        "sin",
        "sqrt",
        "(",
        ")",
        "(",
        ")",
        "+",
        "-",
        "*",
        "/",
        "^",
        "**",
        "=",
        ";",
        "\n",
        ",",
        "2",
        ".5",
        "1e3",
        "1e",
        "e",
        "pi",
        "√",
        "²",
        "⁻",
        "é",
        "π",
        "#",
        "0",
        "_",
        ".",
        " ",
        "f(t)=t;",
        "a=2;",
        "\u{feff}",
        "min(",
        "translate(",
        "1e-999",
        "nan",
        "\0",
        "😀",
    ];
    let mut random = fastrand::Rng::with_seed(1);
    let mut read = 0;
    for _ in 0..20_000 {
        let text: String = (0..random.usize(1..14)).map(|_| PARTS[random.usize(..PARTS.len())]).collect();
        match Formula::parse(&text) {
            Ok(formula) => {
                read += 1;
                assert_eq!(Formula::parse(&formula.to_string()).unwrap(), formula, "{text:?}");
            }
            Err(e) => {
                assert!(text.get(e.span()).is_some(), "{text:?} {e}");
                assert!(e.render(&text).starts_with("error: "));
            }
        }
    }
    assert!(read > 200, "only {read} of the texts were formulas");
}
