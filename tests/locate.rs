//! Point location against an oracle that shares nothing with it: rational numbers, every cell tried.

mod common;

use common::Faces;
use glam::DVec3;
use num_rational::BigRational;
use num_traits::{Signed, Zero};
use nusselt::bsp::{BspOptions, SceneBsp};
use nusselt::contour::{
    Branch, BranchKind, CellId, ContourImage, Domain, Location, Region, Splitter, ViewOptions, Viewpoint,
};
use nusselt::exact::Sign;
use nusselt::scene::{Scene, SupportingPlane};
use nusselt::verify::{RayAnswer, RayOracle};
use proptest::prelude::*;
use std::collections::BTreeMap;

type Vector = [BigRational; 3];

fn exact(v: DVec3) -> Vector {
    v.to_array().map(|x| BigRational::from_float(x).expect("finite"))
}

fn minus(a: &Vector, b: &Vector) -> Vector {
    std::array::from_fn(|k| &a[k] - &b[k])
}

fn cross(a: &Vector, b: &Vector) -> Vector {
    std::array::from_fn(|k| &a[(k + 1) % 3] * &b[(k + 2) % 3] - &a[(k + 2) % 3] * &b[(k + 1) % 3])
}

fn dot(a: &Vector, b: &Vector) -> BigRational {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

/// The normal of a plane and a point of it.
fn plane(scene: &Scene, plane: SupportingPlane) -> [Vector; 2] {
    match plane {
        SupportingPlane::Axis { axis, value } => {
            let unit = DVec3::AXES[axis as usize];
            [exact(unit), exact(unit * value)]
        }
        SupportingPlane::Points(points) => {
            let [a, b, c] = points.map(|v| exact(scene.vertex(v)));
            [cross(&minus(&b, &a), &minus(&c, &a)), a]
        }
    }
}

fn normal(scene: &Scene, eye: &Vector, splitter: Splitter) -> Vector {
    match splitter {
        Splitter::Edge(ends) => {
            let [a, b] = ends.map(|v| minus(&exact(scene.vertex(v)), eye));
            cross(&a, &b)
        }
        Splitter::Points(_) => unreachable!("there are no free windows"),
        Splitter::Crease(planes) => {
            let [[n1, p1], [n2, p2]] = planes.map(|p| plane(scene, p));
            let [h1, h2] = [dot(&n1, &minus(eye, &p1)), dot(&n2, &minus(eye, &p2))];
            std::array::from_fn(|k| &h2 * &n1[k] - &h1 * &n2[k])
        }
        Splitter::Given(normal) => exact(normal),
        Splitter::Parallel(parallel) => {
            let [n, _] = plane(scene, parallel);
            n
        }
    }
}

/// A place in the closure of a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Place {
    Interior,
    Side,
    Corner,
}

/// Cells as inward normals, made from nothing but their splitters, the scene and the eye.
struct Cells {
    normals: Vec<Vec<Vector>>,
    /// Inward, if the domain is a hemisphere.
    horizon: Option<Vector>,
}

impl Cells {
    fn of(image: &ContourImage) -> Self {
        let scene = image.scene();
        let eye = exact(image.viewpoint().eye());
        let inward = |(splitter, inside): (Splitter, Sign)| {
            let normal = normal(scene, &eye, splitter);
            if inside == Sign::Positive { normal } else { normal.map(|x| -x) }
        };
        let normals = image.cells().map(|cell| cell.splitters().map(inward).collect()).collect();
        let horizon = match image.domain() {
            Domain::Hemisphere(normal) => Some(exact(*normal)),
            _ => None,
        };
        Self { normals, horizon }
    }

    fn place(&self, cell: usize, direction: &Vector) -> Option<Place> {
        let mut touched: Option<&Vector> = None;
        let mut place = Place::Interior;
        for normal in &self.normals[cell] {
            let side = dot(normal, direction);
            if side.is_negative() {
                return None;
            }
            if side.is_zero() {
                match touched {
                    None => place = Place::Side,
                    Some(other) if cross(other, normal).iter().any(|x| !x.is_zero()) => place = Place::Corner,
                    Some(_) => {}
                }
                touched = touched.or(Some(normal));
            }
        }
        Some(place)
    }

    /// What `locate` should say.
    fn locate(&self, direction: DVec3) -> Location {
        self.locate_exactly(&exact(direction))
    }

