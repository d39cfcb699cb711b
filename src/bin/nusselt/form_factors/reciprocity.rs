//! How well `A_i F_ij = A_j F_ji` holds, as rows come.

use nusselt::factors::{PatchInfo, Row};
use serde::Serialize;
use std::ops::Range;

/// So many exchanges wait for their counterparts at most: 256 MB, and up to as much again that lists have in reserve. With more, only every second, fourth, ... pair is compared.
const MOST_WAITING: usize = 1 << 24;

/// What comes first of a pair.
#[derive(Clone, Copy)]
struct Exchanged {
    /// The row i.
    row: u32,
    /// `A_i F_ij`.
    value: f64,
}

/// Compares the two exchanges of pairs of patches whose rows both come.
pub(super) struct Reciprocity<'p> {
    patches: &'p [PatchInfo],
    rows: Range<u32>,
    /// For each column j that is still to come as a row.
    waiting: Vec<Vec<Exchanged>>,
    count: usize,
    most: usize,
    tolerance: f64,
    found: Defects,
}

/// What was found.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(super) struct Defects {
    /// The largest of |`A_i F_ij - A_j F_ji`|, in square scene units.
    pub(super) largest: f64,
    /// Between these patches.
    pub(super) between: Option<[u32; 2]>,
    /// The largest of the same over `A_i + A_j`: not above the tolerance if both factors are within it.
    pub(super) largest_relative: f64,
    /// Between these patches.
    pub(super) between_relative: Option<[u32; 2]>,
    /// Pairs of which this is above the tolerance.
    pub(super) pairs_above_tolerance: u64,
    /// So many pairs of which one sees the other were compared.
    pub(super) pairs: u64,
    /// At last only pairs were compared whose numbers have a sum that this divides: 1 is all of them.
    pub(super) every: u32,
}

impl<'p> Reciprocity<'p> {
    /// Of these rows of a matrix, which come in their order.
    pub(super) fn new(patches: &'p [PatchInfo], rows: Range<u32>, tolerance: f64) -> Self {
        let waiting = vec![Vec::new(); rows.len()];
        let found = Defects {
            largest: 0.0,
            between: None,
            largest_relative: 0.0,
            between_relative: None,
            pairs_above_tolerance: 0,
            pairs: 0,
            every: 1,
        };
        Self { patches, rows, waiting, count: 0, most: MOST_WAITING, tolerance, found }
    }

    pub(super) fn add(&mut self, row: &Row) {
        let area = self.area(row.patch);
        let (first, j) = (self.rows.start, row.patch);
        let waiting = std::mem::take(&mut self.waiting[(j - first) as usize]);
        self.count -= waiting.len();
        let mut waiting = waiting.into_iter().peekable();
        for entry in &row.entries {
            let i = entry.column;
            let value = area * entry.share.factor;
            if !self.rows.contains(&i) || i == j || !self.is_compared(i, j) {
                continue;
            }
            if i > j {
                self.waiting[(i - first) as usize].push(Exchanged { row: j, value });
                self.count += 1;
                continue;
            }
            while let Some(one_way) = waiting.next_if(|other| other.row < i) {
                self.compare([one_way.row, j], one_way.value, 0.0);
            }
            let other = waiting.next_if(|other| other.row == i).map_or(0.0, |other| other.value);
            self.compare([i, j], other, value);
        }
        for one_way in waiting {
            self.compare([one_way.row, j], one_way.value, 0.0);
        }
        while self.count > self.most {
            self.thin_out();
        }
    }

    pub(super) fn defects(&self) -> Defects {
        self.found
    }

    fn area(&self, patch: u32) -> f64 {
        self.patches[patch as usize].area
    }

    fn is_compared(&self, i: u32, j: u32) -> bool {
        i.wrapping_add(j).is_multiple_of(self.found.every)
    }

    fn compare(&mut self, pair: [u32; 2], one: f64, other: f64) {
        let defect = (one - other).abs();
        let relative = defect / (self.area(pair[0]) + self.area(pair[1]));
        let found = &mut self.found;
        found.pairs += 1;
        if defect > found.largest {
            (found.largest, found.between) = (defect, Some(pair));
        }
        // Areas that overflow say nothing.
        if relative.is_finite() && relative > found.largest_relative {
            (found.largest_relative, found.between_relative) = (relative, Some(pair));
        }
        found.pairs_above_tolerance += u64::from(relative > self.tolerance);
    }

