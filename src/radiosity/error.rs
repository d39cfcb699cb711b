//! Why there is no solution.

use crate::brdf::BrdfError;
use crate::factors::ExchangeError;
use crate::scene::PolygonId;

/// Why there is no radiosity.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RadiosityError {
    /// A material has no reflectance.
    #[error("polygon {polygon}: its material {material}: {source}")]
    BadMaterial {
        /// The first polygon of that material.
        polygon: PolygonId,
        /// The material's name.
        material: String,
        /// Why.
        source: BrdfError,
    },
    /// Nothing emits from its front.
    #[error("no polygon emits; give a material an emission (Ke)")]
    Dark,
    /// Numbers do not hold the power that is emitted.
    #[error(
        "polygon {polygon}: its power, or that of all up to it, is more than numbers hold; use a smaller emission (Ke) \
         or a larger unit of length"
    )]
    TooBright {
        /// The polygon with which it is too much.
        polygon: PolygonId,
    },
    /// What is emitted is so little that numbers do not hold the parts that it falls into.
    #[error(
        "polygon {polygon}: its power, the largest there is, is so small that numbers do not hold its parts; use a larger \
         emission (Ke), or a smaller unit of length if the scene is tiny"
    )]
    TooDim {
        /// The polygon that emits most.
        polygon: PolygonId,
    },
    /// Numbers do not hold the area of a patch, so that they do not hold its power.
    #[error("polygon {polygon}: its area is more than numbers hold; use a larger unit of length")]
    TooLarge {
        /// The first such polygon.
        polygon: PolygonId,
    },
    /// What surfaces reflect in a closed scene is not less than what they get, or hardly: it would not end in any time.
    #[error(
        "hardly anything is absorbed: of {shots} shots, the last ones took less than 1e-9 from what is left; some surface has \
         to reflect less"
    )]
    Endless {
        /// How many patches have shot.
        shots: usize,
    },
    /// A state is that of another scene.
    #[error("the state has {found} patches, but the scene has {expected}; solve it anew")]
    OtherState {
        /// How many it has.
        found: usize,
        /// How many it should have.
        expected: usize,
    },
    /// A state has numbers that are not finite, or too large.
    #[error("the state of patch {patch} is not finite, or too large; solve it anew")]
    BadState {
        /// The first such patch.
        patch: usize,
    },
    /// There is no row of form factors.
    #[error(transparent)]
    Exchange(#[from] ExchangeError),
    /// The mesh would have too many corners.
    #[error("the mesh would have more than {limit} corners; ask for less detail")]
    TooManyCorners {
        /// How many are allowed.
        limit: usize,
    },
}
