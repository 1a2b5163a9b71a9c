//! `--device`: what of a picture the GPU proves.

use antumbra::render::{Method, Renderer};
use antumbra_gpu::{Error, Gpu, assist};
use anyhow::{Result, anyhow};

use crate::{output::remark, progress::Progress, values::Device};

/// Lets the GPU prove what it can, if that is wanted; the processor does the rest, and all of it where the GPU does nothing.
///
/// # Errors
/// Where `--device gpu` finds no adapter that can be trusted.
pub(super) fn prepare(device: Device, method: Method, renderer: &mut Renderer, quiet: bool) -> Result<()> {
    let say = |text: String| {
        if !quiet {
            remark(&text);
        }
    };
    if device == Device::Cpu {
        return Ok(());
    }
    if method != Method::Certified {
        say(format!("the GPU draws only certified pictures here; the processor does `{}`", method.name()));
        return Ok(());
    }
    // A processor that plays the GPU is taken only where somebody insists.
    let gpu = match Gpu::open(device == Device::Gpu) {
        Ok(gpu) => gpu,
        Err(error) if device == Device::Gpu => {
            return Err(anyhow!("--device gpu: {error}; --device auto goes on with the processor"));
        }
        Err(error) => {
            say(format!("the processor does it: {error}"));
            return Ok(());
        }
    };
    let progress = Progress::new(quiet, gpu.name());
    let assisted = assist(&gpu, renderer, &mut |done| progress.set(done));
    drop(progress);
    match assisted {
        Ok(share) => {
            let percent = |n: usize, of: usize| 100.0 * n as f64 / of.max(1) as f64;
            let [compiled, done] = share.seconds;
            say(format!(
                "{}: {:.1} % of the pixels and {:.1} % of their brackets proved in {:.2} s, after {compiled:.2} s of compiling",
                gpu.name(),
                percent(share.settled, share.pixels),
                percent(share.narrow, share.brackets),
                done - compiled,
            ));
        }
        // Whoever set the flag will see that nothing was done.
        Err(Error::Stopped) => {}
        Err(error) => say(format!("the processor does it: {error}")),
    }
    Ok(())
}
