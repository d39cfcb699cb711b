//! The area that a region has in each pixel.

use glam::{DVec2, UVec2};

/// Computes areas of polygons in pixels of side 1, the first one of which has its upper left corner at the origin (y down): exactly, but for rounding, whatever the
/// polygon. What lies outside of the picture is cut off.
///
/// Every edge adds to the pixels of a row what lies to the right of it, signed by whether it goes down or up; the running sum along the row is the area. So a
/// picture's regions, whose common edges are the same numbers, have areas that sum to 1 in each pixel.
///
/// ```
/// use glam::{DVec2, UVec2};
/// use nusselt::picture::Coverage;
///
/// let mut coverage = Coverage::new(UVec2::new(4, 4));
/// coverage.add_ring(&[(0.5, 0.5), (2.5, 0.5), (2.5, 1.5), (0.5, 1.5)].map(DVec2::from));
/// let mut areas = Vec::new();
/// coverage.for_each(|x, y, area| areas.push((x, y, area)));
/// assert_eq!(areas, [(0, 0, 0.25), (1, 0, 0.5), (2, 0, 0.25), (0, 1, 0.25), (1, 1, 0.5), (2, 1, 0.25)]);
/// ```
#[derive(Clone, Debug)]
pub struct Coverage {
    size: UVec2,
    /// For every row one more than it has pixels: what changes from the pixel before.
    steps: Vec<f64>,
    /// The pixels of each row that something was added to: the first one, and one more than the last.
    touched: Vec<[u32; 2]>,
    rows: [u32; 2],
}

const UNTOUCHED: [u32; 2] = [u32::MAX, 0];

impl Coverage {
    /// Of nothing so far, in a picture of that many pixels.
    pub fn new(size: UVec2) -> Self {
        let steps = vec![0.0; (size.x as usize + 2) * size.y as usize];
        Self { size, steps, touched: vec![UNTOUCHED; size.y as usize], rows: [size.y, 0] }
    }

    /// Forgets all rings.
    pub fn clear(&mut self) {
        for y in self.rows[0]..self.rows[1] {
            let [first, end] = std::mem::replace(&mut self.touched[y as usize], UNTOUCHED);
            let start = self.start(y);
            if first < end {
                self.steps[start + first as usize..start + end as usize].fill(0.0);
            }
        }
        self.rows = [self.size.y, 0];
    }

    fn start(&self, y: u32) -> usize {
        y as usize * (self.size.x as usize + 2)
    }

    /// Adds a ring. Its area counts as positive if it runs clockwise as it is seen (with y down), else negative, so that holes may be cut out.
    pub fn add_ring(&mut self, ring: &[DVec2]) {
        for (k, &from) in ring.iter().enumerate() {
            self.add_edge(from, ring[if k + 1 == ring.len() { 0 } else { k + 1 }]);
        }
    }

    fn add_edge(&mut self, from: DVec2, to: DVec2) {
        if !(from.is_finite() && to.is_finite()) {
            return;
        }
        // An edge that goes up has its inside, as it runs clockwise, to its right.
        let (sign, top, bottom) = if from.y < to.y { (-1.0, from, to) } else { (1.0, to, from) };
        let low = top.y.max(0.0);
        let high = bottom.y.min(f64::from(self.size.y));
        if low >= high {
            return;
        }
        let slope = (bottom.x - top.x) / (bottom.y - top.y);
        let at = |y: f64| {
            if y <= top.y {
                top.x
            } else if y >= bottom.y {
                bottom.x
            } else {
                top.x + (y - top.y) * slope
            }
        };
        let last = (high.ceil() as u32).min(self.size.y);
        for y in low.floor() as u32..last {
            let (above, below) = (low.max(f64::from(y)), high.min(f64::from(y + 1)));
            if above < below {
                self.add_in_row(y, [at(above), at(below)], sign * (below - above));
            }
        }
    }

    /// Adds an edge within one row, that goes from one x to another while y changes by `height`.
    fn add_in_row(&mut self, y: u32, ends: [f64; 2], height: f64) {
        let width = f64::from(self.size.x);
        let [left, right] = [ends[0].min(ends[1]), ends[0].max(ends[1])];
        if left >= width {
            return;
        }
        // What is left of the picture covers all of it.
        if right <= 0.0 {
            self.step(y, 0, height);
            return;
        }
        if left >= right {
            self.upright(y, left, height);
            return;
        }
        let rise = height / (right - left);
        let (from, to) = (left.max(0.0), right.min(width));
        if left < from {
            self.step(y, 0, rise * (from - left));
        }
        let mut x = from;
        let mut pixel = from.floor();
        while x < to {
            let end = (pixel + 1.0).min(to);
            // The part of the edge in this pixel, with the mean of what is to its right there.
            let part = rise * (end - x);
            let inside = pixel + 1.0 - 0.5 * (x + end);
            self.step(y, pixel as u32, part * inside);
            self.step(y, pixel as u32 + 1, part * (1.0 - inside));
            x = end;
            pixel += 1.0;
        }
    }

