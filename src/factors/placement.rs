//! Where a scene is while it is computed with.

use crate::scene::{Scene, origin_near};
use glam::DVec3;

/// Coordinates near the origin and near 1, of which every one of the scene's is the exact image.
#[derive(Clone, Copy, Debug)]
pub(super) struct Placement {
    origin: DVec3,
    /// A power of two, so that squares of lengths neither overflow nor vanish.
    scale: f64,
}

impl Placement {
    pub(super) fn of(scene: &Scene) -> Self {
        let (low, high) = scene.bounds().unwrap_or((DVec3::ZERO, DVec3::ZERO));
        // Points between corners round to places as far apart as numbers are there, and with them what is integrated: a scene that is farther from
        // the origin than it is large is moved there.
        let origin = origin_near(low, high);
        let most = (low - origin).abs().max((high - origin).abs()).max_element();
        Self { origin, scale: inverse_power_of_two(most) }
    }

    /// The image of a point of the scene; exact for all within its bounds.
    pub(super) fn local(self, p: DVec3) -> DVec3 {
        (p - self.origin) * self.scale
    }

    pub(super) fn local_length(self, length: f64) -> f64 {
        length * self.scale
    }

    /// The point of the scene that this is the image of: exactly, for the scene's own, and rounded otherwise.
    pub(super) fn global(self, p: DVec3) -> DVec3 {
        p / self.scale + self.origin
    }

    /// An area in the scene's unit: infinite, or 0, where numbers do not hold it.
    pub(super) fn global_area(self, area: f64) -> f64 {
        area / self.scale / self.scale
    }
}

/// The power of two that brings a positive number near 1.
fn inverse_power_of_two(x: f64) -> f64 {
    let exponent = ((x.to_bits() >> 52) as i32 & 0x7ff) - 1023;
    2.0_f64.powi(-exponent.clamp(-1000, 1000))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Material;

    fn around(corners: [[f64; 3]; 3]) -> Placement {
        let scene = Scene::builder().mesh(&corners, &[vec![0, 1, 2]], Material::new("grey")).build();
        Placement::of(&scene.expect("a triangle"))
    }

    #[test]
    fn a_scene_far_away_is_moved_to_the_origin_without_rounding() {
        let corners = [[1e15, -3.0, 5e-300], [1e15 + 0.125, -7.0, 5e-300], [1e15 + 2.0, -5.0, 5e-300]];
        let placement = around(corners);
        let local = corners.map(|p| placement.local(p.into()));
        // By a power of two near the longest edge, 4.
        let expected = [[0.0, -0.75, 0.0], [0.03125, -1.75, 0.0], [0.5, -1.25, 0.0]];
        assert_eq!(local, expected.map(DVec3::from), "-7 is more than twice -3");
        assert_eq!(local.map(|p| placement.global(p)), corners.map(DVec3::from));
        assert!((placement.local_length(8.0) - 2.0).abs() <= 0.0 && (placement.global_area(1.0) - 16.0).abs() <= 0.0);
    }

    #[test]
    fn a_scene_that_reaches_to_the_origin_stays() {
        for far in [3.0, 1e300, 1e-300] {
            let placement = around([[0.0; 3], [far, -far, far], [far, far, -far]]);
            assert_eq!(placement.origin, DVec3::ZERO);
            let most = placement.local(DVec3::splat(far)).x;
            assert!((1.0..2.0).contains(&most), "{far}: {most}");
        }
    }
}
