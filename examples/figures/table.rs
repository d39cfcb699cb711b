//! A table with a few things on it below a lamp: the scene of figures 2 and 6. Three bars lie on each other in a ring, so that a BSP has to cut.

use glam::DVec3;
use nusselt::scene::{FaceSpec, Material, MaterialId, ObjectId, Scene, SceneBuilder, SceneError};

/// Adds faces to a scene by their corners.
struct Shop {
    builder: SceneBuilder,
    object: ObjectId,
    material: MaterialId,
}

impl Shop {
    fn thing(&mut self, name: &str, diffuse: [f64; 3], emission: [f64; 3]) {
        self.object = self.builder.add_object(name);
        self.material = self.builder.add_material(Material { diffuse, emission, ..Material::new(name) });
    }

    /// Counter-clockwise seen from its front.
    fn face(&mut self, corners: &[DVec3]) {
        let ring = corners.iter().map(|&corner| self.builder.add_vertex(corner)).collect();
        self.builder.add_face(FaceSpec { rings: vec![ring], object: self.object, material: self.material });
    }

    /// A bar between two points, with about a square for a section: with edges in 128ths its faces are planar exactly.
    fn bar(&mut self, [from, to]: [DVec3; 2], thickness: f64) {
        let snap = |v: DVec3| (v * 128.0).round() / 128.0;
        let along = snap(to - from);
        let [aside, up] = {
            let aside = along.cross(DVec3::Z).normalize();
            [aside, aside.cross(along).normalize()].map(|v| snap(v * thickness))
        };
        let corner = snap(from) - (aside + up) / 2.0;
        let first = [corner, corner + aside, corner + aside + up, corner + up];
        let last = first.map(|corner| corner + along);
        self.face(&first);
        self.face(&[last[3], last[2], last[1], last[0]]);
        for k in 0..4 {
            let next = (k + 1) % 4;
            self.face(&[first[next], first[k], last[k], last[next]]);
        }
    }

    /// A prism over a polygon that runs counter-clockwise seen from above.
    fn prism(&mut self, base: &[[f64; 2]], [low, high]: [f64; 2]) {
        let at = |z: f64| base.iter().map(move |&[x, y]| DVec3::new(x, y, z)).collect::<Vec<_>>();
        let [bottom, top] = [at(low), at(high)];
        self.face(&top);
        self.face(&bottom.iter().rev().copied().collect::<Vec<_>>());
        for k in 0..base.len() {
            let next = (k + 1) % base.len();
            self.face(&[bottom[k], bottom[next], top[next], top[k]]);
        }
    }
}

/// The corners of a turned rectangle, counter-clockwise, in 128ths.
fn turned([x, y]: [f64; 2], [width, depth]: [f64; 2], degrees: f64) -> [[f64; 2]; 4] {
    let (sine, cosine) = degrees.to_radians().sin_cos();
    let snap = |x: f64| (x * 128.0).round() / 128.0;
    let [a, b] = [[cosine * width, sine * width], [-sine * depth, cosine * depth]].map(|v| v.map(|x| snap(x / 2.0)));
    [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
        .map(|[right, up]| [snap(x) + right * a[0] + up * b[0], snap(y) + right * a[1] + up * b[1]])
}

/// The scene, z up.
pub(crate) fn scene() -> Result<Scene, SceneError> {
    let mut builder = SceneBuilder::default();
    let object = builder.add_object("table");
    let material = builder.add_material(Material::new("table"));
    let mut shop = Shop { builder, object, material };
    shop.thing("table", [0.55, 0.42, 0.3], [0.0; 3]);
    shop.prism(&turned([0.0, 0.0], [4.0, 3.0], 0.0), [-0.15, 0.0]);
    shop.thing("box", [0.65, 0.2, 0.15], [0.0; 3]);
    shop.prism(&turned([-1.1, 0.6], [0.8, 0.8], 25.0), [0.0, 0.9]);
    shop.thing("book", [0.2, 0.35, 0.6], [0.0; 3]);
    shop.prism(&turned([0.9, -0.6], [1.1, 0.7], -15.0), [0.0, 0.25]);
    shop.thing("prism", [0.25, 0.5, 0.25], [0.0; 3]);
    shop.prism(&[[0.25, 0.375], [1.25, 0.5], [0.625, 1.25]], [0.0, 1.3]);
    shop.thing("bars", [0.75, 0.6, 0.25], [0.0; 3]);
    for turn in 0..3 {
        let ends = [-1.0, 1.0].map(|along| {
            let (sine, cosine) = (f64::from(turn) * 120.0 + 20.0).to_radians().sin_cos();
            // Beside the middle, from low to high.
            let [x, y] = [along * 0.62, -0.2];
            DVec3::new(x * cosine - y * sine - 0.95, x * sine + y * cosine - 0.75, 0.25 + 0.17 * along)
        });
        shop.bar(ends, 0.1);
    }
    shop.thing("lamp", [0.8; 3], [10.0, 9.0, 7.0]);
    let lamp = turned([0.1, -0.5], [1.2, 0.6], 10.0);
    shop.face(&lamp.iter().rev().map(|&[x, y]| DVec3::new(x, y, 2.2)).collect::<Vec<_>>());
    shop.builder.build()
}
