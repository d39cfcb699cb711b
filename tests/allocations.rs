//! No stage of the predicates but the last, integers of arbitrary width, touches the heap once a kernel is
//! warm; views use the memory of others; readers of files take memory for what is there, not for what is promised.

use glam::DVec3;
use nusselt::bsp::{BspOptions, SceneBsp};
use nusselt::bvh::SceneBvh;
use nusselt::contour::{Domain, SceneOrder, ViewOptions, ViewSpace, Viewpoint};
use nusselt::exact::{Direction, DirectionId, Kernel, Plane, Point, PredicateStats, Splitter, SplitterId, orient3d};
use nusselt::io::{ReadOptions, ply, stl};
#[cfg(all(feature = "gltf", feature = "cityjson"))]
use nusselt::io::{cityjson, gltf};
use nusselt::samples::{Kind, generate};
use nusselt::scene::Scene;

/// An eye, three planes through one line of sight and more in general position.
struct Setting {
    eye: DVec3,
    planes: Vec<Plane>,
    points: Vec<Point>,
    splitters: Vec<Splitter>,
    directions: Vec<Direction>,
}

/// Coordinates with `bits` bits after the point, in special and in general position.
fn setting(bits: i32) -> Setting {
    let mut state = 7u64;
    let mut coordinate = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let x = (state >> 11) as f64 / 2f64.powi(53) * 8.0 - 4.0;
        (x * 2f64.powi(bits)).round() / 2f64.powi(bits)
    };
    let mut point = || DVec3::new(coordinate(), coordinate(), coordinate());
    let eye = point();
    let p: Vec<DVec3> = (0..9).map(|_| point()).collect();
    // A mirror image about the eye, exact on this grid, puts edges on common planes with it.
    let q = eye * 2.0 - p[0];
    let planes = vec![
        Plane::Points([p[0], p[1], p[2]]),
        Plane::Points([p[3], p[4], p[5]]),
        Plane::Points([p[0], p[4], p[6]]),
        Plane::Axis { axis: 2, value: p[7].z },
    ];
    let (from, to) = (DVec3::new(p[7].x, p[7].y, p[7].z + 1.0), DVec3::new(p[8].x, p[8].y, p[7].z - 1.0));
    let points = vec![
        Point::Given(p[0]),
        Point::Given(p[1] + p[2] - p[0]),
        Point::EdgePlane([from, to], planes[3]),
        Point::Planes([planes[0], planes[1], planes[2]]),
    ];
    let splitters = vec![
        Splitter::Edge([p[0], p[1]]),
        Splitter::Edge([p[0], p[2]]),
        Splitter::Edge([q, p[3]]),
        Splitter::Crease([planes[0], planes[1]]),
        Splitter::Crease([planes[1], planes[2]]),
        Splitter::Crease([planes[0], planes[2]]),
        Splitter::Given(DVec3::new(1.0, -2.0, 0.5)),
        Splitter::Parallel(planes[0]),
    ];
    let mut directions: Vec<Direction> = points.iter().map(|p| Direction::Point(*p)).collect();
    directions.push(Direction::Crossing([splitters[0], splitters[2]]));
    directions.push(Direction::Crossing([splitters[3], splitters[4]]));
    directions.push(Direction::Given(p[0] - eye));
    Setting { eye, planes, points, splitters, directions }
}

