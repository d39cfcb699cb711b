//! Which names of great circles mean the same one.

use super::mosaic::Mosaic;
use crate::contour::directions::CircleId;
use crate::contour::polygon::HalfSphere;
use crate::exact::Sign;
use glam::DVec3;
use num_bigint::BigInt;
use rustc_hash::FxHashMap;

const UNUSED: u32 = u32::MAX;

/// The great circles that sides lie on, each once, numbered from 0 in the order of their lowest names.
pub(crate) struct GreatCircles {
    /// For every name the number, and whether the normals point the same way.
    of: Vec<(u32, Sign)>,
    /// The lowest name of each: its normal is the great circle's.
    lowest: Vec<CircleId>,
}

impl GreatCircles {
    /// Finds them. Equal great circles have the same cosine with any fixed axis, but for rounding. Sorted by that, only
    /// those closer than what rounding can do are compared, as vectors of whole numbers without a common divisor. The names
    /// in `also` get a number even if no side is on such a great circle.
    pub(crate) fn new(mosaic: &mut Mosaic<'_>, also: &[CircleId]) -> Self {
        let axis = DVec3::new(0.541_196_1, 0.306_562_96, 0.783_036_4);
        let count = mosaic.directions.circle_count();
        let mut is_used = vec![false; count];
        for arc in mosaic.faces.iter().flat_map(|face| mosaic.boundary(face)) {
            is_used[arc.along.circle().0 as usize] = true;
        }
        for circle in also {
            is_used[circle.0 as usize] = true;
        }
        let used = (0..count as u32).filter(|&k| is_used[k as usize]);
        let cosine = |k: u32| mosaic.directions.normal(CircleId(k)).v.normalize_or_zero().dot(axis).abs();
        let mut order: Vec<(f64, u32)> = used.map(|k| (cosine(k), k)).collect();
        order.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let mut lowest_of: Vec<(u32, Sign)> = (0..count as u32).map(|k| (k, Sign::Positive)).collect();
        // A normal is known to 1e-13 of its largest component, so each cosine is off by less than 4e-13.
        for near in order.chunk_by_mut(|a, b| b.0 - a.0 < 1e-12).filter(|near| near.len() > 1) {
            near.sort_unstable_by_key(|&(_, k)| k);
            let mut firsts: FxHashMap<[BigInt; 3], (u32, Sign)> = FxHashMap::default();
            for &(_, k) in &*near {
                let Mosaic { skeleton, directions, knife, .. } = &mut *mosaic;
                let (primitive, sign) = directions.primitive_normal(skeleton, CircleId(k), &mut knife.cache);
                let (first, first_sign) = *firsts.entry(primitive).or_insert((k, sign));
                lowest_of[k as usize] = (first, sign * first_sign);
            }
        }
        let mut of = vec![(UNUSED, Sign::Positive); count];
        let mut lowest = Vec::new();
        for k in (0..count).filter(|&k| is_used[k]) {
            let (first, sign) = lowest_of[k];
            if first == k as u32 {
                of[k] = (lowest.len() as u32, sign);
                lowest.push(CircleId(first));
            } else {
                of[k] = (of[first as usize].0, sign);
            }
        }
        Self { of, lowest }
    }

    /// The great circle's number, and the sign that the inside has for its normal.
    pub(crate) fn of(&self, half: HalfSphere) -> (u32, Sign) {
        let (circle, sign) = self.of[half.circle().0 as usize];
        (circle, sign * half.inside())
    }

    /// The number of a great circle by one of the names that it was found by.
    pub(super) fn number(&self, name: CircleId) -> u32 {
        self.of[name.0 as usize].0
    }

    /// The name whose normal is the great circle's.
    pub(crate) fn name(&self, circle: u32) -> CircleId {
        self.lowest[circle as usize]
    }

    pub(crate) fn count(&self) -> usize {
        self.lowest.len()
    }
}
