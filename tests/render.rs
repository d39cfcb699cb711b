//! Pictures: direct light against a closed form, furnaces, shadows, and all ways of shading against each other.

mod common;

use common::pictures::{floor_spot, material, square};
use glam::{DQuat, DVec2, DVec3, EulerRot, UVec2};
use nusselt::brdf::{Brdf, Lambert, Light, Lighting, Phong, Sky, Sum};
use nusselt::contour::{Domain, Frustum, SceneOrder, Viewpoint};
use nusselt::factors::{Exchange, ExchangeOptions, PatchMesh, mesh_scene};
use nusselt::picture::{PixelPart, PixelParts};
use nusselt::radiosity::SurfaceOptions;
use nusselt::render::{Indirect, RenderError, Rendered, Shader, ShaderOptions, Shading, Spot, render, render_bands};
use nusselt::samples::{Kind, generate};
use nusselt::scene::{Material, PieceId, PolygonId, PolygonRef, Scene, Side};
use std::f64::consts::PI;

fn shader(scene: &Scene, shading: Shading) -> Shader {
    let options = ShaderOptions { shading, ..ShaderOptions::default() };
    Shader::new(SceneOrder::new(scene), Lighting::default(), options).expect("a shader")
}

/// A floor at z = 0, a lamp at z = 3 above it that shines down, and a plate at z = 1.5 that covers x > 0.
const RHO: f64 = 0.7;
const GLOW: f64 = 5.0;
fn half_hidden() -> Scene {
    let up = vec![vec![0, 1, 2, 3]];
    let down = vec![vec![3, 2, 1, 0]];
    Scene::builder()
        .mesh(&square([-4.0, -4.0], [4.0, 4.0], 0.0), &up, material("floor", RHO, 0.0))
        .mesh(&square([-1.0, -1.0], [1.0, 1.0], 3.0), &down, material("lamp", 0.0, GLOW))
        .mesh(&square([0.0, -9.0], [9.0, 9.0], 1.5), &up, material("plate", 0.0, 0.0))
        .build()
        .expect("a scene")
}

/// The form factor from a point of the floor to a parallel rectangle above it: the antiderivative at its corners.
fn rectangle(from: DVec2, low: DVec2, high: DVec2, height: f64) -> f64 {
    let at = |x: f64, y: f64| {
        let (a, b) = (x / height, y / height);
        let (p, q) = ((1.0 + a * a).sqrt(), (1.0 + b * b).sqrt());
        (a / p * (b / p).atan() + b / q * (a / q).atan()) / (2.0 * PI)
    };
    let (low, high) = (low - from, high - from);
    at(high.x, high.y) - at(low.x, high.y) - at(high.x, low.y) + at(low.x, low.y)
}

/// The radiance of the floor there, in the half shadow of the plate.
fn expected(at: DVec2) -> f64 {
    // The plate is half-way: what is seen of the lamp is at x < -at.x.
    let right = (-at.x).clamp(-1.0, 1.0);
    RHO * GLOW * rectangle(at, DVec2::splat(-1.0), DVec2::new(right, 1.0), 3.0)
}

#[test]
fn direct_light_is_the_exact_form_factor_of_what_is_seen_of_a_lamp() {
    let scene = half_hidden();
    let shader = shader(&scene, Shading::Contour);
    let mut in_half_shadow = 0;
    for k in 0..2000 {
        let (x, y) = (-2.0 + 4.0 * f64::from(k) / 1999.0, (f64::from(k) * 0.37).sin() * 1.5);
        let found = shader.reflected(&floor_spot(x, y), DVec3::new(-1.0, 0.3, 2.0), 0).expect("shaded");
        let expected = expected(DVec2::new(x, y));
        // Form factors are right to some 1e-15.
        assert!((found - DVec3::splat(expected)).abs().max_element() < 1e-13, "{x} {y}: {found} {expected}");
        in_half_shadow += usize::from(x.abs() < 1.0);
    }
    assert!(in_half_shadow > 900);
}

#[test]
fn pixels_are_the_radiances_of_what_is_in_them() {
    let scene = half_hidden();
    let shader = shader(&scene, Shading::Contour);
    let eye = DVec3::new(-3.5, 0.5, 1.0);
    let camera = Frustum::new(DVec3::new(2.0, 0.0, -1.0), DVec3::Z, 60.0, 1.5).expect("a camera");
    let size = UVec2::new(48, 32);
    let rendered = render(&shader, eye, &camera, size, &|_| ()).expect("a picture");
    let image = shader.order().view(&Viewpoint::free(eye), &Domain::Frustum(camera)).expect("a view");
    let parts = PixelParts::new(&image, size).expect("a size").expect("a camera");
    let mut floor = 0;
    // By what is reflected alone, of each pixel that shows a surface.
    let mut reflected = Vec::new();
    parts.tile(UVec2::ZERO, size, |x, y, parts| {
        let (mut light, mut area) = (0.0, 0.0);
        let sum: DVec3 = parts
            .iter()
            .map(|part| {
                let radiance = match part.polygon {
                    Some(PolygonId(0)) => {
                        floor += 1;
                        let at = eye + part.direction * (-eye.z / part.direction.z);
                        light += expected(at.truncate()) * part.area;
                        expected(at.truncate())
                    }
                    // The lamp's front is seen.
                    Some(PolygonId(1)) => GLOW,
                    _ => 0.0,
                };
                area += if part.polygon.is_some() { part.area } else { 0.0 };
                DVec3::splat(radiance * part.area)
            })
            .sum();
        if area > 0.0 {
            reflected.push(light / area);
        }
        assert!((rendered.picture.pixel(x, y) - sum).abs().max_element() < 1e-12, "{x} {y}");
    });
    assert!(floor > 600 && rendered.points > floor, "{floor} {}", rendered.points);
    // What is reflected comes to 0.8 at most in 95% of the pixels that show a surface: no fewer, and no more.
    let exposure = rendered.auto_exposure();
    let at_most = |bound: f64| reflected.iter().filter(|&&radiance| radiance * exposure <= bound).count() as f64;
    let (below, within) = (at_most(0.8 - 1e-9), at_most(0.8 + 1e-9));
    let share = 0.95 * (reflected.len() - 1) as f64;
    assert!(reflected.len() > 700 && below <= share && share <= within, "{exposure}: {below} {share} {within}");
    assert!(within - below < 3.0, "radiances are as many as pixels");
}

