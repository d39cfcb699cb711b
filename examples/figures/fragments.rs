//! Figure 2: a scene, and the fragments that its 3D BSP cuts it into.

use crate::table;
use glam::DVec3;
use nusselt::bsp::{BspOptions, PlaneChoice, SceneBsp};
use nusselt::bvh::SceneBvh;
use nusselt::contour::{Domain, Frustum, Projection, Projector, Viewpoint};
use nusselt::io::{DrawingOptions, atomic_write, write_drawing};
use nusselt::scene::{FaceSpec, Material, Scene, SceneBuilder, SceneError};
use std::error::Error;
use std::path::Path;

pub(crate) const EYE: DVec3 = DVec3::new(2.6, -4.6, 3.4);
pub(crate) const LOOK_AT: DVec3 = DVec3::new(0.0, -0.05, 0.55);
pub(crate) const DEGREES: f64 = 42.0;
pub(crate) const ASPECT: f64 = 4.0 / 3.0;
pub(crate) const SIZE: f64 = 640.0;

pub(crate) fn draw(folder: &Path) -> Result<(), Box<dyn Error>> {
    let scene = table::scene()?;
    let bsp = SceneBsp::build(&scene, &BspOptions { planes: PlaneChoice::Polygons, ..BspOptions::default() })?;
    let fragments = scene_of_fragments(&bsp)?;
    println!("{} polygons, {} fragments", scene.polygon_count(), bsp.fragment_count());
    write(&scene, &folder.join("scene.svg"))?;
    write(&fragments, &folder.join("scene-fragments.svg"))
}

/// Every fragment as a polygon with a material of its own, as edges within one material are not drawn.
fn scene_of_fragments(bsp: &SceneBsp) -> Result<Scene, SceneError> {
    let mut builder = SceneBuilder::default();
    for fragment in bsp.fragments() {
        let polygon = fragment.scene().polygon(fragment.polygon());
        let object = builder.add_object(polygon.object_name());
        let name = format!("fragment_{}", fragment.id().0);
        let material = builder.add_material(Material { name, ..polygon.material().clone() });
        let ring = fragment.corners().map(|corner| builder.add_vertex(corner)).collect();
        builder.add_face(FaceSpec { rings: vec![ring], object, material });
    }
    builder.build()
}

fn write(scene: &Scene, path: &Path) -> Result<(), Box<dyn Error>> {
    let frustum = Frustum::new(LOOK_AT - EYE, DVec3::Z, DEGREES, ASPECT)?;
    let image = SceneBvh::build(scene).view(&Viewpoint::free(EYE), &Domain::Frustum(frustum))?;
    let projector = Projector::of_image(&image, Projection::Gnomonic)?;
    let options = DrawingOptions { size: SIZE, ..DrawingOptions::default() };
    atomic_write(path, |out| write_drawing(&image, &projector, &options, out).map(drop))?;
    Ok(())
}
