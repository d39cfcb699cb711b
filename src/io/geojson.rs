//! Visible regions as `GeoJSON` (RFC 7946).

use super::contour_json::{Share, domain_row, side_name};
use super::json::{field, rows};
use crate::contour::{ContourImage, FlatRegion, Projection, Projector};
use crate::scene::{PolygonId, PolygonRef, Side};
use glam::DVec2;
use serde::Serialize;
use std::collections::BTreeMap;
use std::io::{self, BufWriter, Write};

/// The schema's name.
pub const REGIONS_SCHEMA: &str = "nusselt.regions/1";

#[derive(Serialize)]
struct Feature<'a> {
    r#type: &'static str,
    properties: Properties<'a>,
    geometry: Option<Geometry>,
}

#[derive(Serialize)]
struct Properties<'a> {
    polygon: Option<u32>,
    side: Option<&'static str>,
    object: Option<&'a str>,
    material: Option<&'a str>,
    #[serde(flatten)]
    share: Share,
    /// Only if so.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    tangled: bool,
}

/// Polygons of rings of positions.
#[derive(Serialize)]
struct Geometry {
    r#type: &'static str,
    coordinates: Vec<Vec<Vec<[f64; 2]>>>,
}

#[derive(Serialize)]
struct FrameRow {
    right: [f64; 3],
    up: [f64; 3],
    towards: [f64; 3],
}

/// What is seen: in the order of regions, background last.
type Seen = (bool, Option<PolygonId>, Option<Side>);

/// Writes the picture of all visible regions as a `FeatureCollection`, one feature a line: a `MultiPolygon` for every
/// side of a polygon that is seen, and one for the background (`polygon` null), with its solid angle and, for hemispheres,
/// form factor. `geometry` is null where nothing of it is in the picture; solid angles and form factors are
/// those of all that is seen, so that they sum to the domain's.
///
/// Coordinates are those of the picture, not places on Earth: longitude and latitude as seen from the eye in degrees for
/// [`Projection::Equirectangular`], otherwise in the projection's units, in which the hemisphere's radius or the distance of
/// the image plane is 1. `tolerance` is that of [`Projector::regions`]. Numbers are the shortest decimals that read back as
/// the same f64.
///
/// A feature whose rings may touch or cross ([`FlatRegion::is_tangled`]) has the property `tangled`; gives the number of those.
///
/// # Errors
/// Those of `out`.
pub fn write_geojson(
    image: &ContourImage,
    projector: &Projector,
    tolerance: f64,
    out: impl Write,
) -> io::Result<usize> {
    let in_degrees = projector.projection() == Projection::Equirectangular;
    let mut shapes: BTreeMap<Seen, Vec<FlatRegion>> = BTreeMap::new();
    for region in projector.regions(image, tolerance) {
        shapes.entry((region.polygon.is_none(), region.polygon, region.side)).or_default().push(region);
    }
    let mut out = BufWriter::new(out);
    write!(out, "{{")?;
    field(&mut out, "type", &"FeatureCollection")?;
    field(&mut out, "schema", &REGIONS_SCHEMA)?;
    field(&mut out, "eye", &plain(image.viewpoint().eye()))?;
    field(&mut out, "domain", &domain_row(image))?;
    field(&mut out, "projection", &projector.projection().name())?;
    field(&mut out, "units", if in_degrees { &"degree" } else { &"one" })?;
    let frame = projector.frame();
    let frame = FrameRow { right: plain(frame.right()), up: plain(frame.up()), towards: plain(frame.towards()) };
    field(&mut out, "frame", &frame)?;
    let scene = image.scene();
    let mut tangled_count = 0;
    rows(&mut out, "features", shares(image), |out, (seen, share)| {
        let (_, polygon, side) = seen;
        let named = polygon.map(|id| scene.polygon(id));
        let tangled = shapes.get(&seen).is_some_and(|regions| regions.iter().any(|region| region.is_tangled));
        tangled_count += usize::from(tangled);
        let properties = Properties {
            polygon: polygon.map(|id| id.0),
            side: side.map(side_name),
            object: named.map(PolygonRef::object_name),
            material: named.map(|polygon| polygon.material().name.as_str()),
            share,
            tangled,
        };
        let geometry = shapes.get(&seen).map(|regions| Geometry {
            r#type: "MultiPolygon",
            coordinates: regions.iter().map(|region| rings(region, in_degrees)).collect(),
        });
        Ok(serde_json::to_writer(out, &Feature { r#type: "Feature", properties, geometry })?)
    })?;
    writeln!(out, "}}")?;
    out.flush()?;
    Ok(tangled_count)
}

/// How much is seen of everything.
fn shares(image: &ContourImage) -> BTreeMap<Seen, Share> {
    let mut shares: BTreeMap<Seen, Share> = BTreeMap::new();
    for cell in image.cells() {
        let share = Share { solid_angle: cell.solid_angle(), form_factor: cell.form_factor() };
        shares.entry((cell.polygon().is_none(), cell.polygon(), cell.side())).or_default().add(share);
    }
    shares
}

/// The exterior and the holes, closed.
fn rings(region: &FlatRegion, in_degrees: bool) -> Vec<Vec<[f64; 2]>> {
    let position = |p: &DVec2| {
        let p = if in_degrees { DVec2::new(p.x.to_degrees(), p.y.to_degrees()) } else { *p };
        (p + 0.0).to_array()
    };
    let closed = |ring: &Vec<DVec2>| ring.iter().chain(ring.first()).map(position).collect();
    std::iter::once(&region.exterior).chain(&region.holes).map(closed).collect()
}

/// Without -0.
fn plain(v: glam::DVec3) -> [f64; 3] {
    (v + 0.0).to_array()
}
