//! What is summed up over the rows.

use super::pairs::PairSample;
use super::reciprocity::{Defects, Reciprocity};
use crate::args::Common;
use crate::summary::number;
use nusselt::factors::{PatchInfo, Row};
use std::ops::Range;

/// Over all rows of the file, those included that were there before the run.
pub(super) struct Tally<'p> {
    patches: &'p [PatchInfo],
    tolerance: f64,
    /// Rows that were there, and that were computed.
    pub(super) kept: usize,
    pub(super) computed: usize,
    /// How many of them are of patches with area.
    with_area: usize,
    /// Factors between patches that are not zero.
    pub(super) factors: u64,
    background: f64,
    /// How far a row of a patch with area is from summing to 1, at most: at last, and before any residue was placed.
    pub(super) worst_closure: f64,
    pub(super) worst_residue: f64,
    pub(super) largest_estimate: f64,
    /// Rows with an estimate above the tolerance.
    pub(super) rows_above: usize,
    /// `None` if a back counts as its patch: nothing is reciprocal then.
    reciprocity: Option<Reciprocity<'p>>,
    /// Pairs that are to be computed once more.
    pub(super) sample: Option<PairSample>,
}

impl<'p> Tally<'p> {
    /// For these rows, which come in their order.
    pub(super) fn new(patches: &'p [PatchInfo], rows: Range<u32>, tolerance: f64, two_sided: bool) -> Self {
        Self {
            patches,
            tolerance,
            kept: 0,
            computed: 0,
            with_area: 0,
            factors: 0,
            background: 0.0,
            worst_closure: 0.0,
            worst_residue: 0.0,
            largest_estimate: 0.0,
            rows_above: 0,
            reciprocity: (!two_sided).then(|| Reciprocity::new(patches, rows, tolerance)),
            sample: None,
        }
    }

    /// The next row, which was just computed.
    pub(super) fn add(&mut self, row: &Row) {
        self.computed += 1;
        self.sum_up(row);
    }

    /// The next row, which was there.
    pub(super) fn add_kept(&mut self, row: &Row) {
        self.kept += 1;
        self.sum_up(row);
    }

    fn sum_up(&mut self, row: &Row) {
        if let Some(reciprocity) = &mut self.reciprocity {
            reciprocity.add(row);
        }
        if let Some(sample) = &mut self.sample {
            sample.add(row);
        }
        self.factors += row.entries.len() as u64;
        if self.patches[row.patch as usize].area > 0.0 {
            self.with_area += 1;
            self.background += row.background.factor;
            self.worst_closure = self.worst_closure.max((row.sum() - 1.0).abs());
            self.worst_residue = self.worst_residue.max((row.closure_raw - 1.0).abs());
        }
        let shares = row.entries.iter().map(|entry| entry.share).chain([row.backs, row.background]);
        let estimate = shares.fold(0.0, |largest: f64, share| largest.max(share.error));
        self.largest_estimate = self.largest_estimate.max(estimate);
        self.rows_above += usize::from(estimate > self.tolerance);
    }

    /// The mean over patches with area.
    pub(super) fn background_mean(&self) -> f64 {
        self.background / self.with_area.max(1) as f64
    }

    pub(super) fn zero_area(&self) -> usize {
        self.kept + self.computed - self.with_area
    }

    pub(super) fn tolerance(&self) -> f64 {
        self.tolerance
    }

    pub(super) fn defects(&self) -> Option<Defects> {
        self.reciprocity.as_ref().map(Reciprocity::defects)
    }

    /// Warns of rows that may be less accurate than was asked for.
    pub(super) fn warn(&self, common: &Common) {
        if self.rows_above > 0 {
            let rows = self.rows_above;
            let [largest, tolerance] = [self.largest_estimate, self.tolerance].map(number);
            common.warn(&format!(
                "{rows} rows have factors whose error is estimated above the tolerance {tolerance}, at most {largest}; \
                 their estimates say which, and smaller patches help"
            ));
        }
        if let Some(Defects { pairs_above_tolerance: above @ 1.., between_relative: Some([i, j]), .. }) = self.defects()
        {
            let tolerance = number(self.tolerance);
            common.warn(&format!(
                "of {above} pairs of patches, such as {i} and {j}, reciprocity shows that a factor is off by more than \
                 the tolerance {tolerance}; {} (where polygons lie on each other, of which \
                 nusselt info tells, only one of them is seen, and no tolerance helps)",
                advice(self.tolerance)
            ));
        }
    }
}

/// Integrals that take many points are seldom better than this.
const REACHED: f64 = 1e-8;

/// What to do if a tolerance was not kept.
pub(super) fn advice(tolerance: f64) -> &'static str {
    if tolerance > REACHED {
        "take a smaller one to have that accuracy"
    } else {
        "below 1e-8 what is integrated is as good as its estimates say, and smaller patches help"
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nusselt::factors::{Entry, Share};
    use nusselt::scene::PolygonId;

    #[test]
    fn rows_above_the_tolerance_are_counted_and_patches_without_area_are_not_open() {
        let patch = |area| PatchInfo { name: String::new(), polygon: PolygonId(0), area, shape: None };
        let patches = [patch(1.0), patch(0.0), patch(2.0)];
        let share = |factor, error| Share { factor, error };
        let row = |patch, entries, background, closure_raw| Row {
            patch,
            entries,
            backs: Share::default(),
            background,
            closure_raw,
        };
        let mut tally = Tally::new(&patches, 0..3, 1e-3, false);
        tally.add_kept(&row(0, vec![Entry { column: 2, share: share(0.5, 1e-3) }], share(0.5, 0.0), 1.0 + 1e-4));
        tally.add(&row(1, Vec::new(), Share::default(), 0.0));
        tally.add(&row(2, vec![Entry { column: 0, share: share(0.25, 0.0) }], share(0.75, 2e-3), 1.0));
        assert_eq!((tally.kept, tally.computed, tally.factors, tally.zero_area()), (1, 2, 2, 1));
        assert_eq!((tally.rows_above, tally.largest_estimate), (1, 2e-3), "equal to the tolerance is not above it");
        assert!(tally.worst_closure == 0.0 && (tally.worst_residue - 1e-4).abs() < 1e-15);
        assert!((tally.background_mean() - 0.625).abs() < 1e-15);
        assert_eq!(tally.defects().map(|defects| (defects.largest, defects.pairs)), Some((0.0, 1)));
        assert_eq!(Tally::new(&patches, 0..3, 1e-3, true).defects(), None);
    }
}
