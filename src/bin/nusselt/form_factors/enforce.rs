//! `--enforce-reciprocity`.

use super::report::Enforced;
use super::{Work, refused};
use crate::failure::Failure;
use crate::output::Unwritten;
use nusselt::factors::make_reciprocal;
use nusselt::io::matrix::{MatrixJob, MatrixWriter};
use std::path::Path;
use std::time::Instant;

/// So many entries are kept in memory: some two gigabytes, with what is computed from them.
const MOST_ENTRIES: usize = 1 << 24;

impl Work<'_, '_> {
    /// Computes all rows, makes them reciprocal and writes them.
    pub(super) fn enforce(&mut self, path: &Path, job: &MatrixJob<'_>) -> Result<Enforced, Failure> {
        let file = self.file;
        // Before anything is computed.
        let mut writer = MatrixWriter::create(path, job).map_err(|error| refused(file, error))?;
        let rows = writer.next_row()..writer.end_row();
        let (mut all, mut entries) = (Vec::new(), 0);
        let keep = |row: &nusselt::factors::Row| {
            entries += row.entries.len();
            if entries > MOST_ENTRIES {
                let what =
                    "the matrix is too large for --enforce-reciprocity, which has all of it in memory: more than";
                let failure = Failure::Work(format!("{what} {MOST_ENTRIES} factors are not zero; leave it out"));
                return Err(Unwritten::Failed(failure));
            }
            all.push(row.clone());
            Ok(())
        };
        self.run(rows, keep).map_err(|error| error.about(path.display()))?;
        let reciprocal = make_reciprocal(self.exchange.patches(), all).map_err(|error| Failure::about(file, &error))?;
        let start = Instant::now();
        for row in &reciprocal.rows {
            writer.row(row).map_err(|error| refused(file, error))?;
        }
        writer.finish().map_err(|error| refused(file, error))?;
        self.times.write_s = start.elapsed().as_secs_f64();
        Ok(Enforced { largest_change: reciprocal.largest_change, beyond_estimates: reciprocal.beyond_estimates })
    }
}
