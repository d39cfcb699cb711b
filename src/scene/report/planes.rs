//! Pieces by the plane they lie in.
//!
//! An f64 is a whole number times a power of two, and two has an inverse modulo an odd prime: so coordinates, and with them
//! the coefficients of planes, have residues. The coefficients of one plane through different vertices are proportional, and
//! so are their residues, unless those of one are all zero. Divided by the first that is not, they are equal: pieces in one
//! plane have one key. Pieces in different planes hardly ever have (the residues of a minor of their coefficients must vanish);
//! that has to be checked where it matters.

use super::super::{PieceId, Scene, SupportingPlane};
use glam::DVec3;

/// The largest prime below 2^32.
const PRIME: u64 = 4_294_967_291;

/// The pieces that may share a plane with pieces of other polygons, in groups, ascending: those of one plane are in one group.
/// n log n.
pub(super) fn groups(scene: &Scene) -> Vec<Vec<PieceId>> {
    let vertices: Vec<[u64; 3]> = scene.vertices().iter().map(|p| p.to_array().map(residue)).collect();
    let keys: Option<Vec<[u32; 4]>> = scene.planes().iter().map(|&plane| key(plane, &vertices)).collect();
    // No key for a plane: no plane can be told from it.
    let key = |plane: usize| keys.as_ref().map(|keys| keys[plane]);
    let mut pieces: Vec<_> = scene.pieces().map(|piece| (key(piece.plane_id().index()), piece.id())).collect();
    pieces.sort_unstable();
    let groups = pieces.chunk_by(|a, b| a.0 == b.0).map(|group| group.iter().map(|&(_, piece)| piece));
    let polygon = |piece: PieceId| scene.piece(piece).polygon();
    groups
        .filter(|group| group.clone().next().map(polygon) != group.clone().next_back().map(polygon))
        .map(Iterator::collect)
        .collect()
}

/// The residues of the coefficients of a plane, the first that is not zero made 1; `None` if all are zero.
fn key(plane: SupportingPlane, vertices: &[[u64; 3]]) -> Option<[u32; 4]> {
    let coefficients = match plane {
        SupportingPlane::Axis { axis, value } => {
            let normal = DVec3::AXES[axis as usize].to_array();
            [normal[0], normal[1], normal[2], value].map(residue)
        }
        SupportingPlane::Points(points) => {
            let [a, b, c] = points.map(|v| vertices[v.index()]);
            let [u, v] = [b, c].map(|p| [0, 1, 2].map(|k| difference(p[k], a[k])));
            let minor = |j: usize, k: usize| difference(u[j] * v[k] % PRIME, u[k] * v[j] % PRIME);
            let [x, y, z] = [minor(1, 2), minor(2, 0), minor(0, 1)];
            [x, y, z, (x * a[0] % PRIME + y * a[1] % PRIME + z * a[2] % PRIME) % PRIME]
        }
    };
    let first = coefficients.into_iter().find(|&residue| residue != 0)?;
    let inverse = power(first, PRIME - 2);
    Some(coefficients.map(|residue| (residue * inverse % PRIME) as u32))
}

fn difference(a: u64, b: u64) -> u64 {
    (a + PRIME - b) % PRIME
}

fn power(mut base: u64, mut exponent: u64) -> u64 {
    let mut result = 1;
    while exponent > 0 {
        if exponent & 1 == 1 {
            result = result * base % PRIME;
        }
        base = base * base % PRIME;
        exponent >>= 1;
    }
    result
}

/// The residue of a finite number.
fn residue(number: f64) -> u64 {
    const HALF: u64 = PRIME.div_ceil(2);
    let bits = number.to_bits();
    let (biased, fraction) = ((bits >> 52) & 0x7ff, bits & ((1 << 52) - 1));
    let mantissa = if biased == 0 { fraction } else { fraction | 1 << 52 };
    // Numbers are the mantissa times 2 to this.
    let exponent = biased.max(1) as i64 - 1075;
    let scale = power(if exponent < 0 { HALF } else { 2 }, exponent.unsigned_abs());
    let size = mantissa % PRIME * scale % PRIME;
    if number.is_sign_negative() { difference(0, size) } else { size }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Material;

    #[test]
    fn residues_add_and_multiply_as_numbers_do() {
        let tiny = f64::from_bits(1);
        for (a, b) in
            [(0.75, 3.0), (-1.5, 1.25), (5e9, -7.0), (2f64.powi(-1000), 3.0), (1e300, 2.0), (3.0 * tiny, tiny)]
        {
            assert_eq!(residue(a * b) == 0, a * b == 0.0);
            if a.abs() > 1e-300 {
                assert_eq!(residue(a * b), residue(a) * residue(b) % PRIME, "{a:e} * {b:e}");
            }
            assert_eq!(residue(b + b), (residue(b) + residue(b)) % PRIME);
            assert_eq!(residue(-a), difference(0, residue(a)), "{a:e}");
        }
        assert_eq!([0.0, -0.0, 1.0, -1.0].map(residue), [0, 0, 1, PRIME - 1]);
        assert_eq!(residue(0.5) * 2 % PRIME, 1);
        assert_eq!(residue(tiny) * power(2, 1074) % PRIME, 1);
    }

    #[test]
    fn pieces_of_one_plane_are_in_one_group_and_others_are_not() {
        // Triangles in x + 2 y = 3 z + 1, far from each other and of all sizes, and as many beside that plane.
        let mut vertices = Vec::new();
        for k in 0..40 {
            let size = 2f64.powi(k - 20);
            let at = |x: f64, y: f64, off: f64| [3.0 * x + 1.0, 3.0 * y, x + 2.0 * y + off];
            for off in [0.0, 1.0 + size] {
                vertices.extend([at(size, 0.0, off), at(size, size, off), at(0.0, 1024.0 * size, off)]);
            }
        }
        let faces: Vec<_> = (0..80).map(|k| vec![3 * k, 3 * k + 1, 3 * k + 2]).collect();
        let scene = Scene::builder().mesh(&vertices, &faces, Material::new("grey")).build().expect("sound");
        let expected: Vec<PieceId> = (0..40).map(|k| PieceId(2 * k)).collect();
        assert_eq!(groups(&scene), [expected]);
    }

    #[test]
    fn planes_whose_residues_vanish_are_told_from_none() {
        let far = PRIME as f64;
        let vertices =
            [[0., 0., 0.], [far, 0., far], [0., far, far], [1., 0., 0.], [1., 1., 0.], [0., 1., 1.], [9., 9., 9.]];
        let faces = [vec![0, 1, 2], vec![3, 4, 5], vec![0, 4, 6]];
        let scene = Scene::builder().mesh(&vertices, &faces, Material::new("grey")).build().expect("sound");
        assert_eq!(groups(&scene), [[0, 1, 2].map(PieceId)]);
    }
}
