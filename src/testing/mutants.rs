//! Evidence with a change in it, and whether the checker sees that.

use super::{Defect, inner_directions};
use crate::contour::{ContourImage, Location};
use crate::exact::{Direction, Kernel, Sign};
use crate::scene::{PieceId, PolygonId, Scene, Splitter};
use crate::verify::{self, Arithmetic, Evidence, EvidenceDomain, EvidencePane, HalfSphere};
use glam::DVec3;

/// Evidence changed in one way, chosen by the first byte; the others say where. The change may be one that leaves
/// what is claimed as it was.
///
/// `scene` must have pieces. Of evidence without cells the domain is changed.
pub fn mutated(evidence: &Evidence, scene: &Scene, bytes: [u8; 8]) -> Evidence {
    let mut changed = evidence.clone();
    if evidence.cells.is_empty() {
        changed.domain = other_domain(&evidence.domain, bytes);
        return changed;
    }
    let number = |k: usize| usize::from(bytes[k]) << 8 | usize::from(bytes[k + 1]);
    let cell = number(1) % evidence.cells.len();
    let other = number(3) % evidence.cells.len();
    let sides = evidence.cells[cell].sides.len();
    let side = number(5) % sides;
    let splitter = number(3) % evidence.splitters.len();
    let piece = Some(PieceId((number(3) % scene.piece_count()) as u32));
    match bytes[0] % 16 {
        0 => drop(changed.cells.remove(cell)),
        1 => changed.cells.push(evidence.cells[cell].clone()),
        2 => changed.cells[cell].piece = piece,
        3 => changed.cells[cell].piece = None,
        4 => {
            changed.cells[cell].piece = evidence.cells[other].piece;
            changed.cells[other].piece = evidence.cells[cell].piece;
        }
        5 => changed.cells[cell].sides[side].inside = -evidence.cells[cell].sides[side].inside,
        6 => drop(changed.cells[cell].sides.remove(side)),
        7 => changed.cells[cell].sides[side].splitter = splitter as u32,
        8 => {
            let half = HalfSphere { splitter: splitter as u32, inside: evidence.cells[cell].sides[side].inside };
            changed.cells[cell].sides.insert(side, half);
        }
        9 => changed.cells[cell].sides.swap(side, usize::from(bytes[7]) % sides),
        10 => {
            // In all its cells.
            let splitter = evidence.cells[cell].sides[side].splitter as usize;
            changed.splitters[splitter] = nudged(evidence, scene, splitter, bytes[7]);
        }
        11 => {
            // In one cell.
            let splitter = evidence.cells[cell].sides[side].splitter as usize;
            changed.cells[cell].sides[side].splitter = evidence.splitters.len() as u32;
            changed.splitters.push(nudged(evidence, scene, splitter, bytes[7]));
        }
        12 => {
            // All cells that show a piece show another one.
            let from = evidence.cells[cell].piece;
            changed.cells.iter_mut().filter(|cell| cell.piece == from).for_each(|cell| cell.piece = piece);
        }
        13 => changed.domain = other_domain(&evidence.domain, bytes),
        14 => changed.cells[cell].sides.rotate_left(side),
        _ => changed.cells.swap(cell, other),
    }
    changed
}

/// A hemisphere, or a domain of the same kind.
fn other_domain(domain: &EvidenceDomain, bytes: [u8; 8]) -> EvidenceDomain {
    let axis = usize::from(bytes[7]) % 3;
    match (domain, bytes[6] % 4) {
        (EvidenceDomain::Frustum(normals), 0..2) => {
            let mut normals = *normals;
            normals[usize::from(bytes[5]) % 4][axis] += f64::from(bytes[4]) * 1e-12;
            EvidenceDomain::Frustum(normals)
        }
        (EvidenceDomain::Window { panes, horizon }, 0) => {
            let panes = panes.iter().skip(1).cloned().collect();
            EvidenceDomain::Window { panes, horizon: *horizon }
        }
        (EvidenceDomain::Window { panes, horizon }, 1) => {
            let more = EvidencePane::Polygon(PolygonId(0));
            EvidenceDomain::Window { panes: panes.iter().cloned().chain([more]).collect(), horizon: *horizon }
        }
        (EvidenceDomain::Window { panes, .. }, 2) => EvidenceDomain::Window { panes: panes.clone(), horizon: None },
        _ => EvidenceDomain::Hemisphere(DVec3::AXES[axis]),
    }
}

/// About the same great circle, given by three numbers.
fn nudged(evidence: &Evidence, scene: &Scene, splitter: usize, how: u8) -> Splitter {
    let from_eye = |v| scene.vertex(v) - evidence.eye;
    let normal = match evidence.splitters[splitter] {
        Splitter::Edge([a, b]) => from_eye(a).cross(from_eye(b)),
        Splitter::Points([a, b]) => (a - evidence.eye).cross(b - evidence.eye),
        Splitter::Given(normal) => normal,
        same @ (Splitter::Crease(_) | Splitter::Parallel(_)) => return same,
    };
    let mut nudged = normal;
    let axis = usize::from(how) % 3;
    nudged[axis] = if how & 128 == 0 { nudged[axis].next_up() } else { nudged[axis] * (1.0 + 1e-6) };
    if nudged.is_finite() { Splitter::Given(nudged) } else { evidence.splitters[splitter] }
}

/// Checks that both arithmetics come to the same verdict on changed evidence of an image, and that if they accept it, it
/// claims what the image shows. Gives whether it was accepted.
///
/// Cost: the two proofs, and for each cell of the image up to three directions against all cells of the evidence.
///
/// # Errors
/// If the verdicts differ, or if something else is claimed in some direction. Where epsilon is above 0 that may be
/// right, so labels are compared only if it is 0.
pub fn check_verdict(image: &ContourImage, changed: &Evidence) -> Result<bool, Defect> {
    let scene = image.scene();
    let verdicts = [Arithmetic::Kernel, Arithmetic::Rational].map(|arithmetic| changed.check(scene, arithmetic));
    let [fast, slow] =
        verdicts.each_ref().map(|verdict| verdict.as_ref().map(|c| c.cells).map_err(verify::Defect::rule));
    if fast != slow {
        let [kernel, rational] = verdicts.map(|verdict| format!("{verdict:?}"));
        return Err(Defect::Verdicts { kernel, rational });
    }
    if fast.is_err() || changed.epsilon > 0.0 {
        return Ok(fast.is_ok());
    }
    let mut kernel = Kernel::new(scene.vertices().iter().copied(), changed.eye);
    for cell in image.cells() {
        for direction in inner_directions(cell) {
            if image.locate(direction) != Location::Cell(cell.id()) {
                continue;
            }
            let mut is_touched = false;
            let mut claims = Vec::new();
            for claim in &changed.cells {
                let signs = claim.sides.iter().map(|side| {
                    let splitter = scene.resolve_splitter(changed.splitters[side.splitter as usize]);
                    kernel.side(&Direction::Given(direction), &splitter) * side.inside
                });
                match signs.min() {
                    Some(Sign::Positive) => claims.push(claim.piece),
                    Some(Sign::Zero) => is_touched = true,
                    Some(Sign::Negative) | None => {}
                }
            }
            if !is_touched && claims != [cell.piece()] {
                return Err(Defect::Accepted { direction, claims, shown: cell.piece() });
            }
        }
    }
    Ok(true)
}
