//! From pieces to pixels: which faces a piece is drawn on, and its spans there.
//!
//! Nothing is clipped. A convex piece and the eye span a cone, which is the intersection of one half-space for each edge,
//! wherever its vertices are: in front of a face, beside it or behind it. A row of pixels meets each
//! half-space in a ray, and all of them in a span (homogeneous edge functions: M. Olano, T. Greer, "Triangle
//! Scan Conversion Using 2D Homogeneous Coordinates", Graphics Hardware 1997). Two pieces with a common edge have the same
//! edge function up to its sign, bit by bit, and so no pixel between them is lost or drawn twice.

use super::face::Face;
use super::geometry::{ABOVE, FACES, Geometry, OnScreen, Seen};
use glam::DVec3;
use std::ops::Range;

/// A piece to draw on a face, within a box of pixels.
#[derive(Clone, Copy, Debug)]
pub(super) struct Draw {
    piece: u32,
    /// The first row and column, and the ones after the last.
    rows: [u16; 2],
    columns: [u16; 2],
}

/// Puts every piece that may cover the centre of a pixel on the lists of the faces where it may. `passed_over` are not drawn.
pub(super) fn distribute(
    geometry: &Geometry,
    seen: &Seen,
    resolution: usize,
    passed_over: impl Fn(usize) -> bool,
    lists: &mut [Vec<Draw>; 5],
) {
    lists.iter_mut().for_each(Vec::clear);
    for (piece, corners) in geometry.pieces().enumerate() {
        let Some(&first) = corners.first() else { continue };
        let mut bounds = Bounds::new(seen.screen[first as usize]);
        for &corner in &corners[1..] {
            bounds.include(seen.screen[corner as usize]);
        }
        if bounds.any & ABOVE == 0 {
            continue;
        }
        let common = bounds.all & FACES;
        if common != 0 {
            let face = Face::ALL[common.trailing_zeros() as usize];
            if let Some([rows, columns]) = bounds.pixels(face, resolution)
                && !passed_over(piece)
            {
                lists[face as usize].push(Draw { piece: piece as u32, rows, columns });
            }
        } else if !passed_over(piece) {
            for face in Face::ALL {
                let corners = corners.iter().map(|&corner| face.local(seen.positions[corner as usize]));
                if let Some([rows, columns]) = across_faces(face, corners, resolution) {
                    lists[face as usize].push(Draw { piece: piece as u32, rows, columns });
                }
            }
        }
    }
}

/// The box of pixels of a piece on a face, if it is not all of it beyond one of the face's sides or behind it.
fn across_faces(face: Face, corners: impl Iterator<Item = [f64; 3]>, resolution: usize) -> Option<[[u16; 2]; 2]> {
    let half = 0.5 * resolution as f64;
    let lowest = if face == Face::Top { -1.0 } else { 0.0 };
    let mut beyond_all = 31;
    let mut behind = false;
    let mut bounds: Option<Bounds> = None;
    for [u, v, w] in corners {
        let beyond = [u < -w, u > w, v < lowest * w, v > w, w <= 0.0];
        beyond_all &= beyond.iter().rev().fold(0, |bits, &bit| bits << 1 | u32::from(bit));
        behind |= w <= 0.0;
        let scale = half / w;
        let at =
            OnScreen { column: ((u + w) * scale - 0.5) as f32, row: ((v - lowest * w) * scale - 0.5) as f32, flags: 0 };
        match &mut bounds {
            Some(bounds) => bounds.include(at),
            None => bounds = Some(Bounds::new(at)),
        }
    }
    if beyond_all != 0 {
        return None;
    }
    if behind {
        return Some([[0, face.rows(resolution) as u16], [0, resolution as u16]]);
    }
    bounds?.pixels(face, resolution)
}

/// The box around vertices on one face.
struct Bounds {
    least: [f32; 2],
    most: [f32; 2],
    /// Flags that all vertices have, and those that any has.
    all: u32,
    any: u32,
}

impl Bounds {
    fn new(vertex: OnScreen) -> Self {
        let at = [vertex.row, vertex.column];
        Self { least: at, most: at, all: vertex.flags, any: vertex.flags }
    }

