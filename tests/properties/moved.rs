//! A scene with objects moved, and its hierarchy of boxes, are those that are built afresh from the moved coordinates.

use super::{cases, hold, mode};
use glam::{DAffine3, DMat3, DVec3};
use nusselt::bsp::{BspOptions, SceneBsp};
use nusselt::bvh::SceneBvh;
use nusselt::exact::orient3d;
use nusselt::samples::{Kind, generate};
use nusselt::scene::{
    DuplicatePolicy, FaceSpec, Material, MoveError, NonPlanarPolicy, ObjectId, OrDrop, PolygonRef, Repair, Scene,
    SceneBuilder, SceneError, Shape,
};
use nusselt::testing::{Case, Mode, axis_map, case, check_same_regions, coordinate, gallery, point};
use proptest::collection::vec;
use proptest::prelude::*;

const OBJECTS: usize = 3;

type Moves = Vec<(ObjectId, DAffine3)>;

/// The faces of a case, `chunk` of them in a row in one object, and so on in turn.
fn in_objects(case: &Case, chunk: usize, repair: Repair) -> Result<Scene, SceneError> {
    let mut builder = Scene::builder().repair(repair);
    let material = builder.add_material(Material::new("grey"));
    let objects: Vec<_> = (0..OBJECTS).map(|k| builder.add_object(&k.to_string())).collect();
    for (k, corners) in case.faces.loops().iter().enumerate() {
        let ring = corners.iter().map(|&p| builder.add_vertex(p)).collect();
        builder.add_face(FaceSpec { rings: vec![ring], object: objects[k / chunk % OBJECTS], material });
    }
    builder.build()
}

/// The corners of a polygon after a move, by the words of the documentation.
fn corners_after(polygon: PolygonRef<'_>, scene: &Scene, moves: &Moves) -> Vec<Vec<DVec3>> {
    let transform = moves.iter().find(|(object, _)| *object == polygon.object()).map(|&(_, transform)| transform);
    let rings = polygon.rings().iter().map(|ring| {
        let mut corners: Vec<DVec3> = ring.iter().map(|&v| scene.vertex(v)).collect();
        let Some(transform) = transform else { return corners };
        for p in &mut corners {
            *p = transform.transform_point3(*p);
        }
        corners.dedup();
        while corners.len() > 1 && corners.first() == corners.last() {
            corners.pop();
        }
        let [x, y, z] = DVec3::AXES.map(|axis| transform.transform_vector3(axis));
        if orient3d(DVec3::ZERO, x, y, z).is_negative() {
            corners[1..].reverse();
        }
        corners
    });
    rings.collect()
}

/// A scene of the moved coordinates, built afresh: of the `moved` scene's vertices in their order, if there is one.
fn afresh(scene: &Scene, moves: &Moves, repair: Repair, moved: Option<&Scene>) -> Result<Scene, SceneError> {
    let mut builder = SceneBuilder::default().repair(Repair { malformed: OrDrop::Drop, ..repair });
    let material = builder.add_material(Material::new("grey"));
    for name in scene.objects() {
        builder.add_object(name);
    }
    for &position in moved.into_iter().flat_map(Scene::vertices) {
        builder.add_vertex(position);
    }
    for polygon in scene.polygons() {
        let object = polygon.object();
        if polygon.shape() == Shape::Dropped {
            builder.add_unreadable_face(FaceSpec { rings: Vec::new(), object, material }, "dropped before".to_owned());
            continue;
        }
        let stays = moved.map(|moved| moved.polygon(polygon.id())).filter(|polygon| polygon.shape() != Shape::Dropped);
        let rings = match stays {
            Some(polygon) => polygon.rings().iter().map(|ring| ring.iter().map(|v| v.index()).collect()).collect(),
            None => corners_after(polygon, scene, moves)
                .into_iter()
                .map(|corners| corners.into_iter().map(|p| builder.add_vertex(p)).collect())
                .collect::<Vec<Vec<usize>>>(),
        };
        // Corners that have become one would be too few.
        let enough = rings
            .into_iter()
            .map(|ring| [ring[0]].repeat(3_usize.saturating_sub(ring.len())).into_iter().chain(ring).collect());
        builder.add_face(FaceSpec { rings: enough.collect(), object, material });
    }
    builder.build()
}

