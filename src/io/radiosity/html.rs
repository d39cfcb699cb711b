//! A page that shows a surface, all in one file.

use crate::io::number::{Shortest, single};
use crate::radiosity::Surface;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use glam::DVec3;
use rustc_hash::FxHashMap;
use std::f64::consts::PI;
use std::io::{self, Write};

const PAGE: &str = include_str!("viewer.html");

/// Writes a page with the surface in it, which any browser with WebGL shows without a network: turned by dragging, nearer and farther by the wheel, with
/// the exposure, the edges of patches, backs, and what is up to choose. Radiances are floats, times `exposure`; `up` is what it starts with, a direction of any length.
///
/// # Errors
/// Those of `out`, or if there are more corners than 2^32.
///
/// # Panics
/// If `up` is zero or not finite.
pub fn write_radiosity_html(
    surface: &Surface,
    title: &str,
    exposure: f64,
    up: DVec3,
    out: &mut impl Write,
) -> io::Result<()> {
    let up = (up / up.abs().max_element()).normalize();
    assert!(up.is_finite(), "a direction");
    let (low, high) = surface
        .positions
        .iter()
        .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), &p| (low.min(p), high.max(p)));
    let middle = low.midpoint(high);
    let half = high * 0.5 - low * 0.5;
    // Corners are to be within 1 of the origin, whatever the unit: squares of lengths need not be numbers.
    let most = half.max_element();
    let length = (half / most).length();
    let placed = |p: DVec3| if most > 0.0 { (p - middle) / most / length } else { DVec3::ZERO };
    let floats = |vectors: &mut dyn Iterator<Item = DVec3>| {
        let bytes = vectors.flat_map(|v| v.to_array().map(single)).flat_map(f32::to_le_bytes);
        STANDARD.encode(bytes.collect::<Vec<u8>>())
    };
    let integers = |numbers: &mut dyn Iterator<Item = u32>| {
        STANDARD.encode(numbers.flat_map(u32::to_le_bytes).collect::<Vec<u8>>())
    };
    let positions = floats(&mut surface.positions.iter().map(|&p| placed(p)));
    let radiances = floats(&mut surface.radiosity.iter().map(|&b| b / PI * exposure));
    let triangles = integers(&mut surface.triangles.iter().flatten().copied());
    let edges = integers(&mut edges(surface).into_iter().flatten());
    let fields = [
        ("{{title}}", escaped(title)),
        ("{{up}}", format!("{},{},{}", Shortest(up.x), Shortest(up.y), Shortest(up.z))),
        ("{{positions}}", positions),
        ("{{radiances}}", radiances),
        ("{{triangles}}", triangles),
        ("{{edges}}", edges),
    ];
    let mut rest = PAGE;
    while let Some((start, (mark, value))) =
        fields.iter().filter_map(|field| Some((rest.find(field.0)?, field))).min_by_key(|(start, _)| *start)
    {
        out.write_all(&rest.as_bytes()[..start])?;
        out.write_all(value.as_bytes())?;
        rest = &rest[start + mark.len()..];
    }
    out.write_all(rest.as_bytes())
}

/// The sides of triangles beside which there is no other triangle of the same patch.
fn edges(surface: &Surface) -> Vec<[u32; 2]> {
    let mut count: FxHashMap<(u32, [u32; 2]), u32> = FxHashMap::default();
    let sides = surface
        .triangles
        .iter()
        .zip(&surface.patches)
        .flat_map(|(&[a, b, c], patch)| [[a, b], [b, c], [c, a]].map(|[p, q]| (patch.0, [p.min(q), p.max(q)])));
    for side in sides {
        *count.entry(side).or_default() += 1;
    }
    let mut edges: Vec<[u32; 2]> = count.into_iter().filter(|(_, n)| *n == 1).map(|((_, edge), _)| edge).collect();
    edges.sort_unstable();
    edges.dedup();
    edges
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
