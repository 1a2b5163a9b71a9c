//! Searches in shafts: what tiles of hits see of a light, and where something may be in the way. Many tiles in lockstep, so that
//! evaluations come in batches.
use super::known::{Known, Part};
use super::occluders::{Front, Receiver, front, hides, no_zero};
use super::policy::{halves, long_in_shaft, shaft_slope_pays, size};
use super::shaft::Shaft;
use crate::eval::{ShaftPiece, ShaftPoint, Workspace};
use crate::geom::{Box3, Fan, Passage, Rect, axes};
use crate::trace::{Cost, Piece, Sign, Surface};
use antumbra_interval::Interval;
use antumbra_interval::affine::Affine;
use antumbra_interval::round::{add_up, sub_up};
use smallvec::SmallVec;

/// A tile of hits that asks for a light.
#[derive(Clone, Debug)]
pub struct Tile<'a> {
    /// Its hits.
    pub shaft: Shaft,
    /// The light.
    pub light: &'a Rect,
    /// What is known of it.
    pub known: &'a Known,
}

/// Scratch memory.
#[derive(Debug, Default)]
pub(super) struct Scratch {
    searches: Vec<Search>,
    active: Vec<usize>,
    asked: Asked,
    target: Option<Target>,
}

/// What is asked about one surface in a round, and the answers.
#[derive(Debug, Default)]
struct Asked {
    points: Vec<ShaftPiece>,
    slopes: Vec<ShaftPiece>,
    at_points: Vec<Affine<5>>,
    of_slopes: Vec<Affine<5>>,
}

/// The part of a light that was looked at last: one tile after another looks at the same one.
#[derive(Clone, Copy, Debug)]
struct Target {
    light: Rect,
    part: [Interval; 2],
    /// Its points, over (t, u, v, i, j).
    point: ShaftPoint,
    /// Its longest edge.
    width: f64,
}

impl Target {
    fn of(light: &Rect, part: [Interval; 2]) -> Self {
        let [u, v] = part;
        let width = size(light, u, v);
        let (u, v) = (Affine::<5>::spanning(1, u), Affine::<5>::spanning(2, v));
        let point = axes(|k| (u.mul_f64(light.edge_u[k]) + v.mul_f64(light.edge_v[k])).add_f64(light.center[k]));
        Self { light: *light, part, point, width }
    }

    fn shows(&self, light: &Rect, part: [Interval; 2]) -> bool {
        self.part == part && self.light == *light
    }
}

/// A piece that is being looked at.
#[derive(Clone, Copy, Debug)]
struct Look {
    piece: Piece,
    /// Whether it is the slope that tells.
    slope: bool,
}

/// The search of one tile.
#[derive(Debug)]
struct Search {
    known: Known,
    cost: Cost,
    /// `None` when all is done.
    asked: Option<Look>,
    /// So many of the open parts that the tile was told of are to be looked at, from the last one down.
    inherited: usize,
    /// Parts of one that was divided, and its pieces, to be looked at before these.
    quarters: SmallVec<[[Interval; 2]; 4]>,
    divided: SmallVec<[Piece; 4]>,
    beam: Beam,
}

/// The beams from all hits of a tile to a part of the light.
#[derive(Debug)]
struct Beam {
    /// `None` if it is settled.
    part: Option<[Interval; 2]>,
    /// Over (t, u, v, i, j).
    direction: [Affine<5>; 3],
    directions: Box3,
    /// Upper bound of the distances, in the largest axis.
    distance: f64,
    /// Longest edge of the part.
    width: f64,
    /// Of each surface.
    sides: SmallVec<[Side; 2]>,
    stack: Vec<Piece>,
    open: SmallVec<[Piece; 4]>,
}

/// What is known of a surface along a beam.
#[derive(Clone, Copy, Debug)]
struct Side {
    front: Option<Front>,
    passage: Passage,
}

