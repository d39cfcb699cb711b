//! Shadows of point lights against the ray oracle, and what must hold of all of them: parts have the areas of their polygons together, and
//! are watertight where the scene is.

mod common;

use common::Random;
use glam::DVec3;
use nusselt::bvh::SceneBvh;
use nusselt::contour::{ShadowPart, Shadows, ViewError, ViewOptions};
use nusselt::samples::{Kind, cornell_box, generate};
use nusselt::scene::{Material, PolygonId, Scene};
use nusselt::testing::{Mode, closed_scene, gallery, point_inside, scene};
use nusselt::verify::{RayAnswer, RayOracle};
use proptest::prelude::*;
use std::collections::HashMap;

fn shadows(scene: &Scene, light: DVec3) -> Shadows {
    SceneBvh::build(scene).shadows(light, &ViewOptions::default()).expect("shadows")
}

/// The sides of loops that have no counterpart, each with how often it is there in excess.
fn open_sides<'a>(loops: impl Iterator<Item = &'a [u32]>) -> HashMap<[u32; 2], i32> {
    let mut excess = HashMap::new();
    for corners in loops {
        for (k, &a) in corners.iter().enumerate() {
            let b = corners[(k + 1) % corners.len()];
            *excess.entry([a.min(b), a.max(b)]).or_insert(0) += if a < b { 1 } else { -1 };
        }
    }
    excess.retain(|_, excess| *excess != 0);
    excess
}

fn is_closed(scene: &Scene) -> bool {
    let loops: Vec<Vec<u32>> = scene.pieces().map(|piece| piece.vertices().iter().map(|v| v.0).collect()).collect();
    open_sides(loops.iter().map(Vec::as_slice)).is_empty()
}

/// What must hold: areas, orientation, closedness, and the oracle at points inside of parts. Gives how many points it could ask for, lit and not.
fn check(shadows: &Shadows, random: &mut Random) -> Result<[usize; 2], TestCaseError> {
    let scene = shadows.scene();
    let at = |corner: u32| shadows.vertices()[corner as usize];
    prop_assert!(shadows.vertices().iter().all(|p| p.is_finite()));
    let size = scene
        .pieces()
        .flat_map(|piece| piece.points().collect::<Vec<_>>())
        .fold(0.0, |s: f64, p| s.max(p.abs().max_element()));
    for polygon in scene.polygons() {
        let parts = shadows.parts().filter(|part| part.polygon() == polygon.id());
        let mut sum = DVec3::ZERO;
        for part in parts {
            let corners: Vec<DVec3> = part.corners().iter().map(|&c| at(c)).collect();
            prop_assert!(corners.len() >= 3);
            sum += (1..corners.len() - 1)
                .map(|k| (corners[k] - corners[0]).cross(corners[k + 1] - corners[0]))
                .sum::<DVec3>();
        }
        let whole: DVec3 = polygon
            .pieces()
            .map(|piece| {
                let p: Vec<DVec3> = piece.points().collect();
                (1..p.len() - 1).map(|k| (p[k] - p[0]).cross(p[k + 1] - p[0])).sum::<DVec3>()
            })
            .sum();
        // Parts fit together exactly, so all that is left is the rounding of corners: a few units in the last place of the coordinates, along the
        // boundary.
        let parts = shadows
            .parts()
            .filter(|part| part.polygon() == polygon.id())
            .map(|part| part.corners().len())
            .sum::<usize>();
        // Squares of coordinates may overflow, and products underflow.
        prop_assert!(
            !(1e-100..1e100).contains(&size) || (sum - whole).length() <= 1e-14 * size * size * parts as f64,
            "{}: {sum} {whole}",
            polygon.id()
        );
    }
    if is_closed(scene) {
        let open = open_sides(shadows.parts().map(ShadowPart::corners));
        prop_assert!(open.is_empty(), "{} sides without a counterpart", open.len());
    }
    let oracle = RayOracle::new(scene);
    let mut asked = [0; 2];
    let all: Vec<_> = shadows.parts().collect();
    for _ in 0..200.min(4 * all.len()) {
        let part = all[random.below(all.len())];
        let corners = part.corners();
        let weights: Vec<f64> = corners.iter().map(|_| random.within(0.1, 1.0)).collect();
        let point = corners.iter().zip(&weights).map(|(&c, w)| at(c) * *w).sum::<DVec3>() / weights.iter().sum::<f64>();
        // Where rounding could put the point outside of the part nothing is known.
        let normal = scene.piece(part.piece()).points().collect::<Vec<_>>();
        let normal = (normal[1] - normal[0]).cross(normal[2] - normal[0]).normalize_or_zero();
        let height = normal.dot(point - shadows.light()).abs();
        if height <= 1e-6 * (point - shadows.light()).length() {
            // Seen nearly edge on.
            continue;
        }
        let thickness = part.area() / corners.iter().map(|&c| at(c).distance(at(corners[0]))).fold(0.0, f64::max);
        if thickness.is_nan() || thickness <= 1e-9 * size || (point - shadows.light()).length() < 1e-9 * size {
            continue;
        }
        match oracle.cast(shadows.light(), point - shadows.light()) {
            RayAnswer::Hit { piece, .. } => {
                prop_assert_eq!(
                    piece == part.piece(),
                    part.is_lit(),
                    "{} of {} at {}",
                    part.piece(),
                    part.polygon(),
                    point
                );
                asked[usize::from(!part.is_lit())] += 1;
            }
            RayAnswer::Miss | RayAnswer::Boundary => {}
        }
    }
    Ok(asked)
}

