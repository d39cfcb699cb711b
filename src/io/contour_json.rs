//! Contour images as JSON: schema `nusselt.contour/1`.

use crate::contour::{ContourImage, Domain, Horizon, Pane};
use crate::integral::{PolygonSum, Sums};
use crate::io::json::{field, rows};
use crate::scene::{ObjectId, Side};
use crate::verify::Certificate;
use glam::DVec3;
use serde::Serialize;
use std::io::{self, BufWriter, Write};

/// The schema's name.
pub const CONTOUR_SCHEMA: &str = "nusselt.contour/1";

/// A solid angle, with the form factor for hemispheres.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Share {
    /// In steradians.
    pub solid_angle: f64,
    /// Only for hemispheres.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub form_factor: Option<f64>,
}

/// The directions that were looked at.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub enum DomainRow {
    /// All of them.
    Sphere,
    /// Those above a horizon.
    Hemisphere {
        /// The normal: of unit length, or as it was given.
        normal: [f64; 3],
    },
    /// Those that a camera sees.
    Frustum {
        /// The unit direction that it looks in.
        towards: [f64; 3],
        /// The unit direction up in its picture.
        up: [f64; 3],
        /// The vertical field of view, in degrees.
        fov: f64,
        /// Width over height.
        aspect: f64,
        /// The half-spaces that bound it exactly, by their normals to the inside: those of the upper, right, lower and left border.
        normals: [[f64; 3]; 4],
    },
    /// Those inside of windows.
    Window {
        /// The windows: numbers of polygons, and lists of corners.
        windows: Vec<WindowRow>,
        /// The normal of the horizon that they are cut off at: of unit length, or as it was given; left out if there is none.
        #[serde(skip_serializing_if = "Option::is_none")]
        normal: Option<[f64; 3]>,
    },
}

/// A window.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum WindowRow {
    /// A polygon of the scene.
    Polygon(u32),
    /// A polygon of its own.
    Ring(Vec<[f64; 3]>),
}

/// A visible polygon.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PolygonRow<'a> {
    /// Its number.
    pub polygon: u32,
    /// The name of its object.
    pub object: &'a str,
    /// The name of its material.
    pub material: &'a str,
    /// How much of it is seen.
    #[serde(flatten)]
    pub share: Share,
    /// The part of it where its front is seen: of the form factor, or of the solid angle if there is none.
    pub front: f64,
    /// Likewise for its back.
    pub back: f64,
}

/// A visible object.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ObjectRow<'a> {
    /// Its name.
    pub object: &'a str,
    /// How much of it is seen.
    #[serde(flatten)]
    pub share: Share,
}

/// That an image was proved.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct CertificateRow {
    /// Always true: an image whose proof fails is not written.
    pub valid: bool,
    /// The cells.
    pub cells: usize,
    /// The great circles on which their sides lie.
    pub great_circles: usize,
    /// The signs that were decided exactly.
    pub exact_decisions: u64,
}

impl From<Certificate> for CertificateRow {
    fn from(certificate: Certificate) -> Self {
        let Certificate { cells, great_circles, exact_decisions } = certificate;
        Self { valid: true, cells, great_circles, exact_decisions }
    }
}

/// Everything about a contour image but its cells.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ContourSummary<'a> {
    /// [`CONTOUR_SCHEMA`].
    pub schema: &'static str,
    /// The viewpoint.
    pub eye: [f64; 3],
    /// The polygon that it is on.
    pub on: Option<u32>,
    /// The epsilon of the 3D BSP.
    pub epsilon: f64,
    /// The directions looked at.
    pub domain: DomainRow,
    /// The visible polygons, ascending.
    pub polygons: Vec<PolygonRow<'a>>,
    /// The visible objects, in the order of the file.
    pub objects: Vec<ObjectRow<'a>>,
    /// Where nothing is seen.
    pub background: Share,
    /// All of it.
    pub total: Share,
    /// That the image was proved; left out of the file if it was not.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub certificate: Option<CertificateRow>,
}

