//! Objects that move: what becomes of sides, shared vertices, solids and broken faces.

use glam::{DAffine3, DMat3, DVec3};
use nusselt::bvh::SceneBvh;
use nusselt::contour::{Domain, Viewpoint};
use nusselt::scene::{
    DropCause, DuplicatePolicy, FaceSpec, Material, MoveError, NonPlanarPolicy, ObjectId, PolygonId, PolygonRef,
    Repair, Scene, SceneBuilder, SceneProblem, Shape,
};
use nusselt::testing::{Faces, check_image};

const FIRST: ObjectId = ObjectId(0);
const SECOND: ObjectId = ObjectId(1);

/// Each list of faces an object.
fn objects(all: &[Faces], repair: Repair) -> Scene {
    let mut builder = SceneBuilder::default().repair(repair);
    let material = builder.add_material(Material::new("grey"));
    for (k, faces) in all.iter().enumerate() {
        let object = builder.add_object(&format!("object {k}"));
        for corners in faces.loops() {
            let ring = corners.iter().map(|&p| builder.add_vertex(p)).collect();
            builder.add_face(FaceSpec { rings: vec![ring], object, material });
        }
    }
    builder.build().expect("the faces are sound")
}

fn cuboid(low: [f64; 3], high: [f64; 3]) -> Faces {
    let mut faces = Faces::default();
    faces.cuboid(low.into(), high.into());
    faces
}

fn square(z: f64) -> Faces {
    Faces::from(vec![vec![[0.0, 0.0, z], [1.0, 0.0, z], [1.0, 1.0, z], [0.0, 1.0, z]]])
}

fn by(x: f64, y: f64, z: f64) -> DAffine3 {
    DAffine3::from_translation(DVec3::new(x, y, z))
}

fn corners(scene: &Scene, polygon: u32) -> Vec<[f64; 3]> {
    let ring = &scene.polygon(PolygonId(polygon)).rings()[0];
    ring.iter().map(|&v| scene.vertex(v).to_array()).collect()
}

#[test]
fn moves_that_make_no_sense_are_refused_and_named() {
    let scene = objects(&[square(0.0), square(1.0)], Repair::default());
    let moved = |moves: &[(ObjectId, DAffine3)]| scene.with_moved(moves).map(drop);
    let lost = ObjectId(2);
    assert_eq!(moved(&[(lost, DAffine3::IDENTITY)]), Err(MoveError::UnknownObject { object: lost, count: 2 }));
    let twice = [(SECOND, DAffine3::IDENTITY), (SECOND, DAffine3::IDENTITY)];
    assert_eq!(moved(&twice), Err(MoveError::MovedTwice { object: SECOND }));
    assert_eq!(moved(&[(FIRST, by(0.0, f64::NAN, 0.0))]), Err(MoveError::NotFinite { object: FIRST }));
    let huge = DAffine3::from_scale(DVec3::splat(f64::MAX)) * by(1.0, 1.0, 1.0);
    assert_eq!(moved(&[(FIRST, huge)]), Err(MoveError::Overflow { object: FIRST }));
    assert_eq!(moved(&[]), Ok(()));
}

#[test]
fn an_object_leaves_the_vertices_that_it_shares_and_finds_them_again() {
    // Two squares with a common side.
    let right = square(0.0).mapped(|p| p + DVec3::X);
    let scene = objects(&[square(0.0), right], Repair::default());
    assert_eq!((scene.vertices().len(), scene.edges().len()), (6, 7));
    let apart = scene.with_moved(&[(SECOND, by(0.0, 0.0, 1.0))]).expect("nothing breaks");
    assert_eq!((apart.vertices().len(), apart.edges().len()), (8, 8));
    assert_eq!(corners(&apart, 0), corners(&scene, 0));
    assert_eq!(corners(&apart, 1), [[1.0, 0.0, 1.0], [2.0, 0.0, 1.0], [2.0, 1.0, 1.0], [1.0, 1.0, 1.0]]);
    let together = apart.with_moved(&[(SECOND, by(0.0, 0.0, -1.0))]).expect("nothing breaks");
    assert_eq!((together.vertices().len(), together.edges().len()), (6, 7));
    // -0 is +0, however it comes about.
    let away = Faces::from(vec![vec![[0.0, -1.0, -1.0], [0.0, -2.0, -1.0], [0.0, -2.0, -2.0]]]);
    let pair = objects(&[away.clone(), away.mapped(DVec3::abs)], Repair::default());
    let mirror = DAffine3 { translation: -DVec3::ZERO, ..DAffine3::from_scale(DVec3::NEG_ONE) };
    let onto = pair.with_moved(&[(FIRST, mirror)]).expect("nothing breaks");
    assert_eq!((pair.vertices().len(), onto.vertices().len()), (6, 3));
    // Both by one transform stay together.
    let both = scene.with_moved(&[(FIRST, by(0.5, 0.25, 0.0)), (SECOND, by(0.5, 0.25, 0.0))]).expect("nothing breaks");
    assert_eq!((both.vertices().len(), both.edges().len()), (6, 7));
}

