//! Exact point location: which cells a direction lies in, or between.

use super::directions::{CircleId, ExactCache, Towards};
use super::image::{CellId, ContourImage};
use super::tree::Link;
use crate::exact::Sign;
use glam::DVec3;

/// A region of the directions around an eye: a cell, or what a domain leaves out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Region {
    /// A cell.
    Cell(CellId),
    /// Everything outside of the domain.
    Outside,
}

/// Where a direction lies. The regions are named in ascending order, cells before what is outside.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Location {
    /// Inside of a cell.
    Cell(CellId),
    /// Within the boundary between two regions, at the corner of no cell.
    Arc {
        /// The two regions; at least one of them is a cell.
        between: [Region; 2],
    },
    /// At a corner of a cell.
    Vertex {
        /// The cells that have a corner there; at least one.
        corners: Vec<CellId>,
        /// The other regions that meet there: the cell that has the direction within one of its sides, if
        /// it is a T-junction, and what is outside, if the domain ends there.
        beside: Vec<Region>,
    },
    /// Not in the domain. Directions on a horizon are in the domain.
    Outside,
}

impl Location {
    /// All regions that the direction is in or on the boundary of, ascending: one inside of a cell or outside
    /// of the domain, two on an arc, two or more at a vertex.
    pub fn regions(&self) -> Vec<Region> {
        match self {
            Self::Cell(cell) => vec![Region::Cell(*cell)],
            Self::Arc { between } => between.to_vec(),
            Self::Vertex { corners, beside } => {
                let mut regions: Vec<Region> = corners.iter().copied().map(Region::Cell).collect();
                regions.extend_from_slice(beside);
                regions.sort_unstable();
                regions
            }
            Self::Outside => vec![Region::Outside],
        }
    }
}

impl ContourImage {
    /// Finds the cell, arc or vertex that a direction lies in. The direction is taken exactly as its three
    /// numbers are; its length does not matter. One that is zero or not finite is `Outside`.
    ///
    /// The cost is the depth of the contour tree, for each region that the answer names.
    ///
    /// ```
    /// use glam::DVec3;
    /// use nusselt::bsp::{BspOptions, SceneBsp};
    /// use nusselt::contour::{Domain, Location, Region, Viewpoint};
    /// use nusselt::scene::{Material, Scene};
    ///
    /// let vertices = [[1.0, -2.0, 3.0], [3.0, -2.0, 3.0], [2.0, 4.0, 3.0]];
    /// let scene = Scene::builder().mesh(&vertices, &[vec![0, 1, 2]], Material::new("grey")).build()?;
    /// let bsp = SceneBsp::build(&scene, &BspOptions::default())?;
    /// let image = bsp.view(&Viewpoint::free(DVec3::ZERO), &Domain::Sphere)?;
    ///
    /// let Location::Cell(cell) = image.locate(DVec3::new(2.0, 1.0, 3.0)) else { panic!("no cell") };
    /// assert!(image.cell(cell).polygon().is_some());
    /// // Exactly on an edge, and exactly at a vertex.
    /// assert!(matches!(image.locate(DVec3::new(1.75, -2.0, 3.0)), Location::Arc { .. }));
    /// assert!(matches!(image.locate(DVec3::new(1.0, -2.0, 3.0)), Location::Vertex { .. }));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn locate(&self, direction: DVec3) -> Location {
        if !direction.is_finite() || direction == DVec3::ZERO {
            return Location::Outside;
        }
        self.locate_by(|circle, cache| self.tree.directions.given_side(self.skeleton(), direction, circle, cache))
    }

    /// The same for the direction from the eye to a point: the exact one, which rounding the difference may miss. `Outside` if the
    /// point is not finite, or the eye itself.
    pub fn locate_point(&self, point: DVec3) -> Location {
        if !point.is_finite() || point == self.viewpoint().eye() {
            return Location::Outside;
        }
        let towards = Towards::new(self.viewpoint().eye(), point);
        self.locate_by(|circle, cache| self.tree.directions.towards_side(self.skeleton(), &towards, circle, cache))
    }

    /// Finds a direction by the sides of great circles that it lies on.
    fn locate_by(&self, side: impl Fn(CircleId, &mut ExactCache) -> Sign) -> Location {
        let mut cache = ExactCache::default();
        let mut stack = vec![self.root()];
        let mut is_on_splitter = false;
        let (mut corners, mut sides, mut is_rim) = (Vec::new(), Vec::new(), false);
        // A leaf is the intersection of the half spheres on the way to it. So those leaves are reached whose
        // closure holds the direction, each once; and if it is on none of the splitters met, then inside.
        while let Some(link) = stack.pop() {
            match link {
                Link::Node(node) => {
                    let node = &self.tree.nodes[node as usize];
                    match side(node.circle, &mut cache) {
                        Sign::Negative => stack.push(node.negative()),
                        Sign::Positive => stack.push(node.positive()),
                        Sign::Zero => {
                            is_on_splitter = true;
                            stack.extend([node.negative(), node.positive()]);
                        }
                    }
                }
                Link::Leaf(leaf) => match self.cell_of_leaf[leaf as usize] {
                    None => is_rim = true,
                    Some(cell) if !is_on_splitter => return Location::Cell(cell),
                    Some(cell) if self.is_corner(leaf, &side, &mut cache) => corners.push(cell),
                    Some(cell) => sides.push(cell),
                },
            }
        }
        corners.sort_unstable();
        sides.sort_unstable();
        let mut beside: Vec<Region> = sides.into_iter().map(Region::Cell).collect();
        beside.extend(is_rim.then_some(Region::Outside));
        match beside[..] {
            _ if !corners.is_empty() => Location::Vertex { corners, beside },
            [one, other] => Location::Arc { between: [one, other] },
            _ => Location::Outside,
        }
    }

    /// True if a direction on the boundary of a leaf is where it turns.
    fn is_corner(
        &self,
        leaf: u32,
        side_of: &impl Fn(CircleId, &mut ExactCache) -> Sign,
        cache: &mut ExactCache,
    ) -> bool {
        let skeleton = self.skeleton();
        let directions = &self.tree.directions;
        let arcs = self.tree.boundary(leaf);
        let mut first = None;
        for (k, arc) in arcs.iter().enumerate() {
            let circle = arc.along.circle();
            let side = side_of(circle, cache) * arc.along.inside();
            debug_assert_ne!(side, Sign::Negative, "the closure of a leaf that is reached holds the direction");
            if !side.is_zero() {
                continue;
            }
            // Sides that continue each other may lie on one great circle under two names: they do if both
            // ends of the one, which are neither equal nor opposite, are on the circle of the other.
            let first = *first.get_or_insert(circle);
            let ends = [arc.from, arcs[if k + 1 == arcs.len() { 0 } else { k + 1 }].from];
            if circle != first && ends.iter().any(|&end| !directions.side(skeleton, end, first, cache).is_zero()) {
                return true;
            }
        }
        debug_assert!(first.is_some(), "the direction is on the boundary");
        false
    }
}
