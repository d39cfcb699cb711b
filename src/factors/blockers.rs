//! Which elements of a facet are seen wholly from an element, which not at all, and which it takes views to tell.

use super::blocker::{Blocker, Blocks, Corner};
use super::contacts::{TOUCHES, contacts, parts};
use super::element::{Element, Elements};
use super::facets::Facets;
use super::lies::Lies;
use super::shaft::Shaft;
use super::shape::sides;
use super::tree::ElementTree;
use crate::bvh::Content;
use crate::contour::SceneOrder;
use crate::exact::U;
use crate::scene::Side;
use glam::{DVec2, DVec3};

/// What is no farther from an element than this part of its size is near it.
const NEAR: f64 = 1.0 / 32.0;
/// Most of what changes beside a side that is near does so within so many times its distance.
const BESIDE: f64 = 4.0;

/// Where all facets are, seen from one: each to the plane of this one, and this one to the plane of each.
pub(super) struct Around {
    facet: u32,
    /// If there are so many facets that this is not known for all of them.
    lies: Vec<[Lies; 2]>,
}

impl Around {
    pub(super) fn of(facet: u32, facets: &Facets) -> Self {
        let all = if facets.are_told_apart() { 0..0 } else { 0..facets.all.len() as u32 };
        Self { facet, lies: all.map(|other| [facets.lies(other, facet), facets.lies(facet, other)]).collect() }
    }

    pub(super) fn facet(&self) -> u32 {
        self.facet
    }

    /// A facet to the plane of this one.
    pub(super) fn facet_lies(&self, facets: &Facets, other: u32) -> Lies {
        self.lies.get(other as usize).map_or_else(|| facets.lies(other, self.facet), |lies| lies[0])
    }

    /// This facet to the plane of another one.
    pub(super) fn lies(&self, facets: &Facets, other: u32) -> Lies {
        self.lies.get(other as usize).map_or_else(|| facets.lies(self.facet, other), |lies| lies[1])
    }
}

/// How an element is seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Seen {
    /// From every point.
    Wholly,
    /// From none.
    Never,
    /// What is between may hide part of it.
    Partly,
    /// Likewise, and it has been integrated.
    Integrated,
    /// It takes views to tell.
    Unknown,
}

/// A box around an element and a part of a facet: what is outside of it is outside of the shafts to all that is in the part, too.
struct Reach {
    low: DVec3,
    high: DVec3,
}

impl Reach {
    fn of(ring: &[DVec3], part: &[Corner]) -> Self {
        let all = || ring.iter().copied().chain(part.iter().map(|corner| corner.at));
        let low = all().fold(DVec3::INFINITY, DVec3::min);
        let high = all().fold(DVec3::NEG_INFINITY, DVec3::max);
        // Corners that are not of an element are rounded: places in the frame by 6 u times distances there, twice (see `Line`), what is lifted by 4 u times all coordinates.
        let coordinate = low.abs().max(high.abs()).max_element();
        let place = part.iter().fold(0.0, |most: f64, corner| most.max(corner.flat.abs().max_element()));
        let error = 64.0 * U * (coordinate + place);
        Self { low: low - error, high: high + error }
    }

    fn may_meet(&self, [low, high]: [DVec3; 2]) -> bool {
        self.low.cmple(high).all() && self.high.cmpge(low).all()
    }
}

/// Finds what is between an element and those of a facet.
pub(super) struct Blockers<'a> {
    pub(super) facets: &'a Facets,
    pub(super) elements: &'a Elements,
    pub(super) trees: &'a [ElementTree],
}

/// The facets that have lately hidden a whole facet from an element: what is next to that one is often behind the same.
#[derive(Default)]
pub(super) struct Hiders(Vec<u32>);

impl Hiders {
    /// So many are kept.
    const MOST: usize = 8;

    pub(super) fn clear(&mut self) {
        self.0.clear();
    }

    /// Puts one first.
    fn note(&mut self, facet: u32) {
        let place = self.0.iter().position(|&known| known == facet).unwrap_or_else(|| {
            self.0.truncate(Self::MOST - 1);
            self.0.push(facet);
            self.0.len() - 1
        });
        self.0[..=place].rotate_right(1);
    }
}

/// A node of the tree, and which of the possible blockers may block the view of it.
struct Visit {
    node: u32,
    blockers: Vec<u32>,
}