#[test]
fn a_mirror_keeps_the_sides_and_twice_is_not_at_all() {
    let scene = objects(&[cuboid([1.0; 3], [2.0, 3.0, 4.0])], Repair::default());
    let mirror = DAffine3::from_scale(DVec3::new(-1.0, 1.0, 1.0));
    let mirrored = scene.with_moved(&[(FIRST, mirror)]).expect("nothing breaks");
    assert_eq!(mirrored.report().components, scene.report().components, "the fronts are outside");
    let again = mirrored.with_moved(&[(FIRST, mirror)]).expect("nothing breaks");
    for polygon in 0..6 {
        assert_eq!(corners(&again, polygon), corners(&scene, polygon));
        assert_eq!(corners(&mirrored, polygon)[..1], [flipped(corners(&scene, polygon)[0])]);
    }
}

fn flipped([x, y, z]: [f64; 3]) -> [f64; 3] {
    [-x, y, z]
}

#[test]
fn a_turned_quad_may_fold_and_a_sheared_one_unfold() {
    let roof = Faces::from(vec![vec![[0.0, 0.0, 0.0], [0.7, 0.0, 0.1], [0.9, 0.3, 0.4], [0.2, 0.3, 0.3]]]);
    let scene = objects(&[square(-1.0), roof, square(3.0)], Repair::default());
    let warped = scene.polygon(PolygonId(1));
    assert_eq!((warped.shape(), warped.pieces().len()), (Shape::NonPlanar, 2), "its coordinates are rounded decimals");
    let flat = DAffine3::from_scale(DVec3::new(1.0, 1.0, 0.0));
    let bvh = SceneBvh::build(&scene).moved(&[(SECOND, flat)]).expect("nothing breaks");
    let flattened = bvh.scene();
    assert_eq!((flattened.polygon(PolygonId(1)).shape(), flattened.piece_count()), (Shape::Convex, 3));
    let turn = DAffine3::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), 0.3);
    let folded = bvh.moved(&[(SECOND, turn)]).expect("nothing breaks");
    assert_eq!(folded.scene().piece_count(), 4);
    let polygons: Vec<u32> = folded.scene().pieces().map(|piece| piece.polygon().0).collect();
    assert_eq!(polygons, [0, 1, 1, 2]);
}

#[test]
fn what_has_no_area_hides_nothing_until_it_has_some() {
    let scene = objects(&[square(2.0), cuboid([0.0; 3], [1.0; 3])], Repair::default());
    let bvh = SceneBvh::build(&scene);
    assert_eq!(bvh.solid_pieces(), 6);
    let line = DAffine3::from_scale(DVec3::new(0.0, 0.0, 1.0));
    let thin = bvh.moved(&[(SECOND, line)]).expect("nothing breaks");
    assert_eq!((thin.scene().piece_count(), thin.solid_pieces()), (1, 0));
    assert!(thin.node_count() <= bvh.node_count());
    let squeezed = bvh.moved(&[(SECOND, DAffine3::from_scale(DVec3::new(1.0, 1.0, 0.0)))]).expect("nothing breaks");
    assert_eq!((squeezed.scene().piece_count(), squeezed.solid_pieces()), (3, 0));
    // All that there was may go, and something may come of what was nothing.
    let alone = SceneBvh::build(&objects(
        &[Faces::from(vec![vec![[0.0; 3], [0.1, 0.1, 0.1], [0.3, 0.3, 0.3]]])],
        Repair::default(),
    ));
    assert_eq!(alone.node_count(), 0);
    let turn = DAffine3::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), 0.3);
    let seen = alone.moved(&[(FIRST, turn)]).expect("nothing breaks");
    assert_eq!((seen.node_count(), seen.scene().piece_count()), (1, 1), "rounding gives it area");
    let line = Faces::from(vec![vec![[0.0; 3], [0.1, 0.1, 0.1], [0.3, 0.3, 0.3]]]);
    let before_another = SceneBvh::build(&objects(&[line, square(2.0)], Repair::default()));
    let both = before_another.moved(&[(FIRST, turn)]).expect("nothing breaks");
    assert_eq!(both.scene().piece_count(), 2);
    let image = both.view(&Viewpoint::free(DVec3::new(0.0, 0.5, -1.0)), &Domain::Sphere).expect("the eye is finite");
    check_image(&image).expect("both are seen");
    let gone = seen.moved(&[(FIRST, DAffine3::from_scale(DVec3::ZERO))]).expect("nothing breaks");
    assert_eq!((gone.node_count(), gone.scene().piece_count(), gone.looseness().to_string()), (0, 0, "1".to_owned()));
    let image = gone.view(&Viewpoint::free(DVec3::ONE), &Domain::Sphere).expect("the eye is finite");
    assert!(image.cells().all(|cell| cell.polygon().is_none()));
}

