//! Form factors by counting rays.

use super::error::BaselineError;
use super::face::frame;
use super::geometry::{inverse_power_of_two, unit_normal};
use crate::contour::Viewpoint;
use crate::scene::{PieceId, PieceRef, PlaneId, PolygonId, Scene};
use glam::{DVec2, DVec3, Vec3A};
use obvhs::BvhBuildParams;
use obvhs::aabb::Aabb;
use obvhs::cwbvh::CwBvh;
use obvhs::cwbvh::builder::build_cwbvh;
use obvhs::ray::{Ray, RayHit};
use std::f64::consts::FRAC_PI_4;
use std::time::Duration;

/// Monte Carlo estimates of form factors for the views of one scene: rays with a cosine distribution, through a bounding volume
/// hierarchy.
///
/// The unit disc of Nusselt's analog is cut into as many parts of equal area as there are rays, compact ones, and a ray
/// goes through a random point of each. The share of rays that meet a polygon is an unbiased estimate of its form factor. The hierarchy is
/// an eight-wide compressed one of the crate `obvhs`, whose boxes are f32, made a little larger; pieces are met in f64. The same
/// input gives the same rays.
///
/// ```
/// use nusselt::contour::Viewpoint;
/// use nusselt::hemicube::Rays;
///
/// let scene = nusselt::samples::cornell_box().to_builder().build()?;
/// let mut rays = Rays::new(&scene);
/// let view = rays.view(&Viewpoint::free(glam::DVec3::new(278.0, 273.0, 1.0)), glam::DVec3::Z, 10_000, 1)?;
/// let ceiling = nusselt::scene::PolygonId(0);
/// println!("{} +- {}", view.of(ceiling), view.standard_error(ceiling));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone)]
pub struct Rays {
    scene: Scene,
    local: Local,
    bvh: Option<CwBvh>,
    /// The plane of each piece and then, for each of its edges, the plane through it across the piece, with what is inside in
    /// front.
    planes: Vec<Plane>,
    /// Where the planes of each piece begin, and where the last ones end.
    starts: Vec<u32>,
    /// By polygon, with background at the end.
    hits: Vec<u32>,
}

/// All points p with normal . p = offset.
#[derive(Clone, Copy, Debug)]
struct Plane {
    normal: DVec3,
    offset: f64,
}

/// Coordinates about the middle of the scene, in which it reaches 1 to 2 along its longest axis.
#[derive(Clone, Copy, Debug)]
struct Local {
    scale: f64,
    middle: DVec3,
    /// How far it reaches.
    reach: f64,
}

impl Local {
    fn new(scene: &Scene) -> Self {
        let (low, high) = scene.bounds().unwrap_or_default();
        let half = (high * 0.5 - low * 0.5).max_element();
        let scale = inverse_power_of_two(half);
        Self { scale, middle: low * (0.5 * scale) + high * (0.5 * scale), reach: half * scale }
    }

    fn of(&self, point: DVec3) -> DVec3 {
        point * self.scale - self.middle
    }
}

/// Rays of eyes that are farther from the middle than this, in units of the scene's reach, begin nearer: the hierarchy is in f32.
const FARTHEST: f64 = 4.0;
/// What boxes are enlarged by in local coordinates. Up to 8 from the middle f32 rounds where a ray begins by 2e-7; over the way to a box, up to 20,
/// rounding the direction adds 6e-7 and the slab test 2e-6.
const MARGIN: f32 = 4e-6;

