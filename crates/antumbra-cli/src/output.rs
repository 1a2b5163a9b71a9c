//! Files that appear whole or not at all, and the two standard streams.
//!
//! A [`Sink`] is opened *before* the work, so that a wrong path is found at once and not after minutes. It is a hidden
//! file beside its destination until [`finish`] renames it. Whatever ends the program earlier (an error, a full disk,
//! Ctrl-C) leaves no trace of it. Devices and pipes (`/dev/null`) cannot be renamed onto: those are written directly.

use std::{
    fs::{self, File, OpenOptions},
    io::{self, BufWriter, ErrorKind, Write},
    path::{Path, PathBuf},
};

use anyhow::{Result, anyhow, bail};
use tempfile::{NamedTempFile, TempPath};

use crate::interrupt::unfinished;

/// One file to be written.
#[derive(Debug)]
pub(crate) struct Sink {
    /// As the user wrote it, for messages.
    path: PathBuf,
    place: Place,
}

#[derive(Debug)]
enum Place {
    /// A hidden file and the name that it will get.
    Pending { file: File, hidden: TempPath, destination: PathBuf },
    /// A device or a pipe.
    Direct(File),
}

impl Sink {
    /// Checks that `path` can be written and reserves it.
    ///
    /// # Errors
    /// Where it cannot be written, with the path, the reason and what to do.
    pub(crate) fn open(path: &Path) -> Result<Self> {
        let existing = fs::metadata(path).ok();
        match &existing {
            Some(old) if old.is_dir() => {
                bail!("cannot write `{0}`: it is a folder; add a file name, such as `{0}/picture.png`", path.display())
            }
            Some(old) if !old.is_file() => {
                let file = OpenOptions::new().write(true).open(path).map_err(|e| cannot_write(path, &e))?;
                return Ok(Self { path: path.to_owned(), place: Place::Direct(file) });
            }
            Some(old) if old.permissions().readonly() => {
                bail!("cannot write `{}`: the file exists and is read-only; choose another name", path.display())
            }
            _ => {}
        }
        // A link is written through, not replaced.
        let destination = if existing.is_some() { fs::canonicalize(path) } else { Ok(path.to_owned()) };
        let destination = destination.map_err(|e| cannot_write(path, &e))?;
        let folder = destination.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let Some(name) = destination.file_name() else {
            bail!("cannot write `{}`: it is not a file name", path.display());
        };
        let prefix = format!(".{}.", name.to_string_lossy());
        let mut builder = tempfile::Builder::new();
        builder.prefix(&prefix).suffix(".part");
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
        let mut unfinished = unfinished();
        let hidden: NamedTempFile = builder.tempfile_in(folder).map_err(|e| cannot_write(path, &e))?;
        unfinished.push(hidden.path().to_owned());
        let (file, hidden) = hidden.into_parts();
        if let Some(old) = existing {
            file.set_permissions(old.permissions()).map_err(|e| cannot_write(path, &e))?;
        }
        Ok(Self { path: path.to_owned(), place: Place::Pending { file, hidden, destination } })
    }

    /// Writes the content, once.
    ///
    /// # Errors
    /// Where the disk is full or the device refuses.
    pub(crate) fn fill(&mut self, bytes: &[u8]) -> Result<()> {
        match &mut self.place {
            Place::Direct(file) => write_whole(file, bytes),
            // Some file systems report a full disk only when asked to bring the data to it.
            Place::Pending { file, .. } => write_whole(file, bytes).and_then(|()| file.sync_all()),
        }
        .map_err(|e| cannot_write(&self.path, &e))
    }

