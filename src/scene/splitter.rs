//! Great circles in terms of a scene.

use super::{Scene, SupportingPlane, VertexId};
use crate::exact::{self, Plane};
use glam::DVec3;

/// The exact definition of a splitter: a plane through the eye `e`, by its normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Splitter {
    /// Through two vertices of the scene: `(a - e) x (b - e)`.
    Edge([VertexId; 2]),
    /// Through the line where two planes meet: `h_2 N_1 - h_1 N_2` with the planes' normals and the
    /// heights of the eye over them.
    Crease([SupportingPlane; 2]),
    /// Through two points given by their coordinates, `(a - e) x (b - e)`: the side of a free window.
    Points([DVec3; 2]),
    /// A normal given as three numbers: quadtree, horizon of a free hemisphere, side of a frustum.
    Given(DVec3),
    /// A supporting plane moved to the eye: the horizon of a point on a surface.
    Parallel(SupportingPlane),
}

impl Scene {
    /// A supporting plane by its coordinates.
    ///
    /// # Panics
    /// If it names a vertex that does not exist.
    pub fn resolve_plane(&self, plane: SupportingPlane) -> Plane {
        match plane {
            SupportingPlane::Axis { axis, value } => Plane::Axis { axis: axis as usize, value },
            SupportingPlane::Points(points) => Plane::Points(points.map(|v| self.vertex(v))),
        }
    }

    /// A splitter by its coordinates.
    ///
    /// # Panics
    /// If it names a vertex that does not exist.
    pub fn resolve_splitter(&self, splitter: Splitter) -> exact::Splitter {
        match splitter {
            Splitter::Edge(ends) => exact::Splitter::Edge(ends.map(|v| self.vertex(v))),
            Splitter::Points(ends) => exact::Splitter::Edge(ends),
            Splitter::Crease(planes) => exact::Splitter::Crease(planes.map(|plane| self.resolve_plane(plane))),
            Splitter::Given(normal) => exact::Splitter::Given(normal),
            Splitter::Parallel(plane) => exact::Splitter::Parallel(self.resolve_plane(plane)),
        }
    }
}
