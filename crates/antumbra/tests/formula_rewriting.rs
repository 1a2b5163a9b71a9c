//! Zero sets, derivatives and rules by example; their properties are tested beside the code.
use antumbra::expr::{
    Axis, Formula,
    ZeroStep::{self, Abs, Distance, Factor, Power, Repeated, Root, Sign},
};

fn parse(text: &str) -> Formula {
    Formula::parse(text).unwrap_or_else(|e| panic!("{}", e.render(text)))
}

#[test]
fn surfaces() {
    let rows: &[(&str, &str, &[ZeroStep])] = &[
        ("(x^2 + y^2 + z^2 - 1)^2", "x^2 + y^2 + z^2 - 1", &[Power]),
        ("(x - y)^5 = 0", "x - y", &[Power]),
        ("abs(x - y)", "x - y", &[Abs]),
        ("-(x*y)", "x*y", &[Sign]),
        ("3(x + y)", "x + y", &[Factor]),
        ("pi(x + y)", "x + y", &[Factor]),
        ("sqrt(x - y)", "x - y", &[Root]),
        ("cbrt(x - y)", "x - y", &[Root]),
        ("powr(x - y, 1.5)", "x - y", &[Power]),
        ("-2abs(cbrt(x - y))^3", "x - y", &[Factor, Power, Abs, Root]),
        ("x*(x - y)*x", "x*(x - y)", &[Repeated]),
        ("(x - y)^2*z", "(x - y)*z", &[Power]),
        ("exp(x)*(y - z)", "y - z", &[Factor]),
        ("(y - z)/(1 + x^2)", "y - z", &[Factor]),
        ("sphere(1)", "x^2 + y^2 + z^2 - 1", &[Distance]),
        ("0.5 - sqrt(x)", "x - 0.25", &[Distance]),
        ("torus(1, 0.1)", "(sqrt(x^2 + y^2) - 1)^2 + z^2 - 0.01", &[Distance]),
        ("scale(sphere(1), 2)", "(0.5*x)^2 + (0.5*y)^2 + (0.5*z)^2 - 1", &[Factor, Distance]),
        // Must stay: each would gain or lose points.
        ("(y - z)/x", "(y - z)/x", &[]),
        ("sqrt(x)*y", "sqrt(x)*y", &[]),
        ("sqrt(x) + 1", "sqrt(x) + 1", &[]),
        ("sqrt(x)*y*sqrt(x)", "sqrt(x)*y", &[Repeated]),
        ("ln(x)*y", "ln(x)*y", &[]),
        ("x^-2", "x^-2", &[]),
        ("x^2 + y^2", "x^2 + y^2", &[]),
        ("min(x^2, y)", "min(x^2, y)", &[]),
        ("5", "5", &[]),
    ];
    for (text, wanted, steps) in rows {
        let surface = parse(text).surface();
        assert_eq!((surface.formula().to_string().as_str(), surface.steps()), (*wanted, *steps), "{text}");
    }
}

#[test]
fn a_product_that_doubles_at_every_level_stays_small() {
    let mut text = "f0 = x + y\n".to_owned();
    for k in 1..60 {
        text += &format!("f{k} = (f{0}*sin(x))*(f{0}*cos(y))\n", k - 1);
    }
    let surface = parse(&(text + "f59")).surface();
    assert_eq!(surface.formula().to_string(), "(x + y)*sin(x)*cos(y)");
}

#[test]
fn derivatives() {
    let rows = [
        ("x^3", "3*x^2"),
        ("x^2*y", "2*x*y"),
        ("sin(x)*y", "cos(x)*y"),
        ("sqrt(y)", "0"),
        ("sqrt(x)", "1/(2*sqrt(x))"),
        ("ln(x)", "1/x"),
        ("1/x", "-(1/x/x)"),
        ("exp(2x)", "exp(2*x)*2"),
        ("abs(x)", "sign(x)"),
        ("floor(x)", "0"),
        ("x^1.5", "1.5*x^0.5"),
    ];
    for (text, wanted) in rows {
        let derivative = parse(text).derivative(Axis::X);
        // Both sides simplified: the form of the result is no promise.
        assert_eq!(derivative.formula().simplify(), parse(wanted), "{text}: {}", derivative.formula());
    }
    assert!(parse("max(x, y)").derivative(Axis::X).has_kinks());
    assert!(!parse("max(z, y) + x^2").derivative(Axis::X).has_kinks());
}

/// Simplification rules, and what must not be one.
#[test]
fn rules() {
    let rows = [
        ("x + 0", "x"),
        ("0*x", "0"),
        ("0*ln(x)", "0*ln(x)"),
        ("ln(x) - ln(x)", "ln(x) - ln(x)"),
        ("0/(1 + x^2)", "0"),
        ("0/x", "0/x"),
        ("x/x", "x/x"),
        ("x^0", "1"),
        ("(1/x)^0", "(1/x)^0"),
        ("x*x", "x^2"),
        ("x*x*x*x", "x^4"),
        ("x^-2*x^3", "x^-2*x^3"),
        ("(x^-1)^-1", "(x^-1)^-1"),
        ("(x^-1)^3", "x^-3"),
        ("sqrt(x^2)", "abs(x)"),
        ("sqrt(x^4)", "x^2"),
        ("sqrt(x^6)", "abs(x^3)"),
        ("sqrt(x)^2", "sqrt(x)^2"),
        ("abs(x^2 + 1)", "x^2 + 1"),
        ("abs(-x)", "abs(x)"),
        ("abs(x)^2", "x^2"),
        ("abs(x)^3", "abs(x)^3"),
        ("cbrt(x^3)", "x"),
        ("cbrt(x)^3", "x"),
        ("exp(ln(x))", "exp(ln(x))"),
        ("ln(exp(x))", "x"),
        ("x^0.5", "sqrt(x)"),
        ("powr(x, 2)", "powr(x, 2)"),
        ("powr(2, 3)", "8"),
        ("1^x", "1"),
        ("1^ln(x)", "1^ln(x)"),
        ("2*(3*x)", "6*x"),
        ("x/4", "0.25*x"),
        ("x/10", "x/10"),
        ("x/0.1", "10*x"),
        ("sin(-x) + cos(-x)", "cos(x) - sin(x)"),
        ("x + -y", "x - y"),
        ("-(x - y)", "y - x"),
        ("min(x, x)", "x"),
        ("x*y + y*x", "2*(x*y)"),
    ];
    for (text, wanted) in rows {
        assert_eq!(parse(text).to_string(), wanted, "{text}");
    }
}
