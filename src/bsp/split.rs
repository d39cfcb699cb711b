//! The splitter: on which side of a plane a fragment lies, and how it is cut.
//!
//! Whether to cut is decided with epsilon; the cut itself is exact, and both halves get the same
//! crease with opposite signs.

use super::fragment::FragmentSide;
use super::skeleton::Skeleton;
use crate::exact::{Arena, Sign};
use crate::scene::PlaneId;

/// Where a fragment goes.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Placement {
    /// Into the node: it lies in the plane.
    Coplanar { exactly: bool },
    /// Wholly to one side; not exactly so if it pokes through by less than epsilon.
    Front { exactly: bool },
    /// Likewise.
    Back { exactly: bool },
    /// To both, cut in two.
    Spanning { back: Vec<FragmentSide>, front: Vec<FragmentSide> },
}

/// The splitter with its buffers.
#[derive(Debug, Default)]
pub(super) struct Splitter {
    pub(super) arena: Arena,
    signs: Vec<Sign>,
}

impl Splitter {
    /// Places a fragment of a piece with the supporting plane `own` against `plane`.
    pub(super) fn place(
        &mut self,
        skeleton: &mut Skeleton,
        sides: &[FragmentSide],
        own: PlaneId,
        plane: PlaneId,
        epsilon: f64,
    ) -> Placement {
        if own == plane {
            return Placement::Coplanar { exactly: true };
        }
        self.signs.clear();
        for side in sides {
            self.signs.push(skeleton.side(plane, side.point, &mut self.arena));
        }
        let any_front = self.signs.contains(&Sign::Positive);
        let any_back = self.signs.contains(&Sign::Negative);
        if epsilon > 0.0 {
            let (mut far_front, mut far_back) = (false, false);
            for (side, sign) in sides.iter().zip(&self.signs) {
                let height = skeleton.rounded_height(plane, side.point);
                // What overflows is far.
                far_front |= height > epsilon || (!height.is_finite() && sign.is_positive());
                far_back |= height < -epsilon || (!height.is_finite() && sign.is_negative());
            }
            match (far_front, far_back) {
                (false, false) => return Placement::Coplanar { exactly: !any_front && !any_back },
                (true, false) if any_front => return Placement::Front { exactly: !any_back },
                (false, true) if any_back => return Placement::Back { exactly: !any_front },
                _ => {}
            }
        }
        match (any_front, any_back) {
            (false, false) => Placement::Coplanar { exactly: true },
            (true, false) => Placement::Front { exactly: true },
            (false, true) => Placement::Back { exactly: true },
            (true, true) => self.cut(skeleton, sides, own, plane),
        }
    }

    /// Cuts a fragment whose exact signs are in `self.signs`.
    fn cut(&mut self, skeleton: &mut Skeleton, sides: &[FragmentSide], own: PlaneId, plane: PlaneId) -> Placement {
        let crease = skeleton.crease(own, plane);
        let (mut back, mut front) = (Vec::with_capacity(sides.len() + 1), Vec::with_capacity(sides.len() + 1));
        for (k, &side) in sides.iter().enumerate() {
            let next = (k + 1) % sides.len();
            let (here, there) = (self.signs[k], self.signs[next]);
            let along_cut = |point, forward| FragmentSide { point, line: crease, forward };
            // The corner itself: on the plane it belongs to both halves, and where the boundary
            // leaves a half there, that half goes on along the crease.
            match here {
                Sign::Positive => front.push(side),
                Sign::Negative => back.push(side),
                Sign::Zero => {
                    front.push(if there.is_positive() { side } else { along_cut(side.point, true) });
                    back.push(if there.is_negative() { side } else { along_cut(side.point, false) });
                }
            }
            if here * there == Sign::Negative {
                let point = skeleton.crossing(side.line, plane, crease, &mut self.arena);
                let rest = FragmentSide { point, ..side };
                if here.is_positive() {
                    front.push(along_cut(point, true));
                    back.push(rest);
                } else {
                    back.push(along_cut(point, false));
                    front.push(rest);
                }
            }
        }
        Placement::Spanning { back, front }
    }
}
