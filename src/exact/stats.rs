//! How often each stage of the predicates was reached.

use std::ops::AddAssign;

/// Calls of predicates and what decided them. Every call is decided by exactly one stage;
/// [`Kernel::depth_order`](super::Kernel::depth_order) makes up to three calls.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PredicateStats {
    /// Decided by the f64 filter.
    pub filter: u64,
    /// Known without arithmetic, before the filter or after it: a direction on a splitter that defines it,
    /// three edges along one axis.
    pub identity: u64,
    /// Decided by integers of fixed width, or by expansions.
    pub fixed: u64,
    /// Decided by integers of arbitrary width.
    pub arbitrary: u64,
}

impl PredicateStats {
    /// All calls.
    pub fn calls(&self) -> u64 {
        self.filter + self.undecided()
    }

    /// The calls that the filter did not decide.
    pub fn undecided(&self) -> u64 {
        self.identity + self.fixed + self.arbitrary
    }
}

impl AddAssign for PredicateStats {
    fn add_assign(&mut self, other: Self) {
        self.filter += other.filter;
        self.identity += other.identity;
        self.fixed += other.fixed;
        self.arbitrary += other.arbitrary;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn calls_are_the_sum_of_all_stages() {
        let mut stats = PredicateStats { filter: 1, identity: 20, fixed: 300, arbitrary: 4000 };
        assert_eq!((stats.calls(), stats.undecided()), (4321, 4320));
        stats += PredicateStats { filter: 5, identity: 60, fixed: 500, arbitrary: 2000 };
        assert_eq!(stats, PredicateStats { filter: 6, identity: 80, fixed: 800, arbitrary: 6000 });
    }
}
