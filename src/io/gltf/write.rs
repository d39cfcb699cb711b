//! The GLB writer: triangles with a colour, or with a colour for each vertex.

use super::glb::MAGIC;
use crate::scene::origin_near;
use glam::DVec3;
use serde_json::{Value, json};
use std::io::{self, Error, ErrorKind, Write};

/// Triangles under one name.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GlbMesh {
    /// The name of the node and of the mesh.
    pub name: String,
    /// The corners. The file has them as `f32`, from an origin that is near to all meshes: what is equal here stays equal there.
    pub positions: Vec<DVec3>,
    /// A colour for each corner, linear red, green and blue; empty for none.
    pub colors: Vec<[f32; 3]>,
    /// Corners of triangles by their numbers, counter-clockwise seen from their front.
    pub triangles: Vec<[u32; 3]>,
    /// A factor of all colours, linear.
    pub color: [f32; 3],
}

/// Writes meshes as a GLB file (glTF 2.0), each as a node of its own. Surfaces are shown as coloured, without light
/// (`KHR_materials_unlit`), from both sides; coordinates stay as they are, without a swap of axes. What is farther from the origin along an axis than it is long has nodes with a translation there, so that
/// corners are rounded by some 6e-8 of the size of all meshes, as in a city in the coordinates of its country, and not of their distance from the origin.
///
/// # Errors
/// If writing fails, a mesh has no triangles, [`check_positions`] refuses all corners, a colour is not finite, a triangle has a corner that is not there, there are
/// not as many colours as corners, or the file would be longer than 4 GiB.
pub fn write_glb(out: &mut impl Write, meshes: &[GlbMesh]) -> io::Result<()> {
    let invalid = |what: String| Error::new(ErrorKind::InvalidInput, what);
    let corners = || meshes.iter().flat_map(|mesh| &mesh.positions);
    let origin = origin(corners());
    check_about(origin, corners()).map_err(invalid)?;
    let mut binary = Binary::default();
    let (mut materials, mut nodes, mut all) = (Vec::<Value>::new(), Vec::new(), Vec::new());
    let mut colors: Vec<[u32; 3]> = Vec::new();
    for (mesh, k) in meshes.iter().zip(0..) {
        check(mesh).map_err(|what| invalid(format!("mesh {}: {what}", mesh.name)))?;
        let color = mesh.color.map(f32::to_bits);
        let material = colors.iter().position(|known| *known == color).unwrap_or(colors.len());
        if material == colors.len() {
            colors.push(color);
            let [r, g, b] = mesh.color;
            materials.push(json!({
                "pbrMetallicRoughness": { "baseColorFactor": [r, g, b, 1.0], "metallicFactor": 0.0, "roughnessFactor": 1.0 },
                "doubleSided": true, "extensions": { "KHR_materials_unlit": {} },
            }));
        }
        let positions: Vec<[f32; 3]> = mesh.positions.iter().map(|&p| (p - origin).as_vec3().to_array()).collect();
        let bound = |pick: fn(f32, f32) -> f32| {
            positions.iter().copied().reduce(|a, b| std::array::from_fn(|axis| pick(a[axis], b[axis])))
        };
        let at = binary.vectors(&positions, json!({ "min": bound(f32::min), "max": bound(f32::max) }));
        let mut attributes = json!({ "POSITION": at });
        if !mesh.colors.is_empty() {
            attributes["COLOR_0"] = json!(binary.vectors(&mesh.colors, json!({})));
        }
        let indices = binary.indices(&mesh.triangles);
        let primitive = json!({ "attributes": attributes, "indices": indices, "material": material, "mode": 4 });
        all.push(json!({ "name": mesh.name, "primitives": [primitive] }));
        let mut node = json!({ "name": mesh.name, "mesh": k });
        if origin != DVec3::ZERO {
            node["translation"] = json!(origin.to_array());
        }
        nodes.push(node);
    }
    let mut document = json!({
        "asset": { "version": "2.0", "generator": concat!("nusselt ", env!("CARGO_PKG_VERSION")) },
        "scene": 0, "scenes": [{}],
    });
    if !nodes.is_empty() {
        // Lists of glTF are not empty where they are there.
        document["scenes"][0]["nodes"] = (0..nodes.len()).collect();
        document["extensionsUsed"] = json!(["KHR_materials_unlit"]);
        for (name, list) in [
            ("nodes", nodes),
            ("meshes", all),
            ("materials", materials),
            ("accessors", binary.accessors),
            ("bufferViews", binary.views),
            ("buffers", vec![json!({ "byteLength": binary.bytes.len() })]),
        ] {
            document[name] = Value::Array(list);
        }
    }
    let mut text = serde_json::to_vec(&document)?;
    text.resize(text.len().next_multiple_of(4), b' ');
    let has_binary = !binary.bytes.is_empty();
    let length = 12 + 8 + text.len() + if has_binary { 8 + binary.bytes.len() } else { 0 };
    let number = |n: usize| {
        let n = u32::try_from(n).map_err(|_| Error::new(ErrorKind::InvalidInput, "GLB files hold at most 4 GiB"));
        n.map(u32::to_le_bytes)
    };
    out.write_all(MAGIC)?;
    out.write_all(&2u32.to_le_bytes())?;
    out.write_all(&number(length)?)?;
    out.write_all(&number(text.len())?)?;
    out.write_all(b"JSON")?;
    out.write_all(&text)?;
    if has_binary {
        out.write_all(&number(binary.bytes.len())?)?;
        out.write_all(b"BIN\0")?;
        out.write_all(&binary.bytes)?;
    }
    Ok(())
}

