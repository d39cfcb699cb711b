//! A room with a block on its floor, and the same turned in space: its corners are rounded then, and the block stands within rounding of the floor, above it, below
//! it or through it.

use glam::{DMat3, DVec3};
use nusselt::factors::{Exchange, ExchangeError, ExchangeOptions, PatchPlan, Row};
use nusselt::scene::{Material, Scene, SceneBuilder};
use std::f64::consts::PI;

/// Of each factor.
const TOLERANCE: f64 = 1e-3;

/// A room of 4 x 3 x 2.5, its fronts inside, and a block of 1 that stands on its floor: polygons 0 and 6 are the floor and the bottom of the block.
fn room(turn: DMat3) -> SceneBuilder {
    let cuboid = |low: [f64; 3], high: [f64; 3]| -> Vec<[f64; 3]> {
        let corner = |k: usize| [0, 1, 2].map(|axis| if k >> axis & 1 == 0 { low[axis] } else { high[axis] });
        (0..8).map(corner).map(|p| (turn * DVec3::from(p)).to_array()).collect()
    };
    // Counter-clockwise seen from inside, the one below first.
    let inside = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]];
    let outside = inside.map(|face| face.into_iter().rev().collect());
    let builder = Scene::builder();
    let builder = builder.mesh(&cuboid([0.0; 3], [4.0, 3.0, 2.5]), &inside.map(|face| face.to_vec()), grey());
    builder.mesh(&cuboid([1.0, 1.0, 0.0], [2.0, 2.0, 1.0]), &outside, grey())
}

fn built(room: SceneBuilder) -> Scene {
    room.build().expect("a scene")
}

fn grey() -> Material {
    Material::new("grey")
}

/// Factors between polygons, means over those of their patches, and what they may be off by.
struct Between {
    factors: Vec<Vec<f64>>,
    estimates: Vec<Vec<f64>>,
    backs: f64,
}

impl Between {
    fn of(scene: &Scene, plan: PatchPlan) -> Self {
        // As many points or views as that are enough for every factor: what jumps with rounding would take all there are.
        let options = ExchangeOptions { tolerance: TOLERANCE, most_views: 3000, ..ExchangeOptions::default() };
        let exchange = Exchange::new(scene, plan, options).expect("patches");
        let count = scene.polygon_count();
        let mut areas = vec![0.0; count];
        exchange.patches().iter().for_each(|patch| areas[patch.polygon.index()] += patch.area);
        let (mut factors, mut estimates) = (vec![vec![0.0; count]; count], vec![vec![0.0; count]; count]);
        let mut backs = 0.0;
        for (number, patch) in exchange.patches().iter().enumerate() {
            let row = exchange.row(number).expect("a row that closes");
            assert!((row.sum() - 1.0).abs() < 1e-12, "{}", row.sum());
            let (from, part) = (patch.polygon.index(), patch.area / areas[patch.polygon.index()]);
            for entry in &row.entries {
                assert!(entry.share.error <= TOLERANCE, "{number}: {entry:?}");
                let to = exchange.patches()[entry.column as usize].polygon.index();
                factors[from][to] += part * entry.share.factor;
                estimates[from][to] += part * entry.share.error;
            }
            backs += row.backs.factor;
        }
        Self { factors, estimates, backs }
    }
}

#[test]
fn factors_of_a_turned_room_are_those_of_the_room() {
    let turns = [
        DMat3::from_rotation_x(0.7) * DMat3::from_rotation_z(0.3),
        DMat3::from_rotation_y(1.1) * DMat3::from_rotation_x(0.2),
        DMat3::from_axis_angle(DVec3::new(1.0, 2.0, 3.0).normalize(), 2.0),
        DMat3::from_rotation_z(0.25 * PI),
    ];
    for plan in [PatchPlan::Mesh { longest_edge: 1.2 }, PatchPlan::Polygons] {
        let straight = Between::of(&built(room(DMat3::IDENTITY)), plan);
        for (number, turn) in turns.into_iter().enumerate() {
            let turned = Between::of(&built(room(turn)), plan);
            for (from, to) in (0..12).flat_map(|from| (0..12).map(move |to| (from, to))) {
                let [a, b] = [&straight, &turned].map(|room| room.factors[from][to]);
                // Of residues, as much as their estimates is placed on factors that may be off by as much. Rounding is what remains where they are 0.
                let allowed = 2.0 * (straight.estimates[from][to] + turned.estimates[from][to]) + 1e-12;
                assert!((a - b).abs() <= allowed, "{number} {plan:?}: {from} to {to}: {a} {b} {allowed:e}");
            }
            // All that leaves the bottom arrives at the floor below it, a twelfth of the whole, and nothing is lost to the inside.
            assert!((turned.factors[6][0] - 1.0).abs() < 1e-6, "{number}: {:?}", turned.factors[6]);
            assert!((turned.factors[0][6] - 1.0 / 12.0).abs() < 1e-6, "{number}: {:?}", turned.factors[0]);
            assert!(turned.backs < 1e-6, "{number}: {}", turned.backs);
        }
    }
}

