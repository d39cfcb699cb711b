//! Convex spherical polygons and how a great circle cuts them.

use super::directions::{CircleId, DirectionId, Directions, ExactCache};
use crate::bsp::Skeleton;
use crate::exact::Sign;
use std::ops::Range;

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

/// Where the sides of a polygon are kept among those of others.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Span {
    start: u32,
    len: u32,
}

impl Span {
    /// All that is kept from a place on.
    pub(crate) fn from(start: usize, arcs: &[PolygonArc]) -> Self {
        Self { start: start as u32, len: (arcs.len() - start) as u32 }
    }

    /// Keeps a polygon after all others.
    pub(crate) fn keep(polygon: &[PolygonArc], arcs: &mut Vec<PolygonArc>) -> Self {
        let start = arcs.len();
        arcs.extend_from_slice(polygon);
        Self::from(start, arcs)
    }

    /// Moves the polygon that was kept last to the place of this one, if that is large enough.
    pub(crate) fn replace_by_last(self, last: Self, arcs: &mut Vec<PolygonArc>) -> Self {
        if last.len > self.len {
            return last;
        }
        arcs.copy_within(last.range(), self.start as usize);
        arcs.truncate(last.start as usize);
        Self { len: last.len, ..self }
    }

    /// Keeps a polygon in the place of this one, if that is large enough.
    pub(crate) fn replace(self, polygon: &[PolygonArc], arcs: &mut Vec<PolygonArc>) -> Self {
        if polygon.len() > self.len as usize {
            return Self::keep(polygon, arcs);
        }
        let replaced = Self { len: polygon.len() as u32, ..self };
        arcs[replaced.range()].copy_from_slice(polygon);
        replaced
    }

    #[inline]
    pub(crate) fn range(self) -> Range<usize> {
        self.start as usize..(self.start + self.len) as usize
    }
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
    corners: Corners,
    /// The sides of the corners of a polygon that has too many for that.
    signs: Vec<Sign>,
    pub(crate) cache: ExactCache,
}

/// The most corners that have a bit each.
const MOST_CORNERS: usize = 64;

/// The sides of a polygon's corners, a bit for each.
#[derive(Clone, Copy, Debug, Default)]
struct Corners {
    positive: u64,
    negative: u64,
}

/// Where the boundary of a polygon goes over to another side of a circle.
#[derive(Clone, Copy, Debug)]
struct Passage {
    /// The corner on the circle, or the last one before it.
    at: usize,
    /// The first corner beyond.
    beyond: usize,
    is_corner: bool,
}

impl Passage {
    /// The first corner that is not on the side before it.
    fn last(self) -> usize {
        if self.is_corner { self.at } else { self.beyond }
    }
}

impl Corners {
    /// Where the boundary of a polygon of so many corners, which has some on both sides, becomes negative, and where positive. A convex polygon
    /// has one of each; `None` if this one has not, or has too many corners.
    #[inline]
    fn passages(self, count: usize) -> Option<[Passage; 2]> {
        let all = u64::MAX >> MOST_CORNERS.checked_sub(count)?;
        let Self { positive, negative } = self;
        // Those that follow one of some.
        let after = |some: u64| (some << 1 | some >> (count - 1)) & all;
        let zero = all & !(positive | negative);
        let starts = [negative, positive].map(|side| side & !after(side));
        if starts.iter().any(|start| !start.is_power_of_two()) || zero & after(zero) != 0 {
            return None;
        }
        Some(starts.map(|start| {
            let beyond = start.trailing_zeros() as usize;
            let at = if beyond == 0 { count - 1 } else { beyond - 1 };
            Passage { at, beyond, is_corner: zero >> at & 1 != 0 }
        }))
    }
}

impl Corners {
    fn sign(self, corner: usize) -> Sign {
        match (self.positive >> corner & 1, self.negative >> corner & 1) {
            (1, _) => Sign::Positive,
            (_, 1) => Sign::Negative,
            _ => Sign::Zero,
        }
    }
}