/// The lamp is far above white, and what is beside it is black or nearly so.
#[test]
fn the_outline_of_a_lamp_is_as_smooth_on_a_screen_as_others_are() {
    let scene = half_hidden();
    let shader = shader(&scene, Shading::Contour);
    let eye = DVec3::new(-3.5, 0.5, 1.0);
    let camera = Frustum::new(DVec3::new(3.5, -0.5, 1.0), DVec3::Z, 60.0, 1.5).expect("a camera");
    let size = UVec2::new(48, 32);
    let rendered = render(&shader, eye, &camera, size, &|_| ()).expect("a picture");
    let image = shader.order().view(&Viewpoint::free(eye), &Domain::Frustum(camera)).expect("a view");
    let parts = PixelParts::new(&image, size).expect("a size").expect("a camera");
    let radiance = |part: &PixelPart| match part.polygon {
        Some(PolygonId(0)) => expected((eye + part.direction * (-eye.z / part.direction.z)).truncate()),
        Some(PolygonId(1)) => GLOW,
        _ => 0.0,
    };
    for exposure in [0.1, 2.0, 1e3] {
        let displayed = rendered.displayed(exposure);
        let (mut outline, mut lamp) = (0, 0.0);
        parts.tile(UVec2::ZERO, size, |x, y, parts| {
            let shown: f64 = parts.iter().map(|part| (radiance(part) * exposure).min(1.0) * part.area).sum();
            // The floor's radiance is right to some 1e-13, and is scaled by the exposure until it is white.
            let found = displayed.pixel(x, y).x;
            assert!((found - shown).abs() < 1e-12 * exposure.max(1.0), "{x} {y} {exposure}");
            assert!((0.0..=1.0).contains(&found));
            let of_lamp = parts.iter().filter(|part| part.polygon == Some(PolygonId(1))).map(|part| part.area);
            lamp += of_lamp.sum::<f64>();
            // What averaging first would make of it.
            outline += usize::from((rendered.picture.pixel(x, y).x * exposure).min(1.0) > found + 0.1);
        });
        assert!(lamp > 10.0, "it is seen: {lamp}");
        assert_eq!(outline > 5, exposure > 1.0, "{outline}");
    }
}

/// A box with its fronts inside.
fn hollow(material: Material) -> Scene {
    let corner = |k: usize| [0, 1, 2].map(|axis| if k >> axis & 1 == 0 { 0.0 } else { [2.0, 3.0, 1.5][axis] });
    let vertices: Vec<[f64; 3]> = (0..8).map(corner).collect();
    let faces = [[0, 1, 3, 2], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3], [4, 6, 7, 5]];
    Scene::builder().mesh(&vertices, &faces.map(|face| face.to_vec()), material).build().expect("a scene")
}

/// Its radiosities, known without solving anything.
fn furnace(patch: f64, rho: f64, emission: f64) -> (Scene, Indirect) {
    let scene = hollow(material("even", rho, emission));
    let (patches, of) = mesh_scene(&scene, patch).expect("a mesh");
    let all = |radiosity: f64| vec![DVec3::splat(radiosity); patches.polygon_count()];
    let (emitted, total) = (all(PI * emission), all(PI * emission / (1.0 - rho)));
    let indirect = Indirect::new(&patches, &of, scene.polygon_count(), &emitted, &total);
    (scene, indirect)
}