    fn locate_exactly(&self, direction: &Vector) -> Location {
        let places: BTreeMap<CellId, Place> = (0..self.normals.len())
            .filter_map(|k| self.place(k, direction).map(|place| (CellId(k as u32), place)))
            .collect();
        let of = |wanted| places.iter().filter(move |(_, place)| **place == wanted).map(|(&cell, _)| cell);
        let height = self.horizon.as_ref().map(|normal| dot(normal, direction));
        let is_rim = height.as_ref().is_some_and(Zero::is_zero);
        if height.is_some_and(|h| h.is_negative()) {
            assert!(places.is_empty(), "cells {places:?} below the horizon");
            return Location::Outside;
        }
        let inside: Vec<CellId> = of(Place::Interior).collect();
        if let [cell] = inside[..] {
            assert_eq!(
                (places.len(), is_rim),
                (1, false),
                "an interior meets another cell, or the horizon: {places:?}"
            );
            return Location::Cell(cell);
        }
        assert!(inside.is_empty(), "cells overlap: {inside:?}");
        let corners: Vec<CellId> = of(Place::Corner).collect();
        let mut beside: Vec<Region> = of(Place::Side).map(Region::Cell).collect();
        beside.extend(is_rim.then_some(Region::Outside));
        if corners.is_empty() {
            let between = beside.try_into().expect("two regions at an arc");
            return Location::Arc { between };
        }
        assert!(beside.len() <= 1, "half planes leave nothing for a corner: {beside:?}, {corners:?}");
        Location::Vertex { corners, beside }
    }
}

/// The region that a direction comes to in the contour tree, if it is on no great circle above that.
fn walk(branch: Branch<'_>, image: &ContourImage, direction: &Vector) -> Option<Region> {
    match branch.kind() {
        BranchKind::Cell(cell) => Some(Region::Cell(cell.id())),
        BranchKind::Outside => Some(Region::Outside),
        BranchKind::Node { splitter, normal: rounded, negative, positive } => {
            let normal = normal(image.scene(), &exact(image.viewpoint().eye()), splitter);
            // A unit vector, and off by a few roundings of 2^-53 at most.
            let [size, off] = [exact(rounded), cross(&normal, &exact(rounded))].map(|v| dot(&v, &v));
            let hair = BigRational::from_float(1e-29).expect("finite");
            assert!(dot(&normal, &exact(rounded)).is_positive() && off < &hair * dot(&normal, &normal), "{rounded}");
            assert!((size - BigRational::from_float(1.0).expect("finite")).abs() < BigRational::from_float(1e-14)?);
            let height = dot(&normal, direction);
            (!height.is_zero())
                .then(|| if height.is_positive() { positive } else { negative })
                .and_then(|branch| walk(branch, image, direction))
        }
    }
}

/// How many answers of each kind there were.
#[derive(Debug, Default, PartialEq, Eq)]
struct Counts {
    cells: usize,
    arcs: usize,
    vertices: usize,
    junctions: usize,
    outside: usize,
}

fn check(image: &ContourImage, directions: impl IntoIterator<Item = DVec3>, counts: &mut Counts) {
    let cells = Cells::of(image);
    let eye = image.viewpoint().eye();
    let oracle = RayOracle::new(image.scene());
    for direction in directions {
        let location = image.locate(direction);
        assert_eq!(location, cells.locate(direction), "from {eye} towards {direction}");
        for length in [3.0, 0.375, 2_f64.powi(1000), 2_f64.powi(-1070)] {
            assert_eq!(image.locate(direction * length), location, "{length} times {direction}");
        }
        match walk(image.tree(), image, &exact(direction)) {
            Some(region) => assert_eq!(location.regions(), [region]),
            None => assert!(!matches!(location, Location::Cell(_)), "a splitter runs through a cell"),
        }
        match &location {
            Location::Cell(cell) => {
                counts.cells += 1;
                assert_eq!(location.regions(), [Region::Cell(*cell)]);
                let seen = image.cell(*cell).polygon();
                match oracle.cast(eye, direction) {
                    RayAnswer::Hit { polygon, .. } => assert_eq!(seen, Some(polygon), "from {eye} towards {direction}"),
                    RayAnswer::Miss => assert_eq!(seen, None, "from {eye} towards {direction}"),
                    // An edge within what one polygon covers, say between its pieces.
                    RayAnswer::Boundary => {}
                }
            }
            Location::Arc { between } => {
                counts.arcs += 1;
                assert_eq!(location.regions(), between);
                assert!(between[0] < between[1], "ascending, and different");
            }
            Location::Vertex { corners, beside } => {
                counts.vertices += 1;
                counts.junctions += beside.len();
                let regions = location.regions();
                assert!(regions.len() == corners.len() + beside.len() && regions.len() >= 2);
                assert!(regions.is_sorted_by(|a, b| a < b), "ascending, and different");
                assert!(corners.iter().all(|&cell| regions.contains(&Region::Cell(cell))));
            }
            Location::Outside => {
                counts.outside += 1;
                assert_eq!(location.regions(), [Region::Outside]);
            }
        }
    }
}

