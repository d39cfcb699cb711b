//! `nusselt point-factors` as a user meets it.
#![cfg(feature = "cli")]

use serde_json::{Value, json};
use std::fmt::Write as _;
use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

/// A folder of its own for each test, with the Cornell box in it.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("point-factors-{name}-{}", std::process::id()));
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
        let mut stdin = program.stdin.take().expect("a pipe");
        let input = input.to_owned();
        // It prints before it has read everything, and may end before that.
        let writer = std::thread::spawn(move || drop(stdin.write_all(input.as_bytes())));
        let output = program.wait_with_output().expect("the program ends");
        writer.join().expect("it only writes");
        let [out, err] = [output.stdout, output.stderr].map(|bytes| String::from_utf8(bytes).expect("UTF-8"));
        assert_eq!(output.status.code(), Some(code), "{line}\n{out}\n{err}");
        if code == 0 {
            return out;
        }
        assert_eq!(out, "", "{line}");
        assert_eq!(err.matches("nusselt: ").count(), 1, "{line}: {err}");
        err
    }

    fn points(&self, rest: &str, input: &str) -> String {
        self.run(&format!("point-factors box.obj {rest}"), input, 0)
    }

    fn json(&self, name: &str) -> Value {
        serde_json::from_str(&self.read(name)).expect("JSON")
    }

    fn read(&self, name: &str) -> String {
        fs::read_to_string(self.0.join(name)).expect("a file")
    }

    fn write(&self, name: &str, text: &str) {
        fs::write(self.0.join(name), text).expect("writable");
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// Two in the air, one on the floor because it lies there, one on a polygon that is named.
const POINTS: &str =
    "x,y,z,nx,ny,nz,polygon\n278,273,1,0,0,1,\n100,300,1,0,0.2,4,\n100,0,100,0,1,0,\n278 273 200 0 -3 0 0\n";

/// Lines of CSV as point, name and factor.
fn lines(text: &str) -> Vec<(usize, String, f64)> {
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("point,name,factor"));
    let line = |line: &str| {
        let fields: Vec<_> = line.split(',').collect();
        assert_eq!(fields.len(), 3, "{line}");
        (fields[0].parse().expect("a number"), fields[1].to_owned(), fields[2].parse().expect("a number"))
    };
    lines.map(line).collect()
}

#[test]
fn without_a_file_csv_is_printed_and_every_point_sums_to_one() {
    let folder = Folder::new("csv");
    folder.write("p.csv", POINTS);
    let text = folder.points("--points p.csv", "");
    assert_eq!(text, folder.points("--points - --threads 1", POINTS), "from standard input, in one thread");
    assert_eq!(text, folder.points("--points p.csv --threads 3 --quiet", ""));
    folder.points("--points p.csv -o f.csv --quiet", "");
    assert_eq!(text, folder.read("f.csv"));
    let lines = lines(&text);
    for point in 0..4 {
        let own: Vec<_> = lines.iter().filter(|line| line.0 == point).collect();
        let sum: f64 = own.iter().map(|line| line.2).sum();
        assert!((sum - 1.0).abs() < 1e-12, "{point}: {sum}");
        assert!(own.iter().all(|line| line.2 > 0.0));
    }
    assert!(lines.is_sorted_by_key(|line| line.0) && lines.iter().any(|line| line.1 == "background"));
}

