//! All methods side by side: what the comparison tells against closed forms, counts by hand, and what each method gives by itself.

mod common;

use common::Faces;
use glam::DVec3;
use nusselt::bsp::{BspOptions, SceneBsp};
use nusselt::contour::{Domain, Viewpoint};
use nusselt::hemicube::{
    BaselineError, CompareError, ComparisonRow, Hemicube, Method, Rays, compare, reference_method,
};
use nusselt::samples::{Kind, cornell_box, generate};
use nusselt::scene::{PolygonId, Scene, Side};
use std::f64::consts::TAU;
use std::num::NonZeroUsize;

const ROUNDS: NonZeroUsize = NonZeroUsize::new(2).expect("not 0");
const UP: Domain = Domain::Hemisphere(DVec3::Z);

fn bsp(scene: &Scene) -> SceneBsp {
    SceneBsp::build(scene, &BspOptions::default()).expect("a small scene")
}

/// More views than are taken at a time.
fn room() -> (SceneBsp, Vec<(Viewpoint, Domain)>) {
    let mesh = generate(Kind::Room, 400, 5).expect("a size the generator takes");
    let scene = mesh.to_builder().build().expect("a generated scene is valid");
    let mut views: Vec<_> = mesh
        .free_points(24, 1)
        .into_iter()
        .map(|point| (Viewpoint::free(DVec3::from(point)), Domain::Hemisphere(DVec3::new(0.3, -0.1, 2.0))))
        .collect();
    let on = Viewpoint::on_surface(&scene, PolygonId(3), Side::Front, views[0].0.eye()).expect("a polygon with area");
    views.push((on, Domain::Above));
    (bsp(&scene), views)
}

fn exact(bsp: &SceneBsp, views: &[(Viewpoint, Domain)]) -> Vec<Vec<f64>> {
    let factors = |(viewpoint, domain): &(Viewpoint, Domain)| {
        let sums = bsp.view(viewpoint, domain).ok()?.form_factors()?;
        Some((0..bsp.scene().polygon_count() as u32).map(|k| sums.of(PolygonId(k))).collect())
    };
    views.iter().map(|view| factors(view).expect("a hemisphere")).collect()
}

/// Checks the errors and losses of a row, which are counted anew from the form factors of all views.
fn check_errors(row: &ComparisonRow, exact: &[Vec<f64>], found: &[Vec<f64>]) {
    let name = row.method;
    let pairs = || exact.iter().flatten().zip(found.iter().flatten());
    for (least, deviations) in [(1e-3, &row.above_1e3), (1e-4, &row.above_1e4)] {
        let mut errors: Vec<f64> = pairs().filter(|(e, _)| **e > least).map(|(e, f)| (f - e).abs() / e).collect();
        errors.sort_by(f64::total_cmp);
        assert_eq!(deviations.count(), errors.len(), "{name} above {least}");
        // So many in a hundred may be larger. Sizes are told to one part in 4096, the worst one as it is.
        for (larger, tolerance) in [(0, 1e-12), (1, 1.0 / 4096.0), (50, 1.0 / 4096.0)] {
            let expected = errors[errors.len() - 1 - larger * errors.len() / 100];
            let told = deviations.quantile(1.0 - larger as f64 / 100.0).expect("some are larger");
            let off = (told - expected).abs();
            assert!(off <= expected * tolerance + 1e-13, "{name} above {least}, {larger}%: {told} is not {expected}");
        }
        assert_eq!(deviations.visible(), pairs().filter(|(e, _)| **e > 0.0).count(), "{name}");
        assert_eq!(deviations.lost(), pairs().filter(|(e, f)| **e > 0.0 && **f <= 0.0).count(), "{name}");
    }
}

/// Of the form factors above 1e-4, of which there are some.
fn worst(row: &ComparisonRow) -> f64 {
    row.above_1e4.quantile(1.0).expect("some are larger")
}

/// The form factor of a rectangle parallel to the receiver, at a height, from above the receiver to x and y; of either sign.
fn ceiling(x: f64, y: f64, height: f64) -> f64 {
    let [x, y] = [x / height, y / height];
    let [p, q] = [x.hypot(1.0), y.hypot(1.0)];
    ((y / p).atan() * x / p + (x / q).atan() * y / q) / TAU
}

