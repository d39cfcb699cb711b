//! Which pieces of many polylines cross each other, while they are halved.

use glam::DVec2;
use robust::{Coord, orient2d};
use rustc_hash::FxHashMap;

/// A straight piece of a polyline.
#[derive(Clone, Copy)]
pub(super) struct Piece {
    /// The number of the polyline.
    pub(super) line: u32,
    /// How far along it the piece begins and ends, in any measure.
    pub(super) span: [f64; 2],
    pub(super) ends: [DVec2; 2],
}

impl Piece {
    fn low(&self) -> f64 {
        self.ends[0].x.min(self.ends[1].x)
    }

    fn high(&self) -> f64 {
        self.ends[0].x.max(self.ends[1].x)
    }

    /// All squares that it meets, and some beside them.
    fn squares(&self, square: f64) -> impl Iterator<Item = [i64; 2]> + use<> {
        let [p, q] = if self.ends[0].x <= self.ends[1].x { self.ends } else { [self.ends[1], self.ends[0]] };
        let [low, high] = [p.min(q), p.max(q)].map(|p| (p / square).floor().as_i64vec2());
        // Rounding is far below a square: one more above and below is enough.
        let height =
            move |border: i64| p.y + ((border as f64 * square - p.x) / (q.x - p.x)).clamp(0.0, 1.0) * (q.y - p.y);
        let rows = move |column: i64| {
            if low.x == high.x {
                return low.y..=high.y;
            }
            let [a, b] = [column, column + 1].map(|border| (height(border) / square).floor() as i64);
            (a.min(b) - 1).max(low.y)..=(a.max(b) + 1).min(high.y)
        };
        (low.x..=high.x).flat_map(move |x| rows(x).map(move |y| [x, y]))
    }
}

/// All pieces together are at most so many squares wide and high.
const MOST_SQUARES: f64 = 4096.0;

/// Pieces of polylines by number, sorted into squares: what they cost is theirs, and the pairs within each.
pub(super) struct Pieces {
    square: f64,
    all: Vec<Piece>,
    squares: FxHashMap<[i64; 2], Vec<u32>>,
}

impl Pieces {
    /// In squares of that size, or larger ones if it takes too many of them; the ends of all pieces are finite.
    pub(super) fn new(pieces: Vec<Piece>, square: f64) -> Self {
        let farthest = pieces.iter().flat_map(|piece| piece.ends).map(|p| p.abs().max_element()).fold(0.0, f64::max);
        let square = square.max(farthest * (2.0 / MOST_SQUARES));
        let mut squares: FxHashMap<_, Vec<_>> = FxHashMap::default();
        for (number, piece) in (0..).zip(&pieces) {
            for place in piece.squares(square) {
                squares.entry(place).or_default().push(number);
            }
        }
        Self { square, all: pieces, squares }
    }

    pub(super) fn len(&self) -> usize {
        self.all.len()
    }

    pub(super) fn get(&self, number: u32) -> Piece {
        self.all[number as usize]
    }

    /// Breaks a piece at a point, so far along the line. It keeps the first half; the second one gets the number that is returned.
    pub(super) fn halve(&mut self, number: u32, at: f64, middle: DVec2) -> u32 {
        let whole = self.get(number);
        let second = self.all.len() as u32;
        let ([from, to], [p, q]) = (whole.span, whole.ends);
        let halves = [
            Piece { span: [from, at], ends: [p, middle], ..whole },
            Piece { span: [at, to], ends: [middle, q], ..whole },
        ];
        // A square may have thousands: it is left alone if it keeps the piece.
        let [first_squares, second_squares] = halves.map(|half| half.squares(self.square).collect::<Vec<_>>());
        let whole_squares: Vec<_> = whole.squares(self.square).collect();
        for place in &whole_squares {
            if !first_squares.contains(place) {
                self.squares.entry(*place).or_default().retain(|&other| other != number);
            }
        }
        for place in first_squares {
            if !whole_squares.contains(&place) {
                self.squares.entry(place).or_default().push(number);
            }
        }
        for place in second_squares {
            self.squares.entry(place).or_default().push(second);
        }
        self.all[number as usize] = halves[0];
        self.all.push(halves[1]);
        second
    }

