//! Proofs of images of windows and cameras: the domain is the union of the windows, above the horizon, and nothing else.

use glam::DVec3;
use nusselt::bvh::SceneBvh;
use nusselt::contour::{Domain, Frustum, Viewpoint, Windows};
use nusselt::io::{KeptCertificate, write_certificate};
use nusselt::scene::{PieceId, PolygonId, Scene, Side};
use nusselt::verify::{Arithmetic, Evidence, EvidenceDomain, EvidenceHorizon, EvidencePane, Rule};
use std::time::{Duration, Instant};

const EYE: DVec3 = DVec3::new(200.0, 300.0, 100.0);

fn scene() -> Scene {
    nusselt::samples::cornell_box().to_builder().build().expect("the Cornell box")
}

fn square(low: [f64; 2], size: f64) -> Vec<DVec3> {
    [[0.0, 0.0], [size, 0.0], [size, size], [0.0, size]].map(|[x, y]| DVec3::new(low[0] + x, low[1] + y, 400.0)).into()
}

fn evidence(scene: &Scene, windows: Windows) -> Evidence {
    let image = SceneBvh::build(scene).view(&Viewpoint::free(EYE), &Domain::Window(windows)).expect("a view");
    image.evidence()
}

/// Of two squares that overlap, a polygon of the scene, and a horizon that cuts some of them.
fn three(scene: &Scene) -> Evidence {
    let own = [square([100.0, 100.0], 200.0), square([200.0, 200.0], 250.0)].map(|ring| Windows::free(&ring));
    let [first, second] = own.map(|windows| windows.expect("a square"));
    let windows = Windows::polygon(PolygonId(3)).and(&first).and(&second);
    evidence(scene, windows.within_hemisphere(DVec3::new(0.0, -1.0, 0.2)))
}

/// What both arithmetics say: the rule that is broken.
fn verdict(evidence: &Evidence, scene: &Scene) -> Option<Rule> {
    let verdicts = [Arithmetic::Kernel, Arithmetic::Rational]
        .map(|arithmetic| evidence.check(scene, arithmetic).err().map(|defect| defect.rule()));
    assert_eq!(verdicts[0], verdicts[1], "both arithmetics agree");
    verdicts[0]
}

fn with_panes(evidence: &Evidence, change: impl FnOnce(&mut Vec<EvidencePane>)) -> Evidence {
    let mut changed = evidence.clone();
    let EvidenceDomain::Window { panes, .. } = &mut changed.domain else { panic!("its domain are windows") };
    change(panes);
    changed
}

fn with_horizon(evidence: &Evidence, other: Option<EvidenceHorizon>) -> Evidence {
    let mut changed = evidence.clone();
    let EvidenceDomain::Window { horizon, .. } = &mut changed.domain else { panic!("its domain are windows") };
    *horizon = other;
    changed
}

#[test]
fn another_domain_than_what_the_cells_tile_is_refused() {
    let scene = scene();
    let honest = three(&scene);
    assert_eq!(verdict(&honest, &scene), None);
    let wrong: Vec<(&str, Evidence)> = vec![
        ("one less", with_panes(&honest, |panes| drop(panes.remove(0)))),
        ("another less", with_panes(&honest, |panes| drop(panes.remove(2)))),
        ("one more", with_panes(&honest, |panes| panes.push(EvidencePane::Polygon(PolygonId(5))))),
        (
            "a corner moved",
            with_panes(&honest, |panes| {
                let EvidencePane::Ring(ring) = &mut panes[1] else { panic!("a ring") };
                ring[0].x = ring[0].x.next_up();
            }),
        ),
        ("no horizon", with_horizon(&honest, None)),
        (
            "another horizon",
            with_horizon(&honest, Some(EvidenceHorizon::Normal(DVec3::new(0.0, -1.0, 0.2f64.next_up())))),
        ),
        ("a surface", with_horizon(&honest, Some(EvidenceHorizon::Above(PieceId(0), Side::Front)))),
        ("the sphere", Evidence { domain: EvidenceDomain::Sphere, ..honest.clone() }),
        ("a hemisphere", Evidence { domain: EvidenceDomain::Hemisphere(DVec3::Z), ..honest.clone() }),
        ("no cells", Evidence { cells: Vec::new(), ..honest.clone() }),
    ];
    for (name, evidence) in wrong {
        let rule = verdict(&evidence, &scene);
        assert!(matches!(rule, Some(Rule::Balance | Rule::Witness)), "{name}: {rule:?}");
    }
    for k in 0..honest.cells.len() {
        let (mut less, mut twice) = (honest.clone(), honest.clone());
        less.cells.remove(k);
        twice.cells.push(twice.cells[k].clone());
        assert_eq!([verdict(&less, &scene), verdict(&twice, &scene)], [Some(Rule::Balance); 2], "cell {k}");
    }
    // The same union, said otherwise.
    for same in [
        with_panes(&honest, |panes| panes.reverse()),
        with_panes(&honest, |panes| panes.push(panes[1].clone())),
        with_panes(&honest, |panes| {
            for pane in panes {
                if let EvidencePane::Ring(ring) = pane {
                    ring.reverse();
                }
            }
        }),
        with_panes(&honest, |panes| panes.push(EvidencePane::Ring(square([220.0, 220.0], 50.0)))),
        with_horizon(&honest, Some(EvidenceHorizon::Normal(DVec3::new(0.0, -0.5, 0.1)))),
    ] {
        assert_eq!(verdict(&same, &scene), None);
    }
}

