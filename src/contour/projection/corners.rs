//! Corners that lie between a curve and its chord.

use glam::{DVec2, DVec3};
use robust::{Coord, orient2d};
use rustc_hash::FxHashMap;

/// Directions this near to the plane of a great circle are on either side of it, or on it, for all that rounding can tell.
const DOUBT: f64 = 1e-15;

/// Corners of regions in the picture, with their directions, in squares.
pub(super) struct Corners {
    squares: FxHashMap<[i64; 2], Vec<(DVec2, DVec3)>>,
    square: f64,
    /// How far chords may be from their curves.
    reach: f64,
}

impl Corners {
    /// Sorts corners into squares of that size. No chord may be farther than `reach` from its curve.
    pub(super) fn new(corners: impl Iterator<Item = (DVec2, DVec3)>, square: f64, reach: f64) -> Self {
        let mut squares: FxHashMap<_, Vec<_>> = FxHashMap::default();
        for corner in corners {
            squares.entry(place_of(corner.0, square)).or_default().push(corner);
        }
        for corners in squares.values_mut() {
            corners.sort_by(|(p, _), (q, _)| p.x.total_cmp(&q.x).then(p.y.total_cmp(&q.y)));
            corners.dedup_by_key(|corner| corner.0);
        }
        Self { squares, square, reach }
    }

    /// Whether a corner is on one side of a stretch of the great circle with that normal and on the other side of the stretch's chord
    /// from `p` to `q`, or may be. Left of a great circle, as seen from outside of the sphere, is right of it in the picture.
    pub(super) fn are_between(&self, [p, q]: [DVec2; 2], normal: DVec3) -> bool {
        let (low, high) = (p.min(q) - self.reach, p.max(q) + self.reach);
        let [from, to] = [low, high].map(|p| place_of(p, self.square));
        let chord = q - p;
        let is_between = |&(place, direction): &(DVec2, DVec3)| {
            let along = (place - p).dot(chord);
            if !(along > 0.0 && along < chord.length_squared()) {
                return false;
            }
            let [a, b, c] = [p, q, place].map(|p| Coord { x: p.x, y: p.y });
            let (turn, height) = (orient2d(a, b, c), normal.dot(direction));
            let is_near = turn.abs() <= self.reach * chord.length();
            is_near && (turn == 0.0 || height.abs() <= DOUBT || (turn > 0.0) == (height > 0.0))
        };
        let squares = (from[0]..=to[0]).flat_map(|x| (from[1]..=to[1]).map(move |y| [x, y]));
        squares.filter_map(|square| self.squares.get(&square)).any(|corners| {
            let first = corners.partition_point(|corner| corner.0.x < low.x);
            corners[first..].iter().take_while(|corner| corner.0.x <= high.x).any(is_between)
        })
    }
}

/// The square that a point is in.
fn place_of(p: DVec2, square: f64) -> [i64; 2] {
    (p / square).floor().as_i64vec2().to_array()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_are_found_only_between_chord_and_curve() {
        // The great circle over the line y = z, seen along z: the upper half of an ellipse. Up is to its left in the picture.
        let slope = 0.5_f64.sqrt();
        let seen = |angle: f64| DVec3::new(angle.sin(), angle.cos() * slope, angle.cos() * slope);
        let normal = DVec3::new(0.0, -slope, slope);
        let [p, q] = [-0.1, 0.1].map(|angle| seen(angle).truncate());
        let top = seen(0.0).y;
        let bulge = top - p.y;
        for square in [1e-3, 0.1, 10.0] {
            // On the chord, or on the curve, is between them for all that can be told.
            let shares =
                [(-0.5, false), (0.0, true), (0.5, true), (0.99, true), (1.0, true), (1.01, false), (1.5, false)];
            for x in [-0.03, 0.0, 0.05] {
                // Where the curve is at x, in shares of what it is above the chord.
                let above = f64::sqrt(0.5 * (1.0 - x * x)) - p.y;
                for (share, expected) in shares {
                    let place = DVec2::new(x, p.y + above * share);
                    let direction = place.extend((1.0 - place.length_squared()).sqrt());
                    let corners = Corners::new([(place, direction)].into_iter(), square, 2.0 * bulge);
                    assert_eq!(corners.are_between([p, q], normal), expected, "{x} {share}");
                    assert_eq!(corners.are_between([q, p], -normal), expected, "{x} {share}, backwards");
                }
            }
            // Its own ends are not between.
            let ends = [-0.1, 0.1].map(|angle| (seen(angle).truncate(), seen(angle)));
            assert!(!Corners::new(ends.into_iter(), square, bulge).are_between([p, q], normal));
        }
    }
}
