//! What solids shut: where the bottom of a block stands on a floor, in front of the floor there is the inside of the block.
//!
//! Nothing gets there but from the other one of the two, and nothing else is to count as seeing it. Solids that overlap, as an annex that reaches into a building, have walls within each other from
//! which it is seen all the same: what they see there are backs.

use super::ExchangeError;
use super::blockers::Blockers;
use super::bodies::MOST_FACETS;
use super::contacts::{TOUCHES, take_out};
use super::element::Element;
use super::facets::{Facet, Facets};
use super::seen::{Before, LookSpace, Looker};
use super::shape::Frame;
use super::touching::{apart, in_both, middle, strip, within};
use crate::bvh::Solid;
use crate::parallel;
use crate::scene::Side;
use glam::{DVec2, DVec3};
use std::collections::HashMap;

/// For each facet.
#[derive(Default)]
pub(super) struct Shut {
    /// What is shut of it, in its frame, counter-clockwise, and by which other one; all of what the two have in common is in one ring, that of the other one.
    regions: Vec<Vec<Region>>,
    /// The facets of which it may see what is shut, ascending.
    seen: Vec<Vec<u32>>,
    /// For each element whether all of it is shut.
    whole: Vec<bool>,
}

#[derive(Clone)]
struct Region {
    by: u32,
    ring: Vec<DVec2>,
    /// True if the ring is that of the other facet.
    is_whole: bool,
}

impl Shut {
    /// `touching` has for each facet those that it is face to face with.
    ///
    /// In front of what stands face to face with the outside of a solid there is the inside of that, but there may be something else in it, such as a room of a building. So a part of the two is shut if, from its middle, one of them sees
    /// a back of the other one's solid, or nothing that would be open.
    pub(super) fn of(
        blockers: &Blockers<'_>,
        looker: &Looker<'_>,
        touching: &[Vec<u32>],
    ) -> Result<Self, ExchangeError> {
        let (facets, frames) = (blockers.facets, &blockers.elements.frames);
        let pairs = pairs(touching).filter(|&[a, b]| shuts(facets, a, b)).collect();
        let shut = parallel::map(pairs, |pair: [u32; 2]| {
            shut_parts(blockers, looker, touching, pair).map(|(parts, is_all)| (pair, parts, is_all))
        });
        let convex = ConvexSolids::of(facets, frames);
        let (regions, seen) = (vec![Vec::new(); touching.len()], vec![Vec::new(); touching.len()]);
        let mut found = Self { regions, seen, whole: Vec::new() };
        for shut in shut {
            let ([a, b], parts, is_whole) = shut?;
            if parts.is_empty() {
                continue;
            }
            for [own, by] in [[a, b], [b, a]] {
                let frame = &frames[own as usize];
                let flat = |ring: &[DVec3]| -> Vec<DVec2> { ring.iter().map(|&p| frame.flat(p)).collect() };
                let reversed = |mut ring: Vec<DVec2>| {
                    ring.reverse();
                    ring
                };
                let rings = if is_whole {
                    vec![reversed(flat(&facets.all[by as usize].ring))]
                } else {
                    parts.iter().map(|part| if own == a { flat(part) } else { reversed(flat(part)) }).collect()
                };
                found.regions[own as usize].extend(rings.into_iter().map(|ring| Region { by, ring, is_whole }));
                for seer in seers(blockers, &convex, own, by) {
                    found.seen[seer as usize].push(own);
                }
            }
        }
        for facets in &mut found.seen {
            facets.sort_unstable();
            facets.dedup();
        }
        let is_whole = |element: &Element| {
            let mut parts = vec![element.ring.clone()];
            for region in &found.regions[element.facet as usize] {
                take_out(&mut parts, &frames[element.facet as usize], &region.ring, strip(element));
            }
            parts.is_empty()
        };
        found.whole = blockers.elements.all.iter().map(is_whole).collect();
        Ok(found)
    }

    /// True if all of an element is shut: nothing sees it but what shuts it.
    pub(super) fn is_whole(&self, element: u32) -> bool {
        self.whole.get(element as usize).is_some_and(|&is_whole| is_whole)
    }