impl Knife {
    /// Finds the side of every corner.
    #[inline]
    pub(crate) fn classify(
        &mut self,
        skeleton: &Skeleton,
        directions: &Directions,
        polygon: &[PolygonArc],
        circle: CircleId,
    ) -> Sides {
        self.cache.count_calls(polygon.len());
        if polygon.len() > MOST_CORNERS {
            return self.classify_many(skeleton, directions, polygon, circle);
        }
        let normal = directions.normal(circle);
        let (mut positive, mut negative, mut known) = (0u64, 0u64, 0u64);
        // The first corner has the lowest bit.
        for arc in polygon.iter().rev() {
            let [is_positive, is_negative] = directions.approximation(arc.from).dot_bits(normal);
            positive = positive << 1 | is_positive;
            negative = negative << 1 | is_negative;
            known = known << 1 | 1;
        }
        let mut open = known & !(positive | negative);
        while open != 0 {
            let corner = polygon[open.trailing_zeros() as usize].from;
            let bit = open & open.wrapping_neg();
            match directions.undecided_side_of(skeleton, corner, circle, &mut self.cache) {
                Sign::Positive => positive |= bit,
                Sign::Negative => negative |= bit,
                Sign::Zero => {}
            }
            open ^= bit;
        }
        self.corners = Corners { positive, negative };
        Sides { positive: positive != 0, negative: negative != 0 }
    }

    #[cold]
    fn classify_many(
        &mut self,
        skeleton: &Skeleton,
        directions: &Directions,
        polygon: &[PolygonArc],
        circle: CircleId,
    ) -> Sides {
        self.signs.clear();
        self.signs.extend(polygon.iter().map(|arc| directions.side(skeleton, arc.from, circle, &mut self.cache)));
        Sides { positive: self.signs.contains(&Sign::Positive), negative: self.signs.contains(&Sign::Negative) }
    }

    /// Cuts a polygon, classified last, whose corners lie on both sides: its negative and its positive part, which are kept after all
    /// others, the negative one last. `known` may name the direction in which an arc of the polygon crosses the circle, if there is one already.
    #[inline]
    pub(crate) fn cut(
        &mut self,
        skeleton: &Skeleton,
        directions: &mut Directions,
        arcs: &mut Vec<PolygonArc>,
        polygon: Span,
        circle: CircleId,
        mut known: impl FnMut(&mut Directions, &mut ExactCache, PolygonArc) -> Option<DirectionId>,
    ) -> [Span; 2] {
        let count = polygon.len as usize;
        let Some([down, up]) = self.corners.passages(count) else {
            return self.cut_any(skeleton, directions, arcs, polygon, circle, known);
        };
        let mut end = |passage: Passage, arc: PolygonArc, here: Sign| {
            if passage.is_corner {
                // It belongs to both parts.
                return arc.from;
            }
            let known = known(directions, &mut self.cache, arc);
            known.unwrap_or_else(|| cross(skeleton, directions, &mut self.cache, arc, here, circle))
        };
        let first = polygon.start as usize;
        let [arc_down, arc_up] = [arcs[first + down.at], arcs[first + up.at]];
        let (from_down, from_up) = (end(down, arc_down, Sign::Positive), end(up, arc_up, Sign::Negative));
        let start = arcs.len();
        arcs.reserve(count + 4);
        arcs.push(PolygonArc { from: from_up, along: arc_up.along });
        copy_run(arcs, first, count, up.beyond, down.last());
        // Where the boundary leaves a part, that part goes on along the circle.
        arcs.push(PolygonArc { from: from_down, along: HalfSphere::new(circle, Sign::Positive) });
        let middle = arcs.len();
        arcs.push(PolygonArc { from: from_down, along: arc_down.along });
        copy_run(arcs, first, count, down.beyond, up.last());
        arcs.push(PolygonArc { from: from_up, along: HalfSphere::new(circle, Sign::Negative) });
        [Span::from(middle, arcs), Span { start: start as u32, len: (middle - start) as u32 }]
    }

    /// The same, but only the part in a half sphere.
    #[inline]
    pub(crate) fn cut_off(
        &mut self,
        skeleton: &Skeleton,
        directions: &mut Directions,
        arcs: &mut Vec<PolygonArc>,
        polygon: Span,
        half: HalfSphere,
    ) -> Span {
        let (circle, inside) = (half.circle(), half.inside());
        let count = polygon.len as usize;
        let Some([down, up]) = self.corners.passages(count) else {
            let [negative, positive] = self.cut_any(skeleton, directions, arcs, polygon, circle, |_, _, _| None);
            return if inside.is_positive() { positive } else { negative };
        };
        let (enters, leaves) = if inside.is_positive() { (up, down) } else { (down, up) };
        let first = polygon.start as usize;
        let [arc_in, arc_out] = [arcs[first + enters.at], arcs[first + leaves.at]];
        let mut end = |passage: Passage, arc: PolygonArc, here: Sign| {
            if passage.is_corner { arc.from } else { cross(skeleton, directions, &mut self.cache, arc, here, circle) }
        };
        let (from_in, from_out) = (end(enters, arc_in, -inside), end(leaves, arc_out, inside));
        let start = arcs.len();
        arcs.reserve(count + 2);
        arcs.push(PolygonArc { from: from_in, along: arc_in.along });
        copy_run(arcs, first, count, enters.beyond, leaves.last());
        arcs.push(PolygonArc { from: from_out, along: half });
        Span::from(start, arcs)
    }

