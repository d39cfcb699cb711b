//! From arcs of great circles to polylines.

use super::{Projection, Projector};
use glam::{DVec2, DVec3};
use std::f64::consts::{FRAC_PI_2, PI};

/// Arcs longer than this (as a chord) are halved whatever their picture looks like: an arc that
/// bends both ways may pass through the middle of its chord.
const LONG: f64 = 0.15;
/// Halvings at most; 2^-24 of an arc is below what any picture shows.
const DEPTH: u32 = 24;

impl Projector {
    /// The closed paths of a convex cell: its picture, cut to the window; empty if nothing of it is in
    /// the window. More than one where the picture has a seam.
    ///
    /// `boundary` holds unit directions, counter-clockwise seen from outside of the sphere, less than
    /// pi apart. The paths run clockwise (y up). They leave the true picture by at most `tolerance`, in
    /// the picture's units, or twice that beside a pole of a panorama. Cells that share an arc in part may
    /// round it differently within that: draw them with a hairline of their own colour.
    pub fn cell(&self, boundary: &[DVec3], tolerance: f64) -> Vec<Vec<DVec2>> {
        let mut cell: Vec<DVec3> = boundary.iter().map(|&d| self.frame.components(d)).collect();
        for &clip in &self.clips {
            cell = half(&cell, clip);
        }
        let mut parts = vec![cell];
        for &seam in &self.seams {
            parts = parts.into_iter().flat_map(|part| cut(part, seam)).collect();
        }
        let paths = parts.into_iter().filter(|part| part.len() > 2).map(|part| match self.projection {
            Projection::Stereographic => {
                let part = self.off_antipode(&part).map_or(part.clone(), |plane| half(&part, plane));
                self.inside_window(self.closed(&part, tolerance))
            }
            _ => self.closed(&part, tolerance),
        });
        paths.filter(|path| path.len() > 2).collect()
    }

    /// The polylines of an arc of a great circle, shorter than pi, as far as it is in the window. An arc
    /// along the seam of a panorama appears on one side of it.
    pub fn arc(&self, ends: [DVec3; 2], tolerance: f64) -> Vec<Vec<DVec2>> {
        let mut arcs = vec![ends.map(|d| self.frame.components(d))];
        for &clip in &self.clips {
            arcs = arcs.into_iter().filter_map(|arc| positive_stretch(arc, clip)).collect();
        }
        for &seam in &self.seams {
            let both = |arc| [positive_stretch(arc, seam), positive_stretch(arc, -seam)];
            arcs = arcs
                .into_iter()
                // An arc along the seam belongs to both sides: once is enough.
                .flat_map(|arc| if on_plane(arc, seam) { [Some(arc), None] } else { both(arc) })
                .flatten()
                .collect();
        }
        if self.projection == Projection::Stereographic {
            let cut = |arc: [DVec3; 2]| self.off_antipode(&arc).map_or(Some(arc), |plane| positive_stretch(arc, plane));
            arcs = arcs.into_iter().filter_map(cut).collect();
        }
        let mut lines = Vec::new();
        for arc in arcs {
            let mut line = Vec::new();
            if let [Some(start), Some(end)] = self.places_of_arc(arc) {
                let sector = self.sector(&arc);
                line.push(self.within_sector(start, sector));
                self.bend(arc, [start, end], sector, tolerance, DEPTH, &mut line);
                push_new(&mut line, self.within_sector(end, sector));
            }
            if self.projection == Projection::Stereographic {
                lines.extend(self.lines_inside_window(&line));
            } else if line.len() > 1 {
                lines.push(line);
            }
        }
        lines
    }

    /// The picture of a convex polygon that does not cross a seam.
    fn closed(&self, cell: &[DVec3], tolerance: f64) -> Vec<DVec2> {
        let mut path = Vec::new();
        let sector = self.sector(cell);
        for (k, &from) in cell.iter().enumerate() {
            let to = cell[(k + 1) % cell.len()];
            if let [Some(start), Some(end)] = self.places_of_arc([from, to]) {
                push_new(&mut path, self.within_sector(start, sector));
                self.bend([from, to], [start, end], sector, tolerance, DEPTH, &mut path);
                // At a pole the next arc starts elsewhere.
                push_new(&mut path, self.within_sector(end, sector));
            }
        }
        while path.len() > 1 && path.first() == path.last() {
            path.pop();
        }
        path
    }

