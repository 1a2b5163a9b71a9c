//! Which numbers a picture is drawn with, 32 or 64 bits: that is measured.
use crate::certified::{Kernels, Pixel, Proved};
use crate::error::Error;
use crate::machine::Machine;
use antumbra::eval::wgsl::Width;
use antumbra::geom::Film;
use antumbra::render::Question;
use std::sync::atomic::AtomicBool;

/// Pixels of the sample, about. Pictures of fewer than four times as many are not worth a measurement.
const SAMPLE: usize = 4096;

/// Seconds of the processor for what the GPU leaves, a pixel or a bracket: an estimate, as it depends on the scene. It changes no claim.
const LEFT: f64 = 1e-4;

/// What a width costs, by a sample of the picture.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Measured {
    /// Seconds of the GPU.
    pub seconds: f64,
    /// Pixels and brackets that it leaves to the processor.
    pub left: usize,
}

impl Measured {
    fn of(proved: &Proved, seconds: f64, tolerance: f64) -> Self {
        let open = |pixel: &Pixel| matches!(pixel, Pixel::Open { .. });
        let wide = |light: &Vec<[f64; 2]>| {
            let brackets = proved.pixels.iter().zip(light);
            brackets.filter(|(pixel, [lo, hi])| matches!(pixel, Pixel::Hit { .. }) && hi - lo > tolerance).count()
        };
        let left =
            proved.pixels.iter().filter(|pixel| open(pixel)).count() + proved.lights.iter().map(wide).sum::<usize>();
        Self { seconds, left }
    }

    fn cost(self) -> f64 {
        self.seconds + LEFT * self.left as f64
    }
}

/// The kernels of a picture, compiled in the width that costs less in a sample of it: the same view, with fewer pixels. Tells that width and
/// what was measured in 32 and in 64 bits; nothing, and 32 bits, where there are no 64-bit numbers, no kernels for them, or too few pixels.
///
/// # Errors
/// Why the scene stays on the CPU; those of the device.
pub async fn chosen<M: Machine>(
    gpu: &M,
    question: &Question<'_>,
    stop: &AtomicBool,
) -> Result<(Kernels<M>, Width, Option<[Measured; 2]>), Error> {
    let Question { surfaces, film, lights, tolerance, .. } = question;
    let compile = |film: &Film, width| Kernels::of_width(gpu, surfaces, film, lights, *tolerance, width);
    let step = ((film.width * film.height) as f64 / SAMPLE as f64).sqrt();
    if step < 2.0 || !gpu.has_double() {
        return Ok((compile(film, Width::Single)?, Width::Single, None));
    }
    let side = |pixels: usize| ((pixels as f64 / step) as usize).max(1);
    let sample = Film { width: side(film.width), height: side(film.height), ..*film };
    let single = measure(gpu, compile(&sample, Width::Single)?, stop, *tolerance).await?;
    // What 64 bits do not have, 32 do. A device that fails while it runs them is believed no more in 32.
    let Ok(kernels) = compile(&sample, Width::Double) else {
        return Ok((compile(film, Width::Single)?, Width::Single, None));
    };
    let double = measure(gpu, kernels, stop, *tolerance).await?;
    let width = if double.cost() < single.cost() { Width::Double } else { Width::Single };
    Ok((compile(film, width)?, width, Some([single, double])))
}

async fn measure<M: Machine>(
    gpu: &M,
    kernels: Kernels<M>,
    stop: &AtomicBool,
    tolerance: f64,
) -> Result<Measured, Error> {
    // Drivers compile when a kernel runs for the first time.
    kernels.prove_async(gpu, stop, &mut |_| ()).await?;
    let begin = gpu.seconds();
    let proved = kernels.prove_async(gpu, stop, &mut |_| ()).await?;
    Ok(Measured::of(&proved, gpu.seconds() - begin, tolerance))
}

#[cfg(test)]
mod tests {
    use super::Measured;

    #[test]
    fn time_is_weighed_against_what_is_left() {
        let cost = |seconds, left| Measured { seconds, left }.cost();
        assert!(cost(0.010, 100) < cost(0.010, 200));
        assert!(cost(0.010, 100) < cost(0.030, 100));
        // Twice the time pays where it leaves much less, and not where it leaves as much.
        assert!(cost(0.020, 50) < cost(0.010, 300));
        assert!(cost(0.020, 299) > cost(0.010, 300));
    }
}
