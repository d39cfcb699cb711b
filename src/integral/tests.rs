//! The integrals against closed forms and against cubature in a plane chart.

use super::brute::gauss;
use super::{UnitDirection, form_factor, form_factor_of_units, solid_angle, solid_angle_of_units};
use glam::DVec3;
use num_rational::BigRational;
use num_traits::ToPrimitive;
use proptest::prelude::*;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

fn close(value: f64, expected: f64, error: f64) {
    assert!((value - expected).abs() <= error, "{value:e} instead of {expected:e}: off by {:e}", value - expected);
}

/// A polygon in the plane z = 1 and integrals over it: every number in it is exact, so this knows
/// nothing of differences of unit vectors.
struct Chart {
    points: Vec<[f64; 2]>,
}

impl Chart {
    fn regular(count: usize, centre: [f64; 2], size: f64, aspect: f64) -> Self {
        let points = (0..count).map(|k| {
            let (sin, cos) = (0.3 + k as f64 * TAU / count as f64).sin_cos();
            [centre[0] + 0.5 * size * cos, centre[1] + 0.5 * size * aspect * sin]
        });
        Self { points: points.collect() }
    }

    fn directions(&self) -> Vec<DVec3> {
        self.points.iter().map(|&[x, y]| DVec3::new(x, y, 1.0)).collect()
    }

    fn integrate(&self, f: impl Fn(DVec3) -> f64) -> f64 {
        let exact = |x: f64| BigRational::from_float(x).unwrap();
        let [a, rest @ ..] = &self.points[..] else {
            return 0.0;
        };
        let mut sum = 0.0;
        for pair in rest.windows(2) {
            let [b, c] = [pair[0], pair[1]];
            let side = |p: [f64; 2], k: usize| exact(p[k]) - exact(a[k]);
            let double_area = side(b, 0) * side(c, 1) - side(b, 1) * side(c, 0);
            let mut mean = 0.0;
            for (s, weight_s) in gauss() {
                for (t, weight_t) in gauss() {
                    // The square collapsed onto the triangle.
                    let [u, v] = [s * (1.0 - t), s * t];
                    let at = |k: usize| a[k] + u * (b[k] - a[k]) + v * (c[k] - a[k]);
                    mean += weight_s * weight_t * s * f(DVec3::new(at(0), at(1), 1.0));
                }
            }
            sum += mean * double_area.to_f64().unwrap();
        }
        sum
    }

    fn solid_angle(&self) -> f64 {
        self.integrate(|p| p.length_squared().powf(-1.5))
    }

    fn form_factor(&self, normal: DVec3) -> f64 {
        self.integrate(|p| normal.dot(p) * p.length_squared().powi(-2)) / PI / normal.length()
    }
}

#[test]
fn octants_are_an_eighth_of_the_sphere() {
    let [x, y, z] = [DVec3::X, DVec3::Y, DVec3::Z];
    close(solid_angle(&[x, y, z]), FRAC_PI_2, 3e-16);
    close(solid_angle(&[-x, y, -z]), FRAC_PI_2, 3e-16);
    for normal in [x, y, z] {
        close(form_factor(&[x, y, z], normal), 0.25, 1e-16);
    }
    assert!(solid_angle(&[x, z, y]) <= 0.0, "turned the wrong way");
}

#[test]
fn hemispheres_are_whole_however_they_are_written() {
    for count in 3..40 {
        let rim: Vec<DVec3> = (0..count)
            .map(|k| (0.1 + k as f64 * TAU / count as f64).sin_cos())
            .map(|(sin, cos)| DVec3::new(cos, sin, 0.0))
            .collect();
        close(solid_angle(&rim), TAU, 4e-15);
        close(form_factor(&rim, DVec3::Z), 1.0, 1e-15);
    }
    // Three vertices, two of them almost antipodal.
    let rim = |angle: f64| DVec3::new(angle.cos(), angle.sin(), 0.0);
    for gap in [1e-1, 1e-3, 1e-6, 1e-9, 1e-12] {
        let triangle = [rim(0.0), rim(PI - gap), rim(PI + 1.0)];
        close(solid_angle(&triangle), TAU, 1e-14);
        close(form_factor(&triangle, DVec3::Z), 1.0, 1e-14);
    }
}

