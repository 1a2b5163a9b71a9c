//! Of many boxes those in which a function may be 0.
use super::inclusion::centred;
use super::{Gradient, Inclusion, Workspace, centred_range};
use crate::geom::Box3;
use antumbra_interval::Interval;

/// Scratch memory: keep it, it only grows.
#[derive(Debug, Default)]
pub struct Sieve {
    gradients: Vec<Gradient>,
    points: Vec<Box3>,
    values: Vec<Gradient>,
}

const NOTHING_KNOWN: Gradient = Gradient { value: Interval::ENTIRE, partials: [Interval::ENTIRE; 3] };

impl Sieve {
    /// Keeps the boxes in which f may be 0, by its range and by the mean value form: what goes is proved to hold no zero. Two
    /// gradients for a box at most, in batches.
    pub fn retain(&mut self, f: &dyn Inclusion, regions: &mut Vec<Box3>, work: &mut Workspace) {
        self.gradients.resize(regions.len(), NOTHING_KNOWN);
        f.gradients(regions, &mut self.gradients, work);
        keep(regions, &mut self.gradients, |_, gradient| gradient.value.possibly_zero());
        if !f.continuous_everywhere() {
            return regions.retain(|region| centred_range(f, region, work).possibly_zero());
        }
        self.points.clear();
        self.points.extend(regions.iter().map(|region| region.mid().to_box()));
        self.values.resize(regions.len(), NOTHING_KNOWN);
        f.gradients(&self.points, &mut self.values, work);
        let mut middles = self.points.iter().zip(&self.values);
        keep(regions, &mut self.gradients, |region, gradient| {
            middles.next().is_none_or(|(mid, at)| centred(region, mid, at.value, gradient.partials).possibly_zero())
        });
    }
}

/// Keeps some boxes, and their gradients.
fn keep(regions: &mut Vec<Box3>, gradients: &mut Vec<Gradient>, mut wanted: impl FnMut(&Box3, &Gradient) -> bool) {
    let mut kept = 0;
    for k in 0..regions.len() {
        if wanted(&regions[k], &gradients[k]) {
            (regions[kept], gradients[kept]) = (regions[k], gradients[k]);
            kept += 1;
        }
    }
    regions.truncate(kept);
    gradients.truncate(kept);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::Formula;
    use crate::tape::Tape;

    /// Cells of a cube of half side 2 that remain.
    fn left(text: &str) -> Vec<Box3> {
        const CELLS: usize = 9;
        let tape = Tape::compile(Formula::parse(text).unwrap().surface().formula()).unwrap();
        let edge = |k: usize| {
            Interval::point(-2.0) + Interval::new(4.0 * k as f64, 4.0 * k as f64 + 4.0) / Interval::point(CELLS as f64)
        };
        let all = (0..CELLS).flat_map(|i| (0..CELLS).flat_map(move |j| (0..CELLS).map(move |k| (i, j, k))));
        let mut cells: Vec<Box3> = all.map(|(i, j, k)| Box3([edge(i), edge(j), edge(k)])).collect();
        Sieve::default().retain(&tape, &mut cells, &mut Workspace::default());
        cells
    }

    #[test]
    fn cells_that_a_sphere_crosses_stay_and_others_go() {
        // |p| = 1, also as a function that is not continuous everywhere.
        for text in ["x^2 + y^2 + z^2 = 1", "x^2 + y^2 + z^2 - floor(1.5 + x/10) = 0"] {
            let cells = left(text);
            assert!((80..300).contains(&cells.len()), "{text}: {}", cells.len());
            for k in 0..1000 {
                let (a, z) = (0.7 * f64::from(k), f64::from(k) / 500.0 - 1.0);
                let r = (1.0 - z * z).max(0.0).sqrt();
                let p = [r * core_math::cos(a), r * core_math::sin(a), z];
                assert!(cells.iter().any(|cell| (0..3).all(|i| cell[i].contains(p[i]))), "{text}: {p:?} is lost");
            }
        }
    }

    #[test]
    fn nothing_stays_of_what_has_no_zero_and_all_of_what_is_zero() {
        assert_eq!(left("x^2 + y^2 + z^2 + 1 = 0").len(), 0);
        assert_eq!(left("sqrt(x) + 1 = 0").len(), 0, "defined in a half, and positive there");
        assert_eq!(left("x - x + 0 * y = 0").len(), 729);
    }
}
