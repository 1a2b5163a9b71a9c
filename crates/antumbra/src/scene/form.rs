//! In which form is a formula drawn? A probe of each form's cost and tightness decides.
//!
//! All forms are the same real function on the same domain ([`Formula::forms`]), so every choice is sound, whatever rounded numbers it
//! comes from; it decides only how much work a picture is. The probe uses no clock, no threads and nothing random: the same formula in
//! the same clip has the same form on every machine.
//!
//! What a form is expected to take is the cost of an evaluation, a sum of weights of its operations, times the questions of a search, relative
//! to the written form: over pieces of two cameras' views, of six sizes, the share of those that stay open. Both were held against
//! whole pictures (`examples/forms.rs`); the expectation is within some 15 % of what they take.
use crate::eval::{FanPiece, Inclusion, Workspace};
use crate::expr::{Binary, Formula, Unary, Writing};
use crate::geom::{Box3, Camera, Film, Vec3};
use crate::tape::{Op, Tape};
use antumbra_interval::affine::Affine;
use antumbra_interval::{Decoration, Interval};

/// Pieces of the first round, along each side of the film and of the way through the clip.
const FIRST: usize = 4;
/// Rounds; each halves pieces in all three directions.
const ROUNDS: usize = 6;
/// Pieces that may hold some surface which are followed into the next round: fewer of dear formulas.
const FOLLOWED: [usize; 2] = [16, 48];
/// Operations that following them may take, in additions.
const WORK: f64 = 4000.0;
/// From where the probe looks, in half sizes of the clip: two directions that no symmetry of a cube maps to each other.
const EYES: [Vec3; 2] = [Vec3([2.6, -4.3, 2.9]), Vec3([-4.6, -1.7, -3.1])];
/// What an evaluation costs beside its operations: searches, clips, memory.
const OVERHEAD: f64 = 24.0;
/// Forms whose evaluation costs more than this many times that of the written one are not probed.
const DEAREST: f64 = 1.05;
/// A form is chosen if it is expected to take less than this share of the written form's work: near 1 nothing is known.
const MARGIN: f64 = 0.87;
/// What rounds to come are hoped to bring: the share of a form that is not given up.
const PROMISING: f64 = 0.7;
/// A form whose enclosures of points are this many times as wide is not chosen, cheap though it be: deep searches end at rounding.
const COARSEST: f64 = 2.0;

/// A form, and how it came about.
pub(super) struct Chosen {
    pub(super) writing: Writing,
    pub(super) tape: Tape,
}

/// The form with the least work in those bounds; `None` where none is better than the written one by a margin, or nothing is known.
///
/// Cost: one to six milliseconds, most of it for long formulas.
pub(super) fn choose(formula: &Formula, written: &Tape, bounds: &Box3) -> Option<Chosen> {
    let bounded = bounds.half_extent().0.iter().all(|half| (1e-9..1e9).contains(half));
    if !(bounded && bounds.mid().length() < 1e9) {
        return None;
    }
    let dearest = DEAREST * cost(written);
    let own = parts(written);
    let mut tapes: Vec<(Writing, Tape)> = vec![];
    for (writing, form) in formula.forms() {
        let Ok(tape) = Tape::compile(&form.repeated_squares()) else { continue };
        let new = || !tapes.iter().any(|(_, known)| known.clauses() == tape.clauses());
        // What is proved of the written form once and for all is not to be asked again and again.
        let lost = written.is_continuous_everywhere() && !tape.is_continuous_everywhere();
        if cost(&tape) <= dearest && !lost && new() && parts(&tape) != own {
            tapes.push((writing, tape));
        }
    }
    if tapes.is_empty() {
        return None;
    }
    let mut work = Workspace::default();
    let sample = Sample::new(written, bounds, &mut work);
    let mut best = (MARGIN * cost(written), None);
    for (writing, tape) in tapes {
        let own = cost(&tape);
        let effort = own * sample.questions(&tape, best.0 / own, &mut work);
        if effort < best.0 && sample.is_fine(&tape, &mut work) {
            best = (effort, Some(Chosen { writing, tape }));
        }
    }
    best.1
}

/// The operations and constants of a tape in a fixed order. Forms that have the same are the same sums in another order, not worth a
/// probe.
fn parts(tape: &Tape) -> (Vec<Op>, Vec<[u64; 2]>) {
    let kind = |op: Op| if let Op::Constant(_) = op { Op::Constant(0) } else { op };
    let mut ops: Vec<Op> = tape.clauses().iter().map(|clause| kind(clause.op)).collect();
    let mut constants: Vec<_> = tape.constants().iter().map(|c| [c.lo().to_bits(), c.hi().to_bits()]).collect();
    ops.sort_unstable();
    constants.sort_unstable();
    (ops, constants)
}

/// About what one evaluation costs, in additions of affine forms.
fn cost(tape: &Tape) -> f64 {
    OVERHEAD + tape.clauses().iter().map(|clause| weight(clause.op)).sum::<f64>()
}

fn weight(op: Op) -> f64 {
    match op {
        Op::Constant(_) | Op::Axis(_) | Op::Unary(Unary::Neg) => 0.5,
        Op::Binary(Binary::Add | Binary::Sub) => 1.0,
        Op::Unary(Unary::Sqr) => 2.5,
        Op::Binary(Binary::Mul) => 3.5,
        // In vectors, but for the lanes in which it is wide beside its distance from 0.
        Op::Powi(_) => 10.0,
        // Lane by lane: choices, and linear approximations over a range.
        Op::Unary(Unary::Abs | Unary::Sign | Unary::Floor) | Op::Binary(Binary::Min | Binary::Max) => 15.0,
        Op::Binary(Binary::Div) => 30.0,
        Op::Unary(_) | Op::Binary(Binary::Pow | Binary::Atan2) => 40.0,
    }
}

