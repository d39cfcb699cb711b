//! From the vertices of a file to coordinates of a scene.

use super::super::Origin;
use super::json::Model;
use crate::exact::orient3d;
use glam::{DMat3, DVec3};

/// How the vertices of a file become points.
#[derive(Clone, Copy, Debug)]
pub(super) struct Coordinates {
    scale: DVec3,
    translate: DVec3,
    /// How long a unit of the file's reference system is in the scene.
    unit: f64,
}

impl Coordinates {
    /// By the transform of a file, if it has one; otherwise what is wrong with it.
    pub(super) fn of(model: &Model, origin: Origin) -> Result<Self, String> {
        let [mut scale, mut translate] = match &model.transform {
            Some(transform) => [transform.scale, transform.translate].map(DVec3::from),
            None => [DVec3::ONE, DVec3::ZERO],
        };
        if !(scale.cmpgt(DVec3::ZERO).all() && scale.is_finite() && translate.is_finite()) {
            return Err("its scale is not above 0".to_owned());
        }
        let mut unit = 1.0;
        if origin != Origin::File {
            translate = DVec3::ZERO;
        }
        if origin == Origin::Integers {
            if scale != DVec3::splat(scale.x) {
                return Err("its scales differ by axis, so that its integers have another shape; \
                            read it with a local origin"
                    .to_owned());
            }
            unit = 1.0 / scale.x;
            scale = DVec3::ONE;
        }
        Ok(Self { scale, translate, unit })
    }

    /// The point of a vertex.
    pub(super) fn point(&self, vertex: [f64; 3]) -> DVec3 {
        DVec3::from(vertex) * self.scale + self.translate
    }

    /// The placing of a template by a matrix, row by row, at a point.
    pub(super) fn placing(&self, matrix: &[f64; 16], at: DVec3) -> Result<Placing, String> {
        let [rows @ .., _, _, _, _] = matrix;
        if matrix[12..] != [0.0, 0.0, 0.0, 1.0] {
            return Err("the last row of its matrix is not 0 0 0 1".to_owned());
        }
        let row = |k: usize| DVec3::from_slice(&rows[4 * k..][..3]);
        let matrix = DMat3::from_cols(row(0), row(1), row(2)).transpose();
        let shift = DVec3::new(rows[3], rows[7], rows[11]);
        let is_mirrored = orient3d(DVec3::ZERO, matrix.x_axis, matrix.y_axis, matrix.z_axis).is_negative();
        Ok(Placing { matrix, shift, unit: self.unit, at, is_mirrored })
    }
}

/// Where a template is put.
#[derive(Clone, Copy, Debug)]
pub(super) struct Placing {
    matrix: DMat3,
    shift: DVec3,
    unit: f64,
    at: DVec3,
    /// Whether it is put there as its mirror image: what was counter-clockwise runs clockwise.
    pub(super) is_mirrored: bool,
}

impl Placing {
    /// Where a vertex of the template is put.
    pub(super) fn point(&self, vertex: [f64; 3]) -> DVec3 {
        (self.matrix * DVec3::from(vertex) + self.shift) * self.unit + self.at
    }
}