    /// Writes the content, once, piece by piece.
    ///
    /// # Errors
    /// Those of the content; where the disk is full or the device refuses.
    pub(crate) fn write(&mut self, content: impl FnOnce(&mut dyn Write) -> Result<()>) -> Result<()> {
        let (Place::Direct(file) | Place::Pending { file, .. }) = &mut self.place;
        let mut out = BufWriter::new(&mut *file);
        content(&mut out).map_err(|e| anyhow!("cannot write `{}`: {e:#}", self.path.display()))?;
        out.flush().map_err(|e| cannot_write(&self.path, &e))?;
        drop(out);
        match &self.place {
            Place::Direct(_) => Ok(()),
            Place::Pending { file, .. } => file.sync_all().map_err(|e| cannot_write(&self.path, &e)),
        }
    }
}

/// Gives all files their names; an interrupt comes before the first or after the last. Other unfinished files stay so.
///
/// # Errors
/// Where a file cannot be renamed; those before it are in place.
pub(crate) fn finish(sinks: Vec<Sink>) -> Result<()> {
    let mut unfinished = unfinished();
    for sink in sinks {
        if let Place::Pending { hidden, destination, .. } = sink.place {
            let name = hidden.to_path_buf();
            hidden.persist(destination).map_err(|e| cannot_write(&sink.path, &e.error))?;
            unfinished.retain(|path| *path != name);
        }
    }
    Ok(())
}

/// A folder for several files; where it had to be made and nothing came into it, it is removed again.
#[derive(Debug)]
pub(crate) struct Folder {
    path: PathBuf,
    made: bool,
}

impl Folder {
    /// Checks that files can be written in `path`, making the folder if its parent exists.
    ///
    /// # Errors
    /// Where they cannot.
    pub(crate) fn open(path: &Path) -> Result<Self> {
        let made = match fs::metadata(path) {
            Ok(old) if old.is_dir() => false,
            Ok(_) => bail!("cannot write into `{}`: it is a file, not a folder", path.display()),
            Err(_) => {
                let mut unfinished = unfinished();
                fs::create_dir(path).map_err(|e| cannot_write(path, &e))?;
                unfinished.push(path.to_owned());
                true
            }
        };
        let folder = Self { path: path.to_owned(), made };
        tempfile::tempfile_in(path).map_err(|e| cannot_write(&path.join("*"), &e))?;
        Ok(folder)
    }

    /// A file in the folder.
    ///
    /// # Errors
    /// As for [`Sink::open`].
    pub(crate) fn sink(&self, name: &str) -> Result<Sink> {
        Sink::open(&self.path.join(name))
    }

    /// The folder as the user wrote it.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        if self.made {
            // Fails, as it should, where the folder is not empty.
            let _ = fs::remove_dir(&self.path);
        }
    }
}

fn write_whole(out: &mut impl Write, bytes: &[u8]) -> io::Result<()> {
    out.write_all(bytes)?;
    out.flush()
}

/// The message for a path that cannot be written: what, why, and what to do.
fn cannot_write(path: &Path, error: &io::Error) -> anyhow::Error {
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let parent = folder.display();
    let reason = match error.kind() {
        ErrorKind::NotFound if !folder.exists() => format!("the folder `{parent}` does not exist; make it first"),
        ErrorKind::NotFound => format!("`{parent}` takes no new files; choose another place"),
        ErrorKind::NotADirectory => format!("`{parent}` is not a folder"),
        ErrorKind::PermissionDenied => format!("you may not write in `{parent}`; choose another place"),
        ErrorKind::ReadOnlyFilesystem => format!("`{parent}` is on a read-only disk; choose another place"),
        ErrorKind::StorageFull | ErrorKind::QuotaExceeded | ErrorKind::FileTooLarge => {
            format!("no space left for it; free some or choose another place ({error})")
        }
        ErrorKind::InvalidFilename => "the name is too long or has characters that the disk refuses".to_owned(),
        _ => error.to_string(),
    };
    anyhow!("cannot write `{}`: {reason}", path.display())
}

