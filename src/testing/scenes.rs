//! Strategies for scenes, most of them degenerate in some way.

use super::{Faces, Mode, coordinate, few_ulps_from, nudged, point};
use glam::DVec3;
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::Index;

/// Every point whose coordinates are at most this in size lies strictly inside every [`closed_scene`].
pub const INSIDE: f64 = 3.0;

/// A room, fronts inwards, with boxes and tetrahedra in it, some of which poke through others or lie
/// flat on a wall; some faces are subdivided. It is closed exactly: from within [`INSIDE`] of the origin no ray escapes.
///
/// The room's walls are faces 0 to 5, or what subdivision left of them. In grid mode subdivision makes T-junctions;
/// in chaos mode every vertex is displaced, each by its own amount, and walls are folded: the mesh conforms, so that no
/// crack opens.
pub fn closed_scene(mode: Mode) -> impl Strategy<Value = Faces> {
    let half = || (4i8..=8).prop_map(f64::from);
    let rooms = ([half(), half(), half()], [half(), half(), half()]).prop_map(|(low, high)| {
        let mut room = Faces::default();
        room.cuboid(-DVec3::from(low), DVec3::from(high));
        room.reversed()
    });
    let splits = vec(any::<Index>(), 0..5);
    (rooms, vec(thing(), 0..4), splits, any::<u64>()).prop_map(move |(mut faces, things, splits, seed)| {
        for thing in things {
            faces.append(&thing);
        }
        for split in splits {
            let face = split.index(faces.len());
            // The middle of an edge would be displaced off it.
            if mode == Mode::Grid || faces.loops()[face].len() > 3 {
                faces = faces.split(face);
            }
        }
        match mode {
            Mode::Grid => faces,
            Mode::Chaos => faces.mapped(|p| p + displacement(p, seed)),
        }
    })
}

/// A point within [`INSIDE`] of the origin in each coordinate: strictly inside of every [`closed_scene`].
pub fn point_inside(mode: Mode) -> impl Strategy<Value = DVec3> {
    let whole = || (-INSIDE as i8..=INSIDE as i8).prop_map(f64::from);
    let any = || -INSIDE..INSIDE;
    match mode {
        Mode::Grid => [whole(), whole(), whole()].prop_map(DVec3::from).boxed(),
        Mode::Chaos => [any(), any(), any()].prop_map(DVec3::from).boxed(),
    }
}

/// A box or a tetrahedron on the grid, not flat.
fn thing() -> impl Strategy<Value = Faces> {
    let low = || (-6i8..=4).prop_map(f64::from);
    let size = || (1i8..=3).prop_map(f64::from);
    ([low(), low(), low()], [size(), size(), size()], any::<bool>()).prop_map(|(low, size, is_box)| {
        let (low, size) = (DVec3::from(low), DVec3::from(size));
        let mut faces = Faces::default();
        if is_box {
            faces.cuboid(low, low + size);
        } else {
            let [x, y, z] = DVec3::AXES.map(|axis| low + size * axis);
            faces.tetrahedron([x, y, z, low]);
        }
        faces
    })
}

/// Up to 0.3 in each coordinate, a function of the point alone: vertices that coincide stay together.
fn displacement(p: DVec3, seed: u64) -> DVec3 {
    let amount = |axis: u64| {
        // SplitMix64's mixer over the seed, the axis and the coordinates (-0 = +0).
        let mixed = p.to_array().into_iter().map(|x| (x + 0.0).to_bits()).fold(seed ^ axis, |state, bits| {
            let z = (state ^ bits).wrapping_add(0x9E37_79B9_7F4A_7C15);
            let z = (z ^ z >> 30).wrapping_mul(0xBF58_476D_1CE4_E5B9);
            let z = (z ^ z >> 27).wrapping_mul(0x94D0_49BB_1331_11EB);
            z ^ z >> 31
        });
        (mixed >> 11) as f64 / 2f64.powi(53) * 0.6 - 0.3
    };
    DVec3::new(amount(0), amount(1), amount(2))
}

/// Up to `most` triangles with no vertex in common but by chance.
pub fn triangle_soup(mode: Mode, most: usize) -> impl Strategy<Value = Faces> {
    vec([point(mode), point(mode), point(mode)], 1..=most).prop_map(|triangles| of_loops(&triangles))
}