impl Rays {
    /// Builds the hierarchy: O(n log n).
    pub fn new(scene: &Scene) -> Self {
        let local = Local::new(scene);
        let mut planes = Vec::new();
        let mut starts = vec![0];
        let mut boxes = Vec::with_capacity(scene.piece_count());
        for piece in scene.pieces() {
            push_planes(piece, &local, &mut planes);
            starts.push(planes.len() as u32);
            let corners = piece.points().map(|p| local.of(p).as_vec3a());
            let (low, high) =
                corners.fold((Vec3A::INFINITY, Vec3A::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)));
            boxes.push(Aabb::new(low - MARGIN, high + MARGIN));
        }
        let bvh =
            (!boxes.is_empty()).then(|| build_cwbvh(&boxes, BvhBuildParams::medium_build(), &mut Duration::default()));
        Self { scene: scene.clone(), local, bvh, planes, starts, hits: vec![0; scene.polygon_count() + 1] }
    }

    /// The scene.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// What that many rays meet above the tangent plane at a viewpoint, for a normal of any length. If the viewpoint is on a piece,
    /// that piece and what shares its plane are passed through. The eye may be as far away as it likes: rays are in f64 up to the scene, which
    /// is off by 1e-16 of the way.
    ///
    /// # Errors
    /// If there are no rays, if the eye is not finite, if the normal has no direction, or if the viewpoint is on a piece of another scene.
    pub fn view(
        &mut self,
        viewpoint: &Viewpoint,
        normal: DVec3,
        rays: u32,
        seed: u64,
    ) -> Result<RaysView<'_>, BaselineError> {
        let background = self.hits.len() - 1;
        let mut hits = std::mem::take(&mut self.hits);
        hits.fill(0);
        let result = self.for_each_ray(viewpoint, normal, rays, seed, |_, seen| {
            hits[seen.map_or(background, |piece| self.scene.piece(piece).polygon().index())] += 1;
        });
        self.hits = hits;
        result?;
        Ok(RaysView { rays, hits: &self.hits })
    }

    /// Calls with the unit direction of every ray of [`Rays::view`] and the piece that it meets, `None` for background.
    ///
    /// # Errors
    /// As [`Rays::view`].
    pub fn for_each_ray(
        &self,
        viewpoint: &Viewpoint,
        normal: DVec3,
        rays: u32,
        seed: u64,
        mut f: impl FnMut(DVec3, Option<PieceId>),
    ) -> Result<(), BaselineError> {
        let [t, b, n] = frame(normal).ok_or(BaselineError::BadNormal)?;
        let floor = BaselineError::check_viewpoint(viewpoint, &self.scene)?;
        let eye = self.local.of(viewpoint.eye());
        if rays == 0 {
            return Err(BaselineError::NoRays);
        }
        for point in disc(rays, seed) {
            let up = (1.0 - point.length_squared()).max(0.0).sqrt();
            let direction = t * point.x + b * point.y + n * up;
            f(direction, self.start(eye, direction).and_then(|start| self.first_met(start, direction, floor)));
        }
        Ok(())
    }

    /// Where a ray may begin: at the eye, or nearer if that is far away. `None` if it misses the scene.
    fn start(&self, eye: DVec3, direction: DVec3) -> Option<DVec3> {
        let reach = self.local.reach;
        if eye.abs().max_element() <= FARTHEST * reach {
            return Some(eye);
        }
        // More than the square root of 3: a ball around the scene, which the eye is outside of.
        let radius = 2.0 * reach;
        let way = -eye.dot(direction);
        let nearest = eye + direction * way;
        // Not if something is not a number either.
        (way > 0.0 && nearest.length() < radius).then(|| nearest - direction * radius)
    }

    fn first_met(&self, eye: DVec3, direction: DVec3, floor: Option<PlaneId>) -> Option<PieceId> {
        let bvh = self.bvh.as_ref()?;
        let ray = Ray::new_inf(eye.as_vec3a(), direction.as_vec3a());
        let mut nearest = (f64::INFINITY, u32::MAX);
        bvh.ray_traverse(ray, &mut RayHit::none(), |_, k| {
            let piece = bvh.primitive_indices[k];
            let Some(distance) = self.distance(piece, eye, direction) else { return f32::INFINITY };
            if (distance, piece) < nearest && floor.is_none_or(|plane| self.plane_of(piece) != plane) {
                nearest = (distance, piece);
                // Never less: what is nearer must not be passed over. The box around it has a margin, too.
                return (distance as f32 + MARGIN).next_up();
            }
            f32::INFINITY
        });
        (nearest.1 != u32::MAX).then_some(PieceId(nearest.1))
    }

    /// The distance along a ray to a piece, if it is met.
    fn distance(&self, piece: u32, eye: DVec3, direction: DVec3) -> Option<f64> {
        let k = piece as usize;
        let [own, edges @ ..] = &self.planes[self.starts[k] as usize..self.starts[k + 1] as usize] else {
            return None;
        };
        let distance = (own.offset - own.normal.dot(eye)) / own.normal.dot(direction);
        // Not if it is not a number either.
        if !(distance > 0.0 && distance < f64::INFINITY) {
            return None;
        }
        let point = eye + direction * distance;
        edges.iter().all(|edge| edge.normal.dot(point) >= edge.offset).then_some(distance)
    }

    fn piece(&self, piece: u32) -> PieceRef<'_> {
        self.scene.piece(PieceId(piece))
    }

    fn plane_of(&self, piece: u32) -> PlaneId {
        self.piece(piece).plane_id()
    }
}

fn push_planes(piece: PieceRef<'_>, local: &Local, planes: &mut Vec<Plane>) {
    let normal = unit_normal(piece);
    let corners: Vec<DVec3> = piece.points().map(|p| local.of(p)).collect();
    let Some(first) = corners.first() else { return };
    planes.push(Plane { normal, offset: normal.dot(*first) });
    for (&a, &b) in corners.iter().zip(corners.iter().cycle().skip(1)) {
        let inwards = normal.cross((b - a).normalize_or_zero());
        planes.push(Plane { normal: inwards, offset: inwards.dot(a) });
    }
}

