use super::{
    point::{Value, value, values},
    random::{point, text},
};
use crate::expr::{Axis, ErrorKind, Formula};
use fastrand::Rng;
use num_rational::BigRational;
use num_traits::{Signed, Zero};

/// Random formulas, as written and simplified; those that are no formulas (division by 0) are left out.
fn formulas(seed: u64, count: usize, mut check: impl FnMut(&mut Rng, &str, Formula, Formula)) {
    let mut random = Rng::with_seed(seed);
    let mut checked = 0;
    while checked < count {
        let size = random.usize(1..12);
        let text = text(&mut random, size);
        if text.len() > 4000 {
            continue;
        }
        match (Formula::parse_as_written(&text), Formula::parse(&text)) {
            (Ok(written), Ok(simple)) => {
                checked += 1;
                check(&mut random, &text, written, simple);
            }
            (_, Err(e)) | (Err(e), _) => {
                assert!(matches!(e.kind(), ErrorKind::DivisionByZero | ErrorKind::Exponent), "{}", e.render(&text));
            }
        }
    }
}

fn same(a: &Value, b: &Value) -> bool {
    match (a, b) {
        (Value::Unclear, _) | (_, Value::Unclear) => true,
        (Value::Undefined, Value::Undefined) => true,
        (Value::Exact(a), Value::Exact(b)) => a == b,
        (Value::Undefined, _) | (_, Value::Undefined) => false,
        (a, b) => {
            let (a, b) = (a.float().unwrap(), b.float().unwrap());
            (a - b).abs() <= 1e-4 * (1.0 + a.abs().max(b.abs()))
        }
    }
}

#[test]
fn simplification_keeps_value_and_domain() {
    let (mut exact, mut undefined, mut float, mut changed) = (0, 0, 0, 0);
    formulas(1, 12_000, |random, text, written, simple| {
        changed += usize::from(simple.graph().nodes().len() < written.graph().nodes().len());
        for _ in 0..6 {
            let p = point(random);
            let (before, after) = (value(&written, &p), value(&simple, &p));
            assert!(same(&before, &after), "{text}\n{written}\n{simple}\nat {p:?}: {before:?} became {after:?}");
            match before {
                Value::Exact(_) => exact += 1,
                Value::Undefined => undefined += 1,
                Value::Float(_) => float += 1,
                Value::Unclear => {}
            }
        }
    });
    eprintln!("exact {exact}, undefined {undefined}, float {float}, changed {changed}");
    assert!(exact > 5000 && undefined > 5000 && float > 5000 && changed > 1000, "the samples must meet every case");
}

#[test]
fn the_surface_is_the_same_set() {
    let (mut zeros, mut steps) = (0, 0);
    formulas(2, 12_000, |random, text, written, _| {
        // Half of the formulas as they are, half wrapped in what the pass removes.
        let wrapped = match random.u32(..14) {
            0 => format!("({text})^2"),
            1 => format!("-3*abs({text})^3"),
            2 => format!("sqrt({text}) - 2"),
            3 => format!("sqrt({text})"),
            4 => format!("({text})*(x - y)*({text})^2*abs(x - y)"),
            5 => format!("cbrt({text})/exp(x)"),
            6 => format!("powr({text}, 1.5)"),
            7 => format!("sqrt({text})*(x - 1)^2*sqrt({text})"),
            8 => format!("0.5 - sqrt({text})"),
            9 => format!("1/({text})*(x + y)^2"),
            _ => text.to_owned(),
        };
        let Ok(formula) = Formula::parse_as_written(&wrapped) else { return };
        let surface = formula.surface();
        steps += usize::from(!surface.steps().is_empty());
        for _ in 0..8 {
            let p = point(random);
            let (before, after) = (value(&formula, &p), value(surface.formula(), &p));
            let on = |v: &Value| match v {
                Value::Exact(q) => Some(q.is_zero()),
                Value::Undefined => Some(false),
                Value::Float(v) if v.abs() > 1e-3 => Some(false),
                Value::Float(_) | Value::Unclear => None,
            };
            if let (Some(a), Some(b)) = (on(&before), on(&after)) {
                zeros += usize::from(a);
                assert_eq!(a, b, "{wrapped}\n{}\nat {p:?}: {before:?} became {after:?}", surface.formula());
            }
        }
        let _ = written;
    });
    eprintln!("zeros {zeros}, steps {steps}");
    assert!(zeros > 2000 && steps > 3000);
}

