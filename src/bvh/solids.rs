//! Solids: parts of a scene that are proved to bound a volume, so that their inside is not seen from outside.
//!
//! Pieces that share edges form a component. It is a solid if
//! - every edge has exactly two pieces, which run along it in opposite ways: the component is closed and oriented;
//! - no two of its pieces meet but in vertices and edges that they share, by exact signs;
//! - its volume has a sure sign, which tells the outside.
//!
//! Such a surface has an inside and an outside (Jordan and Brouwer), and a ray from outside of its box meets it first from
//! outside. What is not proved is no solid: that costs time, never a wrong image.

use crate::bsp::{Bounds, Skeleton};
use crate::exact::{Sign, U, orient3d, power_of_two_at_most};
use crate::scene::{PieceId, PieceRef, Scene, Side, VertexId};
use glam::DVec3;
use std::cmp::Ordering;

const NONE: u32 = u32::MAX;
/// Pairs of boxes that may be compared, for each piece of a component, before it is given up.
const PAIRS: usize = 50;

/// A closed and oriented component.
#[derive(Clone, Debug)]
struct Component {
    bounds: Bounds,
    pieces: usize,
    /// The side of its pieces that faces the inside, if it is proved to be a solid.
    inside: Option<Side>,
}

/// A closed and oriented part of a scene that does not pass through itself.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Solid {
    pub(crate) number: u32,
    pub(crate) bounds: Bounds,
    /// The side of its pieces that faces the inside.
    pub(crate) inside: Side,
}

#[derive(Clone, Debug)]
pub(super) struct Solids {
    components: Vec<Component>,
    /// The component that a piece is part of.
    component_of: Vec<u32>,
}

impl Solids {
    pub(super) fn of(scene: &Scene, skeleton: &Skeleton, bounds: &[Bounds]) -> Self {
        Self::with_verdicts(scene, bounds, |pieces| Surface { scene, skeleton, bounds, pieces }.proved_inside())
    }

    /// Those of a scene with objects moved. What no piece has moved of, come to or left is what it was; `before` tells of each piece
    /// the number it had, if it has not moved.
    pub(super) fn moved(
        &self,
        scene: &Scene,
        skeleton: &Skeleton,
        bounds: &[Bounds],
        before: &[Option<PieceId>],
    ) -> Self {
        Self::with_verdicts(scene, bounds, |pieces| match self.known(pieces, before) {
            Some(known) => known.inside,
            None => Surface { scene, skeleton, bounds, pieces }.proved_inside(),
        })
    }

    fn with_verdicts(scene: &Scene, bounds: &[Bounds], inside: impl Fn(&[PieceId]) -> Option<Side>) -> Self {
        let mut found = Self { components: Vec::new(), component_of: vec![NONE; scene.piece_count()] };
        for pieces in closed_components(scene) {
            for piece in &pieces {
                found.component_of[piece.index()] = found.components.len() as u32;
            }
            let around = pieces.iter().fold(Bounds::EMPTY, |all, piece| all.union(bounds[piece.index()]));
            found.components.push(Component { bounds: around, pieces: pieces.len(), inside: inside(&pieces) });
        }
        found
    }

    /// The component that was made of exactly these pieces, which are one now.
    ///
    /// If none of them has moved and one was part of a component, that was these: each edge had the two pieces that it has now, and as it
    /// was closed, no more.
    fn known(&self, pieces: &[PieceId], before: &[Option<PieceId>]) -> Option<&Component> {
        if pieces.iter().any(|piece| before[piece.index()].is_none()) {
            return None;
        }
        let first = before[pieces.first()?.index()]?;
        self.components.get(self.component_of[first.index()] as usize)
    }

    pub(super) fn piece_count(&self) -> usize {
        self.components.iter().filter(|component| component.inside.is_some()).map(|component| component.pieces).sum()
    }

    /// The solid that a piece is part of.
    pub(super) fn solid_of(&self, piece: PieceId) -> Option<Solid> {
        let component = self.component_of[piece.index()];
        let Component { bounds, inside, .. } = self.components.get(component as usize)?;
        inside.map(|inside| Solid { number: component, bounds: *bounds, inside })
    }

