//! What is exchanged between what, and how accurately.

/// What the patches are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PatchPlan {
    /// Patch k is polygon k, those without area included.
    Polygons,
    /// A patch for every object that has polygons.
    Objects,
    /// Every polygon in parts whose edges are at most this long, in scene units. Edges that polygons share are divided
    /// in the same places.
    Mesh {
        /// The longest edge; positive.
        longest_edge: f64,
    },
}

/// Which sides of patches receive.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Sides {
    /// Fronts; what arrives at backs is summed apart.
    #[default]
    Fronts,
    /// A back counts as its patch. Rows leave from fronts all the same.
    Both,
}

/// How form factors between patches are computed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExchangeOptions {
    /// The absolute error allowed of each factor; above 0.
    pub tolerance: f64,
    /// Which sides receive.
    pub sides: Sides,
    /// About so many views are taken from one flat convex part of a patch at most. Entries whose error is estimated above the tolerance then say
    /// so.
    pub most_views: usize,
}

impl Default for ExchangeOptions {
    fn default() -> Self {
        Self { tolerance: 1e-4, sides: Sides::Fronts, most_views: 100_000 }
    }
}
