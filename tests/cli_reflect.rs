//! `nusselt reflect` as a user meets it.
#![cfg(feature = "cli")]

use nusselt::brdf::{Lambert, Merl};
use nusselt::io::write_merl;
use serde_json::Value;
use std::f64::consts::PI;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// A folder of its own for each test, with a lamp above a table in it.
struct Folder(PathBuf);

const SCENE: &str = "\
mtllib lamp.mtl
v -1 -1 2
v 1 -1 2
v 1 1 2
v -1 1 2
v -3 -3 0
v 3 -3 0
v 3 3 0
v -3 3 0
o lamp
usemtl lamp
f 4 3 2 1
o table
usemtl lacquer
f 5 6 7 8
";

const MATERIALS: &str = "\
newmtl lamp
Kd 0 0 0
Ke 3 2 1
newmtl lacquer
Kd 0.5 0.4 0.3
Ks 0.2 0.2 0.2
Ns 20
";

impl Folder {
    fn new(name: &str) -> Self {
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("reflect-{name}-{}", std::process::id()));
        // Left over from a run that was stopped.
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).expect("a folder for tests");
        let folder = Self(path);
        folder.write("lamp.obj", SCENE);
        folder.write("lamp.mtl", MATERIALS);
        folder
    }

    fn output(&self, line: &str, code: i32) -> [String; 2] {
        let Output { status, stdout, stderr } = Command::new(env!("CARGO_BIN_EXE_nusselt"))
            .args(line.split_whitespace())
            .current_dir(&self.0)
            .output()
            .expect("the program runs");
        let [stdout, stderr] = [stdout, stderr].map(|bytes| String::from_utf8(bytes).expect("UTF-8"));
        assert_eq!(status.code(), Some(code), "{line}\n{stdout}\n{stderr}");
        [stdout, stderr]
    }

    /// From the middle of the table.
    fn reflect(&self, rest: &str) -> Value {
        let line = format!("reflect lamp.obj --eye 0,0,0 --normal 0,0,1 --json {rest}");
        let value: Value = serde_json::from_str(&self.output(&line, 0)[0]).expect("JSON");
        assert_eq!(value["schema"], "nusselt.reflect/1");
        value
    }

    /// The one message.
    fn refused(&self, line: &str, code: i32) -> String {
        let [stdout, stderr] = self.output(line, code);
        assert_eq!(stdout, "", "{line}");
        assert!(stderr.starts_with("nusselt: ") && stderr.matches("nusselt: ").count() == 1, "{line}: {stderr}");
        stderr
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

fn rgb(value: &Value, key: &str) -> [f64; 3] {
    let list = value[key].as_array().expect("an array");
    let numbers: Vec<f64> = list.iter().map(|x| x.as_f64().expect("a number")).collect();
    numbers.try_into().expect("three numbers")
}

fn close(found: [f64; 3], expected: [f64; 3], relative: f64) {
    for (x, y) in found.into_iter().zip(expected) {
        assert!((x - y).abs() <= relative * y.abs(), "{found:?} instead of {expected:?}");
    }
}

/// The form factor of the lamp from the middle of the table: a square of side 2 at height 2.
fn lamp_factor() -> f64 {
    let t = 1.0 / 5.0_f64.sqrt();
    4.0 / PI * t * t.atan()
}

#[test]
fn matt_surfaces_reflect_their_form_factor() {
    let folder = Folder::new("matt");
    let value = folder.reflect("--view 0,1,1 --brdf lambert:0.5");
    let f = lamp_factor();
    close(rgb(&value, "radiance"), [1.5 * f, f, 0.5 * f], 1e-14);
    assert!(rgb(&value, "error").into_iter().all(|error| (0.0..1e-13).contains(&error)));
    close(rgb(&value, "albedo"), [0.5; 3], 0.0);
    // The table is what one stands on.
    assert_eq!((&value["on"], rgb(&value, "normal")), (&Value::from(1), [0.0, 0.0, 1.0]));
    assert_eq!(value["timing"]["views"], 1);
    assert!(value["reflect_ms"].as_f64().expect("a number") >= 0.0);
    let above = folder.reflect("--view 0,1,1 --brdf lambert:0.5 --free");
    assert_eq!(above["on"], Value::Null);
    close(rgb(&above, "radiance"), [1.5 * f, f, 0.5 * f], 1e-14);
    // In words the same.
    let words = &folder.output("reflect lamp.obj --eye 0,0,0 --on 1 --view 0,1,1 --brdf lambert:0.5", 0)[0];
    assert!(words.contains("on the front of polygon 1 (table)") && words.contains("radiance"), "{words}");
}

#[test]
fn materials_and_sums_are_what_they_are_made_of() {
    let folder = Folder::new("sums");
    let of =
        |spec: &str| rgb(&folder.reflect(&format!("--view 0.2,-0.3,1 --tolerance 1e-6 --brdf {spec}")), "radiance");
    let [matt, gloss] = [of("lambert:0.5,0.4,0.3"), of("phong:20:0.2")];
    let sum = [0, 1, 2].map(|k| matt[k] + gloss[k]);
    close(of("lambert:0.5,0.4,0.3+phong:20:0.2"), sum, 1e-14);
    close(of("material"), sum, 1e-14);
    close(of("lafortune:-1,-1,1:20:0.2"), gloss, 1e-13);
    close(of("phong:2e+1:2e-1"), gloss, 1e-14);
    // All models give something, to the tolerance.
    for spec in [
        "oren-nayar:0.5:0.4",
        "blinn:30:0.5",
        "ward:0.2,0.1:0.3",
        "ashikhmin:10,100:0.3:0.4",
        "ggx:0.3",
        "ggx:0.3,0.1:0.04",
        "ggx:0.2:ior=1.5",
        "ggx:0.2:ior=0.2,0.9,1.5;k=3.9,2.4,1.9",
        "ggx:0.1:all",
        "mirror",
        "mirror:ior=1.5",
        "gltf:0.8,0.5,0.2:0.5:0.4",
    ] {
        let value = folder.reflect(&format!("--view 0.2,-0.3,1 --tangent 1,1,0 --brdf {spec}"));
        let [radiance, error, albedo] = ["radiance", "error", "albedo"].map(|key| rgb(&value, key));
        for k in 0..3 {
            assert!(radiance[k] > 0.0 && error[k] <= 1.01e-4 * radiance[0] && error[k] >= 0.0, "{spec}: {value}");
            assert!(albedo[k] > 0.0 && albedo[k] <= 1.0, "{spec}: {value}");
        }
    }
    close(of("mirror"), [3.0, 2.0, 1.0], 0.0);
    // A dielectric at normal incidence: ((n - 1) / (n + 1))^2.
    let glass = rgb(&folder.reflect("--view 0,0,1 --brdf mirror:ior=1.5"), "radiance");
    close(glass, [0.12, 0.08, 0.04], 1e-14);
}

#[test]
fn skies_and_lights_light_too() {
    let folder = Folder::new("lights");
    let f = lamp_factor();
    let of = |rest: &str| rgb(&folder.reflect(&format!("--view 0,0,1 --brdf lambert:1 {rest}")), "radiance");
    let lamp = [3.0 * f, 2.0 * f, f];
    let and = |more: [f64; 3]| [0, 1, 2].map(|k| lamp[k] + more[k]);
    close(of("--sky constant:2"), and([2.0 * (1.0 - f); 3]), 1e-13);
    // Overcast, less than 7/9 of the zenith's radiance by what the lamp hides: between what it has at 45 degrees and at the zenith.
    let overcast = of("--sky overcast:3")[0] - lamp[0];
    assert!(overcast < 7.0 / 3.0 - 3.0 * f * 0.8 && overcast > 7.0 / 3.0 - 3.0 * f, "{overcast}");
    let [towards, away] = ["1,0,1", "-1,0,1"].map(|sun| of(&format!("--sky clear:3,3,3:{sun} --tolerance 1e-6")));
    close(towards, away, 1e-5);
    // Seen from the lamp's other side it is a sky on its side: above it is half of the dome.
    assert!(of("--sky overcast:3 --sky-up 1,0,0")[0] < of("--sky overcast:3")[0]);
    close(of("--directional-light 4,0,3:5"), and([3.0 / PI; 3]), 1e-14);
    close(of("--directional-light 0,0,1:5"), lamp, 1e-14);
    close(of("--point-light 0,0,1:1,2,3"), and([1.0 / PI, 2.0 / PI, 3.0 / PI]), 1e-14);
    close(of("--point-light 0,0,3:1"), lamp, 1e-14);
    close(
        of("--point-light 0,0,1:1 --point-light 0,0,1:1,2,3 --directional-light 4,0,3:5"),
        and([5.0 / PI, 6.0 / PI, 7.0 / PI]),
        1e-14,
    );
    // The lamp's back is dark unless both sides emit.
    let back = |rest: &str| {
        let line = format!("reflect lamp.obj --eye 0,0,4 --normal 0,0,-1 --view 0,0,-1 --brdf lambert:1 --json {rest}");
        let value: Value = serde_json::from_str(&folder.output(&line, 0)[0]).expect("JSON");
        rgb(&value, "radiance")
    };
    close(back(""), [0.0; 3], 0.0);
    close(back("--two-sided"), lamp, 1e-14);
}

#[test]
fn specifications_that_make_no_sense_are_refused_with_what_is_expected() {
    let folder = Folder::new("specs");
    for (spec, words) in [
        ("gloss", "there is no model \"gloss\"; there are lambert, oren-nayar, phong"),
        ("lambert", "it takes the form lambert:RHO"),
        ("lambert:0.5:0.5", "it takes the form lambert:RHO"),
        ("lambert:1.5", "a reflectance has to be from 0 to 1, not [1.5, 1.5, 1.5]"),
        ("lambert:0.1,0.2", "a colour takes one number or three, R,G,B, not \"0.1,0.2\""),
        ("lambert:red", "\"red\" is not a number"),
        ("phong:-1", "an exponent has to be from 0 to 1,000,000, not -1"),
        ("phong:nan", "nan is not finite"),
        ("ggx:0", "a roughness has to be from 0.0001 to 10, not 0"),
        ("ggx:0.1:ior=0", "a refractive index has to be from 0.01 to 100"),
        ("ggx:0.1,0.2,0.3", "it takes at most 2 numbers"),
        ("mirror:2", "a reflectance has to be from 0 to 1"),
        ("lafortune:1,2:3", "it takes 3 numbers"),
        ("lafortune:2,2,2:30", "take a smaller weight or scale"),
        ("material:x", "it takes the form material"),
        ("lambert:0.5+", "a model is missing"),
        ("+lambert:0.5", "a model is missing"),
    ] {
        let line = format!("reflect lamp.obj --eye 0,0,0 --normal 0,0,1 --view 0,0,1 --brdf {spec}");
        let message = folder.refused(&line, 2);
        assert!(
            message.contains(words) && message.contains("--brdf") && message.lines().count() == 1,
            "{spec}: {message}"
        );
    }
    for (rest, words) in [
        ("--sky blue", "it takes the form constant:L, overcast:L or clear:L:X,Y,Z"),
        ("--sky clear:1:1,0,0", "the sun at [1, 0, 0] is not above the horizon"),
        ("--sky overcast:-1", "a radiance of the sky has to be finite and not negative"),
        ("--sky-up 0,0,1", "--sky"),
        ("--point-light 1,2,3", "it takes the form X,Y,Z:I"),
        ("--point-light 0,0,0:1", "--point-light:"),
        ("--directional-light 0,0,0:1", "the zero vector has no direction"),
        ("--directional-light 0,0,1:-1", "is negative"),
        ("--tolerance 0", "it is from 1e-12 to 1"),
        ("--tangent 0,0,1", "--tangent:"),
        ("-o x.png", "pictures are written as .svg"),
        ("--picture polar", "--output"),
        ("-o x.svg --picture round", "there are plane, polar, lobe"),
        ("-o lamp.svg --view 0,0,-1", "--view"),
    ] {
        let view = if rest.contains("--view") { "" } else { "--view 0,0,1" };
        let line = format!("reflect lamp.obj --eye 0,0,0 --normal 0,0,1 {view} --brdf lambert:0.5 {rest}");
        let message = folder.refused(&line, 2);
        assert!(message.contains(words), "{rest}: {message}");
    }
    let nowhere = folder.refused("reflect lamp.obj --eye 0,0,1 --normal 0,0,1 --view 0,0,1 --brdf material", 2);
    assert!(nowhere.contains("--brdf material") && nowhere.contains("--on K"), "{nowhere}");
    assert!(folder.refused("reflect lamp.obj --eye 0,0,1 --view 0,0,1 --brdf lambert:1", 2).contains("--normal"));
    assert!(folder.refused("reflect lamp.obj --eye 0,0,1 --on 7 --view 0,0,1 --brdf lambert:1", 2).contains("--on"));
    assert_eq!(folder.files(), 2);
    // The work fails: what the file says is wrong.
    folder.write("lamp.mtl", &MATERIALS.replace("Ns 20", "Ns 2e6"));
    let line = "reflect lamp.obj --eye 0,0,0 --normal 0,0,1 --view 0,0,1 --brdf material";
    let message = folder.refused(line, 1);
    assert!(message.contains("lamp.mtl:4: material \"lacquer\": an exponent"), "{message}");
    // So much is made less, with a warning.
    for bright in ["Kd 0.9", "Kd 1.5"] {
        folder.write("lamp.mtl", &MATERIALS.replace("Kd 0.5", bright));
        let [_, warning] = folder.output(line, 0);
        assert!(warning.contains("lamp.mtl:4: material \"lacquer\": Kd and Ks sum to more than 1"), "{warning}");
    }
    assert!(
        folder
            .refused("reflect none.obj --eye 0,0,0 --normal 0,0,1 --view 0,0,1 --brdf mirror", 1)
            .contains("none.obj")
    );
}

#[test]
fn tables_are_read_from_files() {
    let folder = Folder::new("tables");
    let matt = Lambert::new(glam::DVec3::new(0.5, 0.4, 0.3)).expect("a reflectance");
    write_merl(&folder.0.join("matt.binary"), &Merl::tabulate(&matt).expect("a table")).expect("writable");
    let expected = rgb(&folder.reflect("--view 0.2,-0.3,1 --brdf lambert:0.5,0.4,0.3"), "radiance");
    let measured = folder.reflect("--view 0.2,-0.3,1 --brdf merl:matt.binary");
    // The file has f64 values of a constant.
    close(rgb(&measured, "radiance"), expected, 1e-4);
    let ltc = folder.reflect("--view 0.2,-0.3,1 --brdf ltc:0.3:0.5 --sky overcast:1");
    let ggx = folder.reflect("--view 0.2,-0.3,1 --brdf ggx:0.3:0.5 --sky overcast:1");
    for k in 0..3 {
        let off = (rgb(&ltc, "radiance")[k] - rgb(&ggx, "radiance")[k]).abs();
        assert!(off <= rgb(&ltc, "error")[k] + rgb(&ggx, "error")[k], "{ltc} {ggx}");
    }
    let line = "reflect lamp.obj --eye 0,0,0 --normal 0,0,1 --view 0,0,1 --brdf";
    for (spec, words) in
        [("merl:none.binary", "none.binary"), ("sh:lamp.obj", "lamp.obj"), ("merl:lamp.obj", "lamp.obj")]
    {
        let message = folder.refused(&format!("{line} {spec}"), 1);
        assert!(message.contains(words), "{spec}: {message}");
    }
    assert!(folder.refused(&format!("{line} merl"), 2).contains("it takes the form merl:FILE"));
    assert!(folder.refused(&format!("{line} ltc:0.001"), 2).contains("ltc:"));
}

#[test]
fn a_mirror_at_an_edge_warns_of_the_error() {
    let folder = Folder::new("edge");
    // Towards the edge of the lamp at 1, 0, 2.
    let line = "reflect lamp.obj --eye 0,0,0 --normal 0,0,1 --view -1,0,2 --brdf mirror --json";
    let [stdout, stderr] = folder.output(line, 0);
    let value: Value = serde_json::from_str(&stdout).expect("JSON");
    // The direction is rounded: within it, beyond it or on it.
    let [radiance, error] = ["radiance", "error"].map(|key| rgb(&value, key)[0]);
    assert!([0.0, 3.0].contains(&radiance) && [0.0, 3.0].contains(&error), "{value}");
    assert_eq!(stderr.contains("larger than --tolerance"), error > 0.0, "{stderr}");
}

/// Every tag is closed by its own name, attributes are quoted, and no text has a bare < or &.
fn check_xml(text: &str) {
    let body = text.strip_prefix("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n").expect("a declaration");
    let mut open: Vec<&str> = Vec::new();
    let mut rest = body;
    while let Some(start) = rest.find('<') {
        let words = &rest[..start];
        assert!(
            !words.contains('>') && words.matches('&').count() == words.matches(';').count()
                || open.last() == Some(&"style")
        );
        let end = start + rest[start..].find('>').expect("a tag that ends");
        let tag = &rest[start + 1..end];
        assert!(tag.matches('"').count().is_multiple_of(2) && !tag.contains('<'), "{tag}");
        if let Some(name) = tag.strip_prefix('/') {
            assert_eq!(open.pop(), Some(name));
        } else if !tag.ends_with('/') {
            open.push(tag.split_whitespace().next().expect("a name"));
        }
        rest = &rest[end + 1..];
    }
    assert!(open.is_empty() && rest.trim().is_empty(), "{open:?}");
    assert!(!text.contains("NaN") && !text.contains("inf"), "numbers");
}

#[test]
fn pictures_are_well_formed_and_show_what_they_should() {
    let folder = Folder::new("pictures");
    for view in ["0.5,0.2,1", "0,0,1", "1,0,0.01"] {
        for spec in
            ["lambert:0.5,0.4,0.3", "lambert:0.3+ggx:0.2:0.5", "ggx:0.01", "mirror", "lambert:0", "phong:2048+mirror"]
        {
            for picture in ["plane", "polar", "lobe"] {
                let line = format!(
                    "reflect lamp.obj --eye 0,0,0 --normal 0,0,1 --view {view} --brdf {spec} -o x.svg --picture {picture} --quiet"
                );
                assert_eq!(folder.output(&line, 0)[0], "", "{line}");
                let text = fs::read_to_string(folder.0.join("x.svg")).expect("written");
                check_xml(&text);
                let has_emitters = text.contains("id=\"emitters\"");
                assert_eq!(has_emitters, picture == "plane", "{line}");
                assert_eq!(text.contains("a mirror") || text.contains(">mirror<"), spec.contains("mirror"), "{line}");
            }
        }
    }
    let line = "reflect lamp.obj --eye 0,0,0 --normal 0,0,1 --view 0,0,1 --brdf lambert:0.5 -o x.svg";
    let words = &folder.output(line, 0)[0];
    assert!(words.contains("wrote        x.svg"), "{words}");
    // The cosine to the fourth power: on the plane, half of the largest value is at tan^2 = sqrt(2) - 1.
    let text = fs::read_to_string(folder.0.join("x.svg")).expect("written");
    assert!(text.contains("0.159 (most)") || text.contains("0.16 (most)"), "1 / (2 pi)");
    let outside =
        folder.refused("reflect lamp.obj --eye 0,0,0 --normal 0,0,1 --view 0,0,1 --brdf mirror -o none/x.svg", 1);
    assert!(outside.contains("none/x.svg"), "{outside}");
}