/// Looks for the open parts of their lights from tiles of hits: tells what is then known to each, and what it cost, in their order.
///
/// In a piece in which a form of f (or of its slope from the hits) has the sign of the receivers' side, nothing is in the way of any hit; where
/// it has the other one on rays of every hit to every point, none sees anything. Pieces that are long beside the width of the shaft are halved, others stay
/// open. A light that is wide against the tile is divided once: then the hits inherit what is open of each quarter, or that nothing is.
///
/// The searches do not know of each other: the answer to a tile, and its cost, are the same in any company.
pub fn look(
    surfaces: &[Surface<'_>],
    tiles: &[Tile<'_>],
    scratch: &mut super::Scratch,
    work: &mut Workspace,
    mut found: impl FnMut(Known, Cost),
) {
    let Scratch { searches, active, asked, target } = &mut scratch.shafts;
    active.clear();
    searches.reserve(tiles.len().saturating_sub(searches.len()));
    for (k, tile) in tiles.iter().enumerate() {
        if searches.len() == k {
            searches.push(Search::new());
        }
        searches[k].begin(surfaces, tile, target, work);
        active.push(k);
    }
    loop {
        active.retain(|k| searches[*k].asked.is_some());
        if active.is_empty() {
            break;
        }
        for (surface, of) in surfaces.iter().enumerate() {
            asked.clear();
            for &k in active.iter() {
                if let Some(look) = searches[k].looks_at(surface) {
                    asked.push(&tiles[k].shaft, &searches[k].beam, look);
                }
            }
            asked.answer(of, work);
            let (mut at_points, mut of_slopes) = (asked.at_points.iter(), asked.of_slopes.iter());
            for &k in active.iter() {
                if let Some(look) = searches[k].looks_at(surface)
                    && let Some(form) = if look.slope { of_slopes.next() } else { at_points.next() }
                {
                    searches[k].looked(surfaces, &tiles[k], look.piece, *form, target, work);
                }
            }
        }
    }
    for search in &mut searches[..tiles.len()] {
        found(std::mem::take(&mut search.known), search.cost);
    }
}

impl Asked {
    fn clear(&mut self) {
        self.points.clear();
        self.slopes.clear();
    }

    fn push(&mut self, shaft: &Shaft, beam: &Beam, look: Look) {
        let piece = ShaftPiece { apex: shaft.apex, direction: beam.direction, t: look.piece.t };
        if look.slope { &mut self.slopes } else { &mut self.points }.push(piece);
    }

    fn answer(&mut self, surface: &Surface<'_>, work: &mut Workspace) {
        let Self { points, slopes, at_points, of_slopes } = self;
        at_points.resize(points.len(), Affine::UNKNOWN);
        of_slopes.resize(slopes.len(), Affine::UNKNOWN);
        surface.function.shafts(points, at_points, work);
        surface.function.shaft_slopes(slopes, of_slopes, work);
    }
}

impl Search {
    fn new() -> Self {
        let beam = Beam {
            part: None,
            direction: [Affine::ZERO; 3],
            directions: Box3([Interval::ZERO; 3]),
            distance: 0.0,
            width: 0.0,
            sides: SmallVec::new(),
            stack: Vec::new(),
            open: SmallVec::new(),
        };
        let (quarters, divided) = (SmallVec::new(), SmallVec::new());
        let (known, cost) = (Known::default(), Cost::default());
        Self { known, cost, asked: None, inherited: 0, quarters, divided, beam }
    }

    fn begin(&mut self, surfaces: &[Surface<'_>], tile: &Tile<'_>, target: &mut Option<Target>, work: &mut Workspace) {
        self.known = tile.known.settled_part();
        self.cost = Cost::default();
        self.inherited = tile.known.open.len();
        self.quarters.clear();
        self.beam.part = None;
        self.beam.stack.clear();
        self.go_on(surfaces, tile, target, work);
    }

    fn looks_at(&self, surface: usize) -> Option<Look> {
        self.asked.filter(|look| look.piece.surface == surface)
    }

    /// The next piece to look at, in this part of the light or in a later one.
    fn go_on(&mut self, surfaces: &[Surface<'_>], tile: &Tile<'_>, target: &mut Option<Target>, work: &mut Workspace) {
        self.asked = loop {
            if let Some(look) = self.beam.next(&tile.shaft) {
                self.cost.evaluations += 1;
                break Some(look);
            }
            self.part_done(tile);
            if !self.next_part(surfaces, tile, target, work) {
                break None;
            }
        };
    }

    /// Turns to the next part of the light, if there is one.
    fn next_part(
        &mut self,
        surfaces: &[Surface<'_>],
        tile: &Tile<'_>,
        target: &mut Option<Target>,
        work: &mut Workspace,
    ) -> bool {
        let (part, pieces) = if let Some(quarter) = self.quarters.pop() {
            (quarter, &self.divided[..])
        } else if self.inherited > 0 {
            self.inherited -= 1;
            let part = &tile.known.open[self.inherited];
            (part.part, &part.pieces[..])
        } else {
            return false;
        };
        self.cost.beams += 1;
        self.beam.turn(surfaces, tile, part, target, work, &mut self.cost);
        self.beam.stack.extend(pieces.iter().rev());
        true
    }

    /// All pieces of the part have been looked at: books it.
    fn part_done(&mut self, tile: &Tile<'_>) {
        let Some(part) = self.beam.part.take() else { return };
        let open = &self.beam.open;
        if open.is_empty() {
            self.known.lit(part);
        } else if self.known.whole() && tile.shaft.narrow_against(tile.light) {
            self.divided.clone_from(open);
            self.quarters.extend(self.known.divide(part));
        } else {
            self.known.open(Part { part, pieces: open.clone() });
        }
    }

    fn looked(
        &mut self,
        surfaces: &[Surface<'_>],
        tile: &Tile<'_>,
        piece: Piece,
        form: Affine<5>,
        target: &mut Option<Target>,
        work: &mut Workspace,
    ) {
        if !self.beam.looked(surfaces, &tile.shaft, piece, form, work, &mut self.cost) {
            self.known.shaded();
            self.beam.part = None;
            self.beam.stack.clear();
        }
        self.go_on(surfaces, tile, target, work);
    }
}

impl Beam {
    /// The next piece to look at.
    fn next(&mut self, shaft: &Shaft) -> Option<Look> {
        while let Some(Piece { surface, t }) = self.stack.pop() {
            let t = t.intersection(self.sides[surface].passage.outer);
            if !t.is_empty() {
                // At t = 0 only the slope tells anything.
                let slope = surface == shaft.surface && (shaft_slope_pays(t) || t.lo() == 0.0);
                return Some(Look { piece: Piece { surface, t }, slope });
            }
        }
        None
    }

    /// Turns it to a part of the light.
    fn turn(
        &mut self,
        surfaces: &[Surface<'_>],
        tile: &Tile<'_>,
        part: [Interval; 2],
        target: &mut Option<Target>,
        work: &mut Workspace,
        cost: &mut Cost,
    ) {
        let shaft = &tile.shaft;
        let target = match target {
            Some(target) if target.shows(tile.light, part) => target,
            other => other.insert(Target::of(tile.light, part)),
        };
        (self.part, self.width) = (Some(part), target.width);
        self.direction = axes(|k| target.point[k] - shaft.apex[k]);
        self.directions = Box3(self.direction.map(|d| d.range()));
        self.distance = (0..3).map(|k| self.directions[k].magnitude()).fold(0.0, f64::max);
        let receiver = Receiver { point: shaft.region, surface: shaft.surface, side: shaft.side };
        // What only other surfaces than that of the hits ask for.
        let mut fan = None;
        self.sides.clear();
        for (index, surface) in surfaces.iter().enumerate() {
            let front = if index == shaft.surface {
                Some(Front::of(&receiver))
            } else {
                let fan = fan.get_or_insert_with(|| Fan::towards(shaft.region, tile.light, part[0], part[1]));
                front(surface, &receiver, fan, work, cost)
            };
            self.sides.push(Side { front, passage: surface.passage(&shaft.region, &self.directions) });
        }
        self.open.clear();
    }

    /// Takes an answer in. `false`: no hit sees any of this part.
    fn looked(
        &mut self,
        surfaces: &[Surface<'_>],
        shaft: &Shaft,
        Piece { surface, t }: Piece,
        form: Affine<5>,
        work: &mut Workspace,
        cost: &mut Cost,
    ) -> bool {
        let (at, Side { front, passage }) = (&surfaces[surface], self.sides[surface]);
        let region = |t| Box3(axes(|k| shaft.region[k] + t * self.directions[k]));
        if !form.is_known() && no_zero(at.function, &region(t), work, cost) {
            return true;
        }
        let form = if front.is_some_and(|f| f.sign == Sign::Negative) { -form } else { form };
        let range = form.range();
        if range.certainly_positive() {
            return true;
        }
        let [along, rest @ ..] = *form.coefficients();
        let lowest_at = if along < 0.0 { t.hi() } else { t.lo() };
        let bottom = sub_up(form.centre(), along.abs());
        let top = rest.iter().fold(add_up(bottom, form.error()), |s, a| add_up(s, a.abs()));
        if top < 0.0 && hides(at, front, lowest_at, &passage, region, work) {
            return false;
        }
        if range.certainly_negative() {
            return !(surface == shaft.surface && t.lo() == 0.0);
        }
        if long_in_shaft(t, self.distance, self.width, shaft.extent) {
            let [near, far] = halves(t);
            let (first, second) = if along < 0.0 { (far, near) } else { (near, far) };
            self.stack.push(Piece { surface, t: second });
            self.stack.push(Piece { surface, t: first });
        } else {
            self.open.push(Piece { surface, t });
        }
        true
    }
}
