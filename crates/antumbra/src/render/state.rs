//! A render that was stopped, as bytes: what it is of, everything the [`Book`] knows, and a checksum.
use super::RenderSpec;
use super::book::Book;
use super::renderer::{Part, Stage};
use super::window::Window;
use crate::eval::Workspace;
use crate::geom::Box3;
use crate::scene::{Object, Scene, SceneFile};
use antumbra_interval::Interval;
use serde::{Deserialize, Serialize};
use std::io::{self, Read, Seek, SeekFrom, Write};

/// How every state begins.
const MAGIC: [u8; 8] = *b"antumbra";
/// Number of the layout around the header; what is in it is bound to the program that wrote it.
const FORMAT: u32 = 1;
/// Bytes of the checksum (BLAKE3) of everything before it, at the end.
const CHECKSUM: usize = blake3::OUT_LEN;
/// Longest header that is believed.
const MAX_HEADER: u32 = 1 << 28;

/// Why a state cannot be written or gone on with.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum StateError {
    /// It cannot be read or written.
    #[error("{0}")]
    Io(#[from] io::Error),
    /// It is something else.
    #[error("it is not the state of a render")]
    NotAState,
    /// It is of another version or build, whose tiles may differ.
    #[error("it was written by Antumbra {found}, and this is Antumbra {own}")]
    Program {
        /// Version and build that wrote it.
        found: String,
        /// Version and build of this program.
        own: String,
    },
    /// It was cut off or changed.
    #[error("it is damaged: its checksum is wrong, so it was cut off or changed")]
    Damaged,
    /// It is of another scene.
    #[error("it is of another scene")]
    Scene,
    /// It is of other options.
    #[error("it is of other options: {found} there, {own} here")]
    Spec {
        /// The first options that differ, as they are in the state.
        found: String,
        /// As they are asked for.
        own: String,
    },
    /// It cannot be joined.
    #[error("it is no finished part of the picture, or one that is there already")]
    Part,
    /// The picture that it belongs to cannot be begun.
    #[error(transparent)]
    Render(#[from] super::Error),
}

/// What a state is of: it fits only where all of this is equal.
#[derive(PartialEq, Serialize, Deserialize)]
struct Header {
    program: String,
    scene: String,
    /// Enclosures of the objects' functions: what the names of two formulas hide, their values show.
    functions: Vec<Vec<Interval>>,
    spec: String,
}

impl Header {
    /// Of a state: whether unions are divided is in the state itself, so that it goes on as it began.
    fn of_state(scene: &Scene, spec: &RenderSpec) -> Result<Self, StateError> {
        Self::new(scene, &RenderSpec { unions: true, ..spec.clone() })
    }

    fn new(scene: &Scene, spec: &RenderSpec) -> Result<Self, StateError> {
        let text = SceneFile::of(scene).text().map_err(|e| io::Error::other(e.to_string()))?;
        Ok(Self {
            program: program(),
            scene: format!("{text}\n{scene:?}"),
            functions: scene.objects.iter().map(samples).collect(),
            spec: format!("{spec:?}"),
        })
    }

    /// # Errors
    /// Where this is not the header of the same picture.
    fn require(&self, own: &Self) -> Result<(), StateError> {
        if self.program != own.program {
            return Err(StateError::Program { found: self.program.clone(), own: own.program.clone() });
        }
        // The spec first: a scene can be named in a few words only by what it is not.
        if self.spec != own.spec {
            // Equal words but those that differ: `width: 512`.
            let (here, there): (Vec<&str>, Vec<&str>) =
                self.spec.split(", ").zip(own.spec.split(", ")).filter(|(a, b)| a != b).unzip();
            let words = |list: Vec<&str>| list.join(", ").replace("RenderSpec { ", "").replace(" }", "");
            return Err(StateError::Spec { found: words(here), own: words(there) });
        }
        if self != own { Err(StateError::Scene) } else { Ok(()) }
    }
}

/// A name for the picture of that scene by that spec in this program: 64 hexadecimal digits, equal only where the pictures
/// are.
///
/// # Errors
/// Where the scene has no text, which none is known not to have.
pub fn fingerprint(scene: &Scene, spec: &RenderSpec) -> Result<String, StateError> {
    let header = postcard::to_stdvec(&Header::new(scene, spec)?).map_err(io::Error::other)?;
    Ok(blake3::hash(&header).to_hex().to_string())
}

/// Version and build.
fn program() -> String {
    concat!(env!("CARGO_PKG_VERSION"), " (build ", env!("ANTUMBRA_SOURCES"), ")").to_owned()
}

/// Ranges of an object's function over the 27 cells of its clip.
fn samples(object: &Object) -> Vec<Interval> {
    let (bounds, mut work) = (object.clip().bounds(), Workspace::default());
    let third = |axis: usize, k: usize| {
        let [lo, hi] = [bounds[axis].lo(), bounds[axis].hi()].map(|x| x.clamp(-1e9, 1e9));
        let at = |k: usize| (lo + (hi - lo) * (k as f64 / 3.0)).clamp(lo, hi);
        Interval::try_new(at(k), at(k + 1)).unwrap_or(Interval::ZERO)
    };
    (0..27)
        .map(|k| {
            let cell = Box3([third(0, k % 3), third(1, k / 3 % 3), third(2, k / 9)]);
            object.surface.range(&cell, &mut work)
        })
        .collect()
}

/// How far a render is, with everything it knows.
#[derive(Serialize, Deserialize)]
pub(super) struct Stopped<B = Book> {
    pub(super) stage: Stage,
    pub(super) part: Part,
    pub(super) tiles: usize,
    pub(super) window: Window,
    pub(super) divided: bool,
    pub(super) book: B,
}

/// Writes and hashes.
struct Hashing<W> {
    out: W,
    hasher: blake3::Hasher,
}

impl<W: Write> Write for Hashing<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let n = self.out.write(bytes)?;
        self.hasher.update(&bytes[..n]);
        Ok(n)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}

