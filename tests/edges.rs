//! Edges that are seen and that are hidden, against the ray oracle; and drawings of them.

mod common;

use common::Random;
use glam::DVec3;
use nusselt::bvh::SceneBvh;
use nusselt::contour::{ContourImage, Domain, Frustum, Projection, Projector, Viewpoint};
use nusselt::io::{DrawingCounts, DrawingOptions, Fill, write_drawing};
use nusselt::samples::{Kind, generate};
use nusselt::scene::{EdgeId, FaceSpec, Material, Scene};
use nusselt::testing::{Mode, free_viewpoint, scene};
use nusselt::verify::{RayAnswer, RayOracle};
use proptest::prelude::*;

fn sphere(scene: &Scene, eye: DVec3) -> ContourImage {
    SceneBvh::build(scene).view(&Viewpoint::free(eye), &Domain::Sphere).expect("a view")
}

/// Every stretch is as the oracle says a little beside it, and those of an edge make up all of it. Gives how many were seen, and hidden.
fn check(image: &ContourImage, with_rays: bool, random: &mut Random) -> Result<[usize; 2], TestCaseError> {
    let (scene, eye) = (image.scene(), image.viewpoint().eye());
    let oracle = RayOracle::new(scene);
    let mut tracer = image.edge_tracer();
    let mut counts = [0; 2];
    for edge in (0..scene.edges().len() as u32).map(EdgeId) {
        let stretches = tracer.trace(edge);
        // Squares of coordinates may overflow.
        let unit = |d: DVec3| (d / d.abs().max_element()).normalize_or_zero();
        let [a, b] = scene.edges()[edge.index()].map(|v| unit(scene.vertex(v) - eye));
        let length = |[a, b]: [DVec3; 2]| a.cross(b).length().atan2(a.dot(b));
        let sum: f64 = stretches.iter().map(|stretch| length(stretch.ends)).sum();
        if !stretches.is_empty() {
            // A stretch that is left out is shorter than 1e-13; a direction is rounded by 1e-13 at most.
            prop_assert!((sum - length([a, b])).abs() < 1e-12 * (stretches.len() + 4) as f64, "{edge}: {sum}");
        }
        let own: Vec<_> = tracer.pieces_beside(edge).iter().map(|&piece| scene.piece(piece).polygon()).collect();
        // What is seen nearly edge on beside it is thinner than the rays can tell.
        let across = a.cross(b).normalize_or_zero();
        let corners =
            tracer.pieces_beside(edge).iter().flat_map(|&piece| scene.piece(piece).points().collect::<Vec<_>>());
        if corners.map(|p| across.dot(unit(p - eye)).abs()).fold(0.0, f64::max) < 1e-4 {
            continue;
        }
        for pair in stretches.windows(2) {
            prop_assert!(pair[0].is_visible != pair[1].is_visible);
        }
        for stretch in stretches.iter().filter(|_| with_rays) {
            let [from, to] = stretch.ends;
            if length(stretch.ends) < 1e-4 {
                continue;
            }
            let middle = from.lerp(to, random.within(0.3, 0.7)).normalize();
            let aside = from.cross(to).normalize();
            let sees = |offset: f64| match oracle.cast(eye, middle + aside * offset) {
                RayAnswer::Hit { polygon, .. } => Some(own.contains(&polygon)),
                RayAnswer::Miss => Some(false),
                RayAnswer::Boundary => None,
            };
            // What is thinner than the offset cannot be told.
            let [near, far] = [1e-8, 1e-6].map(|offset| [sees(offset), sees(-offset)]);
            let [Some(left), Some(right)] = near else { continue };
            if near == far {
                prop_assert_eq!(left || right, stretch.is_visible, "{} at {}", edge, middle);
                counts[usize::from(!stretch.is_visible)] += 1;
            }
        }
    }
    Ok(counts)
}

