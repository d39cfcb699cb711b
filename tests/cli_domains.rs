//! Cameras and windows on the command line.
#![cfg(feature = "cli")]

mod common;

use common::program::Folder;
use glam::DVec3;
use serde_json::{Value, json};
use std::fs;

fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

fn vector(value: &Value) -> DVec3 {
    let numbers: Vec<f64> = value.as_array().expect("an array").iter().map(number).collect();
    DVec3::from_slice(&numbers)
}

#[test]
fn a_camera_sees_what_its_angles_say() {
    let folder = Folder::new("domains-camera");
    let line = "contour box.obj --eye 278,273,-800 --look-at 278,273,0 --fov 60 --up 0,1,0";
    let image = folder.parsed(&format!("{line} --aspect 16/9 --json --certify"));
    let domain = &image["domain"];
    assert_eq!(domain["kind"], "frustum");
    assert_eq!((number(&domain["fov"]), number(&domain["aspect"])), (60.0, 16.0 / 9.0));
    assert_eq!((vector(&domain["towards"]), vector(&domain["up"])), (DVec3::Z, DVec3::Y));
    assert_eq!(domain["normals"].as_array().map(Vec::len), Some(4));
    assert_eq!(image["certificate"]["valid"], true);
    // A rectangular pyramid.
    let b = 30f64.to_radians().tan();
    let a = 16.0 / 9.0 * b;
    let expected = 4.0 * (a * b / ((1.0 + a * a) * (1.0 + b * b)).sqrt()).asin();
    assert!((number(&image["total"]["solid_angle"]) - expected).abs() < 1e-13);
    assert!(image["total"].get("form_factor").is_none());
    // Up is z, or y when that is where it looks.
    let up = |rest: &str| {
        vector(&folder.parsed(&format!("contour box.obj --eye 1,2,3 {rest} --fov 30 --json"))["domain"]["up"])
    };
    assert_eq!(up("--look-at 1,5,3"), DVec3::Z);
    assert_eq!(up("--look-at 1,2,-7"), DVec3::Y);
    assert_eq!(up("--look-at 1,5,3 --up -1,0,0"), DVec3::NEG_X);
    // The picture is the image plane, from border to border.
    folder.run(&format!("{line} --aspect 1.5 -o x.svg -o x.geojson -o x.obj"), 0);
    let svg = folder.read("x.svg");
    assert!(svg.contains("polygon_") && svg.contains("looking along (0, 0, 1) with (0, 1, 0) up"), "{svg}");
    let size = |key: &str| {
        let at = svg.find("<rect class=\"border\"").expect("a border");
        let rest = &svg[at..];
        let rest = &rest[rest.find(&format!("{key}=\"")).expect("its size") + key.len() + 2..];
        rest[..rest.find('"').expect("an end")].parse::<f64>().expect("a number")
    };
    assert!((size("width") / size("height") - 1.5).abs() < 1e-2);
    let words = folder.run(&format!("{line} --aspect 1"), 0);
    assert!(words.contains("camera towards 0,0,1, 60 degrees high, aspect 1\n"), "{words}");
}

