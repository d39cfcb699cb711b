//! Convex polygons on the faces of a cube around an eye, for comparisons by area.

use glam::{DMat3, DVec2, DVec3};

/// The six faces, as matrices into coordinates (x, y) on the face and z away from the eye. Exact.
pub(crate) fn faces() -> [DMat3; 6] {
    let [x, y, z] = DVec3::AXES;
    [[y, z, x], [z, y, -x], [z, x, y], [x, z, -y], [x, y, z], [y, x, -z]].map(|rows| {
        let [a, b, c] = rows;
        DMat3::from_cols(a, b, c).transpose()
    })
}

/// The part of a convex polygon on the positive side of a plane through the eye.
pub(crate) fn cut(polygon: &[DVec3], normal: DVec3) -> Vec<DVec3> {
    let mut kept = Vec::with_capacity(polygon.len() + 1);
    for (k, &a) in polygon.iter().enumerate() {
        let b = polygon[(k + 1) % polygon.len()];
        let (height_a, height_b) = (normal.dot(a), normal.dot(b));
        if height_a >= 0.0 {
            kept.push(a);
        }
        if height_a * height_b < 0.0 {
            kept.push(a + (b - a) * (height_a / (height_a - height_b)));
        }
    }
    kept
}

/// What of a convex polygon, given relative to the eye, is seen through a face, projected onto it; empty if that
/// is less than a polygon. Counter-clockwise.
pub(crate) fn on_face(face: DMat3, corners: impl IntoIterator<Item = DVec3>) -> Vec<DVec2> {
    let mut polygon: Vec<DVec3> = corners.into_iter().map(|p| face * p).collect();
    for side in [[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]] {
        polygon = cut(&polygon, DVec3::new(side[0], side[1], 1.0));
    }
    let mut polygon: Vec<DVec2> = polygon.into_iter().filter(|p| p.z > 0.0).map(|p| p.truncate() / p.z).collect();
    if polygon.len() < 3 {
        polygon.clear();
    }
    if area(&polygon) < 0.0 {
        polygon.reverse();
    }
    polygon
}

/// The area of a polygon, positive if it runs counter-clockwise.
pub(crate) fn area(polygon: &[DVec2]) -> f64 {
    let Some(&first) = polygon.first() else { return 0.0 };
    polygon.windows(2).map(|pair| (pair[0] - first).perp_dot(pair[1] - first)).sum::<f64>() * 0.5
}

/// The length of a polygon's boundary.
pub(crate) fn perimeter(polygon: &[DVec2]) -> f64 {
    (0..polygon.len()).map(|k| polygon[k].distance(polygon[(k + 1) % polygon.len()])).sum()
}
