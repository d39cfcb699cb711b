//! Segments with whole coordinates, rounded so that no two of them cross: snap rounding.
//!
//! Every end and every crossing makes the unit square around the nearest whole point *hot*; every segment is
//! replaced by the polyline through the middles of the hot squares that it goes through. These polylines do not
//! cross, and none is farther than sqrt(1/2) from its segment (J. Hobby, "Practical segment intersection
//! with finite precision output", 1999). A square holds its lower and left sides, not the others.

use std::collections::{BTreeSet, HashSet};

/// A whole point.
pub(super) type Point = [i64; 2];

/// The largest coordinate: what is computed below then fits into 128 bits.
pub(super) const LARGEST: i64 = 1 << 30;

/// Non-crossing segments as pairs of places in a list of points.
#[derive(Clone, Debug, Default)]
pub(super) struct Snapped {
    pub(super) points: Vec<Point>,
    pub(super) edges: Vec<[usize; 2]>,
}

/// Rounds segments; `None` if they have more than `limit` crossings.
pub(super) fn snap(segments: impl IntoIterator<Item = [Point; 2]>, limit: usize) -> Option<Snapped> {
    let segments: BTreeSet<[Point; 2]> =
        segments.into_iter().map(|[a, b]| if a <= b { [a, b] } else { [b, a] }).filter(|[a, b]| a != b).collect();
    // By their least x.
    let segments: Vec<[Point; 2]> = segments.into_iter().collect();
    let mut hot: HashSet<Point> = segments.iter().flatten().copied().collect();
    let mut crossings = 0;
    for (k, &one) in segments.iter().enumerate() {
        for &other in segments[k + 1..].iter().take_while(|other| other[0][0] <= one[1][0]) {
            if let Some(point) = rounded_crossing(one, other) {
                hot.insert(point);
                crossings += 1;
            }
        }
        if crossings > limit {
            return None;
        }
    }
    let mut points: Vec<Point> = hot.into_iter().collect();
    points.sort_unstable();
    let mut edges = BTreeSet::new();
    let mut met = Vec::new();
    for &[a, b] in &segments {
        met.clear();
        let first = points.partition_point(|p| p[0] < a[0] - 1);
        let near = points[first..].iter().enumerate().take_while(|(_, p)| p[0] <= b[0] + 1);
        met.extend(near.filter(|(_, p)| goes_through(a, b, **p)).map(|(k, _)| first + k));
        let along = |k: &usize| points[*k][0] * (b[0] - a[0]) + points[*k][1] * (b[1] - a[1]);
        met.sort_by_key(|k| i128::from(along(k)));
        edges.extend(met.windows(2).map(|pair| [pair[0].min(pair[1]), pair[0].max(pair[1])]));
    }
    Some(Snapped { points, edges: edges.into_iter().collect() })
}

fn cross([ax, ay]: Point, [bx, by]: Point) -> i128 {
    i128::from(ax) * i128::from(by) - i128::from(ay) * i128::from(bx)
}

fn minus(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1]]
}

/// The whole point next to where two segments that are not parallel meet.
fn rounded_crossing([a, b]: [Point; 2], [c, d]: [Point; 2]) -> Option<Point> {
    let [low, high] = [a[1].min(b[1]), a[1].max(b[1])];
    if (c[1] < low && d[1] < low) || (c[1] > high && d[1] > high) {
        return None;
    }
    let [one, other, between] = [minus(b, a), minus(d, c), minus(c, a)];
    let whole = cross(one, other);
    let [along_one, along_other] = [cross(between, other) * whole.signum(), cross(between, one) * whole.signum()];
    let whole = whole.abs();
    if whole == 0 || along_one < 0 || along_one > whole || along_other < 0 || along_other > whole {
        return None;
    }
    // The floor of x + 1/2.
    let round = |k: usize| a[k] + (2 * i128::from(one[k]) * along_one + whole).div_euclid(2 * whole) as i64;
    Some([round(0), round(1)])
}