#[test]
fn lunes_have_twice_their_angle() {
    for angle in [3.0, 2.0, 1.0, 0.1, 1e-3, 1e-6, 1e-9] {
        let side = |azimuth: f64| DVec3::new(f64::cos(azimuth), f64::sin(azimuth), 0.0);
        let lune = [DVec3::Z, side(0.0), -DVec3::Z, side(angle)];
        close(solid_angle(&lune), 2.0 * angle, 4e-15);
        // Lambert on a lune seen from the pole of its first half circle.
        close(form_factor(&lune, DVec3::Y), (1.0 - angle.cos()) / 2.0, 1e-15);
    }
}

#[test]
fn polygons_inscribed_in_a_cap() {
    for count in [3, 4, 5, 12, 100] {
        for radius in [1.5, 1.0, 0.3, 1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-8] {
            let step = TAU / count as f64;
            let boundary: Vec<DVec3> = (0..count)
                .map(|k| (k as f64 * step).sin_cos())
                .map(|(sin, cos)| DVec3::new(cos, sin, 1.0 / f64::tan(radius)))
                .collect();
            let square = (radius / 2.0).tan().powi(2);
            let omega = 2.0 * count as f64 * (square * step.sin()).atan2(1.0 + square * step.cos());
            close(solid_angle(&boundary), omega, 2e-15 * omega);
            let arc = 2.0 * (radius.sin() * (step / 2.0).sin()).asin();
            let factor = count as f64 / TAU * arc / arc.sin() * radius.sin().powi(2) * step.sin();
            close(form_factor(&boundary, DVec3::Z), factor, 2e-15 * factor);
        }
    }
}

#[test]
fn rectangle_above_a_parallel_element() {
    for [x, y] in [[1.0, 1.0], [0.1, 3.0], [20.0, 30.0], [1e-3, 2e-3], [1e-6, 1e-6], [1e5, 1e5]] {
        let corner = |x, y| DVec3::new(x, y, 1.0);
        let rectangle = [corner(0.0, 0.0), corner(x, 0.0), corner(x, y), corner(0.0, y)];
        let [p, q] = [x.hypot(1.0), y.hypot(1.0)];
        let factor = ((y / p).atan() * x / p + (x / q).atan() * y / q) / TAU;
        close(form_factor(&rectangle, DVec3::Z), factor, 1e-15 * factor);
        let omega = (x * y / (1.0 + x * x + y * y).sqrt()).atan();
        close(solid_angle(&rectangle), omega, 1e-15 * omega);
    }
}

/// Compares with cubature. Gives the worst relative error, and checks the stated one.
fn check_against_cubature(chart: &Chart, normal: DVec3) -> f64 {
    let directions = chart.directions();
    let unit: Vec<DVec3> = directions.iter().map(|v| v.normalize()).collect();
    let perimeter: f64 = (0..unit.len()).map(|k| unit[k].distance(unit[(k + 1) % unit.len()])).sum();
    let diameter = unit.iter().flat_map(|a| unit.iter().map(|b| a.distance(*b))).fold(0.0, f64::max);
    // The reference is good to about 5e-16 of its value itself.
    let [omega, factor] = [chart.solid_angle(), chart.form_factor(normal)];
    let [near_omega, near_factor] = [solid_angle(&directions), form_factor(&directions, normal)];
    close(near_omega, omega, 4e-16 * (omega + perimeter * diameter) + 5e-16 * omega);
    close(near_factor, factor, 2e-16 * (factor + perimeter * diameter) + 5e-16 * factor);
    (near_omega / omega - 1.0).abs().max((near_factor / factor - 1.0).abs())
}