/// Up to `most` triangles on a few common points: many share vertices and edges, or are equal, or flat.
pub fn mesh_soup(mode: Mode, most: usize) -> impl Strategy<Value = Faces> {
    let corner = any::<Index>;
    (vec(point(mode), 4..10), vec([corner(), corner(), corner()], 1..=most)).prop_map(|(points, triangles)| {
        let triangles: Vec<_> = triangles.iter().map(|t| t.map(|k| *k.get(&points))).collect();
        of_loops(&triangles)
    })
}

fn of_loops<const N: usize>(loops: &[[DVec3; N]]) -> Faces {
    let mut faces = Faces::default();
    for corners in loops {
        faces.push(corners);
    }
    faces
}

/// Two triangles that differ in one coordinate of one corner, by one step: a whole number on the
/// grid, the last place in chaos. Half of the time the second shows its other side.
pub fn near_coplanar_pair(mode: Mode) -> impl Strategy<Value = Faces> {
    let triangle = [point(mode), point(mode), point(mode)];
    (triangle, 0usize..3, 0usize..3, prop_oneof![Just(-1i64), Just(1)], any::<bool>()).prop_map(
        move |(triangle, corner, axis, step, turned)| {
            let mut other = triangle;
            let x = &mut other[corner][axis];
            *x = match mode {
                Mode::Grid => *x + step as f64,
                Mode::Chaos => nudged(*x, step),
            };
            if turned {
                other.reverse();
            }
            of_loops(&[triangle, other])
        },
    )
}

/// A triangle, and others with a corner in the middle of one of its edges: exactly there on the grid,
/// up to rounding in chaos.
pub fn t_junctions(mode: Mode) -> impl Strategy<Value = Faces> {
    let triangle = || [point(mode), point(mode), point(mode)];
    (triangle(), vec((0usize..3, [point(mode), point(mode)]), 1..4)).prop_map(|(first, others)| {
        let mut faces = of_loops(&[first]);
        for (edge, [p, q]) in others {
            faces.push(&[first[edge] * 0.5 + first[(edge + 1) % 3] * 0.5, p, q]);
        }
        faces
    })
}

/// Two to five large triangles, all of which have about the origin in their inside: nearly all
/// pass through each other.
pub fn interpenetrating(mode: Mode) -> impl Strategy<Value = Faces> {
    let near = || (-1i8..=1).prop_map(f64::from);
    let middle = move || {
        [near(), near(), near()].prop_flat_map(move |p| match mode {
            Mode::Grid => Just(DVec3::from(p)).boxed(),
            Mode::Chaos => p.map(few_ulps_from).prop_map(DVec3::from).boxed(),
        })
    };
    vec((middle(), point(mode), point(mode)), 2..6).prop_map(|triangles| {
        let triangles: Vec<_> = triangles.into_iter().map(|(c, u, v)| [c + u, c - u + v, c - v].map(finite)).collect();
        of_loops(&triangles)
    })
}

/// Two to six triangles and parallelograms in one plane, some turned over, that overlap each other.
/// Exactly coplanar on the grid; in chaos exactly so only if the plane happens to be axis-aligned.
pub fn coplanar_overlaps(mode: Mode) -> impl Strategy<Value = Faces> {
    let step = || (-3i8..=3).prop_map(f64::from);
    let corner = move || [step(), step()];
    let plane = prop_oneof![
        [point(mode), point(mode), point(mode)],
        coordinate(mode).prop_map(|z| [DVec3::new(0.0, 0.0, z), DVec3::X, DVec3::Y]),
    ];
    (plane, vec(([corner(), corner(), corner()], any::<bool>()), 2..7)).prop_map(move |([o, u, v], shapes)| {
        let mut faces = Faces::default();
        for (corners, is_parallelogram) in shapes {
            let corners = corners.map(|[i, j]| finite(o + u * i + v * j));
            // Rounded corners need not be planar: three always are.
            if is_parallelogram && mode == Mode::Grid {
                faces.parallelogram(corners);
            } else {
                faces.push(&corners);
            }
        }
        faces
    })
}

