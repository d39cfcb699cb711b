//! Which elements of a facet are seen wholly from an element, which not at all, and which it takes views to tell.

use super::contacts::contacts;
use super::element::{Element, Elements};
use super::facets::Facets;
use super::shaft::{Blocker, Blocks, Lies, Shaft};
use super::shape::Frame;
use super::tree::ElementTree;
use crate::bvh::Content;
use crate::contour::SceneOrder;
use crate::scene::Side;
use glam::{DVec2, DVec3};

/// Where all facets are, seen from one.
pub(super) struct Around {
    facet: u32,
    /// Each facet to the plane of this one.
    facets: Vec<Lies>,
    /// This one to the plane of each facet.
    own: Vec<Lies>,
    /// Where facets stand on this one or pass through it, in its frame.
    contacts: Vec<[DVec2; 2]>,
}

impl Around {
    pub(super) fn of(facet: u32, facets: &Facets, frame: &Frame) -> Self {
        let all = 0..facets.all.len() as u32;
        let lies = all.map(|other| (facets.lies(other, facet), facets.lies(facet, other)));
        let (lies, own): (Vec<Lies>, Vec<Lies>) = lies.unzip();
        let contacts = contacts(facet, facets, frame, &lies);
        Self { facet, facets: lies, own, contacts }
    }

    pub(super) fn facet(&self) -> u32 {
        self.facet
    }

    pub(super) fn contacts(&self) -> &[[DVec2; 2]] {
        &self.contacts
    }

    /// A facet to the plane of this one.
    pub(super) fn facet_lies(&self, other: u32) -> Lies {
        self.facets[other as usize]
    }

    /// This facet to the plane of another one.
    pub(super) fn lies(&self, other: u32) -> Lies {
        self.own[other as usize]
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

/// Finds what is between an element and those of a facet.
pub(super) struct Blockers<'a> {
    pub(super) facets: &'a Facets,
    pub(super) elements: &'a Elements,
    pub(super) trees: &'a [ElementTree],
}

/// A node of the tree, and which of the possible blockers may block the view of it.
struct Visit {
    node: u32,
    blockers: Vec<u32>,
}

impl Blockers<'_> {
    /// Calls `found` with the elements of a facet of which the front is seen, and with the facets that may be between if it takes views to tell.
    pub(super) fn classify(
        &self,
        around: &Around,
        from: &Element,
        facet: u32,
        mut found: impl FnMut(u32, Seen, &mut dyn Iterator<Item = u32>),
    ) {
        let tree = &self.trees[facet as usize];
        let frame = &self.elements.frames[facet as usize];
        let Some(root) = tree.root() else { return };
        let mut all = |node: u32, seen: Seen, blockers: &[u32], candidates: &[Blocker]| {
            for &element in tree.elements(node) {
                found(element, seen, &mut blockers.iter().map(|&blocker| candidates[blocker as usize].facet));
            }
        };
        if self.facets.all[facet as usize].is_covered {
            return all(root, Seen::Unknown, &[], &[]);
        }
        let target = &self.facets.all[facet as usize];
        let shaft = Shaft::between(&from.ring, &target.ring);
        let candidates = self.candidates(around, from, facet, &shaft);
        let mut corners = Vec::new();
        let mut visits = vec![Visit { node: root, blockers: (0..candidates.len() as u32).collect() }];
        while let Some(Visit { node, mut blockers }) = visits.pop() {
            let is_one = tree.halves(node).is_none();
            let mut is_hidden = false;
            if !blockers.is_empty() {
                tree.corners(node, frame, &self.elements.all, &mut corners);
                blockers.retain(|&blocker| {
                    is_hidden || {
                        let blocks = candidates[blocker as usize].blocks(&corners);
                        is_hidden = blocks == Blocks::Everything;
                        blocks != Blocks::Nothing
                    }
                });
            }
            // The planes of the shaft are for what it is worth: one element.
            if is_one && !is_hidden && !blockers.is_empty() && tree.elements(root).len() > 1 {
                let ring: Vec<DVec3> = corners.iter().map(|corner| corner.at).collect();
                let shaft = Shaft::between(&from.ring, &ring);
                let is_free = |&blocker: &u32| {
                    let facet = candidates[blocker as usize].facet;
                    !shaft.excludes(&self.facets.all[facet as usize].ring)
                };
                blockers.retain(is_free);
            }
            match tree.halves(node) {
                _ if is_hidden => all(node, Seen::Never, &[], &[]),
                _ if blockers.is_empty() => all(node, Seen::Wholly, &[], &[]),
                None => all(node, Seen::Partly, &blockers, &candidates),
                Some([first, second]) => {
                    visits.push(Visit { node: second, blockers: blockers.clone() });
                    visits.push(Visit { node: first, blockers });
                }
            }
        }
    }

