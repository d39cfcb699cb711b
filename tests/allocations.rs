//! No stage of the predicates but the last, integers of arbitrary width, touches the heap once a kernel is
//! warm.

use glam::DVec3;
use nusselt::exact::{Direction, DirectionId, Kernel, Plane, Point, PredicateStats, Splitter, SplitterId, orient3d};

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