/// All directions of whole numbers up to `most`, without multiples.
fn grid(most: i32) -> Vec<DVec3> {
    let mut directions = Vec::new();
    let gcd = |mut a: i32, mut b: i32| {
        while b != 0 {
            (a, b) = (b, a % b);
        }
        a.abs()
    };
    for x in -most..=most {
        for y in -most..=most {
            for z in -most..=most {
                if gcd(gcd(x, y), z) == 1 {
                    directions.push(DVec3::new(f64::from(x), f64::from(y), f64::from(z)));
                }
            }
        }
    }
    directions
}

fn view(scene: &Scene, eye: DVec3, domain: &Domain, depth: u32) -> ContourImage {
    let bsp = SceneBsp::build(scene, &BspOptions::default()).expect("epsilon is 0");
    let options = ViewOptions { quadtree_depth: Some(depth), ..Default::default() };
    bsp.view_with(&Viewpoint::free(eye), domain, &options).expect("a finite eye")
}

#[test]
fn octants_have_their_arcs_and_vertices() {
    let scene = Scene::builder().build().unwrap();
    let image = view(&scene, DVec3::ZERO, &Domain::Sphere, 0);
    let mut counts = Counts::default();
    check(&image, grid(1), &mut counts);
    assert_eq!(counts, Counts { cells: 8, arcs: 12, vertices: 6, ..Default::default() });
    let Location::Vertex { corners, beside } = image.locate(DVec3::X) else { panic!("no vertex") };
    assert_eq!((corners.len(), beside.len()), (4, 0));

    let image = view(&scene, DVec3::ZERO, &Domain::Hemisphere(DVec3::Z), 0);
    let mut counts = Counts::default();
    check(&image, grid(1), &mut counts);
    // On the horizon lie four arcs between a quarter and what is outside, and four vertices.
    assert_eq!(counts, Counts { cells: 4, arcs: 8, vertices: 5, junctions: 4, outside: 9 });
    let down = image.locate(DVec3::new(1.0, 1.0, -0.0));
    assert!(matches!(down, Location::Arc { between: [Region::Cell(_), Region::Outside] }), "{down:?}");
}

#[test]
fn directions_that_name_nothing_are_outside() {
    let image = view(&Scene::builder().build().unwrap(), DVec3::ONE, &Domain::Sphere, 1);
    for direction in [DVec3::ZERO, DVec3::NAN, DVec3::new(0.0, f64::INFINITY, 1.0), DVec3::new(-0.0, 0.0, -0.0)] {
        assert_eq!(image.locate(direction), Location::Outside);
    }
}