#[test]
fn both_ways_and_contour_tell_the_same_factors() {
    let folder = Folder::new("contour");
    let boxes = folder.points("--points - --by polygon", POINTS);
    let by_bsp = folder.points("--points - --by polygon --way bsp", POINTS);
    let (boxes, by_bsp) = (lines(&boxes), lines(&by_bsp));
    assert_eq!(boxes.len(), by_bsp.len());
    for (a, b) in boxes.iter().zip(&by_bsp) {
        assert!((a.0, &a.1) == (b.0, &b.1) && (a.2 - b.2).abs() < 1e-12, "{a:?} {b:?}");
    }
    let image = folder.run("contour box.obj --eye 278,273,1 --normal 0,0,1 --json", "", 0);
    let image: Value = serde_json::from_str(&image).expect("JSON");
    for row in image["polygons"].as_array().expect("rows") {
        let number = row["polygon"].to_string();
        let own = boxes.iter().find(|line| line.0 == 0 && line.1 == number).expect("the polygon").2;
        assert!((own - row["form_factor"].as_f64().expect("a factor")).abs() < 1e-12, "{number}");
    }
}

#[test]
fn json_keeps_to_its_schema() {
    let folder = Folder::new("json");
    for (flags, by, on) in [
        ("", "object", json!([null, null, 0, 0])),
        ("--by polygon", "polygon", json!([null, null, 0, 0])),
        ("--by object --free", "object", json!([null, null, null, 0])),
    ] {
        let told = folder.points(&format!("--points - {flags} -o x.json"), POINTS);
        assert!(told.contains("wrote        x.json") && told.contains("points       4, "), "{told}");
        let file = folder.json("x.json");
        assert_eq!((&file["schema"], &file["by"]), (&json!("nusselt.point-factors/1"), &json!(by)));
        let names = file["names"].as_array().expect("names");
        let points = file["points"].as_array().expect("points");
        assert_eq!(points.iter().map(|point| point["on"].clone()).collect::<Value>(), on, "{flags}");
        let printed = lines(&folder.points(&format!("--points - {flags}"), POINTS));
        for (k, point) in points.iter().enumerate() {
            let mut factors: Vec<(usize, String, f64)> = Vec::new();
            for factor in point["factors"].as_array().expect("factors") {
                let index = factor[0].as_u64().expect("an index") as usize;
                let name = names[index].as_str().expect("a name");
                let name = if by == "object" { name.to_owned() } else { index.to_string() };
                factors.push((k, name, factor[1].as_f64().expect("a factor")));
            }
            let background = point["background"].as_f64().expect("a factor");
            factors.extend((background > 0.0).then(|| (k, "background".to_owned(), background)));
            assert_eq!(factors, printed.iter().filter(|line| line.0 == k).cloned().collect::<Vec<_>>());
        }
        assert_eq!(points[3]["normal"], json!([0.0, -3.0, 0.0]), "as it was given");
        assert_eq!(points[3]["point"], json!([278.0, 273.0, 200.0]));
    }
}

#[test]
fn the_summary_has_timing_and_closure() {
    let folder = Folder::new("summary");
    for line in ["--points - --json", "--points - --json -o x.csv"] {
        let summary: Value = serde_json::from_str(&folder.points(line, POINTS)).expect("JSON and nothing else");
        assert_eq!((&summary["points"], &summary["on"]), (&json!(4), &json!(2)), "{line}");
        assert!(summary["worst_closure"].as_f64().is_some_and(|x| x < 1e-12));
        let timing = &summary["timing"];
        assert_eq!(timing["views"], json!(4));
        for key in ["load_s", "bsp_s", "view_ms_mean", "view_ms_max"] {
            assert!(timing[key].as_f64().is_some_and(|x| x > 0.0), "{key}");
        }
    }
    assert_eq!(lines(&folder.read("x.csv")).iter().map(|line| line.0).max(), Some(3));
}

