//! `nusselt form-factors` as a user meets it.
#![cfg(feature = "cli")]

use serde_json::{Value, json};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// A unit cube seen from inside: floor, ceiling and four walls, with their fronts inwards.
const CUBE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n\
    f 1 2 3 4\nf 8 7 6 5\nf 5 6 2 1\nf 6 7 3 2\nf 7 8 4 3\nf 8 5 1 4\n";
/// Between opposite and between adjacent faces of a cube: closed forms (Howell's catalogue, C-11 and C-14).
const OPPOSITE: f64 = 0.199_824_895_698_387;
const ADJACENT: f64 = 0.200_043_776_075_403;
#[cfg(feature = "parquet")]
const ENDINGS: [&str; 6] = ["json", "csv", "npy", "mtx", "rows", "parquet"];
#[cfg(not(feature = "parquet"))]
const ENDINGS: [&str; 5] = ["json", "csv", "npy", "mtx", "rows"];

/// A folder of its own for each test, with the cube in it.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("form-factors-{name}-{}", std::process::id()));
        // Left over from a run that was stopped.
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).expect("a folder for tests");
        let folder = Self(path);
        folder.write("cube.obj", CUBE);
        folder
    }

    fn command(&self, line: &str) -> Command {
        let mut program = Command::new(env!("CARGO_BIN_EXE_nusselt"));
        program.args(line.split_whitespace()).current_dir(&self.0).stdin(Stdio::null());
        program
    }

    /// What the program prints on stdout and on stderr.
    fn output(&self, line: &str, code: i32) -> [String; 2] {
        let output = self.command(line).output().expect("the program runs");
        let [out, err] = [output.stdout, output.stderr].map(|bytes| String::from_utf8(bytes).expect("UTF-8"));
        assert_eq!(output.status.code(), Some(code), "{line}\n{out}\n{err}");
        [out, err]
    }

    /// What it prints on stdout if it succeeds.
    fn run(&self, line: &str) -> String {
        self.output(line, 0)[0].clone()
    }

    /// The one line in which it fails.
    fn fail(&self, line: &str, code: i32) -> String {
        let [out, err] = self.output(line, code);
        assert!(out.is_empty() && err.lines().count() == 1 && err.starts_with("nusselt: "), "{line}: {out}{err}");
        err
    }

    fn summary(&self, line: &str) -> Value {
        serde_json::from_str(&self.run(&format!("{line} --json"))).expect("JSON and nothing else")
    }

    fn read(&self, name: &str) -> Vec<u8> {
        fs::read(self.0.join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    fn json(&self, name: &str) -> Value {
        serde_json::from_slice(&self.read(name)).expect("JSON")
    }

    fn write(&self, name: &str, text: &str) {
        fs::write(self.0.join(name), text).expect("writable");
    }

    fn names(&self) -> Vec<String> {
        let files = fs::read_dir(&self.0).expect("a folder").map(|file| file.expect("a file").file_name());
        let mut names: Vec<_> = files.map(|name| name.to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }

    /// Starts a run, waits until some of its rows are on disk, and kills it.
    fn kill(&self, line: &str, name: &str) {
        // On a busy machine it may end before this has seen that it has begun.
        for _ in 0..50 {
            if self.is_killed(line, &format!("{name}.partial")) {
                return;
            }
            fs::remove_file(self.0.join(name)).expect("it ended");
        }
        panic!("it always ends before it is killed");
    }

    fn is_killed(&self, line: &str, partial: &str) -> bool {
        let mut program = self.command(line).stdout(Stdio::null()).spawn().expect("the program runs");
        let length = || fs::metadata(self.0.join(partial)).map_or(0, |file| file.len());
        let deadline = Instant::now() + Duration::from_secs(300);
        let mut head = 0;
        while head == 0 || length() < head + 2_000 {
            assert!(Instant::now() < deadline, "no rows come");
            if let Some(status) = program.try_wait().expect("a state") {
                assert!(status.success());
                return false;
            }
            std::thread::sleep(Duration::from_millis(1));
            head = if head == 0 { length() } else { head };
        }
        program.kill().expect("a program of its own");
        program.wait().expect("it ends");
        // It may have been quicker.
        length() > 0
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// Lines of CSV as row, column, factor and error.
fn lines(text: &str) -> Vec<(usize, String, f64, f64)> {
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("row,column,factor,error"));
    let line = |line: &str| {
        let fields: Vec<_> = line.split(',').collect();
        assert_eq!(fields.len(), 4, "{line}");
        let number = |k: usize| fields[k].parse().expect("a number");
        (fields[0].parse().expect("a number"), fields[1].to_owned(), number(2), number(3))
    };
    lines.map(line).collect()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

#[test]
fn a_cube_has_its_closed_forms() {
    let folder = Folder::new("cube");
    for tolerance in [1e-4, 1e-7] {
        let lines = lines(&folder.run(&format!("form-factors cube.obj --tolerance {tolerance}")));
        assert_eq!(lines.len(), 30, "nothing on backs, in the background or on itself");
        for (row, column, factor, error) in lines {
            let column: usize = column.parse().expect("a patch");
            let is_opposite = [[0, 1], [2, 4], [3, 5]].iter().any(|pair| pair.contains(&row) && pair.contains(&column));
            let expected = if is_opposite { OPPOSITE } else { ADJACENT };
            assert!((factor - expected).abs() <= tolerance && error <= tolerance, "{row} {column}: {factor} {error}");
        }
    }
}

#[test]
fn meshes_sum_up_to_what_they_are_parts_of() {
    let folder = Folder::new("mesh");
    folder.run("form-factors cube.obj --patch 0.4 -o m.json");
    let file = folder.json("m.json");
    let patches = file["patches"].as_array().expect("patches");
    assert_eq!(patches.len(), 6 * 9);
    let polygon = |patch: &Value| patches[patch.as_u64().expect("a number") as usize]["polygon"].as_u64();
    let area = |patch: &Value| number(&patches[patch.as_u64().expect("a number") as usize]["area"]);
    let mut sums = [0.0; 2];
    for factor in file["factors"].as_array().expect("factors") {
        for (sum, to) in sums.iter_mut().zip([1, 2]) {
            if (polygon(&factor[0]), polygon(&factor[1])) == (Some(0), Some(to)) {
                *sum += area(&factor[0]) * number(&factor[2]);
            }
        }
    }
    // Rows of nine patches with a tolerance of 1e-4 for each of nine factors, weighted by their areas.
    assert!((sums[0] - OPPOSITE).abs() < 9e-4 && (sums[1] - ADJACENT).abs() < 9e-4, "{sums:?}");
    let objects = folder.run("form-factors cube.obj --patch object");
    let objects = lines(&objects);
    assert!(objects.len() == 1 && objects[0].1 == "0" && (objects[0].2 - 1.0).abs() < 1e-12, "{objects:?}");
}

#[test]
fn json_keeps_to_its_schema() {
    let folder = Folder::new("json");
    // Over an open floor, a wall whose back is seen, and a face without area.
    folder.write(
        "open.obj",
        "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nv 0 1 1\nv 2 1 1\no floor\nf 1 2 3 4\no wall\nf 4 3 6 5\nf 1 2 1\n",
    );
    let [told, warned] = folder.output("form-factors open.obj -o m.json", 0);
    assert!(warned.contains("this face has no area, 1 in all"), "{warned}");
    assert!(told.contains("wrote        m.json"), "{told}");
    let file = folder.json("m.json");
    assert_eq!(file["schema"], "nusselt.form-factors/1");
    let patches = file["patches"].as_array().expect("patches");
    let row = |k: usize| (patches[k]["name"].clone(), patches[k]["polygon"].clone());
    assert_eq!([row(0), row(2)], [(json!("floor"), json!(0)), (json!("wall"), json!(2))]);
    assert_eq!([&patches[0]["area"], &patches[2]["area"]], [&json!(4.0), &json!(0.0)]);
    let printed = lines(&folder.output("form-factors open.obj", 0)[0]);
    let mut sums = [0.0; 3];
    let mut found = Vec::new();
    for factor in file["factors"].as_array().expect("factors") {
        let [i, j] = [0, 1].map(|k| factor[k].as_u64().expect("a number") as usize);
        sums[i] += number(&factor[2]);
        found.push((i, j.to_string(), number(&factor[2]), number(&factor[3])));
    }
    assert_eq!(found, printed.iter().filter(|line| line.1.parse::<usize>().is_ok()).cloned().collect::<Vec<_>>());
    for (k, sum) in sums.iter().enumerate() {
        let [backs, background, row_sum, raw] =
            ["backs", "background", "row_sums", "closure_raw"].map(|name| number(&file[name][k]));
        assert!((sum + backs + background - row_sum).abs() < 1e-15);
        let expected = if k == 2 { 0.0 } else { 1.0 };
        assert!((row_sum - expected).abs() < 1e-12 && (raw - expected).abs() < 1e-3, "{k}: {row_sum} {raw}");
    }
    // The wall leans over the floor, and shows it the side that its corners say.
    let both = lines(&folder.output("form-factors open.obj --two-sided", 0)[0]);
    let to_wall = |lines: &[(usize, String, f64, f64)], name: &str| {
        lines.iter().find(|line| line.0 == 0 && line.1 == name).map_or(0.0, |line| line.2)
    };
    let seen = to_wall(&printed, "1") + to_wall(&printed, "backs");
    assert!(seen > 0.1 && (to_wall(&both, "1") - seen).abs() < 2e-4 && to_wall(&both, "backs") == 0.0);
    assert!(to_wall(&printed, "1") == 0.0 || to_wall(&printed, "backs") == 0.0, "one side of it");
}

#[test]
fn closed_cities_close_for_any_number_of_threads() {
    let folder = Folder::new("city");
    folder.run("scene city --polygons 80 --seed 3 -o city.obj");
    let text = folder.output("form-factors city.obj --tolerance 1e-3", 0)[0].clone();
    let lines = lines(&text);
    let mut sums = [0.0; 80];
    for line in &lines {
        sums[line.0] += line.2;
    }
    assert!(sums.iter().all(|sum| (sum - 1.0).abs() < 1e-12), "{sums:?}");
    for threads in [1, 3] {
        let again = folder.output(&format!("form-factors city.obj --tolerance 1e-3 --quiet --threads {threads}"), 0);
        assert!(again == [text.clone(), String::new()], "{threads} threads");
    }
}

#[test]
fn the_summary_tells_closure_reciprocity_estimates_and_times() {
    let folder = Folder::new("summary");
    let summary = folder.summary("form-factors cube.obj --patch 0.5 --certify");
    for (name, expected) in [
        ("schema", json!("nusselt.form-factors/1")),
        ("patch", json!("0.5")),
        ("tolerance", json!(1e-4)),
        ("two_sided", json!(false)),
        ("polygons", json!(6)),
        ("patches", json!(24)),
        ("rows", json!([0, 24])),
        ("rows_computed", json!(24)),
        ("rows_kept", json!(0)),
        ("factors", json!(24 * 20)),
        ("rows_above_tolerance", json!(0)),
    ] {
        assert_eq!(summary[name], expected, "{name}");
    }
    assert!(number(&summary["worst_closure"]) < 1e-12 && number(&summary["worst_residue"]) < 1e-3);
    assert!((0.0..1e-4).contains(&number(&summary["largest_estimate"])));
    assert!(number(&summary["background_mean"]).abs() < 1e-12);
    let reciprocity = &summary["reciprocity"];
    assert_eq!((&reciprocity["pairs"], &reciprocity["every"]), (&json!(24 * 20 / 2), &json!(1)));
    // All is seen wholly, and exchanged once in closed form or nearly so.
    assert!(number(&reciprocity["largest_relative"]) < 1e-7, "{reciprocity}");
    let certificate = &summary["certificate"];
    assert_eq!((&certificate["valid"], &certificate["polygons"]), (&json!(true), &json!([0, 1, 2, 3, 4, 5])));
    assert!(number(&certificate["exact_decisions"]) > 0.0);
    // Of 16 rows, 16 of their 20 factors; by points, so that other numbers are found.
    let pairs = &certificate["pairs"];
    assert_eq!((&pairs["checked"], &pairs["not_checked"]), (&json!(256), &json!(0)));
    assert_eq!(pairs["pairs_above_tolerance"], json!(0));
    assert!((0.0..1e-4).contains(&number(&pairs["largest_relative"])) && number(&pairs["largest_relative"]) > 0.0);
    let timing = &summary["timing"];
    assert_eq!(timing["views"], json!(24), "a row each");
    for key in ["load_s", "bsp_s", "view_ms_mean", "view_ms_max", "rows_s", "certify_ms"] {
        assert!(number(&timing[key]) > 0.0, "{key}");
    }
    let part = folder.summary("form-factors cube.obj --rows 2..4 --two-sided --certify=rational");
    assert_eq!((&part["rows"], &part["rows_computed"], &part["factors"]), (&json!([2, 4]), &json!(2), &json!(10)));
    assert_eq!((&part["reciprocity"], &part["certificate"]["polygons"]), (&Value::Null, &json!([2, 3])));
    assert_eq!(part["certificate"]["pairs"], Value::Null, "with backs nothing is reciprocal");
    let told = folder.run("form-factors cube.obj --certify -o m.csv");
    assert!(told.contains("proof        holds for all directions of 6 views; kernel arithmetic"), "{told}");
    assert!(told.contains("pairs        30 once more from their other patch, within "), "{told}");
    assert!(told.contains("rows         0..6, 6 computed") && told.contains("above 0.0001 in 0 rows"), "{told}");
}

#[test]
fn parts_are_merged_to_what_one_run_writes_in_every_format() {
    let folder = Folder::new("merge");
    folder.run("form-factors cube.obj --rows 3..6 -o b.rows --quiet");
    folder.run("form-factors cube.obj --rows 0..3 -o a.rows --threads 1");
    for ending in ENDINGS {
        folder.run(&format!("form-factors cube.obj -o whole.{ending}"));
        folder.run(&format!("form-factors merge b.rows a.rows -o merged.{ending}"));
        assert!(folder.read(&format!("whole.{ending}")) == folder.read(&format!("merged.{ending}")), "{ending}");
    }
    let told = folder.summary("form-factors merge a.rows b.rows -o merged.csv");
    assert_eq!((&told["parts"], &told["wrote"]), (&json!(2), &json!("merged.csv")));
    // Parts of one part say so on standard output too.
    let rows: Vec<_> = lines(&folder.run("form-factors cube.obj --rows 3..6")).iter().map(|line| line.0).collect();
    assert!(rows.first() == Some(&3) && rows.last() == Some(&5) && rows.len() == 15);

    folder.run("form-factors cube.obj --rows 2..4 -o c.rows");
    folder.run("form-factors cube.obj --rows 3..6 --tolerance 1e-3 -o d.rows");
    for (parts, named) in [
        ("a.rows", "no part has the rows 3..6"),
        ("a.rows c.rows b.rows", "a.rows and c.rows both have the rows 2..3"),
        ("a.rows d.rows", "--tolerance was 0.0001, and is 0.001"),
        ("a.rows none.rows", "cannot read none.rows"),
        ("a.rows cube.obj", "not a file of rows"),
    ] {
        let message = folder.fail(&format!("form-factors merge {parts} -o new.csv"), 1);
        assert!(message.contains(named) && !folder.0.join("new.csv").exists(), "{parts}: {message}");
    }
}

#[test]
fn a_run_that_was_killed_goes_on_to_the_same_bytes() {
    let folder = Folder::new("kill");
    folder.run("scene city --polygons 120 --seed 1 -o city.obj");
    let run = "form-factors city.obj --tolerance 1e-3 --threads 1";
    folder.output(&format!("{run} -o whole.json"), 0);
    for name in ["m.json", "m.rows"] {
        folder.kill(&format!("{run} -o {name}"), name);
        assert!(!folder.0.join(name).exists());
        let refused = folder.fail(&format!("{run} -o {name}"), 1);
        assert!(refused.contains(&format!("{name}.partial is there")) && refused.contains("--resume"), "{refused}");
        // Cut off within a row, as by a crash of the machine.
        let partial = folder.0.join(format!("{name}.partial"));
        let file = fs::OpenOptions::new().write(true).open(&partial).expect("it is there");
        file.set_len(file.metadata().expect("a length").len() - 5).expect("writable");
        let summary = folder.summary(&format!("{run} --threads 2 --resume -o {name}").replacen("--threads 1 ", "", 1));
        let [kept, computed] = ["rows_kept", "rows_computed"].map(|name| summary[name].as_u64().expect("a count"));
        assert!(kept > 0 && computed > 0 && kept + computed == 120, "{kept} {computed}");
        assert_eq!(summary["timing"]["views"], summary["rows_computed"]);
        assert!(number(&summary["reciprocity"]["pairs"]) > 120.0 && number(&summary["worst_closure"]) < 1e-12);
    }
    assert!(folder.read("m.json") == folder.read("whole.json"));
    folder.run("form-factors merge m.rows -o merged.json");
    assert!(folder.read("merged.json") == folder.read("whole.json"));
    assert!(folder.names().iter().all(|name| !name.contains("partial") && !name.contains("manifest")));
}

#[test]
fn patches_are_placed_in_every_format() {
    let folder = Folder::new("patches");
    folder.run("form-factors cube.obj --patch 0.5 -o m.json --patches p.csv");
    let patches = folder.json("m.json")["patches"].as_array().expect("patches").clone();
    let table = String::from_utf8(folder.read("p.csv")).expect("UTF-8");
    let mut lines = table.lines();
    assert_eq!(lines.next(), Some("row,name,polygon,area,center_x,center_y,center_z,normal_x,normal_y,normal_z"));
    assert_eq!(patches.len(), 24);
    for (k, (line, patch)) in lines.zip(&patches).enumerate() {
        let fields: Vec<f64> = line.split(',').map(|field| field.parse().unwrap_or(f64::NAN)).collect();
        let told = |name: &str| [0, 1, 2].map(|axis| number(&patch[name][axis]));
        assert_eq!((fields[0], fields[2]), (k as f64, number(&patch["polygon"])));
        assert!(
            fields[3..4] == [0.25] && fields[4..7] == told("center") && fields[7..] == told("normal"),
            "{line} {patch}"
        );
        let corners = patch["boundary"].as_array().expect("one convex piece");
        let mean = [0, 1, 2].map(|axis| corners.iter().map(|p| number(&p[axis])).sum::<f64>() / 4.0);
        assert_eq!((corners.len(), mean), (4, told("center")));
    }
    // The fronts of a room show to its middle.
    assert_eq!((&patches[0]["normal"], &patches[0]["center"]), (&json!([0.0, 0.0, 1.0]), &json!([0.25, 0.25, 0.0])));
    // The drawing has them in the same order: read as a scene, each polygon is a patch.
    folder.run("form-factors cube.obj --patch 0.5 --rows 0..1 --patches p.obj -o a.rows");
    folder.run("form-factors p.obj -o again.json");
    let again = folder.json("again.json");
    for (k, patch) in again["patches"].as_array().expect("patches").iter().enumerate() {
        assert_eq!(patch["name"], json!(format!("patch_{k}")));
        assert_eq!((&patch["boundary"], &patch["area"]), (&patches[k]["boundary"], &patches[k]["area"]));
    }
    folder.run("form-factors cube.obj --patch 0.5 --rows 1..24 -o b.rows");
    folder.run("form-factors merge a.rows b.rows -o m.npy --patches merged.csv");
    assert_eq!(String::from_utf8(folder.read("merged.csv")).expect("UTF-8"), table);
}

#[test]
fn areas_beyond_numbers_leave_nothing_behind() {
    let folder = Folder::new("area");
    let (vertices, faces) = CUBE.split_once('f').expect("faces after vertices");
    folder.write("huge.obj", &format!("{}f{faces}", vertices.replace('1', "1e200")));
    let before = folder.names();
    let message = folder.fail("form-factors huge.obj -o m.csv", 1);
    assert!(message.contains("huge.obj: the area of patch 0 (polygon 0) is inf"), "{message}");
    assert_eq!(folder.names(), before);
}

#[test]
fn what_a_killed_run_left_unnamed_is_removed() {
    let folder = Folder::new("left");
    let left = [".m.npy.1-2.tmp", ".m.npy.partial.999999999-0.tmp", ".m.npy.manifest.json.77-1.tmp", ".p.csv.7-0.tmp"];
    for name in left.iter().chain(&[".n.npy.1-2.tmp", ".m.npy.tmp"]) {
        folder.write(name, "left");
    }
    folder.run("form-factors cube.obj -o m.npy --resume --patches p.csv");
    assert_eq!(folder.names(), [".m.npy.tmp", ".n.npy.1-2.tmp", "cube.obj", "m.npy", "p.csv"]);
}

#[test]
fn another_run_is_not_resumed() {
    let folder = Folder::new("changed");
    folder.run("scene city --polygons 120 --seed 1 -o city.obj");
    folder.run("scene city --polygons 120 --seed 2 -o other.obj");
    folder.kill("form-factors city.obj --tolerance 1e-3 --threads 1 -o m.csv", "m.csv");
    let left = folder.read("m.csv.partial");
    for (line, named) in [
        ("other.obj --tolerance 1e-3", "the scene is another one"),
        ("city.obj", "--tolerance was 0.001, and is 0.0001"),
        ("city.obj --tolerance 1e-3 --patch object", "--patch was polygon, and is object"),
        ("city.obj --tolerance 1e-3 --patch 1e3", "--patch was polygon, and is 1000"),
        ("city.obj --tolerance 1e-3 --two-sided", "--two-sided was false, and is true"),
    ] {
        let message = folder.fail(&format!("form-factors {line} --resume -o m.csv"), 1);
        assert!(message.contains("m.csv.partial is of another run") && message.contains(named), "{line}: {message}");
        assert!(folder.read("m.csv.partial") == left, "{line}");
    }
}

#[test]
fn wrong_command_lines_are_refused_in_one_line() {
    let folder = Folder::new("usage");
    for (line, named) in [
        ("", "<SCENE>"),
        ("cube.obj -o x.txt", ".json, .csv, .npy, .mtx, .parquet, .rows"),
        ("cube.obj -o x", ".json, .csv, .npy, .mtx, .parquet, .rows"),
        ("cube.obj -o x.csv -o y.csv", "--output"),
        ("cube.obj -o cube.obj", "ending"),
        ("cube.obj --resume", "--output"),
        ("cube.obj --rows 0..7 -o x.rows", "there are no rows 0..7: the matrix has 6"),
        ("cube.obj --rows 7..9", "there are no rows 7..9"),
        ("cube.obj --rows 3..3", "A..B"),
        ("cube.obj --rows 4..3", "A..B"),
        ("cube.obj --rows -1..3", "A..B"),
        ("cube.obj --rows 0..3 -o x.csv", "some of the rows are written as .rows"),
        ("cube.obj --patch 0", "above 0"),
        ("cube.obj --patch nan", "above 0"),
        ("cube.obj --patch inf", "above 0"),
        ("cube.obj --patch -2", "above 0"),
        ("cube.obj --patch faces", "above 0"),
        ("cube.obj --patch 1e-3", "take a longer edge"),
        ("cube.obj --patch 1e-300", "take a longer edge"),
        ("cube.obj --tolerance 0", "above 0"),
        ("cube.obj --tolerance -1e-4", "above 0"),
        ("cube.obj --tolerance nan", "above 0"),
        ("cube.obj --certify=soon", "kernel and rational"),
        ("cube.obj --patches x.npy", ".csv or .obj"),
        ("cube.obj --patches cube.obj", "would overwrite"),
        ("cube.obj -o x.csv --patches x.csv", "the same file"),
        ("cube.obj -o x.csv --patches ./x.csv", "the same file"),
        ("merge cube.rows -o x.csv --patches x.csv", "the same file"),
        ("merge", "<PART>"),
        ("merge a.rows", "--output"),
        ("merge a.rows -o x.txt", ".rows"),
        ("merge cube.rows -o cube.rows", "is a part that is read"),
        ("cube.obj merge a.rows -o x.csv", "merge"),
    ] {
        folder.write("cube.rows", "");
        let message = folder.fail(&format!("form-factors {line}"), 2);
        assert!(message.contains(named), "{line}: {message}");
    }
    folder.write("m.csv.manifest.json", CUBE);
    let message = folder.fail("form-factors m.csv.manifest.json -o m.csv", 2);
    assert!(message.contains("would overwrite"), "{message}");
    assert_eq!(folder.names(), ["cube.obj", "cube.rows", "m.csv.manifest.json"]);
    assert!(folder.fail("form-factors none.obj", 1).contains("none.obj"));
    assert!(folder.fail("form-factors cube.obj -o none/m.csv", 1).contains("make its directory first"));
}

#[test]
#[cfg(not(feature = "parquet"))]
fn without_the_feature_parquet_is_a_usage_error_that_names_it() {
    let folder = Folder::new("no-parquet");
    let message = folder.fail("form-factors cube.obj -o x.parquet", 2);
    assert!(message.contains("feature parquet") && !folder.0.join("x.parquet").exists(), "{message}");
}

#[test]
fn scenes_without_polygons_have_an_empty_matrix() {
    let folder = Folder::new("empty");
    folder.write("empty.obj", "v 0 0 0\n");
    let [out, err] = folder.output("form-factors empty.obj --certify -o m.json", 0);
    assert!(out.contains("rows         0..0, 0 computed") && err.contains("there are no faces"), "{out}{err}");
    assert_eq!(folder.json("m.json")["factors"], json!([]));
}

#[test]
fn reciprocity_is_enforced_if_asked_for_and_told() {
    let folder = Folder::new("enforced");
    folder.run("scene city --polygons 120 --seed 1 -o city.obj");
    let summary = folder.run("form-factors city.obj --tolerance 1e-3 --enforce-reciprocity -o m.json --json");
    let summary: Value = serde_json::from_str(&summary).expect("JSON");
    let change = summary["enforced"]["largest_change"].as_f64().expect("a number");
    assert!(change > 0.0 && change < 4e-3, "{summary}");
    let file = folder.json("m.json");
    let area = |k: &Value| file["patches"][k.as_u64().expect("a patch") as usize]["area"].as_f64().expect("an area");
    let factors = file["factors"].as_array().expect("a list");
    for entry in factors {
        let (i, j) = (&entry[0], &entry[1]);
        let back = factors.iter().find(|other| other[0] == *j && other[1] == *i).expect("both are there");
        let [there, back] = [entry, back].map(|entry| entry[2].as_f64().expect("a number"));
        assert!((area(i) * there - area(j) * back).abs() <= 1e-14 * area(i).max(area(j)), "{entry}");
    }
    let sums = file["row_sums"].as_array().expect("a list");
    assert!(sums.iter().all(|sum| (sum.as_f64().expect("a number") - 1.0).abs() <= 1e-12), "{sums:?}");
    let words = folder.run("form-factors city.obj --tolerance 1e-3 --enforce-reciprocity -o m.csv");
    assert!(words.contains("enforced     factors changed by at most"), "{words}");
    // It takes all rows, and a file.
    assert!(folder.fail("form-factors cube.obj --enforce-reciprocity", 2).contains("--output"));
    for line in ["--rows 0..3 -o a.rows", "--two-sided -o a.csv", "-o a.csv --resume"] {
        let [out, err] = folder.output(&format!("form-factors cube.obj --enforce-reciprocity {line}"), 2);
        assert!(out.is_empty() && err.contains("--enforce-reciprocity"), "{line}: {err}");
    }
}
