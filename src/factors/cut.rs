//! Cutting the cells of a mesh along segments, such that it stays free of T-junctions: where a segment meets the side of a cell, all cells that have that side get a corner
//! there, whichever facet they are in.

use super::shape::{Frame, double_area, sides, turn};
use glam::{DVec2, DVec3};
use rustc_hash::FxHashMap;
use spade::{ConstrainedDelaunayTriangulation, Point2, Triangulation};

/// Corners are no nearer to each other than about this part of the sides of a cell: cuts are moved by as much at most.
const SNAP: f64 = 1e-4;

/// A convex cell of a facet, counter-clockwise seen from its front.
pub(super) struct Cell<'a> {
    frame: &'a Frame,
    ring: &'a [DVec3],
    /// The segments of its facet.
    segments: &'a [[DVec2; 2]],
}

/// A point by its bits, so that equal ones are the same.
pub(super) type Key = [u64; 3];

pub(super) fn key(p: DVec3) -> Key {
    p.to_array().map(|x| (x + 0.0).to_bits())
}

/// The sides of cells, each by its ends in their order, with the places from 0 to 1 at which segments meet it.
#[derive(Default)]
pub(super) struct Places {
    of: FxHashMap<[Key; 2], Vec<f64>>,
}

impl Places {
    /// Notes where the segments of a cell meet its sides.
    pub(super) fn note(&mut self, cell: &Cell<'_>) {
        let near = cell.near_segments();
        if near.is_empty() {
            return;
        }
        for [a, b] in sides(cell.ring) {
            let [a, b] = if key(a) < key(b) { [a, b] } else { [b, a] };
            let [p, q] = [a, b].map(|p| cell.frame.flat(p));
            let met: Vec<f64> = near.iter().flat_map(|&segment| meetings([p, q], segment)).flatten().collect();
            if !met.is_empty() {
                self.of.entry([key(a), key(b)]).or_default().extend(met);
            }
        }
    }

    /// Leaves one of those that are as good as one.
    pub(super) fn settle(&mut self) {
        for places in self.of.values_mut() {
            places.sort_unstable_by(f64::total_cmp);
            places.dedup_by(|next, kept| *next - *kept < SNAP);
        }
    }

    /// The ring with the corners that segments add to it, and the side that each corner is on or begins.
    fn outline(&self, ring: &[DVec3]) -> (Vec<DVec3>, Vec<usize>) {
        let (mut outline, mut on) = (Vec::new(), Vec::new());
        for (side, [a, b]) in sides(ring).enumerate() {
            outline.push(a);
            let is_along = key(a) < key(b);
            let [low, high] = if is_along { [a, b] } else { [b, a] };
            let places = self.of.get(&[key(low), key(high)]).map_or(&[][..], Vec::as_slice);
            let point = |&t: &f64| low.lerp(high, t);
            if is_along {
                outline.extend(places.iter().map(point));
            } else {
                outline.extend(places.iter().rev().map(point));
            }
            on.resize(outline.len(), side);
        }
        (outline, on)
    }
}

/// Where a segment meets a side, from 0 to 1 and not at its ends; nowhere if it runs along it.
fn meetings([p, q]: [DVec2; 2], segment: [DVec2; 2]) -> [Option<f64>; 2] {
    let length = p.distance(q);
    let heights = segment.map(|s| turn(p, q, s) / length);
    let along = segment.map(|s| (q - p).dot(s - p) / (length * length));
    let is_on = heights.map(|height| height.abs() <= SNAP * length);
    let inner = |t: f64| (SNAP..=1.0 - SNAP).contains(&t).then_some(t);
    match is_on {
        [true, false] => [inner(along[0]), None],
        [false, true] => [inner(along[1]), None],
        [false, false] if (heights[0] < 0.0) != (heights[1] < 0.0) => {
            let part = heights[0] / (heights[0] - heights[1]);
            [inner(along[0] + (along[1] - along[0]) * part), None]
        }
        _ => [None; 2],
    }
}

