//! An outside opinion: the visible areas of polygons on the faces of a cube, from the boolean operations of
//! `geo`.
//!
//! No order is used: of every piece, what every other one hides of it is cut off. On its own outline another
//! piece is nearer where one linear function of the direction says so, so that what it hides is convex too.

mod common;

use common::face::{area, cut, faces, on_face, perimeter};
use common::scenes::{Case, generated, odd, soups};
use geo::algorithm::bool_ops::{FillRule, OpType};
use geo::{Area, BooleanOps, Coord, LineString, MultiPolygon, Polygon, Validation};
use glam::{DMat3, DVec2, DVec3};
use nusselt::bsp::{BspOptions, SceneBsp};
use nusselt::contour::{ContourImage, Domain, Viewpoint};
use nusselt::scene::{PieceId, PieceRef, PolygonId, Scene, Side};
use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// `geo` rounds coordinates to a grid of 2^-29 of half the input's extent or finer, here at most 1.
const PITCH: f64 = 1.0 / (1u64 << 29) as f64;

/// How far `geo` may move an edge: sqrt(1/2) of the pitch when its ends are put on the grid, the same
/// again when it is cut at crossings, which are rounded too; and once more, since its parts are cut again.
const MOVED: f64 = 2.2 * PITCH;

/// A piece as it appears on a face.
struct Seen {
    polygon: PolygonId,
    piece: PieceId,
    side: Side,
    /// Three of its vertices that are not collinear.
    plane: [DVec3; 3],
    /// One over the depth along `d` is `rate . d`, in the coordinates of the face.
    rate: DVec3,
    outline: Vec<DVec2>,
}

impl Seen {
    fn new(face: DMat3, eye: DVec3, piece: PieceRef<'_>) -> Option<Self> {
        let points: Vec<DVec3> = piece.points().collect();
        let normal = |k: usize| (points[k] - points[0]).cross(points[k + 1] - points[0]);
        let best = (1..points.len() - 1).max_by(|&j, &k| normal(j).length().total_cmp(&normal(k).length()))?;
        let plane = [points[0], points[best], points[best + 1]];
        let side = match height(plane, eye) {
            h if h > 0.0 => Side::Front,
            h if h < 0.0 => Side::Back,
            _ => return None,
        };
        let rate = face * (normal(best) / normal(best).dot(points[0] - eye));
        let outline = on_face(face, points.iter().map(|&p| p - eye));
        let seen = Self { polygon: piece.polygon(), piece: piece.id(), side, plane, rate, outline };
        (!seen.outline.is_empty()).then_some(seen)
    }

    /// What this piece hides of another one.
    fn hides(&self, other: &Self) -> Vec<DVec2> {
        let outline = self.outline.iter();
        if self.plane.iter().all(|&p| height(other.plane, p) == 0.0) {
            let rank = |seen: &Self| (seen.side, seen.polygon, seen.piece);
            return if rank(self) < rank(other) { outline.copied().collect() } else { Vec::new() };
        }
        let corners: Vec<DVec3> = outline.map(|p| p.extend(1.0)).collect();
        let nearer = cut(&corners, self.rate - other.rate);
        if nearer.len() < 3 { Vec::new() } else { nearer.into_iter().map(DVec3::truncate).collect() }
    }
}

/// Positive on the front of a plane; the sign is exact.
fn height(plane: [DVec3; 3], point: DVec3) -> f64 {
    let [a, b, c, d] = [plane[0], plane[1], plane[2], point].map(|p| robust::Coord3D { x: p.x, y: p.y, z: p.z });
    -robust::orient3d(a, b, c, d)
}

fn polygon(corners: &[DVec2]) -> Polygon {
    Polygon::new(LineString(corners.iter().map(|p| Coord { x: p.x, y: p.y }).collect()), Vec::new())
}

/// What came out, by polygons on faces.
#[derive(Debug, Default)]
struct Counts {
    views: usize,
    agreements: usize,
    panics: usize,
    invalid: usize,
    operations: usize,
    difference: f64,
    tolerance: f64,
    /// The largest difference by its tolerance.
    share: f64,
}

impl Counts {
    fn without_verdict(&self) -> usize {
        self.panics + self.invalid
    }
}

