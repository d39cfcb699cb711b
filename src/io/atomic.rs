//! Files that are there as a whole or not at all.

use std::ffi::OsStr;
use std::fs::{self, File, OpenOptions, TryLockError};
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
    let mut temporary = Temporary::beside(path)?;
    write(&mut temporary.file)?;
    temporary.file.flush()?;
    if let Some(old) = old {
        temporary.file.get_ref().set_permissions(old.permissions())?;
    }
    temporary.file.get_ref().sync_all()?;
    fs::rename(&temporary.path, &temporary.target)?;
    temporary.is_done = true;
    Ok(())
}

/// Makes sure that [`atomic_write`] could write a file now, so that no work is done for one that cannot be made: makes the file beside it, and removes it again. Whether what is not a regular file can be written is not looked at,
/// as a pipe would wait for who reads it, but that it is a directory is told.
///
/// # Errors
/// What making the file returns.
pub fn check_writable(path: &Path) -> io::Result<()> {
    match fs::metadata(path) {
        Ok(old) if old.is_dir() => Err(io::ErrorKind::IsADirectory.into()),
        Ok(old) if !old.is_file() => Ok(()),
        _ => Temporary::beside(path).map(drop),
    }
}

/// The end of temporary names.
const ENDING: &str = ".tmp";

/// A file under a name of its own, removed unless it is done.
struct Temporary {
    path: PathBuf,
    /// The name that it is to have.
    target: PathBuf,
    file: BufWriter<File>,
    is_done: bool,
}

impl Temporary {
    /// Of a file that is to have that name, or of the one that a link of that name leads to: it stays a link.
    fn beside(path: &Path) -> io::Result<Self> {
        let is_there = fs::metadata(path).is_ok();
        Self::create(if is_there { fs::canonicalize(path)? } else { path.to_owned() })
    }

    fn create(target: PathBuf) -> io::Result<Self> {
        static COUNT: AtomicU64 = AtomicU64::new(0);
        let Some(name) = target.file_name() else {
            return Err(io::Error::new(io::ErrorKind::InvalidInput, "the path does not name a file"));
        };
        loop {
            let mut unique = std::ffi::OsString::from(".");
            unique.push(name);
            unique.push(format!(".{}-{}{ENDING}", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed)));
            let path = target.with_file_name(unique);
            let file = match OpenOptions::new().write(true).create_new(true).open(&path) {
                Ok(file) => file,
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => continue,
                Err(error) => return Err(error),
            };
            // The lock tells that someone is writing; the system takes it away from who does not any more. Where there are no locks nothing is ever
            // taken to be abandoned. One who was quicker holds it only to remove the file.
            let is_taken = matches!(file.try_lock(), Err(TryLockError::WouldBlock));
            if !is_taken && fs::symlink_metadata(&path).is_ok() {
                return Ok(Self { path, target, file: BufWriter::new(file), is_done: false });
            }
        }
    }
}

/// Removes what killed processes left of writing a file with [`atomic_write`]: the temporary files beside it, which are
/// called `.NAME.PID-N.tmp`, and that no one is writing any more. It takes reading the directory.
///
/// Whether someone writes is told by a lock on the file, which ends with the process, on whichever machine that is. What cannot be locked stays, and
/// nothing that goes wrong here is told: it is only about space.
pub fn remove_abandoned(path: &Path) {
    let target = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    let Some(name) = target.file_name() else { return };
    let folder = target.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let is_file = entry.file_type().is_ok_and(|kind| kind.is_file());
        if !is_file || !is_temporary(&entry.file_name(), name) {
            continue;
        }
        // Kept until it is removed: who has just made it must not be between that and his lock.
        let Ok(file) = File::options().write(true).open(entry.path()) else { continue };
        if file.try_lock().is_ok() {
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// True for a name that [`atomic_write`] gives to what becomes a file with the name `target`.
fn is_temporary(name: &OsStr, target: &OsStr) -> bool {
    let is_number = |text: &[u8]| !text.is_empty() && text.iter().all(u8::is_ascii_digit);
    let numbers = name.as_encoded_bytes().strip_prefix(b".").and_then(|name| {
        name.strip_prefix(target.as_encoded_bytes())?.strip_prefix(b".")?.strip_suffix(ENDING.as_bytes())
    });
    let place = numbers.and_then(|numbers| numbers.iter().position(|&byte| byte == b'-'));
    matches!((numbers, place), (Some(numbers), Some(place)) if is_number(&numbers[..place]) && is_number(&numbers[place + 1..]))
}

impl Drop for Temporary {
    fn drop(&mut self) {
        if !self.is_done {
            // There is no one left to tell if this fails.
            let _ = fs::remove_file(&self.path);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_cannot_be_written_is_known_before() {
        let folder = std::env::temp_dir().join(format!("nusselt-writable-{}", std::process::id()));
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(&folder).expect("a folder for tests");
        let file = folder.join("a.npy");
        check_writable(&file).expect("it is not there, and can be");
        fs::write(&file, "old").expect("writable");
        check_writable(&file).expect("it can be replaced");
        assert_eq!(fs::read(&file).expect("as it was"), b"old");
        let kind = |path: &Path| check_writable(path).expect_err("it cannot be written").kind();
        assert_eq!(kind(&folder), io::ErrorKind::IsADirectory);
        assert_eq!(kind(&folder.join("none").join("a.npy")), io::ErrorKind::NotFound);
        assert_eq!(kind(&file.join("a.npy")), io::ErrorKind::NotADirectory);
        assert_eq!(fs::read_dir(&folder).expect("it is there").count(), 1, "nothing is left");
        fs::remove_dir_all(&folder).expect("it is there");
    }

    #[test]
    fn only_temporary_files_of_the_target_that_no_one_writes_are_removed() {
        let folder = std::env::temp_dir().join(format!("nusselt-abandoned-{}", std::process::id()));
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(&folder).expect("a folder for tests");
        let left = [".a.npy.17-0.tmp", ".a.npy.4000000000-12.tmp"];
        let others = [
            "a.npy",
            ".a.npy",
            ".a.npy.tmp",
            ".a.npy.-.tmp",
            ".a.npy.17-.tmp",
            ".a.npy.17.tmp",
            ".a.npy.x-1.tmp",
            ".a.npy.1-2-3.tmp",
            ".a.npy.17-0.tmp2",
            ".a.npy.partial.17-0.tmp",
            ".b.npy.17-0.tmp",
            "a.npy.17-0.tmp",
        ];
        for name in left.iter().chain(&others) {
            fs::write(folder.join(name), name).expect("writable");
        }
        fs::create_dir(folder.join(".a.npy.18-0.tmp")).expect("a folder");
        let target = folder.join("a.npy");
        // Another one writes it at the same time.
        atomic_write(&target, |file| {
            file.write_all(b"new")?;
            remove_abandoned(&target);
            let there = |name: &&str| folder.join(name).exists();
            assert!(!left.iter().any(there) && others.iter().all(there));
            Ok::<_, io::Error>(())
        })
        .expect("its own is not taken away");
        assert_eq!(fs::read(&target).expect("it is there"), b"new");
        assert!(folder.join(".a.npy.18-0.tmp").is_dir());
        remove_abandoned(&folder.join("none").join("a.npy"));
        remove_abandoned(Path::new("/"));
        fs::remove_dir_all(&folder).expect("it is there");
    }
}
