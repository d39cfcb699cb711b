//! Absolute accuracy: 1e-12 against closed forms (Howell, A Catalog of Radiation Heat Transfer Configuration Factors, sections B-3, B-4),
//! in the open and behind other polygons.

use super::{both_ways, of, scene};
use glam::{DVec2, DVec3};
use proptest::prelude::*;
use std::f64::consts::{PI, TAU};

const ALLOWED: f64 = 1e-12;

/// B-3: a rectangle from above the element's foot to (x, y), in the parallel plane at distance 1. Odd in x and y.
fn parallel_corner(x: f64, y: f64) -> f64 {
    let [p, q] = [x.hypot(1.0), y.hypot(1.0)];
    ((y / p).atan() * x / p + (x / q).atan() * y / q) / TAU
}

/// B-4: a rectangle in the plane at distance 1 perpendicular to the element, from its plane to height z, from its foot to y. Odd in y,
/// even in z.
fn perpendicular_corner(y: f64, z: f64) -> f64 {
    let a = z.hypot(1.0).recip();
    (y.atan() - a * (y * a).atan()) / TAU
}

fn of_rectangle(corner: impl Fn(f64, f64) -> f64, [low, high]: [DVec2; 2]) -> f64 {
    corner(high.x, high.y) - corner(low.x, high.y) - corner(high.x, low.y) + corner(low.x, low.y)
}

/// A rectangle of the plane z = height; both sides count, so its orientation does not matter.
fn rectangle([low, high]: [DVec2; 2], height: f64) -> Vec<DVec3> {
    [low, DVec2::new(high.x, low.y), high, DVec2::new(low.x, high.y)].map(|p| p.extend(height)).to_vec()
}

fn box_of(a: [f64; 2], b: [f64; 2]) -> [DVec2; 2] {
    let [a, b] = [DVec2::from(a), DVec2::from(b)];
    [a.min(b), a.max(b)]
}

/// Lambert's sum, term by term.
fn lambert(polygon: &[DVec3], normal: DVec3) -> f64 {
    let next = |k: usize| polygon[(k + 1) % polygon.len()];
    let terms = polygon.iter().enumerate().map(|(k, &a)| {
        let cross = a.cross(next(k));
        cross.length().atan2(a.dot(next(k))) * normal.dot(cross.normalize_or_zero())
    });
    (terms.sum::<f64>() / TAU).abs()
}

/// The part of a convex polygon on one side of a line, in a plane (Sutherland and Hodgman 1974).
fn clipped(polygon: &[DVec2], from: DVec2, to: DVec2) -> Vec<DVec2> {
    let height = |p: DVec2| (to - from).perp_dot(p - from);
    let mut kept = Vec::new();
    for (k, &a) in polygon.iter().enumerate() {
        let b = polygon[(k + 1) % polygon.len()];
        let (ha, hb) = (height(a), height(b));
        if ha >= 0.0 {
            kept.push(a);
        }
        if (ha < 0.0) != (hb < 0.0) {
            kept.push(a + (b - a) * (ha / (ha - hb)));
        }
    }
    kept
}

fn counter_clockwise(mut triangle: [DVec2; 3]) -> [DVec2; 3] {
    if (triangle[1] - triangle[0]).perp_dot(triangle[2] - triangle[0]) < 0.0 {
        triangle.swap(1, 2);
    }
    triangle
}

