//! Certificates on the command line: kept, checked again, and refused when anything that matters was changed.
#![cfg(feature = "cli")]

mod common;

use common::program::Folder;
use serde_json::{Value, json};
use std::fs;

/// A folder with the Cornell box and a room in it.
fn folder(name: &str) -> Folder {
    let folder = Folder::new(&format!("certificate-{name}"));
    folder.run("scene room --polygons 150 --seed 5 -o room.obj", 0);
    folder
}

#[test]
fn kept_certificates_hold_when_read_again() {
    let folder = folder("round");
    for (scene, view, domain) in [
        ("box.obj", "--eye 278,273,-100 --sphere", "sphere"),
        ("box.obj", "--eye 278,273,200 --normal 0.1,-0.2,0.3", "hemisphere"),
        ("box.obj", "--eye 100,50,100 --on 0", "above"),
        ("box.obj", "--eye 100,50,100 --on 0:back", "above"),
        ("box.obj", "--eye 278,273,200 --sphere --epsilon 30", "sphere"),
        ("room.obj", "--eye 1,1,1 --normal 0,0,1", "hemisphere"),
        ("room.obj", "--eye 1,1,0 --on 3 --epsilon 0.1", "above"),
    ] {
        let made = folder.parsed(&format!("contour {scene} {view} --certificate kept.json -o x.json --json"));
        let kept = folder.json("kept.json");
        assert_eq!(kept["schema"], "nusselt.certificate/1");
        assert_eq!((&kept["domain"]["kind"], &kept["eye"]), (&Value::from(domain), &made["eye"]));
        assert_eq!(made["certificate"], folder.json("x.json")["certificate"]);
        assert_eq!(made["certificate"]["cells"], made["cell_count"]);
        let seen = folder.parsed(&format!("verify {scene} kept.json --json"));
        assert_eq!(seen["schema"], "nusselt.verify/1");
        assert_eq!(seen["certificate"], made["certificate"], "the same proof");
        assert_eq!((&seen["eye"], &seen["epsilon"]), (&made["eye"], &made["epsilon"]));
        assert!(seen["timing"]["certify_ms"].as_f64() > Some(0.0));
        let exact = folder.parsed(&format!("verify {scene} kept.json --json --rational"));
        assert_eq!(exact["arithmetic"], "rational");
        for key in ["valid", "cells", "great_circles"] {
            assert_eq!(exact["certificate"][key], made["certificate"][key]);
        }
        assert!(folder.run(&format!("verify {scene} kept.json"), 0).contains("proof        holds"));
        assert_eq!(folder.run(&format!("verify {scene} kept.json --quiet"), 0), "");
    }
}

#[test]
fn a_proof_is_told_in_words_and_numbers() {
    let folder = folder("words");
    let line = "contour box.obj --eye 278,273,-100 --sphere";
    let words = folder.run(&format!("{line} --certify -o x.json"), 0);
    assert!(words.contains("proof        holds for all directions; kernel arithmetic, "), "{words}");
    let row = &folder.json("x.json")["certificate"];
    assert_eq!(row["valid"], true);
    assert!(words.contains(&format!("{} exact decisions", row["exact_decisions"])), "{words}");
    assert!(folder.run(&format!("{line} --certify=rational"), 0).contains("rational arithmetic, "));
    assert!(folder.run(&format!("{line} --certify=kernel"), 0).contains("kernel arithmetic, "));
    let words = folder.run(&format!("{line} --certificate kept.json"), 0);
    assert!(words.contains("proof ") && words.contains("wrote        kept.json"), "{words}");
    let printed = folder.parsed(&format!("{line} --certify --json"));
    assert!(printed["timing"]["certify_ms"].as_f64() > Some(0.0));
    assert_eq!(&printed["certificate"], row);

    let plain = folder.parsed(&format!("{line} --json -o x.json"));
    assert!(plain.get("certificate").is_none() && plain["timing"].get("certify_ms").is_none());
    assert!(folder.json("x.json").get("certificate").is_none());
}

