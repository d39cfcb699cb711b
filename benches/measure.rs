//! The tables of docs/performance.md: `cargo bench --bench measure`, or for one scene
//! `cargo bench --bench measure -- room 50000 [quadtree depth]`; `floor` for a depth looks from points on
//! the floor instead of points in the air. Every scene has two rows: seen by its 3D BSP, and by a hierarchy of boxes;
//! `bsp` or `boxes` for a depth leaves the other one out. `cargo bench --bench measure -- regions` is the table of visible regions,
//! `cargo bench --bench measure -- moved` that of objects that move.

use glam::{DAffine3, DVec3};
use nusselt::bsp::{BspOptions, SceneBsp};
use nusselt::bvh::SceneBvh;
use nusselt::contour::{
    ContourImage, Domain, Projection, Projector, ViewError, ViewOptions, ViewSpace, Viewpoint, VisibleRegion,
};
use nusselt::samples::{Kind, generate};
use nusselt::scene::ObjectId;
use std::error::Error;
use std::time::Instant;

/// Views a row; the same points for every machine.
const VIEWS: usize = 100;

fn main() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = std::env::args().skip(1).filter(|word| word != "--bench").collect();
    if words == ["regions"] {
        return regions();
    }
    if words == ["moved"] {
        return moved();
    }
    println!(
        "| scene | polygons | way | build s | view ms | worst | factors ms | cells | visible | inserted | skipped | nodes | filter undecided | integers | worst sum |"
    );
    println!(
        "| --- | ---: | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |"
    );
    if let [kind, polygons, rest @ ..] = words.as_slice() {
        let (kind, polygons) = (kind.parse()?, polygons.parse()?);
        return match rest.first().map(String::as_str) {
            None => row(kind, polygons, None, false, Way::BOTH),
            Some("floor") => row(kind, polygons, None, true, Way::BOTH),
            Some("bsp") => row(kind, polygons, None, false, &[Way::Bsp]),
            Some("boxes") => row(kind, polygons, None, false, &[Way::Boxes]),
            Some(depth) => row(kind, polygons, Some(depth.parse()?), false, Way::BOTH),
        };
    }
    for kind in Kind::ALL {
        for polygons in [1_000, 10_000, 50_000] {
            row(kind, polygons, None, false, Way::BOTH)?;
        }
    }
    Ok(())
}

enum Way {
    Bsp,
    Boxes,
}

impl Way {
    const BOTH: &[Self] = &[Self::Bsp, Self::Boxes];
}

fn row(kind: Kind, polygons: usize, depth: Option<u32>, floor: bool, ways: &[Way]) -> Result<(), Box<dyn Error>> {
    let mesh = generate(kind, polygons, 1)?;
    let scene = mesh.to_builder().build()?;
    let options = ViewOptions { quadtree_depth: depth, ..ViewOptions::default() };
    let points = if floor { mesh.floor_points(VIEWS, 3) } else { mesh.free_points(VIEWS, 3) };
    let domain = Domain::Hemisphere(DVec3::Z);
    for way in ways {
        let start = Instant::now();
        match way {
            Way::Bsp => {
                let bsp = SceneBsp::build(&scene, &BspOptions::default())?;
                print!("| {kind} | {polygons} | BSP | {:.3} ", start.elapsed().as_secs_f64());
                views(&points, |eye, space| bsp.view_in(space, eye, &domain, &options))?;
            }
            Way::Boxes => {
                let boxes = SceneBvh::build(&scene);
                print!("| {kind} | {polygons} | boxes | {:.3} ", start.elapsed().as_secs_f64());
                views(&points, |eye, space| boxes.view_in(space, eye, &domain, &options))?;
            }
        }
    }
    Ok(())
}

/// The rest of a row, for one way; each view in the memory of the one before.
fn views(
    points: &[[f64; 3]],
    see: impl for<'s> Fn(&Viewpoint, &'s mut ViewSpace) -> Result<&'s ContourImage, ViewError>,
) -> Result<(), Box<dyn Error>> {
    let (mut view, mut longest, mut factors, mut worst) = (0.0, 0.0f64, 0.0, 0.0f64);
    let mut counts = [0; 7];
    let mut space = ViewSpace::new();
    for point in points {
        let start = Instant::now();
        let image = see(&Viewpoint::free(DVec3::from(*point)), &mut space)?;
        let time = start.elapsed().as_secs_f64();
        let sums = image.form_factors().ok_or("a hemisphere has a normal")?;
        factors += start.elapsed().as_secs_f64() - time;
        view += time;
        longest = longest.max(time);
        worst = worst.max((sums.total() - 1.0).abs()).max(sums.background);
        let stats = image.stats();
        let row = [
            image.cell_count(),
            sums.polygons.len(),
            stats.inserted,
            stats.skipped_subtrees,
            stats.visited_nodes as usize,
            stats.predicates.undecided() as usize,
            (stats.predicates.fixed + stats.predicates.arbitrary) as usize,
        ];
        counts.iter_mut().zip(row).for_each(|(sum, n)| *sum += n);
    }
    let milli = |seconds: f64| seconds * 1e3 / VIEWS as f64;
    let means = counts.map(|sum| (sum / VIEWS).to_string()).join(" | ");
    println!("| {:.2} | {:.2} | {:.2} | {means} | {worst:.0e} |", milli(view), longest * 1e3, milli(factors));
    Ok(())
}

