//! Cases for the predicates: an eye, points that are often in special position, and definitions made of
//! them, drawn from numbers.

use crate::oracle::unit_of;
use glam::DVec3;
use nusselt::exact::{Direction, Plane, Point, Splitter};

/// Where choices come from: a generator of random numbers, or the bytes of a fuzzer.
pub(crate) trait Source {
    /// A number below `n`, which is at most 256.
    fn below(&mut self, n: u64) -> u64;
    /// Any 64 bits.
    fn bits(&mut self) -> u64;

    fn one_in(&mut self, n: u64) -> bool {
        self.below(n) == n - 1
    }
}

/// `SplitMix64`.
pub(crate) struct Random(pub(crate) u64);

impl Source for Random {
    fn below(&mut self, n: u64) -> u64 {
        ((u128::from(self.bits()) * u128::from(n)) >> 64) as u64
    }

    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ self.0 >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ z >> 31
    }
}

/// What coordinates look like.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Class {
    /// Whole numbers from -4 to 4.
    Grid,
    /// Multiples of 0.1 as f64 knows them.
    Decimal,
    /// Numbers that were f32 once, within 100.
    SinglePrecision,
    /// Full mantissas, within 1.
    Full,
    /// A cluster far from the origin, some steps of the last place wide.
    Cluster,
    /// Multiples of the least denormal number.
    Denormal,
    /// Near the end of the exponents.
    Huge,
    /// Exponents from -40 to 40.
    Mixed,
    /// Any exponent.
    Wild,
    /// Any finite bits.
    Chaos,
}

impl Class {
    pub(crate) const ALL: [Self; 10] = [
        Self::Grid,
        Self::Decimal,
        Self::SinglePrecision,
        Self::Full,
        Self::Cluster,
        Self::Denormal,
        Self::Huge,
        Self::Mixed,
        Self::Wild,
        Self::Chaos,
    ];

    pub(crate) fn coordinate(self, source: &mut impl Source) -> f64 {
        // In [-1, 1), with 53 bits.
        let full = |source: &mut dyn FnMut() -> u64| (source() as i64 >> 10) as f64 / 2f64.powi(53);
        let mut bits = || source.bits();
        match self {
            Self::Grid => source.below(9) as f64 - 4.0,
            Self::Decimal => (source.below(41) as f64 - 20.0) * 0.1,
            Self::SinglePrecision => f64::from((full(&mut bits) * 100.0) as f32),
            Self::Full => full(&mut bits),
            Self::Cluster => 1e6 + (source.below(17) as f64 - 8.0) * 2f64.powi(-33),
            Self::Denormal => match source.below(4) {
                0 => (source.below(9) as f64 - 4.0) * f64::from_bits(1),
                1 => f64::from_bits(source.bits() >> 12),
                2 => -f64::from_bits(source.bits() >> 40),
                _ => full(&mut || source.bits()) * 2f64.powi(-1020),
            },
            Self::Huge => {
                let m = if source.one_in(2) { source.below(9) as f64 - 4.0 } else { full(&mut || source.bits()) * 4.0 };
                m * 2f64.powi(1000 + source.below(21) as i32)
            }
            Self::Mixed => full(&mut || source.bits()) * 2f64.powi(source.below(81) as i32 - 40),
            Self::Wild => {
                let m = if source.one_in(2) { source.below(9) as f64 - 4.0 } else { full(&mut || source.bits()) };
                // In two steps: the power may be denormal.
                m * 2f64.powi(source.below(256) as i32 * 4 - 500) * 2f64.powi(-500 + source.below(4) as i32)
            }
            Self::Chaos => Some(f64::from_bits(source.bits())).filter(|x| x.is_finite()).unwrap_or(1.0),
        }
    }

    fn point(self, source: &mut impl Source) -> DVec3 {
        DVec3::new(self.coordinate(source), self.coordinate(source), self.coordinate(source))
    }
}

