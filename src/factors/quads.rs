//! An element in quadrilaterals that have been integrated, the worst of which are divided next.

use super::cubature::halves;
use super::row::Share;
use super::rule::{Outer, Sample};
use glam::DVec3;
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// What is seen of an element is nothing if it is less than this part of what would be.
const ROUNDING: f64 = 1e-12;
/// Errors have both signs: their sum is taken to be so many times the root of the sum of their squares, and no less than this part of the sum of their sizes, as parts along a
/// shadow's edge that runs as their sides do are all wrong alike.
const OF_ROOT: f64 = 2.0;
const OF_SUM: f64 = 0.4;

/// A part of the element.
#[derive(Clone, Copy)]
pub(super) struct Part {
    pub(super) corners: [DVec3; 4],
    pub(super) outer: Outer,
}

impl Part {
    pub(super) fn halves(&self, first: bool) -> [Self; 2] {
        let [low, high] = halves(self.corners, first);
        let [outer_low, outer_high] = self.outer.halves(first);
        [Self { corners: low, outer: outer_low }, Self { corners: high, outer: outer_high }]
    }
}

/// What is known of it.
pub(super) struct Quad {
    pub(super) part: Part,
    pub(super) sample: Sample,
    /// What it may be wrong by besides, as something may have been missed.
    pub(super) missed: f64,
    /// In the order of their making.
    number: usize,
}

impl Quad {
    pub(super) fn error(&self) -> f64 {
        self.sample.error + self.missed
    }
}

impl PartialEq for Quad {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Quad {}

impl PartialOrd for Quad {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Quad {
    fn cmp(&self, other: &Self) -> Ordering {
        self.error().total_cmp(&other.error()).then(other.number.cmp(&self.number))
    }
}

/// The parts so far.
#[derive(Default)]
pub(super) struct Quads {
    waiting: BinaryHeap<Quad>,
    /// How many have been made.
    pub(super) count: usize,
    /// The sums of their estimates, of the squares of these, and of what may have been missed.
    error: f64,
    squares: f64,
    missed: f64,
}

impl Quads {
    pub(super) fn add(&mut self, part: Part, sample: Sample, missed: f64) {
        self.count += 1;
        self.error += sample.error;
        self.squares += sample.error * sample.error;
        self.missed += missed;
        self.waiting.push(Quad { part, sample, missed, number: self.count });
    }

    /// Takes out the one with the largest estimate.
    pub(super) fn pop(&mut self) -> Option<Quad> {
        let worst = self.waiting.pop()?;
        self.error -= worst.sample.error;
        self.squares -= worst.sample.error * worst.sample.error;
        self.missed -= worst.missed;
        Some(worst)
    }

    /// Takes out all, in an order that does not change.
    pub(super) fn take(&mut self) -> Vec<Quad> {
        let Self { waiting, count, .. } = std::mem::take(self);
        self.count = count;
        waiting.into_sorted_vec()
    }

    /// Puts back one that was taken out.
    pub(super) fn put(&mut self, Quad { part, sample, missed, number }: Quad) {
        let count = self.count;
        self.count = number - 1;
        self.add(part, sample, missed);
        self.count = count;
    }

    /// Adds to the estimates, by equal parts.
    pub(super) fn worsen(&mut self, error: f64) {
        self.missed += error;
        let part = error / self.waiting.len() as f64;
        let all = std::mem::take(&mut self.waiting).into_iter();
        self.waiting = all.map(|quad| Quad { missed: quad.missed + part, ..quad }).collect();
    }

    /// Takes back what was added, as nothing has been missed.
    pub(super) fn trust(&mut self) {
        self.missed = 0.0;
        let all = std::mem::take(&mut self.waiting).into_iter();
        self.waiting = all.map(|quad| Quad { missed: 0.0, ..quad }).collect();
    }

    /// An estimate of the error of the sum.
    pub(super) fn error(&self) -> f64 {
        let both_signs = (OF_ROOT * self.squares.max(0.0).sqrt()).max(OF_SUM * self.error);
        self.error.min(both_signs).max(0.0) + self.missed.max(0.0)
    }

    /// The sum so far, up to rounding that depends on how it was divided.
    pub(super) fn value(&self) -> f64 {
        self.waiting.iter().map(|quad| quad.sample.value).sum()
    }

    /// True if there is no more than rounding leaves of slivers of what is hidden, of a factor that is nowhere larger than this with nothing between.
    pub(super) fn is_nothing(&self, at_most: f64) -> bool {
        self.value().abs().max(self.error()) <= ROUNDING * at_most
    }

    /// The integral, of a factor that is nowhere larger than this with nothing between.
    pub(super) fn total(self, at_most: f64) -> Share {
        if self.is_nothing(at_most) {
            return Share::default();
        }
        let error = self.error();
        Share { factor: self.waiting.into_sorted_vec().iter().fold(0.0, |sum, quad| sum + quad.sample.value), error }
    }
}
