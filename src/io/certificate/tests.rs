//! Certificates read back as they were written, and nothing else reads at all.

use super::*;
use crate::exact::Sign;
use crate::scene::{Axis, PieceId, PolygonId, Scene, Side, Splitter, SupportingPlane, VertexId};
use crate::verify::{
    Evidence, EvidenceCell, EvidenceDomain, EvidenceHorizon, EvidencePane, EvidenceSliver, HalfSphere,
};
use glam::DVec3;
use proptest::prelude::*;

fn written(evidence: &Evidence) -> String {
    let scene = Scene::builder().build().unwrap();
    let mut bytes = Vec::new();
    write_certificate(evidence, &scene, &mut bytes).unwrap();
    String::from_utf8(bytes).unwrap()
}

fn read(text: &str) -> Result<Evidence, String> {
    let kept = KeptCertificate::from_json(text.as_bytes(), "kept.json");
    kept.map(|kept| kept.evidence).map_err(|error| error.to_string())
}

/// Bits, as -0 equals 0.
fn exactly(evidence: &Evidence) -> String {
    format!("{evidence:?}")
}

fn numbers() -> impl Strategy<Value = f64> {
    let special = prop::sample::select(vec![0.0, -0.0, 5e-324, -5e-324, f64::MAX, f64::MIN_POSITIVE, 0.1, 1e23]);
    prop_oneof![special, any::<u64>().prop_map(f64::from_bits).prop_filter("finite", |x| x.is_finite())]
}

fn vectors() -> impl Strategy<Value = DVec3> {
    prop::array::uniform3(numbers()).prop_map(DVec3::from)
}

fn planes() -> impl Strategy<Value = SupportingPlane> {
    prop_oneof![
        (prop::sample::select(&Axis::ALL[..]), numbers())
            .prop_map(|(axis, value)| SupportingPlane::Axis { axis, value }),
        prop::array::uniform3(any::<u32>()).prop_map(|points| SupportingPlane::Points(points.map(VertexId))),
    ]
}

fn sides() -> impl Strategy<Value = Side> {
    prop_oneof![Just(Side::Front), Just(Side::Back)]
}

fn splitters() -> impl Strategy<Value = Splitter> {
    prop_oneof![
        prop::array::uniform2(any::<u32>()).prop_map(|ends| Splitter::Edge(ends.map(VertexId))),
        prop::array::uniform2(planes()).prop_map(Splitter::Crease),
        prop::array::uniform2(vectors()).prop_map(Splitter::Points),
        vectors().prop_map(Splitter::Given),
        planes().prop_map(Splitter::Parallel),
    ]
}

fn domains() -> impl Strategy<Value = EvidenceDomain> {
    prop_oneof![
        Just(EvidenceDomain::Sphere),
        vectors().prop_map(EvidenceDomain::Hemisphere),
        (any::<u32>(), sides()).prop_map(|(piece, side)| EvidenceDomain::Above(PieceId(piece), side)),
        prop::array::uniform4(vectors()).prop_map(EvidenceDomain::Frustum),
        (prop::collection::vec(panes(), 0..4), prop::option::of(horizons()))
            .prop_map(|(panes, horizon)| EvidenceDomain::Window { panes, horizon }),
    ]
}

fn panes() -> impl Strategy<Value = EvidencePane> {
    prop_oneof![
        any::<u32>().prop_map(|polygon| EvidencePane::Polygon(PolygonId(polygon))),
        prop::collection::vec(vectors(), 0..5).prop_map(EvidencePane::Ring),
    ]
}

fn horizons() -> impl Strategy<Value = EvidenceHorizon> {
    prop_oneof![
        vectors().prop_map(EvidenceHorizon::Normal),
        (any::<u32>(), sides()).prop_map(|(piece, side)| EvidenceHorizon::Above(PieceId(piece), side)),
    ]
}

fn evidences() -> impl Strategy<Value = Evidence> {
    let slivers = (any::<u32>(), planes(), prop::option::of(sides()))
        .prop_map(|(piece, plane, beyond)| EvidenceSliver { piece: PieceId(piece), plane, beyond });
    let signs = prop_oneof![Just(Sign::Positive), Just(Sign::Negative)];
    let half = (any::<prop::sample::Index>(), signs);
    let cells = (prop::option::of(any::<u32>()), prop::collection::vec(half, 0..6));
    let lists = (
        prop::collection::vec(slivers, 0..3),
        prop::collection::vec(splitters(), 1..9),
        prop::collection::vec(cells, 0..6),
    );
    (vectors(), domains(), numbers(), lists).prop_map(|(eye, domain, epsilon, (slivers, splitters, cells))| {
        let count = splitters.len();
        let cells = cells.into_iter().map(|(piece, sides)| EvidenceCell {
            piece: piece.map(PieceId),
            sides: sides
                .into_iter()
                .map(|(k, inside)| HalfSphere { splitter: k.index(count) as u32, inside })
                .collect(),
        });
        let epsilon = epsilon.abs();
        Evidence { eye, domain, epsilon, slivers, cells: cells.collect(), splitters }
    })
}

