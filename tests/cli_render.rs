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
    folder.write("semicolons.csv", "278;273;-800;278;273;0;40\n200,273,-700 278,273,0 45\n");
    let error = folder.run("render box.obj --frames semicolons.csv --size 16x12 -o x.png", 1);
    assert!(error.contains("semicolons.csv:1: ") && error.contains("by commas or blanks"), "{error}");
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
        (with("--size 16384x16384 -o x.png"), 2, "would take 10.7 GB to keep"),
        (with("--size 16384x16384 --exposure 1 -o x.png -o y.png"), 2, "which takes an --exposure"),
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
        (with("-o box.obj/x.png"), 1, "cannot write box.obj/x.png: "),
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

/// Before any work is done: the scene is not even read.
#[test]
#[cfg(target_os = "linux")]
fn a_place_that_takes_no_files_is_named() {
    let folder = Folder::new("render-nowhere");
    let error = folder.run(&format!("render none.obj {CAMERA} -o /proc/x.png"), 1);
    assert!(error.contains("cannot write /proc/x.png: ") && error.contains("choose another directory"), "{error}");
}

/// What the program says on stderr.
fn said_in(folder: &Folder, line: &str) -> String {
    let mut program = Command::new(env!("CARGO_BIN_EXE_nusselt"));
    let output = program.args(line.split_whitespace()).current_dir(folder.path(".")).output();
    String::from_utf8(output.expect("the program runs").stderr).expect("UTF-8")
}

/// Render, radiosity and reflect go by one rule, and name the file, the line and the material.
#[test]
fn materials_that_reflect_too_much_are_told_by_file_and_line() {
    let folder = Folder::new("render-materials");
    let faces = "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nv 0 0 3\nv 4 0 3\nv 4 4 3\nv 0 4 3\n";
    let scene = format!("mtllib lit.mtl\n{faces}usemtl bright\nf 1 2 3 4\nusemtl lamp\nf 8 7 6 5\n");
    folder.write("lit.obj", &scene);
    let camera = "--eye 2,2,2.9 --look-at 2,2.1,0 --fov 60 --size 8x8";
    let lines = [
        format!("render lit.obj {camera} --patch 2 --exposure 1 -o x.png"),
        "radiosity lit.obj --patch 2 -o x.json".to_owned(),
        "reflect lit.obj --eye 2,2,0 --on 0 --view 0,0,1 --brdf material --quiet".to_owned(),
    ];
    let with = |kd: &str, ks: &str| {
        let lamp = "newmtl lamp\nKd 0.5 0.5 0.5\nKe 1 1 1\n";
        folder.write("lit.mtl", format!("{lamp}# below\nnewmtl bright\nKd {kd}\nKs {ks}\nNs 9\n"));
    };
    let warning = "lit.mtl:5: material \"bright\": Kd and Ks sum to more than 1";
    for (kd, ks, divided) in [("0.9 0.9 0.9", "0.6 0.6 0.6", "0.6 0.6 0.6"), ("1.2 0.5 0.5", "0 0 0", "1 0.5 0.5")] {
        with(kd, ks);
        for line in &lines[..2] {
            let said = said_in(&folder, line);
            assert!(said.contains(warning), "{line}: {said}");
        }
        let solved = folder.read("x.json");
        // With what is left of it there is the same solution, and nothing to say.
        with(divided, if ks == "0 0 0" { ks } else { "0.4 0.4 0.4" });
        assert_eq!(said_in(&folder, &format!("{} --quiet", lines[1])), "");
        assert_eq!(folder.read("x.json"), solved);
    }
    with("-0.1 0 0", "0 0 0");
    for line in &lines {
        let error = folder.run(line, 1);
        assert!(error.contains("lit.mtl:5: ") && error.contains("bright"), "{error}");
    }
    let gltf = r#"{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":0}]}],
        "materials":[{"name":"glow","emissiveFactor":[1,1,1],"pbrMetallicRoughness":{"baseColorFactor":[1.5,1,1,1]}}],
        "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],"bufferViews":[{"buffer":0,"byteLength":36}],
        "buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]}"#;
    folder.write("glow.gltf", gltf);
    for line in [&lines[0], &lines[1]] {
        let error = folder.run(&line.replace("lit.obj", "glow.gltf"), 1);
        assert!(error.contains("glow.gltf: ") && error.contains("glow\": a reflectance has to be"), "{error}");
    }
}

