//! Where other facets stand on a facet or pass through it: what is seen changes there from one point to the next, all at once.
//!
//! Integrals over an element are taken over its parts between such lines. This decides where points are taken, and nothing about what is seen from
//! them; so what is as near to a plane as rounding leaves it, in scenes that have been turned, is taken to be on it.

use super::element::Element;
use super::facets::Facets;
use super::lies::Lies;
use super::shape::{Frame, clip, double_area, sides, turn};
use glam::{DVec2, DVec3};

/// What is no farther than this from a plane touches it. A scene is about 1 across here: it is what points are taken to be on a polygon within (docs/form-factors.md), and
/// some million times what turning a scene does to its corners.
pub(super) const TOUCHES: f64 = 1e-9;
/// No element is cut into more parts than this.
const MOST_PARTS: usize = 64;

/// The segments in which some facets meet the plane of one, or nearly so, other than those that lie in it.
pub(super) fn contacts(facet: u32, facets: &Facets, frame: &Frame, others: &[u32]) -> Vec<[DVec2; 2]> {
    let mut segments = Vec::new();
    for &number in others {
        // What is behind ends at the plane, and is not seen.
        if matches!(facets.lies(number, facet), Lies::On | Lies::Behind) {
            continue;
        }
        let other = &facets.all[number as usize];
        let height = |p: DVec3| Some(frame.height(p)).filter(|height| height.abs() > TOUCHES).unwrap_or(0.0);
        let heights: Vec<(DVec3, f64)> = other.ring.iter().map(|&p| (p, height(p))).collect();
        if heights.iter().all(|&(_, height)| height <= 0.0) {
            continue;
        }
        let next = heights.iter().cycle().skip(1);
        let mut points = heights.iter().zip(next).filter_map(|(&(p, from), &(q, to))| {
            if from == 0.0 {
                return Some(frame.flat(p));
            }
            (from * to < 0.0).then(|| frame.flat(p + (q - p) * (from / (from - to))))
        });
        let Some(first) = points.next() else { continue };
        // A convex polygon meets a plane in a segment; corners within a side may lie on it.
        let farthest = points.max_by(|p, q| first.distance_squared(*p).total_cmp(&first.distance_squared(*q)));
        if let Some(last) = farthest.filter(|&last| last != first) {
            segments.push([first, last]);
        }
    }
    segments
}

/// The element cut along the lines of segments that lie in it.
pub(super) fn parts(element: &Element, frame: &Frame, contacts: &[[DVec2; 2]]) -> Vec<Vec<DVec3>> {
    let parts = cut(&element.flat, element.radius, contacts);
    if parts.len() == 1 {
        return vec![element.ring.clone()];
    }
    parts.into_iter().map(|part| part.into_iter().map(|p| frame.lift(p)).collect()).collect()
}

/// A convex polygon cut along the lines of segments that lie in it.
pub(super) fn cut(ring: &[DVec2], size: f64, contacts: &[[DVec2; 2]]) -> Vec<Vec<DVec2>> {
    let mut parts = vec![ring.to_vec()];
    let mut cut = Vec::new();
    for &[p, q] in contacts {
        if !crosses(ring, [p, q], size) || parts.len() > MOST_PARTS {
            continue;
        }
        // Lines, and not segments: parts stay convex.
        let side = |r: DVec2| turn(p, q, r);
        let mut next = Vec::with_capacity(parts.len() + 1);
        for part in parts {
            for sign in [1.0, -1.0] {
                clip(&part, |r| sign * side(r), &mut cut);
                if cut.len() >= 3 {
                    next.push(cut.clone());
                }
            }
        }
        parts = next;
    }
    parts
}

/// Takes what a convex ring covers out of convex parts; what is left of them is convex, too. Areas up to `least` are nothing.
pub(super) fn take_out(parts: &mut Vec<Vec<DVec3>>, frame: &Frame, ring: &[DVec2], least: f64) {
    let is_some = |part: &[DVec3]| part.len() >= 3 && 0.5 * double_area(part).length() > least;
    for part in std::mem::take(parts) {
        let (mut inside, mut cut, mut outside) = (part.clone(), Vec::new(), Vec::new());
        for [a, b] in sides(ring) {
            let side = |p: DVec3| turn(a, b, frame.flat(p));
            clip(&inside, |p| -side(p), &mut cut);
            if is_some(&cut) {
                outside.push(cut.clone());
            }
            clip(&inside, side, &mut cut);
            std::mem::swap(&mut inside, &mut cut);
        }
        if is_some(&inside) {
            parts.append(&mut outside);
        } else {
            parts.push(part);
        }
    }
}

/// True if a segment has a length within a convex polygon, and not on its boundary, up to rounding.
pub(super) fn crosses(ring: &[DVec2], [p, q]: [DVec2; 2], size: f64) -> bool {
    let (mut from, mut to) = (0.0, 1.0_f64);
    for [a, b] in sides(ring) {
        let reach = 1e-12 * size * a.distance(b);
        let (at_p, at_q) = (turn(a, b, p), turn(a, b, q));
        if at_p <= reach && at_q <= reach {
            return false;
        }
        let crossing = at_p / (at_p - at_q);
        if at_p < 0.0 {
            from = f64::max(from, crossing);
        }
        if at_q < 0.0 {
            to = to.min(crossing);
        }
    }
    (to - from) * p.distance(q) > 1e-12 * size
}
