//! The shapes of things in a certificate's file, and what they stand for.

use crate::scene::{Axis, PieceId, PolygonId, Scene, Side, Splitter, SupportingPlane, VertexId};
use crate::verify::{EvidenceDomain, EvidenceHorizon, EvidencePane, EvidenceSliver};
use glam::DVec3;
use serde::{Deserialize, Deserializer, Serialize};
use std::fmt;

/// How much there is in a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SceneSize {
    /// Vertices, each once.
    pub vertices: usize,
    /// Polygons, those without area included.
    pub polygons: usize,
    /// Convex pieces.
    pub pieces: usize,
}

impl SceneSize {
    /// Of a scene.
    pub fn of(scene: &Scene) -> Self {
        Self { vertices: scene.vertices().len(), polygons: scene.polygon_count(), pieces: scene.piece_count() }
    }
}

impl fmt::Display for SceneSize {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { vertices, polygons, pieces } = self;
        write!(f, "{vertices} vertices, {polygons} polygons and {pieces} convex pieces")
    }
}

#[derive(Clone, Copy, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum SideRow {
    Front,
    Back,
}

impl From<Side> for SideRow {
    fn from(side: Side) -> Self {
        if side == Side::Front { Self::Front } else { Self::Back }
    }
}

impl From<SideRow> for Side {
    fn from(row: SideRow) -> Self {
        match row {
            SideRow::Front => Self::Front,
            SideRow::Back => Self::Back,
        }
    }
}

/// A plane: one coordinate, or three vertices.
#[derive(Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum PlaneRow {
    X(f64),
    Y(f64),
    Z(f64),
    Points([u32; 3]),
}

impl From<SupportingPlane> for PlaneRow {
    fn from(plane: SupportingPlane) -> Self {
        match plane {
            SupportingPlane::Axis { axis: Axis::X, value } => Self::X(value),
            SupportingPlane::Axis { axis: Axis::Y, value } => Self::Y(value),
            SupportingPlane::Axis { axis: Axis::Z, value } => Self::Z(value),
            SupportingPlane::Points(points) => Self::Points(points.map(|v| v.0)),
        }
    }
}

impl From<PlaneRow> for SupportingPlane {
    fn from(row: PlaneRow) -> Self {
        let (axis, value) = match row {
            PlaneRow::X(value) => (Axis::X, value),
            PlaneRow::Y(value) => (Axis::Y, value),
            PlaneRow::Z(value) => (Axis::Z, value),
            PlaneRow::Points(points) => return Self::Points(points.map(VertexId)),
        };
        Self::Axis { axis, value }
    }
}

#[derive(Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum SplitterRow {
    Edge([u32; 2]),
    Points([[f64; 3]; 2]),
    Crease([PlaneRow; 2]),
    Given([f64; 3]),
    Parallel(PlaneRow),
}

impl From<Splitter> for SplitterRow {
    fn from(splitter: Splitter) -> Self {
        match splitter {
            Splitter::Edge(ends) => Self::Edge(ends.map(|v| v.0)),
            Splitter::Points(ends) => Self::Points(ends.map(|p| p.to_array())),
            Splitter::Crease(planes) => Self::Crease(planes.map(PlaneRow::from)),
            Splitter::Given(normal) => Self::Given(normal.to_array()),
            Splitter::Parallel(plane) => Self::Parallel(plane.into()),
        }
    }
}

impl From<SplitterRow> for Splitter {
    fn from(row: SplitterRow) -> Self {
        match row {
            SplitterRow::Edge(ends) => Self::Edge(ends.map(VertexId)),
            SplitterRow::Points(ends) => Self::Points(ends.map(DVec3::from)),
            SplitterRow::Crease(planes) => Self::Crease(planes.map(SupportingPlane::from)),
            SplitterRow::Given(normal) => Self::Given(DVec3::from(normal)),
            SplitterRow::Parallel(plane) => Self::Parallel(plane.into()),
        }
    }
}

