//! What models of the halfway vector have in common.

use super::mirrored;
use crate::integral::Peak;
use glam::DVec3;

/// The unit vector halfway between two directions above the surface.
pub(super) fn halfway(incoming: DVec3, outgoing: DVec3) -> DVec3 {
    (incoming + outgoing).normalize()
}

/// At most so many peaks along a ridge.
const RIDGE: u32 = 12;

/// Where the lobe of halfway vectors about the normal, of those widths along x and y, is for the viewer's direction.
///
/// A turn of the halfway vector by d turns the direction by 2 d in the plane of the two, and by 2 d times the cosine
/// between them across it. A lobe much wider one way than the other is a ridge, and gets several peaks along it.
pub(super) fn peaks(outgoing: DVec3, width_x: f64, width_y: f64) -> Vec<Peak> {
    let [narrow, wide] = [width_x.min(width_y), width_x.max(width_y)];
    let along = if width_x > width_y { DVec3::X } else { DVec3::Y };
    let width = (2.0 * narrow * outgoing.z.max(narrow)).min(1.0);
    let mut peaks = vec![Peak { axis: mirrored(outgoing), width }];
    let count = (wide / narrow).round().clamp(1.0, f64::from(RIDGE)) as u32;
    for k in 1..count {
        for sign in [-1.0, 1.0] {
            let tilt = sign * 2.0 * wide * f64::from(k) / f64::from(count);
            let half = (DVec3::Z + along * tilt).normalize();
            let axis = half * (2.0 * half.dot(outgoing)) - outgoing;
            if axis.z > 0.0 && half.dot(outgoing) > 0.0 {
                peaks.push(Peak { axis, width });
            }
        }
    }
    peaks
}