#[test]
fn a_furnace_looks_even_however_it_is_shaded() {
    let (rho, emission) = (0.6, 2.0);
    let (scene, gathering) = furnace(0.7, rho, emission);
    let mesh = PatchMesh::new(&scene, 0.7).expect("a mesh");
    let exchange = Exchange::of_mesh(&mesh, ExchangeOptions::default()).expect("patches");
    let options = SurfaceOptions::default();
    let interpolating = gathering.clone().interpolated(&exchange, &mesh.regions(), &options).expect("a surface");
    assert!(interpolating.corner_count() > 0 && gathering.corner_count() == 0);
    let camera = Frustum::new(DVec3::new(1.0, 1.5, -0.4), DVec3::Z, 80.0, 1.0).expect("a camera");
    let ways = [
        (Shading::Contour, &gathering, 1e-12),
        // What is a thousandth of the way inside of the corners sees all of the box, too.
        (Shading::Contour, &interpolating, 1e-12),
        (Shading::Hemicube { resolution: 32 }, &gathering, 1e-12),
        // Every ray meets a wall.
        (Shading::Rays { rays: 50 }, &gathering, 1e-12),
    ];
    for (shading, indirect, tolerance) in ways {
        let shader = shader(&scene, shading).with_indirect(indirect.clone()).expect("its patches");
        let rendered =
            render(&shader, DVec3::new(0.3, 0.4, 1.1), &camera, UVec2::new(12, 12), &|_| ()).expect("a picture");
        for pixel in rendered.picture.pixels() {
            let off = (*pixel - emission / (1.0 - rho)).abs().max_element();
            assert!(off < tolerance, "{shading:?}: {pixel}");
        }
    }
}

/// A sheet between a floor and a brighter ceiling, whose light is interpolated on its front.
#[test]
fn backs_reflect_what_they_see_and_not_what_their_fronts_do() {
    let up = vec![vec![0, 1, 2, 3]];
    let scene = Scene::builder()
        .mesh(&square([-4.0, -4.0], [4.0, 4.0], 0.0), &up, material("floor", 0.0, 0.0))
        .mesh(&square([-1.0, -1.0], [1.0, 1.0], 1.0), &up, material("sheet", RHO, 0.0))
        .mesh(&square([-4.0, -4.0], [4.0, 4.0], 3.0), &[vec![3, 2, 1, 0]], material("ceiling", 0.0, 0.0))
        .build()
        .expect("a scene");
    let mesh = PatchMesh::new(&scene, 1.0).expect("a mesh");
    let (patches, of) = (mesh.patches().expect("a scene"), mesh.polygons());
    let exchange = Exchange::of_mesh(&mesh, ExchangeOptions::default()).expect("patches");
    let radiosities = [1.0, 0.0, 7.0];
    let radiosity: Vec<DVec3> = of.iter().map(|polygon| DVec3::splat(radiosities[polygon.index()])).collect();
    let nothing = vec![DVec3::ZERO; mesh.len()];
    let indirect = Indirect::new(&patches, &of, scene.polygon_count(), &nothing, &radiosity);
    let options = SurfaceOptions::default();
    let indirect = indirect.interpolated(&exchange, &mesh.regions(), &options).expect("a surface");
    let shader = shader(&scene, Shading::Contour).with_indirect(indirect).expect("its patches");
    let sheet = |side: Side, x: f64, y: f64| {
        let spot = Spot { piece: PieceId(1), side, near: DVec3::new(x, y, 1.0) };
        let viewer = if side == Side::Front { DVec3::Z } else { DVec3::NEG_Z };
        shader.reflected(&spot, viewer, 0).expect("shaded").x
    };
    for k in 0..100 {
        let [x, y] = [k % 10, k / 10].map(|k| -0.93 + 1.86 * f64::from(k) / 9.0);
        let seen = |height: f64| rectangle(DVec2::new(x, y), DVec2::splat(-4.0), DVec2::splat(4.0), height);
        let [front, back] = [(7.0, seen(2.0)), (1.0, seen(1.0))].map(|(radiosity, f)| RHO * radiosity / PI * f);
        // Gathered from some 128 patches, of form factors that are right to some 1e-15.
        let found = sheet(Side::Back, x, y);
        assert!((found - back).abs() < 1e-13, "{x} {y}: {found} {back}");
        // An edge is not halved if its middle is off by 0.03; a point of a triangle by up to three times that.
        let found = sheet(Side::Front, x, y);
        assert!((found / front - 1.0).abs() < 0.09, "{x} {y}: {found} {front}");
    }
}

#[test]
fn hemicubes_and_rays_come_near_contours_and_only_those_are_even() {
    let scene = half_hidden();
    let field = |shading| {
        let shader = shader(&scene, shading);
        let at = |k: i32| shader.reflected(&floor_spot(-2.0 + 0.02 * f64::from(k), 0.1), DVec3::Z, k as u64);
        (0..200).map(|k| at(k).expect("shaded").x).collect::<Vec<f64>>()
    };
    // How much a value differs from the mean of its neighbours.
    let bumps = |field: &[f64]| field.windows(3).map(|w| (w[1] - 0.5 * (w[0] + w[2])).abs()).fold(0.0, f64::max);
    let exact = field(Shading::Contour);
    let cubes = field(Shading::Hemicube { resolution: 64 });
    let off = exact.iter().zip(&cubes).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    // A lamp of form factor 0.13 covers some 30 by 30 pixels of the top face: a row more or less is a thirtieth of it.
    assert!(off < 0.1 * RHO * GLOW * 0.13 && off > 1e-4, "{off}");
    // The exact field has kinks too, where the half shadow begins and ends.
    assert!(bumps(&cubes) > 10.0 * bumps(&exact), "{} {}", bumps(&cubes), bumps(&exact));
    // Each within five standard errors of the exact form factor, as many independent rays have.
    let count = 4096;
    let rays = field(Shading::Rays { rays: count });
    for (exact, found) in exact.iter().zip(&rays) {
        let factor = exact / (RHO * GLOW);
        let error = RHO * GLOW * (factor * (1.0 - factor) / f64::from(count)).sqrt();
        assert!((exact - found).abs() <= 5.0 * error + 1e-12, "{exact} {found} {error}");
    }
}

