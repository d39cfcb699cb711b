//! OBJ files are read as they are meant, or refused with all that is wrong.

use glam::DVec3;
use nusselt::io::{self, Loaded, ReadError, ReadOptions, obj};
use nusselt::scene::{Material, PolygonId, Shape};
use proptest::prelude::*;
use std::fs;
use std::path::Path;

fn no_files(_: &str) -> std::io::Result<Vec<u8>> {
    Err(std::io::Error::from(std::io::ErrorKind::NotFound))
}

fn parse(text: &str) -> Result<Loaded, ReadError> {
    obj::parse(text.as_bytes(), "test.obj", &ReadOptions::default(), no_files)
}

/// All faults, one a line.
fn faults(text: &str) -> Vec<String> {
    match parse(text) {
        Err(ReadError::Invalid(faults)) => faults.list().iter().map(ToString::to_string).collect(),
        other => panic!("not refused: {other:?}"),
    }
}

const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

#[test]
fn faces_come_in_all_forms() {
    let text = "\u{feff}# a square\r\nv\t0 0 0 1\r\nv 1 0 0 0.5 0.5 0.5\r\nv 1 \\\r\n 1 0\r\nv 0 1. -0e0 # last\r\n\
                vt 0 0\r\nvn 0 0 1\r\nf 1 2 3 4\r\nf 1/1 2/1 3/1\r\nf 1//1 2//1 3//1\r\nf 1/1/1 2/1/1 4/1/1\r\nf -4 -3 -2 -1\r\ns off\r\nl 1 2\r\np 1\r\nf 4\t3  2";
    let loaded = parse(text).unwrap();
    assert_eq!(loaded.warnings, [""; 0]);
    let scene = &loaded.scene;
    let counts: Vec<_> = scene.polygons().map(|polygon| polygon.rings()[0].len()).collect();
    assert_eq!(counts, [4, 3, 3, 3, 4, 3]);
    assert_eq!(scene.polygon(PolygonId(0)).rings(), scene.polygon(PolygonId(4)).rings());
    assert_eq!(scene.vertices().len(), 4);
    assert_eq!(scene.objects(), ["default"]);
}

#[test]
fn vertices_may_come_after_their_faces() {
    let loaded = parse(&format!("f 1 2 3\n{SQUARE}")).unwrap();
    assert_eq!(loaded.scene.piece_count(), 1);
}

#[test]
fn the_object_is_the_last_o_else_the_last_g_else_default() {
    let face = "f 1 2 3\n";
    let text = format!("{SQUARE}{face}g a b\n{face}g\n{face}g c\n{face}o d#e # f\n{face}g h\n{face}o a b\n{face}");
    let scene = parse(&text).unwrap().scene;
    let names: Vec<_> = scene.polygons().map(|polygon| polygon.object_name().to_owned()).collect();
    assert_eq!(names, ["default", "a b", "default", "c", "d#e", "d#e", "a b"]);
    assert_eq!(scene.objects(), ["default", "a b", "c", "d#e"]);
}

#[test]
fn materials_come_from_libraries_with_blanks_in_their_names() {
    let text = format!(
        "mtllib my lamp.mtl\nmtllib one.mtl two.mtl\n{SQUARE}f 1 2 3\nusemtl lamp\nf 1 2 3\nusemtl two\nf 1 2 3\nusemtl none\nf 1 2 3"
    );
    let loaded = obj::parse(text.as_bytes(), "test.obj", &ReadOptions::default(), |name| match name {
        "my lamp.mtl" => Ok(b"newmtl lamp\nKd .2\nKs 0.1 0.2 0.3\nNs 12\nKe 1 2 3e2\nKa 9 9 9\nmap_Kd x.png".to_vec()),
        "two.mtl" => Ok(b"Kd 7 7 7\nnewmtl two\nKd spectral x.rfl\n".to_vec()),
        _ => no_files(name),
    })
    .unwrap();
    let materials = loaded.scene.materials();
    let names: Vec<_> = materials.iter().map(|material| material.name.as_str()).collect();
    assert_eq!(names, ["default", "lamp", "two", "none"]);
    let lamp = Material {
        diffuse: [0.2; 3],
        specular: [0.1, 0.2, 0.3],
        exponent: 12.0,
        emission: [1.0, 2.0, 300.0],
        name: "lamp".into(),
        metallic_roughness: None,
    };
    assert_eq!(materials[1], lamp);
    assert_eq!(materials[2], Material::new("two"));
    assert_eq!(loaded.warnings.len(), 3, "{:?}", loaded.warnings);
    assert!(loaded.warnings[0].starts_with("test.obj:2: no materials from `one.mtl`"));
}

