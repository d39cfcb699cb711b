//! What the files hold.

use super::*;
use crate::contour::{Domain, SceneOrder, Viewpoint};
use crate::factors::PointSolver;
use crate::scene::Material;

fn scene() -> Scene {
    let square = |z: f64| [[-1.0, -1.0, z], [1.0, -1.0, z], [1.0, 1.0, z], [-1.0, 1.0, z]];
    let mut builder = Scene::builder();
    let names = ["near, \"low\"", "far"].map(|name| builder.add_object(name));
    let material = builder.add_material(Material::new("grey"));
    for (object, (z, reverse)) in names.into_iter().zip([(1.0, true), (-2.0, false)]) {
        let mut ring: Vec<usize> = square(z).iter().map(|&p| builder.add_vertex(p.into())).collect();
        if reverse {
            ring.reverse();
        }
        builder.add_face(crate::scene::FaceSpec { rings: vec![ring], object, material });
    }
    builder.build().expect("a scene")
}

fn file(format: PointFactorsFormat, by: By) -> (Vec<PointFactors>, Vec<u8>) {
    let scene = scene();
    let solver = PointSolver::new(SceneOrder::new(&scene), by);
    let views = [DVec3::Z, DVec3::NEG_Z, DVec3::X];
    let points: Vec<_> = views.map(|n| (Viewpoint::free(DVec3::ZERO), Domain::Hemisphere(n))).to_vec();
    let all = solver.solve_all(&points).expect("views");
    let mut writer = PointFactorsWriter::new(Vec::new(), format, &scene, by).expect("memory");
    for (factors, normal) in all.iter().zip(views) {
        writer.write(DVec3::ZERO, normal, factors).expect("memory");
    }
    assert_eq!(writer.count(), 3);
    (all, writer.finish().expect("memory"))
}

/// Lines as they must be.
fn expected(all: &[PointFactors], names: [&str; 2]) -> Vec<(i64, String, f64)> {
    let lines = all.iter().enumerate().flat_map(|(k, point)| {
        let factors = point.factors.iter().map(move |&(i, f)| (k as i64, names[i as usize].to_owned(), f));
        factors.chain([(k as i64, "background".to_owned(), point.background)])
    });
    lines.collect()
}

#[test]
fn csv_has_a_line_for_each_factor() {
    for (by, names) in [(By::Object, ["\"near, \"\"low\"\"\"", "far"]), (By::Polygon, ["0", "1"])] {
        let (all, bytes) = file(PointFactorsFormat::Csv, by);
        assert!(all[0].factors.len() == 1 && all[2].factors.len() == 2);
        let lines: Vec<String> = expected(&all, names).iter().map(|(k, name, f)| format!("{k},{name},{f}\n")).collect();
        assert_eq!(String::from_utf8(bytes).expect("UTF-8"), format!("point,name,factor\n{}", lines.concat()));
    }
}

#[cfg(feature = "json")]
#[test]
fn json_has_names_and_points_and_reads_back_bit_by_bit() {
    for (by, name) in [(By::Object, "object"), (By::Polygon, "polygon")] {
        let (all, bytes) = file(PointFactorsFormat::Json, by);
        let value: serde_json::Value = serde_json::from_slice(&bytes).expect("JSON");
        assert_eq!((&value["schema"], &value["by"]), (&POINT_FACTORS_SCHEMA.into(), &name.into()));
        assert_eq!(value["names"], serde_json::json!(["near, \"low\"", "far"]));
        let points = value["points"].as_array().expect("a list");
        assert_eq!(points.len(), all.len());
        for (point, factors) in points.iter().zip(&all) {
            let read = point["factors"].as_array().expect("a list").iter();
            let read = read.map(|f| (f[0].as_u64().expect("a number") as u32, f[1].as_f64().expect("a number")));
            assert_eq!(read.collect::<Vec<_>>(), factors.factors);
            assert_eq!(point["background"].as_f64(), Some(factors.background));
            assert!(point["on"].is_null() && point["point"] == serde_json::json!([0.0, 0.0, 0.0]));
        }
        assert_eq!(points[1]["normal"], serde_json::json!([0.0, 0.0, -1.0]));
    }
}

#[cfg(feature = "json")]
#[test]
fn no_points_are_json_too() {
    let scene = scene();
    let writer = PointFactorsWriter::new(Vec::new(), PointFactorsFormat::Json, &scene, By::Object).expect("memory");
    let value: serde_json::Value = serde_json::from_slice(&writer.finish().expect("memory")).expect("JSON");
    assert_eq!(value["points"], serde_json::json!([]));
}

#[cfg(feature = "parquet")]
#[test]
fn parquet_has_the_rows_of_the_csv() {
    use ::parquet::file::reader::{FileReader, SerializedFileReader};
    use ::parquet::record::RowAccessor;
    let (all, bytes) = file(PointFactorsFormat::Parquet, By::Object);
    let path = std::env::temp_dir().join(format!("nusselt-points-{}.parquet", std::process::id()));
    std::fs::write(&path, bytes).expect("a file for tests");
    let reader = SerializedFileReader::new(std::fs::File::open(&path).expect("it is there")).expect("Parquet");
    std::fs::remove_file(&path).expect("it is there");
    let rows = reader.get_row_iter(None).expect("rows").map(|row| {
        let row = row.expect("a row");
        (row.get_long(0).expect("whole"), row.get_string(1).expect("text").clone(), row.get_double(2).expect("real"))
    });
    assert_eq!(rows.collect::<Vec<_>>(), expected(&all, ["near, \"low\"", "far"]));
    let names: Vec<_> =
        reader.metadata().file_metadata().schema().get_fields().iter().map(|f| f.name().to_owned()).collect();
    assert_eq!(names, ["point", "name", "factor"]);
}