/// What it takes to merge cells to regions, and to draw those in Nusselt's projection.
fn regions() -> Result<(), Box<dyn Error>> {
    println!("| scene | polygons | cells | view ms | merge ms | regions | loops | sides | picture ms | points |");
    println!("| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |");
    for kind in Kind::ALL {
        for polygons in [1_000, 10_000, 50_000] {
            let mesh = generate(kind, polygons, 1)?;
            let bsp = SceneBsp::build(&mesh.to_builder().build()?, &BspOptions::default())?;
            let mut times = [0.0; 3];
            let mut counts = [0; 5];
            let views = VIEWS / 5;
            for point in mesh.free_points(views, 3) {
                let start = Instant::now();
                let image = bsp.view(&Viewpoint::free(DVec3::from(point)), &Domain::Hemisphere(DVec3::Z))?;
                let viewed = Instant::now();
                let regions = image.regions();
                let merged = Instant::now();
                let picture = Projector::of_image(&image, Projection::Nusselt)?.regions(&image, Projector::TOLERANCE);
                let drawn = Instant::now();
                for (sum, time) in times.iter_mut().zip([viewed - start, merged - viewed, drawn - merged]) {
                    *sum += time.as_secs_f64() * 1e3 / views as f64;
                }
                let loops = regions.iter().flat_map(VisibleRegion::loops);
                let rings = picture.iter().flat_map(|region| region.holes.iter().chain([&region.exterior]));
                let row = [
                    image.cell_count(),
                    regions.len(),
                    loops.clone().count(),
                    loops.map(|boundary| boundary.sides().len()).sum(),
                    rings.map(Vec::len).sum(),
                ];
                counts.iter_mut().zip(row).for_each(|(sum, n)| *sum += n);
            }
            let [view, merge, draw] = times;
            let [cells, regions, loops, sides, points] = counts.map(|sum| sum / views);
            println!(
                "| {kind} | {polygons} | {cells} | {view:.2} | {merge:.2} | {regions} | {loops} | {sides} | {draw:.2} | {points} |"
            );
        }
    }
    Ok(())
}

/// What it takes to move objects, against building anew, and what views of either take.
fn moved() -> Result<(), Box<dyn Error>> {
    println!(
        "| scene | moves | polygons | scene ms | its boxes ms | with_moved ms | moved ms | tightened ms | anew / moved | looseness | view ms | view anew ms |"
    );
    println!("| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |");
    for kind in Kind::ALL {
        let mesh = generate(kind, 50_000, 1)?;
        let scene = mesh.to_builder().build()?;
        let built = SceneBvh::build(&scene);
        let (low, high) = scene.bounds().ok_or("the scene has polygons")?;
        // The first object is the shell.
        let objects: Vec<ObjectId> = (1..scene.objects().len() as u32).map(ObjectId).collect();
        let step = DAffine3::from_translation(DVec3::new(0.25, 0.125, 0.0));
        // Mirrored in the middle, but for the sides: objects change places and stay inside.
        let turned = DAffine3::from_translation((low + high) * DVec3::new(1.0, 1.0, 0.0))
            * DAffine3::from_scale(DVec3::new(-1.0, -1.0, 1.0));
        let some = |every: usize, transform: DAffine3| -> Vec<_> {
            objects.iter().step_by(every).map(|&object| (object, transform)).collect()
        };
        for (name, moves) in [
            ("one by 0.3 m", some(objects.len(), step)),
            ("one across", some(objects.len(), turned)),
            ("a tenth across", some(10, turned)),
            ("half across", some(2, turned)),
            ("half by 0.3 m", some(2, step)),
        ] {
            let moving: Vec<ObjectId> = moves.iter().map(|(object, _)| *object).collect();
            let polygons = scene.polygons().filter(|polygon| moving.contains(&polygon.object())).count();
            let builder = mesh.to_builder();
            let mut times = [f64::INFINITY; 5];
            let mut note = |k: usize, start: Instant| times[k] = times[k].min(start.elapsed().as_secs_f64() * 1e3);
            let (mut after, mut anew) = (built.clone(), built.clone());
            for _ in 0..5 {
                let builder = builder.clone();
                let start = Instant::now();
                let _ = builder.build()?;
                note(0, start);
                let start = Instant::now();
                let _ = scene.with_moved(&moves)?;
                note(2, start);
                let start = Instant::now();
                after = built.moved(&moves)?;
                note(3, start);
                let start = Instant::now();
                anew = SceneBvh::build(after.scene());
                note(1, start);
                let loose = after.clone();
                let start = Instant::now();
                let _ = loose.tightened();
                note(4, start);
            }
            let [build, boxes, with_moved, moved, tightened] = times;
            let mut views = [0.0; 2];
            for point in mesh.free_points(VIEWS, 3) {
                for (sum, bvh) in views.iter_mut().zip([&after, &anew]) {
                    let start = Instant::now();
                    bvh.view(&Viewpoint::free(DVec3::from(point)), &Domain::Hemisphere(DVec3::Z))?;
                    *sum += start.elapsed().as_secs_f64() * 1e3 / VIEWS as f64;
                }
            }
            println!(
                "| {kind} | {name} | {polygons} | {build:.1} | {boxes:.1} | {with_moved:.1} | {moved:.1} | {tightened:.1} | {:.1} | {:.2} | {:.2} | {:.2} |",
                (build + boxes) / moved,
                after.looseness(),
                views[0],
                views[1]
            );
        }
    }
    Ok(())
}
