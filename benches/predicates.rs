//! What an exact sign costs, by stage and by kind of input: `cargo bench --bench predicates`. The table
//! of docs/numerics.md is made from it.

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use glam::DVec3;
use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::Signed;
use nusselt::exact::{Direction, Kernel, Plane, Point, PredicateStats, Sign, Splitter, orient3d};
use std::hint::black_box;

/// Where coordinates come from.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Input {
    /// f32 numbers within 1000, with the eye on the same grid: differences of about 44 bits.
    Single,
    /// f64 numbers of full mantissas, of sizes that differ by 2^20: differences of about 73 bits.
    Double,
}

impl Input {
    const ALL: [(Self, &'static str); 2] = [(Self::Single, "f32-born"), (Self::Double, "full f64")];
}

/// `SplitMix64`.
struct Random(u64);

impl Random {
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn coordinate(&mut self, input: Input) -> f64 {
        let x = (self.bits() >> 11) as f64 / 2f64.powi(52) - 1.0;
        match input {
            // On the grid of 2^-34 below 2^10: 44 bits.
            Input::Single => f64::from((x * 1000.0) as f32),
            Input::Double => x * 2f64.powi((self.bits() % 20) as i32 - 10),
        }
    }

    fn point(&mut self, input: Input) -> DVec3 {
        DVec3::new(self.coordinate(input), self.coordinate(input), self.coordinate(input))
    }
}

/// Three edges through one point, which is the end of none of them: their planes all hold the line of sight to it.
fn zero_edges(random: &mut Random, input: Input) -> [Splitter; 3] {
    // On a grid of twice the last place, so that what is as far from it on the other side needs no rounding.
    let grid = |x: f64| {
        let digits = if input == Input::Single { 22 } else { 51 };
        2f64.powi(x.abs().log2().floor() as i32 - digits)
    };
    let apex = random.point(input);
    let apex = DVec3::from(apex.to_array().map(|x| (x / grid(x)).round() * grid(x)));
    [(); 3].map(|()| {
        let unit = [(); 3].map(|()| (random.bits() >> 11) as f64 / 2f64.powi(52) - 1.0);
        let step = DVec3::from([0, 1, 2].map(|k| {
            let g = grid(apex[k]);
            (unit[k] * 2f64.powi(if input == Input::Single { 22 } else { 51 })).round() * g
        }));
        let ends = [apex - step, apex + step];
        assert!(ends[0] + step == apex && ends[1] - step == apex, "the ends need no rounding");
        Splitter::Edge(ends)
    })
}

/// Three creases of planes that all hold one point: their great circles meet there.
fn zero_creases(random: &mut Random, input: Input) -> [Splitter; 3] {
    let apex = random.point(input);
    let mut plane = || Plane::Points([apex, random.point(input), random.point(input)]);
    [(); 3].map(|()| Splitter::Crease([plane(), plane()]))
}

/// Creases of one plane with three others through one of its points: the common case of a cut polygon.
fn zero_creases_on_one_plane(random: &mut Random, input: Input) -> [Splitter; 3] {
    let apex = random.point(input);
    let mut plane = || Plane::Points([apex, random.point(input), random.point(input)]);
    let own = plane();
    [(); 3].map(|()| Splitter::Crease([own, plane()]))
}

/// Two creases and an edge through one point.
fn zero_mixed(random: &mut Random, input: Input) -> [Splitter; 3] {
    let apex = random.point(input);
    let mut plane = || Plane::Points([apex, random.point(input), random.point(input)]);
    let (c1, c2) = (Splitter::Crease([plane(), plane()]), Splitter::Crease([plane(), plane()]));
    [c1, c2, Splitter::Edge([apex, random.point(input)])]
}

/// How many different ones a bench goes round.
const CASES: usize = 64;

fn orientation(c: &mut Criterion) {
    type Make = fn(&mut Random, Input) -> [Splitter; 3];
    let kinds: [(&str, Make); 5] = [
        ("filter, three edges", |r, i| [(); 3].map(|()| Splitter::Edge([r.point(i), r.point(i)]))),
        ("exact zero, three edges", zero_edges),
        ("exact zero, two creases and an edge", zero_mixed),
        ("exact zero, three creases", zero_creases),
        ("exact zero, three creases on one plane", zero_creases_on_one_plane),
    ];
    let mut group = c.benchmark_group("orientation_of");
    for (kind, make) in kinds {
        for (input, name) in Input::ALL {
            let mut random = Random(1);
            let eye = random.point(input);
            let mut kernel = Kernel::new([], eye);
            let ids: Vec<_> = (0..CASES).map(|_| make(&mut random, input).map(|s| kernel.add_splitter(&s))).collect();
            let zeros = ids.iter().filter(|ids| kernel.orientation_of(**ids).is_zero()).count();
            assert_eq!(zeros, if kind.starts_with("exact") { CASES } else { 0 }, "{kind}");
            kernel.reset_stats();
            let mut next = ids.iter().cycle();
            group.bench_function(BenchmarkId::new(kind, name), |b| {
                b.iter(|| kernel.orientation_of(*black_box(next.next().expect("an endless cycle"))));
            });
            report(kernel.stats());
        }
    }
    for (input, name) in Input::ALL {
        // Many, one after the other.
        let mut random = Random(1);
        let eye = random.point(input);
        let mut kernel = Kernel::new([], eye);
        let mut edge = || kernel.add_splitter(&Splitter::Edge([random.point(input), random.point(input)]));
        let triples = [(); CASES].map(|()| [edge(), edge(), edge()]);
        group.bench_function(BenchmarkId::new("filter, 64 times three edges", name), |b| {
            b.iter(|| {
                let positive = |ids: &&_| kernel.orientation_of(**ids) == Sign::Positive;
                black_box(&triples).iter().filter(positive).count()
            });
        });
        report(kernel.stats());
    }
    group.finish();
}

/// Which stages a bench really reached.
fn report(stats: PredicateStats) {
    let calls = stats.calls().max(1) as f64;
    let share = |n: u64| 100.0 * n as f64 / calls;
    println!(
        "    stages: filter {:.0}%, identity {:.0}%, fixed {:.0}%, arbitrary {:.0}%",
        share(stats.filter),
        share(stats.identity),
        share(stats.fixed),
        share(stats.arbitrary)
    );
}

fn sides(c: &mut Criterion) {
    type Make = fn(&mut Random, Input) -> (Direction, Splitter);
    let kinds: [(&str, Make); 4] = [
        ("filter, point and edge", |r, i| {
            (Direction::Point(Point::Given(r.point(i))), Splitter::Edge([r.point(i), r.point(i)]))
        }),
        ("identity, crossing", |r, i| {
            let edges = [(); 2].map(|()| Splitter::Edge([r.point(i), r.point(i)]));
            (Direction::Crossing(edges), edges[1])
        }),
        ("exact zero, edge through plane and crease", |r, i| {
            // The point lies on both planes of the crease, which only arithmetic knows.
            let (mut a, mut b) = (r.point(i), r.point(i));
            let z = r.coordinate(i);
            (a.z, b.z) = (2000.0, -2000.0);
            let cut = Plane::Axis { axis: 2, value: z };
            let other = Plane::Points([a, b, r.point(i)]);
            (Direction::Point(Point::EdgePlane([a, b], cut)), Splitter::Crease([other, cut]))
        }),
        ("exact zero, edge through plane and crease of points", |r, i| {
            let (a, b, p) = (r.point(i), r.point(i), r.point(i));
            // A plane that separates a from b: through three points near their middle.
            let m = (a + b) / 2.0;
            let m = if i == Input::Single { m.as_vec3().as_dvec3() } else { m };
            let cut = Plane::Points([m, m + DVec3::new(1.0, -1.0, 0.0), m + DVec3::new(0.0, 1.0, -1.0)]);
            (Direction::Point(Point::EdgePlane([a, b], cut)), Splitter::Crease([Plane::Points([a, b, p]), cut]))
        }),
    ];
    let mut group = c.benchmark_group("side_of");
    for (kind, make) in kinds {
        for (input, name) in Input::ALL {
            let mut random = Random(2);
            let eye = random.point(input);
            let mut kernel = Kernel::new([], eye);
            let mut ids = Vec::new();
            while ids.len() < CASES {
                let (d, s) = make(&mut random, input);
                if let Direction::Point(Point::EdgePlane([a, b], cut)) = d {
                    let sides = [a, b].map(|p| kernel.plane_side(&Point::Given(p), &cut));
                    if sides[0] * sides[1] != Sign::Negative {
                        continue;
                    }
                }
                ids.push((kernel.add_direction(&d), kernel.add_splitter(&s)));
            }
            for (d, s) in &ids {
                assert_eq!(kernel.side_of(*d, *s).is_zero(), !kind.starts_with("filter"), "{kind}");
            }
            kernel.reset_stats();
            let mut next = ids.iter().cycle();
            group.bench_function(BenchmarkId::new(kind, name), |b| {
                b.iter(|| {
                    let (d, s) = *black_box(next.next().expect("an endless cycle"));
                    kernel.side_of(d, s)
                });
            });
            report(kernel.stats());
        }
    }
    for (input, name) in Input::ALL {
        // As the tree asks: many directions against one splitter, one after the other.
        let mut random = Random(2);
        let eye = random.point(input);
        let mut kernel = Kernel::new([], eye);
        let splitter = kernel.add_splitter(&Splitter::Edge([random.point(input), random.point(input)]));
        let directions =
            [(); CASES].map(|()| kernel.add_direction(&Direction::Point(Point::Given(random.point(input)))));
        group.bench_function(BenchmarkId::new("filter, 64 points and one edge", name), |b| {
            b.iter(|| {
                let positive = |d: &&_| kernel.side_of(**d, black_box(splitter)) == Sign::Positive;
                black_box(&directions).iter().filter(positive).count()
            });
        });
        report(kernel.stats());
    }
    group.finish();
}

fn corners(c: &mut Criterion) {
    let mut group = c.benchmark_group("orient3d");
    for (input, name) in Input::ALL {
        let mut random = Random(3);
        let general: Vec<[DVec3; 4]> = (0..CASES).map(|_| [(); 4].map(|()| random.point(input))).collect();
        let flat: Vec<[DVec3; 4]> =
            general.iter().map(|[a, b, c, d]| [a, b, c, d].map(|p| DVec3::new(p.x, p.y, a.z))).collect();
        for (kind, cases) in [("filter", general), ("exact zero", flat)] {
            let mut next = cases.iter().cycle();
            group.bench_function(BenchmarkId::new(kind, name), |bench| {
                bench.iter(|| {
                    let [a, b, c, d] = *black_box(next.next().expect("an endless cycle"));
                    orient3d(a, b, c, d)
                });
            });
        }
    }
    group.finish();
}

/// The same three edges with other people's numbers: coordinates relative to the eye are made before.
fn others(c: &mut Criterion) {
    let mut group = c.benchmark_group("degree 6");
    for (input, name) in Input::ALL {
        let mut random = Random(1);
        let eye = random.point(input);
        let cases: Vec<[Splitter; 3]> = (0..CASES).map(|_| zero_edges(&mut random, input)).collect();
        let normals = |s: &[Splitter; 3], convert: &dyn Fn(DVec3) -> [BigRational; 3]| {
            s.map(|s| {
                let Splitter::Edge([a, b]) = s else { unreachable!("only edges are made") };
                cross(&convert(a), &convert(b))
            })
        };
        let exact = |p: DVec3| {
            let rational = |x: f64| BigRational::from_float(x).expect("finite");
            [0, 1, 2].map(|k| rational(p[k]) - rational(eye[k]))
        };
        let rationals: Vec<[[BigRational; 3]; 3]> = cases.iter().map(|s| normals(s, &exact)).collect();
        // On this grid all of them are whole.
        let grid: BigInt = BigInt::from(1) << 200u32;
        let integers: Vec<[[BigInt; 3]; 3]> = rationals
            .iter()
            .map(|n| {
                n.clone().map(|v| {
                    let whole = v.map(|x| (x * BigRational::from_integer(grid.clone())).to_integer());
                    let zeros = whole.iter().filter_map(BigInt::trailing_zeros).min().unwrap_or(0);
                    whole.map(|x| x >> zeros)
                })
            })
            .collect();
        let mut next = rationals.iter().cycle();
        group.bench_function(BenchmarkId::new("num-rational", name), |b| {
            b.iter(|| det(black_box(next.next().expect("an endless cycle"))).is_negative());
        });
        let mut next = integers.iter().cycle();
        group.bench_function(BenchmarkId::new("num-bigint", name), |b| {
            b.iter(|| det(black_box(next.next().expect("an endless cycle"))).is_negative());
        });
    }
    group.finish();
}

fn cross<T>(a: &[T; 3], b: &[T; 3]) -> [T; 3]
where
    for<'a> &'a T: std::ops::Mul<&'a T, Output = T>,
    T: std::ops::Sub<T, Output = T>,
{
    [&a[1] * &b[2] - &a[2] * &b[1], &a[2] * &b[0] - &a[0] * &b[2], &a[0] * &b[1] - &a[1] * &b[0]]
}

fn det<T>([a, b, c]: &[[T; 3]; 3]) -> T
where
    for<'a> &'a T: std::ops::Mul<&'a T, Output = T>,
    T: std::ops::Sub<T, Output = T> + std::ops::Add<T, Output = T>,
{
    let n = cross(b, c);
    &a[0] * &n[0] + &a[1] * &n[1] + &a[2] * &n[2]
}

criterion_group!(benches, orientation, sides, corners, others);
criterion_main!(benches);
