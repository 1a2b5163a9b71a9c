//! What the host of the kernels asks of a GPU, whoever holds it: wgpu in a program, the browser around a page.
use crate::error::Error;
use bytemuck::Pod;

/// What a buffer is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Usage {
    /// Numbers that kernels read: `var<uniform>`.
    Uniform,
    /// Numbers that kernels read and write: `var<storage>`.
    Storage,
}

/// A kernel that is to be compiled: a text, an entry point of it, and the constants that it leaves open.
#[derive(Clone, Copy, Debug)]
pub struct Kernel<'a> {
    /// The whole text.
    pub text: &'a str,
    /// Where it begins.
    pub entry: &'a str,
    /// Names and values.
    pub constants: &'a [(&'a str, f64)],
}

/// A GPU that takes orders and carries them out one after the other.
///
/// Only [`run`](Self::run) and [`read`](Self::read) wait. Whatever went wrong with any order before them is an error there at the latest: what
/// is read is never what an order that failed has left.
pub trait Machine {
    /// Memory of the GPU. A new one holds zeros.
    type Buffer;
    /// A compiled kernel.
    type Pipeline;
    /// Buffers in the places that a kernel names; they live as long as it does.
    type Binding;

    /// The adapter's name.
    fn name(&self) -> &str;

    /// Whether a processor plays the GPU.
    fn is_software(&self) -> bool;

    /// Whether kernels may compute in 64 bits: it has such numbers, and they passed the probe.
    fn has_double(&self) -> bool {
        false
    }

    /// Seconds since some moment.
    fn seconds(&self) -> f64;

    /// A buffer of so many bytes, at least 16.
    ///
    /// # Errors
    /// [`Error::Failed`] where it is too large.
    fn buffer(&self, bytes: u64, usage: Usage) -> Result<Self::Buffer, Error>;

    /// Its bytes.
    fn size(&self, buffer: &Self::Buffer) -> u64;

    /// Writes from the beginning of a buffer, a whole number of words.
    fn write(&self, buffer: &Self::Buffer, content: &[u8]);

    /// A kernel of the text, compiled once for each text, entry point and constants.
    ///
    /// # Errors
    /// [`Error::Failed`], or only when it is run.
    fn pipeline(&self, text: &str, entry: &str, constants: &[(&str, f64)]) -> Result<Self::Pipeline, Error>;

    /// The same of several kernels, at the same time where the driver can: it may take seconds for each.
    ///
    /// # Errors
    /// Those of [`pipeline`](Self::pipeline).
    fn pipelines(&self, kernels: &[Kernel<'_>]) -> Result<Vec<Self::Pipeline>, Error> {
        kernels.iter().map(|k| self.pipeline(k.text, k.entry, k.constants)).collect()
    }

    /// Binds buffers to the places of the first group.
    ///
    /// # Errors
    /// [`Error::Failed`], or only when it is run.
    fn bind(&self, pipeline: &Self::Pipeline, buffers: &[(u32, &Self::Buffer)]) -> Result<Self::Binding, Error>;

    /// Sets buffers to zero.
    fn clear(&self, buffers: &[&Self::Buffer]);

    /// Copies the whole of a buffer into another one.
    fn copy(&self, from: &Self::Buffer, to: &Self::Buffer);

    /// Runs so many groups of a kernel and waits. The seconds that they took by the clock of the GPU, where it has one.
    fn run(
        &self,
        pipeline: &Self::Pipeline,
        binding: &Self::Binding,
        groups: u32,
    ) -> impl Future<Output = Result<Option<f64>, Error>>;

    /// The first bytes of a buffer, a whole number of words.
    fn read<T: Pod>(&self, buffer: &Self::Buffer, bytes: u64) -> impl Future<Output = Result<Vec<T>, Error>>;

    /// A buffer with that content, a whole number of words.
    ///
    /// # Errors
    /// Those of [`buffer`](Self::buffer).
    fn filled(&self, content: &[u8], usage: Usage) -> Result<Self::Buffer, Error> {
        let buffer = self.buffer(content.len() as u64, usage)?;
        self.write(&buffer, content);
        Ok(buffer)
    }

    /// The whole content of a buffer.
    fn read_all<T: Pod>(&self, buffer: &Self::Buffer) -> impl Future<Output = Result<Vec<T>, Error>> {
        self.read(buffer, self.size(buffer))
    }

    /// The first number of a buffer.
    fn read_first(&self, buffer: &Self::Buffer) -> impl Future<Output = Result<u32, Error>> {
        async { Ok(self.read::<u32>(buffer, 16).await?[0]) }
    }
}
