//! What colour a pixel gets, and when.
use super::book::Book;
use super::by_proof::{BLOCK, Block};
use super::crease;
use super::hits::{Hits, Seen};
use super::likely::likely;
use super::pixel::{Light, Pixel};
use super::renderer::Stage;
use super::shade::{self, Lamp, Point};
use super::task::Task;
use super::{Frame, LightPlanes, Method, Renderer};
use rayon::prelude::*;
use smallvec::SmallVec;
use std::ops::Range;

/// A colour, linear, Rec. 709 primaries.
pub(super) type Rgb = [f32; 3];

/// Of a pixel that waits for its colour.
pub(super) const BLACK: Rgb = [0.0; 3];

/// What a row of pixels of a block shows, and those beside it.
type Seeing<'a> = SmallVec<[Option<&'a Seen>; 36]>;

/// How strongly a pixel shows something that may be there and that no ray of its grid meets.
const THIN_WEIGHT: f32 = 0.6;

impl Renderer {
    /// From now on a hit gets its colour when its light is known, and not, as well, when it is found: less work for whoever looks only
    /// at the finished picture or at its [`preview`](Self::preview). Until then it is black. The finished picture is the same.
    pub fn color_late(&mut self) {
        self.late_colors = true;
    }

    /// The frame of an unfinished render with the colours of its edges, as far as they are known: to be looked at. What
    /// was not looked at is black, light that was not looked for is there.
    #[must_use]
    pub fn preview(mut self) -> Frame {
        self.put_missing_colors();
        let rows = self.task.window.finished().start..self.task.window.held().end;
        self.finish_colors(rows);
        self.book.frame
    }

    /// Colours of hits that still wait for theirs. (What is found black anew is coloured again with the same result, or by its
    /// light, or where brackets are open by what is likely.)
    pub(super) fn put_missing_colors(&mut self) {
        if !matches!(self.stage, Stage::Primary | Stage::Shadow) {
            return;
        }
        let Self { crew, book, task, .. } = self;
        let pixels = task.indices(task.window.fresh());
        let missing = |book: &Book| -> Vec<(usize, Rgb)> {
            let frame = &book.frame;
            let unlit = |index: usize| frame.lights.iter().all(|l| l.is_untold(index));
            let color = |index: usize| {
                let hit = book.hits.at(index).filter(|hit| awaits_light(task, hit.proved()))?;
                let missing = frame.rgb[index] == BLACK && unlit(index);
                missing.then(|| (index, book.color(task, index, Some(hit), |_| None)))
            };
            pixels.into_par_iter().with_min_len(BLOCK * BLOCK).filter_map(color).collect()
        };
        crew.install(|| missing(book)).into_iter().for_each(|(index, color)| book.frame.rgb[index] = color);
    }

    /// The colours of pixels that depend on their neighbours, of those rows.
    pub(super) fn finish_colors(&mut self, rows: Range<usize>) {
        let Self { crew, book, task, .. } = self;
        crew.install(|| book.finish_colors(task, task.indices(rows)));
    }
}

/// Whether the light of a hit is looked for: then it gets a colour with it.
fn awaits_light(task: &Task, proved: bool) -> bool {
    !task.lights.is_empty() && (task.method != Method::Certified || proved)
}

/// Whether the colour of what is not proved to be a hit depends on what is beside it. All hits of the paper's methods are undecided; there it
/// would say nothing.
pub(super) fn is_doubtful(task: &Task, pixel: &Pixel) -> bool {
    task.method == Method::Certified && pixel.hit.is_some_and(|hit| hit.receiver.is_none())
}

/// The colour of a pixel as long as nothing is known of its light, which is taken to be there; of one that [`is_doubtful`], or that gets it
/// `late`, black.
pub(super) fn first_color(task: &Task, pixel: &Pixel, late: bool) -> Rgb {
    if is_doubtful(task, pixel) || late && pixel.hit.is_some_and(|hit| awaits_light(task, hit.receiver.is_some())) {
        return BLACK;
    }
    let seen = pixel.hit.as_ref().map(Seen::from);
    color(task, task.place(pixel.index), seen.as_ref(), false, |_| None)
}

