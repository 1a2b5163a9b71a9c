//! What beams can meet: surfaces in their grids, and the floor.
use crate::eval::Workspace;
use crate::geom::Beam;
use crate::trace::{Cost, Search, Target, nearest, possibly_blocked};
use antumbra_interval::Interval;

/// Everything that can be hit.
pub struct World<'a> {
    /// The surfaces.
    pub targets: Vec<Target<'a>>,
    /// Height of the plane `z = floor`, if there is one.
    pub floor: Option<f64>,
}

/// What a beam may meet first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Find {
    /// Index in [`World::targets`]; the floor counts as one after the last.
    pub object: usize,
    /// Parameters of the meeting.
    pub t: Interval,
}

impl World<'_> {
    /// The nearest meeting at a parameter in `t`. `None` proves that no ray of the beam meets anything.
    pub fn nearest(
        &self,
        beam: &Beam,
        t: Interval,
        search: Search<'_>,
        work: &mut Workspace,
        cost: &mut Cost,
    ) -> Option<Find> {
        let mut best: Option<Find> = None;
        let mut offer = |find: Find| {
            if best.is_none_or(|b| find.t.lo() < b.t.lo()) {
                best = Some(find);
            }
        };
        let mut beams = Cost::default();
        for (object, target) in self.targets.iter().enumerate() {
            if let Some(t) = nearest(*target, beam, t, search, work, &mut beams) {
                offer(Find { object, t });
            }
        }
        if let Some(t) = self.floor_parameters(beam, t) {
            offer(Find { object: self.targets.len(), t });
        }
        // One beam, whatever it had to be tested against.
        *cost += Cost { beams: 1, evaluations: beams.evaluations };
        best
    }

    /// Whether the beam may be blocked at a parameter in `t`. `false` proves that it is not.
    pub fn possibly_blocked(
        &self,
        beam: &Beam,
        t: Interval,
        search: Search<'_>,
        work: &mut Workspace,
        cost: &mut Cost,
    ) -> bool {
        let mut beams = Cost::default();
        let blocked = self.floor_parameters(beam, t).is_some()
            || self.targets.iter().any(|target| possibly_blocked(*target, beam, t, search, work, &mut beams));
        *cost += Cost { beams: 1, evaluations: beams.evaluations };
        blocked
    }

    /// Parameters at which the beam may touch the floor: the plane needs no search.
    fn floor_parameters(&self, beam: &Beam, t: Interval) -> Option<Interval> {
        let t = beam.parameters_in(2, Interval::point(self.floor?)).intersection(t);
        (!t.is_empty()).then_some(t)
    }
}
