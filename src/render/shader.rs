//! The radiance that a point of a surface sends.

use super::leaves::{Leaves, is_mirrored};
use super::mirrors::Meets;
use super::{Indirect, RenderError, lights};
use crate::brdf::{self, Brdf, Emission, Lighting, ReflectError};
use crate::contour::{Cell, ContourImage, Domain, SceneOrder, ViewError, ViewSpace, Viewpoint, Windows};
use crate::hemicube::Hemicube;
#[cfg(feature = "rays")]
use crate::hemicube::{BaselineError, Rays};
use crate::integral::CubatureOptions;
use crate::scene::{PieceId, PolygonId, PolygonRef, Scene, Side};
use glam::DVec3;
use std::sync::{Mutex, PoisonError};

/// How it is found what a point sees.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Shading {
    /// By contour images: exactly.
    #[default]
    Contour,
    /// By a hemicube over each point.
    Hemicube {
        /// Rows and columns of the top face: see [`Hemicube::new`].
        resolution: usize,
    },
    /// By random rays from each point, with a cosine distribution.
    #[cfg(feature = "rays")]
    Rays {
        /// How many.
        rays: u32,
    },
}

/// How points are shaded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShaderOptions {
    /// How it is found what they see.
    pub shading: Shading,
    /// So many times a ray is followed from mirror to mirror; what is seen then reflects nothing in its mirrors.
    pub mirrors: u32,
    /// How accurate integrals of BRDFs are that have no closed form.
    pub cubature: CubatureOptions,
}

impl Default for ShaderOptions {
    fn default() -> Self {
        let cubature = CubatureOptions { relative: 1e-3, absolute: 1e-9, ..CubatureOptions::default() };
        Self { shading: Shading::Contour, mirrors: 8, cubature }
    }
}

/// A point on a side of a piece: the nearest one to `near`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spot {
    /// The piece.
    pub piece: PieceId,
    /// The side of it.
    pub side: Side,
    /// A point on it or near it.
    pub near: DVec3,
}

/// Tells the radiance that points of surfaces send. Threads share it.
///
/// Both sides of a polygon reflect by its material; only fronts emit, unless [`Lighting::is_two_sided`] says otherwise.
pub struct Shader {
    pub(super) order: SceneOrder,
    pub(super) brdfs: Vec<Box<dyn Brdf>>,
    pub(super) lighting: Lighting,
    /// What each point light sees.
    pub(super) light_views: Vec<Option<ContourImage>>,
    /// Where light comes from that is not interreflected; `None` if from nowhere.
    pub(super) lamps: Option<Domain>,
    pub(super) indirect: Option<Indirect>,
    pub(super) options: ShaderOptions,
    #[cfg(feature = "rays")]
    pub(super) rays: Option<Rays>,
    desks: Mutex<Vec<Desk>>,
}

/// Memory that one thread uses at a time.
#[derive(Default)]
pub(super) struct Desk {
    pub(super) space: ViewSpace,
    pub(super) hemicube: Option<Hemicube>,
    pub(super) ring: Vec<DVec3>,
}

/// With more polygons that emit than this, all that is above a point is looked at instead of what is towards each of them.
const MOST_WINDOWS: usize = 64;

impl Shader {
    /// For a scene whose materials reflect as they say ([`Material::brdf`](crate::scene::Material::brdf)), lit by what its polygons emit and by `lighting`.
    ///
    /// # Errors
    /// If a material has no BRDF, if a light is not fit for use, or if there is no such hemicube, no ray, or no view from a light.
    pub fn new(order: SceneOrder, lighting: Lighting, options: ShaderOptions) -> Result<Self, RenderError> {
        let brdfs = order.scene().materials().iter().map(|material| {
            material.brdf().map_err(|source| RenderError::Material { material: material.name.clone(), source })
        });
        let brdfs = brdfs.collect::<Result<_, _>>()?;
        Self::with_brdfs(order, brdfs, lighting, options)
    }

