//! Surfaces that hang together, and whether their fronts agree.

use super::super::flat::unit_scale;
use super::super::{PolygonId, PolygonRef, Scene};
use super::edges::{Use, oriented_rings};
use super::volume::volume;
use super::{Component, Fronts, Orientation};
use crate::exact::{Sign, U};
use glam::DVec3;

/// The components, by their first polygons, and the polygons that are inverted; n log n.
pub(super) fn components(scene: &Scene, uses: &[Use]) -> (Vec<Component>, Vec<PolygonId>) {
    let mut forest = Forest::new(scene.polygon_count());
    let edges = || uses.chunk_by(|a, b| a.edge == b.edge);
    for pair in edges() {
        if let [a, b] = pair {
            forest.join(a.polygon, b.polygon, a.against == b.against);
        }
    }
    let mut open = vec![false; scene.polygon_count()];
    for group in edges().filter(|group| group.len() != 2) {
        for pass in group {
            let root = forest.find(pass.polygon.index()).0;
            open[root] = true;
        }
    }
    let scale = unit_scale(scene.vertices().iter().copied());
    let mut inverted = Vec::new();
    let mut found = Vec::new();
    for members in members(scene, &mut forest) {
        let root = forest.find(members[0].0.index()).0;
        let closed = !open[root];
        let mut orientation = Orientation::Consistent;
        if forest.contradicts[root] {
            orientation = Orientation::NonOrientable;
        } else if members.iter().any(|member| member.1 != members[0].1) {
            match lesser_side(scene, &members, scale) {
                Some(lesser) => {
                    orientation = Orientation::SomeInverted;
                    inverted.extend(members.iter().filter(|member| member.1 == lesser).map(|member| member.0));
                }
                None => orientation = Orientation::Undecided,
            }
        }
        let enclosed = (closed && orientation == Orientation::Consistent).then(|| {
            let triangles: Vec<_> = members.iter().flat_map(|member| fans(scene.polygon(member.0))).collect();
            volume(&triangles)
        });
        let fronts = match enclosed.map(|(sign, _)| sign) {
            Some(Sign::Positive) => Some(Fronts::Outwards),
            Some(Sign::Negative) => Some(Fronts::Inwards),
            Some(Sign::Zero) | None => None,
        };
        found.push(Component {
            first: members[0].0,
            polygons: members.len(),
            closed,
            orientation,
            fronts,
            volume: enclosed.map(|(_, size)| size),
        });
    }
    inverted.sort_unstable();
    (found, inverted)
}

/// Sets of polygons, each with a turn: whether its front is on the other side than that of the set's root.
struct Forest {
    parent: Vec<(u32, bool)>,
    size: Vec<u32>,
    /// For roots: whether some polygon would have to have its front on both sides.
    contradicts: Vec<bool>,
}

impl Forest {
    fn new(count: usize) -> Self {
        let parent = (0..count as u32).map(|k| (k, false)).collect();
        Self { parent, size: vec![1; count], contradicts: vec![false; count] }
    }

    /// The root, and the turn against it. Halves the way to the root.
    fn find(&mut self, polygon: usize) -> (usize, bool) {
        let (mut at, mut turned) = (polygon, false);
        loop {
            let (parent, turn) = self.parent[at];
            let parent = parent as usize;
            if parent == at {
                return (at, turned);
            }
            let (grandparent, next) = self.parent[parent];
            // A root is its own parent, without a turn.
            self.parent[at] = (grandparent, turn != next);
            turned ^= turn != next;
            at = grandparent as usize;
        }
    }

    /// Notes that two polygons are neighbours, and whether their fronts are on different sides.
    fn join(&mut self, a: PolygonId, b: PolygonId, turned: bool) {
        let ((mut a, turn_a), (mut b, turn_b)) = (self.find(a.index()), self.find(b.index()));
        let turn = turned != (turn_a != turn_b);
        if a == b {
            self.contradicts[a] |= turn;
            return;
        }
        if self.size[a] < self.size[b] {
            std::mem::swap(&mut a, &mut b);
        }
        self.parent[b] = (a as u32, turn);
        self.size[a] += self.size[b];
        self.contradicts[a] |= self.contradicts[b];
    }
}

/// The polygons with area of each component, ascending, with their turns; the components by their first polygons.
fn members(scene: &Scene, forest: &mut Forest) -> Vec<Vec<(PolygonId, bool)>> {
    let mut places: Vec<Option<usize>> = vec![None; scene.polygon_count()];
    let mut members: Vec<Vec<_>> = Vec::new();
    for polygon in scene.polygons().filter(|polygon| polygon.pieces().len() > 0) {
        let (root, turned) = forest.find(polygon.id().index());
        let place = *places[root].get_or_insert(members.len());
        if place == members.len() {
            members.push(Vec::new());
        }
        members[place].push((polygon.id(), turned));
    }
    members
}

/// Which of both sides has less area; `None` if it takes more than rounded areas to tell.
fn lesser_side(scene: &Scene, members: &[(PolygonId, bool)], scale: f64) -> Option<bool> {
    let mut sums = [0.0; 2];
    let mut bound = 0.0;
    for side in [false, true] {
        let members = members.iter().filter(|member| member.1 == side);
        let mut areas: Vec<_> = members.map(|member| area(scene.polygon(member.0), scale)).collect();
        // So that the order of the polygons does not matter.
        areas.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
        for (area, error) in areas {
            sums[usize::from(side)] += area;
            bound += error;
        }
    }
    bound += members.len() as f64 * U * (sums[0] + sums[1]);
    let difference = sums[0] - sums[1];
    (difference.abs() > bound).then_some(difference > 0.0)
}

/// Twice the area of a polygon, in scaled units, and a bound of its rounding error.
fn area(polygon: PolygonRef<'_>, scale: f64) -> (f64, f64) {
    let (mut sum, mut bound) = (0.0, 0.0);
    for piece in polygon.pieces() {
        let points: Vec<DVec3> = piece.points().collect();
        let offset = |p: DVec3| p * scale - points[0] * scale;
        let (mut normal, mut lengths) = (DVec3::ZERO, 0.0);
        for pair in points.windows(2) {
            let [a, b] = [offset(pair[0]), offset(pair[1])];
            normal += a.cross(b);
            lengths += a.length() * b.length();
        }
        sum += normal.length();
        // Each of three components of a cross product is off by 5 u of the product of the lengths, each addition by u.
        bound += 2.0 * (10 + points.len()) as f64 * U * lengths;
    }
    (sum, bound)
}

/// Triangles that fill the rings of a polygon, each from its first vertex, in the direction that makes the polygon. Where
/// it is not planar they are not its pieces.
fn fans(polygon: PolygonRef<'_>) -> Vec<[DVec3; 3]> {
    let mut triangles = Vec::new();
    for (ring, reversed) in oriented_rings(polygon) {
        for k in 1..ring.len().saturating_sub(1) {
            let [a, b, c] = [ring[0], ring[k], ring[k + 1]].map(|v| polygon.scene.vertex(v));
            triangles.push(if reversed { [a, c, b] } else { [a, b, c] });
        }
    }
    triangles
}
