//! Metamorphic laws: how the answer changes when the question does, where nobody knows the answer itself.
//!
//! What is shown in exact directions must agree exactly. Solid angles may differ by rounding, for the
//! cells are cut differently: by the sum of both images' `angle_tolerance`, which is derived there. Laws are on
//! the grid, where the changes themselves are exact.

use super::{cases, grid_directions, hold};
use glam::DVec3;
use nusselt::bsp::{BspOptions, PlaneChoice, SceneBsp};
use nusselt::contour::{ContourImage, Domain, SceneOrder, ViewError, ViewOptions, Viewpoint, ViewsError};
use nusselt::exact::orient3d;
use nusselt::samples::{Kind, generate};
use nusselt::scene::{PieceRef, PolygonId, Side};
use nusselt::testing::{
    AxisMap, Case, Faces, Mode, Outlook, axis_map, case, case_of, check_same_bits, check_same_view, closed_scene,
    mesh_soup, point, point_inside, triangle_soup,
};
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::Index;
use std::thread;

fn same(polygon: PolygonId, side: Side) -> (PolygonId, Side) {
    (polygon, side)
}

fn agree(first: &ContourImage, second: &ContourImage, directions: &[DVec3]) -> Result<(), TestCaseError> {
    hold(check_same_view([first, second], [&same, &same], |d| d, directions))?;
    Ok(())
}

/// With a free eye: a viewpoint on a surface is rounded onto it, and after a change of coordinates that need not be
/// the same point. Nor need a frustum be that has its axes changed; and windows go by the numbers of faces.
fn free(mut case: Case) -> Case {
    if matches!(case.outlook, Outlook::Above(..) | Outlook::Frustum(_) | Outlook::Windows(_)) {
        case.outlook = Outlook::Sphere;
    }
    case
}

fn free_case() -> impl Strategy<Value = Case> {
    case(Mode::Grid).prop_map(free)
}

/// No two faces of these scenes lie in one plane but by chance, and none is hidden by a tie.
fn soup() -> impl Strategy<Value = Case> {
    case_of(Mode::Grid, prop_oneof![triangle_soup(Mode::Grid, 8), mesh_soup(Mode::Grid, 8)]).prop_map(free)
}

