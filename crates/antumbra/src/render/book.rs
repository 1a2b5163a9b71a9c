//! What is known of the picture so far: the frame, its hits, and the statistics.
use super::by_proof::BLOCK;
use super::crease::{Grids, apart};
use super::frame::slide;
use super::hits::Hits;
use super::likely::likely;
use super::pixel::{Edge, Hit, Known, Light, Pixel};
use super::shade::{self, Lamp, Point};
use super::task::Task;
use super::{Frame, LightPlanes, Method, RenderSpec, Stats};
use crate::eval::Occupancy;
use crate::verdict::{Reason, Verdict};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::ops::Range;

/// Frame, hits and statistics: all that a state holds of a render. Written by one thread; what is in it when the last tile
/// is done does not depend on the order of the tiles.
#[derive(Serialize, Deserialize)]
pub(super) struct Book {
    pub(super) frame: Frame,
    pub(super) stats: Stats,
    hits: Hits,
    /// Pixels that an edge crosses, with the hits of their grid of rays.
    edges: BTreeMap<usize, Edge>,
    /// Evaluations that the search for the surface took, per pixel.
    primary_cost: Vec<u32>,
}

impl Book {
    pub(super) fn new(frame: Frame, spec: &RenderSpec, threads: usize) -> Self {
        let (width, height) = (spec.width, spec.height);
        let (method, lights) = (spec.method.name().to_owned(), frame.lights.len());
        let stats = Stats { method, width, height, threads, lights, ..Stats::default() };
        let pixels = frame.verdict.len();
        let (hits, primary_cost) = (Hits::none(pixels), vec![0; pixels]);
        Self { frame, stats, hits, edges: BTreeMap::new(), primary_cost }
    }

    /// Whether every plane has the size of a picture of that many pixels and lights.
    pub(super) fn fits(&self, width: usize, height: usize, lights: usize) -> bool {
        let (frame, n) = (&self.frame, width * height);
        let planes = [frame.verdict.len(), frame.t_lo.len(), frame.t_hi.len(), frame.normal.len(), frame.rgb.len()];
        let more = [frame.coverage_lo.len(), frame.coverage_hi.len(), frame.cost.len()];
        let of_light = |l: &LightPlanes| {
            let sizes = [l.visible_lo.len(), l.visible_hi.len(), l.facing.len(), l.initial_occluded.len()];
            sizes == [n; 4]
        };
        (frame.width, frame.height, frame.lights.len()) == (width, height, lights)
            && planes == [n; 5]
            && more == [n; 3]
            && frame.lights.iter().all(of_light)
            && (self.hits.pixels(), self.primary_cost.len()) == (n, n)
            && self.hits.holds()
            && self.edges.keys().all(|index| *index < n)
    }

    /// Takes over what another book of the same picture knows, and tells whether it can: not where both know something of a pixel.
    pub(super) fn join(&mut self, other: Self) -> bool {
        let seen = |book: &Self, index: usize| book.frame.verdict[index] != Frame::UNSEEN;
        if (0..self.hits.pixels()).any(|index| seen(self, index) && seen(&other, index)) {
            return false;
        }
        for index in (0..self.hits.pixels()).filter(|index| seen(&other, *index)) {
            let (to, from) = (&mut self.frame, &other.frame);
            to.verdict[index] = from.verdict[index];
            (to.t_lo[index], to.t_hi[index]) = (from.t_lo[index], from.t_hi[index]);
            to.normal[index] = from.normal[index];
            to.rgb[index] = from.rgb[index];
            (to.coverage_lo[index], to.coverage_hi[index]) = (from.coverage_lo[index], from.coverage_hi[index]);
            to.cost[index] = from.cost[index];
            for (to, from) in to.lights.iter_mut().zip(&from.lights) {
                (to.visible_lo[index], to.visible_hi[index]) = (from.visible_lo[index], from.visible_hi[index]);
                to.facing[index] = from.facing[index];
                to.initial_occluded[index] = from.initial_occluded[index];
            }
            self.hits.put(index, other.hits.at(index).copied());
            self.primary_cost[index] = other.primary_cost[index];
        }
        self.edges.extend(other.edges);
        self.stats.join(&other.stats);
        true
    }