/// The form factor of a wall on the receiver's plane at that distance, from beside the receiver so far to one side, and so high.
fn wall(distance: f64, side: f64, height: f64) -> f64 {
    let slant = distance.hypot(height);
    ((side / distance).atan() - (side / slant).atan() * distance / slant) / TAU
}

/// A box of 4 x 3 x 2 around the origin at a height of 0.5 over its floor, with a ceiling of 12 x 12 rectangles, and the
/// form factors of its polygons from there, facing up.
fn box_with_closed_form() -> (Scene, Vec<f64>) {
    let [x, y, z] = [[-1.25, 2.75], [-2.0, 1.0], [-0.5, 1.5]];
    let mut faces = Faces::default();
    let mut factors = Vec::new();
    let at = |range: [f64; 2], k: usize| range[0] + (range[1] - range[0]) * k as f64 / 12.0;
    for (i, j) in (0..12).flat_map(|i| (0..12).map(move |j| (i, j))) {
        let [[a, b], [c, d]] = [[at(x, i), at(x, i + 1)], [at(y, j), at(y, j + 1)]];
        faces.face(&[[a, c], [a, d], [b, d], [b, c]].map(|[x, y]| DVec3::new(x, y, z[1])));
        let part = |x, y| ceiling(x, y, z[1]);
        factors.push(part(b, d) - part(a, d) - part(b, c) + part(a, c));
    }
    for (axis, range, [low, high]) in [(0, x, y), (1, y, x)] {
        for (distance, turned) in [(range[0], false), (range[1], true)] {
            let corner = |side: f64, z: f64| {
                if axis == 0 { DVec3::new(distance, side, z) } else { DVec3::new(side, distance, z) }
            };
            let mut corners = [corner(low, z[0]), corner(high, z[0]), corner(high, z[1]), corner(low, z[1])];
            if turned != (axis == 1) {
                corners.reverse();
            }
            faces.face(&corners);
            factors.push(wall(distance.abs(), high, z[1]) - wall(distance.abs(), low, z[1]));
        }
    }
    faces.face(&[[x[0], y[0]], [x[1], y[0]], [x[1], y[1]], [x[0], y[1]]].map(|[x, y]| DVec3::new(x, y, z[0])));
    factors.push(0.0);
    assert!((factors.iter().sum::<f64>() - 1.0).abs() < 1e-13, "closed forms of a closed box");
    (faces.build(), factors)
}

#[test]
fn errors_are_told_from_the_closed_forms_of_a_box() {
    let (scene, closed) = box_with_closed_form();
    let view = (Viewpoint::free(DVec3::ZERO), UP);
    let resolutions = [16, 64, 250];
    let mut methods = vec![Method::Contour, Method::ContourByBoxes];
    methods.extend(resolutions.map(|resolution| Method::Hemicube { resolution }));
    let rows = compare(&bsp(&scene), std::slice::from_ref(&view), &methods, ROUNDS, |_| ()).expect("good methods");
    let exact = [closed];
    assert_eq!((rows[0].above_1e4.visible(), rows[0].above_1e4.count()), (148, 148), "all but the floor");
    for (row, resolution) in rows[2..].iter().zip(resolutions) {
        let mut hemicube = Hemicube::new(&scene, resolution).expect("even");
        let found = hemicube.view(&view.0, DVec3::Z).expect("a normal").factors().to_vec();
        check_errors(row, &exact, &[found]);
        assert_eq!(row.evaluations, 3 * resolution * resolution);
    }
    let worst: Vec<_> = rows.iter().map(worst).collect();
    assert!(worst[0] == 0.0 && worst[1] < 1e-12, "both contour images are exact: {worst:?}");
    assert!(worst[2] > 0.2 && worst[4] < 0.5 * worst[2] && worst[4] > 1e-3, "a hemicube is not: {worst:?}");
}

