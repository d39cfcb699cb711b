//! `nusselt shadows` on the command line.
#![cfg(feature = "cli")]

mod common;

use common::program::Folder;
use glam::DVec3;
use nusselt::io::{ReadOptions, obj};
use serde_json::Value;

fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

#[test]
fn groups_of_the_file_have_the_areas_of_the_summary() {
    let folder = Folder::new("shadows");
    let summary = folder.parsed("shadows box.obj --light 278,400,279 -o parts.obj -o parts.glb --json");
    assert_eq!(
        (&summary["schema"], &summary["light"]),
        (&"nusselt.shadows/1".into(), &vec![278.0, 400.0, 279.0].into())
    );
    let read =
        obj::parse(folder.read("parts.obj").as_bytes(), "parts.obj", &ReadOptions::default(), |_| Ok(Vec::new()));
    let scene = read.expect("read").scene;
    let mut areas: std::collections::BTreeMap<String, f64> = std::collections::BTreeMap::new();
    for polygon in scene.polygons() {
        for piece in polygon.pieces() {
            let p: Vec<_> = piece.points().collect();
            let doubled: DVec3 = (1..p.len() - 1).map(|k| (p[k] - p[0]).cross(p[k + 1] - p[0])).sum();
            *areas.entry(polygon.object_name().to_owned()).or_default() += doubled.length() / 2.0;
        }
    }
    let rows = summary["polygons"].as_array().expect("rows");
    assert_eq!(rows.len(), 16);
    let mut dark = 0;
    for row in rows {
        for (key, kind) in [("lit", "lit"), ("shadow", "shadow")] {
            let expected = number(&row[key]);
            let found = areas.remove(&format!("polygon_{}_{kind}", row["polygon"])).unwrap_or(0.0);
            // Both from the same rounded corners, summed in another order.
            assert!((found - expected).abs() <= 1e-12 * 6e5, "{row}: {found}");
            dark += usize::from(key == "shadow" && expected > 0.0);
        }
    }
    assert!(areas.is_empty() && dark > 4, "{areas:?}");
    // What the file of the viewer has is as much.
    let info = folder.parsed("info parts.glb --json");
    assert!(info["polygons"].as_u64().expect("a count") >= scene.polygon_count() as u64);
    let text = folder.run("shadows box.obj --light 278,400,279", 0);
    assert!(text.contains("lit ") && text.contains("shadow"), "{text}");
}

#[test]
fn polygons_without_area_are_neither_lit_nor_dark() {
    let folder = Folder::new("shadows-flat");
    let vertices = "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nv 2 0 0\n";
    folder.write("flat.obj", format!("{vertices}f 1 2 3 4\nf 1 2 5\n"));
    let text = folder.run("shadows flat.obj --light 2,2,3", 0);
    assert!(text.contains("2, of them 1 lit, 0 in part, 1 without area"), "{text}");
    folder.write("whole.obj", format!("{vertices}f 1 2 3 4\n"));
    let text = folder.run("shadows whole.obj --light 2,2,3", 0);
    assert!(text.contains("1, of them 1 lit, 0 in part\n"), "{text}");
}

#[test]
fn areas_are_right_or_refused_however_large_or_small() {
    let folder = Folder::new("shadows-size");
    let triangle =
        |name: &str, size: &str| folder.write(name, format!("v 0 0 0\nv {size} 0 0\nv 0 {size} 0\nf 1 2 3\n"));
    triangle("large.obj", "1e150");
    triangle("small.obj", "1e-150");
    for (name, area) in [("large.obj", 5e299), ("small.obj", 5e-301)] {
        let summary = folder.parsed(&format!("shadows {name} --light 1,1,1 --json"));
        // A product of two numbers that are rounded, and of powers of two.
        assert!((number(&summary["total"]["lit"]) / area - 1.0).abs() < 1e-15, "{summary}");
    }
    // One that numbers do not hold, and two whose sum they do not.
    triangle("huge.obj", "1e200");
    let half = "v 0 0 0\nv 1.8e154 0 0\nv 0 1.8e154 0\nv 0 0 9\nv 1.8e154 0 9\nv 0 1.8e154 9\n";
    folder.write("two.obj", format!("{half}f 1 2 3\nf 4 5 6\n"));
    for (name, polygon) in [("huge.obj", 0), ("two.obj", 1)] {
        let error = folder.run(&format!("shadows {name} --light 1,1,1 --json -o x.obj"), 1);
        assert!(error.contains(&format!("{name}: polygon {polygon}: its area")), "{error}");
        assert!(error.trim_end().ends_with("use a larger unit of length") && !folder.path("x.obj").exists(), "{error}");
    }
}

#[test]
fn what_is_wrong_is_said_in_one_line() {
    let folder = Folder::new("shadows-wrong");
    for (line, code, what) in [
        ("shadows box.obj", 2, "--light"),
        ("shadows box.obj --light 1,2", 2, "three numbers"),
        ("shadows box.obj --light 1,2,nan", 2, "not finite"),
        ("shadows box.obj --light 1,2,3 -o x.stl", 2, "neither .obj nor .glb"),
        ("shadows box.obj --light 1,2,3 -o box.obj", 2, "would overwrite"),
        ("shadows box.obj --light 1,2,3 -o box.mtl", 2, "neither .obj nor .glb"),
        ("shadows box.obj --light 1,2,3 -o a.obj -o a.obj", 2, "written twice"),
        ("shadows none.obj --light 1,2,3", 1, "none.obj"),
        ("shadows box.obj --light 1,2,3 -o nowhere/x.glb", 1, "make its directory first"),
    ] {
        let error = folder.run(line, code);
        assert!(error.contains(what), "{line}: {error}");
    }
}