/// Both faces of a thin wall are in one plane, too, and see the rooms on their sides.
#[test]
fn faces_of_a_thin_wall_are_not_face_to_face() {
    let wall = [[3.0, 0.0, 0.0], [3.0, 3.0, 0.0], [3.0, 3.0, 2.5], [3.0, 0.0, 2.5]];
    let scene = room(DMat3::IDENTITY).mesh(&wall, &[vec![0, 1, 2, 3], vec![3, 2, 1, 0]], grey());
    let between = Between::of(&built(scene), PatchPlan::Polygons);
    assert!(between.factors[12][13].abs().max(between.factors[13][12].abs()) <= 0.0);
    // One of them sees the narrow part of the room, the other one the block.
    assert!(between.factors[12][5] > 0.3 && between.factors[13][4] > 0.05 && between.factors[13][11] > 0.01);
}

fn factor(row: &Row, column: u32) -> f64 {
    row.entries.iter().find(|entry| entry.column == column).map_or(0.0, |entry| entry.share.factor)
}

/// Boxes as a room has its block, by corners.
fn with_boxes(boxes: &[[[f64; 3]; 2]], turn: DMat3) -> SceneBuilder {
    let inside = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]];
    let outside = inside.map(|face| face.into_iter().rev().collect());
    boxes.iter().fold(room(turn), |builder, [low, high]| {
        let corner = |k: usize| [0, 1, 2].map(|axis| if k >> axis & 1 == 0 { low[axis] } else { high[axis] });
        let corners: Vec<[f64; 3]> = (0..8).map(corner).map(|p| (turn * DVec3::from(p)).to_array()).collect();
        builder.mesh(&corners, &outside, grey())
    })
}

/// A block on a block whose top is in two parts: where they are rounded, these are no one facet, and cover the bottom of the upper one together only.
#[test]
fn a_bottom_astride_two_tops_is_shut() {
    let corners = [
        [2.5, 1.0, 0.0],
        [3.5, 1.0, 0.0],
        [3.5, 2.0, 0.0],
        [2.5, 2.0, 0.0],
        [2.5, 1.0, 1.0],
        [3.5, 1.0, 1.0],
        [3.5, 2.0, 1.0],
        [2.5, 2.0, 1.0],
        [3.1, 1.0, 1.0],
        [3.1, 2.0, 1.0],
    ];
    let faces = [[3, 2, 1, 0], [4, 8, 9, 7], [8, 5, 6, 9], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]];
    for turn in [DMat3::IDENTITY, DMat3::from_rotation_x(0.7) * DMat3::from_rotation_z(0.3)] {
        let corners = corners.map(|p| (turn * DVec3::from(p)).to_array());
        let builder = with_boxes(&[[[2.75, 1.25, 1.0], [3.25, 1.75, 1.5]]], turn);
        let scene = built(builder.mesh(&corners, &faces.map(|face| face.to_vec()), grey()));
        let options = ExchangeOptions { tolerance: TOLERANCE, ..ExchangeOptions::default() };
        let exchange = Exchange::new(&scene, PatchPlan::Polygons, options).expect("patches");
        // The upper block's bottom is polygon 12, the lower one's 18, and the tops 19 and 20, of which 0.175 and 0.075 square units are below the upper one.
        for (from, to, expected) in [
            (0, 18, 1.0 / 12.0),
            (0, 12, 0.0),
            (19, 12, 0.175 / 0.6),
            (20, 12, 0.075 / 0.4),
            (12, 19, 0.7),
            (12, 20, 0.3),
        ] {
            let row = exchange.row(from).expect("a row that closes");
            let found = factor(&row, to);
            assert!((found - expected).abs() < 1e-6, "{from} to {to}: {found} instead of {expected}");
            assert!(row.backs.factor < 1e-6 && (row.sum() - 1.0).abs() < 1e-12, "{row:?}");
        }
    }
}