impl<'a> ContourSummary<'a> {
    /// Sums up an image, without a certificate: set that if there is one. Costs one pass over its cells.
    pub fn new(image: &'a ContourImage) -> Self {
        let scene = image.scene();
        let angles = image.solid_angles();
        let factors = image.form_factors();
        let share_of =
            |sum: fn(&Sums) -> f64| Share { solid_angle: sum(&angles), form_factor: factors.as_ref().map(sum) };
        let mut objects = vec![None::<Share>; scene.objects().len()];
        let mut polygons = Vec::with_capacity(angles.polygons.len());
        for (k, angle) in angles.polygons.iter().enumerate() {
            let polygon = scene.polygon(angle.polygon);
            let factor = factors.as_ref().map(|sums| sums.polygons[k]);
            let share = Share { solid_angle: angle.both(), form_factor: factor.map(PolygonSum::both) };
            let sides = factor.unwrap_or(*angle);
            polygons.push(PolygonRow {
                polygon: angle.polygon.0,
                object: polygon.object_name(),
                material: &polygon.material().name,
                share,
                front: sides.front,
                back: sides.back,
            });
            objects[polygon.object().index()].get_or_insert_default().add(share);
        }
        let objects = (0..).map(ObjectId).zip(objects).filter_map(|(id, share)| {
            let object = scene.objects()[id.index()].as_str();
            share.map(|share| ObjectRow { object, share })
        });
        Self {
            schema: CONTOUR_SCHEMA,
            eye: image.viewpoint().eye().to_array(),
            on: image.viewpoint().surface().map(|(polygon, _)| polygon.0),
            epsilon: image.epsilon(),
            domain: domain_row(image),
            objects: objects.collect(),
            polygons,
            background: share_of(|sums| sums.background),
            total: share_of(Sums::total),
            certificate: None,
        }
    }
}

impl Share {
    pub(super) fn add(&mut self, other: Self) {
        self.solid_angle += other.solid_angle;
        if let Some(factor) = other.form_factor {
            *self.form_factor.get_or_insert_default() += factor;
        }
    }
}

pub(super) fn domain_row(image: &ContourImage) -> DomainRow {
    // Adding 0 turns -0 into 0.
    let numbers = |v: DVec3| (v + 0.0).to_array();
    let normal = match image.domain().horizon() {
        None => None,
        Some(Horizon::Normal(normal)) => Some(normal),
        Some(Horizon::Surface) => image.normal(),
    };
    let normal = normal.map(numbers);
    match image.domain() {
        Domain::Frustum(frustum) => DomainRow::Frustum {
            towards: numbers(frustum.frame().towards()),
            up: numbers(frustum.frame().up()),
            fov: frustum.degrees(),
            aspect: frustum.aspect(),
            normals: frustum.normals().map(numbers),
        },
        Domain::Window(windows) => {
            let windows = windows.panes().iter().map(|pane| match pane {
                Pane::Polygon(polygon) => WindowRow::Polygon(polygon.0),
                Pane::Ring(ring) => WindowRow::Ring(ring.iter().map(|&p| numbers(p)).collect()),
            });
            DomainRow::Window { windows: windows.collect(), normal }
        }
        Domain::Sphere | Domain::Hemisphere(_) | Domain::Above => {
            normal.map_or(DomainRow::Sphere, |normal| DomainRow::Hemisphere { normal })
        }
    }
}

pub(super) fn side_name(side: Side) -> &'static str {
    if side == Side::Front { "front" } else { "back" }
}

#[derive(Serialize)]
struct CellRow<'a> {
    polygon: Option<u32>,
    side: Option<&'static str>,
    boundary: &'a [[f64; 3]],
    #[serde(flatten)]
    share: Share,
}

/// Writes the image, one cell a line. Numbers are the shortest decimals that read back as the same f64.
/// Cells are written as they are made up: memory does not grow with their number.
///
/// # Errors
/// Those of `out`.
pub fn write_contour_json(image: &ContourImage, summary: &ContourSummary<'_>, out: impl Write) -> io::Result<()> {
    let mut out = BufWriter::new(out);
    write!(out, "{{")?;
    field(&mut out, "schema", &summary.schema)?;
    field(&mut out, "eye", &summary.eye)?;
    field(&mut out, "on", &summary.on)?;
    field(&mut out, "epsilon", &summary.epsilon)?;
    field(&mut out, "domain", &summary.domain)?;
    let mut boundary = Vec::new();
    rows(&mut out, "cells", image.cells(), |out, cell| {
        boundary.clear();
        boundary.extend(cell.boundary().map(|d| d.to_array()));
        let side = cell.side().map(side_name);
        let share = Share { solid_angle: cell.solid_angle(), form_factor: cell.form_factor() };
        let row = CellRow { polygon: cell.polygon().map(|id| id.0), side, boundary: &boundary, share };
        Ok(serde_json::to_writer(out, &row)?)
    })?;
    writeln!(out, ",")?;
    rows(&mut out, "polygons", &summary.polygons, |out, row| Ok(serde_json::to_writer(out, row)?))?;
    writeln!(out, ",")?;
    rows(&mut out, "objects", &summary.objects, |out, row| Ok(serde_json::to_writer(out, row)?))?;
    writeln!(out, ",")?;
    field(&mut out, "background", &summary.background)?;
    write!(out, "\"total\": ")?;
    serde_json::to_writer(&mut out, &summary.total)?;
    if let Some(certificate) = &summary.certificate {
        write!(out, ",\n\"certificate\": ")?;
        serde_json::to_writer(&mut out, certificate)?;
    }
    writeln!(out, "}}")?;
    out.flush()
}
