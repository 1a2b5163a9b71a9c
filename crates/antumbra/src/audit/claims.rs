//! Which claims of a frame are asked, of which rays.
use super::precise::{Big, Scratch};
use super::ray::{Judge, Ray, Seen};
use crate::expr;
use crate::geom::{Camera, Rect};
use crate::render::{Crew, Error, Frame, RunSpec};
use crate::scene::Scene;
use fastrand::Rng;
use rayon::prelude::*;
use serde::Serialize;
use std::collections::BTreeMap;

/// What to ask.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AuditSpec {
    /// Pixels to look at.
    pub pixels: usize,
    /// Seed of the choice of pixels and rays.
    pub seed: u64,
    /// Factor on the edges of the lights with which the frame was made.
    pub light_scale: f64,
    /// Whether it has the floor.
    pub floor: bool,
}

/// Kinds of claims.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// A ray of a pixel that is proved empty meets nothing.
    Empty,
    /// The centre ray meets a surface in `[t_lo, t_hi]`.
    Hit,
    /// ... and nothing before.
    Before,
    /// The centre ray of a pixel that is proved to be hit by other rays only meets nothing.
    CentreFree,
    /// A ray of a pixel whose rays are all proved to meet a surface does.
    Covered,
    /// The share of rays that meet a surface is within the bounds.
    Coverage,
    /// A point of a light that is proved to be visible as a whole is.
    Lit,
    /// A point of a light that is proved to be hidden is.
    Dark,
    /// The visible share of a light, sampled on a grid of rays, is within its bracket.
    Bracket,
}

/// Answers to one kind of claim.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Tally {
    /// Rays (or, for shares, grids of rays) that were asked.
    pub claims: u64,
    /// Rays followed for them.
    pub rays: u64,
    /// Claims on which the audit cannot tell: f comes too near to zero, or is undefined on the way.
    pub unclear: u64,
    /// Claims found to be wrong.
    pub violations: u64,
}

/// What an audit found.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Report {
    /// Pixels looked at.
    pub pixels: usize,
    /// Answers by kind.
    pub kinds: BTreeMap<Kind, Tally>,
    /// Each violation in words, by pixel.
    pub violations: Vec<String>,
}

impl Report {
    /// All kinds together.
    #[must_use]
    pub fn total(&self) -> Tally {
        self.kinds.values().fold(Tally::default(), |a, b| Tally {
            claims: a.claims + b.claims,
            rays: a.rays + b.rays,
            unclear: a.unclear + b.unclear,
            violations: a.violations + b.violations,
        })
    }

    fn merge(&mut self, other: Self) {
        self.pixels += other.pixels;
        for (kind, tally) in other.kinds {
            let sum = self.kinds.entry(kind).or_default();
            sum.claims += tally.claims;
            sum.rays += tally.rays;
            sum.unclear += tally.unclear;
            sum.violations += tally.violations;
        }
        self.violations.extend(other.violations);
    }