/// All there is to a scene.
fn check_same_scene(a: &Scene, b: &Scene) -> Result<(), TestCaseError> {
    prop_assert_eq!(a.vertices(), b.vertices());
    prop_assert_eq!(a.edges(), b.edges());
    prop_assert_eq!(a.planes(), b.planes());
    prop_assert_eq!(a.piece_count(), b.piece_count());
    for (p, q) in a.polygons().zip(b.polygons()) {
        prop_assert_eq!((p.shape(), p.object(), p.rings()), (q.shape(), q.object(), q.rings()), "polygon {}", p.id());
        for (p, q) in p.pieces().zip(q.pieces()) {
            prop_assert_eq!((p.plane_id(), p.facing(), p.polygon()), (q.plane_id(), q.facing(), q.polygon()));
            prop_assert_eq!((p.vertices(), p.edges()), (q.vertices(), q.edges()));
        }
    }
    let dropped = |scene: &Scene| -> Vec<_> { scene.repairs().dropped.iter().map(|dropped| dropped.polygon).collect() };
    prop_assert_eq!(dropped(a), dropped(b));
    Ok(())
}

/// Moves objects, if that can be, and checks the scene, its hierarchy and a view of it.
fn check_move(bvh: &SceneBvh, moves: &Moves, repair: Repair, case: &Case) -> Result<Option<SceneBvh>, TestCaseError> {
    let scene = bvh.scene();
    let moved = match bvh.moved(moves) {
        Ok(moved) => moved,
        Err(MoveError::Overflow { object }) => {
            let lost = scene.polygons().filter(|polygon| polygon.object() == object);
            let finite = |p: PolygonRef<'_>| corners_after(p, scene, moves).iter().flatten().all(|p| p.is_finite());
            prop_assert!(!lost.into_iter().all(finite), "nothing overflows");
            return Ok(None);
        }
        Err(MoveError::Broken(error)) => {
            prop_assert_eq!(afresh(scene, moves, repair, None).map(drop), Err(error));
            return Ok(None);
        }
        Err(error) => return Err(TestCaseError::fail(error.to_string())),
    };
    for (before, after) in scene.polygons().zip(moved.scene().polygons()) {
        if after.shape() != Shape::Dropped {
            let corners = after.rings().iter().map(|ring| ring.iter().map(|&v| moved.scene().vertex(v)).collect());
            prop_assert_eq!(corners.collect::<Vec<Vec<_>>>(), corners_after(before, scene, moves));
        }
    }
    let fresh = hold(afresh(scene, moves, repair, Some(moved.scene())))?;
    check_same_scene(moved.scene(), &fresh)?;
    let built = SceneBvh::build(&fresh);
    prop_assert_eq!(moved.solid_pieces(), built.solid_pieces());
    let (viewpoint, domain) = case.viewpoint(&fresh);
    let image = hold(moved.view(&viewpoint, &domain))?;
    hold(image.certify())?;
    hold(check_same_regions(&image, &hold(built.view(&viewpoint, &domain))?))?;
    let bsp = hold(SceneBsp::build(&fresh, &BspOptions::default()))?;
    hold(check_same_regions(&image, &hold(bsp.view(&viewpoint, &domain))?))?;
    Ok(Some(moved))
}

fn check(case: &Case, chunk: usize, repair: Repair, steps: &[Moves]) -> Result<(), TestCaseError> {
    let Ok(scene) = in_objects(case, chunk, repair) else { return Ok(()) };
    let mut bvh = SceneBvh::build(&scene);
    for moves in steps {
        let Some(moved) = check_move(&bvh, moves, repair, case)? else { continue };
        bvh = moved;
    }
    Ok(())
}

/// Mostly on the grid: there things come to coincide.
fn transform(mode: Mode) -> impl Strategy<Value = DAffine3> {
    let step = || (-4i8..=4).prop_map(f64::from);
    let by = move || [step(), step(), step()].prop_map(|by| DAffine3::from_translation(by.into()));
    let scale = || prop_oneof![4 => Just(1.0), 1 => Just(2.0), 1 => Just(0.5), 1 => Just(-1.0), 1 => Just(0.0)];
    let on_the_grid = prop_oneof![
        4 => by(),
        2 => (axis_map(), by()).prop_map(|(map, by)| {
            by * DAffine3::from_mat3(DMat3::from_cols_array_2d(&DVec3::AXES.map(|axis| map.apply(axis).to_array())))
        }),
        2 => ([scale(), scale(), scale()], by()).prop_map(|(scale, by)| by * DAffine3::from_scale(scale.into())),
        1 => Just(DAffine3::IDENTITY),
    ];
    let anywhere = prop_oneof![
        point(mode).prop_map(DAffine3::from_translation),
        ([-1.0..1.0, -1.0..1.0, -1.0..1.0], 0.0..7.0, point(Mode::Grid)).prop_map(|(axis, angle, by)| {
            let axis = DVec3::from(axis).try_normalize().unwrap_or(DVec3::Z);
            DAffine3::from_translation(by) * DAffine3::from_axis_angle(axis, angle)
        }),
        [coordinate(mode), coordinate(mode), coordinate(mode)].prop_map(|scale| DAffine3::from_scale(scale.into())),
        [point(mode), point(mode), point(mode), point(mode)]
            .prop_map(|[x, y, z, by]| DAffine3 { matrix3: DMat3::from_cols(x, y, z), translation: by }),
    ];
    prop_oneof![2 => on_the_grid, 1 => anywhere]
}

