//! An outside opinion: faces of a cube around the eye, triangulated by `spade`, labelled by rays.

mod common;

use common::Faces;
use common::scenes::{Case, generated, odd, soups};
use glam::{DQuat, DVec3};
use nusselt::bsp::{BspOptions, SceneBsp};
use nusselt::contour::{ContourImage, Domain, Location, Viewpoint};
use nusselt::scene::{PieceId, PieceRef, PolygonId};
use nusselt::verify::outside::{Claim, Disagreement, FaceOpinion, NoVerdict, Outline, second_opinion};
use std::collections::BTreeMap;

/// The opinions on the faces of many views.
#[derive(Debug, Default)]
struct Counts {
    views: usize,
    agreements: usize,
    disagreements: usize,
    reasons: BTreeMap<String, usize>,
    triangles: usize,
    skipped: usize,
    difference: f64,
    tolerance: f64,
    /// Views with a verdict on all faces, and the largest difference of a polygon's solid angle in them.
    whole: usize,
    solid_angle: f64,
}

impl Counts {
    fn faces(&self) -> usize {
        6 * self.views
    }
}

fn claim(image: &ContourImage, direction: DVec3) -> Claim {
    match image.locate(direction) {
        Location::Cell(cell) => Claim::Shows(image.cell(cell).polygon()),
        Location::Arc { .. } | Location::Vertex { .. } => Claim::Boundary,
        Location::Outside => Claim::Outside,
    }
}

fn outlines(image: &ContourImage) -> Vec<Outline> {
    image.cells().map(|cell| Outline { polygon: cell.polygon(), corners: cell.boundary().collect() }).collect()
}

fn view(case: &Case, eye: DVec3) -> ContourImage {
    let bsp = SceneBsp::build(&case.scene, &BspOptions::default()).expect("epsilon is 0");
    bsp.view(&Viewpoint::free(eye), &Domain::Sphere).expect("a finite eye")
}

fn judge(case: &Case, eye: DVec3, counts: &mut Counts) {
    let image = view(case, eye);
    let opinions = second_opinion(&case.scene, eye, &outlines(&image), |d| claim(&image, d));
    counts.views += 1;
    let mut whole: BTreeMap<Option<PolygonId>, f64> = BTreeMap::new();
    let (mut tolerance, mut verdicts) = (0.0, 0);
    for opinion in opinions {
        match opinion {
            FaceOpinion::Agreement(face) => {
                verdicts += 1;
                counts.agreements += 1;
                counts.triangles += face.triangles;
                counts.skipped += face.skipped;
                counts.difference = counts.difference.max(face.difference);
                counts.tolerance = counts.tolerance.max(face.tolerance);
                tolerance += face.tolerance;
                for (polygon, angle) in face.solid_angles {
                    *whole.entry(polygon).or_default() += angle;
                }
            }
            FaceOpinion::Disagreement(disagreement) => {
                counts.disagreements += 1;
                eprintln!("{} from {eye}: {disagreement:?}", case.name);
            }
            FaceOpinion::NoVerdict(reason) => {
                eprintln!("{} from {eye}: no verdict: {reason}", case.name);
                let kind = format!("{reason:?}");
                let kind = kind.split([' ', '{']).next().unwrap_or_default().to_owned();
                *counts.reasons.entry(kind).or_default() += 1;
            }
        }
    }
    if verdicts == 6 {
        counts.whole += 1;
        // A solid angle is not larger than the area on the face. The sums are ours, over cells, and go
        // through all corners once more: a few roundings each.
        let sums = image.solid_angles();
        tolerance += 1e-13 * image.cell_count() as f64;
        let ours = sums.polygons.iter().map(|sum| (Some(sum.polygon), sum.both()));
        for (polygon, angle) in ours.chain([(None, sums.background)]) {
            let theirs = whole.remove(&polygon).unwrap_or_default();
            let difference = (angle - theirs).abs();
            counts.solid_angle = counts.solid_angle.max(difference);
            assert!(difference <= tolerance, "{} from {eye}: {polygon:?}: {angle}, by triangles {theirs}", case.name);
        }
        assert!(whole.values().all(|&angle| angle <= tolerance), "{} from {eye}: more is seen: {whole:?}", case.name);
    }
}

fn judge_all(cases: &[Case]) -> Counts {
    let mut counts = Counts::default();
    for case in cases {
        for &eye in &case.eyes {
            judge(case, eye, &mut counts);
        }
    }
    println!("{counts:#?}");
    counts
}

#[test]
fn triangulated_faces_agree_on_generated_scenes() {
    let counts = judge_all(&generated(400, 3, 4));
    assert_eq!(counts.disagreements, 0);
    assert!(counts.agreements * 100 >= counts.faces() * 99, "{counts:?}");
}

#[test]
fn triangulated_faces_agree_on_odd_scenes() {
    let counts = judge_all(&odd());
    assert_eq!(counts.disagreements, 0);
    assert!(counts.agreements * 100 >= counts.faces() * 99, "{counts:?}");
}

#[test]
fn triangulated_faces_agree_on_coarse_grids() {
    let counts = judge_all(&soups(200));
    assert_eq!(counts.disagreements, 0);
    assert!(counts.agreements * 100 >= counts.faces() * 99, "{counts:?}");
}

/// A room with a table, from where both are seen.
fn room() -> Case {
    let mut faces = Faces::default();
    faces.cuboid(DVec3::ZERO, DVec3::splat(4.0), DQuat::IDENTITY, true);
    faces.cuboid(DVec3::new(1.0, 2.0, 0.5), DVec3::splat(0.5), DQuat::from_rotation_z(0.4), false);
    Case { name: "room".into(), scene: faces.build(), eyes: vec![DVec3::new(0.1, -0.2, 1.3)] }
}