/// What the predicates are asked about.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Case {
    pub(crate) eye: DVec3,
    /// The points that the kernel's grid is made for.
    pub(crate) known: Vec<DVec3>,
    pub(crate) planes: Vec<Plane>,
    pub(crate) points: Vec<Point>,
    pub(crate) splitters: Vec<Splitter>,
    pub(crate) directions: Vec<Direction>,
    pub(crate) corners: [DVec3; 4],
}

/// The number `steps` steps of the last place away, as long as it is finite.
pub(crate) fn nudged(x: f64, steps: i64) -> f64 {
    let order = |x: f64| {
        let bits = x.to_bits() as i64;
        if bits < 0 { i64::MIN - bits } else { bits }
    };
    let moved = order(x).saturating_add(steps);
    let result = f64::from_bits(if moved < 0 { i64::MIN.wrapping_sub(moved) } else { moved } as u64);
    if result.is_finite() { result } else { x }
}

impl Case {
    /// Draws a case.
    pub(crate) fn draw(source: &mut impl Source, class: Class) -> Self {
        let pool = pool(source, class);
        let planes: Vec<Plane> = (0..3).map(|_| plane(source, &pool)).collect();
        let points: Vec<Point> = (0..3).map(|_| point(source, &pool, &planes)).collect();
        let splitters: Vec<Splitter> = (0..4).map(|_| splitter(source, class, &pool, &planes)).collect();
        let directions = (0..3)
            .map(|_| match source.below(6) {
                0 => Direction::Given(vector(source, class, &pool)),
                1 | 2 => Direction::Point(points[source.below(3) as usize]),
                3 => Direction::Point(Point::Given(pick(source, &pool))),
                _ => {
                    let (i, j) = (source.below(4), 1 + source.below(3));
                    Direction::Crossing([splitters[i as usize], splitters[((i + j) % 4) as usize]])
                }
            })
            .collect();
        let eye = pool[0];
        let known = match source.below(6) {
            0 => Vec::new(),
            1 => pool[..2].to_vec(),
            _ => pool.clone(),
        };
        let corners = [(); 4].map(|()| pick(source, &pool));
        Self { eye, known, planes, points, splitters, directions, corners }
    }

    /// The exponent of the finest bit of all coordinates, vectors in units of their own left out.
    pub(crate) fn unit(&self) -> i32 {
        let mut all = Vec::new();
        self.map(&mut |x| {
            all.push(DVec3::splat(x));
            x
        });
        unit_of(all)
    }

    /// Every coordinate of a position changed by `f`; vectors in units of their own stay.
    pub(crate) fn map(&self, f: &mut impl FnMut(f64) -> f64) -> Self {
        Self {
            eye: map_position(self.eye, f),
            known: self.known.iter().map(|p| map_position(*p, f)).collect(),
            planes: self.planes.iter().map(|p| map_plane(*p, f)).collect(),
            points: self.points.iter().map(|p| map_point(*p, f)).collect(),
            splitters: self.splitters.iter().map(|s| map_splitter(*s, f)).collect(),
            directions: self.directions.iter().map(|d| map_direction(d, f)).collect(),
            corners: self.corners.map(|p| map_position(p, f)),
        }
    }
}

fn map_position(p: DVec3, f: &mut impl FnMut(f64) -> f64) -> DVec3 {
    DVec3::from(p.to_array().map(f))
}

fn map_plane(plane: Plane, f: &mut impl FnMut(f64) -> f64) -> Plane {
    match plane {
        Plane::Axis { axis, value } => Plane::Axis { axis, value: f(value) },
        Plane::Points(points) => Plane::Points(points.map(|p| map_position(p, f))),
    }
}

fn map_point(point: Point, f: &mut impl FnMut(f64) -> f64) -> Point {
    match point {
        Point::Given(p) => Point::Given(map_position(p, f)),
        Point::EdgePlane(ends, plane) => Point::EdgePlane(ends.map(|p| map_position(p, f)), map_plane(plane, f)),
        Point::Planes(planes) => Point::Planes(planes.map(|p| map_plane(p, f))),
    }
}

