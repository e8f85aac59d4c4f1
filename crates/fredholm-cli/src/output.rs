//! Files that are whole or not there: prepared before the work begins, put in their place when it is done.

use anyhow::{Context, Result, anyhow, bail};
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::process;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};
use tempfile::NamedTempFile;

/// A file to be, whose folder is known to take it.
#[derive(Debug)]
pub struct Output {
    path: PathBuf,
    place: Place,
}

#[derive(Debug)]
enum Place {
    /// A file without a name of its own yet, beside the target, gone if it is dropped.
    Beside { file: NamedTempFile, target: PathBuf },
    /// A device or a pipe, which must not be replaced by a file.
    Itself(File),
}

impl Output {
    /// Makes sure that the file can be written, and leaves what is there untouched until [`Self::write`].
    pub fn prepare(path: &Path) -> Result<Self> {
        let place = Self::place(path).with_context(|| format!("cannot write {}", path.display()))?;
        Ok(Self { path: path.to_owned(), place })
    }

    /// Where it is going to be.
    pub fn path(&self) -> &Path {
        &self.path
    }

    fn place(path: &Path) -> Result<Place> {
        // A link stays one: the file that it points to is replaced.
        let target = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
        match fs::metadata(&target) {
            Ok(there) if there.is_dir() => bail!("it is a folder; give the name of a file"),
            Ok(there) if there.permissions().readonly() => bail!("the file is read-only"),
            Ok(there) if !there.is_file() => Ok(Place::Itself(OpenOptions::new().write(true).open(&target)?)),
            _ => {
                let folder = match target.parent() {
                    Some(folder) if !folder.as_os_str().is_empty() => folder,
                    _ => Path::new("."),
                };
                Ok(Place::Beside { file: temporary(folder)?, target })
            }
        }
    }

    /// Writes the file, all of it or nothing, and says where it is.
    pub fn write(self, write: impl FnOnce(&mut BufWriter<&mut File>) -> io::Result<()>) -> Result<PathBuf> {
        let Self { path, place } = self;
        let written = match place {
            Place::Itself(mut file) => buffered(&mut file, write),
            Place::Beside { mut file, target } => buffered(file.as_file_mut(), write)
                .and_then(|()| file.persist(&target).map(drop).map_err(|error| error.error)),
        };
        written.with_context(|| format!("cannot write {}", path.display()))?;
        Ok(path)
    }
}

/// Refuses to write two of the outputs of a run to the same file.
pub fn refuse_twins(paths: &[Option<&Path>]) -> Result<()> {
    let paths: Vec<&Path> = paths.iter().flatten().copied().collect();
    match (1..paths.len()).find(|&k| paths[..k].contains(&paths[k])) {
        Some(k) => bail!("two outputs are to be written to {}; give each its own file", paths[k].display()),
        None => Ok(()),
    }
}

/// Bytes that are written at once: by 8 KB, which end within pages, a file of 16 MB takes the system half as long again.
const BUFFER: usize = 1 << 20;

fn buffered(
    file: &mut File,
    write: impl FnOnce(&mut BufWriter<&mut File>) -> io::Result<()>,
) -> io::Result<()> {
    let mut out = BufWriter::with_capacity(BUFFER, file);
    write(&mut out)?;
    out.flush()
}

/// The files that have no name of their own yet, or had none once.
static PARTS: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// Lets an interrupt (Ctrl-C) take the unfinished files with it, which nobody would ever find again.
pub fn clear_on_interrupt() -> Result<()> {
    ctrlc::set_handler(clear).context("cannot listen for interrupts")
}

/// Lets the first interrupt only set a flag, so that what is found can be kept; the second one is as above.
pub fn stop_on_interrupt() -> Result<&'static AtomicBool> {
    static STOPPED: AtomicBool = AtomicBool::new(false);
    let stop = || {
        if STOPPED.swap(true, Ordering::Relaxed) || ENDS.load(Ordering::Relaxed) {
            clear();
        }
    };
    ctrlc::set_handler(stop).context("cannot listen for interrupts")?;
    Ok(&STOPPED)
}

/// Whether even the first interrupt ends the program.
static ENDS: AtomicBool = AtomicBool::new(false);