fn is_label(opinion: &FaceOpinion) -> bool {
    matches!(opinion, FaceOpinion::Disagreement(Disagreement::Label { .. }))
}

fn is_area(opinion: &FaceOpinion) -> bool {
    matches!(opinion, FaceOpinion::Disagreement(Disagreement::Area { .. }))
}

#[test]
fn what_is_wrong_in_an_image_is_found() {
    let case = room();
    let eye = case.eyes[0];
    let image = view(&case, eye);
    let right = outlines(&image);
    let largest = image.cells().max_by(|a, b| a.solid_angle().total_cmp(&b.solid_angle())).expect("cells").id();
    let count = |opinions: &[FaceOpinion; 6], wanted: fn(&FaceOpinion) -> bool| {
        let rest = opinions.iter().filter(|&o| !wanted(o));
        assert!(rest.clone().all(|o| matches!(o, FaceOpinion::Agreement(_))), "{opinions:?}");
        6 - rest.count()
    };
    let opinions = |outlines: &[Outline]| second_opinion(&case.scene, eye, outlines, |d| claim(&image, d));
    assert_eq!(count(&opinions(&right), is_area), 0);

    // A cell left out, one twice, one with another label, a corner moved by 1e-6: areas.
    let mut wrong = right.clone();
    wrong.remove(largest.index());
    assert_eq!(count(&opinions(&wrong), is_area), 1);
    let mut wrong = right.clone();
    wrong.push(right[largest.index()].clone());
    assert_eq!(count(&opinions(&wrong), is_area), 1);
    let mut wrong = right.clone();
    wrong[largest.index()].polygon = None;
    assert_eq!(count(&opinions(&wrong), is_area), 1);
    let mut wrong = right.clone();
    let corners = &mut wrong[largest.index()].corners;
    corners[0] = corners[0].lerp(corners[1] + corners[2], 1e-6);
    assert_eq!(count(&opinions(&wrong), is_area), 1);

    // One cell located as another polygon: a label.
    let relabelled = |direction| match image.locate(direction) {
        Location::Cell(cell) if cell == largest => Claim::Shows(Some(PolygonId(9))),
        _ => claim(&image, direction),
    };
    assert_eq!(count(&second_opinion(&case.scene, eye, &right, relabelled), is_label), 1);
    let nothing = second_opinion(&case.scene, eye, &right, |_| Claim::Outside);
    assert_eq!(count(&nothing, is_label), 6);
}

#[test]
fn a_polygon_given_to_what_is_behind_it_is_found() {
    let case = room();
    let eye = case.eyes[0];
    let mut found = 0;
    for face in 6..12 {
        let mut without = Faces::default();
        for k in 0..case.scene.polygon_count() {
            let points = case.scene.polygon(PolygonId(k as u32)).pieces().flat_map(PieceRef::points);
            // Far behind the room, so that the numbers of the others stay.
            let far = if k == face { DVec3::splat(100.0) } else { DVec3::ZERO };
            without.face(&points.take(4).map(|p| p + far).collect::<Vec<_>>());
        }
        let blind = Case { name: "without".into(), scene: without.build(), eyes: vec![eye] };
        let image = view(&blind, eye);
        let is_visible = view(&case, eye).solid_angles().of(PolygonId(face as u32)) > 0.0;
        let opinions = second_opinion(&case.scene, eye, &outlines(&image), |d| claim(&image, d));
        assert_eq!(opinions.iter().any(is_label), is_visible, "face {face}: {opinions:?}");
        found += usize::from(is_visible);
    }
    assert!(found >= 2);
}

#[test]
fn where_rounding_could_decide_there_is_no_verdict() {
    let reasons = |faces: &Faces, claim: fn(DVec3) -> Claim| -> Vec<NoVerdict> {
        let opinions = second_opinion(&faces.build(), DVec3::ZERO, &[], claim).into_iter();
        opinions.filter_map(|o| if let FaceOpinion::NoVerdict(reason) = o { Some(reason) } else { None }).collect()
    };
    let sheet = |tilt: f64, scale: f64| {
        [[-1.0, -1.0], [1.0, -1.0], [0.0, 1.0]].map(|[x, y]| DVec3::new(x, y, 3.0 + tilt * x) * scale)
    };
    // Two sheets that cross at an angle of 1e-9.
    let mut faces = Faces::default();
    faces.face(&sheet(0.0, 1.0));
    faces.face(&sheet(1e-9, 1.0));
    let boundary = |_| Claim::Boundary;
    assert!(reasons(&faces, boundary).contains(&NoVerdict::NearlyCoplanar { pieces: [PieceId(0), PieceId(1)] }));
    // Nothing was compared.
    let mut faces = Faces::default();
    faces.face(&sheet(0.0, 1.0));
    let vague = reasons(&faces, boundary);
    assert!(vague.len() == 6 && vague.iter().all(|r| matches!(r, NoVerdict::TooVague { .. })), "{vague:?}");
    // Next to the eye, and a million times as long.
    let mut faces = Faces::default();
    faces.face(&[[-1e6, 1e-7, 1e-7], [1e6, 2e-7, 1e-7], [0.0, 3.0, 1.0]].map(DVec3::from));
    assert!(reasons(&faces, boundary).contains(&NoVerdict::Imprecise { piece: PieceId(0) }));
    // Products overflow.
    let mut faces = Faces::default();
    faces.face(&sheet(0.0, 1e200));
    faces.face(&sheet(0.5, 1e200));
    assert!(reasons(&faces, boundary).contains(&NoVerdict::Imprecise { piece: PieceId(0) }));
}
