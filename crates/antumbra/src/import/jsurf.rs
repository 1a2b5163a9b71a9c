//! Surface descriptions of SURFER and jSurf: Java properties.
//!
//! Read are `surface_equation`, `surface_parameter_NAME` and `scale_factor`: SURFER shows the inside of a ball of radius
//! `10^scale_factor` about the origin.
use super::pieces::Pieces;
use super::{Model, Part, written};
use crate::expr::{Error, ErrorKind};
use crate::geom::{Clip, Vec3};
use std::ops::Range;

/// A property: key, its place, and the value's characters with their places.
struct Property<'a> {
    key: &'a str,
    at: Range<usize>,
    value: Vec<(String, usize)>,
}

impl Property<'_> {
    fn text(&self) -> String {
        self.value.iter().map(|(piece, _)| piece.as_str()).collect()
    }
}

/// Reads a file.
pub(super) fn read(file: &str) -> Result<Model, Error> {
    let properties = properties(file);
    let Some(equation) = properties.iter().rfind(|p| p.key == "surface_equation") else {
        let error = Error::new(file, ErrorKind::Empty, 0..0, "there is no `surface_equation` in this file");
        return Err(error.with_help("a .jsurf file has a line such as `surface_equation=x^2+y^2+z^2-1`"));
    };
    let mut pieces = Pieces::of(file);
    for p in &properties {
        let Some(name) = p.key.strip_prefix("surface_parameter_") else { continue };
        let value: Vec<(&str, usize)> = p.value.iter().map(|(piece, at)| (piece.as_str(), *at)).collect();
        pieces.define((name, p.at.end - name.len()), "", &value);
    }
    equation.value.iter().for_each(|(piece, at)| pieces.expression(piece, *at));
    let formula = written(file, &pieces.formula()?, equation.at.start)?;
    let clip = match properties.iter().rfind(|p| p.key == "scale_factor") {
        None => Clip::Ball { center: Vec3::default(), radius: 1.0 },
        Some(p) => {
            let factor = p.text().trim().parse::<f64>().ok().filter(|f| f.abs() <= 6.0).ok_or_else(|| {
                let error = Error::new(file, ErrorKind::Number, p.at.clone(), "the scale is no number from -6 to 6");
                error.with_help("the part that is shown is a ball of radius 10^scale_factor")
            })?;
            let radius = core_math::pow(10.0, factor);
            Clip::Ball { center: Vec3::default(), radius }
        }
    };
    Ok(Model { title: None, surfaces: vec![Part { formula, clip: Some(clip), open: None }] })
}

/// The properties of a file: `key=value` or `key:value`, `#` and `!` begin comments, `\` escapes the next character.
fn properties(file: &str) -> Vec<Property<'_>> {
    let (mut found, mut begin) = (vec![], 0);
    for line in file.split_inclusive('\n') {
        let at = begin;
        begin += line.len();
        let body = line.trim_end();
        let indent = body.len() - body.trim_start().len();
        let body = &body[indent..];
        if body.starts_with(['#', '!']) {
            continue;
        }
        let Some(end) = body.find(['=', ':']) else { continue };
        let key = body[..end].trim_end();
        let key_at = at + indent..at + indent + key.len();
        let mut value: Vec<(String, usize)> = vec![];
        let (mut piece, mut from) = (String::new(), at + indent + end + 1);
        let mut escaped = false;
        for (i, c) in body[end + 1..].char_indices() {
            if !escaped && c == '\\' {
                escaped = true;
                value.push((std::mem::take(&mut piece), from));
                from = at + indent + end + 1 + i + 1;
                continue;
            }
            escaped = false;
            piece.push(c);
        }
        value.push((piece, from));
        found.push(Property { key, at: key_at, value });
    }
    found
}
