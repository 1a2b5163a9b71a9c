//! Adapters, and one of them opened: buffers, pipelines, passes with their times.
use crate::error::Error;
use crate::machine::{Kernel, Machine, Usage};
use crate::{probe, probe_double};
use std::collections::HashMap;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::time::Instant;
use wgpu::{BindGroup, Buffer, BufferUsages, ComputePipeline, Features};

/// An adapter and what the probe says of it.
#[derive(Clone, Debug)]
pub struct Adapter {
    /// Its name.
    pub name: String,
    /// The interface to it: Vulkan, Metal, Direct3D 12.
    pub backend: String,
    /// Discrete, integrated, software.
    pub kind: String,
    /// Name and version of the driver.
    pub driver: String,
    /// Whether it has 64-bit floats in shaders.
    pub double: bool,
    /// Whether its arithmetic can be trusted.
    pub probe: Result<probe::Report, Error>,
}

/// A device that passed the probe.
pub struct Gpu {
    device: wgpu::Device,
    queue: wgpu::Queue,
    name: String,
    software: bool,
    /// Nanoseconds per tick of its clock, if it has one.
    period: Option<f32>,
    /// No buffer may be larger; bytes.
    pub(crate) largest: u64,
    /// What was compiled, by its text, entry point and constants.
    pipelines: Mutex<HashMap<(String, String), ComputePipeline>>,
    begin: Instant,
    failures: Arc<Mutex<Failures>>,
    /// Whether its 64-bit numbers can be trusted.
    double: OnceLock<bool>,
}

/// What the driver told. Of a device that is lost every call fails, each in its own words.
#[derive(Debug, Default)]
struct Failures {
    lost: Option<String>,
    first: Option<String>,
}

/// One pass of a kernel.
pub(crate) struct Pass<'a> {
    pub(crate) pipeline: &'a ComputePipeline,
    pub(crate) bind: &'a BindGroup,
    pub(crate) groups: [u32; 3],
}

/// What work on a [`Gpu`] comes to: it never waits for anything but the GPU itself.
pub(crate) fn finish<T>(work: impl Future<Output = T>) -> T {
    pollster::block_on(work)
}

fn instance() -> wgpu::Instance {
    wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle_from_env())
}

fn list() -> Vec<wgpu::Adapter> {
    let mut all = pollster::block_on(instance().enumerate_adapters(wgpu::Backends::PRIMARY));
    let rank = |a: &wgpu::Adapter| match a.get_info().device_type {
        wgpu::DeviceType::DiscreteGpu => 0,
        wgpu::DeviceType::IntegratedGpu => 1,
        wgpu::DeviceType::VirtualGpu => 2,
        wgpu::DeviceType::Other => 3,
        wgpu::DeviceType::Cpu => 4,
    };
    all.sort_by_key(rank);
    all
}

/// All adapters, the most promising first, each with the verdict of the probe: some tenths of a second per adapter.
#[must_use]
pub fn adapters() -> Vec<Adapter> {
    let describe = |adapter: &wgpu::Adapter| {
        let info = adapter.get_info();
        let double = adapter.features().contains(Features::SHADER_F64);
        let probe = Gpu::unproved(adapter).and_then(|gpu| gpu.probe());
        Adapter {
            name: info.name,
            backend: info.backend.to_string(),
            kind: format!("{:?}", info.device_type),
            driver: format!("{} {}", info.driver, info.driver_info).trim().to_owned(),
            double,
            probe,
        }
    };
    list().iter().map(describe).collect()
}

impl Gpu {
    /// The most promising adapter that passes the probe. Software adapters count only if `software` is true.
    ///
    /// # Errors
    /// [`Error::NoAdapter`], or what kept the last adapter from being used.
    pub fn open(software: bool) -> Result<Self, Error> {
        let mut last = Error::NoAdapter;
        for adapter in list() {
            if !software && adapter.get_info().device_type == wgpu::DeviceType::Cpu {
                continue;
            }
            match Self::unproved(&adapter).and_then(|gpu| gpu.probe().map(|_| gpu)) {
                Ok(gpu) => return Ok(gpu),
                Err(error) => last = error,
            }
        }
        Err(last)
    }

    /// The most promising adapter, whatever the probe says: for finding out what is wrong with it. Nothing that it claims is proved.
    ///
    /// # Errors
    /// [`Error::NoAdapter`], [`Error::Failed`].
    pub fn open_untrusted() -> Result<Self, Error> {
        list().first().map_or(Err(Error::NoAdapter), Self::unproved)
    }

