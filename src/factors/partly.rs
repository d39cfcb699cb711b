//! The exchange between two elements that see each other partly: an integral over one of them, of the closed form of what is seen of the other.
//!
//! It is divided into quadrilaterals, the worst of which are halved or quartered until the estimates of their errors sum to no more than what is allowed. A shadow that
//! covers a corner or a side of the element only may be seen by none of the first points. It is seen from the other element's corners and the middles of its sides, as light goes both ways: if, of what they see
//! of the element, sides of blockers are bounds that are none from any of the points, estimates are raised, until they are bounds from more points.

use super::bodies::FacetSide;
use super::cubature::{Outer, Rule, Sample, halves};
use super::element::{Element, Elements, quads};
use super::facets::Facets;
use super::hidden::{HiddenSpace, Target};
use super::row::Share;
use super::shape::sides;
use glam::DVec3;
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// What is seen of an element is nothing if it is less than this part of what would be.
const ROUNDING: f64 = 1e-12;
/// Few points are enough where no more than so many times what is allowed would arrive with nothing between.
const SMALL: f64 = 8.0;
/// The part of that which few points are taken to be wrong by at least; like the next one, chosen by what entries of dense cities were off by.
const OF_FEW: f64 = 0.1;
/// The part of it which a shadow is taken to cover that none of many points has seen.
const OF_MANY: f64 = 0.015;
/// How many times its estimate an element is taken to be wrong by that is not divided: there is nothing else to tell by.
const OF_WHOLE: f64 = 3.0;
/// The part of their estimates that parts of divided elements are wrong by; chosen by dense cities, too: in rows of them estimates were ten times too large, in the middle, without.
const OF_PARTS: f64 = 0.7;
/// Errors have both signs: their sum is taken to be so many times the root of the sum of their squares, and no less than this part of the sum of their sizes, as parts along a
/// shadow's edge that runs as their sides do are all wrong alike.
const OF_ROOT: f64 = 2.0;
const OF_SUM: f64 = 0.4;
/// As long as so many times what is allowed is left, parts are quartered that are wrong by this part of it; after so many points only those that change across both sides.
const FAR: f64 = 3.0;
const OF_ALLOWED: f64 = 0.1;
const BEGUN: usize = 1000;

/// Two elements with what is between them.
pub(super) struct Partly<'a> {
    pub(super) facets: &'a Facets,
    pub(super) elements: &'a Elements,
    pub(super) from: &'a Element,
    /// It in parts between the lines where others stand on it.
    pub(super) parts: &'a [Vec<DVec3>],
    pub(super) to: &'a Element,
    /// Facets, ascending.
    pub(super) between: &'a [u32],
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
        let target = Target::new(self.facets, self.elements, [self.from, self.to], self.between, there);
        // With nothing between, what is seen changes steadily.
        let eyes = self.from.ring.iter().copied().chain([self.from.centre]);
        let at_most = eyes.map(|eye| target.whole_factor(eye, there)).fold(0.0, f64::max);
        if at_most <= SMALL * allowed {
            let mut quads = self.sample(few, 1.0, &target, there);
            quads.worsen(OF_FEW * at_most);
            if quads.error() <= allowed {
                return quads.total(at_most);
            }
        }
        there.bounds = Some(Vec::new());
        let mut quads = self.sample(many, OF_WHOLE, &target, there);
        let known = there.bounds.take().unwrap_or_default();
        // What is below that is not worth a look.
        let is_worth = OF_MANY * at_most + quads.error() > allowed;
        let mut missed = if is_worth { self.missed(&known, back) } else { Vec::new() };
        if !missed.is_empty() {
            quads.worsen(OF_MANY * at_most);
            there.bounds = Some(known);
        }
        let mut points = quads.count * many.count();
        while quads.error() > allowed && points < most {
            if let Some(known) = &there.bounds {
                missed.retain(|side| known.binary_search(side).is_err());
                if missed.is_empty() {
                    quads.trust();
                    there.bounds = None;
                    continue;
                }
            }
            let is_far = quads.error() > FAR * allowed;
            let Some(worst) = quads.pop() else { break };
            let mut parts = worst.part.halves(worst.sample.halve_first).to_vec();
            let is_begun = points < BEGUN;
            if is_far && (is_begun || worst.sample.is_even) && worst.error() > OF_ALLOWED * allowed {
                parts = parts.iter().flat_map(|half| half.halves(!worst.sample.halve_first)).collect();
            }
            // Of what may have been missed they have as much less as they are smaller, and each its part; in the end a shadow is seen or too small to look for.
            let missed = if is_begun { worst.missed / (parts.len() * parts.len()) as f64 } else { 0.0 };
            for part in parts {
                points += many.count();
                let sample = many.sample(part.corners, part.outer, self.from.area, |point| target.factor(point, there));
                quads.add(part, Sample { error: OF_PARTS * sample.error, ..sample }, missed);
            }
        }
        there.bounds = None;
        quads.total(at_most)
    }

    /// All of the element, wrong by so many times its estimate.
    fn sample(&self, rule: &Rule, times: f64, target: &Target<'_>, space: &mut HiddenSpace) -> Quads {
        let mut all = Quads::default();
        for ring in self.parts {
            for quad in quads(ring.len()) {
                let part = Part { corners: quad.map(|k| ring[k]), outer: Outer::ALL };
                let sample = rule.sample(part.corners, part.outer, self.from.area, |point| target.factor(point, space));
                all.add(part, Sample { error: times * sample.error, ..sample }, 0.0);
            }
        }
        all
    }

    /// The sides that are bounds of what corners of the other element and middles of its sides see of this one, and are not known.
    fn missed(&self, known: &[FacetSide], space: &mut HiddenSpace) -> Vec<FacetSide> {
        let own = Target::new(self.facets, self.elements, [self.to, self.from], self.between, space);
        space.bounds = Some(Vec::new());
        let middles = sides(&self.to.ring).map(|[a, b]| a.midpoint(b));
        self.to.ring.iter().copied().chain(middles).for_each(|eye| own.note_bounds(eye, space));
        let mut bounds = space.bounds.take().unwrap_or_default();
        bounds.retain(|side| known.binary_search(side).is_err());
        bounds
    }
}

