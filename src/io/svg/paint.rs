//! The colours of polygons in a picture.

use crate::contour::{ContourImage, ViewFrame};
use crate::io::srgb::encoded;
use crate::scene::{PolygonId, PolygonRef, Scene};
use glam::DVec3;

/// What is seen where nothing is, linear: #cfe4f7.
const BACKGROUND: DVec3 = DVec3::new(0.623_960_391_746_752_2, 0.775_822_286_098_042_4, 0.930_110_858_154_214);

/// Colours polygons so that those of one material can be told apart by their orientation, and those
/// of one orientation, a little, by their object.
pub(in crate::io) struct Paint<'a> {
    image: &'a ContourImage,
    light: DVec3,
}

impl<'a> Paint<'a> {
    /// Light comes from over the eye's left shoulder.
    pub(in crate::io) fn new(image: &'a ContourImage, frame: ViewFrame) -> Self {
        let light = (frame.up() * 0.65 - frame.towards() * 0.6 - frame.right() * 0.35).normalize();
        Self { image, light }
    }

    /// The unit normal of a polygon, on the side that is seen.
    fn normal_to_eye(&self, polygon: PolygonRef<'_>) -> DVec3 {
        let scene = self.image.scene();
        let normal = normal(scene, polygon);
        let first = polygon.rings().first().and_then(|ring| ring.first());
        let from_eye = first.map_or(DVec3::ZERO, |&v| scene.vertex(v) - self.image.viewpoint().eye());
        if normal.dot(from_eye) > 0.0 { -normal } else { normal }
    }

    /// As the web writes colours.
    pub(super) fn of(&self, polygon: Option<PolygonId>) -> String {
        hex(self.linear(polygon))
    }

    /// As linear red, green and blue.
    pub(in crate::io) fn linear(&self, polygon: Option<PolygonId>) -> DVec3 {
        let Some(id) = polygon else { return BACKGROUND };
        let polygon = self.image.scene().polygon(id);
        let material = polygon.material();
        if material.is_emitter() {
            let emission = DVec3::from(material.emission);
            // Bright, with some of its hue.
            DVec3::ONE.lerp(emission / emission.max_element(), 0.5)
        } else {
            let diffuse = DVec3::from(material.diffuse).min(DVec3::ONE);
            let facing = self.normal_to_eye(polygon).dot(self.light);
            // A third of the way to grey, so that black is not a hole.
            (diffuse * 0.92 + 0.04) * (0.55 + 0.45 * facing) * (0.94 + 0.12 * variation(polygon.object().0))
        }
    }
}

/// A number from 0 to 1 that differs for neighbouring numbers: the golden ratio's multiples.
fn variation(k: u32) -> f64 {
    (f64::from(k) * 0.618_033_988_749_894_9).fract()
}

/// Linear RGB as the web writes colours.
pub(super) fn hex(linear: DVec3) -> String {
    let [r, g, b] = linear.to_array().map(encoded);
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// The unit normal of a polygon's outer ring (Newell), or zero.
fn normal(scene: &Scene, polygon: PolygonRef<'_>) -> DVec3 {
    let Some(ring) = polygon.rings().first() else { return DVec3::ZERO };
    let origin = scene.vertex(ring[0]);
    let offsets: Vec<DVec3> = ring.iter().map(|&v| scene.vertex(v) - origin).collect();
    let size = offsets.iter().fold(0.0, |size: f64, v| size.max(v.abs().max_element()));
    let sum: DVec3 = offsets.windows(2).map(|pair| (pair[0] / size).cross(pair[1] / size)).sum();
    sum.normalize_or_zero()
}
