//! Files that are there as a whole or not at all.

use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

/// Writes a file beside its final name and renames it when it is complete.
///
/// If `write` fails, or the process ends before it is done, the old file stays as it was. What is not
/// a regular file, such as a pipe or a terminal, is written directly.
///
/// ```
/// use std::io::{self, Write};
/// let path = std::env::temp_dir().join(format!("nusselt-doc-{}.txt", std::process::id()));
/// nusselt::io::atomic_write(&path, |file| writeln!(file, "complete"))?;
/// assert_eq!(std::fs::read_to_string(&path)?, "complete\n");
/// let failed = nusselt::io::atomic_write(&path, |_| Err(io::Error::other("no")));
/// assert!(failed.is_err() && std::fs::read_to_string(&path)? == "complete\n");
/// # std::fs::remove_file(&path)?;
/// # Ok::<(), io::Error>(())
/// ```
///
/// # Errors
/// What `write` returns, or what creating, writing or renaming the file does.
pub fn atomic_write<E: From<io::Error>>(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<File>) -> Result<(), E>,
) -> Result<(), E> {
    let old = fs::metadata(path).ok();
    if old.as_ref().is_some_and(|old| !old.is_file()) {
        let mut file = BufWriter::new(OpenOptions::new().write(true).open(path)?);
        write(&mut file)?;
        return Ok(file.flush()?);
    }
    // A link stays a link: what it points to is replaced.
    let target = if old.is_some() { fs::canonicalize(path)? } else { path.to_owned() };
    let mut temporary = Temporary::create(&target)?;
    write(&mut temporary.file)?;
    temporary.file.flush()?;
    if let Some(old) = old {
        temporary.file.get_ref().set_permissions(old.permissions())?;
    }
    temporary.file.get_ref().sync_all()?;
    fs::rename(&temporary.path, &target)?;
    temporary.is_done = true;
    Ok(())
}

/// A file under a name of its own, removed unless it is done.
struct Temporary {
    path: PathBuf,
    file: BufWriter<File>,
    is_done: bool,
}

impl Temporary {
    fn create(target: &Path) -> io::Result<Self> {
        static COUNT: AtomicU64 = AtomicU64::new(0);
        let Some(name) = target.file_name() else {
            return Err(io::Error::new(io::ErrorKind::InvalidInput, "the path does not name a file"));
        };
        loop {
            let mut unique = std::ffi::OsString::from(".");
            unique.push(name);
            unique.push(format!(".{}-{}.tmp", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed)));
            let path = target.with_file_name(unique);
            match OpenOptions::new().write(true).create_new(true).open(&path) {
                Ok(file) => return Ok(Self { path, file: BufWriter::new(file), is_done: false }),
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
                Err(error) => return Err(error),
            }
        }
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        if !self.is_done {
            // There is no one left to tell if this fails.
            let _ = fs::remove_file(&self.path);
        }
    }
}
