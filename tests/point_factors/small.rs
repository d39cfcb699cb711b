//! Relative accuracy: 1e-9 down to factors of 1e-15, also where the corners of what is seen are crossings of edges.

use super::rationals::{Vector, clipped, cross, dot, exact, form_factor, minus};
use super::{both_ways, of, scene};
use glam::DVec3;
use num_traits::Signed;
use nusselt::bsp::{BspOptions, SceneBsp};
use nusselt::contour::{Domain, SceneOrder, Viewpoint};
use nusselt::factors::{By, PointSolver};
use nusselt::scene::{PolygonId, Side};
use proptest::prelude::*;

/// What is asked for.
const ALLOWED: f64 = 1e-9;

/// Polygon 0, of that angular size about a direction, seen past the edges of larger polygons close by, above a horizon.
#[derive(Debug)]
struct Case {
    eye: DVec3,
    normal: DVec3,
    target: Vec<DVec3>,
    screens: Vec<Vec<DVec3>>,
}

impl Case {
    /// The visible part of the target: what is above the horizon, and beyond the edge from the first to the second corner of each screen.
    fn seen(&self) -> Vec<Vector> {
        let from_eye = |p: &DVec3| minus(&exact(*p), &exact(self.eye));
        let target: Vec<_> = self.target.iter().map(from_eye).collect();
        self.screens.iter().fold(clipped(&target, &exact(self.normal)), |seen, screen| {
            let [a, b, c] = [0, 1, 2].map(|k| from_eye(&screen[k]));
            let edge = cross(&a, &b);
            // The screen's third corner is on the side that is hidden.
            let outside = if dot(&edge, &c).is_positive() { edge.map(|x| -x) } else { edge };
            clipped(&seen, &outside)
        })
    }

    fn check(&self) -> Result<f64, TestCaseError> {
        let expected = form_factor(&self.seen(), &exact(self.normal));
        let mut polygons = vec![self.target.clone()];
        polygons.extend(self.screens.iter().cloned());
        for factors in both_ways(&scene(&polygons), self.eye, self.normal) {
            let factor = of(&factors, 0);
            prop_assert!(
                (factor - expected).abs() <= ALLOWED * expected.max(1e-15),
                "{factor:e}, not {expected:e}: {:e}",
                factor / expected - 1.0
            );
        }
        Ok(expected)
    }
}

fn vector(range: f64) -> impl Strategy<Value = DVec3> {
    prop::array::uniform3(-range..range).prop_map(DVec3::from)
}

/// A triangle about `axis` at a distance, and up to two screens one unit away with an edge through it.
fn case() -> impl Strategy<Value = Case> {
    let screens = prop::collection::vec((vector(0.3), vector(1.0), any::<bool>(), 0.3..3.0f64), 0..3);
    (vector(10.0), vector(1.0), prop::array::uniform3(vector(1.0)), -7.3..-2.0f64, -3.0..4.0f64, screens, vector(1.0))
        .prop_filter_map("a triangle that is seen", |(eye, axis, corners, size, distance, screens, normal)| {
            let axis = axis.try_normalize().filter(|_| axis.length() > 0.1)?;
            let (size, distance) = (10f64.powf(size), 10f64.powf(distance));
            // Its corners keep as many digits as they can next to the eye.
            let target: Vec<DVec3> = corners.iter().map(|&c| eye + (axis + c * size) * distance).collect();
            let flat = (target[1] - target[0]).cross(target[2] - target[0]);
            let facing = flat.normalize_or_zero().dot(axis).abs();
            let size_squared = (size * distance).powi(2);
            if facing < 0.05 || flat.length() < 0.1 * size_squared || normal.length() < 0.1 {
                return None;
            }
            let screens = screens.into_iter().map(|(middle, along, swap, near)| {
                let across = axis.cross(along).normalize_or_zero() * if swap { 1.0 } else { -1.0 };
                let along = across.cross(axis);
                // Closer than the target, and larger by far.
                let near = near.min(0.3) * distance;
                let on = eye + (axis + middle * size) * near;
                vec![on - along * near, on + along * near, on + (across * 2.0 + axis * 0.3) * near]
            });
            Some(Case { eye, normal, target, screens: screens.collect() })
        })
        .prop_filter("something is seen", |case| {
            let towards = case.target[0] - case.eye;
            case.normal.dot(towards) > 0.0 && case.seen().len() >= 3
        })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(512))]

    #[test]
    fn small_parts_between_crossings_are_right_to_nine_digits(case in case()) {
        case.check()?;
    }
}

