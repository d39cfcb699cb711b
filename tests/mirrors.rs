//! What flat mirrors show: against plane geometry, and against what stands behind a hole in their place.

mod common;

use common::pictures::{floor_spot, material, square};
use glam::{DQuat, DVec3, EulerRot, UVec2};
use nusselt::brdf::{Brdf, Fresnel, Lambert, Lighting, Mirror, Sky, Sum};
use nusselt::contour::{Frustum, SceneOrder};
use nusselt::render::{Shader, ShaderOptions, Spot, render};
use nusselt::samples::{Kind, generate};
use nusselt::scene::{Material, PieceId, PolygonRef, Scene, Side};

#[test]
fn a_mirror_shows_what_is_there() {
    // A mirror at z = 0, and a wall at x = 5 that glows in two colours, below and above z = 1.5.
    let wall = |low: f64, high: f64| [[5.0, -9.0, low], [5.0, -9.0, high], [5.0, 9.0, high], [5.0, 9.0, low]];
    let glow = |name: &str, emission: [f64; 3]| Material { emission, ..Material::new(name) };
    let face = vec![vec![0, 1, 2, 3]];
    let scene = Scene::builder()
        .mesh(&square([-5.0, -5.0], [5.0, 5.0], 0.0), &face, material("mirror", 0.0, 0.0))
        .mesh(&wall(0.0, 1.5), &face, glow("low", [1.0, 0.0, 0.0]))
        .mesh(&wall(1.5, 9.0), &face, glow("high", [0.0, 1.0, 0.0]))
        .build()
        .expect("a scene");
    let reflectance = DVec3::splat(0.8);
    let brdfs = scene.materials().iter().map(|material| -> Box<dyn Brdf> {
        if material.name == "mirror" {
            Box::new(Mirror::new(Fresnel::ALL))
        } else {
            Box::new(Lambert::new(reflectance).expect("a BRDF"))
        }
    });
    let sky = DVec3::new(0.0, 0.0, 3.0);
    let lighting = Lighting { sky: Some(Sky::constant(sky).expect("a sky")), ..Lighting::default() };
    let order = SceneOrder::new(&scene);
    let shader = Shader::with_brdfs(order, brdfs.collect(), lighting, ShaderOptions::default()).expect("a shader");
    let (eye, mut seen) = (DVec3::new(-2.0, 0.2, 2.0), [0; 3]);
    for k in 0..400 {
        let at = DVec3::new(-1.9 + 6.8 * f64::from(k % 20) / 19.0, -4.0 + 8.0 * f64::from(k / 20) / 19.0, 0.0);
        let viewer = eye - at;
        let found = shader.reflected(&Spot { near: at, ..floor_spot(0.0, 0.0) }, viewer, 0).expect("shaded");
        // Where the mirrored ray meets the wall's plane.
        let way = DVec3::new(-viewer.x, -viewer.y, viewer.z);
        let meets = at + way * ((5.0 - at.x) / way.x);
        let (which, expected) = if way.x <= 0.0 || meets.y.abs() > 9.0 || meets.z > 9.0 {
            (2, sky)
        } else {
            // What it emits and what it reflects of the sky and of the mirror, where nothing is matt.
            let spot = Spot { piece: PieceId(if meets.z < 1.5 { 1 } else { 2 }), side: Side::Front, near: meets };
            let which = usize::from(meets.z >= 1.5);
            (which, shader.emitted(&spot) + shader.reflected(&spot, -way, 0).expect("shaded"))
        };
        seen[which] += 1;
        assert!((found - expected).abs().max_element() < 1e-9, "{at}: {found} {expected}");
    }
    assert!(seen.iter().all(|&count| count > 10), "{seen:?}");
    // Two mirrors that face each other end.
    let both = Scene::builder()
        .mesh(&square([-5.0, -5.0], [5.0, 5.0], 0.0), &face, material("mirror", 0.0, 0.0))
        .mesh(&square([-5.0, -5.0], [5.0, 5.0], 1.0), &[vec![3, 2, 1, 0]], material("mirror", 0.0, 1.0))
        .build()
        .expect("a scene");
    let brdfs: Vec<Box<dyn Brdf>> =
        both.materials().iter().map(|_| -> Box<dyn Brdf> { Box::new(Mirror::new(Fresnel::ALL)) }).collect();
    let order = SceneOrder::new(&both);
    let options = ShaderOptions { mirrors: 5, ..ShaderOptions::default() };
    let shader = Shader::with_brdfs(order, brdfs, Lighting::default(), options).expect("a shader");
    // Of five rays three meet the lid, which glows.
    let found = shader.reflected(&floor_spot(0.0, 0.0), DVec3::Z, 0).expect("shaded");
    assert_eq!(found, DVec3::splat(3.0));
}

