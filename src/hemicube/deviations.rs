//! How far approximate form factors are from exact ones.

use std::collections::BTreeMap;

/// Relative errors of form factors, collected over views.
///
/// They are counted by size to one part in 4096, so that memory does not grow with the number of views: a few megabytes at most.
#[derive(Clone, Debug)]
pub struct Deviations {
    least: f64,
    /// How many errors there are of each size, rounded up: its first bits.
    sizes: BTreeMap<u64, usize>,
    worst: f64,
    count: usize,
    visible: usize,
    lost: usize,
}

/// Of the 52 bits of a fraction, so many are left out.
const DROPPED: u32 = 40;

impl Deviations {
    /// Of the polygons whose exact form factor is more than `least`, a number not below 0.
    pub fn above(least: f64) -> Self {
        Self { least, sizes: BTreeMap::new(), worst: 0.0, count: 0, visible: 0, lost: 0 }
    }

    /// Adds a view: the approximate and exact form factors of every polygon in the same order.
    pub fn add(&mut self, approximate: impl IntoIterator<Item = f64>, exact: impl IntoIterator<Item = f64>) {
        for (approximate, exact) in approximate.into_iter().zip(exact) {
            self.visible += usize::from(exact > 0.0);
            self.lost += usize::from(exact > 0.0 && approximate <= 0.0);
            if exact > self.least {
                let error = (approximate - exact).abs() / exact;
                // The bits of numbers not below 0 are in their order.
                *self.sizes.entry(error.to_bits().div_ceil(1 << DROPPED)).or_default() += 1;
                self.worst = self.worst.max(error);
                self.count += 1;
            }
        }
    }

    /// The relative error that a share of the form factors, 0 to 1, does not exceed: the smallest of those collected that serves,
    /// rounded up by less than one part in 4096, but not above the worst, which is not rounded. `None` if no form factor was large enough to be
    /// collected. 0.5 is the median, 1 the worst.
    pub fn quantile(&self, share: f64) -> Option<f64> {
        if self.count == 0 {
            return None;
        }
        let rank = (share * self.count as f64).ceil() as usize;
        let mut below = 0;
        for (&size, count) in &self.sizes {
            below += count;
            if below >= rank {
                return Some(f64::from_bits(size << DROPPED).min(self.worst));
            }
        }
        Some(self.worst)
    }

    /// How many form factors were compared.
    pub fn count(&self) -> usize {
        self.count
    }

    /// How many form factors were above 0, summed over the views.
    pub fn visible(&self) -> usize {
        self.visible
    }

    /// How many of those, however small, are 0 in the approximation.
    pub fn lost(&self) -> usize {
        self.lost
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_those_of_relative_errors_above_the_threshold() {
        let mut deviations = Deviations::above(0.1);
        assert_eq!(deviations.quantile(1.0), None);
        deviations.add([0.0, 0.0], [0.1, 0.0]);
        assert_eq!((deviations.quantile(0.5), deviations.lost()), (None, 1), "lost, but too small to be collected");
        deviations.add([0.25, 0.5, 0.0, 0.0, 7.0], [0.5, 0.5, 0.05, 0.0, 1.0]);
        deviations.add([0.0], [0.2]);
        assert_eq!((deviations.count(), deviations.visible(), deviations.lost()), (4, 6, 3));
        for (share, expected) in [(0.0, 0.0), (0.25, 0.0), (0.5, 0.5), (0.75, 1.0), (1.0, 6.0)] {
            assert!((deviations.quantile(share).expect("some") - expected).abs() < 1e-15, "{share}");
        }
    }

    #[test]
    fn any_number_of_errors_takes_little_memory_and_is_told_to_one_part_in_4096() {
        let mut deviations = Deviations::above(0.5);
        let error = |k: u32| f64::from(k) * 1e-6;
        deviations.add((0..=100_000).map(|k| 1.0 + error(k)), std::iter::repeat(1.0));
        for (share, exact) in [(0.1, 0.01), (0.5, 0.05), (0.99, 0.099)] {
            let told = deviations.quantile(share).expect("many");
            assert!(told > exact * (1.0 - 1e-9) && told < exact * (1.0 + 1.0 / 4096.0) + 1e-6, "{share}: {told}");
        }
        // As it was added: 1.1 - 1.
        assert!((deviations.quantile(1.0).expect("many") - 0.1).abs() < 1e-15);
        assert!(deviations.sizes.len() < 100_000 / 2, "{}", deviations.sizes.len());
    }
}
