//! Elements face to face: the floor below a block, and the bottom of the block.
//!
//! What leaves one arrives at the other, and nothing else gets there. Views do not tell so: of two polygons in one plane neither is in front of the other, and where rounding has
//! moved one of them a point on it may be on either side of the other. (Whether it is seen from outside is not asked here: that is decided exactly.) Two coincident faces of a thin wall are in
//! one plane as well, but both see the rooms that they face: a floor below a block sees nothing but the block's inside.

use super::ExchangeError;
use super::Sides;
use super::blockers::Blockers;
use super::contacts::{TOUCHES, cut, take_out};
use super::element::{Element, Elements};
use super::element_row::ElementRows;
use super::facets::Facets;
use super::footprints::near_pairs;
use super::lies::Lies;
use super::row::Share;
use super::seen::{Before, LookSpace, SHUT};
use super::shape::{Frame, clip, double_area, sides, turn};
use super::shut::{Shut, shuts};
use crate::scene::PolygonId;
use glam::{DVec2, DVec3};

/// What an element has of another one that it is face to face with.
pub(super) struct Touch {
    pub(super) other: u32,
    /// `A_i` `F_ij`.
    pub(super) exchange: Share,
    /// What is shut by it, in convex parts that run as this one does.
    rings: Vec<Vec<DVec3>>,
}

impl Touch {
    /// Takes what is shut out of convex parts of the element; areas up to that of a strip are nothing.
    pub(super) fn take_out(&self, parts: &mut Vec<Vec<DVec3>>, element: &Element, frame: &Frame) {
        for ring in &self.rings {
            let ring: Vec<DVec2> = ring.iter().map(|&p| frame.flat(p)).collect();
            take_out(parts, frame, &ring, strip(element));
        }
    }
}

/// For each facet those that face it in its plane, or as near to it as rounding leaves them, ascending.
pub(super) fn touching_facets(facets: &Facets, frames: &[Frame]) -> Vec<Vec<u32>> {
    let mut found = vec![Vec::new(); frames.len()];
    in_one_plane(facets, frames, |a, b| {
        if frames[a].normal.dot(frames[b].normal) < 0.0 {
            found[a].push(b as u32);
            found[b].push(a as u32);
        }
    });
    for facets in &mut found {
        facets.sort_unstable();
    }
    found
}

/// Two polygons that show the same way and lie on each other, but not in one plane exactly: the first such pair of what is not all shut.
pub(super) fn overlap(facets: &Facets, elements: &Elements, shut: &Shut) -> Option<[PolygonId; 2]> {
    let mut first = None;
    let is_open = |facet: usize| {
        let frame = &elements.frames[facet];
        let flat: Vec<DVec2> = facets.all[facet].ring.iter().map(|&p| frame.flat(p)).collect();
        shut.open(facet as u32, frame, &flat).next().is_some()
    };
    in_one_plane(facets, &elements.frames, |a, b| {
        let lies = facets.lies(a as u32, b as u32);
        if elements.frames[a].normal.dot(elements.frames[b].normal) > 0.0
            && lies != Lies::On
            && is_open(a)
            && is_open(b)
        {
            first = [first, on_each_other(elements, [a, b])].into_iter().flatten().min();
        }
    });
    first
}

/// The first two polygons of two facets in one plane that lie on each other.
pub(super) fn on_each_other(elements: &Elements, [a, b]: [usize; 2]) -> Option<[PolygonId; 2]> {
    let pairs = elements.of_facet[a].iter().flat_map(|&i| elements.of_facet[b].iter().map(move |&j| (i, j)));
    let polygon = |k: u32| elements.patches[elements.all[k as usize].patch as usize].polygon;
    let on_each_other = pairs.filter(|&(i, j)| common(elements, i, j).is_some());
    on_each_other.map(|(i, j)| [polygon(i).min(polygon(j)), polygon(i).max(polygon(j))]).min()
}