fn check(mesh: &GlbMesh) -> Result<(), String> {
    let count = mesh.positions.len();
    if mesh.triangles.is_empty() {
        return Err("it has no triangles".to_owned());
    }
    if let Some(corner) = mesh.triangles.iter().flatten().find(|&&corner| corner as usize >= count) {
        return Err(format!("a triangle has corner {corner}, but there are {count}"));
    }
    if !mesh.colors.is_empty() && mesh.colors.len() != count {
        return Err(format!("there are {} colours for {count} corners", mesh.colors.len()));
    }
    let colors = mesh.colors.iter().chain([&mesh.color]);
    if colors.flatten().any(|x| !x.is_finite()) {
        return Err("a colour is not finite".to_owned());
    }
    Ok(())
}

/// Checks that a file can show corners, the coordinates of which are `f32` there: at most 3.4e38, and at least 1e-30 for the largest.
///
/// # Errors
/// If it cannot.
pub fn check_positions(positions: &[DVec3]) -> Result<(), String> {
    check_about(origin(positions.iter()), positions.iter())
}

fn check_about<'a>(origin: DVec3, positions: impl Iterator<Item = &'a DVec3>) -> Result<(), String> {
    let mut most = 0.0;
    for p in positions {
        let off = *p - origin;
        if !p.as_vec3().is_finite() {
            return Err(format!("the corner {:?} is not finite as f32, of which GLB files are", p.to_array()));
        }
        most = off.abs().max_element().max(most);
    }
    if most > 0.0 && most < LEAST {
        return Err(format!("corners are {most:e} apart at most, too little for f32, of which GLB files are"));
    }
    Ok(())
}

/// Below this, numbers that are `f32` lose digits.
const LEAST: f64 = 1e-30;

/// What is to be the origin of corners.
fn origin<'a>(positions: impl Iterator<Item = &'a DVec3>) -> DVec3 {
    let [low, high] =
        positions.fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |[low, high], &p| [low.min(p), high.max(p)]);
    origin_near(low, high)
}

const FLOATS: u32 = 5126;
const INTEGERS: u32 = 5125;

/// The numbers of all meshes, and where they are.
#[derive(Default)]
struct Binary {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl Binary {
    /// The number of the accessor to vectors.
    fn vectors(&mut self, vectors: &[[f32; 3]], bounds: Value) -> usize {
        let numbers = vectors.iter().flatten().map(|x| x.to_le_bytes());
        let mut accessor = bounds;
        accessor["componentType"] = FLOATS.into();
        accessor["type"] = "VEC3".into();
        accessor["count"] = vectors.len().into();
        self.push(numbers, 34962, accessor)
    }

    fn indices(&mut self, triangles: &[[u32; 3]]) -> usize {
        let numbers = triangles.iter().flatten().map(|k| k.to_le_bytes());
        let accessor = json!({ "componentType": INTEGERS, "type": "SCALAR", "count": 3 * triangles.len() });
        self.push(numbers, 34963, accessor)
    }

