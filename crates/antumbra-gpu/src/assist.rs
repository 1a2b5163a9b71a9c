//! A renderer that is told what the GPU has proved, and does the rest itself.
use crate::certified::{Kernels, Pixel};
use crate::device::{Error, Gpu};
use antumbra::render::{Given, GivenPixel, Renderer};
use std::time::Instant;

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
    /// Seconds until the kernels were compiled, and until everything was read back.
    pub seconds: [f64; 2],
}

/// Proves on the GPU what it can of a picture that has not begun, and gives it to its renderer.
///
/// # Errors
/// Why the GPU did nothing; the renderer is as it was and does all of it. [`Error::Stopped`] if its stop flag was set.
pub fn assist(gpu: &Gpu, renderer: &mut Renderer, progress: &mut dyn FnMut(f64)) -> Result<Share, Error> {
    let begin = Instant::now();
    let stop = renderer.stop_flag();
    let question = renderer.question();
    let kernels = Kernels::new(gpu, &question.surfaces, &question.film, &question.lights, question.tolerance)?;
    let compiled = begin.elapsed().as_secs_f64();
    let proved = kernels.prove(gpu, &stop, progress)?;
    let proofs = |pixel: &Pixel| match *pixel {
        Pixel::Empty => Some(GivenPixel::Empty),
        Pixel::Hit { surface, t, before } => Some(GivenPixel::Hit { surface, t, before }),
        Pixel::Open { .. } => None,
    };
    let given = Given { pixels: proved.pixels.iter().map(proofs).collect(), lights: proved.lights };
    let tolerance = question.tolerance;
    let hits: Vec<usize> =
        (0..given.pixels.len()).filter(|index| matches!(given.pixels[*index], Some(GivenPixel::Hit { .. }))).collect();
    let narrow = |light: &Vec<[f64; 2]>| hits.iter().filter(|k| light[**k][1] - light[**k][0] <= tolerance).count();
    let share = Share {
        pixels: given.pixels.len(),
        settled: given.pixels.iter().flatten().count(),
        brackets: hits.len() * given.lights.len(),
        narrow: given.lights.iter().map(narrow).sum(),
        seconds: [compiled, begin.elapsed().as_secs_f64()],
    };
    if renderer.give(given) {
        Ok(share)
    } else {
        Err(Error::Scene("only a certified picture that has not begun has use for the GPU"))
    }
}