/// Every predicate on everything.
fn ask(kernel: &mut Kernel, setting: &Setting, directions: &[DirectionId], splitters: &[SplitterId]) {
    for (d, d_id) in setting.directions.iter().zip(directions) {
        for (s, s_id) in setting.splitters.iter().zip(splitters) {
            assert_eq!(kernel.side(d, s), kernel.side_of(*d_id, *s_id));
        }
        kernel.depth_order([&setting.planes[0], &setting.planes[1]], d);
    }
    for (a, a_id) in setting.splitters.iter().zip(splitters) {
        for (b, b_id) in setting.splitters.iter().zip(splitters) {
            kernel.compare_circles(a, b);
            for (c, c_id) in setting.splitters.iter().zip(splitters) {
                assert_eq!(kernel.orientation([a, b, c]), kernel.orientation_of([*a_id, *b_id, *c_id]));
            }
        }
    }
    kernel.order_along(&setting.splitters[0], &setting.directions[4], &setting.directions[0]);
    for point in &setting.points {
        for plane in &setting.planes {
            kernel.plane_side(point, plane);
        }
    }
}

#[test]
fn a_warm_kernel_allocates_nothing_up_to_the_last_stage() {
    // 20 bits as small models have, 44 as single precision, 50 as doubles on a grid.
    for bits in [20, 44, 50] {
        let setting = setting(bits);
        let mut kernel = Kernel::new([setting.eye], setting.eye);
        let directions: Vec<_> = setting.directions.iter().map(|d| kernel.add_direction(d)).collect();
        let splitters: Vec<_> = setting.splitters.iter().map(|s| kernel.add_splitter(s)).collect();
        ask(&mut kernel, &setting, &directions, &splitters);
        kernel.reset_stats();
        let info = allocation_counter::measure(|| ask(&mut kernel, &setting, &directions, &splitters));
        let stats = kernel.stats();
        assert_eq!(info.count_total, 0, "{bits} bits: {stats:?}");
        assert!(stats.filter > 0 && stats.identity > 0 && stats.fixed > 50, "all stages were reached: {stats:?}");
        assert_eq!(stats.arbitrary, PredicateStats::default().arbitrary, "{bits} bits: {stats:?}");
    }
}

#[test]
fn orient3d_allocates_nothing_up_to_the_last_stage() {
    for scale in [1.0, 2f64.powi(-900), 2f64.powi(900)] {
        let [a, b, c] = [DVec3::new(1.0, 2.0, 0.5), DVec3::new(-3.0, 1.5, 2.0), DVec3::new(0.25, 0.75, -1.0)];
        for d in [a + b - c, DVec3::ONE] {
            let info = allocation_counter::measure(|| {
                orient3d(a * scale, b * scale, c * scale, d * scale);
            });
            assert_eq!(info.count_total, 0, "{scale:e}");
        }
    }
}

/// Memory that is asked for at most while something is read, in bytes.
fn memory(read: impl FnOnce() -> bool) -> u64 {
    allocation_counter::measure(|| assert!(!read(), "it is refused")).bytes_max
}

#[test]
fn files_that_promise_much_and_hold_little_take_little_memory() {
    let options = ReadOptions::default();
    let mut lying = vec![b' '; 80];
    lying.extend(u32::MAX.to_le_bytes());
    lying.extend([0; 50]);
    let stl = memory(|| stl::parse(&lying, "x.stl", &options).is_ok());
    let header = "ply\nformat binary_big_endian 1.0\nelement vertex 4000000000\nproperty double x\nproperty double y\n\
                  property double z\nelement face 4000000000\nproperty list uint uint vertex_indices\nend_header\n";
    let vertices = memory(|| ply::parse(header.as_bytes(), "x.ply", &options).is_ok());
    let header = header.replace("vertex 4000000000", "vertex 0").replace("face 4000000000", "face 1");
    let list = [header.as_bytes(), &[255; 4], &[0; 100]].concat();
    let faces = memory(|| ply::parse(&list, "x.ply", &options).is_ok());
    for (what, bytes) in [("triangles", stl), ("vertices", vertices), ("a face", faces)] {
        assert!(bytes < 20_000, "{what}: {bytes} bytes");
    }
}

