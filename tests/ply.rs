//! PLY files are read as they are meant, or refused with all that is wrong.

use nusselt::io::{Loaded, ReadError, ReadOptions, ply};
use nusselt::scene::{PolygonId, PolygonRef, Scene, Shape};

fn parse(bytes: &[u8]) -> Result<Loaded, ReadError> {
    ply::parse(bytes, "test.ply", &ReadOptions::default())
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

const TEXT: &str = "\
ply
format ascii 1.0
comment element face 7
obj_info x
element camera 1
property float nothing
property list uchar float much
element vertex 5
property uchar red
property float z
property float x
property list int short more
property double y
element empty 4000000000
element face 3
property uchar flags
property list uchar int vertex_index
property float quality
end_header
nan 2 1 x
255 0 0.1 0 0
255 0 1 1 7 0

255 0 1 2 8 9 1
255 0 0 0 1
0 5 0 0 0.5e0
1 5 0 1 2 3 4 nan
2 3 1 1 2 0
3 4 3 2 1 0 0
";

#[test]
fn text_is_read_whatever_else_it_has() {
    for text in [TEXT.to_owned(), TEXT.replace('\n', "\r\n")] {
        let loaded = parse(text.as_bytes()).unwrap();
        let scene = &loaded.scene;
        assert_eq!((scene.objects(), scene.polygon_count()), (&["default".to_owned()][..], 3));
        assert_eq!(corners(scene, 2), [[0., 1., 0.], [1., 1., 0.], [1., 0., 0.], [0.1, 0., 0.]]);
        let shapes: Vec<_> = scene.polygons().map(PolygonRef::shape).collect();
        assert_eq!(shapes, [Shape::NonPlanar, Shape::Degenerate, Shape::Convex]);
        let expected = "test.ply:28: this face has no area, 1 in all; they keep their numbers and hide nothing";
        assert_eq!(loaded.warnings, [expected]);
    }
}

/// A binary file of numbers in one byte order.
fn binary(is_big: bool, header: &str, numbers: &[(&str, f64)]) -> Vec<u8> {
    let order = if is_big { "big" } else { "little" };
    let mut bytes = format!("ply\nformat binary_{order}_endian 1.0\n{header}end_header\n").into_bytes();
    for &(kind, number) in numbers {
        let mut number = match kind {
            "char" => (number as i8).to_le_bytes().to_vec(),
            "uchar" => (number as u8).to_le_bytes().to_vec(),
            "short" => (number as i16).to_le_bytes().to_vec(),
            "ushort" => (number as u16).to_le_bytes().to_vec(),
            "int" => (number as i32).to_le_bytes().to_vec(),
            "uint" => (number as u32).to_le_bytes().to_vec(),
            "float" => (number as f32).to_le_bytes().to_vec(),
            "double" => number.to_le_bytes().to_vec(),
            _ => panic!("{kind}"),
        };
        if is_big {
            number.reverse();
        }
        bytes.extend(number);
    }
    bytes
}

const TYPES: [&str; 8] = ["char", "uchar", "short", "ushort", "int", "uint", "float", "double"];

/// A square with a list before its corners.
fn square(is_big: bool, coordinate: &str, length: &str, index: &str) -> Vec<u8> {
    let header = format!(
        "element vertex 4\nproperty {coordinate} x\nproperty {coordinate} y\nproperty {coordinate} z\n\
         element face 1\nproperty list {length} {index} other\nproperty list {length} {index} vertex_indices\n"
    );
    let mut numbers = Vec::new();
    for [x, y] in [[0., 0.], [100., 0.], [100., 100.], [0., 100.]] {
        numbers.extend([(coordinate, x), (coordinate, y), (coordinate, 7.)]);
    }
    numbers.extend([(length, 2.), (index, 9.), (index, 9.), (length, 4.)]);
    numbers.extend([0., 1., 2., 3.].map(|k| (index, k)));
    binary(is_big, &header, &numbers)
}

#[test]
fn binary_files_are_read_in_both_orders_and_all_types() {
    for (is_big, kind) in [false, true].into_iter().flat_map(|big| TYPES.map(|kind| (big, kind))) {
        for bytes in [
            square(is_big, kind, "uchar", "int"),
            square(is_big, "float", kind, "int"),
            square(is_big, "float", "uint", kind),
        ] {
            let loaded = parse(&bytes).unwrap_or_else(|error| panic!("{kind}: {error}"));
            let expected = [[0., 0., 7.], [100., 0., 7.], [100., 100., 7.], [0., 100., 7.]];
            assert_eq!((corners(&loaded.scene, 0), loaded.warnings), (expected.to_vec(), Vec::new()), "{kind}");
        }
    }
}

#[test]
fn every_truncation_is_refused() {
    let bytes = square(true, "double", "ushort", "uint");
    for length in 0..bytes.len() {
        assert!(parse(&bytes[..length]).is_err(), "{length} bytes");
    }
    // The last line of text may be cut within its last number.
    for length in 0..TEXT.len() - 3 {
        assert!(parse(&TEXT.as_bytes()[..length]).is_err(), "{length} bytes");
    }
}

#[test]
fn what_is_not_finite_or_no_index_is_told_with_its_item() {
    let header = "element vertex 3\nproperty float x\nproperty float y\nproperty double z\n\
                  element face 3\nproperty list char float vertex_indices\n";
    let nan = |x, y, z| [("float", x), ("float", y), ("double", z)];
    let mut numbers = [nan(0., 0., 0.), nan(f64::NAN, 0., 0.), nan(0., 0., f64::NEG_INFINITY)].concat();
    let face = |corners: [f64; 3]| [("char", 3.), ("float", corners[0]), ("float", corners[1]), ("float", corners[2])];
    numbers.extend([face([0., 1., 2.]), face([0., 1.5, 2.]), face([0., 1., -2.])].concat());
    assert_eq!(
        faults(&binary(true, header, &numbers)),
        [
            "test.ply: vertex 1: a coordinate is not finite; correct it",
            "test.ply: vertex 2: a coordinate is not finite; correct it",
            "test.ply: face 1: 1.5 is not the index of a vertex",
            "test.ply: face 2: -2 is not the index of a vertex",
        ]
    );
    let mut negative = square(false, "float", "char", "int");
    let at = negative.len() - 17;
    negative[at] = 255;
    assert_eq!(faults(&negative), ["test.ply: face 0: -1 is no length of a list"]);
}

#[test]
fn everything_that_is_wrong_in_text_is_named_with_its_line() {
    let text = TEXT.replace("2 3 1 1 2 0", "2 3 1 9 2 0").replace("0 5 0 0 0.5e0", "0 5 0 0 x");
    assert_eq!(
        faults(text.as_bytes()),
        ["test.ply:26: `x` is not a number", "test.ply:28: there is no vertex 9; they are 0 to 4"]
    );
    let text = TEXT.replace("2 3 1 1 2 0", "2 2 1 2 0").replace("3 4 3 2 1 0 0", "3 4 3 2");
    assert_eq!(
        faults(text.as_bytes()),
        ["test.ply:28: a face takes at least 3 vertices, but here are 2", "test.ply:29: the line ends too early"]
    );
}

#[test]
fn headers_that_lie_or_are_wrong_are_told() {
    let told = |old: &str, new: &str| {
        assert!(TEXT.contains(old), "{old}");
        faults(TEXT.replacen(old, new, 1).as_bytes()).join("; ")
    };
    for (old, new, expected) in [
        ("ply\n", "plywood\n", "test.ply:1: a PLY file starts with the line `ply`"),
        ("ascii", "utf8", "test.ply:2: the format `utf8` is not known"),
        ("format ascii 1.0\n", "", "test.ply:18: the header has no line `format`"),
        ("vertex 5", "vertex -5", "test.ply:8: `-5` is no number of elements"),
        ("vertex 5", "vertex 18446744073709551615", "test.ply:8: it promises 18446744073709551615 elements `vertex`"),
        ("vertex 5", "face 5", "test.ply:15: there are two elements `face`"),
        ("property double y", "property double w", "test.ply:8: the vertices have no number `y`"),
        ("property double y", "property list int int y", "test.ply:8: the vertices have no number `y`"),
        ("property double y", "property real y", "test.ply:13: `real` is no type"),
        ("end_header", "end", "the line `end` is none of a header"),
        (
            "list uchar int vertex_index",
            "int vertex_index",
            "test.ply:15: the element face has no list `vertex_indices`",
        ),
        ("face 3", "face 300", "test.ply:15: it promises 300 elements `face`"),
        ("face 3", "face 4", "test.ply: the file ends in element 3 of 4 `face`"),
        ("1 5 0 1 2 3 4 nan", "1 5000000 0", "test.ply: the file ends in element 0 of 3 `face`"),
    ] {
        let told = told(old, new);
        assert!(told.contains(expected), "{told}");
    }
    let early = faults(b"ply\nproperty int x\n");
    assert_eq!(early, ["test.ply:2: a property before the first `element`"]);
}

#[test]
fn strips_are_triangles_that_turn_the_same_way() {
    let text = "ply\nformat ascii 1.0\nelement tristrips 1\nproperty list int int vertex_indices\n\
                element vertex 4\nproperty int x\nproperty int y\nproperty int z\nend_header\n\
                11 0 1 2 3 -1 0 1 3 -1 2 3\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n";
    let scene = parse(text.as_bytes()).unwrap().scene;
    let up = |k| {
        let [a, b, c] = corners(&scene, k).try_into().unwrap();
        (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    };
    assert!((0..3).all(|k| up(k) > 0.0));
    assert_eq!(scene.polygon_count(), 3);
}

#[test]
fn points_without_faces_are_a_scene_without_faces() {
    let text = "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n1 2 3\n";
    assert_eq!(parse(text.as_bytes()).unwrap().warnings, ["test.ply: there are no faces"]);
}

#[test]
fn headers_of_very_many_elements_take_time_in_proportion() {
    // Compared with each other they would take minutes.
    let elements: Vec<String> = (0..200_000).map(|k| format!("element a{k} 0\n")).collect();
    let elements = elements.concat();
    let loaded = parse(format!("ply\nformat ascii 1.0\n{elements}end_header\n").as_bytes()).expect("an empty scene");
    assert_eq!(loaded.scene.polygon_count(), 0);
}
