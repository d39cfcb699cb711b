//! Which stretches of the scene's edges are seen, and which are hidden.

use super::directions::{CircleId, Directions, ExactCache, LooseDirection};
use super::image::ContourImage;
use super::polygon::HalfSphere;
use super::tree::{Link, TreeNode};
use crate::bsp::{LineId, PointId};
use crate::exact::Sign;
use crate::scene::{EdgeId, PieceId, PolygonId};
use glam::DVec3;
use rustc_hash::FxHashMap;
use std::f64::consts::{FRAC_PI_2, TAU};

/// Stretches shorter than this, in radians, are left out: some hundred times what a direction is rounded by.
const SHORTEST: f64 = 1e-13;

/// A stretch of an edge of the scene within the domain of an image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EdgeStretch {
    /// Its ends, as unit directions less than pi apart, rounded.
    pub ends: [DVec3; 2],
    /// A polygon that has the edge is seen beside it, on one side at least.
    pub is_visible: bool,
}

/// Follows the edges of a scene through a contour image.
#[derive(Clone, Debug)]
pub struct EdgeTracer<'a> {
    image: &'a ContourImage,
    /// Those of the image and of the edges that were followed.
    directions: Directions,
    circles: FxHashMap<LineId, CircleId>,
    /// The pieces that have each edge on their boundary.
    beside: Vec<Vec<PieceId>>,
    cache: ExactCache,
}

impl ContourImage {
    /// Makes what follows edges: about as much work as going through all cells and all polygons.
    ///
    /// ```
    /// # use nusselt::bvh::SceneBvh;
    /// # use nusselt::contour::{Domain, Viewpoint};
    /// # use nusselt::scene::{EdgeId, Material, Scene};
    /// // A square in front of the middle of a wall: the wall's own edges are seen, all of them.
    /// let vertices = [
    ///     [-9.0, -9.0, 2.0], [9.0, -9.0, 2.0], [9.0, 9.0, 2.0], [-9.0, 9.0, 2.0],
    ///     [-1.0, -1.0, 1.0], [1.0, -1.0, 1.0], [1.0, 1.0, 1.0], [-1.0, 1.0, 1.0],
    /// ];
    /// let faces = [vec![0, 1, 2, 3], vec![4, 5, 6, 7]];
    /// let scene = Scene::builder().mesh(&vertices, &faces, Material::new("grey")).build()?;
    /// let image = SceneBvh::build(&scene).view(&Viewpoint::free(glam::DVec3::ZERO), &Domain::Sphere)?;
    /// let mut tracer = image.edge_tracer();
    /// for edge in 0..scene.edges().len() as u32 {
    ///     let stretches = tracer.trace(EdgeId(edge));
    ///     assert!(stretches.len() == 1 && stretches[0].is_visible);
    /// }
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn edge_tracer(&self) -> EdgeTracer<'_> {
        let directions = self.tree.directions.clone();
        let circles = (0..directions.circle_count() as u32).map(CircleId);
        let circles = circles.filter_map(|circle| Some((directions.line(circle)?, circle))).collect();
        let mut beside = vec![Vec::new(); self.scene().edges().len()];
        for piece in self.scene().pieces() {
            for edge in piece.edges() {
                beside[edge.index()].push(piece.id());
            }
        }
        EdgeTracer { image: self, directions, circles, beside, cache: ExactCache::default() }
    }
}

/// A part of an edge on the way down the contour tree, and on which sides of it to look.
#[derive(Clone, Copy)]
struct Step {
    link: Link,
    ends: [LooseDirection; 2],
    left: bool,
    right: bool,
}

