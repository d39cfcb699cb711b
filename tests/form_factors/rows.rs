//! What holds of all rows.

use super::cases::{cuboid, rectangle, scene_of};
use super::{all_rows, city, exchange, factor};
use glam::DVec3;
use nusselt::contour::{Domain, SceneOrder, ViewOptions, Viewpoint};
use nusselt::factors::{Exchange, ExchangeError, ExchangeOptions, PatchPlan, Row, Sides};
use nusselt::samples::{Kind, generate};
use nusselt::scene::{Material, PolygonId, Scene, Side};

#[test]
fn rows_close_in_generated_scenes() {
    for kind in Kind::ALL {
        let scene = generate(kind, 300, 3).expect("a scene").to_builder().build().expect("sound");
        let exchange = exchange(&scene, PatchPlan::Polygons, 1e-3);
        for patch in (0..exchange.patches().len()).step_by(17) {
            let row = exchange.row(patch).expect("a row");
            assert!((row.sum() - 1.0).abs() <= 1e-12, "{kind:?} {patch}: {}", row.sum());
            assert!(row.entries.iter().all(|entry| entry.share.factor > 0.0 && entry.share.error <= 1e-3));
            assert!(row.entries.windows(2).all(|pair| pair[0].column < pair[1].column));
        }
    }
}

/// Factors by views of the scene itself from a grid of points on a polygon, which is a parallelogram.
fn by_many_views(scene: &Scene, order: &SceneOrder, polygon: PolygonId, side: usize) -> Vec<f64> {
    let ring: Vec<DVec3> = scene.polygon(polygon).pieces().next().expect("an area").points().collect();
    let at = |k: usize| (k as f64 + 0.5) / side as f64;
    let points = (0..side * side).map(|k| ring[0].lerp(ring[1], at(k % side)) + (ring[3] - ring[0]) * at(k / side));
    let eyes = points.map(|p| (Viewpoint::on_surface(scene, polygon, Side::Front, p).expect("on it"), Domain::Above));
    let eyes: Vec<_> = eyes.collect();
    let views = order.views(&eyes, &ViewOptions::default(), |_, image| image.form_factors().expect("a hemisphere"));
    let mut factors = vec![0.0; scene.polygon_count()];
    for sums in views.expect("views") {
        for sum in sums.polygons {
            factors[sum.polygon.index()] += sum.front / (side * side) as f64;
        }
    }
    factors
}

#[test]
fn entries_of_a_city_are_within_the_tolerance_of_many_views() {
    let scene = city::city(3).expect("a city");
    let order = SceneOrder::new(&scene);
    let tolerance = 1e-3;
    let exchange = exchange(&scene, PatchPlan::Polygons, tolerance);
    for patch in (0..exchange.patches().len()).step_by(11) {
        let row = exchange.row(patch).expect("a row");
        let expected = by_many_views(&scene, &order, PolygonId(patch as u32), 24);
        assert!((row.sum() - 1.0).abs() <= 1e-12);
        for (column, expected) in expected.into_iter().enumerate() {
            let found = factor(&row, column as u32);
            // 576 points in a grid are off by a few ten-thousandths where light is cut by edges; what is placed of a residue is within the estimate.
            assert!((found - expected).abs() <= tolerance, "{patch} {column}: {found} instead of {expected}");
        }
    }
}

#[test]
fn what_is_seen_through_a_gap_only_is_found() {
    // A wall at the end of a city, over the roofs and from a wedge of a twelfth of a square, on which no point of a rule lies.
    let scene = city::city(6).expect("a city");
    let [square, wall] = [153, 372];
    let expected = by_many_views(&scene, &SceneOrder::new(&scene), PolygonId(square as u32), 48)[wall];
    let tolerance = 1e-6;
    // The views' midpoint rule is off by the jump at the wedge's sides over a cell's width: a tenth of it at most.
    assert!((1.6e-6..2.0e-6).contains(&expected), "{expected:e}");
    let exchange = exchange(&scene, PatchPlan::Polygons, tolerance);
    let found = factor(&exchange.row(square).expect("a row"), wall as u32);
    assert!((found - expected).abs() < 0.2 * tolerance, "{found:e} instead of {expected:e}");
    // Once more, by points on either patch, each within the tolerance of a factor from there.
    let patches = exchange.patches();
    for [from, to] in [[square, wall], [wall, square]] {
        let again = exchange.by_points(from, to).expect("patches").expect("both are alone");
        let there = found * patches[square].area / patches[from].area;
        assert!((again.factor - there).abs() < tolerance, "{from}: {again:?} instead of {there:e}");
    }
    assert!(exchange.by_points(square, patches.len()).is_err());
}

#[test]
fn rows_are_the_same_bits_for_any_number_of_threads_and_in_any_order() {
    let scene = city::city(2).expect("a city");
    let exchange = exchange(&scene, PatchPlan::Polygons, 1e-3);
    let in_order = |threads: usize| {
        let mut rows = Vec::new();
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        let run = || {
            exchange.rows(0..exchange.patches().len(), |row| {
                rows.push(row);
                Ok::<(), ExchangeError>(())
            })
        };
        pool.install(run).expect("rows");
        rows
    };
    let one = in_order(1);
    assert_eq!(one, in_order(3));
    let backwards: Vec<Row> = (0..one.len()).rev().map(|patch| exchange.row(patch).expect("a row")).collect();
    assert!(one.iter().eq(backwards.iter().rev()));
}

