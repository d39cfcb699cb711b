//! Figures 3 and 4: the 2D BSP of a view of one triangle, and what another triangle behind it adds.

use glam::{DVec2, DVec3};
use nusselt::bsp::{BspOptions, SceneBsp};
use nusselt::contour::{
    Branch, BranchKind, ContourImage, Domain, Frustum, Projection, Projector, Splitter, ViewOptions, Viewpoint,
};
use nusselt::io::{SvgOptions, atomic_write, write_svg};
use nusselt::scene::{FaceSpec, Material, PolygonRef, Scene, SceneBuilder, SceneError};
use std::error::Error;
use std::fmt::{self, Write as _};
use std::io::Write;
use std::path::Path;

/// The length of a side of the picture, and of what is around it.
const SIZE: f64 = 420.0;
const PICTURE: f64 = SIZE + 2.0 * 20.0;
/// Between neighbouring leaves and levels of the tree.
const STEP: DVec2 = DVec2::new(64.0, 62.0);
const TOP: f64 = 50.0;

pub(crate) fn draw(folder: &Path) -> Result<(), Box<dyn Error>> {
    write(1, &folder.join("tree-one.svg"))?;
    write(2, &folder.join("tree-two.svg"))
}

/// The first so many of two triangles, by their places in the image plane and their distances.
fn scene(triangles: usize) -> Result<Scene, SceneError> {
    let [right, up, towards] = axes();
    let mut builder = SceneBuilder::default();
    let shapes = [
        ("near", [0.85, 0.45, 0.3], 1.0, [[-0.28, -0.2], [0.2, -0.12], [-0.05, 0.24]]),
        ("far", [0.3, 0.5, 0.8], 2.0, [[-0.02, -0.3], [0.33, 0.12], [-0.06, 0.05]]),
    ];
    for (name, diffuse, distance, corners) in shapes.into_iter().take(triangles) {
        let object = builder.add_object(name);
        let material = builder.add_material(Material { diffuse, ..Material::new(name) });
        let corner = |[x, y]: [f64; 2]| (right * x + up * y + towards) * distance;
        let ring = corners.into_iter().map(|at| builder.add_vertex(corner(at))).collect();
        builder.add_face(FaceSpec { rings: vec![ring], object, material });
    }
    builder.build()
}

/// To the right, up and ahead: into the middle of an octant, so that no side of an octant is in the picture.
fn axes() -> [DVec3; 3] {
    let towards = DVec3::ONE.normalize();
    let right = DVec3::new(1.0, -1.0, 0.0).normalize();
    [right, right.cross(towards), towards]
}