#[test]
fn certificates_never_replace_what_is_read_or_written() {
    let folder = folder("keep");
    fs::copy(folder.path("box.obj"), folder.path("scene.obj")).expect("a copy");
    let scene = fs::read_to_string(folder.path("box.obj")).expect("written").replace("box.mtl", "lib.json");
    folder.write("odd.obj", scene);
    fs::copy(folder.path("box.mtl"), folder.path("lib.json")).expect("a copy");
    for (line, named) in [
        ("contour box.obj --eye 1,2,3 --sphere --certify=exact", "there are kernel and rational"),
        ("contour box.obj --eye 1,2,3 --sphere --certify=", "--certify"),
        ("contour box.obj --eye 1,2,3 --sphere --certificate kept", ".json"),
        ("contour box.obj --eye 1,2,3 --sphere --certificate box.obj", ".json"),
        ("contour box.obj --eye 1,2,3 --sphere --certificate", "--certificate"),
        ("contour box.obj --eye 1,2,3 --sphere --certificate x.json -o ./x.json", "written twice"),
        ("contour odd.obj --eye 1,2,3 --sphere --certificate ./lib.json", "would overwrite"),
        ("verify box.obj", "<CERTIFICATE>"),
        ("verify box.obj kept.json --certify", "--certify"),
    ] {
        let message = folder.run(line, 2);
        assert!(message.contains(named), "{line}: {message}");
    }
    assert!(!folder.exists("x.json") && !folder.exists("kept.json"));
    let message = folder.run("contour box.obj --eye 1,2,3 --sphere --certificate missing/kept.json -o x.json", 1);
    assert!(message.contains("missing/kept.json") && !folder.exists("x.json"), "{message}");
}

#[test]
fn a_changed_certificate_does_not_hold() {
    let folder = folder("tamper");
    folder.run("contour box.obj --eye 278,273,-100 --normal 0,0,1 --certificate kept.json", 0);
    let kept = folder.json("kept.json");
    let refused = |what: &str, change: &dyn Fn(&mut Value)| {
        let mut changed = kept.clone();
        change(&mut changed);
        assert!(changed != kept, "{what}");
        folder.write("changed.json", changed.to_string());
        let message = folder.run("verify box.obj changed.json", 1);
        assert!(message.starts_with("nusselt: changed.json: "), "{message}");
        message
    };
    let count = kept["cells"].as_array().expect("cells").len();
    let piece = |k: usize| &kept["cells"][k]["piece"];
    let labelled = (0..count).find(|&k| !piece(k).is_null()).expect("something is seen");
    let other = (0..count).find(|&k| piece(k) != piece(labelled) && !piece(k).is_null()).expect("more than one");
    let relabel = format!("cell {labelled} ");
    for (what, change, named) in [
        (
            "lost",
            (&|c: &mut Value| drop(c["cells"].as_array_mut().expect("cells").remove(3))) as &dyn Fn(&mut Value),
            "gap or an overlap",
        ),
        (
            "doubled",
            &|c| {
                let cell = c["cells"][3].clone();
                c["cells"].as_array_mut().expect("cells").push(cell);
            },
            "gap or an overlap",
        ),
        ("no cells", &|c| c["cells"] = json!([]), "gap or an overlap"),
        ("background", &|c| c["cells"][labelled]["piece"] = Value::Null, &relabel),
        ("relabelled", &|c| c["cells"][labelled]["piece"] = piece(other).clone(), &relabel),
        (
            "turned over",
            &|c| {
                let side = c["cells"][5]["sides"][1].as_i64().expect("a number");
                c["cells"][5]["sides"][1] = json!(-side);
            },
            "cell 5 is not a convex cone",
        ),
        ("backwards", &|c| c["cells"][5]["sides"].as_array_mut().expect("sides").reverse(), "cell 5 is not"),
        ("another domain", &|c| c["domain"] = json!({ "kind": "sphere" }), "gap or an overlap"),
        ("a tilted horizon", &|c| c["domain"]["normal"] = json!([0, 5e-324, 1]), "gap or an overlap"),
        ("no horizon", &|c| c["domain"]["normal"] = json!([0, 0, 0]), "domain"),
        ("another eye", &|c| c["eye"] = json!([278, 273, 300]), "changed.json"),
        ("no such piece", &|c| c["cells"][5]["piece"] = json!(17), "cell 5: its piece or one of its splitters"),
        ("no such vertex", &|c| c["splitters"][2] = json!({ "edge": [0, 28] }), "splitter 2: a vertex does not exist"),
        ("no such splitter", &|c| c["cells"][5]["sides"][0] = json!(100_000), "cell 5: there is no splitter 100000"),
    ] {
        let message = refused(what, change);
        assert!(message.contains(named), "{what}: {message}");
    }
    // What does not change the claim does no harm.
    let mut same = kept.clone();
    same["cells"].as_array_mut().expect("cells").reverse();
    same["cells"][2]["sides"].as_array_mut().expect("sides").rotate_left(1);
    folder.write("same.json", same.to_string());
    folder.run("verify box.obj same.json", 0);
}

