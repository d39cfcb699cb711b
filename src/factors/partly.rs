//! The exchange between two elements that see each other partly: an integral over one of them, of the closed form of what is seen of the other.
//!
//! It is divided into quadrilaterals, the worst of which are halved or quartered until the estimates of their errors sum to no more than what is allowed. A shadow that
//! covers a corner or a side of the element only may be seen by none of the first points. It is seen from the other element's corners and the middles of its sides, as light goes both ways: if, of what they see
//! of the element, sides of blockers are bounds that are none from any of the points, estimates are raised, until they are bounds from more points. If some still are none, and points of the other element see another amount of
//! this one, it is cut where their shadows end, so that there are points on both sides of them, however narrow what is lit or hidden may be.

use super::bodies::FacetSide;
use super::element::{Element, Elements, quads};
use super::facets::Facets;
use super::hidden::{Bound, HiddenSpace, Target};
use super::pieces::pieces;
use super::quads::{Part, Quads};
use super::row::Share;
use super::rule::{Outer, Rule, Sample};
use super::shape::{double_area, sides};
use glam::{DVec2, DVec3};

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
/// Where more than so many times what is allowed would arrive with nothing between, the first few parts are taken to be wrong by so many times their estimates instead: of a city of
/// 10 x 10 blocks 15 pairs were off by more than 5e-5 at a tolerance of 1e-4, and the worst by 1.1e-4, nearly all of them such ones in 5 to 11 parts; with this it is 1, by 6.3e-5, for a twentieth more points.
const STRONG: f64 = 400.0;
const OF_FIRST: f64 = 2.0;
const FIRST: usize = 8;
/// As long as so many times what is allowed is left, parts are quartered that are wrong by this part of it; after so many points only those that change across both sides.
const FAR: f64 = 3.0;
const OF_ALLOWED: f64 = 0.1;
const BEGUN: usize = 1000;
/// With shadows that no point has met, what the other element sees has to agree to this part of what is allowed, or of the estimate of that. Chosen by dense cities: of 21,546 such pairs
/// 916 do not, and of the others none is off by more than 2.3e-5 at a tolerance of 1e-4.
const AGREES: f64 = 0.25;
/// Parts are cut along no more bounds at once.
const AT_ONCE: usize = 16;
/// What is cut off is narrow if it is less than this part of the element; if what may arrive there is more than this part of what is allowed, it is cut along all bounds.
const NARROW: f64 = 1.0 / 16.0;

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
    /// Where the element was cut last, in its frame.
    pub(super) cuts: Vec<[DVec2; 2]>,
}

impl Default for PartlySpace {
    fn default() -> Self {
        let (there, back) = (HiddenSpace::default(), HiddenSpace::default());
        Self { there, back, few: Rule::first(), many: Rule::genz_malik(), cuts: Vec::new() }
    }
}

