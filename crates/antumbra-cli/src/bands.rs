//! Pictures that are drawn in bands: which, and the finished rows of them until all are there.
//!
//! Finished rows go to files of rows in the folder `NAME.png.bands` beside the picture, one for the picture and one for each plane, with
//! checksums, and with the fingerprint of the picture: rows of another one are never taken for its own. They are as many as the saved state counts, or
//! more, so that a render that was stopped goes on. When all rows are there, the files become what was asked for, and the folder goes.

use std::{
    fs::{self, File, OpenOptions},
    io::{self, BufReader, BufWriter, Read, Seek, Write},
    ops::Range,
    path::{Path, PathBuf},
};

use antumbra::{
    image::{COLOR_PLANE, Depth, npy_bytes, npy_header, png_codes, png_rows},
    render::{Frame, RenderSpec, Renderer, fingerprint},
    scene::Exposure,
};
use anyhow::{Context, Result, anyhow, bail};

use crate::{
    failure::Usage,
    options::{Format, RenderOptions},
    output::Sink,
};

/// MiB that a picture takes at most, where nothing is said and the picture allows it.
const MEMORY: u64 = 1536;
/// Name of the picture's file of rows: no plane has it. Rows of other bits do not fit.
fn picture_name(depth: Depth) -> &'static str {
    match depth {
        Depth::Eight => "picture-8",
        Depth::Sixteen => "picture-16",
    }
}

/// How many rows to draw at a time; all of them if that is how it must or may be. Where less memory is allowed than some rows take, it is as few
/// as can be.
///
/// # Errors
/// [`Usage`] where the whole picture is needed, and not allowed.
pub(crate) fn rows(options: &RenderOptions) -> Result<usize> {
    let (spec, scene) = (&options.spec, &options.scene.scene);
    let lights = scene.lights.len();
    let allowed = options.memory.unwrap_or(MEMORY) << 20;
    if Renderer::bytes(spec.width, spec.height, lights) <= allowed {
        return Ok(spec.height);
    }
    let needs_all = [
        (options.format == Format::Exr, "an EXR file"),
        (options.overlay.is_some(), "an overlay with its legend"),
        (scene.look.outline, "an outline"),
        (matches!(scene.look.exposure, Exposure::Auto(_)), "automatic exposure"),
    ];
    if let Some((_, what)) = needs_all.into_iter().find(|(needed, _)| *needed) {
        return match options.memory {
            None => Ok(spec.height),
            Some(memory) => Err(Usage(format!(
                "{what} needs the whole picture, which takes up to {} MiB: allow it with --memory, or leave it out; {memory} MiB allow \
                 only a picture in bands",
                Renderer::bytes(spec.width, spec.height, lights) >> 20
            ))
            .into()),
        };
    }
    // A band is held with 64 rows of the one before; the copy of its rows for the files is about as large as half of it.
    let row = Renderer::bytes(spec.width, 1, lights);
    Ok((allowed / row).saturating_sub(64).min(spec.height as u64) as usize * 2 / 3)
}

/// The finished rows of a picture.
pub(crate) struct Rows {
    folder: PathBuf,
    /// A folder that goes with the program: for pictures that go to a device.
    _temporary: Option<tempfile::TempDir>,
    files: Vec<RowFile>,
    depth: Depth,
    /// Size of the picture.
    width: usize,
    height: usize,
}

impl Rows {
    /// Those of the picture and the planes that are wanted; `done` of them are there, from an earlier run.
    ///
    /// # Errors
    /// Where files cannot be made, or fewer rows are there.
    pub(crate) fn open(options: &RenderOptions, done: usize) -> Result<Self> {
        let picture = &options.picture;
        let is_file = fs::metadata(picture).map_or(true, |old| old.is_file());
        let temporary = if is_file { None } else { Some(tempfile::tempdir()?) };
        let folder = temporary.as_ref().map_or_else(|| folder(picture), |t| t.path().to_owned());
        let (Format::Png(depth), false) = (options.format, options.overlay.is_some()) else {
            bail!("only PNG files are drawn in bands");
        };
        let shown = folder.display();
        match fs::create_dir(&folder) {
            // Not through a link.
            Err(_) if fs::symlink_metadata(&folder).is_ok_and(|found| found.is_dir()) => {}
            made => made.with_context(|| format!("cannot make the folder `{shown}`"))?,
        }
        // As of a state: both go on as they began.
        let print = fingerprint(&options.scene.scene, &RenderSpec { unions: true, ..options.spec.clone() })?;
        let (width, height) = (options.spec.width, options.spec.height);
        let planes = options.planes.is_some().then(|| Frame::plane_names(options.scene.scene.lights.len()));
        let names = std::iter::once(picture_name(depth).to_owned()).chain(planes.into_iter().flatten());
        let files = names.map(|name| RowFile::open(&folder, name, &print, done)).collect::<Result<_>>()?;
        Ok(Self { folder, _temporary: temporary, files, depth, width, height })
    }