    /// Forgets the first pixels, a whole number of rows, and makes room for as many unseen ones at the end as there are then too few.
    pub(super) fn slide(&mut self, forget: usize, pixels: usize) {
        self.frame.slide(forget, pixels);
        self.hits.slide(forget, pixels);
        slide(&mut self.primary_cost, forget, pixels, 0);
        self.edges = std::mem::take(&mut self.edges)
            .split_off(&forget)
            .into_iter()
            .map(|(index, edge)| (index - forget, edge))
            .collect();
    }

    /// Whether every pixel was looked at.
    pub(super) fn is_whole(&self) -> bool {
        !self.frame.verdict.contains(&Frame::UNSEEN)
    }

    pub(super) fn hit(&self, index: usize) -> Option<&Hit> {
        self.hits.at(index)
    }

    pub(super) fn restart_shadows(&mut self, method: Method) {
        self.stats.forget_shadows(method.name());
        for index in 0..self.hits.pixels() {
            self.frame.cost[index] = self.primary_cost[index];
            for light in &mut self.frame.lights {
                light.initial_occluded[index] = false;
                if self.hits.at(index).is_some() {
                    (light.visible_lo[index], light.visible_hi[index]) = (0.0, 1.0);
                }
            }
        }
    }

    pub(super) fn put_pixel(&mut self, task: &Task, pixel: Pixel) {
        let (frame, stats, index) = (&mut self.frame, &mut self.stats, pixel.index);
        stats.pixel_beams += pixel.cost.beams;
        stats.primary_evaluations += pixel.cost.evaluations;
        self.primary_cost[index] = u32::try_from(pixel.cost.evaluations).unwrap_or(u32::MAX);
        frame.cost[index] = self.primary_cost[index];
        [frame.coverage_lo[index], frame.coverage_hi[index]] = pixel.coverage;
        let (code, counter) = match pixel.known {
            Known::Empty => (Frame::verdict_code(Verdict::No), &mut stats.proved_empty),
            Known::Hit => (Frame::verdict_code(Verdict::Yes), &mut stats.proved_hit),
            Known::Partly => (Frame::PARTLY, &mut stats.proved_partly),
            Known::Undecided(reason) => (
                Frame::verdict_code(Verdict::Unknown(reason)),
                match reason {
                    Reason::Resolution => &mut stats.undecided_resolution,
                    Reason::Touching => &mut stats.undecided_touching,
                    Reason::Domain => &mut stats.undecided_domain,
                    Reason::Budget => &mut stats.undecided_budget,
                },
            ),
        };
        *counter += 1;
        frame.verdict[index] = code;
        if let Some(hit) = pixel.hit {
            stats.hits += 1;
            stats.floor_hits += u64::from(hit.floor);
            (frame.t_lo[index], frame.t_hi[index]) = (hit.t.lo(), hit.t.hi());
            frame.normal[index] = hit.normal.0.map(|c| c as f32);
            for (planes, light) in frame.lights.iter_mut().zip(&task.lights) {
                planes.facing[index] = hit.normal.dot((light.rect.center - hit.point).normalized()) as f32;
                // Nothing is known of its light yet.
                (planes.visible_lo[index], planes.visible_hi[index]) = (0.0, 1.0);
            }
        }
        self.hits.put(index, pixel.hit);
        if let Some(edge) = pixel.edge {
            self.edges.insert(index, *edge);
        }
    }