impl Partly<'_> {
    /// The form factor from the element to what it sees of the other, with an estimate of its error that is not above `allowed` if `most` points or so are
    /// enough for that.
    pub(super) fn integrate(&self, allowed: f64, most: usize, space: &mut PartlySpace) -> Share {
        let PartlySpace { there, back, few, many, cuts } = space;
        cuts.clear();
        let target = Target::new(self.facets, self.elements, [self.from, self.to], self.between, there);
        // With nothing between, what is seen changes steadily.
        let eyes = self.from.ring.iter().copied().chain([self.from.centre]);
        let at_most = eyes.map(|eye| target.whole_factor(eye, there)).fold(0.0, f64::max);
        let is_strong = at_most > STRONG * allowed;
        let mut points = Points { rule: few, target: &target, space: there, area: self.from.area, is_strong };
        if at_most <= SMALL * allowed && !self.is_near() {
            let mut quads = points.whole(self.parts, 1.0);
            quads.worsen(OF_FEW * at_most);
            if quads.error() <= allowed {
                return quads.total(at_most);
            }
        }
        points.rule = many;
        points.space.bounds = Some(Vec::new());
        let mut quads = points.whole(self.parts, OF_WHOLE);
        // What is below that is not worth a look, unless nothing at all has been seen of what is between: all may be wrong then.
        let is_blind = points.space.bounds.as_ref().is_some_and(Vec::is_empty) || quads.is_nothing(at_most);
        if is_blind || OF_MANY * at_most + quads.error() > allowed {
            let own = Target::new(self.facets, self.elements, [self.to, self.from], self.between, back);
            let missed = points.space.not_noted(self.bounds_seen(&own, back));
            let mut unseen = missed.clone();
            if !missed.is_empty() {
                quads.worsen(OF_MANY * at_most);
                unseen = points.refine(&mut quads, unseen, allowed, most);
            }
            if is_blind {
                // A side that has been met by one point of those in between is little.
                unseen = missed;
            }
            if !unseen.is_empty() && !self.agrees(&quads, allowed, &own, many, back) {
                let frame = &self.elements.frames[self.from.facet as usize];
                *cuts = points.cut_along(&mut quads, unseen, allowed / at_most, most, |part, segments| {
                    pieces(part, segments, frame, self.from.radius)
                });
                quads.trust();
            }
        }
        points.space.bounds = None;
        points.refine(&mut quads, Vec::new(), allowed, most);
        quads.total(at_most)
    }

    /// True if the elements are so near each other that more may be seen from between corners and centre than from these.
    fn is_near(&self) -> bool {
        let bounds = |element: &Element| {
            let ring = || element.ring.iter().copied();
            [ring().fold(DVec3::INFINITY, DVec3::min), ring().fold(DVec3::NEG_INFINITY, DVec3::max)]
        };
        let ([low, high], [other_low, other_high]) = (bounds(self.from), bounds(self.to));
        let apart = (other_low - high).max(low - other_high).max(DVec3::ZERO);
        apart.length() < self.from.radius
    }

    /// The bounds of what corners of the other element and middles of its sides see of this one.
    fn bounds_seen(&self, own: &Target<'_>, back: &mut HiddenSpace) -> Vec<Bound> {
        back.bounds = Some(Vec::new());
        let middles = sides(&self.to.ring).map(|[a, b]| a.midpoint(b));
        let eyes = self.to.ring.iter().copied().chain(middles);
        let bounds = eyes.flat_map(|eye| own.bounds(eye, back)).collect();
        back.bounds = None;
        bounds
    }

    /// True if many points of the other element see as much of this one as there is in its parts, up to estimates of that.
    fn agrees(&self, all: &Quads, allowed: f64, own: &Target<'_>, rule: &Rule, back: &mut HiddenSpace) -> bool {
        let mut points = Points { rule, target: own, space: back, area: self.from.area, is_strong: false };
        let seen = points.whole(&[&self.to.ring], 1.0);
        (seen.value() - all.value()).abs() <= AGREES * allowed.max(seen.error())
    }
}

/// Points on an element that look at another one.
struct Points<'a> {
    rule: &'a Rule,
    target: &'a Target<'a>,
    space: &'a mut HiddenSpace,
    /// What areas are parts of.
    area: f64,
    /// Much may arrive.
    is_strong: bool,
}