#[test]
fn errors_losses_and_evaluations_are_those_of_the_methods() {
    let (bsp, views) = room();
    let scene = bsp.scene();
    let exact = exact(&bsp, &views);
    let mut hemicube = Hemicube::new(scene, 64).expect("even");
    let mut rays = Rays::new(scene);
    let mut found: [Vec<Vec<f64>>; 4] = [exact.clone(), Vec::new(), Vec::new(), Vec::new()];
    let mut evaluations = [0; 4];
    for (k, (viewpoint, domain)) in views.iter().enumerate() {
        let image = bsp.view(viewpoint, domain).expect("a finite eye");
        let normal = image.normal().expect("a hemisphere");
        evaluations[0] += image.cell_count();
        found[1].push(hemicube.view(viewpoint, normal).expect("a normal").factors().to_vec());
        evaluations[1] += 3 * 64 * 64;
        let view = hemicube.analytic(viewpoint, normal).expect("a normal");
        found[2].push(view.factors().to_vec());
        evaluations[2] += view.evaluations();
        found[3].push(rays.view(viewpoint, normal, 500, k as u64).expect("a normal").factors().collect());
    }
    let methods = [
        Method::Contour,
        Method::Hemicube { resolution: 64 },
        Method::Analytic { resolution: 64 },
        Method::Rays { rays: 500 },
    ];
    let mut done = 0;
    let rows = compare(&bsp, &views, &methods, ROUNDS, |count| done += count).expect("good methods");
    assert_eq!(done, views.len() * methods.len() * 2, "two rounds");
    for (((row, method), found), evaluations) in rows.iter().zip(methods).zip(&found).zip(evaluations) {
        assert_eq!(row.method, method);
        check_errors(row, &exact, found);
        assert_eq!(row.evaluations, evaluations, "{method}");
        assert!(row.view_ms.len() == views.len() && row.view_ms.iter().all(|&ms| ms > 0.0 && ms.is_finite()));
        assert!(row.median_ms() <= row.max_ms() && row.mean_ms() <= row.max_ms());
    }
    let lost: Vec<_> = rows.iter().map(|row| row.above_1e4.lost()).collect();
    assert!(lost[0] == 0 && lost[1] > 0 && lost[2] == lost[1] && lost[3] > lost[1], "{lost:?}");
}

#[test]
fn errors_of_hemicubes_fall_with_their_resolution() {
    let (bsp, views) = room();
    let methods = [16, 64, 256].map(|resolution| Method::Hemicube { resolution });
    let rows = compare(&bsp, &views, &methods, NonZeroUsize::MIN, |_| ()).expect("even");
    for pair in rows.windows(2) {
        for share in [0.5, 0.99] {
            let [coarse, fine] = [&pair[0], &pair[1]].map(|row| row.above_1e4.quantile(share).expect("some"));
            assert!(fine < 0.6 * coarse, "{}, {share}: {coarse} {fine}", pair[1].method);
        }
        assert!(pair[1].above_1e4.lost() < pair[0].above_1e4.lost());
    }
}

#[test]
fn both_contour_images_have_the_same_form_factors() {
    let (bsp, views) = room();
    let rows = compare(&bsp, &views, &[Method::Contour, Method::ContourByBoxes], ROUNDS, |_| ()).expect("methods");
    assert!(rows.iter().all(|row| row.above_1e4.count() > 1000 && row.above_1e4.lost() == 0));
    let [own, other] = [0, 1].map(|k| worst(&rows[k]));
    assert!(own == 0.0 && other < 1e-11, "{own} {other}");
}

#[test]
fn what_an_epsilon_leaves_uncut_is_an_error_of_the_bsp_and_not_of_the_others() {
    // Each pokes through the plane of the other; uncut, one of them is in front of the other everywhere.
    let mut faces = Faces::default();
    faces.face(&[[-1.0, -1.0, 1.0], [1.0, -1.0, 1.2], [1.0, 1.0, 1.2], [-1.0, 1.0, 1.0]].map(DVec3::from));
    faces.face(&[[-1.0, -1.0, 1.2], [1.0, -1.0, 1.0], [1.0, 1.0, 1.0], [-1.0, 1.0, 1.2]].map(DVec3::from));
    let scene = faces.build();
    let views = [(Viewpoint::free(DVec3::ZERO), UP)];
    let methods = [Method::Contour, Method::ContourByBoxes];
    for (epsilon, exact) in [(0.0, Method::Contour), (0.5, Method::ContourByBoxes)] {
        let bsp = SceneBsp::build(&scene, &BspOptions { epsilon, ..BspOptions::default() }).expect("a small scene");
        assert_eq!(reference_method(&bsp), exact);
        let rows = compare(&bsp, &views, &methods, NonZeroUsize::MIN, |_| ()).expect("methods");
        let [by_bsp, by_boxes] = [0, 1].map(|k| worst(&rows[k]));
        assert!(by_boxes < 1e-12 && (by_bsp > 0.1) == (epsilon > 0.0), "{epsilon}: {by_bsp} {by_boxes}");
    }
}