#[test]
fn small_polygons_keep_their_digits() {
    for exponent in -100..=-2 {
        let size = 10_f64.powf(f64::from(exponent) / 10.0);
        for (count, centre, aspect) in
            [(3, [0.0, 0.0], 1.0), (4, [0.3, -0.7], 1.0), (7, [-1.1, 0.2], 0.3), (5, [0.5, 0.5], 0.05)]
        {
            let chart = Chart::regular(count, centre, size, aspect);
            let worst = check_against_cubature(&chart, DVec3::new(0.4, -0.2, 1.3));
            assert!(worst < 2e-15, "{worst:e} at {size:e}");
        }
    }
}

#[test]
fn slivers_keep_the_stated_error() {
    for aspect in [1e-3, 1e-6, 1e-9, 1e-12] {
        for size in [0.3, 1e-3, 1e-6] {
            check_against_cubature(&Chart::regular(5, [0.4, 0.1], size, aspect), DVec3::Z);
        }
    }
}

#[test]
fn lengths_of_directions_do_not_matter() {
    let chart = Chart::regular(5, [0.2, -0.1], 1e-6, 0.5);
    let plain = chart.directions();
    let scales = [1.0, 2_f64.powi(-900), 2_f64.powi(900), 2_f64.powi(40), 2_f64.powi(-7)];
    let scaled: Vec<DVec3> = plain.iter().zip(scales).map(|(&v, scale)| v * scale).collect();
    close(solid_angle(&scaled), solid_angle(&plain), 1e-30);
    close(form_factor(&scaled, DVec3::Z), form_factor(&plain, DVec3::Z * 1e300), 1e-30);
    let tiny = DVec3::new(0.0, 5e-324, 0.0);
    close(solid_angle(&[DVec3::X, tiny, DVec3::Z * 1e308]), FRAC_PI_2, 3e-16);
}

#[test]
fn double_double_vertices_carry_more_than_rounded_ones() {
    // A square of size 1e-9 around a direction that f64 cannot hold, and its corners as sums.
    let axis = DVec3::new(1.0 / 3.0, 2.0 / 7.0, 0.9).normalize();
    let [u, v] = [axis.any_orthonormal_pair().0, axis.any_orthonormal_pair().1];
    let size = 1e-9;
    let corners = [-u - v, u - v, u + v, v - u].map(|c| UnitDirection::from_sum(axis, c * (0.5 * size)));
    let mut corners = corners.map(Option::unwrap);
    if u.cross(v).dot(axis) < 0.0 {
        corners.reverse();
    }
    let omega = solid_angle_of_units(&corners);
    close(omega, size * size, 2e-15 * size * size);
    close(form_factor_of_units(&corners, axis) * PI, size * size, 2e-15 * size * size);
}

#[test]
fn degenerate_boundaries_are_numbers() {
    let [x, y, z] = [DVec3::X, DVec3::Y, DVec3::Z];
    let bad = [DVec3::ZERO, DVec3::splat(f64::NAN), DVec3::new(f64::INFINITY, 0.0, 1.0)];
    let boundaries: [&[DVec3]; 10] =
        [&[], &[x], &[x, x], &[x, y], &[x, -x], &[x, x, y, y, x], &[x, -x, y], &[x, y, -x, -y], &bad, &[x, y, -x, y]];
    for boundary in boundaries {
        for value in [solid_angle(boundary), form_factor(boundary, z), form_factor(boundary, bad[1])] {
            assert!((0.0..=TAU + 1e-14).contains(&value), "{boundary:?}: {value}");
        }
    }
    close(solid_angle(&[x, x, y, y, z, z, x]), FRAC_PI_2, 3e-16);
    close(solid_angle(&[bad[0], x, bad[1], y, bad[2], z]), FRAC_PI_2, 3e-16);
    close(form_factor(&[x, x, y, y, z, z, x], z), 0.25, 1e-16);
}

