//! The certified method on the GPU: surfaces, then each light; what 32 bits cannot prove stays open.
//!
//! A picture is drawn in bands of rows, so that memory is bounded whatever its size; a band in dispatches whose size follows the time
//! that they take.
#[cfg(feature = "native")]
use crate::device::{self, Gpu};
use crate::error::Error;
use crate::machine::{Kernel, Machine, Usage};
use crate::pace::Pace;
use crate::receipt::{Receipts, tickets};
use crate::scene::{self, Frame, Region, Upload};
use antumbra::eval::wgsl::{Kind, Width};
use antumbra::geom::{Film, Rect};
use antumbra::trace::{Sign, Surface};
use antumbra_interval::Interval;
use std::sync::atomic::{AtomicBool, Ordering};

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
    /// Seconds of the GPU for surfaces, and per light for the whole of it, its first division and each further one; empty without a clock.
    pub seconds: Vec<f64>,
    /// Items of work: hits of which the light is divided, then parts that each further division looks at again.
    pub divided: [u64; 1 + DIVISIONS],
}

/// The kernels of one scene, compiled.
pub struct Kernels<M: Machine> {
    /// Surfaces, whole light, its first division, each further one.
    stages: Vec<Stage<M::Pipeline>>,
    frame: Frame,
    regions: Vec<Region>,
    /// Of the regions.
    seal: u32,
    lights: Vec<Rect>,
    /// Most pixels of a band, if it has more rows than the 8 of a tile.
    pub(crate) band: u32,
    width: Width,
}

struct Stage<P> {
    pipeline: P,
    pace: Pace,
}

/// Parts of the light along each side, at first.
const SIDE: u32 = 8;
/// How often parts that stay open are divided in 2 x 2.
const DIVISIONS: usize = 2;
/// Stages of one light: the whole, the first division, further ones.
const LIGHT: usize = 2 + DIVISIONS;
const STAGES: usize = 1 + LIGHT;
/// Threads of a group.
const GROUP: u32 = 64;
/// Parts that a list holds for each pixel of a band; what does not fit is not looked at again.
const PARTS: u64 = 2;
/// Bytes of a part, and of what comes before the first one.
const PART: u64 = 32;
const HEAD: u64 = 16;
/// Pixels of a band: 176 bytes each, with what is read back 192 MiB in all.
const BAND: u32 = 1 << 20;