#[test]
fn gloss_and_interreflection_agree_with_rays_within_their_noise() {
    let scene = generate(Kind::Room, 300, 2).expect("a room").to_builder().build().expect("a scene");
    let (patches, of) = mesh_scene(&scene, 1.0).expect("a mesh");
    // Some radiosities: the same for both, whatever they are.
    let materials = patches.polygons().map(PolygonRef::material);
    let emission: Vec<DVec3> = materials.map(|material| DVec3::from(material.emission) * PI).collect();
    let some = |k: usize| emission[k] + DVec3::new(1.0, 2.0, 3.0) * (0.1 + (k % 7) as f64 * 0.1);
    let total: Vec<DVec3> = (0..emission.len()).map(some).collect();
    let indirect = Indirect::new(&patches, &of, scene.polygon_count(), &emission, &total);
    let of_shading = |shading, with_indirect: bool| {
        let brdfs = scene.materials().iter().map(|_| -> Box<dyn Brdf> {
            let matt = Lambert::new(DVec3::new(0.5, 0.4, 0.3)).expect("a BRDF");
            let gloss = Phong::new(DVec3::splat(0.4), 12.0).expect("a BRDF");
            Box::new(Sum::new(vec![Box::new(matt), Box::new(gloss)]))
        });
        let options = ShaderOptions { shading, ..ShaderOptions::default() };
        let shader = Shader::with_brdfs(SceneOrder::new(&scene), brdfs.collect(), Lighting::default(), options)
            .expect("a shader");
        if with_indirect { shader.with_indirect(indirect.clone()).expect("its patches") } else { shader }
    };
    for with_indirect in [false, true] {
        let exact = of_shading(Shading::Contour, with_indirect);
        let rays = of_shading(Shading::Rays { rays: 4000 }, with_indirect);
        let floor = scene.pieces().find(|piece| scene.polygon(piece.polygon()).material().name == "floor");
        let floor = floor.expect("a floor").id();
        let middle: DVec3 = scene.piece(floor).points().sum::<DVec3>() / scene.piece(floor).points().len() as f64;
        let spot = Spot { piece: floor, side: Side::Front, near: middle };
        let viewer = DVec3::new(0.8, 0.3, 0.5);
        let expected = exact.reflected(&spot, viewer, 0).expect("shaded");
        let runs: Vec<DVec3> = (0..40).map(|seed| rays.reflected(&spot, viewer, seed).expect("shaded")).collect();
        let mean = runs.iter().sum::<DVec3>() / 40.0;
        let variance = runs.iter().map(|run| (*run - mean) * (*run - mean)).sum::<DVec3>() / 39.0;
        let error = DVec3::from((variance / 40.0).to_array().map(f64::sqrt));
        let off = (mean - expected).abs();
        assert!(off.cmple(error * 5.0 + 1e-9).all(), "{with_indirect}: {expected} {mean} +- {error}");
        assert!(
            error.max_element() < 0.05 * expected.max_element() && expected.min_element() > 0.0,
            "{expected} {error}"
        );
    }
}

#[test]
fn a_light_on_a_surface_lights_all_of_it_but_its_own_point() {
    let scene = half_hidden();
    let eye = DVec3::new(-3.5, 0.5, 1.0);
    let camera = Frustum::new(DVec3::new(2.0, 0.0, -1.0), DVec3::Z, 60.0, 1.0).expect("a camera");
    let plain = shader(&scene, Shading::Contour);
    let at = |spot: &Spot, shader: &Shader| shader.reflected(spot, DVec3::new(-1.0, 0.3, 2.0), 0).expect("shaded");
    // On the floor, at a corner of it, on the lamp, in its plane beside it, on an edge of the plate, and a hair above the floor.
    for place in
        [[0.5, 0.25, 0.0], [4.0, 4.0, 0.0], [0.0, 0.0, 3.0], [2.0, 0.0, 3.0], [0.0, 0.0, 1.5], [0.5, 0.25, 1e-200]]
    {
        let position = DVec3::from(place);
        let light = Light::Point { position, intensity: DVec3::ONE };
        let lighting = Lighting { lights: vec![light], ..Lighting::default() };
        let lit = Shader::new(SceneOrder::new(&scene), lighting, ShaderOptions::default()).expect("a shader");
        let below = floor_spot(position.x, position.y);
        if position.z < 1e-9 {
            // Where it is itself it is left out.
            assert_eq!(at(&below, &lit), at(&below, &plain), "{place:?}");
        }
        let rendered = render(&lit, eye, &camera, UVec2::new(12, 12), &|_| ()).expect("a picture");
        assert!(rendered.picture.pixels().iter().all(|pixel| pixel.is_finite()), "{place:?}");
    }
    let nowhere = Light::Point { position: DVec3::NAN, intensity: DVec3::ONE };
    let dark = Light::Directional { towards: DVec3::Z, irradiance: DVec3::NEG_ONE };
    for light in [nowhere, dark] {
        let lighting = Lighting { lights: vec![light], ..Lighting::default() };
        let refused = Shader::new(SceneOrder::new(&scene), lighting, ShaderOptions::default()).err();
        assert!(matches!(refused, Some(RenderError::Light(_))), "{refused:?}");
    }
}