    /// The facets that may block light between an element and a whole facet.
    fn candidates(&self, around: &Around, from: &Element, facet: u32, shaft: &Shaft) -> Vec<Blocker> {
        let frame = &self.elements.frames[facet as usize];
        let mut candidates = Vec::new();
        for number in self.within(shaft) {
            if number == around.facet
                || number == facet
                || matches!(around.facet_lies(number), Lies::Behind | Lies::On)
                || self.is_redundant(around, from, number)
            {
                continue;
            }
            let blocker = &self.facets.all[number as usize];
            let own = match around.lies(number) {
                Lies::Across => Lies::of(&from.ring, blocker.spanning),
                lies => lies,
            };
            let lies = self.facets.lies(facet, number);
            // What is behind the facet, or in its plane, hides nothing of it.
            let is_behind = matches!(self.facets.lies(number, facet), Lies::Behind | Lies::On);
            if !own.is_beside(lies) && !is_behind && !shaft.excludes(&blocker.ring) {
                let what = (number, &blocker.ring[..], blocker.spanning);
                candidates.push(Blocker::between(&from.ring, [own, lies], frame, what));
            }
        }
        candidates
    }

    /// The facets in boxes that may meet a shaft, ascending.
    fn within(&self, shaft: &Shaft) -> Vec<u32> {
        let SceneOrder::Boxes(bvh) = &self.facets.order else { unreachable!("views of facets are taken by boxes") };
        let hierarchy = &*bvh.hierarchy;
        let mut stack: Vec<u32> = (0..hierarchy.nodes.len().min(1) as u32).collect();
        let mut pieces = Vec::new();
        while let Some(number) = stack.pop() {
            let node = &hierarchy.nodes[number as usize];
            if !shaft.may_meet(node.bounds.low, node.bounds.high) {
                continue;
            }
            match &node.content {
                Content::Boxes(halves) => stack.extend(halves),
                Content::Panels(range) => {
                    for &panel in &hierarchy.order[range.start as usize..range.end as usize] {
                        hierarchy.panels.pieces(panel, &mut Vec::new(), |piece| pieces.push(piece));
                    }
                }
            }
        }
        let scene = self.facets.order.scene();
        let mut numbers: Vec<u32> = pieces.into_iter().map(|piece| scene.piece(piece).polygon().0).collect();
        numbers.sort_unstable();
        numbers.dedup();
        numbers
    }

    /// True if light from the element meets another facet of the solid that a facet is part of before it meets that one.
    ///
    /// Light that leaves a surface of which it sees the outside, or that it is outside of, gets to an inside through an outside only.
    fn is_redundant(&self, around: &Around, from: &Element, facet: u32) -> bool {
        let Some(solid) = self.facets.all[facet as usize].solid else { return false };
        let shown = match around.lies(facet) {
            Lies::Front => Side::Front,
            Lies::Behind => Side::Back,
            Lies::On | Lies::Across => return false,
        };
        let own = self.facets.all[around.facet as usize].solid;
        if own.is_some_and(|own| own.number == solid.number) {
            return shown == Side::Back;
        }
        let placement = self.facets.placement;
        let (low, high) = (placement.local(solid.bounds.low), placement.local(solid.bounds.high));
        let is_outside = |axis: usize| {
            from.ring.iter().all(|p| p[axis] < low[axis]) || from.ring.iter().all(|p| p[axis] > high[axis])
        };
        shown == solid.inside && (0..3).any(is_outside)
    }
}
