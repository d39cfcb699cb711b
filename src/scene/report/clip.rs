//! The area that two convex polygons share, rounded.

use glam::DVec2;

/// The area shared by two convex polygons in the plane that run counter-clockwise; never negative. Off by some units in
/// the last place of the product of their sizes (Sutherland and Hodgman's clipping).
pub(super) fn shared_area(polygon: &[DVec2], window: &[DVec2]) -> f64 {
    let Some(&origin) = polygon.first() else { return 0.0 };
    let mut ring: Vec<DVec2> = polygon.iter().map(|&p| p - origin).collect();
    for (k, &from) in window.iter().enumerate() {
        let (from, to) = (from - origin, window[(k + 1) % window.len()] - origin);
        let height = |p: DVec2| (to - from).perp_dot(p - from);
        let mut kept = Vec::with_capacity(ring.len() + 1);
        for (j, &p) in ring.iter().enumerate() {
            let q = ring[(j + 1) % ring.len()];
            let (here, there) = (height(p), height(q));
            if here >= 0.0 {
                kept.push(p);
            }
            if (here < 0.0) != (there < 0.0) {
                kept.push(p + (q - p) * (here / (here - there)));
            }
        }
        ring = kept;
    }
    let twice: f64 = ring.iter().zip(ring.iter().cycle().skip(1)).map(|(p, q)| p.perp_dot(*q)).sum();
    twice.max(0.0) * 0.5
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn squares_share_what_they_share() {
        let square =
            |x: f64, y: f64, size: f64| [[x, y], [x + size, y], [x + size, y + size], [x, y + size]].map(DVec2::from);
        for (other, expected) in [
            (square(0.0, 0.0, 2.0), 4.0),
            (square(1.0, 1.0, 2.0), 1.0),
            (square(0.5, 0.5, 1.0), 1.0),
            (square(-1.0, -1.0, 8.0), 4.0),
            (square(2.0, 0.0, 2.0), 0.0),
            (square(5.0, 5.0, 2.0), 0.0),
        ] {
            assert_eq!(shared_area(&square(0.0, 0.0, 2.0), &other).to_bits(), f64::to_bits(expected), "{other:?}");
        }
    }
}