#[test]
fn a_lamp_in_line_with_a_point_lights_nothing_there() {
    // One that stands on the floor, and one in the floor's own plane.
    let upright = [[0.0, -1.0, 0.0], [0.0, 1.0, 0.0], [0.0, 1.0, 1.0], [0.0, -1.0, 1.0]];
    let face = vec![vec![0, 1, 2, 3]];
    let scene = Scene::builder()
        .mesh(&square([-4.0, -4.0], [4.0, 4.0], 0.0), &face, material("floor", RHO, 0.0))
        .mesh(&upright, &face, material("lamp", 0.0, GLOW))
        .mesh(&square([4.0, -1.0], [6.0, 1.0], 0.0), &face, material("lamp", 0.0, GLOW))
        .build()
        .expect("a scene");
    for options in [Shading::Contour, Shading::Hemicube { resolution: 16 }] {
        let shader = shader(&scene, options);
        let at = |x: f64, y: f64| shader.reflected(&floor_spot(x, y), DVec3::Z, 0).expect("shaded").x;
        // In its plane beside it, at its corners, on its lower edge, behind it, and beside the other one; then before it.
        for [x, y] in [[0.0, 2.0], [0.0, 1.0], [0.0, -1.0], [0.0, 0.3], [-1.0, 0.2], [4.0, 0.0], [4.0, 1.0]] {
            let found = at(x, y);
            // On its edge or corner what is seen of it depends on how the point is rounded.
            let is_on_it = x == 0.0 && y.abs() <= 1.0;
            let is_lit = x > 0.0;
            assert!(found.is_finite() && (is_on_it || (found > 0.0) == is_lit), "{options:?} {x} {y}: {found}");
        }
        let camera = Frustum::new(DVec3::new(0.0, 1.0, -1.0), DVec3::Z, 60.0, 1.0).expect("a camera");
        let rendered = render(&shader, DVec3::new(0.0, -3.0, 1.5), &camera, UVec2::new(9, 9), &|_| ());
        assert!(rendered.expect("a picture").picture.pixels().iter().all(|pixel| pixel.is_finite()));
    }
}

/// Below a hood that is open at its bottom, on whole patches of the floor.
#[test]
fn what_is_seen_inside_of_a_hood_has_no_light_from_outside() {
    let corner = |k: usize| [0, 1, 2].map(|axis| [[-1.0, -1.0, 0.0][axis], [1.0, 1.0, 1.0][axis]][k >> axis & 1]);
    let hood: Vec<[f64; 3]> = (0..8).map(corner).collect();
    let sides = [[0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5], [4, 5, 7, 6]];
    let scene = Scene::builder()
        .mesh(&square([-4.0, -4.0], [4.0, 4.0], 0.0), &[vec![0, 1, 2, 3]], material("floor", RHO, 0.0))
        .mesh(&hood, &sides.map(|side| side.to_vec()), material("hood", RHO, 0.0))
        .mesh(&square([-4.0, -4.0], [4.0, 4.0], 5.0), &[vec![3, 2, 1, 0]], material("ceiling", RHO, 0.0))
        .build()
        .expect("a scene");
    let mesh = PatchMesh::new(&scene, 1.0).expect("a mesh");
    let (patches, of, count) = (mesh.patches().expect("a scene"), mesh.polygons(), mesh.len());
    let exchange = Exchange::of_mesh(&mesh, ExchangeOptions::default()).expect("patches");
    let radiosity = vec![DVec3::ONE; count];
    let indirect = Indirect::new(&patches, &of, scene.polygon_count(), &vec![DVec3::ZERO; count], &radiosity);
    let options = SurfaceOptions::default();
    let indirect = indirect.interpolated(&exchange, &mesh.regions(), &options).expect("a surface");
    let shader = shader(&scene, Shading::Contour).with_indirect(indirect).expect("its patches");
    let at = |x: f64, y: f64| shader.reflected(&floor_spot(x, y), DVec3::Z, 0).expect("shaded").x;
    for k in 0..400 {
        let [x, y] = [k % 20, k / 20].map(|k| -0.99 + 1.98 * f64::from(k) / 19.0);
        assert!(at(x, y) == 0.0, "{x} {y}: {}", at(x, y));
        // Outside of it there is light everywhere.
        assert!(at(2.0 + x, y) > 0.05 && at(2.0 * x, 2.0 + y) > 0.05, "{x} {y}");
    }
}

