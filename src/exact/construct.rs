//! Definitions as integer vectors: the last stage of every predicate.
//!
//! All of them are relative to the frame's origin, in its grid units; each vector may be a positive
//! multiple of what it stands for.

use super::arena::{Arena, Kept3, Num, Num3};
use super::definition::{Direction, Plane, Point, Splitter};
use super::frame::{Frame, given_vector};
use super::{Sign, fixed};

/// A frame and the arena that numbers are made in.
#[derive(Debug)]
pub(crate) struct Constructor<'a> {
    pub(crate) frame: &'a Frame,
    pub(crate) arena: &'a mut Arena,
}

impl Constructor<'_> {
    /// A plane as `normal . x + height = 0`: the sign of `normal . x + height w` is the side that the
    /// point `x / w` with `w > 0` is on, and `height` that of the origin.
    pub(crate) fn plane(&mut self, plane: &Plane) -> (Num3, Num) {
        let arena = &mut *self.arena;
        match *plane {
            Plane::Axis { axis, value } => {
                let mut normal = [Num::ZERO; 3];
                normal[axis] = arena.integer(1);
                (normal, self.frame.relative_coordinate(arena, axis, value).negated())
            }
            Plane::Points(points) => {
                let [a, b, c] = points.map(|p| self.frame.relative(arena, p));
                let ab = arena.sub3(b, a);
                let ac = arena.sub3(c, a);
                let normal = arena.cross(ab, ac);
                (normal, arena.dot(normal, a).negated())
            }
        }
    }

    /// A point in homogeneous coordinates `x / w` with `w > 0`.
    pub(crate) fn point(&mut self, point: &Point) -> (Num3, Num) {
        match point {
            Point::Given(p) => (self.frame.relative(self.arena, *p), self.arena.integer(1)),
            Point::EdgePlane(ends, plane) => {
                let [a, b] = ends.map(|p| self.frame.relative(self.arena, p));
                let (normal, height) = self.plane(plane);
                let arena = &mut *self.arena;
                let [at_a, at_b] = [a, b].map(|p| {
                    let along = arena.dot(normal, p);
                    arena.add(along, height)
                });
                debug_assert_eq!(at_a.sign() * at_b.sign(), Sign::Negative, "the plane separates the ends");
                // (a |h_b| + b |h_a|) / (|h_a| + |h_b|); the heights' signs differ.
                let sign = at_a.sign();
                let (to_a, to_b) = (at_b.negated().times_sign(sign), at_a.times_sign(sign));
                let (from_a, from_b) = (arena.scale3(to_a, a), arena.scale3(to_b, b));
                (arena.add3(from_a, from_b), arena.add(to_a, to_b))
            }
            Point::Planes(planes) => {
                // Cramer's rule for N_i . x = -h_i.
                let [(n1, h1), (n2, h2), (n3, h3)] = planes.map(|p| self.plane(&p));
                let arena = &mut *self.arena;
                let (n23, n31, n12) = (arena.cross(n2, n3), arena.cross(n3, n1), arena.cross(n1, n2));
                let det = arena.dot(n1, n23);
                let terms = [(h1, n23), (h2, n31), (h3, n12)].map(|(h, n)| arena.scale3(h, n));
                let sum = arena.add3(terms[0], terms[1]);
                let sum = arena.add3(sum, terms[2]);
                let sign = det.sign();
                (sum.map(|x| x.times_sign(-sign)), det.times_sign(sign))
            }
        }
    }

    /// The normal of a splitter.
    pub(crate) fn splitter(&mut self, splitter: &Splitter) -> Num3 {
        match splitter {
            Splitter::Edge(ends) => {
                let [a, b] = ends.map(|p| self.frame.relative(self.arena, p));
                self.arena.cross(a, b)
            }
            Splitter::Crease(planes) => {
                let [(n1, h1), (n2, h2)] = planes.map(|p| self.plane(&p));
                let (first, second) = (self.arena.scale3(h2, n1), self.arena.scale3(h1, n2));
                self.arena.sub3(first, second)
            }
            Splitter::Given(normal) => given_vector(self.arena, *normal),
            Splitter::Parallel(plane) => self.plane(plane).0,
        }
    }

    /// The normal of a splitter, kept.
    pub(crate) fn keep_splitter(&mut self, splitter: &Splitter) -> Kept3 {
        if let Splitter::Edge(ends) = splitter
            && let [Some(a), Some(b)] = ends.map(|p| self.frame.narrow_relative(p))
        {
            return self.arena.keep_digits(&fixed::narrow_cross(a, b));
        }
        let mark = self.arena.mark();
        let normal = self.splitter(splitter);
        self.arena.keep3(mark, normal)
    }

    /// A direction, kept.
    pub(crate) fn keep_direction(&mut self, direction: &Direction) -> Kept3 {
        if let Direction::Point(Point::Given(p)) = direction
            && let Some(p) = self.frame.narrow_relative(*p)
        {
            return self.arena.keep_digits(&p.map(fixed::of_i128));
        }
        let mark = self.arena.mark();
        let direction = self.direction(direction);
        self.arena.keep3(mark, direction)
    }

    /// A direction.
    pub(crate) fn direction(&mut self, direction: &Direction) -> Num3 {
        match direction {
            Direction::Given(d) => given_vector(self.arena, *d),
            Direction::Point(point) => self.point(point).0,
            Direction::Crossing(splitters) => {
                let [m, n] = splitters.map(|s| self.splitter(&s));
                self.arena.cross(m, n)
            }
        }
    }
}
