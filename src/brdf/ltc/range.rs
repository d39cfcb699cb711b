//! Bounds of GGX times cosine over a polygon.
//!
//! For a fixed viewer v, with z = uz and c = u.v, the product is D(hz) F(h.v) z / (2 (vz S(z) + z S(vz))) with hz^2 = (z + vz)^2 / (2 + 2 c),
//! (h.v)^2 = (1 + c) / 2 and S(z)^2 = z^2 + a^2 (1 - z^2). D grows with hz, as a is at most 1, and so with z and as c falls; the last factor grows with z, as S(z) / z falls; and F grows as c falls.
//! So the bounds are at the bounds of z and c, which are those of a cap around the polygon.

use crate::integral::Cap;
use glam::DVec3;
use std::f64::consts::PI;

/// The least and the largest value over a convex polygon above the horizon with those unit corners, of facets of a reflectance at normal incidence (Schlick) and
/// a roughness of at most 1.
pub(super) fn of_ggx(at_normal: DVec3, roughness: f64, outgoing: DVec3, corners: &[DVec3]) -> [DVec3; 2] {
    let cap = Cap::around(corners);
    let [low, high] = cap.cosines(DVec3::Z).map(|z| z.max(0.0));
    let [away, along] = cap.cosines(outgoing);
    let square = roughness * roughness;
    let smith = |z: f64| (z * z + square * (1.0 - z * z)).sqrt();
    let at = |z: f64, c: f64| {
        // Not a number where h has no direction: then it may be the normal.
        let hz2 = ((z + outgoing.z).powi(2) / (2.0 + 2.0 * c)).min(1.0);
        let slopes = hz2 * (square - 1.0) + 1.0;
        let visible = 0.5 * z / (outgoing.z * smith(z) + z * smith(outgoing.z));
        let schlick = (1.0 - (0.5 * (1.0 + c)).max(0.0).sqrt()).clamp(0.0, 1.0).powi(5);
        (at_normal + (DVec3::ONE - at_normal) * schlick) * (square / (PI * slopes * slopes) * visible)
    };
    // Some rounding.
    [at(low, along) * (1.0 - 1e-12), at(high, away) * (1.0 + 1e-12)]
}

#[cfg(test)]
mod tests {
    use super::of_ggx;
    use crate::brdf::tests::{RHO, at};
    use crate::brdf::{Brdf, Fresnel, Ggx};
    use crate::integral::random::Random;
    use glam::DVec3;

    #[test]
    fn no_value_is_out_of_range() {
        let mut random = Random(5);
        let mut tightest = f64::INFINITY;
        for roughness in [0.003, 0.05, 0.3, 1.0] {
            let ggx = Ggx::new(Fresnel::schlick(RHO).unwrap(), roughness, roughness).unwrap();
            for _ in 0..400 {
                let outgoing = random.direction();
                let polygon = random.polygon(crate::brdf::mirrored(outgoing), roughness);
                if polygon.len() < 3 {
                    continue;
                }
                let [least, most] = of_ggx(RHO, roughness, outgoing, &polygon);
                let [mut low, mut high] = [DVec3::INFINITY, DVec3::ZERO];
                for _ in 0..200 {
                    // Any mixture of corners is within.
                    let mixed: DVec3 = polygon.iter().map(|&corner| corner * random.unit().powi(4)).sum();
                    let Some(incoming) = mixed.try_normalize().filter(|u| u.z > 0.0) else { continue };
                    let value = ggx.eval(incoming, outgoing) * incoming.z;
                    assert!(value.cmpge(least).all() && value.cmple(most).all(), "{value} in {least} to {most}");
                    (low, high) = (low.min(value), high.max(value));
                }
                tightest = tightest.min(most.x / high.x);
            }
        }
        // Caps of small polygons hold little else.
        assert!(tightest < 1.1, "{tightest}");
        let whole = of_ggx(RHO, 0.5, at(89.9, 0.0), &crate::brdf::tests::HEMISPHERE);
        assert!(whole[0].abs().max_element() < 1e-12 && whole[1].is_finite());
    }
}