/// The same block twice: the first bottom gets what leaves the floor below, and the row closes.
#[test]
fn what_is_below_two_bottoms_is_shut_once() {
    let scene = built(with_boxes(&[[[1.0, 1.0, 0.0], [2.0, 2.0, 1.0]]], DMat3::IDENTITY));
    let options = ExchangeOptions { tolerance: TOLERANCE, most_views: 3000, ..ExchangeOptions::default() };
    let row = Exchange::new(&scene, PatchPlan::Polygons, options).expect("patches").row(0).expect("a row that closes");
    assert!((factor(&row, 6) - 1.0 / 12.0).abs() < 1e-6 && factor(&row, 12).abs() < 1e-6, "{row:?}");
    assert!((row.sum() - 1.0).abs() < 1e-12);
}

/// The same, where each of the rows is told by others what they have found: a block, and a plate below it.
#[test]
fn rows_that_tell_each_other_close_where_bottoms_lie_on_each_other() {
    let plate = [[1.2, 1.2, 0.0], [1.2, 1.8, 0.0], [1.8, 1.8, 0.0], [1.8, 1.2, 0.0]];
    for turn in [DMat3::IDENTITY, DMat3::from_rotation_x(0.7) * DMat3::from_rotation_z(0.3)] {
        let plate = plate.map(|p| (turn * DVec3::from(p)).to_array());
        let scene = built(room(turn).mesh(&plate, &[vec![0, 1, 2, 3]], grey()));
        let options = ExchangeOptions { tolerance: TOLERANCE, ..ExchangeOptions::default() };
        let exchange = Exchange::new(&scene, PatchPlan::Polygons, options).expect("patches");
        let mut rows = Vec::new();
        let closed = exchange.rows(0..exchange.patches().len(), |row| {
            rows.push(row);
            Ok::<(), ExchangeError>(())
        });
        closed.expect("rows that close");
        assert!((factor(&rows[0], 6) + factor(&rows[0], 12) - 1.0 / 12.0).abs() < 1e-6, "{:?}", rows[0]);
    }
}

/// Solids that overlap show the room what their union does, and what is within both counts for none: an annex that reaches into a building, against one that ends at its wall;
/// a box inside of it, against none.
#[test]
fn overlapping_solids_exchange_with_a_room_what_their_union_does() {
    let annex = |from: f64| [[from, 1.25, 0.0], [2.75, 1.75, 0.5]];
    let hidden = [[1.25, 1.25, 0.0], [1.75, 1.75, 0.5]];
    for turn in [DMat3::IDENTITY, DMat3::from_rotation_x(0.7) * DMat3::from_rotation_z(0.3)] {
        let of = |boxes: &[[[f64; 3]; 2]]| Between::of(&built(with_boxes(boxes, turn)), PatchPlan::Polygons);
        let union = of(&[annex(2.0)]);
        let alone = of(&[]);
        for (overlapping, apart) in [(of(&[annex(1.5)]), &union), (of(&[hidden]), &alone)] {
            // The room, and all that it sees: those of the same place are the same face of each.
            for (from, to) in (0..6).flat_map(|from| (0..overlapping.factors.len()).map(move |to| (from, to))) {
                let value = |of: &[Vec<f64>]| of[from].get(to).copied().unwrap_or(0.0);
                let [a, b] = [value(&overlapping.factors), value(&apart.factors)];
                let allowed = 2.0 * (value(&overlapping.estimates) + value(&apart.estimates)) + 1e-12;
                assert!((a - b).abs() <= allowed, "{from} to {to}: {a} {b} {allowed:e}");
            }
            // All that leaves the building's bottom arrives at the floor.
            assert!((overlapping.factors[6][0] - 1.0).abs() < 1e-6, "{:?}", overlapping.factors[6]);
        }
    }
}