    fn note(&mut self, kind: Kind, rays: usize, answer: Answer, what: impl FnOnce() -> String) {
        let tally = self.kinds.entry(kind).or_default();
        tally.claims += 1;
        tally.rays += rays as u64;
        match answer {
            Answer::Agrees => {}
            Answer::Unclear => tally.unclear += 1,
            Answer::Contradicts => {
                tally.violations += 1;
                self.violations.push(what());
            }
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Answer {
    Agrees,
    Unclear,
    Contradicts,
}

/// Rays of an empty or covered pixel that are asked.
const RAYS: usize = 16;
/// Points of a light that are asked where it is lit or dark.
const POINTS: usize = 32;
/// Cells along each side of a pixel for shares of its rays.
const PIXEL_GRID: usize = 8;
/// Cells along each side of a light for shares of it ...
const LIGHT_GRID: usize = 16;
/// ... and at a second look, before a violation is reported.
const FINE_GRID: usize = 64;
/// A search that has missed what a claim promises is made again with this many times the sections.
const FINE: usize = 24;

/// An audit that goes on from pixel to pixel.
pub struct Audit<'a> {
    scene: &'a Scene,
    frame: &'a Frame,
    spec: AuditSpec,
    camera: Camera,
    crew: Crew,
    chosen: Vec<usize>,
    next: usize,
    report: Report,
}

impl<'a> Audit<'a> {
    /// Chooses the pixels: as many empty ones, hits in full light or in the dark, hits in penumbrae, and edges or undecided
    /// pixels, as far as there are.
    ///
    /// # Errors
    /// Where the threads cannot be started.
    pub fn new(scene: &'a Scene, frame: &'a Frame, spec: AuditSpec, run: RunSpec) -> Result<Self, Error> {
        let crew = run.crew()?;
        let mut random = Rng::with_seed(spec.seed);
        let partly = |i: usize| frame.lights.iter().any(|l| l.visible_hi[i] > 0.0 && l.visible_lo[i] < 1.0);
        let mut classes: [Vec<usize>; 4] = Default::default();
        for i in 0..frame.verdict.len() {
            let class = match frame.verdict[i] {
                0 => 0,
                1 if partly(i) => 2,
                1 => 1,
                _ => 3,
            };
            classes[class].push(i);
        }
        let filled: Vec<&Vec<usize>> = classes.iter().filter(|c| !c.is_empty()).collect();
        let chosen = (0..if filled.is_empty() { 0 } else { spec.pixels })
            .filter_map(|k| random.choice(filled[k % filled.len()]).copied())
            .collect();
        let camera = scene.view.camera(frame.width as f64 / frame.height as f64);
        Ok(Self { scene, frame, spec, camera, crew, chosen, next: 0, report: Report::default() })
    }

    /// Looks at some more pixels, on all threads; tells whether it is finished.
    ///
    /// # Errors
    /// Where a formula of the scene cannot be read.
    pub fn step(&mut self) -> Result<bool, expr::Error> {
        let end = (self.next + 64).min(self.chosen.len());
        let batch: Vec<(usize, usize)> = (self.next..end).map(|k| (k, self.chosen[k])).collect();
        let this = &*self;
        let reports: Result<Vec<Report>, expr::Error> =
            self.crew.install(|| batch.par_chunks(8).map(|part| this.pixels(part)).collect());
        reports?.into_iter().for_each(|report| self.report.merge(report));
        self.next = end;
        Ok(end == self.chosen.len())
    }

    /// Share of the pixels that have been looked at.
    #[must_use]
    pub fn progress(&self) -> f64 {
        self.next as f64 / self.chosen.len().max(1) as f64
    }

    /// What was found so far.
    #[must_use]
    pub fn report(&self) -> &Report {
        &self.report
    }

    fn pixels(&self, part: &[(usize, usize)]) -> Result<Report, expr::Error> {
        let mut report = Report::default();
        let Some(mut s) = Scratch::new() else { return Ok(report) };
        let floor = self.spec.floor.then(|| self.scene.floor().ok()).flatten();
        let objects = self.scene.objects.iter().chain(&floor);
        let judges = objects.map(|o| Judge::new(o, &mut s)).collect::<Result<Vec<_>, _>>()?;
        for &(place, index) in part {
            // Every pixel has its own rays, whatever the threads do.
            let random = Rng::with_seed(self.spec.seed ^ (place as u64) << 20 ^ index as u64);
            Pixel { audit: self, judges: &judges, index, random, s: &mut s, report: &mut report }.look();
        }
        Ok(report)
    }
}

struct Pixel<'a> {
    audit: &'a Audit<'a>,
    judges: &'a [Judge],
    index: usize,
    random: Rng,
    s: &'a mut Scratch,
    report: &'a mut Report,
}

impl Pixel<'_> {
    fn look(&mut self) {
        self.report.pixels += 1;
        let frame = self.audit.frame;
        match frame.verdict[self.index] {
            0 => {
                for k in 0..RAYS {
                    let at = self.place(k);
                    self.expect_free(Kind::Empty, at);
                }
            }
            1 => self.hit(),
            Frame::PARTLY => self.expect_free(Kind::CentreFree, [0.5, 0.5]),
            _ => {}
        }
        if frame.verdict[self.index] != 0 {
            self.coverage();
        }
    }

    /// The four corners, then random places of the pixel.
    fn place(&mut self, k: usize) -> [f64; 2] {
        match k {
            0..4 => [(k % 2) as f64, (k / 2) as f64],
            _ => [self.random.f64(), self.random.f64()],
        }
    }

    /// The camera's ray through a place of the pixel, from its upper left corner.
    fn ray(&self, [x, y]: [f64; 2]) -> Ray {
        let Audit { frame, camera, .. } = self.audit;
        let film = |cell: usize, part: f64, n: usize| {
            let place = Big::from(cell as f64).add(&part.into()).mul(&2.0.into());
            place.div(&(n as f64).into()).sub(&1.0.into())
        };
        let x = film(self.index % frame.width, x, frame.width);
        let y = Big::from(0.0).sub(&film(self.index / frame.width, y, frame.height));
        let direction = std::array::from_fn(|k| {
            let [forward, right, up] = [camera.forward, camera.right, camera.up].map(|v| Big::from(v[k]));
            forward.add(&x.mul(&right)).add(&y.mul(&up))
        });
        Ray::new(camera.eye.0.map(Big::from), direction)
    }