    /// Appends what a band has finished.
    ///
    /// # Errors
    /// Where the disk is full.
    pub(crate) fn put(&mut self, rows: &Range<usize>, frame: &Frame, options: &RenderOptions) -> Result<()> {
        let look = &options.scene.scene.look;
        let planes = if self.files.len() > 1 { Some(frame.planes()?) } else { None };
        let (depth, height) = (self.depth, self.height);
        for file in &mut self.files {
            if file.name == picture_name(depth) {
                let codes = png_codes(frame.picture(look)?.require(COLOR_PLANE)?, rows.start, depth)?;
                file.put(&codes, rows.len())?;
            } else if let Some(planes) = &planes {
                let plane = planes.require(&file.name)?;
                let (bytes, own) = (npy_bytes(plane)?, npy_header(plane, rows.len())?);
                if rows.start == 0 {
                    file.put(&npy_header(plane, height)?, 0)?;
                }
                file.put(&bytes[own.len()..], rows.len())?;
            }
        }
        Ok(())
    }

    /// Writes the picture.
    ///
    /// # Errors
    /// Where rows were damaged, or the disk is full.
    pub(crate) fn write_picture(&self, sink: &mut Sink) -> Result<()> {
        let Some(file) = self.files.iter().find(|file| file.name == picture_name(self.depth)) else { return Ok(()) };
        let size = [self.width, self.height];
        sink.write(|out| Ok(png_rows(out, size, self.depth, |out| file.copy(self.height, out))?))
    }

    /// Names of the planes.
    pub(crate) fn planes(&self) -> impl Iterator<Item = &str> {
        self.files.iter().map(|file| &*file.name).filter(|name| *name != picture_name(self.depth))
    }

    /// Writes the `.npy` file of a plane.
    ///
    /// # Errors
    /// Where rows were damaged, or the disk is full.
    pub(crate) fn write_plane(&self, name: &str, sink: &mut Sink) -> Result<()> {
        let Some(file) = self.files.iter().find(|file| file.name == name) else { return Ok(()) };
        sink.write(|out| Ok(file.copy(self.height, out)?))
    }

    /// Where they are.
    pub(crate) fn folder(&self) -> &Path {
        &self.folder
    }

    /// Takes away the files that this render wrote.
    pub(crate) fn remove(self) {
        let Self { folder, files, .. } = self;
        for RowFile { path, file, begun, .. } in files {
            let empty = file.metadata().is_ok_and(|found| found.len() == 0);
            drop(file);
            if begun || empty {
                let _ = fs::remove_file(path);
            }
        }
        // Fails, as it should, where something else is in it.
        let _ = fs::remove_dir(folder);
    }
}

/// The folder of the finished rows of a picture.
pub(crate) fn folder(picture: &Path) -> PathBuf {
    let name = picture.file_name().unwrap_or_default().to_string_lossy();
    picture.with_file_name(format!("{name}.bands"))
}

/// A file of rows: blocks of `length: u32, rows: u32, bytes, CRC-32`, little endian. The first block tells whose rows they are; blocks of 0 rows are
/// what comes before them.
struct RowFile {
    name: String,
    path: PathBuf,
    file: File,
    identity: Vec<u8>,
    /// Whether what is in it is of this render: until it has rows, it leaves those of another one alone.
    begun: bool,
}

/// How every file of rows begins, in its first block.
const MAGIC: &[u8] = b"antumbra rows 1\n";

