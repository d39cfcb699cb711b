//! The gradient of irradiance against finite differences of it, and where there is none.

mod common;

use common::Random;
use glam::DVec3;
use nusselt::brdf::emitted_by_both_sides;
use nusselt::contour::{ContourImage, Domain, SceneOrder, Viewpoint, VisibleRegion};
use nusselt::integral::{GradientError, IrradianceGradient};
use nusselt::samples::{Kind, generate};
use nusselt::scene::{Material, PolygonId, Scene};
use std::f64::consts::PI;

fn scene(faces: &[Vec<DVec3>], radiance: impl Fn(usize) -> f64) -> Scene {
    let builder = faces.iter().enumerate().fold(Scene::builder(), |builder, (k, face)| {
        let emission = DVec3::new(1.0, 0.5, 0.25) * radiance(k);
        let material = Material { emission: emission.to_array(), ..Material::new(format!("m{k}")) };
        let corners: Vec<[f64; 3]> = face.iter().map(DVec3::to_array).collect();
        builder.mesh(&corners, &[(0..face.len()).collect::<Vec<_>>()], material)
    });
    builder.build().expect("a scene")
}

fn radiance(image: &ContourImage) -> impl Fn(&VisibleRegion) -> DVec3 {
    |region| emitted_by_both_sides(image.cell(region.cells()[0]))
}

fn view(order: &SceneOrder, eye: DVec3, normal: DVec3) -> ContourImage {
    order.view(&Viewpoint::free(eye), &Domain::Hemisphere(normal)).expect("a view")
}

fn gradient(order: &SceneOrder, eye: DVec3, normal: DVec3) -> Result<IrradianceGradient, GradientError> {
    let image = view(order, eye, normal);
    image.irradiance_gradient(radiance(&image))
}

/// From form factors, which know nothing of gradients.
fn irradiance(order: &SceneOrder, eye: DVec3, normal: DVec3) -> f64 {
    let image = view(order, eye, normal);
    let factors = image.form_factors().expect("a hemisphere");
    let of = |k: PolygonId| image.scene().polygon(k).material().emission[0];
    factors.polygons.iter().map(|sum| PI * sum.both() * of(sum.polygon)).sum()
}

/// Central differences of fourth order.
fn difference(f: impl Fn(f64) -> f64, h: f64) -> f64 {
    (8.0 * (f(h) - f(-h)) - (f(2.0 * h) - f(-2.0 * h))) / (12.0 * h)
}

/// How far derivatives are off by differences, as a part of the irradiance's scale.
fn check(order: &SceneOrder, eye: DVec3, normal: DVec3, h: f64) -> f64 {
    let found = gradient(order, eye, normal).expect("a derivative");
    assert!((found.irradiance.x - irradiance(order, eye, normal)).abs() < 1e-13 * (1.0 + found.irradiance.x));
    let mut worst = 0.0_f64;
    for axis in DVec3::AXES {
        let expected = difference(|t| irradiance(order, eye + axis * t, normal), h);
        worst = worst.max((found.by_position[0].dot(axis) - expected).abs());
        // Turned about the axis: the normal moves by axis x normal.
        let turned = |t: f64| {
            (normal * t.cos() + axis.cross(normal) * t.sin() + axis * (axis.dot(normal) * (1.0 - t.cos()))).normalize()
        };
        let expected = difference(|t| irradiance(order, eye, turned(t)), h);
        worst = worst.max((found.by_normal[0].dot(axis.cross(normal)) - expected).abs());
        assert!((found.by_position[1] * 2.0 - found.by_position[0]).length() < 1e-12, "colours");
    }
    worst
}