/// Each window's own image is right, and both together cover what they share twice.
#[test]
fn windows_that_overlap_do_not_count_twice() {
    let scene = scene();
    let rings = [square([100.0, 100.0], 200.0), square([200.0, 200.0], 250.0)];
    let own = rings.clone().map(|ring| evidence(&scene, Windows::free(&ring).expect("a square")));
    let mut together = own[0].clone();
    let first = together.splitters.len() as u32;
    together.splitters.extend_from_slice(&own[1].splitters);
    together.cells.extend(own[1].cells.iter().cloned().map(|mut cell| {
        cell.sides.iter_mut().for_each(|side| side.splitter += first);
        cell
    }));
    let panes = rings.map(EvidencePane::Ring).to_vec();
    together.domain = EvidenceDomain::Window { panes, horizon: None };
    assert_eq!(own.each_ref().map(|evidence| verdict(evidence, &scene)), [None; 2]);
    assert_eq!(verdict(&together, &scene), Some(Rule::Balance));
}

#[test]
fn what_is_no_domain_is_malformed() {
    let scene = scene();
    let honest = three(&scene);
    let ring = |points: &[[f64; 3]]| {
        let points: Vec<DVec3> = points.iter().map(|&p| p.into()).collect();
        with_panes(&honest, |panes| panes.push(EvidencePane::Ring(points)))
    };
    let frustum = |normals: [DVec3; 4]| Evidence { domain: EvidenceDomain::Frustum(normals), ..honest.clone() };
    let [t, r, b, l] = Frustum::new(DVec3::X, DVec3::Z, 60.0, 1.0).expect("a camera").normals();
    for (name, evidence) in [
        ("two points", ring(&[[0.0; 3], [1.0; 3]])),
        ("not finite", ring(&[[0.0; 3], [1.0, 0.0, f64::NAN], [0.0, 1.0, 0.0]])),
        ("corners in line", ring(&[[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 1.0, 0.0]])),
        ("concave", ring(&[[0.0; 3], [4.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 4.0, 0.0]])),
        ("a bow tie", ring(&[[0.0; 3], [4.0, 4.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]])),
        ("no polygon", with_panes(&honest, |panes| panes.push(EvidencePane::Polygon(PolygonId(16))))),
        ("no piece", with_horizon(&honest, Some(EvidenceHorizon::Above(PieceId(99), Side::Front)))),
        ("a zero horizon", with_horizon(&honest, Some(EvidenceHorizon::Normal(DVec3::ZERO)))),
        ("clockwise", frustum([t, l, b, r])),
        ("outwards", frustum([-t, -r, -b, -l])),
        ("a zero normal", frustum([t, DVec3::ZERO, b, l])),
        ("an infinite normal", frustum([t, r, DVec3::INFINITY, l])),
    ] {
        assert_eq!(verdict(&evidence, &scene), Some(Rule::Form), "{name}");
    }
}

#[test]
fn kept_proofs_of_windows_and_cameras_are_read_and_hold() {
    let scene = scene();
    let boxes = SceneBvh::build(&scene);
    let floor = Viewpoint::on_surface(&scene, PolygonId(0), Side::Front, EYE).expect("the floor");
    let camera = Frustum::new(DVec3::new(0.3, 1.0, -0.2), DVec3::Z, 60.0, 1.5).expect("a camera");
    let lamp = Windows::polygon(PolygonId(1)).above_surface();
    let on_floor = boxes.view(&floor, &Domain::Window(lamp)).expect("a view").evidence();
    let seen = boxes.view(&Viewpoint::free(EYE), &Domain::Frustum(camera)).expect("a view").evidence();
    for evidence in [three(&scene), on_floor, seen] {
        let mut file = Vec::new();
        write_certificate(&evidence, &scene, &mut file).expect("memory can be written");
        let kept = KeptCertificate::from_json(&file, "kept.json").expect("it was just written");
        assert_eq!(kept.evidence, evidence);
        assert_eq!(verdict(&kept.evidence, &scene), None);
    }
}

/// Nobody can make the check take long with windows that no engine would cut.
#[test]
fn very_many_windows_take_no_time() {
    let scene = scene();
    let honest = three(&scene);
    let many = with_panes(&honest, |panes| {
        panes.extend((0..30_000).map(|k| {
            let k = f64::from(k);
            EvidencePane::Ring(square([k * 0.37 % 500.0, k * 0.73 % 500.0], 60.0 + k * 0.01))
        }));
    });
    // One that is named very often is one.
    let often = with_panes(&honest, |panes| panes.extend((0..300_000).map(|_| EvidencePane::Polygon(PolygonId(3)))));
    let start = Instant::now();
    often.check(&scene, Arithmetic::Kernel).expect("the same union");
    let defect = many.check(&scene, Arithmetic::Kernel).expect_err("its cells do not tile them");
    assert!(start.elapsed() < Duration::from_secs(300), "{:?}", start.elapsed());
    assert!(defect.to_string().len() < 1000);
}
