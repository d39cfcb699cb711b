//! Interreflected light, from a solution of the radiosity.

use super::RenderError;
use super::patch_index::PatchIndex;
use crate::contour::{ContourImage, SceneOrder};
use crate::factors::Exchange;
use crate::radiosity::{Gather, RadiosityError, Surface, SurfaceOptions, in_own_unit, off};
use crate::scene::{PolygonId, Scene, Side};
use glam::DVec3;
use std::f64::consts::PI;

/// The patches of a scene with their radiosities, and, if that is asked for, the irradiance that surfaces have of what is reflected.
///
/// Backs send no light, as in [`Solver`](crate::radiosity::Solver).
#[derive(Clone, Debug)]
pub struct Indirect {
    pub(super) patches: Scene,
    pub(super) order: SceneOrder,
    of: Vec<PolygonId>,
    emission: Vec<DVec3>,
    radiosity: Vec<DVec3>,
    index: PatchIndex,
    /// The polygon whose patches those of each polygon are, if some are meshed together.
    hosts: Option<Vec<PolygonId>>,
    surface: Option<Irradiance>,
}

/// The irradiance of fronts at corners of triangles.
#[derive(Clone, Debug)]
struct Irradiance {
    surface: Surface,
    /// Where the triangles of each patch begin, and where the last ones end.
    starts: Vec<usize>,
}

impl Indirect {
    /// Of patches of a scene with so many polygons, patch k being part of polygon `of[k]`, with the radiosity that each emits and the one that it has in all, as
    /// [`Solver`](crate::radiosity::Solver) gives them. What a point receives is gathered from all patches that it sees, exactly, at the cost of a view of all of
    /// the scene for each point: see [`Indirect::interpolated`].
    ///
    /// # Panics
    /// If there are not as many of each as patches, or `of` names a polygon that there is not.
    pub fn new(patches: &Scene, of: &[PolygonId], polygons: usize, emission: &[DVec3], radiosity: &[DVec3]) -> Self {
        let count = patches.polygon_count();
        assert!([of.len(), emission.len(), radiosity.len()].iter().all(|&len| len == count), "one for every patch");
        assert!(of.iter().all(|polygon| polygon.index() < polygons), "patches of polygons that there are");
        Self {
            patches: patches.clone(),
            order: SceneOrder::new(patches),
            of: of.to_vec(),
            emission: emission.to_vec(),
            radiosity: radiosity.to_vec(),
            index: PatchIndex::new(patches, of, polygons),
            hosts: None,
            surface: None,
        }
    }

    /// Says that patches of polygon k are those of polygon `hosts[k]` ([`PatchMesh::joined`](crate::factors::PatchMesh::joined)).
    ///
    /// # Panics
    /// If there is not one for every polygon.
    #[must_use]
    pub fn with_hosts(mut self, hosts: Vec<PolygonId>) -> Self {
        let fits = |host: &PolygonId| host.index() < hosts.len();
        assert!(self.of.iter().chain(&hosts).all(fits), "hosts are polygons of the scene");
        self.hosts = Some(hosts);
        self
    }

    /// Gathers the irradiance of what patches reflect, without what they emit, at the corners of a mesh that is finer where it changes ([`Surface`]), by all threads. Between them it is
    /// interpolated linearly for matt fronts; light straight from lamps is not part of it.
    ///
    /// The exchange is that of the same patches; corners are shared within regions ([`PatchMesh::regions`](crate::factors::PatchMesh::regions)).
    ///
    /// # Errors
    /// As [`Surface::new`].
    ///
    /// # Panics
    /// If there are other numbers of patches.
    pub fn interpolated(
        self,
        exchange: &Exchange,
        regions: &[PolygonId],
        options: &SurfaceOptions,
    ) -> Result<Self, RadiosityError> {
        let all = vec![true; self.patches.polygon_count()];
        self.interpolated_on(&all, exchange, regions, options, &|_| ())
    }

    /// The same on those patches alone that are `shown` ([`Shader::shown`](super::Shader::shown)): on others it is gathered at every point that
    /// is asked for. `done` is told from any thread how many more views are made.
    ///
    /// # Errors
    /// As [`Surface::new`].
    ///
    /// # Panics
    /// As [`Indirect::interpolated`].
    pub fn interpolated_on(
        mut self,
        shown: &[bool],
        exchange: &Exchange,
        regions: &[PolygonId],
        options: &SurfaceOptions,
        done: &(dyn Fn(usize) + Sync),
    ) -> Result<Self, RadiosityError> {
        let count = self.patches.polygon_count();
        let reflected: Vec<DVec3> = self.radiosity.iter().zip(&self.emission).map(|(&b, &e)| b - e).collect();
        let nothing = vec![DVec3::ZERO; count];
        let share = |k: u32| if self.is_matt(PolygonId(k)) { DVec3::ONE } else { DVec3::ZERO };
        let receives: Vec<DVec3> = (0..count as u32).map(share).collect();
        let gather = Gather::new(exchange, &nothing, &receives, &reflected);
        assert_eq!(shown.len(), count, "one for every patch");
        let is_wanted = |patch: PolygonId| shown[patch.index()];
        let surface = Surface::watched(&self.patches, regions, &gather, options, &is_wanted, done)?;
        let starts = (0..=count).map(|k| surface.patches.partition_point(|patch| patch.index() < k)).collect();
        self.surface = Some(Irradiance { surface, starts });
        Ok(self)
    }