proptest! {
    #![proptest_config(cases(400))]

    /// Where faces of one plane overlap, the lower number is seen: so only scenes without such ties are
    /// permuted freely, and the others must show the same points, under some name. The 3D BSP has no seed; its
    /// choice of planes follows the order of the faces, so this law also changes that.
    #[test]
    fn permuted_polygons_are_seen_under_their_new_numbers(
        (case, order) in soup().prop_flat_map(|case| {
            let order = Just((0..case.faces.len()).collect::<Vec<_>>()).prop_shuffle();
            (Just(case), order)
        }),
        seed in any::<u64>(),
    ) {
        prop_assume!(!has_coplanar_faces(&case.faces));
        let permuted = Case { faces: case.faces.reordered(&order), ..case.clone() };
        let old_number = |polygon: PolygonId, side| (PolygonId(order[polygon.index()] as u32), side);
        let images = [hold(case.image())?, hold(permuted.image())?];
        hold(check_same_view(images.each_ref(), [&same, &old_number], |d| d, &grid_directions(seed)))?;
    }

    /// All f64 operations commute with a power of two as long as nothing overflows or underflows: the same
    /// bits.
    #[test]
    fn scaling_by_a_power_of_two_changes_no_bit(case in case(Mode::Grid), exponent in -100i32..100) {
        let scale = 2f64.powi(exponent);
        // Windows are moved by it.
        let direction = case.direction * scale;
        let scaled = Case { faces: case.faces.mapped(|p| p * scale), eye: case.eye * scale, direction, ..case.clone() };
        let image = hold(case.image())?;
        // On a surface the eye is rounded past its plane: where the plane meets 0, by the least number there is.
        let eye = image.viewpoint().eye().to_array();
        prop_assume!(eye.iter().all(|x| *x == 0.0 || x.abs() > 2f64.powi(-200)));
        hold(check_same_bits(&image, &hold(scaled.image())?))?;
    }

    #[test]
    fn axes_may_be_permuted_and_mirrored(
        case in free_case(), map in axis_map(), seed in any::<u64>(),
    ) {
        let turned = Case {
            faces: case.faces.turned(map),
            eye: map.apply(case.eye),
            direction: map.apply(case.direction),
            ..case.clone()
        };
        let images = [hold(case.image())?, hold(turned.image())?];
        hold(check_same_view(images.each_ref(), [&same, &same], |d| AxisMap::apply(map, d), &grid_directions(seed)))?;
    }

    #[test]
    fn translation_on_the_grid_changes_nothing(
        case in free_case(), by in [-1000i32..1000, -1000i32..1000, -1000i32..1000], seed in any::<u64>(),
    ) {
        let by = DVec3::from(by.map(f64::from));
        let moved = Case { faces: case.faces.mapped(|p| p + by), eye: case.eye + by, ..case.clone() };
        agree(&hold(case.image())?, &hold(moved.image())?, &grid_directions(seed))?;
    }

    /// The parts of a face together are seen as the face was: first part under its number, the other
    /// under a new one, so only where no tie depends on numbers.
    #[test]
    fn parts_of_a_subdivided_polygon_add_up(
        case in soup(), which in any::<Index>(), again in any::<bool>(), seed in any::<u64>(),
    ) {
        prop_assume!(!has_coplanar_faces(&case.faces));
        let face = which.index(case.faces.len());
        let count = case.faces.len();
        let split = case.faces.split(face);
        let split = if again { split.split(face) } else { split };
        let split = Case { faces: split, ..case.clone() };
        let whole = |polygon: PolygonId, side| {
            (if polygon.index() < count { polygon } else { PolygonId(face as u32) }, side)
        };
        let images = [hold(case.image())?, hold(split.image())?];
        hold(check_same_view(images.each_ref(), [&same, &whole], |d| d, &grid_directions(seed)))?;
    }

    /// A closed room seen from within: what is added outside of it is hidden, whatever planes it adds to the BSP.
    #[test]
    fn hidden_polygons_change_nothing(
        faces in closed_scene(Mode::Grid),
        eye in point_inside(Mode::Grid),
        hidden in triangle_soup(Mode::Grid, 4),
        first in any::<bool>(),
        seed in any::<u64>(),
    ) {
        // Beyond the largest room, and farther in the direction in which the triangle lies.
        let hidden = hidden.mapped(|p| p + DVec3::new(40.0, 8.0, -3.0));
        let mut more = if first { hidden.clone() } else { faces.clone() };
        more.append(if first { &faces } else { &hidden });
        let shift = if first { hidden.len() as u32 } else { 0 };
        let case = Case { mode: Mode::Grid, faces, eye, direction: DVec3::Z, outlook: Outlook::Sphere, epsilon: 0.0 };
        let images = [hold(case.image())?, hold(Case { faces: more, ..case.clone() }.image())?];
        let shifted = |polygon: PolygonId, side| (PolygonId(polygon.0 + shift), side);
        hold(check_same_view(images.each_ref(), [&shifted, &same], |d| d, &grid_directions(seed)))?;
    }

    /// Of coincident fronts the lowest number is seen: a copy at the end is never seen, a copy at the
    /// front hides the original.
    #[test]
    fn of_a_polygon_and_its_copy_the_lower_number_is_seen(
        case in soup(), which in any::<Index>(), first in any::<bool>(), seed in any::<u64>(),
    ) {
        // At the front it may also win ties that the original lost.
        prop_assume!(!first || !has_coplanar_faces(&case.faces));
        let face = which.index(case.faces.len());
        let mut faces = Faces::default();
        if first {
            faces.push(&case.faces.loops()[face]);
        }
        faces.append(&case.faces);
        if !first {
            faces.push(&case.faces.loops()[face]);
        }
        let images = [hold(case.image())?, hold(Case { faces, ..case.clone() }.image())?];
        let renamed = |polygon: PolygonId, side| match (first, polygon) {
            (false, _) => (polygon, side),
            (true, PolygonId(k)) if k as usize == face => (PolygonId(0), side),
            (true, PolygonId(k)) => (PolygonId(k + 1), side),
        };
        hold(check_same_view(images.each_ref(), [&renamed, &same], |d| d, &grid_directions(seed)))?;
    }

    /// A copy of the first polygon turned over shows its front where the original showed its back, and wins there.
    #[test]
    fn of_a_polygon_and_its_copy_turned_over_the_front_is_seen(case in soup(), seed in any::<u64>()) {
        let mut corners = case.faces.loops()[0].clone();
        corners.reverse();
        let mut faces = case.faces.clone();
        let copy = PolygonId(faces.push(&corners) as u32);
        let images = [hold(case.image())?, hold(Case { faces, ..case.clone() }.image())?];
        let renamed = |polygon: PolygonId, side| match (polygon, side) {
            (PolygonId(0), Side::Back) => (copy, Side::Front),
            other => other,
        };
        hold(check_same_view(images.each_ref(), [&renamed, &same], |d| d, &grid_directions(seed)))?;
    }

    /// Other splitters at the top of the contour tree cut other cells, which show the same.
    #[test]
    fn the_quadtree_changes_nothing_seen(case in free_case(), depth in 0u32..4, seed in any::<u64>()) {
        let bsp = hold(case.bsp())?;
        let (viewpoint, domain) = case.viewpoint(bsp.scene());
        let options = ViewOptions { quadtree_depth: Some(depth), ..ViewOptions::default() };
        let other = hold(bsp.view_with(&viewpoint, &domain, &options))?;
        agree(&hold(case.view(&bsp))?, &other, &grid_directions(seed))?;
    }

    /// Other splitting planes cut other fragments, which look the same.
    #[test]
    fn the_choice_of_splitting_planes_changes_nothing_seen(case in free_case(), polygons in any::<bool>(), seed in any::<u64>()) {
        let planes = if polygons { PlaneChoice::Polygons } else { PlaneChoice::SurfaceArea };
        let other = hold(SceneBsp::build(&hold(case.scene())?, &BspOptions { planes, ..BspOptions::default() }))?;
        agree(&hold(case.image())?, &hold(case.view(&other))?, &grid_directions(seed))?;
    }
}

