//! Primary visibility of the certified method: blocks of pixels that are divided until everything is proved or counted.
//!
//! Breadth first: all frusta of one size together, then the centre rays of all pixels together, and so on, so that
//! evaluations come in batches. No search knows of its neighbours, hence all results and costs are those of one pixel
//! after another.
mod centres;

use super::by_proof::{BLOCK, Block, indices};
use super::coverage::{Looking, Part, Window, outward};
use super::given::{Given, GivenPixel};
use super::pixel::{Edge, Hit, Known, Pixel};
use super::spare::Scratch;
use super::task::{Asked, Task};
use crate::eval::Occupancy;
use crate::geom::{Beam, Fan};
use crate::shadow::Receiver;
use crate::trace::{
    Cost, Effort, Frustum, Known as Open, Meeting, Patch, Piece, Ray, Surface, first_meetings, narrow, patches,
};
use smallvec::SmallVec;

/// Blocks up to this side whose frustum is covered by one simple piece are not divided further.
const SIMPLE: usize = 4;
/// A pixel that an edge crosses is divided this often, for the bounds of its coverage.
const COVERAGE_LEVELS: u32 = 2;
/// Cosine between normals within a pixel from which it is shown as one surface.
const PLAIN_NORMAL: f64 = 0.97;
/// Rays along each side of such a pixel, for its colour.
pub(super) const EDGE_RAYS: usize = 4;
/// Parts `(i, j)` of a pixel in its corners.
const CORNERS: [(usize, usize); 4] = [(0, 0), (EDGE_RAYS - 1, 0), (0, EDGE_RAYS - 1), (EDGE_RAYS - 1, EDGE_RAYS - 1)];

/// What a block is divided into: a tree, in which the nodes of a level follow each other.
struct Node {
    block: Block,
    open: Open,
    /// What its rays meet, if that is one patch.
    patch: Option<Patch>,
    /// Of its frustum alone, with its patch.
    cost: Cost,
    /// Its parts in the order of the picture; empty for a leaf.
    children: std::ops::Range<usize>,
}

/// A pixel that may show something.
struct Sight<'a> {
    column: usize,
    row: usize,
    open: &'a Open,
    ray: Beam,
    pixel: Pixel,
    /// Another surface in front of what the centre ray meets.
    thin: Option<Box<Hit>>,
    /// Where its parts are, if it was divided.
    parts: Option<usize>,
    stage: Stage,
}

impl<'a> Sight<'a> {
    /// Nothing is known but what is open in its block.
    fn new(task: &Task, index: usize, open: &'a Open, ray: Beam, cost: Cost) -> Self {
        let (column, row) = task.place(index);
        let (pixel, thin, parts, stage) = (Pixel { cost, ..empty(index) }, None, None, Stage::Settled);
        Self { column, row, open, ray, pixel, thin, parts, stage }
    }
}

/// What is still to be found out about a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Stage {
    /// Nothing.
    Settled,
    /// How much of it is covered.
    Coverage,
    /// Whether its corners look like its middle.
    Corners,
    /// What a grid of its rays meets.
    Edge,
}

struct Primary<'a> {
    task: &'a Task,
    surfaces: Vec<Surface<'a>>,
    given: Option<&'a Given>,
    scratch: &'a mut Scratch,
}

/// A ray and what it meets; the number is the asker's.
type Met = (usize, Beam, Meeting);

/// Primary visibility of the block at `(column, row)`, clipped to the picture; what is given is not looked for. And how full its
/// batches were.
pub(super) fn primary(
    task: &Task,
    column: usize,
    row: usize,
    given: Option<&Given>,
    scratch: &mut Scratch,
) -> (Vec<Pixel>, Occupancy) {
    let mut pass = Primary { task, surfaces: task.surfaces(), given, scratch };
    let whole = (column, row, BLOCK);
    let mut out: Vec<Pixel> = indices(task, whole).filter_map(|index| pass.taken(index)).collect();
    if pass.all_given(whole) {
        return (out, Occupancy::default());
    }
    let mut nodes = pass.divide(whole);
    pass.patches(&mut nodes);
    let (simple, mut sights) = pass.centres(&nodes);
    let parts = pass.coverages(&mut sights);
    pass.corners(&mut sights, &parts);
    pass.edges(&mut sights, &parts);
    out.reserve(BLOCK * BLOCK);
    in_order(task, &nodes, simple, sights, |pixel| {
        if !is_given(given, pixel.index) {
            out.push(pixel);
        }
    });
    (out, scratch.work.take_occupancy())
}

