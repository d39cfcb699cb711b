//! What the program says about files it cannot use, or uses in part.
#![cfg(feature = "cli")]

use serde_json::{Value, json};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("messages-{name}-{}", std::process::id()));
        // Left over from a run that was stopped.
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).expect("a folder for tests");
        Self(path)
    }

    fn write(&self, name: &str, bytes: impl AsRef<[u8]>) {
        fs::write(self.0.join(name), bytes).expect("writable");
    }

    /// What the program prints on stdout and stderr.
    fn run(&self, line: &str, code: i32) -> [String; 2] {
        let program = Command::new(env!("CARGO_BIN_EXE_nusselt"))
            .args(line.split_whitespace())
            .current_dir(&self.0)
            .output()
            .expect("the program runs");
        let [out, err] = [program.stdout, program.stderr].map(|bytes| String::from_utf8(bytes).expect("UTF-8"));
        assert_eq!(program.status.code(), Some(code), "{line}\n{out}\n{err}");
        [out, err]
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// A triangle, and one with a number that is none: binary.
fn stl() -> Vec<u8> {
    let mut bytes = vec![b' '; 80];
    bytes.extend(2_u32.to_le_bytes());
    for third in [1.0, f32::NAN] {
        let numbers: [f32; 12] = [0., 0., 1., 0., 0., 0., 1., 0., 0., 0., 1., third];
        bytes.extend(numbers.iter().flat_map(|number| number.to_le_bytes()));
        bytes.extend([0; 2]);
    }
    bytes
}

/// The first triangle of a primitive is fine; the second one names a vertex that is not there.
fn gltf() -> Value {
    json!({
        "asset": { "version": "2.0" },
        "scene": 0,
        "scenes": [{ "nodes": [0] }],
        "nodes": [{ "mesh": 0 }],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 }, "indices": 1 }] }],
        "accessors": [
            { "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3" },
            { "bufferView": 1, "componentType": 5121, "count": 6, "type": "SCALAR" }
        ],
        "bufferViews": [{ "buffer": 0, "byteLength": 36 }, { "buffer": 0, "byteOffset": 36, "byteLength": 6 }],
        "buffers": [{ "byteLength": 42, "uri": "x.bin" }]
    })
}

fn cityjson() -> Value {
    json!({
        "type": "CityJSON", "version": "2.0", "vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0]],
        "transform": { "scale": [1, 1, 1], "translate": [0, 0, 0] },
        "CityObjects": { "a": { "type": "Building", "geometry": [
            { "type": "MultiSurface", "lod": "2", "boundaries": [[[0, 1, 2]], [[0, 1, 7]]] }
        ] } }
    })
}

#[test]
fn dropped_faces_keep_the_first_cause_in_all_formats() {
    let folder = Folder::new("causes");
    let corners: [f32; 9] = [0., 0., 0., 1., 0., 0., 0., 1., 0.];
    let mut bytes: Vec<u8> = corners.iter().flat_map(|number| number.to_le_bytes()).collect();
    bytes.extend([0, 1, 2, 0, 1, 9]);
    folder.write("x.bin", bytes);
    let ply = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
               element face 2\nproperty list uchar float vertex_indices\nend_header\n\
               0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 0 1 1.5\n";
    let solid = "solid\nfacet vertex 0 0 0 vertex 1 0 0 vertex 0 1 0 endfacet\nfacet\nvertex 0 0 0\nvertex 1 y 0\n\
                 vertex 0 z 0\nendsolid\n";
    for (name, bytes, cause) in [
        ("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 x y\n".into(), "cannot be read: `x` "),
        ("a.ply", ply.into(), "cannot be read: 1.5 "),
        ("a.stl", solid.into(), "cannot be read: `y` is not a number"),
        ("b.stl", stl(), "vertex 5 has a coordinate that is not finite"),
        ("a.gltf", gltf().to_string().into(), "cannot be read: there is no vertex 9; the primitive has 3"),
        ("a.json", cityjson().to_string().into(), "cannot be read: "),
    ] {
        folder.write(name, bytes);
        let [out, err] = folder.run(&format!("info {name} --json --repair malformed=drop"), 0);
        let info: Value = serde_json::from_str(&out).expect("JSON");
        assert_eq!(info["polygons"], 2, "{name}");
        let dropped = &info["repairs"]["dropped"]["malformed"];
        assert_eq!((&dropped["count"], &dropped["first"][0]["polygon"]), (&json!(1), &json!(1)), "{name}");
        // The corners that are there make it as large as they are apart.
        let size = dropped["first"][0]["size"].as_f64().expect("a number");
        let expected = if ["a.obj", "a.stl"].contains(&name) { 0.0 } else { 1.0 };
        assert!((size - expected).abs() < f64::EPSILON, "{name}: {size}");
        let problem = dropped["first"][0]["problem"].as_str().expect("text");
        assert!(problem.contains(cause), "{name}: {problem}");
        // The warning of the reader gives the same cause.
        if let Some((_, cause)) = problem.split_once("cannot be read: ") {
            assert!(err.contains(cause), "{name}: {cause}\n{err}");
        }
        let [_, err] = folder.run(&format!("info {name}"), 1);
        assert!(err.starts_with(&format!("nusselt: {name}:")), "{err}");
    }
    let [_, err] = folder.run("info b.stl", 1);
    let advice = "--repair malformed=drop leaves out such faces, and takes the rest";
    assert_eq!(err, format!("nusselt: b.stl: triangle 1: a coordinate is not finite; correct it\n{advice}\n"));
}