/// A square of that size at a distance, its lower half hidden by a slanted screen, over a horizon just below it.
fn low(size: f64, distance: f64, height: f64) -> Case {
    let eye = DVec3::new(0.1, -0.3, 0.7);
    let at = |y: f64, z: f64| eye + DVec3::new(distance, y * distance, z * distance);
    let target = [(-size, height), (size, height), (size, height + size), (-size, height + size)];
    let near = |y: f64, z: f64| eye + DVec3::new(1.0, y, z) * (0.01 * distance);
    let middle = height + size / 2.0;
    let screen = vec![near(-2.0, middle - size / 3.0), near(1.0, middle + size / 7.0), near(-0.3, -3.0)];
    Case {
        eye,
        normal: DVec3::new(0.0, 0.0, 2.5),
        target: target.map(|(y, z)| at(y, z)).to_vec(),
        screens: vec![screen],
    }
}

#[test]
fn what_rises_a_little_above_the_horizon_is_right_to_nine_digits() {
    let mut least = f64::INFINITY;
    for distance in [1.0, 1e3, 1e6] {
        for size in [1e-2, 1e-4, 1e-5] {
            for height in [0.0, 1e-3, -0.3 * size] {
                least = least.min(low(size, distance, height).check().unwrap_or_else(|error| panic!("{error}")));
            }
        }
    }
    assert!(least < 1e-14, "{least:e}");
}

#[test]
fn a_far_tiny_polygon_cut_by_two_screens_is_right_to_nine_digits() {
    // 3e-8 of a radian: a factor of about 1e-16 to 1e-15, of which a quarter is seen.
    let eye = DVec3::new(1.0 / 3.0, 0.2, -0.7);
    let corner = |x: f64, y: f64| eye + DVec3::new(x * 3e-5, y * 3e-5, 1000.0);
    let target = vec![corner(-1.0, -1.0), corner(1.0, -0.9), corner(1.1, 1.0), corner(-1.0, 1.2)];
    let near = |x: f64, y: f64| eye + DVec3::new(x, y, 3.0);
    let screens = vec![
        vec![near(1e-8, -1.0), near(-2e-8, 1.0), near(-1.0, 0.1)],
        vec![near(-1.0, 3e-9), near(1.0, -1e-8), near(0.2, -1.0)],
    ];
    let case = Case { eye, normal: DVec3::new(0.2, 0.1, 1.0), target, screens };
    let expected = case.check().unwrap_or_else(|error| panic!("{error}"));
    assert!((1e-16..1e-14).contains(&expected), "{expected:e}");
}

#[test]
fn above_a_slanted_floor_its_exact_plane_is_the_horizon() {
    let floor = vec![DVec3::new(0.1, 0.2, 0.05), DVec3::new(3.3, 0.1, 0.4), DVec3::new(0.3, 2.9, -0.2)];
    let [along, across] = [floor[1] - floor[0], floor[2] - floor[0]];
    let up = along.cross(across).normalize();
    let near = floor.iter().sum::<DVec3>() / 3.0;
    for (distance, width, height) in [(10.0, 1e-2, 1e-3), (1e3, 1e-2, 1e-5), (1e5, 1e-3, 1e-5), (1e3, 0.03, 1e-6)] {
        // From below the horizon to above it; narrow, as the reference is cubature.
        let at = |y: f64, z: f64| near + (along.normalize() + across.normalize() * y + up * z) * distance;
        let target = vec![at(-width, -height), at(width, -height), at(width, height), at(-width, 2.0 * height)];
        let scene = scene(&[floor.clone(), target.clone()]);
        let viewpoint = Viewpoint::on_surface(&scene, PolygonId(0), Side::Front, near).expect("a floor");
        let corners = [0, 1, 2].map(|k| exact(floor[k]));
        let normal = cross(&minus(&corners[1], &corners[0]), &minus(&corners[2], &corners[0]));
        let from_eye: Vec<_> = target.iter().map(|&p| minus(&exact(p), &exact(viewpoint.eye()))).collect();
        let expected = form_factor(&clipped(&from_eye, &normal), &normal);
        let bsp = SceneBsp::build(&scene, &BspOptions::default()).expect("a small scene");
        for order in [SceneOrder::new(&scene), bsp.into()] {
            let factors = PointSolver::new(order, By::Polygon).solve(&viewpoint, &Domain::Above).expect("a view");
            assert_eq!(factors.on, Some(PolygonId(0)));
            let factor = of(&factors, 1);
            assert!((factor - expected).abs() <= ALLOWED * expected.max(1e-15), "{factor:e}, not {expected:e}");
        }
    }
}
