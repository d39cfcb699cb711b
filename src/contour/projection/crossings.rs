//! Which of many polylines cross each other.

use glam::DVec2;
use robust::{Coord, orient2d};
use rustc_hash::FxHashMap;

/// A stretch of a polyline between two of its points.
#[derive(Clone, Copy)]
struct Segment {
    /// The numbers of the polyline and of the stretch.
    at: [u32; 2],
    ends: [DVec2; 2],
}

impl Segment {
    /// Where it begins along x.
    fn low(&self) -> f64 {
        self.ends[0].x.min(self.ends[1].x)
    }
}

/// The stretches of polylines that meet others but at points that both have, as numbers of polyline and stretch, ascending. Exact for the
/// coordinates as they are.
///
/// Segments are sorted into squares of that size: the cost is theirs, and the pairs within each.
pub(super) fn crossing(lines: &[Vec<DVec2>], square: f64) -> Vec<[u32; 2]> {
    let mut squares: FxHashMap<[i64; 2], Vec<Segment>> = FxHashMap::default();
    for (line, points) in (0..).zip(lines) {
        for (k, pair) in (0..).zip(points.windows(2)) {
            let segment = Segment { at: [line, k], ends: [pair[0], pair[1]] };
            let [low, high] = [pair[0].min(pair[1]), pair[0].max(pair[1])].map(|p| (p / square).floor().as_i64vec2());
            for x in low.x..=high.x {
                for y in low.y..=high.y {
                    squares.entry([x, y]).or_default().push(segment);
                }
            }
        }
    }
    let mut meets: Vec<Vec<bool>> = lines.iter().map(|points| vec![false; points.len()]).collect();
    for segments in squares.values_mut() {
        // Long pieces that lie on each other share many squares.
        if segments.iter().all(|segment| meets[segment.at[0] as usize][segment.at[1] as usize]) {
            continue;
        }
        segments.sort_by(|s, t| s.low().total_cmp(&t.low()));
        for (k, first) in segments.iter().enumerate() {
            let high = first.ends[0].x.max(first.ends[1].x);
            for second in segments[k + 1..].iter().take_while(|second| second.low() <= high) {
                let [s, t] = [first.at, second.at].map(|at| at.map(|number| number as usize));
                // Many may meet each other: the pairs of those that do are not told.
                if !(meets[s[0]][s[1]] && meets[t[0]][t[1]]) && meet(first.ends, second.ends) {
                    (meets[s[0]][s[1]], meets[t[0]][t[1]]) = (true, true);
                }
            }
        }
    }
    let stretches = |(line, meets): (u32, &Vec<bool>)| {
        let met = (0..).zip(meets.clone()).filter(|&(_, meets)| meets);
        met.map(move |(k, _)| [line, k])
    };
    (0..).zip(&meets).flat_map(stretches).collect()
}