/// The colours of the hits of a block whose light has been found.
pub(super) fn lit_colors(task: &Task, hits: &Hits, block: Block, found: &[Light]) -> Vec<(usize, Rgb)> {
    let (left, top, side) = block;
    let (across, down) = (side.min(task.film.width - left), side.min(task.window.held().end - top));
    // For each pixel, row by row, and each light the middle of the bracket; no number where nothing was found.
    let lights = task.lights.len();
    let mut visible = vec![f64::NAN; lights * across * down];
    for light in found {
        let (column, row) = task.place(light.index);
        visible[((row - top) * across + column - left) * lights + light.light] = 0.5 * (light.lo + light.hi);
    }
    let mut colors = Vec::with_capacity(found.len() / lights.max(1));
    for (k, visible) in visible.chunks_exact(lights.max(1)).enumerate() {
        if visible.iter().all(|visible| visible.is_nan()) {
            continue;
        }
        let place = (left + k % across, top + k / across);
        let index = task.index(place.0, place.1);
        if let Some(hit) = hits.at(index) {
            // A bracket of which nothing was told is all of [0, 1].
            let visible = |light: usize| Some(if visible[light].is_nan() { 0.5 } else { visible[light] });
            colors.push((index, color(task, place, Some(hit), false, visible)));
        }
    }
    colors
}

/// Colour of a pixel that shows one hit, or nothing. `visible` tells which fraction of a light reaches it; before that is known
/// it is lit. `touching`: not proved to be a surface, nor the edge of one.
fn color(
    task: &Task,
    (column, row): (usize, usize),
    hit: Option<&Seen>,
    touching: bool,
    visible: impl Fn(usize) -> Option<f64>,
) -> Rgb {
    let backdrop = shade::backdrop(&task.scene.backdrop, &task.film, column as f64 + 0.5, row as f64 + 0.5);
    let Some(hit) = hit else { return backdrop.map(|c| c as f32) };
    let (position, normal, color, object) = (hit.point, hit.normal, hit.color(), hit.object());
    let (finish, floor) = (task.objects[object].finish, Some(object) == task.floor_index());
    let point = Point { position, normal, color, finish, floor, touching };
    let camera = [task.film.camera.eye, task.scene.view.target];
    let lights = task.lights.iter().zip(&task.full).enumerate();
    let lights = lights.map(|(k, (light, full))| Lamp { light, full: *full, visible: visible(k) });
    shade::shade(&point, lights, &task.scene.sky, camera, backdrop, task.scale).map(|c| c as f32)
}

impl Book {
    /// Colour of a pixel that shows that hit, or nothing.
    pub(super) fn color(
        &self,
        task: &Task,
        index: usize,
        hit: Option<&Seen>,
        visible: impl Fn(usize) -> Option<f64>,
    ) -> Rgb {
        let unproved = hit.is_some_and(|hit| !hit.proved());
        let touching = task.method == Method::Certified && unproved && !self.at_an_edge(task, index);
        color(task, task.place(index), hit, touching, visible)
    }

