//! Drivers that leave out what they were told to do, and do not tell: nothing is claimed then that was not proved.
use crate::device::{Gpu, finish};
use crate::error::Error;
use crate::machine::{Machine, Usage};
use crate::{Found, Kernels, Paper, Proved};
use antumbra::paper::Method as Paperly;
use antumbra::render::{Method, RenderSpec, Renderer, RunSpec};
use antumbra::scene::named;
use bytemuck::Pod;
use std::cell::{Cell, RefCell};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use wgpu::{BindGroup, Buffer, ComputePipeline};

/// What is left out.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Omit {
    Nothing,
    /// The dispatch of that number.
    Run(usize),
    /// What is uploaded as number so and so.
    Write(usize),
    /// Every clearing.
    Clears,
}

/// A GPU with such a driver, which also hands out memory that others have used.
struct Negligent<'a> {
    gpu: &'a Gpu,
    omit: Omit,
    runs: Cell<usize>,
    writes: Cell<usize>,
    /// Memory in the order in which it was asked for: where it is asked for again, it is that one.
    memory: RefCell<Vec<Buffer>>,
    next: Cell<usize>,
}

impl<'a> Negligent<'a> {
    fn new(gpu: &'a Gpu, omit: Omit) -> Self {
        let [runs, writes, next] = [0; 3].map(Cell::new);
        Self { gpu, omit, runs, writes, memory: RefCell::default(), next }
    }

    fn count(counter: &Cell<usize>) -> usize {
        counter.replace(counter.get() + 1)
    }
}

impl Machine for Negligent<'_> {
    type Buffer = Buffer;
    type Pipeline = ComputePipeline;
    type Binding = BindGroup;

    fn name(&self) -> &str {
        Machine::name(self.gpu)
    }

    fn is_software(&self) -> bool {
        Machine::is_software(self.gpu)
    }

    fn seconds(&self) -> f64 {
        Machine::seconds(self.gpu)
    }

    fn buffer(&self, bytes: u64, usage: Usage) -> Result<Buffer, Error> {
        // Accounts and numbers are new, or nothing at all would be believed.
        if usage == Usage::Uniform || bytes <= 16 {
            return Machine::buffer(self.gpu, bytes, usage);
        }
        let number = Self::count(&self.next);
        if let Some(used) = self.memory.borrow().get(number) {
            assert!(used.size() >= bytes, "the pictures are of one size");
            return Ok(used.clone());
        }
        let new = Machine::buffer(self.gpu, bytes, usage)?;
        self.memory.borrow_mut().push(new.clone());
        Ok(new)
    }

    fn size(&self, buffer: &Buffer) -> u64 {
        buffer.size()
    }

    fn write(&self, buffer: &Buffer, content: &[u8]) {
        if self.omit != Omit::Write(Self::count(&self.writes)) {
            Machine::write(self.gpu, buffer, content);
        }
    }

    fn pipeline(&self, text: &str, entry: &str, constants: &[(&str, f64)]) -> Result<ComputePipeline, Error> {
        Machine::pipeline(self.gpu, text, entry, constants)
    }

    fn bind(&self, pipeline: &ComputePipeline, buffers: &[(u32, &Buffer)]) -> Result<BindGroup, Error> {
        Machine::bind(self.gpu, pipeline, buffers)
    }

    fn clear(&self, buffers: &[&Buffer]) {
        if self.omit != Omit::Clears {
            Machine::clear(self.gpu, buffers);
        }
    }

    fn copy(&self, from: &Buffer, to: &Buffer) {
        Machine::copy(self.gpu, from, to);
    }

    async fn run(&self, pipeline: &ComputePipeline, bind: &BindGroup, groups: u32) -> Result<Option<f64>, Error> {
        if self.omit == Omit::Run(Self::count(&self.runs)) {
            return Ok(None);
        }
        Machine::run(self.gpu, pipeline, bind, groups).await
    }

    async fn read<T: Pod>(&self, buffer: &Buffer, bytes: u64) -> Result<Vec<T>, Error> {
        Machine::read(self.gpu, buffer, bytes).await
    }
}

const SIDE: usize = 32;

fn renderer(name: &str, method: Method) -> Renderer {
    let spec = RenderSpec { width: SIDE, height: SIDE, method, ..RenderSpec::default() };
    Renderer::new(Arc::new(named(name).unwrap().unwrap()), spec, RunSpec::default()).unwrap()
}

