//! A furnished room.

use super::free::FreeSpace;
use super::furniture::{cabinet, chair, crates, lone_ball, shelf, table};
use super::mesh::Mesh;
use super::parts::{Part, Piece, furnish};
use super::rng::Rng;
use super::shell::Shell;
use super::ticks::{Frame, metres, mm};
use crate::scene::Axis;

/// Every piece of furniture has a square of this side to itself.
const SLOT: i64 = mm(1600);
const HEIGHT: i64 = mm(2800);

type Maker = fn(&mut Rng, Frame) -> Vec<Part>;

/// What stands in rooms.
const FURNITURE: [(&str, Maker); 6] = [
    ("table", table),
    ("chair", chair),
    ("shelf", |rng, frame| {
        let width = rng.stepped(mm(800), mm(1100), mm(50));
        shelf(rng, frame, width)
    }),
    ("cabinet", cabinet),
    ("crates", crates),
    ("ball", lone_ball),
];

/// About two fifths of the polygons for the shell, the rest for furniture; both the number of
/// pieces and their tessellation grow as the square root of the number of polygons.
pub(super) fn room(polygons: usize, seed: u64) -> Mesh {
    let mut rng = Rng::new(seed);
    let slots = (polygons.isqrt() / 4).max(2);
    let rows = (slots * 2 / 3).isqrt().max(1);
    let columns = slots.div_ceil(rows);
    let size = [SLOT * columns as i64, SLOT * rows as i64, HEIGHT];
    let lamps = [columns, rows].map(|slots| slots.div_ceil(4));
    let shell = Shell::within(polygons * 2 / 5, size, lamps, [mm(1200), mm(600)]);
    let mut mesh =
        Mesh::empty(FreeSpace { low: [0.0; 3], high: size.map(metres), up: Axis::Z, margin: 0.05, solids: Vec::new() });
    shell.add_to(&mut mesh);
    let budget = polygons - mesh.faces().len();
    let pieces = pieces(&mut rng, columns, rows, budget);
    furnish(&mut mesh, &pieces, budget);
    mesh
}

/// A piece for every slot, as far as the budget goes: all kinds in turn, each round in another order.
fn pieces(rng: &mut Rng, columns: usize, rows: usize, mut budget: usize) -> Vec<Piece> {
    let mut numbers = [0; FURNITURE.len()];
    let mut pieces = Vec::new();
    let mut round = Vec::new();
    for slot in 0..columns * rows {
        let frame = frame(rng, slot % columns, slot / columns);
        if slot % FURNITURE.len() == 0 {
            round = rng.shuffled(FURNITURE.len());
        }
        let first = round[slot % FURNITURE.len()];
        for kind in (0..FURNITURE.len()).map(|k| (first + k) % FURNITURE.len()) {
            let (name, make) = FURNITURE[kind];
            let piece = Piece { name: format!("{name}_{}", numbers[kind] + 1), parts: make(rng, frame) };
            if piece.least() <= budget {
                budget -= piece.least();
                numbers[kind] += 1;
                pieces.push(piece);
                break;
            }
        }
    }
    pieces
}

/// A place in a slot: pieces reach at most 0.75 m from their origin. A third are not turned.
fn frame(rng: &mut Rng, column: usize, row: usize) -> Frame {
    let mut place = |slot: usize| SLOT * slot as i64 + SLOT / 2 + rng.stepped(mm(-40), mm(40), mm(5));
    let frame = Frame::at(place(column), place(row));
    if rng.chance(1, 3) { frame } else { frame.turned(rng.stepped(-1023, 1023, 2), 1024) }
}
