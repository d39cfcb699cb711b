//! The top of the contour tree, chosen independently of the scene: a quadtree on the faces of a cube, or on an image plane.
//!
//! Octants first, then the quarter faces of the cube around the eye, then halves of the gnomonic
//! coordinates in turn, with small exact normals such as `(-3/8, 1, 0)`; or the borders of an image plane, and halves of that.

use super::directions::CircleId;
use super::polygon::HalfSphere;
use super::tree::{ContourTree, Workspace};
use crate::bsp::Skeleton;
use crate::exact::Sign;
use glam::DVec3;
use rustc_hash::FxHashMap;

/// Where the quadtree lies that cuts the directions before anything is put in. It changes the cost of a view and how cells are cut, not what
/// is seen.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Quadtree {
    /// On the faces of a cube around the eye, from halves of its octants downwards: for any domain.
    #[default]
    Cube,
    /// On an image plane in front of the eye, square to the normal of a hemisphere (Jacob 1995, figure 5). What of
    /// the hemisphere is not seen through it stays in one piece on each of its sides.
    Plane {
        /// The angle across it, above 0 and below 180.
        degrees: f64,
        /// How squares are halved.
        spacing: Spacing,
    },
}

/// Where a square of an image plane is halved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Spacing {
    /// In the middle, as seen in the plane.
    Even,
    /// In the middle, as seen from the eye, so that wide planes are cut more finely towards their centre.
    TowardsCentre,
}

impl Spacing {
    /// The coordinate in the plane, at distance 1 from the eye, of what is halved: a coordinate, or an angle.
    fn coordinate(self, x: f64) -> f64 {
        match self {
            Self::Even => x,
            Self::TowardsCentre => x.tan(),
        }
    }
}

/// A part of a plane: coordinates over `towards` along the other two lie between the bounds.
#[derive(Clone, Copy, Debug)]
struct Square {
    across: [DVec3; 2],
    towards: DVec3,
    spacing: Spacing,
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

/// Cuts the open leaves of a tree that consists of octants, or parts of them, `depth` times. `normal` is that of the domain, if it
/// is a hemisphere.
pub(crate) fn subdivide(
    tree: &mut ContourTree,
    skeleton: &Skeleton,
    quadtree: Quadtree,
    normal: Option<DVec3>,
    depth: u32,
    work: &mut Workspace,
) {
    if depth == 0 {
        return;
    }
    let mut circles = Circles::default();
    match quadtree {
        Quadtree::Cube => {
            let faces = quarter_faces(tree, skeleton, &mut circles, work);
            quarter(tree, skeleton, faces, depth - 1, &mut circles, work);
        }
        Quadtree::Plane { degrees, spacing } => {
            let Some(normal) = normal else { return };
            let plane = image_plane(tree, skeleton, normal, degrees, spacing, &mut circles, work);
            quarter(tree, skeleton, plane, depth, &mut circles, work);
        }
    }
}

/// The quarter faces of a cube, from octants.
fn quarter_faces(
    tree: &mut ContourTree,
    skeleton: &Skeleton,
    circles: &mut Circles,
    work: &mut Workspace,
) -> Vec<(u32, Square)> {
    let mut squares = Vec::new();
    for leaf in tree.open_leaves() {
        let signs = octant_of(tree, leaf);
        let unit = |axis: usize| DVec3::AXES[axis] * signs[axis];
        // The face of x against y, then the winner against z.
        let half = circles.half_sphere(tree, skeleton, unit(0) - unit(1), work);
        let sides = tree.cut_leaf(skeleton, leaf, half, |_, _, _| None, work);
        for (axis, side) in [0, 1].into_iter().zip(sides) {
            let Some(side) = side else { continue };
            let half = circles.half_sphere(tree, skeleton, unit(axis) - unit(2), work);
            let faces = tree.cut_leaf(skeleton, side, half, |_, _, _| None, work);
            for (axis, leaf) in [axis, 2].into_iter().zip(faces) {
                let square = Square {
                    across: [1, 2].map(|k| unit((axis + k) % 3)),
                    towards: unit(axis),
                    spacing: Spacing::Even,
                    low: [0.0; 2],
                    high: [1.0; 2],
                };
                squares.extend(leaf.map(|leaf| (leaf, square)));
            }
        }
    }
    squares
}

/// What is seen through an image plane, from octants.
fn image_plane(
    tree: &mut ContourTree,
    skeleton: &Skeleton,
    normal: DVec3,
    degrees: f64,
    spacing: Spacing,
    circles: &mut Circles,
    work: &mut Workspace,
) -> Vec<(u32, Square)> {
    let towards = (normal / normal.abs().max_element()).normalize();
    let (u, v) = towards.any_orthonormal_pair();
    let angle = (degrees / 2.0).to_radians();
    let edge = angle.tan();
    let most = match spacing {
        Spacing::Even => edge,
        Spacing::TowardsCentre => angle,
    };
    let square = Square { across: [u, v], towards, spacing, low: [-most; 2], high: [most; 2] };
    let mut inner = tree.open_leaves();
    for border in [u, -u, v, -v] {
        let half = circles.half_sphere(tree, skeleton, towards * edge - border, work);
        inner =
            inner.into_iter().filter_map(|leaf| tree.cut_leaf(skeleton, leaf, half, |_, _, _| None, work)[0]).collect();
    }
    inner.into_iter().map(|leaf| (leaf, square)).collect()
}

/// Quarters squares so many times.
fn quarter(
    tree: &mut ContourTree,
    skeleton: &Skeleton,
    mut squares: Vec<(u32, Square)>,
    times: u32,
    circles: &mut Circles,
    work: &mut Workspace,
) {
    for _ in 0..times {
        for direction in [0, 1] {
            let mut next = Vec::with_capacity(squares.len() * 2);
            for (leaf, square) in squares {
                let middle = f64::midpoint(square.low[direction], square.high[direction]);
                let normal = square.across[direction] - square.towards * square.spacing.coordinate(middle);
                let half = circles.half_sphere(tree, skeleton, normal, work);
                let [above, below] = tree.cut_leaf(skeleton, leaf, half, |_, _, _| None, work);
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
