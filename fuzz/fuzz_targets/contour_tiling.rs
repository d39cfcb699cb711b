//! Triangle soups on a coarse grid, full of coincidences, or with any finite coordinates: the cells tile
//! the sphere, and show what a ray meets.
#![no_main]

use glam::DVec3;
use libfuzzer_sys::fuzz_target;
use nusselt::bsp::{BspOptions, SceneBsp};
use nusselt::contour::{Domain, Location, Viewpoint};
use nusselt::scene::{Material, Scene};
use nusselt::verify::{RayAnswer, RayOracle};

/// The most triangles of one case: more cost time and find nothing new.
const MOST_TRIANGLES: usize = 24;

/// Numbers read from the input; zeros past its end.
struct Bytes<'a>(&'a [u8]);

impl Bytes<'_> {
    fn byte(&mut self) -> u8 {
        let Some((&first, rest)) = self.0.split_first() else { return 0 };
        self.0 = rest;
        first
    }

    /// In grid mode a small whole number, in chaos mode any finite f64.
    fn coordinate(&mut self, chaos: bool) -> f64 {
        if !chaos {
            return f64::from(self.byte() % 9) - 4.0;
        }
        let value = f64::from_le_bytes([(); 8].map(|()| self.byte()));
        if value.is_finite() { value } else { 0.0 }
    }

    fn point(&mut self, chaos: bool) -> DVec3 {
        DVec3::new(self.coordinate(chaos), self.coordinate(chaos), self.coordinate(chaos))
    }
}

fuzz_target!(|data: &[u8]| {
    let mut bytes = Bytes(data);
    let chaos = bytes.byte() % 4 == 3;
    let eye = bytes.point(chaos);
    let direction = bytes.point(chaos);
    let mut vertices = Vec::new();
    while !bytes.0.is_empty() && vertices.len() < 3 * MOST_TRIANGLES {
        vertices.extend([(); 3].map(|()| bytes.point(chaos).to_array()));
    }
    let faces: Vec<Vec<usize>> = (0..vertices.len() / 3).map(|k| vec![3 * k, 3 * k + 1, 3 * k + 2]).collect();
    let scene = Scene::builder().mesh(&vertices, &faces, Material::new("m"));
    let Ok(scene) = scene.build() else { return };
    let bsp = SceneBsp::build(&scene, &BspOptions::default()).expect("epsilon is 0");
    let image = bsp.view(&Viewpoint::free(eye), &Domain::Sphere).expect("the eye is finite");
    let total = image.solid_angles().total();
    assert!((total - 4.0 * std::f64::consts::PI).abs() < 1e-9, "the cells cover {total}\n{vertices:?}\n{eye:?}");
    let oracle = RayOracle::new(&scene);
    let middles = image.cells().map(|cell| cell.boundary().sum::<DVec3>());
    for d in middles.chain([direction]) {
        let Location::Cell(cell) = image.locate(d) else { continue };
        let seen = image.cell(cell).polygon();
        match oracle.cast(eye, d) {
            RayAnswer::Hit { polygon, .. } => assert_eq!(seen, Some(polygon), "{vertices:?}\n{eye:?}\n{d:?}"),
            RayAnswer::Miss => assert_eq!(seen, None, "{vertices:?}\n{eye:?}\n{d:?}"),
            RayAnswer::Boundary => {}
        }
    }
});
