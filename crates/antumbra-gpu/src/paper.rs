//! The paper's method on the GPU: grid, beam casting, initial shadow beams, sub-beams.
#[cfg(feature = "native")]
use crate::device::{self, Gpu};
use crate::error::Error;
use crate::machine::{Kernel, Machine, Usage};
use crate::pace::Pace;
use crate::receipt::{Receipts, seal, tickets};
use crate::scene::{self, Frame, Region};
use antumbra::eval::wgsl::{FORMS, INTERVALS, Kind, Width, outward};
use antumbra::geom::Rect;
use antumbra::paper;
use antumbra::render::{Method, Question, Traced, TracedLight, TracedPixel};
use antumbra_interval::Interval;
use bytemuck::{Pod, Zeroable};
use std::sync::atomic::{AtomicBool, Ordering};

/// What the paper's method finds of a picture.
#[derive(Clone, Debug)]
pub struct Found {
    /// Sections, sub-beams, evaluations.
    pub traced: Traced,
    /// Seconds of the GPU for the grid, pixel beams, initial beams, sub-beams; empty without a clock.
    pub seconds: Vec<f64>,
}

/// `Paper` of `paper.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
struct Constants {
    cells: u32,
    sub_beams: u32,
    always: u32,
    far: f32,
    width: f32,
    offset: f32,
    seal: u32,
    pad: u32,
}

/// The paper's method for one picture, compiled.
pub struct Paper<M: Machine> {
    kernels: Vec<M::Pipeline>,
    paces: [Pace; STAGES],
    frame: Frame,
    regions: Vec<Region>,
    lights: Vec<Rect>,
    slabs: Vec<[f32; 2]>,
    /// Cells of all surfaces.
    cells: u32,
    constants: Constants,
    /// What the seals of all these make together.
    seal: u32,
    /// Most pixels of a band, if it has more rows than the 8 of a tile.
    pub(crate) band: u32,
}

const STAGES: usize = 4;
/// Places of the stages.
const GRID: usize = 0;
const PIXELS: usize = 1;
const INITIAL: usize = 2;
const SUB_BEAMS: usize = 3;
/// What each of them binds.
const USED: [&[u32]; STAGES] =
    [&[0, 1, 2, 3, 4, 9], &[0, 1, 2, 3, 4, 5, 9], &[0, 1, 2, 3, 4, 5, 6, 7, 9], &[0, 1, 2, 3, 4, 5, 6, 7, 9]];
/// Threads of a group.
const GROUP: u32 = 64;
/// Pixels of a band: 40 bytes each, and what is read back.
const BAND: u32 = 1 << 20;
/// Most cells of all grids: 2^31 bits.
const CELLS: usize = 1 << 31;
/// Bytes of a list before its items, and of an item.
const HEAD: u64 = 8;
const ITEM: u64 = 8;

