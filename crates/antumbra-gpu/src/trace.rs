//! A renderer that is told what the paper's method has found on the GPU.
use crate::device::Gpu;
use crate::error::Error;
use crate::paper::Paper;
use antumbra::render::Renderer;
use std::time::Instant;

/// Traces on the GPU a picture of the paper's methods that has not begun, and gives it to its renderer: what is left are points, normals and colours. Tells the
/// seconds until the kernels were compiled, and until everything was read back.
///
/// # Errors
/// Why the GPU did nothing; the renderer is as it was and does all of it. [`Error::Stopped`] if its stop flag was set.
pub fn trace(gpu: &Gpu, renderer: &mut Renderer, progress: &mut dyn FnMut(f64)) -> Result<[f64; 2], Error> {
    const BEGUN: Error = Error::Scene("a picture that has begun has no use for the GPU");
    if !renderer.takes() {
        return Err(BEGUN);
    }
    let begin = Instant::now();
    let stop = renderer.stop_flag();
    let paper = Paper::new(gpu, &renderer.question())?;
    let compiled = begin.elapsed().as_secs_f64();
    let found = paper.run(gpu, &stop, progress)?;
    let seconds = [compiled, begin.elapsed().as_secs_f64()];
    if renderer.give_traced(found.traced) { Ok(seconds) } else { Err(BEGUN) }
}