/// Lets the next interrupt end the program, where there is nothing left to be kept.
pub fn end_on_interrupt() {
    ENDS.store(true, Ordering::Relaxed);
}

fn clear() {
    for part in PARTS.lock().unwrap_or_else(PoisonError::into_inner).iter() {
        // Most are finished and gone; a last one that cannot be removed has nobody to be told to.
        let _ = fs::remove_file(part);
    }
    // 128 + SIGINT, as shells have it.
    process::exit(130);
}

/// A nameless file in a folder, with the permissions that any new file has.
fn temporary(folder: &Path) -> Result<NamedTempFile> {
    fs::metadata(folder).with_context(|| format!("the folder {}", folder.display()))?;
    let mut builder = tempfile::Builder::new();
    builder.prefix(".fredholm-").suffix(".part");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // Without this the file would be for its owner's eyes only; the umask has its say as ever.
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    // The error itself names a file that nobody asked for.
    let file = builder
        .tempfile_in(folder)
        .map_err(|error| anyhow!("the folder {} takes no files: {}", folder.display(), error.kind()))?;
    PARTS.lock().unwrap_or_else(PoisonError::into_inner).push(file.path().to_owned());
    Ok(file)
}

/// A folder for frames: made if need be, and taken away again if it was made for nothing.
#[derive(Debug)]
pub struct Folder {
    path: PathBuf,
    made: bool,
}

impl Folder {
    /// Makes sure that files can be written into it.
    pub fn prepare(path: &Path) -> Result<Self> {
        let made = !path.exists();
        fs::create_dir_all(path).with_context(|| format!("cannot make the folder {}", path.display()))?;
        let folder = Self { path: path.to_owned(), made };
        folder.frame(1)?;
        Ok(folder)
    }

    /// The file of an iteration's frame.
    pub fn frame(&self, iteration: usize) -> Result<Output> {
        Output::prepare(&self.path.join(format!("{iteration:05}.png")))
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        if self.made {
            // Only an empty folder can be removed, which is what is wanted.
            let _ = fs::remove_dir(&self.path);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).unwrap();
        entries.map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned()).collect()
    }

    #[test]
    fn a_file_is_replaced_only_when_the_new_one_is_whole() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.txt");
        fs::write(&path, "old").unwrap();
        let full = io::Error::from(io::ErrorKind::StorageFull);
        let failed = Output::prepare(&path).unwrap().write(|out| {
            out.write_all(b"half")?;
            Err(full)
        });
        let message = format!("{:#}", failed.unwrap_err());
        assert!(message.contains("a.txt") && message.contains("no storage space"), "{message}");
        assert_eq!(fs::read_to_string(&path).unwrap(), "old");
        Output::prepare(&path).unwrap().write(|out| out.write_all(b"new")).unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "new");
        assert_eq!(names(folder.path()), ["a.txt"]);
    }

    #[test]
    fn a_file_that_is_given_up_leaves_nothing() {
        let folder = tempfile::tempdir().unwrap();
        drop(Output::prepare(&folder.path().join("a.txt")).unwrap());
        assert!(names(folder.path()).is_empty());
    }

    #[test]
    fn what_cannot_be_written_is_told_at_once() {
        let folder = tempfile::tempdir().unwrap();
        let message = |path: &Path| format!("{:#}", Output::prepare(path).unwrap_err());
        assert!(message(folder.path()).contains("it is a folder"));
        assert!(message(&folder.path().join("no/such.txt")).contains("No such file"));
    }

    #[cfg(unix)]
    #[test]
    fn a_device_is_written_to_and_not_replaced() {
        use std::os::unix::fs::FileTypeExt;
        let null = Path::new("/dev/null");
        Output::prepare(null).unwrap().write(|out| out.write_all(b"x")).unwrap();
        assert!(fs::metadata(null).unwrap().file_type().is_char_device());
    }

    #[test]
    fn two_outputs_need_two_files() {
        let (a, b) = (Some(Path::new("a")), Some(Path::new("b")));
        assert!(refuse_twins(&[a, None, b]).is_ok());
        assert!(refuse_twins(&[a, b, a]).is_err());
    }
}
