//! Which elements of a facet are seen wholly from an element, which not at all, and which it takes views to tell.

use super::element::{Element, Elements};
use super::facets::Facets;
use super::shaft::{Blocks, Lies, Shaft, across};
use super::tree::ElementTree;
use crate::bvh::Content;
use crate::contour::SceneOrder;
use crate::scene::Side;
use glam::DVec3;

/// Where all facets are, seen from one.
pub(super) struct Around {
    facet: u32,
    /// Each facet to the plane of this one.
    facets: Vec<Lies>,
    /// This one to the plane of each facet.
    own: Vec<Lies>,
}

impl Around {
    pub(super) fn of(facet: u32, facets: &Facets) -> Self {
        let this = &facets.facets[facet as usize];
        let lies = |other: u32| {
            let other = &facets.facets[other as usize];
            (Lies::of(&other.ring, this.spanning), Lies::of(&this.ring, other.spanning))
        };
        let (facets, own) = (0..facets.facets.len() as u32).map(lies).unzip();
        Self { facet, facets, own }
    }

    pub(super) fn facet(&self) -> u32 {
        self.facet
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
    /// It takes views to tell.
    Partly,
}

/// Finds what is between an element and those of a facet.
pub(super) struct Blockers<'a> {
    pub(super) facets: &'a Facets,
    pub(super) elements: &'a Elements,
    pub(super) trees: &'a [ElementTree],
}

/// A node of the tree and what may block the view of it.
struct Visit {
    node: u32,
    blockers: Vec<(u32, Lies)>,
}

impl Blockers<'_> {
    /// Calls `found` with the elements of a facet, which lies in front of the element's plane at least in part, and has it in front in part.
    pub(super) fn classify(&self, around: &Around, from: &Element, facet: u32, mut found: impl FnMut(u32, Seen)) {
        let tree = &self.trees[facet as usize];
        let frame = &self.elements.frames[facet as usize];
        let Some(root) = tree.root() else { return };
        let all = |found: &mut dyn FnMut(u32, Seen), node: u32, seen: Seen| {
            tree.elements(node).iter().for_each(|&element| found(element, seen));
        };
        if self.facets.facets[facet as usize].is_covered {
            return all(&mut found, root, Seen::Partly);
        }
        let mut ring = Vec::new();
        let mut visits = vec![Visit { node: root, blockers: self.candidates(around, from, facet) }];
        while let Some(Visit { node, mut blockers }) = visits.pop() {
            if blockers.is_empty() {
                all(&mut found, node, Seen::Wholly);
                continue;
            }
            tree.ring(node, frame, &self.elements.elements, &mut ring);
            let mut shaft = None;
            let mut is_hidden = false;
            blockers.retain(|&(blocker, lies)| {
                let blocks = !is_hidden && {
                    match self.between(around, from, (&ring, lies), blocker) {
                        Blocks::Nothing => false,
                        Blocks::Everything => {
                            is_hidden = true;
                            true
                        }
                        Blocks::Unknown => {
                            let shaft = shaft.get_or_insert_with(|| Shaft::between(&from.ring, &ring));
                            !shaft.excludes(&self.facets.facets[blocker as usize].ring)
                        }
                    }
                };
                blocks || is_hidden
            });
            if is_hidden {
                all(&mut found, node, Seen::Never);
                continue;
            }
            match tree.halves(node) {
                _ if blockers.is_empty() => all(&mut found, node, Seen::Wholly),
                None => all(&mut found, node, Seen::Partly),
                Some([first, second]) => {
                    visits.push(Visit { node: second, blockers: blockers.clone() });
                    visits.push(Visit { node: first, blockers });
                }
            }
        }
    }

    /// The facets that may block light between an element and a whole facet, and how that facet lies to their planes.
    fn candidates(&self, around: &Around, from: &Element, facet: u32) -> Vec<(u32, Lies)> {
        let target = &self.facets.facets[facet as usize];
        let SceneOrder::Boxes(bvh) = &self.facets.order else { unreachable!("views of facets are taken by boxes") };
        let hierarchy = &*bvh.hierarchy;
        let shaft = Shaft::between(&from.ring, &target.ring);
        let mut candidates = Vec::new();
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
                        hierarchy.panels.pieces(panel, &mut pieces);
                    }
                }
            }
        }
        let scene = self.facets.order.scene();
        let mut numbers: Vec<u32> = pieces.into_iter().map(|piece| scene.piece(piece).polygon().0).collect();
        numbers.sort_unstable();
        numbers.dedup();
        for number in numbers {
            if number == around.facet || number == facet || matches!(around.facet_lies(number), Lies::Behind | Lies::On)
            {
                continue;
            }
            let blocker = &self.facets.facets[number as usize];
            let lies = Lies::of(&target.ring, blocker.spanning);
            if self.is_redundant(around, from, number) {
                continue;
            }
            let is_beside = around.lies(number).is_beside(lies);
            // What is behind the facet, or in its plane, hides nothing of it.
            let is_behind = || matches!(Lies::of(&blocker.ring, target.spanning), Lies::Behind | Lies::On);
            if !is_beside && !is_behind() && !shaft.excludes(&blocker.ring) {
                candidates.push((number, lies));
            }
        }
        candidates
    }

    /// True if light from the element meets another facet of the solid that a facet is part of before it meets that one.
    ///
    /// Light that leaves a surface of which it sees the outside, or that it is outside of, gets to an inside through an outside only.
    fn is_redundant(&self, around: &Around, from: &Element, facet: u32) -> bool {
        let Some(solid) = self.facets.facets[facet as usize].solid else { return false };
        let shown = match around.lies(facet) {
            Lies::Front => Side::Front,
            Lies::Behind => Side::Back,
            Lies::On | Lies::Across => return false,
        };
        let own = self.facets.facets[around.facet as usize].solid;
        if own.is_some_and(|own| own.number == solid.number) {
            return shown == Side::Back;
        }
        let scale = self.facets.scale;
        let (low, high) = (solid.bounds.low * scale, solid.bounds.high * scale);
        let is_outside = |axis: usize| {
            from.ring.iter().all(|p| p[axis] < low[axis]) || from.ring.iter().all(|p| p[axis] > high[axis])
        };
        shown == solid.inside && (0..3).any(is_outside)
    }

    /// What a facet does between an element and a ring, of which it is known how all of its facet lies to the plane of the blocker.
    fn between(&self, around: &Around, from: &Element, (ring, lies): (&[DVec3], Lies), blocker: u32) -> Blocks {
        let blocking = &self.facets.facets[blocker as usize];
        let own = match around.lies(blocker) {
            Lies::Across => Lies::of(&from.ring, blocking.spanning),
            lies => lies,
        };
        let other = match lies {
            Lies::Across => Lies::of(ring, blocking.spanning),
            lies => lies,
        };
        match (own, other) {
            (own, other) if own.is_beside(other) => Blocks::Nothing,
            (Lies::Front, Lies::Behind) => across(&from.ring, ring, &blocking.ring),
            (Lies::Behind, Lies::Front) => across(ring, &from.ring, &blocking.ring),
            _ => Blocks::Unknown,
        }
    }
}