/// What glows before a mirror at x = 0, by corners and radiances; the camera is at larger x. One passes through the mirror's plane.
fn before_mirror() -> Vec<([[f64; 3]; 4], [f64; 3])> {
    let aslant = [[3.4, 0.1, -0.9], [2.9, 1.2, -0.6], [2.8, 1.4, 0.7], [3.6, 0.2, 0.9]];
    let beyond = [[4.0, -6.0, -0.3], [4.0, 6.0, -0.1], [4.5, 5.0, 6.0], [4.5, -6.0, 6.0]];
    let through = [[0.0, -0.5, -0.4], [1.2, -0.3, -0.5], [1.2, -0.3, 0.6], [0.0, -0.5, 0.5]];
    // Before the mirror, and in it.
    let post = [[0.6, 0.1, -9.0], [0.6, 0.3, -9.0], [0.6, 0.2, 9.0], [0.6, 0.1, 9.0]];
    vec![(aslant, [1.0, 0.0, 0.0]), (beyond, [0.0, 0.5, 0.0]), (through, [0.0, 0.0, 2.0]), (post, [0.3, 0.2, 0.1])]
}

/// A mirror within a black wall at x = 0, or a hole in its place and behind it what would be seen in it; all turned.
/// Beside it there are as many small mirrors as wanted, each in a plane of its own.
fn with_mirror(is_mirror: bool, turn: DQuat, small: usize) -> Scene {
    let dull = || material("dull", 0.0, 0.0);
    let glow = |emission: [f64; 3]| Material { emission, ..Material::new("glow") };
    let turned = |ring: &[[f64; 3]]| -> Vec<[f64; 3]> {
        ring.iter().map(|&p| turn.mul_vec3(DVec3::from(p)).to_array()).collect()
    };
    let hole = [[0.0, -1.0, -0.7], [0.0, 1.1, -0.9], [0.0, 0.8, 1.0], [0.0, -0.9, 0.8]];
    let wall = [[0.0, -60.0, -60.0], [0.0, 60.0, -60.0], [0.0, 60.0, 60.0], [0.0, -60.0, 60.0]];
    let both: Vec<[f64; 3]> = hole.into_iter().chain(wall).collect();
    let faces: Vec<Vec<usize>> = (0..4).map(|k| vec![k, 4 + k, 4 + (k + 1) % 4, (k + 1) % 4]).collect();
    let mut builder = Scene::builder().mesh(&turned(&both), &faces, dull());
    let face = [vec![0, 1, 2, 3]];
    for k in 0..small {
        let (x, y) = (1e-3 * (k + 1) as f64, -1.5 + 0.17 * k as f64);
        let square = [[x, y, 1.04], [x, y + 0.1, 1.04], [x, y + 0.1, 1.14], [x, y, 1.14]];
        builder = builder.mesh(&turned(&square), &face, material("mirror", 0.0, 0.0));
    }
    if is_mirror {
        builder = builder.mesh(&turned(&hole), &face, material("mirror", 0.0, 0.0));
        // Nobody sees what is behind it, though it is where the eye behind the mirror looks through.
        let behind = [[-0.4, -3.0, -3.0], [-0.4, 3.0, -3.0], [-0.5, 3.0, 3.0], [-0.5, -3.0, 3.0]];
        builder = builder.mesh(&turned(&behind), &face, glow([7.0; 3]));
    }
    for (ring, emission) in before_mirror() {
        let is_through = ring[0][0] == 0.0;
        // Behind the mirror's plane there may be more of it.
        let farther = ring.map(|[x, y, z]| if x == 0.0 { [-0.3, y - 0.05, z - 0.025 * z.signum()] } else { [x, y, z] });
        let shown = if is_mirror && is_through { farther } else { ring };
        builder = builder.mesh(&turned(&shown), &face, glow(emission));
        if !is_mirror {
            builder = builder.mesh(&turned(&ring.map(|[x, y, z]| [-x, y, z])), &face, glow(emission));
        }
    }
    builder.build().expect("a scene")
}

