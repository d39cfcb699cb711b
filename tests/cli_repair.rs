//! `--repair` as a user meets it: what it drops, welds, says and refuses.
#![cfg(feature = "cli")]

use serde_json::{Value, json};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// A square, a bow tie, a bent square, the first square again, a face with a bad index; a triangle with a corner that is
/// off the square's by a hair.
const BROKEN: &str =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 5 5 0\nv 7 7 0\nv 7 5 0\nv 5 7 0\nv 9 9 9\nv 10 9 9\nv 10 10 9\nv 9 10 9.5
v 1 1 1e-6\nv 2 2 0\nv 1 2 0\nf 1 2 3 4\nf 5 6 7 8\nf 9 10 11 12\nf 4 3 2 1\nf 1 2 99\nf 13 14 15\n";

const ALL: &str = "malformed=drop,self-crossing=drop,non-planar=drop,duplicate=drop,weld=0.001";

struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("repair-{name}-{}", std::process::id()));
        // Left over from a run that was stopped.
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).expect("a folder for tests");
        fs::write(path.join("broken.obj"), BROKEN).expect("writable");
        Self(path)
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

#[test]
fn without_repair_broken_files_are_refused_with_their_lines() {
    let folder = Folder::new("refused");
    let [out, err] = folder.run("info broken.obj", 1);
    assert_eq!(out, "");
    assert!(err.contains("broken.obj:17: the boundary of polygon 1 crosses itself"), "{err}");
    assert!(err.contains("broken.obj:20: there is no vertex 99"), "{err}");
    let [_, err] = folder.run("info broken.obj --repair malformed=drop,self-crossing=drop,non-planar=reject", 1);
    assert!(err.contains("broken.obj:18: polygon 2 is not exactly planar"), "{err}");
    assert!(!err.contains("--repair"), "what is rejected on request comes without advice: {err}");
}

/// The lines of a vertex that is not finite, a face with a bad index, one that is no number, one with two corners, a bow tie.
#[test]
fn a_refusal_names_the_repair_that_goes_on() {
    let folder = Folder::new("advice");
    let vertices = "v 0 0 0\nv 1 1 0\nv 1 0 0\nv 0 1 0\nv 0 0 nan\n";
    for (faces, given, advised) in [
        ("f 1 2 9", "", "malformed=drop"),
        ("f 1 2 x", "", "malformed=drop"),
        ("f 1 2", "", "malformed=drop"),
        ("f 1 2 3 4", "", "self-crossing=drop"),
        ("f 1 2 3 4\nf 1 2 9", "", "self-crossing=drop,malformed=drop"),
        ("f 1 2 3 4", "weld=0.5", "self-crossing=drop,weld=0.5"),
    ] {
        let vertices = vertices.rsplit_once("v 0 0 nan").expect("the last one").0;
        fs::write(folder.0.join("a.obj"), format!("{vertices}{faces}\n")).expect("writable");
        let given = if given.is_empty() { String::new() } else { format!(" --repair {given}") };
        for command in ["info a.obj", "contour a.obj --eye 0,0,1 --sphere"] {
            let [_, err] = folder.run(&format!("{command}{given}"), 1);
            let advice = format!("\n--repair {advised} leaves out such faces, and takes the rest\n");
            assert!(err.ends_with(&advice), "{faces}: {err}");
            folder.run(&format!("{command} --repair {advised}"), 0);
        }
    }
    fs::write(folder.0.join("a.obj"), format!("{vertices}f 1 2 5\n")).expect("writable");
    let [_, err] = folder.run("info a.obj", 1);
    assert!(err.ends_with("\n--repair malformed=drop leaves out such faces, and takes the rest\n"), "{err}");
    folder.run("info nowhere.obj", 1);
}