    /// A device of which nothing is known yet.
    fn unproved(adapter: &wgpu::Adapter) -> Result<Self, Error> {
        let failed = |e: &dyn std::fmt::Display| Error::Failed(e.to_string());
        let info = adapter.get_info();
        let timed = adapter.features() & Features::TIMESTAMP_QUERY;
        let both = Features::SHADER_F64 | Features::SHADER_INT64;
        let double = if adapter.features().contains(both) { both } else { Features::empty() };
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("antumbra"),
            required_features: timed | double,
            required_limits: wgpu::Limits::default().or_better_values_from(&adapter.limits()),
            ..Default::default()
        };
        let (device, queue) = pollster::block_on(adapter.request_device(&descriptor)).map_err(|e| failed(&e))?;
        let failures: Arc<Mutex<Failures>> = Arc::default();
        let lost = Arc::clone(&failures);
        device.set_device_lost_callback(move |reason, text| {
            // Nobody hears of it where it is lost because it is dropped.
            let text = format!("the device was lost ({reason:?}): {text}");
            lost.lock().unwrap_or_else(PoisonError::into_inner).lost.get_or_insert(text);
        });
        let wrong = Arc::clone(&failures);
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            wrong.lock().unwrap_or_else(PoisonError::into_inner).first.get_or_insert(error.to_string());
        }));
        let period = timed.contains(Features::TIMESTAMP_QUERY).then(|| queue.get_timestamp_period());
        let software = info.device_type == wgpu::DeviceType::Cpu;
        let limits = device.limits();
        let largest = limits.max_buffer_size.min(limits.max_storage_buffer_binding_size);
        let (pipelines, begin) = (Mutex::default(), Instant::now());
        Ok(Self {
            device,
            queue,
            name: info.name,
            software,
            period,
            largest,
            pipelines,
            begin,
            failures,
            double: OnceLock::new(),
        })
    }

    fn probe(&self) -> Result<probe::Report, Error> {
        finish(probe::run(self))
    }

    /// The adapter's name.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Whether a processor plays the GPU.
    #[must_use]
    pub fn is_software(&self) -> bool {
        self.software
    }

    /// Whether shaders have 64-bit floats, and the whole numbers that a fence for them needs; whatever a probe says of them.
    pub(crate) fn knows_double(&self) -> bool {
        self.device.features().contains(Features::SHADER_F64 | Features::SHADER_INT64)
    }

    /// Whatever has gone wrong since the last question.
    pub(crate) fn check(&self) -> Result<(), Error> {
        let told = || self.failures.lock().unwrap_or_else(PoisonError::into_inner);
        let Some(first) = told().first.take() else {
            return told().lost.clone().map_or(Ok(()), |text| Err(Error::Failed(text)));
        };
        // The loss itself is told when the device is asked.
        let _ = self.device.poll(wgpu::PollType::Poll);
        Err(Error::Failed(told().lost.clone().unwrap_or(first)))
    }

    /// A buffer of zeros.
    pub(crate) fn buffer(&self, bytes: u64, usage: BufferUsages) -> Result<Buffer, Error> {
        if bytes > self.largest {
            return Err(Error::Failed(format!("a buffer of {bytes} bytes is larger than it allows")));
        }
        let usage = usage | BufferUsages::COPY_DST | BufferUsages::COPY_SRC;
        let descriptor = wgpu::BufferDescriptor { label: None, size: bytes.max(16), usage, mapped_at_creation: false };
        let buffer = self.device.create_buffer(&descriptor);
        self.check()?;
        Ok(buffer)
    }

    /// A storage buffer of zeros.
    pub(crate) fn storage(&self, bytes: u64) -> Result<Buffer, Error> {
        self.buffer(bytes, BufferUsages::STORAGE)
    }

    /// A buffer with that content.
    pub(crate) fn filled(&self, content: &[u8], usage: BufferUsages) -> Result<Buffer, Error> {
        let buffer = self.buffer(content.len() as u64, usage)?;
        self.queue.write_buffer(&buffer, 0, content);
        Ok(buffer)
    }

    pub(crate) fn write(&self, buffer: &Buffer, content: &[u8]) {
        self.queue.write_buffer(buffer, 0, content);
    }

    /// Kernels, compiled once for each text, entry point and constants, as long as this device lives; side by side, as drivers may take seconds for each.
    pub(crate) fn pipelines(&self, kernels: &[Kernel<'_>]) -> Result<Vec<ComputePipeline>, Error> {
        let key = |k: &Kernel<'_>| (k.text.to_owned(), format!("{} {:?}", k.entry, k.constants));
        let kept = || self.pipelines.lock().unwrap_or_else(PoisonError::into_inner);
        let mut known: Vec<Option<ComputePipeline>> = kernels.iter().map(|k| kept().get(&key(k)).cloned()).collect();
        std::thread::scope(|scope| {
            let missing = kernels.iter().zip(&mut known).filter(|(_, known)| known.is_none());
            missing.for_each(|(kernel, place)| drop(scope.spawn(move || *place = Some(self.compile(kernel)))));
        });
        // Whatever has failed is told here, and nothing is kept.
        self.check()?;
        let all: Vec<ComputePipeline> = known.into_iter().flatten().collect();
        kept().extend(kernels.iter().map(key).zip(all.iter().cloned()));
        Ok(all)
    }

    /// Not checked.
    fn compile(&self, kernel: &Kernel<'_>) -> ComputePipeline {
        let source = wgpu::ShaderSource::Wgsl(kernel.text.into());
        let module = self.device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source });
        self.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some(kernel.entry),
            layout: None,
            module: &module,
            entry_point: Some(kernel.entry),
            compilation_options: wgpu::PipelineCompilationOptions {
                constants: kernel.constants,
                zero_initialize_workgroup_memory: false,
            },
            cache: None,
        })
    }

    /// One of them.
    pub(crate) fn pipeline(
        &self,
        text: &str,
        entry: &str,
        constants: &[(&str, f64)],
    ) -> Result<ComputePipeline, Error> {
        self.pipelines(&[Kernel { text, entry, constants }]).map(|mut all| all.remove(0))
    }

    /// Loses the device, as a driver does that was reset.
    #[cfg(test)]
    pub(crate) fn lose(&self) {
        self.device.destroy();
    }

    /// Binds buffers to the places of the first group.
    pub(crate) fn bind(&self, pipeline: &ComputePipeline, buffers: &[(u32, &Buffer)]) -> Result<BindGroup, Error> {
        let entries: Vec<_> = buffers
            .iter()
            .map(|(place, buffer)| wgpu::BindGroupEntry { binding: *place, resource: buffer.as_entire_binding() })
            .collect();
        let layout = pipeline.get_bind_group_layout(0);
        let descriptor = wgpu::BindGroupDescriptor { label: None, layout: &layout, entries: &entries };
        let group = self.device.create_bind_group(&descriptor);
        self.check()?;
        Ok(group)
    }

    /// Sets buffers to zero.
    pub(crate) fn clear(&self, buffers: &[&Buffer]) {
        let mut encoder = self.device.create_command_encoder(&Default::default());
        buffers.iter().for_each(|buffer| encoder.clear_buffer(buffer, 0, None));
        self.queue.submit([encoder.finish()]);
    }

    /// Copies the whole of a buffer into another one.
    pub(crate) fn copy(&self, from: &Buffer, to: &Buffer) {
        let mut encoder = self.device.create_command_encoder(&Default::default());
        encoder.copy_buffer_to_buffer(from, 0, to, 0, from.size());
        self.queue.submit([encoder.finish()]);
    }

    /// Runs passes one after the other and waits. The seconds of each by the clock of the GPU, where it has one; else none.
    pub(crate) fn run(&self, passes: &[Pass<'_>]) -> Result<Vec<f64>, Error> {
        let count = 2 * passes.len() as u32;
        let clock = self.period.map(|period| {
            let descriptor = wgpu::QuerySetDescriptor { label: None, ty: wgpu::QueryType::Timestamp, count };
            (period, self.device.create_query_set(&descriptor))
        });
        let mut encoder = self.device.create_command_encoder(&Default::default());
        for (k, pass) in passes.iter().enumerate() {
            let timestamp_writes = clock.as_ref().map(|(_, set)| wgpu::ComputePassTimestampWrites {
                query_set: set,
                beginning_of_pass_write_index: Some(2 * k as u32),
                end_of_pass_write_index: Some(2 * k as u32 + 1),
            });
            let mut compute =
                encoder.begin_compute_pass(&wgpu::ComputePassDescriptor { label: None, timestamp_writes });
            compute.set_pipeline(pass.pipeline);
            compute.set_bind_group(0, pass.bind, &[]);
            let [x, y, z] = pass.groups;
            compute.dispatch_workgroups(x, y, z);
        }
        let mut times = None;
        if let Some((period, set)) = &clock {
            let ticks = self.buffer(8 * u64::from(count), BufferUsages::QUERY_RESOLVE)?;
            encoder.resolve_query_set(set, 0..count, &ticks, 0);
            times = Some((*period, ticks));
        }
        self.queue.submit([encoder.finish()]);
        let Some((period, ticks)) = times else {
            self.wait()?;
            return Ok(Vec::new());
        };
        let ticks: Vec<u64> = self.read(&ticks)?;
        let seconds = |pair: &[u64]| pair[1].saturating_sub(pair[0]) as f64 * f64::from(period) * 1e-9;
        Ok(ticks.chunks_exact(2).take(passes.len()).map(seconds).collect())
    }

    fn wait(&self) -> Result<(), Error> {
        let waited = self.device.poll(wgpu::PollType::wait_indefinitely());
        self.check()?;
        waited.map(|_| ()).map_err(|e| Error::Failed(e.to_string()))
    }

    /// The content of a buffer.
    pub(crate) fn read<T: bytemuck::Pod>(&self, buffer: &Buffer) -> Result<Vec<T>, Error> {
        self.read_part(buffer, buffer.size())
    }

    fn read_part<T: bytemuck::Pod>(&self, buffer: &Buffer, size: u64) -> Result<Vec<T>, Error> {
        let usage = BufferUsages::MAP_READ | BufferUsages::COPY_DST;
        let descriptor = wgpu::BufferDescriptor { label: None, size, usage, mapped_at_creation: false };
        let copy = self.device.create_buffer(&descriptor);
        let mut encoder = self.device.create_command_encoder(&Default::default());
        encoder.copy_buffer_to_buffer(buffer, 0, &copy, 0, size);
        self.queue.submit([encoder.finish()]);
        copy.slice(..).map_async(wgpu::MapMode::Read, |_| {});
        self.wait()?;
        let view = copy.slice(..).get_mapped_range().map_err(|e| Error::Failed(e.to_string()))?;
        Ok(bytemuck::pod_collect_to_vec(&view))
    }
}

