//! How irradiance changes with the place and the turn of the receiver, also where sources are partly hidden.
//!
//! Visibility changes the boundaries of what is seen, and irradiance is an integral over what they bound: E = L (integral of n.u over a region). Moving
//! the eye by dr moves each boundary, an arc of a great circle with the inward normal m = N / |N| of the plane through the
//! eye and a line of the scene, N = +-(a - e) x d for a line through a along d. That plane turns by dN = +-d x dr, so that
//! the region grows over the arc by (u.dN) / |N| at u:
//!
//! dE = L sum over arcs of 1 / |N| (integral of (n.u) (u.dN) ds) = L sum +-dr . ((integral of (n.u) u ds) x d) / |N|.
//!
//! It is the derivative that Arvo gives by the motion of the vertices ("The irradiance Jacobian for partially occluded
//! polyhedral sources", SIGGRAPH 1994), summed up differently: no arc has to know its neighbours, so that nothing is lost where many edges meet in one
//! direction, and arcs along the horizon, where n.u = 0, do not count, whatever they move like.
//!
//! There is no derivative where two lines of the scene lie on one arc (on one side the one ends the region, on the other the other), or where the eye
//! is in the plane of a polygon, which is about to appear. Neither matters where it is hidden: where its points are exactly behind the planes of all polygons that are seen
//! along it, on both sides. They are still so a little farther on.

mod cells;
mod lines;

use super::flux::double_flux;
use super::unit_outline;
use crate::contour::{ContourImage, RegionLoop, VisibleRegion};
use crate::scene::{PolygonId, VertexId};
use glam::DVec3;
use lines::Lines;

/// The irradiance of a surface element, and its first derivatives, by colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IrradianceGradient {
    /// In W / m^2, or the scene's unit.
    pub irradiance: DVec3,
    /// The gradient by the element's position, its normal kept, for red, green and blue: it moves by dr, and the irradiance by the dot product.
    pub by_position: [DVec3; 3],
    /// The same by its unit normal, for turns of it: this is the vector irradiance, whose component along the normal is the irradiance.
    pub by_normal: [DVec3; 3],
}

/// Why irradiance has no derivative there, or none that can be told.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GradientError {
    /// The image is of a sphere or of a camera's directions: there is no surface.
    #[error("there is no irradiance without a surface: take a view of a hemisphere")]
    NoNormal,
    /// Seen from the eye two edges on different lines lie one behind the other, where neither is certain to be hidden.
    #[error(
        "the edges {}-{} and {}-{} are in line seen from the eye: irradiance may have no derivative there; move the eye a little",
        edges[0][0], edges[0][1], edges[1][0], edges[1][1]
    )]
    InLine {
        /// The edges by their vertices.
        edges: [[VertexId; 2]; 2],
    },
    /// The eye is in the plane of a polygon that reaches above the horizon and is not certain to be hidden.
    #[error(
        "the eye is in the plane of polygon {polygon}: irradiance may have no derivative there; move the eye a little"
    )]
    EdgeOn {
        /// The polygon.
        polygon: PolygonId,
    },
    /// A boundary lies where two polygons cross each other, and on a circle of the quadtree too, so that it is not known from what it comes.
    #[error("what bounds polygon {polygon:?} is a crease in line with an axis; move the eye a little")]
    Unknown {
        /// What is seen there.
        polygon: Option<PolygonId>,
    },
}