/// Areas are exact in mirrors too: as if what they show were behind them.
#[test]
fn edges_in_a_flat_mirror_have_the_areas_of_what_it_shows() {
    let sky = || Some(Sky::constant(DVec3::new(0.0, 0.1, 0.7)).expect("a sky"));
    let size = UVec2::new(60, 40);
    let turned = DQuat::from_euler(EulerRot::XYZ, 0.7, 0.4, -1.1);
    // Of more than 16 planes of mirrors the largest is exact; the smallest ones, at the top, are not.
    for (turn, tolerance, small, first_row) in
        [(DQuat::IDENTITY, 1e-12, 0, 0), (turned, 1e-11, 0, 0), (DQuat::IDENTITY, 1e-12, 17, 8)]
    {
        let camera = Frustum::new(turn * DVec3::new(-1.0, 0.1, 0.05), turn * DVec3::Z, 50.0, 1.5).expect("a camera");
        let eye = turn * DVec3::new(2.7, -0.4, -0.1);
        let rendered = [true, false].map(|is_mirror| {
            let scene = with_mirror(is_mirror, turn, small);
            let brdf = |material: &Material| -> Box<dyn Brdf> {
                if material.name == "mirror" {
                    Box::new(Mirror::new(Fresnel::ALL))
                } else {
                    Box::new(Lambert::new(DVec3::ZERO).expect("a BRDF"))
                }
            };
            let brdfs = scene.materials().iter().map(brdf).collect();
            let lighting = Lighting { sky: sky(), is_two_sided: true, ..Lighting::default() };
            let shader = Shader::with_brdfs(SceneOrder::new(&scene), brdfs, lighting, ShaderOptions::default());
            let shader = shader.expect("a shader");
            let with = |threads: usize| {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
                pool.install(|| render(&shader, eye, &camera, size, &|_| ()).expect("a picture"))
            };
            let rendered = with(1);
            assert!(rendered.picture == with(3).picture, "threads matter");
            rendered
        });
        let mut mixed = 0;
        let pure = [[1.0, 0.0, 0.0], [0.0, 0.5, 0.0], [0.0, 0.0, 2.0], [0.3, 0.2, 0.1], [0.0, 0.1, 0.7], [0.0; 3]];
        for y in first_row..size.y {
            for x in 0..size.x {
                let [found, expected] = [0, 1].map(|k: usize| rendered[k].picture.pixel(x, y));
                assert!((found - expected).abs().max_element() < tolerance, "{x} {y}: {found} {expected}");
                mixed += usize::from(pure.iter().all(|&p| (expected - DVec3::from(p)).abs().max_element() > 1e-9));
            }
        }
        assert!(mixed > 200, "{mixed} pixels with edges");
        // On a screen, where parts are cut off at white, too.
        let [found, expected] = [0, 1].map(|k: usize| rendered[k].displayed(1.7));
        let pixels = found.pixels().iter().zip(expected.pixels());
        pixels
            .skip((first_row * size.x) as usize)
            .for_each(|(a, b)| assert!((*a - *b).abs().max_element() < 2.0 * tolerance, "{a} {b}"));
    }
}

