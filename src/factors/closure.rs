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
/// afterwards.
pub(super) fn place(row: &mut Row) -> Result<(), TooLarge> {
    // Once is enough but for rounding.
    for _ in 0..3 {
        let excess = row.sum() - 1.0;
        let room = |share: &Share| if excess > 0.0 { share.error.min(share.factor) } else { share.error };
        let shares = || row.entries.iter().map(|entry| &entry.share).chain([&row.backs, &row.background]);
        let estimates: f64 = shares().map(room).sum();
        if excess.abs() <= 2.0 * f64::EPSILON {
            return Ok(());
        }
        if excess.abs() > estimates + ROUNDING {
            return Err(TooLarge { residue: -excess, estimates });
        }
        // Of rounding, each share gets what is its part of the whole.
        let (part, of_whole) =
            if excess.abs() <= estimates { (excess / estimates, 0.0) } else { (0.0, excess / row.sum()) };
        let all = row.entries.iter_mut().map(|entry| &mut entry.share).chain([&mut row.backs, &mut row.background]);
        for share in all {
            let room = if excess > 0.0 { share.error.min(share.factor) } else { share.error };
            share.factor = (share.factor - part * room - of_whole * share.factor).max(0.0);
        }
    }
    Ok(())
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
        place(&mut lacking).expect("within the estimates");
        let factors: Vec<f64> = lacking.entries.iter().map(|entry| entry.share.factor).collect();
        assert!((lacking.sum() - 1.0).abs() < 1e-15);
        assert!((factors[0] - 0.5).abs() <= 0.0);
        assert!((factors[1] - 0.300_25).abs() < 1e-15 && (factors[2] - 0.199_75).abs() < 1e-15, "{factors:?}");
    }

    #[test]
    fn nothing_becomes_negative() {
        let mut excessive = row(&[(0.998, 0.0), (0.0005, 1e-2), (0.002, 1e-2)]);
        place(&mut excessive).expect("within the estimates");
        assert!((excessive.sum() - 1.0).abs() < 1e-15);
        assert!(excessive.entries.iter().all(|entry| entry.share.factor >= 0.0), "{excessive:?}");
    }

    #[test]
    fn what_no_estimate_explains_is_not_placed() {
        let error = place(&mut row(&[(0.5, 1e-4), (0.49, 1e-4)])).expect_err("a residue of 0.01");
        assert!((error.residue - 0.01).abs() < 1e-15 && (error.estimates - 2e-4).abs() < 1e-18);
    }
}