    /// The same with a BRDF for each material, in their order.
    ///
    /// # Errors
    /// As [`Shader::new`], and if there are not as many.
    pub fn with_brdfs(
        order: SceneOrder,
        brdfs: Vec<Box<dyn Brdf>>,
        lighting: Lighting,
        options: ShaderOptions,
    ) -> Result<Self, RenderError> {
        let scene = order.scene();
        let (found, expected) = (brdfs.len(), scene.materials().len());
        if found != expected {
            return Err(RenderError::WrongBrdfs { found, expected });
        }
        let emitters = scene.polygons().filter(|polygon| polygon.material().is_emitter() && polygon.pieces().len() > 0);
        let emitters: Vec<PolygonId> = emitters.map(PolygonRef::id).collect();
        let lamps = if lighting.sky.is_some() || emitters.len() > MOST_WINDOWS {
            Some(Domain::Above)
        } else {
            (!emitters.is_empty()).then(|| Domain::Window(Windows::polygons(emitters).above_surface()))
        };
        let light_views = lights::views(&order, &lighting.lights)?;
        if let Shading::Hemicube { resolution } = options.shading {
            Hemicube::check(resolution)?;
        }
        #[cfg(feature = "rays")]
        let rays = match options.shading {
            Shading::Rays { rays: 0 } => return Err(BaselineError::NoRays.into()),
            Shading::Rays { .. } => Some(Rays::new(scene)),
            _ => None,
        };
        Ok(Self {
            brdfs,
            lighting,
            light_views,
            lamps,
            indirect: None,
            options,
            #[cfg(feature = "rays")]
            rays,
            desks: Mutex::default(),
            order,
        })
    }

    /// With interreflected light too. It is that of diffuse surfaces and of what polygons emit, without the sky and lights without extent.
    ///
    /// # Errors
    /// If it is that of a scene with more polygons.
    pub fn with_indirect(mut self, indirect: Indirect) -> Result<Self, RenderError> {
        indirect.check(self.scene())?;
        #[cfg(feature = "rays")]
        if self.rays.is_some() {
            self.rays = Some(Rays::new(&indirect.patches));
        }
        self.desks = Mutex::default();
        self.indirect = Some(indirect);
        Ok(self)
    }

    /// The scene.
    pub fn scene(&self) -> &Scene {
        self.order.scene()
    }

    /// What it has views of the scene from.
    pub fn order(&self) -> &SceneOrder {
        &self.order
    }

    /// The radiance that a point emits, in all directions.
    pub fn emitted(&self, spot: &Spot) -> DVec3 {
        let is_emitting = spot.side == Side::Front || self.lighting.is_two_sided;
        let polygon = self.scene().piece(spot.piece).polygon();
        if is_emitting { DVec3::from(self.scene().polygon(polygon).material().emission) } else { DVec3::ZERO }
    }

    /// The radiance that a point reflects towards a viewer, who is above its surface in a direction of any length. `seed` chooses the random rays; nothing else depends on it.
    ///
    /// The cost is about that of the views that it takes: through windows of the lamps for direct light, of all that is above it for gloss and for gathered interreflection.
    ///
    /// # Errors
    /// If the point is not finite, if the viewer is below its surface, or if there is no view.
    ///
    /// # Panics
    /// If there is no such piece.
    pub fn reflected(&self, spot: &Spot, viewer: DVec3, seed: u64) -> Result<DVec3, RenderError> {
        let place = Place::new(self, *spot, viewer)?;
        if place.height < -1e-9 {
            return Err(place.reflect_error(ReflectError::BadView(viewer)));
        }
        self.reflected_where_seen(spot, viewer, seed, None)
    }

    /// The same where the surface is known to be seen: that the viewer is below it is rounding. What is seen in it as in a flat mirror may be known.
    pub(super) fn reflected_where_seen(
        &self,
        spot: &Spot,
        viewer: DVec3,
        seed: u64,
        mirrored: Option<Meets>,
    ) -> Result<DVec3, RenderError> {
        // A desk is only ever taken or put back whole.
        let free = || self.desks.lock().unwrap_or_else(PoisonError::into_inner);
        let taken = free().pop();
        let mut desk = taken.unwrap_or_default();
        let result = self.reflected_at(&mut desk, spot, viewer, seed, 0, mirrored);
        free().push(desk);
        result
    }

    /// What is seen of the background in a unit direction.
    pub fn background(&self, direction: DVec3) -> DVec3 {
        self.lighting.sky.as_ref().map_or(DVec3::ZERO, |sky| sky.radiance(direction))
    }

