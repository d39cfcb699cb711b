//! The program as a user meets it: what it prints, writes and refuses.
#![cfg(feature = "cli")]

use serde_json::Value;
use std::f64::consts::{PI, TAU};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// A folder of its own for each test, with the Cornell box in it.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("cli-{name}-{}", std::process::id()));
        // Left over from a run that was stopped.
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).expect("a folder for tests");
        let folder = Self(path);
        folder.run("scene cornell -o box.obj", 0);
        folder
    }

    /// Runs the program in the folder; checks the exit code, and that failures are one message.
    fn run(&self, line: &str, code: i32) -> String {
        let Output { status, stdout, stderr } = Command::new(env!("CARGO_BIN_EXE_nusselt"))
            .args(line.split_whitespace())
            .current_dir(&self.0)
            .output()
            .expect("the program runs");
        let [stdout, stderr] = [stdout, stderr].map(|bytes| String::from_utf8(bytes).expect("UTF-8"));
        assert_eq!(status.code(), Some(code), "{line}\n{stdout}\n{stderr}");
        if code == 0 {
            return stdout;
        }
        assert_eq!(stdout, "", "{line}");
        assert!(stderr.starts_with("nusselt: ") && stderr.ends_with('\n'), "{line}: {stderr}");
        stderr
    }

    fn write(&self, name: &str, text: &str) {
        fs::write(self.0.join(name), text).expect("writable");
    }

    fn read(&self, name: &str) -> String {
        fs::read_to_string(self.0.join(name)).expect("written")
    }

    fn json(&self, name: &str) -> Value {
        serde_json::from_str(&self.read(name)).expect("JSON")
    }

    fn files(&self) -> Vec<String> {
        let entries = fs::read_dir(&self.0).expect("a folder");
        let mut names: Vec<_> =
            entries.map(|e| e.expect("an entry").file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().expect("an array").iter().map(|x| x.as_f64().expect("a number")).collect()
}

fn sum(rows: &Value, key: &str) -> f64 {
    rows.as_array().expect("an array").iter().map(|row| row[key].as_f64().expect("a number")).sum()
}

fn close(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-12 * b.abs().max(1.0)
}

/// What every file of schema `nusselt.contour/1` keeps to.
fn check_contour(image: &Value, hemisphere: bool) {
    assert_eq!(image["schema"], "nusselt.contour/1");
    assert_eq!(numbers(&image["eye"]).len(), 3);
    let keys: &[(&str, f64)] =
        if hemisphere { &[("solid_angle", TAU), ("form_factor", 1.0)] } else { &[("solid_angle", 2.0 * TAU)] };
    for &(key, whole) in keys {
        assert!(close(image["total"][key].as_f64().expect("a total"), whole));
        let background = image["background"][key].as_f64().expect("a number");
        for rows in ["polygons", "objects"] {
            assert!(close(sum(&image[rows], key) + background, whole), "{rows} {key}");
        }
        if image.get("cells").is_some() {
            assert!(close(sum(&image["cells"], key), whole), "cells {key}");
        }
    }
    let ids: Vec<_> = image["polygons"].as_array().expect("rows").iter().map(|row| row["polygon"].as_u64()).collect();
    assert!(ids.is_sorted() && ids.iter().all(Option::is_some));
    for row in image["polygons"].as_array().expect("rows") {
        let whole = if hemisphere { &row["form_factor"] } else { &row["solid_angle"] };
        let [front, back] = ["front", "back"].map(|key| row[key].as_f64().expect("a number"));
        assert!(close(front + back, whole.as_f64().expect("a number")));
        assert!(row["object"].is_string() && row["material"].is_string());
    }
    for cell in image.get("cells").and_then(Value::as_array).into_iter().flatten() {
        assert_eq!(cell["polygon"].is_null(), cell["side"].is_null());
        assert_eq!(cell.get("form_factor").is_some(), hemisphere);
        assert!(cell["solid_angle"].as_f64().expect("a number") >= 0.0);
        let b: Vec<Vec<f64>> = cell["boundary"].as_array().expect("corners").iter().map(numbers).collect();
        assert!(b.len() >= 3);
        for k in 0..b.len() {
            let [p, q, r] = [0, 1, 2].map(|i| glam::DVec3::from_slice(&b[(k + i) % b.len()]));
            assert!(p.cross(q).dot(r) > -1e-15, "counter-clockwise from outside: {cell}");
            assert!((p.length() - 1.0).abs() < 1e-15);
        }
    }
}

#[test]
fn contour_json_keeps_to_its_schema() {
    let folder = Folder::new("schema");
    folder.run("contour box.obj --eye 278,273,-100 --normal 0,0,5 -o h.json", 0);
    let image = folder.json("h.json");
    check_contour(&image, true);
    assert_eq!(image["on"], Value::Null);
    assert_eq!(image["epsilon"], 0.0);
    assert_eq!(image["domain"]["kind"], "hemisphere");
    assert_eq!(numbers(&image["domain"]["normal"]), [0.0, 0.0, 5.0]);
    let names: Vec<_> = image["objects"].as_array().expect("rows").iter().map(|row| row["object"].clone()).collect();
    assert_eq!(names[..3], ["floor", "light", "ceiling"]);

    folder.run("contour box.obj --eye=-2e1,273,200 --sphere -o s.json", 0);
    let image = folder.json("s.json");
    check_contour(&image, false);
    assert_eq!(image["domain"], serde_json::json!({ "kind": "sphere" }));

    let printed: Value =
        serde_json::from_str(&folder.run("contour box.obj --eye -20,273,200 --sphere --json", 0)).expect("JSON");
    check_contour(&printed, false);
    assert!(printed.get("cells").is_none());
    assert_eq!(printed["polygons"], image["polygons"]);
    assert_eq!(printed["timing"]["views"], 1);
    for key in ["load_s", "bsp_s", "view_ms_mean", "view_ms_max", "threads"] {
        assert!(printed["timing"][key].as_f64().expect("a number") >= 0.0, "{key}");
    }
    let predicate = |key: &str| printed["predicates"][key].as_u64().expect("a count");
    assert!(predicate("filter") > 0);
    let decided = ["filter", "identity", "fixed", "arbitrary"].map(predicate);
    assert_eq!(predicate("calls"), decided.iter().sum::<u64>());
}

#[test]
fn the_same_command_writes_the_same_file() {
    let folder = Folder::new("same");
    folder.run("scene room --polygons 300 --seed 3 -o room.obj", 0);
    for ending in ["json", "svg", "obj", "geojson"] {
        for name in ["one", "two"] {
            let threads = name.len();
            folder
                .run(&format!("contour room.obj --eye 3,1,1 --normal 1,0,1 --threads {threads} -o {name}.{ending}"), 0);
        }
        let [one, two] =
            ["one", "two"].map(|name| folder.read(&format!("{name}.{ending}")).replace("two.mtl", "one.mtl"));
        assert!(one == two, "{ending}");
    }
}

#[test]
fn both_ways_show_the_same() {
    let folder = Folder::new("ways");
    folder.run("scene office --polygons 500 --seed 2 -o office.obj", 0);
    let line = "contour office.obj --eye 3,1.5,1 --normal 1,2,1 --certify -o";
    let ways = ["", "--way boxes", "--way bsp", "--epsilon 1e-9"].map(|way| {
        folder.run(&format!("{line} x.json {way}"), 0);
        let image = folder.json("x.json");
        check_contour(&image, true);
        image
    });
    let cells = ways.each_ref().map(|image| image["cells"].as_array().expect("cells").len());
    assert!(cells[0] == cells[1] && cells[1] != cells[2], "by default boxes: {cells:?}");
    for rows in ["polygons", "objects"] {
        let [boxes, rest @ ..] = ways.each_ref().map(|image| image[rows].as_array().expect("rows"));
        for other in rest {
            assert_eq!(boxes.len(), other.len());
            for (a, b) in boxes.iter().zip(other) {
                assert_eq!((&a["polygon"], &a["object"]), (&b["polygon"], &b["object"]));
                for key in ["solid_angle", "form_factor"] {
                    let [a, b] = [a, b].map(|row| row[key].as_f64().expect("a number"));
                    assert!(close(a, b), "{rows} {key}: {a} {b}");
                }
            }
        }
    }
}

#[test]
fn a_point_on_a_polygon_is_found_to_be_on_it() {
    let folder = Folder::new("on");
    let on = |line: &str| {
        folder.run(&format!("contour box.obj --eye {line} -o x.json"), 0);
        let image = folder.json("x.json");
        check_contour(&image, true);
        image
    };
    assert_eq!(on("100,0,100 --normal 0,1,0")["on"], 0);
    assert_eq!(on("100,1e-8,100 --normal 0,3,0")["on"], 0);
    assert_eq!(on("100,0,100 --normal 0,1,0 --free")["on"], Value::Null);
    assert_eq!(on("100,0,100 --normal 0,1,0.1")["on"], Value::Null);
    assert_eq!(on("100,1,100 --normal 0,1,0")["on"], Value::Null);
    // From below the floor nothing is seen.
    let below = on("100,0,100 --normal 0,-1,0");
    assert_eq!(below["on"], 0);
    assert!(close(below["background"]["form_factor"].as_f64().expect("a number"), 1.0));
    // --on moves the eye to the nearest point.
    let front = on("100,50,100 --on 0");
    assert_eq!((&front["on"], numbers(&front["eye"])), (&Value::from(0), vec![100.0, 0.0, 100.0]));
    assert_eq!(numbers(&front["domain"]["normal"]), [0.0, 1.0, 0.0]);
    assert!(front["background"]["form_factor"].as_f64().expect("a number") < 0.5);
    let back = on("100,50,100 --on 0:back");
    assert_eq!(back["domain"]["normal"].to_string(), "[0.0,-1.0,0.0]");
    assert_eq!(back["polygons"].as_array().map(Vec::len), Some(0));
}

#[test]
fn wrong_command_lines_say_what_is_wrong_in_one_line_and_do_nothing() {
    let folder = Folder::new("usage");
    let before = folder.files();
    for (line, named) in [
        ("", "subcommand"),
        ("contour box.obj --eye 0,0,0 --sphere --way boxes --epsilon 0.1", "--epsilon is for the 3D BSP"),
        ("contour box.obj --eye 0,0,0 --sphere --way cut", "boxes, bsp"),
        ("contuor box.obj", "contuor"),
        ("contour box.obj --normal 0,0,1", "--eye"),
        ("contour box.obj --eye 0,0,0", "--normal"),
        ("contour --eye 0,0,0 --sphere", "<SCENE>"),
        ("contour box.obj --eye 0,0,0 --normal 0,0,0", "zero"),
        ("contour box.obj --eye 0,0,0 --normal 0,nan,0", "finite"),
        ("contour box.obj --eye inf,0,0 --sphere", "finite"),
        ("contour box.obj --eye 1e999,0,0 --sphere", "finite"),
        ("contour box.obj --eye 1,2 --sphere", "X,Y,Z"),
        ("contour box.obj --eye 1,2,x --sphere", "\"x\""),
        ("contour box.obj --eye 1,2,3 --sphere --normal 0,0,1", "--normal"),
        ("contour box.obj --eye 1,2,3 --sphere --on 3", "--on"),
        ("contour box.obj --eye 1,2,3 --sphere --free", "--free"),
        ("contour box.obj --eye 1,2,3 --on -1", "-1"),
        ("contour box.obj --eye 1,2,3 --on 1:top", "top"),
        ("contour box.obj --eye 1,2,3 --on 16 -o x.json", "16"),
        ("contour box.obj --eye 1,2,3 --sphere -o x.bmp", ".svg"),
        ("contour box.obj --eye 1,2,3 --sphere -o x.bmp", ".geojson"),
        ("contour box.obj --eye 1,2,3 --sphere -o x.geojson --projection nusselt", "equirectangular"),
        ("contour box.obj --eye 1,2,3 --sphere -o x", ".svg"),
        ("contour nowhere.obj --eye 1,2,3 --sphere -o x.bmp", ".svg"),
        ("contour box.obj --eye 1,2,3 --sphere -o x.svg --projection nusselt", "equirectangular"),
        ("contour box.obj --eye 1,2,3 --sphere -o x.svg --projection mercator", "gnomonic"),
        ("contour box.obj --eye 1,2,3 --sphere -o box.obj", "overwrite"),
        ("contour box.obj --eye 1,2,3 --sphere -o x.json -o ./x.json", "twice"),
        ("contour box.obj --eye 1,2,3 --sphere --quadtree-depth 9", "9"),
        ("contour box.obj --eye 1,2,3 --sphere --epsilon -1", "epsilon"),
        ("contour box.obj --eye 1,2,3 --sphere --threads 0", "threads"),
        ("info", "<SCENE>"),
        ("info box.obj --fragments", "-o"),
        ("info box.obj --fragments -o x.svg", ".obj"),
        ("scene room --seed 1 -o x.obj", "--polygons"),
        ("scene room --polygons 3 -o x.obj", "64"),
        ("scene cornell --polygons 20 -o x.obj", "16"),
        ("scene castle --polygons 100 -o x.obj", "castle"),
        ("scene room --polygons 100 -o x.stl", ".obj"),
    ] {
        let message = folder.run(line, 2);
        assert_eq!(message.lines().count(), 1, "{line}: {message}");
        assert!(message.contains(named), "{line}: {message}");
    }
    assert_eq!(folder.files(), before);
}

#[test]
fn what_cannot_be_read_or_written_is_named_and_leaves_nothing_behind() {
    let folder = Folder::new("work");
    folder.write("bad.obj", "v 0 0 0\nv 1 0 0\nf 1 2 9\n");
    folder.write("nan.obj", "v 0 0 0\nv 1 nan 0\nv 1 1 0\nf 1 2 3\n");
    folder.write("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
    folder.write("scene.xyz", "");
    #[cfg(unix)]
    std::os::unix::fs::symlink("/dev/zero", folder.0.join("endless.obj")).expect("a link");
    let before = folder.files();
    #[cfg(unix)]
    assert!(folder.run("info endless.obj", 1).contains("endless.obj: it is not a regular file"));
    for (line, named) in [
        ("contour nowhere.obj --eye 1,2,3 --sphere -o x.json", "nowhere.obj"),
        ("contour bad.obj --eye 1,2,3 --sphere -o x.json", "bad.obj:3"),
        ("info nan.obj", "nan.obj:2"),
        ("info scene.xyz", ".obj"),
        ("contour flat.obj --eye 1,2,3 --on 0 --quiet", "no area"),
        ("contour box.obj --eye 1,2,3 --sphere -o missing/x.svg", "missing/x.svg"),
        ("scene room --polygons 100 -o missing/x.obj", "missing/x.mtl"),
    ] {
        let message = folder.run(line, 1);
        assert!(message.contains(named), "{line}: {message}");
        assert_eq!(message.lines().filter(|line| line.starts_with("nusselt: ")).count(), 1, "{message}");
    }
    assert_eq!(folder.files(), before);
}

#[test]
fn city_models_are_read_at_a_level_of_detail_and_from_an_origin() {
    let folder = Folder::new("city");
    let surface =
        |lod: &str, ring: &str| format!("{{\"type\":\"MultiSurface\",\"lod\":\"{lod}\",\"boundaries\":[{ring}]}}");
    let geometry = [surface("1", "[[0,1,2]]"), surface("2.2", "[[0,1,2]],[[0,2,3]]")].join(",");
    let start = "{\"type\":\"CityJSON\",\"version\":\"2.0\",\"vertices\":[[0,0,0],[4,0,0],[4,4,0],[0,4,4]],";
    let transform = "\"transform\":{\"scale\":[0.5,0.5,0.5],\"translate\":[10,20,30]}";
    let object = format!("\"CityObjects\":{{\"a\":{{\"type\":\"Road\",\"geometry\":[{geometry}]}}}}");
    folder.write("a.city.json", &format!("{start}{transform},{object}}}"));
    let info = |flags: &str| -> Value {
        serde_json::from_str(&folder.run(&format!("info a.city.json --json {flags}"), 0)).expect("JSON")
    };
    assert_eq!((&info("")["polygons"], &info("--lod 1")["polygons"]), (&Value::from(2), &Value::from(1)));
    for (origin, high) in [("file", [12.0, 22.0, 32.0]), ("local", [2.0, 2.0, 2.0]), ("integers", [4.0, 4.0, 4.0])] {
        assert_eq!(numbers(&info(&format!("--origin {origin}"))["bounds"]["high"]), high);
    }
    assert!(folder.run("info a.city.json --lod 3", 1).contains("a.city.json: nothing has the level of detail 3"));
    assert!(folder.run("info a.city.json --origin here", 2).contains("there are file, local and integers"));
}

#[test]
fn outputs_never_replace_what_is_read() {
    let folder = Folder::new("keep");
    let scene = "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n";
    folder.write("a.obj", &format!("mtllib b.mtl\n{scene}"));
    folder.write("b.mtl", "newmtl a\n");
    let mut lines = vec![
        ("contour a.obj --eye 0,0,1 --sphere -o b.obj", "b.mtl"),
        ("contour a.obj --eye 0,0,1 --sphere -o x.svg -o ./b.obj", "b.mtl"),
        ("contour a.obj --eye 0,0,1 --sphere -o a.obj", "a.obj"),
        ("info a.obj --fragments -o b.obj", "b.mtl"),
        ("info a.obj --fragments -o ./a.obj", "a.obj"),
    ];
    #[cfg(unix)]
    {
        for (target, link) in [("b.mtl", "c.mtl"), ("b.mtl", "d.svg"), ("a.obj", "e.mtl"), (".", "here")] {
            std::os::unix::fs::symlink(target, folder.0.join(link)).expect("a link");
        }
        lines.extend([
            ("contour a.obj --eye 0,0,1 --sphere -o c.obj", "b.mtl"),
            ("contour a.obj --eye 0,0,1 --sphere -o d.svg", "b.mtl"),
            ("info a.obj --fragments -o e.obj", "a.obj"),
            ("info a.obj --fragments -o here/b.obj", "b.mtl"),
        ]);
    }
    let before = (folder.files(), folder.read("a.obj"), folder.read("b.mtl"));
    for (line, named) in lines {
        let message = folder.run(line, 2);
        assert!(message.contains("would overwrite") && message.contains(named), "{line}: {message}");
        assert_eq!(message.lines().count(), 1, "{line}: {message}");
    }
    assert_eq!((folder.files(), folder.read("a.obj"), folder.read("b.mtl")), before);
    folder.run("info a.obj --fragments -o f.obj", 0);
}

#[test]
fn every_json_summary_carries_timing() {
    let folder = Folder::new("timing");
    for line in [
        "info box.obj",
        "scene room --polygons 100 -o x.obj",
        "contour box.obj --eye 1,2,3 --sphere",
        "compare box.obj --eye 1,2,3 --normal 0,0,1 --resolutions 16 --rays 10",
    ] {
        let summary: Value = serde_json::from_str(&folder.run(&format!("{line} --json"), 0)).expect("JSON");
        for key in ["load_s", "bsp_s", "views", "view_ms_mean", "view_ms_max", "threads"] {
            assert!(summary["timing"][key].as_f64().expect("a number") >= 0.0, "{line}: {key}");
        }
    }
    for epsilon in ["1e-300", "1e300", "0.5"] {
        let text = folder.run(&format!("info box.obj --epsilon {epsilon}"), 0);
        assert!(text.lines().any(|line| line.contains(&format!(" {epsilon}, "))), "{text}");
    }
}

#[test]
fn svg_is_well_formed_in_every_projection() {
    let folder = Folder::new("svg");
    folder.write("odd.obj", "o a<b & \"c\"\nv 0 0 1\nv 1 0 1\nv 0 1 1\nf 1 2 3\n");
    for projection in ["nusselt", "gnomonic", "stereographic", "equirectangular"] {
        folder.run(
            &format!(
                "contour box.obj --eye 278,273,-100 --normal 0,0,1 --projection {projection} --show-tree -o x.svg"
            ),
            0,
        );
        check_xml(&folder.read("x.svg"));
        assert!(folder.read("x.svg").contains("id=\"polygon_4\""));
    }
    folder.run("contour box.obj --eye 278,273,100 --sphere -o x.svg", 0);
    check_xml(&folder.read("x.svg"));
    folder.run("contour odd.obj --eye 0.2,0.2,0 --normal 0,0,1 -o x.svg", 0);
    check_xml(&folder.read("x.svg"));
    assert!(folder.read("x.svg").contains("a&lt;b &amp; "));
}

/// Tags are balanced, attributes quoted, no stray characters, all numbers finite.
fn check_xml(text: &str) {
    let mut open = Vec::new();
    for part in text.split('<').skip(1) {
        let (tag, content) = part.split_once('>').expect("tags end");
        assert!(!content.contains('>') && !tag.contains("NaN") && !tag.contains("inf"), "{tag}");
        assert!(tag.matches('"').count() % 2 == 0, "{tag}");
        for entity in content.split('&').skip(1) {
            assert!(["amp;", "lt;", "gt;"].iter().any(|known| entity.starts_with(known)), "{content}");
        }
        let name = tag.split_whitespace().next().expect("a name").to_owned();
        if let Some(closed) = tag.strip_prefix('/') {
            assert_eq!(open.pop().as_deref(), Some(closed));
        } else if !tag.ends_with('/') && !tag.starts_with('?') {
            open.push(name);
        }
    }
    assert!(open.is_empty(), "{open:?}");
}

#[test]
fn visible_parts_in_space_cover_what_is_seen() {
    let folder = Folder::new("obj");
    // Two squares above each other: the upper one hides the middle of the lower one.
    folder.write(
        "two.obj",
        "v -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\nv -4 -4 2\nv 4 -4 2\nv 4 4 2\nv -4 4 2\nf 4 3 2 1\nf 5 6 7 8\n",
    );
    folder.run("contour two.obj --eye 0,0,0 --normal 0,0,1 -o seen.obj", 0);
    let text = folder.read("seen.obj");
    assert!(text.contains("mtllib seen.mtl") && text.contains("g polygon_0") && text.contains("g polygon_1"));
    let scene = nusselt::io::read_scene(&folder.0.join("seen.obj"), &nusselt::io::ReadOptions::default())
        .expect("it reads")
        .scene;
    let mut areas = [0.0; 2];
    for polygon in scene.polygons() {
        let ring: Vec<_> = polygon.rings()[0].iter().map(|&v| scene.vertex(v)).collect();
        let area: f64 = ring.windows(2).map(|p| (p[0] - ring[0]).cross(p[1] - ring[0]).z / 2.0).sum();
        areas[usize::from(ring[0].z > 1.5)] += area;
    }
    // The signs are those of the faces' fronts: down for the first, up for the second.
    assert!((areas[0] + 4.0).abs() < 1e-12 && (areas[1] - (64.0 - 16.0)).abs() < 1e-11, "{areas:?}");

    folder.run("info two.obj --fragments -o fragments.obj", 0);
    assert!(folder.read("fragments.obj").contains("g polygon_1"));
}

#[test]
fn info_counts_what_is_there() {
    let folder = Folder::new("info");
    let info: Value = serde_json::from_str(&folder.run("info box.obj --json", 0)).expect("JSON");
    assert_eq!(info["polygons"], 16);
    assert_eq!(info["objects"].as_array().map(Vec::len), Some(8));
    assert_eq!(info["emitters"], 1);
    assert_eq!(info["open_edges"]["count"], 16);
    assert_eq!(info["non_planar"]["first"], serde_json::json!([5]));
    assert_eq!(numbers(&info["bounds"]["high"]), [556.0, 548.8, 559.2]);
    assert!(info["bsp"]["fragments"].as_u64() >= Some(16));
    assert!(folder.run("info box.obj", 0).contains("16 open"));
    folder.write("empty.obj", "# nothing\n");
    let empty: Value = serde_json::from_str(&folder.run("info empty.obj --json", 0)).expect("JSON");
    assert_eq!((&empty["polygons"], &empty["bounds"]), (&Value::from(0), &Value::Null));
}

#[test]
fn an_empty_scene_shows_the_background() {
    let folder = Folder::new("empty");
    folder.write("empty.obj", "# nothing\n");
    folder.run("contour empty.obj --eye 0,0,0 --normal 1,2,3 -o x.json -o x.svg -o x.obj -o x.geojson", 0);
    let image = folder.json("x.json");
    check_contour(&image, true);
    assert!(close(image["background"]["solid_angle"].as_f64().expect("a number"), 2.0 * PI));
    check_xml(&folder.read("x.svg"));
    assert_eq!(folder.json("x.geojson")["features"].as_array().map(Vec::len), Some(1));
    // The whole sphere is a rectangle.
    folder.run("contour empty.obj --eye 0,0,0 --sphere -o y.geojson", 0);
    let sphere = &folder.json("y.geojson")["features"][0]["geometry"]["coordinates"];
    assert!(close(area_of(sphere), 360.0 * 180.0), "{sphere}");
}

/// The area of a `MultiPolygon`; checks that its rings are closed and turn as RFC 7946 wants it.
fn area_of(coordinates: &Value) -> f64 {
    let mut total = 0.0;
    for polygon in coordinates.as_array().expect("polygons") {
        for (k, ring) in polygon.as_array().expect("rings").iter().enumerate() {
            let ring: Vec<Vec<f64>> = ring.as_array().expect("positions").iter().map(numbers).collect();
            assert!(ring.len() >= 4 && ring.first() == ring.last());
            let area: f64 = ring.windows(2).map(|p| (p[0][0] * p[1][1] - p[0][1] * p[1][0]) / 2.0).sum();
            assert!((area > 0.0) == (k == 0), "exteriors are counter-clockwise, holes clockwise");
            total += area;
        }
    }
    total
}

#[test]
fn geojson_has_the_regions_of_everything_seen() {
    let folder = Folder::new("geojson");
    folder.run("contour box.obj --eye 278,273,-100 --normal 0,0,1 -o x.geojson -o x.json", 0);
    let [picture, image] = ["x.geojson", "x.json"].map(|name| folder.json(name));
    assert_eq!(picture["type"], "FeatureCollection");
    assert_eq!(picture["schema"], "nusselt.regions/1");
    assert_eq!((&picture["projection"], &picture["units"]), (&Value::from("nusselt"), &Value::from("one")));
    assert_eq!(picture["domain"], image["domain"]);
    let features = picture["features"].as_array().expect("features");
    let of = |key: &str| features.iter().map(|f| f["properties"][key].as_f64().expect("a number")).sum::<f64>();
    assert!(close(of("form_factor"), 1.0) && close(of("solid_angle"), TAU));
    let mut total = 0.0;
    for feature in features {
        let properties = &feature["properties"];
        let area = area_of(&feature["geometry"]["coordinates"]);
        assert!((area / PI - properties["form_factor"].as_f64().expect("a number")).abs() < 1e-4, "{properties}");
        total += area;
        let known = |row: &&Value| row["polygon"] == properties["polygon"];
        match image["polygons"].as_array().expect("rows").iter().find(known) {
            Some(row) => {
                assert_eq!((&row["object"], &row["material"]), (&properties["object"], &properties["material"]));
                assert!(properties["side"].is_string() && feature["geometry"]["type"] == "MultiPolygon");
            }
            None => assert!(["polygon", "side", "object", "material"].iter().all(|key| properties[key].is_null())),
        }
    }
    assert!((total - PI).abs() < 1e-4, "{total}");
    assert_eq!(features.last().map(|f| f["properties"]["polygon"].is_null()), Some(true), "background comes last");

    folder.run("contour box.obj --eye 278,273,100 --sphere -o y.geojson", 0);
    let panorama = folder.json("y.geojson");
    assert_eq!(
        (&panorama["projection"], &panorama["units"]),
        (&Value::from("equirectangular"), &Value::from("degree"))
    );
    let features = panorama["features"].as_array().expect("features");
    assert!(features.iter().all(|feature| feature["properties"].get("form_factor").is_none()));
    let total: f64 = features.iter().map(|feature| area_of(&feature["geometry"]["coordinates"])).sum();
    assert!((total - 360.0 * 180.0).abs() < 1.0, "{total}");

    // What is not in the picture is listed all the same.
    folder.run("contour box.obj --eye 278,273,100 --sphere --projection gnomonic -o z.geojson", 0);
    let window = folder.json("z.geojson");
    let features = window["features"].as_array().expect("features");
    assert!(features.iter().any(|feature| feature["geometry"].is_null()));
    let angles = features.iter().map(|f| f["properties"]["solid_angle"].as_f64().expect("a number"));
    assert!(close(angles.sum(), 2.0 * TAU));
}

#[test]
fn help_has_an_example_for_every_command() {
    let folder = Folder::new("help");
    assert!(folder.run("--help", 0).contains("contour"));
    assert!(folder.run("--version", 0).starts_with("nusselt 0."));
    for command in ["info", "contour", "compare", "verify", "scene"] {
        let help = folder.run(&format!("{command} --help"), 0);
        assert!(help.contains("Example") && help.contains(&format!("nusselt {command} ")), "{command}");
    }
}

#[test]
fn quiet_says_nothing() {
    let folder = Folder::new("quiet");
    assert_eq!(folder.run("contour box.obj --eye 1,2,3 --sphere --quiet", 0), "");
    assert_eq!(folder.run("info box.obj --quiet", 0), "");
    assert!(
        folder.run("contour box.obj --eye 100,0,100 --normal 0,1,0", 0).contains("on the front of polygon 0 (floor)")
    );
}

#[test]
fn materials_of_one_name_are_written_under_names_of_their_own() {
    use nusselt::io::{ReadOptions, mtl, obj};
    use nusselt::scene::Material;
    let named = |name: &str, red: f64| Material { diffuse: [red, 0.0, 0.0], ..Material::new(name) };
    let materials = [named("m", 0.1), named("m", 0.2), named("m.1", 0.3), named("", 0.4), named("default", 0.5)];
    let names = mtl::names(&materials);
    assert_eq!(names, ["m", "m.1", "m.1.1", "default", "default.1"]);
    let mut library = Vec::new();
    mtl::write(&mut library, &materials).expect("memory takes all");
    let uses: Vec<String> = names.iter().map(|name| format!("usemtl {name}\nf 1 2 3\n")).collect();
    let uses = uses.concat();
    let text = format!("mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\n{uses}");
    let loaded =
        obj::parse(text.as_bytes(), "a.obj", &ReadOptions::default(), |_| Ok(library.clone())).expect("it reads");
    let reds: Vec<f64> = loaded.scene.polygons().map(|polygon| polygon.material().diffuse[0]).collect();
    assert!(
        reds.iter().zip([0.1_f64, 0.2, 0.3, 0.4, 0.5]).all(|(red, wanted)| red.to_bits() == wanted.to_bits()),
        "{reds:?}"
    );
}
