//! Rows that are asked for one by one, in any order, and still tell each other what they exchange.

use super::row_space::RowSpace;
use super::shared::{self, Shared};
use super::{Exchange, ExchangeError, Row};
use std::sync::{Mutex, PoisonError};

/// Computes rows as [`Exchange::row`] does, to the same bits, in less time if many are asked for: what two patches exchange is taken from the row of the first of them if that
/// was asked for before. It is about half of the time if all are, in their order.
pub struct RowsOnce<'a> {
    exchange: &'a Exchange,
    shared: Shared,
    spaces: Mutex<Vec<RowSpace>>,
}

impl<'a> RowsOnce<'a> {
    /// Of the rows of an exchange; the first 4,096 tell each other.
    pub fn new(exchange: &'a Exchange) -> Self {
        let count = exchange.patches().len();
        let shared = Shared::of(&exchange.elements, 0..count.min(shared::BLOCK));
        Self { exchange, shared, spaces: Mutex::default() }
    }

    /// One row. It may be asked for again, and is computed anew then.
    ///
    /// # Errors
    /// As [`Exchange::row`].
    pub fn row(&self, patch: usize) -> Result<Row, ExchangeError> {
        if patch >= self.exchange.patches().len() {
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
