//! Which patches are too large for what changes on them.

use super::corners::Corners;
use super::rings::mean_of;
use super::{Gather, RadiosityError, strength};
use crate::scene::{PieceRef, PolygonId, Scene};
use glam::DVec3;

/// For every patch, whether radiosities gathered at its corners and in its middle differ by more than that part of their mean, or of the mean of what all
/// patches reflect if that is larger (by the color channel in which they differ most). Such patches are to be halved ([`PatchMesh::halved`](crate::factors::PatchMesh::halved)).
///
/// The scene is that of the patches; corners are shared by patches of one region ([`PatchMesh::regions`](crate::factors::PatchMesh::regions)), but not by both sides of what stands on it. The cost is a view for
/// every corner and every patch that reflects; `done` is told from any thread how many more views are made. Corners are taken a thousandth of the way inside, and left out where they are covered.
///
/// # Errors
/// If there is no view from some point.
///
/// # Panics
/// If `regions` does not name one for every patch.
pub fn uneven_patches(
    patches: &Scene,
    regions: &[PolygonId],
    gather: &Gather<'_>,
    part: f64,
    done: &(dyn Fn(usize) + Sync),
) -> Result<Vec<bool>, RadiosityError> {
    let reflects = |piece: &PieceRef<'_>| gather.reflected(piece.polygon().index()).is_some();
    let pieces: Vec<PieceRef<'_>> = patches.pieces().filter(reflects).collect();
    let corners = Corners::new(patches, &pieces, |piece| regions[piece.polygon().index()]);
    let mut places = corners.places;
    let mut places_of = vec![Vec::new(); patches.polygon_count()];
    for (piece, numbers) in pieces.iter().zip(corners.of_pieces) {
        let own = &mut places_of[piece.polygon().index()];
        own.extend(numbers.into_iter().map(|number| number as usize));
        own.push(places.len());
        places.push((piece.polygon(), mean_of(&piece.points().collect::<Vec<_>>())));
    }
    let found = gather.uncovered_at_all(places, done)?;
    let mean = mean_reflected(gather);
    let is_uneven = |(patch, places): (usize, Vec<usize>)| {
        let emission = gather.emission(PolygonId(patch as u32));
        let reflected: Vec<DVec3> = places.iter().filter_map(|&k| found[k]).map(|b| b - emission).collect();
        let Some(&first) = reflected.first() else { return false };
        let (low, high) = reflected.iter().fold((first, first), |(low, high), &b| (low.min(b), high.max(b)));
        let own = reflected.iter().sum::<DVec3>() / reflected.len() as f64;
        3.0 * (high - low).max_element() > part * strength(own).max(mean)
    };
    Ok(places_of.into_iter().enumerate().map(is_uneven).collect())
}

/// The mean of what is reflected over the area of all patches that reflect.
fn mean_reflected(gather: &Gather<'_>) -> f64 {
    let (mut power, mut area) = (0.0, 0.0);
    for (patch, info) in gather.exchange().patches().iter().enumerate() {
        if let Some(reflected) = gather.reflected(patch) {
            power += info.area * strength(reflected).max(0.0);
            area += info.area;
        }
    }
    if area > 0.0 { power / area } else { 0.0 }
}