/// True if two segments meet, but at an end that they have in common.
fn meet([a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> bool {
    let apart = a.max(b).cmplt(c.min(d)) | c.max(d).cmplt(a.min(b));
    if apart.any() {
        return false;
    }
    let turn = |p: DVec2, q: DVec2, r: DVec2| {
        let [p, q, r] = [p, q, r].map(|p| Coord { x: p.x, y: p.y });
        orient2d(p, q, r)
    };
    if [c, d].contains(&a) || [c, d].contains(&b) {
        // From the common end: along each other, or apart.
        let [common, far] = if [c, d].contains(&a) { [a, b] } else { [b, a] };
        let other = if c == common { d } else { c };
        return turn(common, far, other) == 0.0 && (far - common).dot(other - common) > 0.0;
    }
    // On one side of the other's line, both, and not on it.
    let beside = |x: f64, y: f64| (x > 0.0 && y > 0.0) || (x < 0.0 && y < 0.0);
    !beside(turn(a, b, c), turn(a, b, d)) && !beside(turn(c, d, a), turn(c, d, b))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_cross_where_segments_meet_away_from_common_points() {
        let lines: [&[[f64; 2]]; 6] = [
            &[[0.0, 0.0], [1.0, 0.1], [2.0, 0.0]],
            // From a point of the first one.
            &[[1.0, 0.1], [1.0, 1.0]],
            // Over the middle of the first one, and back.
            &[[1.5, 1.0], [1.4, -1.0]],
            // Ends on the first one's first stretch.
            &[[0.5, 0.05], [0.5, 1.0]],
            // Beside all of them; in one line with a stretch, but apart.
            &[[3.0, 0.0], [4.0, 0.0]],
            &[[5.0, 0.0], [6.0, 0.0], [6.0, 1.0]],
        ];
        let lines = lines.map(|line| line.iter().copied().map(DVec2::from).collect::<Vec<_>>());
        for shift in [0.0, -16.0] {
            let lines = lines.clone().map(|line| line.iter().map(|p| p + DVec2::new(shift, 0.0)).collect::<Vec<_>>());
            for square in [0.1, 1.0, 2.0, 100.0] {
                assert_eq!(crossing(&lines, square), [[0, 0], [0, 1], [2, 0], [3, 0]], "{square} {shift}");
            }
        }
        let spike = [[0.0, 0.0], [1.0, 2.0], [0.5, 1.0], [0.0, 3.0]].map(DVec2::from).to_vec();
        let beside = [[0.0, 0.0], [2.0, 4.0]].map(DVec2::from).to_vec();
        let on = [[0.0, 0.0], [-1.0, -2.0]].map(DVec2::from).to_vec();
        let found = crossing(&[spike, beside, on], 0.7);
        assert_eq!(found, [[0, 0], [0, 1], [0, 2], [1, 0]], "along each other from a common point, and on a stretch");
        let eight = [[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]].map(DVec2::from).to_vec();
        assert_eq!(crossing(&[eight], 0.3), [[0, 0], [0, 2]], "itself");
    }
    /// Two segments, all ways round: which of them is first, and which end of each.
    fn meet_any_way(s: [[f64; 2]; 2], t: [[f64; 2]; 2]) -> bool {
        let [s, t] = [s, t].map(|ends| ends.map(DVec2::from));
        let back = |[a, b]: [DVec2; 2]| [b, a];
        let ways = [(s, t), (back(s), t), (s, back(t)), (back(s), back(t))];
        let found = ways.map(|(s, t)| [meet(s, t), meet(t, s)]);
        assert!(found.iter().flatten().all(|&meets| meets == found[0][0]), "{s:?} {t:?}: {found:?}");
        found[0][0]
    }

    #[test]
    fn segments_meet_whichever_way_they_run() {
        let level = [[0.0, 0.0], [4.0, 0.0]];
        for up in [1.0, -1.0] {
            assert!(meet_any_way(level, [[1.0, 0.0], [2.0, up]]), "an end on the other");
            assert!(meet_any_way(level, [[1.0, -up], [2.0, up]]), "across");
            assert!(!meet_any_way(level, [[1.0, 0.5 * up], [2.0, up]]), "beside");
            assert!(!meet_any_way(level, [[0.0, 0.0], [2.0, up]]), "a common end");
            assert!(!meet_any_way(level, [[5.0, -up], [5.5, up]]), "across the line, but beyond the end");
        }
        assert!(meet_any_way(level, [[0.0, 0.0], [2.0, 0.0]]), "along each other from a common end");
        assert!(!meet_any_way(level, [[0.0, 0.0], [-2.0, 0.0]]), "apart from a common end");
        assert!(meet_any_way(level, [[1.0, 0.0], [5.0, 0.0]]), "along each other");
        assert!(!meet_any_way(level, [[5.0, 0.0], [6.0, 0.0]]), "in one line");
        assert!(!meet_any_way([[0.0, 0.0], [0.0, 4.0]], [[0.0, 5.0], [0.0, 6.0]]), "in one line, upright");
    }

    /// All of a fan cross in one square. Their number is odd: none is found only as another's partner.
    #[test]
    fn a_square_full_of_crossings_is_told_once_a_stretch() {
        let lines: Vec<Vec<DVec2>> = (0..1001)
            .map(|k| [[0.0, f64::from(k)], [1.0, -f64::from(k)]].map(|p| DVec2::from(p) / 2048.0).to_vec())
            .collect();
        let all: Vec<[u32; 2]> = (0..1001).map(|line| [line, 0]).collect();
        assert_eq!(crossing(&lines, 1.0), all);
    }
}