impl Blockers<'_> {
    /// What two elements are found to be, and what may be between, is the same from either of them: it is decided by exact signs for both, those of facets as a
    /// whole, and of shafts between them. What is found of many elements at once is found of each.
    ///
    /// Nothing depends on the facets that have hidden others, which are asked first, but the time it takes.
    ///
    /// Calls `found` with the elements of a facet of which the front is seen, and with the facets that may be between if it takes views to tell. Those that are left
    /// out change nothing for the others.
    pub(super) fn classify(
        &self,
        around: &Around,
        from: &Element,
        facet: u32,
        hiders: &mut Hiders,
        is_left_out: impl Fn(u32) -> bool,
        mut found: impl FnMut(u32, Seen, &mut dyn Iterator<Item = u32>),
    ) {
        let tree = &self.trees[facet as usize];
        let frame = &self.elements.frames[facet as usize];
        let Some(root) = tree.root() else { return };
        let is_over = |node: u32| tree.elements(node).iter().all(|&element| is_left_out(element));
        if is_over(root) {
            return;
        }
        let mut all = |node: u32, seen: Seen, blockers: &[u32], candidates: &[Blocker<'_>]| {
            for &element in tree.elements(node).iter().filter(|&&element| !is_left_out(element)) {
                found(element, seen, &mut blockers.iter().map(|&blocker| candidates[blocker as usize].facet));
            }
        };
        if self.facets.all[facet as usize].is_ranked {
            return all(root, Seen::Unknown, &[], &[]);
        }
        let target = &self.facets.all[facet as usize];
        let own_ring = &self.facets.all[around.facet as usize].ring;
        let shaft = Shaft::between(&from.ring, &target.ring);
        let mut corners = Vec::new();
        tree.corners(root, frame, &self.elements.all, &mut corners);
        let is_alone = tree.halves(root).is_none();
        let hides_all = |&hider: &u32| {
            let blocker = self.blocker(around, from, facet, hider).filter(|_| self.may_hide(around, facet, hider));
            blocker.is_some_and(|mut blocker| blocker.blocks(&corners, is_alone) == Blocks::Everything)
                && !shaft.excludes(&self.facets.all[hider as usize].ring)
        };
        if let Some(hider) = hiders.0.iter().copied().find(hides_all) {
            hiders.note(hider);
            return all(root, Seen::Never, &[], &[]);
        }
        let mut candidates = self.candidates(around, from, facet, &shaft);
        let mut visits = vec![Visit { node: root, blockers: (0..candidates.len() as u32).collect() }];
        while let Some(Visit { node, mut blockers }) = visits.pop() {
            let is_one = tree.halves(node).is_none();
            let mut is_hidden = false;
            if !blockers.is_empty() {
                tree.corners(node, frame, &self.elements.all, &mut corners);
                let reach = Reach::of(&from.ring, &corners);
                blockers.retain(|&blocker| {
                    let blocker = &mut candidates[blocker as usize];
                    is_hidden
                        || reach.may_meet(self.facets.all[blocker.facet as usize].bounds) && {
                            let blocks = blocker.blocks(&corners, is_one);
                            is_hidden = blocks == Blocks::Everything;
                            if is_hidden && node == root {
                                hiders.note(blocker.facet);
                            }
                            blocks != Blocks::Nothing
                        }
                });
            }
            // The planes of these shafts are for what it is worth: one element. It is all of them, whichever end one looks from.
            if is_one && !is_hidden {
                let ring: Vec<DVec3> = corners.iter().map(|corner| corner.at).collect();
                for (ring_from, is_known) in [(&from.ring, ring == target.ring), (own_ring, from.ring == *own_ring)] {
                    if !is_known && !blockers.is_empty() {
                        let shaft = Shaft::between(ring_from, &ring);
                        blockers.retain(|&blocker| {
                            let facet = candidates[blocker as usize].facet;
                            !shaft.excludes(&self.facets.all[facet as usize].ring)
                        });
                    }
                }
            }
            match tree.halves(node) {
                _ if is_hidden => all(node, Seen::Never, &[], &[]),
                _ if blockers.is_empty() => all(node, Seen::Wholly, &[], &[]),
                None => all(node, Seen::Partly, &blockers, &candidates),
                Some([first, second]) => {
                    if !is_over(second) {
                        visits.push(Visit { node: second, blockers: blockers.clone() });
                    }
                    if !is_over(first) {
                        visits.push(Visit { node: first, blockers });
                    }
                }
            }
        }
    }

    /// An element in parts between the lines where facets stand on it or pass through it, or come near it with a side: from one point to the next what is seen changes there within about that distance.
    pub(super) fn parts(&self, element: &Element) -> Vec<Vec<DVec3>> {
        let frame = &self.elements.frames[element.facet as usize];
        // Corners of a mesh are rounded.
        let reach = element.radius * (1e-12 + element.rounding) + TOUCHES;
        let mut segments = self.contacts(element.facet, &element.ring, reach);
        self.near_sides(element, &mut segments);
        parts(element, frame, &segments)
    }

    /// Adds the sides of facets that are near an element all along, as they lie before it.
    fn near_sides(&self, element: &Element, segments: &mut Vec<[DVec2; 2]>) {
        let reach = NEAR * element.radius;
        let low = element.ring.iter().fold(DVec3::INFINITY, |low, &p| low.min(p)) - reach;
        let high = element.ring.iter().fold(DVec3::NEG_INFINITY, |high, &p| high.max(p)) + reach;
        let frame = &self.elements.frames[element.facet as usize];
        let others = self.within(
            |&other| other != element.facet,
            |other_low, other_high| low.cmple(other_high).all() && high.cmpge(other_low).all(),
        );
        for other in others {
            let is_near = |p: DVec3| (TOUCHES..=reach).contains(&frame.height(p));
            let near = sides(&self.facets.all[other as usize].ring).filter(|side| side.iter().all(|&p| is_near(p)));
            for side in near {
                let beside = BESIDE * side.iter().map(|&p| frame.height(p)).fold(0.0, f64::max);
                let [a, b] = side.map(|p| frame.flat(p));
                let across = (b - a).perp().normalize_or_zero() * beside;
                segments.extend([[a, b], [a + across, b + across], [a - across, b - across]]);
            }
        }
    }

    /// Where facets stand on a part of a facet or pass through it, in its plane, if they are not farther from it than that; some of the segments may be beside it.
    pub(super) fn contacts(&self, facet: u32, ring: &[DVec3], reach: f64) -> Vec<[DVec2; 2]> {
        let low = ring.iter().fold(DVec3::INFINITY, |low, &p| low.min(p)) - reach;
        let high = ring.iter().fold(DVec3::NEG_INFINITY, |high, &p| high.max(p)) + reach;
        let others =
            self.within(|_| true, |other_low, other_high| low.cmple(other_high).all() && high.cmpge(other_low).all());
        contacts(facet, self.facets, &self.elements.frames[facet as usize], &others)
    }

    /// The facets that may block light between an element and a whole facet, ascending.
    fn candidates<'b>(&'b self, around: &Around, from: &'b Element, facet: u32, shaft: &Shaft) -> Vec<Blocker<'b>> {
        let may_hide = |&number: &u32| self.may_hide(around, facet, number);
        let blocker = |number: u32| {
            self.blocker(around, from, facet, number)
                .filter(|_| !shaft.excludes(&self.facets.all[number as usize].ring))
        };
        self.within(may_hide, |low, high| shaft.may_meet(low, high)).into_iter().filter_map(blocker).collect()
    }

    /// False if a facet hides nothing of another one for what it is: what is behind that, or in its plane.
    fn may_hide(&self, around: &Around, facet: u32, number: u32) -> bool {
        number != around.facet
            && number != facet
            && !matches!(around.facet_lies(self.facets, number), Lies::Behind | Lies::On)
            && !matches!(self.facets.lies(number, facet), Lies::Behind | Lies::On)
            && !self.is_redundant(around.facet.min(facet), number)
    }

    /// A facet as a blocker of light between an element and another facet, unless these are on one side of its plane.
    fn blocker<'b>(&'b self, around: &Around, from: &'b Element, facet: u32, number: u32) -> Option<Blocker<'b>> {
        let blocker = &self.facets.all[number as usize];
        let own = match around.lies(self.facets, number) {
            Lies::Across => Lies::of(&from.ring, blocker.spanning),
            lies => lies,
        };
        let lies = self.facets.lies(facet, number);
        let frame = &self.elements.frames[facet as usize];
        let what = (number, &blocker.ring[..], blocker.spanning);
        (!own.is_beside(lies)).then(|| Blocker::between(&from.ring, [own, lies], frame, what))
    }

    /// The facets of those wanted in boxes that may meet something, ascending.
    pub(super) fn within(&self, is_wanted: impl Fn(&u32) -> bool, may_meet: impl Fn(DVec3, DVec3) -> bool) -> Vec<u32> {
        let SceneOrder::Boxes(bvh) = &self.facets.order else { unreachable!("views of facets are taken by boxes") };
        let hierarchy = &*bvh.hierarchy;
        let mut stack: Vec<u32> = (0..hierarchy.nodes.len().min(1) as u32).collect();
        let mut numbers = Vec::new();
        while let Some(number) = stack.pop() {
            let node = &hierarchy.nodes[number as usize];
            if !may_meet(node.bounds.low, node.bounds.high) {
                continue;
            }
            match &node.content {
                Content::Boxes(halves) => stack.extend(halves),
                Content::Panels(range) => {
                    for facet in self.facets.of_panels(range.clone()) {
                        let [low, high] = self.facets.all[*facet as usize].bounds;
                        if is_wanted(facet) && may_meet(low, high) {
                            numbers.push(*facet);
                        }
                    }
                }
            }
        }
        numbers.sort_unstable();
        numbers
    }

    /// True if light from one facet meets another facet of the solid that a facet is part of before it meets that one.
    ///
    /// Light that leaves a surface of which it sees the outside, or that it is outside of, gets to an inside through an outside only.
    fn is_redundant(&self, from: u32, facet: u32) -> bool {
        let Some(solid) = self.facets.all[facet as usize].solid else { return false };
        let shown = match self.facets.lies(from, facet) {
            Lies::Front => Side::Front,
            Lies::Behind => Side::Back,
            Lies::On | Lies::Across => return false,
        };
        let from = &self.facets.all[from as usize];
        if from.solid.is_some_and(|own| own.number == solid.number) {
            return shown == Side::Back;
        }
        let placement = self.facets.placement;
        let (low, high) = (placement.local(solid.bounds.low), placement.local(solid.bounds.high));
        // Not by rounding alone: points of it may not be, then.
        let is_outside = |axis: usize| {
            from.ring.iter().all(|p| p[axis] < low[axis] - TOUCHES)
                || from.ring.iter().all(|p| p[axis] > high[axis] + TOUCHES)
        };
        shown == solid.inside && (0..3).any(is_outside)
    }
}
