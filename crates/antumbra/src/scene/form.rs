//! In which form is a formula drawn? A probe of each form's cost and tightness decides.
//!
//! All forms are the same real function on the same domain ([`Formula::forms`]), so every choice is sound, whatever numbers it
//! comes from; it decides only how much work a picture is. The probe uses no clock, no threads and nothing random: the same formula in the same
//! clip has the same form on every machine.
use crate::eval::{FanPiece, Inclusion, Workspace};
use crate::expr::{Binary, Formula, Unary, Writing};
use crate::geom::{Box3, Camera, Film, Vec3};
use crate::tape::{Op, Tape};
use antumbra_interval::Interval;
use antumbra_interval::affine::Affine;

/// Frusta of the first round, along each side of the film and of the way through the clip.
const FIRST: usize = 8;
/// Rounds; each halves what is left in all three directions.
const ROUNDS: usize = 3;
/// From where the probe looks, in half sizes of the clip: two directions that no symmetry maps to each other.
const EYES: [Vec3; 2] = [Vec3([2.6, -4.3, 2.9]), Vec3([-4.6, -1.7, -3.1])];
/// Forms whose evaluation costs more than this many times that of the written one are not probed.
const DEAREST: f64 = 1.3;
/// A form is chosen if its work is less than this share of the written form's.
const MARGIN: f64 = 0.9;
/// What an evaluation costs beside its operations: searches, clips, memory.
const OVERHEAD: f64 = 24.0;
/// A form whose enclosures of points are this many times as wide is not chosen, cheap though it be: deep searches end at rounding.
const COARSEST: f64 = 4.0;

/// A form, and how it came about.
pub(super) struct Chosen {
    pub(super) writing: Writing,
    pub(super) tape: Tape,
}

/// The form with the least work in those bounds; `None` where none is better than the written one by a margin, or nothing is known.
pub(super) fn choose(formula: &Formula, written: &Tape, bounds: &Box3) -> Option<Chosen> {
    let cost = cost(written);
    let forms = formula.forms();
    let mut tapes: Vec<Chosen> = vec![];
    for (writing, form) in forms {
        let tape = Tape::compile(&form.repeated_squares()).ok()?;
        let known = |t: &Tape| t.clauses() == tape.clauses() && t.constants() == tape.constants();
        if self::cost(&tape) <= DEAREST * cost && !known(written) && !tapes.iter().any(|c| known(&c.tape)) {
            tapes.push(Chosen { writing, tape });
        }
    }
    if tapes.is_empty() {
        return None;
    }
    let probe = Probe::new(bounds)?;
    let mut work = Workspace::default();
    let reference = probe.ask(written, usize::MAX, &mut work);
    let most = (MARGIN * reference.work(cost)).floor();
    let mut best: Option<(f64, Chosen)> = None;
    for chosen in tapes {
        let own = self::cost(&chosen.tape);
        let limit = best.as_ref().map_or(most, |(w, _)| *w);
        let found = probe.ask(&chosen.tape, (limit / own) as usize, &mut work);
        if found.work(own) < limit && found.width <= COARSEST * reference.width {
            best = Some((found.work(own), chosen));
        }
    }
    best.map(|(_, chosen)| chosen)
}

/// About what one evaluation costs, in additions of affine forms.
fn cost(tape: &Tape) -> f64 {
    OVERHEAD + tape.clauses().iter().map(|clause| weight(clause.op)).sum::<f64>()
}

fn weight(op: Op) -> f64 {
    match op {
        Op::Constant(_) | Op::Axis(_) => 0.5,
        Op::Unary(Unary::Neg) => 0.5,
        Op::Binary(Binary::Add | Binary::Sub) => 1.0,
        Op::Unary(Unary::Sqr) => 2.5,
        Op::Binary(Binary::Mul) => 3.5,
        // Lane by lane: linear approximations over a range.
        Op::Unary(_) | Op::Powi(_) | Op::Binary(_) => 15.0,
    }
}

