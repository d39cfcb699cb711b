//! Cutting a convex spherical polygon, exactly and without making a corner.

use crate::exact::Sign;

/// Cuts what is outside of a half sphere off a convex polygon; false if nothing with an interior is left.
///
/// A polygon is a cyclic list of half spheres whose intersection it is, with an interior; side `k` runs from corner `k`,
/// where it meets side `k - 1`, to corner `k + 1`. `orientation` is the sign of the determinant of three inward normals.
pub(super) fn clip<T: Clone>(polygon: &mut Vec<T>, half: &T, mut orientation: impl FnMut([&T; 3]) -> Sign) -> bool {
    let len = polygon.len();
    let signs: Vec<Sign> = (0..len)
        .map(|k| {
            let before = &polygon[if k == 0 { len - 1 } else { k - 1 }];
            orientation([before, &polygon[k], half])
        })
        .collect();
    if !signs.contains(&Sign::Negative) {
        return true;
    }
    // The polygon has an interior, so what touches the inside only from outside has none.
    let next = |k: usize| if k + 1 == len { 0 } else { k + 1 };
    let leaves = |k: &usize| signs[*k].is_positive() && !signs[next(*k)].is_positive();
    let Some(last) = (0..len).find(leaves) else { return false };
    // What is kept is one run of sides, from where the polygon comes back inside to `last`.
    let mut kept = vec![half.clone()];
    let mut k = next(last);
    loop {
        if signs[k].is_positive() || signs[next(k)].is_positive() {
            kept.push(polygon[k].clone());
        }
        if k == last {
            break;
        }
        k = next(k);
    }
    *polygon = kept;
    true
}
