//! The paper's method on the GPU: grid, beam casting, initial shadow beams, sub-beams.
use crate::device::{Gpu, Pass};
use crate::error::Error;
use crate::scene::{self, Frame, Region};
use antumbra::eval::wgsl::{FORMS, INTERVALS, Kind, outward};
use antumbra::geom::{Film, Rect};
use antumbra::paper::Settings;
use antumbra::trace::Surface;
use antumbra_interval::Interval;
use bytemuck::{Pod, Zeroable};
use std::sync::atomic::{AtomicBool, Ordering};
use wgpu::{BufferUsages, ComputePipeline};

/// What the paper's method finds on a picture with one light.
#[derive(Clone, Debug, Default)]
pub struct Found {
    /// Per pixel: the section of T in which its beam may first meet a surface; `None` proves that it meets none.
    pub hits: Vec<Option<[f32; 2]>>,
    /// Per pixel: how many sub-beams may be blocked.
    pub blocked: Vec<u32>,
    /// Pixels whose sub-beams were traced: all hits, or those whose initial beam may be blocked.
    pub initial_occluded: usize,
    /// Evaluations: of pixel beams, of initial beams, of sub-beams.
    pub evaluations: [u64; 3],
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
    pad: [u32; 2],
}

/// The paper's method for one scene and its first light, compiled.
pub struct Paper {
    kernels: [ComputePipeline; 4],
    frame: Frame,
    regions: Vec<Region>,
    slabs: Vec<[f32; 2]>,
    constants: Constants,
}

/// Items of a dispatch: sub-beams are counted in 32 bits, and watchdogs wait for seconds only.
const ITEMS: u32 = 1 << 20;
const GROUPS: u32 = 8192;

