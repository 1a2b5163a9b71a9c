//! The certified method on the GPU: surfaces, then each light; what 32 bits cannot prove stays open.
//!
//! A picture is drawn in bands of rows, so that memory is bounded whatever its size; a band in dispatches whose size follows the time
//! that they take.
use crate::device::{Error, Gpu, Pass};
use crate::pace::Pace;
use crate::scene::{self, Frame, Region};
use antumbra::eval::wgsl::{FORMS, Kind};
use antumbra::geom::{Film, Rect};
use antumbra::trace::{Sign, Surface};
use antumbra_interval::Interval;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;
use wgpu::{BindGroup, Buffer, BufferUsages, ComputePipeline};

/// What is proved of a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Pixel {
    /// No ray of it meets a surface.
    Empty,
    /// Every ray meets `surface`; the centre ray meets something for the first time in `t`, namely that surface.
    Hit {
        /// Index of the surface.
        surface: usize,
        /// Where.
        t: Interval,
        /// The sign of its function just before.
        before: Sign,
    },
    /// No ray meets anything before `from`.
    Open {
        /// Where something may begin.
        from: f64,
    },
}

/// What is proved of a picture.
#[derive(Clone, Debug, Default)]
pub struct Proved {
    /// Row by row.
    pub pixels: Vec<Pixel>,
    /// Per light and pixel: bounds of the visible fraction, `[0, 1]` where nothing is known.
    pub lights: Vec<Vec<[f64; 2]>>,
    /// Evaluations for surfaces, and for lights.
    pub evaluations: [u64; 2],
    /// Seconds of the GPU for surfaces, and per light for the whole of it and for each division; empty without a clock.
    pub seconds: Vec<f64>,
    /// Items of work: hits of which the light is divided, and parts that are divided again.
    pub divided: [u64; 2],
}

/// The kernels of one scene, compiled.
pub struct Kernels {
    /// Surfaces, whole light, the light in 8 x 8, each open part in 4 x 4.
    stages: [Stage; 4],
    frame: Frame,
    regions: Vec<Region>,
    lights: Vec<Rect>,
}

struct Stage {
    pipeline: ComputePipeline,
    pace: Pace,
}

/// Divisions of the light, and of each part that stays open.
const SPLIT: [u32; 2] = [8, 4];
/// Threads of a group.
const GROUP: u32 = 64;
/// Parts that a list holds for each pixel of a band; what does not fit is added as it is.
const PARTS: u64 = 4;
/// Pixels of a band, at most, if it has more rows than the 8 of a tile: 104 bytes each, with what is read back 128 MiB in all.
const BAND: u32 = 1 << 20;

