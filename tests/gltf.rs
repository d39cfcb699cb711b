//! glTF and GLB files are read as they are meant, or refused with what is wrong.
#![cfg(feature = "gltf")]
#![expect(clippy::float_cmp, reason = "coordinates must be exactly what the file has")]

use glam::DVec3;
use nusselt::io::{self, Loaded, ReadError, ReadOptions, gltf};
use nusselt::scene::{Material, MetallicRoughness, PolygonId, Scene};
use serde_json::{Value, json};
use std::fs;

fn parse_with(bytes: &[u8], buffer: &[u8]) -> Result<Loaded, ReadError> {
    gltf::parse(bytes, "test.gltf", &ReadOptions::default(), |_| Ok(buffer.to_vec()))
}

/// All faults, one a line.
fn faults(result: Result<Loaded, ReadError>) -> Vec<String> {
    match result {
        Err(ReadError::Invalid(faults)) => faults.list().iter().map(ToString::to_string).collect(),
        other => panic!("not refused: {other:?}"),
    }
}

fn corners(scene: &Scene, polygon: u32) -> Vec<[f64; 3]> {
    scene.polygon(PolygonId(polygon)).rings()[0].iter().map(|&v| scene.vertex(v).to_array()).collect()
}

/// Corners of a unit square as floats, then of a larger one: 4 positions each, 96 bytes; then the indices
/// 0 1 2 0 2 3 as bytes, and padding.
fn buffer() -> Vec<u8> {
    let squares = [1.0_f32, 2.0].map(|s| [[0., 0., 0.], [s, 0., 0.], [s, s, 0.], [0., s, 0.]]);
    let mut bytes: Vec<u8> = squares.iter().flatten().flatten().flat_map(|x| x.to_le_bytes()).collect();
    bytes.extend([0, 1, 2, 0, 2, 3, 0, 0]);
    bytes
}

/// Two triangles of a square on a node.
fn square() -> Value {
    json!({
        "asset": { "version": "2.0" },
        "scene": 0,
        "scenes": [{ "nodes": [0] }],
        "nodes": [{ "mesh": 0 }],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 }, "indices": 1 }] }],
        "accessors": [
            { "bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3" },
            { "bufferView": 1, "componentType": 5121, "count": 6, "type": "SCALAR" }
        ],
        "bufferViews": [
            { "buffer": 0, "byteLength": 96 },
            { "buffer": 0, "byteOffset": 96, "byteLength": 6 }
        ],
        "buffers": [{ "byteLength": 104, "uri": "x.bin" }]
    })
}

fn read(value: &Value) -> Result<Loaded, ReadError> {
    parse_with(value.to_string().as_bytes(), &buffer())
}

/// The square with something else at a place, like `/nodes/0/mesh`.
fn changed(pointer: &str, value: Value) -> Value {
    let mut file = square();
    let (parent, key) = pointer.rsplit_once('/').expect("a pointer");
    match file.pointer_mut(parent).expect("a parent") {
        Value::Array(list) => match key.parse::<usize>() {
            Ok(k) if k < list.len() => list[k] = value,
            _ => list.push(value),
        },
        Value::Object(map) => {
            map.insert(key.to_owned(), value);
        }
        other => panic!("{other}"),
    }
    file
}

fn glb(json: &str, binary: &[u8]) -> Vec<u8> {
    let mut json = json.as_bytes().to_vec();
    json.resize(json.len().next_multiple_of(4), b' ');
    let mut bytes = b"glTF\x02\0\0\0".to_vec();
    bytes.extend((28 + json.len() as u32 + binary.len() as u32).to_le_bytes());
    for (kind, chunk) in [(b"JSON", &json[..]), (b"BIN\0", binary)] {
        bytes.extend((chunk.len() as u32).to_le_bytes());
        bytes.extend(kind);
        bytes.extend(chunk);
    }
    bytes
}

#[test]
fn triangles_come_in_order_with_their_sides() {
    let scene = read(&square()).unwrap().scene;
    assert_eq!(corners(&scene, 0), [[0., 0., 0.], [1., 0., 0.], [1., 1., 0.]]);
    assert_eq!(corners(&scene, 1), [[0., 0., 0.], [1., 1., 0.], [0., 1., 0.]]);
    assert_eq!((scene.objects(), scene.polygon_count()), (&["node_0".to_owned()][..], 2));
}

