//! Quadtrees at the top of the contour tree, four levels deep and alone.

use glam::DVec3;
use nusselt::bvh::SceneBvh;
use nusselt::contour::{Domain, Projection, Projector, Quadtree, Spacing, ViewOptions, Viewpoint};
use nusselt::io::{SvgOptions, atomic_write, write_svg};
use nusselt::scene::Scene;
use std::error::Error;
use std::path::Path;

pub(crate) fn draw(folder: &Path) -> Result<(), Box<dyn Error>> {
    let bvh = SceneBvh::build(&Scene::builder().build()?);
    for (name, quadtree) in [
        ("cube", Quadtree::Cube),
        ("even", Quadtree::Plane { degrees: 170.0, spacing: Spacing::Even }),
        ("centre", Quadtree::Plane { degrees: 170.0, spacing: Spacing::TowardsCentre }),
    ] {
        let options = ViewOptions { quadtree_depth: Some(4), quadtree, ..ViewOptions::default() };
        let image = bvh.view_with(&Viewpoint::free(DVec3::ZERO), &Domain::Hemisphere(DVec3::Z), &options)?;
        let projector = Projector::of_image(&image, Projection::Stereographic)?;
        let options = SvgOptions { show_tree: true, ..SvgOptions::default() };
        atomic_write(&folder.join(format!("quadtree-{name}.svg")), |file| {
            write_svg(&image, &projector, &options, file)
        })?;
    }
    Ok(())
}
