//! How many operations the adapter does in a second, in 32 and in 64 bits: what the kernels are to be measured against.
use crate::device::{Gpu, Pass};
use crate::error::Error;
use std::time::Instant;
use wgpu::BufferUsages;

/// Products and sums per second; a fence comes with its operation and does not count.
#[derive(Clone, Copy, Debug)]
pub struct Throughput {
    /// In 32 bits, as the compiler likes them.
    pub bare: f64,
    /// In 32 bits, each through a fence: what kernels can reach.
    pub fenced: f64,
    /// In 64 bits, each through a fence; none where shaders have no 64-bit numbers.
    pub double: Option<f64>,
}

/// Groups of 64 threads, and rounds of 8 operations in each: 2^26 operations in all for a processor that plays the GPU, 2^35 for others.
const SOFTWARE: [u32; 2] = [1 << 11, 1 << 6];
const HARDWARE: [u32; 2] = [1 << 15, 1 << 11];

/// Measures it: medians of 5.
///
/// # Errors
/// Those of the device.
pub fn throughput(gpu: &Gpu) -> Result<Throughput, Error> {
    let [groups, rounds] = if gpu.is_software() { SOFTWARE } else { HARDWARE };
    let zero = gpu.filled(bytemuck::cast_slice(&[0_u32; 4]), BufferUsages::UNIFORM)?;
    let out = gpu.storage(16)?;
    let rate = |float: &str, bits: &str, fence: &str| -> Result<f64, Error> {
        let text =
            include_str!("throughput.wgsl").replace("FLOAT", float).replace("BITS", bits).replace("FENCE", fence);
        let pipeline = gpu.pipeline(&text, "chains", &[("ROUNDS", f64::from(rounds))])?;
        let bind = gpu.bind(&pipeline, &[(0, &zero), (1, &out)])?;
        let mut seconds = Vec::with_capacity(5);
        for _ in 0..6 {
            let begin = Instant::now();
            let times = gpu.run(&[Pass { pipeline: &pipeline, bind: &bind, groups: [groups, 1, 1] }])?;
            seconds.push(times.first().copied().unwrap_or_else(|| begin.elapsed().as_secs_f64()));
        }
        seconds.remove(0);
        seconds.sort_by(f64::total_cmp);
        Ok(f64::from(groups) * 64.0 * 8.0 * f64::from(rounds) / seconds[2])
    };
    let double = gpu.knows_double().then(|| rate("f64", "u64", "fenced")).transpose()?;
    Ok(Throughput { bare: rate("f32", "u32", "bare")?, fenced: rate("f32", "u32", "fenced")?, double })
}