/// A random point in each of `count` parts of equal area of the unit disc.
///
/// The square is cut into rows of about as many cells as there are rows, and mapped to the disc by P. Shirley and K. Chiu, "A
/// Low Distortion Map Between Disk and Square", JGT 2(3), 1997, which keeps ratios of areas.
fn disc(count: u32, seed: u64) -> impl Iterator<Item = DVec2> {
    let rows = u64::from(count.isqrt());
    let total = u64::from(count);
    let cells = (0..rows).flat_map(move |row| {
        let [first, end] = [row, row + 1].map(|row| row * total / rows);
        (first..end).map(move |cell| (first, end, cell))
    });
    cells.map(move |(first, end, cell)| {
        let [x, y] = [0, 1].map(|k| unit(seed, 2 * cell + k));
        let width = (end - first) as f64;
        let x = ((cell - first) as f64 + x) / width;
        let y = (first as f64 + y * width) / total as f64;
        square_to_disc(DVec2::new(2.0 * x - 1.0, 2.0 * y - 1.0))
    })
}

fn square_to_disc(p: DVec2) -> DVec2 {
    if p == DVec2::ZERO {
        return p;
    }
    if p.x.abs() > p.y.abs() {
        let (sin, cos) = (FRAC_PI_4 * (p.y / p.x)).sin_cos();
        p.x * DVec2::new(cos, sin)
    } else {
        let (sin, cos) = (FRAC_PI_4 * (p.x / p.y)).sin_cos();
        p.y * DVec2::new(sin, cos)
    }
}

/// The k-th number of a sequence in 0..1 that `seed` chooses: `SplitMix64` (Steele, Lea and Flood 2014), entered anywhere.
fn unit(seed: u64, k: u64) -> f64 {
    let mix = |mut z: u64| {
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    };
    let step = (k + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    (mix(mix(seed.wrapping_add(1)).wrapping_add(step)) >> 11) as f64 / (1_u64 << 53) as f64
}

/// What rays met.
#[derive(Clone, Copy, Debug)]
pub struct RaysView<'a> {
    rays: u32,
    hits: &'a [u32],
}

impl RaysView<'_> {
    /// The share of rays that met a polygon.
    ///
    /// # Panics
    /// If there is no polygon of that number.
    pub fn of(&self, polygon: PolygonId) -> f64 {
        f64::from(self.hits[..self.hits.len() - 1][polygon.index()]) / f64::from(self.rays)
    }

    /// A bound on the standard error of [`Self::of`], with the estimate in place of what it estimates: that of as many
    /// independent rays, sqrt(f (1 - f) / n). One ray in each of n parts of equal area never has more. For a polygon that
    /// no ray met, 0: its form factor is below 3 / n with 95% certainty.
    ///
    /// # Panics
    /// If there is no polygon of that number.
    pub fn standard_error(&self, polygon: PolygonId) -> f64 {
        let share = self.of(polygon);
        (share * (1.0 - share) / f64::from(self.rays)).sqrt()
    }

    /// The estimate for every polygon by its number.
    pub fn factors(&self) -> impl ExactSizeIterator<Item = f64> {
        self.hits[..self.hits.len() - 1].iter().map(|&hits| f64::from(hits) / f64::from(self.rays))
    }

    /// The share of rays that met nothing.
    pub fn background(&self) -> f64 {
        f64::from(self.hits[self.hits.len() - 1]) / f64::from(self.rays)
    }

    /// The number of rays.
    pub fn rays(&self) -> u32 {
        self.rays
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_fill_the_disc_evenly() {
        for count in [1, 2, 3, 10, 1000, 100_003] {
            let points: Vec<DVec2> = disc(count, 7).collect();
            assert_eq!(points.len(), count as usize);
            assert!(points.iter().all(|p| p.length() <= 1.0 + 1e-15));
        }
        // By quadrant, and inside half the radius.
        let points: Vec<DVec2> = disc(100_000, 3).collect();
        let share = |inside: &dyn Fn(&DVec2) -> bool| points.iter().filter(|p| inside(p)).count() as f64 / 1e5;
        assert!((share(&|p| p.x > 0.0 && p.y > 0.0) - 0.25).abs() < 2e-3);
        assert!((share(&|p| p.x < 0.0 && p.y > 0.0) - 0.25).abs() < 2e-3);
        assert!((share(&|p| p.length() < 0.5) - 0.25).abs() < 2e-3);
    }
}