impl ContourImage {
    /// The irradiance of a surface element at the eye by what is seen, and how it changes as the element moves or turns.
    ///
    /// `radiance` tells what comes from a region, the same from all of it. The derivatives are exact but for rounding: about 1e-15 of the radiance over the angular
    /// size of the regions and over the distance to the lines that bound them. Of a viewpoint on a surface that by the surface's own
    /// normal is one-sided: away from it.
    ///
    /// The cost is that of [`ContourImage::regions`], and n log n in the number of the scene's edges.
    ///
    /// # Errors
    /// Where there is no derivative, or none that can be told; see [`GradientError`].
    ///
    /// ```
    /// use glam::DVec3;
    /// use nusselt::contour::{Domain, SceneOrder, Viewpoint};
    /// use nusselt::scene::{Material, Scene};
    ///
    /// // A small lamp at height 2: its irradiance falls with the square of the distance.
    /// let lamp = [[-0.01, -0.01, 2.0], [0.01, -0.01, 2.0], [0.01, 0.01, 2.0], [-0.01, 0.01, 2.0]];
    /// let scene = Scene::builder().mesh(&lamp, &[vec![0, 1, 2, 3]], Material::new("lamp")).build()?;
    /// let up = Domain::Hemisphere(DVec3::Z);
    /// let image = SceneOrder::new(&scene).view(&Viewpoint::free(DVec3::ZERO), &up)?;
    /// let lamp = |region: &nusselt::contour::VisibleRegion| region.polygon().map_or(DVec3::ZERO, |_| DVec3::ONE);
    /// let gradient = image.irradiance_gradient(lamp)?;
    /// let nearer = gradient.by_position[0].z / gradient.irradiance.x;
    /// assert!((nearer - 1.0).abs() < 1e-4, "2 / distance: {nearer}");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn irradiance_gradient(
        &self,
        radiance: impl Fn(&VisibleRegion) -> DVec3,
    ) -> Result<IrradianceGradient, GradientError> {
        let normal = self.normal().ok_or(GradientError::NoNormal)?;
        let mut lines = Lines::new(self, normal).ok_or(GradientError::NoNormal)?;
        lines.check_edge_on(normal)?;
        lines.check_in_line()?;
        let [mut flux, mut motion] = [[DVec3::ZERO; 3]; 2];
        for region in self.regions() {
            let colour = radiance(&region);
            if colour == DVec3::ZERO {
                continue;
            }
            let mut region_flux = DVec3::ZERO;
            for &cell in region.cells() {
                let boundary: Vec<DVec3> = self.cell(cell).boundary().collect();
                region_flux += 0.5 * double_flux(&unit_outline(&boundary));
            }
            let mut region_motion = DVec3::ZERO;
            for side in region.loops().iter().flat_map(RegionLoop::sides) {
                for part in lines.behind(side, region.polygon())? {
                    region_motion += part.line.growth(side.from, part.angles, normal);
                }
            }
            for k in 0..3 {
                flux[k] += region_flux * colour[k];
                motion[k] += region_motion * colour[k];
            }
        }
        Ok(IrradianceGradient {
            irradiance: DVec3::from(flux.map(|flux| flux.dot(normal))),
            by_position: motion,
            by_normal: flux,
        })
    }
}

/// The line of the scene behind a side of a region.
struct Line {
    /// The normal N of the plane through it and the eye, to the inside of the region, and along the line, with N = (a - e) x along.
    inward: DVec3,
    along: DVec3,
}

impl Line {
    /// The gradient by position of the integral of n.u over the region, as far as a part of a side moves: between two angles from where the side starts.
    fn growth(&self, zero: DVec3, [from, to]: [f64; 2], normal: DVec3) -> DVec3 {
        let size = self.inward.length();
        let inward = self.inward / size;
        // The region is to the left.
        let aside = inward.cross(zero);
        let (start, ahead) = (zero * from.cos() + aside * from.sin(), aside * from.cos() - zero * from.sin());
        let length = to - from;
        let (sin, cos) = length.sin_cos();
        let [start_square, both, ahead_square] =
            [0.5 * (length + sin * cos), 0.5 * sin * sin, 0.5 * (length - sin * cos)];
        let [p, t] = [normal.dot(start), normal.dot(ahead)];
        // The integral of (n.u) u over the arc.
        let moment = start * (p * start_square + t * both) + ahead * (p * both + t * ahead_square);
        moment.cross(self.along) / size
    }
}
