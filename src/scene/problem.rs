//! What can be wrong with a scene.

use super::{DropCause, PolygonId};

/// One thing that is wrong with the input of a [`SceneBuilder`](super::SceneBuilder).
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SceneProblem {
    /// A coordinate is infinite or not a number.
    #[error("vertex {vertex} has a coordinate that is not finite")]
    NotFinite {
        /// The index of the vertex.
        vertex: usize,
    },
    /// A ring with fewer than three vertices.
    #[error("polygon {polygon} has a ring of {count} vertices; it takes at least 3")]
    TooFewVertices {
        /// The polygon.
        polygon: PolygonId,
        /// How many vertices the ring has.
        count: usize,
    },
    /// An index past the last vertex.
    #[error("polygon {polygon} names vertex {vertex}, but there are {count} vertices")]
    UnknownVertex {
        /// The polygon.
        polygon: PolygonId,
        /// The index it names.
        vertex: usize,
        /// The number of vertices.
        count: usize,
    },
    /// A material that was never added.
    #[error("polygon {polygon} names material {material}, but there are {count} materials")]
    UnknownMaterial {
        /// The polygon.
        polygon: PolygonId,
        /// The material it names.
        material: u32,
        /// The number of materials.
        count: usize,
    },
    /// An object that was never added.
    #[error("polygon {polygon} names object {object}, but there are {count} objects")]
    UnknownObject {
        /// The polygon.
        polygon: PolygonId,
        /// The object it names.
        object: u32,
        /// The number of objects.
        count: usize,
    },
    /// The boundary crosses itself or goes around something more than once, or a hole crosses the
    /// outer ring; seen along the normal, if the polygon is not planar.
    #[error("the boundary of polygon {polygon} crosses itself; split it where it does")]
    SelfCrossing {
        /// The polygon.
        polygon: PolygonId,
    },
    /// A hole that is not inside of the outer ring.
    #[error("polygon {polygon} has a hole outside of its outer ring; remove it or make it a polygon")]
    HoleOutside {
        /// The polygon.
        polygon: PolygonId,
    },
    /// A hole that overlaps another one, lies in it or is the same: what is inside is not known.
    #[error(
        "polygon {polygon} has holes that overlap, or one in another; merge them, or make what is in a hole a polygon"
    )]
    HolesOverlap {
        /// The polygon.
        polygon: PolygonId,
    },
    /// A boundary that runs back and forth over itself, or past itself, so often that triangulating it
    /// would take time quadratic in its length.
    #[error("polygon {polygon} takes too much work to triangulate; remove doubled edges or split it")]
    TooMuchWork {
        /// The polygon.
        polygon: PolygonId,
    },
    /// The ring's coordinates span too many orders of magnitude to triangulate it.
    #[error("polygon {polygon} cannot be triangulated: its coordinates span more than 2^{limit}; scale or split it")]
    OutOfRange {
        /// The polygon.
        polygon: PolygonId,
        /// The largest ratio of coordinates that is taken, as an exponent of 2.
        limit: u32,
    },
    /// A polygon that is not exactly planar, which [`Repair::non_planar`](super::Repair::non_planar) rejects.
    #[error("polygon {polygon} is not exactly planar; split it, or have it triangulated")]
    NonPlanar {
        /// The polygon.
        polygon: PolygonId,
    },
    /// A polygon without area, which [`Repair::zero_area`](super::Repair::zero_area) rejects.
    #[error("polygon {polygon} has no area; remove it, or have it kept")]
    ZeroArea {
        /// The polygon.
        polygon: PolygonId,
    },
    /// A polygon with the same corners as one before, which [`Repair::duplicates`](super::Repair::duplicates) rejects.
    #[error("polygon {polygon} has the same corners as polygon {first}; remove it, or have it kept or dropped")]
    Duplicate {
        /// The polygon.
        polygon: PolygonId,
        /// The one before.
        first: PolygonId,
    },
    /// A tolerance for [`Repair::weld`](super::Repair::weld) that is negative, infinite or not a number.
    #[error("{tolerance} is no tolerance to weld vertices within; it takes a finite distance of at least 0")]
    BadTolerance {
        /// The tolerance.
        tolerance: f64,
    },
    /// A number of a material is infinite, not a number, or negative.
    #[error("the {what} of material {name:?} is {value}; it takes a finite number of at least 0")]
    BadMaterial {
        /// The material, in the order in which they were added.
        material: u32,
        /// Its name.
        name: String,
        /// What the number is: its diffuse or specular reflectance, its exponent or its emission.
        what: &'static str,
        /// The number: the first one, if there are several.
        value: f64,
    },
    /// A face that was given up before it had vertices: see [`SceneBuilder::add_unreadable_face`](super::SceneBuilder::add_unreadable_face).
    #[error("polygon {polygon} cannot be read: {what}")]
    Unreadable {
        /// The polygon.
        polygon: PolygonId,
        /// Why.
        what: String,
    },
    /// More vertices, edges or polygons than a 32-bit id can name.
    #[error("the scene has more than {limit} {what}")]
    TooLarge {
        /// What there is too much of.
        what: &'static str,
        /// How many are taken.
        limit: u64,
    },
}

impl SceneProblem {
    /// The polygon that is to blame, if it is one.
    pub fn polygon(&self) -> Option<PolygonId> {
        match *self {
            Self::TooFewVertices { polygon, .. }
            | Self::UnknownVertex { polygon, .. }
            | Self::Unreadable { polygon, .. }
            | Self::UnknownMaterial { polygon, .. }
            | Self::UnknownObject { polygon, .. }
            | Self::SelfCrossing { polygon }
            | Self::HoleOutside { polygon }
            | Self::HolesOverlap { polygon }
            | Self::TooMuchWork { polygon }
            | Self::NonPlanar { polygon }
            | Self::ZeroArea { polygon }
            | Self::Duplicate { polygon, .. }
            | Self::OutOfRange { polygon, .. } => Some(polygon),
            _ => None,
        }
    }

    /// The policy of a [`Repair`](super::Repair) that drops faces with this problem, if there is one.
    pub fn dropped_by(&self) -> Option<DropCause> {
        match self {
            Self::NotFinite { .. }
            | Self::TooFewVertices { .. }
            | Self::UnknownVertex { .. }
            | Self::Unreadable { .. } => Some(DropCause::Malformed),
            Self::SelfCrossing { .. }
            | Self::HoleOutside { .. }
            | Self::HolesOverlap { .. }
            | Self::TooMuchWork { .. }
            | Self::OutOfRange { .. } => Some(DropCause::SelfCrossing),
            Self::NonPlanar { .. } => Some(DropCause::NonPlanar),
            Self::Duplicate { .. } => Some(DropCause::Duplicate),
            _ => None,
        }
    }
}

/// Everything that is wrong with a scene: every problem, not the first.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{}", summary(.problems))]
pub struct SceneError {
    /// The problems, by vertex and polygon in ascending order; never empty.
    pub problems: Vec<SceneProblem>,
}

fn summary(problems: &[SceneProblem]) -> String {
    match problems {
        [] => "no problem".to_owned(),
        [only] => only.to_string(),
        [first, rest @ ..] => format!("{first} (and {} more problems)", rest.len()),
    }
}
