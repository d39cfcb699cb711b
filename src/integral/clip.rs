//! Convex spherical polygons cut off at a great circle, in `f64`.

use super::flux::double_flux;
use super::unit::{UnitDirection, arcs, outline};
use glam::DVec3;

/// The vertices of a polygon as unit vectors of `f64`, none there twice and no arc longer than 90 degrees.
pub(crate) fn unit_outline(boundary: &[DVec3]) -> Vec<DVec3> {
    outline(boundary.iter().filter_map(|&v| UnitDirection::new(v))).iter().map(UnitDirection::rounded).collect()
}

/// What of an outline is in the half sphere of a unit `normal`; an outline again, empty if nothing is.
///
/// Signs are those of `f64`: a vertex within 4e-16 of the great circle may count as on either side, and crossings are
/// rounded. So the result is off by a strip of that width along its boundary, which is what integrals that use it state.
pub(crate) fn clip(outline: &[DVec3], normal: DVec3) -> Vec<DVec3> {
    let heights: Vec<f64> = outline.iter().map(|v| v.dot(normal)).collect();
    // A half sphere whose own boundary is the great circle has no corner that tells its side.
    if heights.iter().all(|h| h.abs() < 1e-15) {
        return if double_flux(outline).dot(normal) > 0.0 { outline.to_vec() } else { Vec::new() };
    }
    let count = outline.len();
    let before = |k: usize| (k + count - 1) % count;
    // Begun where the boundary comes in, so that what leads out is known when it does so again.
    let Some(start) = (0..count).find(|&k| heights[k] >= 0.0 && heights[before(k)] < 0.0) else {
        return if heights.iter().all(|&h| h >= 0.0) { outline.to_vec() } else { Vec::new() };
    };
    let crossing = |k: usize, next: usize| {
        (outline[k] * heights[next].abs() + outline[next] * heights[k].abs()).try_normalize().unwrap_or(outline[k])
    };
    let mut kept: Vec<DVec3> = Vec::with_capacity(count + 3);
    if heights[start] > 0.0 {
        kept.push(crossing(before(start), start));
    }
    let mut exit = DVec3::ZERO;
    for k in (start..start + count).map(|k| k % count) {
        let next = (k + 1) % count;
        if heights[k] >= 0.0 {
            kept.push(outline[k]);
            if heights[next] < 0.0 {
                exit = if heights[k] > 0.0 { crossing(k, next) } else { outline[k] };
                kept.push(exit);
            }
        } else if heights[next] >= 0.0 {
            let entry = if heights[next] > 0.0 { crossing(k, next) } else { outline[next] };
            kept.extend(along(exit, entry, normal));
            kept.push(entry);
        }
    }
    kept.dedup();
    while kept.len() > 1 && kept.first() == kept.last() {
        kept.pop();
    }
    kept
}

/// The middle of the arc about `normal` from one unit vector to another, if it is of more than 90 degrees: it may be one of 180.
fn along(from: DVec3, to: DVec3, normal: DVec3) -> Option<DVec3> {
    if from.dot(to) >= 0.0 {
        return None;
    }
    let half = 0.5 * normal.dot(from.cross(to)).max(0.0).atan2(from.dot(to));
    (from * half.cos() + normal.cross(from) * half.sin()).try_normalize()
}

/// The length of an outline's boundary, in radians.
pub(crate) fn perimeter(outline: &[DVec3]) -> f64 {
    arcs(outline).map(|[a, b]| a.cross(*b).length().atan2(a.dot(*b))).sum()
}

#[cfg(test)]
mod tests {
    use super::{clip, unit_outline};
    use crate::integral::solid_angle;
    use glam::DVec3;
    use std::f64::consts::{FRAC_PI_2, PI, TAU};

    #[test]
    fn half_spheres_are_cut_to_lunes() {
        let hemisphere = [DVec3::X, DVec3::Y, DVec3::NEG_X, DVec3::NEG_Y];
        for k in 0..200 {
            let angle = f64::from(k) * TAU / 200.0;
            for tilt in [0.0, 1e-9, 0.3, FRAC_PI_2, 2.0, PI - 1e-9] {
                // The inward normal of the great circle, `tilt` away from the zenith.
                let normal = DVec3::new(tilt.sin() * angle.cos(), tilt.sin() * angle.sin(), tilt.cos());
                let lune = clip(&unit_outline(&hemisphere), normal);
                let [area, expected] = [solid_angle(&lune), 2.0 * (PI - tilt)];
                assert!((area - expected).abs() < 1e-14, "{area} instead of {expected} at {angle} {tilt}");
            }
        }
    }

    #[test]
    fn halves_add_up() {
        let polygon =
            unit_outline(&[DVec3::new(1.0, 0.2, 0.5), DVec3::new(-0.3, 2.0, 1.0), DVec3::new(-1.0, -1.0, 0.4)]);
        let whole = solid_angle(&polygon);
        for k in 0..100 {
            let normal = DVec3::new((f64::from(k) * 0.7).cos(), (f64::from(k) * 1.3).sin(), 0.1).normalize();
            let halves = solid_angle(&clip(&polygon, normal)) + solid_angle(&clip(&polygon, -normal));
            assert!((halves - whole).abs() < 1e-14, "{halves} of {whole}");
        }
    }

    #[test]
    fn what_touches_is_kept_whole_or_not_at_all() {
        let octant = [DVec3::X, DVec3::Y, DVec3::Z];
        assert_eq!(clip(&octant, DVec3::Z), octant);
        assert!(solid_angle(&clip(&octant, DVec3::NEG_Z)) == 0.0);
        assert!(clip(&[], DVec3::Z).is_empty());
        let hemisphere = [DVec3::X, DVec3::Y, DVec3::NEG_X, DVec3::NEG_Y];
        assert_eq!(clip(&hemisphere, DVec3::Z), hemisphere);
        assert!(clip(&hemisphere, DVec3::NEG_Z).is_empty());
    }
}
