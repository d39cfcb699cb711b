//! `nusselt radiosity` on the command line.
#![cfg(feature = "cli")]

mod common;

use common::program::Folder;
use serde_json::Value;
use std::path::Path;
use std::process::Command;

fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

#[test]
fn the_cornell_box_is_solved_into_files_of_all_kinds() {
    let folder = Folder::new("radiosity");
    let line = "radiosity box.obj --patch 300 --tolerance 1e-2 --until 0.02 --depth 1 --detail 0.2";
    let summary = folder.parsed(&format!("{line} -o a.glb -o a.ply -o a.html -o a.json --json"));
    assert_eq!(summary["schema"], "nusselt.radiosity/1");
    assert!(number(&summary["unshot"]) <= 0.02 && number(&summary["defect"]) < 1e-12, "{summary}");
    let table: Value = serde_json::from_str(&folder.read("a.json")).expect("JSON");
    let patches = table["patches"].as_array().expect("rows");
    assert_eq!(patches.len() as u64, summary["patches"].as_u64().expect("a count"));
    assert!(patches.iter().all(|patch| number(&patch["radiosity"][0]) >= number(&patch["emission"][0])));
    let count = |file: &str| folder.parsed(&format!("info {file} --json"))["polygons"].as_u64().expect("a count");
    assert_eq!(count("a.glb"), count("a.ply"));
    assert!(count("a.ply") >= 2 * patches.len() as u64);
    let page = folder.read("a.html");
    assert!(page.starts_with("<!DOCTYPE html>") && !page.contains("{{") && page.trim_end().ends_with("</html>"));
    // z is up unless one says otherwise, and a key makes it -x, which comes next.
    let raised = |page: &str, axis: usize| {
        let Some(above) = shows_itself(&folder, page) else { return };
        // The eye is raised by 0.45 rad.
        assert!((above[axis].abs() - 0.45_f64.cos()).abs() < 1e-3, "{page}: {above:?}");
        assert!(above[axis] > 0.0 || page == "key.html", "{page}: {above:?}");
    };
    raised("a.html", 2);
    folder.run(&format!("{line} --up 0,2,0 -o up.html"), 0);
    raised("up.html", 1);
    let key = "<script>dispatchEvent(new KeyboardEvent('keydown', { key: 'u' }))</script></html>";
    folder.write("key.html", page.replace("</html>", key));
    raised("key.html", 0);
    // Files of glTF say that y is up.
    folder.write("lamp.gltf", LAMP);
    folder.run("radiosity lamp.gltf -o lamp.html", 0);
    raised("lamp.html", 1);
    // Two threads or one, and the same files.
    folder.run(&format!("{line} --threads 1 -o b.ply"), 0);
    assert_eq!(
        std::fs::read(folder.path("a.ply")).expect("a file"),
        std::fs::read(folder.path("b.ply")).expect("a file")
    );
}

const LAMP: &str = r#"{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
    "meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":0}]}],"materials":[{"emissiveFactor":[1,1,1]}],
    "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],"bufferViews":[{"buffer":0,"byteLength":36}],
    "buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]}"#;

/// Opens a page in Chromium, if that is there; gives the direction that points up on the screen.
fn shows_itself(folder: &Folder, page: &str) -> Option<[f64; 3]> {
    let Some(browser) = ["/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"]
        .into_iter()
        .find(|path| Path::new(path).exists())
    else {
        eprintln!("SKIPPED: there is no Chromium to show {page} with; install it to have the page tested");
        return None;
    };
    let profile = folder.path("profile");
    let output = Command::new(browser)
        .args(["--headless", "--no-sandbox", "--disable-gpu", "--use-gl=angle", "--use-angle=swiftshader"])
        .args(["--enable-unsafe-swiftshader", "--no-first-run", "--disable-background-networking", "--disable-quic"])
        .args(["--disable-component-update", "--disable-sync", "--virtual-time-budget=10000", "--dump-dom"])
        .arg(format!("--user-data-dir={}", profile.display()))
        .arg(format!("file://{}", folder.path(page).display()))
        .output()
        .expect("the browser runs");
    let shown = String::from_utf8_lossy(&output.stdout);
    let said = |name: &str| {
        let rest = shown.split(&format!("data-{name}=\"")).nth(1)?;
        rest.split('"').next()
    };
    assert_eq!(said("state"), Some("drawn"), "{}", String::from_utf8_lossy(&output.stderr));
    let above: Vec<f64> = said("above")?.split(',').map(|x| x.parse().expect("a number")).collect();
    Some(above.try_into().expect("three numbers"))
}

