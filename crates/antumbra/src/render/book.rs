//! What is known of the picture so far: the frame, its hits, and the statistics.
use super::by_proof::{BLOCK, Block};
use super::coloring::Rgb;
use super::crease::Grids;
use super::frame::slide;
use super::hits::{Fringe, Hits};
use super::pixel::{Known, Light, Pixel};
use super::task::Task;
use super::{Frame, LightPlanes, Method, RenderSpec, Stats};
use crate::eval::Occupancy;
use crate::verdict::{Reason, Verdict};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Frame, hits and statistics: all that a state holds of a render. Written by one thread at a time; what it says of a
/// pixel when the last tile is done does not depend on the order of the tiles (how hits are numbered does: the bytes of a state with it).
#[derive(Serialize, Deserialize)]
pub(super) struct Book {
    pub(super) frame: Frame,
    pub(super) stats: Stats,
    pub(super) hits: Hits,
    /// Pixels that an edge crosses, with the hits of their grid of rays.
    pub(super) edges: BTreeMap<usize, Fringe>,
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
    }

    /// Whether what it knows of hits is that of pixels it has and of so many surfaces, each hit that of one pixel.
    pub(super) fn holds(&self, surfaces: usize) -> bool {
        let n = self.hits.pixels();
        self.hits.holds(surfaces) && self.edges.iter().all(|(index, fringe)| *index < n && fringe.holds(surfaces))
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
            self.hits.put_from(index, &other.hits, index);
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

    /// What was found of the pixels of a block, and their colours as long as nothing more is known: row by row, so that what is side by side
    /// in the planes is written, and the hits of neighbours are kept, one after the other.
    pub(super) fn put_pixels(&mut self, task: &Task, (left, top, _): Block, found: &[Pixel], colors: &[Rgb]) {
        const NONE: u16 = u16::MAX;
        let (first, width) = (task.index(left, top), task.film.width);
        let mut places = [NONE; BLOCK * BLOCK];
        for (k, pixel) in (0_u16..).zip(found) {
            let from_first = pixel.index - first;
            places[from_first / width * BLOCK + from_first % width] = k;
        }
        for k in places.into_iter().filter(|k| *k != NONE).map(usize::from) {
            self.put_pixel(task, &found[k], colors[k]);
        }
    }

    fn put_pixel(&mut self, task: &Task, pixel: &Pixel, color: Rgb) {
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
        frame.rgb[index] = color;
        if let Some(hit) = &pixel.hit {
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
        self.hits.put(index, pixel.hit.as_ref());
        if let Some(edge) = pixel.edge.as_deref() {
            self.edges.insert(index, edge.into());
        }
    }

    /// The hits, and beside them what is written while their light is looked for.
    pub(super) fn in_light(&mut self) -> (&Hits, InLight<'_>) {
        let Self { hits, frame, stats, .. } = self;
        (hits, InLight { hits, frame, stats })
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
}

/// What is written while the light of hits is looked for.
pub(super) struct InLight<'a> {
    hits: &'a Hits,
    frame: &'a mut Frame,
    stats: &'a mut Stats,
}

impl InLight<'_> {
    /// What reaches a hit of a light.
    pub(super) fn put(&mut self, task: &Task, light: &Light) {
        if !self.hits.is_hit(light.index) {
            return;
        }
        let (frame, stats, index) = (&mut *self.frame, &mut *self.stats, light.index);
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

    /// The colour of a pixel.
    pub(super) fn put_color(&mut self, (index, color): (usize, Rgb)) {
        self.frame.rgb[index] = color;
    }
}