/// In bands of 8 rows.
fn prove(machine: &Negligent<'_>, name: &str) -> Result<Proved, Error> {
    machine.next.set(0);
    let mut kernels: Kernels<Negligent<'_>> = crate::kernels(machine, &renderer(name, Method::Certified))?;
    kernels.band = 1;
    finish(kernels.prove_async(machine, &AtomicBool::new(false), &mut |_| ()))
}

fn trace(machine: &Negligent<'_>, name: &str) -> Result<Found, Error> {
    machine.next.set(0);
    let mut paper = Paper::new(machine, &renderer(name, Method::Paper(Paperly::Initial)).question())?;
    paper.band = 1;
    finish(paper.run_async(machine, &AtomicBool::new(false), &mut |_| ()))
}

/// Whatever one order is left out, of dispatches and of uploads, it is found; or it was of no consequence.
fn every_omission_is_found<T: PartialEq>(gpu: &Gpu, draw: impl Fn(&Negligent<'_>) -> Result<T, Error>) {
    let honest = Negligent::new(gpu, Omit::Nothing);
    let whole = draw(&honest).unwrap();
    let (runs, writes) = (honest.runs.get(), honest.writes.get());
    assert!(runs >= 12 && writes > runs, "{runs} {writes}");
    for omit in (0..runs).map(Omit::Run).chain((0..writes).map(Omit::Write)) {
        let machine = Negligent::new(gpu, omit);
        match (draw(&machine), omit) {
            (Err(Error::Failed(text)), _) => assert!(text.contains("did not tell"), "{omit:?}: {text}"),
            (Err(other), _) => panic!("{omit:?}: {other}"),
            // The first numbers of the frame are overwritten before anybody reads them.
            (Ok(found), Omit::Write(0)) => assert!(found == whole),
            // How many dispatches there are is a matter of time.
            (Ok(_), Omit::Run(number)) => assert!(number >= machine.runs.get(), "{omit:?}"),
            (Ok(_), Omit::Write(number)) => assert!(number >= machine.writes.get(), "{omit:?}"),
            (Ok(_), _) => unreachable!(),
        }
    }
}

#[test]
fn what_was_left_out_of_a_certified_picture_is_found() {
    let Some(gpu) = crate::tests::gpu() else { return };
    every_omission_is_found(&gpu, |machine| prove(machine, "chubs").map(|p| (p.pixels, p.lights)));
}

#[test]
fn what_was_left_out_of_the_papers_pictures_is_found() {
    let Some(gpu) = crate::tests::gpu() else { return };
    every_omission_is_found(&gpu, |machine| trace(machine, "chubs").map(|found| found.traced));
}

/// Memory full of another picture's results, which nobody clears, between bands and lights neither: no claim comes from there.
#[test]
fn nothing_is_claimed_from_stale_memory() {
    let Some(gpu) = crate::tests::gpu() else { return };
    for [one, other] in [["mcmullen", "chubs"], ["kusner", "orthocircle"]] {
        let honest = prove(&Negligent::new(&gpu, Omit::Nothing), other).unwrap();
        let machine = Negligent::new(&gpu, Omit::Clears);
        prove(&machine, one).unwrap();
        let stale = prove(&machine, other).unwrap();
        assert_eq!(stale.pixels, honest.pixels);
        // Lists that are full of others' items have room for less: brackets may be wider, and nothing else.
        let mut equal = 0;
        for ([lo, hi], [a, b]) in stale.lights.iter().flatten().zip(honest.lights.iter().flatten()) {
            assert!(lo <= a && hi >= b, "[{lo}, {hi}] from stale memory, [{a}, {b}] from new");
            equal += usize::from(lo == a && hi == b);
        }
        assert!(2 * equal > SIDE * SIDE, "{equal}");

        let honest = trace(&Negligent::new(&gpu, Omit::Nothing), other).unwrap();
        let machine = Negligent::new(&gpu, Omit::Clears);
        // Its own bands are found to fill the list that nobody clears.
        let _ = trace(&machine, one);
        match trace(&machine, other) {
            Ok(stale) => assert_eq!(stale.traced, honest.traced),
            Err(error) => assert!(error.to_string().contains("did not tell"), "{error}"),
        }
    }
}