proptest! {
    #![proptest_config(cases(60))]

    /// Views of one BSP from several threads at once, in any order, are the same bits as one after the
    /// other.
    #[test]
    fn one_thread_or_many_give_the_same_bits(case in free_case(), eyes in vec(point(Mode::Grid), 4)) {
        let bsp: SceneBsp = hold(case.bsp())?;
        let views: Vec<Case> = eyes.into_iter().map(|eye| Case { eye, ..case.clone() }).collect();
        let alone: Vec<ContourImage> = hold(views.iter().map(|case| case.view(&bsp)).collect())?;
        let together = thread::scope(|scope| {
            let threads: Vec<_> = (0..4)
                .map(|first| {
                    let (views, bsp) = (&views, &bsp);
                    scope.spawn(move || {
                        (0..views.len()).map(|k| (first + k) % views.len()).map(|k| (k, views[k].view(bsp))).collect::<Vec<_>>()
                    })
                })
                .collect();
            threads.into_iter().flat_map(|thread| thread.join().expect("a view does not panic")).collect::<Vec<_>>()
        });
        for (k, image) in together {
            hold(check_same_bits(&alone[k], &hold(image)?))?;
        }
        // The tree itself does not depend on anything but the scene.
        hold(check_same_bits(&alone[0], &hold(views[0].image())?))?;
    }
}

/// Also where a thread's memory was used for other views before, whichever those were.
#[test]
fn many_views_are_the_same_bits_for_any_number_of_threads() {
    let room = generate(Kind::Room, 400, 5).unwrap();
    let scene = room.to_builder().build().unwrap();
    let domains = [Domain::Hemisphere(DVec3::Z), Domain::Sphere, Domain::Hemisphere(DVec3::new(1.0, -2.0, 0.5))];
    let eyes = room.free_points(30, 2).into_iter().zip(domains.into_iter().cycle());
    let views: Vec<_> = eyes.map(|(eye, domain)| (Viewpoint::free(eye.into()), domain)).collect();
    let options = ViewOptions::default();
    let ways: [SceneOrder; 2] =
        [SceneOrder::new(&scene), SceneBsp::build(&scene, &BspOptions::default()).unwrap().into()];
    for order in ways {
        for threads in [1, 2, 3, 8] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let images = pool.install(|| order.views(&views, &options, |k, image| (k, image.clone()))).unwrap();
            assert_eq!(images.len(), views.len());
            for (place, (k, image)) in images.into_iter().enumerate() {
                assert_eq!(k, place);
                check_same_bits(&order.view(&views[k].0, &views[k].1).unwrap(), &image).unwrap();
            }
            let mut bad = views.clone();
            bad[20].1 = Domain::Hemisphere(DVec3::ZERO);
            bad[11].0 = Viewpoint::free(DVec3::NAN);
            let error = pool.install(|| order.views(&bad, &options, |_, _| ())).unwrap_err();
            assert_eq!(error, ViewsError { index: 11, source: ViewError::EyeNotFinite });
        }
    }
}

/// True if some two faces with an area lie in one plane: then numbers decide what is seen where they overlap.
fn has_coplanar_faces(faces: &Faces) -> bool {
    let Ok(scene) = faces.scene() else { return true };
    let in_plane = |a: PieceRef<'_>, b: PieceRef<'_>| {
        let corners: Vec<DVec3> = a.points().take(3).collect();
        b.points().all(|p| orient3d(corners[0], corners[1], corners[2], p).is_zero())
    };
    scene.pieces().any(|a| scene.pieces().any(|b| a.polygon() != b.polygon() && in_plane(a, b)))
}