#[test]
fn rooms_offices_and_cities_agree_with_rays_and_stay_closed() {
    let mut random = Random(7);
    let mut asked = [0; 2];
    for kind in [Kind::Room, Kind::Office, Kind::City] {
        let scene = generate(kind, 400, 3).expect("a scene").to_builder().build().expect("a scene");
        assert!(is_closed(&scene), "{kind:?}");
        let bounds = scene.pieces().flat_map(|piece| piece.points().collect::<Vec<_>>());
        let (low, high) =
            bounds.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)));
        for share in [0.31, 0.52, 0.77] {
            let light = low + (high - low) * DVec3::new(share, 1.0 - share * 0.9, 0.83);
            let [lit, dark] = check(&shadows(&scene, light), &mut random).expect("right");
            asked = [asked[0] + lit, asked[1] + dark];
        }
    }
    assert!(asked.iter().all(|&count| count > 100), "{asked:?}");
}

#[test]
fn lights_on_vertices_edges_and_planes_leave_everything_closed() {
    let scene = cornell_box().to_builder().build().expect("a scene");
    assert!(!is_closed(&scene) || scene.polygon_count() > 0);
    let mut random = Random(3);
    let room = generate(Kind::Room, 200, 1).expect("a scene").to_builder().build().expect("a scene");
    for scene in [scene, room] {
        for piece in scene.pieces().step_by(7) {
            let p: Vec<DVec3> = piece.points().collect();
            for light in [p[0], (p[0] + p[1]) / 2.0, p[0] + (p[1] - p[0]) * 1.5, (p[0] + p[1] + p[2]) / 3.0] {
                check(&shadows(&scene, light), &mut random).expect("right");
            }
        }
    }
}

#[test]
fn the_gallery_of_degenerate_scenes_holds() {
    let mut random = Random(5);
    for (name, case) in gallery::all() {
        let Ok(scene) = case.scene() else { continue };
        let (viewpoint, _) = case.viewpoint(&scene);
        check(&shadows(&scene, viewpoint.eye()), &mut random).unwrap_or_else(|error| panic!("{name}: {error}"));
    }
}

#[test]
fn a_wall_behind_a_grid_of_slats_is_lit_in_stripes() {
    // Three slats of width 1 at z = 1, gaps of 1, under a light at z = 2: stripes of 2 on the wall at z = 0.
    let mut vertices = vec![[-10.0, -10.0, 0.0], [10.0, -10.0, 0.0], [10.0, 10.0, 0.0], [-10.0, 10.0, 0.0]];
    let mut faces = vec![vec![0, 1, 2, 3]];
    for x in [-2.5, -0.5, 1.5] {
        let first = vertices.len();
        vertices.extend([[x, -9.0, 1.0], [x + 1.0, -9.0, 1.0], [x + 1.0, 9.0, 1.0], [x, 9.0, 1.0]]);
        faces.push((first..first + 4).collect());
    }
    let scene = Scene::builder().mesh(&vertices, &faces, Material::new("grey")).build().expect("a scene");
    let shadows = shadows(&scene, DVec3::new(0.0, 0.0, 2.0));
    // The slats' shadows are cut off by the wall's ends, 20 long.
    // All numbers are whole or halves.
    assert_eq!(glam::DVec2::from(shadows.areas()[0]), glam::DVec2::new(400.0 - 3.0 * 2.0 * 20.0, 3.0 * 2.0 * 20.0));
    // As few parts as the tree allows: three shadows, and what is between them.
    let parts: Vec<_> = shadows.parts().filter(|part| part.polygon() == PolygonId(0)).map(ShadowPart::is_lit).collect();
    assert_eq!((parts.iter().filter(|lit| !**lit).count(), parts.len() <= 12), (3, true), "{parts:?}");
}

#[test]
fn what_is_too_much_or_not_finite_is_refused() {
    let scene = cornell_box().to_builder().build().expect("a scene");
    let bvh = SceneBvh::build(&scene);
    let bad = bvh.shadows(DVec3::new(0.0, f64::NAN, 0.0), &ViewOptions::default());
    assert!(matches!(bad, Err(ViewError::EyeNotFinite)));
    let few = ViewOptions { max_cells: 20, ..ViewOptions::default() };
    assert!(matches!(bvh.shadows(DVec3::splat(200.0), &few), Err(ViewError::TooManyCells { limit: 20 })));
    let none = Scene::builder().build().expect("a scene");
    assert_eq!(SceneBvh::build(&none).shadows(DVec3::ZERO, &ViewOptions::default()).expect("none").parts().len(), 0);
}

fn mode() -> impl Strategy<Value = Mode> {
    prop_oneof![Just(Mode::Grid), Just(Mode::Chaos)]
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(150) })]

    #[test]
    fn closed_scenes_stay_closed(
        (faces, light) in mode().prop_flat_map(|mode| (closed_scene(mode), point_inside(mode))), seed in any::<u64>(),
    ) {
        let Ok(scene) = faces.scene() else { return Ok(()) };
        check(&shadows(&scene, light), &mut Random(seed))?;
    }

    #[test]
    fn any_scene_agrees_with_rays(
        (faces, light) in mode().prop_flat_map(|mode| (scene(mode), nusselt::testing::free_viewpoint(mode))), seed in any::<u64>(),
    ) {
        let Ok(scene) = faces.scene() else { return Ok(()) };
        check(&shadows(&scene, light), &mut Random(seed))?;
    }
}