/// A wall that ends within the floor, and patches that send light on one side of it only.
#[test]
fn no_light_leaks_through_a_wall_that_ends_within_a_floor() {
    let upright = |x: f64, [low, high]: [f64; 2], height: f64| {
        [[x, low, 0.0], [x, high, 0.0], [x, high, height], [x, low, height]]
    };
    let both = [vec![0, 1, 2, 3], vec![3, 2, 1, 0]];
    let panel = upright(-1.0, [-0.5, 0.5], 0.5);
    // Where no line of the floor's grid is along the wall, and where one is.
    for low in [-2.1, -2.0] {
        let scene = Scene::builder()
            .mesh(&square([low, low], [2.0, 2.0], 0.0), &[vec![0, 1, 2, 3]], material("floor", RHO, 0.0))
            .mesh(&upright(0.0, [-1.0, 1.0], 1.0), &both, material("wall", RHO, 0.0))
            .mesh(&panel, &both[..1], material("panel", RHO, 0.0))
            .build()
            .expect("a scene");
        let mesh = PatchMesh::new(&scene, 0.5).expect("a mesh");
        let (patches, of, count) = (mesh.patches().expect("a scene"), mesh.polygons(), mesh.len());
        let exchange = Exchange::of_mesh(&mesh, ExchangeOptions::default()).expect("patches");
        let sends = |&polygon: &PolygonId| if polygon.0 == 3 { DVec3::ONE } else { DVec3::ZERO };
        let radiosity: Vec<DVec3> = of.iter().map(sends).collect();
        let nothing = vec![DVec3::ZERO; count];
        let gathering = Indirect::new(&patches, &of, scene.polygon_count(), &nothing, &radiosity);
        let options = SurfaceOptions { depth: 5, ..SurfaceOptions::default() };
        let interpolating = gathering.clone().interpolated(&exchange, &mesh.regions(), &options).expect("a surface");
        let [gathering, interpolating] = [gathering, interpolating]
            .map(|with| shader(&scene, Shading::Contour).with_indirect(with).expect("its patches"));
        let at = |of: &Shader, x: f64, y: f64| of.reflected(&floor_spot(x, y), DVec3::Z, 0).expect("shaded").x;
        for k in 0..200 {
            let [x, y] = [f64::from(k % 10) * 0.04 + 0.01, f64::from(k / 10) * 0.05 - 0.48];
            // All that goes from the panel to a point behind the wall, between its ends, goes through it.
            assert!(at(&interpolating, x, y) == 0.0, "{low} {x} {y}: {}", at(&interpolating, x, y));
            assert!(at(&gathering, x, y) == 0.0);
            // An edge is not halved if its middle is off by 0.03 of what is there; a point of a triangle by up to three times that.
            let [exact, found] = [&gathering, &interpolating].map(|of| at(of, -x, y));
            assert!(exact > 0.0 && (found / exact - 1.0).abs() < 0.09, "{low} {x} {y}: {found} {exact}");
        }
    }
}

#[test]
fn a_picture_by_bands_is_the_same() {
    let scene = half_hidden();
    let shader = shader(&scene, Shading::Contour);
    let (eye, size) = (DVec3::new(-3.5, 0.5, 1.0), UVec2::new(8200, 37));
    let camera = Frustum::new(DVec3::new(2.0, 0.0, 1.0), DVec3::Z, 1.0, 8200.0 / 37.0).expect("a camera");
    let whole = render(&shader, eye, &camera, size, &|_| ()).expect("a picture");
    let (mut pixels, mut shown, mut bands) = (Vec::new(), Vec::new(), 0);
    let points = render_bands(&shader, eye, &camera, size, &|_| (), |band| {
        assert_eq!(band.radiances.len() % 8200, 0);
        shown.extend(band.displayed(7.0));
        pixels.extend(band.radiances);
        bands += 1;
        Ok::<(), RenderError>(())
    });
    assert_eq!((points.ok(), &pixels[..]), (Some(whole.points), whole.picture.pixels()));
    assert_eq!(shown, whole.displayed(7.0).pixels());
    // Of 513 squares side by side, one row of squares at a time.
    assert_eq!(bands, 3);
    assert!(whole.points > 8200 && pixels.iter().any(|&pixel| pixel != pixels[0]));
    let stopped = render_bands(&shader, eye, &camera, size, &|_| (), |_| Err(RenderError::TooBright { x: 7, y: 7 }));
    assert_eq!(stopped, Err(RenderError::TooBright { x: 7, y: 7 }));
}

#[test]
fn lights_that_are_very_bright_or_very_dim_are_exposed_like_others() {
    let picture = |glow: f64| {
        let lamp = material("lamp", 0.0, glow);
        let scene = Scene::builder()
            .mesh(&square([-4.0, -4.0], [4.0, 4.0], 0.0), &[vec![0, 1, 2, 3]], material("floor", RHO, 0.0))
            .mesh(&square([-1.0, -1.0], [1.0, 1.0], 3.0), &[vec![3, 2, 1, 0]], lamp)
            .build()
            .expect("a scene");
        let camera = Frustum::new(DVec3::new(2.0, 0.0, -1.0), DVec3::Z, 60.0, 1.0).expect("a camera");
        render(&shader(&scene, Shading::Contour), DVec3::new(-3.5, 0.5, 1.0), &camera, UVec2::new(9, 9), &|_| ())
    };
    let exposed = |glow: f64| {
        let rendered = picture(glow).expect("a picture");
        let exposure = rendered.auto_exposure();
        assert!(exposure.is_finite() && exposure > 0.0, "{glow}: {exposure}");
        rendered.picture.pixels().iter().map(|&pixel| pixel * exposure).collect::<Vec<_>>()
    };
    let usual = exposed(1.0);
    // Sums of a few products are rounded a few times.
    for glow in [1e300, 1e-290] {
        for (found, expected) in exposed(glow).iter().zip(&usual) {
            assert!((*found - *expected).abs().max_element() < 1e-13, "{glow}: {found} {expected}");
        }
    }
    // Its radiances are subnormal, or no numbers.
    assert!(exposed(1e-320).iter().all(|pixel| pixel.is_finite()));
    assert!(matches!(picture(f64::MAX), Ok(_) | Err(RenderError::TooBright { .. })));
}

