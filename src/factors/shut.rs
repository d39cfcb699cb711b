//! What solids shut: where the bottom of a block stands on a floor, in front of the floor there is the inside of the block.
//!
//! Nothing gets there but from the other one of the two, and nothing else is to count as seeing it. Solids that overlap, as an annex that reaches into a building, have walls within each other from
//! which it is seen all the same: what they see there are backs.

use super::blockers::Blockers;
use super::bodies::MOST_FACETS;
use super::contacts::{TOUCHES, take_out};
use super::facets::{Facet, Facets};
use super::shape::Frame;
use crate::bvh::Solid;
use crate::scene::Side;
use glam::{DVec2, DVec3};
use std::collections::HashMap;

/// For each facet.
#[derive(Default)]
pub(super) struct Shut {
    /// What is shut of it, in its frame, counter-clockwise.
    regions: Vec<Vec<Vec<DVec2>>>,
    /// The facets of which it may see what is shut, ascending.
    seen: Vec<Vec<u32>>,
}

impl Shut {
    /// `touching` has for each facet those that it is face to face with.
    pub(super) fn of(blockers: &Blockers<'_>, touching: &[Vec<u32>]) -> Self {
        let (facets, frames) = (blockers.facets, &blockers.elements.frames);
        let convex = ConvexSolids::of(facets, frames);
        let mut found = Self { regions: vec![Vec::new(); touching.len()], seen: vec![Vec::new(); touching.len()] };
        for (number, others) in (0..).zip(touching) {
            for &other in others.iter().filter(|&&other| shuts(facets, number, other)) {
                let frame = &frames[number as usize];
                let ring = facets.all[other as usize].ring.iter().rev().map(|&p| frame.flat(p)).collect();
                found.regions[number as usize].push(ring);
                for seer in seers(blockers, &convex, number, other) {
                    found.seen[seer as usize].push(number);
                }
            }
        }
        for facets in &mut found.seen {
            facets.sort_unstable();
            facets.dedup();
        }
        found
    }

    /// True if one of two facets may see what is shut of the other.
    pub(super) fn is_between(&self, a: u32, b: u32) -> bool {
        self.is_seen(a, b) || self.is_seen(b, a)
    }

    /// True if what is shut of a facet may be seen from another one.
    pub(super) fn is_seen(&self, from: u32, facet: u32) -> bool {
        self.seen.get(from as usize).is_some_and(|seen| seen.binary_search(&facet).is_ok())
    }

    /// The convex parts of a part of a facet that are not shut.
    pub(super) fn open(&self, facet: u32, frame: &Frame, part: &[DVec2]) -> impl Iterator<Item = Vec<DVec2>> {
        let mut open = vec![part.iter().map(|&p| frame.lift(p)).collect()];
        for region in self.regions.get(facet as usize).into_iter().flatten() {
            take_out(&mut open, frame, region, 0.0);
        }
        open.into_iter().map(|part| part.into_iter().map(|p| frame.flat(p)).collect())
    }
}

/// True if one of two facets face to face is the outside of a solid: what they have in common is shut, then.
pub(super) fn shuts(facets: &Facets, a: u32, b: u32) -> bool {
    [a, b].into_iter().any(|facet| within(&facets.all[facet as usize]).is_some())
}

/// The solid that a facet is the outside of.
fn within(facet: &Facet) -> Option<Solid> {
    facet.solid.filter(|solid| solid.inside == Side::Back)
}

/// The facets that may see what another one shuts of a facet: what is in the other one's solid, if it is the outside of one, else all that is in front.
fn seers(blockers: &Blockers<'_>, convex: &ConvexSolids, facet: u32, other: u32) -> Vec<u32> {
    let (facets, frames) = (blockers.facets, &blockers.elements.frames);
    let Some(solid) = within(&facets.all[other as usize]) else {
        let frame = &frames[facet as usize];
        let is_other = |&seer: &u32| seer != other && seer != facet;
        return blockers.within(is_other, |low, high| {
            let farthest = DVec3::select(frame.normal.cmpgt(DVec3::ZERO), high, low);
            frame.height(farthest) > TOUCHES
        });
    };
    let (low, high) = (facets.placement.local(solid.bounds.low), facets.placement.local(solid.bounds.high));
    let is_in = |seer: u32| {
        let Facet { ring, solid: own, .. } = &facets.all[seer as usize];
        let is_before = |&side: &u32| ring.iter().all(|&p| frames[side as usize].height(p) >= -TOUCHES);
        own.is_none_or(|own| own.number != solid.number) && !convex.facets(solid).iter().any(is_before)
    };
    // What touches it is not in it.
    let may_meet = |from: DVec3, to: DVec3| (from + TOUCHES).cmplt(high).all() && (to - TOUCHES).cmpgt(low).all();
    blockers.within(|&seer| is_in(seer), may_meet)
}

/// Solids that are convex, of few facets.
struct ConvexSolids(HashMap<u32, Vec<u32>>);

impl ConvexSolids {
    fn of(facets: &Facets, frames: &[Frame]) -> Self {
        let mut all: HashMap<u32, Vec<u32>> = HashMap::new();
        for (number, facet) in (0..).zip(&facets.all) {
            if let Some(solid) = within(facet) {
                all.entry(solid.number).or_default().push(number);
            }
        }
        all.retain(|_, solid| {
            let is_behind =
                |a: u32, b: u32| facets.all[a as usize].ring.iter().all(|&p| frames[b as usize].height(p) <= TOUCHES);
            solid.len() <= MOST_FACETS && solid.iter().all(|&a| solid.iter().all(|&b| is_behind(a, b)))
        });
        Self(all)
    }

    /// Its facets, if it is one.
    fn facets(&self, solid: Solid) -> &[u32] {
        self.0.get(&solid.number).map_or(&[], |facets| facets)
    }
}