/// Where the probe looks.
struct Probe {
    pieces: Vec<Piece>,
}

#[derive(Clone, Copy)]
struct Piece {
    film: Film,
    x: Interval,
    y: Interval,
    t: Interval,
}

/// What was found.
struct Found {
    evaluations: usize,
    /// Sum of the widths of enclosures of points near the surface.
    width: f64,
}

impl Found {
    fn work(&self, cost: f64) -> f64 {
        self.evaluations as f64 * cost
    }
}

impl Piece {
    fn asked(&self) -> FanPiece {
        FanPiece { fan: self.film.fan_of(self.x, self.y), t: self.t }
    }

    fn parts(self) -> impl Iterator<Item = Self> {
        let half = |i: Interval, k: usize| {
            let mid = i.mid();
            if k == 0 { Interval::new(i.lo(), mid) } else { Interval::new(mid, i.hi()) }
        };
        (0..8).map(move |k| Self {
            x: half(self.x, k & 1),
            y: half(self.y, k >> 1 & 1),
            t: half(self.t, k >> 2),
            ..self
        })
    }

    fn middle(&self) -> Box3 {
        let at = |i: Interval| Interval::point(i.mid());
        self.film.fan_of(at(self.x), at(self.y)).box_at(at(self.t)).mid().to_box()
    }
}

impl Probe {
    /// `None` for a clip without bounds.
    fn new(bounds: &Box3) -> Option<Self> {
        let half = bounds.half_extent();
        let radius = half.0.into_iter().fold(0.0, f64::max);
        if !(radius > 0.0 && radius < 1e9 && bounds.mid().length() < 1e12) {
            return None;
        }
        let mut pieces = vec![];
        for from in EYES {
            let eye = bounds.mid() + from * radius;
            let distance = from.length() * radius;
            let reach = half.length();
            let angle = 2.0 * core_math::asin((reach / distance).min(0.9)).to_degrees();
            let film = Film { camera: Camera::look_at(eye, bounds.mid(), angle, 1.0), width: 1, height: 1 };
            let part = |lo: f64, hi: f64, k: usize| {
                let at = |k: usize| lo + (hi - lo) * (k as f64 / FIRST as f64);
                Interval::new(at(k), at(k + 1))
            };
            for k in 0..FIRST * FIRST * FIRST {
                let (i, j, l) = (k % FIRST, k / FIRST % FIRST, k / FIRST / FIRST);
                let (x, y) = (part(-1.0, 1.0, i), part(-1.0, 1.0, j));
                let piece = Piece { film, x, y, t: part(distance - reach, distance + reach, l) };
                if film.fan_of(x, y).box_at(piece.t).intersection(*bounds).is_some() {
                    pieces.push(piece);
                }
            }
        }
        Some(Self { pieces })
    }

    /// Searches for the surface by halving what may hold some of it, and counts. It stops beyond `most` evaluations.
    fn ask(&self, f: &Tape, most: usize, work: &mut Workspace) -> Found {
        let mut found = Found { evaluations: 0, width: 0.0 };
        let mut pieces = self.pieces.clone();
        for round in 0.. {
            found.evaluations += pieces.len();
            if found.evaluations > most {
                return found;
            }
            let questions: Vec<FanPiece> = pieces.iter().map(Piece::asked).collect();
            let mut answers = vec![Affine::ZERO; questions.len()];
            f.beams(&questions, &mut answers, work);
            let mut left = answers.iter();
            pieces.retain(|_| left.next().is_some_and(|form| form.range().possibly_zero()));
            if round == ROUNDS - 1 {
                break;
            }
            pieces = pieces.into_iter().flat_map(Piece::parts).collect();
        }
        for piece in pieces.iter().step_by(pieces.len() / 64 + 1) {
            found.width += f.range(&piece.middle(), work).width();
        }
        found
    }
}