#[test]
fn everything_that_is_wrong_is_named_with_its_line() {
    let text = format!("{SQUARE}f 1 2\nf 1 2 x\nf 0 1 2\nf 1 2 -5\nf 1 3 2 4\nf 1 2 99999999999999999999\nf 1 2 9\n");
    assert_eq!(
        faults(&text),
        [
            "test.obj:5: a face takes at least 3 vertices, but here are 2",
            "test.obj:6: `x` is not the index of a vertex; it takes a whole number",
            "test.obj:7: there is no vertex 0; vertices are counted from 1",
            "test.obj:8: vertex -5 from here on back: there are only 4 so far",
            "test.obj:9: the boundary of polygon 4 crosses itself; split it where it does",
            "test.obj:10: `99999999999999999999` is not the index of a vertex; it takes a whole number",
            "test.obj:11: there is no vertex 9; the file has 4",
        ]
    );
    assert_eq!(faults("v 1 2\nv nan 0 0\nv 0 -inf 0\nv 1 1e400 1\nv 1,2,3\n").len(), 5);
    let many = parse(&"f 1\n".repeat(20_000)).unwrap_err().to_string();
    assert_eq!(many.lines().count(), 9);
    assert!(many.ends_with("\nand 19992 more"));
}

#[test]
fn bad_materials_are_named_where_they_are_defined() {
    let text = format!("mtllib m.mtl\n{SQUARE}usemtl a\nf 1 2 3\n");
    let read = |library: &str| {
        obj::parse(text.as_bytes(), "test.obj", &ReadOptions::default(), |_| Ok(library.as_bytes().to_vec()))
            .unwrap_err()
            .to_string()
    };
    for (line, what) in [
        ("Kd 0 -1 0", "diffuse reflectance"),
        ("Ks -1", "specular reflectance"),
        ("Ke 0 0 -1", "emission"),
        ("Ns -1", "exponent"),
    ] {
        assert_eq!(
            read(&format!("newmtl b\nnewmtl a\n{line}")),
            format!("m.mtl:2: the {what} of material \"a\" is -1; it takes a finite number of at least 0")
        );
    }
    assert_eq!(
        read("newmtl a\nKe 0 1e999 0"),
        "m.mtl:2: Ke: the number `1e999` is too large; the largest is about 1.8e308"
    );
    assert!(read("newmtl a\nKe 0 1").starts_with("m.mtl:2: Ke: a colour takes 3 numbers"));
}

#[test]
fn faces_without_area_are_counted_in_a_warning() {
    let loaded = parse(&format!("{SQUARE}f 1 2 1\nf 1 2 3\nf 1 1 1\n")).unwrap();
    assert_eq!(
        loaded.warnings,
        ["test.obj:5: this face has no area, 2 in all; they keep their numbers and hide nothing"]
    );
    assert_eq!(loaded.scene.polygon(PolygonId(1)).shape(), Shape::Convex);
}

#[test]
fn odd_files_are_scenes_without_faces() {
    for text in ["", "\n\n", "curv2 1 2\n", "\\", "# only a comment \\"] {
        let loaded = parse(text).unwrap();
        assert_eq!(loaded.scene.polygon_count(), 0);
        assert!(!loaded.warnings.is_empty());
    }
}

