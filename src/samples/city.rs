//! A city under a box of sky: ground, buildings and sky are one closed surface.

use super::free::{Block, FreeSpace, Solid};
use super::mesh::{Look, Mesh};
use super::paint::Paint;
use super::rng::Rng;
use super::surface::{Sheet, Surface};
use super::ticks::{Frame, cells, finest, lines, metres, mm};
use crate::scene::Axis;

/// How far the sky is above the highest roof.
const HEADROOM: i64 = mm(20_000);
const STOREY: i64 = mm(3200);
/// Cells of the sky's ceiling are this many times as long as those of the ground.
const SKY_CELLS: i64 = 4;

const FACADES: [Paint; 3] = [Paint::Brick, Paint::Plaster, Paint::Concrete];

/// The number of buildings grows as the number of polygons to the power 3/4; the rest goes into
/// their tessellation and the ground's.
pub(super) fn city(polygons: usize, seed: u64) -> Mesh {
    let mut rng = Rng::new(seed);
    let root = polygons.isqrt();
    let blocks = (root * root.isqrt() / 10).isqrt().max(1);
    let plan = Plan::draw(&mut rng, blocks);
    let grid = Grid::within(&plan, polygons);
    let mut mesh = Mesh::empty(FreeSpace {
        low: [0.0; 3],
        high: [plan.size(0), plan.size(1), plan.sky].map(metres),
        up: Axis::Z,
        margin: 0.05,
        solids: Vec::new(),
    });
    grid.add_to(&mut mesh, &plan);
    mesh
}

#[derive(Clone, Copy, Debug)]
enum Roof {
    Flat,
    /// Four slopes up to a point.
    Pyramid,
    /// Two slopes up to a ridge along x.
    Gable,
}

#[derive(Clone, Debug)]
struct Building {
    /// Its wall's height.
    height: i64,
    /// The height of its roof's top.
    top: i64,
    roof: Roof,
    paint: Paint,
}

/// Streets and lots alternate along x and along y, streets first and last; every lot has a building.
#[derive(Clone, Debug)]
struct Plan {
    /// Where strips begin and the last one ends, along x and y; strip 2k + 1 is a row of lots.
    strips: [Vec<i64>; 2],
    /// The building at lot (i, j), row by row.
    buildings: Vec<Building>,
    /// The height of the sky.
    sky: i64,
}

impl Plan {
    fn draw(rng: &mut Rng, blocks: usize) -> Self {
        let mut draw_strips = || {
            let mut strips = vec![0];
            let mut end = 0;
            for strip in 0..=2 * blocks {
                let (low, high) = if strip % 2 == 0 { (mm(8000), mm(14_000)) } else { (mm(10_000), mm(22_000)) };
                end += rng.stepped(low, high, mm(500));
                strips.push(end);
            }
            strips
        };
        let strips = [draw_strips(), draw_strips()];
        let buildings: Vec<Building> = (0..blocks * blocks).map(|_| Building::draw(rng)).collect();
        let highest = buildings.iter().map(|building| building.top).max().unwrap_or(0);
        Self { strips, buildings, sky: highest + HEADROOM }
    }

    /// The city's length along an axis.
    fn size(&self, axis: usize) -> i64 {
        self.strips[axis].last().copied().unwrap_or(0)
    }

    fn blocks(&self) -> usize {
        self.strips[0].len() / 2 - 1
    }
}

impl Building {
    fn draw(rng: &mut Rng) -> Self {
        let storeys = if rng.chance(1, 6) { rng.stepped(8, 20, 1) } else { rng.stepped(1, 6, 1) };
        let height = STOREY * storeys + rng.stepped(0, mm(800), mm(100));
        let roof = if storeys > 6 { Roof::Flat } else { [Roof::Flat, Roof::Pyramid, Roof::Gable][rng.below(3)] };
        let rise = if matches!(roof, Roof::Flat) { 0 } else { rng.stepped(mm(2000), mm(5000), mm(250)) };
        Self { height, top: height + rise, roof, paint: FACADES[rng.below(3)] }
    }

    /// The number of polygons over `x` by `y` ground cells, with `rows` rows of wall.
    fn polygon_count(&self, [x, y]: [usize; 2], rows: usize) -> usize {
        let roof = match self.roof {
            Roof::Flat => x * y,
            Roof::Pyramid | Roof::Gable => 2 * (x + y),
        };
        2 * (x + y) * rows + roof
    }
}

