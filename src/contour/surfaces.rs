//! Finding the surfaces that many sensors are meant to be on.

use super::viewpoint::Viewpoint;
use crate::bsp::Bounds;
use crate::bvh::{BvhNode, Content, boxes};
use crate::scene::{PieceId, Scene, Side};
use glam::DVec3;

/// The pieces of a scene in boxes, to ask [`Viewpoint::surface_at`] for many places: what is found is the same, in about the logarithm of
/// the number of polygons. Threads share it.
///
/// ```
/// use nusselt::contour::{SurfaceIndex, Viewpoint};
/// use glam::DVec3;
///
/// let scene = nusselt::samples::cornell_box().to_builder().build()?;
/// let index = SurfaceIndex::new(&scene);
/// let (eye, up) = (DVec3::new(100.0, 0.0, 100.0), DVec3::Y);
/// assert!(index.surface_at(eye, up).is_some());
/// assert_eq!(index.surface_at(eye, up), Viewpoint::surface_at(&scene, eye, up));
/// assert_eq!(index.surface_at(eye, DVec3::X), None);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct SurfaceIndex {
    scene: Scene,
    /// The root is the first.
    nodes: Vec<BvhNode>,
    /// Numbers of pieces, in the order of the boxes that hold them.
    order: Vec<u32>,
}

impl SurfaceIndex {
    /// Builds it: about `n log n` time for `n` polygons.
    #[must_use]
    pub fn new(scene: &Scene) -> Self {
        let bounds: Vec<Bounds> = scene
            .pieces()
            .map(|piece| piece.points().fold(Bounds::EMPTY, |all, p| all.union(Bounds { low: p, high: p })))
            .collect();
        let (nodes, order) = boxes((0..bounds.len() as u32).collect(), |piece| bounds[piece as usize]);
        Self { scene: scene.clone(), nodes, order }
    }

    /// The scene it was built for.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// What [`Viewpoint::surface_at`] says.
    pub fn surface_at(&self, eye: DVec3, normal: DVec3) -> Option<(PieceId, Side)> {
        let reach = Viewpoint::reach(&self.scene);
        let mut near = Vec::new();
        let mut left = if self.nodes.is_empty() { Vec::new() } else { vec![0] };
        while let Some(node) = left.pop() {
            let BvhNode { bounds, content } = &self.nodes[node as usize];
            if !Viewpoint::is_within(bounds.low, bounds.high, reach, eye) {
                continue;
            }
            match content {
                Content::Boxes(halves) => left.extend(halves),
                Content::Panels(range) => near.extend(&self.order[range.start as usize..range.end as usize]),
            }
        }
        // Of equal ones the lowest number counts.
        near.sort_unstable();
        Viewpoint::surface_among(near.into_iter().map(|piece| self.scene.piece(PieceId(piece))), reach, eye, normal)
    }
}
