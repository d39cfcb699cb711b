//! One case: every predicate against the oracle, and the laws that hold between calls.

use crate::case::Case;
use crate::oracle::{Exact, Oracle, dot, sign};
use crate::print;
use glam::DVec3;
use num_bigint::BigInt;
use num_rational::BigRational;
use nusselt::exact::{CircleRelation, Direction, Kernel, Plane, Point, PredicateStats, Sign, Splitter, orient3d};
use std::fmt::Debug;

/// Numbers that the oracle computes with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Reference {
    /// Integers on a grid.
    Integers,
    /// [`BigRational`].
    Rationals,
}

/// What was asked.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Tally {
    /// Calls of predicates whose answer was compared.
    pub(crate) calls: u64,
    /// How many of the answers were "on", "same" or "equal".
    pub(crate) zeros: u64,
    /// What decided them.
    pub(crate) stages: PredicateStats,
}

impl Tally {
    pub(crate) fn add(&mut self, other: Self) {
        self.calls += other.calls;
        self.zeros += other.zeros;
        self.stages += other.stages;
    }
}

/// Compares all answers. The error is the case as Rust and the call that went wrong.
pub(crate) fn check(case: &Case, reference: Reference) -> Result<Tally, String> {
    let checked = match reference {
        Reference::Integers => Check::<BigInt>::new(case).all(),
        Reference::Rationals => Check::<BigRational>::new(case).all(),
    };
    checked.map_err(|call| format!("wrong: {call}\nwith\n{}", print::case(case)))
}

/// The definition with its normal reversed.
pub(crate) fn reversed(splitter: &Splitter) -> Splitter {
    match *splitter {
        Splitter::Edge([a, b]) => Splitter::Edge([b, a]),
        Splitter::Crease([p, q]) => Splitter::Crease([q, p]),
        Splitter::Given(normal) => Splitter::Given(-normal),
        Splitter::Parallel(Plane::Points([a, b, c])) => Splitter::Parallel(Plane::Points([a, c, b])),
        Splitter::Parallel(Plane::Axis { axis, .. }) => Splitter::Given(-DVec3::AXES[axis]),
    }
}

struct Check<'a, T> {
    case: &'a Case,
    oracle: Oracle<T>,
    kernel: Kernel,
    tally: Tally,
}

impl<'a, T: Exact> Check<'a, T> {
    fn new(case: &'a Case) -> Self {
        Self {
            case,
            oracle: Oracle::new(case.eye, case.unit()),
            kernel: Kernel::new(case.known.iter().copied(), case.eye),
            tally: Tally::default(),
        }
    }

    /// Counts a comparison, or fails with the call in words.
    fn same<A: PartialEq + Debug>(&mut self, got: &A, want: &A, call: impl Fn() -> String) -> Result<(), String> {
        self.tally.calls += 1;
        if got == want { Ok(()) } else { Err(format!("{} is {got:?} and not {want:?}", call())) }
    }

    fn same_sign(&mut self, got: Sign, want: Sign, call: impl Fn() -> String) -> Result<(), String> {
        self.tally.zeros += u64::from(want.is_zero());
        self.same(&got, &want, call)
    }

    fn all(mut self) -> Result<Tally, String> {
        self.splitters_and_directions()?;
        self.along()?;
        self.planes()?;
        self.corners()?;
        self.scaled()?;
        self.tally.stages = self.kernel.stats();
        Ok(self.tally)
    }

    fn splitters_and_directions(&mut self) -> Result<(), String> {
        let splitters: Vec<_> =
            self.case.splitters.iter().filter_map(|s| Some((*s, self.oracle.splitter(s)?))).collect();
        let directions: Vec<_> =
            self.case.directions.iter().filter_map(|d| Some((*d, self.oracle.direction(d)?))).collect();
        let splitter_ids: Vec<_> = splitters.iter().map(|(s, _)| self.kernel.add_splitter(s)).collect();
        let direction_ids: Vec<_> = directions.iter().map(|(d, _)| self.kernel.add_direction(d)).collect();
        for ((s, n), s_id) in splitters.iter().zip(&splitter_ids) {
            for ((d, v), d_id) in directions.iter().zip(&direction_ids) {
                let want = sign(&dot(n, v));
                let call = |name| move || format!("{name}({}, {})", print::direction(d), print::splitter(s));
                let got = self.kernel.side(d, s);
                self.same_sign(got, want, call("side"))?;
                let got = self.kernel.side_of(*d_id, *s_id);
                self.same_sign(got, want, call("side_of"))?;
                let got = self.kernel.side_of(*d_id, *s_id);
                self.same_sign(got, want, call("the second side_of"))?;
                let got = self.kernel.side(d, &reversed(s));
                self.same_sign(got, -want, call("the reversed side"))?;
            }
        }
        let count = splitters.len();
        for (i, j, k) in [(0, 1, 2), (1, 2, 3), (0, 2, 3), (3, 1, 0), (0, 0, 1)] {
            if i.max(j).max(k) >= count {
                continue;
            }
            let [a, b, c] = [i, j, k].map(|x| &splitters[x]);
            let want = sign(&dot(&b.1, &crate::oracle::cross(&c.1, &a.1)));
            let call = |name| move || format!("{name}([{}])", [a, b, c].map(|s| print::splitter(&s.0)).join(", "));
            let got = self.kernel.orientation([&a.0, &b.0, &c.0]);
            self.same_sign(got, want, call("orientation"))?;
            let got = self.kernel.orientation([&b.0, &c.0, &a.0]);
            self.same_sign(got, want, call("the turned orientation"))?;
            let got = self.kernel.orientation([&b.0, &a.0, &c.0]);
            self.same_sign(got, -want, call("the swapped orientation"))?;
            let got = self.kernel.orientation_of([i, j, k].map(|x| splitter_ids[x]));
            self.same_sign(got, want, call("orientation_of"))?;
            let got = self.kernel.orientation_of([k, j, i].map(|x| splitter_ids[x]));
            self.same_sign(got, -want, call("the swapped orientation_of"))?;
        }
        for (a, _) in &splitters {
            for (b, _) in &splitters {
                let Some(want) = self.oracle.compare_circles(a, b) else { continue };
                self.tally.zeros += u64::from(want != CircleRelation::Different);
                let call = || format!("compare_circles({}, {})", print::splitter(a), print::splitter(b));
                let got = self.kernel.compare_circles(a, b);
                self.same(&got, &want, call)?;
                let got = self.kernel.compare_circles(a, &reversed(b));
                let opposite = match want {
                    CircleRelation::Same => CircleRelation::Opposite,
                    CircleRelation::Opposite => CircleRelation::Same,
                    CircleRelation::Different => CircleRelation::Different,
                };
                self.same(&got, &opposite, || format!("the reversed {}", call()))?;
            }
        }
        Ok(())
    }

