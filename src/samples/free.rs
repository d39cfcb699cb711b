//! Where a sample scene is empty: for tests that need points to look from.

use super::rng::Rng;
use super::ticks::{Frame, metres};
use crate::scene::Axis;

/// A box along the axes of a frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct Block {
    pub(super) frame: Frame,
    /// Its least corner.
    pub(super) low: [i64; 3],
    /// Its greatest corner.
    pub(super) high: [i64; 3],
}

/// A ball, in metres.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ball {
    pub(super) centre: [f64; 3],
    pub(super) radius: f64,
}

/// Something that stands in the scene, without its tessellation.
#[derive(Clone, Debug)]
pub(super) enum Solid {
    Block(Block),
    Ball(Ball),
    /// What is behind all of some planes, each by its unit normal and its distance from the origin.
    Convex(Vec<([f64; 3], f64)>),
}

impl Solid {
    /// The distance from a point to the solid, up to rounding, or less; 0 inside.
    pub(super) fn distance(&self, point: [f64; 3]) -> f64 {
        match self {
            Self::Block(Block { frame, low, high }) => {
                let [x, y, z] = frame.local(point);
                let outside = |axis: usize, at: f64| (metres(low[axis]) - at).max(at - metres(high[axis])).max(0.0);
                let [dx, dy, dz] = [outside(0, x), outside(1, y), outside(2, z)];
                (dx * dx + dy * dy + dz * dz).sqrt()
            }
            Self::Ball(Ball { centre, radius }) => {
                let [dx, dy, dz] = [0, 1, 2].map(|axis| point[axis] - centre[axis]);
                ((dx * dx + dy * dy + dz * dz).sqrt() - radius).max(0.0)
            }
            Self::Convex(planes) => {
                let above = planes.iter().map(|(n, d)| n[0] * point[0] + n[1] * point[1] + n[2] * point[2] - d);
                above.fold(0.0, f64::max)
            }
        }
    }
}

/// A box of air with solids in it.
#[derive(Clone, Debug)]
pub(super) struct FreeSpace {
    /// The least corner of the air.
    pub(super) low: [f64; 3],
    /// Its greatest corner.
    pub(super) high: [f64; 3],
    /// Which way is up; the floor is the air's lower side in this direction.
    pub(super) up: Axis,
    /// How far free points keep from everything.
    pub(super) margin: f64,
    /// What stands in the air.
    pub(super) solids: Vec<Solid>,
}

impl FreeSpace {
    /// The distance to the nearest solid or side of the air; 0 inside solids and outside the air.
    pub(super) fn clearance(&self, point: [f64; 3]) -> f64 {
        let sides = (0..3).map(|axis| (point[axis] - self.low[axis]).min(self.high[axis] - point[axis]));
        sides.fold(self.distance_to_solids(point), f64::min).max(0.0)
    }

    /// `count` points that keep the margin from everything.
    pub(super) fn points(&self, count: usize, seed: u64) -> Vec<[f64; 3]> {
        self.sample(count, seed, |point| point)
    }

    /// `count` points on the floor that keep the margin from solids and walls.
    pub(super) fn floor_points(&self, count: usize, seed: u64) -> Vec<[f64; 3]> {
        let up = self.up as usize;
        self.sample(count, seed, |mut point| {
            point[up] = self.low[up];
            point
        })
    }

    fn distance_to_solids(&self, point: [f64; 3]) -> f64 {
        self.solids.iter().map(|solid| solid.distance(point)).fold(f64::INFINITY, f64::min)
    }

