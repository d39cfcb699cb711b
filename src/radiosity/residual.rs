//! What is left of light that bounces, made least.

use crate::factors::ViewedRows;
use glam::DVec3;
use std::collections::VecDeque;

/// So many directions are remembered. Where exchange is symmetric one would do, but for rounding.
const DIRECTIONS: usize = 8;

/// A direction changes so little of what is left, by squares, that it is left alone: light of which all but 1e-12 comes back.
const NOTHING: f64 = 1e-24;

/// Solves `x = b + T x` for irradiances x, where T is one bounce (by form factors, of what is reflected), by generalized conjugate residuals: each step takes what is left, `r = b + T x - x`, as the direction, makes
/// what that changes orthogonal to what the last ones did, and goes as far as makes r least. Colour channels are apart.
///
/// The measure is the sum of squares of r by weights. With weights D times the reflectance, where D are those of [`symmetric_weights`], T is symmetric, and it is as if all directions were remembered
/// (conjugate residuals; Stiefel 1955): the steps are as many as T has eigenvalues that are apart, such as one near 1 for each closed room that is bright.
///
/// Groups between which nothing bounces are apart, too.
pub(super) struct Residual {
    weights: Vec<DVec3>,
    /// The number of the group of each.
    groups: Vec<u32>,
    solution: Vec<DVec3>,
    left: Vec<DVec3>,
    past: VecDeque<Direction>,
}

/// A direction that was gone in.
struct Direction {
    step: Vec<DVec3>,
    /// What one step takes from what is left, and for each group the sum of its squares; 0 in channels in which it was not gone.
    change: Vec<DVec3>,
    sizes: Vec<DVec3>,
}

impl Residual {
    /// From nothing: all of b is left. `groups` are numbers below that of patches, one for each of them.
    pub(super) fn new(b: Vec<DVec3>, weights: Vec<DVec3>, groups: &[u32]) -> Self {
        let groups = groups.to_vec();
        Self { weights, groups, solution: vec![DVec3::ZERO; b.len()], left: b, past: VecDeque::new() }
    }

    /// What is left.
    pub(super) fn left(&self) -> &[DVec3] {
        &self.left
    }

    /// Takes a step, given one bounce of what is left.
    pub(super) fn reduce(&mut self, bounced: &[DVec3]) {
        let whole: Vec<DVec3> = self.left.iter().zip(bounced).map(|(&r, &t)| r - t).collect();
        let (mut step, mut change) = (self.left.clone(), whole.clone());
        let of = |sums: &[DVec3], k: usize| sums[self.groups[k] as usize];
        for past in &self.past {
            let mut along = self.products(&change, &past.change);
            for (along, &size) in along.iter_mut().zip(&past.sizes) {
                *along = DVec3::select(size.cmpgt(DVec3::ZERO), *along / size, DVec3::ZERO);
            }
            for k in 0..step.len() {
                step[k] -= of(&along, k) * past.step[k];
                change[k] -= of(&along, k) * past.change[k];
            }
        }
        let mut sizes = self.products(&change, &change);
        let (far, most) = (self.products(&self.left, &change), self.products(&self.left, &self.left));
        for k in 0..self.left.len() {
            let (far, size, most) = (of(&far, k), of(&sizes, k), of(&most, k));
            // Then it is one bounce that is added.
            let is_plain = size.cmple(NOTHING * most);
            self.solution[k] += DVec3::select(is_plain, self.left[k], far / size * step[k]);
            self.left[k] -= DVec3::select(is_plain, whole[k], far / size * change[k]);
        }
        for (size, &most) in sizes.iter_mut().zip(&most) {
            *size = DVec3::select(size.cmple(NOTHING * most), DVec3::ZERO, *size);
        }
        if self.past.len() == DIRECTIONS {
            self.past.pop_front();
        }
        self.past.push_back(Direction { step, change, sizes });
    }

    /// The solution, with what is left added: one bounce of it is all that is wrong then.
    pub(super) fn into_solution(self) -> Vec<DVec3> {
        self.solution.iter().zip(self.left).map(|(&x, r)| x + r).collect()
    }