#[test]
fn a_kept_state_is_gone_on_from() {
    let folder = Folder::new("radiosity-state");
    let line = "radiosity box.obj --patch 300 --tolerance 1e-2";
    folder.run(&format!("{line} --until 0.3 --state a.state"), 0);
    let first = folder.parsed(&format!("{line} --until 0.05 --state a.state --resume -o a.json --json"));
    folder.run(&format!("{line} --until 0.05 -o b.json"), 0);
    assert_eq!(folder.read("a.json"), folder.read("b.json"));
    assert!(number(&first["unshot"]) <= 0.05);
    for (change, what) in [
        ("radiosity box.obj --patch 200 --tolerance 1e-2", "other patches"),
        ("radiosity box.obj --patch 300 --tolerance 1e-3", "another tolerance"),
        ("radiosity box.obj --patch 300 --tolerance 1e-2 --overshoot", "another --overshoot"),
        ("radiosity box.obj --patch 300 --tolerance 1e-2 --subdivide 1", "another --subdivide"),
    ] {
        let error = folder.run(&format!("{change} --state a.state --resume"), 1);
        assert!(error.contains(what), "{error}");
    }
    folder.write("a.state", "{\"schema\":");
    let error = folder.run(&format!("{line} --state a.state --resume"), 1);
    assert!(error.contains("a.state") && error.contains("start anew"), "{error}");
}

#[test]
fn halved_patches_are_gone_on_from_and_keep_all_power() {
    let folder = Folder::new("radiosity-subdivide");
    let line = "radiosity box.obj --patch 300 --tolerance 1e-2 --until 0.1 --gradient 0.4";
    let plain = folder.parsed(&format!("{line} --subdivide 0 -o a.json --json"));
    let halved = folder.parsed(&format!("{line} --subdivide 2 -o b.json -o b.ply --depth 0 --json"));
    let patches = |summary: &Value| summary["patches"].as_u64().expect("a count");
    assert!(patches(&halved) > patches(&plain) && patches(&halved) < 16 * patches(&plain));
    assert!(number(&halved["defect"]) < 1e-12 && number(&halved["unshot"]) <= 0.1, "{halved}");
    // Once, kept, and once more: the same as twice.
    folder.run(&format!("{line} --subdivide 1 --state a.state"), 0);
    folder.run(&format!("{line} --subdivide 2 --state a.state --resume -o c.json"), 0);
    assert_eq!(folder.read("b.json"), folder.read("c.json"));
    // Less often cannot be had from it, nor with another gradient.
    let error = folder.run(&format!("{line} --subdivide 1 --state a.state --resume"), 1);
    assert!(error.contains("--subdivide 2"), "{error}");
    let other = line.replace("0.4", "0.3");
    let error = folder.run(&format!("{other} --subdivide 2 --state a.state --resume"), 1);
    assert!(error.contains("--gradient"), "{error}");
}

