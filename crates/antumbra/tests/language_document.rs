//! Every example of `docs/language.md` is true.
use antumbra::expr::Formula;
use antumbra::tape::Tape;

const DOCUMENT: &str = include_str!("../../../docs/language.md");

/// The fenced blocks of one kind, with the number of their first line.
fn blocks(kind: &str) -> Vec<(usize, String)> {
    let mut out = vec![];
    let mut block: Option<(usize, String)> = None;
    let mut inside_other = false;
    for (number, line) in DOCUMENT.lines().enumerate() {
        match (line.strip_prefix("```"), &mut block) {
            (Some(_), Some(_)) => out.extend(block.take()),
            (Some(_), None) if inside_other => inside_other = false,
            (Some(info), None) if info == kind => block = Some((number + 2, String::new())),
            (Some(_), None) => inside_other = true,
            (None, Some((_, text))) => {
                text.push_str(line);
                text.push('\n');
            }
            (None, None) => {}
        }
    }
    assert!(block.is_none() && !inside_other, "a block is not closed");
    out
}

fn parse(text: &str, line: usize) -> Formula {
    Formula::parse(text).unwrap_or_else(|e| panic!("docs/language.md, line {line}:\n{}", e.render(text)))
}

#[test]
fn every_formula_is_one() {
    let blocks = blocks("formula");
    assert!(blocks.len() >= 6, "{}", blocks.len());
    for (line, text) in blocks {
        Tape::compile(&parse(&text, line)).unwrap();
    }
}

#[test]
fn both_ways_to_write_a_formula_are_one_formula() {
    let mut pairs = 0;
    for (line, block) in blocks("means") {
        for (k, row) in block.lines().enumerate() {
            let (left, right) = row.split_once(" means ").unwrap_or_else(|| panic!("line {}: {row}", line + k));
            let (a, b) = (parse(left, line + k), parse(right, line + k));
            assert_eq!(a, b, "docs/language.md, line {}", line + k);
            pairs += 1;
        }
    }
    assert!(pairs >= 20, "{pairs}");
}

#[test]
fn every_error_is_shown_as_it_is() {
    let blocks = blocks("error");
    assert!(blocks.len() >= 3, "{}", blocks.len());
    for (line, block) in blocks {
        let (text, shown) = block.split_once("\n\n").unwrap();
        let error = Formula::parse(text).expect_err(text);
        assert_eq!(error.render(text).trim_end(), shown.trim_end(), "docs/language.md, line {line}");
    }
}

/// No block of a kind that nobody tests.
#[test]
fn every_block_is_tested() {
    let fences = DOCUMENT.lines().filter(|line| line.starts_with("```")).count();
    let tested: usize = ["formula", "means", "error"].iter().map(|kind| blocks(kind).len()).sum();
    assert_eq!(fences, 2 * tested);
}

/// The tables name every function.
#[test]
fn every_function_is_in_the_document() {
    for name in [
        "sin",
        "cos",
        "tan",
        "sec",
        "csc",
        "cot",
        "asin",
        "arcsin",
        "acos",
        "arccos",
        "atan",
        "arctan",
        "atan2",
        "arctan2",
        "sinh",
        "cosh",
        "tanh",
        "exp",
        "ln",
        "log",
        "log10",
        "log2",
        "sqrt",
        "cbrt",
        "abs",
        "sign",
        "sgn",
        "floor",
        "ceil",
        "min",
        "max",
        "mod",
        "pow",
        "powr",
        "union",
        "intersection",
        "difference",
        "smooth_union",
        "smooth_intersection",
        "smooth_difference",
        "translate",
        "rotate",
        "scale",
        "sphere",
        "torus",
        "box",
        "cylinder",
    ] {
        let written = [format!("`{name}("), format!("`{name}`")].iter().any(|w| DOCUMENT.contains(w.as_str()));
        assert!(written, "{name}");
    }
}