impl<M: Machine> Paper<M> {
    /// Compiles it for a picture.
    ///
    /// # Errors
    /// Why the picture stays on the CPU: another method than [`paper::Method::Initial`] and [`paper::Method::Fixed`], a floor, a formula without
    /// kernels, a grid that is too fine.
    pub fn new(gpu: &M, question: &Question<'_>) -> Result<Self, Error> {
        let Question { surfaces, film, lights, settings, .. } = question;
        let always = match question.method {
            Method::Paper(paper::Method::Initial) => false,
            Method::Paper(paper::Method::Fixed) => true,
            _ => return Err(Error::Scene("of the paper's methods the GPU has `paper` and `fixed49`")),
        };
        if question.floor {
            return Err(Error::Scene("in the paper's methods a floor stays on the processor"));
        }
        let n = question.cells;
        let cells = n.checked_pow(3).and_then(|cube| cube.checked_mul(surfaces.len())).filter(|cells| *cells < CELLS);
        let cells = cells.filter(|cells| *cells > 0).and_then(|cells| u32::try_from(cells).ok());
        let cells = cells.ok_or(Error::Scene("a grid has cells, and on the GPU less than 2^31"))?;
        let (frame, mut regions) = scene::frame(surfaces, film)?;
        let kinds = [Kind::Form, Kind::Interval];
        let functions = scene::functions(surfaces, Width::Single, &kinds, &frame, film, lights)?;
        let [common, kernel] = [include_str!("kernels/frame.wgsl"), include_str!("kernels/paper.wgsl")];
        let text = format!("{FORMS}\n{INTERVALS}\n{common}\n{functions}\n{kernel}");
        let passes: [_; STAGES] = ["grid", "pixels", "initial", "sub_beams"];
        let kernels = gpu.pipelines(&passes.map(|entry| Kernel { text: &text, entry, constants: &[] }))?;
        let begin = if gpu.is_software() { 64 } else { 4096 };
        let mut slabs = Vec::with_capacity(3 * n * surfaces.len());
        for surface in surfaces {
            let bounds = surface.clip.bounds();
            for axis in 0..3 {
                let (lo, hi) = (Interval::point(bounds[axis].lo()), Interval::point(bounds[axis].hi()));
                let edge = |k: usize| lo + (hi - lo) * (Interval::point(k as f64) / Interval::point(n as f64));
                slabs.extend((0..n).map(|k| outward(edge(k).hull(edge(k + 1)))));
            }
        }
        // A last element, which is no slab.
        let seals = [scene::seal(&mut regions), seal(), seal()];
        slabs.push([seals[1] as f32; 2]);
        let constants = Constants {
            cells: n as u32,
            sub_beams: settings.sub_beams as u32,
            always: u32::from(always),
            far: outward(Interval::point(frame.quantum() * f64::from(frame.end)))[1],
            width: settings.bisection.width as f32,
            offset: settings.offset as f32,
            seal: seals[2],
            pad: 0,
        };
        let paces = std::array::from_fn(|_| Pace::new(begin));
        let seal = seals.iter().sum();
        Ok(Self { kernels, paces, frame, regions, lights: lights.clone(), slabs, cells, constants, seal, band: BAND })
    }

    /// Runs it. `stop` is looked at between dispatches; `progress` hears after each of them which part of the work is done, in `[0, 1]`.
    ///
    /// # Errors
    /// Those of the device.
    pub async fn run_async(&self, gpu: &M, stop: &AtomicBool, progress: &mut dyn FnMut(f64)) -> Result<Found, Error> {
        let [width, height] = [self.frame.width, self.frame.height];
        let rows = self.frame.band(self.band);
        let mut run = Run::new(gpu, self, rows * width, stop, progress)?;
        run.grid().await?;
        for first in (0..height).step_by(rows as usize) {
            run.band(first, rows.min(height - first)).await?;
        }
        Ok(run.finish())
    }
}

#[cfg(feature = "native")]
impl Paper<Gpu> {
    /// [`run_async`](Self::run_async), where there is nothing else to be done meanwhile.
    ///
    /// # Errors
    /// Those of the device.
    pub fn run(&self, gpu: &Gpu, stop: &AtomicBool, progress: &mut dyn FnMut(f64)) -> Result<Found, Error> {
        device::finish(self.run_async(gpu, stop, progress))
    }
}

/// The buffers of a band, and what is found so far.
struct Run<'a, M: Machine> {
    gpu: &'a M,
    paper: &'a Paper<M>,
    stop: &'a AtomicBool,
    progress: &'a mut dyn FnMut(f64),
    frame: M::Buffer,
    found: M::Buffer,
    shade: M::Buffer,
    list: M::Buffer,
    receipts: M::Buffer,
    handed: Receipts,
    binds: Vec<M::Binding>,
    traced: Traced,
    seconds: Vec<f64>,
    clocked: bool,
    /// Pixels times passes that are done.
    done: u64,
}