#[test]
fn the_whole_matrix_is_gone_on_with() {
    use nusselt::factors::{Exchange, ExchangeOptions, PatchMesh};
    use nusselt::io::matrix::{MatrixJob, MatrixWriter};
    let folder = Folder::new("radiosity-full");
    let line = "radiosity box.obj --patch 300 --tolerance 1e-2 --full";
    folder.run(&format!("{line} -o a.json"), 0);
    folder.run(&format!("{line} --state b.state -o b.json"), 0);
    assert_eq!(folder.read("a.json"), folder.read("b.json"));
    let partial = "c.state.0.rows.partial";
    // As an interrupted run leaves it, and with a row that is wrong, so that one sees that rows are taken from there.
    let scene =
        nusselt::io::read_scene(&folder.path("box.obj"), &nusselt::io::ReadOptions::default()).expect("a scene").scene;
    let mesh = PatchMesh::new(&scene, 300.0).expect("a mesh");
    let patches = mesh.patches().expect("a scene");
    let options = ExchangeOptions { tolerance: 1e-2, ..ExchangeOptions::default() };
    let exchange = Exchange::of_mesh(&mesh, options).expect("patches");
    for is_wrong in [false, true] {
        let job = MatrixJob::new(&patches, exchange.patches()).with_option("--tolerance", 1e-2);
        let mut writer = MatrixWriter::create(&folder.path("c.state.0.rows"), &job).expect("a file");
        for patch in 0..9 {
            let mut row = exchange.row(patch).expect("a row");
            if is_wrong && patch == 5 {
                row.entries.clear();
                (row.backs.factor, row.background.factor) = (0.0, 1.0);
            }
            writer.row(&row).expect("written");
        }
        drop(writer);
        assert!(folder.path(partial).exists());
        folder.run(&format!("{line} --state c.state --resume -o c.json"), 0);
        assert_eq!(folder.read("a.json") != folder.read("c.json"), is_wrong);
        assert!(!folder.path(partial).exists(), "it is solved");
        std::fs::remove_file(folder.path("c.state")).expect("the solution");
    }
    // Rows of other patches are no use.
    let job = MatrixJob::new(&patches, exchange.patches()).with_option("--tolerance", 1e-3);
    drop(MatrixWriter::create(&folder.path("c.state.0.rows"), &job).expect("a file"));
    let error = folder.run(&format!("{line} --state c.state --resume"), 1);
    assert!(error.contains("c.state.0.rows") && error.contains("--tolerance"), "{error}");
    // Without --resume it starts anew.
    folder.run(&format!("{line} --state c.state -o c.json"), 0);
    assert_eq!(folder.read("a.json"), folder.read("c.json"));
}

#[test]
fn the_ambient_term_is_shown_and_not_counted() {
    let folder = Folder::new("radiosity-ambient");
    let line = "radiosity box.obj --patch 300 --tolerance 1e-2 --until 0.5 --depth 0 --exposure 1";
    folder.run(&format!("{line} -o a.json -o a.ply"), 0);
    folder.run(&format!("{line} --ambient -o b.json -o b.ply"), 0);
    let [plain, ambient]: [Value; 2] =
        ["a.json", "b.json"].map(|file| serde_json::from_str(&folder.read(file)).expect("JSON"));
    assert_eq!(plain["balance"], ambient["balance"]);
    let rows = |table: &Value| table["patches"].as_array().expect("rows").clone();
    for (a, b) in rows(&plain).iter().zip(&rows(&ambient)) {
        assert_eq!(a["radiosity"], b["radiosity"]);
        assert!(a.get("ambient").is_none());
        // All that reflects gets some.
        assert_eq!(number(&b["ambient"][0]) > 0.0, number(&b["reflectance"][0]) > 0.0);
    }
    assert_ne!(
        std::fs::read(folder.path("a.ply")).expect("a file"),
        std::fs::read(folder.path("b.ply")).expect("a file")
    );
}

#[test]
fn what_is_wrong_is_said_in_one_line() {
    let folder = Folder::new("radiosity-wrong");
    folder.write("dark.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    for (line, code, what) in [
        ("radiosity box.obj --patch 0", 2, "above 0"),
        ("radiosity box.obj --until 0", 2, "1e-13 to 1"),
        ("radiosity box.obj --until 0.1 --full", 2, "--full"),
        ("radiosity box.obj --resume", 2, "--state"),
        ("radiosity box.obj -o a.stl", 2, ".html"),
        ("radiosity box.obj -o a.glb -o a.glb", 2, "written twice"),
        ("radiosity box.obj --patch 1e-3", 1, "take a longer edge"),
        ("radiosity dark.obj", 1, "no polygon emits"),
        ("radiosity none.obj", 1, "none.obj"),
    ] {
        let error = folder.run(line, code);
        assert!(error.contains(what), "{line}: {error}");
    }
}
