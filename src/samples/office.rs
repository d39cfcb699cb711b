//! A floor of office cubicles.

use super::free::FreeSpace;
use super::furniture::{cabinet, chair, shelf, slab};
use super::mesh::Mesh;
use super::paint::Paint;
use super::parts::{Part, Piece, furnish};
use super::rng::Rng;
use super::shell::Shell;
use super::ticks::{Frame, metres, mm};
use crate::scene::Axis;

/// A cubicle's share of the floor, aisles included.
const CUBICLE: [i64; 2] = [mm(3200), mm(3000)];
/// The aisle around all cubicles.
const AISLE: i64 = mm(800);
const HEIGHT: i64 = mm(3000);

type Maker = fn(&mut Rng, [i64; 2]) -> Vec<Part>;

/// What stands in cubicles, what is needed most first, and in how many of 8 cubicles.
const FURNITURE: [(&str, usize, Maker); 7] = [
    ("partition", 8, partition),
    ("desk", 8, desk),
    ("drawers", 7, drawers),
    ("cabinet", 6, |rng, at| cabinet(rng, place(at, mm(2650), mm(1050)).turned_right())),
    ("chair", 8, desk_chair),
    ("monitor", 7, monitor),
    ("shelf", 5, |rng, at| shelf(rng, place(at, mm(480), mm(1350)).turned_right(), mm(1000))),
];

/// Three tenths of the polygons for the shell, the rest for furniture; the number of cubicles grows
/// as the number of polygons to the power 3/4, the tessellation as what is left.
pub(super) fn office(polygons: usize, seed: u64) -> Mesh {
    let mut rng = Rng::new(seed);
    let root = polygons.isqrt();
    let cubicles = (root * root.isqrt() / 20).max(1);
    let rows = cubicles.isqrt();
    let columns = cubicles.div_ceil(rows);
    let size = [CUBICLE[0] * columns as i64 + 2 * AISLE, CUBICLE[1] * rows as i64 + 2 * AISLE, HEIGHT];
    let lamps = [columns, rows].map(|cubicles| cubicles.div_ceil(2));
    let shell = Shell::within(polygons * 3 / 10, size, lamps, [mm(1800), mm(600)]);
    let mut mesh =
        Mesh::empty(FreeSpace { low: [0.0; 3], high: size.map(metres), up: Axis::Z, margin: 0.05, solids: Vec::new() });
    shell.add_to(&mut mesh);
    let budget = polygons - mesh.faces().len();
    let pieces = pieces(&mut rng, columns, rows, budget);
    furnish(&mut mesh, &pieces, budget);
    mesh
}

/// Furniture for all cubicles, as far as the budget goes: first partitions everywhere, then desks ...
fn pieces(rng: &mut Rng, columns: usize, rows: usize, mut budget: usize) -> Vec<Piece> {
    let mut pieces = Vec::new();
    for (name, share, make) in FURNITURE {
        for cubicle in 0..columns * rows {
            let at = [(cubicle % columns, CUBICLE[0]), (cubicle / columns, CUBICLE[1])]
                .map(|(slot, length)| AISLE + length * slot as i64);
            let wanted = rng.chance(share, 8);
            let piece = Piece { name: format!("{name}_{}", cubicle + 1), parts: make(rng, at) };
            if wanted && piece.least() <= budget {
                budget -= piece.least();
                pieces.push(piece);
            }
        }
    }
    pieces
}

/// Two thin walls flat on the floor that meet at a right angle.
fn partition(rng: &mut Rng, [x, y]: [i64; 2]) -> Vec<Part> {
    let height = rng.stepped(mm(1200), mm(1800), mm(100));
    let back = [[x + mm(200), y + mm(2800), 0], [x + mm(3000), y + mm(2850), height]];
    let side = [[x + mm(200), y + mm(800), 0], [x + mm(250), y + mm(2800), height - rng.stepped(0, mm(200), mm(100))]];
    [back, side].map(|[low, high]| Part::block(Frame::WORLD, low, high, Paint::Fabric)).into()
}

/// A desk on two side panels that stand flat on the floor.
fn desk(rng: &mut Rng, at: [i64; 2]) -> Vec<Part> {
    let frame = place(at, mm(1500), mm(2380));
    let (width, depth) = (rng.stepped(mm(1400), mm(1700), mm(100)), rng.stepped(mm(660), mm(760), mm(20)));
    let paint = [Paint::Oak, Paint::Walnut][rng.below(2)];
    let mut parts = vec![slab(frame, [0, 0], [width, depth], [mm(720), mm(750)], paint)];
    for side in [-1, 1] {
        let x = side * (width / 2 - mm(40));
        parts.push(slab(frame, [x, 0], [mm(30), depth - mm(40)], [0, mm(720)], Paint::Metal));
    }
    parts
}

/// A chest of drawers below the desk.
fn drawers(rng: &mut Rng, at: [i64; 2]) -> Vec<Part> {
    let height = rng.stepped(mm(500), mm(640), mm(20));
    vec![slab(place(at, mm(1130), mm(2380)), [0, 0], [mm(420), mm(560)], [0, height], Paint::Metal)]
}

/// A chair in front of the desk, one in four turned by some angle.
fn desk_chair(rng: &mut Rng, at: [i64; 2]) -> Vec<Part> {
    let frame = place(at, mm(1500), mm(1600));
    let turned = frame.turned(rng.stepped(-1023, 1023, 2), 1024);
    let frame = if rng.chance(1, 4) { turned } else { frame };
    chair(rng, frame)
}

/// A screen on a foot flat on the desk.
fn monitor(rng: &mut Rng, at: [i64; 2]) -> Vec<Part> {
    let frame = place(at, mm(1500), mm(2500));
    let width = rng.stepped(mm(500), mm(800), mm(20));
    let bottom = mm(750) + rng.stepped(mm(60), mm(120), mm(10));
    vec![
        slab(frame, [0, 0], [mm(120), mm(80)], [mm(750), bottom], Paint::Metal),
        slab(frame, [0, 0], [width, mm(40)], [bottom, bottom + mm(380)], Paint::Screen),
    ]
}

fn place(at: [i64; 2], x: i64, y: i64) -> Frame {
    Frame::at(at[0] + x, at[1] + y)
}