#[test]
fn solids_are_proved_where_something_moved_and_nowhere_else_lost() {
    // A cube in two objects, and another one that stays.
    let whole = cuboid([0.0; 3], [1.0; 3]);
    let [cup, lid] = [whole.loops()[1..].to_vec(), whole.loops()[..1].to_vec()].map(|loops| {
        let mut faces = Faces::default();
        for corners in loops {
            faces.push(&corners);
        }
        faces
    });
    let scene = objects(&[cup, lid, cuboid([3.0; 3], [4.0; 3])], Repair::default());
    let closed = SceneBvh::build(&scene);
    assert_eq!(closed.solid_pieces(), 12);
    let open = closed.moved(&[(SECOND, by(0.0, 0.0, -1.0))]).expect("nothing breaks");
    assert_eq!(open.solid_pieces(), 6);
    let eye = Viewpoint::free(DVec3::new(0.5, 0.5, -0.5));
    let image = open.view(&eye, &Domain::Sphere).expect("the eye is finite");
    check_image(&image).expect("the image is right");
    assert!(image.cells().any(|cell| cell.polygon() == Some(PolygonId(0))), "one sees into the open cube");
    let closed = open.moved(&[(SECOND, by(0.0, 0.0, 1.0))]).expect("nothing breaks");
    assert_eq!(closed.solid_pieces(), 12);
    // At z = 0 a mirror moves no corner of the lid, but what was its outside is above it now.
    let mirror = DAffine3::from_scale(DVec3::new(1.0, 1.0, -1.0));
    assert_eq!(closed.moved(&[(SECOND, mirror)]).expect("nothing breaks").solid_pieces(), 6);
    assert_eq!(closed.moved(&[(FIRST, mirror), (SECOND, mirror)]).expect("nothing breaks").solid_pieces(), 12);
}

/// A long box with two pointed roofs, the first of which is an object of its own that leans towards the other.
#[test]
fn a_solid_that_comes_to_pass_through_itself_is_none() {
    let quad = |faces: &mut Faces, corners: [[i8; 3]; 4]| {
        faces.push(&corners.map(|p| DVec3::from(p.map(f64::from))));
    };
    let [mut body, mut roof] = [Faces::default(), Faces::default()];
    for i in 0..3 {
        quad(&mut body, [[i, 0, -1], [i, 1, -1], [i + 1, 1, -1], [i + 1, 0, -1]]);
        quad(&mut body, [[i, 0, -1], [i + 1, 0, -1], [i + 1, 0, 0], [i, 0, 0]]);
        quad(&mut body, [[i, 1, -1], [i, 1, 0], [i + 1, 1, 0], [i + 1, 1, -1]]);
    }
    quad(&mut body, [[0, 0, -1], [0, 0, 0], [0, 1, 0], [0, 1, -1]]);
    quad(&mut body, [[3, 0, -1], [3, 1, -1], [3, 1, 0], [3, 0, 0]]);
    quad(&mut body, [[1, 0, 0], [2, 0, 0], [2, 1, 0], [1, 1, 0]]);
    for (faces, x) in [(&mut roof, 0.0), (&mut body, 2.0)] {
        let around = [[x, 0.0], [x + 1.0, 0.0], [x + 1.0, 1.0], [x, 1.0]].map(|[x, y]| DVec3::new(x, y, 0.0));
        for k in 0..4 {
            faces.push(&[around[k], around[(k + 1) % 4], DVec3::new(x + 0.5, 0.5, 1.0)]);
        }
    }
    let bvh = SceneBvh::build(&objects(&[body, roof], Repair::default()));
    let leaning = |by: f64| {
        let shear = DAffine3::from_mat3(DMat3::from_cols(DVec3::X, DVec3::Y, DVec3::new(by, 0.0, 1.0)));
        bvh.moved(&[(SECOND, shear)]).expect("nothing breaks").solid_pieces()
    };
    assert_eq!([0.0, 1.0, 2.5].map(leaning), [20, 20, 0]);
}