fn write(triangles: usize, path: &Path) -> Result<(), Box<dyn Error>> {
    let scene = scene(triangles)?;
    let [_, up, towards] = axes();
    let domain = Domain::Frustum(Frustum::new(towards, up, 42.0, 1.0)?);
    let bsp = SceneBsp::build(&scene, &BspOptions::default())?;
    // The scene is too small for a quadtree.
    let options = ViewOptions { quadtree_depth: Some(0), ..ViewOptions::default() };
    let image = bsp.view_with(&Viewpoint::free(DVec3::ZERO), &domain, &options)?;
    let projector = Projector::of_image(&image, Projection::Gnomonic)?;
    let mut picture = Vec::new();
    write_svg(&image, &projector, &SvgOptions { size: SIZE, show_tree: false }, &mut picture)?;
    let picture = String::from_utf8(picture)?;
    let (_, picture) = picture.split_once("?>").ok_or("no picture")?;

    let mut diagram = Diagram::new(&projector);
    diagram.add(image.tree())?;
    let size = DVec2::new(PICTURE + diagram.leaves * STEP.x + 20.0, PICTURE.max(TOP + diagram.depth * STEP.y + 40.0));
    let splitters = splitters(&image, &projector)?;
    let Diagram { letters, links, marks, .. } = diagram;
    atomic_write(path, |out| {
        writeln!(out, r#"<?xml version="1.0" encoding="UTF-8"?>"#)?;
        let DVec2 { x, y } = size;
        writeln!(
            out,
            r#"<svg xmlns="http://www.w3.org/2000/svg" width="{x}" height="{y}" viewBox="0 0 {x} {y}" font-family="sans-serif" font-size="15" text-anchor="middle">"#
        )?;
        writeln!(out, r#"<rect width="{x}" height="{y}" fill="white"/>{picture}{splitters}"#)?;
        writeln!(out, r##"<g stroke="#444" fill="none">{links}</g>{marks}{letters}</svg>"##)
    })?;
    Ok(())
}

/// Where a direction is drawn.
fn place(projector: &Projector, direction: DVec3) -> DVec2 {
    let window = projector.window();
    let at = (projector.point(direction) - window.low) / window.size();
    DVec2::new(20.0 + at.x * SIZE, 20.0 + (1.0 - at.y) * SIZE)
}

/// The stretches of edges by which cells were cut apart, dashed.
fn splitters(image: &ContourImage, projector: &Projector) -> Result<String, fmt::Error> {
    let mut lines = String::new();
    for arc in image.tree_arcs() {
        if matches!(arc.splitter, Splitter::Edge(_)) {
            let [p, q] = arc.ends.map(|end| place(projector, end));
            write!(
                lines,
                r##"<path d="M{:.1},{:.1} {:.1},{:.1}" stroke="#222" stroke-dasharray="5 4"/>"##,
                p.x, p.y, q.x, q.y
            )?;
        }
    }
    Ok(lines)
}

/// The tree as nodes and links, below each other, and letters at what they stand for in the picture.
struct Diagram<'a> {
    projector: &'a Projector,
    leaves: f64,
    depth: f64,
    /// The edges so far; their number is their letter.
    edges: Vec<Splitter>,
    letters: String,
    links: String,
    marks: String,
}

impl<'a> Diagram<'a> {
    fn new(projector: &'a Projector) -> Self {
        let [letters, links, marks] = Default::default();
        Self { projector, leaves: 0.0, depth: 0.0, edges: Vec::new(), letters, links, marks }
    }

    fn add(&mut self, root: Branch<'_>) -> Result<(), Box<dyn Error>> {
        self.branch(root, 0.0)?;
        Ok(())
    }

    /// Adds a part of the tree at a level; gives its place across, or none if nothing of it is in the domain.
    fn branch(&mut self, branch: Branch<'_>, level: f64) -> Result<Option<f64>, Box<dyn Error>> {
        let y = TOP + level * STEP.y;
        self.depth = self.depth.max(level);
        match branch.kind() {
            BranchKind::Outside => Ok(None),
            BranchKind::Cell(cell) => {
                let x = PICTURE + (self.leaves + 0.5) * STEP.x;
                self.leaves += 1.0;
                let (name, colour) = match cell.polygon() {
                    Some(polygon) => ("in", ["#e8a08a", "#8fb0e0"][polygon.index()]),
                    None => ("out", "#cfe4f7"),
                };
                let number = cell.id().0;
                write!(
                    self.marks,
                    r##"<rect x="{}" y="{}" width="52" height="26" rx="5" fill="{colour}" stroke="#444"/><text x="{x}" y="{}">{name} {number}</text>"##,
                    x - 26.0,
                    y - 13.0,
                    y + 5.0
                )?;
                let middle: DVec3 = cell.boundary().sum();
                let at = place(self.projector, middle);
                write!(self.letters, r##"<text x="{:.1}" y="{:.1}" fill="#333">{number}</text>"##, at.x, at.y + 5.0)?;
                Ok(Some(x))
            }
            // Octants and the sides of the picture, which the tree begins with.
            BranchKind::Node { splitter: Splitter::Given(_), negative, positive, .. } => {
                let sides = [self.branch(negative, level)?, self.branch(positive, level)?];
                Ok(sides.into_iter().flatten().next())
            }
            BranchKind::Node { splitter, negative, positive, .. } => {
                let known = self.edges.iter().position(|&edge| edge == splitter);
                let number = known.unwrap_or_else(|| {
                    self.edges.push(splitter);
                    self.edges.len() - 1
                });
                let letter = char::from(b'a' + number as u8);
                let sides = [self.branch(negative, level + 1.0)?, self.branch(positive, level + 1.0)?];
                let [Some(low), Some(high)] = sides else { return Ok(sides.into_iter().flatten().next()) };
                let x = f64::midpoint(low, high);
                for (side, sign) in [(low, "\u{2212}"), (high, "+")] {
                    let below = y + STEP.y;
                    write!(self.links, r#"<path d="M{x},{y} {side},{below}"/>"#)?;
                    let [across, down] = [x.midpoint(side), y.midpoint(below)];
                    let aside = if side < x { -9.0 } else { 9.0 };
                    write!(
                        self.marks,
                        r##"<text x="{}" y="{down}" font-size="13" fill="#777">{sign}</text>"##,
                        across + aside
                    )?;
                }
                write!(
                    self.marks,
                    r##"<circle cx="{x}" cy="{y}" r="14" fill="white" stroke="#444"/><text x="{x}" y="{}" font-style="italic">{letter}</text>"##,
                    y + 5.0
                )?;
                if known.is_none() {
                    self.label(splitter, letter, branch)?;
                }
                Ok(Some(x))
            }
        }
    }

    /// Writes the letter of an edge beside the stretch of it that is nearest to its middle.
    fn label(&mut self, splitter: Splitter, letter: char, branch: Branch<'_>) -> fmt::Result {
        let (Splitter::Edge(ends), BranchKind::Node { normal, .. }) = (splitter, branch.kind()) else { return Ok(()) };
        let scene = branch.image().scene();
        let [a, b] = ends.map(|vertex| scene.vertex(vertex).normalize());
        let arcs = branch.image().tree_arcs().into_iter().filter(|arc| arc.splitter == splitter);
        let middles = arcs.map(|arc| arc.ends[0] + arc.ends[1]);
        let Some(on) = middles.min_by(|p, q| p.distance(a + b).total_cmp(&q.distance(a + b))) else { return Ok(()) };
        // Away from its polygon.
        let own = scene.polygons().flat_map(PolygonRef::rings).find(|ring| ends.iter().all(|v| ring.contains(v)));
        let middle: DVec3 = own.into_iter().flatten().map(|&vertex| scene.vertex(vertex)).sum();
        let beside = place(self.projector, on - normal * 0.1_f64.copysign(middle.dot(normal)));
        let on = place(self.projector, on);
        let at = on + (beside - on).normalize() * 13.0;
        write!(
            self.letters,
            r##"<text x="{:.1}" y="{:.1}" font-style="italic" font-weight="bold" fill="#111">{letter}</text>"##,
            at.x,
            at.y + 5.0
        )
    }
}
