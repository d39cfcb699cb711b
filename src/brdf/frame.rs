//! The frame of a surface.

use glam::{DMat3, DVec3};

/// From the scene's directions to a surface's: z along the normal, x along the tangent.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    to_local: DMat3,
}

impl Frame {
    /// Of a unit normal and a tangent, made perpendicular; without one any that is always the same. `None` if the tangent has
    /// no direction beside the normal.
    pub(super) fn new(normal: DVec3, tangent: Option<DVec3>) -> Option<Self> {
        let x = match tangent {
            None => normal.any_orthonormal_vector(),
            Some(tangent) => {
                let unit = (tangent / tangent.abs().max_element()).try_normalize()?;
                let beside = unit - normal * normal.dot(unit);
                // What is left of a tangent along the normal is rounding.
                if beside.length() < 1e-9 {
                    return None;
                }
                let beside = beside.normalize();
                (beside - normal * normal.dot(beside)).normalize()
            }
        };
        Some(Self { to_local: DMat3::from_cols(x, normal.cross(x), normal).transpose() })
    }

    pub(super) fn to_local(self, direction: DVec3) -> DVec3 {
        self.to_local * direction
    }

    pub(super) fn to_scene(self, direction: DVec3) -> DVec3 {
        self.to_local.transpose() * direction
    }
}