    /// True if [`Solids::is_inside`] says the same of both pieces, from wherever they are seen.
    pub(super) fn are_hidden_together(&self, a: PieceId, b: PieceId) -> bool {
        let [a, b] = [a, b].map(|piece| self.component_of[piece.index()]);
        let is_solid = |component: u32| self.components.get(component as usize).is_some_and(|c| c.inside.is_some());
        a == b || !(is_solid(a) || is_solid(b))
    }

    /// True if that side of a piece faces the inside of a solid that the eye is certainly outside of.
    pub(super) fn is_inside(&self, piece: PieceId, shown: Side, eye: DVec3) -> bool {
        let Some(component) = self.components.get(self.component_of[piece.index()] as usize) else { return false };
        let Bounds { low, high } = component.bounds;
        component.inside == Some(shown) && (eye.cmplt(low) | eye.cmpgt(high)).any()
    }
}

/// The components, joined at edges, of which every edge has two pieces that run along it in opposite ways.
fn closed_components(scene: &Scene) -> Vec<Vec<PieceId>> {
    // The first pieces along each edge, in either direction, and whether there are more.
    let mut along = vec![[NONE; 2]; scene.edges().len()];
    let mut parent: Vec<u32> = (0..scene.piece_count() as u32).collect();
    let mut is_open = vec![false; scene.piece_count()];
    for piece in scene.pieces() {
        for (vertex, edge) in piece.vertices().iter().zip(piece.edges()) {
            let way = usize::from(scene.edges()[edge.index()][0] == *vertex);
            let slots = &mut along[edge.index()];
            for other in slots.iter().copied().filter(|&other| other != NONE) {
                let (a, b) = (root(&mut parent, other), root(&mut parent, piece.id().0));
                parent[a.max(b) as usize] = a.min(b);
            }
            if slots[way] == NONE {
                slots[way] = piece.id().0;
            } else {
                is_open[piece.id().index()] = true;
            }
        }
    }
    for slots in &along {
        if let [piece, NONE] | [NONE, piece] = *slots
            && piece != NONE
        {
            is_open[piece as usize] = true;
        }
    }
    for piece in 0..scene.piece_count() as u32 {
        if is_open[piece as usize] {
            let root = root(&mut parent, piece);
            is_open[root as usize] = true;
        }
    }
    let mut place = vec![NONE; scene.piece_count()];
    let mut components: Vec<Vec<PieceId>> = Vec::new();
    for piece in 0..scene.piece_count() as u32 {
        let root = root(&mut parent, piece) as usize;
        if is_open[root] {
            continue;
        }
        if place[root] == NONE {
            place[root] = components.len() as u32;
            components.push(Vec::new());
        }
        components[place[root] as usize].push(PieceId(piece));
    }
    components
}

fn root(parent: &mut [u32], mut k: u32) -> u32 {
    while parent[k as usize] != k {
        parent[k as usize] = parent[parent[k as usize] as usize];
        k = parent[k as usize];
    }
    k
}

struct Surface<'a> {
    scene: &'a Scene,
    skeleton: &'a Skeleton,
    bounds: &'a [Bounds],
    pieces: &'a [PieceId],
}