#[test]
fn lights_without_extent_cast_sharp_shadows() {
    let scene = half_hidden();
    let (position, intensity) = (DVec3::new(0.5, 0.2, 2.5), DVec3::new(4.0, 5.0, 6.0));
    let towards = DVec3::new(-1.0, 0.0, 1.0);
    let sun = DVec3::new(3.0, 2.0, 1.0);
    let lights = [Light::Point { position, intensity }, Light::Directional { towards, irradiance: sun }];
    for (k, light) in lights.into_iter().enumerate() {
        let lighting = Lighting { lights: vec![light], ..Lighting::default() };
        let with = Shader::new(SceneOrder::new(&scene), lighting, ShaderOptions::default()).expect("a shader");
        let without = shader(&scene, Shading::Contour);
        let mut lit = 0;
        for step in 0..400 {
            let at =
                DVec3::new(-3.9 + 7.8 * f64::from(step % 20) / 19.3, -3.9 + 7.8 * f64::from(step / 20) / 19.3, 0.0);
            let spot = floor_spot(at.x, at.y);
            let radiance = |shader: &Shader| shader.reflected(&spot, DVec3::Z, 0).expect("shaded");
            let found = radiance(&with) - radiance(&without);
            // The plate is at z = 1.5 and x > 0, the lamp at z = 3 above it all.
            let way = if k == 0 { position - at } else { towards };
            let [plate, lamp] = [1.5, 3.0].map(|z| at + way * (z / way.z));
            let in_lamp = k == 1 && lamp.x.abs() < 1.0 && lamp.y.abs() < 1.0;
            let expected = if plate.x > 0.0 || in_lamp {
                DVec3::ZERO
            } else if k == 0 {
                intensity * (RHO / PI * way.z / way.length().powi(3))
            } else {
                sun * (RHO / PI * std::f64::consts::FRAC_1_SQRT_2)
            };
            lit += usize::from(expected != DVec3::ZERO);
            assert!((found - expected).abs().max_element() < 1e-13, "{k} {at}: {found} {expected}");
        }
        assert!((50..350).contains(&lit), "{lit}");
    }
}

/// Two of its corners are higher or lower than the others: it is a valley or a ridge of two triangles. Points on their common edge are rounded to either side of it.
#[test]
fn no_triangle_of_a_polygon_shadows_the_other_one_on_their_common_edge() {
    let light = DVec3::new(0.3, -0.2, 3.0);
    let mut triangles = 0;
    for turn in 0..10 {
        let rotation = DQuat::from_euler(EulerRot::XYZ, 0.37 + 0.01 * f64::from(turn), 0.23, 0.71);
        let mut corners = square([-0.7, -0.9], [1.1, 0.8], 0.0);
        corners[0][2] = if turn % 2 == 0 { 0.4 } else { -0.4 };
        let corners = corners.map(|p| (rotation * DVec3::from(p)).to_array());
        let scene = Scene::builder().mesh(&corners, &[vec![0, 1, 2, 3]], material("floor", RHO, 0.0));
        let scene = scene.build().expect("a scene");
        let lights = vec![Light::Point { position: light, intensity: DVec3::ONE }];
        let lighting = Lighting { lights, ..Lighting::default() };
        let shader = Shader::new(SceneOrder::new(&scene), lighting, ShaderOptions::default()).expect("a shader");
        let corners: Vec<Vec<DVec3>> = scene.pieces().map(|piece| piece.points().collect()).collect();
        let common: Vec<DVec3> = corners[0].iter().copied().filter(|point| corners[1].contains(point)).collect();
        assert_eq!(common.len(), 2);
        for piece in scene.pieces() {
            let p: Vec<DVec3> = piece.points().collect();
            let normal = (p[1] - p[0]).cross(p[2] - p[0]).normalize();
            triangles += 1;
            for k in 0..500 {
                let near = common[0].lerp(common[1], (f64::from(k) + 0.5) / 500.0);
                let spot = Spot { piece: piece.id(), side: Side::Front, near };
                let (found, way) = (shader.reflected(&spot, light - near, 0).expect("shaded").x, light - near);
                let expected = RHO / PI * way.dot(normal) / way.length().powi(3);
                // Points and normals are rounded a few times.
                assert!((found / expected - 1.0).abs() < 1e-12, "{turn}: {near}: {found} {expected}");
            }
        }
    }
    assert_eq!(triangles, 20);
}