    /// The same on a ray that has come from so many mirrors.
    fn reflected_at(
        &self,
        desk: &mut Desk,
        spot: &Spot,
        viewer: DVec3,
        seed: u64,
        mirrors: u32,
        mirrored: Option<Meets>,
    ) -> Result<DVec3, RenderError> {
        let place = Place::new(self, *spot, viewer)?;
        let leaves = Leaves::new(place.brdf, place.towards.outgoing);
        let mut sum = DVec3::ZERO;
        if !(leaves.matt.is_empty() && leaves.glossy.is_empty()) {
            sum += match self.options.shading {
                Shading::Contour => self.by_contour(desk, &place, &leaves)?,
                _ => self.by_samples(desk, &place, &leaves, seed)?,
            };
            sum += self.of_lights(&mut desk.space, &place)?;
        }
        if mirrors < self.options.mirrors {
            for &(direction, reflectance) in &leaves.mirrors {
                let known = mirrored.filter(|_| is_mirrored(place.towards.outgoing, direction));
                let Meets { spot, direction } = if let Some(known) = known {
                    known
                } else {
                    let direction = place.towards.to_scene(direction);
                    Meets { spot: self.first_seen(&mut desk.space, &place, direction)?, direction }
                };
                let seen = match spot {
                    Some(spot) => {
                        let seed = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15).wrapping_add(1);
                        self.emitted(&spot) + self.reflected_at(desk, &spot, -direction, seed, mirrors + 1, None)?
                    }
                    None => self.background(direction),
                };
                sum += reflectance * seen;
            }
        }
        Ok(sum)
    }

    /// What a cell of an image of the scene emits.
    pub(super) fn emission(&self, cell: Cell<'_>) -> Emission<'_> {
        match (cell.polygon(), self.lighting.is_two_sided) {
            (None, _) => self.lighting.sky.as_ref().map_or(Emission::NONE, Emission::Sky),
            (Some(_), false) => brdf::emitted(cell).into(),
            (Some(_), true) => brdf::emitted_by_both_sides(cell).into(),
        }
    }
}

/// A point that is shaded, and what reflects there.
pub(super) struct Place<'a> {
    pub(super) spot: Spot,
    pub(super) polygon: PolygonId,
    pub(super) viewpoint: Viewpoint,
    pub(super) normal: DVec3,
    /// The sine of the angle at which the viewer is above the surface.
    height: f64,
    pub(super) brdf: &'a dyn Brdf,
    pub(super) towards: brdf::Place,
}

impl<'a> Place<'a> {
    fn new(shader: &'a Shader, spot: Spot, viewer: DVec3) -> Result<Self, RenderError> {
        let scene = shader.scene();
        let viewpoint = Viewpoint::on_piece(scene, spot.piece, spot.side, spot.near)?;
        let polygon = scene.piece(spot.piece).polygon();
        let normal = viewpoint.surface_normal(scene, shader.order.skeleton()).unwrap_or_default();
        let failed = |source| RenderError::Reflect { polygon, source };
        let unit = (viewer / viewer.abs().max_element()).try_normalize();
        let unit = unit.ok_or_else(|| failed(ReflectError::BadView(viewer)))?;
        let height = normal.dot(unit);
        // Who sees the surface edge-on may be below it by rounding.
        let raised = if height > GRAZING { unit } else { unit + normal * (GRAZING - height) };
        let towards = brdf::Place::at(normal, None, raised).map_err(failed)?;
        let brdf = &*shader.brdfs[scene.polygon(polygon).material_id().index()];
        Ok(Self { spot, polygon, viewpoint, normal, height, brdf, towards })
    }

    pub(super) fn eye(&self) -> DVec3 {
        self.viewpoint.eye()
    }

    pub(super) fn view_error(&self, source: ViewError) -> RenderError {
        RenderError::Point { polygon: self.polygon, source }
    }

    pub(super) fn reflect_error(&self, source: ReflectError) -> RenderError {
        RenderError::Reflect { polygon: self.polygon, source }
    }
}

/// The least sine of the angle at which a surface is taken to be seen.
const GRAZING: f64 = 1e-12;
