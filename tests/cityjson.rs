//! CityJSON files are read as they are meant, or refused with what is wrong.
#![cfg(feature = "cityjson")]
#![expect(clippy::float_cmp, reason = "coordinates must be exactly what the file has")]
#![expect(clippy::needless_pass_by_value, reason = "`json!` makes values")]

use glam::DVec3;
use nusselt::io::{Loaded, Origin, ReadError, ReadOptions, cityjson};
use nusselt::scene::{PolygonId, Scene, Shape};
use serde_json::{Value, json};

fn parse_with(text: &str, options: &ReadOptions) -> Result<Loaded, ReadError> {
    cityjson::parse(text.as_bytes(), "test.json", options)
}

fn read(file: &Value) -> Result<Loaded, ReadError> {
    parse_with(&file.to_string(), &ReadOptions::default())
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

/// A file whose vertices are the corners of a cube (bit k of the index is axis k) of 1000 units.
fn file(objects: Value) -> Value {
    let vertices: Vec<_> = (0..8).map(|k| [k & 1, k >> 1 & 1, k >> 2 & 1].map(|bit| 1000 * bit)).collect();
    json!({
        "type": "CityJSON", "version": "2.0", "vertices": vertices, "CityObjects": objects,
        "transform": { "scale": [0.001, 0.001, 0.001], "translate": [100, 200, 0] }
    })
}

/// The six sides of the cube, seen from outside.
fn shell() -> Value {
    json!([[[0, 2, 3, 1]], [[4, 5, 7, 6]], [[0, 1, 5, 4]], [[2, 6, 7, 3]], [[0, 4, 6, 2]], [[1, 3, 7, 5]]])
}

fn surfaces(kind: &str, boundaries: Value) -> Value {
    json!({ "type": kind, "lod": "2", "boundaries": boundaries })
}

#[test]
fn surfaces_of_all_types_come_depth_first() {
    for (kind, boundaries, count) in [
        ("MultiSurface", shell(), 6),
        ("CompositeSurface", shell(), 6),
        ("Solid", json!([shell(), shell()]), 12),
        ("MultiSolid", json!([[shell()], [shell(), shell()]]), 18),
        ("CompositeSolid", json!([[shell()]]), 6),
    ] {
        let loaded = read(&file(json!({ "a": { "type": "Building", "geometry": [surfaces(kind, boundaries)] } })));
        let scene = loaded.unwrap().scene;
        assert_eq!(scene.polygon_count(), count, "{kind}");
        assert_eq!(corners(&scene, 1), [[100., 200., 1.], [101., 200., 1.], [101., 201., 1.], [100., 201., 1.]]);
        assert_eq!((scene.objects(), scene.materials()[0].name.as_str()), (&["a".to_owned()][..], "Building"));
    }
}

#[test]
fn city_objects_keep_the_order_of_the_file() {
    let object =
        |z| json!({ "type": "Building", "geometry": [surfaces("MultiSurface", json!([[[z, z + 1, z + 2]]]))] });
    // `json!` sorts keys; here they are written out of order.
    let empty = file(json!({})).to_string();
    let objects =
        format!("{{\"z\":{},\"b\":{},\"m\":{{\"type\":\"Building\"}},\"a\":{}}}", object(2), object(0), object(4));
    let text = empty.replace("\"CityObjects\":{}", &format!("\"CityObjects\":{objects}"));
    let scene = parse_with(&text, &ReadOptions::default()).unwrap().scene;
    assert_eq!(scene.objects(), ["z", "b", "a"]);
    assert_eq!(corners(&scene, 0)[0], [100., 201., 0.]);
    let twice = text.replace("\"b\":", "\"z\":");
    let told = faults(parse_with(&twice, &ReadOptions::default()));
    assert_eq!(told, ["test.json: city object `z`: the file has two city objects with this id"]);
}

#[test]
fn inner_rings_are_holes() {
    let mut file = file(
        json!({ "a": { "type": "Road", "geometry": [surfaces("MultiSurface", json!([[[0, 1, 3, 2], [8, 9, 10]]]))] } }),
    );
    for hole in [[200, 200, 0], [200, 400, 0], [400, 200, 0]] {
        file["vertices"].as_array_mut().unwrap().push(json!(hole));
    }
    let scene = read(&file).unwrap().scene;
    assert_eq!(scene.polygon(PolygonId(0)).shape(), Shape::Concave);
    assert_eq!(scene.polygon(PolygonId(0)).rings().len(), 2);
}

#[test]
fn the_highest_level_of_detail_of_each_is_taken_or_the_one_that_is_named() {
    let level = |lod: Value, count: usize| json!({ "type": "MultiSurface", "lod": lod, "boundaries": vec![[[0, 1, 3]]; count] });
    let whole = file;
    let file = file(json!({
        "a": { "type": "Building", "geometry": [level(json!("1.3"), 1), level(json!("2.2"), 2), level(json!(0), 4), level(json!("2.2"), 8)] },
        "b": { "type": "Building", "geometry": [level(json!(1), 16)] },
        "c": { "type": "Building", "geometry": [{ "type": "MultiPoint", "lod": "3", "boundaries": [0, 1] }, level(json!("1.0"), 32)] }
    }));
    let count = |lod: Option<&str>| {
        let options = ReadOptions { lod: lod.map(str::to_owned), ..ReadOptions::default() };
        parse_with(&file.to_string(), &options).map(|loaded| loaded.scene.polygon_count())
    };
    assert_eq!(count(None).unwrap(), 2 + 8 + 16 + 32);
    assert_eq!(count(Some("1")).unwrap(), 16 + 32);
    assert_eq!(count(Some("1.3")).unwrap(), 1);
    assert_eq!(count(Some("0.0")).unwrap(), 4);
    let options = |lod: &str| ReadOptions { lod: Some(lod.to_owned()), ..ReadOptions::default() };
    let told = faults(parse_with(&file.to_string(), &options("3")));
    assert_eq!(told, ["test.json: nothing has the level of detail 3; there are 0, 1, 1.3, 2.2"]);
    let told = faults(parse_with(&file.to_string(), &options("high")));
    assert_eq!(told, ["test.json: `high` is no level of detail; one is written like 2 or 2.2"]);
    // Also where there are more levels than a message names.
    let many: Vec<_> = (0..20).map(|lod| level(json!(lod), 1)).collect();
    let many = whole(json!({ "a": { "type": "Building", "geometry": many } })).to_string();
    assert!(faults(parse_with(&many, &options("99")))[0].contains("nothing has the level of detail 99"));
    assert_eq!(parse_with(&many, &options("19")).unwrap().scene.polygon_count(), 1);
    let loaded = parse_with(&file.to_string(), &options("1.3")).unwrap();
    assert_eq!(
        loaded.warnings,
        [
            "test.json: 1 geometries without surfaces were ignored",
            "test.json: 2 city objects have no level of detail 1.3"
        ]
    );
}

#[test]
fn materials_are_named_after_semantic_surfaces() {
    let mut solid = surfaces("Solid", json!([shell(), shell(), shell()]));
    solid["semantics"] = json!({
        "surfaces": [{ "type": "WallSurface" }, { "type": "RoofSurface", "extra": 1 }],
        "values": [[0, 1, null, 0], null]
    });
    let mut object = json!({ "a": { "type": "BuildingPart", "geometry": [solid] } });
    let scene = read(&file(object.clone())).unwrap().scene;
    let names: Vec<_> = scene.polygons().map(|polygon| polygon.material().name.clone()).collect();
    let part = "BuildingPart";
    assert_eq!(names[..7], ["WallSurface", "RoofSurface", part, "WallSurface", part, part, part]);
    assert_eq!(scene.materials().len(), 3);
    let geometry = &mut object["a"]["geometry"][0]["semantics"];
    geometry["values"] = json!([[0, 2]]);
    let told = faults(read(&file(object)));
    assert_eq!(told, ["test.json: city object `a`, geometry 0: there is no semantic surface 2; it has 2"]);
}

#[test]
fn the_origin_decides_what_coordinates_are() {
    let mut file = file(json!({ "a": { "type": "Building", "geometry": [surfaces("Solid", json!([shell()]))] } }));
    file["transform"] = json!({ "scale": [0.001, 0.001, 0.001], "translate": [84_616.468, 447_422.999, -0.452] });
    file["vertices"] = json!(vec![[411_283, 25_181, 572]; 8]);
    let vertex = |origin| {
        let options = ReadOptions { origin, ..ReadOptions::default() };
        parse_with(&file.to_string(), &options).unwrap().scene.vertices()[0].to_array()
    };
    let integers = [411_283.0, 25_181.0, 572.0];
    let local = integers.map(|x| x * 0.001);
    assert_eq!(vertex(Origin::Integers), integers);
    assert_eq!(vertex(Origin::Local), local);
    assert_eq!(vertex(Origin::File), [local[0] + 84_616.468, local[1] + 447_422.999, local[2] - 0.452]);
    file["transform"]["scale"][2] = json!(0.01);
    let options = ReadOptions { origin: Origin::Integers, ..ReadOptions::default() };
    let told = faults(parse_with(&file.to_string(), &options));
    assert!(told[0].starts_with("test.json: transform: its scales differ by axis"), "{told:?}");
    // Without a transform, as version 1.0 allows, vertices are coordinates.
    file.as_object_mut().unwrap().remove("transform");
    file["vertices"] = json!(vec![json!([0.25, 1e6, -3]); 8]);
    assert_eq!(read(&file).unwrap().scene.vertices()[0].to_array(), [0.25, 1e6, -3.0]);
}

fn templates(matrix: Value) -> Value {
    let instance = |at: usize| json!({ "type": "GeometryInstance", "template": 0, "boundaries": [at], "transformationMatrix": matrix });
    let mut file = file(json!({
        "tree": { "type": "SolitaryVegetationObject", "geometry": [instance(1)] },
        "twin": { "type": "SolitaryVegetationObject", "geometry": [instance(7)] }
    }));
    file["geometry-templates"] = json!({
        "templates": [{ "type": "MultiSurface", "lod": "2", "boundaries": [[[0, 1, 2]]] }],
        "vertices-templates": [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
    });
    file
}

#[test]
fn templates_are_placed_by_matrix_and_point() {
    let scene = read(&templates(json!([2, 0, 0, 10, 0, 3, 0, 20, 0, 0, 4, 30, 0, 0, 0, 1]))).unwrap().scene;
    assert_eq!(scene.objects(), ["tree", "twin"]);
    assert_eq!(corners(&scene, 0), [[111., 220., 30.], [113., 220., 30.], [111., 223., 30.]]);
    assert_eq!(corners(&scene, 1)[0], [111., 221., 31.]);
    // A mirrored one keeps its sides.
    let scene = read(&templates(json!([-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]))).unwrap().scene;
    assert_eq!(corners(&scene, 0), [[101., 201., 0.], [100., 200., 0.], [101., 200., 0.]]);
    let options = ReadOptions { origin: Origin::Integers, ..ReadOptions::default() };
    let text = templates(json!([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1])).to_string();
    let scene = parse_with(&text, &options).unwrap().scene;
    assert_eq!(corners(&scene, 0)[1], [2000., 0., 0.]);
}

#[test]
fn instances_that_are_wrong_are_told() {
    let identity = json!([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]);
    for (pointer, value, expected) in [
        ("/template", json!(9), "there is no template 9; the file has 1"),
        ("/template", Value::Null, "an instance takes a `template`"),
        ("/transformationMatrix", Value::Null, "an instance takes a `transformationMatrix`"),
        (
            "/transformationMatrix",
            json!([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 2]),
            "the last row of its matrix is not 0 0 0 1",
        ),
        ("/boundaries", json!([1, 2]), "the `boundaries` of an instance take one vertex"),
        ("/boundaries", json!([99]), "there is no vertex 99; the file has 8"),
    ] {
        let mut file = templates(identity.clone());
        *file["CityObjects"]["tree"]["geometry"][0].pointer_mut(pointer).unwrap() = value;
        assert_eq!(faults(read(&file)), [format!("test.json: city object `tree`, geometry 0: {expected}")]);
    }
    let mut cyclic = templates(identity);
    cyclic["geometry-templates"]["templates"][0] = cyclic["CityObjects"]["tree"]["geometry"][0].clone();
    assert!(faults(read(&cyclic))[0].ends_with("template 0 is an instance itself"));
}

#[test]
fn small_files_that_unfold_to_very_many_faces_are_refused() {
    let mut file = templates(json!([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]));
    let instance = file["CityObjects"]["tree"]["geometry"][0].clone();
    file["CityObjects"]["tree"]["geometry"] = Value::Array(vec![instance; 3_000]);
    file["geometry-templates"]["templates"][0]["boundaries"] = json!(vec![[[0, 1, 2]]; 3_000]);
    let told = faults(read(&file));
    assert!(told[0].contains("city object `tree`: it unfolds to more than 12582912 corners"), "{told:?}");
    file["geometry-templates"]["templates"][0]["boundaries"] = json!(vec![[0; 0]; 3_000]);
    file["geometry-templates"]["templates"][0]["type"] = json!("Solid");
    assert_eq!(read(&file).unwrap().scene.polygon_count(), 0);
}

#[test]
fn surfaces_that_are_wrong_are_told_with_their_number() {
    let told = |kind: &str, boundaries: Value| {
        faults(read(&file(json!({ "a\nb": { "type": "Road", "geometry": [surfaces(kind, boundaries)] } })))).join("; ")
    };
    let place = "test.json: city object `a\\nb`, geometry 0";
    for (boundaries, expected) in [
        (json!([[[0, 1, 3]], [[0, 1, 9]]]), ", surface 1: there is no vertex 9; there are 8"),
        (json!([[[0, 1]]]), ", surface 0: a ring takes at least 3 vertices, but here are 2"),
        (json!([[[0, 3, 1, 2]]]), ", surface 0: the boundary of polygon 0 crosses itself; split it where it does"),
        (json!([[]]), ", surface 0: it is not a list of rings"),
        (json!([[0, 1, 2]]), ", surface 0: it is not a list of rings"),
        (json!([[[[0, 1, 2], 1, 2]]]), ", surface 0: its rings are not lists of indices"),
        (json!([[[0, 1, null]]]), ", surface 0: its rings are not lists of indices"),
        (json!(7), ": its boundaries are not lists as deep as its type says"),
    ] {
        assert_eq!(told("MultiSurface", boundaries), format!("{place}{expected}"));
    }
    assert_eq!(told("Solid", json!([7])), format!("{place}: its boundaries are not lists as deep as its type says"));
}

#[test]
fn files_that_are_no_city_models_are_told() {
    let told = |text: &str| faults(parse_with(text, &ReadOptions::default())).join("; ");
    for (text, expected) in [
        ("{}", "test.json: it has no \"type\": \"CityJSON\""),
        ("{\"type\":\"FeatureCollection\"}", "test.json: its \"type\" is `FeatureCollection`, not \"CityJSON\""),
        ("{\"type\":\"CityJSONFeature\"}", "test.json: it is a feature of a CityJSON sequence"),
        ("{\"type\":\"CityJSON\"}", "test.json: it has no \"version\""),
        ("{\"type\":\"CityJSON\",\"version\":\"3.0\"}", "test.json: its version is `3.0`; convert it to 2.0"),
        ("{\"type\":\"CityJSON\",\n\"vertices\":[[1,2]]}", "test.json:2: "),
        ("{\"vertices\":[[1,2,1e999]]}", "test.json:1: number out of range"),
        ("", "test.json:1: the file ends in the midst of a value"),
    ] {
        assert!(told(text).starts_with(expected), "{}", told(text));
    }
    let mut scale = file(json!({}));
    scale["transform"]["scale"][1] = json!(0);
    assert_eq!(faults(read(&scale)), ["test.json: transform: its scale is not above 0"]);
    scale["transform"]["scale"][1] = json!(1e308);
    assert!(faults(read(&scale))[0].starts_with("test.json: vertex 2: a coordinate is not finite"));
    for pre in [
        "{\"type\":\"CityJSON\",\"CityObjects\":{\"a\":{\"type\":\"x\",\"geometry\":[{\"type\":\"Solid\",\"boundaries\":",
        "",
    ] {
        let deep = told(&(pre.to_owned() + &"[".repeat(1_000_000)));
        assert!(deep.starts_with("test.json:1: ") && deep.len() < 400, "{deep}");
    }
}

#[test]
fn every_truncation_is_refused() {
    let text = templates(json!([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1])).to_string();
    for length in 0..text.len() {
        assert!(parse_with(&text[..length], &ReadOptions::default()).is_err(), "{length} bytes");
    }
}

#[test]
fn coordinates_of_equal_integers_are_equal() {
    // A wall that shares an edge with a roof shares its vertices, whatever the scale does to them.
    let two = json!([[[0, 1, 5, 4]], [[4, 5, 7, 6]]]);
    let scene =
        read(&file(json!({ "a": { "type": "Building", "geometry": [surfaces("MultiSurface", two)] } }))).unwrap().scene;
    assert_eq!(scene.vertices().len(), 6);
    assert!(scene.vertices().iter().all(|v| v.cmpge(DVec3::new(100.0, 200.0, 0.0)).all()));
}

#[test]
fn optional_members_that_are_null_are_absent() {
    let semantics = json!({ "surfaces": [{ "type": "RoofSurface" }], "values": [0, 0, 0, 0, 0, 0] });
    let mut geometry = surfaces("MultiSurface", shell());
    geometry["semantics"] = semantics;
    let mut whole = file(json!({ "a": { "type": "Building", "geometry": [geometry] } }));
    whole["geometry-templates"] = json!({ "templates": [], "vertices-templates": [] });
    for (pointer, key, material, polygons) in [
        ("", "geometry-templates", "RoofSurface", 6),
        ("/geometry-templates", "templates", "RoofSurface", 6),
        ("/geometry-templates", "vertices-templates", "RoofSurface", 6),
        ("/CityObjects/a/geometry/0/semantics", "values", "Building", 6),
        ("/CityObjects/a/geometry/0/semantics", "surfaces", "Building", 6),
        ("/CityObjects/a/geometry/0", "semantics", "Building", 6),
        ("/CityObjects/a/geometry/0", "template", "RoofSurface", 6),
        ("/CityObjects/a/geometry/0", "transformationMatrix", "RoofSurface", 6),
        ("/CityObjects/a/geometry/0", "lod", "RoofSurface", 6),
        ("/CityObjects/a", "geometry", "", 0),
        ("", "CityObjects", "", 0),
    ] {
        let mut file = whole.clone();
        file.pointer_mut(pointer).unwrap()[key] = Value::Null;
        if key == "surfaces" {
            // There is nothing for values to name.
            file["CityObjects"]["a"]["geometry"][0]["semantics"]["values"] = Value::Null;
        }
        let scene = read(&file).unwrap_or_else(|error| panic!("{pointer}/{key}: {error}")).scene;
        assert_eq!(scene.polygon_count(), polygons, "{pointer}/{key}");
        assert_eq!(scene.materials().first().map_or("", |known| &known.name), material, "{pointer}/{key}");
    }
    let mut none = file(json!({}));
    none["vertices"] = Value::Null;
    assert_eq!(read(&none).unwrap().scene.polygon_count(), 0);
}