#[test]
fn the_repair_that_a_scene_was_built_with_holds_when_it_moves() {
    let repair = Repair { duplicates: DuplicatePolicy::Drop, non_planar: NonPlanarPolicy::Reject, ..Repair::default() };
    let scene = objects(&[square(0.0), square(1.0), square(2.0)], repair);
    // Onto the one behind it, which goes, and onto the one before it, which stays.
    let moved = scene.with_moved(&[(SECOND, by(0.0, 0.0, 1.0))]).expect("duplicates are dropped");
    assert_eq!(moved.polygon(PolygonId(2)).shape(), Shape::Dropped);
    assert_eq!(moved.vertices().len(), 8);
    let dropped = &moved.repairs().dropped;
    assert_eq!((dropped[0].polygon, dropped[0].cause), (PolygonId(2), DropCause::Duplicate));
    assert!((dropped[0].size - 2f64.sqrt()).abs() < 1e-12);
    let moved = moved.with_moved(&[(SECOND, by(0.0, 0.0, -2.0))]).expect("duplicates are dropped");
    let shapes: Vec<Shape> = moved.polygons().map(PolygonRef::shape).collect();
    assert_eq!(shapes, [Shape::Convex, Shape::Dropped, Shape::Dropped], "what is dropped does not come back");
    let causes: Vec<u32> = moved.repairs().dropped.iter().map(|dropped| dropped.polygon.0).collect();
    assert_eq!(causes, [1, 2]);
    let turn = DAffine3::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), 0.3) * by(0.1, 0.2, 0.3);
    let error = scene.with_moved(&[(SECOND, turn)]).map(drop).expect_err("the quad folds");
    let MoveError::Broken(error) = error else { panic!("{error}") };
    assert_eq!(error.problems, [SceneProblem::NonPlanar { polygon: PolygonId(1) }]);
}

#[test]
fn boxes_get_loose_with_distance_and_can_be_made_tight() {
    let cubes: Vec<Faces> =
        (0..20).map(|k| cuboid([3.0 * f64::from(k), 0.0, 0.0], [3.0 * f64::from(k) + 1.0, 1.0, 1.0])).collect();
    let bvh = SceneBvh::build(&objects(&cubes, Repair::default()));
    let looseness = |bvh: &SceneBvh| (bvh.looseness() * 100.0).round() / 100.0;
    assert_eq!(looseness(&bvh).to_string(), "1");
    let all: Vec<_> = (0..20).map(|k| (ObjectId(k), DAffine3::from_scale(DVec3::splat(4.0)))).collect();
    assert_eq!(looseness(&bvh.moved(&all).expect("nothing breaks")).to_string(), "1", "all of it alike");
    let near = bvh.moved(&[(FIRST, by(0.5, 0.0, 0.0))]).expect("nothing breaks");
    let far = bvh.moved(&[(FIRST, by(50.0, 20.0, 0.0))]).expect("nothing breaks");
    assert!(near.looseness() < 1.01 && far.looseness() > 2.0, "{} and {}", near.looseness(), far.looseness());
    let tight = far.clone().tightened();
    assert_eq!(looseness(&tight).to_string(), "1");
    assert_eq!(tight.solid_pieces(), 120);
    let view = |bvh: &SceneBvh| {
        bvh.view(&Viewpoint::free(DVec3::new(30.0, 5.0, 9.0)), &Domain::Sphere).expect("the eye is finite")
    };
    nusselt::testing::check_same_regions(&view(&tight), &view(&far)).expect("the same view");
}
