//! Work in several threads, with results that do not depend on how many there are.

use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// The results of `f` for all items, in the order of the items. With the feature `parallel` the threads of the current `rayon` pool share
/// the work item by item: each is work enough for that, and some take much longer than others.
pub(crate) fn map<T: Send, R: Send>(items: Vec<T>, f: impl Fn(T) -> R + Sync + Send) -> Vec<R> {
    #[cfg(feature = "parallel")]
    {
        use rayon::iter::{IndexedParallelIterator, IntoParallelIterator, ParallelIterator};
        items.into_par_iter().with_max_len(1).map(f).collect()
    }
    #[cfg(not(feature = "parallel"))]
    items.into_iter().map(f).collect()
}

/// So many results of [`in_order`] are in memory at most.
const MOST_WAITING: usize = 256;

/// Hands the results of `f` over to `take`, in the order of the items, each as soon as all before it are there. Items are begun in their order. With the
/// feature `parallel` the threads of the current `rayon` pool share the work; one of them takes results while the others go on.
///
/// # Errors
/// The first result that is an error, after all before it have been taken, or the first error of `take`.
pub(crate) fn in_order<R: Send, E: Send>(
    items: Range<usize>,
    f: impl Fn(usize) -> Result<R, E> + Sync + Send,
    mut take: impl FnMut(R) -> Result<(), E> + Send,
) -> Result<(), E> {
    let mut start = items.start;
    while start < items.end {
        let lot = start..items.end.min(start + MOST_WAITING);
        let next = AtomicUsize::new(start);
        let results = InOrder::new(start, &mut take);
        // All threads begin the next item there is, whichever they are given.
        map(lot.clone().collect(), |_| {
            if !results.is_over() {
                let item = next.fetch_add(1, Ordering::Relaxed);
                results.put(item, f(item));
            }
        });
        results.end()?;
        start = lot.end;
    }
    Ok(())
}

/// Results that come in any order, on their way to where they are taken in theirs.
struct InOrder<T, R, E> {
    waiting: Mutex<Waiting<R, E>>,
    /// Held by one thread at a time, as `is_taken` tells.
    take: Mutex<T>,
}

struct Waiting<R, E> {
    results: BTreeMap<usize, Result<R, E>>,
    /// The item whose result is taken next.
    next: usize,
    is_taken: bool,
    failure: Option<E>,
}

impl<R, E, T: FnMut(R) -> Result<(), E>> InOrder<T, R, E> {
    fn new(next: usize, take: T) -> Self {
        let waiting = Waiting { results: BTreeMap::new(), next, is_taken: false, failure: None };
        Self { waiting: Mutex::new(waiting), take: Mutex::new(take) }
    }

    fn waiting(&self) -> MutexGuard<'_, Waiting<R, E>> {
        self.waiting.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// True if nothing more is taken.
    fn is_over(&self) -> bool {
        self.waiting().failure.is_some()
    }

    /// Takes what is next, unless another thread does so already: that goes on as long as there is something.
    fn put(&self, item: usize, result: Result<R, E>) {
        let mut waiting = self.waiting();
        waiting.results.insert(item, result);
        if std::mem::replace(&mut waiting.is_taken, true) {
            return;
        }
        while waiting.failure.is_none() {
            let next = waiting.next;
            let Some(result) = waiting.results.remove(&next) else { break };
            drop(waiting);
            let taken = result.and_then(|result| {
                let mut take = self.take.lock().unwrap_or_else(PoisonError::into_inner);
                take(result)
            });
            waiting = self.waiting();
            waiting.next += 1;
            waiting.failure = taken.err();
        }
        waiting.is_taken = false;
    }

    fn end(self) -> Result<(), E> {
        let Waiting { failure, .. } = self.waiting.into_inner().unwrap_or_else(PoisonError::into_inner);
        failure.map_or(Ok(()), Err)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    /// What is taken of 0..1000 until the end or the first error.
    fn taken(
        f: impl Fn(usize) -> Result<usize, String> + Sync + Send,
        last: usize,
    ) -> (Vec<usize>, Result<(), String>) {
        let mut all = Vec::new();
        let result = in_order(0..1000, f, |item| {
            all.push(item);
            if item == last { Err(format!("taking {item}")) } else { Ok(()) }
        });
        (all, result)
    }

    /// Some take much longer than others.
    fn slowly(item: usize) {
        if item.is_multiple_of(97) {
            std::thread::sleep(Duration::from_millis(3));
        }
    }

    #[test]
    fn results_are_taken_in_their_order() {
        let (all, result) = taken(
            |item| {
                slowly(item);
                Ok(item)
            },
            usize::MAX,
        );
        assert!(result.is_ok() && all.iter().copied().eq(0..1000));
    }

    #[test]
    fn the_first_error_ends_it_after_all_before_it() {
        let fail = |item| {
            slowly(item);
            if item >= 290 && item % 10 == 1 { Err(format!("item {item}")) } else { Ok(item) }
        };
        let (all, result) = taken(fail, usize::MAX);
        assert!(result == Err("item 291".to_owned()) && all.iter().copied().eq(0..291), "{result:?}");
        let (all, result) = taken(
            |item| {
                slowly(item);
                Ok(item)
            },
            500,
        );
        assert!(result == Err("taking 500".to_owned()) && all.iter().copied().eq(0..501), "{result:?}");
    }
}