/// Writes a state: magic and format; length and bytes of the header (postcard); the content (postcard, in LZ4 frames);
/// the checksum.
pub(super) fn write(
    scene: &Scene,
    spec: &RenderSpec,
    how_far: &Stopped<&Book>,
    out: &mut dyn Write,
) -> Result<(), StateError> {
    let header = postcard::to_stdvec(&Header::of_state(scene, spec)?).map_err(io::Error::other)?;
    let length = u32::try_from(header.len()).ok().filter(|n| *n <= MAX_HEADER);
    let length = length.ok_or_else(|| io::Error::other("the text of the scene is too long"))?;
    let mut out = Hashing { out, hasher: blake3::Hasher::new() };
    for part in [&MAGIC[..], &FORMAT.to_le_bytes(), &length.to_le_bytes(), &header] {
        out.write_all(part)?;
    }
    let packed = lz4_flex::frame::FrameEncoder::new(&mut out);
    let packed = postcard::to_io(how_far, packed).map_err(io::Error::other)?;
    packed.finish().map_err(io::Error::other)?;
    let checksum = *out.hasher.finalize().as_bytes();
    out.out.write_all(&checksum)?;
    Ok(out.out.flush()?)
}

/// Reads a state of that picture.
pub(super) fn read(scene: &Scene, spec: &RenderSpec, input: &mut (impl Read + Seek)) -> Result<Stopped, StateError> {
    // What it is; then whether it is whole; only then what is in it.
    let length = input.seek(SeekFrom::End(0))?;
    input.rewind()?;
    let mut magic = [0; 8];
    input.read_exact(&mut magic).map_err(cut_off(StateError::NotAState))?;
    if magic != MAGIC {
        return Err(StateError::NotAState);
    }
    let format = number(input)?;
    if format != FORMAT {
        return Err(StateError::Program { found: format!("with states of format {format}"), own: program() });
    }
    input.rewind()?;
    let mut hasher = blake3::Hasher::new();
    let hashed = length.checked_sub(CHECKSUM as u64).ok_or(StateError::Damaged)?;
    io::copy(&mut input.by_ref().take(hashed), &mut hasher)?;
    let mut checksum = [0; CHECKSUM];
    input.read_exact(&mut checksum)?;
    if *hasher.finalize().as_bytes() != checksum {
        return Err(StateError::Damaged);
    }
    input.seek(SeekFrom::Start(MAGIC.len() as u64 + 4))?;
    let size = number(input)?;
    if size > MAX_HEADER {
        return Err(StateError::Damaged);
    }
    let mut header = vec![0; size as usize];
    input.read_exact(&mut header).map_err(cut_off(StateError::Damaged))?;
    let header: Header = postcard::from_bytes(&header).map_err(|_| StateError::Damaged)?;
    header.require(&Header::of_state(scene, spec)?)?;
    // Room for the names in it; numbers need none.
    let mut names = [0; 1024];
    let content = lz4_flex::frame::FrameDecoder::new(input);
    let (stopped, _) = postcard::from_io::<Stopped<Book>, _>((content, &mut names)).map_err(|_| StateError::Damaged)?;
    let held = stopped.window.held().len();
    let fits = stopped.window.holds(spec.height) && stopped.book.fits(spec.width, held, scene.lights.len());
    if fits { Ok(stopped) } else { Err(StateError::Damaged) }
}

fn number(input: &mut impl Read) -> Result<u32, StateError> {
    let mut bytes = [0; 4];
    input.read_exact(&mut bytes).map_err(cut_off(StateError::Damaged))?;
    Ok(u32::from_le_bytes(bytes))
}

/// The error where a file ends too early.
fn cut_off(meaning: StateError) -> impl FnOnce(io::Error) -> StateError {
    |error| if error.kind() == io::ErrorKind::UnexpectedEof { meaning } else { error.into() }
}