#[test]
fn rows_are_the_same_bits_whichever_are_computed_together() {
    // Around a turned box in the air, and one that stands on the floor and touches a wall: in a mesh much is told of many patches at once.
    let (sin, cos) = 0.5_f64.sin_cos();
    let turned = |[x, y, z]: [f64; 3]| [2.1 + cos * x - sin * y, 1.4 + sin * x + cos * y, z];
    let mut quads = cuboid([0.; 3], [4., 3., 2.5], true);
    let of_turned = cuboid([-0.6, -0.5, 0.4], [0.6, 0.5, 1.4], false);
    quads.extend(of_turned.into_iter().map(|face| face.into_iter().map(turned).collect::<Vec<_>>()));
    quads.extend(cuboid([0.0, 1.0, 0.0], [0.5, 2.0, 1.0], false));
    let scene = scene_of(&quads);
    let exchange = exchange(&scene, PatchPlan::Mesh { longest_edge: 0.4 }, 1e-3);
    let rows_of = |range: std::ops::Range<usize>| {
        let mut rows = Vec::new();
        let taken = exchange.rows(range, |row| {
            rows.push(row);
            Ok::<(), ExchangeError>(())
        });
        taken.expect("rows");
        rows
    };
    let count = exchange.patches().len();
    let all = rows_of(0..count);
    assert!(count > 500 && all.len() == count);
    for range in [count / 3..count / 2, count / 2..count] {
        assert!(rows_of(range.clone()) == all[range.clone()], "{range:?}");
    }
    for patch in (0..count).step_by(7) {
        assert_eq!(exchange.row(patch).expect("a row"), all[patch], "{patch}");
    }
}

#[test]
fn objects_see_themselves_and_columns_of_polygons_add_up_to_theirs() {
    let mut builder = Scene::builder();
    let material = builder.add_material(Material::new("grey"));
    for (name, faces) in [("outer", cuboid([0.; 3], [3.; 3], true)), ("inner", cuboid([1.; 3], [2.; 3], false))] {
        let object = builder.add_object(name);
        for face in faces {
            let ring = face.iter().map(|&p| builder.add_vertex(p.into())).collect();
            builder.add_face(nusselt::scene::FaceSpec { rings: vec![ring], object, material });
        }
    }
    let scene = builder.build().expect("two cubes");
    let exchange = exchange(&scene, PatchPlan::Objects, 1e-6);
    let names: Vec<&str> = exchange.patches().iter().map(|patch| patch.name.as_str()).collect();
    assert_eq!(names, ["outer", "inner"]);
    assert!((exchange.patches()[0].area - 54.0).abs() < 1e-13);
    let rows = all_rows(&exchange);
    assert!((factor(&rows[0], 1) - 1.0 / 9.0).abs() <= 1e-6 && (factor(&rows[0], 0) - 8.0 / 9.0).abs() <= 1e-6);
    assert!((factor(&rows[1], 0) - 1.0).abs() <= 1e-12 && factor(&rows[1], 1) == 0.0);
}

#[test]
fn backs_are_apart_unless_they_count_as_fronts() {
    let below = rectangle([0.; 3], [1., 0., 0.], [0., 1., 0.]);
    // Turned away.
    let above = rectangle([0., 0., 1.], [1., 0., 0.], [0., 1., 0.]);
    let scene = scene_of(&[below, above]);
    let expected = super::references::opposed(1.0, 1.0, 1.0);
    for sides in [Sides::Fronts, Sides::Both] {
        let options = ExchangeOptions { tolerance: 1e-6, sides, ..ExchangeOptions::default() };
        let row = Exchange::new(&scene, PatchPlan::Polygons, options).expect("options").row(0).expect("a row");
        let (front, backs) = if sides == Sides::Both { (expected, 0.0) } else { (0.0, expected) };
        assert!((factor(&row, 1) - front).abs() <= 1e-6 && (row.backs.factor - backs).abs() <= 1e-6, "{row:?}");
        assert!((row.background.factor - (1.0 - expected)).abs() <= 1e-6);
    }
}

#[test]
fn of_polygons_on_each_other_the_one_that_views_show_gets_the_light() {
    let below = rectangle([0.; 3], [1., 0., 0.], [0., 1., 0.]);
    let above = rectangle([0., 0., 1.], [0., 1., 0.], [1., 0., 0.]);
    let turned: Vec<[f64; 3]> = above.iter().rev().copied().collect();
    // A back, a front, and the front once more: the first front wins.
    let scene = scene_of(&[below, turned, above.clone(), above]);
    let row = exchange(&scene, PatchPlan::Polygons, 1e-6).row(0).expect("a row");
    assert!((factor(&row, 2) - super::references::opposed(1.0, 1.0, 1.0)).abs() <= 1e-6);
    assert!(factor(&row, 1) == 0.0 && factor(&row, 3) == 0.0 && row.backs.factor == 0.0, "{row:?}");
}

