//! A line on stderr that tells how far the work is.

use std::io::{IsTerminal, Write, stderr};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Shown if stderr is a terminal; gone when it is dropped.
pub(crate) struct Progress {
    what: &'static str,
    /// `None` if it is not known.
    total: Option<usize>,
    done: usize,
    start: Instant,
    shown: Option<Instant>,
    is_on: bool,
    /// What else there is to tell.
    note: String,
}

impl Progress {
    /// Of `total` things, if that is known, called `what`.
    pub(crate) fn new(what: &'static str, total: Option<usize>, quiet: bool) -> Self {
        let is_on = !quiet && stderr().is_terminal();
        Self { what, total, done: 0, start: Instant::now(), shown: None, is_on, note: String::new() }
    }

    /// What is told beside how many are done.
    pub(crate) fn note(&mut self, note: String) {
        self.note = note;
    }

    /// One more is done, of so many as turn out to be.
    pub(crate) fn add_of(&mut self, total: usize) {
        self.total = Some(total);
        self.add(1);
    }

    /// So many more are done.
    pub(crate) fn add(&mut self, count: usize) {
        self.done += count;
        let is_due = self.shown.is_none_or(|last| last.elapsed() > Duration::from_millis(100));
        if self.is_on && is_due {
            self.shown = Some(Instant::now());
            // If stderr is closed there is no one left to tell.
            let _ = write!(stderr(), "\r\x1b[K{}", self.line(self.start.elapsed().as_secs_f64()));
        }
    }

    fn line(&self, seconds: f64) -> String {
        let rate = self.done as f64 / seconds.max(1e-9);
        let note = if self.note.is_empty() { String::new() } else { format!(", {}", self.note) };
        let Some(total) = self.total else {
            return format!("{} {}, {rate:.1}/s{note}", self.done, self.what);
        };
        let left = total.saturating_sub(self.done) as f64 / rate.max(1e-9);
        format!("{} of {total} {}, {rate:.1}/s, {left:.0} s left{note}", self.done, self.what)
    }
}

/// The same, told by several threads.
pub(crate) struct SharedProgress(Mutex<Progress>);

impl SharedProgress {
    /// As [`Progress::new`].
    pub(crate) fn new(what: &'static str, total: Option<usize>, quiet: bool) -> Self {
        Self(Mutex::new(Progress::new(what, total, quiet)))
    }

    /// So many more are done.
    pub(crate) fn add(&self, count: usize) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).add(count);
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if self.shown.is_some() {
            let _ = write!(stderr(), "\r\x1b[K");
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_tells_rate_and_time_left() {
        let mut progress = Progress::new("views", Some(100), true);
        progress.add(20);
        progress.add(5);
        assert_eq!(progress.line(10.0), "25 of 100 views, 2.5/s, 30 s left");
        assert!(progress.shown.is_none(), "quiet");
        progress.add_of(52);
        assert_eq!(progress.line(13.0), "26 of 52 views, 2.0/s, 13 s left");
        progress.total = None;
        progress.done -= 1;
        assert_eq!(progress.line(10.0), "25 views, 2.5/s");
    }
}
