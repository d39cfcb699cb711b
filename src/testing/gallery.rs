//! Degenerate scenes by name: each is what some visibility program gets wrong.
//!
//! All are in [`Mode::Grid`] but for those that say otherwise, with an epsilon of 0. [`all`] lists them.

use super::{Case, Faces, Mode, Outlook, nudged};
use crate::scene::Side;
use glam::DVec3;

type Loops<'a> = &'a [&'a [[f64; 3]]];

fn case(loops: Loops<'_>, eye: [f64; 3]) -> Case {
    let faces = Faces::from(loops.iter().map(|corners| corners.to_vec()).collect::<Vec<_>>());
    Case { mode: Mode::Grid, faces, eye: eye.into(), direction: DVec3::Z, outlook: Outlook::Sphere, epsilon: 0.0 }
}

/// A square of half side 2 at height `z`, its front up.
fn square(z: f64) -> [[f64; 3]; 4] {
    [[-2.0, -2.0, z], [2.0, -2.0, z], [2.0, 2.0, z], [-2.0, 2.0, z]]
}

/// The cube of half side 4 about the origin, fronts inwards.
fn room() -> Faces {
    let mut faces = Faces::default();
    faces.cuboid(DVec3::splat(-4.0), DVec3::splat(4.0));
    faces.reversed()
}

fn from_within(faces: Faces, eye: [f64; 3]) -> Case {
    Case { faces, ..case(&[], eye) }
}

macro_rules! gallery {
    ($($(#[$doc:meta])* fn $name:ident() $body:block)*) => {
        $($(#[$doc])* pub fn $name() -> Case $body)*

        /// All scenes of the gallery with their names.
        pub fn all() -> Vec<(&'static str, Case)> {
            vec![$((stringify!($name), $name())),*]
        }
    };
}

gallery! {
    /// Nothing at all: one background in every direction.
    fn empty() {
        case(&[], [0.0; 3])
    }

    /// The eye lies in the plane of a square, beside it: edge-on, it hides nothing.
    fn eye_in_plane_beside() {
        case(&[&square(0.0), &square(1.0)], [5.0, 0.0, 0.0])
    }

    /// The eye lies inside a square: it hides nothing, from either side.
    fn eye_inside_polygon() {
        case(&[&square(0.0), &square(1.0), &square(-1.0)], [0.0, 1.0, 0.0])
    }

    /// The eye lies on an edge that two walls of a room share: both are edge-on, and half of the
    /// directions see the outside.
    fn eye_on_edge() {
        from_within(room(), [4.0, 4.0, 1.0])
    }

    /// The eye lies on the corner of a room: three walls are edge-on.
    fn eye_on_vertex() {
        from_within(room(), [4.0, 4.0, 4.0])
    }

    /// The eye lies on the line through an edge, beyond its end: two vertices are one direction.
    fn eye_in_line_with_edge() {
        case(&[&[[1.0, 0.0, 0.0], [3.0, 0.0, 0.0], [2.0, 2.0, 1.0]], &square(2.0)], [-2.0, 0.0, 0.0])
    }

    /// A wall of two coincident faces, back to back: from either side its front is seen.
    fn thin_wall() {
        let mut back = square(1.0);
        back.reverse();
        case(&[&square(1.0), &back], [0.5, 0.25, 3.0])
    }

    /// The same triangle three times: the first is seen.
    fn triplicate() {
        let triangle: &[[f64; 3]] = &[[0.0, 0.0, 1.0], [4.0, 0.0, 1.0], [0.0, 4.0, 2.0]];
        case(&[triangle, triangle, triangle], [0.0; 3])
    }

    /// Squares that overlap in one slanted plane, one of them turned over.
    fn coplanar_overlap() {
        let shifted = |x: f64| square(0.0).map(|[px, py, _]| [px + x, py, px + x + py]);
        let mut turned = shifted(2.0);
        turned.reverse();
        case(&[&shifted(0.0), &turned, &shifted(3.0)], [0.0, 1.0, 5.0])
    }

    /// Edges in one line that overlap without being equal: three great circles are one.
    fn overlapping_edges() {
        case(
            &[
                &[[-3.0, 0.0, 1.0], [1.0, 0.0, 1.0], [-1.0, 2.0, 1.0]],
                &[[-1.0, 0.0, 1.0], [3.0, 0.0, 1.0], [1.0, -2.0, 1.0]],
                &[[0.0, 0.0, 1.0], [4.0, 0.0, 1.0], [2.0, 2.0, 3.0]],
            ],
            [0.0; 3],
        )
    }

    /// A corner of one triangle lies in the middle of another's edge.
    fn t_junction() {
        case(
            &[
                &[[-2.0, 0.0, 1.0], [2.0, 0.0, 1.0], [0.0, 2.0, 1.0]],
                &[[0.0, 0.0, 1.0], [-2.0, -2.0, 1.0], [2.0, -2.0, 3.0]],
            ],
            [0.0; 3],
        )
    }

    /// A vertex lies in the inside of another polygon.
    fn vertex_in_polygon() {
        case(&[&square(2.0), &[[0.0, 0.0, 2.0], [3.0, 0.0, 0.0], [0.0, 3.0, 4.0]]], [0.25, 0.5, -1.0])
    }

    /// Three squares through one point: three creases meet there.
    fn interpenetrating() {
        case(
            &[
                &square(0.0),
                &[[0.0, -2.0, -2.0], [0.0, 2.0, -2.0], [0.0, 2.0, 2.0], [0.0, -2.0, 2.0]],
                &[[-2.0, -2.0, -2.0], [2.0, -2.0, 2.0], [2.0, 2.0, 2.0], [-2.0, 2.0, -2.0]],
            ],
            [3.0, 1.0, 5.0],
        )
    }

    /// Three beams, each over the next: no order of whole polygons exists.
    fn cyclic_overlap() {
        case(
            &[
                &[[-6.0, -4.0, -3.0], [6.0, -4.0, 3.0], [6.0, -2.0, 3.0], [-6.0, -2.0, -3.0]],
                &[[6.0, -4.0, -3.0], [0.0, 7.0, 3.0], [-2.0, 5.0, 3.0], [4.0, -6.0, -3.0]],
                &[[0.0, 7.0, -3.0], [-6.0, -4.0, 3.0], [-4.0, -6.0, 3.0], [2.0, 5.0, -3.0]],
            ],
            [0.0, 0.0, 9.0],
        )
    }

    /// Three edges at different depths that seem to cross in one point.
    fn three_edges_through_one_direction() {
        case(
            &[
                &[[-1.0, 0.0, 1.0], [1.0, 0.0, 1.0], [0.0, 1.0, 1.0]],
                &[[0.0, -2.0, 2.0], [0.0, 2.0, 2.0], [-2.0, 0.0, 2.0]],
                &[[-3.0, -3.0, 3.0], [3.0, 3.0, 3.0], [3.0, -3.0, 3.0]],
            ],
            [0.0; 3],
        )
    }

    /// Two triangles point by point opposite each other as seen from the eye: all their great circles agree.
    fn antipodal_triangles() {
        case(
            &[
                &[[-1.0, -1.0, 1.0], [2.0, -1.0, 1.0], [-1.0, 2.0, 1.0]],
                &[[1.0, 1.0, -1.0], [-2.0, 1.0, -1.0], [1.0, -2.0, -1.0]],
            ],
            [0.0; 3],
        )
    }

    /// Two vertices in exactly opposite directions, joined by an edge through the eye.
    fn edge_through_eye() {
        case(&[&[[-2.0, -1.0, 0.0], [2.0, 1.0, 0.0], [0.0, 0.0, 3.0]], &square(-1.0)], [0.0; 3])
    }

    /// Triangles without area: collinear corners, equal corners, all corners equal.
    fn no_area() {
        case(
            &[
                &[[0.0, 0.0, 1.0], [1.0, 1.0, 1.0], [3.0, 3.0, 1.0]],
                &[[0.0, 0.0, 1.0], [0.0, 0.0, 1.0], [1.0, 2.0, 1.0]],
                &[[1.0, 0.0, 1.0]; 3],
                &square(2.0),
            ],
            [0.0; 3],
        )
    }

    /// A convex ring with vertices in the middle of its edges.
    fn collinear_vertices() {
        case(
            &[&[
                [-2.0, -2.0, 1.0],
                [0.0, -2.0, 1.0],
                [1.0, -2.0, 1.0],
                [2.0, -2.0, 1.0],
                [2.0, 2.0, 1.0],
                [-2.0, 2.0, 1.0],
                [-2.0, 0.0, 1.0],
            ]],
            [1.0, -2.0, 0.0],
        )
    }

    /// A quadrilateral that is not planar: folded along a diagonal.
    fn folded() {
        case(&[&[[-2.0, -2.0, 1.0], [2.0, -2.0, 2.0], [2.0, 2.0, 1.0], [-2.0, 2.0, 2.0]], &square(3.0)], [0.0; 3])
    }

    /// A concave polygon, the eye above the notch.
    fn concave() {
        case(
            &[&[[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [4.0, 4.0, 0.0], [2.0, 1.0, 0.0], [0.0, 4.0, 0.0]], &square(-1.0)],
            [2.0, 2.0, 1.0],
        )
    }

    /// Boxes that touch in a face, in an edge and in a corner.
    fn touching_boxes() {
        let mut faces = room();
        for low in [[-1.0, -1.0, -1.0], [0.0, -1.0, -1.0], [1.0, 0.0, -1.0], [0.0, 0.0, 0.0]] {
            faces.cuboid(low.into(), DVec3::from(low) + 1.0);
        }
        from_within(faces, [2.0, 1.0, 1.0])
    }

    /// A box that stands flat on the floor: two coplanar faces with fronts on opposite sides.
    fn box_on_floor() {
        let mut faces = room();
        faces.cuboid([-1.0, -1.0, -4.0].into(), [1.0, 1.0, -2.0].into());
        from_within(faces, [2.0, 1.0, -3.0])
    }

    /// The horizon runs through edges and vertices, and cuts what crosses it.
    fn on_the_horizon() {
        let mut case = case(
            &[
                &[[2.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 2.0]],
                &[[-2.0, 0.0, 0.0], [0.0, -2.0, 0.0], [0.0, 0.0, -2.0]],
                &[[-3.0, 1.0, -1.0], [-3.0, -1.0, 0.0], [-3.0, 1.0, 1.0]],
            ],
            [0.0; 3],
        );
        case.outlook = Outlook::Hemisphere;
        case
    }

    /// On the floor of a room next to a wall's foot: what is above the floor's own plane.
    fn on_the_floor_at_the_wall() {
        let mut case = from_within(room(), [4.0, 0.0, -4.0]);
        case.outlook = Outlook::Above(0, Side::Front);
        case
    }

    /// Chaos: two triangles that differ by one place in one coordinate; the planes cross far outside.
    fn one_ulp_apart() {
        let triangle = [[0.1, 0.2, 1.3], [2.3, 0.1, 1.1], [0.4, 2.2, 1.7]];
        let mut other = triangle;
        other[2][2] = nudged(other[2][2], 1);
        Case { mode: Mode::Chaos, ..case(&[&triangle, &other], [0.3, 0.3, -2.0]) }
    }

    /// Chaos: the eye one place off the plane of a slanted triangle: it hides half of all directions, or nothing.
    fn eye_one_ulp_off_plane() {
        let eye = [0.25, 0.5, nudged(0.75, 1)];
        Case { mode: Mode::Chaos, ..case(&[&[[-1.0, 0.0, -1.0], [2.0, 0.0, 2.0], [0.0, 2.0, 2.0]], &square(3.0)], eye) }
    }

    /// Chaos: a scene in denormal numbers.
    fn denormal() {
        let unit = f64::from_bits(1);
        let scaled = interpenetrating().faces.mapped(|p| p * unit);
        Case { mode: Mode::Chaos, faces: scaled, ..case(&[], [3.0 * unit, unit, 5.0 * unit]) }
    }

    /// Chaos: a scene near the end of the exponents, where squares and differences overflow.
    fn huge() {
        let unit = 2f64.powi(1021);
        let scaled = interpenetrating().faces.mapped(|p| p * unit);
        Case { mode: Mode::Chaos, faces: scaled, ..case(&[], [3.0 * unit, unit, 5.0 * unit]) }
    }

    /// Chaos: a tiny triangle before a huge one.
    fn mixed_scales() {
        let (small, large) = (2f64.powi(-200), 2f64.powi(200));
        let triangle = |s: f64, z: f64| [[-s, -s, z], [2.0 * s, -s, z], [-s, 2.0 * s, z]];
        Case { mode: Mode::Chaos, ..case(&[&triangle(small, 1.0), &triangle(large, large * 2.0)], [0.0; 3]) }
    }
}
