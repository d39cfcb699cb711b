//! Convex parts of an element, cut along lines where what is seen changes.

use super::contacts::crosses;
use super::shape::{Frame, clip, turn};
use glam::{DVec2, DVec3};

/// A part is cut into no more pieces than about this.
const MOST_PIECES: usize = 64;

/// A convex part of an element of a size, which may have corners twice in a row, cut along the lines of segments in the frame that are in what is left of it: itself if none is.
pub(super) fn pieces(part: &[DVec3], segments: &[[DVec2; 2]], frame: &Frame, size: f64) -> Vec<Vec<DVec3>> {
    let mut ring: Vec<DVec2> = part.iter().map(|&p| frame.flat(p)).collect();
    ring.dedup();
    let mut pieces = vec![ring];
    for &[p, q] in segments {
        if pieces.len() >= MOST_PIECES {
            break;
        }
        let mut next = Vec::with_capacity(pieces.len() + 1);
        for piece in pieces {
            if !crosses(&piece, [p, q], size) {
                next.push(piece);
                continue;
            }
            for sign in [1.0, -1.0] {
                let mut half = Vec::new();
                clip(&piece, |r| sign * turn(p, q, r), &mut half);
                if half.len() >= 3 {
                    next.push(half);
                }
            }
        }
        pieces = next;
    }
    if pieces.len() == 1 {
        return vec![part.to_vec()];
    }
    pieces.into_iter().map(|piece| piece.into_iter().map(|p| frame.lift(p)).collect()).collect()
}

#[cfg(test)]
mod tests {
    use super::super::shape::double_area;
    use super::*;

    #[test]
    fn pieces_are_the_part_and_end_at_segments_within_it() {
        let part = [DVec3::ZERO, DVec3::new(2., 0., 0.), DVec3::new(2., 1., 0.), DVec3::new(0., 1., 0.)];
        let frame = Frame::through([part[0], part[1], part[2]]);
        let at = |x: f64, y: f64| DVec2::new(x, y);
        let strip = [[at(0.5, -1.0), at(0.5, 2.0)], [at(0.51, 0.2), at(0.51, 0.3)]];
        let beside = [[at(2.5, -1.0), at(2.5, 2.0)], [at(0.0, 0.0), at(0.0, 1.0)], [at(1.0, 3.0), at(1.0, 2.0)]];
        for (segments, expected) in
            [(&strip[..], vec![0.01, 0.5, 1.49]), (&beside[..], vec![2.0]), (&strip[..1], vec![0.5, 1.5])]
        {
            let mut areas: Vec<f64> = pieces(&part, segments, &frame, 2.0)
                .iter()
                .map(|piece| 0.5 * double_area(piece).dot(frame.normal))
                .collect();
            areas.sort_by(f64::total_cmp);
            assert_eq!(areas.len(), expected.len(), "{areas:?}");
            // Rounding of numbers of about 2.
            assert!(areas.iter().zip(&expected).all(|(a, b)| (a - b).abs() < 1e-15), "{areas:?}");
        }
    }

    #[test]
    fn a_part_with_a_corner_twice_is_cut_too() {
        let part = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Y];
        let frame = Frame::through([part[0], part[1], part[2]]);
        let cut = pieces(&part, &[[DVec2::new(0.25, 0.1), DVec2::new(0.25, 0.2)]], &frame, 1.0);
        assert_eq!(cut.len(), 2);
    }
}