/// Calls `found` with all pairs of facets that are in one plane and near each other, or as near to it as rounding leaves them.
fn in_one_plane(facets: &Facets, frames: &[Frame], mut found: impl FnMut(usize, usize)) {
    let boxes: Vec<[DVec3; 2]> = facets.all.iter().map(|facet| facet.bounds).collect();
    let is_near = |a: usize, b: usize| facets.all[a].ring.iter().all(|&p| frames[b].height(p).abs() <= TOUCHES);
    near_pairs(&boxes, TOUCHES, |a, b| {
        if is_near(a, b) || is_near(b, a) {
            found(a, b);
        }
    });
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
        let mut found = Vec::new();
        // Backs get what arrives at them, then.
        if self.looker.sides == Sides::Both {
            return Ok(found);
        }
        for &facet in &self.touching[from.facet as usize] {
            for &other in &elements.of_facet[facet as usize] {
                let [i, j] = [number.min(other), number.max(other)];
                let Some(whole) = common(elements, i, j) else { continue };
                let (parts, is_all) = self.shut_parts(i, j, whole, space)?;
                if parts.is_empty() {
                    continue;
                }
                let mut touch = Touch { other, exchange: Share::default(), rings: Vec::new() };
                for part in parts {
                    let Share { factor, error } = exchange(elements, j, &part);
                    touch.exchange.factor += factor;
                    touch.exchange.error += error;
                    touch.rings.push(if number == i { part } else { part.into_iter().rev().collect() });
                }
                if is_all {
                    // As it is, without corners of rounding.
                    touch.rings = vec![elements.all[other as usize].ring.iter().rev().copied().collect()];
                }
                found.push(touch);
            }
        }
        Ok(found)
    }

    /// The parts that are shut of what two elements have in common, and whether that is all of it.
    fn shut_parts(
        &self,
        i: u32,
        j: u32,
        whole: Vec<DVec3>,
        space: &mut LookSpace,
    ) -> Result<(Vec<Vec<DVec3>>, bool), ExchangeError> {
        let elements = self.blockers.elements;
        let facets = [i, j].map(|number| elements.all[number as usize].facet);
        let [own, other] = facets;
        if shuts(self.blockers.facets, own, other) {
            return Ok(self.looker.shut.parts(facets, &elements.frames[own as usize], whole));
        }
        let parts = apart(&self.blockers, facets, whole);
        let count = parts.len();
        let mut shut = Vec::new();
        for part in parts {
            let middle = middle(&part);
            let mut is_shut =
                |facet: u32| self.looker.before(space, facet, middle, self.touching, None).map(Before::is_shut);
            if is_shut(own)? || is_shut(other)? {
                shut.push(part);
            }
        }
        let is_all = shut.len() == count;
        Ok((shut, is_all))
    }
}

pub(super) fn middle(part: &[DVec3]) -> DVec3 {
    part.iter().sum::<DVec3>() / part.len() as f64
}

/// What two facets have in common, in parts between the lines where others stand on either of them: each is shut as a whole, or not at all.
pub(super) fn apart(blockers: &Blockers<'_>, facets: [u32; 2], common: Vec<DVec3>) -> Vec<Vec<DVec3>> {
    let [frame, other] = facets.map(|facet| &blockers.elements.frames[facet as usize]);
    let [mut contacts, of_other] = facets.map(|facet| blockers.contacts(facet, &common, TOUCHES));
    contacts.extend(of_other.into_iter().map(|segment| segment.map(|p| frame.flat(other.lift(p)))));
    let flat: Vec<DVec2> = common.iter().map(|&p| frame.flat(p)).collect();
    let size = common.iter().map(|p| p.distance(common[0])).fold(0.0, f64::max);
    let parts = cut(&flat, size, &contacts);
    if parts.len() == 1 {
        return vec![common];
    }
    let mut parts: Vec<Vec<DVec3>> =
        parts.into_iter().map(|part| part.into_iter().map(|p| frame.lift(p)).collect()).collect();
    for part in &mut parts {
        // Sides of rounding have no direction.
        part.dedup_by(|a, b| a.distance(*b) <= TOUCHES);
        if part.len() > 1 && part[0].distance(part[part.len() - 1]) <= TOUCHES {
            part.pop();
        }
    }
    parts.retain(|part| part.len() >= 3);
    parts
}