/// Whether the GPU can draw these surfaces on a film under lights, without compiling anything.
///
/// # Errors
/// Why the scene stays on the CPU.
pub fn check(surfaces: &[Surface<'_>], film: &Film, lights: &[Rect]) -> Result<(), Error> {
    text(surfaces, film, lights, Width::Single).map(|_| ())
}

/// The numbers of the picture, and the text that all kernels begin with.
fn text(
    surfaces: &[Surface<'_>],
    film: &Film,
    lights: &[Rect],
    width: Width,
) -> Result<(Frame, Vec<Region>, String), Error> {
    let (frame, regions) = scene::frame(surfaces, film)?;
    let functions = scene::functions(surfaces, width, &[Kind::Form, Kind::Slope], &frame, film, lights)?;
    let common = width.text(include_str!("kernels/frame.wgsl"));
    Ok((frame, regions, format!("{}\n{common}\n{}", width.forms(), width.text(&functions))))
}

impl<M: Machine> Kernels<M> {
    /// Compiles the kernels for surfaces on a film under lights, or takes them from those that the GPU has compiled before.
    ///
    /// # Errors
    /// Why the scene stays on the CPU.
    pub fn new(gpu: &M, surfaces: &[Surface<'_>], film: &Film, lights: &[Rect], tolerance: f64) -> Result<Self, Error> {
        Self::of_width(gpu, surfaces, film, lights, tolerance, Width::Single)
    }

    /// The same with numbers of that width.
    ///
    /// # Errors
    /// As for [`Kernels::new`]; what has no kernels in 64 bits.
    pub fn of_width(
        gpu: &M,
        surfaces: &[Surface<'_>],
        film: &Film,
        lights: &[Rect],
        tolerance: f64,
        width: Width,
    ) -> Result<Self, Error> {
        let (frame, mut regions, common) = text(surfaces, film, lights, width)?;
        let primary = format!("{common}\n{}", width.text(include_str!("kernels/primary.wgsl")));
        let shadow = format!("{common}\n{}", width.text(include_str!("kernels/shadow.wgsl")));
        let begin = if gpu.is_software() { 64 } else { 4096 };
        // Of the tolerance, as a number of parts.
        let room = tolerance.clamp(1e-4, 0.1) * f64::from(SIDE * SIDE);
        let divided = |side: u32, aspect: f64| [("SIDE", f64::from(side)), ("ROOM", room), ("ASPECT", aspect)];
        // Shorter pieces pay where nothing is looked at again.
        let [first, second, third] = [divided(SIDE, 2.0), divided(2 * SIDE, 2.0), divided(4 * SIDE, 1.0)];
        let pipelines = gpu.pipelines(&[
            Kernel { text: &primary, entry: "primary", constants: &[] },
            Kernel { text: &shadow, entry: "whole", constants: &[] },
            Kernel { text: &shadow, entry: "cells", constants: &first },
            Kernel { text: &shadow, entry: "refine", constants: &second },
            Kernel { text: &shadow, entry: "refine", constants: &third },
        ])?;
        let stages = pipelines.into_iter().map(|pipeline| Stage { pipeline, pace: Pace::new(begin) }).collect();
        let seal = scene::seal(&mut regions);
        Ok(Self { stages, frame, regions, seal, lights: lights.to_vec(), band: BAND, width })
    }

    /// Proves what it can. `stop` is looked at between dispatches; `progress` hears after each of them which part of the work is done, in
    /// `[0, 1]`.
    ///
    /// # Errors
    /// Those of the device.
    pub async fn prove_async(
        &self,
        gpu: &M,
        stop: &AtomicBool,
        progress: &mut dyn FnMut(f64),
    ) -> Result<Proved, Error> {
        let [width, height] = [self.frame.width, self.frame.height];
        let rows = self.frame.band(self.band);
        let mut run = Run::new(gpu, self, rows * width, stop, progress)?;
        for first in (0..height).step_by(rows as usize) {
            run.band(first, rows.min(height - first)).await?;
        }
        Ok(run.finish())
    }
}

#[cfg(feature = "native")]
impl Kernels<Gpu> {
    /// [`prove_async`](Self::prove_async), where there is nothing else to be done meanwhile.
    ///
    /// # Errors
    /// Those of the device.
    pub fn prove(&self, gpu: &Gpu, stop: &AtomicBool, progress: &mut dyn FnMut(f64)) -> Result<Proved, Error> {
        device::finish(self.prove_async(gpu, stop, progress))
    }
}

/// The buffers of a band, and what is proved so far.
struct Run<'a, M: Machine> {
    gpu: &'a M,
    kernels: &'a Kernels<M>,
    stop: &'a AtomicBool,
    progress: &'a mut dyn FnMut(f64),
    frame: M::Buffer,
    found: M::Buffer,
    sums: M::Buffer,
    before: M::Buffer,
    hits: M::Buffer,
    parts: [M::Buffer; 2],
    account: M::Buffer,
    handed: Receipts,
    binds: [M::Binding; STAGES],
    proved: Proved,
    clocked: bool,
    /// Pixels times passes that are done.
    done: u64,
}

impl<'a, M: Machine> Run<'a, M> {
    fn new(
        gpu: &'a M,
        kernels: &'a Kernels<M>,
        pixels: u32,
        stop: &'a AtomicBool,
        progress: &'a mut dyn FnMut(f64),
    ) -> Result<Self, Error> {
        let pixels = u64::from(pixels);
        let frame = gpu.filled(&kernels.frame.bytes(kernels.width), Usage::Uniform)?;
        let regions: Vec<u8> = kernels.regions.iter().flat_map(|r| r.bytes(kernels.width)).collect();
        let regions = gpu.filled(&regions, Usage::Uniform)?;
        let storage = |bytes: u64| gpu.buffer(bytes, Usage::Storage);
        let found = storage(16 * pixels)?;
        let [sums, before] = [storage(8 * pixels)?, storage(8 * pixels)?];
        let hits = storage(HEAD + 16 * pixels)?;
        let list = || storage(HEAD + PART * PARTS * pixels);
        let parts = [list()?, list()?];
        let account = storage(16)?;
        let pipeline = |k: usize| &kernels.stages[k].pipeline;
        let common = [(0, &frame), (1, &regions), (2, &found), (9, &account), (3, &sums)];
        let light = |k: usize, more: &[(u32, &M::Buffer)]| gpu.bind(pipeline(k), &[&common[..], more].concat());
        let binds = [
            gpu.bind(pipeline(0), &common[..4])?,
            light(1, &[(5, &hits)])?,
            light(2, &[(5, &hits), (6, &parts[0])])?,
            light(3, &[(4, &before), (6, &parts[1]), (8, &parts[0])])?,
            light(4, &[(4, &before), (6, &parts[0]), (8, &parts[1])])?,
        ];
        let seconds = vec![0.0; 1 + LIGHT * kernels.lights.len()];
        let proved = Proved { seconds, lights: vec![Vec::new(); kernels.lights.len()], ..Proved::default() };
        let run = Self {
            gpu,
            kernels,
            stop,
            progress,
            frame,
            found,
            sums,
            before,
            hits,
            parts,
            account,
            handed: Receipts::default(),
            binds,
            proved,
            clocked: true,
            done: 0,
        };
        Ok(run)
    }

    /// Runs `groups` groups of a stage, each of which does `each` items, in dispatches of the stage's pace. `pixels` of work are then done.
    async fn stage(
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
            let ticket = self.handed.hand_out(part, self.kernels.seal);
            let frame = Frame { first: frame.first + first * each, count, ticket, ..frame };
            self.gpu.write(&self.frame, &frame.bytes(self.kernels.width));
            let begin = self.gpu.seconds();
            let time = self.gpu.run(pipeline, &self.binds[stage], part).await?;
            pace.took(part, self.gpu.seconds() - begin);
            self.clocked &= time.is_some();
            self.proved.seconds[place] += time.unwrap_or(0.0);
            first += part;
            self.tell(pixels * u64::from(first) / u64::from(groups));
        }
        self.done += pixels;
        self.tell(0);
        Ok(())
    }

    fn tell(&mut self, more: u64) {
        let whole = self.kernels.frame;
        let passes = (1 + LIGHT * self.kernels.lights.len()) as u64;
        let all = u64::from(whole.width) * u64::from(whole.height) * passes;
        (self.progress)((self.done + more) as f64 / all as f64);
    }

    async fn band(&mut self, top: u32, rows: u32) -> Result<(), Error> {
        let whole = self.kernels.frame;
        let pixels = rows * whole.width;
        let work = u64::from(pixels);
        let base = Frame { base: top * whole.width, ..whole };
        let across = whole.width.div_ceil(8);
        let tiles = across * rows.div_ceil(8);
        self.stage(0, 0, Frame { first: top / 8 * across, count: tiles, ..base }, tiles, 1, work).await?;
        let mut found: Vec<[u32; 4]> = self.gpu.read_all(&self.found).await?;
        let mut spent = self.settle().await?;
        found.truncate(pixels as usize);
        self.proved.evaluations[0] += found.iter().map(|f| u64::from(f[3])).sum::<u64>();
        let quantum = whole.quantum();
        self.proved.pixels.extend(found.iter().map(|f| pixel(f, quantum)));
        for (k, light) in self.kernels.lights.iter().enumerate() {
            self.gpu.clear(&[&self.hits, &self.parts[0]]);
            let frame = Frame { series: tickets(1), ..base.lit_by(light) };
            let place = 1 + LIGHT * k;
            let all = Frame { first: 0, count: pixels, ..frame };
            self.stage(1, place, all, pixels.div_ceil(GROUP), GROUP, work).await?;
            let hits = self.items(&self.hits, 16).await?;
            self.proved.divided[0] += u64::from(hits);
            self.stage(2, place + 1, Frame { first: 0, count: hits, ..frame }, hits, 1, work).await?;
            for division in 0..DIVISIONS {
                let list = &self.parts[division % 2];
                let parts = self.items(list, PART).await?;
                self.proved.divided[1 + division] += u64::from(parts);
                self.gpu.copy(&self.sums, &self.before);
                self.gpu.clear(&[&self.parts[(division + 1) % 2]]);
                let count = Frame { first: 0, count: parts, ..frame };
                self.stage(3 + division, place + 2 + division, count, parts.div_ceil(GROUP / 4), GROUP / 4, work)
                    .await?;
            }
            let sums: Vec<[u32; 2]> = self.gpu.read_all(&self.sums).await?;
            let before = spent;
            spent = self.settle().await?;
            self.proved.evaluations[1] += u64::from(spent.wrapping_sub(before));
            // Sums of integers, exact; what is lit and what is hidden are different parts of the light.
            let share = |n: u32| f64::from(n) / f64::from(1_u32 << 30);
            let brackets = sums.iter().map(|[lit, dark]| [share(*lit), 1.0 - share(*dark)]);
            self.proved.lights[k].extend(brackets.take(pixels as usize));
        }
        Ok(())
    }

    /// Sees to it that everything was done so far, and tells how many evaluations lights have taken.
    async fn settle(&self) -> Result<u32, Error> {
        let [receipts, evaluations, ..] = self.gpu.read::<[u32; 4]>(&self.account, 16).await?[0];
        if self.handed.is_sum(receipts) { Ok(evaluations) } else { Err(Receipts::missing()) }
    }

    /// How many items of so many bytes a list holds; those that found no place are not in it.
    async fn items(&self, list: &M::Buffer, bytes: u64) -> Result<u32, Error> {
        Ok(self.gpu.read_first(list).await?.min(((self.gpu.size(list) - HEAD) / bytes) as u32))
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
