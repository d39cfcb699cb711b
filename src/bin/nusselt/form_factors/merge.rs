//! `nusselt form-factors merge`: parts of a matrix put together.

use super::{options, patches, refused};
use crate::args::Common;
use crate::failure::Failure;
use crate::output::{clear, keep, print, print_json};
use crate::summary::Lines;
use nusselt::io::matrix::{FORM_FACTORS_SCHEMA, MatrixError, merge, read_patches};
use serde_json::json;
use std::path::PathBuf;

const EXAMPLE: &str = "\
Example: two parts that have every row once, as one table
  nusselt form-factors merge a.rows b.rows -o city.csv";

/// Put parts of a matrix together, made with --rows
#[derive(clap::Args)]
#[command(after_help = EXAMPLE)]
pub(super) struct Merge {
    /// The parts, .rows, in any order: of one scene, with the same options, every row in one of them
    #[arg(value_name = "PART", required = true)]
    parts: Vec<PathBuf>,
    /// Write to this file, as form-factors does: the same, byte by byte, as if all rows had been computed in one run
    #[arg(short, long, value_name = "FILE", value_parser = options::parse_output)]
    output: PathBuf,
    /// Write the patches to this file, as form-factors does: .csv or .obj
    #[arg(long, value_name = "FILE", value_parser = options::parse_patches)]
    patches: Option<PathBuf>,
}

impl Merge {
    pub(super) fn run(&self, common: &Common) -> Result<(), Failure> {
        let refused = |error| match error {
            MatrixError::Io { path, source } if self.parts.contains(&path) => {
                Failure::Work(format!("cannot read {}: {source}; check the name and the folder", path.display()))
            }
            _ => refused(&self.output, error),
        };
        let outputs = || [Some(&self.output), self.patches.as_ref()].into_iter().flatten().map(PathBuf::as_path);
        keep(&self.parts, self.patches.iter().map(PathBuf::as_path))?;
        patches::keep_apart(self.patches.as_deref(), Some(&self.output))?;
        outputs().for_each(clear);
        merge(&self.parts, &self.output).map_err(refused)?;
        if let (Some(path), Some(part)) = (&self.patches, self.parts.first()) {
            patches::write(path, &read_patches(part).map_err(refused)?)?;
        }
        let (parts, output) = (self.parts.len(), self.output.display());
        if common.json {
            return print_json(&json!({ "schema": FORM_FACTORS_SCHEMA, "parts": parts, "wrote": output.to_string() }));
        }
        let mut lines = Lines::default();
        lines.add("merged", format!("{parts} parts"));
        lines.add("wrote", output);
        if common.quiet { Ok(()) } else { print(&lines.0) }
    }
}