/// A part of a camera's view.
#[derive(Clone, Copy)]
struct Piece {
    film: Film,
    x: Interval,
    y: Interval,
    t: Interval,
}

impl Piece {
    fn asked(&self) -> FanPiece {
        FanPiece { fan: self.film.fan_of(self.x, self.y), t: self.t }
    }

    fn halves(self) -> impl Iterator<Item = Self> {
        let half = |i: Interval, upper: bool| {
            let mid = i.mid();
            if upper { Interval::new(mid, i.hi()) } else { Interval::new(i.lo(), mid) }
        };
        (0..8).map(move |k| Self {
            x: half(self.x, k & 1 > 0),
            y: half(self.y, k & 2 > 0),
            t: half(self.t, k & 4 > 0),
            ..self
        })
    }
}

/// Where the probe looks: at pieces of cameras' views, smaller from round to round, of which those are followed that may
/// hold some surface, as far as the written form knows.
struct Sample {
    rounds: Vec<Round>,
    /// Boxes of the smallest pieces, and what the written form proves of the function there.
    boxes: Vec<(Box3, Decoration)>,
    /// Sum of the widths of its enclosures of their middles.
    width: f64,
}

struct Round {
    pieces: Vec<FanPiece>,
    /// How many of them the written form leaves open.
    open: f64,
}

impl Sample {
    fn new(written: &Tape, bounds: &Box3, work: &mut Workspace) -> Self {
        let most = ((WORK / cost(written)) as usize).clamp(FOLLOWED[0], FOLLOWED[1]);
        let (mut pieces, mut rounds) = (first(bounds), vec![]);
        for round in 0..ROUNDS {
            if round > 0 {
                pieces = pieces.into_iter().flat_map(Piece::halves).collect();
            }
            let asked: Vec<FanPiece> = pieces.iter().map(Piece::asked).collect();
            let mut kept = open(written, &asked, work).into_iter();
            pieces.retain(|_| kept.next() == Some(true));
            let left = pieces.len();
            if left == 0 {
                break;
            }
            rounds.push(Round { pieces: asked, open: left as f64 });
            // Evenly from all of them.
            let followed = left.min(most);
            pieces = (0..followed).map(|k| pieces[k * left / followed]).collect();
        }
        let boxes = pieces.iter().map(|piece| piece.asked().fan.box_at(piece.t));
        let boxes: Vec<_> = boxes.map(|b| (b, written.decorated(&b, work).decoration)).collect();
        let width = width(written, &boxes, work);
        Self { rounds, boxes, width }
    }

    /// How many questions a search asks, as a share of those that the written form needs: the mean over the rounds of the pieces that
    /// stay open. Infinite as soon as it looks like `most` or more.
    fn questions(&self, f: &Tape, most: f64, work: &mut Workspace) -> f64 {
        let all = self.rounds.len() as f64;
        let (mut sum, mut rest) = (0.0, all);
        for round in &self.rounds {
            sum += open(f, &round.pieces, work).into_iter().filter(|open| *open).count() as f64 / round.open;
            rest -= 1.0;
            if sum + PROMISING * rest >= most * all {
                return f64::INFINITY;
            }
        }
        if all > 0.0 { sum / all } else { f64::INFINITY }
    }

    /// Whether a form is about as sharp at points, and proves as much of domain and continuity.
    fn is_fine(&self, f: &Tape, work: &mut Workspace) -> bool {
        let certain = f.is_continuous_everywhere()
            || self.boxes.iter().all(|(b, decoration)| f.decorated(b, work).decoration >= *decoration);
        certain && width(f, &self.boxes, work) <= COARSEST * self.width
    }
}

/// Which pieces may hold a zero.
fn open(f: &Tape, pieces: &[FanPiece], work: &mut Workspace) -> Vec<bool> {
    let mut forms = vec![Affine::ZERO; pieces.len()];
    f.beams(pieces, &mut forms, work);
    forms.iter().map(|form| form.range().possibly_zero()).collect()
}

fn width(f: &Tape, boxes: &[(Box3, Decoration)], work: &mut Workspace) -> f64 {
    boxes.iter().map(|(b, _)| f.range(&b.mid().to_box(), work).width()).sum()
}

/// Pieces that fill the bounds, seen from each eye.
fn first(bounds: &Box3) -> Vec<Piece> {
    let half = bounds.half_extent();
    let radius = half.0.into_iter().fold(0.0, f64::max);
    let part = |lo: f64, hi: f64, k: usize| {
        let at = |k: usize| lo + (hi - lo) * (k as f64 / FIRST as f64);
        Interval::new(at(k), at(k + 1))
    };
    let mut pieces = vec![];
    for from in EYES {
        let (distance, reach) = (from.length() * radius, half.length());
        let angle = 2.0 * core_math::asin(reach / distance).to_degrees();
        let camera = Camera::look_at(bounds.mid() + from * radius, bounds.mid(), angle, 1.0);
        let film = Film { camera, width: 1, height: 1 };
        for k in 0..FIRST * FIRST * FIRST {
            let (x, y) = (part(-1.0, 1.0, k % FIRST), part(-1.0, 1.0, k / FIRST % FIRST));
            let t = part(distance - reach, distance + reach, k / FIRST / FIRST);
            if film.fan_of(x, y).box_at(t).intersection(*bounds).is_some() {
                pieces.push(Piece { film, x, y, t });
            }
        }
    }
    pieces
}