/// Orders are carried out where they are given: nothing is left to wait for.
impl Machine for Gpu {
    type Buffer = Buffer;
    type Pipeline = ComputePipeline;
    type Binding = BindGroup;

    fn name(&self) -> &str {
        &self.name
    }

    fn is_software(&self) -> bool {
        self.software
    }

    /// Asked once: what the probe says does not change.
    fn has_double(&self) -> bool {
        *self.double.get_or_init(|| {
            self.knows_double() && finish(probe_double::passes(self, &probe_double::text())).unwrap_or(false)
        })
    }

    fn seconds(&self) -> f64 {
        self.begin.elapsed().as_secs_f64()
    }

    fn buffer(&self, bytes: u64, usage: Usage) -> Result<Buffer, Error> {
        let usage = if usage == Usage::Uniform { BufferUsages::UNIFORM } else { BufferUsages::STORAGE };
        self.buffer(bytes, usage)
    }

    fn size(&self, buffer: &Buffer) -> u64 {
        buffer.size()
    }

    fn write(&self, buffer: &Buffer, content: &[u8]) {
        self.write(buffer, content);
    }

    fn pipeline(&self, text: &str, entry: &str, constants: &[(&str, f64)]) -> Result<ComputePipeline, Error> {
        self.pipeline(text, entry, constants)
    }

    fn pipelines(&self, kernels: &[Kernel<'_>]) -> Result<Vec<ComputePipeline>, Error> {
        self.pipelines(kernels)
    }

    fn bind(&self, pipeline: &ComputePipeline, buffers: &[(u32, &Buffer)]) -> Result<BindGroup, Error> {
        self.bind(pipeline, buffers)
    }

    fn clear(&self, buffers: &[&Buffer]) {
        self.clear(buffers);
    }

    fn copy(&self, from: &Buffer, to: &Buffer) {
        self.copy(from, to);
    }

    async fn run(&self, pipeline: &ComputePipeline, bind: &BindGroup, groups: u32) -> Result<Option<f64>, Error> {
        Ok(self.run(&[Pass { pipeline, bind, groups: [groups, 1, 1] }])?.first().copied())
    }

    async fn read<T: bytemuck::Pod>(&self, buffer: &Buffer, bytes: u64) -> Result<Vec<T>, Error> {
        self.read_part(buffer, bytes)
    }
}
