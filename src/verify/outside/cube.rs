//! The faces of the cube around the eye, and what is cut to them, in `f64`.

use glam::{DVec2, DVec3};

/// A face of the cube of side 2 around the eye.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct CubeFace {
    axis: usize,
    is_negative: bool,
}

impl CubeFace {
    /// All six.
    pub const ALL: [Self; 6] = [
        Self { axis: 0, is_negative: false },
        Self { axis: 0, is_negative: true },
        Self { axis: 1, is_negative: false },
        Self { axis: 1, is_negative: true },
        Self { axis: 2, is_negative: false },
        Self { axis: 2, is_negative: true },
    ];

    /// The coordinates of a vector along the face's two sides and away from the eye. Exact.
    pub(super) fn local(self, v: DVec3) -> DVec3 {
        let along = v[self.axis];
        DVec3::new(v[(self.axis + 1) % 3], v[(self.axis + 2) % 3], if self.is_negative { -along } else { along })
    }

    /// The direction through a point of the face. Exact.
    pub fn direction(self, point: DVec2) -> DVec3 {
        let mut d = DVec3::ZERO;
        d[self.axis] = if self.is_negative { -1.0 } else { 1.0 };
        d[(self.axis + 1) % 3] = point.x;
        d[(self.axis + 2) % 3] = point.y;
        d
    }
}

/// The four planes that bound the directions through a face, positive inside.
const SIDES: [DVec3; 4] =
    [DVec3::new(1.0, 0.0, 1.0), DVec3::new(-1.0, 0.0, 1.0), DVec3::new(0.0, 1.0, 1.0), DVec3::new(0.0, -1.0, 1.0)];

/// The part of a segment, in local coordinates, that is seen through the face.
pub(super) fn clip_segment([mut a, mut b]: [DVec3; 2]) -> Option<[DVec3; 2]> {
    for side in SIDES {
        let [height_a, height_b] = [side.dot(a), side.dot(b)];
        if height_a < 0.0 && height_b < 0.0 {
            return None;
        }
        if height_a < 0.0 {
            a = crossing(a, b, height_a, height_b);
        } else if height_b < 0.0 {
            b = crossing(a, b, height_a, height_b);
        }
    }
    Some([a, b])
}

/// The part of a convex polygon, in local coordinates, that is seen through the face.
pub(super) fn clip_polygon(corners: &[DVec3]) -> Vec<DVec3> {
    let mut polygon = corners.to_vec();
    for side in SIDES {
        let mut kept = Vec::with_capacity(polygon.len() + 1);
        for (k, &a) in polygon.iter().enumerate() {
            let b = polygon[(k + 1) % polygon.len()];
            let [height_a, height_b] = [side.dot(a), side.dot(b)];
            if height_a >= 0.0 {
                kept.push(a);
            }
            if height_a * height_b < 0.0 {
                kept.push(crossing(a, b, height_a, height_b));
            }
        }
        polygon = kept;
    }
    polygon
}

fn crossing(a: DVec3, b: DVec3, height_a: f64, height_b: f64) -> DVec3 {
    a + (b - a) * (height_a / (height_a - height_b))
}

/// Where a vector in local coordinates meets the face.
pub(super) fn project(v: DVec3) -> DVec2 {
    DVec2::new(v.x / v.z, v.y / v.z).clamp(DVec2::NEG_ONE, DVec2::ONE)
}

/// The area of a polygon.
pub(super) fn area(corners: &[DVec2]) -> f64 {
    let Some(&first) = corners.first() else { return 0.0 };
    corners.windows(2).map(|pair| (pair[0] - first).perp_dot(pair[1] - first)).sum::<f64>().abs() * 0.5
}
