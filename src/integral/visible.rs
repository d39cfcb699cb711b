//! Which polygons are seen, in order of their numbers, without sorting them.

use crate::scene::PolygonId;

/// A set of polygons.
#[derive(Debug)]
pub(super) struct Visible {
    /// A bit for each polygon.
    bits: Vec<u64>,
    /// How many bits are set in the words before each one.
    before: Vec<u32>,
}

impl Visible {
    /// None of so many polygons.
    pub(super) fn none(polygons: usize) -> Self {
        Self { bits: vec![0; polygons.div_ceil(64)], before: Vec::new() }
    }

    pub(super) fn insert(&mut self, polygon: PolygonId) {
        self.bits[polygon.index() / 64] |= 1 << (polygon.index() % 64);
    }

    /// Counts them.
    pub(super) fn count(&mut self) -> usize {
        let mut count = 0;
        self.before.clear();
        self.before.extend(self.bits.iter().map(|word| {
            count += word.count_ones();
            count - word.count_ones()
        }));
        count as usize
    }

    /// All of them in order.
    pub(super) fn iter(&self) -> impl Iterator<Item = PolygonId> {
        self.bits.iter().enumerate().flat_map(|(k, &word)| {
            let mut left = word;
            std::iter::from_fn(move || {
                let bit = left.trailing_zeros();
                // The lowest one is taken away.
                left &= left.checked_sub(1)?;
                Some(PolygonId(k as u32 * 64 + bit))
            })
        })
    }

    /// How many of them come before one of them, as of when they were counted.
    pub(super) fn place(&self, polygon: PolygonId) -> usize {
        let (word, bit) = (polygon.index() / 64, polygon.index() % 64);
        let below = self.bits[word] & ((1 << bit) - 1);
        self.before[word] as usize + below.count_ones() as usize
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::collections::BTreeSet;

    proptest! {
        #[test]
        fn polygons_are_found_at_their_places(numbers in prop::collection::vec(0u32..300, 0..100)) {
            let expected: BTreeSet<u32> = numbers.iter().copied().collect();
            let mut visible = Visible::none(300);
            for k in numbers {
                visible.insert(PolygonId(k));
            }
            prop_assert_eq!(visible.count(), expected.len());
            let found: Vec<PolygonId> = visible.iter().collect();
            prop_assert!(found.iter().map(|p| p.0).eq(expected));
            prop_assert!(found.iter().enumerate().all(|(k, &polygon)| visible.place(polygon) == k));
        }
    }
}