impl RowFile {
    /// The file of that name, cut off after `done` rows; it is kept from other programs.
    fn open(folder: &Path, name: String, print: &str, done: usize) -> Result<Self> {
        let path = folder.join(&name);
        let shown = path.display().to_string();
        if fs::symlink_metadata(&path).is_ok_and(|found| !found.is_file()) {
            bail!("cannot write `{shown}`: it is no plain file");
        }
        let file = OpenOptions::new().read(true).write(true).create(true).truncate(false).open(&path);
        let mut file = file.map_err(|e| anyhow!("cannot write `{shown}`: {e}"))?;
        if matches!(file.try_lock(), Err(fs::TryLockError::WouldBlock)) {
            bail!("another program is drawing this picture: it has `{shown}`");
        }
        let identity = [MAGIC, print.as_bytes()].concat();
        let mut input = BufReader::new(&file);
        let first = Block::read(&mut input);
        let is_empty = file.metadata()?.len() == 0;
        if !is_empty && !first.as_ref().is_ok_and(|block| block.bytes.starts_with(MAGIC)) {
            bail!(
                "cannot write `{shown}`: something else is in it; give the picture another name, or move that file away"
            );
        }
        let begun = done > 0;
        if begun {
            let anew = "to begin anew, leave out --resume";
            if first.as_ref().map_or(&[][..], |block| &block.bytes) != identity {
                bail!("cannot go on: the rows in `{shown}` are not of this picture; {anew}");
            }
            let (mut rows, mut end) = (0, first.map_or(0, |block| block.size()));
            while rows < done {
                let block = Block::read(&mut input).map_err(|e| {
                    anyhow!("cannot go on: `{shown}` has {rows} of the {done} rows that were finished ({e}); {anew}")
                })?;
                if block.rows == 0 && rows > 0 || rows + block.rows > done {
                    bail!("cannot go on: the rows in `{shown}` are not those of the state; {anew}");
                }
                rows += block.rows;
                end += block.size();
            }
            drop(input);
            file.set_len(end)?;
            file.seek(io::SeekFrom::Start(end))?;
        }
        Ok(Self { name, path, file, identity, begun })
    }

    /// Appends rows, and sees to it that they are on the disk: a state may count on them.
    fn put(&mut self, bytes: &[u8], rows: usize) -> Result<()> {
        let mut append = || -> io::Result<()> {
            if !self.begun {
                self.file.set_len(0)?;
                self.file.rewind()?;
                Block::write(&self.file, &self.identity, 0)?;
                self.begun = true;
            }
            Block::write(&self.file, bytes, rows)?;
            self.file.sync_data()
        };
        append().map_err(|e| anyhow!("cannot write `{}`: {e}", self.path.display()))
    }

    /// The content: all blocks but the first, of which the rows must be so many.
    fn copy(&self, rows: usize, out: &mut dyn Write) -> io::Result<()> {
        let mut input = BufReader::new(File::open(&self.path)?);
        if Block::read(&mut input)?.bytes != self.identity {
            return Err(io::Error::other("the finished rows are of another picture"));
        }
        let mut found = 0;
        while found < rows {
            let block = Block::read(&mut input)?;
            if block.rows == 0 && found > 0 || found + block.rows > rows {
                return Err(io::Error::other("the finished rows are damaged"));
            }
            out.write_all(&block.bytes)?;
            found += block.rows;
        }
        Ok(())
    }
}

struct Block {
    rows: usize,
    bytes: Vec<u8>,
}

impl Block {
    fn write(out: impl Write, bytes: &[u8], rows: usize) -> io::Result<()> {
        let number = |n: usize| u32::try_from(n).map(u32::to_le_bytes).map_err(io::Error::other);
        let mut out = BufWriter::new(out);
        out.write_all(&number(bytes.len())?)?;
        out.write_all(&number(rows)?)?;
        out.write_all(bytes)?;
        out.write_all(&crc32fast::hash(bytes).to_le_bytes())?;
        out.flush()
    }

    fn read(input: &mut impl Read) -> io::Result<Self> {
        let mut number = || -> io::Result<u32> {
            let mut bytes = [0; 4];
            input.read_exact(&mut bytes)?;
            Ok(u32::from_le_bytes(bytes))
        };
        let (length, rows) = (number()?, number()?);
        let mut bytes = Vec::new();
        input.take(u64::from(length)).read_to_end(&mut bytes)?;
        let mut checksum = [0; 4];
        input.read_exact(&mut checksum)?;
        if crc32fast::hash(&bytes) != u32::from_le_bytes(checksum) {
            return Err(io::Error::other("a finished row is damaged"));
        }
        Ok(Self { rows: rows as usize, bytes })
    }

    /// In the file.
    fn size(&self) -> u64 {
        self.bytes.len() as u64 + 12
    }
}
