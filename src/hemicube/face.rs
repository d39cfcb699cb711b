//! The five faces of half a cube around the eye, and the frame it stands in.

use glam::DVec3;

/// A face of the hemicube, which stands on the eye's tangent plane.
///
/// The frame is right-handed: the third axis is the normal, the first two are tangents chosen by the
/// normal alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Face {
    /// Across the normal.
    Top = 0,
    /// Across the first tangent.
    PlusX = 1,
    /// Across its opposite.
    MinusX = 2,
    /// Across the second tangent.
    PlusY = 3,
    /// Across its opposite.
    MinusY = 4,
}

impl Face {
    /// All five, in order.
    pub const ALL: [Self; 5] = [Self::Top, Self::PlusX, Self::MinusX, Self::PlusY, Self::MinusY];

    /// A direction of the hemicube's frame in the frame of the face, which is a rotation of it: along its columns, along
    /// its rows, away from the eye. On side faces rows count upwards, from the horizon.
    pub(super) fn local(self, [x, y, z]: [f64; 3]) -> [f64; 3] {
        match self {
            Self::Top => [x, y, z],
            Self::PlusX => [y, z, x],
            Self::MinusX => [-y, z, -x],
            Self::PlusY => [-x, z, y],
            Self::MinusY => [x, z, -y],
        }
    }

    /// The reverse of [`Face::local`].
    pub(super) fn to_frame(self, [u, v, w]: [f64; 3]) -> [f64; 3] {
        match self {
            Self::Top => [u, v, w],
            Self::PlusX => [w, u, v],
            Self::MinusX => [-w, -u, v],
            Self::PlusY => [-u, w, v],
            Self::MinusY => [u, -w, v],
        }
    }

    /// Its number of rows on a hemicube whose top face has `resolution` of them.
    pub(super) fn rows(self, resolution: usize) -> usize {
        if self == Self::Top { resolution } else { resolution / 2 }
    }

    /// Where its first row is among the rows of all faces.
    pub(super) fn first_row(self, resolution: usize) -> usize {
        match self {
            Self::Top => 0,
            side => resolution + (side as usize - 1) * (resolution / 2),
        }
    }
}

/// The frame of a hemicube about a normal of any length: two tangents and the unit normal; `None` if the normal has no
/// direction. An axis of the world as normal gives a frame of axes of the world.
///
/// T. Duff and others, "Building an Orthonormal Basis, Revisited", JCGT 6(1), 2017.
pub(super) fn frame(normal: DVec3) -> Option<[DVec3; 3]> {
    let largest = normal.abs().max_element();
    if !(normal.is_finite() && largest > 0.0) {
        return None;
    }
    let n = (normal / largest).normalize();
    let sign = 1.0_f64.copysign(n.z);
    let a = -1.0 / (sign + n.z);
    let b = n.x * n.y * a;
    let first = DVec3::new(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x);
    let second = DVec3::new(b, sign + n.y * n.y * a, -n.y);
    Some([first, second, n])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_right_handed_and_orthonormal() {
        let normals = [
            DVec3::X,
            DVec3::NEG_X,
            DVec3::Y,
            DVec3::NEG_Y,
            DVec3::Z,
            DVec3::NEG_Z,
            DVec3::new(1e300, -2e300, 3e299),
            DVec3::new(5e-324, 0.0, -5e-324),
            DVec3::new(1.0, 1e-9, -1e-12),
        ];
        for normal in normals {
            let [a, b, c] = frame(normal).unwrap();
            assert!((a.cross(b) - c).length() < 1e-15, "{normal}");
            for v in [a, b, c] {
                assert!((v.length() - 1.0).abs() < 1e-15, "{normal}");
            }
        }
        for axis in [DVec3::X, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z] {
            for v in frame(axis).unwrap() {
                assert!(DVec3::AXES.contains(&v.abs()), "{axis}: {v}");
            }
        }
        assert_eq!(frame(DVec3::ZERO), None);
        assert_eq!(frame(DVec3::new(f64::NAN, 0.0, 1.0)), None);
    }

    #[test]
    fn faces_are_rotations() {
        for face in Face::ALL {
            let [a, b, c] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|v| DVec3::from(face.local(v)));
            assert_eq!(a.cross(b), c, "{face:?}");
            let back = DVec3::from(face.to_frame(face.local([1.0, 2.0, 3.0])));
            assert_eq!(back, DVec3::new(1.0, 2.0, 3.0), "{face:?}");
        }
    }
}
