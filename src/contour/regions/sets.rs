//! Disjoint sets of numbers.

/// Disjoint sets of the numbers below a count, each known by its lowest number.
pub(crate) struct Sets {
    above: Vec<u32>,
}

impl Sets {
    /// Every number by itself.
    pub(crate) fn new(count: usize) -> Self {
        Self { above: (0..count as u32).collect() }
    }

    /// The lowest number of a set.
    pub(crate) fn find(&mut self, mut k: u32) -> u32 {
        while self.above[k as usize] != k {
            let above = self.above[self.above[k as usize] as usize];
            self.above[k as usize] = above;
            k = above;
        }
        k
    }

    pub(crate) fn unite(&mut self, a: u32, b: u32) {
        let (a, b) = (self.find(a), self.find(b));
        self.above[a.max(b) as usize] = a.min(b);
    }
}