#[test]
fn no_name_of_a_material_is_default() {
    let text = format!("mtllib m\n{SQUARE}f 1 2 3\nusemtl a\nf 1 2 3\nusemtl\nf 1 2 3\nusemtl default\nf 1 2 3\n");
    let loaded =
        obj::parse(
            text.as_bytes(),
            "test.obj",
            &ReadOptions::default(),
            |_| Ok(b"newmtl a\nnewmtl\nKd 1 0 0".to_vec()),
        )
        .unwrap();
    assert_eq!(loaded.warnings, [""; 0]);
    let materials = loaded.scene.materials();
    assert_eq!(materials.iter().map(|m| m.name.as_str()).collect::<Vec<_>>(), ["default", "a"]);
    assert_eq!(materials[0].diffuse.map(f64::to_bits), [1.0, 0.0, 0.0].map(f64::to_bits));
    assert_eq!(parse(&format!("{SQUARE}usemtl\nf 1 2 3")).unwrap().warnings, [""; 0]);
}

#[test]
fn the_files_that_were_read_are_known() {
    let folder = std::env::temp_dir().join(format!("nusselt-files-{}", std::process::id()));
    fs::create_dir_all(&folder).unwrap();
    let path = folder.join("x.obj");
    fs::write(&path, format!("mtllib a.mtl b.mtl\nmtllib ./a.mtl\n{SQUARE}f 1 2 3\n")).unwrap();
    fs::write(folder.join("a.mtl"), "newmtl a\n").unwrap();
    assert_eq!(io::read_scene(&path, &ReadOptions::default()).unwrap().files, [path.clone(), folder.join("a.mtl")]);
    // A folder is no file to read, whatever it is called.
    let error = io::read_scene(
        &{
            fs::create_dir(folder.join("d.obj")).unwrap();
            folder.join("d.obj")
        },
        &ReadOptions::default(),
    )
    .unwrap_err();
    assert!(error.to_string().contains("not a regular file"), "{error}");
    fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn files_of_no_known_format_are_refused_with_the_endings_that_are_known() {
    let folder = std::env::temp_dir().join(format!("nusselt-endings-{}", std::process::id()));
    fs::create_dir_all(&folder).unwrap();
    for name in ["scene.xyz", "obj"] {
        let path = folder.join(name);
        fs::write(&path, SQUARE).unwrap();
        let error = io::read_scene(&path, &ReadOptions::default()).unwrap_err();
        assert!(matches!(error, ReadError::UnknownFormat { .. }));
        let known = ".obj, .gltf, .glb, .stl, .ply, .json, .city.json";
        let expected = format!("its ending is not one of {known}, nor is its content; convert it or rename it");
        assert_eq!(error.to_string(), format!("cannot read {}: {expected}", path.display()));
    }
    // Options of other formats are no fault, but told.
    let path = folder.join("square.OBJ");
    fs::write(&path, SQUARE.to_owned() + "f 1 2 3 4\n").unwrap();
    let options = ReadOptions { lod: Some("2".to_owned()), ..ReadOptions::default() };
    let warnings = io::read_scene(&path, &options).unwrap().warnings;
    assert!(warnings.len() == 1 && warnings[0].contains("it is OBJ: levels of detail"), "{warnings:?}");
    fs::remove_dir_all(&folder).unwrap();
    let missing = io::read_scene(Path::new("no such FILE.xyz"), &ReadOptions::default());
    assert!(matches!(missing, Err(ReadError::Io { .. })));
}

#[test]
fn what_is_written_is_read_back_bit_for_bit() {
    let p = DVec3::new;
    let groups = [
        obj::Group {
            name: "polygon_0 #1\nx".into(),
            material: Some("grey \\".into()),
            polygons: vec![
                vec![p(0.1, 1e-300, -0.0), p(1.0 / 3.0, 0.0, 1e300), p(5e-324, f64::MAX, 2.0)],
                vec![p(1.0 / 3.0, 0.0, 1e300), p(0.1, 1e-300, -0.0), p(123_456_789.123_456_78, 1e15, 1e-5)],
            ],
        },
        obj::Group { name: String::new(), material: None, polygons: vec![] },
    ];
    let mut bytes = Vec::new();
    obj::write(&mut bytes, &groups, Some("m.mtl")).unwrap();
    let loaded = obj::parse(&bytes, "test.obj", &ReadOptions::default(), |_| Ok(b"newmtl grey _\n".to_vec())).unwrap();
    assert_eq!(loaded.warnings, [""; 0]);
    let scene = loaded.scene;
    for (polygon, expected) in scene.polygons().zip(&groups[0].polygons) {
        let points: Vec<_> = polygon.rings()[0].iter().map(|&v| scene.vertex(v)).collect();
        assert_eq!(&points, expected);
    }
    assert_eq!(scene.objects(), ["polygon_0 _1_x"]);
    let bad = obj::Group { name: "bad".into(), material: None, polygons: vec![vec![DVec3::NAN; 3]] };
    assert!(obj::write(&mut Vec::new(), &[bad], None).is_err());
}

#[test]
fn materials_are_read_back_as_written() {
    let mut lamp = Material::new("lamp");
    lamp.emission = [0.1, 1e20, 3.0];
    let mut library = Vec::new();
    io::mtl::write(&mut library, std::slice::from_ref(&lamp)).unwrap();
    let text = format!("mtllib m\n{SQUARE}usemtl lamp\nf 1 2 3");
    let loaded = obj::parse(text.as_bytes(), "test.obj", &ReadOptions::default(), |_| Ok(library.clone())).unwrap();
    assert_eq!(loaded.scene.materials(), [lamp]);
}

#[test]
fn interrupted_writing_leaves_nothing_behind() {
    let folder = std::env::temp_dir().join(format!("nusselt-test-{}", std::process::id()));
    fs::create_dir_all(&folder).unwrap();
    let path = folder.join("x.obj");
    let failed = io::atomic_write(&path, |file| {
        std::io::Write::write_all(file, b"half")?;
        Err(std::io::Error::other("stop"))
    });
    assert!(failed.is_err());
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 0);
    io::atomic_write(&path, |file| std::io::Write::write_all(file, b"whole")).unwrap();
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 1);
    assert_eq!(fs::read(&path).unwrap(), b"whole");
    fs::remove_dir_all(&folder).unwrap();
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(500) })]

    #[test]
    fn random_bytes_are_read_or_refused(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        let _ = obj::parse(&bytes, "random.obj", &ReadOptions::default(), |_| Ok(bytes.clone()));
    }

    #[test]
    fn random_lines_are_read_or_refused(
        lines in prop::collection::vec((
            prop::sample::select(vec!["v", "v", "v", "f", "f", "f", "o", "g", "usemtl", "mtllib", "newmtl", "Kd", "Ns", "Ke", "#", "\\", "xyz"]),
            prop::collection::vec(prop::sample::select(vec![
                "0", "1", "2", "3", "-1", "-2", "4/5/6", "7//", "/", "1e308", "-1e-320", "0.1", "1e999", "nan", "a", "\\", "#", "\u{e9}", "9223372036854775807", "-9223372036854775808",
            ]), 0..6),
            prop::sample::select(vec!["\n", "\r\n", "\r", " \\\n"]),
        ), 0..40),
    ) {
        let mut text = String::new();
        for (keyword, rest, end) in &lines {
            text.extend([*keyword, " ", &rest.join(" "), end]);
        }
        if let Err(error) = obj::parse(text.as_bytes(), "random.obj", &ReadOptions::default(), |_| Ok(text.clone().into_bytes())) {
            prop_assert!(error.to_string().contains(": "));
        }
    }
}
