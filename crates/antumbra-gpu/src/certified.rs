//! The certified method on the GPU: surfaces, then each light; what 32 bits cannot prove stays open.
use crate::device::{Error, Gpu, Pass};
use crate::scene::{self, Frame, Region};
use antumbra::eval::wgsl::{FORMS, Kind};
use antumbra::geom::{Film, Rect};
use antumbra::trace::{Sign, Surface};
use antumbra_interval::Interval;
use std::sync::atomic::{AtomicBool, Ordering};
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
    primary: ComputePipeline,
    whole: ComputePipeline,
    /// The light in 8 x 8, then each open part in 4 x 4.
    cells: [ComputePipeline; 2],
    frame: Frame,
    regions: Vec<Region>,
    lights: Vec<Rect>,
}

/// Divisions of the light, and of each part that stays open.
const SPLIT: [u32; 2] = [8, 4];
/// Parts that a list holds for each pixel of the picture; what does not fit is added as it is.
const PARTS: u64 = 4;
/// Groups of a pass over a list: enough to fill any GPU, they go on until the list is done.
const GROUPS: u32 = 8192;
/// Pixels of one dispatch: more would keep a slow GPU too long for its watchdog.
const PIXELS: u32 = 1 << 20;

impl Kernels {
    /// Compiles the kernels for surfaces on a film under lights.
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
        let (frame, regions) = scene::frame(surfaces, film)?;
        let functions = scene::functions(surfaces, &[Kind::Form, Kind::Slope], &frame, film, lights)?;
        let common = format!("{FORMS}\n{}\n{functions}", include_str!("kernels/frame.wgsl"));
        let primary = gpu.module(&format!("{common}\n{}", include_str!("kernels/primary.wgsl")))?;
        let shadow = gpu.module(&format!("{common}\n{}", include_str!("kernels/shadow.wgsl")))?;
        let rest = tolerance.clamp(1e-4, 0.1);
        let cells = |side: u32, split: u32, rest: f64, aspect: f64| {
            gpu.pipeline(
                &shadow,
                "cells",
                &[("SIDE", f64::from(side)), ("SPLIT", f64::from(split)), ("REST", rest), ("ASPECT", aspect)],
            )
        };
        Ok(Self {
            primary: gpu.pipeline(&primary, "primary", &[])?,
            whole: gpu.pipeline(&shadow, "whole", &[])?,
            // The last division keeps what is unknown as it is.
            cells: [cells(1, SPLIT[0], rest, 2.0)?, cells(SPLIT[0], SPLIT[1], 2.0, 2.0)?],
            frame,
            regions,
            lights: lights.to_vec(),
        })
    }

    /// Proves what it can. `stop` is looked at between dispatches.
    ///
    /// # Errors
    /// Those of the device.
    pub fn prove(&self, gpu: &Gpu, stop: &AtomicBool) -> Result<Proved, Error> {
        Run::new(gpu, self)?.all(stop)
    }
}

/// The buffers of one picture.
struct Run<'a> {
    gpu: &'a Gpu,
    kernels: &'a Kernels,
    count: u32,
    frame: Buffer,
    found: Buffer,
    lit: Buffer,
    dark: Buffer,
    lists: [Buffer; 2],
    spent: Buffer,
    primary: BindGroup,
    whole: BindGroup,
    cells: [BindGroup; 2],
}

impl<'a> Run<'a> {
    fn new(gpu: &'a Gpu, kernels: &'a Kernels) -> Result<Self, Error> {
        let count = kernels.frame.width * kernels.frame.height;
        let pixels = u64::from(count);
        let frame = gpu.filled(bytemuck::bytes_of(&kernels.frame), BufferUsages::UNIFORM)?;
        let regions = gpu.filled(bytemuck::cast_slice(&kernels.regions), BufferUsages::UNIFORM)?;
        let found = gpu.storage(16 * pixels)?;
        let (lit, dark) = (gpu.storage(4 * pixels)?, gpu.storage(4 * pixels)?);
        // Hits to divide: all at most. Then parts.
        let parts = 16 + 16 * PARTS * pixels;
        let lists = [gpu.storage(16 + 16 * pixels)?, gpu.storage(parts)?];
        let spent = gpu.storage(16)?;
        let primary = gpu.bind(&kernels.primary, &[(0, &frame), (1, &regions), (2, &found)])?;
        let whole = gpu.bind(
            &kernels.whole,
            &[(0, &frame), (1, &regions), (2, &found), (3, &lit), (4, &dark), (6, &lists[0]), (7, &spent)],
        )?;
        let cells = |k: usize, work: &Buffer, more: &Buffer| {
            let buffers =
                [(0, &frame), (1, &regions), (2, &found), (3, &lit), (4, &dark), (5, work), (6, more), (7, &spent)];
            gpu.bind(&kernels.cells[k], &buffers)
        };
        let cells = [cells(0, &lists[0], &lists[1])?, cells(1, &lists[1], &lists[0])?];
        Ok(Self { gpu, kernels, count, frame, found, lit, dark, lists, spent, primary, whole, cells })
    }