/// The tessellation of a plan.
#[derive(Clone, Debug)]
struct Grid {
    /// Cells of every strip along x and y.
    strips: [Vec<usize>; 2],
    /// Rows of every building's wall.
    rows: Vec<usize>,
    /// Cells of the sky's ceiling along x and y.
    sky: [usize; 2],
}

impl Grid {
    /// The finest that takes at most so many polygons.
    fn within(plan: &Plan, budget: usize) -> Self {
        let mut grid = Self::with_cells(plan, finest(|h| Self::with_cells(plan, h).polygon_count(plan) <= budget));
        let mut left = budget.saturating_sub(grid.polygon_count(plan));
        loop {
            let before = left;
            for lot in 0..plan.buildings.len() {
                let [x, y] = grid.lot(plan, lot);
                if 2 * (x + y) <= left {
                    left -= 2 * (x + y);
                    grid.rows[lot] += 1;
                }
            }
            if left == before {
                return grid;
            }
        }
    }

    /// Cells of edge `h`/64 ticks or a little more.
    fn with_cells(plan: &Plan, h: i64) -> Self {
        let strips = [0, 1].map(|axis| plan.strips[axis].windows(2).map(|ends| cells(ends[1] - ends[0], h)).collect());
        let rows = plan.buildings.iter().map(|building| cells(building.height, h)).collect();
        let sky = [0, 1].map(|axis| cells(plan.size(axis) / SKY_CELLS, h));
        Self { strips, rows, sky }
    }

    /// The ground cells of a lot along x and y.
    fn lot(&self, plan: &Plan, lot: usize) -> [usize; 2] {
        let blocks = plan.blocks();
        [self.strips[0][2 * (lot % blocks) + 1], self.strips[1][2 * (lot / blocks) + 1]]
    }

    fn polygon_count(&self, plan: &Plan) -> usize {
        let [x, y] = [0, 1].map(|axis| self.strips[axis].iter().sum::<usize>());
        let [lots_x, lots_y] = [0, 1].map(|axis| self.strips[axis].iter().skip(1).step_by(2).sum::<usize>());
        let ground = x * y - lots_x * lots_y;
        let sky = 2 * (x + y + self.sky[0] + self.sky[1]) + self.sky[0] * self.sky[1];
        let buildings = plan.buildings.iter().enumerate();
        let buildings = buildings.map(|(k, building)| building.polygon_count(self.lot(plan, k), self.rows[k]));
        ground + sky + buildings.sum::<usize>()
    }

    /// Adds the city, fronts towards the air: objects `ground`, `building_1` ... and `sky`.
    fn add_to(&self, mesh: &mut Mesh, plan: &Plan) {
        let strips: [Vec<Vec<i64>>; 2] = [0, 1].map(|axis| {
            let ends = plan.strips[axis].windows(2).zip(&self.strips[axis]);
            ends.map(|(ends, &cells)| lines(ends[0], ends[1], cells)).collect()
        });
        let ground = Look {
            object: mesh.add_object("ground".to_owned()),
            material: mesh.add_material(Paint::Asphalt.material()),
        };
        let mut surface = Surface::new(mesh, Frame::WORLD);
        for (j, vs) in strips[1].iter().enumerate() {
            for (i, us) in strips[0].iter().enumerate() {
                if i % 2 == 0 || j % 2 == 0 {
                    surface.sheet(Sheet { axis: 2, at: 0, us, vs, faces_up: true }, ground);
                }
            }
        }
        let blocks = plan.blocks();
        for (lot, building) in plan.buildings.iter().enumerate() {
            let [us, vs] = [&strips[0][2 * (lot % blocks) + 1], &strips[1][2 * (lot / blocks) + 1]];
            let object = surface.mesh().add_object(format!("building_{}", lot + 1));
            add_building(&mut surface, building, [us, vs], &lines(0, building.height, self.rows[lot]), object);
        }
        let borders = strips.map(|strips| {
            let first = strips[0][0];
            std::iter::once(first).chain(strips.iter().flat_map(|lines| lines.iter().skip(1).copied())).collect()
        });
        self.add_sky(&mut surface, plan, &borders);
    }