impl<'a> Cell<'a> {
    /// In the plane of a facet with these segments.
    pub(super) fn of((frame, segments): (&'a Frame, &'a [[DVec2; 2]]), ring: &'a [DVec3]) -> Self {
        Self { frame, ring, segments }
    }

    fn flat(&self) -> Vec<DVec2> {
        self.ring.iter().map(|&p| self.frame.flat(p)).collect()
    }

    /// The segments whose rectangles meet that of the cell.
    fn near_segments(&self) -> Vec<[DVec2; 2]> {
        if self.segments.is_empty() {
            return Vec::new();
        }
        let flat = self.flat();
        let low = flat.iter().fold(DVec2::INFINITY, |low, &p| low.min(p));
        let high = flat.iter().fold(DVec2::NEG_INFINITY, |high, &p| high.max(p));
        let reach = SNAP * (high - low).max_element();
        let meets = |&[p, q]: &[DVec2; 2]| p.min(q).cmple(high + reach).all() && p.max(q).cmpge(low - reach).all();
        self.segments.iter().copied().filter(meets).collect()
    }

    /// The parts of the cell between its segments, and those that have to have the corners of neighbours.
    pub(super) fn cut(&self, places: &Places) -> Vec<Vec<DVec3>> {
        let (outline, on) = places.outline(self.ring);
        let near = self.near_segments();
        if near.is_empty() && outline.len() == self.ring.len() {
            return vec![outline];
        }
        let mut net = Net::of(self, outline, on);
        for &segment in &near {
            net.add(segment);
        }
        net.cross();
        net.parts()
    }

    /// True if an edge within the cell's facet runs along one of its segments.
    pub(super) fn is_along_segment(&self, edge: [DVec3; 2]) -> bool {
        let [p, q] = edge.map(|p| self.frame.flat(p));
        let reach = 4.0 * SNAP * self.size();
        self.segments.iter().any(|&[s, e]| {
            let length = s.distance(e);
            let is_near = |r: DVec2| {
                let along = (e - s).dot(r - s) / length;
                turn(s, e, r).abs() <= reach * length && (-reach..=length + reach).contains(&along)
            };
            length > 0.0 && is_near(p) && is_near(q)
        })
    }

    /// The length of its longest side.
    fn size(&self) -> f64 {
        sides(self.ring).map(|[a, b]| a.distance(b)).fold(0.0, f64::max)
    }
}

/// Chords within a cell, between numbered nodes, those of the outline first.
struct Net<'a> {
    frame: &'a Frame,
    ring: Vec<DVec2>,
    points: Vec<DVec3>,
    flat: Vec<DVec2>,
    /// The side that each node of the outline is on or begins.
    on: Vec<usize>,
    chords: Vec<[usize; 2]>,
    reach: f64,
}

impl<'a> Net<'a> {
    fn of(cell: &Cell<'a>, points: Vec<DVec3>, on: Vec<usize>) -> Self {
        let flat = points.iter().map(|&p| cell.frame.flat(p)).collect();
        Self {
            frame: cell.frame,
            ring: cell.flat(),
            points,
            flat,
            on,
            chords: Vec::new(),
            reach: 4.0 * SNAP * cell.size(),
        }
    }

    /// The node at a place; a new one if there is none near it and there may be.
    fn node(&mut self, at: DVec2, may_be_new: bool) -> Option<usize> {
        let distance = |k: &usize| self.flat[*k].distance(at);
        let nearest = (0..self.flat.len()).min_by(|a, b| distance(a).total_cmp(&distance(b)));
        if let Some(node) = nearest.filter(|node| distance(node) <= self.reach) {
            return Some(node);
        }
        may_be_new.then(|| {
            self.flat.push(at);
            self.points.push(self.frame.lift(at));
            self.flat.len() - 1
        })
    }

