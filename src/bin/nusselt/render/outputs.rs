//! The files that pictures are written to.

use crate::failure::Failure;
use crate::output::{check_once, is_same_file, write_file};
use nusselt::io::write_png;
use nusselt::render::Rendered;
use std::path::{Path, PathBuf};

/// A file to write, or one for each picture of a sequence.
#[derive(Clone)]
pub(super) struct Output {
    path: PathBuf,
    format: Format,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Format {
    Png,
    Exr,
}

impl Output {
    pub(super) fn parse(text: &str) -> Result<Self, String> {
        let path = PathBuf::from(text);
        let format = match path.extension().map(|ending| ending.to_string_lossy().to_lowercase()).as_deref() {
            Some("png") => Format::Png,
            Some("exr") if cfg!(feature = "exr") => Format::Exr,
            Some("exr") => {
                return Err(
                    "this build is without the feature exr; build it with --features exr, or take .png".to_owned()
                );
            }
            _ => return Err("its ending is none of .png, .exr".to_owned()),
        };
        Ok(Self { path, format })
    }

    pub(super) fn is_png(&self) -> bool {
        self.format == Format::Png
    }

    /// Writes one picture.
    pub(super) fn write(&self, file: &Path, rendered: &Rendered, exposure: f64) -> Result<(), Failure> {
        match self.format {
            Format::Png => write_file(file, |out| write_png(&rendered.displayed(exposure), out)),
            #[cfg(feature = "exr")]
            Format::Exr => write_file(file, |out| nusselt::io::write_exr(&rendered.picture, out)),
            #[cfg(not(feature = "exr"))]
            Format::Exr => unreachable!("refused when the command line was read"),
        }
    }

    /// The file of picture k of a sequence, from 0.
    fn numbered(&self, k: usize) -> PathBuf {
        let stem = self.path.file_stem().unwrap_or_default().to_string_lossy();
        let ending = self.path.extension().unwrap_or_default().to_string_lossy();
        self.path.with_file_name(format!("{stem}_{:04}.{ending}", k + 1))
    }
}

/// The files of all outputs, those of one after those of another; numbered if they are a sequence.
pub(super) fn files(outputs: &[Output], frames: Option<&Path>, count: usize) -> Result<Vec<PathBuf>, Failure> {
    check_once(outputs.iter().map(|output| output.path.as_path()))?;
    let Some(frames) = frames else { return Ok(outputs.iter().map(|output| output.path.clone()).collect()) };
    let files: Vec<PathBuf> = outputs.iter().flat_map(|output| (0..count).map(|k| output.numbered(k))).collect();
    match files.iter().find(|file| is_same_file(file, frames)) {
        Some(file) => Err(Failure::Usage(format!("{} would overwrite the path that is read", file.display()))),
        None => Ok(files),
    }
}
