//! The scene's vertices and pieces in flat arrays, and what a view makes of them.

use super::face::Face;
use crate::scene::{PieceRef, Scene};
use glam::DVec3;

/// The pieces of a scene.
#[derive(Clone, Debug)]
pub(super) struct Geometry {
    x: Vec<f64>,
    y: Vec<f64>,
    z: Vec<f64>,
    /// Vertices of all pieces, one after the other.
    corners: Vec<u32>,
    /// Where the vertices of each piece begin in `corners`, and where the last ones end.
    starts: Vec<u32>,
    /// Unit normals of the pieces' planes.
    normals: Vec<DVec3>,
    /// The largest absolute coordinate.
    reach: f64,
}

impl Geometry {
    pub(super) fn new(scene: &Scene) -> Self {
        let vertices = scene.vertices();
        let mut starts = vec![0];
        let mut corners = Vec::new();
        for piece in scene.pieces() {
            corners.extend(piece.vertices().iter().map(|v| v.0));
            starts.push(corners.len() as u32);
        }
        Self {
            x: vertices.iter().map(|p| p.x).collect(),
            y: vertices.iter().map(|p| p.y).collect(),
            z: vertices.iter().map(|p| p.z).collect(),
            corners,
            starts,
            normals: scene.pieces().map(unit_normal).collect(),
            reach: vertices.iter().fold(0.0, |reach, p| p.abs().max_element().max(reach)),
        }
    }

    pub(super) fn piece_count(&self) -> usize {
        self.normals.len()
    }

    pub(super) fn corners(&self, piece: usize) -> &[u32] {
        &self.corners[self.starts[piece] as usize..self.starts[piece + 1] as usize]
    }

    /// The vertices of all pieces, in order.
    pub(super) fn pieces(&self) -> impl Iterator<Item = &[u32]> {
        self.starts.windows(2).map(|ends| &self.corners[ends[0] as usize..ends[1] as usize])
    }

    pub(super) fn normal(&self, piece: usize) -> DVec3 {
        self.normals[piece]
    }

    /// All vertices in a frame around the eye, into `seen`.
    pub(super) fn transform(&self, eye: DVec3, [t, b, n]: [DVec3; 3], resolution: usize, seen: &mut Seen) {
        // A power of two brings everything to about 1 and rounds nothing: no product overflows.
        let scale = inverse_power_of_two(self.reach.max(eye.abs().max_element()));
        let eye = eye * scale;
        let half = 0.5 * resolution as f64;
        seen.positions.clear();
        seen.screen.clear();
        let coordinates = self.x.iter().zip(&self.y).zip(&self.z);
        seen.positions.extend(coordinates.map(|((&x, &y), &z)| {
            let p = DVec3::new(x * scale - eye.x, y * scale - eye.y, z * scale - eye.z);
            [t.dot(p), b.dot(p), n.dot(p)]
        }));
        seen.screen.extend(seen.positions.iter().map(|&p| OnScreen::new(p, half)));
    }
}

/// A unit vector along the area vector of a piece; zero if it is lost to underflow.
pub(super) fn unit_normal(piece: PieceRef<'_>) -> DVec3 {
    let reach = piece.points().fold(0.0, |reach: f64, p| p.abs().max_element().max(reach));
    let scale = inverse_power_of_two(reach);
    let origin = piece.points().next().unwrap_or_default() * scale;
    let extent = piece.points().fold(0.0, |extent: f64, p| (p * scale - origin).abs().max_element().max(extent));
    let enlarge = inverse_power_of_two(extent);
    let points = || piece.points().map(|p| (p * scale - origin) * enlarge);
    let area: DVec3 = points().zip(points().skip(1)).map(|(a, b)| a.cross(b)).sum();
    let largest = area.abs().max_element();
    if largest > 0.0 { (area / largest).normalize() } else { DVec3::ZERO }
}

/// A power of two that brings a positive number to 1..2, or as near to it as powers go; 1 for 0.
pub(super) fn inverse_power_of_two(value: f64) -> f64 {
    let biased = (value.to_bits() >> 52) as i64;
    if value == 0.0 { 1.0 } else { f64::from_bits(((2046 - biased).clamp(1, 2046) as u64) << 52) }
}

/// The vertices as a view sees them.
#[derive(Clone, Debug, Default)]
pub(super) struct Seen {
    /// In the hemicube's frame.
    pub(super) positions: Vec<[f64; 3]>,
    pub(super) screen: Vec<OnScreen>,
}

/// A vertex on the face whose part of all directions it is in.
#[derive(Clone, Copy, Debug)]
pub(super) struct OnScreen {
    /// In pixels of the face; pixel `k` has its centre at `k`.
    pub(super) column: f32,
    pub(super) row: f32,
    /// A bit for the face, and [`ABOVE`].
    pub(super) flags: u32,
}

/// The vertex is above the horizon.
pub(super) const ABOVE: u32 = 1 << 5;
/// The bits of the faces.
pub(super) const FACES: u32 = (1 << 5) - 1;

impl OnScreen {
    /// Directions belong to the top face where z is the largest coordinate, else to the side face of the larger of
    /// the first two. So each face has a convex cone of directions (those of side faces reach down to the nadir).
    fn new([x, y, z]: [f64; 3], half: f64) -> Self {
        let above = if z > 0.0 { ABOVE } else { 0 };
        let (u, v, w, face) = if z >= x.abs() && z >= y.abs() {
            (x, y + z, z, Face::Top as u32)
        } else if x.abs() >= y.abs() {
            if x >= 0.0 { (y, z, x, Face::PlusX as u32) } else { (-y, z, -x, Face::MinusX as u32) }
        } else if y >= 0.0 {
            (-x, z, y, Face::PlusY as u32)
        } else {
            (x, z, -y, Face::MinusY as u32)
        };
        if w > 0.0 {
            let scale = half / w;
            let column = (u + w) * scale - 0.5;
            let row = v * scale - 0.5;
            Self { column: column as f32, row: row as f32, flags: above | (1 << face) }
        } else {
            // The eye itself, or straight below it.
            Self { column: 0.0, row: 0.0, flags: above }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_of_two_bring_numbers_to_one() {
        for value in [1.0, 1.5, 3.0, 1e300, 1e-300, 0.1] {
            assert!((1.0..2.0).contains(&(value * inverse_power_of_two(value))), "{value}");
        }
        for value in [f64::MAX, f64::MIN_POSITIVE, 5e-324] {
            let scaled = value * inverse_power_of_two(value);
            assert!(scaled > 0.0 && scaled < 4.0, "{value}");
        }
        assert_eq!(inverse_power_of_two(0.0).to_bits(), 1.0_f64.to_bits());
    }
}
