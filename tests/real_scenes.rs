//! Scenes that people made, next to the repository: views of each are proved, and compared with rays.

mod common;

use common::Random;
use glam::DVec3;
use nusselt::bsp::{BspOptions, SceneBsp};
use nusselt::contour::{Domain, Location, Viewpoint};
use nusselt::io::{ReadOptions, read_scene};
use nusselt::verify::{RayAnswer, RayOracle};
use std::path::{Path, PathBuf};

/// Files of one ending below a folder.
fn files(folder: &Path, ending: &str, found: &mut Vec<PathBuf>) {
    let Ok(entries) = std::fs::read_dir(folder) else { return };
    for path in entries.flatten().map(|entry| entry.path()) {
        if path.is_dir() {
            files(&path, ending, found);
        } else if path.extension().is_some_and(|e| e == ending) {
            found.push(path);
        }
    }
}

#[test]
fn views_of_real_scenes_are_proved_and_show_what_rays_meet() {
    let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/scenes"));
    let mut paths = Vec::new();
    files(folder, "obj", &mut paths);
    paths.sort();
    if paths.is_empty() {
        eprintln!("SKIPPED: no scenes in {}", folder.display());
        return;
    }
    let mut random = Random(4);
    let (mut compared, mut excused) = (0, 0);
    for path in paths {
        let scene = read_scene(&path, &ReadOptions::default()).expect("a scene that can be used").scene;
        let bsp = SceneBsp::build(&scene, &BspOptions::default()).expect("epsilon is 0");
        let oracle = RayOracle::new(&scene);
        let (low, high) = scene.bounds().expect("a scene with vertices");
        let (middle, half) = ((low + high) * 0.5, (high - low) * 0.5);
        let outside = middle + (high - low) * DVec3::new(0.9, -0.7, 0.8);
        let vertex = scene.vertices()[scene.vertices().len() / 2];
        for eye in [middle, outside, vertex, middle + half * random.in_cube(0.8)] {
            let image = bsp.view(&Viewpoint::free(eye), &Domain::Sphere).expect("a finite eye");
            if let Err(defect) = image.certify() {
                panic!("{} from {eye}: {}", path.display(), defect.to_rust(&image.evidence(), &scene));
            }
            let total = image.solid_angles().total();
            assert!((total - 4.0 * std::f64::consts::PI).abs() < 1e-11, "{}: {total}", path.display());
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
                    Location::Outside => panic!("{}: a direction outside of the sphere", path.display()),
                }
            }
        }
    }
    assert!(compared > 50 * excused, "{compared} compared, {excused} on boundaries");
}
