//! The top of the contour tree, chosen independently of the scene: a quadtree on the faces of a cube.
//!
//! Octants first, then the quarter faces of the cube around the eye, then halves of the gnomonic
//! coordinates in turn. All normals are small exact numbers such as `(-3/8, 1, 0)`.

use super::directions::CircleId;
use super::polygon::HalfSphere;
use super::tree::{ContourTree, Workspace};
use crate::bsp::Skeleton;
use crate::exact::Sign;
use glam::DVec3;
use rustc_hash::FxHashMap;

/// A part of a quarter face: on the face of `axis`, the other two coordinates over that one lie
/// between the bounds.
#[derive(Clone, Copy, Debug)]
struct Square {
    axis: usize,
    /// The signs of the octant's coordinates.
    signs: [f64; 3],
    low: [f64; 2],
    high: [f64; 2],
}

#[derive(Default)]
struct Circles {
    known: FxHashMap<[u64; 3], CircleId>,
}

impl Circles {
    /// The half sphere `normal . d >= 0`; opposite normals share their circle.
    fn half_sphere(
        &mut self,
        tree: &mut ContourTree,
        skeleton: &Skeleton,
        normal: DVec3,
        work: &mut Workspace,
    ) -> HalfSphere {
        let flip = normal.to_array().into_iter().find(|&x| x != 0.0).is_some_and(|x| x < 0.0);
        let canonical = if flip { -normal } else { normal } + DVec3::ZERO;
        let key = canonical.to_array().map(f64::to_bits);
        let circle = *self
            .known
            .entry(key)
            .or_insert_with(|| tree.directions.push_given(skeleton, canonical, &mut work.knife.cache));
        HalfSphere::new(circle, if flip { Sign::Negative } else { Sign::Positive })
    }
}

/// Cuts the open leaves of a tree that consists of octants, or parts of them: 0 leaves them as they
/// are, 1 makes quarter faces of a cube, every further level quarters those.
pub(crate) fn subdivide(tree: &mut ContourTree, skeleton: &Skeleton, depth: u32, work: &mut Workspace) {
    if depth == 0 {
        return;
    }
    let mut circles = Circles::default();
    let mut squares = Vec::new();
    for leaf in tree.open_leaves() {
        let signs = octant_of(tree, leaf);
        let unit = |axis: usize| DVec3::AXES[axis] * signs[axis];
        // The face of x against y, then the winner against z.
        let half = circles.half_sphere(tree, skeleton, unit(0) - unit(1), work);
        let sides = tree.cut_leaf(skeleton, leaf, half, work);
        for (axis, side) in [0, 1].into_iter().zip(sides) {
            let Some(side) = side else { continue };
            let half = circles.half_sphere(tree, skeleton, unit(axis) - unit(2), work);
            let faces = tree.cut_leaf(skeleton, side, half, work);
            for (axis, leaf) in [axis, 2].into_iter().zip(faces) {
                let square = Square { axis, signs, low: [0.0; 2], high: [1.0; 2] };
                squares.extend(leaf.map(|leaf| (leaf, square)));
            }
        }
    }
    for _ in 1..depth {
        for direction in [0, 1] {
            let mut next = Vec::with_capacity(squares.len() * 2);
            for (leaf, square) in squares {
                let middle = f64::midpoint(square.low[direction], square.high[direction]);
                let axis = (square.axis + 1 + direction) % 3;
                let mut normal = DVec3::ZERO;
                normal[axis] = square.signs[axis];
                normal[square.axis] = -middle * square.signs[square.axis];
                let half = circles.half_sphere(tree, skeleton, normal, work);
                let [above, below] = tree.cut_leaf(skeleton, leaf, half, work);
                let (mut upper, mut lower) = (square, square);
                upper.low[direction] = middle;
                lower.high[direction] = middle;
                next.extend(above.map(|leaf| (leaf, upper)));
                next.extend(below.map(|leaf| (leaf, lower)));
            }
            squares = next;
        }
    }
}

/// The octant that a leaf is part of: no splitter but the coordinate planes separates it from others.
fn octant_of(tree: &ContourTree, leaf: u32) -> [f64; 3] {
    let middle: DVec3 = tree.boundary(leaf).iter().map(|arc| tree.directions.unit(arc.from)).sum();
    middle.to_array().map(|x| if x < 0.0 { -1.0 } else { 1.0 })
}
