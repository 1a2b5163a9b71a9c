//! The progressive renderer.
use super::shade::{self, Point};
use super::{Error, Frame, Method, RenderSpec, RunSpec, Stats};
use crate::eval::Workspace;
use crate::geom::{Film, Rect, Vec3};
use crate::grid::Grid;
use crate::paper::{Find, Settings, Shadow, World, shadow};
use crate::scene::Scene;
use crate::trace::{Cost, Target};
use crate::verdict::{Reason, Verdict};
use antumbra_interval::Interval;
use rayon::prelude::*;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Side of a tile (paper: "we divided the screen in many tiles"): the unit of work of a thread.
const TILE: usize = 16;

/// Draws one scene. Ask it to [`refine`](Self::refine) until it is done; look at [`frame`](Self::frame) and
/// [`stats`](Self::stats) whenever you like. The frame is the same, bit for bit, for any number of threads and any
/// budgets.
pub struct Renderer {
    scene: Arc<Scene>,
    spec: RenderSpec,
    film: Film,
    light: Rect,
    settings: Settings,
    pool: rayon::ThreadPool,
    grids: Vec<Grid>,
    hits: Vec<Option<Hit>>,
    frame: Frame,
    stage: Stage,
    next_tile: usize,
    stats: Stats,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Stage {
    Grid,
    Primary,
    Shadow,
    Done,
}

/// The start of a pixel's shadow beams.
#[derive(Clone, Copy, Debug)]
struct Hit {
    t: Interval,
    point: Vec3,
    normal: Vec3,
    outside: bool,
    floor: bool,
}

impl Renderer {
    /// A renderer that has not begun.
    ///
    /// # Errors
    /// A spec out of range, no memory, no threads.
    pub fn new(scene: Arc<Scene>, spec: RenderSpec, run: RunSpec) -> Result<Self, Error> {
        spec.validate()?;
        let frame = Frame::new(spec.width, spec.height)?;
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(run.threads.unwrap_or(0))
            .build()
            .map_err(|e| Error::Threads(e.to_string()))?;
        let (width, height) = (spec.width, spec.height);
        let film = Film { camera: scene.view.camera(width as f64 / height as f64), width, height };
        let settings = Settings {
            sub_beams: spec.sub_beams,
            offset: spec.offset.unwrap_or(RenderSpec::OFFSET * scene.scale()),
            bisection: spec.bisection,
            seed: spec.seed,
        };
        let stats = Stats {
            method: spec.method.name().to_owned(),
            width,
            height,
            threads: pool.current_num_threads(),
            ..Stats::default()
        };
        let light = scene.light.scaled(spec.light_scale);
        let hits = vec![None; width * height];
        let (grids, stage, next_tile) = (Vec::new(), Stage::Grid, 0);
        Ok(Self { scene, spec, film, light, settings, pool, grids, hits, frame, stage, next_tile, stats })
    }

    /// Continues where it was with another method of shadows: same scene, same hits. What the hits cost stays in the
    /// statistics. Does nothing to a renderer that has not found all its hits yet, but for the method.
    pub fn restart_shadows(&mut self, method: Method) {
        self.spec.method = method;
        if matches!(self.stage, Stage::Shadow | Stage::Done) {
            let old = std::mem::take(&mut self.stats);
            self.stats = Stats {
                method: method.name().to_owned(),
                lit: 0,
                partly: 0,
                dark: 0,
                in_shadow_facing: 0,
                initial_occluded: 0,
                initial_beams: 0,
                beams: 0,
                shadow_evaluations: 0,
                shadow_seconds: 0.0,
                ..old
            };
            (self.stage, self.next_tile) = (Stage::Shadow, 0);
        }
        self.stats.method = method.name().to_owned();
    }

    /// Works for about `budget` (at least one step) and tells whether the picture is finished.
    pub fn refine(&mut self, budget: Duration) -> bool {
        let begin = Instant::now();
        while self.stage != Stage::Done {
            let step = Instant::now();
            let stage = self.stage;
            self.step();
            let seconds = step.elapsed().as_secs_f64();
            match stage {
                Stage::Grid => self.stats.grid_seconds += seconds,
                Stage::Primary => self.stats.primary_seconds += seconds,
                Stage::Shadow | Stage::Done => self.stats.shadow_seconds += seconds,
            }
            if begin.elapsed() >= budget {
                break;
            }
        }
        self.stage == Stage::Done
    }