    /// Where an arc starts and ends. A pole of a panorama has the longitude of the arc's other end.
    fn places_of_arc(&self, arc: [DVec3; 2]) -> [Option<DVec2>; 2] {
        if self.projection != Projection::Equirectangular {
            return arc.map(|d| Some(self.place(d)).filter(|p| p.is_finite()));
        }
        let is_pole = |d: DVec3| d.x.hypot(d.z) < 1e-12;
        let pole = |d: DVec3, other: DVec3| DVec2::new(self.place(other).x, FRAC_PI_2.copysign(d.y));
        let [a, b] = arc;
        match (is_pole(a), is_pole(b)) {
            (false, false) => arc.map(|d| Some(self.place(d))),
            (true, false) => [Some(pole(a, b)), Some(self.place(b))],
            (false, true) => [Some(self.place(a)), Some(pole(b, a))],
            (true, true) => [None, None],
        }
    }

    /// The longitudes of the part of a panorama, between seams, that a polygon or arc lies in.
    fn sector(&self, part: &[DVec3]) -> [f64; 2] {
        if self.projection != Projection::Equirectangular {
            return [f64::NEG_INFINITY, f64::INFINITY];
        }
        let sum: DVec3 = part.iter().sum();
        let [low, high] = if sum.z >= 0.0 { [0.0, FRAC_PI_2] } else { [FRAC_PI_2, PI] };
        if sum.x >= 0.0 { [low, high] } else { [-high, -low] }
    }

    /// Rounding, or the seam itself, may put a point on the other side of the picture.
    fn within_sector(&self, p: DVec2, [low, high]: [f64; 2]) -> DVec2 {
        if self.projection != Projection::Equirectangular {
            return p;
        }
        let turned = |x: f64| {
            if x < low - 1.0 {
                x + 2.0 * PI
            } else if x > high + 1.0 {
                x - 2.0 * PI
            } else {
                x
            }
        };
        DVec2::new(turned(p.x).clamp(low, high), p.y)
    }

    /// The points inside of an arc that its picture needs.
    fn bend(
        &self,
        [a, b]: [DVec3; 2],
        [p, q]: [DVec2; 2],
        sector: [f64; 2],
        tolerance: f64,
        depth: u32,
        path: &mut Vec<DVec2>,
    ) {
        // Straight lines stay straight.
        if depth == 0 || self.projection == Projection::Gnomonic {
            return;
        }
        let Some(middle) = (a + b).try_normalize() else { return };
        let [p, q] = [p, q].map(|p| self.within_sector(p, sector));
        let place = self.within_sector(self.place(middle), sector);
        let off = place.distance(nearest_on_segment(place, p, q));
        if off <= tolerance && a.distance(b) <= LONG || !place.is_finite() {
            return;
        }
        self.bend([a, middle], [p, place], sector, tolerance, depth - 1, path);
        push_new(path, place);
        self.bend([middle, b], [place, q], sector, tolerance, depth - 1, path);
    }

    /// A plane that cuts the point opposite to `towards`, which has no picture, off a part between seams that
    /// may come near it; what is cut off lies outside of the window.
    fn off_antipode(&self, part: &[DVec3]) -> Option<DVec3> {
        let sum: DVec3 = part.iter().sum();
        if sum.z >= 0.0 {
            return None;
        }
        // The window's corners have the radius h sqrt 2. What |x| + |y| < t |z| drops is less than
        // atan t from the antipode; with the t of radius 2 h it lies outside of the window.
        let outermost = PI - 2.0 * (self.window.high.x * 2.0).atan();
        Some(DVec3::new(1f64.copysign(sum.x), 1f64.copysign(sum.y), outermost.tan()))
    }

    fn inside_window(&self, mut path: Vec<DVec2>) -> Vec<DVec2> {
        for axis in 0..2 {
            for (sign, limit) in [(1.0, self.window.high[axis]), (-1.0, -self.window.low[axis])] {
                let room = |p: DVec2| limit - sign * p[axis];
                if path.iter().all(|&p| room(p) >= 0.0) {
                    continue;
                }
                let mut kept = Vec::with_capacity(path.len() + 2);
                for (k, &p) in path.iter().enumerate() {
                    let q = path[(k + 1) % path.len()];
                    if room(p) >= 0.0 {
                        kept.push(p);
                    }
                    if (room(p) > 0.0 && room(q) < 0.0) || (room(p) < 0.0 && room(q) > 0.0) {
                        kept.push(p.lerp(q, room(p) / (room(p) - room(q))));
                    }
                }
                path = kept;
            }
        }
        path
    }

