//! Scenes that people made, next to the repository: every file loads, views of each are proved, and compared with rays.

mod common;

use common::Random;
use glam::DVec3;
use nusselt::bsp::{BspOptions, SceneBsp};
use nusselt::bvh::SceneBvh;
use nusselt::contour::{Domain, Location, SceneOrder, Viewpoint};
use nusselt::io::{ReadOptions, read_scene};
use nusselt::scene::{Material, PolygonId, Scene, Shape, Side};
use nusselt::verify::{RayAnswer, RayOracle};
use std::path::{Path, PathBuf};

/// What the files consist of: polygons and objects, counted apart from this crate (faces of OBJ files, counts of
/// accessors, lists of boundaries).
const FILES: &[(&str, usize, usize)] = &[
    ("city/cube.json", 6, 1),
    ("city/delft.json", 36_271, 570),
    ("city/kenney/building-garage.glb", 196, 1),
    ("city/kenney/building-small-a.glb", 452, 1),
    ("city/kenney/building-small-b.glb", 600, 1),
    ("city/kenney/building-small-c.glb", 834, 1),
    ("city/kenney/building-small-d.glb", 448, 1),
    ("city/kenney/grass-trees.glb", 380, 1),
    ("city/kenney/pavement-fountain.glb", 152, 1),
    ("city/kenney/road-straight-lightposts.glb", 190, 1),
    ("city/rotterdam_subset.json", 248, 16),
    ("city/zurich_subset_lod2.json", 2039, 161),
    ("classic/spot.obj", 5856, 1),
    ("classic/teapot.obj", 6320, 1),
    ("cornell/CornellBox-Original.obj", 22, 8),
    ("cornell/tobj_cornell_box.obj", 18, 8),
    ("degenerate/manifold/Cray_left.obj", 576, 1),
    ("degenerate/manifold/Cray_right.obj", 12, 1),
    ("degenerate/manifold/Generic_Twin_7863.1.t0_left.obj", 212, 1),
    ("degenerate/manifold/Generic_Twin_7863.1.t0_right.obj", 244, 1),
    ("degenerate/manifold/Havocglass8_left.obj", 164, 1),
    ("degenerate/manifold/Havocglass8_right.obj", 12, 1),
    ("degenerate/manifold/Offset1.obj", 4418, 1),
    ("degenerate/manifold/Offset2.obj", 1116, 1),
    ("degenerate/manifold/Offset3.obj", 56, 1),
    ("degenerate/manifold/Offset4.obj", 76, 1),
    ("degenerate/manifold/openscad-nonmanifold-crash.obj", 1442, 1),
    ("degenerate/manifold/self_intersectA.obj", 17_160, 1),
    ("degenerate/manifold/self_intersectB.obj", 17_160, 1),
    ("rooms/polyhaven/painted_wooden_cabinet_02_1k.gltf", 966, 3),
    ("rooms/polyhaven/painted_wooden_cabinet_1k.gltf", 2227, 5),
    ("rooms/polyhaven/painted_wooden_stool_1k.gltf", 676, 1),
    ("rooms/polyhaven/sofa_03_1k.gltf", 8004, 1),
    ("rooms/polyhaven/wooden_bookshelf_worn_1k.gltf", 10_106, 1),
    ("rooms/polyhaven/wooden_table_02_1k.gltf", 196, 1),
];

/// The folder of the scenes, if it is there.
fn scenes() -> Option<&'static Path> {
    let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/scenes"));
    if folder.is_dir() {
        return Some(folder);
    }
    eprintln!("SKIPPED: no scenes in {}", folder.display());
    None
}

/// The files below a folder that are scenes.
fn files(folder: &Path, found: &mut Vec<PathBuf>) {
    for path in std::fs::read_dir(folder).expect("a readable folder").flatten().map(|entry| entry.path()) {
        let is_scene = |ending: &std::ffi::OsStr| ["obj", "json", "glb", "gltf"].iter().any(|known| ending == *known);
        if path.is_dir() {
            files(&path, found);
        } else if path.extension().is_some_and(is_scene) {
            found.push(path);
        }
    }
}

#[test]
fn every_file_loads_with_as_many_polygons_as_it_has() {
    let Some(folder) = scenes() else { return };
    let mut paths = Vec::new();
    files(folder, &mut paths);
    paths.sort();
    let known: Vec<PathBuf> = FILES.iter().map(|(name, ..)| folder.join(name)).collect();
    assert_eq!(paths, known);
    for (path, &(name, polygons, objects)) in paths.iter().zip(FILES) {
        let loaded = read_scene(path, &ReadOptions::default()).unwrap_or_else(|error| panic!("{error}"));
        let scene = &loaded.scene;
        let count = |shape| scene.polygons().filter(|polygon| polygon.shape() == shape).count();
        let shapes = [Shape::Convex, Shape::Concave, Shape::NonPlanar, Shape::Degenerate].map(count);
        eprintln!(
            "{name}: {} polygons {shapes:?}, {} objects, {} pieces, {:?}",
            scene.polygon_count(),
            scene.objects().len(),
            scene.piece_count(),
            loaded.warnings
        );
        assert_eq!((scene.polygon_count(), scene.objects().len()), (polygons, objects), "{name}");
        assert_eq!(loaded.files[0], *path);
    }
}

