//! STL files are read as they are meant, or refused with all that is wrong.

use glam::DVec3;
use nusselt::io::{Loaded, ReadError, ReadOptions, stl};
use nusselt::scene::{PolygonId, Scene, Shape};

fn parse(bytes: &[u8]) -> Result<Loaded, ReadError> {
    stl::parse(bytes, "test.stl", &ReadOptions::default())
}

/// All faults, one a line.
fn faults(bytes: &[u8]) -> Vec<String> {
    match parse(bytes) {
        Err(ReadError::Invalid(faults)) => faults.list().iter().map(ToString::to_string).collect(),
        other => panic!("not refused: {other:?}"),
    }
}

fn corners(scene: &Scene, polygon: u32) -> Vec<[f64; 3]> {
    scene.polygon(PolygonId(polygon)).rings()[0].iter().map(|&v| scene.vertex(v).to_array()).collect()
}

fn binary(start: &[u8], count: u32, triangles: &[[[f32; 3]; 3]]) -> Vec<u8> {
    let mut bytes = start.to_vec();
    bytes.resize(80, b' ');
    bytes.extend(count.to_le_bytes());
    for triangle in triangles {
        let normal = [f32::NAN; 3];
        bytes.extend([normal].iter().chain(triangle).flatten().flat_map(|x| x.to_le_bytes()));
        bytes.extend([7, 7]);
    }
    bytes
}

const TRIANGLES: [[[f32; 3]; 3]; 2] =
    [[[0.1, 0., 0.], [1., 0., 0.], [0., 1., 0.]], [[0., 0., 1.], [0., 2., 1.], [2., 0., 1.]]];

#[test]
fn binary_triangles_keep_their_bits_and_order() {
    for start in [&b"made by hand"[..], b"solid made by hand\nfacet"] {
        let loaded = parse(&binary(start, 2, &TRIANGLES)).unwrap();
        assert_eq!(loaded.warnings, [""; 0]);
        assert_eq!(loaded.scene.objects(), ["default"]);
        let first = corners(&loaded.scene, 0);
        assert_eq!(first, [[f64::from(0.1_f32), 0., 0.], [1., 0., 0.], [0., 1., 0.]]);
        assert_eq!(corners(&loaded.scene, 1), [[0., 0., 1.], [0., 2., 1.], [2., 0., 1.]]);
    }
}

#[test]
fn counts_that_lie_are_told() {
    let more = faults(&binary(b"x", 3, &TRIANGLES));
    assert_eq!(more, ["test.stl: it promises 3 triangles, but only 2 are there; it may be cut off"]);
    let most = faults(&binary(b"x", u32::MAX, &TRIANGLES));
    assert_eq!(most, ["test.stl: it promises 4294967295 triangles, but only 2 are there; it may be cut off"]);
    let solid = faults(&binary(b"solid\0", 3, &TRIANGLES));
    assert_eq!(solid, more);
    let fewer = parse(&binary(b"x", 1, &TRIANGLES)).unwrap();
    assert_eq!(fewer.scene.polygon_count(), 1);
    assert_eq!(fewer.warnings, ["test.stl: the 50 bytes after the last triangle were ignored"]);
    let short = faults(b"sol");
    assert_eq!(short, ["test.stl: neither text that starts with `solid` nor binary: 3 bytes are too few"]);
    let none = parse(&binary(b"x", 0, &[])).unwrap();
    assert_eq!(none.warnings, ["test.stl: there are no faces"]);
}

#[test]
fn every_truncation_is_refused() {
    let bytes = binary(b"x", 2, &TRIANGLES);
    for length in 0..bytes.len() {
        assert!(parse(&bytes[..length]).is_err(), "{length} bytes");
    }
}

#[test]
fn numbers_that_are_not_finite_are_told_once_with_their_triangle() {
    let mut triangles = TRIANGLES;
    triangles[1][2][1] = f32::NAN;
    triangles[0][0] = [f32::INFINITY; 3];
    triangles[0][1][2] = f32::NAN;
    let what = "a coordinate is not finite; correct it";
    assert_eq!(
        faults(&binary(b"x", 2, &triangles)),
        [format!("test.stl: triangle 0: {what}"), format!("test.stl: triangle 1: {what}")]
    );
}

const TEXT: &str = "\
solid left wing # 1
 facet normal nan nan nan
  outer loop
   vertex 0.1 0 0
   VERTEX 1e0 0 0
   vertex 0 1 0
  endloop
 endfacet
endsolid left wing # 1

solid
facet normal 0 0 1 outer loop vertex 0 0 1 vertex 2 0 1 vertex 2 2 1 vertex 0 2 1 endloop endfacet
facet
vertex 0 0 1
vertex 0 0 1
vertex 2 0 1
endfacet
endsolid
";

#[test]
fn solids_are_objects_and_text_is_read_as_doubles() {
    for text in [TEXT.to_owned(), TEXT.replace('\n', "\r\n"), TEXT.replace('\n', "\r"), format!("\u{feff}{TEXT}")] {
        let loaded = parse(text.as_bytes()).unwrap();
        let scene = &loaded.scene;
        assert_eq!(scene.objects(), ["left wing # 1", "default"]);
        assert_eq!(scene.vertices()[0], DVec3::new(0.1, 0.0, 0.0));
        assert_eq!(corners(scene, 1).len(), 4);
        assert_eq!(scene.polygon(PolygonId(2)).shape(), Shape::Degenerate);
        let expected = "test.stl:13: this face has no area, 1 in all; they keep their numbers and hide nothing";
        assert_eq!(loaded.warnings, [expected]);
    }
}

#[test]
fn everything_that_is_wrong_in_text_is_named_with_its_line() {
    let text = "solid a\nfacet normal 0 0 1\nvertex 0 0 x\nvertex 1 0 0\nendfacet\nvertex 1 2 3\nfacet\nvertex 0 0 0\n\
                vertex 1 2\nfacet\nendfacet\nnonsense\nfacet vertex 0 0 0 vertex 1 0 0 vertex 0 1e999 0";
    assert_eq!(
        faults(text.as_bytes()),
        [
            "test.stl:3: `x` is not a number",
            "test.stl:6: a vertex outside of a facet; it takes `facet` and `endfacet` around it",
            "test.stl:7: this facet has no `endfacet` before the next `facet`",
            "test.stl:9: a vertex takes 3 coordinates, but here are 2",
            "test.stl:10: a facet takes 3 vertices, but here are 0",
            "test.stl:12: `nonsense` is no word of STL; it takes `solid`, `facet normal`, `outer loop`, `vertex` and their ends",
            "test.stl:13: the number `1e999` is too large; the largest is about 1.8e308",
            "test.stl:13: this facet has no `endfacet` before the end of the file; it may be cut off",
        ]
    );
    let crossed = "solid\nfacet vertex 0 0 0 vertex 1 1 0 vertex 1 0 0 vertex 0 1 0 endfacet\nendsolid";
    assert_eq!(
        faults(crossed.as_bytes()),
        ["test.stl:2: the boundary of polygon 0 crosses itself; split it where it does"]
    );
}

#[test]
fn text_that_is_cut_off_is_refused_or_told() {
    for length in 6..TEXT.trim_end().len() {
        match parse(&TEXT.as_bytes()[..length]) {
            Err(ReadError::Invalid(faults)) => assert!(!faults.is_empty()),
            Err(error) => panic!("{error}"),
            // Between two facets, or two solids.
            Ok(loaded) => assert!(loaded.scene.polygon_count() < 3 || !loaded.warnings.is_empty(), "{length}"),
        }
    }
}