#[test]
fn a_tessellated_hemisphere_adds_up_to_one() {
    for (rings, sectors) in [(1, 3), (2, 5), (20, 40), (200, 300)] {
        let at = |ring: usize, sector: usize| {
            let (sin, cos) = (ring as f64 / rings as f64 * FRAC_PI_2).sin_cos();
            let (sin_azimuth, cos_azimuth) = ((sector % sectors) as f64 / sectors as f64 * TAU).sin_cos();
            let height = if ring == rings { 0.0 } else { cos };
            DVec3::new(sin * cos_azimuth, sin * sin_azimuth, height)
        };
        let mut sums = [0.0; 2];
        for ring in 0..rings {
            let mut ring_sums = [0.0; 2];
            for sector in 0..sectors {
                let cell = [at(ring, sector), at(ring + 1, sector), at(ring + 1, sector + 1), at(ring, sector + 1)];
                ring_sums[0] += solid_angle(&cell);
                ring_sums[1] += form_factor(&cell, DVec3::Z);
            }
            sums = [sums[0] + ring_sums[0], sums[1] + ring_sums[1]];
        }
        close(sums[0], TAU, 1e-13);
        close(sums[1], 1.0, 1e-14);
    }
}

fn triangle(size: f64) -> impl Strategy<Value = [DVec3; 3]> {
    let axis = prop::array::uniform3(-1.0..1.0_f64).prop_map(DVec3::from);
    let offset = || prop::array::uniform3(-1.0..1.0_f64).prop_map(DVec3::from);
    (axis, offset(), offset(), offset()).prop_filter_map("a flat triangle", move |(axis, a, b, c)| {
        let axis = axis.try_normalize()?;
        let [a, b, c] = [a, b, c].map(|v| axis + size * v);
        let determinant = a.dot((b - a).cross(c - a));
        (determinant.abs() > 1e-3 * size * size).then_some(if determinant > 0.0 { [a, b, c] } else { [a, c, b] })
    })
}

proptest! {
    #[test]
    fn parts_add_up(exponent in -3.0..-0.3_f64, [a, b, c] in triangle(1.0), s in 0.0..1.0_f64, t in 0.0..1.0_f64) {
        // Shrunk about its first vertex; b' and c' are rounded, which changes nothing below.
        let size = 10_f64.powf(exponent);
        let [b, c] = [a + size * (b - a), a + size * (c - a)];
        // A point within, up to rounding, and the three triangles around it. The rounding of the
        // point moves it by an ulp, which the three areas make up for among themselves.
        let u = s * (1.0 - t);
        let v = s * t;
        let p = a + u * (b - a) + v * (c - a);
        let whole = solid_angle(&[a, b, c]);
        let parts = solid_angle(&[a, b, p]) + solid_angle(&[b, c, p]) + solid_angle(&[c, a, p]);
        // Seen from close by, the polygon is larger than its size: the stated error has a share of the value.
        let allowed = 1e-14 * size * size.max(1e-2) + 1e-15 * (size + whole);
        prop_assert!((parts - whole).abs() < allowed, "{parts:e} {whole:e}");
        let axis = (a + b + c).normalize();
        // Form factors are of polygons above the horizon.
        prop_assume!([a, b, c].into_iter().all(|v| v.dot(axis) >= 0.0));
        let whole = form_factor(&[a, b, c], axis);
        let parts = form_factor(&[a, b, p], axis) + form_factor(&[b, c, p], axis) + form_factor(&[c, a, p], axis);
        prop_assert!((parts - whole).abs() < 1e-15 * (size + whole), "{parts:e} {whole:e}");
    }

    #[test]
    fn turning_the_list_changes_nothing(size in 1e-6..1.0_f64, [a, b, c] in triangle(1.0)) {
        let [b, c] = [a + size * (b - a), a + size * (c - a)];
        let first = solid_angle(&[a, b, c]);
        prop_assert!((first - solid_angle(&[b, c, a])).abs() < 2e-15 * (first + size * size * 4.0));
        let factor = form_factor(&[a, b, c], a);
        prop_assert!((factor - form_factor(&[b, c, a], a)).abs() < 2e-15 * (factor + size * size * 4.0));
    }

    #[test]
    fn anything_gives_a_number(
        boundary in prop::collection::vec(prop::array::uniform3(prop::num::f64::ANY).prop_map(DVec3::from), 0..7),
        normal in prop::array::uniform3(prop::num::f64::ANY).prop_map(DVec3::from),
    ) {
        prop_assert!(solid_angle(&boundary) >= 0.0);
        prop_assert!(form_factor(&boundary, normal) >= 0.0);
    }
}