/// Whether the GPU can draw these surfaces on a film under lights, without compiling anything.
///
/// # Errors
/// Why the scene stays on the CPU.
pub fn check(surfaces: &[Surface<'_>], film: &Film, lights: &[Rect]) -> Result<(), Error> {
    text(surfaces, film, lights).map(|_| ())
}

/// The numbers of the picture, and the text that all kernels begin with.
fn text(surfaces: &[Surface<'_>], film: &Film, lights: &[Rect]) -> Result<(Frame, Vec<Region>, String), Error> {
    let (frame, regions) = scene::frame(surfaces, film)?;
    let functions = scene::functions(surfaces, &[Kind::Form, Kind::Slope], &frame, film, lights)?;
    Ok((frame, regions, format!("{FORMS}\n{}\n{functions}", include_str!("kernels/frame.wgsl"))))
}

impl Kernels {
    /// Compiles the kernels for surfaces on a film under lights, or takes them from those that the GPU has compiled before.
    ///
    /// # Errors
    /// Why the scene stays on the CPU.
    pub fn new(
        gpu: &Gpu,
        surfaces: &[Surface<'_>],
        film: &Film,
        lights: &[Rect],
        tolerance: f64,
    ) -> Result<Self, Error> {
        let (frame, regions, common) = text(surfaces, film, lights)?;
        let primary = format!("{common}\n{}", include_str!("kernels/primary.wgsl"));
        let shadow = format!("{common}\n{}", include_str!("kernels/shadow.wgsl"));
        let begin = if gpu.is_software() { 64 } else { 4096 };
        let stage = |text: &str, entry: &str, constants: &[(&str, f64)]| -> Result<Stage, Error> {
            Ok(Stage { pipeline: gpu.pipeline(text, entry, constants)?, pace: Pace::new(begin) })
        };
        let cells = |side: u32, split: u32, room: f64| {
            let sizes = [("SIDE", f64::from(side)), ("SPLIT", f64::from(split))];
            stage(&shadow, "cells", &[sizes[0], sizes[1], ("ROOM", room), ("ASPECT", 2.0)])
        };
        // Of the tolerance, as a number of parts.
        let room = tolerance.clamp(1e-4, 0.1) * f64::from(SPLIT[0] * SPLIT[0]);
        let stages = [
            stage(&primary, "primary", &[])?,
            stage(&shadow, "whole", &[])?,
            cells(1, SPLIT[0], room)?,
            // The last division keeps what is unknown as it is.
            cells(SPLIT[0], SPLIT[1], 1e6)?,
        ];
        Ok(Self { stages, frame, regions, lights: lights.to_vec() })
    }

    /// Proves what it can. `stop` is looked at between dispatches; `progress` hears after each of them which part of the work is done, in
    /// `[0, 1]`.
    ///
    /// # Errors
    /// Those of the device.
    pub fn prove(&self, gpu: &Gpu, stop: &AtomicBool, progress: &mut dyn FnMut(f64)) -> Result<Proved, Error> {
        let [width, height] = [self.frame.width, self.frame.height];
        // Whole tiles of 8 x 8 pixels.
        let rows = (BAND / width / 8 * 8).max(8).min(height);
        let mut run = Run::new(gpu, self, rows * width, stop, progress)?;
        for first in (0..height).step_by(rows as usize) {
            run.band(first, rows.min(height - first))?;
        }
        Ok(run.finish())
    }
}

/// The buffers of a band, and what is proved so far.
struct Run<'a> {
    gpu: &'a Gpu,
    kernels: &'a Kernels,
    stop: &'a AtomicBool,
    progress: &'a mut dyn FnMut(f64),
    frame: Buffer,
    found: Buffer,
    lit: Buffer,
    dark: Buffer,
    lists: [Buffer; 2],
    spent: Buffer,
    binds: [BindGroup; 4],
    proved: Proved,
    clocked: bool,
    /// Pixels times passes that are done.
    done: u64,
}

impl<'a> Run<'a> {
    fn new(
        gpu: &'a Gpu,
        kernels: &'a Kernels,
        pixels: u32,
        stop: &'a AtomicBool,
        progress: &'a mut dyn FnMut(f64),
    ) -> Result<Self, Error> {
        let pixels = u64::from(pixels);
        let frame = gpu.filled(bytemuck::bytes_of(&kernels.frame), BufferUsages::UNIFORM)?;
        let regions = gpu.filled(bytemuck::cast_slice(&kernels.regions), BufferUsages::UNIFORM)?;
        let found = gpu.storage(16 * pixels)?;
        let (lit, dark) = (gpu.storage(4 * pixels)?, gpu.storage(4 * pixels)?);
        // Hits to divide: all at most. Then parts.
        let parts = 16 + 16 * PARTS * pixels;
        let lists = [gpu.storage(16 + 16 * pixels)?, gpu.storage(parts)?];
        let spent = gpu.storage(16)?;
        let [surfaces, whole, first, second] = &kernels.stages;
        let common = [(0, &frame), (1, &regions), (2, &found), (3, &lit), (4, &dark)];
        let cells = |stage: &Stage, work, more| {
            let lists: [(u32, &Buffer); 3] = [(5, work), (6, more), (7, &spent)];
            gpu.bind(&stage.pipeline, &[&common[..], &lists].concat())
        };
        let binds = [
            gpu.bind(&surfaces.pipeline, &common[..3])?,
            gpu.bind(&whole.pipeline, &[&common[..], &[(6, &lists[0]), (7, &spent)]].concat())?,
            cells(first, &lists[0], &lists[1])?,
            cells(second, &lists[1], &lists[0])?,
        ];
        let seconds = vec![0.0; 1 + 3 * kernels.lights.len()];
        let proved = Proved { seconds, lights: vec![Vec::new(); kernels.lights.len()], ..Proved::default() };
        let run = Self {
            gpu,
            kernels,
            stop,
            progress,
            frame,
            found,
            lit,
            dark,
            lists,
            spent,
            binds,
            proved,
            clocked: true,
            done: 0,
        };
        Ok(run)
    }

    /// Runs `groups` groups of a stage, each of which does `each` items, in dispatches of the stage's pace. `pixels` of work are then done.
    fn stage(
        &mut self,
        stage: usize,
        place: usize,
        frame: Frame,
        groups: u32,
        each: u32,
        pixels: u64,
    ) -> Result<(), Error> {
        let Stage { pipeline, pace } = &self.kernels.stages[stage];
        let mut first = 0;
        while first < groups {
            if self.stop.load(Ordering::Relaxed) {
                return Err(Error::Stopped);
            }
            let part = pace.next(groups - first);
            // What is past the end of a list is looked at by nobody.
            let count = (part * each).min(frame.count - first * each);
            let frame = Frame { first: frame.first + first * each, count, ..frame };
            self.gpu.write(&self.frame, bytemuck::bytes_of(&frame));
            let begin = Instant::now();
            let times = self.gpu.run(&[Pass { pipeline, bind: &self.binds[stage], groups: [part, 1, 1] }])?;
            pace.took(part, begin.elapsed().as_secs_f64());
            self.clocked &= !times.is_empty();
            self.proved.seconds[place] += times.iter().sum::<f64>();
            first += part;
            self.tell(pixels * u64::from(first) / u64::from(groups));
        }
        self.done += pixels;
        self.tell(0);
        Ok(())
    }

    fn tell(&mut self, more: u64) {
        let whole = self.kernels.frame;
        let passes = 1 + 3 * self.kernels.lights.len() as u64;
        let all = u64::from(whole.width) * u64::from(whole.height) * passes;
        (self.progress)((self.done + more) as f64 / all as f64);
    }

    fn band(&mut self, top: u32, rows: u32) -> Result<(), Error> {
        let whole = self.kernels.frame;
        let pixels = rows * whole.width;
        let work = u64::from(pixels);
        let base = Frame { base: top * whole.width, ..whole };
        let across = whole.width.div_ceil(8);
        let tiles = across * rows.div_ceil(8);
        self.stage(0, 0, Frame { first: top / 8 * across, count: tiles, ..base }, tiles, 1, work)?;
        let mut found: Vec<[u32; 4]> = self.gpu.read(&self.found)?;
        found.truncate(pixels as usize);
        self.proved.evaluations[0] += found.iter().map(|f| u64::from(f[3])).sum::<u64>();
        let quantum = whole.quantum();
        self.proved.pixels.extend(found.iter().map(|f| pixel(f, quantum)));
        for (k, light) in self.kernels.lights.iter().enumerate() {
            let [first, second] = &self.lists;
            self.gpu.clear(&[&self.lit, &self.dark, first, second, &self.spent]);
            let frame = base.lit_by(light);
            let count = Frame { first: 0, count: pixels, ..frame };
            self.stage(1, 3 * k + 1, count, pixels.div_ceil(GROUP), GROUP, work)?;
            for division in 0..SPLIT.len() {
                // Parts that found no place in the list are not in it.
                let list = &self.lists[division];
                let items = self.gpu.read_first(list)?.min(((list.size() - 16) / 16) as u32);
                self.proved.divided[division] += u64::from(items);
                let each = GROUP / SPLIT[division].pow(2);
                let count = Frame { first: 0, count: items, ..frame };
                self.stage(2 + division, 3 * k + 2 + division, count, items.div_ceil(each), each, work)?;
            }
            self.proved.evaluations[1] += u64::from(self.gpu.read_first(&self.spent)?);
            let (lit, dark) = (self.gpu.read::<u32>(&self.lit)?, self.gpu.read::<u32>(&self.dark)?);
            // Sums of integers, exact; what is lit and what is hidden are different parts of the light.
            let share = |n: u32| f64::from(n) / f64::from(1_u32 << 30);
            let brackets = lit.iter().zip(&dark).map(|(l, d)| [share(*l), 1.0 - share(*d)]);
            self.proved.lights[k].extend(brackets.take(pixels as usize));
        }
        Ok(())
    }

    fn finish(mut self) -> Proved {
        if !self.clocked {
            self.proved.seconds.clear();
        }
        self.proved
    }
}

fn pixel([what, a, b, _]: &[u32; 4], quantum: f64) -> Pixel {
    // Exact: whole numbers below 2^24 and a power of two.
    let at = |k: u32| f64::from(k) * quantum;
    match what & 0xff {
        3 => Pixel::Empty,
        1 => Pixel::Hit {
            surface: (what >> 8 & 0xff) as usize,
            t: Interval::new(at(*a), at(*b)),
            before: if what >> 16 == 1 { Sign::Positive } else { Sign::Negative },
        },
        2 => Pixel::Open { from: at(*a) },
        // Nobody has written here.
        _ => Pixel::Open { from: 0.0 },
    }
}