proptest! {
    #[test]
    fn evidence_reads_back_as_the_same_bits(evidence in evidences()) {
        prop_assert_eq!(exactly(&read(&written(&evidence)).unwrap()), exactly(&evidence));
    }

    #[test]
    fn damaged_files_are_read_as_something_or_refused_in_one_line(
        evidence in evidences(),
        damage in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>(), 0..4_u8), 1..4),
    ) {
        let mut bytes = written(&evidence).into_bytes();
        for (place, byte, how) in damage {
            if bytes.is_empty() {
                break;
            }
            let place = place.index(bytes.len());
            match how {
                0 => bytes[place] = byte,
                1 => bytes.truncate(place),
                2 => bytes.insert(place, b"[]{}\",:-019e.nx "[usize::from(byte % 16)]),
                _ => { bytes.remove(place); }
            }
        }
        if let Err(error) = KeptCertificate::from_json(&bytes, "kept.json") {
            let message = error.to_string();
            prop_assert!(message.starts_with("kept.json: ") && message.lines().count() == 1, "{}", message);
        }
    }
}

const SMALL: &str = r#"{"schema": "nusselt.certificate/1",
"scene": {"vertices": 8, "polygons": 6, "pieces": 7},
"eye": [0.5, 0.5, -0.0],
"domain": {"kind": "hemisphere", "normal": [0, 0, 5e-324]},
"epsilon": 0.25,
"slivers": [
{"piece": 3, "plane": {"z": -0.5}, "beyond": null}
],
"splitters": [
{"given": [0.0, 0.0, 1.0]},
{"edge": [4, 5]},
{"crease": [{"points": [0, 1, 2]}, {"x": 0.5}]},
{"parallel": {"z": 0.0}}
],
"cells": [
{"piece": 5, "sides": [1, 2, -3]},
{"piece": null, "sides": [-2, 4, 3]}
]}
"#;

#[test]
fn the_documented_shapes_are_read() {
    let kept = KeptCertificate::from_json(SMALL.as_bytes(), "kept.json").unwrap();
    assert_eq!(kept.scene, SceneSize { vertices: 8, polygons: 6, pieces: 7 });
    let Evidence { eye, domain, epsilon, slivers, splitters, cells } = kept.evidence;
    assert!(eye == DVec3::new(0.5, 0.5, 0.0) && eye.z.is_sign_negative());
    assert_eq!(domain, EvidenceDomain::Hemisphere(DVec3::new(0.0, 0.0, 5e-324)));
    assert_eq!((epsilon, slivers[0].beyond, splitters.len()), (0.25, None, 4));
    let [x, z] = [(Axis::X, 0.5), (Axis::Z, 0.0)].map(|(axis, value)| SupportingPlane::Axis { axis, value });
    assert_eq!(splitters[2], Splitter::Crease([SupportingPlane::Points([0, 1, 2].map(VertexId)), x]));
    assert_eq!(splitters[3], Splitter::Parallel(z));
    assert_eq!((cells[0].piece, cells[1].piece), (Some(PieceId(5)), None));
    let [plus, minus] = [Sign::Positive, Sign::Negative];
    assert_eq!(
        cells[1].sides,
        [(1, minus), (3, plus), (2, plus)].map(|(splitter, inside)| HalfSphere { splitter, inside })
    );
}

