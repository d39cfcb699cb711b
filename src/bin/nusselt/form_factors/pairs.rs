//! A sample of pairs of patches, computed once more in another way: both rows of a pair have one number, so that they agree whatever that is.

use super::certify::evenly;
use crate::summary::short;
use nusselt::factors::{Exchange, ExchangeError, PatchInfo, Row};
use rayon::iter::{IntoParallelIterator, ParallelIterator};
use serde::Serialize;
use std::ops::Range;

/// One of the pairs of a row.
#[derive(Clone, Copy)]
struct Pair {
    from: u32,
    to: u32,
    factor: f64,
}

/// Pairs of some rows, as these come.
pub(super) struct PairSample {
    /// Ascending.
    rows: Vec<u32>,
    pairs: Vec<Pair>,
}

/// How well they agree with what their other patch finds.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(super) struct PairCheck {
    /// Pairs that were computed once more.
    pub(super) checked: usize,
    /// Pairs for which there are only views.
    not_checked: usize,
    /// The largest |`A_i F_ij - A_j F_ji`| over `A_i + A_j`: not above the tolerance if both factors are within it.
    largest_relative: f64,
    /// Between these patches.
    between: Option<[u32; 2]>,
    /// Pairs of which this is above the tolerance.
    pub(super) pairs_above_tolerance: usize,
}

impl PairSample {
    /// Of some of these rows.
    pub(super) fn new(patches: &[PatchInfo], rows: Range<u32>) -> Self {
        let with_area: Vec<u32> = rows.filter(|&row| patches[row as usize].area > 0.0).collect();
        Self { rows: evenly(&with_area), pairs: Vec::new() }
    }

    pub(super) fn add(&mut self, row: &Row) {
        if self.rows.binary_search(&row.patch).is_err() {
            return;
        }
        let from = row.patch;
        let others = row.entries.iter().filter(|entry| entry.column != from);
        let pairs: Vec<Pair> =
            others.map(|entry| Pair { from, to: entry.column, factor: entry.share.factor }).collect();
        self.pairs.extend(evenly(&pairs));
    }

    /// Computes them by points on the patch that the row is not of, in all threads.
    pub(super) fn check(&self, exchange: &Exchange, tolerance: f64) -> Result<PairCheck, ExchangeError> {
        let patches = exchange.patches();
        let defect = |&Pair { from, to, factor }: &Pair| {
            let back = exchange.by_points(to as usize, from as usize)?;
            let [own, its] = [from, to].map(|patch| patches[patch as usize].area);
            Ok(back.map(|back| (own * factor - its * back.factor).abs() / (own + its)))
        };
        let defects = self.pairs.iter().collect::<Vec<_>>().into_par_iter().map(defect);
        let defects = defects.collect::<Result<Vec<Option<f64>>, ExchangeError>>()?;
        let mut check =
            PairCheck { checked: 0, not_checked: 0, largest_relative: 0.0, between: None, pairs_above_tolerance: 0 };
        for (pair, defect) in self.pairs.iter().zip(defects) {
            // Areas that overflow say nothing.
            let Some(defect) = defect.filter(|defect| defect.is_finite()) else {
                check.not_checked += 1;
                continue;
            };
            check.checked += 1;
            if defect > check.largest_relative {
                (check.largest_relative, check.between) = (defect, Some([pair.from, pair.to]));
            }
            check.pairs_above_tolerance += usize::from(defect > tolerance);
        }
        Ok(check)
    }
}

impl PairCheck {
    pub(super) fn in_words(&self) -> String {
        let Self { checked, not_checked, largest_relative, between, .. } = *self;
        let between = between.map_or_else(String::new, |[i, j]| format!(" (patches {i} and {j})"));
        let rest = if not_checked > 0 { format!("; {not_checked} more take views") } else { String::new() };
        let largest = short(largest_relative);
        format!("{checked} once more from their other patch, within {largest} of A_i + A_j{between}{rest}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nusselt::factors::{Entry, ExchangeOptions, PatchPlan};
    use nusselt::samples::{Kind, generate};

    #[test]
    fn what_is_wrong_is_found_from_the_other_patch() {
        let scene = generate(Kind::Room, 200, 1).expect("a room").to_builder().build().expect("a room");
        let exchange = Exchange::new(&scene, PatchPlan::Polygons, ExchangeOptions::default()).expect("patches");
        let patches = exchange.patches();
        let rows: Vec<Row> = (0..patches.len()).map(|row| exchange.row(row).expect("a row")).collect();
        let check = |rows: &[Row]| {
            let mut sample = PairSample::new(patches, 0..patches.len() as u32);
            for row in rows {
                sample.add(row);
            }
            sample.check(&exchange, 1e-4).expect("pairs")
        };
        let right = check(&rows);
        assert!(right.checked > 100 && right.pairs_above_tolerance == 0, "{right:?}");
        assert!(right.largest_relative > 0.0, "other numbers: {right:?}");
        // The first entry of the first row is in the sample.
        let mut wrong = rows;
        let Entry { column, share } = &mut wrong[0].entries[0];
        share.factor += 2e-4 * (1.0 + patches[*column as usize].area / patches[0].area);
        let between = Some([0, *column]);
        let found = check(&wrong);
        assert_eq!((found.pairs_above_tolerance, found.between), (1, between), "{found:?}");
        assert!((found.largest_relative - 2e-4).abs() <= right.largest_relative, "{found:?}");
    }
}