    /// Adds what of a segment is inside as a chord, unless it runs along a side.
    fn add(&mut self, [p, q]: [DVec2; 2]) {
        let (mut from, mut to) = (0.0, 1.0_f64);
        for [a, b] in sides(&self.ring) {
            let (at_p, at_q) = (turn(a, b, p), turn(a, b, q));
            if at_p <= 0.0 && at_q <= 0.0 {
                return;
            }
            let crossing = at_p / (at_p - at_q);
            if at_p < 0.0 {
                from = f64::max(from, crossing);
            }
            if at_q < 0.0 {
                to = to.min(crossing);
            }
        }
        if (to - from) * p.distance(q) <= self.reach {
            return;
        }
        // Where it enters and leaves, the outline has corners already, unless that is beside one.
        let ends = [(from, from <= 0.0), (to, to >= 1.0)];
        let nodes = ends.map(|(t, is_end)| self.node(p.lerp(q, t), is_end && self.is_well_inside(p.lerp(q, t))));
        let [Some(a), Some(b)] = nodes else { return };
        if a != b && !self.is_on_one_side(a, b) && !self.chords.contains(&[a.min(b), a.max(b)]) {
            self.chords.push([a.min(b), a.max(b)]);
        }
    }

    fn is_well_inside(&self, at: DVec2) -> bool {
        sides(&self.ring).all(|[a, b]| turn(a, b, at) > 0.25 * self.reach * a.distance(b))
    }

    /// True for two nodes of the outline that are on the same side of the cell.
    fn is_on_one_side(&self, a: usize, b: usize) -> bool {
        let (Some(&low), Some(&high)) = (self.on.get(a.min(b)), self.on.get(a.max(b))) else { return false };
        // The first node of the next side ends this one.
        let begins = |node: usize| node == 0 || self.on[node - 1] != self.on[node];
        let next = (low + 1) % self.ring.len();
        let is_last_to_first = begins(a.min(b)) && (high + 1) % self.ring.len() == low;
        low == high || high == next && begins(a.max(b)) || is_last_to_first
    }

    /// Gives chords nodes where they cross each other, or pass by one.
    fn cross(&mut self) {
        let chords = self.chords.clone();
        for (k, &[a, b]) in chords.iter().enumerate() {
            for &[c, d] in &chords[k + 1..] {
                let [p, q, r, s] = [a, b, c, d].map(|node| self.flat[node]);
                let (at_r, at_s) = (turn(p, q, r), turn(p, q, s));
                let (at_p, at_q) = (turn(r, s, p), turn(r, s, q));
                if at_r * at_s < 0.0 && at_p * at_q < 0.0 {
                    self.node(p.lerp(q, at_p / (at_p - at_q)), true);
                }
            }
        }
        let mut divided: Vec<[usize; 2]> = Vec::new();
        for [a, b] in chords {
            let [p, q] = [a, b].map(|node| self.flat[node]);
            let length = p.distance(q);
            let place = |k: usize| (q - p).dot(self.flat[k] - p) / length;
            let is_between = |&k: &usize| {
                let off = turn(p, q, self.flat[k]).abs() / length;
                k != a && k != b && off <= self.reach && place(k) > 0.0 && place(k) < length
            };
            let mut nodes: Vec<usize> = (0..self.flat.len()).filter(is_between).collect();
            nodes.sort_unstable_by(|&m, &n| place(m).total_cmp(&place(n)));
            let all: Vec<usize> = [a].into_iter().chain(nodes).chain([b]).collect();
            divided.extend(all.windows(2).map(|ends| [ends[0].min(ends[1]), ends[0].max(ends[1])]));
        }
        divided.retain(|&[a, b]| !self.is_on_one_side(a, b));
        divided.sort_unstable();
        divided.dedup();
        self.chords = divided;
    }

    fn parts(&self) -> Vec<Vec<DVec3>> {
        let outline: Vec<usize> = (0..self.on.len()).collect();
        if self.chords.is_empty() && outline.len() == self.ring.len() {
            return vec![self.points.clone()];
        }
        let rings = if self.flat.len() == outline.len() {
            // Chords from side to side.
            let mut parts = vec![outline];
            for &[a, b] in &self.chords {
                let Some(place) = parts.iter().position(|part| part.contains(&a) && part.contains(&b)) else {
                    continue;
                };
                let mut part = parts.swap_remove(place);
                let first = part.iter().position(|&node| node == a).unwrap_or(0);
                part.rotate_left(first);
                let last = part.iter().position(|&node| node == b).unwrap_or(0);
                let other = part[last..].iter().copied().chain([a]).collect();
                part.truncate(last + 1);
                parts.extend([part, other]);
            }
            parts.retain(|part| part.len() > 2);
            parts
                .into_iter()
                .flat_map(|part| if self.is_plain(&part) { vec![part] } else { self.filled(&part, &[]) })
                .collect()
        } else {
            self.filled(&outline, &self.chords)
        };
        rings.into_iter().map(|ring: Vec<usize>| ring.into_iter().map(|node| self.points[node]).collect()).collect()
    }