    fn lines_inside_window(&self, line: &[DVec2]) -> Vec<Vec<DVec2>> {
        let mut lines: Vec<Vec<DVec2>> = Vec::new();
        for pair in line.windows(2) {
            let (mut low, mut high) = (0.0, 1.0);
            let step = pair[1] - pair[0];
            for axis in 0..2 {
                let reach = [self.window.low[axis], self.window.high[axis]].map(|w| (w - pair[0][axis]) / step[axis]);
                let outside = pair[0][axis] < self.window.low[axis] || pair[0][axis] > self.window.high[axis];
                if step[axis] == 0.0 {
                    high = if outside { -1.0 } else { high };
                } else {
                    low = f64::max(low, reach[0].min(reach[1]));
                    high = f64::min(high, reach[0].max(reach[1]));
                }
            }
            if low > high {
                continue;
            }
            // A step taken whole may round to another point than its end, and break the line there.
            let [p, q] = [low, high].map(|t| if t < 1.0 { pair[0] + step * t } else { pair[1] });
            match lines.last_mut() {
                Some(last) if last.last() == Some(&p) => last.push(q),
                _ => lines.push(vec![p, q]),
            }
        }
        lines
    }
}

fn push_new(path: &mut Vec<DVec2>, p: DVec2) {
    if path.last() != Some(&p) {
        path.push(p);
    }
}

fn nearest_on_segment(p: DVec2, a: DVec2, b: DVec2) -> DVec2 {
    let ab = b - a;
    let along = (p - a).dot(ab) / ab.length_squared();
    if along.is_finite() { a + ab * along.clamp(0.0, 1.0) } else { a }
}

/// Where the arc crosses the plane, as a unit vector: the heights have opposite signs.
fn crossing([a, b]: [DVec3; 2], [above, below]: [f64; 2]) -> DVec3 {
    ((a * below - b * above) * (below - above).signum()).normalize_or(a)
}

/// Heights within rounding of a plane count as on it.
fn height(d: DVec3, plane: DVec3) -> f64 {
    let height = d.dot(plane);
    if height.abs() <= 1e-15 * plane.length() { 0.0 } else { height }
}

fn on_plane(arc: [DVec3; 2], plane: DVec3) -> bool {
    arc.into_iter().all(|d| height(d, plane) == 0.0)
}

/// The part of a convex polygon on the positive side of a plane through the eye; empty if none.
fn half(cell: &[DVec3], plane: DVec3) -> Vec<DVec3> {
    let mut kept = Vec::with_capacity(cell.len() + 1);
    let mut inside = false;
    for (k, &a) in cell.iter().enumerate() {
        let b = cell[(k + 1) % cell.len()];
        let (here, there) = (height(a, plane), height(b, plane));
        inside |= here > 0.0;
        if here >= 0.0 {
            kept.push(a);
        }
        if here * there < 0.0 {
            kept.push(crossing([a, b], [here, there]));
        }
    }
    if inside { kept } else { Vec::new() }
}

/// Both parts of a convex polygon, without empty ones.
fn cut(cell: Vec<DVec3>, plane: DVec3) -> Vec<Vec<DVec3>> {
    let heights = cell.iter().map(|&d| height(d, plane));
    let (low, high) = heights.fold((0.0, 0.0), |(l, h), x| (f64::min(l, x), f64::max(h, x)));
    if low < 0.0 && high > 0.0 { vec![half(&cell, plane), half(&cell, -plane)] } else { vec![cell] }
}

/// The part of an arc on the positive side.
fn positive_stretch(arc: [DVec3; 2], plane: DVec3) -> Option<[DVec3; 2]> {
    let heights = arc.map(|d| height(d, plane));
    match heights.map(|h| h >= 0.0) {
        [true, true] => Some(arc),
        [true, false] if heights[0] > 0.0 => Some([arc[0], crossing(arc, heights)]),
        [false, true] if heights[1] > 0.0 => Some([crossing(arc, heights), arc[1]]),
        _ => None,
    }
}
