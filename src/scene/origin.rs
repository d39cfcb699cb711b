//! Where a scene's numbers begin.

use glam::DVec3;

/// What coordinates from `low` to `high` are to be counted from: along each axis 0, or `low` if they are farther from 0 than apart. No difference is rounded: none is of numbers of which one is more than twice the
/// other (Sterbenz 1974).
pub(crate) fn origin_near(low: DVec3, high: DVec3) -> DVec3 {
    let origin = |low: f64, high: f64| {
        let is_far = if low > 0.0 { 0.5 * high <= low } else { high < 0.0 && 0.5 * low >= high };
        if is_far { low } else { 0.0 }
    };
    DVec3::new(origin(low.x, high.x), origin(low.y, high.y), origin(low.z, high.z))
}