#[test]
fn a_polygon_between_pixels_is_lost_by_z_buffers_alone() {
    let square = |low: f64, high: f64| {
        let corners = [[low, low, 1.0], [high, low, 1.0], [high, high, 1.0], [low, high, 1.0]];
        corners.map(DVec3::from)
    };
    let mut faces = Faces::default();
    // The first one is seen in one pixel of a row of 16, and the second one lies between the centres of pixels.
    faces.face(&square(0.125, 0.25));
    faces.face(&square(0.001, 0.002));
    let bsp = bsp(&faces.build());
    let views = [(); 3].map(|()| (Viewpoint::free(DVec3::ZERO), UP));
    let methods = [
        Method::Contour,
        Method::ContourByBoxes,
        Method::Hemicube { resolution: 16 },
        Method::Analytic { resolution: 16 },
    ];
    let rows = compare(&bsp, &views, &methods, ROUNDS, |_| ()).expect("even");
    let lost: Vec<_> = rows.iter().map(|row| (row.above_1e4.lost(), row.above_1e4.visible())).collect();
    assert_eq!(lost, [(0, 6), (0, 6), (3, 6), (3, 6)]);
    // The tiny one is too small to count for errors; the other one fills a pixel.
    assert!(rows.iter().all(|row| row.above_1e4.count() == 3 && worst(row) < 1e-12));
    // Of 768 pixels one shows a polygon, which is wholly seen.
    assert_eq!([rows[2].evaluations, rows[3].evaluations], [3 * 768, 3 * (1 + 767)]);
}

#[test]
fn methods_are_named_with_their_resolution() {
    let methods = [
        Method::Contour,
        Method::ContourByBoxes,
        Method::Hemicube { resolution: 64 },
        Method::Analytic { resolution: 64 },
        Method::Rays { rays: 10 },
    ];
    let names = ["contour", "contour-boxes", "hemicube 64", "analytic 64", "rays 10"];
    assert_eq!(methods.map(|method| method.to_string()), names);
}

#[test]
fn without_views_or_methods_there_is_nothing_to_tell() {
    let bsp = bsp(&cornell_box().to_builder().build().expect("the Cornell box"));
    let rows = compare(&bsp, &[], &[Method::Contour], ROUNDS, |_| ()).expect("no views");
    assert!(rows[0].view_ms.is_empty() && rows[0].above_1e4.count() == 0);
    let times = [rows[0].mean_ms(), rows[0].median_ms(), rows[0].max_ms()];
    assert_eq!(times.map(f64::to_bits), [0; 3]);
    let view = (Viewpoint::free(DVec3::splat(100.0)), UP);
    assert!(compare(&bsp, &[view], &[], ROUNDS, |_| ()).expect("no methods").is_empty());
}

#[test]
fn what_cannot_be_compared_is_named() {
    let bsp = bsp(&cornell_box().to_builder().build().expect("the Cornell box"));
    let good = (Viewpoint::free(DVec3::new(278.0, 273.0, 1.0)), UP);
    // Beyond the views that are taken together first.
    let views = |last| [vec![good.clone(); 22], vec![last]].concat();
    let try_with = |view, method| compare(&bsp, &views(view), &[method], ROUNDS, |_| ()).expect_err("not compared");
    let odd = CompareError::Method(BaselineError::BadResolution { resolution: 7 });
    assert_eq!(try_with(good.clone(), Method::Analytic { resolution: 7 }), odd);
    assert_eq!(try_with(good.clone(), Method::Rays { rays: 0 }), CompareError::Method(BaselineError::NoRays));
    assert_eq!(try_with((good.0, Domain::Sphere), Method::Contour), CompareError::NoNormal { view: 22 });
    let nowhere = (Viewpoint::free(DVec3::NAN), UP);
    assert!(matches!(try_with(nowhere, Method::Contour), CompareError::Contour { view: 22, .. }));
    assert!(matches!(try_with((good.0, Domain::Above), Method::Contour), CompareError::Contour { view: 22, .. }));
}