#[derive(Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "lowercase", deny_unknown_fields)]
pub(super) enum DomainRow {
    // With braces, as else unknown fields would be taken.
    Sphere {},
    Hemisphere {
        normal: [f64; 3],
    },
    Above {
        piece: u32,
        side: SideRow,
    },
    Frustum {
        normals: [[f64; 3]; 4],
    },
    Window {
        panes: Vec<PaneRow>,
        #[serde(deserialize_with = "present")]
        horizon: Option<HorizonRow>,
    },
}

#[derive(Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum PaneRow {
    Polygon(u32),
    Ring(Vec<[f64; 3]>),
}

#[derive(Serialize, Deserialize)]
#[serde(rename_all = "lowercase", deny_unknown_fields)]
pub(super) enum HorizonRow {
    Normal([f64; 3]),
    Above { piece: u32, side: SideRow },
}

impl From<&EvidenceDomain> for DomainRow {
    fn from(domain: &EvidenceDomain) -> Self {
        match *domain {
            EvidenceDomain::Sphere => Self::Sphere {},
            EvidenceDomain::Hemisphere(normal) => Self::Hemisphere { normal: normal.to_array() },
            EvidenceDomain::Above(piece, side) => Self::Above { piece: piece.0, side: side.into() },
            EvidenceDomain::Frustum(normals) => Self::Frustum { normals: normals.map(|normal| normal.to_array()) },
            EvidenceDomain::Window { ref panes, horizon } => {
                let panes = panes.iter().map(|pane| match pane {
                    EvidencePane::Polygon(polygon) => PaneRow::Polygon(polygon.0),
                    EvidencePane::Ring(ring) => PaneRow::Ring(ring.iter().map(DVec3::to_array).collect()),
                });
                let horizon = horizon.map(|horizon| match horizon {
                    EvidenceHorizon::Normal(normal) => HorizonRow::Normal(normal.to_array()),
                    EvidenceHorizon::Above(piece, side) => HorizonRow::Above { piece: piece.0, side: side.into() },
                });
                Self::Window { panes: panes.collect(), horizon }
            }
        }
    }
}

impl From<DomainRow> for EvidenceDomain {
    fn from(row: DomainRow) -> Self {
        match row {
            DomainRow::Sphere {} => Self::Sphere,
            DomainRow::Hemisphere { normal } => Self::Hemisphere(DVec3::from(normal)),
            DomainRow::Above { piece, side } => Self::Above(PieceId(piece), side.into()),
            DomainRow::Frustum { normals } => Self::Frustum(normals.map(DVec3::from)),
            DomainRow::Window { panes, horizon } => {
                let panes = panes.into_iter().map(|pane| match pane {
                    PaneRow::Polygon(polygon) => EvidencePane::Polygon(PolygonId(polygon)),
                    PaneRow::Ring(ring) => EvidencePane::Ring(ring.into_iter().map(DVec3::from).collect()),
                });
                let horizon = horizon.map(|horizon| match horizon {
                    HorizonRow::Normal(normal) => EvidenceHorizon::Normal(DVec3::from(normal)),
                    HorizonRow::Above { piece, side } => EvidenceHorizon::Above(PieceId(piece), side.into()),
                });
                Self::Window { panes: panes.collect(), horizon }
            }
        }
    }
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SliverRow {
    piece: u32,
    plane: PlaneRow,
    #[serde(deserialize_with = "present")]
    beyond: Option<SideRow>,
}

impl From<EvidenceSliver> for SliverRow {
    fn from(sliver: EvidenceSliver) -> Self {
        Self { piece: sliver.piece.0, plane: sliver.plane.into(), beyond: sliver.beyond.map(SideRow::from) }
    }
}

impl From<SliverRow> for EvidenceSliver {
    fn from(row: SliverRow) -> Self {
        Self { piece: PieceId(row.piece), plane: row.plane.into(), beyond: row.beyond.map(Side::from) }
    }
}

/// A value or null: it has to be there.
pub(super) fn present<'de, D: Deserializer<'de>, T: Deserialize<'de>>(from: D) -> Result<Option<T>, D::Error> {
    Option::deserialize(from)
}