    fn along(&mut self) -> Result<(), String> {
        let splitters = &self.case.splitters;
        let circle = splitters[0];
        let mut on: Vec<Direction> = splitters[1..].iter().map(|s| Direction::Crossing([circle, *s])).collect();
        on.push(Direction::Crossing([splitters[1], circle]));
        if let Splitter::Edge(ends) = circle {
            on.extend(ends.map(|p| Direction::Point(Point::Given(p))));
        }
        on.extend(&self.case.directions);
        for from in &on {
            for other in &on {
                let Some(want) = self.oracle.order_along(&circle, from, other) else { continue };
                let got = self.kernel.order_along(&circle, from, other);
                self.same(&got, &want, || {
                    format!(
                        "order_along({}, {}, {})",
                        print::splitter(&circle),
                        print::direction(from),
                        print::direction(other)
                    )
                })?;
            }
        }
        Ok(())
    }

    fn planes(&mut self) -> Result<(), String> {
        let case = self.case;
        for plane in &case.planes {
            for point in case.points.iter().chain(&[Point::Given(case.eye), Point::Given(case.corners[0])]) {
                let Some(want) = self.oracle.plane_side(point, plane) else { continue };
                let got = self.kernel.plane_side(point, plane);
                self.same_sign(got, want, || format!("plane_side({}, {})", print::point(point), print::plane(plane)))?;
            }
            for other in &case.planes {
                for d in &case.directions {
                    let Some(want) = self.oracle.depth_order([plane, other], d) else { continue };
                    self.tally.zeros += u64::from(want.is_eq());
                    let got = self.kernel.depth_order([plane, other], d);
                    self.same(&got, &want, || {
                        format!(
                            "depth_order([{}, {}], {})",
                            print::plane(plane),
                            print::plane(other),
                            print::direction(d)
                        )
                    })?;
                }
            }
        }
        Ok(())
    }

    fn corners(&mut self) -> Result<(), String> {
        let corners @ [a, b, c, d] = self.case.corners;
        let want = sign(&self.oracle.orient3d_value(corners));
        let call = || "orient3d(corners)".to_string();
        self.same_sign(orient3d(a, b, c, d), want, call)?;
        self.same_sign(orient3d(b, a, c, d), -want, call)?;
        self.same_sign(orient3d(c, a, b, d), want, call)?;
        self.same_sign(orient3d(d, b, c, a), -want, call)
    }

    /// Powers of two change no sign, where they lose no bit.
    fn scaled(&mut self) -> Result<(), String> {
        let case = self.case;
        for exponent in [-300, 1, 200] {
            let factor = 2f64.powi(exponent);
            let mut exact = true;
            let scaled = case.map(&mut |x| {
                exact &= (x * factor).is_finite() && (x * factor / factor).to_bits() == x.to_bits();
                x * factor
            });
            if !exact {
                continue;
            }
            let mut kernel = Kernel::new(scaled.known.iter().copied(), scaled.eye);
            for (s, scaled_s) in case.splitters.iter().zip(&scaled.splitters) {
                for (d, scaled_d) in case.directions.iter().zip(&scaled.directions) {
                    let Some(want) = self.oracle.side(d, s) else { continue };
                    let got = kernel.side(scaled_d, scaled_s);
                    let call = || format!("2^{exponent} times side({}, {})", print::direction(d), print::splitter(s));
                    self.same_sign(got, want, call)?;
                }
            }
        }
        Ok(())
    }
}
