//! Pictures of visible regions for the `geo` crates.

use super::{ContourImage, FlatRegion, Projection, ProjectionError, Projector};
use crate::scene::{PolygonId, Side};
use geo_types::{Coord, LineString, MultiPolygon, Polygon};
use glam::DVec2;

/// The picture of what is seen of one side of a polygon, or of the background.
#[derive(Clone, Debug, PartialEq)]
pub struct GeoRegion {
    /// The polygon; `None` for background.
    pub polygon: Option<PolygonId>,
    /// The side of it.
    pub side: Option<Side>,
    /// Its visible regions: `geo::MultiPolygon`, with exteriors counter-clockwise and interiors clockwise.
    pub shape: MultiPolygon<f64>,
    /// True if its rings may touch or cross: see [`FlatRegion::is_tangled`].
    pub is_tangled: bool,
}

impl ContourImage {
    /// The visible regions in a projection as polygons with holes, one multi-polygon for every side of a polygon that is in the
    /// picture and one for the background, which comes last. Coordinates are those of [`Projector`]: for the hemisphere the disc has the radius
    /// 1, panoramas are in radians. Curves are flattened to within [`Projector::TOLERANCE`]: see
    /// [`Projector::regions`].
    ///
    /// ```
    /// # use nusselt::bsp::{BspOptions, SceneBsp};
    /// # use nusselt::contour::{Domain, Projection, Viewpoint};
    /// use geo::Area;
    /// let scene = nusselt::samples::cornell_box().to_builder().build()?;
    /// let bsp = SceneBsp::build(&scene, &BspOptions::default())?;
    /// let viewpoint = Viewpoint::free(glam::DVec3::new(278.0, 273.0, 1.0));
    /// let image = bsp.view(&viewpoint, &Domain::Hemisphere(glam::DVec3::Z))?;
    /// let regions = image.to_geo(Projection::Nusselt)?;
    /// let disc: f64 = regions.iter().map(|region| region.shape.signed_area()).sum();
    /// assert!((disc - std::f64::consts::PI).abs() < 1e-4);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// As [`Projector::of_image`]: if the image is of the whole sphere and the projection is [`Projection::Nusselt`].
    pub fn to_geo(&self, projection: Projection) -> Result<Vec<GeoRegion>, ProjectionError> {
        Ok(Projector::of_image(self, projection)?.to_geo(self, Projector::TOLERANCE))
    }
}

impl Projector {
    /// What [`Projector::regions`] gives, for the `geo` crates.
    pub fn to_geo(&self, image: &ContourImage, tolerance: f64) -> Vec<GeoRegion> {
        let regions = self.regions(image, tolerance);
        let groups = regions.chunk_by(|a, b| (a.polygon, a.side) == (b.polygon, b.side));
        let shapes = groups.map(|group| GeoRegion {
            polygon: group[0].polygon,
            side: group[0].side,
            shape: MultiPolygon(group.iter().map(polygon).collect()),
            is_tangled: group.iter().any(|region| region.is_tangled),
        });
        shapes.collect()
    }
}

fn polygon(region: &FlatRegion) -> Polygon<f64> {
    Polygon::new(ring(&region.exterior), region.holes.iter().map(|hole| ring(hole)).collect())
}

fn ring(points: &[DVec2]) -> LineString<f64> {
    let mut coordinates: Vec<Coord<f64>> = points.iter().map(|p| Coord { x: p.x, y: p.y }).collect();
    coordinates.extend(coordinates.first().copied());
    LineString(coordinates)
}
