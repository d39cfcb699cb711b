//! Which wrong orders the recorded slivers excuse: in rational numbers, whatever arithmetic the rest is checked in.
//!
//! At a node of the 3D BSP that parts two pieces by a plane, the order is wrong only where the one that was left
//! uncut lies beyond the plane, by less than epsilon. From an eye that is further from the plane the line of sight is on
//! its way to the plane there, or past it, and the other piece must lie between: so it is within epsilon of the plane too.

use super::clip::clip;
use super::evidence::EvidenceSliver;
use super::rational::{RationalPlane, Vector, cross, dot, exact, normal, rational, sign_of, whole};
use crate::exact::{Plane, Sign, Splitter};
use crate::scene::Side;
use glam::DVec3;
use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::Zero;

/// A convex spherical polygon by its inward normals.
pub(super) type Part = Vec<Vector<BigInt>>;

/// The planes of two pieces that are seen in wrong order.
pub(super) struct Disorder {
    eye: Vector<BigRational>,
    /// How far slivers may reach.
    limit: BigRational,
    planes: [RationalPlane; 2],
}

impl Disorder {
    pub(super) fn new(eye: DVec3, planes: [&Plane; 2], limit: f64) -> Self {
        Self { eye: exact(eye), limit: rational(limit), planes: planes.map(RationalPlane::new) }
    }

    /// The normal of a great circle to its inside.
    pub(super) fn inward_normal(&self, splitter: &Splitter, inside: Sign) -> Vector<BigInt> {
        let normal = whole(&normal(&self.eye, splitter));
        if inside.is_negative() { normal.map(|x| -x) } else { normal }
    }

    /// Leaves of `parts` what a sliver of the first or the second of the two pieces does not excuse.
    pub(super) fn excuse(&self, parts: &mut Vec<Part>, whose: usize, sliver: &EvidenceSliver, plane: &Plane) {
        let plane = RationalPlane::new(plane);
        // Three vertices on a line are no plane to be near to.
        if plane.normal.iter().all(Zero::is_zero) {
            return;
        }
        let reach = &self.limit * &length_at_least(&plane.normal);
        let within = |piece: &RationalPlane| {
            [self.half(piece, &plane, &-&reach, Sign::Positive), self.half(piece, &plane, &reach, Sign::Negative)]
        };
        let beyond = |side: Side| {
            let sign = if side == Side::Front { Sign::Positive } else { Sign::Negative };
            self.half(&self.planes[whose], &plane, &BigRational::zero(), sign)
        };
        let height = plane.height(&self.eye);
        let eye_is_near = -&reach <= height && height <= reach;
        let near = self.planes.iter().enumerate().filter(|(k, _)| *k == whose || !eye_is_near);
        let excused: Vec<Vector<BigInt>> =
            sliver.beyond.map(beyond).into_iter().chain(near.flat_map(|(_, piece)| within(piece))).collect();
        let mut rest = Vec::new();
        // What is outside of one of the half spheres stays; what is inside of all of them goes.
        'parts: for mut part in parts.drain(..) {
            for half in &excused {
                // Without a normal: the piece is at that height all over.
                if half.iter().all(Zero::is_zero) {
                    continue;
                }
                let outside = half.clone().map(|x| -x);
                let mut cut = part.clone();
                if clip_exactly(&mut cut, &outside) {
                    rest.push(cut);
                }
                if !clip_exactly(&mut part, half) {
                    continue 'parts;
                }
            }
        }
        *parts = rest;
    }

    /// The directions in which a piece is seen at a height over a plane that is at least, or at most, the one given, in
    /// units of the plane's normal.
    ///
    /// A point `e + t d` of the piece, with normal `N` and the eye at height `h`, has `t = -h / (N . d) > 0`; its height
    /// over the other plane is `g + t (M . d)`. Times `N . d`, which has the sign of `-h`, that is linear in `d`.
    fn half(&self, piece: &RationalPlane, plane: &RationalPlane, least: &BigRational, side: Sign) -> Vector<BigInt> {
        let (h, g) = (piece.height(&self.eye), plane.height(&self.eye) - least);
        let normal = [0, 1, 2].map(|k| &g * &piece.normal[k] - &h * &plane.normal[k]);
        let normal = whole(&normal);
        if sign_of(&h) == side { normal.map(|x| -x) } else { normal }
    }
}

fn clip_exactly(part: &mut Part, half: &Vector<BigInt>) -> bool {
    clip(part, half, |[a, b, c]| sign_of(&dot(a, &cross(b, c))))
}

/// A number not below the length of a vector, and hardly above it.
fn length_at_least(v: &Vector<BigRational>) -> BigRational {
    let square = dot(v, v);
    // sqrt(p / q) = sqrt(p q) / q, with the root of a large integer rounded up.
    let scale = BigInt::from(1) << 64u32;
    let root = (square.numer() * square.denom() * &scale * &scale).sqrt() + 1;
    BigRational::new(root, square.denom() * scale)
}