    /// Share of the work that is done, 0 to 1, roughly: tiles, the shadows counted three times.
    #[must_use]
    pub fn progress(&self) -> f64 {
        let share = self.next_tile as f64 / self.tiles() as f64;
        match self.stage {
            Stage::Grid => 0.0,
            Stage::Primary => 0.25 * share,
            Stage::Shadow => 0.25 + 0.75 * share,
            Stage::Done => 1.0,
        }
    }

    /// The picture as far as it is known.
    #[must_use]
    pub fn frame(&self) -> &Frame {
        &self.frame
    }

    /// Counters and times so far.
    #[must_use]
    pub fn stats(&self) -> Stats {
        let s = &self.stats;
        Stats {
            evaluations: s.grid_evaluations + s.primary_evaluations + s.shadow_evaluations,
            seconds: s.grid_seconds + s.primary_seconds + s.shadow_seconds,
            ..s.clone()
        }
    }

    fn tiles(&self) -> usize {
        self.film.width.div_ceil(TILE) * self.film.height.div_ceil(TILE)
    }

    /// Pixels of a tile as indices of the planes.
    fn pixels(&self, tile: usize) -> impl Iterator<Item = usize> + use<> {
        let (width, height) = (self.film.width, self.film.height);
        let across = width.div_ceil(TILE);
        let (left, top) = (tile % across * TILE, tile / across * TILE);
        let (right, bottom) = ((left + TILE).min(width), (top + TILE).min(height));
        (top..bottom).flat_map(move |row| (left..right).map(move |column| row * width + column))
    }

    fn step(&mut self) {
        if self.stage == Stage::Grid {
            let (scene, n) = (&self.scene, self.spec.grid);
            self.grids = self.pool.install(|| {
                scene.objects.iter().map(|o| Grid::build(o.surface.as_ref(), o.clip, n)).collect::<Vec<_>>()
            });
            self.stats.grid_evaluations = self.grids.iter().map(Grid::evaluations).sum();
            self.stage = Stage::Primary;
            return;
        }
        // A few tiles per thread and step: so cancelling is quick, and threads seldom wait for each other.
        let end = (self.next_tile + 4 * self.pool.current_num_threads()).min(self.tiles());
        let batch = self.next_tile..end;
        match self.stage {
            Stage::Primary => {
                let found: Vec<Vec<_>> = {
                    let this = &*self;
                    this.pool.install(|| batch.into_par_iter().map(|tile| this.primary_tile(tile)).collect())
                };
                found.into_iter().flatten().for_each(|(pixel, hit, cost)| self.put_hit(pixel, hit, cost));
            }
            _ => {
                let found: Vec<Vec<_>> = {
                    let this = &*self;
                    this.pool.install(|| batch.into_par_iter().map(|tile| this.shadow_tile(tile)).collect())
                };
                found.into_iter().flatten().for_each(|(pixel, shadow)| self.put_shadow(pixel, &shadow));
            }
        }
        self.next_tile = end;
        if end == self.tiles() {
            self.next_tile = 0;
            self.stage = if self.stage == Stage::Primary { Stage::Shadow } else { Stage::Done };
        }
    }

    fn world(&self) -> World<'_> {
        let targets = self
            .scene
            .objects
            .iter()
            .zip(&self.grids)
            .map(|(object, grid)| Target { function: object.surface.as_ref(), grid })
            .collect();
        World { targets, floor: self.spec.floor.then_some(self.scene.floor_height) }
    }

    fn primary_tile(&self, tile: usize) -> Vec<(usize, Option<Hit>, Cost)> {
        let (world, mut work) = (self.world(), Workspace::default());
        self.pixels(tile)
            .map(|pixel| {
                let (column, row) = (pixel % self.film.width, pixel / self.film.width);
                let rays = self.spec.method.uses_rays();
                let beam = if rays { self.film.ray(column, row) } else { self.film.beam(column, row) };
                let mut cost = Cost::default();
                let find =
                    world.nearest(&beam, Interval::NON_NEGATIVE, self.settings.bisection, &mut work, &mut cost);
                let hit = find.map(|find| self.hit(&world, &beam, find, &mut work));
                (pixel, hit, cost)
            })
            .collect()
    }