    fn push(&mut self, numbers: impl Iterator<Item = [u8; 4]>, target: u32, mut accessor: Value) -> usize {
        let start = self.bytes.len();
        self.bytes.extend(numbers.flatten());
        accessor["bufferView"] = self.views.len().into();
        let length = self.bytes.len() - start;
        self.views.push(json!({ "buffer": 0, "byteOffset": start, "byteLength": length, "target": target }));
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::{ReadOptions, read_scene};

    fn square(name: &str) -> GlbMesh {
        GlbMesh {
            name: name.to_owned(),
            positions: vec![DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y],
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            color: [0.5, 0.25, 1.0],
            ..GlbMesh::default()
        }
    }

    #[test]
    fn what_is_written_is_read_again() {
        let colored = GlbMesh { colors: vec![[0.1, 0.2, 0.3]; 4], ..square("b") };
        let mut file = Vec::new();
        write_glb(&mut file, &[square("a"), colored]).expect("written");
        assert_eq!(file.len() % 4, 0);
        let path = std::env::temp_dir().join(format!("nusselt-glb-{}.glb", std::process::id()));
        std::fs::write(&path, &file).expect("a file");
        let loaded = read_scene(&path, &ReadOptions::default());
        std::fs::remove_file(&path).expect("removed");
        let scene = loaded.expect("read").scene;
        let names: Vec<&str> = scene.objects().iter().map(String::as_str).collect();
        assert_eq!((scene.polygon_count(), names), (4, vec!["a", "b"]));
        let corners: Vec<DVec3> = scene.pieces().nth(3).expect("a piece").points().collect();
        assert_eq!(corners, [DVec3::ZERO, DVec3::new(1.0, 1.0, 0.0), DVec3::Y]);
    }

    /// A square of 1 at the coordinates of a country, and one of 0.5 beside it: read again they are where they were, to rounding of f32 about their size.
    #[test]
    fn what_is_far_away_keeps_its_shape() {
        let place = DVec3::new(465_000.25, -5_432_000.5, 0.0);
        let moved = |mut mesh: GlbMesh, size: f64| {
            mesh.positions.iter_mut().for_each(|p| *p = *p * size + place);
            mesh
        };
        let meshes = [moved(square("a"), 1.0), moved(square("b"), 0.5)];
        let mut file = Vec::new();
        write_glb(&mut file, &meshes).expect("written");
        let path = std::env::temp_dir().join(format!("nusselt-far-{}.glb", std::process::id()));
        std::fs::write(&path, &file).expect("a file");
        let loaded = read_scene(&path, &ReadOptions::default());
        std::fs::remove_file(&path).expect("removed");
        let scene = loaded.expect("read").scene;
        let corners: Vec<DVec3> = scene.pieces().nth(3).expect("a piece").points().collect();
        assert_eq!(corners, [place, place + DVec3::new(0.5, 0.5, 0.0), place + DVec3::Y * 0.5]);
        // Nothing is moved that is about the origin, nor along an axis on which it is.
        let text = String::from_utf8_lossy(&file).into_owned();
        assert!(text.contains("\"translation\":[465000.25,-5432000.5,0.0]"), "{text}");
        let mut near = Vec::new();
        write_glb(&mut near, &[square("a")]).expect("written");
        assert!(!String::from_utf8_lossy(&near).contains("translation"));
        // What would be no more than a point is refused.
        let tiny = GlbMesh { positions: square("m").positions.iter().map(|&p| p * 1e-40).collect(), ..square("m") };
        let error = write_glb(&mut Vec::new(), &[tiny]).expect_err("refused").to_string();
        assert!(error.contains("corners are 1e-40 apart at most"), "{error}");
    }

    #[test]
    fn nothing_is_a_file_too_and_what_is_wrong_is_refused() {
        let mut file = Vec::new();
        write_glb(&mut file, &[]).expect("written");
        assert_eq!(&file[..4], MAGIC);
        let wrong = [
            (GlbMesh { triangles: vec![], ..square("m") }, "it has no triangles"),
            (GlbMesh { triangles: vec![[0, 1, 4]], ..square("m") }, "a triangle has corner 4, but there are 4"),
            (GlbMesh { colors: vec![[0.0; 3]], ..square("m") }, "there are 1 colours for 4 corners"),
            (GlbMesh { positions: vec![DVec3::MAX; 4], ..square("m") }, "is not finite as f32"),
            (GlbMesh { color: [f32::NAN; 3], ..square("m") }, "a colour is not finite"),
        ];
        for (mesh, what) in wrong {
            let error = write_glb(&mut Vec::new(), &[mesh]).expect_err("refused").to_string();
            assert!(error.contains(what) && (error.starts_with("mesh m: ") || what.contains("f32")), "{error}");
        }
    }
}