    /// By rejection. All our scenes are mostly air, also near the floor, so this ends.
    fn sample(&self, count: usize, seed: u64, place: impl Fn([f64; 3]) -> [f64; 3]) -> Vec<[f64; 3]> {
        let mut rng = Rng::new(seed);
        let inside =
            |rng: &mut Rng, axis: usize| rng.between(self.low[axis] + self.margin, self.high[axis] - self.margin);
        let mut points = Vec::with_capacity(count);
        while points.len() < count {
            let point = place([inside(&mut rng, 0), inside(&mut rng, 1), inside(&mut rng, 2)]);
            if self.distance_to_solids(point) >= self.margin {
                points.push(point);
            }
        }
        points
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::{Kind, Mesh, generate};

    /// A block's corners in plan, and its reach in height.
    fn plan(block: &Block) -> ([[f64; 2]; 4], [f64; 2]) {
        let Block { frame, low, high } = block;
        let corners = [[low[0], low[1]], [high[0], low[1]], [high[0], high[1]], [low[0], high[1]]];
        let plan = corners.map(|[x, y]| frame.world([x, y, 0])).map(|[x, y, _]| [x, y]);
        (plan, [metres(low[2]), metres(high[2])])
    }

    /// The greatest distance between parallel lines or planes that separate two blocks; not positive
    /// if they overlap or touch.
    fn gap(one: &Block, other: &Block) -> f64 {
        let ((a, a_reach), (b, b_reach)) = (plan(one), plan(other));
        let mut gap = (a_reach[0] - b_reach[1]).max(b_reach[0] - a_reach[1]);
        for corners in [a, b] {
            for k in 0..4 {
                let ([x0, y0], [x1, y1]) = (corners[k], corners[(k + 1) % 4]);
                let (nx, ny) = (y1 - y0, x0 - x1);
                let length = (nx * nx + ny * ny).sqrt();
                let shadow = |corners: [[f64; 2]; 4]| corners.map(|[x, y]| (x * nx + y * ny) / length);
                let least = |plan| shadow(plan).into_iter().fold(f64::INFINITY, f64::min);
                let greatest = |plan| shadow(plan).into_iter().fold(f64::NEG_INFINITY, f64::max);
                gap = gap.max(least(a) - greatest(b)).max(least(b) - greatest(a));
            }
        }
        gap
    }

    fn scenes() -> impl Iterator<Item = Mesh> {
        let sizes = [(100, 0), (1000, 1), (1500, 2), (5000, 3), (20_000, 4)];
        [Kind::Room, Kind::Office].into_iter().flat_map(move |kind| {
            sizes.map(|(polygons, seed)| generate(kind, polygons, seed).expect("the count is in range"))
        })
    }

    #[test]
    fn things_touch_exactly_or_keep_apart() {
        for mesh in scenes() {
            let solids = &mesh.free_space().solids;
            for (k, one) in solids.iter().enumerate() {
                for other in &solids[..k] {
                    let gap = match (one, other) {
                        (Solid::Block(one), Solid::Block(other)) => gap(one, other),
                        (Solid::Ball(ball), other) | (other, Solid::Ball(ball)) => {
                            other.distance(ball.centre) - ball.radius
                        }
                        (Solid::Convex(_), _) | (_, Solid::Convex(_)) => unreachable!("not in generated scenes"),
                    };
                    // What touches is laid out in ticks, so there is nothing between 0 and 0.9 mm.
                    assert!(gap.abs() < 1e-12 || gap > 9e-4, "{gap}: {one:?} {other:?}");
                }
            }
        }
    }

    #[test]
    fn things_are_inside_the_room() {
        for mesh in scenes() {
            let FreeSpace { low, high, solids, .. } = mesh.free_space();
            let walls = |[x, y]: [f64; 2]| (x - low[0]).min(high[0] - x).min(y - low[1]).min(high[1] - y);
            for solid in solids {
                let (sideways, floor, top) = match solid {
                    Solid::Block(block) => {
                        let (corners, [floor, top]) = plan(block);
                        (corners.map(walls).into_iter().fold(f64::INFINITY, f64::min), floor, top)
                    }
                    Solid::Ball(Ball { centre: [x, y, z], radius }) => {
                        (walls([*x, *y]) - radius, z - radius, z + radius)
                    }
                    Solid::Convex(_) => unreachable!("not in generated scenes"),
                };
                assert!(sideways > 0.01 && floor >= 0.0 && top < high[2] - 0.3, "{solid:?}");
            }
        }
    }
}
