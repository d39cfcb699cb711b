//! Directions as sums of two vectors, to twice the precision of `f64`: for numbers, never for decisions.

use super::{CircleId, Constructor, DirectionDef, DirectionId, Directions, ExactCache};
use crate::bsp::Skeleton;
use crate::exact::double::{Double3, cross, difference};
use crate::exact::{Point, Splitter};
use crate::scene::PlaneId;
use glam::DVec3;

impl Directions {
    /// The direction, of any length, to a relative error below 1e-21: in double-double arithmetic where that is certain, else from integers.
    pub(crate) fn doubled(&self, skeleton: &Skeleton, d: DirectionId, cache: &mut ExactCache) -> [DVec3; 2] {
        match self.definitions[d.0 as usize] {
            DirectionDef::Point(point) => match skeleton.resolved_point(skeleton.point(point)) {
                Point::Given(p) if is_moderate(p - self.eye) => halves(&difference(p, self.eye)),
                _ => {
                    let exact = self.exact_point(skeleton, point, cache);
                    cache.arena.kept_sum(&exact)
                }
            },
            DirectionDef::Towards(point) => {
                let point = self.vector(point);
                if is_moderate(point - self.eye) {
                    return halves(&difference(point, self.eye));
                }
                let exact = self.exact_towards(point, cache);
                cache.arena.kept_sum(&exact)
            }
            DirectionDef::Crossing { circles, reversed } => {
                let [m, n] = if reversed { [circles[1], circles[0]] } else { circles };
                if let Some([m, n]) =
                    self.quick_normal(skeleton, m).zip(self.quick_normal(skeleton, n)).map(<[_; 2]>::from)
                {
                    let crossing = halves(&cross(&m, &n));
                    let [m, n] = [halves(&m)[0], halves(&n)[0]];
                    // Otherwise the circles nearly coincide, and too much has cancelled.
                    if crossing[0].length_squared() > 1e-8 * m.length_squared() * n.length_squared() {
                        return crossing;
                    }
                }
                let [m, n] = [m, n].map(|c| self.exact_normal(skeleton, c, cache));
                cache.arena.kept_cross_sum(&m, &n)
            }
        }
    }

    /// A plane's normal, pointing to its front, likewise.
    pub(crate) fn doubled_normal(&self, skeleton: &Skeleton, plane: PlaneId, cache: &mut ExactCache) -> [DVec3; 2] {
        let definition = Splitter::Parallel(skeleton.resolved_plane(plane));
        let normal = Constructor { frame: &self.frame, arena: &mut cache.arena }.keep_splitter(&definition);
        cache.arena.kept_sum(&normal)
    }

    /// The normal of a great circle through an edge, or of one that is given: each component is off by 2^-98 of the length at most. Its
    /// length is that of an edge times a distance, 1e-60 to 1e60; `None` beyond that.
    fn quick_normal(&self, skeleton: &Skeleton, c: CircleId) -> Option<Double3> {
        match self.resolved(skeleton, c) {
            Splitter::Edge([a, b]) => {
                // As in `Approx3::edge_normal`: this keeps the accuracy of short edges.
                let (to, along) = (difference(a, self.eye), difference(b, a));
                let normal = cross(&to, &along);
                let [to, along, length] = [to, along, normal].map(|v| halves(&v)[0]);
                let is_good = is_moderate(to) && is_moderate(along);
                // Seen along the edge, nearly: too much has cancelled.
                let keeps = length.length_squared() > 1e-8 * to.length_squared() * along.length_squared();
                (is_good && keeps).then_some(normal)
            }
            Splitter::Given(normal) => is_moderate(normal).then(|| difference(normal, DVec3::ZERO)),
            Splitter::Crease(_) | Splitter::Parallel(_) => None,
        }
    }
}

/// True for vectors of which products of four neither over- nor underflow.
fn is_moderate(v: DVec3) -> bool {
    (1e-30..1e30).contains(&v.abs().max_element())
}

fn halves(v: &Double3) -> [DVec3; 2] {
    [DVec3::from(v.map(|x| x.hi)), DVec3::from(v.map(|x| x.lo))]
}
