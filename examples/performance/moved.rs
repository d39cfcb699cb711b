//! What it takes to move objects, against building anew, and what views of either take.

use crate::range;
use glam::{DAffine3, DVec3};
use nusselt::bvh::SceneBvh;
use nusselt::contour::{Domain, ViewOptions, ViewSpace, Viewpoint};
use nusselt::samples::{Kind, Mesh, generate};
use nusselt::scene::{ObjectId, Scene};
use std::error::Error;
use std::fmt::Write;
use std::path::Path;
use std::time::Instant;

/// Views a row.
const VIEWS: usize = 100;
/// The shortest of so many times counts.
const ROUNDS: usize = 5;

pub(crate) fn part(_: &Path) -> Result<String, Box<dyn Error>> {
    let mut text = String::from(
        "| scene | moves | polygons | scene ms | its boxes ms | with_moved ms | moved ms | tightened ms | anew / moved | looseness | view ms | view anew ms |\n\
         | --- | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n",
    );
    let (mut one, mut half, mut views) = (Vec::new(), Vec::new(), Vec::new());
    for kind in Kind::ALL {
        let mesh = generate(kind, 50_000, 1)?;
        let scene = mesh.to_builder().build()?;
        let built = SceneBvh::build(&scene);
        for (name, moves) in moves(&scene)? {
            eprintln!("objects of a {kind}: {name}");
            let moving: Vec<ObjectId> = moves.iter().map(|(object, _)| *object).collect();
            let polygons = scene.polygons().filter(|polygon| moving.contains(&polygon.object())).count();
            let Times { build, boxes, with_moved, moved, tightened, after, anew } = measure(&mesh, &built, &moves)?;
            let [view, view_anew] = [view_ms(&after, &mesh)?, view_ms(&anew, &mesh)?];
            let gain = (build + boxes) / moved;
            if name.starts_with("one") {
                one.push(gain);
            } else if name.starts_with("half") {
                half.push(gain);
            }
            views.push(view / view_anew);
            writeln!(
                text,
                "| {kind} | {name} | {polygons} | {build:.1} | {boxes:.1} | {with_moved:.1} | {moved:.1} | {tightened:.1} | {gain:.1} | {:.2} | {view:.2} | {view_anew:.2} |",
                after.looseness(),
            )?;
        }
    }
    writeln!(
        text,
        "\nBuilding anew takes {} times as long as moving one object, and {} times as long as moving half of them. Views take {} times as long as with \
         boxes built anew.",
        range(one),
        range(half),
        range(views)
    )?;
    Ok(text)
}

type Moves = Vec<(ObjectId, DAffine3)>;

/// What is moved, with its name. The first object is the shell, which stays.
fn moves(scene: &Scene) -> Result<[(&'static str, Moves); 5], Box<dyn Error>> {
    let (low, high) = scene.bounds().ok_or("the scene has polygons")?;
    let objects: Vec<ObjectId> = (1..scene.objects().len() as u32).map(ObjectId).collect();
    let step = DAffine3::from_translation(DVec3::new(0.25, 0.125, 0.0));
    // Mirrored in the middle, but for the sides: objects change places and stay inside.
    let turned = DAffine3::from_translation((low + high) * DVec3::new(1.0, 1.0, 0.0))
        * DAffine3::from_scale(DVec3::new(-1.0, -1.0, 1.0));
    let some = |every: usize, transform: DAffine3| -> Moves {
        objects.iter().step_by(every).map(|&object| (object, transform)).collect()
    };
    Ok([
        ("one by 0.3 m", some(objects.len(), step)),
        ("one across", some(objects.len(), turned)),
        ("a tenth across", some(10, turned)),
        ("half across", some(2, turned)),
        ("half by 0.3 m", some(2, step)),
    ])
}

/// Milliseconds, and the boxes after the move and built anew.
struct Times {
    build: f64,
    boxes: f64,
    with_moved: f64,
    moved: f64,
    tightened: f64,
    after: SceneBvh,
    anew: SceneBvh,
}

fn measure(mesh: &Mesh, built: &SceneBvh, moves: &[(ObjectId, DAffine3)]) -> Result<Times, Box<dyn Error>> {
    let builder = mesh.to_builder();
    let mut times = [f64::INFINITY; 5];
    let mut note = |k: usize, start: Instant| times[k] = times[k].min(start.elapsed().as_secs_f64() * 1e3);
    let (mut after, mut anew) = (built.clone(), built.clone());
    for _ in 0..ROUNDS {
        let builder = builder.clone();
        let start = Instant::now();
        let _ = builder.build()?;
        note(0, start);
        let start = Instant::now();
        let _ = built.scene().with_moved(moves)?;
        note(2, start);
        let start = Instant::now();
        after = built.moved(moves)?;
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
    Ok(Times { build, boxes, with_moved, moved, tightened, after, anew })
}

/// The mean of a view, each in the memory of the one before.
fn view_ms(bvh: &SceneBvh, mesh: &Mesh) -> Result<f64, Box<dyn Error>> {
    let mut space = ViewSpace::new();
    let mut mean = 0.0;
    for point in mesh.free_points(VIEWS, 3) {
        let eye = Viewpoint::free(DVec3::from(point));
        let start = Instant::now();
        bvh.view_in(&mut space, &eye, &Domain::Hemisphere(DVec3::Z), &ViewOptions::default())?;
        mean += start.elapsed().as_secs_f64() * 1e3 / VIEWS as f64;
    }
    Ok(mean)
}
