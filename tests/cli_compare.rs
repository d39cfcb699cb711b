//! `nusselt compare` as a user meets it.
#![cfg(feature = "cli")]

use serde_json::{Value, json};
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// A folder of its own for each test, with the Cornell box in it.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("compare-{name}-{}", std::process::id()));
        // Left over from a run that was stopped.
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).expect("a folder for tests");
        let folder = Self(path);
        folder.run("scene cornell -o box.obj", "", 0);
        folder
    }

    /// What the program prints: on stdout if it succeeds, otherwise on stderr, and nothing on stdout.
    fn run(&self, line: &str, input: &str, code: i32) -> String {
        let program = Command::new(env!("CARGO_BIN_EXE_nusselt"))
            .args(line.split_whitespace())
            .current_dir(&self.0)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn();
        let mut program = program.expect("the program runs");
        // The program may end before it has read everything.
        let _ = program.stdin.take().expect("a pipe").write_all(input.as_bytes());
        let output = program.wait_with_output().expect("the program ends");
        let [out, err] = [output.stdout, output.stderr].map(|bytes| String::from_utf8(bytes).expect("UTF-8"));
        assert_eq!(output.status.code(), Some(code), "{line}\n{out}\n{err}");
        if code == 0 {
            return out;
        }
        assert_eq!(out, "", "{line}");
        assert_eq!(err.matches("nusselt: ").count(), 1, "{line}: {err}");
        err
    }

    fn compare(&self, rest: &str, input: &str) -> Value {
        serde_json::from_str(&self.run(&format!("compare box.obj {rest} --json"), input, 0)).expect("JSON")
    }

    fn write(&self, name: &str, text: &str) {
        fs::write(self.0.join(name), text).expect("writable");
    }

    fn files(&self) -> usize {
        fs::read_dir(&self.0).expect("a folder").count()
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

const QUICK: &str = "--resolutions 16,32 --rays 100 --rounds 1";

fn rows(summary: &Value) -> &[Value] {
    summary["methods"].as_array().expect("rows")
}

/// All that does not depend on how long things took.
fn untimed(summary: &Value) -> Vec<Value> {
    let keys = ["method", "resolution", "max_error", "p99_error", "median_error", "lost", "visible", "evaluations"];
    rows(summary).iter().map(|row| keys.iter().map(|key| row[key].clone()).collect()).collect()
}

#[test]
fn json_has_a_row_for_each_method_with_time_errors_losses_and_evaluations() {
    let folder = Folder::new("json");
    let summary = folder.compare("--eye 278,273,1 --normal 0,0,1", "");
    assert_eq!(summary["schema"], "nusselt.compare/1");
    assert_eq!((&summary["polygons"], &summary["views"], &summary["rounds"]), (&json!(16), &json!(1), &json!(3)));
    let named: Vec<_> = rows(&summary).iter().map(|row| (row["method"].clone(), row["resolution"].clone())).collect();
    let mut expected = vec![(json!("contour"), Value::Null), (json!("contour-boxes"), Value::Null)];
    for n in [64, 128, 256, 512, 1024] {
        expected.extend(["hemicube", "analytic"].map(|name| (json!(name), json!(n))));
    }
    expected.extend([10_000, 100_000].map(|n| (json!("rays"), json!(n))));
    assert_eq!(named, expected);
    let number = |row: &Value, key: &str| row[key].as_f64().unwrap_or_else(|| panic!("{key} of {row}"));
    for row in rows(&summary) {
        for key in ["load_s", "bsp_s", "setup_s", "view_ms_mean", "view_ms_median", "view_ms_max"] {
            assert!(number(row, key) >= 0.0, "{key}");
        }
        assert_eq!(number(row, "views").to_bits(), 1.0f64.to_bits());
        assert!(number(row, "view_ms_mean") > 0.0);
        assert_eq!(row["threads"], json!(1), "views are taken by one thread, however many there are");
        assert!(number(row, "median_error") <= number(row, "p99_error"));
        assert!(number(row, "p99_error") <= number(row, "max_error"));
        assert!(number(row, "lost") < number(row, "visible"));
        let errors = row["errors"].as_array().expect("two").iter();
        let above: Vec<_> = errors.map(|errors| number(errors, "above").to_string()).collect();
        assert_eq!(above, ["0.001", "0.0001"]);
        assert_eq!(row["max_error"], row["errors"][1]["max_error"], "of those above 1e-4");
        match (row["method"].as_str(), row["resolution"].as_u64()) {
            (Some("contour"), _) => assert_eq!(row["max_error"], json!(0.0)),
            (Some("contour-boxes"), _) => assert!(number(row, "max_error") < 1e-12),
            (Some("hemicube"), Some(n)) => {
                assert_eq!(row["evaluations"], json!(3 * n * n));
                assert!(number(row, "max_error") > 1e-4);
            }
            (Some("analytic"), Some(n)) => assert!(number(row, "evaluations") < 3.0 * (n * n) as f64),
            _ => assert_eq!(row["evaluations"], json!(0)),
        }
    }
    assert!(number(&summary["timing"], "bsp_s") > 0.0 && summary["timing"]["views"] == json!(1));
}

#[test]
fn points_come_from_a_file_or_from_standard_input() {
    let folder = Folder::new("points");
    let text = "x,y,z,nx,ny,nz,polygon\n278,273,1,0,0,1,\n100,300,1,0,0.2,4,\n278 273 200 0 -3 0 0\n";
    folder.write("p.csv", text);
    let from_file = folder.compare(&format!("--points p.csv {QUICK}"), "");
    let from_input = folder.compare(&format!("--points - {QUICK} --threads 1"), text);
    assert_eq!(untimed(&from_file), untimed(&from_input));
    assert_eq!(from_file["views"], json!(3));
    assert_eq!(from_file["on"], json!([null, null, 0]), "on the polygon that is named, as near as one gets");
    assert!(rows(&from_file).iter().all(|row| row["views"] == json!(3)));

    let alone = folder.compare(&format!("--eye 278,273,1 --normal 0,0,1 {QUICK}"), "");
    let line = folder.compare(&format!("--points - {QUICK}"), "278 273 1 0 0 1");
    assert_eq!(untimed(&alone), untimed(&line));
}

#[test]
fn a_point_on_a_polygon_is_above_it_unless_it_is_to_be_free() {
    let folder = Folder::new("on");
    let floor = format!("--eye 100,0,100 --normal 0,1,0 {QUICK}");
    assert_eq!(folder.compare(&floor, "")["on"], json!([0]));
    assert_eq!(folder.compare(&format!("{floor} --free"), "")["on"], json!([null]));
    // A normal says on which side of the polygon that is named: below the floor everything is background.
    let below = folder.compare(&format!("--points - {QUICK}"), "100 50 100 0 -1 0 0");
    let visible = |summary: &Value| rows(summary)[0]["visible"].as_u64().expect("a count");
    assert_eq!(visible(&below), 0);
    // A slanting normal only tells the side: the horizon is that of the floor.
    let above = folder.compare(&format!("--points - {QUICK}"), "100 50 100 0.5 1 0 0");
    assert_eq!(untimed(&above), untimed(&folder.compare(&floor, "")));
    assert!(visible(&above) > 3);
}

#[test]
fn in_words_it_is_a_table() {
    let folder = Folder::new("words");
    let text = folder.run(&format!("compare box.obj --eye 278,273,1 --normal 0,0,1 {QUICK}"), "", 0);
    let expected = ["contour", "contour-boxes", "hemicube 16", "analytic 16", "hemicube 32", "analytic 32", "rays 100"];
    let at = text.find("method ").expect("a header");
    for (line, name) in text[at..].lines().skip(1).zip(expected) {
        assert!(line.starts_with(&format!("{name} ")), "{line}");
    }
    assert_eq!(text[at..].lines().count(), 1 + expected.len());
    let setup = |line: &str| line.split_whitespace().rev().nth(9).and_then(|word| word.parse::<f64>().ok());
    assert!(text[at..].lines().next().is_some_and(|header| header.contains("setup")));
    assert!(text[at..].lines().skip(1).all(|line| setup(line).is_some_and(|ms| ms >= 0.0)), "{text}");
    let bare = "compare box.obj --eye 278,273,1 --normal 0,0,1 --resolutions none --rays none";
    assert!(!folder.run(bare, "", 0).contains("hemicube"));
    assert_eq!(folder.run(&format!("{bare} --quiet"), "", 0), "");
}

#[test]
fn points_that_cannot_be_used_are_named_by_line() {
    let folder = Folder::new("bad");
    let files = folder.files();
    for (text, named) in [
        ("", "standard input: it has no points"),
        ("# nothing\n\n", "standard input: it has no points"),
        ("x,y,z,nx,ny,nz\n", "standard input: it has no points"),
        ("1,2,3\n", "standard input:1: x y z nx ny nz [polygon] are 6 or 7 fields, not 3"),
        ("1;2;3;0;0;1\n1 2 3 0 0 1 2 3\n", "standard input:2: x y z nx ny nz [polygon] are 6 or 7 fields, not 8"),
        ("1 2 3 0 0 1\n1,2,,0,0,1\n", "standard input:2: z is empty"),
        ("1 2 nan 0 0 1\n", "standard input:1: z: `nan` is not a finite number"),
        ("1 2 1e999 0 0 1\n", "standard input:1: z: the number `1e999` is too large"),
        ("1 2 3 0 0 up\n", "standard input:1: nz: `up` is not a number"),
        ("1 2 3 0 -0 0\n", "standard input:1: the normal 0 0 0 has no direction"),
        ("1 2 3 0 0 1 1.5\n", "standard input:1: `1.5` is not the number of a polygon"),
        ("1 2 3 0 0 1\n\n1 2 3 0 0 1 16\n", "standard input:3: there is no polygon 16: the scene has 16"),
    ] {
        let message = folder.run(&format!("compare box.obj --points - {QUICK}"), text, 1);
        assert!(message.contains(named), "{text:?}: {message}");
    }
    assert!(folder.run("compare box.obj --points none.csv", "", 1).contains("cannot read none.csv"));
    assert!(folder.run("compare none.obj --points -", "1 2 3 0 0 1", 1).contains("none.obj"));
    assert!(folder.run("compare box.obj --points .", "", 1).contains("not a regular file"));
    folder.write("garbage.csv", &"\u{1F600} ,\\".repeat(10_000));
    let message = folder.run("compare box.obj --points garbage.csv", "", 1);
    assert!(message.len() < 2000, "{message}");
    assert_eq!(folder.files(), files + 1);
}

#[test]
fn far_eyes_are_compared_by_all_methods() {
    let folder = Folder::new("far");
    // One point that is far away does not keep the others from being compared.
    let summary =
        folder.compare(&format!("--points - {QUICK}"), "278 273 1 0 0 1\n278 273 -9000 0 0 1\n1e308 2 3 -1 0 0\n");
    assert_eq!((rows(&summary).len(), &summary["views"]), (7, &json!(3)));
    let summary = folder.compare("--eye 278,273,-9000 --normal 0,0,1 --resolutions 1024 --rays 3000000 --rounds 1", "");
    for row in rows(&summary) {
        let (median, factors) = (row["median_error"].as_f64(), row["errors"][1]["factors"].as_u64());
        assert!(median.is_some_and(|error| error < 0.1) && factors > Some(1), "{row}");
    }
}

#[test]
fn where_no_form_factor_is_large_enough_there_is_no_error_to_tell() {
    let folder = Folder::new("none");
    let far = "--eye 278,273,-90000 --normal 0,0,1 --resolutions 16 --rays 10 --rounds 1";
    let summary = folder.compare(far, "");
    for row in rows(&summary) {
        for errors in [row, &row["errors"][0], &row["errors"][1]] {
            assert!(["max_error", "p99_error", "median_error"].iter().all(|key| errors[*key].is_null()), "{row}");
        }
        let is_contour = row["method"].as_str().is_some_and(|name| name.starts_with("contour"));
        assert_eq!(row["lost"].as_u64().expect("a count") > 0, !is_contour, "{row}");
    }
    let text = folder.run(&format!("compare box.obj {far}"), "", 0);
    let table = &text[text.find("method ").expect("a header")..];
    for line in table.lines().skip(1) {
        assert_eq!(line.split_whitespace().filter(|word| *word == "-").count(), 4, "{line}");
    }
}

#[test]
fn with_an_epsilon_the_reference_is_by_boxes_and_is_named() {
    let folder = Folder::new("epsilon");
    // Two squares that cross each other, by less than the epsilon.
    let square = |z: [f64; 2]| format!("v -1 -1 {}\nv 1 -1 {}\nv 1 1 {}\nv -1 1 {}\n", z[0], z[1], z[1], z[0]);
    folder.write("crossed.obj", &format!("{}{}f 1 2 3 4\nf 5 6 7 8\n", square([1.0, 1.2]), square([1.2, 1.0])));
    let line = "compare crossed.obj --eye 0,0,0 --normal 0,0,1 --resolutions none --rays none --rounds 1";
    for (rest, name, worst) in [("", "contour", 0), (" --epsilon 0.5", "contour-boxes", 1)] {
        let summary: Value = serde_json::from_str(&folder.run(&format!("{line}{rest} --json"), "", 0)).expect("JSON");
        assert_eq!(summary["reference"], json!(name));
        let errors: Vec<_> = rows(&summary).iter().map(|row| row["max_error"].as_f64().expect("an error")).collect();
        assert!((errors[0] > 0.1) == (worst > 0) && errors[1] < 1e-12, "{rest}: {errors:?}");
        let words = folder.run(&format!("{line}{rest}"), "", 0);
        assert!(words.contains(&format!("reference    {name}")), "{words}");
        assert_eq!(words.contains("not exact with an epsilon of 0.5"), worst > 0, "{words}");
    }
}

#[test]
fn wrong_command_lines_are_refused_in_one_line() {
    let folder = Folder::new("usage");
    for (line, named) in [
        ("", "--points"),
        ("--eye 1,2,3", "--normal"),
        ("--normal 0,0,1", "--eye"),
        ("--points - --eye 1,2,3 --normal 0,0,1", "--points"),
        ("--points - --normal 0,0,1", "--normal"),
        ("--eye 1,2,3 --normal 0,0,0", "zero"),
        ("--eye 1,2,inf --normal 0,0,1", "finite"),
        ("--points - --rounds 0", "1 to 1000"),
        ("--points - --rounds 1001", "1 to 1000"),
        ("--points - --resolutions 63", "even"),
        ("--points - --resolutions 0", "even"),
        ("--points - --resolutions 64,,128", "even"),
        ("--points - --resolutions 64,4098", "4096"),
        ("--points - --resolutions=-2", "even"),
        ("--points - --rays 0", "1 to 1000000000"),
        ("--points - --rays ten", "1 to 1000000000"),
        ("--points - --epsilon -1", "epsilon"),
    ] {
        let message = folder.run(&format!("compare box.obj {line}"), "1 2 3 0 0 1", 2);
        assert!(message.lines().count() == 1 && message.contains(named), "{line}: {message}");
    }
}