#[test]
fn what_is_wrong_is_named() {
    let deep = "[".repeat(1_000_000);
    let long = format!("\"{}\": 0, \"eye\"", "x\\u001b".repeat(100_000));
    for (old, new, named) in [
        ("certificate/1", "certificate/2", "nusselt.certificate/2"),
        ("certificate/1", "contour/1", "nusselt.contour/1"),
        ("\"nusselt.certificate/1\"", "7", "line 1"),
        ("\"schema\": \"nusselt.certificate/1\",", "", "missing field `schema`"),
        ("\"vertices\": 8", "\"vertices\": -8", "line 2"),
        ("\"vertices\": 8, ", "", "missing field `vertices`"),
        ("[0.5, 0.5, -0.0]", "[0.5, 0.5]", "line 3"),
        ("[0.5, 0.5, -0.0]", "[0.5, 0.5, 1, 2]", "line 3"),
        ("[0.5, 0.5, -0.0]", "[0.5, 0.5, 1e999]", "line 3"),
        ("[0.5, 0.5, -0.0]", "[0.5, 0.5, NaN]", "line 3"),
        ("[0.5, 0.5, -0.0]", "[0.5, 0.5, null]", "line 3"),
        ("hemisphere", "lens", "lens"),
        ("hemisphere", "frustum", "unknown field `normal`, expected `normals`"),
        ("\"normal\": [0, 0, 5e-324]", "\"normal\": [0, 0, 5e-324], \"panes\": []", "unknown field `panes`"),
        ("\"kind\": \"hemisphere\", ", "", "kind"),
        ("\"kind\": \"hemisphere\", \"normal\": [0, 0, 5e-324]", "\"kind\": \"sphere\", \"normal\": 1", "normal"),
        ("\"kind\": \"hemisphere\"", "\"kind\": \"hemisphere\", \"kind\": \"sphere\"", "kind"),
        ("0.25", "-0.25", "epsilon"),
        (", \"beyond\": null", "", "sliver 0: missing field `beyond`"),
        ("{\"z\": -0.5}", "{\"w\": -0.5}", "sliver 0: unknown variant `w`"),
        ("{\"given\": [0.0, 0.0, 1.0]}", "{\"given\": [0.0, 0.0]}", "splitter 0: "),
        ("[4, 5]", "[4, 5, 6]", "splitter 1: "),
        ("[4, 5]", "[4, -5]", "splitter 1: "),
        ("[4, 5]", "[4, 4294967296]", "splitter 1: "),
        ("{\"edge\": [4, 5]}", "{\"edge\": [4, 5], \"given\": [0, 0, 1]}", "splitter 1: "),
        ("{\"edge\": [4, 5]}", "7", "splitter 1: "),
        ("\"piece\": 5, ", "", "cell 0: missing field `piece`"),
        ("\"piece\": 5", "\"piece\": 5.5", "cell 0: "),
        ("\"piece\": 5", "\"piece\": 5, \"piece\": 6", "cell 0: duplicate field `piece`"),
        ("\"piece\": 5", "\"polygon\": 5", "cell 0: unknown field `polygon`"),
        ("[1, 2, -3]", "[1, 2, 0]", "cell 0: there is no splitter 0"),
        ("[-2, 4, 3]", "[-2, 5, 3]", "cell 1: there is no splitter 5, only 4"),
        ("[-2, 4, 3]", "[-2, 4, -9223372036854775808]", "cell 1: there is no splitter -9223372036854775808"),
        ("[-2, 4, 3]", "[-2, 4, 9223372036854775808]", "cell 1: "),
        ("[-2, 4, 3]", &deep, "cell 1: "),
        ("{\"piece\": 5, \"sides\": [1, 2, -3]}", &deep, "cell 0: "),
        ("\"eye\"", "\"eye\": [0, 0, 0], \"eye\"", "duplicate field `eye`"),
        ("\"eye\"", "\"ear\": 0, \"eye\"", "unknown field `ear`"),
        ("\"eye\"", &long, "unknown field `x"),
        ("]}\n", "", "ends in the midst of"),
        ("]}\n", "]} 1\n", "trailing"),
        (SMALL, "", "ends in the midst of"),
        (SMALL, "null", "line 1"),
        (SMALL, &deep, "line 1"),
    ] {
        assert!(SMALL.contains(old), "{old}");
        // The last one, as some are part of others that come before.
        let at = SMALL.rfind(old).unwrap();
        let text = [&SMALL[..at], new, &SMALL[at + old.len()..]].concat();
        let message = read(&text).expect_err(new);
        assert!(message.contains(named), "{named}: {message}");
        assert!(message.len() < 500 && !message.chars().any(char::is_control), "{message}");
    }
}

#[test]
fn a_million_cells_are_read() {
    let at = SMALL.find("{\"piece\": 5").unwrap();
    let cells = "{\"piece\":null,\"sides\":[]},\n".repeat(1_000_000);
    let evidence = read(&[&SMALL[..at], &cells, &SMALL[at..]].concat()).unwrap();
    assert_eq!(evidence.cells.len(), 1_000_002);
}
