//! A sample of the scene's views, proved.

use super::pairs::PairCheck;
use crate::failure::Failure;
use crate::proof::{name, prove};
use crate::summary::Lines;
use glam::DVec3;
use nusselt::contour::{Domain, SceneOrder, Viewpoint};
use nusselt::factors::PatchInfo;
use nusselt::io::CertificateRow;
use nusselt::scene::{PieceRef, PolygonId, Scene, Side};
use nusselt::verify::{Arithmetic, Certificate};
use rayon::iter::{IntoParallelRefIterator, ParallelIterator};
use serde::Serialize;
use std::ops::Range;
use std::path::Path;
use std::time::Instant;

/// So many views are proved at most.
const MOST: usize = 16;

/// Views that were proved, all of them.
#[derive(Serialize)]
pub(super) struct Proved {
    #[serde(flatten)]
    certificate: CertificateRow,
    /// From the middles of these polygons.
    polygons: Vec<u32>,
    /// Some of the factors, computed once more; `None` where backs count.
    pub(super) pairs: Option<PairCheck>,
    #[serde(skip)]
    arithmetic: Arithmetic,
    #[serde(skip)]
    pub(super) ms: f64,
}

/// Proves what is seen from the middles of patches, evenly spaced among those with these rows.
pub(super) fn prove_sample(
    file: &Path,
    scene: &Scene,
    patches: &[PatchInfo],
    rows: Range<u32>,
    arithmetic: Arithmetic,
) -> Result<Proved, Failure> {
    let start = Instant::now();
    let patches = &patches[rows.start as usize..rows.end as usize];
    // Those without area see nothing; parts of one polygon have one middle.
    let mut polygons: Vec<PolygonId> = patches.iter().map(|patch| patch.polygon).collect();
    polygons.dedup();
    polygons.retain(|&polygon| scene.polygon(polygon).pieces().next().is_some());
    let sample = evenly(&polygons);
    let order = SceneOrder::new(scene);
    let proofs: Vec<_> = sample.par_iter().map(|&polygon| prove_from(file, &order, polygon, arithmetic)).collect();
    let mut all = Certificate { cells: 0, great_circles: 0, exact_decisions: 0 };
    for proof in proofs {
        let Certificate { cells, great_circles, exact_decisions } = proof?;
        all.cells += cells;
        all.great_circles += great_circles;
        all.exact_decisions += exact_decisions;
    }
    let polygons = sample.iter().map(|polygon| polygon.0).collect();
    Ok(Proved { certificate: all.into(), polygons, pairs: None, arithmetic, ms: start.elapsed().as_secs_f64() * 1e3 })
}

/// At most [`MOST`], the first and the last among them.
pub(super) fn evenly<T: Copy>(all: &[T]) -> Vec<T> {
    let count = all.len().min(MOST);
    (0..count).map(|k| all[k * (all.len() - 1) / (count - 1).max(1)]).collect()
}

fn prove_from(
    file: &Path,
    order: &SceneOrder,
    polygon: PolygonId,
    arithmetic: Arithmetic,
) -> Result<Certificate, Failure> {
    let scene = order.scene();
    let corners = || scene.polygon(polygon).pieces().flat_map(PieceRef::points);
    let weight = 1.0 / corners().count() as f64;
    let middle = corners().fold(DVec3::ZERO, |sum, corner| sum + corner * weight);
    let viewpoint = Viewpoint::on_surface(scene, polygon, Side::Front, middle);
    let viewpoint = viewpoint.map_err(|error| Failure::about(file, &error))?;
    let image = order.view(&viewpoint, &Domain::Above).map_err(|error| Failure::about(file, &error))?;
    prove(file, &image, arithmetic).map(|(_, proof)| proof.certificate)
}

impl Proved {
    pub(super) fn tell(&self, lines: &mut Lines) {
        let (views, arithmetic, ms) = (self.polygons.len(), name(self.arithmetic), self.ms);
        lines.add(
            "proof",
            format!("holds for all directions of {views} views; {arithmetic} arithmetic, {ms:.0} ms with the views"),
        );
        if let Some(pairs) = &self.pairs {
            lines.add("pairs", pairs.in_words());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sample_spans_all_patches() {
        let polygons = |count: u32| (0..count).map(PolygonId).collect::<Vec<_>>();
        assert!(evenly::<PolygonId>(&[]).is_empty());
        assert_eq!(evenly(&polygons(1)), polygons(1));
        assert_eq!(evenly(&polygons(16)), polygons(16));
        let sample = evenly(&polygons(1000));
        assert!(sample.len() == 16 && sample.is_sorted() && sample[0].0 == 0 && sample[15].0 == 999, "{sample:?}");
    }
}