/// A parallelogram cut into up to 5 x 5 tiles that share their corners; some are missing, halved to triangles, turned over, or there twice; and
/// up to two triangles elsewhere. In chaos, where a plane with slopes cannot be kept, it is axis-aligned; its corners
/// are nudged off their lines, all or none.
pub fn tiles(mode: Mode) -> impl Strategy<Value = Faces> {
    let plane = match mode {
        Mode::Grid => [point(mode), point(mode), point(mode)].boxed(),
        Mode::Chaos => coordinate(mode).prop_map(|z| [DVec3::new(-2.0, -2.0, z), DVec3::X, DVec3::Y]).boxed(),
    };
    let kinds = vec(0u8..16, 25);
    (plane, [1i8..=5, 1i8..=5], kinds, any::<bool>(), any::<u64>(), triangle_soup(mode, 2)).prop_map(
        move |([o, u, v], [columns, rows], kinds, nudge, seed, others)| {
            let corner = |i: i8, j: i8| {
                let p = o + u * f64::from(i) + v * f64::from(j);
                let off = displacement(p, seed);
                finite(if nudge && mode == Mode::Chaos { DVec3::new(p.x + off.x, p.y + off.y, p.z) } else { p })
            };
            let mut faces = Faces::default();
            let places = (0..rows).flat_map(|j| (0..columns).map(move |i| (i, j)));
            for ((i, j), kind) in places.zip(kinds) {
                let mut tile = [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
                match kind {
                    0 => continue,
                    1 => tile.reverse(),
                    _ => {}
                }
                for _ in 0..if kind == 2 { 2 } else { 1 } {
                    if kind % 4 == 3 {
                        faces.push(&[tile[0], tile[1], tile[2]]);
                        faces.push(&[tile[0], tile[2], tile[3]]);
                    } else {
                        faces.push(&tile);
                    }
                }
            }
            faces.append(&others);
            faces
        },
    )
}

/// A soup in which some triangles occur again, some of these turned over.
pub fn duplicates(mode: Mode) -> impl Strategy<Value = Faces> {
    (mesh_soup(mode, 4), vec((any::<Index>(), any::<bool>()), 1..5)).prop_map(|(mut faces, again)| {
        for (which, turned) in again {
            let mut corners = which.get(faces.loops()).clone();
            if turned {
                corners.reverse();
            }
            faces.push(&corners);
        }
        faces
    })
}

/// Three beams, each over the next, that no order of whole polygons can draw; each corner moved by up to
/// one step: a whole number on the grid, a few places in chaos.
pub fn cyclic_overlap(mode: Mode) -> impl Strategy<Value = Faces> {
    let ends = [DVec3::new(-6.0, -4.0, 0.0), DVec3::new(6.0, -4.0, 0.0), DVec3::new(0.0, 7.0, 0.0)];
    vec([-1i8..=1, -1i8..=1, -1i8..=1], 12).prop_map(move |moves| {
        let mut faces = Faces::default();
        let mut moves = moves.into_iter();
        let mut moved = |p: DVec3| {
            let steps = moves.next().unwrap_or_default();
            DVec3::from([0, 1, 2].map(|k| match mode {
                Mode::Grid => p[k] + f64::from(steps[k]),
                Mode::Chaos => nudged(p[k], i64::from(steps[k])),
            }))
        };
        for k in 0..3 {
            // From below one corner of the triangle to above the next, and two steps wide.
            let (from, to) = (ends[k] - DVec3::Z * 3.0, ends[(k + 1) % 3] + DVec3::Z * 3.0);
            let wide = DVec3::new(from.y - to.y, to.x - from.x, 0.0).signum() * 2.0;
            let corners = [from, to, to + wide, from + wide].map(&mut moved);
            faces.push(&[corners[0], corners[1], corners[2]]);
            faces.push(&[corners[0], corners[2], corners[3]]);
        }
        faces
    })
}

/// Any of these scenes, or two of them in one.
pub fn scene(mode: Mode) -> impl Strategy<Value = Faces> {
    let one = || {
        prop_oneof![
            3 => triangle_soup(mode, 6).boxed(),
            3 => mesh_soup(mode, 6).boxed(),
            2 => near_coplanar_pair(mode).boxed(),
            2 => t_junctions(mode).boxed(),
            2 => interpenetrating(mode).boxed(),
            2 => coplanar_overlaps(mode).boxed(),
            2 => duplicates(mode).boxed(),
            2 => tiles(mode).boxed(),
            1 => cyclic_overlap(mode).boxed(),
            1 => closed_scene(mode).boxed(),
        ]
    };
    prop_oneof![
        2 => one(),
        1 => (one(), one()).prop_map(|(mut first, second)| {
            first.append(&second);
            first
        }),
    ]
}

/// A sum of huge numbers may overflow.
fn finite(p: DVec3) -> DVec3 {
    if p.is_finite() { p } else { DVec3::from(p.to_array().map(|x| if x.is_finite() { x } else { f64::MAX })) }
}
