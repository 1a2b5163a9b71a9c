//! Rays of which it is proved where they first meet a surface: the place is enclosed, without the states that a search has.
use super::policy::{Effort, Reach};
use super::root::{Goal, Root};
use super::{Bracket, Cost, Meeting, Surface};
use crate::eval::{RayPiece, Workspace};
use crate::geom::Beam;
use antumbra_interval::Interval;
use antumbra_interval::affine::{Affine, Dual};

/// A ray and what is proved of its first root. On the bracket the ray is inside the surface's region.
#[derive(Clone, Copy, Debug)]
pub struct Bracketed {
    /// The ray, a thin beam.
    pub beam: Beam,
    /// What is proved.
    pub bracket: Bracket,
}

/// So many questions are asked together, if there are as many.
const COMPANY: usize = 64;

const UNKNOWN: Dual<1> = Dual { value: Affine::UNKNOWN, derivative: Affine::UNKNOWN };

/// Scratch memory: keep it, it only grows.
#[derive(Debug, Default)]
pub struct Brackets {
    questions: Questions,
    asked: Vec<(usize, Root)>,
    pieces: Vec<RayPiece>,
    values: Vec<Dual<1>>,
    ranges: Vec<Interval>,
}

/// What is to be asked next, and of which ray.
#[derive(Debug, Default)]
struct Questions {
    narrow: Vec<(usize, Root)>,
    middle: Vec<(usize, Root)>,
}

impl Questions {
    /// A ray's next question, or its answer.
    fn take(&mut self, k: usize, goal: Goal, found: &mut impl FnMut(usize, Option<Meeting>, Cost)) {
        let cost = |root: &Root| Cost { beams: 0, evaluations: u64::from(root.steps) };
        match goal {
            Goal::Narrow(root) => self.narrow.push((k, root)),
            Goal::Middle(root) => self.middle.push((k, root)),
            Goal::Proved(root) => found(k, Some(root.meeting()), cost(&root)),
            Goal::Unclear(root) => found(k, None, cost(&root)),
        }
    }
}

/// Encloses the first root of each ray: its meeting, and what that cost, in any order; the number is the ray's. `None` where the bracket may hold several
/// roots, of which the first must be looked for ([`first_meetings`](super::first_meetings)).
///
/// By the steps that [`first_meetings`](super::first_meetings) takes once it has a bracket. The rays do not know of each other: the answer for a ray, and its cost,
/// are the same in any company.
pub fn enclose(
    surfaces: &[Surface<'_>],
    rays: &[Bracketed],
    effort: Effort,
    scratch: &mut Brackets,
    work: &mut Workspace,
    mut found: impl FnMut(usize, Option<Meeting>, Cost),
) {
    let Brackets { questions, asked, pieces, values, ranges } = scratch;
    for (surface, of) in surfaces.iter().enumerate() {
        let mut waiting = rays.iter().enumerate().filter(|(_, ray)| ray.bracket.surface == surface);
        let bounds = of.clip.bounds();
        loop {
            // Either kind of question is asked as soon as there are enough of them, the last ones at the end.
            while questions.narrow.len() < COMPANY
                && let Some((k, Bracketed { bracket, .. })) = waiting.next()
            {
                let root = Root::new(*bracket, Interval::ENTIRE);
                questions.take(k, root.enclose(bracket.t, effort), &mut found);
            }
            let newton = questions.middle.len() >= COMPANY || questions.narrow.is_empty();
            asked.clear();
            asked.append(if newton { &mut questions.middle } else { &mut questions.narrow });
            if asked.is_empty() {
                break;
            }
            pieces.clear();
            pieces.extend(asked.iter().map(|(k, root)| {
                let t = root.bracket.t;
                let t = if newton { Interval::point(t.mid()) } else { t };
                RayPiece { ray: rays[*k].beam, t }
            }));
            if newton {
                ranges.resize(pieces.len(), Interval::ENTIRE);
                of.function.ranges(pieces, ranges, work);
                for ((k, root), range) in asked.iter().zip(&*ranges) {
                    questions.take(*k, root.stepped(*range, effort), &mut found);
                }
            } else {
                values.resize(pieces.len(), UNKNOWN);
                of.function.rays(pieces, values, work);
                for ((k, root), value) in asked.iter().zip(&*values) {
                    let reach = Reach::of(&bounds, rays[*k].beam.origin);
                    questions.take(*k, root.narrowed(value, reach, effort), &mut found);
                }
            }
        }
    }
}