#[test]
fn polygons_keep_their_numbers_when_folded_concave_or_without_area() {
    // An L of one polygon under a ceiling, a fold, and a polygon that is a line.
    let l = vec![[0., 0., 0.], [2., 0., 0.], [2., 1., 0.], [1., 1., 0.], [1., 2., 0.], [0., 2., 0.]];
    let fold = vec![[3., 0., 0.], [4., 0., 1.], [3., 1., 0.], [2.9, 0.5, 1.]];
    let line = vec![[0., 0., 1.], [1., 0., 1.], [2., 0., 1.]];
    let ceiling = rectangle([0., 0., 1.5], [0., 2., 0.], [2., 0., 0.]);
    let scene = scene_of(&[l, fold, line, ceiling]);
    let exchange = exchange(&scene, PatchPlan::Polygons, 1e-5);
    let areas: Vec<f64> = exchange.patches().iter().map(|patch| patch.area).collect();
    assert!((areas[0] - 3.0).abs() < 1e-15 && areas[2] == 0.0 && (areas[3] - 4.0).abs() < 1e-15);
    let rows = all_rows(&exchange);
    assert!(rows[2].entries.is_empty() && rows[2].sum() == 0.0);
    for k in [0, 1, 3] {
        assert!((rows[k].sum() - 1.0).abs() <= 1e-12, "{:?}", rows[k]);
    }
    let (there, back) = (factor(&rows[0], 3), factor(&rows[3], 0));
    assert!((areas[0] * there - areas[3] * back).abs() <= 1e-5 * 7.0, "{there} {back}");
}

#[test]
fn scale_does_not_matter_up_to_the_ends_of_f64() {
    let cube = cuboid([0.; 3], [1.; 3], true);
    let expected = exchange(&scene_of(&cube), PatchPlan::Polygons, 1e-8).row(0).expect("a row");
    for power in [-900, -300, 300, 900] {
        let scale = 2.0_f64.powi(power);
        let scaled: Vec<Vec<[f64; 3]>> =
            cube.iter().map(|face| face.iter().map(|p| p.map(|x| x * scale)).collect()).collect();
        let row = exchange(&scene_of(&scaled), PatchPlan::Polygons, 1e-8).row(0).expect("a row");
        assert_eq!(row, expected, "2^{power}");
    }
}

#[test]
fn what_cannot_be_is_refused_with_a_reason() {
    let scene = scene_of(&cuboid([0.; 3], [1.; 3], true));
    let new = |plan, tolerance| {
        let options = ExchangeOptions { tolerance, ..ExchangeOptions::default() };
        Exchange::new(&scene, plan, options).map(|_| ()).expect_err("not possible").to_string()
    };
    for tolerance in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(new(PatchPlan::Polygons, tolerance).contains("tolerance"), "{tolerance}");
    }
    for longest_edge in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(new(PatchPlan::Mesh { longest_edge }, 1e-3).contains("longest edge"), "{longest_edge}");
    }
    assert!(new(PatchPlan::Mesh { longest_edge: 1e-9 }, 1e-3).contains("4 million"));
    let exchange = exchange(&scene, PatchPlan::Polygons, 1e-3);
    assert_eq!(exchange.row(6), Err(ExchangeError::UnknownPatch { patch: 6, count: 6 }));
    assert!(exchange.rows(0..7, |_| Ok::<(), ExchangeError>(())).is_err());
}

#[test]
fn a_patch_that_is_lost_in_its_scene_is_refused_rather_than_without_area() {
    // Of area 1, beside one that is 1e100 long.
    let small = rectangle([0.; 3], [1., 0., 0.], [0., 1., 0.]);
    let long = rectangle([0., 0., 1.], [1e100, 0., 0.], [0., 1., 0.]);
    let scene = scene_of(&[small, long]);
    let new = |plan| Exchange::new(&scene, plan, ExchangeOptions::default()).map(|_| ());
    for plan in [PatchPlan::Polygons, PatchPlan::Objects] {
        let polygon = PolygonId(0);
        assert_eq!(new(plan), Err(ExchangeError::TooSmall { polygon }), "{plan:?}");
    }
}

#[test]
fn what_stands_on_a_patch_cuts_it_for_the_integral() {
    // A box without a bottom on a floor under a ceiling: from beneath it, all of its inside is seen, backs.
    let mut polygons = vec![rectangle([0.; 3], [1., 0., 0.], [0., 1., 0.])];
    polygons.extend(
        cuboid([0.21, 0.32, 0.0], [0.57, 0.73, 0.4], false).into_iter().filter(|face| face.iter().any(|p| p[2] > 0.0)),
    );
    let covered = 0.36 * 0.41;
    let scene = scene_of(&polygons);
    for tolerance in [1e-4, 1e-6] {
        let row = exchange(&scene, PatchPlan::Polygons, tolerance).row(0).expect("a row");
        assert!((row.backs.factor - covered).abs() <= tolerance && row.backs.error <= tolerance, "{row:?}");
    }
}