    pub(super) fn put_light(&mut self, task: &Task, light: &Light) {
        if self.hits.at(light.index).is_none() {
            return;
        }
        let (frame, stats, index) = (&mut self.frame, &mut self.stats, light.index);
        let planes = &mut frame.lights[light.light];
        (planes.visible_lo[index], planes.visible_hi[index]) = (light.lo, light.hi);
        planes.initial_occluded[index] = light.first_occluded;
        let class = match (light.lo, light.hi) {
            (1.0, _) => &mut stats.lit,
            (_, 0.0) => &mut stats.dark,
            _ => &mut stats.partly,
        };
        *class += 1;
        stats.in_shadow_facing += u64::from(light.lo < 1.0 && planes.facing[index] > 0.0);
        stats.initial_occluded += u64::from(light.first_occluded);
        // Lit as far as anybody wanted to know.
        let lit = light.hi == 1.0 && light.lo >= 1.0 - task.tolerance.width;
        stats.false_alarms += u64::from(light.first_occluded && lit);
        stats.brackets_open += u64::from(light.reason.is_some());
        stats.bracket_width_max = stats.bracket_width_max.max(light.hi - light.lo);
        stats.initial_beams += light.initial.beams;
        stats.beams += light.sub.beams;
        let evaluations = light.initial.evaluations + light.sub.evaluations;
        stats.shadow_evaluations += evaluations;
        frame.cost[index] = frame.cost[index].saturating_add(u32::try_from(evaluations).unwrap_or(u32::MAX));
    }

    /// Gives pixels their colours: `lit` by what is known of their light, or as if nothing were in its way. In parallel on the
    /// threads of the pool that this runs in.
    pub(super) fn put_colors(&mut self, task: &Task, pixels: &[usize], lit: bool) {
        let this = &*self;
        let color = |&index: &usize| {
            let visible = |light: usize| lit.then(|| this.frame.lights[light].visible(index));
            this.color(task, index, this.hits.at(index), &visible)
        };
        let colors: Vec<[f32; 3]> = pixels.par_iter().with_min_len(BLOCK * BLOCK).map(color).collect();
        for (&index, color) in pixels.iter().zip(colors) {
            self.frame.rgb[index] = color;
        }
    }

    /// Colour of a pixel that shows one hit, or nothing. `visible` tells which fraction of a light reaches it; before that is known
    /// it is lit.
    fn color(&self, task: &Task, index: usize, hit: Option<&Hit>, visible: &dyn Fn(usize) -> Option<f64>) -> [f32; 3] {
        let (column, row) = task.place(index);
        let backdrop = shade::backdrop(&task.scene.backdrop, &task.film, column as f64 + 0.5, row as f64 + 0.5);
        let Some(hit) = hit else { return backdrop.map(|c| c as f32) };
        // All hits of the paper's methods are undecided; there it would say nothing.
        let touching = task.method == Method::Certified && hit.receiver.is_none() && !self.at_an_edge(task, index);
        let Hit { point: position, normal, color, floor, object, .. } = *hit;
        let finish = task.objects[object].finish;
        let point = Point { position, normal, color, finish, floor, touching };
        let camera = [task.film.camera.eye, task.scene.view.target];
        let lights = task.lights.iter().zip(&task.full).enumerate();
        let lights = lights.map(|(k, (light, full))| Lamp { light, full: *full, visible: visible(k) });
        shade::shade(&point, lights, &task.scene.sky, camera, backdrop, task.scale).map(|c| c as f32)
    }

    /// Of some pixels those that show an edge within what they meet, and have no grid of rays yet.
    pub(super) fn creases(&self, task: &Task, pixels: impl Iterator<Item = usize>) -> Vec<usize> {
        let (width, rows) = (task.film.width, task.window.held());
        let crease = |&index: &usize| {
            let (column, row) = task.place(index);
            let Some(hit) = self.hits.at(index).copied().filter(|hit| hit.receiver.is_some()) else { return false };
            let beside = [
                (column > 0, index.wrapping_sub(1)),
                (column + 1 < width, index + 1),
                (row > rows.start, index.wrapping_sub(width)),
                (row + 1 < rows.end, index + width),
            ];
            let differs = |at: usize| self.hits.at(at).is_some_and(|other| apart(&hit, other));
            !self.edges.contains_key(&index) && beside.into_iter().any(|(inside, at)| inside && differs(at))
        };
        pixels.filter(crease).collect()
    }

    /// How full batches were.
    pub(super) fn put_occupancy(&mut self, occupancy: &Occupancy) {
        self.stats.batched_questions += occupancy.questions;
        self.stats.batch_lanes += occupancy.lanes;
    }

    /// Grids of rays of such pixels.
    pub(super) fn put_creases(&mut self, (edges, cost, occupancy): Grids) {
        self.put_occupancy(&occupancy);
        self.edges.extend(edges);
        self.stats.edge_evaluations += cost.evaluations;
    }