/// A room that glows evenly but for a floor that is a mirror, with things on it: no part of a pixel is lost or there twice.
#[test]
fn what_mirrors_show_fills_them() {
    let room = generate(Kind::Room, 300, 2).expect("a room").to_builder().build().expect("a scene");
    let vertices: Vec<[f64; 3]> = room.vertices().iter().map(DVec3::to_array).collect();
    let is_floor = |polygon: &PolygonRef<'_>| polygon.material().name == "floor";
    let rings = |floor: bool| -> Vec<Vec<usize>> {
        let of = room.polygons().filter(|polygon| is_floor(polygon) == floor);
        of.map(|polygon| polygon.rings()[0].iter().map(|v| v.index()).collect()).collect()
    };
    assert!(!rings(true).is_empty());
    let builder = Scene::builder().mesh(&vertices, &rings(true), material("mirror", 0.0, 0.0));
    let scene = builder.mesh(&vertices, &rings(false), material("glow", 0.0, 1.0)).build().expect("a scene");
    let brdfs: Vec<Box<dyn Brdf>> =
        vec![Box::new(Mirror::new(Fresnel::ALL)), Box::new(Lambert::new(DVec3::ZERO).expect("a BRDF"))];
    let lighting = Lighting { is_two_sided: true, ..Lighting::default() };
    let options = ShaderOptions { mirrors: 1, ..ShaderOptions::default() };
    let shader = Shader::with_brdfs(SceneOrder::new(&scene), brdfs, lighting, options).expect("a shader");
    let size = UVec2::new(48, 40);
    for (towards, degrees) in [(DVec3::new(1.0, 0.6, -0.4), 75.0), (DVec3::new(0.3, 0.2, -1.0), 120.0)] {
        let camera = Frustum::new(towards, DVec3::Z, degrees, 1.2).expect("a camera");
        let rendered = render(&shader, DVec3::new(0.4, 0.5, 1.6), &camera, size, &|_| ()).expect("a picture");
        assert!(rendered.points > 3 * 48 * 40 / 2, "{} points: many pixels have several parts", rendered.points);
        for (k, pixel) in rendered.picture.pixels().iter().enumerate() {
            // Some tens of parts, each off by some 1e-14 of a pixel.
            assert!((*pixel - DVec3::ONE).abs().max_element() < 1e-11, "{k}: {pixel}");
        }
    }
}

/// Each part was followed apart: from mirror to mirror, twice as many rays.
#[test]
fn mirrors_of_several_parts_do_not_branch() {
    let face = vec![vec![0, 1, 2, 3]];
    let scene = Scene::builder()
        .mesh(&square([-5.0, -5.0], [5.0, 5.0], 0.0), &face, material("mirror", 0.0, 0.0))
        .mesh(&square([-5.0, -5.0], [5.0, 5.0], 1.0), &[vec![3, 2, 1, 0]], material("mirror", 0.0, 1.0))
        .build()
        .expect("a scene");
    let parts = [0.25, 0.375];
    let brdfs = scene.materials().iter().map(|_| -> Box<dyn Brdf> {
        let part = |at_normal: f64| -> Box<dyn Brdf> {
            Box::new(Mirror::new(Fresnel::schlick(DVec3::splat(at_normal)).expect("a reflectance")))
        };
        Box::new(Sum::new(parts.map(part).into()))
    });
    let options = ShaderOptions { mirrors: 64, ..ShaderOptions::default() };
    let shader = Shader::with_brdfs(SceneOrder::new(&scene), brdfs.collect(), Lighting::default(), options);
    let found = shader.expect("a shader").reflected(&floor_spot(0.0, 0.0), DVec3::Z, 0).expect("shaded");
    // Every other ray meets the lid, which emits 1.
    let reflectance: f64 = parts.iter().sum();
    let expected: f64 = (0..64).step_by(2).map(|k| reflectance.powi(k + 1)).sum();
    assert!((found - expected).abs().max_element() < 1e-14, "{found} {expected}");
}
