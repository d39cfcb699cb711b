//! What rows of one run have in common: what two elements exchange is computed by the first of their rows, and handed over to the other one.
//!
//! Whoever computes it gets the same bits, so that nothing depends on which rows are computed together, or in which order. Rows are shared in blocks:
//! what waits is a quarter of the square of a block at most.

use super::element::Elements;
use super::row::Share;
use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

/// Patches whose rows are shared: no more than 100 MB wait.
pub(super) const BLOCK: usize = 4096;

/// What an element's row is told of another element, whose row is complete.
#[derive(Clone, Copy, Debug)]
pub(super) struct Told {
    pub(super) element: u32,
    /// `A_i` `F_ij`, and an estimate of its error; not a number if each row has to find it out.
    exchange: Share,
}

impl Told {
    pub(super) fn of(element: u32, exchange: Option<Share>) -> Self {
        let unknown = Share { factor: f64::NAN, error: f64::NAN };
        Self { element, exchange: exchange.unwrap_or(unknown) }
    }

    pub(super) fn exchange(&self) -> Option<Share> {
        (!self.exchange.factor.is_nan()).then_some(self.exchange)
    }
}

/// The rows of a block.
#[derive(Default)]
pub(super) struct Shared {
    first: u32,
    /// What waits for each row; none once it has begun.
    waiting: Vec<Mutex<Option<Vec<Told>>>>,
    /// True for rows that have told all others.
    is_complete: Vec<AtomicBool>,
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
        let waiting = (0..span).map(|_| Mutex::new(Some(Vec::new()))).collect();
        Self { first, waiting, is_complete: (0..span).map(|_| AtomicBool::new(false)).collect() }
    }

    /// Begins a row: those that are complete, and what they have told it. What they have not told of is nothing.
    pub(super) fn begin(&self, element: u32, complete: &mut Vec<u32>) -> Vec<Told> {
        complete.clear();
        let Some(place) = self.place(element) else { return Vec::new() };
        let all = self.is_complete.iter().zip(self.first..);
        complete.extend(all.filter(|(is_complete, _)| is_complete.load(Ordering::Acquire)).map(|(_, number)| number));
        let mut told = self.waiting[place].lock().unwrap_or_else(PoisonError::into_inner).take().unwrap_or_default();
        // Some may be of rows that have not told all yet.
        told.retain(|told| complete.binary_search(&told.element).is_ok());
        told
    }

    /// Ends a row: tells others that have not begun.
    pub(super) fn complete(&self, element: u32, told: &[Told]) {
        let Some(place) = self.place(element) else { return };
        for &Told { element: other, exchange } in told {
            let Some(other) = self.place(other) else { continue };
            if let Some(waiting) = self.waiting[other].lock().unwrap_or_else(PoisonError::into_inner).as_mut() {
                waiting.push(Told { element, exchange });
            }
        }
        self.is_complete[place].store(true, Ordering::Release);
    }

    fn place(&self, element: u32) -> Option<usize> {
        let place = element.checked_sub(self.first)? as usize;
        (place < self.waiting.len()).then_some(place)
    }
}
