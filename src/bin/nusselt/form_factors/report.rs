//! The summary, as JSON and in words.

use super::certify::Proved;
use super::reciprocity::Defects;
use super::tally::Tally;
use crate::summary::{Lines, Timing, number, short};
use nusselt::io::matrix::FORM_FACTORS_SCHEMA;
use nusselt::scene::Scene;
use serde::Serialize;
use std::ops::Range;
use std::path::Path;
use std::time::Duration;

/// What took how long.
pub(super) struct Times {
    load_s: f64,
    prepare_s: f64,
    rows: usize,
    /// Of all rows together, by all threads.
    pub(super) rows_s: f64,
    /// The sum over rows, and the largest: the time that a thread spent on a row.
    sum_ms: f64,
    max_ms: f64,
    /// To write the final file from the rows.
    pub(super) write_s: f64,
}

impl Times {
    pub(super) fn new(load_s: f64, prepare_s: f64) -> Self {
        Self { load_s, prepare_s, rows: 0, rows_s: 0.0, sum_ms: 0.0, max_ms: 0.0, write_s: 0.0 }
    }

    /// The time of a thread for a row.
    pub(super) fn add_row(&mut self, took: Duration) {
        let ms = took.as_secs_f64() * 1e3;
        self.rows += 1;
        self.sum_ms += ms;
        self.max_ms = self.max_ms.max(ms);
    }
}

/// What `--json` prints.
#[derive(Serialize)]
pub(super) struct Report<'a> {
    schema: &'static str,
    /// `polygon`, `object` or the longest edge.
    patch: String,
    tolerance: f64,
    two_sided: bool,
    polygons: usize,
    patches: usize,
    /// The first row, and one more than the last.
    rows: [u32; 2],
    rows_computed: usize,
    /// Those that an interrupted run had left.
    rows_kept: usize,
    /// Rows of patches without area: nothing leaves them.
    rows_without_area: usize,
    /// How many factors between patches are not zero.
    factors: u64,
    /// Of rows of patches with area.
    background_mean: f64,
    /// How far the factors of a row are from summing to 1, at most.
    worst_closure: f64,
    /// The same before any residue was placed: the largest residue.
    worst_residue: f64,
    /// `null` where backs count as their patches: that is not reciprocal.
    reciprocity: Option<Defects>,
    /// What `--enforce-reciprocity` changed; all else is told of the factors before.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) enforced: Option<Enforced>,
    largest_estimate: f64,
    /// Rows with an estimate above the tolerance.
    rows_above_tolerance: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    certificate: Option<&'a Proved>,
    timing: RowTiming,
}

/// `views` are rows here: a row takes as many views as it needs.
#[derive(Clone, Copy, Serialize)]
struct RowTiming {
    #[serde(flatten)]
    timing: Timing,
    /// To compute all rows, and to write them as they come.
    rows_s: f64,
    /// To write the final file from them.
    write_s: f64,
}

/// What making factors reciprocal took.
#[derive(Clone, Copy, Serialize)]
pub(super) struct Enforced {
    /// The largest change of a factor.
    pub(super) largest_change: f64,
    /// How many factors changed by more than their estimates.
    pub(super) beyond_estimates: usize,
}

/// What was computed.
pub(super) struct Asked {
    pub(super) patch: String,
    pub(super) patches: usize,
    pub(super) two_sided: bool,
    pub(super) rows: Range<u32>,
}

impl<'a> Report<'a> {
    pub(super) fn new(
        scene: &Scene,
        asked: Asked,
        tally: &Tally<'_>,
        times: &Times,
        certificate: Option<&'a Proved>,
    ) -> Self {
        let Times { load_s, prepare_s, rows, rows_s, sum_ms, max_ms, write_s } = *times;
        let mut timing = Timing::of_many(load_s, prepare_s, rows, sum_ms, max_ms);
        timing.certify_ms = certificate.map(|proved| proved.ms);
        Self {
            schema: FORM_FACTORS_SCHEMA,
            patch: asked.patch,
            tolerance: tally.tolerance(),
            two_sided: asked.two_sided,
            polygons: scene.polygon_count(),
            patches: asked.patches,
            rows: [asked.rows.start, asked.rows.end],
            rows_computed: tally.computed,
            rows_kept: tally.kept,
            rows_without_area: tally.zero_area(),
            factors: tally.factors,
            background_mean: tally.background_mean(),
            worst_closure: tally.worst_closure,
            worst_residue: tally.worst_residue,
            reciprocity: tally.defects(),
            enforced: None,
            largest_estimate: tally.largest_estimate,
            rows_above_tolerance: tally.rows_above,
            certificate,
            timing: RowTiming { timing, rows_s, write_s },
        }
    }

    pub(super) fn in_words(&self, output: Option<&Path>) -> String {
        let mut lines = Lines::default();
        lines.add("scene", format!("{} polygons", self.polygons));
        let sides = if self.two_sided { ", both sides receive" } else { "" };
        lines
            .add("patches", format!("{} by {}, tolerance {}{sides}", self.patches, self.patch, number(self.tolerance)));
        let kept = match self.rows_kept {
            0 => String::new(),
            kept => format!("; {kept} were there"),
        };
        let [start, end] = self.rows;
        lines.add("rows", format!("{start}..{end}, {} computed{kept}", self.rows_computed));
        let [closure, raw] = [self.worst_closure, self.worst_residue].map(number);
        lines
            .add("factors", format!("{}, rows within {closure} of 1, {raw} before residues were placed", self.factors));
        lines.add("background", format!("{:.8} on average", self.background_mean));
        let [largest, tolerance] = [short(self.largest_estimate), number(self.tolerance)];
        lines.add("estimates", format!("at most {largest}; above {tolerance} in {} rows", self.rows_above_tolerance));
        if let Some(defects) = &self.reciprocity {
            lines.add("reciprocity", in_words(defects));
        }
        if let Some(Enforced { largest_change, beyond_estimates }) = self.enforced {
            let largest = short(largest_change);
            let what = format!("factors changed by at most {largest}, {beyond_estimates} by more than their estimates");
            lines.add("enforced", what);
        }
        if let Some(proved) = self.certificate {
            proved.tell(&mut lines);
        }
        let RowTiming { timing, rows_s, write_s } = self.timing;
        let Timing { load_s, bsp_s, view_ms_mean, view_ms_max, .. } = timing;
        lines.add(
            "time",
            format!(
                "load {load_s:.3} s, set-up {bsp_s:.3} s, rows {rows_s:.3} s (each {view_ms_mean:.3} ms of a thread, \
                 at most {view_ms_max:.3} ms), file {write_s:.3} s"
            ),
        );
        if let Some(path) = output {
            lines.add("wrote", path.display());
        }
        lines.0
    }
}

fn in_words(defects: &Defects) -> String {
    let Defects { largest, between, largest_relative, pairs, every, .. } = *defects;
    let [largest, relative] = [largest, largest_relative].map(short);
    let between = between.map_or_else(String::new, |[i, j]| format!(" (patches {i} and {j})"));
    let part = if every > 1 { format!(", 1 of {every}") } else { String::new() };
    format!("A_i F_ij and A_j F_ji differ by at most {largest}{between}, {relative} of A_i + A_j; {pairs} pairs{part}")
}