/// Where a block has no top, what stands in it is seen from the floor below it: neither of the two bottoms shuts that off for certain, and both are named.
#[test]
fn bottoms_of_open_bodies_that_overlap_are_named() {
    let other = [[1.5, 1.5, 0.0], [2.5, 2.5, 0.5]];
    for turn in [DMat3::IDENTITY, DMat3::from_rotation_x(0.7) * DMat3::from_rotation_z(0.3)] {
        let named = |builder: SceneBuilder| {
            let options = ExchangeOptions { tolerance: TOLERANCE, ..ExchangeOptions::default() };
            let exchange = Exchange::new(&built(builder), PatchPlan::Polygons, options).expect("patches");
            exchange
                .half_shut()
                .expect("views")
                .into_iter()
                .map(|pair| pair.map(|polygon| polygon.0))
                .collect::<Vec<_>>()
        };
        assert_eq!(named(with_boxes(&[other], turn)), [[0; 2]; 0]);
        assert_eq!(named(with_boxes(&[], turn)), [[0; 2]; 0]);
        // Three walls and a bottom, without a top and the wall towards the block, whose bottom is proved to be that of a solid.
        let [low, high] = other;
        let corner = |k: usize| [0, 1, 2].map(|axis| if k >> axis & 1 == 0 { low[axis] } else { high[axis] });
        let corners: Vec<[f64; 3]> = (0..8).map(corner).map(|p| (turn * DVec3::from(p)).to_array()).collect();
        let faces = [vec![2, 3, 1, 0], vec![1, 5, 4, 0], vec![6, 7, 3, 2], vec![3, 7, 5, 1]];
        assert_eq!(named(with_boxes(&[], turn).mesh(&corners, &faces, grey())), [[0, 12]]);
    }
}

/// A wall in line with the face of a block, as facades of a row of houses are: rounding puts each before or behind the plane of the other.
#[test]
fn a_wall_in_line_with_a_block_sees_what_it_does_in_a_straight_room() {
    let wall = [[2.5, 1.0, 0.0], [3.5, 1.0, 0.0], [3.5, 1.0, 1.0], [2.5, 1.0, 1.0]];
    let row = |turn: DMat3| {
        let corners = wall.map(|p| (turn * DVec3::from(p)).to_array());
        // Two triangles, as its corners need not be in one plane.
        let scene = built(room(turn).mesh(&corners, &[vec![0, 1, 2], vec![0, 2, 3]], grey()));
        let options = ExchangeOptions { tolerance: TOLERANCE, ..ExchangeOptions::default() };
        let exchange = Exchange::new(&scene, PatchPlan::Polygons, options).expect("patches");
        [12, 13].map(|patch| exchange.row(patch).expect("a row that closes"))
    };
    let straight = row(DMat3::IDENTITY);
    for k in 0..24 {
        let turned = row(DMat3::from_rotation_z(0.1 + 0.25 * f64::from(k)) * DMat3::from_rotation_x(f64::from(k % 3)));
        for ((a, b), column) in straight.iter().zip(&turned).flat_map(|pair| (0..14).map(move |column| (pair, column)))
        {
            let [found, expected] = [factor(b, column), factor(a, column)];
            assert!((found - expected).abs() <= 2.0 * TOLERANCE, "{k}: {column}: {found} {expected}");
        }
    }
}

/// A cube's walls see each other, by the catalogues of view factors, if it is in a building and touches the inside of its walls, or is their lining.
#[test]
fn a_room_within_a_solid_is_not_shut_by_it() {
    let unit: Vec<[f64; 3]> = (0..8).map(|k| [k & 1, k >> 1 & 1, k >> 2 & 1].map(f64::from)).collect();
    let inside = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]];
    let outside = inside.map(|face| face.into_iter().rev().collect::<Vec<usize>>());
    let inside = inside.map(|face| face.to_vec());
    // A building that begins where the cube does, at x = 0, and the cube itself.
    for building in [|[x, y, z]: [f64; 3]| [3.0 * x, 3.0 * y - 1.0, 3.0 * z - 1.0], |p: [f64; 3]| p] {
        let walls: Vec<[f64; 3]> = unit.iter().copied().map(building).collect();
        let scene = built(Scene::builder().mesh(&walls, &outside, grey()).mesh(&unit, &inside, grey()));
        let options = ExchangeOptions { tolerance: 1e-5, ..ExchangeOptions::default() };
        let exchange = Exchange::new(&scene, PatchPlan::Polygons, options).expect("patches");
        // The wall at x = 0: that of the building sees nothing but sky, that of the cube the one across and four beside it.
        let outer = exchange.row(4).expect("a row that closes");
        assert!((outer.background.factor - 1.0).abs() < 1e-9, "{outer:?}");
        let inner = exchange.row(10).expect("a row that closes");
        for (column, expected) in [(11, 0.199_825), (6, 0.200_044), (7, 0.200_044), (8, 0.200_044), (9, 0.200_044)] {
            // To the digits given, and the tolerance.
            let found = factor(&inner, column);
            assert!((found - expected).abs() < 1.1e-5, "{column}: {found} {expected}");
        }
    }
}