    /// Halves what waits.
    fn thin_out(&mut self) {
        // Powers of two, so that a sum that wraps is divided alike.
        self.found.every *= 2;
        let (every, first) = (self.found.every, self.rows.start);
        self.count = 0;
        for (waiting, column) in self.waiting.iter_mut().zip(first..) {
            waiting.retain(|one_way| one_way.row.wrapping_add(column).is_multiple_of(every));
            waiting.shrink_to_fit();
            self.count += waiting.len();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nusselt::factors::{Entry, Share};
    use nusselt::scene::PolygonId;

    const COUNT: u32 = 20;

    fn patches() -> Vec<PatchInfo> {
        let patch = |k| PatchInfo { name: String::new(), polygon: PolygonId(k), area: f64::from(k + 1), shape: None };
        (0..COUNT).map(patch).collect()
    }

    /// Symmetric exchanges, but for one pair in one of its directions.
    fn row(patch: u32, wrong: [u32; 2], by: f64) -> Row {
        let entry = |column: u32| {
            let off = if [patch, column] == wrong { by } else { 0.0 };
            let factor = (1.0 / f64::from(patch + column + 1) + off) / f64::from(patch + 1);
            Entry { column, share: Share { factor, error: 0.0 } }
        };
        let entries = (0..COUNT).filter(|&column| column != patch).map(entry);
        let entries = entries.filter(|entry| entry.share.factor > 0.0).collect();
        Row { patch, entries, backs: Share::default(), background: Share::default(), closure_raw: 1.0 }
    }

    fn found(rows: Range<u32>, wrong: [u32; 2], by: f64, most: usize) -> Defects {
        let patches = patches();
        let mut reciprocity = Reciprocity::new(&patches, rows.clone(), 1e-3);
        reciprocity.most = most;
        rows.for_each(|patch| reciprocity.add(&row(patch, wrong, by)));
        assert!(reciprocity.count == 0 && reciprocity.waiting.iter().all(Vec::is_empty));
        reciprocity.defects()
    }

    #[test]
    fn a_defect_is_found_in_either_direction() {
        for wrong in [[3, 7], [7, 3], [0, 19], [19, 18]] {
            let mut pair = wrong;
            pair.sort_unstable();
            let defects = found(0..COUNT, wrong, 0.25, usize::MAX);
            assert!((defects.largest - 0.25).abs() < 1e-15 && defects.between == Some(pair), "{defects:?}");
            let areas = f64::from(wrong[0] + wrong[1] + 2);
            assert!((defects.largest_relative - 0.25 / areas).abs() < 1e-15);
            assert_eq!((defects.pairs, defects.every), (190, 1));
            assert_eq!((defects.pairs_above_tolerance, defects.between_relative), (1, Some(pair)));
        }
    }

    #[test]
    fn an_entry_that_is_missing_is_zero() {
        // The last column, the first one, and one between.
        for wrong in [[3, 19], [19, 3], [5, 0], [9, 8]] {
            let value = 1.0 / f64::from(wrong[0] + wrong[1] + 1);
            let defects = found(0..COUNT, wrong, -value, usize::MAX);
            assert!((defects.largest - value).abs() < 1e-15, "{wrong:?}: {defects:?}");
            assert_eq!(defects.pairs, 190);
        }
    }

    #[test]
    fn rows_that_do_not_come_are_not_waited_for() {
        let defects = found(5..9, [6, 4], 1.0, usize::MAX);
        assert!(defects.pairs == 6 && defects.largest < 1e-15, "{defects:?}");
        assert_eq!(defects.pairs_above_tolerance, 0);
        assert!((found(5..9, [8, 5], 1.0, usize::MAX).largest - 1.0).abs() < 1e-15);
    }

    #[test]
    fn with_too_many_that_wait_some_pairs_are_left_out() {
        let defects = found(0..COUNT, [0, 16], 1.0, 12);
        assert!(defects.every == 8 && defects.pairs < 190 / 4, "{defects:?}");
        assert!((defects.largest - 1.0).abs() < 1e-15, "a pair that is compared: {defects:?}");
        assert!(found(0..COUNT, [19, 18], 1.0, 12).largest < 1e-15, "a pair that is not");
    }
}
