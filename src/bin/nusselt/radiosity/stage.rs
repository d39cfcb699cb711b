//! The patches as they are, until some are halved.

use nusselt::factors::{Exchange, ExchangeError, ExchangeOptions, PatchMesh};
use nusselt::scene::{PolygonId, Scene};

/// More patches than this are not made.
const MOST_PATCHES: usize = 4_000_000;

pub(super) struct Stage {
    pub(super) mesh: PatchMesh,
    /// Polygon k is patch k.
    pub(super) patches: Scene,
    /// The polygon that each patch is part of.
    pub(super) of: Vec<PolygonId>,
    /// What patches share corners in pictures.
    pub(super) regions: Vec<PolygonId>,
    pub(super) exchange: Exchange,
}

impl Stage {
    pub(super) fn of_mesh(mesh: PatchMesh, options: ExchangeOptions) -> Result<Self, ExchangeError> {
        if mesh.len() > MOST_PATCHES {
            return Err(ExchangeError::TooManyPatches);
        }
        let patches = mesh.patches().map_err(ExchangeError::Facets)?;
        let exchange = Exchange::of_mesh(&mesh, options)?;
        Ok(Self { patches, of: mesh.polygons(), regions: mesh.regions(), exchange, mesh })
    }
}