#[test]
fn faults_are_counted_alike_whatever_they_are() {
    let folder = Folder::new("counts");
    let vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    folder.write("a.obj", format!("{vertices}f 1 2 3\nf 1 2 8\nf 1 2\nf 1 2 x\n"));
    let header = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
                  element face 4\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n";
    folder.write("a.ply", format!("{header}3 0 1 2\n3 0 1 7\n2 0 1\n3 0 1 x\n"));
    for (name, first) in [("a.obj", "5: there is no vertex 8; the file has 3"), ("a.ply", "14: there is no vertex 7")] {
        let [out, err] = folder.run(&format!("info {name} --json --repair malformed=drop"), 0);
        assert!(err.starts_with(&format!("nusselt: warning: {name}:{first}")), "{err}");
        assert!(err.contains("(faults of vertices and faces: 3 in all)\n"), "{err}");
        assert!(err.contains("dropped 3 polygons (malformed): 1, 2, 3\n"), "{err}");
        let info: Value = serde_json::from_str(&out).expect("JSON");
        for dropped in info["repairs"]["dropped"]["malformed"]["first"].as_array().expect("a list") {
            assert_eq!(dropped["size"], 1.0, "{name}: {dropped}");
        }
    }
}

#[test]
fn text_that_is_ignored_or_is_no_text_is_told() {
    let folder = Folder::new("surplus");
    let header = "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
                  element face 1\nproperty list uchar int vertex_indices\nend_header\n";
    let text = format!("ply\nformat ascii 1.0\n{header}0 0 0\n1 0 0 7\n0 1 0\n3 0 1 2 2\n\n9 9\n8\n");
    folder.write("a.ply", text);
    let mut bytes = format!("ply\nformat binary_little_endian 1.0\n{header}").into_bytes();
    bytes.extend([0., 0., 0., 1., 0., 0., 0., 1., 0.].iter().flat_map(|x: &f32| x.to_le_bytes()));
    bytes.push(3);
    bytes.extend([0, 1, 2].iter().flat_map(|k: &i32| k.to_le_bytes()));
    folder.write("c.ply", [&bytes[..], b"\r\n"].concat());
    bytes.extend(b"\n123");
    folder.write("b.ply", bytes);
    let [_, err] = folder.run("info a.ply", 0);
    let expected = [
        "a.ply:11: more than its element takes was ignored, in 2 lines in all",
        "a.ply:15: what follows the last element was ignored",
    ];
    assert_eq!(err, expected.map(|what| format!("nusselt: warning: {what}\n")).concat());
    let [_, err] = folder.run("info b.ply", 0);
    assert_eq!(err, "nusselt: warning: b.ply: the 4 bytes after the last element were ignored\n");
    assert_eq!(folder.run("info c.ply", 0)[1], "", "the end of a line is nothing");

    folder.write(
        "a.stl",
        "solid a facet normal 0 0 1 outer loop vertex 0 0 0 vertex 1 0 0 vertex 0 1 0 endloop endfacet",
    );
    let [_, err] = folder.run("info a.stl", 1);
    assert!(err.starts_with("nusselt: a.stl:1: the facets follow in the line of `solid`"), "{err}");
    folder.write("b.stl", "solid facet plate\nfacet vertex 0 0 0 vertex 1 0 0 vertex 0 1 0 endfacet\nendsolid\n");
    folder.run("info b.stl", 0);

    for order in [u16::to_le_bytes, u16::to_be_bytes] {
        let text = "\u{feff}v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
        folder.write("a.obj", text.encode_utf16().flat_map(order).collect::<Vec<u8>>());
        assert_eq!(folder.run("info a.obj", 1)[1], "nusselt: a.obj: its text is UTF-16; save it as UTF-8\n");
    }
}

