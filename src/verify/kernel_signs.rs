//! Signs from the kernel that the engine uses: fast.

use super::evidence::HalfSphere;
use super::signs::Signs;
use crate::exact::{ApproxPlane, CircleRelation, Direction, Kernel, Plane, Point, SeenBox, Sign, Splitter, SplitterId};
use crate::scene::Scene;
use glam::DVec3;

/// So many pairs of great circles are compared at most, beside a few for each: about a minute.
const COMPARISONS: usize = 1 << 26;

/// The kernel, with what it was asked to take in.
pub(super) struct KernelSigns {
    kernel: Kernel,
    ids: Vec<SplitterId>,
    splitters: Vec<Splitter>,
    planes: Vec<(Plane, ApproxPlane)>,
}

impl KernelSigns {
    pub(super) fn new(scene: &Scene, eye: DVec3) -> Self {
        let kernel = Kernel::new(scene.vertices().iter().copied(), eye);
        Self { kernel, ids: Vec::new(), splitters: Vec::new(), planes: Vec::new() }
    }
}

impl Signs for KernelSigns {
    fn add(&mut self, splitter: &Splitter) -> u32 {
        self.ids.push(self.kernel.add_splitter(splitter));
        self.splitters.push(*splitter);
        self.ids.len() as u32 - 1
    }

    fn add_plane(&mut self, plane: &Plane) -> u32 {
        self.planes.push((*plane, ApproxPlane::new(plane)));
        self.planes.len() as u32 - 1
    }

    #[inline]
    fn orientation(&mut self, splitters: [u32; 3]) -> Sign {
        self.kernel.orientation_of(splitters.map(|s| self.ids[s as usize]))
    }

    fn side(&mut self, direction: DVec3, splitter: u32) -> Sign {
        self.kernel.side(&Direction::Given(direction), &self.splitters[splitter as usize])
    }

    fn height(&mut self, point: DVec3, plane: u32) -> Sign {
        self.kernel.plane_side(&Point::Given(point), &self.planes[plane as usize].0)
    }

    /// Equal great circles have the same cosine with any fixed axis, but for rounding. Sorted by that, only
    /// those closer than what rounding can do are compared exactly.
    fn great_circles(&mut self) -> Option<Vec<(u32, Sign)>> {
        let axis = DVec3::new(0.541_196_1, 0.306_562_96, 0.783_036_4);
        let cosine = |k: u32| self.rounded(k).normalize_or_zero().dot(axis).abs();
        let mut order: Vec<(f64, u32)> = (0..self.ids.len() as u32).map(|k| (cosine(k), k)).collect();
        order.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let mut circles = vec![(0, Sign::Positive); self.ids.len()];
        let mut firsts: Vec<(f64, u32)> = Vec::new();
        // A few comparisons a circle are needed where nobody has put thousands within 1e-12 of each other.
        let mut left = COMPARISONS + 16 * order.len();
        for (cosine, k) in order {
            // The kernel knows a normal to 1e-13 of its largest component or better, so each cosine is off by
            // less than 4e-13.
            let near = firsts.iter().rev().take_while(|first| cosine - first.0 < 1e-12).take(left);
            let known = near.map(|first| first.1).find_map(|first| {
                left = left.saturating_sub(1);
                let [a, b] = [first, k].map(|s| self.ids[s as usize]);
                match self.kernel.compare_circles_of(a, b) {
                    CircleRelation::Same => Some((first, Sign::Positive)),
                    CircleRelation::Opposite => Some((first, Sign::Negative)),
                    CircleRelation::Different => None,
                }
            });
            if left == 0 {
                return None;
            }
            circles[k as usize] = known.unwrap_or_else(|| {
                firsts.push((cosine, k));
                (k, Sign::Positive)
            });
        }
        Some(circles)
    }

    fn box_outside(&mut self, sides: &[HalfSphere], [low, high]: [DVec3; 2]) -> bool {
        let seen = SeenBox::new(self.kernel.eye(), low, high);
        sides.iter().any(|side| {
            let normal = self.kernel.approx_normal(self.ids[side.splitter as usize]);
            seen.side(normal).is_some_and(|s| s != side.inside)
        })
    }

    fn box_beyond(&mut self, plane: u32, side: Sign, [low, high]: [DVec3; 2]) -> bool {
        let plane = &self.planes[plane as usize].1;
        SeenBox::new(plane.anchor, low, high).side(&plane.normal) == Some(side)
    }

    fn definition(&self, splitter: u32) -> &Splitter {
        &self.splitters[splitter as usize]
    }

    fn rounded(&self, splitter: u32) -> DVec3 {
        self.kernel.approx_normal(self.ids[splitter as usize]).v
    }

    fn decisions(&self) -> u64 {
        self.kernel.stats().calls()
    }
}
