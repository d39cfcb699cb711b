//! Which corners patches have in common.

use super::rings::{length, mean_of, normal, off};
use super::surface::INSIDE;
use crate::bsp::Bounds;
use crate::bvh::{BvhNode, Content, boxes};
use crate::scene::{PieceRef, PolygonId, Scene};
use glam::DVec3;
use rustc_hash::{FxHashMap, FxHashSet};
use std::collections::hash_map::Entry;
use std::hash::Hash;

/// What is nearer to the middle of a side than this part of the longest side of its patch stands on it, if it rises farther. Patches end where others stand on them, but for some ten-thousandths. This
/// decides where corners are shared, and nothing about what is seen from them: with more of them than it takes there are only more views.
const BESIDE: f64 = 0.01;

/// The corners of pieces of patches. Pieces share those of a side that they have in common, if they are of one group and nothing stands on that side. So both sides of a wall have
/// corners of their own, also where it ends within a polygon. At its end, around which all pieces would share one corner, the two beside it have their own.
pub(super) struct Corners {
    pub(super) positions: Vec<DVec3>,
    /// A point for each, a little inside of the first patch that has it: on the boundary itself what stands on it there would not be seen.
    pub(super) places: Vec<(PolygonId, DVec3)>,
    /// The numbers of the corners of each piece.
    pub(super) of_pieces: Vec<Vec<u32>>,
}