#[test]
fn partly_hidden_sources_change_as_differences_do() {
    let mut random = Random(11);
    let (mut sizes, mut off) = (Vec::new(), Vec::new());
    for _ in 0..60 {
        // Bright sources far away, darker ones before them; some cross each other and the horizon.
        let faces: Vec<Vec<DVec3>> = (0..10)
            .map(|k| {
                let near = if k < 5 { 1.0 } else { 0.5 };
                let middle = random.direction().normalize() * (3.0 * near);
                (0..3).map(|_| middle + random.in_cube(1.6 * near)).collect()
            })
            .collect();
        let scene = scene(&faces, |k| if k < 5 { 1.0 + k as f64 } else { 0.0 });
        let order = SceneOrder::new(&scene);
        let normal = random.direction().normalize();
        let found = gradient(&order, DVec3::ZERO, normal).expect("a derivative");
        sizes.push(found.by_position[0].length());
        off.push(check(&order, DVec3::ZERO, normal, 2e-4));
    }
    off.sort_by(f64::total_cmp);
    // Where an edge passes a vertex between the points of the difference, that is off by the step times the change; elsewhere by the
    // rounding over the step, and its fourth power.
    assert!(off[40] < 1e-9, "{off:?}");
    assert!(off[59] < 1e-3, "{off:?}");
    assert!(sizes.iter().filter(|&&size| size > 0.1).count() > 40, "{sizes:?}");
}

#[test]
fn creases_move_too() {
    // Two squares that cross each other above the eye, one bright.
    let faces = [
        [[-2.0, -1.0, 1.0], [2.0, -1.1, 2.9], [2.0, 1.2, 3.0], [-2.0, 1.0, 1.1]],
        [[-2.0, -1.3, 3.1], [2.0, -1.0, 0.8], [2.1, 1.1, 1.0], [-2.0, 1.0, 2.8]],
    ];
    let triangles: Vec<Vec<DVec3>> = faces
        .iter()
        .flat_map(|face| [[0, 1, 2], [0, 2, 3]].map(|t| t.map(|k| DVec3::from(face[k])).to_vec()))
        .collect();
    let scene = scene(&triangles, |k| if k < 2 { 2.0 } else { 0.0 });
    let order = SceneOrder::new(&scene);
    let mut random = Random(3);
    for _ in 0..10 {
        let (eye, normal) = (random.in_cube(0.1), (DVec3::Z + random.in_cube(0.3)).normalize());
        let off = check(&order, eye, normal, 1e-3);
        assert!(off < 1e-8, "{off}");
    }
}

#[test]
fn rooms_have_gradients_along_their_floors() {
    let scene = generate(Kind::Room, 1_000, 3).expect("a room").to_builder().build().expect("a scene");
    let order = SceneOrder::new(&scene);
    let (low, high) = scene.bounds().unwrap();
    let at = |x: f64, y: f64| {
        let near = DVec3::new(low.x + (high.x - low.x) * x, low.y + (high.y - low.y) * y, low.z);
        let (piece, side) = Viewpoint::surface_at(&scene, near, DVec3::Z).expect("a tile of the floor");
        let floor = Viewpoint::on_piece(&scene, piece, side, near).unwrap();
        order.view(&floor, &Domain::Above).unwrap()
    };
    let lit = |image: &ContourImage| {
        let factors = image.form_factors().unwrap();
        let of = |k: PolygonId| image.scene().polygon(k).material().emission[0];
        factors.polygons.iter().map(|sum| PI * sum.both() * of(sum.polygon)).sum::<f64>()
    };
    let mut off = Vec::new();
    for (x, y) in [(0.31, 0.42), (0.57, 0.66), (0.77, 0.13), (0.111, 0.887), (0.503, 0.297)] {
        let image = at(x, y);
        let found = image.irradiance_gradient(radiance(&image)).expect("a derivative");
        // Corners are rounded to 1e-16, of regions as far around as the radiance of 10 or so times their sides of about 1 make it.
        let off_by = (found.irradiance.x - lit(&image)).abs();
        assert!(off_by < 1e-13, "{off_by} of {found:?}");
        let h = 1e-5;
        let expected = [
            difference(|t| lit(&at(x + t, y)), h) / (high.x - low.x),
            difference(|t| lit(&at(x, y + t)), h) / (high.y - low.y),
        ];
        let size = found.by_position[0].length();
        assert!(size > 1e-3, "{found:?}");
        off.push((found.by_position[0].x - expected[0]).abs().max((found.by_position[0].y - expected[1]).abs()) / size);
    }
    off.sort_by(f64::total_cmp);
    assert!(off[2] < 1e-7 && off[4] < 1e-2, "{off:?}");
}