#[test]
fn glb_is_told_by_its_content_and_holds_its_buffer() {
    let mut file = square();
    file["buffers"][0].as_object_mut().unwrap().remove("uri");
    let bytes = glb(&file.to_string(), &buffer());
    let no_file = |_: &str| panic!("no file is named");
    let loaded = gltf::parse(&bytes, "a.gltf", &ReadOptions::default(), no_file).unwrap();
    assert_eq!((loaded.scene.polygon_count(), loaded.warnings), (2, Vec::new()));
    let longer = [&bytes[..], b"abc"].concat();
    assert_eq!(parse_with(&longer, &[]).unwrap().warnings, ["test.gltf: the 3 bytes after its end were ignored"]);
    for length in 4..bytes.len() {
        assert!(parse_with(&bytes[..length], &[]).is_err(), "{length} bytes");
    }
    let told = |at: usize, byte: u8| {
        let mut bytes = bytes.clone();
        bytes[at] = byte;
        faults(parse_with(&bytes, &[])).join("; ")
    };
    assert_eq!(told(4, 1), "test.gltf: it is version 1 of GLB; convert it to version 2");
    assert!(told(9, 99).starts_with("test.gltf: it says that it has "));
    assert!(told(14, 99).starts_with("test.gltf: a chunk says that it has "));
    assert_eq!(told(16, b'X'), "test.gltf: its first chunk is not JSON");
}

#[test]
fn nodes_are_walked_depth_first_with_transforms_composed_in_doubles() {
    let mut file = square();
    file["scenes"][0]["nodes"] = json!([3, 0]);
    file["meshes"][0]["name"] = json!("quad");
    file["nodes"] = json!([
        { "mesh": 0, "name": "last" },
        { "mesh": 0, "translation": [0.1, 0, 0] },
        { "children": [1], "matrix": [2, 0, 0, 0, 0, 3, 0, 0, 0, 0, 4, 0, 5, 6, 7, 1] },
        { "mesh": 0, "name": "first", "children": [2, 4], "translation": [1e6, 0.1, 0] },
        { "mesh": 0, "name": "last", "rotation": [0, 0, std::f64::consts::FRAC_1_SQRT_2, std::f64::consts::FRAC_1_SQRT_2], "scale": [1, 2, 1] }
    ]);
    let scene = read(&file).unwrap().scene;
    assert_eq!(scene.objects(), ["first", "quad", "last"]);
    assert_eq!(corners(&scene, 0)[1], [1e6 + 1.0, 0.1, 0.0]);
    // 0.1 as a double: not what single precision makes of it.
    assert_eq!(corners(&scene, 2)[0], [2.0 * 0.1 + (1e6 + 5.0), 6.1, 7.0]);
    assert_eq!(corners(&scene, 2)[2], [2.0 + (2.0 * 0.1 + (1e6 + 5.0)), 9.1, 7.0]);
    let turned = DVec3::from(corners(&scene, 4)[2]) - DVec3::new(1e6, 0.1, 0.0);
    assert!(turned.abs_diff_eq(DVec3::new(-2.0, 1.0, 0.0), 1e-9), "{turned}");
    assert_eq!(scene.polygon_count(), 8);
}

#[test]
fn mirrored_nodes_keep_their_sides() {
    for (scale, mirrored) in [([-1, 1, 1], true), ([-1, -1, 1], false), ([-1, -1, -1], true), ([2, 3, 4], false)] {
        let scene = read(&changed("/nodes/0/scale", json!(scale))).unwrap().scene;
        let plain = corners(&read(&square()).unwrap().scene, 0);
        let mut expected: Vec<_> = plain.iter().map(|p| [0, 1, 2].map(|k| p[k] * f64::from(scale[k]))).collect();
        if mirrored {
            expected.swap(0, 1);
        }
        assert_eq!(corners(&scene, 0), expected, "{scale:?}");
    }
}