#[test]
fn levels_of_detail_are_numbers() {
    let folder = Folder::new("lods");
    folder.write("a.json", cityjson().to_string().replace("7]", "2]"));
    for lod in ["nan", "inf", "-inf", "x", "2.x"] {
        let [_, err] = folder.run(&format!("info a.json --lod {lod}"), 2);
        assert!(err.contains("--lod"), "{err}");
    }
    folder.run("info a.json --lod=", 2);
    folder.run("info a.json --lod 2.0", 0);
    folder.run("info a.json --lod 3", 1);
}

/// Triangles with corners anywhere in a cube: most of them pass through each other.
fn soup(count: usize) -> String {
    let mut state = 7_u64;
    let mut number = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 40).to_string()
    };
    let vertices: String =
        (0..3 * count).map(|_| ["v ", &number(), " ", &number(), " ", &number(), "\n"].concat()).collect();
    let faces = (0..count).map(|k| format!("f {} {} {}\n", 3 * k + 1, 3 * k + 2, 3 * k + 3));
    faces.fold(vertices, |text, face| text + &face)
}

#[test]
fn a_scene_that_falls_into_too_many_fragments_has_its_report_all_the_same() {
    let folder = Folder::new("soup");
    folder.write("a.obj", soup(1000));
    let why = "the scene's polygons cut each other into more than 1048576 fragments; simplify it";
    let [out, err] = folder.run("info a.obj", 0);
    assert_eq!(err, "");
    assert!(out.contains("edges        3000 open\n"), "{out}");
    assert!(out.contains(&format!("3D BSP       not built: {why}")), "{out}");
    let [out, _] = folder.run("info a.obj --json", 0);
    let info: Value = serde_json::from_str(&out).expect("JSON");
    assert_eq!(
        (&info["polygons"], &info["open_edges"]["count"], &info["bsp"]),
        (&json!(1000), &json!(3000), &json!(null))
    );
    assert!(info["bsp_not_built"].as_str().is_some_and(|what| what.starts_with(why)), "{info}");
    let [_, err] = folder.run("info a.obj --fragments -o b.obj", 1);
    assert!(err.starts_with(&format!("nusselt: a.obj: {why}")) && !err.contains("::"), "{err}");
    assert!(!folder.0.join("b.obj").exists());
    folder.write("a.obj", soup(1));
    let [out, _] = folder.run("info a.obj --json", 0);
    let info: Value = serde_json::from_str(&out).expect("JSON");
    assert!(info["bsp"]["nodes"] == 1 && info.get("bsp_not_built").is_none(), "{info}");
}

#[test]
fn flawed_edges_are_listed_with_polygons_and_sizes() {
    let folder = Folder::new("edges");
    // A square and three triangles at its first side, one of them turned; one more whose corner is in that side.
    let text = "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nv 1 -1 0\nv 1 0 1\nv 1 0 0\nv 1 -1 -1\nv 2 -1 -1\n\
                f 1 2 3 4\nf 1 2 5\nf 1 2 6\nf 7 8 9\n";
    folder.write("a.obj", text);
    let [out, _] = folder.run("info a.obj", 0);
    assert!(out.contains("open edges   of polygons 0 (length 2), 1 (length 1.41"), "{out}");
    assert!(out.contains("crowded      of polygons 0 and 1 and 2 (length 2)\n"), "{out}");
    assert!(out.contains("T-junctions  1, 0 of them not exactly on the edge: 1,0,0 in 0,0,0 to 2,0,0\n"), "{out}");
    folder.write("b.obj", text.replace("f 1 2 6\nf 7 8 9\n", "").replace("v 1 0 0\n", "v 1 0 1e-12\n"));
    let [out, _] = folder.run("info b.obj", 0);
    assert!(out.contains("turned       0,0,0 to 2,0,0\n"), "{out}");
    folder.write("c.obj", text.replace("v 1 0 0\n", "v 1 0 1e-12\n"));
    let [out, _] = folder.run("info c.obj", 0);
    assert!(out.contains(": 1,0,1e-12 in 0,0,0 to 2,0,0 (gap 1e-12)\n"), "{out}");
    // What there is none of has no line.
    folder.write("d.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 3 2 1\n");
    let [out, _] = folder.run("info d.obj", 0);
    assert!(["open edges", "crowded", "turned"].iter().all(|what| !out.contains(what)), "{out}");
}

