//! Cases printed as Rust, to be pasted into a test.

use crate::case::Case;
use glam::DVec3;
use nusselt::exact::{Direction, Plane, Point, Splitter};

/// The whole case as an expression.
pub(crate) fn case(case: &Case) -> String {
    let Case { eye, known, planes, points, splitters, directions, corners } = case;
    format!(
        "Case {{\n    eye: {},\n    known: vec!{},\n    planes: vec!{},\n    points: vec!{},\n    splitters: vec!{},\n    \
         directions: vec!{},\n    corners: {},\n}}",
        position(eye),
        list(known, position),
        list(planes, plane),
        list(points, point),
        list(splitters, splitter),
        list(directions, direction),
        list(corners, position),
    )
}

fn list<T>(items: &[T], print: impl Fn(&T) -> String) -> String {
    format!("[{}]", items.iter().map(print).collect::<Vec<_>>().join(", "))
}

fn position(p: &DVec3) -> String {
    format!("DVec3::new({:?}, {:?}, {:?})", p.x, p.y, p.z)
}

pub(crate) fn plane(p: &Plane) -> String {
    match p {
        Plane::Axis { axis, value } => format!("Plane::Axis {{ axis: {axis}, value: {value:?} }}"),
        Plane::Points(points) => format!("Plane::Points({})", list(points, position)),
    }
}

pub(crate) fn point(p: &Point) -> String {
    match p {
        Point::Given(p) => format!("Point::Given({})", position(p)),
        Point::EdgePlane(ends, cut) => format!("Point::EdgePlane({}, {})", list(ends, position), plane(cut)),
        Point::Planes(planes) => format!("Point::Planes({})", list(planes, plane)),
    }
}

pub(crate) fn splitter(s: &Splitter) -> String {
    match s {
        Splitter::Edge(ends) => format!("Splitter::Edge({})", list(ends, position)),
        Splitter::Crease(planes) => format!("Splitter::Crease({})", list(planes, plane)),
        Splitter::Given(normal) => format!("Splitter::Given({})", position(normal)),
        Splitter::Parallel(p) => format!("Splitter::Parallel({})", plane(p)),
    }
}

pub(crate) fn direction(d: &Direction) -> String {
    match d {
        Direction::Given(d) => format!("Direction::Given({})", position(d)),
        Direction::Point(p) => format!("Direction::Point({})", point(p)),
        Direction::Crossing(pair) => format!("Direction::Crossing({})", list(pair, splitter)),
    }
}