/// True if the segment from `a` to `b`, `a` not to the right of `b`, meets the square around a point.
fn goes_through(a: Point, b: Point, point: Point) -> bool {
    // In halves, relative to the middle of the square.
    let [a, b] = [a, b].map(|p| minus(p, point).map(|x| 2 * x));
    let [low, high] = [a[1].min(b[1]), a[1].max(b[1])];
    if a[0] >= 1 || b[0] < -1 || low >= 1 || high < -1 {
        return false;
    }
    if a[0] == b[0] || a[1] == b[1] {
        return true;
    }
    let is_rising = a[1] < b[1];
    let side = |corner: Point| cross(minus(b, a), minus(corner, a)).signum();
    let sides = [[-1, -1], [1, -1], [1, 1], [-1, 1]].map(side);
    // Strictly between two corners, the line goes through the inside. Else it touches one corner at most, or
    // runs along a diagonal; the only corner that is part of the square is the lower left one, which a
    // rising line that touches the square elsewhere cannot touch.
    let (above, below) = (sides.contains(&1), sides.contains(&-1));
    if above && below {
        return true;
    }
    !is_rising && sides[0] == 0
}

#[cfg(test)]
mod tests {
    use super::{Point, cross, minus, snap};
    use proptest::prelude::*;

    /// True if the insides of two segments meet in a point, or one holds an end of the other.
    fn collide([a, b]: [Point; 2], [c, d]: [Point; 2]) -> bool {
        let side = |p: Point, q: Point, r: Point| cross(minus(q, p), minus(r, p)).signum();
        let holds = |p: Point, q: Point, r: Point| {
            let ends = [0, 1].map(|k| (p[k].min(q[k]), p[k].max(q[k])));
            r != p && r != q && side(p, q, r) == 0 && (0..2).all(|k| (ends[k].0..=ends[k].1).contains(&r[k]))
        };
        let crosses = side(a, b, c) * side(a, b, d) < 0 && side(c, d, a) * side(c, d, b) < 0;
        crosses || holds(a, b, c) || holds(a, b, d) || holds(c, d, a) || holds(c, d, b)
    }

    fn segments(most: i64, count: usize) -> impl Strategy<Value = Vec<[Point; 2]>> {
        prop::collection::vec(prop::array::uniform2(prop::array::uniform2(-most..=most)), 1..count)
    }

    fn check(segments: &[[Point; 2]]) {
        let snapped = snap(segments.iter().copied(), 10_000).unwrap();
        let edges: Vec<[Point; 2]> = snapped.edges.iter().map(|edge| edge.map(|k| snapped.points[k])).collect();
        for (k, &one) in edges.iter().enumerate() {
            assert!(one[0] != one[1]);
            for &other in &edges[k + 1..] {
                assert!(!collide(one, other), "{one:?} and {other:?}");
            }
        }
        for end in segments.iter().filter(|[a, b]| a != b).flatten() {
            assert!(snapped.points.contains(end), "{end:?} is kept");
        }
    }

    #[test]
    fn crossings_are_limited() {
        let segments = (0..10).flat_map(|k| [[[k, -20], [k, 20]], [[-20, k], [20, k]]]);
        assert!(snap(segments.clone(), 99).is_none());
        assert_eq!(snap(segments, 100).unwrap().points.len(), 100 + 40);
    }

    proptest! {
        #[test]
        fn dense_segments_end_up_without_crossings(segments in segments(6, 12)) {
            check(&segments);
        }

        #[test]
        fn sparse_segments_end_up_without_crossings(segments in segments(1 << 30, 20)) {
            check(&segments);
        }

        #[test]
        fn flat_bundles_end_up_without_crossings(
            bundle in prop::collection::vec((-3..=3_i64, -3..=3_i64, 0..9_i64, 0..9_i64), 1..16),
        ) {
            let segments: Vec<[Point; 2]> =
                bundle.iter().map(|&(a, b, c, d)| [[c - 1000, a], [1000 + d, b]]).collect();
            check(&segments);
        }
    }
}