/// A triangle before a wall, seen from the origin. Two of its sides are nearer to each other than the rounding of points if it is thin.
fn before_a_wall(is_thin: bool) -> String {
    let (b, w) = (1_i64 << 50, 1_i64 << 53);
    let corners = [
        [0, b - 1, b],
        if is_thin { [0, b - 2, b - 1] } else { [0, b / 2, b] },
        [b / 2, b / 2, b],
        [-w, -w, w / 2],
        [w, -w, w / 2],
        [w, w, w / 2],
        [-w, w, w / 2],
    ];
    let vertices = corners.map(|[x, y, z]| format!("v {x} {y} {z}\n")).concat();
    format!("{vertices}f 1 2 3\nf 4 5 6 7\n")
}

#[test]
fn tangled_features_are_marked_and_counted() {
    let folder = Folder::new("tangled");
    for (is_thin, projection) in
        [true, false].into_iter().flat_map(|thin| ["nusselt", "stereographic", "equirectangular"].map(|p| (thin, p)))
    {
        folder.write("a.obj", before_a_wall(is_thin));
        let line = format!("contour a.obj --eye 0,0,0 --normal 0,0,1 --projection {projection} -o a.geojson");
        let [_, err] = folder.run(&line, 0);
        let picture: Value =
            serde_json::from_str(&fs::read_to_string(folder.0.join("a.geojson")).expect("written")).expect("JSON");
        let mut marked = Vec::new();
        for feature in picture["features"].as_array().expect("features") {
            let properties = &feature["properties"];
            match properties.get("tangled") {
                None => {}
                Some(tangled) => {
                    assert_eq!(tangled, true);
                    marked.push(properties["polygon"].clone());
                }
            }
        }
        let (expected, warning) = if is_thin {
            let what =
                "the rings of 2 features may touch or cross: their points are rounded, and they have the property";
            (vec![json!(0), json!(1)], format!("nusselt: warning: a.geojson: {what} `tangled`\n"))
        } else {
            (Vec::new(), String::new())
        };
        assert_eq!((marked, err), (expected, warning), "{projection}");
    }
}

/// A triangle of which a corner smaller than rounding is seen past another one; a triangle that has such a corner cut off by the plane of
/// another one.
#[test]
fn slivers_that_are_no_faces_are_counted() {
    let folder = Folder::new("slivers");
    let tiny = 2.0_f64.powi(-54);
    let wall = "v 1 1 1\nv 2 1 1\nv 1 2 1\nf 1 2 3\n";
    folder.write("a.obj", format!("{wall}v {tiny} 1 0.5\nv 1 {tiny} 0.5\nv 4 4 0.5\nf 4 5 6\n"));
    let [_, err] = folder.run("contour a.obj --eye 0,0,0 --sphere -o x.obj", 0);
    let what = "too thin to have three different corners were left out";
    assert_eq!(err, format!("nusselt: warning: x.obj: 2 cells {what}\n"));
    let tiny = 2.0_f64.powi(-52);
    folder.write("b.obj", format!("{wall}v {tiny} 4 2\nv 4 {tiny} 2\nv 0 0 0\nf 4 5 6\n"));
    let [out, err] = folder.run("info b.obj --fragments -o y.obj", 0);
    assert!(out.contains("3 fragments"), "{out}");
    assert_eq!(err, format!("nusselt: warning: y.obj: 1 fragments {what}\n"));
    let faces = |name: &str| {
        let text = fs::read_to_string(folder.0.join(name)).expect("written");
        text.lines().filter(|line| line.starts_with("f ")).count()
    };
    assert_eq!(faces("y.obj"), 2);
    folder.write("c.obj", wall);
    assert_eq!(folder.run("contour c.obj --eye 0,0,0 --sphere -o z.obj", 0)[1], "");
}