#[test]
fn very_bright_scenes_are_not_black() {
    let folder = Folder::new("render-bright");
    let faces =
        "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nv 0 0 3\nv 4 0 3\nv 4 4 3\nv 0 4 3\nf 1 2 3 4\nusemtl lamp\nf 8 7 6 5\n";
    folder.write("lit.obj", format!("mtllib lit.mtl\n{faces}"));
    for direct in ["--direct", "--patch 2"] {
        let line = format!("render lit.obj --eye -3,2,2 --look-at 2,2,1 --fov 60 --size 8x8 {direct}");
        let pixels = |glow: &str| {
            folder.write("lit.mtl", format!("newmtl lamp\nKd 0.5 0.5 0.5\nKe {glow} {glow} {glow}\n"));
            folder.run(&format!("{line} -o x.png"), 0);
            png(&folder.path("x.png")).1
        };
        let usual = pixels("1");
        assert!(usual.iter().any(|&byte| byte > 200));
        // A byte may be rounded the other way.
        assert!(pixels("1e300").iter().zip(&usual).all(|(a, b)| a.abs_diff(*b) <= 1));
    }
}

#[test]
fn a_scene_without_light_is_black_with_a_warning() {
    let folder = Folder::new("render-dark");
    fs::write(folder.path("dark.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").expect("written");
    let line = "render dark.obj --eye 0.2,0.2,2 --look-at 0.2,0.2,0 --fov 40 --size 4x4";
    let said = |line: &str| said_in(&folder, line);
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

/// A studio with walls of several colours, a lacquered slab, a mirror that stands free, and a lamp.
const STUDIO: &str = "mtllib studio.mtl
v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nv 0 0 3\nv 4 0 3\nv 4 4 3\nv 0 4 3
v 1.4 1.4 2.9\nv 2.6 1.4 2.9\nv 2.6 2.6 2.9\nv 1.4 2.6 2.9
v 0.8 1.2 0\nv 1.8 0.9 0\nv 2.0 1.7 0\nv 1.0 2.0 0\nv 0.8 1.2 0.7\nv 1.8 0.9 0.7\nv 2.0 1.7 0.7\nv 1.0 2.0 0.7
v 2.2 3.7 0.3\nv 3.8 3.0 0.3\nv 3.8 3.0 2.3\nv 2.2 3.7 2.3
usemtl floor\nf 1 2 3 4\nusemtl wall\nf 4 3 7 8\nusemtl red\nf 1 4 8 5\nusemtl lamp\nf 12 11 10 9
usemtl lacquer\nf 17 18 19 20\nf 13 14 18 17\nf 14 15 19 18\nf 15 16 20 19\nf 16 13 17 20\nusemtl glass\nf 21 22 23 24
";
const STUDIO_MATERIALS: &str = "newmtl floor\nKd 0.6 0.6 0.5\nnewmtl wall\nKd 0.7 0.7 0.7\nnewmtl red\nKd 0.7 0.1 0.1
newmtl lamp\nKd 0 0 0\nKe 6 5 4\nnewmtl lacquer\nKd 0.1 0.2 0.5\nKs 0.3 0.3 0.3\nNs 20\nnewmtl glass\nKd 0 0 0
";

/// Lamp, sky and lights without extent; matt, glossy and mirrored.
#[test]
fn a_studio_is_as_it_was_and_as_rays_show_it() {
    let folder = Folder::new("render-studio");
    folder.write("studio.obj", STUDIO);
    folder.write("studio.mtl", STUDIO_MATERIALS);
    let camera = "--eye 3.6,0.3,1.7 --look-at 1.8,2.4,0.9 --fov 65 --size 32x24 --brdf glass=mirror:0.8";
    let solved = "--patch 1 --tolerance 1e-4 --until 1e-5 --gather --exposure 1.2";
    let sky = "--direct --exposure 0.5 --sky overcast:1.5";
    let lights = "--direct --exposure 0.8 --point-light 0.5,0.5,2.5:3,3,1 --directional-light 1,-1,1.5:1,1.2,1.5";
    // Only lamps and skies are met by rays.
    for (name, light, by_rays) in [("lamp", solved, true), ("sky", sky, true), ("lights", lights, false)] {
        let line = format!("render studio.obj {camera} {light}");
        folder.run(&format!("{line} -o {name}.png"), 0);
        let (size, exact) = png(&folder.path(&format!("{name}.png")));
        assert_eq!(size, [32, 24]);
        // Made by the same line.
        let stored = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("tests/pictures/studio_{name}.png"));
        let (_, expected) = png(&stored);
        for (k, (found, expected)) in exact.iter().zip(&expected).enumerate() {
            // As functions of the system's library may round in other ways, and form factors within their tolerance.
            assert!(found.abs_diff(*expected) <= 1, "{name}, byte {k}: {found} {expected}");
        }
        if !by_rays {
            continue;
        }
        let off = |rays: u32| {
            folder.run(&format!("{line} --shading rays:{rays} -o rays.png"), 0);
            let (_, found) = png(&folder.path("rays.png"));
            let sum: u64 = exact.iter().zip(&found).map(|(a, b)| u64::from(a.abs_diff(*b))).sum();
            sum as f64 / exact.len() as f64
        };
        let [few, many] = [off(250), off(4000)];
        // The lamp's form factor is 0.05 to 0.3, so 250 independent rays have a standard error of 10 to 28% of its light: half of that as sRGB has it, at most 18 of 128.
        assert!(few < 18.0 && few > 0.2, "{name}: {few}");
        // Noise falls with the root of the number of rays: to a quarter. Bytes are rounded, by a quarter each on average, and differences of two by a third.
        assert!(many < 0.25 * few * 1.2 + 0.33, "{name}: {few} {many}");
    }
}

#[test]
fn scenes_whose_areas_numbers_do_not_hold_are_lit_or_refused_for_what_is_wrong() {
    let folder = Folder::new("render-huge");
    folder.write("big.mtl", "newmtl grey\nKd 0.5 0.5 0.5\nnewmtl lamp\nKe 1 1 1\n");
    let big = "mtllib big.mtl\nusemtl grey\nv 0 0 0\nv 1e200 0 0\nv 0 1e200 0\nf 1 2 3\n";
    folder.write("big.obj", big);
    let camera = "--eye 2,2,3 --look-at 3,3,0 --fov 60 --size 4x4";
    // Nothing emits, so that there is no power; a light without extent is straight.
    for direct in ["", " --direct"] {
        folder.run(
            &format!("render big.obj {camera} --point-light 1,1,1:1 --exposure 1{direct} -o a{}.png", direct.len()),
            0,
        );
    }
    assert!(same(&folder, "a0.png", "a9.png"));
    let (_, found) = png(&folder.path("a0.png"));
    assert!(found.iter().any(|&byte| byte > 0));
    // The floor would have to be solved for: it is not the lamp that is wrong.
    folder.write("lamp.obj", format!("{big}v 0 0 9\nv 1 0 9\nv 0 1 9\nusemtl lamp\nf 4 6 5\n"));
    let error = folder.run(&format!("render lamp.obj {camera} -o b.png"), 1);
    assert!(error.contains("polygon 0: its area is more than numbers hold; use a larger unit of length"), "{error}");
}