#[test]
fn what_is_changed_is_warned_of_and_listed() {
    let folder = Folder::new("listed");
    let [out, err] = folder.run(&format!("info broken.obj --json --repair {ALL}"), 0);
    // First what the reader says about the first of them, with its line.
    let (reader, changes) = err.split_once('\n').expect("several lines");
    let fault = "there is no vertex 99; the file has 15 (faults of vertices and faces: 1 in all)";
    assert_eq!(reader, format!("nusselt: warning: broken.obj:20: {fault}"));
    let warnings: Vec<&str> = changes.lines().collect();
    let expected = [
        "malformed=drop dropped 1 polygons (malformed): 4",
        "self-crossing=drop dropped 1 polygons (self-crossing): 1",
        "non-planar=drop dropped 1 polygons (not planar): 2",
        "duplicate=drop dropped 1 polygons (duplicates): 3",
        "weld moved 1 vertices, the farthest by 1e-6",
    ];
    assert_eq!(warnings, expected.map(|what| format!("nusselt: warning: broken.obj: --repair {what}")));
    let info: Value = serde_json::from_str(&out).expect("JSON");
    assert_eq!(info["polygons"], 6);
    assert_eq!(info["pieces"], 2);
    assert_eq!(info["repair"], "non-planar=drop,self-crossing=drop,malformed=drop,duplicate=drop,weld=0.001");
    let repairs = &info["repairs"];
    assert_eq!(repairs["dropped"]["duplicate"]["first"][0]["polygon"], 3);
    assert_eq!(repairs["dropped"]["self_crossing"]["first"][0]["size"], 8f64.sqrt());
    let problem = "polygon 4 cannot be read: there is no vertex 99; the file has 15";
    assert_eq!(repairs["dropped"]["malformed"]["first"][0]["problem"], problem);
    let moved = json!({ "count": 1, "first": [{ "vertex": 12, "from": [1.0, 1.0, 1e-6], "to": [1.0, 1.0, 0.0], "distance": 1e-6 }] });
    assert_eq!(repairs["welded"], moved);
    assert_eq!(repairs["farthest_move"], 1e-6);

    let [words, _] = folder.run(&format!("info broken.obj --repair {ALL}"), 0);
    assert!(words.contains("6 (4 dropped)"), "{words}");
    assert!(words.contains("dropped      1 self-crossing: 1 (size 2.8284271247461903)"), "{words}");
    assert!(words.contains("welded       1 vertices, the farthest by 1e-6: 12 (by 1e-6)"), "{words}");
    let [_, silent] = folder.run(&format!("info broken.obj --quiet --repair {ALL}"), 0);
    assert_eq!(silent, "");
}

#[test]
fn flaws_that_stay_are_listed_with_their_sizes() {
    let folder = Folder::new("flaws");
    let [out, err] = folder.run("info broken.obj --json --repair malformed=drop,self-crossing=drop", 0);
    assert_eq!(err.lines().count(), 3);
    let info: Value = serde_json::from_str(&out).expect("JSON");
    assert_eq!(info["repairs"]["welded"]["count"], 0);
    assert_eq!(info["duplicates"], json!({ "count": 1, "first": [[0, 3]] }));
    assert_eq!(
        info["overlaps"],
        json!({ "count": 1, "first": [{ "polygons": [0, 3], "opposed": true, "area": 1.0 }] })
    );
    assert_eq!(info["all_overlaps"], true);
    assert_eq!((&info["non_planar"]["count"], &info["non_planar"]["first"]), (&json!(1), &json!([2])));
    let deviation = info["non_planar"]["largest"].as_f64().expect("a number");
    assert!((deviation - 0.125 / (1.0 + 2.0 * 0.0625_f64).sqrt()).abs() < 1e-12, "{deviation}");
    // The square with its other side is closed and encloses nothing; the bent one and the triangle are open.
    assert_eq!((&info["components"]["count"], &info["components"]["closed"]), (&json!(3), &json!(1)));
    assert_eq!(info["open_edges"]["count"], 4 + 3);
    assert_eq!(info["open_edges"]["lengths"].as_array().map(Vec::len), Some(7));
    assert_eq!(info["open_edges"]["polygons"], json!([2, 2, 2, 2, 5, 5, 5]));
}

#[test]
fn views_and_proofs_take_repaired_scenes() {
    let folder = Folder::new("views");
    let line = format!("contour broken.obj --eye 0.5,0.5,3 --normal 0,0,-1 --repair {ALL} --certificate c.json --json");
    let [out, _] = folder.run(&line, 0);
    let image: Value = serde_json::from_str(&out).expect("JSON");
    let seen: Vec<_> = image["polygons"].as_array().expect("rows").iter().map(|row| row["polygon"].as_u64()).collect();
    assert_eq!(seen, [Some(0), Some(5)], "polygons keep their numbers");
    folder.run(&format!("verify broken.obj c.json --repair {ALL}"), 0);
    folder.run("verify broken.obj c.json --repair malformed=drop,self-crossing=drop", 1);
    let [_, err] = folder.run(&format!("contour broken.obj --eye 0,0,3 --on 1 --repair {ALL}"), 1);
    assert!(err.contains("polygon 1 has no area, or was dropped"), "{err}");
}

#[test]
fn a_bad_spec_is_a_usage_error() {
    let folder = Folder::new("usage");
    for (spec, said) in [
        ("weld=-1", "weld takes a distance of at least 0"),
        ("weld=nan", "weld takes a distance of at least 0"),
        ("holes=drop", "\"holes\" cannot be repaired"),
        ("zero-area=drop", "zero-area takes keep or reject"),
        ("weld=1,weld=1", "weld is given twice"),
        ("drop", "\"drop\" is not of the form what=policy"),
    ] {
        let [out, err] = folder.run(&format!("info broken.obj --repair {spec}"), 2);
        assert_eq!(out, "");
        assert!(err.starts_with("nusselt: ") && err.contains(said) && err.lines().count() == 1, "{spec}: {err}");
    }
}
