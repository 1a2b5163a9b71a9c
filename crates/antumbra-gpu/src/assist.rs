//! A renderer that is told what the GPU has proved, and does the rest itself.
#[cfg(feature = "native")]
use crate::chosen;
#[cfg(feature = "native")]
use crate::device::{self, Gpu};
use crate::error::Error;
use crate::machine::Machine;
use crate::{Kernels, Measured, Pixel, Proved};
use antumbra::eval::wgsl::Width;
use antumbra::render::{Given, GivenPixel, Renderer};

const NO_USE: &str = "only a certified picture that has not begun has use for the GPU";

/// What the GPU contributed to a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Share {
    /// Pixels of the picture.
    pub pixels: usize,
    /// Of them: settled, proved empty or proved hit.
    pub settled: usize,
    /// Pairs of such a hit and a light.
    pub brackets: usize,
    /// Of them: brackets within the tolerance.
    pub narrow: usize,
    /// The numbers that its kernels computed with.
    pub width: Width,
    /// What a sample cost in 32 and in 64 bits, if that was measured.
    pub measured: Option<[Measured; 2]>,
    /// Seconds until the kernels were compiled, and until everything was read back.
    pub seconds: [f64; 2],
}

/// The kernels that prove what they can of a renderer's picture.
///
/// # Errors
/// Why the scene stays on the CPU.
pub fn kernels<M: Machine>(gpu: &M, renderer: &Renderer) -> Result<Kernels<M>, Error> {
    let question = renderer.question();
    Kernels::new(gpu, &question.surfaces, &question.film, &question.lights, question.tolerance)
}

impl Proved {
    /// Gives a picture that has not begun to its renderer; `seconds` are told on.
    ///
    /// # Errors
    /// [`Error::Scene`] where it has no use for it: the renderer is as it was.
    pub fn give_to(self, renderer: &mut Renderer, seconds: [f64; 2]) -> Result<Share, Error> {
        let proofs = |pixel: &Pixel| match *pixel {
            Pixel::Empty => Some(GivenPixel::Empty),
            Pixel::Hit { surface, t, before } => Some(GivenPixel::Hit { surface, t, before }),
            Pixel::Open { .. } => None,
        };
        let given = Given { pixels: self.pixels.iter().map(proofs).collect(), lights: self.lights };
        let tolerance = renderer.question().tolerance;
        let hits: Vec<usize> = (0..given.pixels.len())
            .filter(|index| matches!(given.pixels[*index], Some(GivenPixel::Hit { .. })))
            .collect();
        let narrow = |light: &Vec<[f64; 2]>| hits.iter().filter(|k| light[**k][1] - light[**k][0] <= tolerance).count();
        let share = Share {
            pixels: given.pixels.len(),
            settled: given.pixels.iter().flatten().count(),
            brackets: hits.len() * given.lights.len(),
            narrow: given.lights.iter().map(narrow).sum(),
            width: Width::Single,
            measured: None,
            seconds,
        };
        if renderer.give(given) { Ok(share) } else { Err(Error::Scene(NO_USE)) }
    }
}

/// Proves on the GPU what it can of a picture that has not begun, and gives it to its renderer.
///
/// # Errors
/// Why the GPU did nothing; the renderer is as it was and does all of it. [`Error::Stopped`] if its stop flag was set.
#[cfg(feature = "native")]
pub fn assist(gpu: &Gpu, renderer: &mut Renderer, progress: &mut dyn FnMut(f64)) -> Result<Share, Error> {
    if !renderer.takes() {
        return Err(Error::Scene(NO_USE));
    }
    let begin = gpu.seconds();
    let stop = renderer.stop_flag();
    let (kernels, width, measured) = device::finish(chosen(gpu, &renderer.question(), &stop))?;
    let compiled = gpu.seconds() - begin;
    let proved = kernels.prove(gpu, &stop, progress)?;
    let done = gpu.seconds() - begin;
    let share = proved.give_to(renderer, [compiled, done])?;
    Ok(Share { width, measured, ..share })
}
