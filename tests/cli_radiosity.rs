//! `nusselt radiosity` on the command line.
#![cfg(feature = "cli")]

mod common;

use common::browser::{shown, told};
use common::program::Folder;
use serde_json::Value;

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
    let key = "<script>window.requestAnimationFrame = draw => draw();dispatchEvent(new KeyboardEvent('keydown', { key: 'u' }))</script></html>";
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

/// The direction that points up on the screen when a page is shown, if there is a browser.
fn shows_itself(folder: &Folder, page: &str) -> Option<[f64; 3]> {
    Some(told(&shown(folder, page)?, "above").try_into().expect("three numbers"))
}

/// Works the page's controls one after the other and leaves what the picture was each time: the share of pixels that are not background, their mean,
/// and the share that differs from the first picture.
const CONTROLS: &str = r#"<script>
// A browser without a screen may be done before it has drawn: at once.
window.requestAnimationFrame = draw => draw();
const pixels = () => {
  const all = new Uint8Array(4 * canvas.width * canvas.height);
  gl.readPixels(0, 0, canvas.width, canvas.height, gl.RGBA, gl.UNSIGNED_BYTE, all);
  return all;
};
const form = document.querySelector("form");
const input = (id, change) => { change(document.getElementById(id)); form.dispatchEvent(new Event("input")); };
const mouse = (kind, type, what) => canvas.dispatchEvent(new kind(type, { cancelable: true, ...what }));
const steps = [
  () => {},
  () => input("exposure", it => it.value = -3),
  () => input("exposure", it => it.value = 0),
  () => input("edges", it => it.checked = true),
  () => input("edges", it => it.checked = false),
  () => mouse(PointerEvent, "pointermove", { buttons: 1, movementX: 90, movementY: 0 }),
  () => mouse(PointerEvent, "pointermove", { buttons: 1, movementX: -90, movementY: 0 }),
  () => mouse(WheelEvent, "wheel", { deltaY: -300 }),
];
{
  const report = [];
  let first;
  for (const step of steps) {
    step();
    const now = pixels();
    first ??= now;
    let [lit, sum, other] = [0, 0, 0];
    for (let k = 0; k < now.length; k += 4) {
      const is_lit = now[k] !== 32 || now[k + 1] !== 34 || now[k + 2] !== 37;
      lit += is_lit;
      sum += is_lit ? now[k] + now[k + 1] + now[k + 2] : 0;
      other += [0, 1, 2].some(c => now[k + c] !== first[k + c]);
    }
    report.push(lit / now.length * 4, sum / lit / 3, other / now.length * 4);
  }
  document.body.dataset.report = report;
}
</script></html>"#;

#[test]
fn a_page_shows_patches_and_answers_its_controls() {
    let folder = Folder::new("radiosity-page");
    folder.run("radiosity box.obj --patch 300 --tolerance 1e-2 --until 0.1 -o a.html", 0);
    let page = folder.read("a.html").replace("</html>", CONTROLS);
    folder.write("a.html", page);
    let Some(document) = shown(&folder, "a.html") else { return };
    let report = told(&document, "report");
    let steps: Vec<[f64; 3]> = report.chunks(3).map(|step| step.try_into().expect("three numbers")).collect();
    let [plain, dark, again, edges, without, turned, back, near] = steps.try_into().expect("all steps");
    let [lit, mean, _] = plain;
    assert!(lit > 0.05 && mean > 10.0, "something is seen: {report:?}");
    assert!(dark[1] < 0.8 * mean && dark[0] > 0.9 * lit, "exposure: {report:?}");
    assert!(edges[2] > 0.001 && edges[2] < 0.5 * lit && edges[1] < mean, "edges: {report:?}");
    assert!(turned[2] > 0.05, "turned: {report:?}");
    assert!(near[0] > 1.2 * lit, "nearer: {report:?}");
    // The same view has the same picture; turned back it may be off by rounding.
    assert!(again[2] == 0.0 && without[2] == 0.0 && back[2] < 0.01, "{report:?}");
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
    // It is told how many were halved, and that none is uneven if so.
    let counts: Vec<u64> = halved["halved"].as_array().expect("counts").iter().filter_map(Value::as_u64).collect();
    assert!(counts.len() == 2 && counts.iter().all(|&count| count > 0), "{halved}");
    assert_eq!(plain["halved"].as_array().map(Vec::len), Some(0), "{plain}");
    let told = folder.run(&line.replace("0.4", "1e9 --subdivide 1"), 0);
    assert!(told.contains("none, as no patch is uneven"), "{told}");
    // Once, kept, and once more: the same as twice.
    let told = folder.run(&format!("{line} --subdivide 1 --state a.state"), 0);
    assert!(told.contains(&format!("{} patches that were uneven; some may still be", counts[0])), "{told}");
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

/// A room in a unit in which numbers of GLB files end, or are all 0: it is refused before anything is written, and a page shows it as it does the same room in another unit.
#[test]
fn coordinates_beyond_single_precision() {
    let folder = Folder::new("radiosity-far");
    let room = |unit: f64| {
        let corner = |k: usize| [k & 1, k >> 1 & 1, k >> 2].map(|x| x as f64 * unit);
        let corners: Vec<String> = (0..8).map(corner).map(|[x, y, z]| format!("v {x:e} {y:e} {z:e}\n")).collect();
        let walls = "f 1 2 4 3\nf 1 5 6 2\nf 2 6 8 4\nf 4 8 7 3\nf 3 7 5 1\n";
        format!("mtllib room.mtl\n{}usemtl lamp\nf 5 7 8 6\nusemtl wall\n{walls}", corners.concat())
    };
    folder.write("room.mtl", "newmtl lamp\nKd .5 .5 .5\nKe 1 1 1\nnewmtl wall\nKd .5 .5 .5\n");
    let mut pages = Vec::new();
    for unit in [1.0, 2f64.powi(-300), 2f64.powi(300), 2f64.powi(500)] {
        folder.write("room.obj", room(unit));
        folder.run("radiosity room.obj -o room.html", 0);
        pages.push(folder.read("room.html"));
        assert!(pages[0] == pages[pages.len() - 1], "{unit:e}");
        let is_refused = unit.log2().abs() > 100.0;
        for line in ["radiosity room.obj -o room.json -o room.glb", "shadows room.obj --light 0,0,0 -o room.glb"] {
            let said = folder.run(line, i32::from(is_refused));
            assert_eq!(said.contains("of which GLB files are"), is_refused, "{line}: {said}");
            let json = folder.path("room.json");
            assert_eq!(json.exists(), !is_refused && line.contains("json"), "{line}");
            let _ = std::fs::remove_file(json);
        }
    }
}

/// A furnace of which hardly any light is taken.
#[test]
fn what_hardly_ends_is_refused() {
    let folder = Folder::new("radiosity-furnace");
    folder.write("f.mtl", "newmtl w\nKd .999999999999 .999999999999 .999999999999\nKe 1 1 1\n");
    folder.write(
        "f.obj",
        "mtllib f.mtl\nusemtl w\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 3 4\nf 1 4 2\nf 4 3 2\n",
    );
    let said = folder.run("radiosity f.obj", 1);
    assert!(said.contains("took less than 1e-9 from what is left; some surface has to reflect less"), "{said}");
}