/// Some of the objects, each by a transform of its own or all by one.
fn moves(mode: Mode) -> impl Strategy<Value = Moves> {
    let transforms = vec(transform(mode), OBJECTS);
    (transforms, vec(any::<bool>(), OBJECTS), any::<bool>()).prop_map(|(transforms, chosen, together)| {
        let chosen = (0..OBJECTS).filter(|&k| chosen[k]);
        chosen.map(|k| (ObjectId(k as u32), transforms[if together { 0 } else { k }])).collect()
    })
}

fn repair() -> impl Strategy<Value = Repair> {
    let duplicates = prop_oneof![Just(DuplicatePolicy::Drop), Just(DuplicatePolicy::Reject)];
    let non_planar = prop_oneof![Just(NonPlanarPolicy::Drop), Just(NonPlanarPolicy::Triangulate)];
    prop_oneof![
        2 => Just(Repair::default()),
        1 => (duplicates, non_planar).prop_map(|(duplicates, non_planar)| Repair {
            duplicates,
            non_planar,
            self_crossing: OrDrop::Drop,
            ..Repair::default()
        }),
    ]
}

proptest! {
    #![proptest_config(cases(500))]

    #[test]
    fn moved_is_what_is_built_afresh(
        (case, steps) in mode().prop_flat_map(|mode| (case(mode), vec(moves(mode), 1..4))),
        chunk in prop_oneof![Just(1usize), Just(4), Just(6)],
        repair in repair(),
    ) {
        check(&case, chunk, repair, &steps)?;
    }
}

#[test]
fn degenerate_scenes_may_be_moved_apart_and_together_again() {
    let by = |object: u32, x: f64| (ObjectId(object), DAffine3::from_translation(DVec3::X * x));
    let flat = DAffine3::from_scale(DVec3::new(1.0, 1.0, 0.0));
    let steps = [vec![by(0, 1.0), by(1, -2.0)], vec![by(0, -1.0)], vec![by(1, 2.0)], vec![(ObjectId(0), flat)]];
    for (name, case) in gallery::all() {
        for chunk in [1, 6] {
            check(&case, chunk, Repair::default(), &steps).unwrap_or_else(|error| panic!("{name}: {error}"));
        }
    }
}

/// Furniture that walks about, turns, and stands in other furniture.
#[test]
fn furniture_may_move() {
    for kind in Kind::ALL {
        let mesh = generate(kind, 600, 1).expect("a scene of that size");
        let scene = mesh.to_builder().build().expect("a generated scene is valid");
        let mut bvh = SceneBvh::build(&scene);
        let object = |name: &str| scene.polygons().find(|polygon| polygon.object_name() == name);
        let objects: Vec<_> =
            scene.objects().iter().skip(1).take(3).filter_map(|name| object(name)).map(PolygonRef::object).collect();
        assert!(!objects.is_empty(), "{kind} has objects");
        let eyes = mesh.free_points(3, 5);
        for (k, eye) in eyes.into_iter().enumerate() {
            let turn =
                DAffine3::from_translation(DVec3::new(0.3, -0.2, 0.0)) * DAffine3::from_rotation_z(k as f64 * 0.01);
            let moves: Moves = objects.iter().map(|&object| (object, turn)).collect();
            let case = Case {
                mode: Mode::Chaos,
                faces: nusselt::testing::Faces::default(),
                eye: eye.into(),
                direction: DVec3::Z,
                outlook: nusselt::testing::Outlook::Sphere,
                epsilon: 0.0,
            };
            let moved = check_move(&bvh, &moves, Repair::default(), &case);
            bvh = moved.unwrap_or_else(|error| panic!("{kind}: {error}")).expect("nothing breaks");
        }
    }
}
