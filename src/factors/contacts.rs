//! Where other facets stand on a facet or pass through it: what is seen changes there from one point to the next, all at once.
//!
//! Integrals over an element are taken over its parts between such lines. This decides where points are taken, and nothing about what is seen from
//! them.

use super::element::Element;
use super::facets::Facets;
use super::shaft::Lies;
use super::shape::{Frame, clip};
use crate::exact::{Sign, orient3d};
use glam::{DVec2, DVec3};

/// No element is cut into more parts than this.
const MOST_PARTS: usize = 64;

/// The segments in which some facets meet the plane of one, other than those that lie in it.
pub(super) fn contacts(facet: u32, facets: &Facets, frame: &Frame, others: &[u32]) -> Vec<[DVec2; 2]> {
    let [a, b, c] = facets.all[facet as usize].spanning;
    let mut segments = Vec::new();
    for &number in others {
        // What is behind ends at the plane, and is not seen.
        if matches!(facets.lies(number, facet), Lies::On | Lies::Behind) {
            continue;
        }
        let other = &facets.all[number as usize];
        let heights: Vec<(DVec3, Sign)> = other.ring.iter().map(|&p| (p, orient3d(a, b, c, p))).collect();
        let next = heights.iter().cycle().skip(1);
        let mut points = heights.iter().zip(next).filter_map(|(&(p, from), &(q, to))| {
            if from.is_zero() {
                return Some(frame.flat(p));
            }
            let (low, high) = (frame.height(p), frame.height(q));
            (from == -to && (low - high).abs() > 0.0).then(|| frame.flat(p + (q - p) * (low / (low - high))))
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
    let mut parts = vec![element.flat.clone()];
    let mut cut = Vec::new();
    for &[p, q] in contacts {
        if !crosses(&element.flat, [p, q], element.radius) || parts.len() > MOST_PARTS {
            continue;
        }
        // Lines, and not segments: parts stay convex.
        let side = |r: DVec2| super::shape::turn(p, q, r);
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
    if parts.len() == 1 {
        return vec![element.ring.clone()];
    }
    parts.into_iter().map(|part| part.into_iter().map(|p| frame.lift(p)).collect()).collect()
}

/// True if a segment has a length within a convex polygon, and not on its boundary, up to rounding.
fn crosses(ring: &[DVec2], [p, q]: [DVec2; 2], size: f64) -> bool {
    let (mut from, mut to) = (0.0, 1.0_f64);
    for [a, b] in super::shape::sides(ring) {
        let reach = 1e-12 * size * a.distance(b);
        let (at_p, at_q) = (super::shape::turn(a, b, p), super::shape::turn(a, b, q));
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