/// Whether all of a pixel is given.
fn is_given(given: Option<&Given>, index: usize) -> bool {
    given.is_some_and(|g| g.pixels[index].is_some())
}

/// All pixels, a block's quarter after the other. What a frustum costs is booked on the first pixel below it.
fn in_order(
    task: &Task,
    nodes: &[Node],
    mut simple: Vec<Pixel>,
    mut sights: Vec<Sight<'_>>,
    mut found: impl FnMut(Pixel),
) {
    const NONE: usize = usize::MAX;
    let mut seen = vec![NONE; BLOCK * BLOCK];
    let slot = |index: usize| {
        let (column, row) = task.place(index);
        row % BLOCK * BLOCK + column % BLOCK
    };
    // First the simple ones, then the others.
    let pixels = simple.iter().chain(sights.iter().map(|sight| &sight.pixel));
    pixels.enumerate().for_each(|(k, pixel)| seen[slot(pixel.index)] = k);
    let mut take = |k: usize| match k.checked_sub(simple.len()) {
        None => simple.get_mut(k).map(moved),
        Some(k) => sights.get_mut(k).map(|sight| moved(&mut sight.pixel)),
    };
    let (mut owed, mut stack) = (Cost::default(), vec![0]);
    while let Some(k) = stack.pop() {
        let node = &nodes[k];
        owed += node.cost;
        stack.extend(node.children.clone().rev());
        if node.children.is_empty() {
            for index in indices(task, node.block) {
                // A pixel that nobody looked at is empty only if its frustum is.
                let none = || node.open.certainly_empty().then(|| empty(index));
                let Some(mut pixel) = take(seen[slot(index)]).or_else(none) else { continue };
                pixel.cost += std::mem::take(&mut owed);
                found(pixel);
            }
        }
    }
}

fn moved(pixel: &mut Pixel) -> Pixel {
    Pixel { edge: pixel.edge.take(), ..*pixel }
}

fn empty(index: usize) -> Pixel {
    Pixel { index, known: Known::Empty, coverage: [0.0; 2], hit: None, edge: None, cost: Cost::default() }
}