impl Paper {
    /// Compiles it for surfaces in grids of `cells` cells along each axis. No initial beams if `always`.
    ///
    /// # Errors
    /// Why the scene stays on the CPU.
    pub fn new(
        gpu: &Gpu,
        surfaces: &[Surface<'_>],
        film: &Film,
        light: &Rect,
        settings: &Settings,
        cells: usize,
        always: bool,
    ) -> Result<Self, Error> {
        let (frame, regions) = scene::frame(surfaces, film)?;
        let frame = frame.lit_by(light);
        let kinds = [Kind::Form, Kind::Interval];
        let functions = scene::functions(surfaces, &kinds, &frame, film, std::slice::from_ref(light))?;
        let [common, kernel] = [include_str!("kernels/frame.wgsl"), include_str!("kernels/paper.wgsl")];
        let text = format!("{FORMS}\n{INTERVALS}\n{common}\n{functions}\n{kernel}");
        let pipeline = |entry| gpu.pipeline(&text, entry, &[]);
        let kernels = [pipeline("grid")?, pipeline("pixels")?, pipeline("initial")?, pipeline("sub_beams")?];
        let mut slabs = Vec::with_capacity(3 * cells * surfaces.len());
        for surface in surfaces {
            let bounds = surface.clip.bounds();
            for axis in 0..3 {
                let (lo, hi) = (Interval::point(bounds[axis].lo()), Interval::point(bounds[axis].hi()));
                let edge = |k: usize| lo + (hi - lo) * (Interval::point(k as f64) / Interval::point(cells as f64));
                slabs.extend((0..cells).map(|k| outward(edge(k).hull(edge(k + 1)))));
            }
        }
        let constants = Constants {
            cells: cells as u32,
            sub_beams: settings.sub_beams as u32,
            always: u32::from(always),
            far: outward(Interval::point(frame.quantum() * f64::from(frame.end)))[1],
            width: settings.bisection.width as f32,
            offset: settings.offset as f32,
            pad: [0; 2],
        };
        Ok(Self { kernels, frame, regions, slabs, constants })
    }

    /// Runs it; `stop` is looked at between dispatches.
    ///
    /// # Errors
    /// Those of the device.
    pub fn run(&self, gpu: &Gpu, stop: &AtomicBool) -> Result<Found, Error> {
        let frame = self.frame;
        let count = frame.width * frame.height;
        let uniform = gpu.filled(bytemuck::bytes_of(&frame), BufferUsages::UNIFORM)?;
        let regions = gpu.filled(bytemuck::cast_slice(&self.regions), BufferUsages::UNIFORM)?;
        let constants = gpu.filled(bytemuck::bytes_of(&self.constants), BufferUsages::UNIFORM)?;
        let slabs = gpu.filled(bytemuck::cast_slice(&self.slabs), BufferUsages::STORAGE)?;
        let cells = self.constants.cells.pow(3) * self.regions.len() as u32;
        let marked = gpu.storage(4 * u64::from(cells))?;
        let found = gpu.storage(16 * u64::from(count))?;
        let blocked = gpu.storage(4 * u64::from(count))?;
        let list = gpu.storage(16 + 4 * u64::from(count))?;
        let spent = gpu.storage(16)?;
        let all = [
            (0, &uniform),
            (1, &regions),
            (2, &constants),
            (3, &slabs),
            (4, &marked),
            (5, &found),
            (6, &blocked),
            (7, &list),
            (8, &spent),
        ];
        // Each kernel binds what it names.
        let used: [&[u32]; 4] = [&[0, 2, 3, 4], &[0, 2, 3, 4, 5, 8], &[0, 2, 3, 4, 5, 7, 8], &[0, 2, 3, 4, 5, 6, 7, 8]];
        let mut binds = Vec::with_capacity(4);
        for (kernel, used) in self.kernels.iter().zip(used) {
            let buffers: Vec<_> = all.iter().copied().filter(|(place, _)| used.contains(place)).collect();
            binds.push(gpu.bind(kernel, &buffers)?);
        }
        let mut out = Found { seconds: vec![0.0; 4], ..Found::default() };
        let mut clocked = true;
        let mut go = |out: &mut Found, stage: usize, part: Frame, groups: u32| {
            if stop.load(Ordering::Relaxed) {
                return Err(Error::Stopped);
            }
            gpu.write(&uniform, bytemuck::bytes_of(&part));
            let times =
                gpu.run(&[Pass { pipeline: &self.kernels[stage], bind: &binds[stage], groups: [groups, 1, 1] }])?;
            clocked &= !times.is_empty();
            out.seconds[stage] += times.iter().sum::<f64>();
            Ok(())
        };
        go(&mut out, 0, frame, cells.div_ceil(64))?;
        let tiles = frame.width.div_ceil(8) * frame.height.div_ceil(8);
        let most = ITEMS / 64;
        for first in (0..tiles).step_by(most as usize) {
            go(&mut out, 1, Frame { first, ..frame }, (tiles - first).min(most))?;
        }
        for first in (0..count).step_by(ITEMS as usize) {
            let part = (count - first).min(ITEMS);
            go(&mut out, 2, Frame { first, count: part, ..frame }, part.div_ceil(64))?;
        }
        out.initial_occluded = gpu.read_first(&list)? as usize;
        let beams = self.constants.sub_beams.pow(2).max(1);
        let items = (ITEMS / 16).min((1 << 30) / beams).max(1);
        for first in (0..out.initial_occluded as u32).step_by(items as usize) {
            go(&mut out, 3, Frame { first, count: items, ..frame }, GROUPS)?;
        }
        let hit = |f: &[u32; 4]| (f[0] == 1).then(|| [f32::from_bits(f[1]), f32::from_bits(f[2])]);
        out.hits = gpu.read::<[u32; 4]>(&found)?.iter().map(hit).collect();
        out.blocked = gpu.read(&blocked)?;
        out.blocked.truncate(count as usize);
        let spent: Vec<u32> = gpu.read(&spent)?;
        out.evaluations = [spent[0].into(), spent[1].into(), u64::from(spent[2]) | u64::from(spent[3]) << 32];
        if !clocked {
            out.seconds.clear();
        }
        Ok(out)
    }
}
