//! What a row lacks or has too much of, placed where it may have been lost.

use super::row::{Row, Share};

/// Rounding: entries, backs and background of a row are sums of thousands of numbers.
const ROUNDING: f64 = 1e-13;

/// The sum of the estimates is smaller than what is to be placed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct TooLarge {
    pub(super) residue: f64,
    pub(super) estimates: f64,
}

/// Places the residue of a row on its shares in proportion to their estimates, none by more than that and none below zero: the row's sum is 1
/// afterwards. A residue of at most `allowed` that is larger than the estimates shows that they are too small, and raises them.
pub(super) fn place(row: &mut Row, allowed: f64) -> Result<(), TooLarge> {
    // Once is enough but for rounding.
    for _ in 0..3 {
        let excess = row.sum() - 1.0;
        if excess.abs() <= 2.0 * f64::EPSILON {
            return Ok(());
        }
        let estimates: f64 = shares(row).map(|share| room(share, excess)).sum();
        let unexplained = excess.abs() - estimates;
        if unexplained > ROUNDING && excess.abs() <= allowed {
            raise(row, unexplained + ROUNDING, excess);
        }
        let estimates: f64 = shares(row).map(|share| room(share, excess)).sum();
        if excess.abs() > estimates + ROUNDING {
            return Err(TooLarge { residue: -excess, estimates });
        }
        // Of rounding, each share gets what is its part of the whole.
        let (part, of_whole) =
            if excess.abs() <= estimates { (excess / estimates, 0.0) } else { (0.0, excess / row.sum()) };
        for share in shares_mut(row) {
            share.factor = (share.factor - part * room(share, excess) - of_whole * share.factor).max(0.0);
        }
    }
    Ok(())
}

/// Raises the estimates of a row by so much in all: as the factors are or, where there is too much, as far as these are above their estimates.
fn raise(row: &mut Row, by: f64, excess: f64) {
    let weight = |share: &Share| if excess > 0.0 { (share.factor - share.error).max(0.0) } else { share.factor };
    let whole: f64 = shares(row).map(weight).sum();
    if whole > 0.0 {
        shares_mut(row).for_each(|share| share.error += by / whole * weight(share));
    }
}

/// What may be placed on a share.
fn room(share: &Share, excess: f64) -> f64 {
    if excess > 0.0 { share.error.min(share.factor) } else { share.error }
}

fn shares(row: &Row) -> impl Iterator<Item = &Share> {
    row.entries.iter().map(|entry| &entry.share).chain([&row.backs, &row.background])
}

fn shares_mut(row: &mut Row) -> impl Iterator<Item = &mut Share> {
    row.entries.iter_mut().map(|entry| &mut entry.share).chain([&mut row.backs, &mut row.background])
}

#[cfg(test)]
mod tests {
    use super::super::row::Entry;
    use super::*;

    fn row(shares: &[(f64, f64)]) -> Row {
        let entry =
            |(k, &(factor, error)): (usize, &(f64, f64))| Entry { column: k as u32, share: Share { factor, error } };
        let entries = shares.iter().enumerate().map(entry).collect();
        Row { patch: 0, entries, backs: Share::default(), background: Share::default(), closure_raw: 0.0 }
    }

    #[test]
    fn a_residue_goes_where_the_estimates_are() {
        let mut lacking = row(&[(0.5, 0.0), (0.3, 1e-3), (0.199, 3e-3)]);
        place(&mut lacking, 0.0).expect("within the estimates");
        let factors: Vec<f64> = lacking.entries.iter().map(|entry| entry.share.factor).collect();
        assert!((lacking.sum() - 1.0).abs() < 1e-15);
        assert!((factors[0] - 0.5).abs() <= 0.0);
        assert!((factors[1] - 0.300_25).abs() < 1e-15 && (factors[2] - 0.199_75).abs() < 1e-15, "{factors:?}");
    }

    #[test]
    fn nothing_becomes_negative() {
        let mut excessive = row(&[(0.998, 0.0), (0.0005, 1e-2), (0.002, 1e-2)]);
        place(&mut excessive, 0.0).expect("within the estimates");
        assert!((excessive.sum() - 1.0).abs() < 1e-15);
        assert!(excessive.entries.iter().all(|entry| entry.share.factor >= 0.0), "{excessive:?}");
    }

    #[test]
    fn what_no_estimate_explains_is_not_placed() {
        let error = place(&mut row(&[(0.5, 1e-4), (0.49, 1e-4)]), 9e-3).expect_err("a residue of 0.01");
        assert!((error.residue - 0.01).abs() < 1e-15 && (error.estimates - 2e-4).abs() < 1e-18);
    }

    #[test]
    fn a_small_residue_raises_the_estimates() {
        // Too little and too much, and nothing else to go by.
        for shares in [
            [(0.5, 1e-4), (0.49, 1e-4), (0.0, 0.0)],
            [(0.6, 1e-4), (0.409, 0.0), (0.001, 5e-3)],
            [(0.55, 0.0), (0.44, 0.0), (0.0, 0.0)],
        ] {
            let mut off = row(&shares);
            place(&mut off, 0.011).expect("a residue of 0.01");
            assert!((off.sum() - 1.0).abs() < 1e-15, "{off:?}");
            for (entry, (factor, error)) in off.entries.iter().zip(shares) {
                let Share { factor: placed, error: raised } = entry.share;
                assert!(placed >= 0.0 && (placed - factor).abs() <= raised && raised >= error, "{off:?}");
            }
            let all: f64 = off.entries.iter().map(|entry| entry.share.error).sum();
            assert!(all < 0.01 + 5e-3 + 1e-12, "by no more than it takes: {off:?}");
        }
    }
}