    /// The colours of pixels that depend on their neighbours, when those are known: of what may be a surface, of hits with open brackets, and
    /// of edges. The paper's methods have none of them.
    pub(super) fn finish_colors(&mut self, task: &Task, pixels: Range<usize>) {
        if task.method == Method::Certified {
            for index in pixels.clone() {
                let Some(hit) = self.hits.at(index) else { continue };
                let color = if hit.receiver.is_none() {
                    self.color(task, index, Some(hit), &|_| None)
                } else if self.frame.lights.iter().any(|light| light.is_open(index, task.tolerance.width)) {
                    self.color(task, index, Some(hit), &|light| Some(self.likely(task, light, index)))
                } else {
                    continue;
                };
                self.frame.rgb[index] = color;
            }
        }
        self.shade_edges(task, pixels);
    }

    /// The fraction of a light that a pixel is drawn with.
    fn likely(&self, task: &Task, light: usize, index: usize) -> f64 {
        likely(&self.hits, &self.frame, light, index, task.tolerance.width)
    }

    /// Smooth edges: the mean colour of the grid of rays of each pixel that an edge crosses. The light of a ray's hit is
    /// that of the nearest hit in the neighbourhood. Where no ray of the grid meets the thing that is known, or not
    /// excluded, to be there, it shows all the same.
    fn shade_edges(&mut self, task: &Task, pixels: Range<usize>) {
        let mut colors = Vec::new();
        for (&index, edge) in self.edges.range(pixels) {
            let mut sum = [0.0_f32; 3];
            for sub in &edge.rays {
                let lit_as = sub.as_ref().and_then(|hit| self.light_near(task, index, hit));
                let visible = |light| lit_as.map(|at| self.likely(task, light, at));
                let color = self.color(task, index, sub.as_ref(), &visible);
                (0..3).for_each(|c| sum[c] += color[c]);
            }
            let mut color = sum.map(|s| s / edge.rays.len() as f32);
            if let Some(thin) = &edge.thin
                && !self.is_near(task, index, thin.object)
                && !edge.rays.iter().flatten().any(|hit| hit.object == thin.object)
            {
                let veil = self.color(task, index, Some(thin), &|_| None);
                (0..3).for_each(|c| color[c] += THIN_WEIGHT * (veil[c] - color[c]));
            }
            if edge.rays.iter().all(Option::is_none)
                && let Some(hit) = self.hits.at(index)
                && !self.at_an_edge(task, index)
            {
                let lit_as = self.light_near(task, index, hit);
                let thin = self.color(task, index, Some(hit), &|light| lit_as.map(|at| self.likely(task, light, at)));
                let weight = if self.frame.coverage_lo[index] > 0.0 { 1.0 } else { THIN_WEIGHT };
                (0..3).for_each(|c| color[c] += weight * (thin[c] - color[c]));
            }
            colors.push((index, color));
        }
        for (index, color) in colors {
            self.frame.rgb[index] = color;
        }
    }

    /// Whether that surface is proved in the pixel or next to it.
    fn is_near(&self, task: &Task, index: usize, object: usize) -> bool {
        neighbours(task, index)
            .any(|at| self.hits.at(at).is_some_and(|hit| hit.object == object && hit.receiver.is_some()))
    }

    /// Whether a surface is proved in the pixel or next to it: what is undecided there is how far its edge reaches.
    fn at_an_edge(&self, task: &Task, index: usize) -> bool {
        neighbours(task, index).any(|at| matches!(self.frame.verdict[at], 1 | Frame::PARTLY))
    }

    /// The pixel, among this one and its neighbours, whose hit on the same surface is nearest to `hit`.
    fn light_near(&self, task: &Task, index: usize, hit: &Hit) -> Option<usize> {
        let mut best = (f64::INFINITY, None);
        for at in neighbours(task, index) {
            if let Some(other) = self.hits.at(at)
                && other.object == hit.object
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

/// How strongly a pixel shows something that may be there and that no ray of its grid meets.
const THIN_WEIGHT: f32 = 0.6;
