//! Caps around spherical polygons.

use glam::DVec3;

/// All directions within an angle of a centre.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cap {
    /// A unit vector.
    centre: DVec3,
    /// The cosine and sine of the angle; it is at most 90 degrees, or all there are.
    reach: Option<[f64; 2]>,
}

impl Cap {
    /// A cap that holds a convex polygon of those unit corners. Of a polygon as large as a hemisphere it is the whole sphere.
    pub(crate) fn around(corners: &[DVec3]) -> Self {
        let Some(centre) = corners.iter().sum::<DVec3>().try_normalize() else {
            return Self { centre: DVec3::Z, reach: None };
        };
        let reach = corners.iter().fold(1.0_f64, |reach, v| reach.min(v.dot(centre)));
        Self { centre, reach: (reach > 0.0).then(|| [reach, sine(reach)]) }
    }

    /// The least and the largest cosine of its directions with a unit axis, give or take 1e-12.
    pub(crate) fn cosines(&self, axis: DVec3) -> [f64; 2] {
        let Some([reach, aside]) = self.reach else { return [-1.0, 1.0] };
        let off = axis.dot(self.centre);
        // Cosines of the sum and of the difference of the two angles, unless that passes the axis or its opposite.
        let (along, across) = (off * reach, sine(off) * aside);
        let least = if off <= -reach { -1.0 } else { along - across - 1e-12 };
        let most = if off >= reach { 1.0 } else { along + across + 1e-12 };
        [least, most]
    }
}

fn sine(cosine: f64) -> f64 {
    (1.0 - cosine * cosine).max(0.0).sqrt()
}
