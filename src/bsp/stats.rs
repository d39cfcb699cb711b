//! Figures of a 3D BSP.

/// Size, depth and splits of a [`SceneBsp`](super::SceneBsp).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BspStats {
    /// Nodes.
    pub nodes: usize,
    /// Nodes whose plane is axis-aligned and was chosen independently of any polygon.
    pub axis_nodes: usize,
    /// The number of nodes on the longest path from the root.
    pub depth: usize,
    /// How often a fragment was cut in two.
    pub splits: usize,
    /// Fragments in the finished tree.
    pub fragments: usize,
    /// Fragments left uncut because of epsilon.
    pub uncut_slivers: usize,
}
