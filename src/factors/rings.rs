//! Convex polygons in a plane, one after another in one list that is used again.

use glam::DVec2;

#[derive(Default)]
pub(super) struct Rings {
    points: Vec<DVec2>,
    /// Where each ends.
    ends: Vec<usize>,
}

impl Rings {
    pub(super) fn clear(&mut self) {
        self.points.clear();
        self.ends.clear();
    }

    /// Makes one polygon all there is; nothing if it has less than three corners.
    pub(super) fn set(&mut self, ring: impl Iterator<Item = DVec2>) {
        self.clear();
        self.push_by(|points| points.extend(ring));
    }

    pub(super) fn push(&mut self, ring: &[DVec2]) {
        self.push_by(|points| points.extend_from_slice(ring));
    }

    /// Adds the polygon of the corners that `add` adds to a list; false if these are less than three, which are none.
    pub(super) fn push_by(&mut self, add: impl FnOnce(&mut Vec<DVec2>)) -> bool {
        let first = self.points.len();
        add(&mut self.points);
        let is_one = self.points.len() >= first + 3;
        if is_one {
            self.ends.push(self.points.len());
        } else {
            self.points.truncate(first);
        }
        is_one
    }

    pub(super) fn count(&self) -> usize {
        self.ends.len()
    }

    /// The corners of all.
    pub(super) fn points(&self) -> &[DVec2] {
        &self.points
    }

    pub(super) fn all(&self) -> impl Iterator<Item = &[DVec2]> {
        self.ends.iter().scan(0, |first, &end| {
            let start = std::mem::replace(first, end);
            Some(&self.points[start..end])
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polygons_follow_each_other_and_what_has_no_area_is_none() {
        let ring = |count: u32, x: f64| (0..count).map(|k| DVec2::new(x, f64::from(k))).collect::<Vec<_>>();
        let mut rings = Rings::default();
        rings.set(ring(2, 0.0).into_iter());
        assert_eq!((rings.count(), rings.points().len()), (0, 0));
        rings.set(ring(3, 1.0).into_iter());
        rings.push(&ring(5, 2.0));
        assert!(!rings.push_by(|points| points.extend(ring(2, 9.0))));
        assert!(rings.push_by(|points| points.extend(ring(4, 3.0))));
        assert!(rings.all().eq([ring(3, 1.0), ring(5, 2.0), ring(4, 3.0)]));
        assert_eq!(rings.points().len(), 12);
        rings.clear();
        assert_eq!((rings.count(), rings.points().len()), (0, 0));
    }
}