fn map_splitter(splitter: Splitter, f: &mut impl FnMut(f64) -> f64) -> Splitter {
    match splitter {
        Splitter::Edge(ends) => Splitter::Edge(ends.map(|p| map_position(p, f))),
        Splitter::Crease(planes) => Splitter::Crease(planes.map(|p| map_plane(p, f))),
        Splitter::Given(normal) => Splitter::Given(normal),
        Splitter::Parallel(plane) => Splitter::Parallel(map_plane(plane, f)),
    }
}

fn map_direction(direction: &Direction, f: &mut impl FnMut(f64) -> f64) -> Direction {
    match *direction {
        Direction::Given(d) => Direction::Given(d),
        Direction::Point(point) => Direction::Point(map_point(point, f)),
        Direction::Crossing(splitters) => Direction::Crossing(splitters.map(|s| map_splitter(s, f))),
    }
}

/// Ten points of a class, some of them moved into special position, or to just beside it.
fn pool(source: &mut impl Source, class: Class) -> Vec<DVec3> {
    let mut pool: Vec<DVec3> = (0..10).map(|_| class.point(source)).collect();
    for k in 0..pool.len() {
        let [a, b, c] = [(); 3].map(|()| pool[source.below(10) as usize]);
        let p = match source.below(12) {
            0 => (a + b) / 2.0,
            1 => a + b - c,
            2 => b * 2.0 - a,
            3 | 4 => {
                let axis = source.below(3) as usize;
                let mut p = pool[k];
                p[axis] = a[axis];
                p
            }
            // In line with the eye, which is the first.
            5 => pool[0] + (a - pool[0]) * 0.5,
            6 => pool[0] + (a - pool[0]) * -2.0,
            7 => a + (b - a) * 0.3 + (c - a) * 0.6,
            _ => pool[k],
        };
        let near = source.below(6);
        let steps = source.below(7) as i64 - 3;
        let axis = source.below(3) as usize;
        let mut p = if p.is_finite() { p } else { pool[k] };
        if near == 0 {
            p[axis] = nudged(p[axis], steps);
        }
        pool[k] = p;
    }
    pool
}

fn pick(source: &mut impl Source, pool: &[DVec3]) -> DVec3 {
    pool[source.below(pool.len() as u64) as usize]
}

fn plane(source: &mut impl Source, pool: &[DVec3]) -> Plane {
    if source.below(3) == 0 {
        let axis = source.below(3) as usize;
        Plane::Axis { axis, value: pick(source, pool)[axis] }
    } else {
        Plane::Points([(); 3].map(|()| pick(source, pool)))
    }
}

fn point(source: &mut impl Source, pool: &[DVec3], planes: &[Plane]) -> Point {
    match source.below(6) {
        0 => Point::Given(pick(source, pool)),
        5 => Point::Planes([planes[0], planes[1], planes[2]]),
        _ => Point::EdgePlane([pick(source, pool), pick(source, pool)], planes[source.below(3) as usize]),
    }
}

fn vector(source: &mut impl Source, class: Class, pool: &[DVec3]) -> DVec3 {
    let v = match source.below(4) {
        0 => Class::Grid.point(source),
        1 => class.point(source),
        2 => pick(source, pool) - pool[0],
        _ => (pick(source, pool) - pool[0]).cross(pick(source, pool) - pool[0]),
    };
    if v.is_finite() { v } else { DVec3::X }
}

fn splitter(source: &mut impl Source, class: Class, pool: &[DVec3], planes: &[Plane]) -> Splitter {
    match source.below(8) {
        0..=2 => Splitter::Edge([pick(source, pool), pick(source, pool)]),
        3..=5 => {
            let (i, j) = (source.below(3), 1 + source.below(2));
            Splitter::Crease([planes[i as usize], planes[((i + j) % 3) as usize]])
        }
        6 => Splitter::Given(vector(source, class, pool)),
        _ => Splitter::Parallel(planes[source.below(3) as usize]),
    }
}