    /// Those that meet others but at points that both have, by number; only pairs with one of `new` (ascending) are looked at. Exact for the
    /// coordinates as they are.
    pub(super) fn meeting(&self, new: &[u32]) -> Vec<u32> {
        let places = if new.len() == self.all.len() {
            self.squares.keys().copied().collect()
        } else {
            let mut places: Vec<_> = new.iter().flat_map(|&number| self.get(number).squares(self.square)).collect();
            places.sort_unstable();
            places.dedup();
            places
        };
        let mut is_new = vec![false; self.all.len()];
        for &number in new {
            is_new[number as usize] = true;
        }
        let mut meets = vec![false; self.all.len()];
        let mut sorted = Vec::new();
        for place in places {
            let Some(numbers) = self.squares.get(&place) else { continue };
            // Long pieces that lie on each other share many squares.
            if numbers.iter().all(|&number| meets[number as usize]) {
                continue;
            }
            sorted.clear();
            sorted.extend(numbers.iter().map(|&number| (number as usize, self.get(number))));
            sorted.sort_by(|(_, s), (_, t)| s.low().total_cmp(&t.low()));
            for (k, (s, first)) in sorted.iter().enumerate() {
                for (t, second) in sorted[k + 1..].iter().take_while(|(_, second)| second.low() <= first.high()) {
                    // Many may meet each other: the pairs of those that do are not told.
                    let matters = (is_new[*s] || is_new[*t]) && !(meets[*s] && meets[*t]);
                    if matters && meet(first.ends, second.ends) {
                        (meets[*s], meets[*t]) = (true, true);
                    }
                }
            }
        }
        (0..).zip(meets).filter_map(|(number, meets)| meets.then_some(number)).collect()
    }
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

    fn pieces(lines: &[Vec<DVec2>], square: f64) -> Pieces {
        let of_line = |(line, points): (u32, &Vec<DVec2>)| {
            let pairs = points.windows(2).map(|pair| [pair[0], pair[1]]).enumerate();
            pairs.map(|(k, ends)| Piece { line, span: [k as f64, k as f64 + 1.0], ends }).collect::<Vec<_>>()
        };
        Pieces::new((0..).zip(lines).flat_map(of_line).collect(), square)
    }

    /// The numbers of line and stretch of all that meet others.
    fn crossing(lines: &[Vec<DVec2>], square: f64) -> Vec<[u32; 2]> {
        let pieces = pieces(lines, square);
        let all: Vec<u32> = (0..pieces.len() as u32).collect();
        let found = pieces.meeting(&all).into_iter().map(|number| pieces.get(number));
        found.map(|piece| [piece.line, piece.span[0] as u32]).collect()
    }

    /// What halves meet is what is found in pieces that are made anew.
    #[test]
    fn halves_meet_what_they_meet() {
        // A tent whose second side's middle moves away from a bar that it touches, and a bar that it comes to touch.
        let lines = [
            vec![[0.0, 0.0], [2.0, 2.0], [4.0, 0.0]],
            vec![[2.5, 0.5], [3.1, 1.1]],
            vec![[2.0, -1.0], [2.9, 0.4]],
            vec![[9.0, 9.0], [9.0, 8.0]],
            vec![[8.0, 8.5], [10.0, 8.5]],
        ];
        let lines = lines.map(|line| line.into_iter().map(DVec2::from).collect::<Vec<_>>());
        for (square, middle) in [0.3, 1.0, 7.0].into_iter().flat_map(|s| [[3.0, 0.5], [3.5, 3.5]].map(|m| (s, m))) {
            let mut pieces = pieces(&lines, square);
            let all: Vec<u32> = (0..pieces.len() as u32).collect();
            assert_eq!(pieces.meeting(&all), [1, 2, 4, 5], "{square}");
            let second = pieces.halve(1, 1.5, DVec2::from(middle));
            assert_eq!(second, 6);
            let anew = Pieces::new(pieces.all.clone(), square);
            let all: Vec<u32> = (0..7).collect();
            // The bars far away are no matter of the halves.
            let expected: Vec<u32> = anew.meeting(&all).into_iter().filter(|number| ![4, 5].contains(number)).collect();
            assert_eq!(pieces.meeting(&[1, 6]), expected, "{square}");
            assert_eq!(expected.is_empty(), DVec2::from(middle) == DVec2::splat(3.5), "{square}: {expected:?}");
        }
    }

    /// Of any lengths and slopes: the same as from all pairs, in squares of any size; a long piece is in few of them.
    #[test]
    fn no_square_misses_a_pair() {
        let mut state = 7u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / 2f64.powi(52) - 1.0
        };
        let mut point = |size: f64| DVec2::new(random(), random()) * size;
        let lines: Vec<Vec<DVec2>> = (0..400)
            .map(|k| {
                let start = point(1.0);
                vec![start, start + point(2f64.powi(-(k % 12)))]
            })
            .collect();
        let ends: Vec<[DVec2; 2]> = lines.iter().map(|line| [line[0], line[1]]).collect();
        let meets = |k: usize| (0..ends.len()).any(|other| other != k && meet(ends[k], ends[other]));
        let expected: Vec<[u32; 2]> = (0..ends.len()).filter(|&k| meets(k)).map(|k| [k as u32, 0]).collect();
        assert!(expected.len() > 100 && expected.len() < 300, "{}", expected.len());
        for square in [1e-9, 0.003, 0.1, 5.0] {
            assert_eq!(crossing(&lines, square), expected, "{square}");
        }
        let long = Piece { line: 0, span: [0.0, 1.0], ends: [DVec2::new(-1e9, -1e9), DVec2::new(1e9, 1e9)] };
        let pieces = Pieces::new(vec![long], 1e-9);
        let count = pieces.squares.len();
        assert!((4096..=5 * 4097).contains(&count), "{count}");
    }

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