#[test]
fn there_is_none_where_edges_are_in_line_or_polygons_edge_on() {
    let square = |x: f64, z: f64, size: f64| {
        [[x, -size, z], [x + 2.0 * size, -size, z], [x + 2.0 * size, size, z], [x, size, z]].map(DVec3::from).to_vec()
    };
    // The left edges of a lamp and of a screen before it are in line with the eye.
    let in_line = scene(&[square(0.5, 2.0, 1.0), square(0.25, 1.0, 0.4)], |k| if k == 0 { 1.0 } else { 0.0 });
    let order = SceneOrder::new(&in_line);
    let refused = gradient(&order, DVec3::ZERO, DVec3::Z);
    assert!(matches!(refused, Err(GradientError::InLine { .. })), "{refused:?}");
    // And so it is: to one side the irradiance changes as the lamp's edge moves, to the other as the screen's does.
    let at = |x: f64| irradiance(&order, DVec3::X * x, DVec3::Z);
    let [right, left] = [at(1e-5) - at(0.0), at(0.0) - at(-1e-5)];
    assert!((right - left).abs() > 0.02 * right.abs().max(left.abs()), "{right} {left}");
    // Beside that there is one.
    let off = check(&order, DVec3::new(0.003, 0.01, 0.02), DVec3::Z, 1e-4);
    assert!(off < 1e-9, "{off}");
    // A screen seen edge-on.
    let upright = [[0.0, -0.5, 0.5], [0.0, 0.5, 0.5], [0.0, 0.5, 1.5], [0.0, -0.5, 1.5]].map(DVec3::from).to_vec();
    let edge_on = scene(&[square(-1.0, 2.0, 1.0), upright], |k| if k == 0 { 1.0 } else { 0.0 });
    let order = SceneOrder::new(&edge_on);
    let refused = gradient(&order, DVec3::ZERO, DVec3::Z);
    assert_eq!(refused, Err(GradientError::EdgeOn { polygon: PolygonId(1) }));
    let off = check(&order, DVec3::new(0.01, 0.02, 0.03), DVec3::Z, 1e-4);
    assert!(off < 1e-9, "{off}");
    let sphere = order.view(&Viewpoint::free(DVec3::ZERO), &Domain::Sphere).unwrap();
    assert_eq!(sphere.irradiance_gradient(|_| DVec3::ONE), Err(GradientError::NoNormal));
}

fn rectangle(x: [f64; 2], y: [f64; 2], z: f64) -> Vec<DVec3> {
    [[x[0], y[0]], [x[1], y[0]], [x[1], y[1]], [x[0], y[1]]].map(|[x, y]| DVec3::new(x, y, z)).to_vec()
}