impl Points<'_> {
    fn sample(&mut self, part: &Part) -> Sample {
        self.rule.sample(part.corners, part.outer, self.area, |point| self.target.factor(point, self.space))
    }

    /// All of some convex rings, wrong by so many times the estimate.
    fn whole(&mut self, rings: &[impl AsRef<[DVec3]>], times: f64) -> Quads {
        let mut all = Quads::default();
        for ring in rings.iter().map(AsRef::as_ref) {
            for quad in quads(ring.len()) {
                let part = Part { corners: quad.map(|k| ring[k]), outer: Outer::ALL };
                let sample = self.sample(&part);
                all.add(part, Sample { error: times * sample.error, ..sample }, 0.0);
            }
        }
        all
    }

    /// Adds one of several that something was divided into.
    fn add(&mut self, part: Part, missed: f64, all: &mut Quads) {
        let sample = self.sample(&part);
        let times = if self.is_strong && all.count < FIRST { OF_FIRST } else { OF_PARTS };
        all.add(part, Sample { error: times * sample.error, ..sample }, missed);
    }

    /// Divides the worst parts until estimates sum to no more than what is allowed, or as many points have been taken, and returns those of the bounds that no point has met.
    fn refine(&mut self, all: &mut Quads, mut missed: Vec<Bound>, allowed: f64, most: usize) -> Vec<Bound> {
        while all.error() > allowed && all.count * self.rule.count() < most {
            if !missed.is_empty() {
                missed = self.space.not_noted(missed);
                if missed.is_empty() {
                    all.trust();
                    self.space.bounds = None;
                    continue;
                }
            }
            let is_far = all.error() > FAR * allowed;
            let is_begun = all.count * self.rule.count() < BEGUN;
            let Some(worst) = all.pop() else { break };
            let mut parts = worst.part.halves(worst.sample.halve_first).to_vec();
            if is_far && (is_begun || worst.sample.is_even) && worst.error() > OF_ALLOWED * allowed {
                parts = parts.iter().flat_map(|half| half.halves(!worst.sample.halve_first)).collect();
            }
            // Of what may have been missed they have as much less as they are smaller, and each its part; in the end others tell.
            let each_missed = if is_begun { worst.missed / (parts.len() * parts.len()) as f64 } else { 0.0 };
            for part in parts {
                self.add(part, each_missed, all);
            }
        }
        self.space.not_noted(missed)
    }

    /// Cuts parts along bounds until points have met all of their sides, and returns where; `relative` is what is allowed as a part of what may arrive.
    fn cut_along(
        &mut self,
        all: &mut Quads,
        mut unseen: Vec<Bound>,
        relative: f64,
        most: usize,
        pieces: impl Fn(&[DVec3], &[[DVec2; 2]]) -> Vec<Vec<DVec3>>,
    ) -> Vec<[DVec2; 2]> {
        let mut cuts = Vec::new();
        while !unseen.is_empty() && all.count * self.rule.count() < most {
            let (mut segments, mut rest) = one_of_each(unseen);
            let least = self.cut(all, |part| pieces(part, &segments));
            if least < NARROW && NARROW * relative < least {
                // From elsewhere it is seen beside that, and by no points in between.
                let later = rest.split_off(AT_ONCE.min(rest.len()));
                let others: Vec<[DVec2; 2]> = rest.iter().map(|bound| bound.segment).collect();
                self.cut(all, |part| pieces(part, &others));
                segments.extend(others);
                rest = later;
            }
            cuts.extend(segments);
            unseen = self.space.not_noted(rest);
        }
        cuts
    }

    /// Cuts all parts, and returns the area of the least piece, as a part of the element's.
    fn cut(&mut self, all: &mut Quads, pieces: impl Fn(&[DVec3]) -> Vec<Vec<DVec3>>) -> f64 {
        let mut least = 1.0_f64;
        for quad in all.take() {
            let pieces = pieces(&quad.part.corners);
            if pieces.len() == 1 {
                all.put(quad);
                continue;
            }
            for piece in pieces {
                least = least.min(0.5 * double_area(&piece).length() / self.area);
                for corners in quads(piece.len()) {
                    self.add(Part { corners: corners.map(|k| piece[k]), outer: Outer::ALL }, 0.0, all);
                }
            }
        }
        least
    }
}

/// Where the first bound by each side is, of the first sides, and the other bounds: a side is mostly known when there are points on both sides of one.
fn one_of_each(bounds: Vec<Bound>) -> (Vec<[DVec2; 2]>, Vec<Bound>) {
    let mut taken: Vec<FacetSide> = Vec::new();
    let mut segments = Vec::new();
    let mut rest = Vec::new();
    for bound in bounds {
        if taken.len() < AT_ONCE && !taken.contains(&bound.side) {
            taken.push(bound.side);
            segments.push(bound.segment);
        } else {
            rest.push(bound);
        }
    }
    (segments, rest)
}
