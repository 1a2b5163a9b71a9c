//! Parameters as sliders: their values, and between which values they slide.
use antumbra::{
    expr::definitions,
    scene::{Parameter, SceneFile, number},
};

/// A parameter that can be moved.
#[derive(Clone, Debug, PartialEq)]
pub struct Slider {
    /// Its name.
    pub name: String,
    /// Its value.
    pub value: f64,
    /// Least and greatest value. Where the file says nothing, some room on both sides of the first value.
    pub range: [f64; 2],
}

/// The sliders of a file. Those that were there keep their ranges, unless the value left them or the file says otherwise.
#[must_use]
pub fn sliders(file: &SceneFile, old: &[Slider]) -> Vec<Slider> {
    let mut found: Vec<Slider> = vec![];
    for (name, parameter) in &file.parameters {
        let value = parameter.value();
        let range = match parameter {
            Parameter::Ranged(r) => [r.min, r.max],
            Parameter::Value(_) => range(name, value, old),
        };
        found.push(Slider { name: name.clone(), value, range });
    }
    for entry in &file.surface {
        for (name, place) in definitions(&entry.formula).unwrap_or_default() {
            // What is defined by another parameter has no value of its own.
            let Ok(value) = number(&entry.formula[place]) else { continue };
            if !found.iter().any(|s| s.name == name) {
                let range = range(&name, value, old);
                found.push(Slider { name, value, range });
            }
        }
    }
    found
}

/// The old range while the value is inside; else from 0 to twice the value, or from -1 to 1 about 0.
fn range(name: &str, value: f64, old: &[Slider]) -> [f64; 2] {
    let kept = old.iter().find(|s| s.name == name).map(|s| s.range);
    if let Some([lo, hi]) = kept.filter(|[lo, hi]| (*lo..=*hi).contains(&value)) {
        return [lo, hi];
    }
    if value == 0.0 { [-1.0, 1.0] } else { [(2.0 * value).min(0.0), (2.0 * value).max(0.0)] }
}