    fn include(&mut self, vertex: OnScreen) {
        for (k, at) in [vertex.row, vertex.column].into_iter().enumerate() {
            self.least[k] = if at < self.least[k] { at } else { self.least[k] };
            self.most[k] = if at > self.most[k] { at } else { self.most[k] };
        }
        self.all &= vertex.flags;
        self.any |= vertex.flags;
    }

    /// Rows and columns whose centres are in the box, or next to it by rounding.
    fn pixels(&self, face: Face, resolution: usize) -> Option<[[u16; 2]; 2]> {
        // More than the rounding of a coordinate on the face to f32.
        let slack = resolution as f32 * f32::EPSILON;
        let range = |k: usize, count: usize| {
            let [low, high] = [self.least[k] - slack, self.most[k] + slack];
            if high < 0.0 || low > (count - 1) as f32 {
                return None;
            }
            let first = ceil(f64::from(if low > 0.0 { low } else { 0.0 }));
            let last = if high < (count - 1) as f32 { high as usize } else { count - 1 };
            (first <= last).then_some([first as u16, last as u16 + 1])
        };
        Some([range(0, face.rows(resolution))?, range(1, resolution)?])
    }
}

/// The least integer that is not less than a number from 0 to 2^31.
fn ceil(x: f64) -> usize {
    // Adding it rounds to an integer, which is then in the last bits.
    const SHIFT: f64 = 6_755_399_441_055_744.0;
    let shifted = x + SHIFT;
    let nearest = shifted.to_bits() as u32;
    (nearest + u32::from(shifted - SHIFT < x)) as usize
}

/// The border of a half-space along a row: column = slope * row + offset.
#[derive(Clone, Copy, Debug)]
struct Border {
    slope: f64,
    offset: f64,
}

impl Border {
    fn at(self, row: f64) -> f64 {
        self.slope * row + self.offset
    }
}

/// Consecutive rows of a face.
#[derive(Debug)]
pub(super) struct Band<'a> {
    pub(super) rows: Range<usize>,
    /// Of their pixels.
    pub(super) items: &'a mut [u32],
}

/// How many rows are drawn at a time: faces are drawn in bands that stay in the cache, at the price that pieces in several bands
/// are set up several times.
pub(super) fn band_rows(resolution: usize) -> usize {
    (BAND_PIXELS / resolution).clamp(1, resolution)
}

/// With 8 bytes for each, half of a usual second-level cache.
const BAND_PIXELS: usize = 1 << 15;

/// Draws pieces on one band after the other.
#[derive(Clone, Debug)]
pub(super) struct Rasteriser {
    resolution: usize,
    /// Of a band of rows, 1 over the depth: larger is nearer, and 0 is at infinity.
    nearness: Vec<f32>,
    /// 0, 1, 2 ... for the columns.
    ramp: Vec<f32>,
    left: Vec<Border>,
    right: Vec<Border>,
}

impl Rasteriser {
    pub(super) fn new(resolution: usize) -> Self {
        Self {
            resolution,
            nearness: vec![0.0; band_rows(resolution) * resolution],
            ramp: (0..resolution).map(|k| k as f32).collect(),
            left: Vec::new(),
            right: Vec::new(),
        }
    }

    /// Forgets all depths.
    pub(super) fn clear(&mut self) {
        self.nearness.fill(0.0);
    }

