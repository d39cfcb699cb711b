//! Furniture around the origin of a frame, made of boxes that touch only where one lies flat on
//! another, and balls that touch nothing.

use super::free::Ball;
use super::paint::Paint;
use super::parts::{Form, Part};
use super::rng::Rng;
use super::ticks::{Frame, metres, mm};

/// How high feet keep off the floor.
const GLIDE: i64 = mm(2);
/// How far balls keep off what they lie on.
const BALL_GAP: i64 = mm(1);

const WOODS: [Paint; 2] = [Paint::Oak, Paint::Walnut];
const COLOURS: [Paint; 3] = [Paint::Red, Paint::Blue, Paint::Yellow];

/// A table with nothing on it, or a book, or a book and a ball. Its feet keep off the floor.
pub(super) fn table(rng: &mut Rng, frame: Frame) -> Vec<Part> {
    let (width, depth) = (rng.stepped(mm(900), mm(1200), mm(50)), rng.stepped(mm(600), mm(750), mm(50)));
    let height = rng.stepped(mm(700), mm(760), mm(10));
    let paint = WOODS[rng.below(2)];
    let under = height - mm(30);
    let mut parts = legs(frame, [width / 2 - mm(20), depth / 2 - mm(20)], mm(60), under, paint);
    parts.push(slab(frame, [0, 0], [width, depth], [under, height], paint));
    let items = rng.below(3);
    if items > 0 {
        let book = slab(frame, [-width / 4, 0], [mm(210), mm(150)], [height, height + mm(40)], COLOURS[rng.below(3)]);
        parts.push(book);
    }
    if items > 1 {
        let radius = rng.stepped(mm(80), mm(140), mm(10));
        parts.push(ball(frame, [width / 4, 0], height, radius, COLOURS[rng.below(3)]));
    }
    parts
}

/// A chair, its back at the side of greater y. Its feet keep off the floor.
pub(super) fn chair(rng: &mut Rng, frame: Frame) -> Vec<Part> {
    let (side, seat) = (rng.stepped(mm(400), mm(460), mm(10)), rng.stepped(mm(440), mm(480), mm(10)));
    let paint = [Paint::Oak, Paint::Fabric, Paint::Red, Paint::Blue][rng.below(4)];
    let under = seat - mm(40);
    let mut parts = legs(frame, [side / 2 - mm(10), side / 2 - mm(10)], mm(40), under, Paint::Metal);
    parts.push(slab(frame, [0, 0], [side, side], [under, seat], paint));
    let back = [seat, seat + rng.stepped(mm(380), mm(460), mm(20))];
    parts.push(slab(frame, [0, side / 2 - mm(30)], [side - mm(20), mm(40)], back, paint));
    parts
}

/// A shelf of boards with uprights between them, its lowest board flat on the floor.
pub(super) fn shelf(rng: &mut Rng, frame: Frame, width: i64) -> Vec<Part> {
    let (depth, board) = (rng.stepped(mm(280), mm(320), mm(10)), mm(20));
    let levels = rng.stepped(2, 5, 1);
    let gap = rng.stepped(mm(300), mm(380), mm(20));
    let paint = WOODS[rng.below(2)];
    let mut parts = Vec::new();
    for level in 0..=levels {
        let bottom = level * (gap + board);
        parts.push(slab(frame, [0, 0], [width, depth], [bottom, bottom + board], paint));
        if level < levels {
            let reach = [bottom + board, bottom + board + gap];
            for side in [-1, 1] {
                let x = side * (width / 2 - mm(25));
                parts.push(slab(frame, [x, 0], [mm(30), depth - mm(20)], reach, paint));
            }
        }
    }
    parts
}

/// A cabinet flat on the floor.
pub(super) fn cabinet(rng: &mut Rng, frame: Frame) -> Vec<Part> {
    let size = [rng.stepped(mm(500), mm(1000), mm(50)), rng.stepped(mm(400), mm(500), mm(20))];
    let height = rng.stepped(mm(600), mm(1600), mm(50));
    vec![slab(frame, [0, 0], size, [0, height], WOODS[rng.below(2)])]
}

/// Two or three crates flat on the floor and on one another, turned differently.
pub(super) fn crates(rng: &mut Rng, frame: Frame) -> Vec<Part> {
    let mut bottom = 0;
    let mut parts = Vec::new();
    for _ in 0..2 + rng.below(2) {
        let (side, height) = (rng.stepped(mm(350), mm(700), mm(50)), rng.stepped(mm(250), mm(450), mm(50)));
        let turned = frame.turned(rng.stepped(-400, 400, 1), 1024);
        parts.push(slab(turned, [0, 0], [side, side], [bottom, bottom + height], COLOURS[rng.below(3)]));
        bottom += height;
    }
    parts
}

/// A ball just off the floor.
pub(super) fn lone_ball(rng: &mut Rng, frame: Frame) -> Vec<Part> {
    let radius = rng.stepped(mm(200), mm(500), mm(10));
    vec![ball(frame, [0, 0], 0, radius, COLOURS[rng.below(3)])]
}

/// A box by the middle of its plan, its plan and its reach in height.
pub(super) fn slab(frame: Frame, middle: [i64; 2], size: [i64; 2], reach: [i64; 2], paint: Paint) -> Part {
    let low = [middle[0] - size[0] / 2, middle[1] - size[1] / 2];
    let [x, y] = [low[0] + size[0], low[1] + size[1]];
    Part::block(frame, [low[0], low[1], reach[0]], [x, y, reach[1]], paint)
}

/// Four legs within a rectangle of that half size, from just off the floor to `top`.
fn legs(frame: Frame, half: [i64; 2], side: i64, top: i64, paint: Paint) -> Vec<Part> {
    let middle = half.map(|length| length - side / 2);
    [[-1, -1], [1, -1], [1, 1], [-1, 1]]
        .map(|[x, y]| slab(frame, [x * middle[0], y * middle[1]], [side, side], [GLIDE, top], paint))
        .into()
}

fn ball(frame: Frame, middle: [i64; 2], floor: i64, radius: i64, paint: Paint) -> Part {
    let centre = frame.world([middle[0], middle[1], floor + BALL_GAP + radius]);
    Part { form: Form::Ball(Ball { centre, radius: metres(radius) }), paint }
}