    /// What the ray meets between two parameters.
    fn meets(&mut self, ray: &Ray, range: [f64; 2], fine: usize) -> Seen {
        let mut all = Seen::Clear;
        for judge in self.judges {
            match judge.follow(ray, range, None, fine, self.s) {
                Seen::Zero(section) => return Seen::Zero(section),
                Seen::Unclear => all = Seen::Unclear,
                Seen::Clear => {}
            }
        }
        all
    }

    /// Far enough for every clip.
    fn far(&self) -> f64 {
        let eye = self.audit.camera.eye;
        4.0 * (eye.length() + self.audit.scene.scale() * Scene::FLOOR_REACH)
    }

    fn expect_free(&mut self, kind: Kind, at: [f64; 2]) {
        let (ray, far) = (self.ray(at), self.far());
        let seen = self.meets(&ray, [0.0, far], 1);
        let answer = match seen {
            Seen::Clear => Answer::Agrees,
            Seen::Unclear => Answer::Unclear,
            Seen::Zero(_) => Answer::Contradicts,
        };
        let index = self.index;
        self.report.note(kind, 1, answer, || format!("pixel {index}: the ray at {at:?} meets a surface: {seen:?}"));
    }

    fn hit(&mut self) {
        let frame = self.audit.frame;
        let (index, ray) = (self.index, self.ray([0.5, 0.5]));
        let ends = [frame.t_lo[index], frame.t_hi[index]];
        let mut found = (Answer::Contradicts, None);
        for (own, judge) in self.judges.iter().enumerate() {
            match judge.zero_in(&ray, ends, self.s) {
                Seen::Zero(_) if judge.holds(&ray.at(&ends[0].into()), 1e-9 * ends[1]) => {
                    found = (Answer::Agrees, Some(own));
                    break;
                }
                Seen::Unclear => found = (Answer::Unclear, None),
                _ => {}
            }
        }
        self.report.note(Kind::Hit, 1, found.0, || format!("pixel {index}: no surface at t in {ends:?}"));
        // Up to just before the meeting.
        let seen = self.meets(&ray, [0.0, ends[0] * (1.0 - 1e-9)], 1);
        let answer = match seen {
            Seen::Clear => Answer::Agrees,
            Seen::Unclear => Answer::Unclear,
            Seen::Zero(_) => Answer::Contradicts,
        };
        self.report.note(Kind::Before, 1, answer, || format!("pixel {index}: {seen:?} before the hit at {ends:?}"));
        // Where the light comes from needs the very point; only a change of sign gives it.
        if let Some(own) = found.1
            && let Some((point, side)) = self.judges[own].root(&ray, ends, self.s)
        {
            for light in 0..frame.lights.len() {
                self.light(light, own, &point, side);
            }
        }
    }

    /// Whether the point `(u, v)` of a light is visible.
    fn sees(
        &mut self,
        rect: &Rect,
        [u, v]: [f64; 2],
        own: usize,
        p: &[Big; 3],
        side: f64,
        fine: usize,
    ) -> Option<bool> {
        let direction = std::array::from_fn(|k| {
            let [c, a, b] = [rect.center, rect.edge_u, rect.edge_v].map(|x| Big::from(x[k]));
            c.add(&a.mul(&u.into())).add(&b.mul(&v.into())).sub(&p[k])
        });
        let ray = Ray::new(p.clone(), direction);
        let mut known = true;
        for (index, judge) in self.judges.iter().enumerate() {
            match judge.follow(&ray, [0.0, 1.0], (index == own).then_some(side), fine, self.s) {
                Seen::Zero(_) => return Some(false),
                Seen::Unclear => known = false,
                Seen::Clear => {}
            }
        }
        known.then_some(true)
    }