impl Primary<'_> {
    fn fan(&self, (column, row, side): Block) -> Fan {
        let film = &self.task.film;
        film.fan(column..(column + side).min(film.width), row..(row + side).min(film.height))
    }

    fn all_given(&self, block: Block) -> bool {
        self.given.is_some() && indices(self.task, block).all(|index| is_given(self.given, index))
    }

    /// A pixel of which all is given. A hit whose light is not is enclosed as narrowly as shadows want it.
    fn taken(&mut self, index: usize) -> Option<Pixel> {
        let given = self.given?;
        let (surface, t, before) = match given.pixels[index]? {
            GivenPixel::Empty => return Some(empty(index)),
            GivenPixel::Hit { surface, t, before } => (surface, t, before),
        };
        let mut cost = Cost::default();
        let (column, row) = self.task.place(index);
        let beam = self.task.film.ray(column, row);
        let mut meeting = Meeting { surface, t, before: Some(before), reason: None };
        let wide = |light: &Vec<[f64; 2]>| light[index][1] - light[index][0] > self.task.tolerance.width;
        if given.lights.iter().any(wide) {
            let found = self.meet_finely(&Ray { beam, open: &[Piece { surface, t }], inside: false }, &mut cost);
            // Of the roots in t the first: the very one that is given.
            meeting = found.filter(|m| m.reason.is_none() && m.before.is_some()).unwrap_or(meeting);
        }
        let hit = Some(self.hit(&beam, &meeting));
        Some(Pixel { known: Known::Hit, coverage: [1.0; 2], hit, cost, ..empty(index) })
    }

    /// Divides a block until its parts are empty, simple, or pixels.
    fn divide(&mut self, whole: Block) -> Vec<Node> {
        let nothing = Open::nothing(&self.surfaces, &self.fan(whole));
        let node = |block| Node { block, open: Open::default(), patch: None, cost: Cost::default(), children: 0..0 };
        let mut nodes = vec![node(whole)];
        // Of each node, its parent.
        let mut parents = vec![0];
        let mut level = 0..1;
        while !level.is_empty() {
            let (before, now) = nodes.split_at_mut(level.start);
            let jobs: Vec<Frustum<'_>> = now
                .iter()
                .zip(&parents[level.start..])
                .map(|(n, parent)| Frustum {
                    fan: self.fan(n.block),
                    parent: before.get(*parent).map_or(&nothing, |p| &p.open),
                })
                .collect();
            let Scratch { frusta, work, .. } = &mut *self.scratch;
            narrow(&self.surfaces, &jobs, frusta, work, |k, open, cost| {
                now[k].open = std::mem::take(open);
                now[k].cost = cost;
            });
            for k in level.clone() {
                let (column, row, side) = nodes[k].block;
                let open = &nodes[k].open;
                // Small, covered and simple: straight to the rays.
                let simple = side <= SIMPLE && open.certainly_covered() && open.open.len() == 1;
                if side == 1 || simple || open.certainly_empty() {
                    continue;
                }
                let (half, first) = (side / 2, nodes.len());
                for (down, right) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                    let child = (column + right * half, row + down * half, half);
                    if child.0 < self.task.film.width && child.1 < self.task.film.height && !self.all_given(child) {
                        nodes.push(node(child));
                        parents.push(k);
                    }
                }
                nodes[k].children = first..nodes.len();
            }
            level = level.end..nodes.len();
        }
        nodes
    }

    /// The patches of blocks whose rays all meet one piece of a surface.
    fn patches(&mut self, nodes: &mut [Node]) {
        let one = |n: &Node| n.children.is_empty() && n.block.2 > 1 && n.open.certainly_covered() && n.open.inside;
        let (places, asked): (Vec<usize>, Vec<(Fan, Piece)>) = nodes
            .iter()
            .enumerate()
            .filter(|(_, n)| one(n))
            .filter_map(|(k, n)| match n.open.open[..] {
                [piece] => Some((k, (self.fan(n.block), piece))),
                _ => None,
            })
            .unzip();
        patches(&self.surfaces, &asked, &mut self.scratch.work, |k, patch, cost| {
            let node = &mut nodes[places[k]];
            node.cost += cost;
            node.patch = patch;
        });
    }

    /// How much of the pixels is covered that are not simply covered; and what is in front of what their centre rays meet. Returns what is known of the
    /// parts of those that were divided.
    fn coverages(&mut self, sights: &mut [Sight<'_>]) -> Vec<Vec<Part>> {
        let mut asked: Vec<&mut Sight<'_>> = sights.iter_mut().filter(|s| s.stage == Stage::Coverage).collect();
        let film = &self.task.film;
        let windows: Vec<Window<'_>> = asked
            .iter()
            .filter(|s| !s.open.certainly_covered())
            .map(|s| Window { film: film.window(s.column..s.column + 1, s.row..s.row + 1), parent: s.open })
            .collect();
        let mut looking = Looking { film, surfaces: &self.surfaces, scratch: &mut *self.scratch };
        let mut found = looking.coverage(&windows, COVERAGE_LEVELS).into_iter();
        let mut parts = Vec::with_capacity(windows.len());
        for sight in &mut asked {
            let pixel = &mut sight.pixel;
            if !sight.open.certainly_covered()
                && let Some(covered) = found.next()
            {
                pixel.coverage = outward(covered.share);
                pixel.cost += covered.cost;
                sight.parts = Some(parts.len());
                parts.push(covered.parts);
            }
            if pixel.coverage[1] == 0.0 {
                (pixel.known, pixel.hit, sight.stage) = (Known::Empty, None, Stage::Settled);
                continue;
            }
            sight.thin = pixel.hit.and_then(|hit| {
                let before = |p: &&Piece| p.surface != hit.object && p.t.lo() < hit.t.lo();
                let piece = sight.open.open.iter().find(before)?;
                // An enclosure over the whole pixel reaches too far beside an edge: ask its parts.
                let film = film.window(sight.column..sight.column + 1, sight.row..sight.row + 1);
                let window = Window { film, parent: sight.open };
                let mut looking =
                    Looking { film: &self.task.film, surfaces: &self.surfaces, scratch: &mut *self.scratch };
                if !looking.remains(piece, hit.t.lo(), window, COVERAGE_LEVELS, &mut pixel.cost) {
                    return None;
                }
                let beam = self.task.film.beam(sight.column, sight.row);
                Some(Box::new(self.task.hit(in_front(piece, beam), &mut self.scratch.work)))
            });
            sight.stage = if sight.thin.is_none() && pixel.hit.is_some() { Stage::Corners } else { Stage::Edge };
        }
        parts
    }

    /// Whether rays near the corners of a pixel meet about the same as its centre ray: then one colour will do.
    fn corners<'n>(&mut self, sights: &mut [Sight<'n>], parts: &'n [Vec<Part>]) {
        for (i, j) in CORNERS {
            let mut asked: Vec<&mut Sight<'n>> = sights.iter_mut().filter(|s| s.stage == Stage::Corners).collect();
            let rays: Vec<Ray<'_>> = asked.iter().map(|s| self.ray(s, parts, i, j)).collect();
            let found = self.meet(&rays, self.task.glance);
            let met: Vec<Met> = rays
                .iter()
                .zip(&found)
                .enumerate()
                .filter_map(|(k, (ray, (m, _)))| Some((k, ray.beam, (*m)?)))
                .collect();
            for (sight, (_, cost)) in asked.iter_mut().zip(found) {
                sight.pixel.cost += cost;
                sight.stage = Stage::Edge;
            }
            self.hits(&met, |k, corner| {
                let like =
                    |centre: Hit| corner.normal.dot(centre.normal) > PLAIN_NORMAL && corner.object == centre.object;
                if asked[k].pixel.hit.is_some_and(like) {
                    asked[k].stage = Stage::Corners;
                }
            });
        }
    }

    /// What a grid of rays meets in the pixels that show more than one thing.
    fn edges<'n>(&mut self, sights: &mut [Sight<'n>], parts: &'n [Vec<Part>]) {
        let mut asked: Vec<&mut Sight<'n>> = sights.iter_mut().filter(|s| s.stage == Stage::Edge).collect();
        // Which ray stands for which of a grid, and where those of each grid begin.
        let (mut rays, mut stand, mut begin) = (Vec::new(), Vec::with_capacity(asked.len()), vec![0]);
        for sight in &asked {
            stand.push(self.grid(sight, parts, &mut rays));
            begin.push(rays.len());
        }
        let found = self.meet(&rays, self.task.glance);
        let met: Vec<Met> =
            rays.iter().zip(&found).enumerate().filter_map(|(k, (ray, (m, _)))| Some((k, ray.beam, (*m)?))).collect();
        let mut seen: Vec<Option<Hit>> = vec![None; rays.len()];
        self.hits(&met, |k, hit| seen[k] = Some(hit));
        for ((sight, stand), range) in asked.iter_mut().zip(stand).zip(begin.windows(2)) {
            let Pixel { known, hit, cost, .. } = &mut sight.pixel;
            for k in range[0]..range[1] {
                let (meeting, spent) = found[k];
                *cost += spent;
                if let (None, Some(Meeting { reason: None, .. })) = (*hit, meeting)
                    && let Some(m @ Meeting { reason: None, .. }) = self.meet_finely(&rays[k], cost)
                {
                    (*known, *hit) = (Known::Partly, Some(self.hit(&rays[k].beam, &m)));
                }
            }
            // Something may be there that no ray of the grid meets: it must not vanish.
            if hit.is_none()
                && let Some(piece) = sight.open.open.first()
            {
                let beam = self.task.film.beam(sight.column, sight.row);
                *hit = Some(self.task.hit(in_front(piece, beam), &mut self.scratch.work));
            }
            let grid = stand.iter().map(|k| seen[*k]).collect();
            sight.pixel.edge = Some(Box::new(Edge { rays: grid, thin: sight.thin.take().map(|hit| *hit) }));
        }
    }

    /// Appends the rays of a pixel's grid that are to be followed, and tells which one stands for each. All rays of a part that one piece of a surface
    /// covers see about the same: one of them is enough.
    fn grid<'n>(
        &self,
        sight: &Sight<'n>,
        parts: &'n [Vec<Part>],
        rays: &mut Vec<Ray<'n>>,
    ) -> [usize; EDGE_RAYS * EDGE_RAYS] {
        let mut seen: SmallVec<[(usize, usize); 8]> = SmallVec::new();
        std::array::from_fn(|k| {
            let (i, j) = (k % EDGE_RAYS, k / EDGE_RAYS);
            let simple = |open: &Open| open.certainly_covered() && open.open.len() == 1;
            let part = self.part(sight, parts, i, j).filter(|(_, part)| simple(&part.open)).map(|(part, _)| part);
            if let Some((_, ray)) = seen.iter().find(|(other, _)| Some(*other) == part) {
                return *ray;
            }
            seen.extend(part.map(|part| (part, rays.len())));
            rays.push(self.ray(sight, parts, i, j));
            rays.len() - 1
        })
    }

    /// The part of a divided pixel that holds a ray of its grid, and its number.
    fn part<'n>(&self, sight: &Sight<'n>, parts: &'n [Vec<Part>], i: usize, j: usize) -> Option<(usize, &'n Part)> {
        let place = self.task.film.place(sight.column, sight.row, i, j, EDGE_RAYS);
        parts[sight.parts?].iter().enumerate().find(|(_, part)| part.certainly_holds(place))
    }

    /// A ray of a pixel's grid, with what is known of it.
    fn ray<'n>(&self, sight: &Sight<'n>, parts: &'n [Vec<Part>], i: usize, j: usize) -> Ray<'n> {
        let part = self.part(sight, parts, i, j);
        let Open { open, inside, .. } = part.map_or(sight.open, |(_, part)| &part.open);
        Ray { beam: self.task.film.sub_ray(sight.column, sight.row, i, j, EDGE_RAYS), open, inside: *inside }
    }

    fn meet(&mut self, rays: &[Ray<'_>], effort: Effort) -> Vec<(Option<Meeting>, Cost)> {
        let mut out = Vec::with_capacity(rays.len());
        let Scratch { rays: scratch, work, .. } = &mut *self.scratch;
        first_meetings(&self.surfaces, rays, effort, scratch, work, |_, meeting, cost| {
            out.push((meeting, cost));
        });
        out
    }

    fn meet_finely(&mut self, ray: &Ray<'_>, cost: &mut Cost) -> Option<Meeting> {
        let Scratch { rays: scratch, work, .. } = &mut *self.scratch;
        let mut meeting = None;
        first_meetings(&self.surfaces, &[*ray], Effort::FINE, scratch, work, |_, found, spent| {
            meeting = found;
            *cost += spent;
        });
        meeting
    }

    fn hit(&mut self, ray: &Beam, m: &Meeting) -> Hit {
        received(self.task.hit(asked(ray, m), &mut self.scratch.work), ray, m)
    }

    /// The same for many.
    fn hits(&mut self, met: &[Met], mut found: impl FnMut(usize, Hit)) {
        let all: Vec<Asked> = met.iter().map(|(_, ray, m)| asked(ray, m)).collect();
        let Scratch { hits, work, .. } = &mut *self.scratch;
        self.task.hits(&all, hits, work, |k, hit| {
            let (asker, ray, m) = &met[k];
            found(*asker, received(hit, ray, m));
        });
    }
}

fn asked(ray: &Beam, m: &Meeting) -> Asked {
    Asked { object: m.surface, beam: *ray, t: m.t, before: m.before }
}

/// With what starts a shadow, where that is proved.
fn received(hit: Hit, ray: &Beam, m: &Meeting) -> Hit {
    let receiver = match (m.reason, m.before) {
        (None, Some(side)) => Some(Receiver { point: ray.at(m.t), surface: m.surface, side }),
        _ => None,
    };
    Hit { receiver, ..hit }
}

/// Where an open piece of a pixel's beam begins to show.
fn in_front(piece: &Piece, beam: Beam) -> Asked {
    Asked { object: piece.surface, beam, t: piece.t, before: None }
}