impl EdgeTracer<'_> {
    /// The pieces that have an edge on their boundary, ascending.
    ///
    /// # Panics
    /// If there is no such edge.
    pub fn pieces_beside(&self, edge: EdgeId) -> &[PieceId] {
        &self.beside[edge.index()]
    }

    /// The stretches of an edge within the domain, from its first vertex to its second: as long as can be, seen and hidden ones in turn. None
    /// if the edge is seen end on, as a point.
    ///
    /// What is seen beside it is decided exactly. Stretches shorter than 1e-13 radians are left out.
    ///
    /// # Panics
    /// If there is no such edge.
    pub fn trace(&mut self, edge: EdgeId) -> Vec<EdgeStretch> {
        let skeleton = self.image.skeleton();
        let (line, same_way) = skeleton.representative(LineId(edge.0));
        let (directions, cache) = (&mut self.directions, &mut self.cache);
        let circle = *self.circles.entry(line).or_insert_with(|| directions.push_line(skeleton, line, cache));
        if directions.normal(circle).v == DVec3::ZERO {
            return Vec::new();
        }
        // Its left side is where the normal of its own great circle points to.
        let along = HalfSphere::new(circle, if same_way { Sign::Positive } else { Sign::Negative });
        let ends = self.image.scene().edges()[edge.index()].map(|vertex| {
            let direction = directions.push_point(skeleton, PointId(vertex.0), cache);
            directions.direction(direction)
        });
        let polygon = |piece: PieceId| self.image.scene().piece(piece).polygon();
        let own: Vec<PolygonId> = self.beside[edge.index()].iter().map(|&piece| polygon(piece)).collect();
        let start = ends[0].unit();
        let across = directions.normal(circle).v.normalize_or_zero() * if same_way { 1.0 } else { -1.0 };
        let ahead = across.cross(start);
        // From 0 to pi; rounded, one near pi may come out as one near -pi.
        let angle = |d: &LooseDirection| {
            let angle = d.unit().dot(ahead).atan2(d.unit().dot(start));
            if angle < -FRAC_PI_2 { angle + TAU } else { angle }
        };
        // Where something begins to be there, or to be seen, and where it ends.
        let mut events: Vec<(f64, i32, i32)> = Vec::new();
        let mut stack = vec![Step { link: self.image.root(), ends, left: true, right: true }];
        while let Some(step) = stack.pop() {
            match step.link {
                Link::Node(node) => self.descend(self.image.tree.nodes[node as usize], along, step, &mut stack),
                Link::Leaf(leaf) => {
                    let Some(cell) = self.image.cell_of_leaf[leaf as usize] else { continue };
                    let seen = self.image.cell(cell).polygon().is_some_and(|polygon| own.contains(&polygon));
                    let [from, to] = step.ends.map(|end| angle(&end));
                    events.extend([(from, 1, i32::from(seen)), (to, -1, -i32::from(seen))]);
                }
            }
        }
        events.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        let direction = |angle: f64| start * angle.cos() + ahead * angle.sin();
        let mut stretches: Vec<([f64; 2], bool)> = Vec::new();
        let (mut there, mut seen) = (0, 0);
        // It left the domain since the last stretch.
        let mut interrupted = false;
        for pair in events.windows(2) {
            there += pair[0].1;
            seen += pair[0].2;
            let (from, to) = (pair[0].0, pair[1].0);
            if to - from < SHORTEST {
                continue;
            }
            match stretches.last_mut() {
                _ if there <= 0 => interrupted = true,
                Some((ends, is_visible)) if *is_visible == (seen > 0) && !interrupted => ends[1] = to,
                _ => {
                    stretches.push(([from, to], seen > 0));
                    interrupted = false;
                }
            }
        }
        let stretch = |(ends, is_visible): ([f64; 2], bool)| EdgeStretch { ends: ends.map(direction), is_visible };
        stretches.into_iter().map(stretch).collect()
    }

    fn descend(&mut self, node: TreeNode, along: HalfSphere, step: Step, stack: &mut Vec<Step>) {
        let skeleton = self.image.skeleton();
        let (directions, cache) = (&self.directions, &mut self.cache);
        let [here, there] = step.ends.map(|end| directions.side_of(skeleton, &end, node.circle, cache));
        let towards = |sign: Sign| if sign.is_positive() { node.positive() } else { node.negative() };
        match (here, there) {
            (Sign::Zero, Sign::Zero) => {
                // It runs along the node's circle: what is to its left is on one side of that, what is to its right on the other.
                let left = along.inside() * directions.same_way(skeleton, along.circle(), node.circle, cache);
                if step.left {
                    stack.push(Step { link: towards(left), right: false, ..step });
                }
                if step.right {
                    stack.push(Step { link: towards(-left), left: false, ..step });
                }
            }
            (Sign::Zero, sign) | (sign, Sign::Zero) => stack.push(Step { link: towards(sign), ..step }),
            _ if here == there => stack.push(Step { link: towards(here), ..step }),
            _ => {
                let reversed = along.inside() * here == Sign::Negative;
                let middle = directions.crossing(skeleton, [along.circle(), node.circle], reversed, cache);
                let [from, to] = step.ends;
                stack.push(Step { link: towards(here), ends: [from, middle], ..step });
                stack.push(Step { link: towards(there), ends: [middle, to], ..step });
            }
        }
    }
}