    /// The parts of what two elements of these facets have in common that are shut, and whether it is all; as it is in the frame of the first of the facets.
    pub(super) fn parts(&self, [own, by]: [u32; 2], frame: &Frame, common: Vec<DVec3>) -> (Vec<Vec<DVec3>>, bool) {
        let flat: Vec<DVec2> = common.iter().map(|&p| frame.flat(p)).collect();
        let mut parts = Vec::new();
        for region in self.regions[own as usize].iter().filter(|region| region.by == by) {
            if region.is_whole {
                return (vec![common], true);
            }
            let part = within(flat.clone(), &region.ring);
            if part.len() >= 3 {
                parts.push(part.into_iter().map(|p| frame.lift(p)).collect());
            }
        }
        (parts, false)
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
            take_out(&mut open, frame, &region.ring, 0.0);
        }
        open.into_iter().map(|part| part.into_iter().map(|p| frame.flat(p)).collect())
    }
}

/// True if one of two facets face to face is the outside of a solid: what of them is shut is known of facets as a whole, then.
pub(super) fn shuts(facets: &Facets, a: u32, b: u32) -> bool {
    [a, b].into_iter().any(|facet| solid_within(&facets.all[facet as usize]).is_some())
}

/// The parts of what two facets have in common that are shut, and whether it is all.
fn shut_parts(
    blockers: &Blockers<'_>,
    looker: &Looker<'_>,
    touching: &[Vec<u32>],
    pair: [u32; 2],
) -> Result<(Vec<Vec<DVec3>>, bool), ExchangeError> {
    let [facet, other] = pair.map(|number| &blockers.facets.all[number as usize]);
    let parts = common_parts(blockers, pair);
    let count = parts.len();
    let (mut shut, mut space) = (Vec::new(), LookSpace::default());
    for part in parts {
        let middle = middle(&part);
        let mut is_shut = |from: u32, by: &Facet| match solid_within(by) {
            Some(solid) => looker.before(&mut space, from, middle, touching, Some(solid.number)).map(Before::is_shut),
            None => Ok(false),
        };
        if is_shut(pair[0], other)? || is_shut(pair[1], facet)? {
            shut.push(part);
        }
    }
    let is_all = count > 0 && shut.len() == count;
    Ok((shut, is_all))
}

/// What two facets have in common, in parts between the lines where others stand on either of them.
fn common_parts(blockers: &Blockers<'_>, pair: [u32; 2]) -> Vec<Vec<DVec3>> {
    let [facet, other] = pair.map(|number| &blockers.facets.all[number as usize]);
    let frames = pair.map(|number| &blockers.elements.frames[number as usize]);
    let flat: Vec<DVec2> = facet.ring.iter().map(|&p| frames[0].flat(p)).collect();
    let common = in_both((&flat, frames[0]), (&other.ring, frames[1]));
    common.map_or_else(Vec::new, |common| apart(blockers, pair, common))
}

/// Pairs of facets face to face, none of them the outside of a solid, of which it is not clear whether they shut each other off: from the middle of what they have in common, or of a part of it, backs are seen as well as
/// what is no back.
pub(super) fn half_shut(
    blockers: &Blockers<'_>,
    looker: &Looker<'_>,
    touching: &[Vec<u32>],
) -> Result<Vec<[u32; 2]>, ExchangeError> {
    let pairs = pairs(touching).filter(|&[a, b]| !shuts(blockers.facets, a, b)).collect();
    let found = parallel::map(pairs, |pair: [u32; 2]| {
        let mut space = LookSpace::default();
        for part in common_parts(blockers, pair) {
            let mut before = |from: u32| looker.before(&mut space, from, middle(&part), touching, None);
            let [one, other] = [before(pair[0])?, before(pair[1])?];
            if !one.is_shut() && !other.is_shut() && (one.is_mixed() || other.is_mixed()) {
                return Ok(Some(pair));
            }
        }
        Ok(None)
    });
    found.into_iter().filter_map(Result::transpose).collect()
}

/// Those that are face to face with each other, each pair once.
fn pairs(touching: &[Vec<u32>]) -> impl Iterator<Item = [u32; 2]> {
    (0..).zip(touching).flat_map(|(a, others)| others.iter().filter(move |&&b| a < b).map(move |&b| [a, b]))
}

/// The solid that a facet is the outside of.
fn solid_within(facet: &Facet) -> Option<Solid> {
    facet.solid.filter(|solid| solid.inside == Side::Back)
}

/// The facets that may see what another one shuts of a facet: what is in the other one's solid, if it is the outside of one, else all that is in front.
fn seers(blockers: &Blockers<'_>, convex: &ConvexSolids, facet: u32, other: u32) -> Vec<u32> {
    let (facets, frames) = (blockers.facets, &blockers.elements.frames);
    let Some(solid) = solid_within(&facets.all[other as usize]) else {
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
            if let Some(solid) = solid_within(facet) {
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