    /// True if the material of a patch says that it reflects diffusely.
    fn is_matt(&self, patch: PolygonId) -> bool {
        DVec3::from(self.patches.polygon(patch).material().diffuse) != DVec3::ZERO
    }

    /// How many patches there are.
    pub fn patch_count(&self) -> usize {
        self.patches.polygon_count()
    }

    /// How many corners the irradiance was gathered at; 0 if it is gathered for each point.
    pub fn corner_count(&self) -> usize {
        self.surface.as_ref().map_or(0, |irradiance| irradiance.surface.positions.len())
    }

    pub(super) fn check(&self, scene: &Scene) -> Result<(), RenderError> {
        let found = self.of.iter().map(|polygon| polygon.index() + 1).max().unwrap_or(0);
        let expected = scene.polygon_count();
        let hosts = self.hosts.as_ref().map_or(expected, Vec::len);
        if found > expected || hosts != expected { Err(RenderError::OtherPatches { found, expected }) } else { Ok(()) }
    }

    /// The radiance that a side of a patch sends.
    pub(super) fn radiance(&self, patch: PolygonId, side: Option<Side>) -> DVec3 {
        if side == Some(Side::Front) { self.radiosity[patch.index()] / PI } else { DVec3::ZERO }
    }

    /// The patch that a point of a polygon is on.
    pub(super) fn patch_at(&self, polygon: PolygonId, point: DVec3) -> Option<PolygonId> {
        self.index.patch_at(&self.patches, self.host(polygon), point)
    }

    /// The patches whose fronts an image of the scene shows, and at most some beside these, in no order.
    pub(super) fn patches_in<'a>(&'a self, image: &'a ContourImage) -> impl Iterator<Item = PolygonId> + 'a {
        image.cells().filter(|cell| cell.side() == Some(Side::Front)).flat_map(|cell| {
            let corners = cell.boundary().map(|direction| cell.point_at(direction));
            let host = cell.polygon().map(|polygon| self.host(polygon));
            host.map_or_else(Vec::new, |host| self.index.patches_near(host, corners))
        })
    }

    fn host(&self, polygon: PolygonId) -> PolygonId {
        self.hosts.as_ref().map_or(polygon, |hosts| hosts[polygon.index()])
    }

    /// The interpolated irradiance of a front; `None` if there is none, or if the material was matt and black when it was gathered.
    pub(super) fn irradiance(&self, patch: PolygonId, side: Side, point: DVec3) -> Option<DVec3> {
        let Irradiance { surface, starts } = self.surface.as_ref().filter(|_| side == Side::Front)?;
        if !self.is_matt(patch) {
            return None;
        }
        let triangles = &surface.triangles[starts[patch.index()]..starts[patch.index() + 1]];
        let corners = |triangle: &[u32; 3]| triangle.map(|corner| surface.positions[corner as usize]);
        let mut nearest = (f64::INFINITY, None);
        for triangle in triangles {
            let distance = off(&corners(triangle), point);
            if distance < nearest.0 {
                nearest = (distance, Some(triangle));
                if distance < 0.0 {
                    break;
                }
            }
        }
        let triangle = nearest.1?;
        let shares = barycentric(corners(triangle), point);
        let values = triangle.map(|corner| surface.radiosity[corner as usize]);
        Some(values[0] * shares[0] + values[1] * shares[1] + values[2] * shares[2])
    }
}

/// The shares that the corners of a triangle have in a point, which is moved into it.
fn barycentric([a, b, c]: [DVec3; 3], point: DVec3) -> [f64; 3] {
    let [b, c, point] = in_own_unit([b - a, c - a, point - a]);
    let normal = b.cross(c);
    let whole = normal.length_squared();
    let share = |from: DVec3, to: DVec3| (normal.dot((to - from).cross(point - from)) / whole).clamp(0.0, 1.0);
    let shares = [share(b, c), share(c, DVec3::ZERO), share(DVec3::ZERO, b)];
    let sum: f64 = shares.iter().sum();
    if sum > 0.0 { shares.map(|share| share / sum) } else { [1.0 / 3.0; 3] }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_give_the_point_back() {
        let corners = [DVec3::new(1.0, 0.0, 0.0), DVec3::new(0.0, 2.0, 0.0), DVec3::new(0.0, 0.0, 3.0)];
        let point = corners[0] * 0.2 + corners[1] * 0.5 + corners[2] * 0.3;
        let shares = barycentric(corners, point);
        for (found, expected) in shares.into_iter().zip([0.2, 0.5, 0.3]) {
            assert!((found - expected).abs() < 1e-15, "{shares:?}");
        }
        // From outside the nearest side.
        let outside = DVec3::from(barycentric(corners, corners[0] * 3.0 - corners[1] * 2.0));
        assert!((outside - DVec3::X).length() < 1e-15, "{outside}");
    }
}