/// A part of the element.
#[derive(Clone, Copy)]
struct Part {
    corners: [DVec3; 4],
    outer: Outer,
}

impl Part {
    fn halves(&self, first: bool) -> [Self; 2] {
        let [low, high] = halves(self.corners, first);
        let [outer_low, outer_high] = self.outer.halves(first);
        [Self { corners: low, outer: outer_low }, Self { corners: high, outer: outer_high }]
    }
}

/// What is known of it.
struct Quad {
    part: Part,
    sample: Sample,
    /// What it may be wrong by besides, as something may have been missed.
    missed: f64,
    /// In the order of their making.
    number: usize,
}

impl Quad {
    fn error(&self) -> f64 {
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
struct Quads {
    waiting: BinaryHeap<Quad>,
    /// How many have been made.
    count: usize,
    /// The sums of their estimates, of the squares of these, and of what may have been missed.
    error: f64,
    squares: f64,
    missed: f64,
}

impl Quads {
    fn add(&mut self, part: Part, sample: Sample, missed: f64) {
        self.count += 1;
        self.error += sample.error;
        self.squares += sample.error * sample.error;
        self.missed += missed;
        self.waiting.push(Quad { part, sample, missed, number: self.count });
    }

    /// Takes out the one with the largest estimate.
    fn pop(&mut self) -> Option<Quad> {
        let worst = self.waiting.pop()?;
        self.error -= worst.sample.error;
        self.squares -= worst.sample.error * worst.sample.error;
        self.missed -= worst.missed;
        Some(worst)
    }

    /// Adds to the estimates, by equal parts.
    fn worsen(&mut self, error: f64) {
        self.missed += error;
        let part = error / self.waiting.len() as f64;
        let all = std::mem::take(&mut self.waiting).into_iter();
        self.waiting = all.map(|quad| Quad { missed: quad.missed + part, ..quad }).collect();
    }

    /// Takes back what was added, as nothing has been missed.
    fn trust(&mut self) {
        self.missed = 0.0;
        let all = std::mem::take(&mut self.waiting).into_iter();
        self.waiting = all.map(|quad| Quad { missed: 0.0, ..quad }).collect();
    }

    /// An estimate of the error of the sum.
    fn error(&self) -> f64 {
        let both_signs = (OF_ROOT * self.squares.max(0.0).sqrt()).max(OF_SUM * self.error);
        self.error.min(both_signs).max(0.0) + self.missed.max(0.0)
    }

    /// The integral, of a factor that is nowhere larger than this with nothing between.
    fn total(self, at_most: f64) -> Share {
        let error = self.error();
        let factor = self.waiting.into_sorted_vec().iter().fold(0.0, |sum, quad| sum + quad.sample.value);
        // Rounding leaves slivers of what is hidden.
        if factor.abs().max(error) <= ROUNDING * at_most { Share::default() } else { Share { factor, error } }
    }
}
