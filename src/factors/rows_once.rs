//! Rows that are asked for one by one, in any order, and still tell each other what they exchange.

use super::element_row::RowSpace;
use super::shared::{self, Shared};
use super::{Exchange, ExchangeError, Row};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

/// Computes rows as [`Exchange::row`] does, to the same bits, in about half the time if most are asked for: what two patches exchange is computed for the
/// first of their rows. Up to 100 MB wait to be asked for.
pub struct RowsOnce<'a> {
    exchange: &'a Exchange,
    shared: Shared,
    /// True for rows that were asked for: what others told them is used up.
    is_begun: Vec<AtomicBool>,
    spaces: Mutex<Vec<RowSpace>>,
}

impl<'a> RowsOnce<'a> {
    /// Of the rows of an exchange; the first 4,096 tell each other.
    pub fn new(exchange: &'a Exchange) -> Self {
        let count = exchange.patches().len();
        let shared = Shared::of(&exchange.elements, 0..count.min(shared::BLOCK));
        let is_begun = (0..count).map(|_| AtomicBool::new(false)).collect();
        Self { exchange, shared, is_begun, spaces: Mutex::default() }
    }

    /// One row. It may be asked for again, and is computed anew then.
    ///
    /// # Errors
    /// As [`Exchange::row`].
    pub fn row(&self, patch: usize) -> Result<Row, ExchangeError> {
        let is_again = self.is_begun.get(patch).is_none_or(|is_begun| is_begun.swap(true, Ordering::Relaxed));
        if is_again {
            return self.exchange.row(patch);
        }
        let free = || self.spaces.lock().unwrap_or_else(PoisonError::into_inner);
        let space = free().pop();
        let mut space = space.unwrap_or_else(|| RowSpace::new(&self.exchange.elements));
        let row = self.exchange.row_in(patch, &self.shared, &mut space);
        free().push(space);
        row
    }
}