    fn upright(&mut self, y: u32, x: f64, height: f64) {
        let pixel = x.floor();
        let inside = pixel + 1.0 - x;
        self.step(y, pixel as u32, height * inside);
        self.step(y, pixel as u32 + 1, height * (1.0 - inside));
    }

    fn step(&mut self, y: u32, x: u32, change: f64) {
        let start = self.start(y);
        let x = x.min(self.size.x + 1);
        self.steps[start + x as usize] += change;
        let [first, end] = &mut self.touched[y as usize];
        (*first, *end) = ((*first).min(x), (*end).max(x + 1));
        self.rows = [self.rows[0].min(y), self.rows[1].max(y + 1)];
    }

    /// Calls with the column, the row and the area of every pixel in which there is some.
    pub fn for_each(&self, mut f: impl FnMut(u32, u32, f64)) {
        for y in self.rows[0]..self.rows[1] {
            let [first, end] = self.touched[y as usize];
            let start = self.start(y);
            let mut sum = 0.0;
            // After the last step nothing changes, and all rings are closed: only what leaves the picture to the right goes on.
            for x in first..self.size.x {
                if x < end {
                    sum += self.steps[start + x as usize];
                } else if sum.abs() < 1e-12 {
                    break;
                }
                if sum != 0.0 {
                    f(x, y, sum);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The area of a ring within a pixel, by cutting it off at the pixel's sides (Sutherland and Hodgman).
    fn clipped(ring: &[DVec2], x: u32, y: u32) -> f64 {
        let (x, y) = (f64::from(x), f64::from(y));
        let mut ring = ring.to_vec();
        for (normal, offset) in [(DVec2::X, -x), (DVec2::NEG_X, x + 1.0), (DVec2::Y, -y), (DVec2::NEG_Y, y + 1.0)] {
            let height = |p: DVec2| normal.dot(p) + offset;
            let mut kept = Vec::new();
            for (k, &p) in ring.iter().enumerate() {
                let q = ring[(k + 1) % ring.len()];
                let (a, b) = (height(p), height(q));
                if a >= 0.0 {
                    kept.push(p);
                }
                if (a < 0.0) != (b < 0.0) {
                    kept.push(p.lerp(q, a / (a - b)));
                }
            }
            ring = kept;
        }
        let doubled: f64 = (0..ring.len()).map(|k| ring[k].perp_dot(ring[(k + 1) % ring.len()])).sum();
        doubled / 2.0
    }

    #[test]
    fn areas_are_those_of_clipped_polygons() {
        let mut state = 1u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 53) as f64
        };
        let size = UVec2::new(7, 5);
        let mut coverage = Coverage::new(size);
        for case in 0..2000 {
            // Convex: on an ellipse; every third on whole and half numbers, partly outside.
            let count = 3 + case % 5;
            let (middle, radii) =
                (DVec2::new(random() * 9.0 - 1.0, random() * 7.0 - 1.0), DVec2::new(random() * 5.0, random() * 4.0));
            let ring: Vec<DVec2> = (0..count)
                .map(|k| {
                    let turn = std::f64::consts::TAU * (k as f64 + 0.3 * random()) / count as f64;
                    let p = middle + radii * DVec2::new(turn.cos(), turn.sin());
                    if case % 3 == 0 { (p * 2.0).round() / 2.0 } else { p }
                })
                .collect();
            coverage.clear();
            coverage.add_ring(&ring);
            let mut found = vec![0.0; 35];
            coverage.for_each(|x, y, area| found[(y * 7 + x) as usize] = area);
            for y in 0..5 {
                for x in 0..7 {
                    let expected = clipped(&ring, x, y);
                    let area = found[(y * 7 + x) as usize];
                    assert!((area - expected).abs() < 1e-13, "{case} {x} {y}: {area} {expected} {ring:?}");
                }
            }
        }
    }

    #[test]
    fn neighbours_sum_to_one_and_holes_are_cut_out() {
        let size = UVec2::new(6, 6);
        let outer = [(-1.0, -1.0), (7.0, -1.0), (7.0, 7.0), (-1.0, 7.0)].map(DVec2::from);
        let hole = [(1.3, 1.1), (4.2, 1.7), (2.9, 4.4)].map(DVec2::from);
        let mut around = Coverage::new(size);
        around.add_ring(&outer);
        let reversed: Vec<DVec2> = hole.iter().rev().copied().collect();
        around.add_ring(&reversed);
        let mut inside = Coverage::new(size);
        inside.add_ring(&hole);
        let mut sums = vec![0.0; 36];
        for coverage in [&around, &inside] {
            coverage.for_each(|x, y, area| sums[(y * 6 + x) as usize] += area);
        }
        assert!(sums.iter().all(|sum| (sum - 1.0).abs() < 1e-14), "{sums:?}");
        inside.clear();
        inside.for_each(|_, _, _| panic!("nothing is left"));
    }
}