/// What two elements in one plane have in common, as the first of them runs; `None` if that is not more than a strip.
fn common(elements: &Elements, i: u32, j: u32) -> Option<Vec<DVec3>> {
    let [i, j] = [i, j].map(|number| &elements.all[number as usize]);
    let [frame, other] = [i, j].map(|element| &elements.frames[element.facet as usize]);
    let part = in_both((&i.flat, frame), (&j.ring, other))?;
    (0.5 * double_area(&part).length() > strip(i).min(strip(j))).then_some(part)
}

/// What two convex polygons in one plane have in common, as the first of them runs, of which corners are in its frame.
pub(super) fn in_both((own, frame): (&[DVec2], &Frame), (ring, other): (&[DVec3], &Frame)) -> Option<Vec<DVec3>> {
    let mut ring: Vec<DVec2> = ring.iter().map(|&p| frame.flat(p)).collect();
    if frame.normal.dot(other.normal) < 0.0 {
        ring.reverse();
    }
    let extent = |ring: &[DVec2]| ring.iter().fold([ring[0]; 2], |[low, high], &p| [low.min(p), high.max(p)]);
    let ([low, high], [own_low, own_high]) = (extent(&ring), extent(own));
    if low.cmpge(own_high).any() || high.cmple(own_low).any() {
        return None;
    }
    let part = within(own.to_vec(), &ring);
    (part.len() >= 3).then(|| part.into_iter().map(|p| frame.lift(p)).collect())
}

/// A convex polygon cut to another one.
pub(super) fn within(mut part: Vec<DVec2>, ring: &[DVec2]) -> Vec<DVec2> {
    let mut cut = Vec::new();
    for [a, b] in sides(ring) {
        clip(&part, |p| turn(a, b, p), &mut cut);
        std::mem::swap(&mut part, &mut cut);
    }
    part
}

/// What two elements exchange over a part that they have in common.
fn exchange(elements: &Elements, other: u32, part: &[DVec3]) -> Share {
    let other = &elements.frames[elements.all[other as usize].facet as usize];
    let area = 0.5 * double_area(part).length();
    // At the rim light leaves as if the gap were half as wide all along, and through what is not shut.
    let gap = part.iter().fold(0.0, |gap: f64, &p| gap.max(other.height(p).abs()));
    let rim: f64 = sides(part).map(|[a, b]| a.distance(b)).sum();
    Share { factor: area, error: gap * rim + SHUT * area }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::factors::{Exchange, ExchangeOptions, PatchPlan};
    use crate::scene::{Material, Scene};
    use glam::DMat3;

    #[test]
    fn polygons_that_rounding_has_moved_out_of_one_plane_are_named() {
        let found = |turn: DMat3, second: [[f64; 3]; 3]| {
            let first = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 3.0, 0.0]];
            let corners: Vec<[f64; 3]> =
                first.iter().chain(&second).map(|&p| (turn * DVec3::from(p)).to_array()).collect();
            let faces = [vec![0, 1, 2], vec![3, 4, 5]];
            let scene = Scene::builder().mesh(&corners, &faces, Material::new("grey")).build().expect("a scene");
            let exchange = Exchange::new(&scene, PatchPlan::Polygons, ExchangeOptions::default()).expect("patches");
            overlap(&exchange.facets, &exchange.elements, &exchange.shut)
        };
        let turn = DMat3::from_rotation_x(0.7) * DMat3::from_rotation_z(0.3);
        let over = [[0.3, 0.2, 0.0], [1.7, 0.4, 0.0], [0.6, 1.9, 0.0]];
        assert_eq!(found(turn, over), Some([PolygonId(0), PolygonId(1)]));
        // In one plane exactly numbers decide; beside each other, and shown the other way, nothing has to be decided; and 1e-6 is no rounding.
        assert_eq!(found(DMat3::IDENTITY, over), None);
        assert_eq!(found(turn, [over[0], over[2], over[1]]), None);
        assert_eq!(found(turn, over.map(|[x, y, z]| [x + 4.0, y, z])), None);
        assert_eq!(found(turn, over.map(|[x, y, z]| [x, y, z + 1e-6])), None);
    }
}