    /// For each group, channel by channel.
    fn products(&self, a: &[DVec3], b: &[DVec3]) -> Vec<DVec3> {
        let mut sums = vec![DVec3::ZERO; self.groups.len()];
        for (k, &group) in self.groups.iter().enumerate() {
            sums[group as usize] += self.weights[k] * a[k] * b[k];
        }
        sums
    }
}

/// Weights D with `D_i F_ij = D_j F_ji`: areas, but for that rows are scaled to sum to 1. They follow from one factor to the next, as far as there are both of a pair; elsewhere they are areas.
pub(super) fn symmetric_weights(rows: &ViewedRows, areas: &[f64]) -> Vec<f64> {
    let mut weights = areas.to_vec();
    let mut is_known = vec![false; areas.len()];
    let mut queue = VecDeque::new();
    for first in 0..areas.len() {
        if std::mem::replace(&mut is_known[first], true) {
            continue;
        }
        queue.push_back(first);
        while let Some(patch) = queue.pop_front() {
            for &(other, factor) in rows.row(patch) {
                let other = other as usize;
                if std::mem::replace(&mut is_known[other], true) {
                    continue;
                }
                let back = rows.row(other).binary_search_by_key(&patch, |entry| entry.0 as usize);
                let weight = back.map_or(0.0, |place| weights[patch] * factor / rows.row(other)[place].1);
                if weight > 0.0 && weight.is_finite() {
                    weights[other] = weight;
                }
                queue.push_back(other);
            }
        }
    }
    weights
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows of a room that are not reciprocal, as where backs count as their patches, have no weights for which exchange is symmetric: what comes out is what bounces added up are, all the same.
    #[test]
    fn what_is_not_symmetric_is_solved_too() {
        // A small generator (Knuth's MMIX) of factors.
        let mut state = 5_u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        let count = 24;
        let factors: Vec<Vec<f64>> = (0..count)
            .map(|_| {
                let row: Vec<f64> = (0..count).map(|_| random().powi(4)).collect();
                let sum: f64 = row.iter().sum();
                row.into_iter().map(|factor| factor / sum).collect()
            })
            .collect();
        let reflectance: Vec<DVec3> = (0..count).map(|_| DVec3::new(random(), 0.9, 0.9 + 0.1 * random())).collect();
        let b: Vec<DVec3> = (0..count).map(|_| DVec3::new(random(), random(), 0.0)).collect();
        let weights: Vec<DVec3> = reflectance.iter().map(|&rho| rho * random()).collect();
        let bounce = |light: &[DVec3]| -> Vec<DVec3> {
            let at = |row: &Vec<f64>| (0..count).map(|k| light[k] * reflectance[k] * row[k]).sum();
            factors.iter().map(at).collect()
        };
        let mut added_up = b.clone();
        for _ in 0..3000 {
            added_up = bounce(&added_up).iter().zip(&b).map(|(&bounced, &b)| bounced + b).collect();
        }
        let mut residual = Residual::new(b, weights, &[0; 24]);
        let left = |residual: &Residual| residual.left().iter().fold(0.0, |m: f64, r| m.max(r.abs().max_element()));
        let mut steps = 0;
        while left(&residual) > 1e-14 {
            residual.reduce(&bounce(residual.left()));
            steps += 1;
            assert!(steps < 100, "{}", left(&residual));
        }
        for (found, expected) in residual.into_solution().into_iter().zip(added_up) {
            // What is left, and rounding, over the tenth that is absorbed of a bounce.
            assert!((found - expected).abs().max_element() < 1e-12, "{found} {expected}");
        }
    }

    /// Light of which nothing comes to an end is bounced on, and no number breaks.
    #[test]
    fn where_nothing_is_absorbed_bounces_are_added() {
        let b = vec![DVec3::new(1.0, 0.0, 2f64.powi(-600)); 3];
        let mut residual = Residual::new(b.clone(), vec![DVec3::ONE; 3], &[0; 3]);
        for _ in 0..20 {
            let bounced = residual.left().to_vec();
            residual.reduce(&bounced);
        }
        assert_eq!(residual.left(), b);
        assert_eq!(residual.into_solution(), vec![DVec3::new(21.0, 0.0, 21.0 * 2f64.powi(-600)); 3]);
    }
}