    fn add_sky(&self, surface: &mut Surface<'_>, plan: &Plan, borders: &[Vec<i64>; 2]) {
        let mesh = surface.mesh();
        let look =
            Look { object: mesh.add_object("sky".to_owned()), material: mesh.add_material(Paint::Sky.material()) };
        let [us, vs] = [0, 1].map(|axis| lines(0, plan.size(axis), self.sky[axis]));
        for (x, reversed) in [(0, false), (plan.size(0), true)] {
            let at = |z: i64| move |&y: &i64| [x, y, z];
            let (low, high) = (borders[1].iter().map(at(0)), vs.iter().map(at(plan.sky)));
            add_band(surface, &low.collect::<Vec<_>>(), &high.collect::<Vec<_>>(), reversed, look);
        }
        for (y, reversed) in [(0, true), (plan.size(1), false)] {
            let at = |z: i64| move |&x: &i64| [x, y, z];
            let (low, high) = (borders[0].iter().map(at(0)), us.iter().map(at(plan.sky)));
            add_band(surface, &low.collect::<Vec<_>>(), &high.collect::<Vec<_>>(), reversed, look);
        }
        surface.sheet(Sheet { axis: 2, at: plan.sky, us: &us, vs: &vs, faces_up: false }, look);
    }
}

/// Walls from the ground's vertices up, and a roof on them.
fn add_building(surface: &mut Surface<'_>, building: &Building, [us, vs]: [&[i64]; 2], zs: &[i64], object: u32) {
    let mesh = surface.mesh();
    let walls = Look { object, material: mesh.add_material(building.paint.material()) };
    let tiles = Look { object, material: mesh.add_material(Paint::Tiles.material()) };
    let [[x0, x1], [y0, y1]] = [us, vs].map(|lines| [lines[0], lines[lines.len() - 1]]);
    mesh.add_solid(Solid::Block(Block { frame: Frame::WORLD, low: [x0, y0, 0], high: [x1, y1, building.top] }));
    for (at, faces_up) in [(x0, false), (x1, true)] {
        surface.sheet(Sheet { axis: 0, at, us: vs, vs: zs, faces_up }, walls);
    }
    for (at, faces_up) in [(y0, false), (y1, true)] {
        surface.sheet(Sheet { axis: 1, at, us: zs, vs: us, faces_up }, walls);
    }
    let (z, top) = (building.height, building.top);
    let (middle_x, middle_y) = (i64::midpoint(x0, x1), i64::midpoint(y0, y1));
    match building.roof {
        Roof::Flat => surface.sheet(Sheet { axis: 2, at: z, us, vs, faces_up: true }, tiles),
        Roof::Pyramid => {
            let peak = [middle_x, middle_y, top];
            for eave in eaves(us, vs, z) {
                add_fan(surface, &eave, peak, tiles);
            }
        }
        Roof::Gable => {
            let [south, east, north, west] = eaves(us, vs, z);
            for eave in [south, north] {
                for pair in eave.windows(2) {
                    let ridge = |x: i64| [x, middle_y, top];
                    surface.quad([pair[0], pair[1], ridge(pair[1][0]), ridge(pair[0][0])], tiles);
                }
            }
            add_fan(surface, &east, [x1, middle_y, top], walls);
            add_fan(surface, &west, [x0, middle_y, top], walls);
        }
    }
}

/// The four upper edges of a wall, counter-clockwise from above: south, east, north, west.
fn eaves(us: &[i64], vs: &[i64], z: i64) -> [Vec<[i64; 3]>; 4] {
    let [[x0, x1], [y0, y1]] = [us, vs].map(|lines| [lines[0], lines[lines.len() - 1]]);
    [
        us.iter().map(|&x| [x, y0, z]).collect(),
        vs.iter().map(|&y| [x1, y, z]).collect(),
        us.iter().rev().map(|&x| [x, y1, z]).collect(),
        vs.iter().rev().map(|&y| [x0, y, z]).collect(),
    ]
}

/// Triangles from the pieces of an edge to a point above.
fn add_fan(surface: &mut Surface<'_>, edge: &[[i64; 3]], peak: [i64; 3], look: Look) {
    for pair in edge.windows(2) {
        surface.triangle([pair[0], pair[1], peak], look);
    }
}

/// Triangles between two parallel edges with different vertices. Seen from their fronts the edges
/// run to the right, or to the left if `reversed`.
fn add_band(surface: &mut Surface<'_>, low: &[[i64; 3]], high: &[[i64; 3]], reversed: bool, look: Look) {
    let (n, m) = (low.len() - 1, high.len() - 1);
    let (mut i, mut j) = (0, 0);
    while i + j < n + m {
        let along_low = j == m || (i < n && (i + 1) * m <= (j + 1) * n);
        let mut corners = if along_low { [low[i], low[i + 1], high[j]] } else { [low[i], high[j + 1], high[j]] };
        if reversed {
            corners.reverse();
        }
        surface.triangle(corners, look);
        if along_low {
            i += 1;
        } else {
            j += 1;
        }
    }
}