/// The opinion on a polygon on a face: its visible area and its tolerance.
#[derive(Clone, Copy, Debug)]
enum Opinion {
    Area(f64, f64),
    Panicked,
    Invalid,
}

fn visible(seen: &Seen, all: &[Seen]) -> Opinion {
    let others = all.iter().filter(|other| other.piece != seen.piece);
    let hidden: Vec<Vec<DVec2>> = others.map(|other| other.hides(seen)).filter(|part| !part.is_empty()).collect();
    let length = perimeter(&seen.outline) + hidden.iter().map(|part| perimeter(part)).sum::<f64>();
    let whole = polygon(&seen.outline);
    let hidden = MultiPolygon::new(hidden.iter().map(|part| polygon(part)).collect());
    // The hidden parts overlap, all counter-clockwise: what is hidden is where they wind around at all.
    let operation = || whole.boolean_op_with_fill_rule(&hidden, OpType::Difference, FillRule::NonZero);
    match catch_unwind(AssertUnwindSafe(operation)) {
        Err(_) => Opinion::Panicked,
        Ok(left) if !left.is_valid() => Opinion::Invalid,
        Ok(left) => Opinion::Area(left.unsigned_area(), length * MOVED),
    }
}

fn compare(name: &str, image: &ContourImage, counts: &mut Counts) {
    let scene: &Scene = image.scene();
    let eye = image.viewpoint().eye();
    counts.views += 1;
    for face in faces() {
        let seen: Vec<Seen> = scene.pieces().filter_map(|piece| Seen::new(face, eye, piece)).collect();
        let mut opinions: BTreeMap<PolygonId, Opinion> = BTreeMap::new();
        for piece in &seen {
            counts.operations += 1;
            let sum = opinions.entry(piece.polygon).or_insert(Opinion::Area(0.0, 0.0));
            *sum = match (*sum, visible(piece, &seen)) {
                (Opinion::Area(a, s), Opinion::Area(b, t)) => Opinion::Area(a + b, s + t),
                (Opinion::Area(..), other) | (other, _) => other,
            };
        }
        let mut ours: BTreeMap<PolygonId, f64> = BTreeMap::new();
        for cell in image.cells() {
            if let Some(polygon) = cell.polygon() {
                *ours.entry(polygon).or_default() += area(&on_face(face, cell.boundary()));
            }
        }
        for (polygon, opinion) in opinions {
            let area = ours.remove(&polygon).unwrap_or_default();
            match opinion {
                Opinion::Area(theirs, tolerance) => {
                    let difference = (area - theirs).abs();
                    assert!(
                        difference <= tolerance,
                        "{name} from {eye}, on {face}: {polygon:?}: {area}, by geo {theirs}, tolerance {tolerance:e}"
                    );
                    counts.agreements += 1;
                    counts.difference = counts.difference.max(difference);
                    counts.tolerance = counts.tolerance.max(tolerance);
                    counts.share = counts.share.max(difference / tolerance);
                }
                Opinion::Panicked => counts.panics += 1,
                Opinion::Invalid => counts.invalid += 1,
            }
        }
        assert!(ours.values().all(|&area| area < 1e-12), "{name} from {eye}: more is seen than there is: {ours:?}");
    }
}

fn compare_all(cases: &[Case]) -> Counts {
    let mut counts = Counts::default();
    for case in cases {
        let bsp = SceneBsp::build(&case.scene, &BspOptions::default()).expect("epsilon is 0");
        for &eye in &case.eyes {
            let image = bsp.view(&Viewpoint::free(eye), &Domain::Sphere).expect("a finite eye");
            compare(&case.name, &image, &mut counts);
        }
    }
    println!("{counts:#?}");
    counts
}

#[test]
fn visible_areas_in_generated_scenes_are_those_of_polygon_booleans() {
    let counts = compare_all(&generated(300, 2, 4));
    assert!(counts.without_verdict() * 100 <= counts.agreements, "{counts:?}");
}

#[test]
fn visible_areas_in_odd_scenes_are_those_of_polygon_booleans() {
    let counts = compare_all(&odd());
    assert!(counts.without_verdict() * 100 <= counts.agreements, "{counts:?}");
}

#[test]
fn visible_areas_on_coarse_grids_are_those_of_polygon_booleans() {
    let counts = compare_all(&soups(200));
    assert!(counts.without_verdict() * 100 <= counts.agreements, "{counts:?}");
}