impl Corners {
    /// Of pieces of a scene, with the group of each.
    pub(super) fn new<G: Copy + Eq + Hash>(
        scene: &Scene,
        pieces: &[PieceRef<'_>],
        group: impl Fn(&PieceRef<'_>) -> G,
    ) -> Self {
        let rings: Vec<Vec<DVec3>> = pieces.iter().map(|piece| piece.points().collect()).collect();
        let mut starts = vec![0];
        for ring in &rings {
            starts.push(starts[starts.len() - 1] + ring.len());
        }
        let standing = Standing::on(scene);
        let mut shared = Shared::new(starts[pieces.len()]);
        let mut known: FxHashMap<(G, [[u64; 3]; 2]), [usize; 2]> = FxHashMap::default();
        let mut walls = Vec::new();
        for (number, (piece, ring)) in pieces.iter().zip(&rings).enumerate() {
            for k in 0..ring.len() {
                let next = if k + 1 == ring.len() { 0 } else { k + 1 };
                let [a, b] = [k, next].map(|k| (bits(ring[k]), starts[number] + k));
                let [a, b] = if a.0 < b.0 { [a, b] } else { [b, a] };
                match known.entry((group(piece), [a.0, b.0])) {
                    Entry::Vacant(free) => {
                        free.insert([a.1, b.1]);
                    }
                    Entry::Occupied(other) => {
                        let pairs = [[other.get()[0], a.1], [other.get()[1], b.1]];
                        if standing.is_on(ring, ring[k].midpoint(ring[next])) {
                            walls.extend(pairs);
                        } else {
                            for pair in pairs {
                                shared.unite(pair);
                            }
                        }
                    }
                }
            }
        }
        let ends: FxHashSet<usize> = walls.into_iter().filter(|&pair| shared.are_one(pair)).flatten().collect();
        let mut corners =
            Self { positions: Vec::new(), places: Vec::new(), of_pieces: Vec::with_capacity(rings.len()) };
        let mut numbers: FxHashMap<(usize, bool), u32> = FxHashMap::default();
        for (number, (piece, ring)) in pieces.iter().zip(&rings).enumerate() {
            let middle = mean_of(ring);
            let of_piece = ring.iter().enumerate().map(|(k, &p)| {
                let own = starts[number] + k;
                let is_end = ends.contains(&own);
                let key = (if is_end { own } else { shared.root(own) }, is_end);
                *numbers.entry(key).or_insert_with(|| {
                    corners.positions.push(p);
                    corners.places.push((piece.polygon(), p.lerp(middle, INSIDE)));
                    corners.places.len() as u32 - 1
                })
            });
            let of_piece = of_piece.collect();
            corners.of_pieces.push(of_piece);
        }
        corners
    }
}

fn bits(p: DVec3) -> [u64; 3] {
    p.to_array().map(f64::to_bits)
}

/// What is known to be one.
struct Shared {
    before: Vec<usize>,
}

impl Shared {
    fn new(count: usize) -> Self {
        Self { before: (0..count).collect() }
    }

    fn root(&mut self, mut at: usize) -> usize {
        while self.before[at] != at {
            self.before[at] = self.before[self.before[at]];
            at = self.before[at];
        }
        at
    }

    fn unite(&mut self, pair: [usize; 2]) {
        let [a, b] = pair.map(|at| self.root(at));
        self.before[a.max(b)] = a.min(b);
    }

    fn are_one(&mut self, pair: [usize; 2]) -> bool {
        let [a, b] = pair.map(|at| self.root(at));
        a == b
    }
}

/// The pieces of a scene in boxes, to ask what stands on sides of them.
struct Standing {
    rings: Vec<Vec<DVec3>>,
    nodes: Vec<BvhNode>,
    order: Vec<u32>,
}

impl Standing {
    fn on(scene: &Scene) -> Self {
        let rings: Vec<Vec<DVec3>> = scene.pieces().map(|piece| piece.points().collect()).collect();
        let bounds = |ring: u32| {
            let points = rings[ring as usize].iter();
            points.fold(Bounds::EMPTY, |all, &p| all.union(Bounds { low: p, high: p }))
        };
        let (nodes, order) = boxes((0..rings.len() as u32).collect(), bounds);
        Self { rings, nodes, order }
    }

    /// True if something stands on the front of a ring at the middle of one of its sides.
    fn is_on(&self, ring: &[DVec3], middle: DVec3) -> bool {
        let lengths = ring.iter().zip(ring.iter().cycle().skip(1)).map(|(&a, &b)| length(a - b));
        let reach = BESIDE * lengths.fold(0.0, f64::max);
        let up = normal(ring);
        let stands = |other: &[DVec3]| {
            let height = other.iter().map(|&p| up.dot(p - middle)).fold(f64::NEG_INFINITY, f64::max);
            height > reach && off(other, middle) <= reach
        };
        let mut left = if self.nodes.is_empty() { Vec::new() } else { vec![0_u32] };
        while let Some(node) = left.pop() {
            let BvhNode { bounds, content } = &self.nodes[node as usize];
            let is_near = (bounds.low - reach).cmple(middle).all() && (bounds.high + reach).cmpge(middle).all();
            match content {
                _ if !is_near => {}
                Content::Boxes(halves) => left.extend(halves),
                Content::Panels(range) => {
                    let mut some = self.order[range.start as usize..range.end as usize].iter();
                    if some.any(|&other| stands(&self.rings[other as usize])) {
                        return true;
                    }
                }
            }
        }
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::factors::PatchMesh;
    use crate::scene::Material;

    /// The corners of a floor of 4.1 x 4.1 on which a sheet stands at x = 0 from y = -1 to 1, with the rings that have them.
    fn corners_at(longest: f64) -> (Vec<Vec<DVec3>>, Corners) {
        let floor = [[-2.1, -2.1, 0.0], [2.0, -2.1, 0.0], [2.0, 2.0, 0.0], [-2.1, 2.0, 0.0]];
        let sheet = [[0.0, -1.0, 0.0], [0.0, 1.0, 0.0], [0.0, 1.0, 1.0], [0.0, -1.0, 1.0]];
        let face = [vec![0, 1, 2, 3]];
        let scene = Scene::builder().mesh(&floor, &face, Material::new("floor"));
        let scene = scene.mesh(&sheet, &face, Material::new("sheet")).build().unwrap();
        let mesh = PatchMesh::new(&scene, longest).unwrap();
        let (patches, regions) = (mesh.patches().unwrap(), mesh.regions());
        let pieces: Vec<PieceRef<'_>> =
            patches.pieces().filter(|piece| mesh.polygon(piece.polygon().index()).0 == 0).collect();
        let corners = Corners::new(&patches, &pieces, |piece| regions[piece.polygon().index()]);
        (pieces.iter().map(|piece| piece.points().collect()).collect(), corners)
    }

    #[test]
    fn a_sheet_that_ends_within_a_floor_has_corners_on_each_side() {
        for longest in [0.3, 0.7, 10.0] {
            let (rings, corners) = corners_at(longest);
            let mut sides: FxHashMap<u32, [bool; 2]> = FxHashMap::default();
            let mut at: FxHashMap<[u64; 3], FxHashSet<u32>> = FxHashMap::default();
            for (ring, numbers) in rings.iter().zip(&corners.of_pieces) {
                let middle = mean_of(ring);
                for (&p, &number) in ring.iter().zip(numbers) {
                    assert_eq!(corners.positions[number as usize], p);
                    at.entry(bits(p)).or_default().insert(number);
                    // Strictly between its ends, but for what cuts are moved by.
                    if p.x.abs() < 1e-2 && p.y.abs() < 0.99 {
                        sides.entry(number).or_default()[usize::from(middle.x > 0.0)] = true;
                    }
                }
            }
            assert!(sides.values().all(|of| of[0] != of[1]), "a corner of both sides: {longest}");
            for (p, numbers) in at {
                let p = DVec3::from_array(p.map(f64::from_bits));
                let is_foot = p.x.abs() < 1e-2 && p.y.abs() < 0.99;
                let is_end = p.x.abs() < 1e-2 && (p.y.abs() - 1.0).abs() < 1e-2;
                let expected = if is_end {
                    3
                } else if is_foot {
                    2
                } else {
                    1
                };
                assert_eq!(numbers.len(), expected, "{p} {longest}");
            }
        }
    }
}
