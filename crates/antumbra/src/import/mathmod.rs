//! Scripts of MathMod: the implicit surfaces (`Iso3D`) of a JSON file.
//!
//! Every entry of `Fxyz` is a surface in the box of the entries of `Xmin` to `Zmax` of the same number. `Const` are definitions;
//! a function of `Funct` has the parameters x, y, z and t. The time t is 0.
use super::pieces::Pieces;
use super::{Model, Part, written};
use crate::eval::value_at;
use crate::expr::{Axis, Error, ErrorKind, Formula};
use crate::geom::{Box3, Clip, Vec3};
use crate::tape::Tape;
use antumbra_interval::Interval;
use serde_json::Value;
use std::ops::Range;

/// Reads a file.
pub(super) fn read(file: &str) -> Result<Model, Error> {
    let value: Value = serde_json::from_str(file).map_err(|e| {
        let at = place(file, e.line(), e.column());
        Error::new(file, ErrorKind::Syntax, at..at, format!("this is not JSON: {e}"))
    })?;
    let script = Script { file, iso: iso(file, &value)? };
    let equations = script.list("Fxyz")?;
    if equations.is_empty() {
        let error = Error::new(file, ErrorKind::Empty, script.key("Fxyz"), "the script has no equation");
        return Err(error.with_help("`Fxyz` is a list of formulas in x, y and z"));
    }
    if script.iso.get("Cnd").is_some() {
        let error = Error::new(file, ErrorKind::Unsupported, script.key("Cnd"), "conditions cannot be imported");
        return Err(error.with_help("the clip of a scene file may do: a box or a ball"));
    }
    let limits = ["Xmin", "Xmax", "Ymin", "Ymax", "Zmin", "Zmax"].map(|key| script.list(key));
    let mut surfaces = vec![];
    for (k, equation) in equations.iter().enumerate() {
        let formula = script.formula(equation)?;
        let at = script.string(equation).start;
        let mut sides = [Interval::ENTIRE; 3];
        let mut bounded = true;
        for (axis, side) in sides.iter_mut().enumerate() {
            let mut limit = [0.0; 2];
            for (end, limit) in limit.iter_mut().enumerate() {
                match limits[2 * axis + end].as_ref().map_err(Clone::clone)?.get(k) {
                    Some(text) => *limit = script.number(text)?,
                    None => bounded = false,
                }
            }
            if bounded {
                *side = Interval::try_new(limit[0], limit[1]).filter(|s| s.lo() < s.hi()).ok_or_else(|| {
                    let message = format!("the box is empty: from {} to {}", limit[0], limit[1]);
                    Error::new(file, ErrorKind::Number, at..at, message)
                })?;
            }
        }
        let clip = bounded.then_some(Clip::Box(Box3(sides)));
        surfaces.push(Part { formula: written(file, &formula, at)?, clip, open: None });
    }
    let title = script.list("Name")?.first().map(|name| (*name).to_owned());
    Ok(Model { title, surfaces })
}

/// Byte of a line and column, both from 1.
fn place(file: &str, line: usize, column: usize) -> usize {
    let start: usize = file.split_inclusive('\n').take(line.saturating_sub(1)).map(str::len).sum();
    let mut at = (start + column.saturating_sub(1)).min(file.len());
    while !file.is_char_boundary(at) {
        at -= 1;
    }
    at
}

/// The object of an implicit surface: `Iso3D`, alone or as the first one in a collection.
fn iso<'a>(file: &str, value: &'a Value) -> Result<&'a Value, Error> {
    let models = value.get("MathModels").and_then(Value::as_array);
    let found = value.get("Iso3D").or_else(|| models?.iter().find_map(|model| model.get("Iso3D")));
    found.ok_or_else(|| {
        let parametric = ["Param3D", "Param4D"].into_iter().any(|key| file.contains(key));
        let message = "there is no implicit surface (`Iso3D`) in this file";
        let error = Error::new(file, ErrorKind::Empty, 0..0, message);
        error.with_help(if parametric {
            "parametric surfaces are no zero sets: they cannot be imported"
        } else {
            "a script is `{\"Iso3D\": {\"Fxyz\": [\"x^2 + y^2 + z^2 - 1\"]}}`"
        })
    })
}

struct Script<'a> {
    file: &'a str,
    iso: &'a Value,
}

impl<'a> Script<'a> {
    /// Place of a key.
    fn key(&self, key: &str) -> Range<usize> {
        let quoted = format!("\"{key}\"");
        self.file.find(&quoted).map_or(0..0, |at| at..at + quoted.len())
    }

    /// Place of the inside of a string; the beginning of the file if it is written with escapes.
    fn string(&self, text: &str) -> Range<usize> {
        self.file.find(&format!("\"{text}\"")).map_or(0..0, |at| at + 1..at + 1 + text.len())
    }

    /// A list of strings, or a single one; empty if there is no such key.
    fn list(&self, key: &str) -> Result<Vec<&'a str>, Error> {
        let wrong = || {
            let message = format!("`{key}` must be a list of strings");
            Error::new(self.file, ErrorKind::Syntax, self.key(key), message)
        };
        match self.iso.get(key) {
            None => Ok(vec![]),
            Some(Value::String(one)) => Ok(vec![one]),
            Some(Value::Array(list)) => list.iter().map(|v| v.as_str().ok_or_else(wrong)).collect(),
            Some(_) => Err(wrong()),
        }
    }

    /// A formula that may use the script's constants and functions.
    fn formula(&self, text: &str) -> Result<Formula, Error> {
        let mut pieces = Pieces::of(self.file);
        pieces.add("t = 0; ");
        for (list, parameters) in [("Const", ""), ("Funct", "(x, y, z, t)")] {
            for definition in self.list(list)? {
                let at = self.string(definition).start;
                let Some((name, value)) = definition.split_once('=') else {
                    let error = Error::new(self.file, ErrorKind::Statement, at..at, "a definition without `=`");
                    return Err(error.with_help("constants are written `N=5`, functions `f=x^2+y^2`"));
                };
                pieces.define((name, at), parameters, &[(value, at + name.len() + 1)]);
            }
        }
        pieces.expression(text, self.string(text).start);
        pieces.formula()
    }

    /// The nearest number to a limit of the box.
    fn number(&self, text: &str) -> Result<f64, Error> {
        let formula = self.formula(text)?;
        let constant = [Axis::X, Axis::Y, Axis::Z].into_iter().all(|axis| !formula.uses(axis));
        let tape = Tape::compile(&formula).ok().filter(|_| constant);
        let value = tape.map(|tape| value_at(&tape, Vec3::default(), &mut vec![])).filter(|v| v.abs() <= 1e6);
        value.ok_or_else(|| {
            let at = self.string(text);
            Error::new(self.file, ErrorKind::Number, at, "a limit of the box must be a number up to 1e6")
        })
    }
}