#[test]
fn the_left_wall_of_the_cornell_box_is_not_planar_and_its_lamp_emits() {
    let Some(folder) = scenes() else { return };
    let path = folder.join("cornell/CornellBox-Original.obj");
    let scene = read_scene(&path, &ReadOptions::default()).expect("a scene that can be used").scene;
    let left: Vec<_> = scene.polygons().filter(|polygon| polygon.shape() == Shape::NonPlanar).collect();
    assert_eq!(left.len(), 1);
    assert_eq!(left[0].object_name(), "leftWall");
    assert!(scene.materials().iter().any(Material::is_emitter));
}

/// Twenty viewpoints: within, around and on the surfaces of a scene, in an order in which the first few are of all kinds.
fn viewpoints(scene: &Scene, random: &mut Random) -> Vec<(Viewpoint, Domain)> {
    let (low, high) = scene.bounds().expect("a scene with vertices");
    let (middle, half) = ((low + high) * 0.5, (high - low) * 0.5);
    let mut list = Vec::new();
    let free = |eye| (Viewpoint::free(eye), Domain::Sphere);
    for k in 0..5 {
        let side = if k % 2 == 0 { Side::Front } else { Side::Back };
        let near = middle + half * random.in_cube(1.0);
        // On some polygon with area.
        let on = (0..100).find_map(|_| {
            let polygon = PolygonId(random.below(scene.polygon_count()) as u32);
            Viewpoint::on_surface(scene, polygon, side, near).ok()
        });
        list.push((on.expect("a polygon to stand on"), Domain::Above));
        list.push(free(if k == 0 { middle } else { middle + half * random.in_cube(0.9) }));
        list.push(free(middle + (high - low).max(DVec3::splat(half.length() * 0.1)) * random.direction().normalize()));
        list.push(free(scene.vertices()[random.below(scene.vertices().len())]));
    }
    list
}

/// Proves so many views of a scene, and compares them with rays; how many rays were compared, and how many met a
/// boundary.
fn prove_views(path: &Path, count: usize, random: &mut Random) -> [usize; 2] {
    let scene = read_scene(path, &ReadOptions::default()).expect("a scene that can be used").scene;
    let ways: [SceneOrder; 2] =
        [SceneBvh::build(&scene).into(), SceneBsp::build(&scene, &BspOptions::default()).expect("epsilon is 0").into()];
    let oracle = RayOracle::new(&scene);
    let (low, high) = scene.bounds().expect("a scene with vertices");
    let (middle, half) = ((low + high) * 0.5, (high - low) * 0.5);
    let [mut compared, mut excused] = [0; 2];
    // Kinds of viewpoints come in turn with a period of four, so that each is seen both ways.
    for (k, (viewpoint, domain)) in viewpoints(&scene, random).into_iter().take(count).enumerate() {
        let eye = viewpoint.eye();
        let way = &ways[(k + k / 4) % 2];
        let image = way.view(&viewpoint, &domain).expect("a finite eye");
        if let Err(defect) = image.certify() {
            panic!("{} from {eye}: {}", path.display(), defect.to_rust(&image.evidence(), &scene));
        }
        let (total, all) = (image.solid_angles().total(), if domain == Domain::Above { 2.0 } else { 4.0 });
        assert!((total - all * std::f64::consts::PI).abs() < 1e-11, "{} from {eye}: {total}", path.display());
        for _ in 0..100 {
            let direction = (middle + half * random.in_cube(1.0) - eye).normalize_or_zero();
            let expected = match oracle.cast(eye, direction) {
                RayAnswer::Hit { polygon, .. } => Some(polygon),
                RayAnswer::Miss => None,
                RayAnswer::Boundary => continue,
            };
            match image.locate(direction) {
                Location::Cell(cell) => {
                    assert_eq!(image.cell(cell).polygon(), expected, "{} from {eye}", path.display());
                    compared += 1;
                }
                Location::Arc { .. } | Location::Vertex { .. } => excused += 1,
                Location::Outside => assert_eq!(domain, Domain::Above, "a direction outside of the sphere"),
            }
        }
    }
    [compared, excused]
}

#[test]
fn views_of_real_scenes_are_proved_and_show_what_rays_meet() {
    let Some(folder) = scenes() else { return };
    let mut random = Random(4);
    let [mut compared, mut excused] = [0; 2];
    for (name, polygons, _) in FILES {
        // Those of all kinds, but fewer of what takes long.
        let count = if *polygons > 3000 { 2 } else { 4 };
        let counts = prove_views(&folder.join(name), count, &mut random);
        compared += counts[0];
        excused += counts[1];
    }
    assert!(compared > 50 * excused, "{compared} compared, {excused} on boundaries");
}

/// Takes long; says what each file took.
#[test]
#[ignore = "takes many minutes"]
fn twenty_views_of_every_real_scene_are_proved_and_show_what_rays_meet() {
    let Some(folder) = scenes() else { return };
    let mut random = Random(5);
    for (name, ..) in FILES {
        let start = std::time::Instant::now();
        let [compared, excused] = prove_views(&folder.join(name), 20, &mut random);
        eprintln!("{name}: 20 views proved, {compared} rays agree, {excused} on boundaries, {:.1?}", start.elapsed());
        assert!(compared > 20 * excused, "{name}: {compared} compared, {excused} on boundaries");
    }
}