    /// The same for a polygon of any number of corners, some of which may be in one place.
    #[cold]
    fn cut_any(
        &mut self,
        skeleton: &Skeleton,
        directions: &mut Directions,
        arcs: &mut Vec<PolygonArc>,
        polygon: Span,
        circle: CircleId,
        mut known: impl FnMut(&mut Directions, &mut ExactCache, PolygonArc) -> Option<DirectionId>,
    ) -> [Span; 2] {
        let count = polygon.len as usize;
        if count <= MOST_CORNERS {
            self.signs.clear();
            self.signs.extend((0..count).map(|k| self.corners.sign(k)));
        }
        let along_positive = HalfSphere::new(circle, Sign::Positive);
        let along_negative = HalfSphere::new(circle, Sign::Negative);
        let (mut negative, mut positive) = (Vec::new(), Vec::new());
        for (k, &arc) in arcs[polygon.range()].iter().enumerate() {
            let here = self.signs[k];
            let there = self.signs[if k + 1 == count { 0 } else { k + 1 }];
            match here {
                Sign::Positive => positive.push(arc),
                Sign::Negative => negative.push(arc),
                // A corner on the circle belongs to both parts.
                Sign::Zero => {
                    let start = |along| PolygonArc { from: arc.from, along };
                    positive.push(if there.is_positive() { arc } else { start(along_positive) });
                    negative.push(if there.is_negative() { arc } else { start(along_negative) });
                }
            }
            if here * there == Sign::Negative {
                let from = known(directions, &mut self.cache, arc)
                    .unwrap_or_else(|| cross(skeleton, directions, &mut self.cache, arc, here, circle));
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
        let positive = Span::keep(&positive, arcs);
        [Span::keep(&negative, arcs), positive]
    }
}

/// Copies corners of a polygon that starts at `first`, from number `k` up to `last`, to the end.
#[inline]
fn copy_run(arcs: &mut Vec<PolygonArc>, first: usize, count: usize, mut k: usize, last: usize) {
    while k != last {
        arcs.push(arcs[first + k]);
        k = if k + 1 == count { 0 } else { k + 1 };
    }
}

/// Where an arc that starts on the side `here` of a circle meets it.
#[inline]
fn cross(
    skeleton: &Skeleton,
    directions: &mut Directions,
    cache: &mut ExactCache,
    arc: PolygonArc,
    here: Sign,
    circle: CircleId,
) -> DirectionId {
    // The boundary turns about the inward normal n of the arc; going from the positive
    // to the negative side of t it meets t at n x t, the other way at t x n.
    let reversed = arc.along.inside() != here;
    directions.push_crossing(skeleton, [arc.along.circle(), circle], reversed, cache)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bvh::SceneBvh;
    use crate::scene::{Material, Scene};
    use glam::DVec3;
    use std::f64::consts::TAU;

    type Corner = ([u64; 3], HalfSphere);

    /// The parts of a regular polygon around z, cut by a plane: fast where that is possible, in the way that takes any polygon, and one by one.
    fn parts(count: usize, normal: DVec3) -> [[Vec<Corner>; 2]; 3] {
        let corners = [[0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [0.0, 1.0, 1.0]];
        let scene = Scene::builder().mesh(&corners, &[vec![0, 1, 2]], Material::new("grey")).build().expect("a scene");
        let bvh = SceneBvh::build(&scene);
        let skeleton = &bvh.hierarchy.skeleton;
        let mut knife = Knife::default();
        let mut directions = Directions::new(skeleton.bits, DVec3::ZERO, None);
        let sides: Vec<CircleId> = (0..count)
            .map(|k| TAU * k as f64 / count as f64)
            .map(|angle| DVec3::new(-angle.cos(), -angle.sin(), 1.0))
            .map(|inwards| if count == 4 { inwards.round() } else { inwards })
            .map(|inwards| directions.push_given(skeleton, inwards, &mut knife.cache))
            .collect();
        let arcs = (0..count).map(|k| {
            let meeting = [sides[(k + count - 1) % count], sides[k]];
            let from = directions.push_crossing(skeleton, meeting, false, &mut knife.cache);
            PolygonArc { from, along: HalfSphere::new(sides[k], Sign::Positive) }
        });
        let mut arcs: Vec<PolygonArc> = arcs.collect();
        let polygon = Span::from(0, &arcs);
        let circle = directions.push_given(skeleton, normal, &mut knife.cache);
        let found = knife.classify(skeleton, &directions, &arcs, circle);
        assert_eq!(found, Sides { positive: true, negative: true });
        let none = |_: &mut Directions, _: &mut ExactCache, _| None;
        let fast = knife.cut(skeleton, &mut directions, &mut arcs, polygon, circle, none);
        let any = knife.cut_any(skeleton, &mut directions, &mut arcs, polygon, circle, none);
        let one_by_one = [Sign::Negative, Sign::Positive]
            .map(|side| knife.cut_off(skeleton, &mut directions, &mut arcs, polygon, HalfSphere::new(circle, side)));
        for (part, sign) in fast.into_iter().zip([Sign::Negative, Sign::Positive]) {
            let here = knife.classify(skeleton, &directions, &arcs[part.range()], circle);
            assert_eq!(here, Sides { positive: sign.is_positive(), negative: sign.is_negative() });
        }
        [fast, any, one_by_one].map(|parts| {
            parts.map(|part| {
                let corner =
                    |arc: &PolygonArc| (directions.approximation(arc.from).v.to_array().map(f64::to_bits), arc.along);
                let mut corners: Vec<Corner> = arcs[part.range()].iter().map(corner).collect();
                // From the one side that all parts have.
                let cut = corners.iter().position(|corner| corner.1.circle() == circle).expect("a side along the cut");
                corners.rotate_left(cut);
                corners
            })
        })
    }

    #[test]
    fn all_ways_to_cut_give_the_same_parts() {
        let normals = [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [1.0, 1.0, 0.0], [1.0, 2.0, 0.3], [0.1, -1.0, -0.05]];
        for count in [3, 4, 5, 7, 63, 64, 65, 100] {
            for normal in normals.map(DVec3::from) {
                let [fast, any, one_by_one] = parts(count, normal);
                assert_eq!(fast, any, "{count} {normal}");
                assert_eq!(fast, one_by_one, "{count} {normal}");
                // Two ends of the cut, each in both parts, are new corners or old ones.
                let new = fast.iter().map(Vec::len).sum::<usize>() - count;
                assert!((2..=4).contains(&new), "{count} {normal}: {new}");
            }
        }
        // From corner to corner of a square.
        assert_eq!(parts(4, DVec3::new(1.0, 1.0, 0.0))[0].each_ref().map(Vec::len), [3, 3]);
    }

    #[test]
    fn passages_are_found_where_a_convex_polygon_has_them() {
        let corners = |signs: &str| {
            let bits = |sign| signs.bytes().enumerate().filter(|&(_, s)| s == sign).map(|(k, _)| 1 << k).sum();
            Corners { positive: bits(b'+'), negative: bits(b'-') }.passages(signs.len())
        };
        let told = |signs: &str| corners(signs).map(|both| both.map(|p| (p.at, p.beyond, p.is_corner)));
        assert_eq!(told("++--"), Some([(1, 2, false), (3, 0, false)]));
        assert_eq!(told("-+"), Some([(1, 0, false), (0, 1, false)]));
        assert_eq!(told("0+0-"), Some([(2, 3, true), (0, 1, true)]));
        assert_eq!(told("-+++0"), Some([(4, 0, true), (0, 1, false)]));
        for none in ["+-+-", "+00-", "+-0+-", "++0", "----", "0"] {
            assert_eq!(told(none), None, "{none}");
        }
        assert_eq!(told(&format!("{}-", "+".repeat(63))), Some([(62, 63, false), (63, 0, false)]));
        assert!(Corners { positive: 1, negative: 2 }.passages(65).is_none());
    }
}