    fn light(&mut self, light: usize, own: usize, p: &[Big; 3], side: f64) {
        let (index, planes) = (self.index, &self.audit.frame.lights[light]);
        let (lo, hi) = (planes.visible_lo[index], planes.visible_hi[index]);
        let rect = self.audit.scene.lights[light].rect.scaled(self.audit.spec.light_scale);
        if !(lo == 1.0 || hi == 0.0) {
            let agree = |[least, most]: [f64; 2], n: usize| {
                // An edge may pass unseen through a few cells whose corners agree.
                let slack = 3.0 / (n * n) as f64;
                lo <= most + slack && hi >= least - slack
            };
            let mut shares = self.shares(&rect, own, p, side, LIGHT_GRID);
            let mut answer = Answer::Agrees;
            if !agree(shares, LIGHT_GRID) {
                shares = self.shares(&rect, own, p, side, FINE_GRID);
                answer = if agree(shares, FINE_GRID) { Answer::Unclear } else { Answer::Contradicts };
            }
            let rays = (LIGHT_GRID + 1) * (LIGHT_GRID + 1);
            return self.report.note(Kind::Bracket, rays, answer, || {
                format!("pixel {index}, light {light}: the bracket [{lo}, {hi}] against {shares:?} by sampling")
            });
        }
        let (lit, kind) = if lo == 1.0 { (true, Kind::Lit) } else { (false, Kind::Dark) };
        for _ in 0..POINTS {
            // Not the very border: what is lit up to a set without area may be tangent there.
            let at: [f64; 2] = std::array::from_fn(|_| 0.999 * (2.0 * self.random.f64() - 1.0));
            let mut seen = self.sees(&rect, at, own, p, side, 1);
            if seen == Some(!lit) && !lit {
                seen = self.sees(&rect, at, own, p, side, FINE);
            }
            let answer = match seen {
                None => Answer::Unclear,
                Some(seen) if seen == lit => Answer::Agrees,
                Some(_) => Answer::Contradicts,
            };
            self.report.note(kind, 1, answer, || {
                format!(
                    "pixel {index}, light {light} at {at:?}: the bracket is [{lo}, {hi}], that point says otherwise"
                )
            });
        }
    }

    /// Bounds of the visible share of a light, by the corners of `n x n` cells.
    fn shares(&mut self, rect: &Rect, own: usize, p: &[Big; 3], side: f64, n: usize) -> [f64; 2] {
        let place = |k: usize| 2.0 * k as f64 / n as f64 - 1.0;
        let corners: Vec<Option<bool>> = (0..(n + 1) * (n + 1))
            .map(|k| self.sees(rect, [place(k % (n + 1)), place(k / (n + 1))], own, p, side, 1))
            .collect();
        let (mut sure, mut open) = (0, 0);
        for j in 0..n {
            for i in 0..n {
                let k = j * (n + 1) + i;
                let cell = [corners[k], corners[k + 1], corners[k + n + 1], corners[k + n + 2]];
                sure += usize::from(cell == [Some(true); 4]);
                open += usize::from(cell != [Some(true); 4] && cell != [Some(false); 4]);
            }
        }
        let cell = 1.0 / (n * n) as f64;
        [sure as f64 * cell, (sure + open) as f64 * cell]
    }

    fn coverage(&mut self) {
        let (index, frame, far) = (self.index, self.audit.frame, self.far());
        let (lo, hi) = (frame.coverage_lo[index], frame.coverage_hi[index]);
        if lo == 1.0 {
            for k in 0..RAYS {
                let at = self.place(k);
                let ray = self.ray(at);
                let mut seen = self.meets(&ray, [0.0, far], 1);
                if seen == Seen::Clear {
                    seen = self.meets(&ray, [0.0, far], FINE);
                }
                let answer = match seen {
                    Seen::Zero(_) => Answer::Agrees,
                    Seen::Unclear => Answer::Unclear,
                    Seen::Clear => Answer::Contradicts,
                };
                self.report
                    .note(Kind::Covered, 1, answer, || format!("pixel {index}: the ray at {at:?} meets nothing"));
            }
        } else if lo > 0.0 || hi < 1.0 {
            let (mut sure, mut open, n) = (0, 0, PIXEL_GRID);
            for k in 0..n * n {
                let at = [k % n, k / n].map(|c| (c as f64 + self.random.f64()) / n as f64);
                let ray = self.ray(at);
                match self.meets(&ray, [0.0, far], 1) {
                    Seen::Zero(_) => sure += 1,
                    Seen::Unclear => open += 1,
                    Seen::Clear => {}
                }
            }
            // One random ray per cell: a straight edge crosses at most 2n cells, in each of which it may go either way.
            let (cells, slack) = ((n * n) as f64, 2.0 / n as f64);
            let shares = [f64::from(sure) / cells, f64::from(sure + open) / cells];
            let agree = lo <= shares[1] + slack && hi >= shares[0] - slack;
            let answer = if agree { Answer::Agrees } else { Answer::Contradicts };
            self.report.note(Kind::Coverage, n * n, answer, || {
                format!("pixel {index}: the coverage [{lo}, {hi}] against {shares:?} by sampling")
            });
        }
    }
}
