//! Surfaces from the files of other programs, and from plain text.
//!
//! | format | files | what is read |
//! |---|---|---|
//! | [`Format::Fidget`] | `.vm` | all opcodes but `rand` and `mix`, straight into the graph |
//! | [`Format::Surfer`] | `.jsurf` | equation, parameters, scale |
//! | [`Format::MathMod`] | `.json` | `Iso3D`: equations, constants, functions, box |
//! | [`Format::Formula`] | `.txt` | one formula of the language of [`crate::expr`] |
//!
//! A decimal in a file is that decimal, exactly. `docs/imports.md` has the grammars. Errors are those of formulas: they show the
//! place in the file and say what to do.
mod jsurf;
mod mathmod;
mod pieces;
mod plate;
mod solid;
mod vm;

use crate::expr::{self, Axis, ErrorKind, Formula, MAX_SOURCE};
use crate::geom::Clip;
use crate::scene::{self, Extent, Object, Scene, extent};
use std::path::Path;

/// A format of files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// The text format of Fidget: one operation a line.
    Fidget,
    /// Surface descriptions of SURFER and jSurf: Java properties.
    Surfer,
    /// Scripts of MathMod: JSON.
    MathMod,
    /// One formula.
    Formula,
}

impl Format {
    /// Every format with the extension of its files.
    pub const ALL: [(Self, &'static str); 4] =
        [(Self::Fidget, "vm"), (Self::Surfer, "jsurf"), (Self::MathMod, "json"), (Self::Formula, "txt")];

    /// The format that the extension of a file says, if it says one.
    #[must_use]
    pub fn of_path(path: &Path) -> Option<Self> {
        let extension = path.extension()?.to_str()?.to_ascii_lowercase();
        Self::ALL.into_iter().find(|(_, e)| *e == extension).map(|(format, _)| format)
    }

    /// The format that a text looks like, where no extension says it: a formula, if it looks like nothing else.
    #[must_use]
    pub fn of_content(text: &str) -> Self {
        let lines = || text.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with('#'));
        if text.trim_start().starts_with('{') {
            Self::MathMod
        } else if lines().any(|line| line.starts_with("surface_equation")) {
            Self::Surfer
        } else if lines().next().and_then(|line| line.split_whitespace().nth(1)).is_some_and(vm::is_opcode) {
            Self::Fidget
        } else {
            Self::Formula
        }
    }
}

/// Why a file is not a scene.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// What is written there cannot be read. The error's place is that in the file.
    #[error(transparent)]
    Text(#[from] expr::Error),
    /// It can be read, and not be compiled.
    #[error(transparent)]
    Scene(#[from] scene::Error),
}

/// What a file describes.
#[derive(Clone, Debug)]
struct Model {
    title: Option<String>,
    surfaces: Vec<Part>,
}

/// One surface of a file: the formula as written, and where it ends if the file says so.
#[derive(Clone, Debug)]
struct Part {
    formula: Formula,
    clip: Option<Clip>,
    /// What to show of a surface that has no end.
    open: Option<Clip>,
}

/// The scene in the text of a file. Camera and light are chosen to fit; `name` is the scene's.
///
/// A Fidget model that does not depend on z is a drawing: it becomes a plate of that outline, `max(f, |z| - h)`.
///
/// # Errors
/// See [`Error`]. Never panics, whatever the text.
///
/// Cost: linear in the text, and a search for where the surfaces are (a second or two).
pub fn scene(text: &str, format: Format, name: &str) -> Result<Scene, Error> {
    if text.len() > MAX_SOURCE {
        let message = format!("the file has {} bytes; the most is {MAX_SOURCE}", text.len());
        return Err(expr::Error::new(text, ErrorKind::TooLarge, 0..0, message).into());
    }
    let model = match format {
        Format::Fidget => vm::read(text)?,
        Format::Surfer => jsurf::read(text)?,
        Format::MathMod => mathmod::read(text)?,
        Format::Formula => Model {
            title: None,
            surfaces: vec![Part {
                formula: written(text, &Formula::parse_as_written(text)?, 0)?,
                clip: None,
                open: None,
            }],
        },
    };
    let title = model.title.unwrap_or_else(|| name.to_owned());
    if let (Format::Fidget, [Part { formula, .. }]) = (format, model.surfaces.as_slice())
        && !formula.uses(Axis::Z)
    {
        return Ok(plate::scene(formula, name, title)?);
    }
    let object = |part: &Part| {
        let object = Object::from_formula(&part.formula, Clip::Everywhere)?;
        let found = || match (extent(object.surface.as_ref()), part.open) {
            (Extent::Open(_), Some(open)) => open,
            (found, _) => Clip::Box(found.clip()),
        };
        let clip = part.clip.unwrap_or_else(found);
        Ok::<_, scene::Error>(object.with_clip(clip))
    };
    let objects = model.surfaces.iter().map(object).collect::<Result<Vec<_>, _>>()?;
    Ok(Scene::around(name.to_owned(), title, objects))
}

/// A formula of a file, checked: it must be defined somewhere, and its text short enough to be read again. `at` is its place in
/// the file.
fn written(text: &str, formula: &Formula, at: usize) -> Result<Formula, expr::Error> {
    if formula.simplify().divides_by_zero() {
        let error = expr::Error::new(text, ErrorKind::DivisionByZero, at..at, "a divisor is 0 everywhere");
        return Err(error.with_help("the formula would be defined nowhere"));
    }
    let length = formula.to_string().len();
    if length > MAX_SOURCE {
        let message = format!("written as a formula this has {length} bytes; the most is {MAX_SOURCE}");
        return Err(expr::Error::new(text, ErrorKind::TooLarge, at..at, message));
    }
    Ok(formula.clone())
}