#[test]
fn strips_and_fans_turn_the_same_way() {
    let up = |scene: &Scene, k: u32| {
        let [a, b, c] = corners(scene, k).try_into().unwrap();
        (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    };
    // Strip: 0 1 3 2 of the square; fan: 0 1 2 3.
    for (mode, indices) in [(5, [0, 1, 3, 2]), (6, [0, 1, 2, 3])] {
        let mut file = square();
        file["meshes"][0]["primitives"][0]["mode"] = json!(mode);
        file["accessors"][1]["count"] = json!(4);
        let mut bytes = buffer();
        bytes[96..100].copy_from_slice(&indices);
        let scene = parse_with(file.to_string().as_bytes(), &bytes).unwrap().scene;
        assert!(up(&scene, 0) > 0.0 && up(&scene, 1) > 0.0);
    }
    // The definition of the format: p_i = { v_(i+1), v_(i+2), v_0 }.
    let mut file = square();
    file["meshes"][0]["primitives"][0] = json!({ "attributes": { "POSITION": 0 }, "mode": 6 });
    assert_eq!(corners(&read(&file).unwrap().scene, 1), [[1., 1., 0.], [0., 1., 0.], [0., 0., 0.]]);
}

#[test]
fn points_and_lines_are_passed_over() {
    let mut file = square();
    let points = json!({ "attributes": { "POSITION": 0 }, "mode": 1 });
    file["meshes"][0]["primitives"] = json!([points, file["meshes"][0]["primitives"][0], { "attributes": {} }]);
    let loaded = read(&file).unwrap();
    assert_eq!(loaded.scene.polygon_count(), 2);
    let expected = [
        "1 primitives of points or lines were ignored",
        "1 primitives of triangles have no positions and were ignored",
    ];
    assert_eq!(loaded.warnings, expected.map(|what| format!("test.gltf: {what}")));
}

#[test]
fn sparse_accessors_replace_positions() {
    let mut file = square();
    // Position 2 becomes what is at byte 72: corner 2 of the large square; all others stay, or are 0.
    let sparse = json!({ "count": 1, "indices": { "bufferView": 1, "byteOffset": 2, "componentType": 5121 },
        "values": { "bufferView": 0, "byteOffset": 72 } });
    file["accessors"][0]["sparse"] = sparse;
    assert_eq!(corners(&read(&file).unwrap().scene, 0), [[0., 0., 0.], [1., 0., 0.], [2., 2., 0.]]);
    file["accessors"][0].as_object_mut().unwrap().remove("bufferView");
    assert_eq!(read(&file).unwrap().scene.vertices(), [DVec3::ZERO, DVec3::new(2.0, 2.0, 0.0)]);
    file["accessors"][0]["sparse"]["count"] = json!(3);
    file["accessors"][0]["sparse"]["values"]["byteOffset"] = json!(0);
    let told = faults(read(&file));
    assert_eq!(told, ["test.gltf: accessor 0: its sparse indices do not ascend below 4: number 1 is 0"]);
}

#[test]
fn quantised_positions_are_numbers_or_fractions() {
    let mut file = square();
    file["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
    file["accessors"][0] = json!({ "bufferView": 2, "componentType": 5122, "count": 4, "type": "VEC3" });
    file["bufferViews"] =
        json!([file["bufferViews"][0], file["bufferViews"][1], { "buffer": 0, "byteLength": 96, "byteStride": 8 }]);
    let mut bytes = buffer();
    for (k, p) in [[0, 0, 0], [32_767, 0, 0], [-32_768, 32_767, 0], [1, 1, 1_i16]].into_iter().enumerate() {
        for (c, x) in p.into_iter().enumerate() {
            bytes[8 * k + 2 * c..][..2].copy_from_slice(&x.to_le_bytes());
        }
    }
    let read = |file: &Value| parse_with(file.to_string().as_bytes(), &bytes).unwrap().scene;
    assert_eq!(corners(&read(&file), 0), [[0., 0., 0.], [32_767., 0., 0.], [-32_768., 32_767., 0.]]);
    file["accessors"][0]["normalized"] = json!(true);
    assert_eq!(corners(&read(&file), 0), [[0., 0., 0.], [1., 0., 0.], [-1., 1., 0.]]);
    assert_eq!(corners(&read(&file), 1)[2], [1.0 / 32_767.0; 3]);
}

#[test]
fn materials_have_base_colour_metal_roughness_and_emission() {
    let mut file = square();
    file["materials"] = json!([
        { "name": "unused" },
        { "name": "lamp", "pbrMetallicRoughness": { "baseColorFactor": [0.1, 0.2, 0.3, 0.5], "metallicFactor": 0.5, "roughnessFactor": 0.25 },
          "emissiveFactor": [1, 0.5, 0], "extensions": { "KHR_materials_emissive_strength": { "emissiveStrength": 10 } } },
        { "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } }
    ]);
    let primitive = |material: Value| json!({ "attributes": { "POSITION": 0 }, "indices": 1, "material": material });
    let plain = json!({ "attributes": { "POSITION": 0 }, "indices": 1 });
    file["meshes"][0]["primitives"] = json!([primitive(json!(1)), plain, primitive(json!(2))]);
    let loaded = read(&file).unwrap();
    let materials = loaded.scene.materials();
    let names: Vec<_> = materials.iter().map(|material| material.name.as_str()).collect();
    assert_eq!(names, ["lamp", "default", "material_2"]);
    let mut lamp = Material::new("lamp");
    (lamp.diffuse, lamp.emission) = ([0.1, 0.2, 0.3], [10.0, 5.0, 0.0]);
    let surface = |base_colour, metallic, roughness| Some(MetallicRoughness { base_colour, metallic, roughness });
    lamp.metallic_roughness = surface([0.1, 0.2, 0.3], 0.5, 0.25);
    let mut white = Material::new("material_2");
    white.diffuse = [1.0; 3];
    white.metallic_roughness = surface([1.0; 3], 1.0, 1.0);
    assert_eq!(materials, [lamp, Material::new("default"), white]);
    assert_eq!(
        loaded.warnings,
        ["test.gltf: 1 materials have textures, which are not read: their factors alone are taken"]
    );
    file["materials"][1]["emissiveFactor"] = json!([-1, 0, 0]);
    let told = faults(read(&file));
    assert_eq!(
        told,
        ["test.gltf: material 1: the emission of material \"lamp\" is -10; it takes a finite number of at least 0"]
    );
}

#[test]
fn graphs_that_are_no_trees_are_refused() {
    let told = |nodes: Value| faults(read(&changed("/nodes", nodes))).join("; ");
    let twice = "it is reached twice; a node takes one parent, and no cycle";
    assert_eq!(told(json!([{ "children": [0] }])), format!("test.gltf: node 0: {twice}"));
    assert_eq!(told(json!([{ "children": [1] }, { "children": [0] }])), format!("test.gltf: node 0: {twice}"));
    assert_eq!(told(json!([{ "children": [1, 1] }, {}])), format!("test.gltf: node 1: {twice}"));
    assert_eq!(told(json!([{ "children": [7] }])), "test.gltf: node 7: there is no such node; the file has 1");
    assert_eq!(told(json!([{ "mesh": 7 }])), "test.gltf: node 0: there is no mesh 7; the file has 1");
    assert_eq!(
        told(json!([{ "scale": [1e200, 1, 1], "children": [1] }, { "scale": [1e200, 1, 1] }])),
        "test.gltf: node 1: its transform is not finite"
    );
    assert!(told(json!([{ "matrix": [1, 0, 0, 0.5, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1] }])).contains("last row"));
    assert!(told(json!([{ "rotation": [0, 0, 0, 0] }])).contains("no length"));
    assert_eq!(faults(read(&changed("/scene", json!(3)))), ["test.gltf: scene: there is no scene 3; the file has 1"]);
}

#[test]
fn a_chain_of_a_hundred_thousand_nodes_is_walked() {
    let count = 100_000;
    let nodes: Vec<Value> = (0..count).map(|k| json!({ "children": [k + 1], "translation": [1, 0, 0] })).collect();
    let mut file = changed("/nodes", Value::Array(nodes));
    file["nodes"].as_array_mut().unwrap().push(json!({ "mesh": 0 }));
    let scene = read(&file).unwrap().scene;
    assert_eq!(corners(&scene, 0)[0], [f64::from(count), 0.0, 0.0]);
}

#[test]
fn what_lies_past_buffers_or_is_no_type_is_told_with_its_item() {
    for (pointer, value, expected) in [
        (
            "/accessors/0/count",
            json!(9),
            "accessor 0: its 9 elements from byte 0 on do not fit into the 96 bytes of the view",
        ),
        ("/accessors/0/count", json!(u64::MAX), "accessor 0: its 18446744073709551615 elements"),
        ("/accessors/0/byteOffset", json!(u64::MAX), "accessor 0: its 4 elements from byte 18446744073709551615 on"),
        ("/accessors/0/componentType", json!(5125), "mesh 0, primitive 0: positions take"),
        ("/accessors/0/componentType", json!(5130), "accessor 0: there is no component type 5130"),
        ("/accessors/0/type", json!("MAT4"), "accessor 0: its type is neither"),
        ("/accessors/0/type", json!("SCALAR"), "mesh 0, primitive 0: positions take"),
        ("/accessors/1/componentType", json!(5120), "mesh 0, primitive 0: indices take"),
        ("/accessors/1/count", json!(5), "mesh 0, primitive 0: triangles take three corners each, but it has 5"),
        (
            "/accessors/0/count",
            json!(3),
            "node 0, mesh 0, primitive 0, triangle 1: there is no vertex 3; the primitive has 3",
        ),
        ("/accessors/0/bufferView", json!(9), "accessor 0: there is no buffer view 9"),
        (
            "/bufferViews/0/byteOffset",
            json!(u64::MAX),
            "accessor 0: buffer view 0 ends after the 104 bytes of buffer 0",
        ),
        ("/bufferViews/0/byteLength", json!(105), "accessor 0: buffer view 0 ends after the 104 bytes of buffer 0"),
        ("/bufferViews/0/byteStride", json!(4), "accessor 0: its elements of 12 bytes are only 4 bytes apart"),
        ("/bufferViews/0/buffer", json!(2), "buffer 2: there is no buffer 2"),
        (
            "/buffers/0/byteLength",
            json!(999_999_999_999_u64),
            "buffer 0: it says that it has 999999999999 bytes, but 104 are there",
        ),
        ("/buffers/0/uri", Value::Null, "buffer 0: it has no `uri`"),
        ("/buffers/0/uri", json!("http://a/b"), "buffer 0: its URI `http://a/b` is no relative path"),
        ("/buffers/0/uri", json!("data:;base64,????"), "buffer 0: its data URI is not base64"),
        ("/meshes/0/primitives/0/attributes/POSITION", json!(5), "mesh 0, primitive 0: there is no accessor 5"),
        ("/meshes/0/primitives/0/material", json!(5), "mesh 0, primitive 0: it takes a material that is not there"),
        ("/meshes/0/primitives/0/mode", json!(7), "mesh 0, primitive 0: there is no mode 7"),
        ("/asset/version", json!("1.0"), "asset: it takes version `1.0` of glTF"),
        ("/asset/minVersion", json!("2.1"), "asset: it takes version `2.1` of glTF"),
        ("/extensionsRequired", json!(["KHR_draco_mesh_compression"]), "asset: its meshes are compressed by Draco"),
        (
            "/extensionsRequired",
            json!(["EXT_meshopt_compression"]),
            "asset: its buffers are compressed by meshoptimizer",
        ),
        (
            "/extensionsRequired",
            json!(["EXT_mesh_gpu_instancing"]),
            "takes an extension that is not known (`EXT_mesh_gpu_instancing`)",
        ),
        ("/scenes", json!([]), "scene: there is no scene 0; the file has 0"),
    ] {
        let told = faults(read(&changed(pointer, value)));
        assert!(told[0].starts_with("test.gltf: ") && told[0].contains(expected), "{pointer}: {told:?}");
    }
}

#[test]
fn numbers_in_buffers_that_are_not_finite_are_told_with_their_triangle() {
    let mut bytes = buffer();
    bytes[36..40].copy_from_slice(&f32::NAN.to_le_bytes());
    let told = faults(parse_with(square().to_string().as_bytes(), &bytes));
    assert_eq!(told, ["test.gltf: node 0, mesh 0, primitive 0, triangle 1: a coordinate is not finite; correct it"]);
}

#[test]
fn json_that_is_broken_is_told_with_its_line() {
    let text = serde_json::to_string_pretty(&square()).unwrap();
    for length in 0..text.len() - 1 {
        assert!(parse_with(&text.as_bytes()[..length], &buffer()).is_err(), "{length} bytes");
    }
    let deep = format!("{{\"asset\":{{\"version\":\"2.0\"}},\n\"extras\":{}", "[".repeat(1_000_000));
    let told = faults(parse_with(deep.as_bytes(), &[]));
    assert!(told[0].starts_with("test.gltf:2: "), "{told:?}");
    assert!(faults(parse_with(b"{}", &[]))[0].contains("missing field `asset`"));
}

#[test]
fn small_files_that_unfold_to_very_many_faces_are_refused() {
    let promise = json!({ "componentType": 5126, "count": 3_000_000_000_u64, "type": "VEC3" });
    let mut zeros = changed("/accessors/0", promise);
    zeros["meshes"][0]["primitives"][0].as_object_mut().unwrap().remove("indices");
    // A million primitives of a mesh, or ten thousand nodes with ten thousand of them.
    let primitive = json!({ "attributes": { "POSITION": 0 }, "indices": 1 });
    let mut many = changed("/meshes/0/primitives", Value::Array(vec![primitive; 10_000]));
    many["nodes"] = Value::Array(vec![json!({ "mesh": 0 }); 10_000]);
    many["scenes"][0]["nodes"] = (0..10_000).collect();
    let mut empty = many.clone();
    empty["accessors"][1]["count"] = json!(0);
    for file in [zeros, many, empty] {
        let told = faults(read(&file));
        assert!(told[0].contains("it unfolds to more than 12582912 corners of faces"), "{told:?}");
    }
}

#[test]
fn buffers_are_files_beside_that_must_be_regular() {
    let folder = std::env::temp_dir().join(format!("nusselt-gltf-{}", std::process::id()));
    fs::create_dir_all(folder.join("a folder")).unwrap();
    let path = folder.join("x.gltf");
    let write = |uri: &str| fs::write(&path, changed("/buffers/0/uri", json!(uri)).to_string()).unwrap();
    fs::write(folder.join("a b.bin"), buffer()).unwrap();
    write("a%20b.bin");
    let loaded = io::read_scene(&path, &ReadOptions::default()).unwrap();
    assert_eq!(loaded.files, [path.clone(), folder.join("a b.bin")]);
    for (uri, expected) in [
        ("a%20folder", "not a regular file"),
        ("c.bin", "(os error 2); check the name and the folder"),
        ("%2Fdev%2Fzero", "no relative path"),
    ] {
        write(uri);
        let error = io::read_scene(&path, &ReadOptions::default()).unwrap_err().to_string();
        assert!(error.contains("buffer 0: ") && error.contains(expected), "{error}");
    }
    // The same under other names: unknown endings, and the binary form under the ending of the other.
    let bytes = fs::read(&path).unwrap();
    fs::write(folder.join("x.unknown"), bytes).unwrap();
    let error = io::read_scene(&folder.join("x.unknown"), &ReadOptions::default()).unwrap_err();
    assert!(error.to_string().contains("buffer 0: "), "{error}");
    fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn lists_of_next_to_nothing_are_limited() {
    let many = vec!["{}"; (1 << 20) + 1].join(",");
    for list in ["nodes", "materials", "scenes"] {
        let text = format!(r#"{{"asset":{{"version":"2.0"}},"{list}":[{many}]}}"#);
        let told = faults(parse_with(text.as_bytes(), &[]));
        assert!(told.len() == 1 && told[0].contains("more than 1048576 items"), "{told:?}");
    }
}

#[test]
fn a_glb_chunk_may_be_padded_with_zeros() {
    let mut json = square().to_string();
    let padding = 4 + (4 - json.len() % 4) % 4;
    json.push_str(&"\0".repeat(padding));
    let bytes = glb(&json, &buffer());
    let loaded = gltf::parse(&bytes, "test.glb", &ReadOptions::default(), |_| Ok(buffer())).expect("a square");
    assert_eq!(loaded.scene.polygon_count(), 2);
}

#[test]
fn optional_members_that_are_null_are_absent() {
    let same = |file: &Value| {
        let loaded = read(file).unwrap_or_else(|error| panic!("{file}\n{error}"));
        assert_eq!((loaded.scene.polygon_count(), loaded.warnings), (2, Vec::new()), "{file}");
        assert_eq!(corners(&loaded.scene, 1), [[0., 0., 0.], [1., 1., 0.], [0., 1., 0.]], "{file}");
    };
    for pointer in [
        "/asset/minVersion",
        "/extensionsRequired",
        "/scene",
        "/materials",
        "/nodes/0/name",
        "/nodes/0/children",
        "/nodes/0/skin",
        "/nodes/0/matrix",
        "/nodes/0/translation",
        "/nodes/0/rotation",
        "/nodes/0/scale",
        "/meshes/0/name",
        "/meshes/0/primitives/0/material",
        "/meshes/0/primitives/0/mode",
        "/meshes/0/primitives/0/targets",
        "/accessors/0/byteOffset",
        "/accessors/0/normalized",
        "/accessors/0/sparse",
        "/bufferViews/0/byteOffset",
        "/bufferViews/0/byteStride",
    ] {
        same(&changed(pointer, Value::Null));
    }
    for pointer in ["/0/name", "/0/pbrMetallicRoughness", "/0/emissiveFactor", "/0/emissiveTexture", "/0/extensions"] {
        let mut file = changed("/materials", json!([{}]));
        file["meshes"][0]["primitives"][0]["material"] = json!(0);
        let (parent, key) = pointer.rsplit_once('/').unwrap();
        file["materials"].pointer_mut(parent).unwrap()[key] = Value::Null;
        same(&file);
    }
    // Lists without which there is nothing: as without them.
    for list in ["scenes", "nodes", "meshes", "accessors", "bufferViews", "buffers"] {
        let mut without = square();
        without.as_object_mut().unwrap().remove(list);
        let null = changed(&format!("/{list}"), Value::Null);
        match (read(&null), read(&without)) {
            (Ok(null), Ok(without)) => assert_eq!(null.warnings, without.warnings, "{list}"),
            (null, without) => assert_eq!(faults(null), faults(without), "{list}"),
        }
    }
}

#[test]
fn extensions_that_change_what_is_seen_are_told() {
    let warned = |pointer: &str, value: Value, warning: &str| {
        let loaded = read(&changed(pointer, value)).unwrap_or_else(|error| panic!("{pointer}: {error}"));
        assert_eq!(loaded.warnings, [format!("test.gltf: {warning}")]);
    };
    warned(
        "/nodes/0/extensions",
        json!({ "EXT_mesh_gpu_instancing": { "attributes": { "TRANSLATION": 0 } } }),
        "1 nodes are instanced by EXT_mesh_gpu_instancing, which is not applied: each is there once, where it is itself",
    );
    let hidden = "1 nodes are not to be visible by KHR_node_visibility, which is not applied: they are there";
    warned("/nodes/0/extensions", json!({ "KHR_node_visibility": { "visible": false } }), hidden);
    // Above what is seen, without a mesh of its own.
    let mut file = square();
    file["nodes"] = json!([
        { "children": [1], "extensions": { "KHR_node_visibility": { "visible": false } } }, { "mesh": 0 }
    ]);
    assert_eq!(read(&file).unwrap().warnings, [format!("test.gltf: {hidden}")]);
    warned(
        "/meshes/0/primitives/1",
        json!({ "attributes": {} }),
        "1 primitives of triangles have no positions and were ignored",
    );
    warned(
        "/meshes/0/primitives/1",
        json!({ "attributes": {}, "mode": 1 }),
        "1 primitives of points or lines were ignored",
    );
    for extensions in
        [json!(null), json!({}), json!({ "KHR_node_visibility": { "visible": true } }), json!({ "other": 3 })]
    {
        assert!(read(&changed("/nodes/0/extensions", extensions)).unwrap().warnings.is_empty());
    }

    // With the same triangles beside, compression is no matter.
    let mut file = square();
    file["meshes"][0]["primitives"][0]["extensions"] = json!({ "KHR_draco_mesh_compression": { "bufferView": 0 } });
    assert!(read(&file).unwrap().warnings.is_empty());
    for accessor in [0, 1] {
        let mut file = file.clone();
        file["accessors"][accessor].as_object_mut().unwrap().remove("bufferView");
        let expected = "test.gltf: mesh 0, primitive 0: its triangles are there only as compressed by Draco \
                        (`KHR_draco_mesh_compression`); write it again without";
        assert_eq!(faults(read(&file)), [expected]);
    }
}

#[test]
fn a_triangle_with_two_bad_corners_has_one_fault() {
    let mut bytes = buffer();
    bytes[0..4].copy_from_slice(&f32::NAN.to_le_bytes());
    bytes[12..16].copy_from_slice(&f32::INFINITY.to_le_bytes());
    let found = faults(parse_with(square().to_string().as_bytes(), &bytes));
    let triangle = |k: u32| {
        format!("test.gltf: node 0, mesh 0, primitive 0, triangle {k}: a coordinate is not finite; correct it")
    };
    assert_eq!(found, [triangle(0), triangle(1)]);
}