    /// Of a block of pixels those that show an edge within what they meet, and have no grid of rays yet. Each hit is looked up once for its
    /// row and once for the one above, and whether two neighbours are [`apart`](crease::apart) is asked once.
    pub(super) fn creases(&self, task: &Task, (left, top, side): Block) -> Vec<usize> {
        let (width, held) = (task.film.width, task.window.held());
        let (right, bottom) = ((left + side).min(width), (top + side).min(held.end));
        // With those on both sides.
        let columns = left.saturating_sub(1)..(right + 1).min(width);
        let row_of = |row: Option<usize>| -> Seeing<'_> {
            let at = |row: usize| task.index(columns.start, row)..task.index(columns.end - 1, row) + 1;
            let row = row.filter(|row| held.contains(row)).map_or(0..0, at);
            let mut seen: Seeing<'_> = row.map(|at| self.hits.at(at)).collect();
            seen.resize(columns.len(), None);
            seen
        };
        let apart = |a: Option<&Seen>, b: Option<&Seen>| a.zip(b).is_some_and(|(a, b)| crease::apart(a, b));
        let mut found = Vec::new();
        let (above, mut here) = (row_of(top.checked_sub(1)), row_of(Some(top)));
        // Of the row above and this one: who is apart from whom.
        let mut from_above: SmallVec<[bool; 36]> = above.iter().zip(&here).map(|(a, b)| apart(*a, *b)).collect();
        let first = left - columns.start;
        for row in top..bottom {
            let next = row_of(Some(row + 1));
            let mut from_left = first > 0 && apart(here[0], here[1]);
            for k in first..first + (right - left) {
                let to_right = here.get(k + 1).is_some_and(|right| apart(here[k], *right));
                let below = apart(here[k], next[k]);
                let crease = from_left || to_right || from_above[k] || below;
                if crease && here[k].is_some_and(Seen::proved) {
                    let at = task.index(columns.start + k, row);
                    if !self.edges.contains_key(&at) {
                        found.push(at);
                    }
                }
                (from_left, from_above[k]) = (to_right, below);
            }
            here = next;
        }
        found
    }

    /// The colours of pixels that depend on their neighbours, when those are known: of what may be a surface, of hits with open brackets, and
    /// of edges. The paper's methods have none of them. In parallel on the threads of the pool that this runs in.
    fn finish_colors(&mut self, task: &Task, pixels: Range<usize>) {
        let this = &*self;
        let (frame, tolerance) = (&this.frame, task.tolerance.width);
        let alone = |index: usize| {
            // Told of every light, narrowly: a proved hit, or nothing.
            let told = |light: &LightPlanes| !light.is_untold(index) && !light.is_open(index, tolerance);
            if !frame.lights.is_empty() && frame.lights.iter().all(told) {
                return None;
            }
            let hit = this.hits.at(index)?;
            if !hit.proved() {
                Some((index, this.color(task, index, Some(hit), |_| None)))
            } else if frame.lights.iter().any(|light| light.is_open(index, tolerance)) {
                Some((index, this.color(task, index, Some(hit), |light| Some(this.likely(task, light, index)))))
            } else {
                None
            }
        };
        let mut colors: Vec<(usize, Rgb)> = Vec::new();
        if task.method == Method::Certified {
            colors = pixels.clone().into_par_iter().with_min_len(BLOCK * BLOCK).filter_map(alone).collect();
        }
        let edges: Vec<usize> = this.edges.range(pixels).map(|(index, _)| *index).collect();
        let edge = |&index: &usize| Some((index, this.edge_color(task, index)?));
        // Later ones win.
        colors.par_extend(edges.par_iter().with_min_len(BLOCK).filter_map(edge));
        for (index, color) in colors {
            self.frame.rgb[index] = color;
        }
    }

    /// The fraction of a light that a pixel is drawn with.
    fn likely(&self, task: &Task, light: usize, index: usize) -> f64 {
        likely(&self.hits, &self.frame, light, index, task.tolerance.width)
    }

    /// Smooth edges: the mean colour of the grid of rays of a pixel that an edge crosses. The light of a ray's hit is
    /// that of the nearest hit in the neighbourhood. Where no ray of the grid meets the thing that is known, or not
    /// excluded, to be there, it shows all the same.
    fn edge_color(&self, task: &Task, index: usize) -> Option<Rgb> {
        let edge = self.edges.get(&index)?;
        let lit = |hit: &Seen| {
            let lit_as = self.light_near(task, index, hit);
            self.color(task, index, Some(hit), |light| lit_as.map(|at| self.likely(task, light, at)))
        };
        let nothing = self.color(task, index, None, |_| None);
        let mut sum = BLACK;
        for sub in edge.rays() {
            let color = sub.map_or(nothing, lit);
            (0..3).for_each(|c| sum[c] += color[c]);
        }
        let mut color = sum.map(|s| s / edge.rays().len() as f32);
        if let Some(thin) = &edge.thin
            && !self.is_near(task, index, thin.object())
            && !edge.seen().iter().any(|hit| hit.object() == thin.object())
        {
            let veil = self.color(task, index, Some(thin), |_| None);
            (0..3).for_each(|c| color[c] += THIN_WEIGHT * (veil[c] - color[c]));
        }
        if edge.seen().is_empty()
            && let Some(hit) = self.hits.at(index)
            && !self.at_an_edge(task, index)
        {
            let thin = lit(hit);
            let weight = if self.frame.coverage_lo[index] > 0.0 { 1.0 } else { THIN_WEIGHT };
            (0..3).for_each(|c| color[c] += weight * (thin[c] - color[c]));
        }
        Some(color)
    }

    /// Whether that surface is proved in the pixel or next to it.
    fn is_near(&self, task: &Task, index: usize, object: usize) -> bool {
        neighbours(task, index).any(|at| self.hits.at(at).is_some_and(|hit| hit.object() == object && hit.proved()))
    }

    /// Whether a surface is proved in the pixel or next to it: what is undecided there is how far its edge reaches.
    fn at_an_edge(&self, task: &Task, index: usize) -> bool {
        neighbours(task, index).any(|at| matches!(self.frame.verdict[at], 1 | Frame::PARTLY))
    }

    /// The pixel, among this one and its neighbours, whose hit on the same surface is nearest to `hit`.
    fn light_near(&self, task: &Task, index: usize, hit: &Seen) -> Option<usize> {
        let mut best = (f64::INFINITY, None);
        for at in neighbours(task, index) {
            if let Some(other) = self.hits.at(at)
                && other.object() == hit.object()
            {
                let distance = (other.point - hit.point).length();
                if distance < best.0 {
                    best = (distance, Some(at));
                }
            }
        }
        best.1
    }
}

/// Indices of a pixel and those around it.
fn neighbours(task: &Task, index: usize) -> impl Iterator<Item = usize> + use<> {
    let (width, held) = (task.film.width, task.window.held());
    let (column, row) = task.place(index);
    let columns = column.saturating_sub(1)..(column + 2).min(width);
    let rows = row.saturating_sub(1).max(held.start)..(row + 2).min(held.end);
    task.indices(rows).step_by(width).flat_map(move |left| columns.clone().map(move |column| left + column))
}