    /// True for triangles and quadrilaterals with corners that are corners.
    fn is_plain(&self, ring: &[usize]) -> bool {
        let corner = |k: usize| self.flat[ring[k % ring.len()]];
        let turns = (0..ring.len()).all(|k| {
            let [a, b, c] = [0, 1, 2].map(|next| corner(k + next));
            turn(a, b, c) > SNAP * a.distance(b) * b.distance(c)
        });
        ring.len() <= 4 && turns
    }

    /// The triangles of a convex ring, which may have corners that are none, with all other nodes if there are chords.
    fn filled(&self, ring: &[usize], chords: &[[usize; 2]]) -> Vec<Vec<usize>> {
        self.triangulated(ring, chords).unwrap_or_else(|| {
            // Chords are nearer to each other than numbers hold: it stays as it is, with the corners of its neighbours.
            let best = (0..ring.len()).max_by(|&a, &b| self.least_turn(ring, a).total_cmp(&self.least_turn(ring, b)));
            let mut ring = ring.to_vec();
            ring.rotate_left(best.unwrap_or(0));
            ring[1..].windows(2).map(|pair| vec![ring[0], pair[0], pair[1]]).collect()
        })
    }

    /// Of the fan of triangles from one node, the least area.
    fn least_turn(&self, ring: &[usize], first: usize) -> f64 {
        let at = |k: usize| self.flat[ring[(first + k) % ring.len()]];
        (1..ring.len() - 1).map(|k| turn(at(0), at(k), at(k + 1))).fold(f64::INFINITY, f64::min)
    }

    fn triangulated(&self, ring: &[usize], chords: &[[usize; 2]]) -> Option<Vec<Vec<usize>>> {
        let mut mesh = ConstrainedDelaunayTriangulation::<Point2<f64>>::new();
        let inner = if chords.is_empty() { 0..0 } else { self.on.len()..self.flat.len() };
        let nodes: Vec<usize> = ring.iter().copied().chain(inner).collect();
        let (origin, size) = (self.flat[ring[0]], self.reach / (4.0 * SNAP));
        let mut handle = FxHashMap::default();
        for &node in &nodes {
            // Near 1, which is where it takes numbers as they are.
            let p = (self.flat[node] - origin) / size;
            handle.insert(node, mesh.insert(Point2::new(p.x, p.y)).ok()?);
        }
        if mesh.num_vertices() != nodes.len() {
            return None;
        }
        for [a, b] in sides(ring).chain(chords.iter().copied()) {
            let [from, to] = [handle[&a], handle[&b]];
            if mesh.try_add_constraint(from, to).is_empty() && !mesh.exists_constraint(from, to) {
                return None;
            }
        }
        let points = |face: &[usize]| face.iter().map(|&node| self.points[node]).collect::<Vec<_>>();
        let all = mesh.inner_faces().map(|face| face.vertices().map(|vertex| nodes[vertex.index()]).to_vec());
        // Between nodes of one side rounding may leave triangles outside of it.
        let longest =
            |face: &[usize]| sides(face).map(|[a, b]| self.flat[a].distance(self.flat[b])).fold(0.0, f64::max);
        let faces: Vec<Vec<usize>> =
            all.filter(|face| double_area(&points(face)).length() > 2e-9 * longest(face).powi(2)).collect();
        let sum: f64 = faces.iter().map(|face| double_area(&points(face)).length()).sum();
        let whole = double_area(&points(ring)).length();
        ((sum - whole).abs() <= 1e-9 * whole).then_some(faces)
    }
}