#[test]
fn windows_show_how_much_of_a_lamp_is_seen() {
    let folder = Folder::new("domains-windows");
    // The floor is polygon 0 and the lamp polygon 1.
    let whole = folder.parsed("contour box.obj --eye 278,273,0 --on 0 --json");
    let lamp = |image: &Value| {
        let rows = image["polygons"].as_array().expect("rows").clone();
        rows.into_iter().find(|row| row["polygon"] == 1).expect("the lamp is seen")
    };
    for (rest, factors) in
        [("--on 0 --window 1", true), ("--normal 0,1,0 --window 1 --window 1", true), ("--window 1", false)]
    {
        let eye = if factors { vector(&whole["eye"]) } else { DVec3::new(278.0, 273.0, 200.0) };
        let line = format!("contour box.obj --eye {},{},{} {rest}", eye.x, eye.y, eye.z);
        let image = folder.parsed(&format!("{line} --json --certificate kept.json"));
        assert_eq!(image["domain"]["kind"], "window");
        assert!(image["domain"]["windows"].as_array().expect("windows").iter().all(|window| window == 1));
        assert_eq!(image["domain"].get("normal").is_some(), factors);
        assert_eq!(image["total"].get("form_factor").is_some(), factors);
        folder.run("verify box.obj kept.json --rational", 0);
        let verified = folder.parsed("verify box.obj kept.json --json");
        assert_eq!(verified["domain"]["kind"], "window");
        if factors && rest.starts_with("--on") {
            let [seen, expected] = [&image, &whole].map(|image| number(&lamp(image)["form_factor"]));
            assert!((seen - expected).abs() < 1e-14, "{seen} {expected}");
        }
        for file in ["x.json", "x.svg", "x.geojson"] {
            folder.run(&format!("{line} -o {file}"), 0);
        }
        let words = folder.run(&line, 0);
        assert!(words.contains("windows 1"), "{words}");
    }
    // Edge-on: a valid image of nothing.
    for (eye, window) in [("278,548.7,280", 1), ("278,0,280", 0), ("9,0,-50", 0)] {
        let image = folder.parsed(&format!("contour box.obj --eye {eye} --window {window} --json --certify -o x.svg"));
        let seen = [&image["cell_count"], &image["total"]["solid_angle"], &image["polygons"]];
        assert_eq!(seen, [&json!(0), &json!(0.0), &json!([])], "{eye}");
        assert_eq!(image["certificate"]["valid"], true);
    }
}

#[test]
fn wrong_cameras_and_windows_are_told_before_any_work_is_done() {
    let folder = Folder::new("domains-wrong");
    for (rest, named) in [
        ("--look-at 1,2,3 --fov 60", "--look-at is --eye"),
        ("--look-at 1,2,4", "--fov"),
        ("--fov 60", "--look-at"),
        ("--sphere --fov 60", "--look-at"),
        ("--sphere --up 0,0,1", "--up is for a camera"),
        ("--on 0 --aspect 2", "--aspect is for a camera"),
        ("--look-at 1,2,4 --fov 0", "180"),
        ("--look-at 1,2,4 --fov 180", "180"),
        ("--look-at 1,2,4 --fov -5", "180"),
        ("--look-at 1,2,4 --fov nan", "finite"),
        ("--look-at 1,2,inf --fov 60", "finite"),
        ("--look-at 1,2,4 --fov 60 --up 0,0,0", "zero"),
        ("--look-at 1,2,4 --fov 60 --up 0,0,-3", "--up"),
        ("--look-at 1,2,4 --fov 60 --aspect 0", "above 0"),
        ("--look-at 1,2,4 --fov 60 --aspect 4/0", "above 0"),
        ("--look-at 1,2,4 --fov 60 --aspect 4:3", "4:3"),
        ("--look-at 1,7,4 --fov 1e-300", "too thin"),
        ("--look-at 1,2,4 --fov 60 --sphere", "--sphere"),
        ("--look-at 1,2,4 --fov 60 --normal 0,0,1", "--normal"),
        ("--look-at 1,2,4 --fov 60 --window 1", "--window"),
        ("--look-at 1,2,4 --fov 60 --free", "--free"),
        ("--look-at 1,2,4 --fov 60 --projection nusselt -o x.svg", "hemisphere"),
        ("--window 1 --projection nusselt -o x.svg", "hemisphere"),
        ("--window 16", "there is no polygon 16"),
        ("--window 1 --window 99 --normal 0,0,1", "there is no polygon 99"),
        ("--window x", "x"),
        ("", "--look-at"),
    ] {
        let line = format!("contour box.obj --eye 1,2,3 {rest}");
        let message = folder.run(&line, 2);
        assert!(message.contains(named), "{line}: {message}");
    }
    assert_eq!(fs::read_dir(folder.path(".")).expect("a folder").count(), 2, "the scene and its materials");
}