    /// "Because the intersection points are intervals, we use the midpoints" (paper, section 3).
    fn hit(&self, world: &World<'_>, beam: &crate::geom::Beam, find: Find, work: &mut Workspace) -> Hit {
        let floor = find.object == world.targets.len();
        // A floor seen along its plane has no far end; take the near one.
        let t = if find.t.hi().is_finite() { find.t } else { Interval::point(find.t.lo()) };
        let mut point = beam.at(t).mid();
        let (normal, outside) = if floor {
            point.0[2] = self.scene.floor_height;
            let below = self.film.camera.eye[2] < point[2];
            (Vec3::new(0.0, 0.0, if below { -1.0 } else { 1.0 }), true)
        } else {
            let gradient = world.targets[find.object].function.gradient(&point.to_box(), work);
            let normal = Vec3(gradient.partials.map(|d| if d.is_empty() { 0.0 } else { d.mid() })).normalized();
            let view = beam.direction.mid().normalized();
            // No gradient (a singular point): the surface faces the viewer.
            let normal = if normal == Vec3::default() { -view } else { normal };
            let outside = normal.dot(view) < 0.0;
            (if outside { normal } else { -normal }, outside)
        };
        Hit { t: find.t, point, normal, outside, floor }
    }

    fn shadow_tile(&self, tile: usize) -> Vec<(usize, Shadow)> {
        let Method::Paper(method) = self.spec.method;
        let (world, mut work) = (self.world(), Workspace::default());
        self.pixels(tile)
            .filter_map(|pixel| Some((pixel, self.hits[pixel]?)))
            .map(|(pixel, hit)| {
                (pixel, shadow(&world, &self.settings, method, hit.point, &self.light, pixel as u64, &mut work))
            })
            .collect()
    }

    fn put_hit(&mut self, pixel: usize, hit: Option<Hit>, cost: Cost) {
        self.hits[pixel] = hit;
        self.stats.pixel_beams += cost.beams;
        self.stats.primary_evaluations += cost.evaluations;
        self.frame.cost[pixel] = clamp_cost(cost.evaluations);
        let Some(hit) = hit else {
            self.stats.proved_empty += u64::from(!self.spec.method.uses_rays());
            // A ray that misses proves nothing about the rest of its pixel.
            let verdict =
                if self.spec.method.uses_rays() { Verdict::Unknown(Reason::Resolution) } else { Verdict::No };
            self.frame.verdict[pixel] = Frame::verdict_code(verdict);
            self.frame.rgb[pixel] = self.backdrop(pixel).map(|c| c as f32);
            return;
        };
        self.stats.hits += 1;
        self.stats.floor_hits += u64::from(hit.floor);
        self.frame.verdict[pixel] = Frame::verdict_code(Verdict::Unknown(Reason::Resolution));
        self.frame.t_lo[pixel] = hit.t.lo();
        self.frame.t_hi[pixel] = hit.t.hi();
        self.frame.normal[pixel] = hit.normal.0.map(|c| c as f32);
        let to_light = (self.light.center - hit.point).normalized();
        self.frame.facing[pixel] = hit.normal.dot(to_light) as f32;
        self.put_color(pixel, &hit, 1.0);
    }

    fn put_shadow(&mut self, pixel: usize, shadow: &Shadow) {
        let Some(hit) = self.hits[pixel] else { return };
        let visible = 1.0 - shadow.index;
        self.frame.visible_lo[pixel] = visible;
        self.frame.visible_hi[pixel] = visible;
        let s = &mut self.stats;
        let class = match visible {
            1.0 => &mut s.lit,
            0.0 => &mut s.dark,
            _ => &mut s.partly,
        };
        *class += 1;
        s.in_shadow_facing += u64::from(visible < 1.0 && self.frame.facing[pixel] > 0.0);
        s.initial_occluded += u64::from(shadow.initial_occluded);
        s.initial_beams += shadow.initial.beams;
        s.beams += shadow.sub.beams;
        let evaluations = shadow.initial.evaluations + shadow.sub.evaluations;
        s.shadow_evaluations += evaluations;
        self.frame.cost[pixel] = clamp_cost(u64::from(self.frame.cost[pixel]) + evaluations);
        self.put_color(pixel, &hit, visible);
    }

    fn backdrop(&self, pixel: usize) -> [f64; 3] {
        let (column, row) = (pixel % self.film.width, pixel / self.film.width);
        shade::backdrop(&self.film, column as f64 + 0.5, row as f64 + 0.5)
    }

    fn put_color(&mut self, pixel: usize, hit: &Hit, visible: f64) {
        let point =
            Point { position: hit.point, normal: hit.normal, outside: hit.outside, floor: hit.floor, visible };
        let eye = self.film.camera.eye;
        let color = shade::shade(&point, self.light.center, eye, self.backdrop(pixel), self.scene.scale());
        self.frame.rgb[pixel] = color.map(|c| c as f32);
    }
}

fn clamp_cost(evaluations: u64) -> u32 {
    u32::try_from(evaluations).unwrap_or(u32::MAX)
}
