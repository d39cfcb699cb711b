//! Which way is up in a picture.

use glam::DVec3;

/// An eye's axes: orthonormal, with `right = towards x up`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewFrame {
    right: DVec3,
    up: DVec3,
    towards: DVec3,
}

impl ViewFrame {
    /// Looking along `towards`, with `up` as far up as that allows. Where `up` does not tell (zero, or
    /// parallel to `towards`), a coordinate axis across does; a `towards` without direction counts as +y.
    pub fn new(towards: DVec3, up: DVec3) -> Self {
        let towards = direction(towards).unwrap_or(DVec3::Y);
        let across = |up: DVec3| {
            let across = towards.cross(direction(up)?);
            (across.length() > 1e-9).then(|| across.normalize())
        };
        let axis = if towards.z.abs() < 0.9 { DVec3::Z } else { DVec3::Y };
        let right = across(up).or_else(|| across(axis)).unwrap_or(DVec3::X);
        Self { right, up: right.cross(towards), towards }
    }

    /// The same, or `None` where one of the two has no direction or `up` does not tell.
    pub(crate) fn checked(towards: DVec3, up: DVec3) -> Option<Self> {
        let (towards, up) = (direction(towards)?, direction(up)?);
        let across = towards.cross(up);
        (across.length() > 1e-9).then(|| Self::new(towards, up))
    }

    /// Looking along `towards` with world z up; with world y up when looking along z, so that the view
    /// up at the sky or down at the ground has north at its top (and east at the left, looking up).
    pub fn upright(towards: DVec3) -> Self {
        Self::new(towards, DVec3::Z)
    }

    /// For panoramas: up is world z always, and the middle is the horizontal direction nearest to
    /// `towards`, +y for a vertical one.
    pub fn panorama(towards: DVec3) -> Self {
        let towards = direction(towards).unwrap_or(DVec3::Y);
        let level = DVec3::new(towards.x, towards.y, 0.0);
        Self::new(if level.length() > 1e-9 { level } else { DVec3::Y }, DVec3::Z)
    }

    /// Unit vector to the right of the picture.
    pub fn right(self) -> DVec3 {
        self.right
    }

    /// Unit vector to its top.
    pub fn up(self) -> DVec3 {
        self.up
    }

    /// Unit vector away from the eye, to its middle.
    pub fn towards(self) -> DVec3 {
        self.towards
    }

    /// A vector's components along right, up and towards.
    pub fn components(self, v: DVec3) -> DVec3 {
        DVec3::new(v.dot(self.right), v.dot(self.up), v.dot(self.towards))
    }
}

fn direction(v: DVec3) -> Option<DVec3> {
    (v.is_finite() && v != DVec3::ZERO).then(|| (v / v.abs().max_element()).normalize())
}