#[test]
fn missing_files_come_with_advice() {
    let folder = Folder::new("missing");
    let advice = "; check the name and the folder\n";
    let [_, err] = folder.run("info nowhere.obj", 1);
    assert!(err.starts_with("nusselt: cannot read nowhere.obj: ") && err.ends_with(advice), "{err}");
    folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    let [_, err] = folder.run("verify a.obj nowhere.json", 1);
    assert!(err.starts_with("nusselt: cannot read nowhere.json: ") && err.ends_with(advice), "{err}");
    folder.write("a.gltf", gltf().to_string());
    let [_, err] = folder.run("info a.gltf", 1);
    assert!(err.contains("cannot read `x.bin`: ") && err.ends_with(advice), "{err}");
}

#[test]
fn lists_nested_too_deep_are_told_in_plain_words() {
    let folder = Folder::new("nested");
    let mut city = cityjson().to_string();
    city = city.replace("[[[0,1,2]]", &format!("[{}0{}", "[".repeat(200), "]".repeat(200)));
    folder.write("a.json", city);
    let [_, err] = folder.run("info a.json", 1);
    assert!(err.contains("lists and objects are nested too deep, more than 127 levels; flatten them"), "{err}");
    assert_eq!(err.lines().count(), 1);
}

#[test]
fn numbers_of_materials_are_named_with_their_line() {
    let folder = Folder::new("materials");
    folder.write("a.mtl", "newmtl grey\nKd 1 1 1\nnewmtl \u{1b}lamp\nKe 1 -2 1\n");
    folder.write("a.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl \u{1b}lamp\nf 1 2 3\n");
    let [_, err] = folder.run("info a.obj", 1);
    let what = "the emission of material \"\\u{1b}lamp\" is -2; it takes a finite number of at least 0";
    assert_eq!(err, format!("nusselt: a.mtl:3: {what}\n"));
}

/// Polygons on each other are told before rows of form factors are, which may take long for them: those of open bodies, face to face, and those that show the same way.
#[test]
fn polygons_on_each_other_are_told_before_form_factors() {
    let folder = Folder::new("contacts");
    let corners = |[low, high]: [[f64; 3]; 2]| -> String {
        let corner = |k: usize| [0, 1, 2].map(|axis| if k >> axis & 1 == 0 { low[axis] } else { high[axis] });
        (0..8).map(corner).fold(String::new(), |text, [x, y, z]| text + &format!("v {x} {y} {z}\n"))
    };
    let faces = |first: usize, faces: &[[usize; 4]], outwards: bool| -> String {
        let line = |text: String, face: &[usize; 4]| {
            let mut face = face.map(|k| (first + k).to_string());
            if outwards {
                face.reverse();
            }
            text + &format!("f {}\n", face.join(" "))
        };
        faces.iter().fold(String::new(), line)
    };
    // Fronts inside, the one below first.
    let all = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]];
    let room = corners([[0.0; 3], [4.0, 3.0, 2.5]]) + &faces(1, &all, false);
    let block = corners([[1.0, 1.0, 0.0], [2.0, 2.0, 1.0]]) + &faces(9, &all, true);
    let other = corners([[1.5, 1.5, 0.0], [2.5, 2.5, 0.5]]);
    let said = |name: &str, text: String| {
        folder.write(name, text);
        folder.run(&format!("form-factors {name} --rows 0..1 --tolerance 1e-2 --json"), 0)[1].clone()
    };
    assert_eq!(said("closed.obj", format!("{room}{block}{other}{}", faces(17, &all, true))), "");
    // Without its top and the wall that would be in the block.
    let open = said("open.obj", format!("{room}{block}{other}{}", faces(17, &[all[0], all[2], all[3], all[5]], true)));
    assert!(
        open.starts_with("nusselt: warning: polygons 0 and 12 lie on each other, face to face, but bodies"),
        "{open}"
    );
    // Two triangles, turned by 0.7 about an axis.
    let (sin, cos) = 0.7_f64.sin_cos();
    let turned = |ring: [[f64; 2]; 3]| {
        ring.iter().fold(String::new(), |text, [x, y]| text + &format!("v {x} {} {}\n", y * cos, y * sin))
    };
    let first = turned([[0.0, 0.0], [4.0, 0.0], [0.0, 3.0]]);
    let second = turned([[0.3, 0.2], [1.7, 0.4], [0.6, 1.9]]);
    let flush = said("flush.obj", format!("{first}{second}f 1 2 3\nf 4 5 6\n"));
    assert!(flush.starts_with("nusselt: warning: polygons 0 and 1 show the same way and lie on each other"), "{flush}");
}
