//! The exchange between two elements that see each other partly: an integral over one of them, of the closed form of what is seen of the other.
//!
//! It is divided into quadrilaterals, the worst of which are halved until the estimates of their errors sum to no more than what is allowed. A shadow that
//! covers a corner or a side of the element only may be seen by none of the first points. It is seen from the other element's corners and the middles of its sides, as light goes both ways: if, of what they see
//! of the element, sides of blockers are bounds that are none from any of the points, estimates are raised.

use super::cubature::{Rule, Sample, halves};
use super::element::{Element, quads};
use super::hidden::{HiddenSpace, Target};
use super::row::Share;
use super::shape::{Frame, sides};
use glam::DVec3;
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// Few points are enough where no more than so many times what is allowed would arrive with nothing between.
const SMALL: f64 = 8.0;
/// The part of that which few points are taken to be wrong by at least; like the next one, chosen by what entries of dense cities were off by.
const OF_FEW: f64 = 0.1;
/// The part of it which a shadow is taken to cover that none of many points has seen.
const OF_MANY: f64 = 0.015;

/// Two elements with what is between them.
pub(super) struct Partly<'a> {
    pub(super) from: &'a Element,
    pub(super) from_frame: &'a Frame,
    /// It in parts between the lines where others stand on it.
    pub(super) parts: &'a [Vec<DVec3>],
    pub(super) to: &'a Element,
    pub(super) to_frame: &'a Frame,
    /// Whether the other element is on both sides of the plane of the one it is seen from, and the other way round.
    pub(super) has_horizon: [bool; 2],
    /// Corners, counter-clockwise seen from the front, and the plane.
    pub(super) blockers: &'a [(&'a [DVec3], &'a Frame)],
}

/// Memory and rules that are used again.
pub(super) struct PartlySpace {
    there: HiddenSpace,
    back: HiddenSpace,
    few: Rule,
    many: Rule,
}

impl Default for PartlySpace {
    fn default() -> Self {
        let (there, back) = (HiddenSpace::default(), HiddenSpace::default());
        Self { there, back, few: Rule::first(), many: Rule::genz_malik() }
    }
}

impl Partly<'_> {
    /// The form factor from the element to what it sees of the other, with an estimate of its error that is not above `allowed` if `most` points or so are
    /// enough for that.
    pub(super) fn integrate(&self, allowed: f64, most: usize, space: &mut PartlySpace) -> Share {
        let PartlySpace { there, back, few, many } = space;
        let blockers = self.blockers.iter().copied();
        let target = Target::new(self.to, self.to_frame, self.from_frame, self.has_horizon[0], blockers, there);
        // With nothing between, what is seen changes steadily.
        let eyes = self.from.ring.iter().copied().chain([self.from.centre]);
        let at_most = eyes.map(|eye| target.whole_factor(eye, there)).fold(0.0, f64::max);
        if at_most <= SMALL * allowed {
            let mut quads = self.sample(few, &target, there);
            quads.worsen(OF_FEW * at_most);
            if quads.error <= allowed {
                return quads.total();
            }
        }
        there.bounds = Some(Vec::new());
        let mut quads = self.sample(many, &target, there);
        let known = there.bounds.take().unwrap_or_default();
        // What is below that is not worth a look.
        if OF_MANY * at_most + quads.error > allowed && self.look_back(known, back) {
            quads.worsen(OF_MANY * at_most);
        }
        while quads.error > allowed && quads.count * many.count() < most {
            let Some(worst) = quads.pop() else { break };
            for half in halves(worst.corners, worst.sample.halve_first) {
                quads.add(half, many.sample(half, self.from.area, |point| target.factor(point, there)));
            }
        }
        quads.total()
    }

    /// All of the element.
    fn sample(&self, rule: &Rule, target: &Target<'_>, space: &mut HiddenSpace) -> Quads {
        let mut all = Quads::default();
        for ring in self.parts {
            for quad in quads(ring.len()) {
                let corners = quad.map(|k| ring[k]);
                all.add(corners, rule.sample(corners, self.from.area, |point| target.factor(point, space)));
            }
        }
        all
    }

    /// True if, of what corners of the other element and middles of its sides see of this one, sides are bounds that are not known.
    fn look_back(&self, known: Vec<(u32, u32)>, space: &mut HiddenSpace) -> bool {
        let blockers = self.blockers.iter().copied();
        let own = Target::new(self.from, self.from_frame, self.to_frame, self.has_horizon[1], blockers, space);
        let count = known.len();
        space.bounds = Some(known);
        let middles = sides(&self.to.ring).map(|[a, b]| a.midpoint(b));
        self.to.ring.iter().copied().chain(middles).for_each(|eye| own.note_bounds(eye, space));
        space.bounds.take().is_some_and(|bounds| bounds.len() > count)
    }
}

/// A part of the element.
struct Quad {
    corners: [DVec3; 4],
    sample: Sample,
    error: f64,
    /// In the order of their making.
    number: usize,
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
        self.error.total_cmp(&other.error).then(other.number.cmp(&self.number))
    }
}

/// The parts so far.
#[derive(Default)]
struct Quads {
    waiting: BinaryHeap<Quad>,
    /// How many have been made.
    count: usize,
    error: f64,
}

impl Quads {
    fn add(&mut self, corners: [DVec3; 4], sample: Sample) {
        self.count += 1;
        self.error += sample.error;
        self.waiting.push(Quad { corners, sample, error: sample.error, number: self.count });
    }

    /// Takes out the one with the largest estimate.
    fn pop(&mut self) -> Option<Quad> {
        let worst = self.waiting.pop()?;
        self.error -= worst.error;
        Some(worst)
    }

    /// Adds to the estimates, by equal parts.
    fn worsen(&mut self, error: f64) {
        self.error += error;
        let part = error / self.waiting.len() as f64;
        let all = std::mem::take(&mut self.waiting).into_iter();
        self.waiting = all.map(|quad| Quad { error: quad.error + part, ..quad }).collect();
    }

    fn total(self) -> Share {
        self.waiting.into_sorted_vec().iter().fold(Share::default(), |sum, quad| Share {
            factor: sum.factor + quad.sample.value,
            error: sum.error + quad.error,
        })
    }
}
