//! Convex spherical polygons and how a great circle cuts them.

use super::directions::{CircleId, DirectionId, Directions, ExactCache};
use crate::bsp::Skeleton;
use crate::exact::Sign;

/// A great circle with a side: the inside of a polygon that it bounds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct HalfSphere(u32);

impl HalfSphere {
    pub(crate) fn new(circle: CircleId, inside: Sign) -> Self {
        debug_assert!(!inside.is_zero());
        Self(circle.0 << 1 | u32::from(inside.is_negative()))
    }

    pub(crate) fn circle(self) -> CircleId {
        CircleId(self.0 >> 1)
    }

    /// The sign that directions inside have.
    pub(crate) fn inside(self) -> Sign {
        if self.0 & 1 == 0 { Sign::Positive } else { Sign::Negative }
    }
}

/// One side of a convex spherical polygon: where it starts and the great circle it follows to the
/// next one. The boundary runs counter-clockwise seen from outside of the sphere.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct PolygonArc {
    pub(crate) from: DirectionId,
    pub(crate) along: HalfSphere,
}

/// On which sides of a great circle a polygon has corners.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Sides {
    pub(crate) positive: bool,
    pub(crate) negative: bool,
}

/// Cuts polygons; owns the buffer of signs and the exact numbers of a view.
#[derive(Clone, Debug, Default)]
pub(crate) struct Knife {
    signs: Vec<Sign>,
    pub(crate) cache: ExactCache,
}

impl Knife {
    /// Finds the side of every corner.
    pub(crate) fn classify(
        &mut self,
        skeleton: &Skeleton,
        directions: &Directions,
        polygon: &[PolygonArc],
        circle: CircleId,
    ) -> Sides {
        self.signs.clear();
        self.cache.count_calls(polygon.len());
        let mut sides = Sides { positive: false, negative: false };
        for arc in polygon {
            let sign = directions.side(skeleton, arc.from, circle, &mut self.cache);
            sides.positive |= sign.is_positive();
            sides.negative |= sign.is_negative();
            self.signs.push(sign);
        }
        sides
    }

    /// Cuts a polygon, classified last, whose corners lie on both sides. `known` may name the
    /// direction in which an arc of the polygon crosses the circle, if there is one already.
    #[allow(clippy::too_many_arguments, reason = "the parts of a view are borrowed apart")]
    pub(crate) fn cut(
        &mut self,
        skeleton: &Skeleton,
        directions: &mut Directions,
        polygon: &[PolygonArc],
        circle: CircleId,
        mut known: impl FnMut(&mut Directions, &mut ExactCache, PolygonArc) -> Option<DirectionId>,
        negative: &mut Vec<PolygonArc>,
        positive: &mut Vec<PolygonArc>,
    ) {
        let along_positive = HalfSphere::new(circle, Sign::Positive);
        let along_negative = HalfSphere::new(circle, Sign::Negative);
        for (k, &arc) in polygon.iter().enumerate() {
            let here = self.signs[k];
            let there = self.signs[if k + 1 == polygon.len() { 0 } else { k + 1 }];
            match here {
                Sign::Positive => positive.push(arc),
                Sign::Negative => negative.push(arc),
                // A corner on the circle belongs to both parts. Where the boundary leaves a part,
                // that part goes on along the circle.
                Sign::Zero => {
                    let start = |along| PolygonArc { from: arc.from, along };
                    positive.push(if there.is_positive() { arc } else { start(along_positive) });
                    negative.push(if there.is_negative() { arc } else { start(along_negative) });
                }
            }
            if here * there == Sign::Negative {
                // The boundary turns about the inward normal n of the arc; going from the positive
                // to the negative side of t it meets t at n x t, the other way at t x n.
                let from = known(directions, &mut self.cache, arc).unwrap_or_else(|| {
                    let reversed = arc.along.inside() * here == Sign::Negative;
                    directions.push_crossing(skeleton, [arc.along.circle(), circle], reversed, &mut self.cache)
                });
                let rest = PolygonArc { from, along: arc.along };
                if here.is_positive() {
                    positive.push(PolygonArc { from, along: along_positive });
                    negative.push(rest);
                } else {
                    negative.push(PolygonArc { from, along: along_negative });
                    positive.push(rest);
                }
            }
        }
    }
}
