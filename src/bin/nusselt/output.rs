//! Files and standard output.

use crate::failure::Failure;
use nusselt::io::gltf::check_positions;
use nusselt::io::{atomic_write, check_writable, mtl, obj, remove_abandoned};
use nusselt::scene::Scene;
use std::fmt::Display;
use std::fs::File;
use std::io::{self, BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};

/// Prints to stdout. A reader that has gone away (`| head`) is not a failure.
pub(crate) fn print(text: &str) -> Result<(), Failure> {
    let mut out = io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(Failure::Work(format!("cannot write to standard output: {error}")))
        }
        _ => Ok(()),
    }
}

/// Prints a value as JSON.
pub(crate) fn print_json(value: &impl serde::Serialize) -> Result<(), Failure> {
    let text = serde_json::to_string_pretty(value).map_err(|e| Failure::Work(format!("cannot write JSON: {e}")))?;
    print(&(text + "\n"))
}

/// Why a file was not written.
pub(crate) enum Unwritten {
    /// Writing failed.
    Io(io::Error),
    /// What was to be written did.
    Failed(Failure),
}

impl From<io::Error> for Unwritten {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
}

impl From<Failure> for Unwritten {
    fn from(failure: Failure) -> Self {
        Self::Failed(failure)
    }
}

impl Unwritten {
    /// With the name of what could not be written.
    pub(crate) fn about(self, target: impl Display) -> Failure {
        match self {
            Self::Failed(failure) => failure,
            Self::Io(error) => {
                let advice = match error.kind() {
                    ErrorKind::NotFound | ErrorKind::NotADirectory => {
                        "; no file can be made there: choose another directory"
                    }
                    ErrorKind::PermissionDenied | ErrorKind::ReadOnlyFilesystem => {
                        "; choose a directory that you may write to"
                    }
                    ErrorKind::IsADirectory => "; name a file in it",
                    _ => "",
                };
                Failure::Work(format!("cannot write {target}: {error}{advice}"))
            }
        }
    }
}

/// Writes a file, whole or not at all.
pub(crate) fn write_file(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
) -> Result<(), Failure> {
    write_results(path, |out| Ok(write(out)?))
}

/// The same where what is written may fail to be found.
pub(crate) fn write_results(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<File>) -> Result<(), Unwritten>,
) -> Result<(), Failure> {
    atomic_write(path, write).map_err(|error| error.about(path.display()))
}

/// Refuses a GLB file of a scene that it does not hold, before any work is done for it.
pub(crate) fn check_glb(path: &Path, scene: &Scene) -> Result<(), Failure> {
    let advice = "use a larger unit of length, or another format";
    check_positions(scene.vertices())
        .map_err(|error| Failure::Work(format!("cannot write {}: {error}; {advice}", path.display())))
}

/// The material library beside an OBJ file, and the name by which the OBJ file refers to it.
pub(crate) fn library_of(obj: &Path) -> (PathBuf, String) {
    let path = obj.with_extension("mtl");
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    (path, name)
}

/// Writes an OBJ file with the materials of a scene beside it.
pub(crate) fn write_obj(path: &Path, groups: &[obj::Group], scene: &Scene) -> Result<(), Failure> {
    let (library, name) = library_of(path);
    // First, so that the OBJ file never refers to what is not there.
    write_file(&library, |out| mtl::write(out, scene.materials()))?;
    write_file(path, |out| obj::write(out, groups, Some(&name)))
}

/// The files that are written for an output: itself and, for OBJ, the material library beside it.
pub(crate) fn written(output: &Path) -> Vec<PathBuf> {
    let is_obj = output.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("obj"));
    let library = is_obj.then(|| library_of(output).0);
    [Some(output.to_owned()), library].into_iter().flatten().collect()
}

/// Refuses a file that two outputs would write.
pub(crate) fn check_once<'a>(outputs: impl Iterator<Item = &'a Path>) -> Result<(), Failure> {
    let mut before: Vec<PathBuf> = Vec::new();
    for output in outputs {
        let files = written(output);
        if before.iter().any(|other| files.iter().any(|file| is_same_file(file, other))) {
            return Err(Failure::Usage(format!("{} would be written twice; name each file once", output.display())));
        }
        before.extend(files);
    }
    Ok(())
}

/// Refuses outputs that cannot be written, as their folders do not exist or take no files, before any work is done for them.
pub(crate) fn can_be_written<'a>(outputs: impl Iterator<Item = &'a Path>) -> Result<(), Failure> {
    for output in outputs {
        let folder = output.parent().filter(|folder| !folder.as_os_str().is_empty());
        if let Some(folder) = folder.filter(|folder| !folder.exists()) {
            let [output, folder] = [output, folder].map(Path::display);
            let what = format!("cannot write {output}: {folder} does not exist; make its directory first");
            return Err(Failure::Work(what));
        }
        for file in written(output) {
            check_writable(&file).map_err(|error| Unwritten::Io(error).about(file.display()))?;
        }
    }
    Ok(())
}

/// Refuses outputs that would replace one of the files that are read.
pub(crate) fn keep<'a>(files: &[PathBuf], outputs: impl Iterator<Item = &'a Path>) -> Result<(), Failure> {
    for output in outputs {
        for target in written(output) {
            if let Some(file) = files.iter().find(|file| is_same_file(file, &target)) {
                let [output, file] = [output, file].map(Path::display);
                let what = format!("{output} would overwrite {file}, which is read; name another file");
                return Err(Failure::Usage(what));
            }
        }
    }
    Ok(())
}

/// Removes what killed runs left of writing an output.
pub(crate) fn clear(output: &Path) {
    for path in written(output) {
        remove_abandoned(&path);
    }
}

/// True if both names lead to one file, as far as that can be told before it is written.
pub(crate) fn is_same_file(a: &Path, b: &Path) -> bool {
    let whole = |path: &Path| {
        path.canonicalize().or_else(|_| {
            let parent = path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
            parent.canonicalize().map(|parent| parent.join(path.file_name().unwrap_or_default()))
        })
    };
    match (whole(a), whole(b)) {
        (Ok(a), Ok(b)) => a == b,
        _ => a == b,
    }
}
