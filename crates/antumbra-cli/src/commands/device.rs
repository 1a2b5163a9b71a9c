//! `--device`: what of a picture the GPU does.

use antumbra::{
    eval::wgsl::Width,
    paper,
    render::{Method, Renderer},
};
use antumbra_gpu::{Error, Gpu, Share, assist, trace};
use anyhow::{Result, anyhow};

use crate::{output::remark, progress::Progress, values::Device};

/// Lets the GPU do what it can, if that is wanted; the processor does the rest, and all of it where the GPU does nothing.
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
    let traced = matches!(method, Method::Paper(paper::Method::Initial | paper::Method::Fixed));
    if !traced && method != Method::Certified {
        let name = method.name();
        say(format!("the GPU draws `certified`, `paper` and `fixed49`; the processor does `{name}`"));
        return Ok(());
    }
    if !renderer.takes() {
        say("the processor does it alone: the picture was begun, or is drawn in bands".to_owned());
        return Ok(());
    }
    // A processor that plays the GPU is taken only where somebody insists.
    let gpu = match Gpu::open(device == Device::Gpu) {
        Ok(gpu) => gpu,
        Err(error) if device == Device::Gpu => {
            return Err(anyhow!("--device gpu: {error}; --device auto goes on with the processor"));
        }
        Err(Error::NoAdapter) => {
            let played = "one that a processor plays is asked only with --device gpu";
            say(format!("the processor does it: there is no GPU with a driver ({played})"));
            return Ok(());
        }
        Err(error) => {
            say(format!("the processor does it: {error}"));
            return Ok(());
        }
    };
    let progress = Progress::new(quiet, gpu.name());
    let mut tell = |done| progress.set(done);
    let done = if traced {
        trace(&gpu, renderer, &mut tell).map(|seconds| told_of_paper(&gpu, seconds))
    } else {
        assist(&gpu, renderer, &mut tell).map(|share| told_of_proofs(&gpu, share))
    };
    drop(progress);
    match done {
        Ok(text) => say(text),
        // Whoever set the flag will see that nothing was done.
        Err(Error::Stopped) => {}
        Err(error) => say(format!("the processor does it: {error}")),
    }
    Ok(())
}

fn told_of_proofs(gpu: &Gpu, share: Share) -> String {
    let percent = |n: usize, of: usize| 100.0 * n as f64 / of.max(1) as f64;
    let [compiled, done] = share.seconds;
    let bits = if share.width == Width::Double { 64 } else { 32 };
    let measured = if share.measured.is_some() { " and measuring" } else { "" };
    format!(
        "{} ({bits} bits): {:.1} % of the pixels and {:.1} % of their brackets proved in {:.2} s, after {compiled:.2} s of \
         compiling{measured}",
        gpu.name(),
        percent(share.settled, share.pixels),
        percent(share.narrow, share.brackets),
        done - compiled,
    )
}

fn told_of_paper(gpu: &Gpu, [compiled, done]: [f64; 2]) -> String {
    let name = gpu.name();
    format!("{name}: grid, beams and sub-beams traced in {:.2} s, after {compiled:.2} s of compiling", done - compiled)
}