#[test]
fn many_points_are_read_and_written_as_they_come_in_their_order() {
    let folder = Folder::new("many");
    // More than are shared by the threads at a time, and more than a block of text.
    let count = 3_000;
    let mut text = String::new();
    for k in 0..count {
        let note = " ".repeat(500);
        writeln!(text, "{} 273 300 0 {} 1 # {note}", 10 + k % 500, k / 500).expect("memory");
    }
    let all = lines(&folder.points("--points -", &text));
    let of = |k: usize| all.iter().filter(|line| line.0 == k).map(|line| (line.1.clone(), line.2)).collect::<Vec<_>>();
    let [one, last] = [&text.lines().nth(1234).expect("a line"), &text.lines().last().expect("a line")];
    for (k, line) in [(1234, one), (count - 1, last)] {
        let alone = lines(&folder.points("--points -", line));
        assert_eq!(of(k), alone.iter().map(|line| (line.1.clone(), line.2)).collect::<Vec<_>>());
    }
    assert!(all.is_sorted_by_key(|line| line.0) && all.last().is_some_and(|line| line.0 == count - 1));
}

#[test]
fn bad_points_are_named_by_line_and_leave_no_file() {
    let folder = Folder::new("bad");
    folder.write("old.csv", "old");
    for (text, named) in [
        ("", "it has no points"),
        ("1,2,3\n", "p.csv:1: x y z nx ny nz [polygon] are 6 or 7 fields, not 3"),
        ("1 2 3 0 0 1\n1 2 3 0 -0 0\n", "p.csv:2: the normal 0 0 0 has no direction"),
        ("1 2 3 0 0 1\n\n1 2 3 0 0 1 16\n", "p.csv:3: there is no polygon 16: the scene has 16"),
    ] {
        folder.write("p.csv", text);
        let message = folder.run("point-factors box.obj --points p.csv -o old.csv", "", 1);
        assert!(message.contains(named), "{message}");
        assert_eq!(folder.read("old.csv"), "old");
        // Of a file, all is checked before anything is printed.
        assert!(folder.run("point-factors box.obj --points p.csv", "", 1).contains(named));
    }
    let message = folder.run("point-factors box.obj --points - -o old.csv", "1 2 3 0 0 1\n1 2 3 0 0 1 77\n", 1);
    assert!(message.contains("standard input:2: there is no polygon 77"), "{message}");
    let long = format!("1 2 3 0 0 1\n{}\n1 2 x 0 0 1", "7".repeat(3 << 20));
    folder.write("p.csv", &long);
    let message = folder.run("point-factors box.obj --points p.csv -o old.csv", "", 1);
    assert!(message.contains("p.csv:2: the line is longer") && message.contains("p.csv:3: z: `x`"), "{message}");
    // What follows may not have come.
    let message = folder.run("point-factors box.obj --points - -o old.csv", &long, 1);
    assert!(message.contains("standard input:2: the line is longer"), "{message}");
    let in_plane = "100 50 100 0 1 0 0\n100 50 100 1 0 0 0\n";
    folder.write("p.csv", in_plane);
    for (points, name) in [("p.csv", "p.csv"), ("-", "standard input")] {
        let message = folder.run(&format!("point-factors box.obj --points {points} -o old.csv"), in_plane, 1);
        assert!(
            message.contains(&format!("{name}:2: the normal [1, 0, 0] lies in the plane of polygon 0")),
            "{message}"
        );
    }
    assert!(folder.run("point-factors box.obj --points . ", "", 1).contains("not a regular file"));
    assert_eq!(folder.read("old.csv"), "old");
    let files: Vec<_> = fs::read_dir(&folder.0).expect("a folder").map(|f| f.expect("a file").file_name()).collect();
    assert!(files.iter().all(|name| !name.to_string_lossy().contains(".tmp")), "{files:?}");
}

/// Starts a run that is asked and answers.
fn ask(folder: &Folder) -> (Child, ChildStdin, BufReader<ChildStdout>) {
    let program = Command::new(env!("CARGO_BIN_EXE_nusselt"))
        .args("point-factors box.obj --points -".split(' '))
        .current_dir(&folder.0)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn();
    let mut program = program.expect("the program runs");
    let (stdin, stdout) = (program.stdin.take().expect("a pipe"), program.stdout.take().expect("a pipe"));
    (program, stdin, BufReader::new(stdout))
}

