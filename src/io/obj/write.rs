//! The OBJ writer.

use super::super::number::Shortest;
use super::printable;
use glam::DVec3;
use std::collections::HashMap;
use std::io::{self, Write};

/// Polygons under one name.
#[derive(Clone, Debug, PartialEq)]
pub struct Group {
    /// The name of the group.
    pub name: String,
    /// The name of its material, if it has one.
    pub material: Option<String>,
    /// The polygons, each counter-clockwise seen from its front.
    pub polygons: Vec<Vec<DVec3>>,
}

/// Writes groups of polygons as an OBJ file; `library` is the name of the MTL file with their materials.
///
/// Equal vertices are written once, in order of first use, and coordinates as the shortest numbers that
/// read as the same: what is read back is the same polygons in the same order, bit for bit.
///
/// # Errors
/// If writing fails, a coordinate is not finite, or a polygon has fewer than three vertices.
pub fn write(out: &mut impl Write, groups: &[Group], library: Option<&str>) -> io::Result<()> {
    let refuse = |what: String| Err(io::Error::new(io::ErrorKind::InvalidInput, what));
    if let Some(library) = library {
        writeln!(out, "mtllib {}", printable(library))?;
    }
    let mut known: HashMap<[u64; 3], usize> = HashMap::new();
    for group in groups {
        writeln!(out, "g {}", printable(&group.name))?;
        if let Some(material) = &group.material {
            writeln!(out, "usemtl {}", printable(material))?;
        }
        for polygon in &group.polygons {
            if polygon.len() < 3 {
                return refuse(format!("a polygon of group {} has {} vertices", group.name, polygon.len()));
            }
            let mut corners = Vec::with_capacity(polygon.len());
            for &p in polygon {
                if !p.is_finite() {
                    return refuse(format!("a vertex of group {} is not finite: {p}", group.name));
                }
                let next = known.len() + 1;
                let index = *known.entry(p.to_array().map(f64::to_bits)).or_insert(next);
                if index == next {
                    writeln!(out, "v {} {} {}", Shortest(p.x), Shortest(p.y), Shortest(p.z))?;
                }
                corners.push(index);
            }
            write!(out, "f")?;
            for index in corners {
                write!(out, " {index}")?;
            }
            writeln!(out)?;
        }
    }
    Ok(())
}
