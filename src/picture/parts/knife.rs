//! Convex polygons cut along pixels.

use glam::DVec2;

/// Cuts convex polygons along pixels.
#[derive(Default)]
pub(super) struct Knife {
    strip: Vec<DVec2>,
    rest: Vec<DVec2>,
    part: Vec<DVec2>,
    other: Vec<DVec2>,
}

impl Knife {
    /// Calls with column, row, area and first moment (area times centroid) of what a convex polygon has in each pixel within columns and rows.
    pub(super) fn cut(
        &mut self,
        ring: &[DVec2],
        columns: [u32; 2],
        rows: [u32; 2],
        mut f: impl FnMut(u32, u32, f64, DVec2),
    ) {
        let (low, high) =
            ring.iter().fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), &p| (low.min(p), high.max(p)));
        let [left, right] = columns.map(f64::from);
        if high.x <= left || low.x >= right {
            return;
        }
        let first = (low.y.max(0.0) as u32).max(rows[0]);
        let end = (high.y.max(0.0).ceil() as u32).min(rows[1]);
        for y in first..end {
            halve(ring, 1, f64::from(y), &mut self.rest, None);
            halve(&self.rest, 1, f64::from(y + 1), &mut self.other, Some(&mut self.strip));
            let (from, to) = extent(&self.strip);
            if self.strip.len() < 3 || to <= left || from >= right {
                continue;
            }
            let first = from.max(left) as u32;
            // What is to the left of the columns is cut off.
            halve(&self.strip, 0, f64::from(first), &mut self.rest, None);
            for x in first..(to.min(right).ceil() as u32) {
                halve(&self.rest, 0, f64::from(x + 1), &mut self.other, Some(&mut self.part));
                std::mem::swap(&mut self.rest, &mut self.other);
                let (area, moment) = area_and_moment(&self.part, DVec2::new(f64::from(x), f64::from(y)));
                if area > 0.0 {
                    f(x, y, area, moment);
                }
            }
        }
    }
}

/// The least and the largest x.
fn extent(ring: &[DVec2]) -> (f64, f64) {
    ring.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| (low.min(p.x), high.max(p.x)))
}

/// Cuts a convex polygon at a line across an axis: what is beyond, and what is before.
fn halve(ring: &[DVec2], axis: usize, at: f64, beyond: &mut Vec<DVec2>, mut before: Option<&mut Vec<DVec2>>) {
    beyond.clear();
    if let Some(before) = &mut before {
        before.clear();
    }
    for (k, &p) in ring.iter().enumerate() {
        let q = ring[if k + 1 == ring.len() { 0 } else { k + 1 }];
        let (a, b) = (p[axis] - at, q[axis] - at);
        if a >= 0.0 {
            beyond.push(p);
        }
        if let Some(before) = &mut before
            && a <= 0.0
        {
            before.push(p);
        }
        if (a < 0.0 && b > 0.0) || (a > 0.0 && b < 0.0) {
            let mut crossing = p + (q - p) * (a / (a - b));
            crossing[axis] = at;
            beyond.push(crossing);
            if let Some(before) = &mut before {
                before.push(crossing);
            }
        }
    }
}

/// The area of a polygon that runs either way, and its first moment, summed about a corner near it.
fn area_and_moment(ring: &[DVec2], near: DVec2) -> (f64, DVec2) {
    let (mut double, mut moment) = (0.0, DVec2::ZERO);
    for (k, &p) in ring.iter().enumerate() {
        let (p, q) = (p - near, ring[if k + 1 == ring.len() { 0 } else { k + 1 }] - near);
        let cross = p.perp_dot(q);
        double += cross;
        moment += (p + q) * cross;
    }
    let sign = if double < 0.0 { -1.0 } else { 1.0 };
    let area = 0.5 * sign * double;
    // Within the pixel, whatever rounding does to slivers.
    let centroid = (moment * (sign / 6.0) / area).clamp(DVec2::ZERO, DVec2::ONE);
    (area, (centroid + near) * area)
}
