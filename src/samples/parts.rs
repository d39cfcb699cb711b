//! Furniture as boxes and balls whose tessellation is chosen last, to spend a number of polygons.

use super::free::{Ball, Block, Solid};
use super::mesh::{Look, Mesh};
use super::paint::Paint;
use super::sphere::{add_ball, triangle_count};
use super::surface::Surface;
use super::ticks::{Frame, cells, finest, lines};

/// A closed surface of a piece of furniture.
#[derive(Clone, Debug)]
pub(super) struct Part {
    pub(super) form: Form,
    pub(super) paint: Paint,
}

/// The form of a part.
#[derive(Clone, Debug)]
pub(super) enum Form {
    Block(Block),
    Ball(Ball),
}

impl Part {
    /// A box in a frame, by its least and greatest corner.
    pub(super) fn block(frame: Frame, low: [i64; 3], high: [i64; 3], paint: Paint) -> Self {
        Self { form: Form::Block(Block { frame, low, high }), paint }
    }

    /// The fewest polygons it takes.
    pub(super) fn least(&self) -> usize {
        self.form.cut(i64::MAX).count()
    }
}

impl Form {
    /// Cut into cells of edge `h`/64 ticks or a little more.
    fn cut(&self, h: i64) -> Cut {
        match *self {
            Self::Block(block) => Cut::Block(block, [0, 1, 2].map(|axis| cells(block.high[axis] - block.low[axis], h))),
            Self::Ball(ball) => {
                // A quarter of the circumference, in ticks; an octahedron is too coarse a ball.
                Cut::Ball(ball, cells((ball.radius * 15_708.0) as i64, h).max(2))
            }
        }
    }
}

/// A form and how finely it is cut.
#[derive(Clone, Copy, Debug)]
enum Cut {
    /// Cells along each axis.
    Block(Block, [usize; 3]),
    /// Parts of an octant's edge.
    Ball(Ball, usize),
}

impl Cut {
    fn count(self) -> usize {
        match self {
            Self::Block(_, [x, y, z]) => 2 * (x * y + y * z + z * x),
            Self::Ball(_, n) => triangle_count(n),
        }
    }

    /// One step finer: one more cell along the axis where cells are longest.
    fn refined(self) -> Self {
        match self {
            Self::Block(block, mut cells) => {
                let edge = |axis: usize| (block.high[axis] - block.low[axis]) / cells[axis] as i64;
                let longest = (0..3).max_by_key(|&axis| edge(axis)).unwrap_or(0);
                if edge(longest) > 1 {
                    cells[longest] += 1;
                }
                Self::Block(block, cells)
            }
            Self::Ball(ball, n) => Self::Ball(ball, n + 1),
        }
    }

    fn add_to(self, mesh: &mut Mesh, look: Look) {
        match self {
            Self::Block(block, cells) => {
                let lines = [0, 1, 2].map(|axis| lines(block.low[axis], block.high[axis], cells[axis]));
                Surface::new(mesh, block.frame).block(&lines, look);
                mesh.add_solid(Solid::Block(block));
            }
            Self::Ball(ball, n) => {
                add_ball(mesh, ball, n, look);
                mesh.add_solid(Solid::Ball(ball));
            }
        }
    }
}

/// A named object of one or more parts.
#[derive(Clone, Debug)]
pub(super) struct Piece {
    pub(super) name: String,
    pub(super) parts: Vec<Part>,
}

impl Piece {
    /// The fewest polygons it takes.
    pub(super) fn least(&self) -> usize {
        self.parts.iter().map(Part::least).sum()
    }
}

/// Adds the pieces with as many polygons as the budget allows, and at least the fewest they take.
pub(super) fn furnish(mesh: &mut Mesh, pieces: &[Piece], budget: usize) {
    let parts: Vec<&Part> = pieces.iter().flat_map(|piece| &piece.parts).collect();
    let mut cuts = plan(&parts, budget).into_iter();
    for piece in pieces {
        let object = mesh.add_object(piece.name.clone());
        for (part, cut) in piece.parts.iter().zip(&mut cuts) {
            let material = mesh.add_material(part.paint.material());
            cut.add_to(mesh, Look { object, material });
        }
    }
}

/// The same cell size for all, as small as the budget allows; what is left goes to the first parts
/// that can use it.
fn plan(parts: &[&Part], budget: usize) -> Vec<Cut> {
    let cut = |h| parts.iter().map(move |part| part.form.cut(h));
    let spent = |h| cut(h).map(Cut::count).sum::<usize>();
    let h = finest(|h| spent(h) <= budget);
    let mut cuts: Vec<Cut> = cut(h).collect();
    let mut left = budget.saturating_sub(spent(h));
    loop {
        let before = left;
        for cut in &mut cuts {
            let finer = cut.refined();
            let cost = finer.count() - cut.count();
            if cost <= left {
                left -= cost;
                *cut = finer;
            }
        }
        if left == before {
            return cuts;
        }
    }
}