#[test]
fn points_are_answered_before_the_next_are_asked() {
    let folder = Folder::new("ask");
    let (mut program, mut stdin, mut answers) = ask(&folder);
    let mut line = String::new();
    // Before anything is asked.
    answers.read_line(&mut line).expect("a header");
    assert_eq!(line, "point,name,factor\n");
    for k in 0..4 {
        // In two pieces, and none after it: this would wait for ever if more were asked for.
        stdin.write_all(b"278 273 1").expect("it reads");
        stdin.write_all(b" 0 0 1\n").expect("it reads");
        let mut sum = 0.0;
        // Until the point has all that it sees.
        while sum < 1.0 - 1e-9 {
            line.clear();
            answers.read_line(&mut line).expect("an answer");
            let fields: Vec<_> = line.trim_end().split(',').collect();
            assert_eq!(fields[0], k.to_string(), "{line}");
            sum += fields[2].parse::<f64>().expect("a number");
        }
    }
    drop(stdin);
    line.clear();
    assert_eq!(answers.read_line(&mut line).expect("the end"), 0, "{line}");
    assert!(program.wait().expect("it ends").success());
}

#[test]
fn points_before_a_bad_line_are_answered_and_the_line_is_told_at_once() {
    let folder = Folder::new("bad-line");
    for bad in ["1 2 x 0 0 1\n", "1 2 3 0 0 1 77\n"] {
        let (mut program, mut stdin, mut answers) = ask(&folder);
        stdin.write_all(format!("278 273 1 0 0 1\n{bad}").as_bytes()).expect("it reads");
        // It ends though its input does not.
        let mut text = String::new();
        answers.read_to_string(&mut text).expect("UTF-8");
        let told = lines(&text);
        let sum: f64 = told.iter().map(|line| line.2).sum();
        assert!(told.iter().all(|line| line.0 == 0) && (sum - 1.0).abs() < 1e-12, "{text}");
        assert_eq!(program.wait().expect("it ends").code(), Some(1));
        let mut message = String::new();
        program.stderr.take().expect("a pipe").read_to_string(&mut message).expect("UTF-8");
        assert!(message.starts_with("nusselt: standard input:2: ") && message.lines().count() == 1, "{message}");
        drop(stdin);
    }
}

#[test]
fn wrong_command_lines_are_refused_in_one_line() {
    let folder = Folder::new("usage");
    folder.write("p.csv", POINTS);
    for (line, named) in [
        ("", "--points"),
        ("--points p.csv -o x.txt", ".csv, .json, .parquet"),
        ("--points p.csv -o x", ".csv, .json, .parquet"),
        ("--points p.csv -o p.csv", "would overwrite"),
        ("--points p.csv -o x.csv -o y.csv", "--output"),
        ("--points p.csv --by material", "object and polygon"),
        ("--points p.csv --way boxes --epsilon 1", "--epsilon"),
    ] {
        let message = folder.run(&format!("point-factors box.obj {line}"), "", 2);
        assert!(message.lines().count() == 1 && message.contains(named), "{line}: {message}");
    }
    assert_eq!(folder.read("p.csv"), POINTS);
}

#[test]
#[cfg(not(feature = "parquet"))]
fn without_the_feature_parquet_is_a_usage_error_that_names_it() {
    let folder = Folder::new("no-parquet");
    let message = folder.run("point-factors box.obj --points - -o x.parquet", POINTS, 2);
    assert!(message.contains("feature parquet") && !folder.0.join("x.parquet").exists(), "{message}");
}

#[test]
#[cfg(feature = "parquet")]
fn parquet_is_written_with_the_feature() {
    let folder = Folder::new("parquet");
    folder.points("--points - -o x.parquet", POINTS);
    let bytes = fs::read(folder.0.join("x.parquet")).expect("a file");
    assert!(bytes.starts_with(b"PAR1") && bytes.ends_with(b"PAR1"));
}