/// Prints a result on standard output. A reader that has gone away (`| head`) is not an error.
///
/// # Errors
/// Where standard output cannot be written for another reason.
pub(crate) fn print(text: &str) -> Result<()> {
    match write_whole(&mut io::stdout().lock(), text.as_bytes()) {
        Err(e) if e.kind() == ErrorKind::BrokenPipe => Ok(()),
        other => other.map_err(|e| anyhow!("cannot write to standard output: {e}")),
    }
}

/// Prints a line for a person on standard error; where that is closed, nobody is there to miss it.
pub(crate) fn remark(text: &str) {
    let _ = writeln!(io::stderr().lock(), "{text}");
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A disk with room for a few bytes.
    struct Disk {
        room: usize,
    }

    impl Write for Disk {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            if self.room == 0 {
                return Err(ErrorKind::StorageFull.into());
            }
            let taken = bytes.len().min(self.room);
            self.room -= taken;
            Ok(taken)
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    fn names(folder: &Path) -> Vec<String> {
        let mut names: Vec<_> =
            fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    #[test]
    fn a_full_disk_is_reported_with_the_path() {
        assert!(write_whole(&mut Disk { room: 10 }, &[0; 10]).is_ok());
        let error = write_whole(&mut Disk { room: 10 }, &[0; 11]).unwrap_err();
        let message = cannot_write(Path::new("a/b.png"), &error).to_string();
        assert!(message.contains("`a/b.png`") && message.contains("no space left"), "{message}");
    }

    #[test]
    fn every_kind_of_refusal_says_what_to_do() {
        for (kind, words) in [
            (ErrorKind::NotFound, "the folder `a` does not exist; make it first"),
            (ErrorKind::NotADirectory, "`a` is not a folder"),
            (ErrorKind::PermissionDenied, "you may not write in `a`"),
            (ErrorKind::ReadOnlyFilesystem, "read-only disk"),
            (ErrorKind::QuotaExceeded, "no space left"),
            (ErrorKind::Other, "cannot write `a/b.png`"),
        ] {
            let message = cannot_write(Path::new("a/b.png"), &kind.into()).to_string();
            assert!(message.contains(words), "{kind}: {message}");
        }
    }

    #[test]
    fn a_file_appears_only_when_finished() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("p.png");
        fs::write(&path, "old").unwrap();
        let mut sink = Sink::open(&path).unwrap();
        sink.fill(b"new").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"old");
        finish(vec![sink]).unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"new");
        drop(Sink::open(&path).unwrap());
        assert_eq!(names(folder.path()), ["p.png"]);
    }

    #[test]
    fn a_folder_made_for_nothing_goes_away() {
        let root = tempfile::tempdir().unwrap();
        let path = root.path().join("planes");
        let folder = Folder::open(&path).unwrap();
        let mut sink = folder.sink("t_lo.npy").unwrap();
        sink.fill(b"x").unwrap();
        drop(sink);
        drop(folder);
        assert!(!path.exists());
        let folder = Folder::open(&path).unwrap();
        finish(vec![folder.sink("t_lo.npy").unwrap()]).unwrap();
        drop(folder);
        assert_eq!(names(&path), ["t_lo.npy"]);
    }

    #[cfg(unix)]
    #[test]
    fn links_are_written_through_and_permissions_kept() {
        use std::os::unix::fs::{PermissionsExt, symlink};
        let folder = tempfile::tempdir().unwrap();
        let (real, link) = (folder.path().join("real.png"), folder.path().join("link.png"));
        fs::write(&real, "old").unwrap();
        fs::set_permissions(&real, fs::Permissions::from_mode(0o640)).unwrap();
        symlink(&real, &link).unwrap();
        let mut sink = Sink::open(&link).unwrap();
        sink.fill(b"new").unwrap();
        finish(vec![sink]).unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::read(&real).unwrap(), b"new");
        assert_eq!(fs::metadata(&real).unwrap().permissions().mode() & 0o777, 0o640);
        fs::set_permissions(&real, fs::Permissions::from_mode(0o440)).unwrap();
        assert!(Sink::open(&link).unwrap_err().to_string().contains("read-only"));
    }
}