fn at(range: f64) -> impl Strategy<Value = [f64; 2]> {
    prop::array::uniform2(-range..range)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(128))]

    #[test]
    fn a_rectangle_behind_a_parallel_rectangle_is_a_difference_of_closed_forms(
        a in at(3.0), b in at(3.0), c in at(2.0), d in at(2.0), height in 0.1..0.9f64,
        eye in prop::array::uniform3(-5.0..5.0f64), scale in -20..20,
    ) {
        let scale = 2f64.powi(scale);
        let far = box_of(a, b);
        let near = box_of(c, d);
        prop_assume!((far[1] - far[0]).min_element() > 1e-3 && (near[1] - near[0]).min_element() > 1e-3);
        let eye = DVec3::from(eye) * scale;
        // The coordinates of the scene are rounded: the reference takes what they are.
        let polygons = [rectangle(far, 1.0), rectangle(near, height)]
            .map(|corners| corners.iter().map(|&p| p * scale + eye).collect::<Vec<_>>());
        let seen = |k: usize| {
            let distance = polygons[k][0].z - eye.z;
            [0, 2].map(|corner| (polygons[k][corner] - eye).truncate() / distance)
        };
        let [far, near] = [seen(0), seen(1)];
        let hidden = [far[0].max(near[0]), far[1].min(near[1])];
        let is_hidden = hidden[0].cmplt(hidden[1]).all();
        let hidden = if is_hidden { of_rectangle(parallel_corner, hidden) } else { 0.0 };
        let expected = [of_rectangle(parallel_corner, far) - hidden, of_rectangle(parallel_corner, near)];
        for factors in both_ways(&scene(&polygons), eye, DVec3::Z) {
            for (k, expected) in expected.into_iter().enumerate() {
                let factor = of(&factors, k as u32);
                prop_assert!((factor - expected).abs() < ALLOWED, "{k}: {factor} {expected}");
            }
            prop_assert!((factors.background - (1.0 - expected[0] - expected[1])).abs() < ALLOWED);
        }
    }

    #[test]
    fn a_wall_is_seen_above_the_horizon_only(a in at(3.0), b in at(3.0)) {
        let [low, high] = box_of(a, b);
        prop_assume!((high - low).min_element() > 1e-3);
        // (1, y, z) for (x, y).
        let wall: Vec<DVec3> = rectangle([low, high], 1.0).iter().map(|p| DVec3::new(1.0, p.x, p.y)).collect();
        let zero = DVec2::new(0.0, 0.0);
        let above = [DVec2::new(low.x, low.y.max(zero.y)), DVec2::new(high.x, high.y.max(zero.y))];
        let expected = of_rectangle(perpendicular_corner, above);
        for factors in both_ways(&scene(&[wall]), DVec3::ZERO, DVec3::Z * 3.0) {
            prop_assert!((of(&factors, 0) - expected).abs() < ALLOWED, "{expected}");
            prop_assert!((factors.background - (1.0 - expected)).abs() < ALLOWED);
        }
    }

    #[test]
    fn a_triangle_behind_a_triangle_is_what_clipping_leaves(
        far in prop::array::uniform3(at(3.0)), near in prop::array::uniform3(at(2.0)), height in 0.1..0.9f64,
        tilt in at(0.3),
    ) {
        let [far, near] = [far, near].map(|corners| counter_clockwise(corners.map(DVec2::from)));
        let area = |t: &[DVec2; 3]| (t[1] - t[0]).perp_dot(t[2] - t[0]);
        prop_assume!(area(&far) > 0.1 && area(&near) > 0.1);
        // Above the horizon of a normal that is tilted by this much.
        let normal = DVec3::new(tilt[0], tilt[1], 1.3).normalize();
        let polygons = [far.map(|p| p.extend(1.0)).to_vec(), near.map(|p| (p * height).extend(height)).to_vec()];
        prop_assume!(polygons.iter().flatten().all(|p| p.dot(normal) > 0.0));
        // Both as seen in the plane z = 1; the second as it was rounded.
        let near: Vec<DVec2> = polygons[1].iter().map(|p| p.truncate() / height).collect();
        let mut hidden = far.to_vec();
        for k in 0..3 {
            hidden = clipped(&hidden, near[k], near[(k + 1) % 3]);
        }
        let in_space = |polygon: &[DVec2]| polygon.iter().map(|p| p.extend(1.0)).collect::<Vec<_>>();
        let hidden = if hidden.len() < 3 { 0.0 } else { lambert(&in_space(&hidden), normal) };
        let expected = [lambert(&in_space(&far), normal) - hidden, lambert(&in_space(&near), normal)];
        for factors in both_ways(&scene(&polygons), DVec3::ZERO, normal) {
            for (k, expected) in expected.into_iter().enumerate() {
                prop_assert!((of(&factors, k as u32) - expected).abs() < ALLOWED, "{k}: {expected}");
            }
        }
    }
}

#[test]
fn a_disc_is_the_limit_of_its_polygons() {
    // A disc of radius r at distance h in front of the element: r^2 / (r^2 + h^2). An inscribed polygon of n corners has less: of its
    // area the share (2 pi / n)^2 / 6, and of its factor no more than that; 4 / 3 of it is more than what further terms can add.
    for (radius, height) in [(1.0, 1.0), (0.1, 2.0), (3.0, 0.5)] {
        let exact = radius * radius / (radius * radius + height * height);
        let mut former = f64::INFINITY;
        for count in [16, 64, 256, 1024] {
            let disc: Vec<DVec3> = (0..count)
                .map(|k| (TAU * f64::from(k) / f64::from(count)).sin_cos())
                .map(|(sin, cos)| DVec3::new(radius * cos, radius * sin, height))
                .collect();
            let [factors, _] = both_ways(&scene(&[disc]), DVec3::ZERO, DVec3::Z);
            let missing = exact - of(&factors, 0);
            let most = (2.0 * PI / f64::from(count)).powi(2) / 6.0 * exact * 4.0 / 3.0;
            assert!(missing > 0.0 && missing < most && missing < former / 15.0, "{count}: {missing:e} {most:e}");
            former = missing;
        }
    }
}