impl Surface<'_> {
    /// The side that faces the inside, if the surface is proved to bound a solid.
    fn proved_inside(&self) -> Option<Side> {
        self.inside().filter(|_| self.is_embedded())
    }

    /// The side that faces the inside, by the sign of the volume, if rounding leaves no doubt.
    fn inside(&self) -> Option<Side> {
        let from = self.scene.piece(*self.pieces.first()?).points().next()?;
        let all = || self.pieces.iter().flat_map(|&piece| self.scene.piece(piece).points());
        let most = all().fold(0.0, |most: f64, p| most.max((p - from).abs().max_element()));
        // A power of two, so that nothing is rounded and products are numbers.
        let unit = power_of_two_at_most(most);
        if !((1.0 / unit).is_normal() && most >= unit) {
            return None;
        }
        let (mut volume, mut size, mut terms) = (0.0, 0.0, 0.0);
        for &piece in self.pieces {
            let points: Vec<DVec3> = self.scene.piece(piece).points().map(|p| (p - from) / unit).collect();
            for k in 2..points.len() {
                let [a, b, c] = [points[0], points[k - 1], points[k]];
                volume += a.dot(b.cross(c));
                size += a.abs().dot(cross_of_sizes(b.abs(), c.abs()));
                terms += 1.0;
            }
        }
        // A difference is off by u relatively, so each of the products of a term by (1 + u)^3 and the roundings of the
        // products and sums of the term, 5 more; adding the terms up by as many u as there are. Underflow is far below.
        let bound = (terms + 16.0) * 2.0 * U * size + 1e-290;
        match volume {
            v if !bound.is_finite() || v.is_nan() => None,
            v if v > bound => Some(Side::Back),
            v if v < -bound => Some(Side::Front),
            _ => None,
        }
    }

    /// True if no two pieces meet but where they share vertices.
    fn is_embedded(&self) -> bool {
        let mut by_x: Vec<PieceId> = self.pieces.to_vec();
        let low = |piece: &PieceId| self.bounds[piece.index()].low.x;
        by_x.sort_by(|a, b| low(a).total_cmp(&low(b)).then(a.cmp(b)));
        let mut pairs = PAIRS * by_x.len();
        for (k, &first) in by_x.iter().enumerate() {
            let reach = &self.bounds[first.index()];
            for &second in by_x[k + 1..].iter().take_while(|piece| low(piece) <= reach.high.x) {
                if pairs == 0 {
                    return false;
                }
                pairs -= 1;
                let other = &self.bounds[second.index()];
                let apart = (other.low.cmpgt(reach.high) | other.high.cmplt(reach.low)).any();
                if !apart && !self.are_disjoint(self.scene.piece(first), self.scene.piece(second)) {
                    return false;
                }
            }
        }
        true
    }

    /// True if two pieces certainly do not meet but in one vertex or one edge that they share.
    fn are_disjoint(&self, a: PieceRef<'_>, b: PieceRef<'_>) -> bool {
        let shared = a.vertices().iter().filter(|v| b.vertices().contains(v)).count();
        let shares_edge = a.edges().iter().any(|edge| b.edges().contains(edge));
        if shared > 2 || (shared == 2 && !shares_edge) {
            return false;
        }
        self.is_beside(a, b) || self.is_beside(b, a) || !(self.may_pierce(a, b) || self.may_pierce(b, a))
    }

    /// True if all of `b` is on one side of the plane of `a` or touches it, and what of it touches it meets `a` only in what they share.
    fn is_beside(&self, a: PieceRef<'_>, b: PieceRef<'_>) -> bool {
        let sides = b.vertices().iter().map(|&vertex| self.skeleton.vertex_side(a.plane_id(), vertex));
        let (mut above, mut below, mut touching) = (false, false, Vec::new());
        for (&vertex, side) in b.vertices().iter().zip(sides) {
            match side {
                Sign::Positive => above = true,
                Sign::Negative => below = true,
                Sign::Zero => touching.push(vertex),
            }
        }
        if above && below {
            return false;
        }
        let is_shared = |v: &VertexId| a.vertices().contains(v);
        let is_flat = touching.len() == b.vertices().len();
        if !is_flat && touching.iter().all(is_shared) {
            return true;
        }
        // Any point off the plane will do: if this one were on it, all sides would be 0.
        let normal = self.skeleton.approx_normal(a.plane_id()).v;
        let off = a.points().next().map_or(DVec3::ZERO, |p| p + normal * p.abs().max_element().max(1e-100));
        self.is_beside_edge(a.vertices(), &touching, off) || self.is_beside_edge(&touching, a.vertices(), off)
    }

    /// True if some side of a convex ring has all other points, in the same plane, on its other side, where they meet the ring at
    /// most in shared vertices. `off` is a point off the plane.
    fn is_beside_edge(&self, ring: &[VertexId], others: &[VertexId], off: DVec3) -> bool {
        let separates = |k: usize| {
            let [c, d] = [ring[k], ring[(k + 1) % ring.len()]].map(|v| self.scene.vertex(v));
            let side = |v: &VertexId| orient3d(c, d, off, self.scene.vertex(*v));
            let own = ring.iter().map(side).find(|side| !side.is_zero());
            let beyond = others.iter().map(side).find(|side| !side.is_zero());
            let is_apart =
                others.iter().map(side).all(|side| side.is_zero() || (Some(side) == beyond && Some(side) != own));
            is_apart && beyond.is_some() && {
                let on_line = |v: &&VertexId| side(v).is_zero();
                let shared = others.iter().filter(on_line).all(|v| ring.contains(v));
                // Points on one line have the order of any coordinate that differs.
                let axis = (0..3).find(|&axis| c[axis].partial_cmp(&d[axis]) != Some(Ordering::Equal)).unwrap_or(0);
                let reach = |points: &[VertexId]| {
                    let on_line = points.iter().filter(on_line).map(|&v| self.scene.vertex(v)[axis]);
                    on_line.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)))
                };
                let (mine, theirs) = (reach(ring), reach(others));
                shared || theirs.1 <= mine.0 || theirs.0 >= mine.1
            }
        };
        (0..ring.len()).any(separates)
    }

    /// False if certainly no edge of `a` meets `b` but in a shared vertex.
    fn may_pierce(&self, a: PieceRef<'_>, b: PieceRef<'_>) -> bool {
        let corners = a.vertices();
        (0..corners.len()).any(|k| self.edge_may_meet([corners[k], corners[(k + 1) % corners.len()]], b))
    }

    fn edge_may_meet(&self, [p, q]: [VertexId; 2], b: PieceRef<'_>) -> bool {
        let corners = b.vertices();
        let [at_p, at_q] = [p, q].map(|v| (self.skeleton.vertex_side(b.plane_id(), v), corners.contains(&v)));
        match (at_p, at_q) {
            // From a vertex of both, away from the plane.
            ((_, true), (side, false)) | ((side, false), (_, true)) => side.is_zero(),
            ((_, true), (_, true)) => false,
            ((one, _), (other, _)) if one == other => one.is_zero(),
            ((Sign::Zero, _), _) | (_, (Sign::Zero, _)) => true,
            _ => {
                // The line through p and q passes all sides of b on the same side: within it, or at its edge.
                let mut turns = (0..corners.len()).map(|k| {
                    let [c, d] = [corners[k], corners[(k + 1) % corners.len()]];
                    orient3d(self.scene.vertex(p), self.scene.vertex(q), self.scene.vertex(c), self.scene.vertex(d))
                });
                let mut first = None;
                turns.all(|turn| turn.is_zero() || *first.get_or_insert(turn) == turn)
            }
        }
    }
}

