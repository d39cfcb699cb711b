//! How far approximate form factors are from exact ones.

/// Relative errors of form factors, collected over views.
#[derive(Clone, Debug)]
pub struct Deviations {
    least: f64,
    relative: Vec<f64>,
    visible: usize,
    lost: usize,
}

impl Deviations {
    /// Of the polygons whose exact form factor is more than `least`, a number not below 0.
    pub fn above(least: f64) -> Self {
        Self { least, relative: Vec::new(), visible: 0, lost: 0 }
    }

    /// Adds a view: the approximate and exact form factors of every polygon in the same order.
    pub fn add(&mut self, approximate: impl IntoIterator<Item = f64>, exact: impl IntoIterator<Item = f64>) {
        for (approximate, exact) in approximate.into_iter().zip(exact) {
            self.visible += usize::from(exact > 0.0);
            self.lost += usize::from(exact > 0.0 && approximate == 0.0);
            if exact > self.least {
                self.relative.push((approximate - exact).abs() / exact);
            }
        }
    }

    /// The relative error that a share of the form factors, 0 to 1, does not exceed: the smallest of those collected that serves. 0 if there
    /// are none. 0.5 is the median, 1 the worst. O(n log n).
    pub fn quantile(&self, share: f64) -> f64 {
        let mut sorted = self.relative.clone();
        sorted.sort_unstable_by(f64::total_cmp);
        let rank = (share * sorted.len() as f64).ceil() as usize;
        sorted.get(rank.saturating_sub(1).min(sorted.len().saturating_sub(1))).copied().unwrap_or(0.0)
    }

    /// How many form factors were compared.
    pub fn count(&self) -> usize {
        self.relative.len()
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
        assert!(deviations.quantile(1.0) == 0.0);
        deviations.add([0.25, 0.5, 0.0, 0.0, 7.0], [0.5, 0.5, 0.05, 0.0, 1.0]);
        deviations.add([0.0], [0.2]);
        assert_eq!((deviations.count(), deviations.visible(), deviations.lost()), (4, 5, 2));
        for (share, expected) in [(0.0, 0.0), (0.25, 0.0), (0.5, 0.5), (0.75, 1.0), (1.0, 6.0)] {
            assert!((deviations.quantile(share) - expected).abs() < 1e-15, "{share}");
        }
    }
}
