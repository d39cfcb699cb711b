//! What rows of one run have in common: what two elements exchange is computed by the first of their rows, and handed over to the other one.
//!
//! Whoever computes it gets the same bits, so that nothing depends on which rows are computed together, or in which order. Rows are shared in blocks. A row
//! leaves one table when it is complete, which others read without waiting.

use super::element::Elements;
use super::row::Share;
use std::ops::Range;
use std::sync::OnceLock;

/// Patches whose rows are shared: their tables are no more than 140 MB.
pub(super) const BLOCK: usize = 4096;

/// What a complete row has found of an element.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Told {
    /// Nothing is exchanged.
    Nothing,
    /// `A_i` `F_ij`, and an estimate of its error.
    Exchange(Share),
    /// Each of their rows has to find it out.
    Unknown,
}

/// The rows of a block.
#[derive(Default)]
pub(super) struct Shared {
    first: u32,
    /// Of each element of the block, when its row is complete.
    tables: Vec<OnceLock<Table>>,
}

impl Shared {
    /// For the rows of these patches, which have one element each or nearly so: otherwise, and for single rows, nothing is shared.
    pub(super) fn of(elements: &Elements, patches: Range<usize>) -> Self {
        let count = patches.len();
        let all = || elements.of_patch[patches.clone()].iter().flatten().copied();
        let (Some(first), Some(last)) = (all().min(), all().max()) else { return Self::default() };
        let span = (last - first) as usize + 1;
        if count < 2 || span > 2 * count {
            return Self::default();
        }
        Self { first, tables: (0..span).map(|_| OnceLock::new()).collect() }
    }

    /// The elements before this one whose rows are complete, and what these have found of it. Rows are begun in their order, so that those after it hardly ever are.
    pub(super) fn told(&self, element: u32) -> impl Iterator<Item = (u32, Told)> {
        let place = self.place(element).unwrap_or(0);
        let tables = self.tables[..place].iter().zip(self.first..);
        tables.filter_map(move |(table, other)| Some((other, table.get()?.of(place))))
    }

    /// Ends a row, with what it has found of others.
    pub(super) fn complete(&self, element: u32, found: &[(u32, Told)]) {
        let Some(place) = self.place(element) else { return };
        let later = found.iter().filter_map(|&(other, told)| Some((self.place(other)?, told)));
        let table = Table::new(self.tables.len(), later.filter(|&(other, _)| other > place));
        // A row is completed once.
        let _ = self.tables[place].set(table);
    }

    fn place(&self, element: u32) -> Option<usize> {
        let place = element.checked_sub(self.first)? as usize;
        (place < self.tables.len()).then_some(place)
    }
}

/// What one row has found of others, by their places: a bit for each of which it is not nothing, and exchanges in the order of these.
struct Table {
    /// With the number of bits before each word.
    words: Vec<(u64, u32)>,
    /// Not numbers where each has to find it out.
    exchanges: Vec<Share>,
}

impl Table {
    fn new(places: usize, found: impl Iterator<Item = (usize, Told)> + Clone) -> Self {
        let found = found.filter(|&(_, told)| told != Told::Nothing);
        let mut words = vec![(0, 0); places.div_ceil(64)];
        for (place, _) in found.clone() {
            words[place / 64].0 |= 1 << (place % 64);
        }
        let mut count = 0;
        for (bits, before) in &mut words {
            *before = count;
            count += u64::count_ones(*bits);
        }
        let unknown = Share { factor: f64::NAN, error: f64::NAN };
        let mut table = Self { words, exchanges: vec![unknown; count as usize] };
        for (place, told) in found {
            if let (Some(k), Told::Exchange(share)) = (table.index(place), told) {
                table.exchanges[k] = share;
            }
        }
        table
    }

    fn index(&self, place: usize) -> Option<usize> {
        let (bits, before) = self.words[place / 64];
        let bit = 1 << (place % 64);
        (bits & bit != 0).then(|| (before + (bits & (bit - 1)).count_ones()) as usize)
    }

    fn of(&self, place: usize) -> Told {
        match self.index(place).map(|k| self.exchanges[k]) {
            None => Told::Nothing,
            Some(share) if share.factor.is_nan() => Told::Unknown,
            Some(share) => Told::Exchange(share),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn share(factor: f64) -> Share {
        Share { factor, error: 0.5 * factor }
    }

    fn block(first: u32, count: usize) -> Shared {
        Shared { first, tables: (0..count).map(|_| OnceLock::new()).collect() }
    }

    #[test]
    fn a_row_is_told_what_complete_rows_before_it_have_found() {
        let shared = block(100, 200);
        // In any order, with elements outside of the block, and of rows that have begun.
        let found = [(299, 3.0), (163, 1.0), (164, 2.0), (99, 9.0), (300, 9.0), (101, 9.0)];
        let mut found = found.map(|(element, x)| (element, Told::Exchange(share(x)))).to_vec();
        found.push((228, Told::Unknown));
        shared.complete(102, &found);
        shared.complete(105, &[(299, Told::Exchange(share(4.0)))]);
        let told = |element| shared.told(element).collect::<Vec<_>>();
        assert_eq!(told(163), [(102, Told::Exchange(share(1.0))), (105, Told::Nothing)]);
        assert_eq!(told(164), [(102, Told::Exchange(share(2.0))), (105, Told::Nothing)]);
        assert_eq!(told(228), [(102, Told::Unknown), (105, Told::Nothing)]);
        assert_eq!(told(299), [(102, Told::Exchange(share(3.0))), (105, Told::Exchange(share(4.0)))]);
        assert_eq!(told(105), [(102, Told::Nothing)]);
        // Those are before it, or not of the block.
        assert!([101, 102, 99, 300].into_iter().all(|element| told(element).is_empty()));
    }
}