#[test]
fn a_white_sky_lights_what_it_reaches() {
    // A floor below nothing but the sky: rho times its radiance.
    let face = vec![vec![0, 1, 2, 3]];
    let scene = Scene::builder()
        .mesh(&square([-4.0, -4.0], [4.0, 4.0], 0.0), &face, material("floor", RHO, 0.0))
        .build()
        .expect("a scene");
    let overcast = Sky::overcast(DVec3::ONE, DVec3::Z).expect("a sky");
    let constant = Sky::constant(DVec3::ONE).expect("a sky");
    // 7 pi / 9 of an overcast sky, by cubature to a thousandth.
    for (sky, expected, tolerance) in [(constant, RHO, 1e-14), (overcast, RHO * 7.0 / 9.0, 1e-3)] {
        let lighting = Lighting { sky: Some(sky), ..Lighting::default() };
        let shader = Shader::new(SceneOrder::new(&scene), lighting, ShaderOptions::default()).expect("a shader");
        let found = shader.reflected(&floor_spot(0.3, 0.2), DVec3::new(1.0, 0.0, 1.0), 0).expect("shaded");
        assert!((found - expected).abs().max_element() < tolerance, "{found} {expected}");
        assert_eq!(shader.background(DVec3::NEG_Z), if expected == RHO { DVec3::ONE } else { DVec3::ZERO });
    }
}

#[test]
fn what_cannot_be_rendered_is_said() {
    let scene = half_hidden();
    let with = |shading| {
        Shader::new(SceneOrder::new(&scene), Lighting::default(), ShaderOptions { shading, ..ShaderOptions::default() })
    };
    for shading in [Shading::Hemicube { resolution: 3 }, Shading::Rays { rays: 0 }] {
        assert!(matches!(with(shading), Err(RenderError::Baseline(_))), "{shading:?}");
    }
    let none = Shader::with_brdfs(SceneOrder::new(&scene), Vec::new(), Lighting::default(), ShaderOptions::default());
    assert!(matches!(none, Err(RenderError::WrongBrdfs { found: 0, expected: 3 })));
    let shader = shader(&scene, Shading::Contour);
    let below = shader.reflected(&floor_spot(0.0, 0.0), DVec3::NEG_Z, 0);
    assert!(matches!(below, Err(RenderError::Reflect { polygon: PolygonId(0), .. })), "{below:?}");
    let nowhere = shader.reflected(&floor_spot(f64::NAN, 0.0), DVec3::Z, 0);
    assert!(matches!(nowhere, Err(RenderError::Surface(_))), "{nowhere:?}");
    let camera = Frustum::new(DVec3::Y, DVec3::Z, 40.0, 1.0).expect("a camera");
    let of = |eye, size| render(&shader, eye, &camera, size, &|_| ());
    assert!(matches!(of(DVec3::ONE, UVec2::new(0, 4)), Err(RenderError::Size(_))));
    assert!(matches!(of(DVec3::NAN, UVec2::new(4, 4)), Err(RenderError::View { from: "the camera", .. })));
    let (_, indirect) = furnace(9.0, 0.5, 1.0);
    assert!(matches!(shader.with_indirect(indirect), Err(RenderError::OtherPatches { found: 6, expected: 3 })));
}

#[test]
fn light_that_numbers_do_not_hold_is_told_with_its_pixel() {
    let bright = |emission: f64| {
        let scene = Scene::builder()
            .mesh(&square([-4.0, -4.0], [4.0, 4.0], 0.0), &[vec![0, 1, 2, 3]], material("floor", 0.9, 0.0))
            .mesh(&square([-1.0, -1.0], [1.0, 1.0], 0.01), &[vec![3, 2, 1, 0]], material("lamp", 0.0, emission))
            .build()
            .expect("a scene");
        // On the floor below the lamp.
        let camera = Frustum::new(DVec3::new(-1.0, 0.0, -0.002), DVec3::Z, 0.5, 1.0).expect("a camera");
        render(&shader(&scene, Shading::Contour), DVec3::new(2.0, 0.0, 0.006), &camera, UVec2::new(5, 3), &|_| ())
    };
    let found = bright(1.7e308);
    assert!(matches!(found, Err(RenderError::TooBright { x: 0..5, y: 0..3 })), "{found:?}");
    let picture = bright(1e307).expect("numbers hold a tenth").picture;
    assert!(picture.pixels().iter().any(|pixel| pixel.x > 1e306), "{picture:?}");
}

#[test]
fn odd_cameras_see_what_there_is() {
    let scene = half_hidden();
    let shader = shader(&scene, Shading::Contour);
    // On the floor, in its plane, on its edge, inside of the lamp, and with nothing in view.
    let eyes = [[0.0, 0.0, 0.0], [-9.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 0.0, 3.0], [90.0, 90.0, 90.0]];
    for eye in eyes {
        for degrees in [1e-9, 60.0, 179.9] {
            let camera = Frustum::new(DVec3::new(1.0, 0.2, 0.1), DVec3::Z, degrees, 1.0).expect("a camera");
            let picture: Result<Rendered, _> = render(&shader, eye.into(), &camera, UVec2::new(7, 7), &|_| ());
            let picture = picture.expect("a picture").picture;
            assert!(picture.pixels().iter().all(|pixel| pixel.is_finite() && pixel.min_element() >= 0.0), "{eye:?}");
        }
    }
}