#[test]
fn edges_of_rooms_and_cities_are_seen_where_rays_see_them() {
    let mut random = Random(11);
    for (kind, eye) in
        [(Kind::Room, [0.41, 0.37, 0.52]), (Kind::Office, [0.31, 0.66, 0.4]), (Kind::City, [0.55, 0.52, 0.6])]
    {
        let scene = generate(kind, 300, 2).expect("a scene").to_builder().build().expect("a scene");
        let (low, high) = scene.bounds().expect("not empty");
        let image = sphere(&scene, low + (high - low) * DVec3::from(eye));
        let [seen, hidden] = check(&image, true, &mut random).expect("right");
        assert!(seen > 50 && hidden > 50, "{kind:?}: {seen} {hidden}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(150) })]

    #[test]
    fn edges_of_any_scene_are_seen_where_rays_see_them(
        (faces, eye) in (scene(Mode::Grid), free_viewpoint(Mode::Grid)), seed in any::<u64>(),
    ) {
        let Ok(scene) = faces.scene() else { return Ok(()) };
        check(&sphere(&scene, eye), true, &mut Random(seed))?;
    }

    // Here polygons may be seen in slivers that no ray finds.
    #[test]
    fn edges_of_any_scene_are_followed_to_their_ends(
        (faces, eye) in (scene(Mode::Chaos), free_viewpoint(Mode::Chaos)), seed in any::<u64>(),
    ) {
        let Ok(scene) = faces.scene() else { return Ok(()) };
        check(&sphere(&scene, eye), false, &mut Random(seed))?;
    }
}

// Stretches that are left out, one after the other, do not make two of one; nor is one lost that is half a circle but for rounding.
#[test]
fn long_edges_close_by_are_followed_to_their_ends() {
    let (x, z) = (7.136_014_298_232_181_5, -5.204_935_294_543_438);
    let long: Vec<[[f64; 3]; 3]> = vec![
        [[0.0, 0.0, 0.0], [0.0, -22.820_236_166_464_53, 6.0], [-7.0, 5.192_500_453_430_043, 10_995_116_277_760.0]],
        [[x, 0.0, z], [x, -5.739_492_565_053_065e37, 13.204_935_294_543_44], [x, 8.609_238_847_579_596e37, z]],
        [
            [x, 5.739_492_565_053_065e37, z],
            [x, 0.0, 4.000_000_000_000_001],
            [x, -8.609_238_847_579_596e37, 17.807_402_941_815_16],
        ],
    ];
    for triangle in long {
        let scene = Scene::builder().mesh(&triangle, &[vec![0, 1, 2]], Material::new("grey")).build();
        let scene = scene.expect("a scene");
        for eye in [[-5.0, -1.179_860_095_280_823_8, 0.0], [6.0, 0.0, 0.0]] {
            check(&sphere(&scene, eye.into()), false, &mut Random(0)).expect("right");
        }
    }
}

fn boxes(corners: &[[DVec3; 2]]) -> Scene {
    let (mut vertices, mut faces) = (Vec::new(), Vec::new());
    for [low, high] in corners {
        let first = vertices.len();
        vertices.extend((0..8).map(|k| [0, 1, 2].map(|axis| if k >> axis & 1 == 0 { low[axis] } else { high[axis] })));
        for face in [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]] {
            faces.push(face.map(|k| first + k).to_vec());
        }
    }
    Scene::builder().mesh(&vertices, &faces, Material::new("grey")).build().expect("a scene")
}

fn draw(scene: &Scene, eye: DVec3, options: &DrawingOptions) -> (DrawingCounts, String) {
    let frustum = Frustum::new(-eye, DVec3::Z, 60.0, 1.5).expect("a camera");
    let image = SceneBvh::build(scene).view(&Viewpoint::free(eye), &Domain::Frustum(frustum)).expect("a view");
    let projector = Projector::of_image(&image, Projection::Gnomonic).expect("a projector");
    let mut file = Vec::new();
    let counts = write_drawing(&image, &projector, options, &mut file).expect("written");
    (counts, String::from_utf8(file).expect("text"))
}

#[test]
fn a_cube_has_six_lines_of_silhouette_three_creases_and_three_hidden_edges() {
    let cube = boxes(&[[DVec3::splat(-1.0), DVec3::ONE]]);
    let options = DrawingOptions { hidden: true, ..DrawingOptions::default() };
    let (counts, svg) = draw(&cube, DVec3::new(5.0, 4.0, 3.0), &options);
    let expected = DrawingCounts { regions: 4, silhouettes: 6, creases: 3, hidden: 3, ..DrawingCounts::default() };
    assert_eq!(counts, expected);
    for class in ["silhouette", "crease", "hidden", "polygon_1", "background"] {
        assert!(svg.contains(&format!("class=\"{class}\"")), "{class}");
    }
    // Turns of a right angle are not drawn where only sharper ones are asked for.
    let options = DrawingOptions { crease: 1.6, fill: Fill::White, ..DrawingOptions::default() };
    let (counts, svg) = draw(&cube, DVec3::new(5.0, 4.0, 3.0), &options);
    assert_eq!((counts.silhouettes, counts.creases, counts.hidden), (6, 0, 0));
    assert!(!svg.contains("class=\"crease\"") && !svg.contains("class=\"hidden\""));
}

#[test]
fn cubes_that_pass_through_each_other_have_lines_where_they_do() {
    let scene = boxes(&[[DVec3::splat(-1.0), DVec3::ONE], [DVec3::new(-2.0, -0.5, -0.5), DVec3::new(2.0, 0.5, 0.5)]]);
    let (counts, svg) = draw(&scene, DVec3::new(6.0, 4.0, 3.0), &DrawingOptions::default());
    // Where the bar leaves the cube's face towards the eye two of four sides are seen.
    assert_eq!(counts.crossings, 2, "{counts:?}");
    assert!(svg.contains("class=\"crossing\""));
}

#[test]
fn an_edge_of_many_polygons_is_a_silhouette_too() {
    let twice = boxes(&[[DVec3::splat(-1.0), DVec3::ONE]; 2]);
    let mut builder = Scene::builder();
    let (material, object) = (builder.add_material(Material::new("grey")), builder.add_object("cubes"));
    let corners: Vec<_> = twice.vertices()[..8].iter().map(|&p| builder.add_vertex(p)).collect();
    for polygon in twice.polygons() {
        let ring = polygon.rings()[0].iter().map(|vertex| corners[vertex.index() % 8]).collect();
        builder.add_face(FaceSpec { rings: vec![ring], object, material });
    }
    let scene = builder.build().expect("a scene");
    assert_eq!(scene.edges().len(), 12);
    let (counts, _) = draw(&scene, DVec3::new(5.0, 4.0, 3.0), &DrawingOptions::default());
    assert_eq!((counts.silhouettes, counts.creases), (6, 3), "{counts:?}");
}

#[test]
fn a_line_is_between_two_materials_and_none_within_one() {
    for (other, creases) in [("white", 1), ("grey", 0)] {
        let mut builder = Scene::builder();
        let materials = [builder.add_material(Material::new("grey")), builder.add_material(Material::new("white"))];
        let object = builder.add_object("sheet");
        for [x, y] in [[-1., -1.], [0., -1.], [1., -1.], [-1., 1.], [0., 1.], [1., 1.]] {
            builder.add_vertex(DVec3::new(x, y, 0.0));
        }
        let second = materials[usize::from(other == "white")];
        builder.add_face(FaceSpec { rings: vec![vec![0, 1, 4, 3]], object, material: materials[0] });
        builder.add_face(FaceSpec { rings: vec![vec![1, 2, 5, 4]], object, material: second });
        let scene = builder.build().expect("a scene");
        let (counts, _) = draw(&scene, DVec3::new(0.5, 0.3, 4.0), &DrawingOptions::default());
        assert_eq!((counts.creases, counts.borders), (creases, 6), "{other}: {counts:?}");
    }
}

// The eye is as far from one plane as from the other: where they meet is a circle that the view is divided along before it meets any polygon.
#[test]
fn sheets_that_pass_through_each_other_have_a_line_from_everywhere() {
    let vertices = [
        [[0., 0., 0.], [2., 0., 0.], [2., 2., 0.], [0., 2., 0.]],
        [[1., 0., -1.], [1., 2., -1.], [1., 2., 1.], [1., 0., 1.]],
    ];
    let faces = [vec![0, 1, 2, 3], vec![4, 5, 6, 7]];
    let scene = Scene::builder().mesh(vertices.as_flattened(), &faces, Material::new("grey")).build();
    let scene = scene.expect("a scene");
    for eye in [[4., -3., 3.], [4., -3.1, 2.9], [4., 1., 3.], [-1.5, -3., 2.5], [2., 1., 1.]] {
        let (counts, _) = draw(&scene, DVec3::from(eye), &DrawingOptions::default());
        assert_eq!(counts.crossings, 1, "{eye:?}: {counts:?}");
    }
    // Nor is there one where two meet in an edge.
    let cube = boxes(&[[DVec3::splat(-1.0), DVec3::ONE]]);
    for eye in [[3., -3., 3.], [3., 3., 2.], [4., 0.2, 4.]] {
        assert_eq!(draw(&cube, DVec3::from(eye), &DrawingOptions::default()).0.crossings, 0);
    }
}

#[test]
fn a_sheet_has_borders_and_none_between_its_tiles() {
    let vertices: Vec<[f64; 3]> = (0..9).map(|k| [f64::from(k % 3) - 1.0, f64::from(k / 3) - 1.0, 0.0]).collect();
    let faces: Vec<Vec<usize>> = [0, 1, 3, 4].map(|k| vec![k, k + 1, k + 4, k + 3]).to_vec();
    let scene = Scene::builder().mesh(&vertices, &faces, Material::new("grey")).build().expect("a scene");
    let (counts, _) = draw(&scene, DVec3::new(2.0, -3.0, 4.0), &DrawingOptions::default());
    assert_eq!((counts.borders, counts.creases, counts.silhouettes), (8, 0, 0));
}