impl<'a, M: Machine> Run<'a, M> {
    fn new(
        gpu: &'a M,
        paper: &'a Paper<M>,
        pixels: u32,
        stop: &'a AtomicBool,
        progress: &'a mut dyn FnMut(f64),
    ) -> Result<Self, Error> {
        let pixels = u64::from(pixels);
        let frame = gpu.filled(bytemuck::bytes_of(&paper.frame), Usage::Uniform)?;
        let regions = gpu.filled(bytemuck::cast_slice(&paper.regions), Usage::Uniform)?;
        let constants = gpu.filled(bytemuck::bytes_of(&paper.constants), Usage::Uniform)?;
        let slabs = gpu.filled(bytemuck::cast_slice(&paper.slabs), Usage::Storage)?;
        let storage = |bytes: u64| gpu.buffer(bytes.max(16), Usage::Storage);
        let marked = storage(4 * u64::from(paper.cells.div_ceil(32)))?;
        let [found, shade] = [storage(16 * pixels)?, storage(16 * pixels)?];
        let list = storage(HEAD + ITEM * pixels)?;
        let receipts = storage(4)?;
        let all = [
            (0, &frame),
            (1, &regions),
            (2, &constants),
            (3, &slabs),
            (4, &marked),
            (5, &found),
            (6, &shade),
            (7, &list),
            (9, &receipts),
        ];
        let mut binds = Vec::with_capacity(STAGES);
        for (kernel, used) in paper.kernels.iter().zip(USED) {
            let buffers: Vec<_> = all.iter().copied().filter(|(place, _)| used.contains(place)).collect();
            binds.push(gpu.bind(kernel, &buffers)?);
        }
        let lights = vec![Vec::new(); paper.lights.len()];
        Ok(Self {
            gpu,
            paper,
            stop,
            progress,
            frame,
            found,
            shade,
            list,
            receipts,
            handed: Receipts::default(),
            binds,
            traced: Traced { grid_evaluations: paper.cells.into(), pixels: Vec::new(), lights },
            seconds: vec![0.0; STAGES],
            clocked: true,
            done: 0,
        })
    }

    /// Runs a stage for `count` items, in dispatches of its pace: a group does `each` of them, or an item takes `threads` of several groups. `pixels` of
    /// work are then done.
    async fn stage(&mut self, stage: usize, frame: Frame, items: Items, pixels: u64) -> Result<(), Error> {
        let pace = &self.paper.paces[stage];
        let Items { first: begin, count, threads, group } = items;
        let mut first = 0;
        while first < count {
            if self.stop.load(Ordering::Relaxed) {
                return Err(Error::Stopped);
            }
            // At least one item, however many groups it takes: no more than 1024, of 2^16 sub-beams.
            let groups = pace.next(u32::MAX);
            let part =
                (u64::from(groups) * u64::from(group) / u64::from(threads)).clamp(1, u64::from(count - first)) as u32;
            let groups = (u64::from(part) * u64::from(threads)).div_ceil(group.into()) as u32;
            let ticket = self.handed.hand_out(groups, self.paper.seal);
            let frame = Frame { first: begin + first, count: part, ticket, ..frame };
            self.gpu.write(&self.frame, bytemuck::bytes_of(&frame));
            let now = self.gpu.seconds();
            let pipeline = &self.paper.kernels[stage];
            let time = self.gpu.run(pipeline, &self.binds[stage], groups).await?;
            pace.took(groups, self.gpu.seconds() - now);
            self.clocked &= time.is_some();
            self.seconds[stage] += time.unwrap_or(0.0);
            first += part;
            self.tell(pixels * u64::from(first) / u64::from(count));
        }
        self.done += pixels;
        self.tell(0);
        Ok(())
    }

    fn tell(&mut self, more: u64) {
        let passes = (1 + 2 * self.paper.lights.len()) as u64;
        let all = u64::from(self.paper.frame.width) * u64::from(self.paper.frame.height) * passes;
        (self.progress)((self.done + more) as f64 / all as f64);
    }

