//! Reflection: BRDFs, and the radiance that a surface reflects from what is seen above it.
//!
//! With visibility solved exactly, reflected radiance is a sum over the cells of a contour image of an integral of BRDF
//! times cosine over a convex spherical polygon. `docs/brdf.md` lists the models, in what form each is integrated, with
//! what accuracy and at what cost.
//!
//! Directions are in the surface's own frame: z is its normal, x its tangent. They are unit vectors that point away from the
//! surface: *incoming* towards where light comes from, *outgoing* towards the viewer. Colours are linear RGB.
//!
//! ```
//! use glam::DVec3;
//! use nusselt::brdf::{Phong, emitted, reflected_radiance};
//! use nusselt::contour::{Domain, SceneOrder, Viewpoint};
//! use nusselt::integral::CubatureOptions;
//! use nusselt::samples::{Kind, generate};
//! use nusselt::scene::{PolygonId, Side};
//!
//! let scene = generate(Kind::Room, 1_000, 1)?.to_builder().build()?;
//! let floor = Viewpoint::on_surface(&scene, PolygonId(0), Side::Front, DVec3::ZERO)?;
//! let image = SceneOrder::new(&scene).view(&floor, &Domain::Above)?;
//! let glossy = Phong::new(DVec3::splat(0.5), 20.0)?;
//! let view = image.normal().expect("a floor has a normal") + DVec3::new(0.5, 0.2, 0.0);
//! let radiance = reflected_radiance(&image, &glossy, None, view, emitted, CubatureOptions::default())?;
//! assert!(radiance.error.max_element() < 1e-9);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod ashikhmin;
mod blinn;
mod emission;
mod error;
mod form;
mod frame;
mod fresnel;
mod ggx;
mod halfway;
mod lafortune;
mod lambert;
mod lights;
mod ltc;
mod material;
mod merl;
mod metallic_roughness;
mod mirror;
mod oren_nayar;
mod phong;
mod reflect;
mod reflected;
mod seen;
mod sh;
mod sky;
mod sum;
mod ward;

#[cfg(test)]
mod tests;

pub use ashikhmin::AshikhminShirley;
pub use blinn::Blinn;
pub use emission::{Emission, emitted, emitted_by_both_sides};
pub use error::BrdfError;
pub use form::{Form, Lobe, Range};
pub use fresnel::Fresnel;
pub use ggx::Ggx;
pub use lafortune::Lafortune;
pub use lambert::Lambert;
pub use lights::{Light, Lighting};
pub use ltc::{GgxLtc, LtcFit, LtcTable};
pub(crate) use merl::{BINS as MERL_BINS, COUNT as MERL_COUNT, bin as merl_bin};
pub use merl::{Merl, Unmeasured};
pub use metallic_roughness::MetallicRoughness;
pub use mirror::Mirror;
pub use oren_nayar::OrenNayar;
pub use phong::Phong;
pub(crate) use reflected::Place;
pub use reflected::{ReflectError, albedo_towards, reflected_radiance};
pub(crate) use sh::is_usable;
pub use sh::{ShBrdf, ShProjection, ShSymmetry};
pub use sky::{Sky, SkyError};
pub use sum::Sum;
pub use ward::Ward;

use crate::integral::CubatureOptions;
use glam::DVec3;
use std::sync::Arc;

/// Three numbers (red, green, blue), and what each may be off by.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RgbEstimate {
    /// The numbers.
    pub value: DVec3,
    /// A bound on their errors where the form is analytic, an estimate where it is cubature; not negative.
    pub error: DVec3,
}

/// A bidirectional reflectance distribution function.
pub trait Brdf: Send + Sync {
    /// The ratio of the radiance reflected towards `outgoing` to the irradiance from `incoming`, in sr^-1: never negative but for a [`ShBrdf`], finite for
    /// directions above the surface, and 0 below it. Without the parts of [`Form::Dirac`], which have no finite value.
    fn eval(&self, incoming: DVec3, outgoing: DVec3) -> DVec3;

    /// In what form the function of `incoming` that is left for a fixed `outgoing` can be integrated.
    fn form(&self, outgoing: DVec3) -> Form<'_>;

    /// True if `eval` is the same with its directions exchanged (Helmholtz).
    fn is_reciprocal(&self) -> bool {
        true
    }

    /// The directional albedo: what is reflected towards `outgoing` when the same radiance, 1, comes from everywhere above the surface.
    ///
    /// By default what [`reflected_radiance`] makes of a white hemisphere, to 1e-8 where it is not analytic, or as near as a
    /// million evaluations get: where models have kinks, 1e-7.
    fn albedo(&self, outgoing: DVec3) -> RgbEstimate {
        let options = CubatureOptions { relative: 1e-8, absolute: 1e-12, evaluations: 1_000_000 };
        reflect::white_furnace(self.form(outgoing), &|incoming| self.eval(incoming, outgoing), outgoing, options)
    }
}

/// A BRDF that several owners share.
impl<B: Brdf + ?Sized> Brdf for Arc<B> {
    fn eval(&self, incoming: DVec3, outgoing: DVec3) -> DVec3 {
        (**self).eval(incoming, outgoing)
    }

    fn form(&self, outgoing: DVec3) -> Form<'_> {
        (**self).form(outgoing)
    }

    fn is_reciprocal(&self) -> bool {
        (**self).is_reciprocal()
    }

    fn albedo(&self, outgoing: DVec3) -> RgbEstimate {
        (**self).albedo(outgoing)
    }
}

/// The direction that a mirror reflects into.
fn mirrored(direction: DVec3) -> DVec3 {
    DVec3::new(-direction.x, -direction.y, direction.z)
}

/// True if both directions are above the surface.
fn are_above(incoming: DVec3, outgoing: DVec3) -> bool {
    incoming.z > 0.0 && outgoing.z > 0.0
}
