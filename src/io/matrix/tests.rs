//! What files hold, and that interruptions, parts and damage change none of it.

use super::*;
use crate::factors::{Entry, PatchInfo, PatchShape, Row, Share};
use crate::scene::{Material, PolygonId, Scene};
use glam::DVec3;
use std::fs::{self, File, OpenOptions};
use std::io::Write;
use std::path::{Path, PathBuf};

const COUNT: u32 = 7;
#[cfg(feature = "parquet")]
const ENDINGS: [&str; 6] = ["json", "csv", "npy", "mtx", "rows", "parquet"];
#[cfg(not(feature = "parquet"))]
const ENDINGS: [&str; 5] = ["json", "csv", "npy", "mtx", "rows"];

struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("nusselt-matrix-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).expect("a folder for tests");
        Self(path)
    }

    fn at(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    fn read(&self, name: &str) -> Vec<u8> {
        fs::read(self.at(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    fn text(&self, name: &str) -> String {
        String::from_utf8(self.read(name)).expect("UTF-8")
    }

    fn names(&self) -> Vec<String> {
        let names = fs::read_dir(&self.0).expect("a folder").map(|file| file.expect("a file").file_name());
        let mut names: Vec<_> = names.map(|name| name.to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// Two triangles, the first with a corner at that height.
fn scene_with(height: f64, faces: [[usize; 3]; 2]) -> Scene {
    let corners = [[0.0, 0.0, height], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 2.0]];
    Scene::builder().mesh(&corners, &faces.map(Vec::from), Material::new("grey")).build().expect("a scene")
}

fn scene() -> Scene {
    scene_with(1.0, [[0, 1, 2], [1, 2, 3]])
}

fn patches() -> Vec<PatchInfo> {
    let patch = |k: u32| PatchInfo {
        name: format!("p{k}, \"{k}\""),
        polygon: PolygonId(k / 2),
        area: f64::from(k) / 3.0,
        shape: shape(k),
    };
    (0..COUNT).map(patch).collect()
}

/// None without area; otherwise one piece or two, with a normal or without.
fn shape(k: u32) -> Option<PatchShape> {
    let at = |x: u32, y: f64| DVec3::new(f64::from(x) / 7.0, y, -f64::from(k) / 8.0);
    let piece = |x: u32| vec![at(x, 0.0), at(x + 1, 0.0), at(x, 0.1)];
    let pieces = (0..=k % 2).map(|x| piece(3 * x)).collect();
    let normal = (!k.is_multiple_of(3)).then_some(DVec3::new(0.6, 0.0, -0.8));
    (k > 0).then(|| PatchShape { center: at(k, 0.05), normal, pieces })
}

fn share(k: u32) -> Share {
    Share { factor: f64::from(k + 1) / 97.0, error: f64::from(k) * 1e-7 }
}

/// Row 0 is that of a patch without area.
fn row(patch: u32) -> Row {
    let columns = (0..COUNT).filter(|column| patch > 0 && !(column * 3 + patch).is_multiple_of(4));
    let entries = columns.map(|column| Entry { column, share: share(patch * 10 + column) }).collect();
    let backs = if patch.is_multiple_of(3) { Share::default() } else { share(patch) };
    let background = if patch == 0 { Share::default() } else { share(patch + 40) };
    Row { patch, entries, backs, background, closure_raw: 1.0 + f64::from(patch) * 1e-6 }
}

fn job<'a>(scene: &'a Scene, patches: &'a [PatchInfo]) -> MatrixJob<'a> {
    MatrixJob::new(scene, patches).with_option("tolerance", 1e-4).with_option("patch", "polygon")
}

fn continued(mut writer: MatrixWriter, until: u32) -> MatrixWriter {
    while writer.next_row() < until {
        writer.row(&row(writer.next_row())).expect("the next row");
    }
    writer
}

fn write_whole(path: &Path) {
    let (scene, patches) = (scene(), patches());
    let writer = MatrixWriter::create(path, &job(&scene, &patches)).expect("a new file");
    assert_eq!((writer.next_row(), writer.end_row()), (0, COUNT));
    continued(writer, COUNT).finish().expect("complete");
}

fn write_part(path: &Path, rows: std::ops::Range<u32>) {
    let (scene, patches) = (scene(), patches());
    let writer = MatrixWriter::create(path, &job(&scene, &patches).with_rows(rows.clone())).expect("a new file");
    continued(writer, rows.end).finish().expect("complete");
}

/// All numbers of the matrix, backs and background last.
fn dense() -> Vec<Vec<f64>> {
    let of = |patch| {
        let row = row(patch);
        let mut numbers = vec![0.0; COUNT as usize + 2];
        for entry in &row.entries {
            numbers[entry.column as usize] = entry.share.factor;
        }
        numbers[COUNT as usize..].copy_from_slice(&[row.backs.factor, row.background.factor]);
        numbers
    };
    (0..COUNT).map(of).collect()
}

#[test]
fn npy_is_a_dense_array_with_backs_and_background_last() {
    let folder = Folder::new("npy");
    write_whole(&folder.at("m.npy"));
    let bytes = folder.read("m.npy");
    assert_eq!(&bytes[..8], b"\x93NUMPY\x01\x00");
    let start = 10 + usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
    assert_eq!(start % 64, 0);
    let header = std::str::from_utf8(&bytes[10..start]).expect("text");
    assert_eq!(header.trim_end(), "{'descr': '<f8', 'fortran_order': False, 'shape': (7, 9), }");
    assert!(header.ends_with('\n'));
    let numbers: Vec<f64> =
        bytes[start..].chunks(8).map(|b| f64::from_le_bytes(b.try_into().expect("eight bytes"))).collect();
    assert_eq!(numbers, dense().concat());
}

#[test]
fn mtx_counts_its_entries_from_one() {
    let folder = Folder::new("mtx");
    write_whole(&folder.at("m.mtx"));
    let text = folder.text("m.mtx");
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("%%MatrixMarket matrix coordinate real general"));
    let mut lines = lines.filter(|line| !line.starts_with('%'));
    let numbers = |line: &str| line.split(' ').map(|word| word.parse().expect("a number")).collect::<Vec<f64>>();
    let size = numbers(lines.next().expect("a size"));
    let entries: Vec<_> = lines.map(numbers).collect();
    assert_eq!(size, [7.0, 9.0, entries.len() as f64]);
    let mut read = vec![vec![0.0; 9]; 7];
    for entry in entries {
        read[entry[0] as usize - 1][entry[1] as usize - 1] = entry[2];
    }
    assert_eq!(read, dense());
}

#[test]
fn csv_names_backs_and_background_and_tells_errors() {
    let folder = Folder::new("csv");
    write_whole(&folder.at("m.csv"));
    let text = folder.text("m.csv");
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("row,column,factor,error"));
    let mut expected = Vec::new();
    for row in (0..COUNT).map(row) {
        expected.extend(row.entries.iter().map(|e| (row.patch, e.column.to_string(), e.share)));
        expected
            .extend([("backs", row.backs), ("background", row.background)].map(|(n, s)| (row.patch, n.to_owned(), s)));
    }
    expected.retain(|(_, _, share)| share.factor > 0.0);
    let read = lines.map(|line| {
        let fields: Vec<_> = line.split(',').collect();
        let [factor, error] = [2, 3].map(|k| fields[k].parse().expect("a number"));
        (fields[0].parse().expect("a number"), fields[1].to_owned(), Share { factor, error })
    });
    assert_eq!(read.collect::<Vec<_>>(), expected);
}

#[test]
fn json_keeps_to_its_schema() {
    let folder = Folder::new("json");
    write_whole(&folder.at("m.json"));
    let file: serde_json::Value = serde_json::from_slice(&folder.read("m.json")).expect("JSON");
    assert_eq!(file["schema"], FORM_FACTORS_SCHEMA);
    let list = |name: &str| file[name].as_array().unwrap_or_else(|| panic!("{name}")).clone();
    for (read, patch) in list("patches").iter().zip(patches()) {
        let (shape, point) = (patch.shape.as_ref(), |p: DVec3| p.to_array());
        assert_eq!(
            *read,
            serde_json::json!({
                "name": patch.name, "polygon": patch.polygon.0, "area": patch.area,
                "center": shape.map(|shape| point(shape.center)),
                "normal": shape.and_then(|shape| shape.normal).map(point),
                "boundary": shape.filter(|shape| shape.pieces.len() == 1)
                    .map(|shape| shape.pieces[0].iter().map(|&p| point(p)).collect::<Vec<_>>()),
            })
        );
    }
    let rows: Vec<Row> = (0..COUNT).map(row).collect();
    let entries =
        rows.iter().flat_map(|row| row.entries.iter().map(|e| (row.patch, e.column, e.share.factor, e.share.error)));
    assert_eq!(file["factors"], serde_json::json!(entries.collect::<Vec<_>>()));
    for (name, of) in [
        ("backs", &(|row: &Row| row.backs.factor) as &dyn Fn(&Row) -> f64),
        ("background", &|row| row.background.factor),
        ("row_sums", &|row| row.sum() + 0.0),
        ("closure_raw", &|row| row.closure_raw),
    ] {
        assert_eq!(list(name).len(), COUNT as usize, "{name}");
        assert_eq!(file[name], serde_json::json!(rows.iter().map(of).collect::<Vec<_>>()), "{name}");
    }
}

#[test]
fn patches_are_told_apart_in_the_order_of_rows() {
    let folder = Folder::new("patches");
    write_part(&folder.at("a.rows"), 0..2);
    let kept = read_patches(&folder.at("a.rows")).expect("patches");
    assert_eq!(kept, patches(), "what is read is what was written");
    let written = |name: &str| {
        let mut bytes = Vec::new();
        PatchesFormat::of(Path::new(name)).expect("known").write(&kept, &mut bytes).expect("memory");
        String::from_utf8(bytes).expect("UTF-8")
    };
    let table = written("a.CSV");
    let lines: Vec<&str> = table.lines().collect();
    assert_eq!(lines.len(), 1 + COUNT as usize);
    assert_eq!(lines[0], "row,name,polygon,area,center_x,center_y,center_z,normal_x,normal_y,normal_z");
    assert_eq!(lines[1], "0,\"p0, \"\"0\"\"\",0,0,,,,,,");
    assert_eq!(lines[4], "3,\"p3, \"\"3\"\"\",1,1,0.42857142857142855,0.05,-0.375,,,");
    assert!(lines[2].ends_with(",0.6,0,-0.8"), "{}", lines[2]);
    // A group for each, empty for what has no area.
    let drawn = written("a.obj");
    let groups: Vec<&str> = drawn.lines().filter(|line| line.starts_with('g')).collect();
    assert_eq!(groups, (0..COUNT).map(|k| format!("g patch_{k}")).collect::<Vec<_>>());
    let scene = crate::io::obj::parse(drawn.as_bytes(), "a.obj", &crate::io::ReadOptions::default(), |_| {
        Err(std::io::Error::other("nothing is to be loaded"))
    });
    let scene = scene.expect("it is read again").scene;
    let pieces: Vec<_> = kept.iter().filter_map(|patch| patch.shape.as_ref()).flat_map(|shape| &shape.pieces).collect();
    assert_eq!(scene.polygon_count(), pieces.len());
    for (polygon, piece) in scene.polygons().zip(pieces) {
        assert_eq!(&polygon.rings()[0].iter().map(|&id| scene.vertex(id)).collect::<Vec<_>>(), piece);
    }
    assert_eq!(PatchesFormat::of(Path::new("a.npy")), None);
}

#[cfg(feature = "parquet")]
#[test]
fn parquet_has_the_rows_of_the_csv() {
    use ::parquet::file::reader::SerializedFileReader;
    use ::parquet::record::RowAccessor;
    let folder = Folder::new("parquet");
    write_whole(&folder.at("m.csv"));
    write_whole(&folder.at("m.parquet"));
    let reader = SerializedFileReader::new(File::open(folder.at("m.parquet")).expect("a file")).expect("Parquet");
    let mut text = "row,column,factor,error\n".to_owned();
    for row in reader {
        let row = row.expect("a row");
        let numbers = [2, 3].map(|k| super::super::number::Shortest(row.get_double(k).expect("real")).to_string());
        let (number, column) = (row.get_long(0).expect("whole"), row.get_string(1).expect("text"));
        text += &[&number.to_string(), column, &numbers[0], &numbers[1]].map(String::as_str).join(",");
        text.push('\n');
    }
    assert_eq!(text, folder.text("m.csv"));
}

#[test]
fn only_the_final_file_is_left() {
    let folder = Folder::new("left");
    for ending in ENDINGS {
        write_whole(&folder.at(&format!("m.{ending}")));
    }
    let mut expected = ENDINGS.map(|ending| format!("m.{ending}"));
    expected.sort();
    assert_eq!(folder.names(), expected);
}

#[test]
fn interrupted_and_resumed_is_uninterrupted_byte_by_byte() {
    let folder = Folder::new("resume");
    let (scene, patches) = (scene(), patches());
    let job = job(&scene, &patches);
    for ending in ENDINGS {
        write_whole(&folder.at(&format!("whole.{ending}")));
        let (path, partial) = (folder.at(&format!("m.{ending}")), folder.at(&format!("m.{ending}.partial")));
        for rows in [0, 1, 4, COUNT] {
            // Cut off by some bytes too, as when a machine stops while writing.
            for lost in [0, 1, 9, 30, 1_000_000] {
                let writer = MatrixWriter::create(&path, &job).expect("nothing is in the way");
                let head = fs::metadata(&partial).expect("rows").len();
                drop(continued(writer, rows));
                let length = fs::metadata(&partial).expect("rows").len();
                let file = OpenOptions::new().write(true).open(&partial).expect("rows");
                file.set_len(length.saturating_sub(lost).max(head)).expect("shorter");
                let manifest: Manifest =
                    serde_json::from_slice(&folder.read(&format!("m.{ending}.manifest.json"))).expect("a manifest");
                assert_eq!(manifest, job.manifest().expect("good"));

                let mut there = Vec::new();
                let writer = MatrixWriter::resume_with(&path, &job, |row| there.push(row.clone()));
                let kept = writer.as_ref().expect("the same run").next_row();
                assert_eq!(there, (0..kept).map(row).collect::<Vec<_>>());
                let writer = writer.expect("the same run");
                assert!(if lost == 0 { kept == rows } else { kept <= rows.saturating_sub(1) }, "{rows} {lost} {kept}");
                drop(continued(writer, COUNT.min(kept + 1)));
                let writer = MatrixWriter::resume(&path, &job).expect("the same run");
                continued(writer, COUNT).finish().expect("complete");
                assert_eq!(folder.read(&format!("m.{ending}")), folder.read(&format!("whole.{ending}")));
                fs::remove_file(&path).expect("it is there");
            }
        }
    }
    // Nothing to resume is a start.
    assert_eq!(MatrixWriter::resume(&folder.at("new.csv"), &job).expect("a start").next_row(), 0);
}

#[test]
fn a_damaged_row_and_what_follows_it_are_computed_again() {
    let folder = Folder::new("torn");
    let (scene, patches) = (scene(), patches());
    let job = job(&scene, &patches);
    write_whole(&folder.at("whole.csv"));
    let partial = folder.at("m.csv.partial");
    let writer = MatrixWriter::create(&folder.at("m.csv"), &job).expect("a new file");
    let head = fs::metadata(&partial).expect("rows").len() as usize;
    drop(continued(writer, COUNT));
    let good = fs::read(&partial).expect("rows");
    for place in head..good.len() {
        let mut bad = good.clone();
        bad[place] ^= 0x10;
        fs::write(&partial, &bad).expect("written");
        let writer = MatrixWriter::resume(&folder.at("m.csv"), &job).expect("the same run");
        assert!(writer.next_row() < COUNT, "{place}");
        drop(continued(writer, COUNT));
        assert_eq!(fs::read(&partial).expect("rows"), good, "{place}");
    }
}

#[test]
fn another_run_is_not_resumed_and_what_differs_is_said() {
    let folder = Folder::new("changed");
    let (scene, patches) = (scene(), patches());
    let path = folder.at("m.rows");
    let good = job(&scene, &patches);
    drop(continued(MatrixWriter::create(&path, &good).expect("a new file"), 3));
    let error = MatrixWriter::create(&path, &good).expect_err("in the way");
    assert!(matches!(error, MatrixError::Unfinished { .. }) && error.to_string().contains("m.rows.partial"), "{error}");

    let moved = scene_with(1.0 + 1e-15, [[0, 1, 2], [1, 2, 3]]);
    let mut renamed = patches.clone();
    renamed[2].name.push('x');
    let mut turned = patches.clone();
    turned[2].shape.as_mut().expect("it has area").pieces[0].reverse();
    for (other, said) in [
        (job(&moved, &patches), "the scene is another one"),
        (good.clone().with_option("tolerance", 1e-3), "tolerance was 0.0001, and is 0.001"),
        (good.clone().with_option("two-sided", true), "two-sided was not given, and is true"),
        (good.clone().with_rows(0..3), "the rows were 0..7, and are 0..3"),
        (job(&scene, &patches[..6]), "the number of patches was 7, and is 6"),
        (job(&scene, &renamed), "names, polygons, areas or shapes of patches are others"),
        (job(&scene, &turned), "names, polygons, areas or shapes of patches are others"),
    ] {
        let error = MatrixWriter::resume(&path, &other).expect_err(said);
        assert!(matches!(&error, MatrixError::Changed { .. }) && error.to_string().contains(said), "{error}");
    }
    // Nothing of it was lost.
    assert_eq!(MatrixWriter::resume(&path, &good).expect("the same run").next_row(), 3);
}

#[test]
fn merged_parts_are_the_whole_byte_by_byte() {
    let folder = Folder::new("merge");
    let parts = [(0..2, "a"), (2..3, "b"), (3..7, "c")].map(|(rows, name)| {
        let path = folder.at(&format!("{name}.rows"));
        write_part(&path, rows);
        path
    });
    for ending in ENDINGS {
        write_whole(&folder.at(&format!("whole.{ending}")));
        for order in [[0, 1, 2], [2, 0, 1]] {
            let parts = order.map(|k| parts[k].clone());
            merge(&parts, &folder.at(&format!("m.{ending}"))).expect("all rows once");
            assert_eq!(folder.read(&format!("m.{ending}")), folder.read(&format!("whole.{ending}")));
        }
    }
    merge(&[folder.at("whole.rows")], &folder.at("again.mtx")).expect("one part with all rows");
    assert_eq!(folder.read("again.mtx"), folder.read("whole.mtx"));
}

#[test]
fn parts_that_do_not_go_together_are_refused() {
    let folder = Folder::new("refuse");
    let at = |name: &str| folder.at(&format!("{name}.rows"));
    for (rows, name) in [(0..3, "a"), (2..7, "b"), (3..5, "c"), (5..7, "d")] {
        write_part(&at(name), rows);
    }
    let (scene, patches) = (scene(), patches());
    let other = job(&scene, &patches).with_option("tolerance", 0.5).with_rows(3..7);
    continued(MatrixWriter::create(&at("e"), &other).expect("a new file"), 7).finish().expect("complete");
    let refused = |names: &[&str]| {
        let parts: Vec<_> = names.iter().map(|name| at(name)).collect();
        merge(&parts, &folder.at("m.csv")).expect_err("refused")
    };
    assert!(matches!(refused(&[]), MatrixError::NoParts));
    assert!(matches!(refused(&["c", "d"]), MatrixError::Gap { rows } if rows == (0..3)));
    assert!(matches!(refused(&["a", "d"]), MatrixError::Gap { rows } if rows == (3..5)));
    assert!(matches!(refused(&["c", "a"]), MatrixError::Gap { rows } if rows == (5..7)));
    assert!(matches!(refused(&["b", "a"]), MatrixError::Overlap { rows, .. } if rows == (2..3)));
    assert!(matches!(refused(&["a", "c", "d", "c"]), MatrixError::Overlap { rows, .. } if rows == (3..5)));
    let error = refused(&["a", "e"]);
    assert!(
        matches!(error, MatrixError::OtherMatrix { .. })
            && error.to_string().contains("tolerance was 0.0001, and is 0.5"),
        "{error}"
    );
    assert!(matches!(merge(&[at("a")], &at("a")), Err(MatrixError::WouldOverwrite { .. })));
    assert!(matches!(merge(&[folder.at("none.rows")], &at("m")), Err(MatrixError::Io { .. })));
    assert!(matches!(merge(std::slice::from_ref(&folder.0), &at("m")), Err(MatrixError::Io { .. })));
    assert!(!folder.names().iter().any(|name| name.starts_with("m.") || name.contains(".tmp")), "{:?}", folder.names());
}

#[test]
fn rows_and_ranges_that_cannot_be_are_refused() {
    let folder = Folder::new("bad");
    let (scene, patches) = (scene(), patches());
    let good = job(&scene, &patches);
    let create = |name: &str, job: &MatrixJob<'_>| MatrixWriter::create(&folder.at(name), job);
    assert!(matches!(create("m.txt", &good), Err(MatrixError::UnknownEnding { .. })));
    assert!(matches!(create("m.csv", &good.clone().with_rows(0..3)), Err(MatrixError::PartFormat { .. })));
    let reversed = std::ops::Range { start: 3, end: 2 };
    for rows in [0..8, 3..3, 8..9, reversed] {
        assert!(matches!(create("m.rows", &good.clone().with_rows(rows)), Err(MatrixError::BadRange { count: 7, .. })));
    }
    for area in [f64::INFINITY, f64::NAN, 0.0] {
        let mut huge = patches.clone();
        huge[3].area = area;
        assert!(matches!(create("m.csv", &job(&scene, &huge)), Err(MatrixError::BadArea { patch: 3, .. })), "{area}");
    }
    assert_eq!(folder.names(), [""; 0]);
    let mut writer = create("m.csv", &good).expect("a new file");
    assert!(matches!(writer.row(&row(1)), Err(MatrixError::OutOfOrder { expected: 0, found: 1 })));
    let bad = |change: &dyn Fn(&mut Row)| {
        let mut row = Row { patch: 0, ..row(4) };
        change(&mut row);
        row
    };
    for row in [
        bad(&|row| row.entries[1].share.factor = f64::NAN),
        bad(&|row| row.entries[1].share.error = f64::INFINITY),
        bad(&|row| row.background.factor = f64::NAN),
        bad(&|row| row.closure_raw = f64::NEG_INFINITY),
        bad(&|row| row.entries[1].column = row.entries[0].column),
        bad(&|row| row.entries.last_mut().expect("entries").column = COUNT),
    ] {
        assert!(matches!(writer.row(&row), Err(MatrixError::BadRow { row: 0, .. })), "{row:?}");
    }
    // None of it did any harm.
    let writer = continued(writer, 2);
    assert!(matches!(writer.finish(), Err(MatrixError::Incomplete { missing }) if missing == (2..7)));
    let mut writer = continued(MatrixWriter::resume(&folder.at("m.csv"), &good).expect("the same run"), COUNT);
    assert!(matches!(writer.row(&row(COUNT)), Err(MatrixError::OutOfOrder { .. })));
    writer.finish().expect("complete");
    write_whole(&folder.at("whole.csv"));
    assert_eq!(folder.read("m.csv"), folder.read("whole.csv"));
}

#[test]
fn no_patches_are_a_matrix_too() {
    let folder = Folder::new("empty");
    let scene = scene();
    for ending in ENDINGS {
        let path = folder.at(&format!("m.{ending}"));
        MatrixWriter::create(&path, &MatrixJob::new(&scene, &[])).expect("a new file").finish().expect("complete");
        merge(&[folder.at("m.rows")], &folder.at("x.csv")).ok();
    }
    let file: serde_json::Value = serde_json::from_slice(&folder.read("m.json")).expect("JSON");
    assert_eq!((&file["patches"], &file["row_sums"]), (&serde_json::json!([]), &serde_json::json!([])));
    assert!(folder.text("m.mtx").ends_with("\n0 2 0\n") && folder.text("m.csv") == "row,column,factor,error\n");
}

#[test]
fn damaged_files_of_rows_are_refused_and_never_misread() {
    let folder = Folder::new("damage");
    write_whole(&folder.at("good.rows"));
    merge(&[folder.at("good.rows")], &folder.at("good.csv")).expect("all rows");
    let good = folder.read("good.rows");
    let refused = |bytes: &[u8], what: &str| {
        fs::write(folder.at("bad.rows"), bytes).expect("written");
        let error = merge(&[folder.at("bad.rows")], &folder.at("m.csv")).expect_err(what);
        assert!(matches!(error, MatrixError::Damaged { .. } | MatrixError::NotRows { .. }), "{what}: {error}");
    };
    for place in 0..good.len() {
        refused(&good[..place], &format!("cut off at {place}"));
        let mut bad = good.clone();
        bad[place] ^= 1 << (place % 8);
        refused(&bad, &format!("a bit at {place}"));
    }
    refused(&[&good[..], b"x"].concat(), "something after it");
    refused(&[&good[..], &good[good.len() - 100..]].concat(), "more after it");
    assert!(!folder.at("m.csv").exists());
}

/// A file of rows whose checksums are right, with some manifest and some records.
fn forged(manifest: &Manifest, records: &[&[u8]]) -> Vec<u8> {
    let mut bytes = record::MAGIC.to_vec();
    record::write(&mut bytes, &serde_json::to_vec(manifest).expect("JSON")).expect("memory");
    for record in records {
        record::write(&mut bytes, record).expect("memory");
    }
    bytes
}

#[test]
fn counts_that_lie_take_no_memory() {
    let folder = Folder::new("lies");
    let (scene, patches) = (scene(), patches());
    let manifest = job(&scene, &patches).manifest().expect("good");
    let most = Manifest { patches: u32::MAX, rows: [0, u32::MAX], ..manifest.clone() };
    let heads: Vec<Vec<u8>> = patches.iter().map(record::of_patch).collect();
    let heads: Vec<&[u8]> = heads.iter().map(Vec::as_slice).collect();
    // Of the last patch, with one piece of three corners: the counts of pieces, of corners, and of letters.
    let lie = |place: usize| {
        let mut bytes = heads[6].to_vec();
        bytes[place..place + 4].copy_from_slice(&u32::MAX.to_le_bytes());
        bytes
    };
    let end = heads[6].len();
    let [many_pieces, many_corners, long_name] = [end - 72 - 8, end - 72 - 4, 12].map(lie);
    let mut many = Vec::new();
    record::of_row(&row(0), &mut many);
    let place = many.len() - 4;
    many[place..].copy_from_slice(&u32::MAX.to_le_bytes());
    let mut other = Vec::new();
    record::of_row(&Row { entries: vec![Entry { column: 99, share: share(1) }], ..row(0) }, &mut other);
    let mut long = record::MAGIC.to_vec();
    long.extend(u64::MAX.to_le_bytes());
    long.extend([0; 64]);
    let with = |last: &[u8]| forged(&manifest, &[&heads[..], &[last]].concat());
    for bytes in [
        forged(&most, &heads),
        forged(&Manifest { rows: [5, 2], ..manifest.clone() }, &heads),
        forged(&Manifest { rows: [0, 8], ..manifest.clone() }, &heads),
        forged(&manifest, &heads[..3]),
        forged(&manifest, &[heads[0]; 7]),
        forged(&manifest, &[&b"x"[..]; 7]),
        forged(&manifest, &[&heads[..6], &[&many_pieces[..]]].concat()),
        forged(&manifest, &[&heads[..6], &[&many_corners[..]]].concat()),
        forged(&manifest, &[&heads[..6], &[&long_name[..]]].concat()),
        forged(&manifest, &[&heads[..6], &[&[heads[6], b"x"].concat()[..]]].concat()),
        with(&many),
        with(&other),
        with(b""),
        long,
    ] {
        fs::write(folder.at("bad.rows"), bytes).expect("written");
        let error = merge(&[folder.at("bad.rows")], &folder.at("m.npy")).expect_err("a lie");
        assert!(matches!(error, MatrixError::Damaged { .. }), "{error}");
    }
    // Without a manifest there is nothing to go by.
    let mut file = File::create(folder.at("bad.rows")).expect("a file");
    file.write_all(record::MAGIC).expect("written");
    assert!(matches!(merge(&[folder.at("bad.rows")], &folder.at("m.npy")), Err(MatrixError::Damaged { .. })));
}

#[test]
fn the_digest_of_a_scene_is_of_what_form_factors_depend_on() {
    let first = scene_digest(&scene());
    assert_eq!(scene_digest(&scene()), first, "built again");
    assert_eq!(scene_digest(&scene_with(1.0, [[0, 1, 2], [1, 2, 3]])), first);
    assert_ne!(scene_digest(&scene_with(1.0, [[1, 2, 3], [0, 1, 2]])), first, "other numbers");
    assert_ne!(scene_digest(&scene_with(1.0, [[0, 2, 1], [1, 2, 3]])), first, "turned over");
    assert_ne!(scene_digest(&scene_with(1.0_f64.next_up(), [[0, 1, 2], [1, 2, 3]])), first, "moved");
}
