//! Where the power that is emitted goes.

use glam::DVec3;

/// Powers, by red, green and blue: radiosity times area, in square scene units.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Balance {
    /// What all patches emit.
    pub emitted: DVec3,
    /// What fronts have absorbed.
    pub absorbed: DVec3,
    /// What has arrived at backs, which absorb it.
    pub backs: DVec3,
    /// What has left the scene.
    pub background: DVec3,
    /// What is on patches and has yet to be sent, less what was sent too much.
    pub unshot: DVec3,
    /// What is on patches and has yet to be sent, and what was sent too much: the same unless patches overshoot.
    pub unsettled: DVec3,
}

impl Balance {
    /// What is emitted less all the rest, relative to what is emitted: 0 up to rounding.
    pub fn defect(&self) -> f64 {
        let Self { emitted, absorbed, backs, background, unshot, .. } = *self;
        (emitted - absorbed - backs - background - unshot).abs().element_sum() / emitted.element_sum()
    }

    /// What has yet to be sent, or was sent too much, relative to what is emitted.
    pub fn unshot_fraction(&self) -> f64 {
        self.unsettled.element_sum() / self.emitted.element_sum()
    }
}