    fn all(&self, stop: &AtomicBool) -> Result<Proved, Error> {
        let mut proved = Proved { seconds: vec![0.0], ..Proved::default() };
        let mut clocked = true;
        let mut book = |proved: &mut Proved, at: usize, times: Vec<f64>| {
            clocked &= !times.is_empty();
            proved.seconds.resize(proved.seconds.len().max(at + 1), 0.0);
            proved.seconds[at] += times.iter().sum::<f64>();
        };
        let go = || if stop.load(Ordering::Relaxed) { Err(Error::Stopped) } else { Ok(()) };
        let frame = self.kernels.frame;
        let tiles = frame.width.div_ceil(8) * frame.height.div_ceil(8);
        for first in (0..tiles).step_by((PIXELS / 64) as usize) {
            go()?;
            self.gpu.write(&self.frame, bytemuck::bytes_of(&Frame { first, ..frame }));
            let groups = [(tiles - first).min(PIXELS / 64), 1, 1];
            let times = self.gpu.run(&[Pass { pipeline: &self.kernels.primary, bind: &self.primary, groups }])?;
            book(&mut proved, 0, times);
        }
        let found: Vec<[u32; 4]> = self.gpu.read(&self.found)?;
        proved.evaluations[0] = found.iter().map(|f| u64::from(f[3])).sum();
        proved.pixels = found.iter().map(|f| self.pixel(f)).collect();
        for (k, light) in self.kernels.lights.iter().enumerate() {
            let [first, second] = &self.lists;
            self.gpu.clear(&[&self.lit, &self.dark, first, second, &self.spent]);
            let frame = frame.lit_by(k, light);
            for first in (0..self.count).step_by(PIXELS as usize) {
                go()?;
                let count = (self.count - first).min(PIXELS);
                self.gpu.write(&self.frame, bytemuck::bytes_of(&Frame { first, count, ..frame }));
                let groups = [count.div_ceil(64), 1, 1];
                let times = self.gpu.run(&[Pass { pipeline: &self.kernels.whole, bind: &self.whole, groups }])?;
                book(&mut proved, 3 * k + 1, times);
            }
            for division in 0..SPLIT.len() {
                go()?;
                let groups = [if self.gpu.is_software() { GROUPS / 64 } else { GROUPS }, 1, 1];
                let pass = Pass { pipeline: &self.kernels.cells[division], bind: &self.cells[division], groups };
                let times = self.gpu.run(&[pass])?;
                book(&mut proved, 3 * k + 2 + division, times);
                let list: u32 = self.gpu.read_first(&self.lists[division])?;
                proved.divided[division] += u64::from(list);
            }
            proved.evaluations[1] += u64::from(self.gpu.read_first(&self.spent)?);
            let (lit, dark) = (self.gpu.read::<u32>(&self.lit)?, self.gpu.read::<u32>(&self.dark)?);
            // Sums of integers, exact; what is lit and what is hidden are different parts of the light.
            let share = |n: u32| f64::from(n) / f64::from(1_u32 << 30);
            proved.lights.push(lit.iter().zip(&dark).map(|(l, d)| [share(*l), 1.0 - share(*d)]).collect());
        }
        if !clocked {
            proved.seconds.clear();
        }
        Ok(proved)
    }

    fn pixel(&self, [what, a, b, _]: &[u32; 4]) -> Pixel {
        let quantum = self.kernels.frame.quantum();
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
}