#[test]
fn no_length_and_no_ratio_is_too_large() {
    let mut faces = Faces::default();
    faces.face(&[[1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [1.0, 0.0, 2.0]].map(DVec3::from));
    let image = view(&faces.build(), DVec3::ZERO, &Domain::Sphere, 2);
    let [least, most, unit] = [5e-324, f64::MAX, 1.0];
    let sizes = [0.0, least, unit, most, -least, -unit, -most];
    let directions = sizes.iter().flat_map(|&x| sizes.iter().map(move |&y| (x, y)));
    let directions = directions.flat_map(|(x, y)| sizes.iter().map(move |&z| DVec3::new(x, y, z)));
    let cells = Cells::of(&image);
    for direction in directions.filter(|&d| d != DVec3::ZERO) {
        assert_eq!(image.locate(direction), cells.locate(direction), "{direction:?}");
    }
    // Just above the triangle's lower edge, on it, and just below it.
    let seen = |z: f64| image.locate(DVec3::new(1.0, 0.25, z));
    assert!(matches!(seen(0.0), Location::Arc { .. }), "{:?}", seen(0.0));
    for (z, polygon) in [(least, true), (-least, false)] {
        let Location::Cell(cell) = seen(z) else { panic!("no cell") };
        assert_eq!(image.cell(cell).polygon().is_some(), polygon);
    }
}

#[test]
fn points_are_located_in_their_exact_directions() {
    let mut faces = Faces::default();
    faces.face(&[[2.0, -1.0, -1.0], [2.0, 1.0, -1.0], [2.0, 1.0, 1.0], [2.0, -1.0, 1.0]].map(DVec3::from));
    faces.face(&[[3.0, -4.1, -1.3], [3.3, 4.7, -1.9], [3.7, 1.1, 5.3]].map(DVec3::from));
    let eye = DVec3::new(0.1, 0.7, 0.3);
    let image = view(&faces.build(), eye, &Domain::Sphere, 1);
    let cells = Cells::of(&image);
    let (mut inside, mut between, mut rounded) = (0, 0, 0);
    let vertices = image.scene().vertices().to_vec();
    let middles = vertices.iter().flat_map(|&a| vertices.iter().map(move |&b| a * 0.5 + b * 0.5));
    let near = |p: DVec3| [p, DVec3::new(p.x.next_up(), p.y, p.z), DVec3::new(p.x, p.y, p.z.next_down()), p * 1e-200];
    for point in middles.flat_map(near) {
        let location = image.locate_point(point);
        assert_eq!(location, cells.locate_exactly(&minus(&exact(point), &exact(eye))), "{point:?}");
        match location {
            Location::Cell(_) => inside += 1,
            _ => between += 1,
        }
        rounded += u32::from(image.locate(point - eye) != location);
    }
    assert!(inside > 10 && between > 10, "{inside} {between}");
    assert!(rounded > 0, "rounding the difference is as good");
    assert_eq!(image.locate_point(eye), Location::Outside);
    assert_eq!(image.locate_point(DVec3::NAN), Location::Outside);
}

#[test]
fn collinear_vertices_are_no_corners() {
    // A square with two more vertices on its lower edge, and a triangle that hides one end of that edge.
    let mut faces = Faces::default();
    let square = [[4.0, -2.0, -2.0], [4.0, -1.0, -2.0], [4.0, 0.0, -2.0], [4.0, 2.0, -2.0], [4.0, 2.0, 2.0]];
    faces.face(&square.into_iter().chain([[4.0, -2.0, 2.0]]).map(DVec3::from).collect::<Vec<_>>());
    for depth in 0..4 {
        let image = view(&faces.build(), DVec3::ZERO, &Domain::Sphere, depth);
        let at = image.locate(DVec3::new(4.0, -1.0, -2.0));
        // Deeper quadtrees cut there.
        assert!(depth > 1 || matches!(at, Location::Arc { .. }), "depth {depth}: {at:?}");
        let mut counts = Counts::default();
        check(&image, square.map(DVec3::from), &mut counts);
        check(&image, grid(2), &mut counts);
    }
}

#[test]
fn in_t_junctions_the_cell_beside_is_named() {
    // A triangle whose tip is within the upper edge of a wall.
    let mut faces = Faces::default();
    faces.face(&[[2.0, -1.0, -1.0], [2.0, 1.0, -1.0], [2.0, 1.0, 1.0], [2.0, -1.0, 1.0]].map(DVec3::from));
    faces.face(&[[2.0, 0.0, 1.0], [2.0, 1.0, 3.0], [2.0, -1.0, 3.0]].map(DVec3::from));
    // Off the diagonals of the quadtree.
    let image = view(&faces.build(), DVec3::new(0.0, 0.25, 0.5), &Domain::Sphere, 0);
    let mut counts = Counts::default();
    let tip = DVec3::new(2.0, -0.25, 0.5);
    check(&image, [tip], &mut counts);
    let Location::Vertex { corners, beside } = image.locate(tip) else { panic!("no vertex") };
    assert_eq!(beside.len(), 1, "{corners:?}, {beside:?}");
    let Region::Cell(wall) = beside[0] else { panic!("the sphere has no outside") };
    assert_eq!(image.cell(wall).polygon().map(|p| p.0), Some(0));
}

/// Triangles and squares on a small grid.
fn scenes() -> impl Strategy<Value = Scene> {
    let point = || prop::array::uniform3(-2..=2_i32).prop_map(|p| DVec3::from(p.map(f64::from)));
    let face = (point(), point(), point(), any::<bool>())
        .prop_map(|(a, b, c, four)| if four { vec![a, b, c, a + c - b] } else { vec![a, b, c] });
    prop::collection::vec(face, 1..7).prop_filter_map("no scene", |loops| {
        let mut faces = Faces::default();
        for corners in loops {
            if (corners[1] - corners[0]).cross(corners[2] - corners[0]) != DVec3::ZERO {
                faces.face(&corners);
            }
        }
        (!faces.faces.is_empty()).then(|| faces.build())
    })
}

fn small(most: i32) -> impl Strategy<Value = DVec3> {
    prop::array::uniform3(-most..=most).prop_map(|p| DVec3::from(p.map(f64::from)))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn locations_are_those_of_rational_side_tests(
        scene in scenes(),
        eye in small(3),
        normal in small(1),
        depth in 0..3_u32,
        more in prop::collection::vec(small(5), 4),
    ) {
        let domain = if normal == DVec3::ZERO { Domain::Sphere } else { Domain::Hemisphere(normal) };
        let image = view(&scene, eye, &domain, depth);
        let mut counts = Counts::default();
        check(&image, grid(1).into_iter().chain(more).filter(|&d| d != DVec3::ZERO), &mut counts);
        // Towards vertices and middles of edges, and away from them; on this grid the subtraction is exact.
        let vertices = scene.vertices().iter().map(|&v| v - eye);
        let middles = scene.edges().iter().map(|edge| edge.map(|v| scene.vertex(v) - eye)).map(|[a, b]| a + b);
        let directions = vertices.chain(middles).flat_map(|d| [d, -d]).filter(|&d| d != DVec3::ZERO);
        check(&image, directions.take(40), &mut counts);
    }
}