/// A bound on the components of a cross product, from the sizes of the components of its factors.
fn cross_of_sizes(a: DVec3, b: DVec3) -> DVec3 {
    DVec3::new(a.y * b.z + a.z * b.y, a.z * b.x + a.x * b.z, a.x * b.y + a.y * b.x)
}

#[cfg(test)]
mod tests {
    use super::super::SceneBvh;
    use crate::scene::{Material, Scene};
    use glam::DVec3;

    /// A box of quads with the fronts outside, its corners at 0 or 1 times `size` from `low`.
    fn cuboid(low: [f64; 3], size: [f64; 3]) -> (Vec<[f64; 3]>, Vec<Vec<usize>>) {
        let corner = |k: usize| [0, 1, 2].map(|axis| low[axis] + f64::from((k >> axis & 1) as u8) * size[axis]);
        let faces: [[usize; 4]; 6] =
            [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        ((0..8).map(corner).collect(), faces.map(|face| face.to_vec()).to_vec())
    }

    fn built(vertices: &[[f64; 3]], faces: &[Vec<usize>]) -> Scene {
        Scene::builder().mesh(vertices, faces, Material::new("grey")).build().expect("the mesh is a scene")
    }

    /// Volumes of these are no numbers, or 0.
    #[test]
    fn boxes_of_any_size_are_solids() {
        for size in [1e150, 1e-150, 1e300, 1e-300] {
            let (vertices, faces) = cuboid([0.0; 3], [size; 3]);
            assert_eq!(SceneBvh::build(&built(&vertices, &faces)).solid_pieces(), 6, "{size:e}");
        }
    }

    #[test]
    fn a_box_is_a_solid_and_only_its_inside_is_left_out() {
        let (vertices, faces) = cuboid([1.0, 2.0, 3.0], [2.0, 1.0, 4.0]);
        let reversed: Vec<Vec<usize>> = faces.iter().map(|face| face.iter().rev().copied().collect()).collect();
        for faces in [faces, reversed] {
            let bvh = SceneBvh::build(&built(&vertices, &faces));
            assert_eq!(bvh.solid_pieces(), 6);
            let hierarchy = &bvh.hierarchy;
            for eye in [DVec3::new(-3.0, 2.5, 4.0), DVec3::new(9.0, -8.0, 5.0), DVec3::new(2.0, 2.5, 5.0)] {
                let left_out = bvh.scene().pieces().filter(|piece| {
                    let shown = hierarchy.skeleton.shown_side(*piece, eye).expect("the eye is in no plane");
                    hierarchy.is_inside(piece.id(), shown, eye)
                });
                // From outside those that do not show their outside; from inside none.
                let is_outside = |k: usize, value: f64| eye[k] < value;
                let seen =
                    (0..3).map(|k| usize::from(is_outside(k, [1.0, 2.0, 3.0][k]) || eye[k] > [3.0, 3.0, 7.0][k]));
                let expected = match seen.sum() {
                    0 => 0,
                    seen => 6 - seen,
                };
                assert_eq!(left_out.count(), expected, "from {eye}");
            }
        }
    }

    #[test]
    fn open_or_crossing_or_touching_surfaces_are_no_solids() {
        let (vertices, faces) = cuboid([0.0; 3], [1.0; 3]);
        assert_eq!(SceneBvh::build(&built(&vertices, &faces[1..])).solid_pieces(), 0, "open");
        let mut turned = faces.clone();
        turned[0].reverse();
        assert_eq!(SceneBvh::build(&built(&vertices, &turned)).solid_pieces(), 0, "not oriented");
        // A corner is drawn through the opposite face: all triangles, as quads would not be planar.
        let halves = |k: &[usize]| [vec![k[0], k[1], k[2]], vec![k[0], k[2], k[3]]];
        let triangles: Vec<Vec<usize>> = faces.iter().flat_map(|face| halves(face)).collect();
        assert_eq!(SceneBvh::build(&built(&vertices, &triangles)).solid_pieces(), 12, "triangles");
        // Two cones over the same six edges: beyond the other apex they do not meet, on and between them they do.
        for (corner, solid) in [
            ([2.0, 2.0, 2.0], 12),
            ([0.5, 0.5, 1.0], 0),
            ([0.5, 0.25, 1.5], 0),
            ([0.5, 0.25, 0.5], 12),
            ([1.5, 0.5, 0.5], 0),
        ] {
            let mut moved = vertices.clone();
            moved[0] = corner;
            let pieces = SceneBvh::build(&built(&moved, &triangles)).solid_pieces();
            assert_eq!(pieces, solid, "corner 0 at {corner:?}");
        }
    }

    #[test]
    fn solids_that_pass_through_each_other_are_solids_each() {
        let (mut vertices, mut faces) = cuboid([0.0; 3], [2.0; 3]);
        let (more, of_these) = cuboid([1.0; 3], [2.0; 3]);
        vertices.extend(more);
        faces.extend(of_these.iter().map(|face| face.iter().map(|k| k + 8).collect()));
        assert_eq!(SceneBvh::build(&built(&vertices, &faces)).solid_pieces(), 12);
    }
}