#[test]
fn what_is_hidden_does_not_matter() {
    let lamp = rectangle([-3.0, 3.0], [-3.0, 3.0], 4.0);
    // Behind a screen: two edges in line, and a polygon seen edge-on.
    let screen = rectangle([-0.6, 0.7], [-0.5, 0.8], 1.0);
    let behind = [
        rectangle([0.0, 0.4], [-0.3, 0.3], 2.0),
        rectangle([-0.4, 0.0], [-0.2, 0.4], 3.0),
        [[0.0, -0.1, 1.5], [0.0, 0.2, 1.5], [0.0, 0.2, 1.8], [0.0, -0.1, 1.8]].map(DVec3::from).to_vec(),
    ];
    let with = |parts: &[Vec<DVec3>]| {
        scene(&[std::slice::from_ref(&lamp), parts].concat(), |k| if k == 0 { 1.0 } else { 0.0 })
    };
    let hidden = with(&[std::slice::from_ref(&screen), &behind].concat());
    let off = check(&SceneOrder::new(&hidden), DVec3::ZERO, DVec3::Z, 1e-4);
    assert!(off < 1e-9, "{off}");
    // Not behind: refused as ever.
    let seen = gradient(&SceneOrder::new(&with(&behind[..2])), DVec3::ZERO, DVec3::Z);
    assert!(matches!(seen, Err(GradientError::InLine { .. })), "{seen:?}");
    let seen = gradient(&SceneOrder::new(&with(&behind[2..])), DVec3::ZERO, DVec3::Z);
    assert!(matches!(seen, Err(GradientError::EdgeOn { .. })), "{seen:?}");
    // Partly behind: the stretch in which they are in line reaches out of the screen, or just does not.
    for (low, is_hidden) in [(-0.9, false), (-0.45, true)] {
        let long = [rectangle([0.0, 0.4], [2.0 * low, 0.3], 2.0), rectangle([-0.4, 0.0], [3.0 * low, 0.4], 3.0)];
        let order = SceneOrder::new(&with(&[std::slice::from_ref(&screen), &long].concat()));
        let found = gradient(&order, DVec3::ZERO, DVec3::Z);
        assert_eq!(found.is_ok(), is_hidden, "{found:?}");
    }
}

#[test]
fn a_side_may_be_of_several_lines() {
    // Two screens, one behind the other, whose edges are on one plane through the eye and touch there: each part moves by its own distance.
    let lamp = rectangle([-3.0, 3.0], [-3.0, 3.0], 4.0);
    let near = [[0.0, -1.0, 1.0], [0.0, 0.0, 1.0], [-1.0, -0.5, 1.0]].map(DVec3::from).to_vec();
    for far in [2.0, 3.0] {
        // Its lower edge is hidden.
        let other = [[0.0, 0.0], [0.0, 0.5], [-0.8, 0.5], [-0.8, -0.6]].map(|[x, y]| DVec3::new(x, y, 1.0) * far);
        let faces = [lamp.clone(), near.clone(), other.to_vec()];
        let order = SceneOrder::new(&scene(&faces, |k| if k == 0 { 1.0 } else { 0.0 }));
        let found = gradient(&order, DVec3::ZERO, DVec3::Z).expect("a derivative");
        // Where the two touch the change is of second order on both sides, with different factors: a difference is off by as much as its step.
        let expected = difference(|t| irradiance(&order, DVec3::X * t, DVec3::Z), 1e-6);
        assert!((found.by_position[0].x - expected).abs() < 1e-5, "{found:?} {expected}");
    }
}

#[test]
fn known_gradients() {
    // A square of half side s above, parallel: E = 4 L t atan(t) ... with t = s / sqrt(s^2 + h^2), from its middle.
    let s = 0.7;
    let at = |h: f64| {
        let t = s / f64::hypot(s, h);
        4.0 * t * t.atan()
    };
    let lamp = scene(&[[[-s, -s, 2.0], [s, -s, 2.0], [s, s, 2.0], [-s, s, 2.0]].map(DVec3::from).to_vec()], |_| 1.0);
    let order = SceneOrder::new(&lamp);
    let found = gradient(&order, DVec3::ZERO, DVec3::Z).unwrap();
    assert!((found.irradiance.x - at(2.0)).abs() < 1e-14);
    // dE / dh = dE / dt dt / dh, t' = -s h / (s^2 + h^2)^1.5.
    let (t, root) = (s / f64::hypot(s, 2.0), f64::hypot(s, 2.0));
    let slope = 4.0 * (t.atan() + t / (1.0 + t * t)) * (-s * 2.0 / root.powi(3));
    assert!((found.by_position[0] - DVec3::Z * -slope).length() < 1e-14, "{found:?} {slope}");
}
