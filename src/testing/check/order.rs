//! Front to back: no fragment hides an earlier one anywhere, proved for all directions.
//!
//! For two fragments with heights h > 0 of the eye over their planes (normals N turned so), depth along d is
//! h / -(N . d): the second is strictly in front of the first where (h1 N2 - h2 N1) . d < 0. That is linear in d, so
//! it holds somewhere inside of both cones if their intersection has an inside and a corner where it holds.

use super::Defect;
use crate::bsp::{FragmentRef, SceneBsp};
use crate::scene::{PieceId, PolygonId, Side};
use crate::testing::integers::{Unit, Vector, cross, dot, is_zero, minus, plus, resolved, sign, times};
use glam::DVec3;
use num_bigint::BigInt;
use num_traits::Signed;
use std::collections::HashSet;

/// Checks that back to front is the exact mirror of front to back.
///
/// # Errors
/// The first place where it is not.
pub fn check_mirror(bsp: &SceneBsp, eye: DVec3) -> Result<(), Defect> {
    let front: Vec<_> = bsp.front_to_back(eye).map(FragmentRef::id).collect();
    let mut back: Vec<_> = bsp.back_to_front(eye).map(FragmentRef::id).collect();
    back.reverse();
    if front == back {
        return Ok(());
    }
    let place = front.iter().zip(&back).take_while(|(a, b)| a == b).count();
    Err(Defect::Mirror { place })
}

/// Checks that no fragment hides an earlier one of [`SceneBsp::front_to_back`], in any direction at all; of fragments in
/// one plane, that one that shows its front comes before one that shows its back, then the lower
/// polygon (then piece) id. Only pieces among [`SceneBsp::uncut_slivers`] are excused: none if
/// epsilon is 0. All pairs of fragments, in exact integers.
///
/// # Errors
/// The first pair in the wrong order.
pub fn check_order(bsp: &SceneBsp, eye: DVec3) -> Result<(), Defect> {
    let slivers: HashSet<PieceId> = bsp.uncut_slivers().iter().map(|sliver| sliver.piece).collect();
    let unit = Unit::of(bsp.scene().vertices().iter().copied().chain([eye]));
    let exact_eye = unit.vector(eye);
    let cones: Vec<Cone<'_>> =
        bsp.front_to_back(eye).filter_map(|fragment| Cone::of(unit, &exact_eye, fragment)).collect();
    for (k, later) in cones.iter().enumerate() {
        for earlier in &cones[..k] {
            let excused = [earlier, later].iter().any(|cone| slivers.contains(&cone.fragment.piece()));
            if !excused && later.hides(earlier) {
                return Err(Defect::Order { earlier: earlier.fragment.id(), later: later.fragment.id() });
            }
        }
    }
    Ok(())
}

/// A fragment as it is seen.
struct Cone<'a> {
    fragment: FragmentRef<'a>,
    side: Side,
    /// Its plane's normal, turned towards the eye, and the eye's height over it.
    normal: Vector,
    height: BigInt,
    corners: Vec<Vector>,
    /// The normals of its sides, inwards.
    sides: Vec<Vector>,
}

impl<'a> Cone<'a> {
    /// `None` if the eye is in the fragment's plane.
    fn of(unit: Unit, eye: &Vector, fragment: FragmentRef<'a>) -> Option<Self> {
        let piece = fragment.scene().piece(fragment.piece());
        let (normal, offset) = unit.plane(&resolved(piece.scene(), piece.plane()));
        let height = dot(&normal, eye) - offset;
        let in_front = match sign(&height) {
            0 => return None,
            sign => sign > 0,
        };
        let normal = if in_front { normal } else { normal.map(|x| -x) };
        let side = if in_front { piece.facing() } else { piece.facing().opposite() };
        let mut corners: Vec<Vector> =
            fragment.exact_corners().map(|corner| unit.spot(&corner).seen_from(eye)).collect();
        // Counter-clockwise about the direction of view: fronts are seen clockwise from the other end of it.
        if side == Side::Front {
            corners.reverse();
        }
        let sides = (0..corners.len()).map(|k| cross(&corners[k], &corners[(k + 1) % corners.len()])).collect();
        Some(Self { fragment, side, normal, height: height.abs(), corners, sides })
    }

    /// Of fragments in one plane the one of least rank comes first.
    fn rank(&self) -> (Side, PolygonId, PieceId) {
        (self.side, self.fragment.polygon(), self.fragment.piece())
    }

    /// True if this fragment hides part of the other.
    fn hides(&self, other: &Self) -> bool {
        let crease = minus(&times(&self.normal, &other.height), &times(&other.normal, &self.height));
        let same_plane = is_zero(&crease);
        if same_plane && self.rank() >= other.rank() {
            return false;
        }
        let mut common = other.corners.clone();
        if !same_plane {
            // Only where it is in front.
            common = clipped(&common, &crease.map(|x| -x));
        }
        for side in &self.sides {
            if common.len() < 3 {
                return false;
            }
            common = clipped(&common, side);
        }
        has_inside(&common)
    }
}

/// The part of a cone, given by its corners, where n . d >= 0.
fn clipped(corners: &[Vector], normal: &Vector) -> Vec<Vector> {
    let heights: Vec<BigInt> = corners.iter().map(|corner| dot(normal, corner)).collect();
    let mut kept = Vec::with_capacity(corners.len() + 1);
    for (k, corner) in corners.iter().enumerate() {
        let next = (k + 1) % corners.len();
        let (here, there) = (sign(&heights[k]), sign(&heights[next]));
        if here >= 0 {
            kept.push(corner.clone());
        }
        if here * there < 0 {
            kept.push(plus(&times(corner, &heights[next].abs()), &times(&corners[next], &heights[k].abs())));
        }
    }
    kept
}

fn has_inside(corners: &[Vector]) -> bool {
    let Some((first, rest)) = corners.split_first() else { return false };
    rest.iter().enumerate().any(|(k, a)| {
        let normal = cross(first, a);
        rest[k + 1..].iter().any(|b| sign(&dot(&normal, b)) != 0)
    })
}
