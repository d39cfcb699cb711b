//! An outside opinion: the visible areas of stacked polygons, from the boolean operations of `geo`.

mod common;

use common::{Faces, Random};
use geo::{Area, BooleanOps, Coord, LineString, MultiPolygon, Polygon};
use glam::DVec3;
use nusselt::bsp::{BspOptions, SceneBsp};
use nusselt::contour::{Domain, Viewpoint};
use nusselt::scene::{PieceRef, PolygonId};

/// Where a direction meets the plane at height 1.
fn gnomonic(d: DVec3) -> Coord {
    Coord { x: d.x / d.z, y: d.y / d.z }
}

fn polygon(corners: impl Iterator<Item = DVec3>) -> Polygon {
    Polygon::new(LineString(corners.map(gnomonic).collect()), Vec::new())
}

/// `geo` rounds coordinates to a grid of 32-bit integers over the input's extent, here about 6: an edge
/// moves by 3e-9, and no area has a boundary longer than 60.
const TOLERANCE: f64 = 2e-7;

#[test]
fn visible_areas_of_stacked_triangles_are_those_of_polygon_booleans() {
    let mut random = Random(31);
    for count in [2, 10, 40] {
        let mut faces = Faces::default();
        // Level k lies below all later ones: seen from the origin it is nearer.
        for k in 0..count {
            let height = 1.0 + f64::from(k);
            let middle = random.in_cube(1.0);
            let corner = |random: &mut Random| {
                let p = (middle + random.in_cube(1.0)) * height;
                DVec3::new(p.x, p.y, height)
            };
            let corners = [corner(&mut random), corner(&mut random), corner(&mut random)];
            faces.face(&corners);
        }
        let scene = faces.build();
        let bsp = SceneBsp::build(&scene, &BspOptions::default()).unwrap();
        let image = bsp.view(&Viewpoint::free(DVec3::ZERO), &Domain::Hemisphere(DVec3::Z)).unwrap();
        let mut ours = vec![0.0; scene.polygon_count()];
        for cell in image.cells() {
            if let Some(PolygonId(k)) = cell.polygon() {
                ours[k as usize] += polygon(cell.boundary()).unsigned_area();
            }
        }
        let mut hidden = MultiPolygon::new(Vec::new());
        for (k, area) in ours.into_iter().enumerate() {
            let whole = polygon(scene.polygon(PolygonId(k as u32)).pieces().flat_map(PieceRef::points));
            let whole = MultiPolygon::new(vec![whole]);
            let expected = whole.difference(&hidden).unsigned_area();
            assert!((area - expected).abs() < TOLERANCE, "polygon {k} of {count}: {area}, by geo {expected}");
            hidden = hidden.union(&whole);
        }
    }
}