#[test]
#[cfg(all(feature = "gltf", feature = "cityjson"))]
fn json_that_promises_much_and_holds_little_takes_little_memory() {
    let options = ReadOptions::default();
    let gltf = |accessor: &str, nodes: &str, scene: &str| {
        let text = format!(
            r#"{{"asset":{{"version":"2.0"}},"scenes":[{{"nodes":[{scene}]}}],"nodes":[{nodes}],
            "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}}}}]}}],
            "accessors":[{{"componentType":5126,"type":"VEC3",{accessor}}}]}}"#
        );
        (text.len(), memory(|| gltf::parse(text.as_bytes(), "x.gltf", &options, |_| Ok(Vec::new())).is_ok()))
    };
    // Zeros that no buffer holds: once, and a thousand times.
    let (_, once) = gltf(r#""count":3000000000"#, r#"{"mesh":0}"#, "0");
    assert!(once < 20_000, "{once} bytes");
    let nodes = vec![r#"{"mesh":0}"#; 1000].join(",");
    let numbers = (0..1000).map(|k| k.to_string()).collect::<Vec<_>>().join(",");
    let (size, many) = gltf(r#""count":3000000"#, &nodes, &numbers);
    assert!(many < 60 * size as u64, "{many} bytes for {size}");
    let text = format!(
        r#"{{"type":"CityJSON","version":"2.0","vertices":[[0,0,0]],"CityObjects":{{"a":{{"type":"x","geometry":[{}]}}}},
        "geometry-templates":{{"templates":[{{"type":"MultiSurface","boundaries":[{}]}}],"vertices-templates":[]}}}}"#,
        vec![r#"{"type":"GeometryInstance","template":0,"boundaries":[0],"transformationMatrix":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]}"#; 10_000].join(","),
        vec!["[[0,0,0]]"; 10_000].join(","),
    );
    let city = memory(|| cityjson::parse(text.as_bytes(), "x.json", &options).is_ok());
    assert!(city < 60 * text.len() as u64, "{city} bytes for {}", text.len());
}

/// How often each of some views of a room asks for memory if it may use what views from the same points have left; and how many insertions
/// it makes.
fn allocations_of_views(polygons: usize, order_of: fn(&Scene) -> SceneOrder) -> Vec<(u64, usize)> {
    let room = generate(Kind::Room, polygons, 1).expect("a size the generator takes");
    let order = order_of(&room.to_builder().build().expect("a generated scene is valid"));
    let eyes: Vec<_> = room.free_points(4, 3).into_iter().map(|p| Viewpoint::free(DVec3::from(p))).collect();
    let mut space = ViewSpace::new();
    let mut view = |eye: &Viewpoint| {
        let mut inserted = 0;
        let info = allocation_counter::measure(|| {
            let image = order.view_in(&mut space, eye, &Domain::Hemisphere(DVec3::Z), &ViewOptions::default());
            inserted = image.expect("a view").stats().inserted;
        });
        (info.count_total, inserted)
    };
    for eye in &eyes {
        view(eye);
    }
    eyes.iter().map(view).collect()
}

#[test]
fn views_in_memory_of_others_ask_for_little_however_much_they_put_in() {
    for polygons in [200, 1_000, 10_000] {
        let by_boxes = allocations_of_views(polygons, |scene| SceneBvh::build(scene).into());
        // The octants and the horizon, and integers of arbitrary width now and then.
        assert!(by_boxes.iter().all(|(count, _)| *count <= 20), "{polygons} polygons: {by_boxes:?}");
        let by_bsp = allocations_of_views(polygons, |scene| {
            SceneBsp::build(scene, &BspOptions::default()).expect("epsilon is 0").into()
        });
        // A node lists the fragments that are seen from behind apart.
        assert!(by_bsp.iter().all(|(count, n)| *count <= 20 + *n as u64 / 10), "{polygons} polygons: {by_bsp:?}");
        let most = by_boxes.iter().map(|(_, inserted)| *inserted).max();
        assert!(polygons < 10_000 || most > Some(100), "what many insertions take is tested: {by_boxes:?}");
    }
}
