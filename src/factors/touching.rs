//! Elements face to face: the floor below a block, and the bottom of the block.
//!
//! What leaves one arrives at the other, and nothing else gets there. Views do not tell so: of two polygons in one plane neither is in front of the other, and where rounding has
//! moved one of them a point on it may be on either side of the other. (Whether it is seen from outside is not asked here: that is decided exactly.) Two coincident faces of a thin wall are in
//! one plane as well, but both see the rooms that they face: a floor below a block sees nothing but the block's inside.

use super::ExchangeError;
use super::Sides;
use super::contacts::TOUCHES;
use super::element::{Element, Elements};
use super::element_row::ElementRows;
use super::facets::Facets;
use super::footprints::near_pairs;
use super::row::Share;
use super::seen::{LookSpace, SHUT};
use super::shape::{Frame, clip, sides, turn};
use glam::{DVec2, DVec3};

/// What an element has of another one that it is face to face with.
pub(super) struct Touch {
    pub(super) other: u32,
    /// `A_i` `F_ij`.
    pub(super) exchange: Share,
    /// The other one in the frame of this one, counter-clockwise.
    pub(super) ring: Vec<DVec2>,
}

/// For each facet those that face it in its plane, or as near to it as rounding leaves them, ascending.
pub(super) fn touching_facets(facets: &Facets, frames: &[Frame]) -> Vec<Vec<u32>> {
    let boxes: Vec<[DVec3; 2]> = facets.all.iter().map(|facet| facet.bounds).collect();
    let mut found = vec![Vec::new(); boxes.len()];
    let is_near = |a: usize, b: usize| facets.all[a].ring.iter().all(|&p| frames[b].height(p).abs() <= TOUCHES);
    near_pairs(&boxes, TOUCHES, |a, b| {
        if frames[a].normal.dot(frames[b].normal) < 0.0 && (is_near(a, b) || is_near(b, a)) {
            found[a].push(b as u32);
            found[b].push(a as u32);
        }
    });
    for facets in &mut found {
        facets.sort_unstable();
    }
    found
}

/// An area that is no more than a strip as narrow as what is between such facets.
pub(super) fn strip(element: &Element) -> f64 {
    2.0 * element.radius * TOUCHES
}

impl ElementRows<'_> {
    /// The elements that an element is face to face with, and shut off by from all else.
    pub(super) fn touching(&self, number: u32, space: &mut LookSpace) -> Result<Vec<Touch>, ExchangeError> {
        let elements = self.blockers.elements;
        let from = &elements.all[number as usize];
        let frame = &elements.frames[from.facet as usize];
        let mut found = Vec::new();
        // Backs get what arrives at them, then.
        if self.looker.sides == Sides::Both {
            return Ok(found);
        }
        for &facet in &self.touching[from.facet as usize] {
            for &other in &elements.of_facet[facet as usize] {
                let [i, j] = [number.min(other), number.max(other)];
                let Some((exchange, middle)) = common(elements, i, j) else { continue };
                if self.is_shut(i, middle, space)? || self.is_shut(j, middle, space)? {
                    let ring = elements.all[other as usize].ring.iter().rev().map(|&p| frame.flat(p)).collect();
                    found.push(Touch { other, exchange, ring });
                }
            }
        }
        Ok(found)
    }

    fn is_shut(&self, element: u32, at: DVec3, space: &mut LookSpace) -> Result<bool, ExchangeError> {
        let facet = self.blockers.elements.all[element as usize].facet;
        self.looker.is_shut(space, facet, at, self.touching)
    }
}

/// What two elements face to face have in common, and its middle; `None` if that is not more than a strip.
fn common(elements: &Elements, i: u32, j: u32) -> Option<(Share, DVec3)> {
    let [i, j] = [i, j].map(|number| &elements.all[number as usize]);
    let [frame, other] = [i, j].map(|element| &elements.frames[element.facet as usize]);
    let ring: Vec<DVec2> = j.ring.iter().rev().map(|&p| frame.flat(p)).collect();
    let [low, high] = ring.iter().fold([ring[0]; 2], |[low, high], &p| [low.min(p), high.max(p)]);
    if low.cmpge(i.high).any() || high.cmple(i.low).any() {
        return None;
    }
    let (mut part, mut cut) = (i.flat.clone(), Vec::new());
    for [a, b] in sides(&ring) {
        clip(&part, |p| turn(a, b, p), &mut cut);
        std::mem::swap(&mut part, &mut cut);
    }
    let first = *part.first()?;
    let area = 0.5 * sides(&part).map(|[a, b]| turn(first, a, b)).sum::<f64>();
    if area <= strip(i).min(strip(j)) {
        return None;
    }
    let middle = frame.lift(part.iter().sum::<DVec2>() / part.len() as f64);
    // At the rim light leaves as if the gap were half as wide all along, and through what is not shut.
    let gap = part.iter().fold(0.0, |gap: f64, &p| gap.max(other.height(frame.lift(p)).abs()));
    let rim: f64 = sides(&part).map(|[a, b]| a.distance(b)).sum();
    Some((Share { factor: area, error: gap * rim + SHUT * area }, middle))
}
