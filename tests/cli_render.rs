//! `nusselt render` on the command line.
#![cfg(feature = "cli")]

mod common;

use common::program::Folder;
use std::fs::{self, File};
use std::io::BufReader;
use std::path::Path;
use std::process::Command;

const CAMERA: &str = "--eye 278,273,-800 --look-at 278,273,0 --up 0,1,0 --fov 39.3";

/// Width, height and bytes of a PNG file.
fn png(path: &Path) -> ([u32; 2], Vec<u8>) {
    let decoder = png::Decoder::new(BufReader::new(File::open(path).expect("a file")));
    let mut reader = decoder.read_info().expect("a PNG file");
    let mut bytes = vec![0; reader.output_buffer_size().expect("a small picture")];
    let frame = reader.next_frame(&mut bytes).expect("pixels");
    bytes.truncate(frame.buffer_size());
    ([frame.width, frame.height], bytes)
}

fn same(folder: &Folder, a: &str, b: &str) -> bool {
    fs::read(folder.path(a)).expect("a file") == fs::read(folder.path(b)).expect("a file")
}

#[test]
fn the_cornell_box_is_as_it_was() {
    let folder = Folder::new("render");
    let line = format!(
        "render box.obj {CAMERA} --size 32x24 --patch 250 --tolerance 1e-4 --until 1e-5 --depth 1 --exposure 3"
    );
    let summary = folder.parsed(&format!("{line} -o a.png --json"));
    assert_eq!(summary["schema"], "nusselt.render/1");
    assert_eq!(summary["size"], serde_json::json!([32, 24]));
    assert!(summary["points"].as_u64() > Some(600) && summary["corners"].as_u64() > Some(50), "{summary}");
    let (size, found) = png(&folder.path("a.png"));
    assert_eq!(size, [32, 24]);
    // Made by the same line.
    let (size, expected) = png(&Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/pictures/cornell.png"));
    assert_eq!(size, [32, 24]);
    for (k, (found, expected)) in found.iter().zip(&expected).enumerate() {
        // As functions of the system's library may round in other ways, and form factors within their tolerance.
        assert!(found.abs_diff(*expected) <= 1, "byte {k}: {found} {expected}");
    }
    // One thread or several, and the same file.
    folder.run(&format!("{line} --threads 1 -o b.png"), 0);
    folder.run(&format!("{line} --threads 3 -o c.png"), 0);
    assert!(same(&folder, "a.png", "b.png") && same(&folder, "a.png", "c.png"));
}

#[test]
fn all_ways_of_shading_show_about_the_same() {
    let folder = Folder::new("render-ways");
    let line = format!("render box.obj {CAMERA} --size 24x24 --exposure 3");
    for solved in ["--direct", "--patch 300 --tolerance 1e-2"] {
        folder.run(&format!("{line} {solved} -o contour.png"), 0);
        let (_, contour) = png(&folder.path("contour.png"));
        let off = |way: &str, file: &str| {
            folder.run(&format!("{line} {solved} --shading {way} -o {file}"), 0);
            let (_, other) = png(&folder.path(file));
            let sum: u64 = contour.iter().zip(&other).map(|(a, b)| u64::from(a.abs_diff(*b))).sum();
            sum as f64 / contour.len() as f64
        };
        // A row of pixels more or less is a tenth of the lamp, and half of that as sRGB has it; most points are off by less.
        let cubes = off("hemicube:128", "cubes.png");
        assert!(cubes < 4.0, "{solved}: {cubes}");
        // The lamp has a form factor of about 0.03: of as many independent rays the standard error is 18% of it, which is 8% as sRGB has it, 10 of 128; and 0.8
        // of that is the mean error.
        let few = off("rays:1000 --threads 1", "few.png");
        assert!(few < 8.0, "{solved}: {few}");
        off("rays:1000 --threads 2", "threads.png");
        assert!(same(&folder, "few.png", "threads.png"), "rays depend on threads");
        // Noise falls with the root of their number at least: to 0.35 of it, and to what is rounded and interpolated.
        let many = off("rays:8000", "many.png");
        assert!(many < 0.5 * few + 0.5, "{solved}: {few} {many}");
    }
}

#[test]
fn a_sequence_is_numbered_and_evenly_exposed() {
    let folder = Folder::new("render-frames");
    folder.write("path.csv", "ex,ey,ez,lx,ly,lz,fov\n278,273,-800,278,273,0,40\n200,273,-700 278,273,0 45\n");
    let line = "render box.obj --frames path.csv --up 0,1,0 --size 16x12 --direct";
    let summary = folder.parsed(&format!("{line} -o walk.png --json"));
    assert_eq!(summary["frames"], 2);
    assert!(folder.exists("walk_0001.png") && folder.exists("walk_0002.png") && !folder.exists("walk.png"));
    // The second picture alone, with the exposure of the first.
    let exposure = summary["exposure"].as_f64().expect("a number");
    let alone = "render box.obj --eye 200,273,-700 --look-at 278,273,0 --fov 45 --up 0,1,0 --size 16x12 --direct";
    folder.run(&format!("{alone} --exposure {exposure} -o alone.png"), 0);
    assert!(same(&folder, "walk_0002.png", "alone.png"));
    folder.write("bad.csv", "278,273,-800,278,273,0,40\n1,2,3,1,2,3,40\n");
    let error = folder.run("render box.obj --frames bad.csv --size 16x12 -o x.png", 1);
    assert!(error.contains("bad.csv:2: the camera looks at its own eye"), "{error}");
    folder.write("up.csv", "278,273,-800,278,273,0,40\n0,0,0,0,9,0,40\n");
    let error = folder.run("render box.obj --frames up.csv --up 0,1,0 --size 16x12 -o x.png", 1);
    assert!(error.contains("up.csv:2: --up"), "{error}");
    assert!(!folder.exists("x_0001.png"));
}

#[test]
fn materials_take_other_brdfs() {
    let folder = Folder::new("render-brdf");
    let line = format!("render box.obj {CAMERA} --size 16x16 --direct --exposure 3");
    folder.run(&format!("{line} -o a.png"), 0);
    folder.run(&format!("{line} --brdf white=lambert:0.2+mirror:0.8 -o b.png"), 0);
    folder.run(&format!("{line} --brdf white=material -o c.png"), 0);
    assert!(!same(&folder, "a.png", "b.png") && same(&folder, "a.png", "c.png"));
    // Lights besides the lamp.
    folder.run(&format!("{line} --point-light 278,500,100:90000 -o d.png"), 0);
    folder.run(&format!("{line} --sky constant:0.5 -o e.png"), 0);
    assert!(!same(&folder, "a.png", "d.png") && !same(&folder, "a.png", "e.png"));
}

#[test]
fn what_is_wrong_is_said_in_one_line() {
    let folder = Folder::new("render-wrong");
    let with = |rest: &str| format!("render box.obj {CAMERA} {rest}");
    for (line, code, what) in [
        (with("--size 4x4"), 2, "--output"),
        (with("--size 4x4 -o x.jpg"), 2, ".png, .exr"),
        (with("--size 0x4 -o x.png"), 2, "from 1 to 16384"),
        (with("--size 20000x4 -o x.png"), 2, "from 1 to 16384"),
        (with("--size 4 -o x.png"), 2, "WxH"),
        (with("--shading cube -o x.png"), 2, "there are contour, hemicube:N"),
        (with("--shading hemicube:63 -o x.png"), 2, "N even"),
        (with("--shading rays:0 -o x.png"), 2, "N from 1"),
        (with("--direct --patch 3 -o x.png"), 2, "--patch"),
        (with("--two-sided -o x.png"), 2, "--direct"),
        (with("--brdf gold=mirror -o x.png"), 2, "no material \"gold\"; there are"),
        (with("--brdf white=chrome -o x.png"), 2, "no model \"chrome\""),
        (with("--exposure 0 -o x.png"), 2, "above 0"),
        (with("-o x.png -o x.png"), 2, "written twice"),
        (with("-o box.obj"), 2, ".png, .exr"),
        (with("-o none/x.png"), 1, "none does not exist; make its directory first"),
        (with("--direct --size 3x3 --point-light 278,273,NaN:1 -o x.png"), 2, "--point-light"),
        ("render box.obj --eye 1,2,3 --look-at 1,2,3 --fov 40 -o x.png".to_owned(), 2, "--look-at is --eye"),
        ("render box.obj --eye 1,2,3 -o x.png".to_owned(), 2, "--look-at"),
        ("render box.obj -o x.png".to_owned(), 2, "--eye"),
        ("render none.obj --eye 1,2,3 --look-at 0,0,0 --fov 40 -o x.png".to_owned(), 1, "none.obj"),
        ("render box.obj --frames none.csv -o x.png".to_owned(), 1, "none.csv"),
    ] {
        let error = folder.run(&line, code);
        assert!(error.contains(what), "{line}: {error}");
        assert!(!folder.exists("x.png"), "{line}");
    }
}

#[test]
fn a_scene_without_light_is_black_with_a_warning() {
    let folder = Folder::new("render-dark");
    fs::write(folder.path("dark.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").expect("written");
    let line = "render dark.obj --eye 0.2,0.2,2 --look-at 0.2,0.2,0 --fov 40 --size 4x4";
    let said = |line: &str| {
        let mut program = Command::new(env!("CARGO_BIN_EXE_nusselt"));
        let output = program.args(line.split_whitespace()).current_dir(folder.path(".")).output();
        String::from_utf8(output.expect("the program runs").stderr).expect("UTF-8")
    };
    let warning = said(&format!("{line} -o x.png"));
    assert!(warning.contains("nothing emits light"), "{warning}");
    assert!(png(&folder.path("x.png")).1.iter().all(|&byte| byte == 0));
    assert_eq!(said(&format!("{line} --sky constant:1 -o y.png")), "");
    assert!(folder.exists("y.png"));
}

/// Only contour images interpolate between corners.
#[test]
fn hemicubes_make_no_corners() {
    let folder = Folder::new("render-corners");
    let line = format!("render box.obj {CAMERA} --size 4x4 --patch 400 --depth 0 -o x.png --json");
    for (shading, has_corners) in [("contour", true), ("hemicube:16", false)] {
        let summary = folder.parsed(&format!("{line} --shading {shading}"));
        assert_eq!(summary["corners"].as_u64().expect("a number") > 0, has_corners, "{summary}");
    }
}

#[test]
fn exr_has_radiances_or_says_what_it_takes() {
    let folder = Folder::new("render-exr");
    let line = format!("render box.obj {CAMERA} --size 8x8 --direct -o x.exr");
    if cfg!(feature = "exr") {
        folder.run(&line, 0);
        assert!(fs::read(folder.path("x.exr")).expect("a file").starts_with(&[0x76, 0x2f, 0x31, 0x01]));
    } else {
        assert!(folder.run(&line, 2).contains("build it with --features exr"));
        assert!(!folder.exists("x.exr"));
    }
}