    /// Draws a piece as far as it is in a band of rows of the item buffer. The number of pixels it covers there, hidden or not.
    pub(super) fn draw(
        &mut self,
        face: Face,
        geometry: &Geometry,
        seen: &Seen,
        normal: DVec3,
        draw: &Draw,
        band: &mut Band<'_>,
    ) -> u32 {
        let piece = draw.piece as usize;
        let half = 0.5 * self.resolution as f64;
        // The centre of the first pixel.
        let u0 = 0.5 / half - 1.0;
        let v0 = if face == Face::Top { u0 } else { 0.5 / half };
        let corners = geometry.corners(piece);
        let at = |corner: u32| face.local(seen.positions[corner as usize]);
        let [nu, nv, nw] = face.local(normal.to_array());
        let first = at(corners[0]);
        let height = nu * first[0] + nv * first[1] + nw * first[2];
        if height == 0.0 || height.is_nan() {
            return 0;
        }
        let mut low = usize::from(draw.rows[0]).max(band.rows.start);
        let mut high = usize::from(draw.rows[1]).min(band.rows.end);
        self.left.clear();
        self.right.clear();
        let mut bounding = 0;
        let mut a = at(corners[corners.len() - 1]);
        for &corner in corners {
            let b = at(corner);
            // The half-space is where it has the sign of `height`.
            let [cu, cv, cw] = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
            a = b;
            if cu == 0.0 {
                // All or nothing of each row.
                if cv == 0.0 {
                    if cw != 0.0 && (cw > 0.0) != (height > 0.0) {
                        return 0;
                    }
                    bounding += u32::from(cw != 0.0);
                    continue;
                }
                let row = (-cw / cv - v0) * half;
                let row = ceil(row.clamp(0.0, self.resolution as f64));
                if (cv > 0.0) == (height > 0.0) {
                    low = low.max(row);
                } else {
                    high = high.min(row);
                }
                bounding += 1;
                continue;
            }
            let inverse = 1.0 / cu;
            let slope = -cv * inverse;
            let offset = (slope * v0 - cw * inverse - u0) * half;
            let border = Border { slope, offset };
            if (cu > 0.0) == (height > 0.0) {
                self.left.push(border);
            } else {
                self.right.push(border);
            }
            bounding += 1;
        }
        if bounding < 3 {
            // Less than a pixel, and too small for its edges to have a direction.
            return 0;
        }
        let step = nu / (half * height);
        let row_step = nv / (half * height);
        let origin = (nu * u0 + nv * v0 + nw) / height;
        let [least, most] = draw.columns.map(f64::from);
        let mut covered = 0;
        for row in low..high {
            let y = row as f64;
            let larger = |x: f64, border: &Border| {
                let other = border.at(y);
                if other > x { other } else { x }
            };
            let smaller = |x: f64, border: &Border| {
                let other = border.at(y);
                if other < x { other } else { x }
            };
            let from = self.left.iter().fold(least, larger);
            let to = self.right.iter().fold(most, smaller);
            if from >= to {
                continue;
            }
            let [from, to] = [ceil(from), ceil(to)];
            if from >= to {
                continue;
            }
            covered += (to - from) as u32;
            let start = (origin + row_step * y + step * from as f64) as f32;
            let start_of_row = (row - band.rows.start) * self.resolution;
            let span = start_of_row + from..start_of_row + to;
            fill(&mut self.nearness[span.clone()], &mut band.items[span], &self.ramp, start, step as f32, draw.piece);
        }
        covered
    }
}

impl Draw {
    pub(super) fn piece(&self) -> usize {
        self.piece as usize
    }

    /// Whether it may have pixels in some rows.
    pub(super) fn meets(&self, rows: &Range<usize>) -> bool {
        usize::from(self.rows[0]) < rows.end && usize::from(self.rows[1]) > rows.start
    }
}

/// The depth test along a span. Of equally near pieces the first drawn stays.
fn fill(nearness: &mut [f32], items: &mut [u32], ramp: &[f32], start: f32, step: f32, piece: u32) {
    for ((old, item), &k) in nearness.iter_mut().zip(items).zip(ramp) {
        // Written without a branch, so that it compiles to vector instructions.
        let new = start + step * k;
        let (near, shown) = (*old, *item);
        let mask = 0_u32.wrapping_sub(u32::from(new > near));
        *old = f32::from_bits((new.to_bits() & mask) | (near.to_bits() & !mask));
        *item = (piece & mask) | (shown & !mask);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ceil_is_ceil() {
        for x in [0.0, 5e-324, 0.3, 0.5, 1.0, 1.5, 2.5, 3.0_f64.next_up(), 3.0_f64.next_down(), 4096.0] {
            assert_eq!(ceil(x), x.ceil() as usize, "{x}");
        }
    }
}
