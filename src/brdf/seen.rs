//! What a surface sees, sorted by how it can be integrated.

use super::emission::Emission;
use super::frame::Frame;
use super::reflect::{Lit, above_horizon};
use super::{ReflectError, Sky};
use crate::contour::{Cell, ContourImage, Joiner};
use crate::integral::{Linear, clip};
use glam::DVec3;

/// Convex polygons of directions above the horizon, in the surface's frame.
#[derive(Default)]
pub(super) struct Seen {
    /// Those that one radiance comes from.
    pub(super) lit: Vec<Lit>,
    /// Those with a radiance that is linear on a triangle in space.
    pub(super) linear: Vec<(Vec<DVec3>, Linear)>,
    /// Those that show the sky, by sky; its vectors are in the surface's frame too.
    pub(super) skies: Vec<(Sky, Vec<Vec<DVec3>>)>,
}

impl Seen {
    /// What an image shows. Cells that show the same are joined to convex polygons: fewer have to be integrated over.
    pub(super) fn new<'e>(
        image: &ContourImage,
        frame: Frame,
        emission: impl Fn(Cell<'_>) -> Emission<'e>,
    ) -> Result<Self, ReflectError> {
        let mut joiner = Joiner::new(image);
        for cell in image.cells() {
            let emission = emission(cell);
            if let Emission::Constant(radiance) = emission {
                check(cell, radiance)?;
                if radiance == DVec3::ZERO {
                    continue;
                }
            }
            // What is linear is so on one piece.
            let piece = if matches!(emission, Emission::Vertices(_)) { cell.piece() } else { None };
            joiner.add(cell, (emission, piece));
        }
        let mut seen = Self::default();
        let mut boundary = Vec::new();
        for polygon in joiner.into_polygons() {
            boundary.clear();
            boundary.extend(polygon.boundary().map(|corner| frame.to_local(corner)));
            seen.add(polygon.cell, &boundary, &polygon.label.0, frame)?;
        }
        Ok(seen)
    }

    /// Adds what cells show, of which one is given, with the boundary of them all in the surface's frame.
    fn add(
        &mut self,
        cell: Cell<'_>,
        boundary: &[DVec3],
        emission: &Emission<'_>,
        frame: Frame,
    ) -> Result<(), ReflectError> {
        match emission {
            Emission::Constant(radiance) => self.lit.extend(Lit::new(boundary, *radiance)),
            Emission::Vertices(radiances) => {
                let triangles = fan(cell, radiances)?;
                let Some(outline) = above_horizon(boundary) else { return Ok(()) };
                for triangle in triangles.iter().filter(|triangle| triangle.is_lit()) {
                    let cuts = triangle.cuts.iter().flatten().map(|&cut| frame.to_local(cut));
                    let outline = cuts.fold(outline.clone(), |outline, cut| clip(&outline, cut));
                    if outline.len() > 2 {
                        self.linear.push((outline, triangle.linear(|v| frame.to_local(v))));
                    }
                }
            }
            Emission::Sky(sky) => {
                if let Some(radiance) = sky.as_constant() {
                    self.lit.extend(Lit::new(boundary, radiance));
                    return Ok(());
                }
                let sky = sky.turned(|v| frame.to_local(v));
                let above = above_horizon(boundary).unwrap_or_default();
                let outline = sky.horizon().map_or(above.clone(), |up| clip(&above, up));
                if outline.len() > 2 {
                    match self.skies.iter_mut().find(|(known, _)| *known == sky) {
                        Some((_, outlines)) => outlines.push(outline),
                        None => self.skies.push((sky, vec![outline])),
                    }
                }
            }
        }
        Ok(())
    }
}

impl Emission<'_> {
    /// What comes from one unit direction of a cell.
    pub(super) fn towards(&self, cell: Cell<'_>, direction: DVec3) -> DVec3 {
        match self {
            Self::Constant(radiance) => *radiance,
            Self::Sky(sky) => sky.radiance(direction),
            Self::Vertices(radiances) => {
                let triangles = fan(cell, radiances).unwrap_or_default();
                let is_in = |triangle: &&Triangle| triangle.cuts.iter().flatten().all(|cut| cut.dot(direction) >= 0.0);
                let found = triangles.iter().find(is_in);
                found.map_or(DVec3::ZERO, |triangle| triangle.linear(|v| v).at(direction))
            }
        }
    }
}

fn check(cell: Cell<'_>, radiance: DVec3) -> Result<(), ReflectError> {
    if radiance.is_finite() && radiance.min_element() >= 0.0 {
        return Ok(());
    }
    Err(ReflectError::BadEmission { cell: cell.id(), emission: radiance })
}

/// A triangle of a fan about a piece's first vertex, relative to the eye.
struct Triangle {
    corners: [DVec3; 3],
    radiances: [DVec3; 3],
    /// Inward normals of the planes through the eye and the diagonals that bound it.
    cuts: [Option<DVec3>; 2],
}

impl Triangle {
    fn is_lit(&self) -> bool {
        self.radiances.iter().any(|radiance| radiance.max_element() > 0.0)
    }

    fn linear(&self, turned: impl Fn(DVec3) -> DVec3) -> Linear {
        Linear::new(self.corners.map(turned), self.radiances)
    }
}

/// The triangles of the piece that a cell shows.
fn fan(cell: Cell<'_>, radiances: &[DVec3]) -> Result<Vec<Triangle>, ReflectError> {
    let image = cell.image();
    let eye = image.viewpoint().eye();
    let points = cell.piece().map(|piece| image.scene().piece(piece).points());
    let points: Vec<DVec3> = points.into_iter().flatten().map(|p| p - eye).collect();
    if points.len() != radiances.len() || points.is_empty() {
        let (vertices, radiances) = (points.len(), radiances.len());
        return Err(ReflectError::WrongVertices { cell: cell.id(), vertices, radiances });
    }
    for &radiance in radiances {
        check(cell, radiance)?;
    }
    // Scaled, so that no product over- or underflows.
    let most = points.iter().fold(f64::MIN_POSITIVE, |most, p| most.max(p.abs().max_element()));
    let points: Vec<DVec3> = points.into_iter().map(|p| p / most).collect();
    // A triangle is on the side of a diagonal where its third corner is.
    let diagonal = |k: usize, inside: DVec3| {
        let normal = points[0].cross(points[k] - points[0]).normalize_or_zero();
        if normal.dot(inside) < 0.0 { -normal } else { normal }
    };
    let last = points.len() - 1;
    let triangles = (1..last).map(|k| {
        let corners = [0, k, k + 1];
        Triangle {
            corners: corners.map(|c| points[c]),
            radiances: corners.map(|c| radiances[c]),
            cuts: [
                (k > 1).then(|| diagonal(k, points[k + 1] - points[k])),
                (k + 1 < last).then(|| diagonal(k + 1, points[k] - points[k + 1])),
            ],
        }
    });
    Ok(triangles.collect())
}
