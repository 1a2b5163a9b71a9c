//! Surfaces of unions, as the surfaces of their parts.
use super::Object;
use crate::eval::{Inclusion, Workspace};
use crate::expr::{Binary, Unary};
use crate::geom::{Clip, Vec3};
use crate::tape::{Op, Tape};
use std::sync::Arc;

/// More parts than these stay together.
const MOST: usize = 250;

impl Object {
    /// Objects that together show what this one shows from `eye`, and cast the same shadows: the parts of a union. `None` if it is none, if
    /// that is not proved, or if the parts together are much longer.
    ///
    /// Let `f = min(f_1, .., f_n)`, defined and continuous everywhere (or a maximum, and all signs below the opposite ones). *Suppose*
    ///
    /// 1. f has no zero in the region but inside the clip, and the region reaches beyond the clip on all sides, so that what lies between
    ///    their borders is connected; f > 0 at one of its points, hence at all.
    /// 2. The eye is outside of the clip, or f > 0 there.
    ///
    /// *Then* a ray from the eye comes into the clip, if at all, with f > 0 (through what lies between), or begins there with f > 0. Until
    /// it meets the surface for the first time all `f_i >= f > 0`, and where it does, some `f_i = 0`. So the first meeting with any
    /// `{f_i = 0}` inside the clip is the first meeting with `{f = 0}`, and there `f_i` is positive before.
    ///
    /// A segment from there to a light is free if f > 0 on it, that is if all `f_i > 0`; a part of it with f < 0 has some `f_i < 0`. With
    /// f >= 0, f and some `f_i` vanish together. And between the borders all `f_i > 0`, so for the parts as well the clip cuts
    /// nothing away.
    ///
    /// Only smooth parts are taken apart (without choices of their own). Faces of boxes often lie in one plane: two parts that vanish together along
    /// a face would leave open which one is met, where their minimum is a plain hit.
    #[must_use]
    pub(crate) fn parts(&self, eye: Vec3) -> Option<Vec<Self>> {
        let tape = self.surface.as_tape().filter(|tape| tape.is_continuous_everywhere())?;
        let (Clip::Box(clip), Clip::Box(region)) = (self.clip(), self.region()) else { return None };
        let beyond = |k: usize| region[k].lo() < clip[k].lo() && clip[k].hi() < region[k].hi();
        if !(0..3).all(|k| beyond(k) && region[k].lo().is_finite()) {
            return None;
        }
        let mut work = Workspace::default();
        // Whether f > 0 at a point; `None` where neither that nor f < 0 is proved.
        let mut positive = |at: Vec3| match tape.range(&at.to_box(), &mut work) {
            f if f.certainly_positive() => Some(true),
            f if f.certainly_negative() => Some(false),
            _ => None,
        };
        let corner = Vec3(std::array::from_fn(|k| region[k].lo()));
        let outside = positive(corner)?;
        let inside_clip = (0..3).all(|k| clip[k].contains(eye[k]));
        if inside_clip && positive(eye) != Some(outside) {
            return None;
        }
        // What parts have in common is done for each of them.
        let terms = tape.terms(if outside { Binary::Min } else { Binary::Max }, MOST, 2 * tape.clauses().len())?;
        if terms.len() < 2 || !terms.iter().all(smooth) {
            return None;
        }
        let part = |term: Tape| {
            let mut part = self.clone();
            part.surface = Arc::new(term);
            part
        };
        Some(terms.into_iter().map(part).collect())
    }
}

/// Whether no operation chooses.
fn smooth(tape: &Tape) -> bool {
    let chooses = |op: Op| {
        matches!(op, Op::Binary(Binary::Min | Binary::Max) | Op::Unary(Unary::Abs | Unary::Sign | Unary::Floor))
    };
    !tape.clauses().iter().any(|clause| chooses(clause.op))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;

    fn parts(formula: &str, eye: Vec3) -> Option<usize> {
        let scene = Scene::from_formula(formula).unwrap();
        scene.objects[0].parts(eye).map(|parts| parts.len())
    }

    const FAR: Vec3 = Vec3([9.0, 3.0, 2.0]);
    const THREE: &str = "min(x^2 + y^2 + z^2 - 1, min((x - 1)^2 + y^2 + z^2 - 1/2, x^2 + (y - 1)^2 + z^2 - 1/3))";

    #[test]
    fn unions_are_divided_where_that_is_the_same() {
        assert_eq!(parts(THREE, FAR), Some(3));
        // Turned inside out it is a maximum.
        assert_eq!(parts(&format!("-({THREE})"), FAR), Some(3));
        assert_eq!(parts("max(1 - x^2 - y^2 - z^2, 1/2 - (x - 1)^2 - y^2 - z^2)", FAR), Some(2));
        // A ball that is there twice, hidden from the rules of the language, is one part.
        let ball = "(x^2 + y^2 + z^2 - 1)";
        let other = "((x - 1)^2 + y^2 + z^2 - 1)";
        let twice = format!("min(min({ball}, {other}), min({ball}, (y - 1)^2 + x^2 + z^2 - 1))");
        assert_eq!(parts(&twice, FAR), Some(3));
        // Between two balls, inside of the clip.
        let apart = "min((x - 2)^2 + y^2 + z^2 - 1, (x + 2)^2 + y^2 + z^2 - 1)";
        assert_eq!(parts(apart, Vec3::default()), Some(2));
    }

    #[test]
    fn what_is_not_proved_stays_together() {
        // Faces in one plane.
        let boxes = "min(max(max(abs(x), abs(y)), abs(z)) - 1, max(max(abs(x - 1), abs(y)), abs(z)) - 1)";
        assert_eq!(parts(boxes, FAR), None);
        // From inside of one ball the wall of the other would be seen.
        assert_eq!(parts(THREE, Vec3([0.1, 0.2, 0.3])), None);
        // An intersection, and no union at all.
        assert_eq!(parts("max(x^2 + y^2 + z^2 - 1, (x - 1)^2 + y^2 + z^2 - 1)", FAR), None);
        assert_eq!(parts("x^2 + y^2 + z^2 - 1", FAR), None);
        // The clip cuts it open.
        assert_eq!(parts("min(x^2 + y^2 - 1, x^2 + z^2 - 1)", FAR), None);
        // Not defined everywhere.
        assert_eq!(parts("min(x^2 + y^2 + z^2 - 1, sqrt((x - 1)^2 + y^2 + z^2 - 1/9) - 1)", FAR), None);
        // The outside of everything is negative.
        assert_eq!(parts("min(1 - x^2 - y^2 - z^2, 2 - (x - 1)^2 - y^2 - z^2)", FAR), None);
    }

    #[test]
    fn parts_that_have_much_in_common_stay_together() {
        let common = "(x^2 + y^2)^2 + sin(x) cos(y) z + exp(-z^2) x + x^4 + y^4 + z^4";
        assert_eq!(parts(&format!("min({common} - 1, min({common} + x - 1.1, {common} + y - 1.2))"), FAR), None);
    }
}