#[test]
fn facts_are_true() {
    let mut proved = [0; 4];
    formulas(3, 8000, |random, text, written, simple| {
        for formula in [&written, &simple] {
            for _ in 0..4 {
                let p = point(random);
                for (i, value) in values(formula.graph(), formula.root(), &p).iter().enumerate() {
                    let facts = formula.graph().facts(formula.graph().id(i));
                    let context = || format!("{text}\n{formula}\nnode {i} at {p:?}: {value:?} {facts:?}");
                    let sign = match value {
                        Value::Exact(q) => (!q.is_negative(), !q.is_zero()),
                        Value::Float(v) => (*v > -1e-6, true),
                        Value::Undefined => {
                            assert!(!facts.total, "{}", context());
                            continue;
                        }
                        Value::Unclear => continue,
                    };
                    assert!(sign.0 || !facts.nonnegative, "{}", context());
                    assert!(sign.1 || !facts.nonzero, "{}", context());
                    assert!(facts.total || !facts.continuous, "{}", context());
                    let known = [facts.total, facts.continuous, facts.nonnegative, facts.nonzero];
                    proved.iter_mut().zip(known).for_each(|(n, k)| *n += usize::from(k));
                }
            }
        }
    });
    assert!(proved.iter().all(|&n| n > 10_000), "{proved:?}");
}

#[test]
fn continuous_functions_have_no_jumps() {
    let mut checked = 0;
    formulas(4, 8000, |random, text, _, simple| {
        if !simple.is_continuous_everywhere() {
            return;
        }
        let p = point(random);
        let step = BigRational::new(1.into(), 1_000_000_000.into());
        let q = p.clone().map(|c| c + &step);
        if let (Some(a), Some(b)) = (value(&simple, &p).float(), value(&simple, &q).float()) {
            checked += 1;
            // A cube root changes by 1e-3 over 1e-9, the cube root of it by 0.1.
            assert!((a - b).abs() <= 0.2 * (1.0 + a.abs()), "{text}\n{simple}\n{p:?} {a} {b}");
        }
    });
    assert!(checked > 1000, "{checked}");
}

#[test]
fn printed_text_reads_back_as_the_same_formula() {
    formulas(5, 10_000, |_, text, written, simple| {
        let printed = written.to_string();
        let back = Formula::parse_as_written(&printed).unwrap_or_else(|e| panic!("{text}\n{}", e.render(&printed)));
        assert_eq!(back, written, "{text}\n{printed}");
        let printed = simple.to_string();
        let back = Formula::parse_as_written(&printed).unwrap_or_else(|e| panic!("{text}\n{}", e.render(&printed)));
        assert_eq!(back.to_string(), printed, "{text}");
    });
}

#[test]
fn large_shared_formulas_are_printed_with_definitions() {
    let mut text = "f0 = x + y\n".to_owned();
    for k in 1..40 {
        text += &format!("f{k} = sin(f{0})*cos(f{0}) + f{0}/3\n", k - 1);
    }
    let formula = Formula::parse(&(text + "f39")).unwrap();
    let printed = formula.to_string();
    assert!(printed.starts_with("t1 = ") && printed.len() < 4000, "{}", printed.len());
    assert_eq!(Formula::parse(&printed).unwrap(), formula);
}

#[test]
fn derivatives_agree_with_finite_differences() {
    let mut compared = 0;
    formulas(6, 6000, |random, text, _, simple| {
        let axis = random.usize(..3);
        let derivative = simple.derivative([Axis::X, Axis::Y, Axis::Z][axis]);
        if derivative.has_kinks() {
            return;
        }
        // Off the lattice on which borders of domains lie.
        let p = [(); 3].map(|()| BigRational::new(random.i32(-3000..3000).into(), 1009.into()));
        let at = |offset: f64| {
            let mut q = p.clone();
            q[axis] += BigRational::from_float(offset).unwrap();
            value(&simple, &q).float()
        };
        // Two steps: where they disagree the function is too wild there for differences.
        let (h, k) = (1e-4, 5e-5);
        let (Some(a), Some(b), Some(c), Some(d)) = (at(-h), at(h), at(-k), at(k)) else { return };
        let (coarse, fine) = ((b - a) / (2.0 * h), (d - c) / (2.0 * k));
        let scale = 1.0 + fine.abs();
        if (coarse - fine).abs() > 1e-4 * scale || a.abs().max(b.abs()) > 1e3 {
            return;
        }
        if let Some(slope) = value(derivative.formula(), &p).float() {
            compared += 1;
            assert!(
                (slope - fine).abs() <= 2e-3 * scale,
                "{text}\n{simple}\n{}\n{p:?} {slope} {fine}",
                derivative.formula()
            );
        }
    });
    assert!(compared > 2000, "{compared}");
}
