//! Digests of the planes of scenes, all presets by default: `cargo run --release -p antumbra --example digest -- [SIZE] [THREADS] [SCENE]...`.
//!
//! Planes are promised to be the same bits for any number of threads, any optimisation of the compiler, and on any machine.
//! Two runs can be compared: with other arguments, in another profile (`--config profile.dev.opt-level=0`), elsewhere.
//! Prints a line per scene and method; a digest is FNV-1a, 64 bits, over the bits of all samples.
use antumbra::image::Samples;
use antumbra::render::{Method, RenderSpec, Renderer, RunSpec};
use antumbra::scene::{PRESETS, named};
use std::process::ExitCode;
use std::sync::Arc;
use std::time::Duration;

/// FNV-1a (Fowler, Noll, Vo).
struct Digest(u64);

impl Digest {
    fn add(&mut self, bytes: &[u8]) {
        for byte in bytes {
            self.0 = (self.0 ^ u64::from(*byte)).wrapping_mul(0x100_0000_01b3);
        }
    }

    fn add_all<T: Copy, const N: usize>(&mut self, samples: &[T], bytes: fn(T) -> [u8; N]) {
        samples.iter().for_each(|sample| self.add(&bytes(*sample)));
    }
}

fn digest(name: &str, method: Method, size: usize, threads: usize) -> Result<u64, String> {
    let scene = named(name).ok_or("no such scene")?.map_err(|e| e.to_string())?;
    // One frame with the floor, so that every way of the renderer is taken.
    let spec = RenderSpec { width: size, height: size, method, floor: true, ..RenderSpec::default() };
    let run = RunSpec { threads: Some(threads) };
    let mut renderer = Renderer::new(Arc::new(scene), spec, run).map_err(|e| e.to_string())?;
    while !renderer.refine(Duration::MAX) {}
    let planes = renderer.frame().planes().map_err(|e| e.to_string())?;
    let mut digest = Digest(0xcbf2_9ce4_8422_2325);
    for plane in planes.iter() {
        digest.add(plane.name().as_bytes());
        match plane.samples() {
            Samples::F64(v) => digest.add_all(v, f64::to_le_bytes),
            Samples::F32(v) => digest.add_all(v, f32::to_le_bytes),
            Samples::U64(v) => digest.add_all(v, u64::to_le_bytes),
            Samples::U32(v) => digest.add_all(v, u32::to_le_bytes),
            Samples::U16(v) => digest.add_all(v, u16::to_le_bytes),
            Samples::U8(v) => digest.add(v),
            other => return Err(format!("unknown samples: {other:?}")),
        }
    }
    Ok(digest.0)
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let number = |i: usize, default: usize| arguments.get(i).map_or(Ok(default), |text| text.parse());
    let (Ok(size), Ok(threads)) = (number(0, 32), number(1, 1)) else {
        eprintln!("usage: digest [SIZE] [THREADS] [SCENE]..., size and threads whole numbers");
        return ExitCode::from(2);
    };
    let wanted = arguments.get(2..).unwrap_or_default();
    for row in PRESETS.iter().filter(|row| wanted.is_empty() || wanted.iter().any(|name| name == row.name)) {
        // The paper's methods on the paper's surfaces.
        let methods = if row.stage.is_some() { &["certified", "paper", "rays-mc"][..] } else { &["certified"] };
        for &method in methods {
            let found = Method::from_name(method).ok_or_else(|| "no such method".to_owned());
            match found.and_then(|m| digest(row.name, m, size, threads)) {
                Ok(digest) => println!("{digest:016x} {} {method} {size}", row.name),
                Err(error) => {
                    eprintln!("{} {method}: {error}", row.name);
                    return ExitCode::FAILURE;
                }
            }
        }
    }
    ExitCode::SUCCESS
}
