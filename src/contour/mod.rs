//! The contour image: which polygon is seen in which direction, exactly.
//!
//! A 2D BSP on the sphere of directions (the *contour tree*) takes the polygons of the scene, whole and roughly from near to far or
//! as fragments exactly front to back ([`SceneOrder`]). Its splitters are planes through the viewpoint, that is great circles. Its leaves are
//! convex: not seen into yet, outside of the domain, or filled with one polygon. What is
//! left open in the end shows the background.

mod branch;
mod certify;
mod directions;
mod domain;
mod edges;
mod frustum;
#[cfg(feature = "geo")]
mod geo;
mod image;
mod joined;
mod locate;
mod neighbours;
mod order;
mod polygon;
mod precise;
mod projection;
mod regions;
mod shadows;
mod subdivision;
mod surfaces;
mod tree;
mod view;
mod viewpoint;
mod windows;

#[cfg(test)]
mod tests;

pub use crate::scene::Splitter;
pub use branch::{Branch, BranchKind};
pub use domain::Domain;
pub use edges::{EdgeStretch, EdgeTracer};
pub use frustum::{Frustum, FrustumError};
#[cfg(feature = "geo")]
pub use geo::GeoRegion;
pub use image::{Cell, CellId, ContourImage, TreeArc};
pub(crate) use joined::Joiner;
pub use locate::{Location, Region};
pub use neighbours::Neighbour;
pub use order::SceneOrder;
pub(crate) use precise::Precise;
pub use projection::{FlatRegion, Projection, ProjectionError, Projector, ViewFrame, Window};
pub use regions::{RegionLoop, RegionSide, VisibleRegion};
pub use shadows::{ShadowPart, Shadows};
pub use subdivision::{Quadtree, Spacing};
pub use surfaces::SurfaceIndex;
pub use view::{ViewError, ViewOptions, ViewSpace, ViewSpaces, ViewStats, ViewsError};
pub use viewpoint::{SurfaceError, Viewpoint};
pub use windows::{Horizon, Pane, WindowError, Windows};