#[test]
fn a_changed_scene_is_told() {
    let folder = folder("scene");
    folder.run("contour box.obj --eye 278,273,-100 --sphere --certificate kept.json", 0);
    let message = folder.run("verify room.obj kept.json", 1);
    assert!(message.contains("28 vertices, 16 polygons and 17 convex pieces") && message.contains("150 polygons"));
    // A triangle in front of a square moves behind it, in the same directions.
    let scene = |z: f64| {
        let square = "v -5 -5 2\nv 5 -5 2\nv 5 5 2\nv -5 5 2\nf 1 2 3 4\n";
        format!("{square}v 0 0 {z}\nv {z} 0 {z}\nv 0 {z} {z}\nf 5 6 7\n")
    };
    folder.write("two.obj", scene(1.0));
    folder.run("contour two.obj --eye 0,0,0 --normal 0,0,1 --free --certificate two.json", 0);
    folder.write("two.obj", scene(3.0));
    let message = folder.run("verify two.obj two.json", 1);
    assert!(message.contains("two.json: the certificate does not hold for two.obj: "), "{message}");
    assert!(message.contains("shows piece 1, which piece 0 hides") && message.contains("was changed"), "{message}");
    // Colours are not part of the claim.
    let library = fs::read_to_string(folder.path("box.mtl")).expect("written");
    folder.write("box.mtl", library.replace("Kd", "# Kd"));
    folder.run("verify box.obj kept.json", 0);
}

#[test]
fn files_that_are_no_certificates_are_refused_with_their_name() {
    let folder = folder("bad");
    folder.run("contour box.obj --eye 278,273,-100 --sphere --certificate kept.json -o image.json", 0);
    let kept = fs::read(folder.path("kept.json")).expect("written");
    folder.write("empty.json", "");
    folder.write("cut.json", &kept[..kept.len() * 2 / 3]);
    folder.write("bytes.json", [0xff, 0, 0x80]);
    folder.write("deep.json", "[".repeat(1_000_000));
    for (file, named) in [
        ("nowhere.json", "cannot read nowhere.json"),
        ("image.json", "image.json: it is no certificate, or a damaged one: its schema is \"nusselt.contour/1\""),
        ("box.mtl", "box.mtl: it is no certificate"),
        ("empty.json", "the file ends in the midst of"),
        ("cut.json", "the file ends in the midst of"),
        ("bytes.json", "bytes.json: it is no certificate"),
        ("deep.json", "deep.json: it is no certificate"),
        (".", "not a regular file"),
    ] {
        let message = folder.run(&format!("verify box.obj {file}"), 1);
        assert!(message.contains(named), "{file}: {message}");
    }
    assert!(folder.run("verify nowhere.obj kept.json", 1).contains("nowhere.obj"));
}
