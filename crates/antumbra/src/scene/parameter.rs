//! Numbers of a scene that can be moved: those of `[parameters]`, and those that a formula's text defines.
use super::{FileError, SceneFile, SurfaceEntry};
use crate::eval::{Inclusion, Workspace};
use crate::expr::{Formula, definitions};
use crate::geom::Box3;
use crate::tape::Tape;
use antumbra_interval::Interval;
use num_rational::BigRational;
use num_traits::ToPrimitive;

impl SceneFile {
    /// The file of one formula, framed automatically.
    #[must_use]
    pub fn of_formula(text: &str) -> Self {
        let formula = text.to_owned();
        Self {
            title: Some("Formula".to_owned()),
            surface: vec![SurfaceEntry { formula, ..SurfaceEntry::default() }],
            ..Self::default()
        }
    }

    /// Names that [`SceneFile::set`] knows: the parameters, then the definitions in formulas.
    #[must_use]
    pub fn parameter_names(&self) -> Vec<String> {
        let mut names: Vec<String> = self.parameters.keys().cloned().collect();
        for entry in &self.surface {
            for (name, _) in definitions(&entry.formula).unwrap_or_default() {
                if !names.contains(&name) {
                    names.push(name);
                }
            }
        }
        names
    }

    /// Gives a name another value where formulas define it: `a = 0.05` becomes `a = (0.1)`.
    ///
    /// # Errors
    /// [`FileError::Value`] where nothing of that name is defined.
    pub(super) fn redefine(&mut self, name: &str, value: f64) -> Result<(), FileError> {
        let mut found = false;
        for entry in &mut self.surface {
            for (_, place) in definitions(&entry.formula).unwrap_or_default().into_iter().filter(|(n, _)| n == name) {
                entry.formula.replace_range(place, &format!("({value:?})"));
                found = true;
            }
        }
        if found {
            return Ok(());
        }
        let known = self.parameter_names();
        let near = |k: &&String| strsim::damerau_levenshtein(name, k);
        let reason = match (known.is_empty(), known.iter().min_by_key(near).filter(|k| near(k) <= 1 + name.len() / 3)) {
            (true, _) => "the scene has no parameters".to_owned(),
            (_, Some(k)) => format!("there is no such parameter; did you mean `{k}`?"),
            _ => format!("there is no such parameter; the scene has {}", known.join(", ")),
        };
        Err(FileError::Value { key: format!("parameters.{name}"), reason })
    }
}

/// The number that a text stands for, a decimal or an expression of the formula language without x, y and z (`2pi`,
/// `sqrt(2)/2`), rounded.
///
/// # Errors
/// What is wrong with it, in words.
pub fn number(text: &str) -> Result<f64, String> {
    if let Ok(value) = text.trim().parse::<f64>() {
        return if value.is_finite() { Ok(value) } else { Err(format!("`{text}` is no finite number")) };
    }
    let refuse = || format!("`{text}` is no number: give one such as 0.05, 1/3 or 2pi");
    let formula = Formula::parse(text).map_err(|_| refuse())?;
    if let Some(value) = formula.graph().exact(formula.root()).and_then(BigRational::to_f64) {
        return if value.is_finite() { Ok(value) } else { Err(refuse()) };
    }
    let tape = Tape::compile(&formula).map_err(|_| refuse())?;
    let mut work = Workspace::default();
    // Wide where it is no constant, or none that is known well.
    let everywhere = Box3([Interval::new(-2.0, 3.0); 3]);
    let range = tape.range(&everywhere, &mut work);
    let known = !range.is_empty() && range.width() <= 1e-12 * range.mid().abs().max(1e-290);
    if known { Ok(range.mid()) } else { Err(refuse()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_may_be_written_as_expressions() {
        for (text, value) in [("0.05", 0.05), ("-1e-3", -1e-3), ("1/3", 1.0 / 3.0), ("0", 0.0), ("1-1", 0.0)] {
            assert_eq!(number(text).unwrap(), value, "{text}");
        }
        assert!((number("2pi").unwrap() - std::f64::consts::TAU).abs() < 1e-15);
        for bad in ["", "inf", "nan", "x", "a", "sqrt(-1)", "1/0", "1 2", "2 = 2 = 2", "10^400"] {
            assert!(number(bad).is_err(), "{bad}: {:?}", number(bad));
        }
    }

    #[test]
    fn definitions_in_formulas_can_be_moved() {
        let mut file = SceneFile::of_formula("r = 1; a = 2r\nx^2 + y^2 + z^2 = a^2");
        file.set("r", 0.25).unwrap();
        assert_eq!(file.surface[0].formula, "r = (0.25); a = 2r\nx^2 + y^2 + z^2 = a^2");
        file.set("a", -3.0).unwrap();
        assert_eq!(file.surface[0].formula, "r = (0.25); a = (-3.0)\nx^2 + y^2 + z^2 = a^2");
        assert!(file.scene("s").is_ok());
        let message = file.set("rr", 1.0).unwrap_err().to_string();
        assert_eq!(message, "parameters.rr: there is no such parameter; did you mean `r`?");
        let message = SceneFile::of_formula("x = 1").set("a", 1.0).unwrap_err().to_string();
        assert_eq!(message, "parameters.a: the scene has no parameters");
        assert!(file.set("a", f64::NAN).unwrap_err().to_string().contains("infinite"));
    }
}