    /// Whether everything was done that should be.
    async fn check(&self) -> Result<(), Error> {
        if self.handed.is_sum(self.gpu.read_first(&self.receipts).await?) { Ok(()) } else { Err(Receipts::missing()) }
    }

    async fn grid(&mut self) -> Result<(), Error> {
        let words = self.paper.cells.div_ceil(32);
        self.stage(GRID, self.paper.frame, Items { first: 0, count: words, threads: 1, group: GROUP }, 0).await
    }

    async fn band(&mut self, top: u32, rows: u32) -> Result<(), Error> {
        let whole = self.paper.frame;
        let pixels = rows * whole.width;
        let work = u64::from(pixels);
        let base = Frame { base: top * whole.width, ..whole };
        let across = whole.width.div_ceil(8);
        let tiles = Items { first: top / 8 * across, count: across * rows.div_ceil(8), threads: 1, group: 1 };
        self.stage(PIXELS, base, tiles, work).await?;
        let mut found: Vec<[u32; 4]> = self.gpu.read_all(&self.found).await?;
        self.check().await?;
        found.truncate(pixels as usize);
        for f in &found {
            self.traced.pixels.push(pixel(f)?);
        }
        for (k, light) in self.paper.lights.iter().enumerate() {
            let frame = Frame { series: tickets(1), ..base.lit_by(light) };
            self.gpu.clear(&[&self.list]);
            self.stage(INITIAL, frame, Items { first: 0, count: pixels, threads: 1, group: GROUP }, work).await?;
            let count = self.gpu.read_first(&self.list).await?;
            if u64::from(count) > (self.gpu.size(&self.list) - HEAD) / ITEM {
                return Err(Receipts::missing());
            }
            let threads = self.paper.constants.sub_beams.pow(2).max(1);
            self.stage(SUB_BEAMS, frame, Items { first: 0, count, threads, group: GROUP }, work).await?;
            let shade: Vec<[u32; 4]> = self.gpu.read_all(&self.shade).await?;
            self.check().await?;
            for (s, f) in shade.iter().zip(&found) {
                self.traced.lights[k].push(if f[0] == NOTHING { TracedLight::default() } else { seen(s, threads)? });
            }
        }
        Ok(())
    }

    fn finish(mut self) -> Found {
        if !self.clocked {
            self.seconds.clear();
        }
        Found { traced: self.traced, seconds: self.seconds }
    }
}

/// Items of a stage: the first, how many, threads that each takes, threads of a group (1 where an item is a group).
#[derive(Clone, Copy)]
struct Items {
    first: u32,
    count: u32,
    threads: u32,
    group: u32,
}

const NOTHING: u32 = 255;

fn pixel([what, a, b, evaluations]: &[u32; 4]) -> Result<TracedPixel, Error> {
    let at = |bits: u32| f64::from(f32::from_bits(bits));
    let find = match *what {
        NOTHING => None,
        0 => return Err(Receipts::missing()),
        surface => Some((surface as usize - 1, Interval::try_new(at(*a), at(*b)).ok_or_else(Receipts::missing)?)),
    };
    Ok(TracedPixel { find, evaluations: *evaluations })
}

/// What was found between a hit and a light; with so many sub-beams, where they are traced.
fn seen([state, initial, blocked, sub]: &[u32; 4], beams: u32) -> Result<TracedLight, Error> {
    let [first, all] = match state & 0xff {
        1 => [0, 0],
        2 => [1, 0],
        3 => [1, beams],
        4 => [0, beams],
        _ => return Err(Receipts::missing()),
    };
    Ok(TracedLight {
        initial_occluded: state & 0xff == 3,
        blocked: *blocked,
        beams: [first, all],
        evaluations: [u64::from(*initial), u64::from(*sub) | u64::from(state >> 8) << 32],
    })
}
