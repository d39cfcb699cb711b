//! Radiosity: energy is conserved, furnaces are even, and results do not depend on threads or interruptions.

use glam::DVec3;
use nusselt::contour::SceneOrder;
use nusselt::factors::{Exchange, ExchangeOptions, PatchPlan, mesh_scene};
use nusselt::radiosity::{Gather, RadiosityError, Solver, SolverOptions, SolverState, Surface, SurfaceOptions};
use nusselt::samples::{Kind, cornell_box, generate};
use nusselt::scene::{Material, MetallicRoughness, PolygonId, Scene};
use std::f64::consts::PI;

fn material(diffuse: f64, emission: f64) -> Material {
    Material { diffuse: [diffuse; 3], emission: [emission; 3], ..Material::new("even") }
}

/// A box with its fronts inside, of one material or of a lid of another.
fn hollow(walls: Material, lid: Material) -> Scene {
    let corner = |k: usize| [0, 1, 2].map(|axis| if k >> axis & 1 == 0 { 0.0 } else { [2.0, 3.0, 1.5][axis] });
    let vertices: Vec<[f64; 3]> = (0..8).map(corner).collect();
    let faces = [[0, 1, 3, 2], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]].map(|face| face.to_vec());
    let builder = Scene::builder().mesh(&vertices, &faces, walls);
    builder.mesh(&vertices, &[vec![4, 6, 7, 5]], lid).build().expect("a scene")
}

fn exchange(scene: &Scene, tolerance: f64) -> Exchange {
    let options = ExchangeOptions { tolerance, ..ExchangeOptions::default() };
    Exchange::new(scene, PatchPlan::Polygons, options).expect("patches")
}

#[test]
fn a_furnace_is_even() {
    let (reflectance, emission) = (0.6, 2.0);
    let scene = hollow(material(reflectance, emission), material(reflectance, emission));
    let (patches, _) = mesh_scene(&scene, 0.8).expect("a mesh");
    let tolerance = 1e-7;
    let exchange = exchange(&patches, tolerance);
    let mut solver = Solver::new(&patches, &exchange, SolverOptions::default()).expect("a solver");
    solver.solve(1e-13, |_| true).expect("solved");
    let expected = PI * emission / (1.0 - reflectance);
    let area: f64 = exchange.patches().iter().map(|patch| patch.area).sum();
    let power: f64 = solver.radiosity().iter().zip(exchange.patches()).map(|(b, patch)| b.x * patch.area).sum();
    // Rows sum to 1 up to rounding, so all power together is right whatever the factors.
    assert!((power / area / expected - 1.0).abs() < 1e-11, "{}", power / area / expected - 1.0);
    // What a patch gets is off by the tolerance of each factor to it, by the areas of the others over its own.
    let least = exchange.patches().iter().map(|patch| patch.area).fold(f64::INFINITY, f64::min);
    let bound = tolerance * area / least / (1.0 - reflectance);
    assert!(solver.radiosity().iter().all(|b| (b.x / expected - 1.0).abs() < bound), "{:?}", solver.radiosity());
    // What is gathered at a point is a mean of those with weights that sum to 1.
    let gather = Gather::new(SceneOrder::new(&patches), solver.emission(), solver.reflectance(), solver.radiosity());
    for (polygon, near) in [(0, DVec3::new(0.7, 0.9, 0.0)), (30, DVec3::new(1e-6, 0.3, 1.0)), (50, DVec3::ONE)] {
        let found = gather.at(PolygonId(polygon), near).expect("a view").x;
        assert!((found / expected - 1.0).abs() < bound, "{found} {expected}");
    }
}

/// In a furnace too, what is covered by a block has no light to show beside it.
#[test]
fn what_stands_on_a_floor_does_not_darken_it() {
    let (reflectance, emission) = (0.5, 1.0);
    let even = material(reflectance, emission);
    let corner = |k: usize| [0, 1, 2].map(|axis| [[0.5, 1.0, 0.0][axis], [1.0, 1.5, 0.5][axis]][k >> axis & 1]);
    let block: Vec<[f64; 3]> = (0..8).map(corner).collect();
    let faces = [[0, 2, 3, 1], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5], [4, 5, 7, 6]];
    let room = hollow(even.clone(), even.clone());
    let vertices: Vec<[f64; 3]> = room.vertices().iter().map(DVec3::to_array).collect();
    let rings = room.polygons().map(|polygon| polygon.rings()[0].iter().map(|v| v.index()).collect());
    let builder = Scene::builder().mesh(&vertices, &rings.collect::<Vec<_>>(), even.clone());
    let scene = builder.mesh(&block, &faces.map(|face| face.to_vec()), even).build().expect("a scene");
    // The block stands on whole patches.
    let (patches, of) = mesh_scene(&scene, 0.5).expect("a mesh");
    let tolerance = 1e-6;
    let exchange = exchange(&patches, tolerance);
    let mut solver = Solver::new(&patches, &exchange, SolverOptions::default()).expect("a solver");
    solver.solve(1e-10, |_| true).expect("solved");
    let gather = Gather::new(SceneOrder::new(&patches), solver.emission(), solver.reflectance(), solver.radiosity());
    let under = DVec3::new(0.75, 1.2, 0.0);
    let covered = of.iter().zip(patches.polygons()).find(|(_, patch)| {
        let ring: Vec<DVec3> = patch.rings()[0].iter().map(|&v| patches.vertex(v)).collect();
        ring.iter().all(|p| p.z == 0.0 && (p - under).abs().max_element() < 0.4)
    });
    let covered = covered.expect("a patch under the block").1.id();
    assert!((gather.at(covered, under).expect("a view").x - PI * emission).abs() < 1e-12, "it emits into the block");
    let surface = Surface::new(&patches, &of, &gather, &SurfaceOptions::default()).expect("a surface");
    let expected = PI * emission / (1.0 - reflectance);
    // As in the furnace above, with 30 square units in patches of a quarter or less.
    let bound = tolerance * 30.0 / 0.1 / (1.0 - reflectance);
    assert!(surface.positions.iter().any(|&p| p.distance(DVec3::new(0.5, 1.0, 0.0)) < 1e-12), "a foot of the block");
    for (position, radiosity) in surface.positions.iter().zip(&surface.radiosity) {
        let is_bottom = position.z == 0.0 && (position - under).abs().max_element() < 0.31;
        assert!((radiosity.x / expected - 1.0).abs() < bound || is_bottom, "{radiosity} at {position}");
    }
    // The floor below the block has what it emits into it: seen from inside, nothing of what is outside.
    let mut below = 0;
    for (triangle, &patch) in surface.triangles.iter().zip(&surface.patches) {
        if of[patch.index()] == PolygonId(0) {
            below += usize::from(patch == covered);
            let (expected, bound) = if patch == covered { (PI * emission, 1e-12) } else { (expected, bound) };
            for corner in triangle {
                let (at, found) = (surface.positions[*corner as usize], surface.radiosity[*corner as usize]);
                assert!((found.x / expected - 1.0).abs() < bound, "{found} at {at}");
            }
        }
    }
    assert!(below >= 2);
    // No corner is left over.
    let used: std::collections::HashSet<&u32> = surface.triangles.iter().flatten().collect();
    assert_eq!(used.len(), surface.positions.len());
}

#[test]
fn power_is_conserved_in_closed_and_open_scenes() {
    let room = generate(Kind::Room, 150, 4).expect("a scene").to_builder().build().expect("a scene");
    let (open, _) = mesh_scene(&cornell_box().to_builder().build().expect("a scene"), 250.0).expect("a mesh");
    for (scene, is_closed) in [(room, true), (open, false)] {
        let exchange = exchange(&scene, 1e-2);
        let mut solver = Solver::new(&scene, &exchange, SolverOptions::default()).expect("a solver");
        solver.solve(0.3, |_| true).expect("solved");
        // Before the end too.
        assert!(solver.balance().defect() < 1e-12, "{:?}", solver.balance());
        let ambient = solver.ambient();
        assert!(ambient.iter().all(|b| b.is_finite() && b.min_element() >= 0.0) && ambient.iter().any(|b| b.x > 0.0));
        solver.solve(1e-10, |_| true).expect("solved");
        let balance = solver.balance();
        assert!(balance.defect() < 1e-9 && balance.unshot_fraction() <= 1e-10, "{balance:?}");
        let gone = (balance.absorbed + balance.backs + balance.background).element_sum();
        assert!((gone / balance.emitted.element_sum() - 1.0).abs() < 1e-9);
        let left = balance.background.element_sum() / balance.emitted.element_sum();
        assert!(if is_closed { left < 1e-9 } else { left > 0.05 }, "{left}");
    }
}

/// In bright rooms it takes fewer shots; in an open one it has to take much back. The solution is the same.
#[test]
fn overshooting_comes_to_the_same_solution() {
    let (lit, _) = mesh_scene(&hollow(material(0.8, 0.0), material(0.0, 1.0)), 0.8).expect("a mesh");
    let (open, _) = mesh_scene(&cornell_box().to_builder().build().expect("a scene"), 250.0).expect("a mesh");
    for (scene, is_bright) in [(lit, true), (open, false)] {
        let exchange = exchange(&scene, 1e-2);
        let solved = |overshoot: bool, until: f64| {
            let options = SolverOptions { overshoot, ..SolverOptions::default() };
            let mut solver = Solver::new(&scene, &exchange, options).expect("a solver");
            let mut has_taken_back = false;
            solver
                .solve(until, |solver| {
                    has_taken_back |= solver.state().unshot.iter().any(|b| b.min_element() < 0.0);
                    assert!(solver.balance().defect() < 1e-12, "{:?}", solver.balance());
                    // No patch sends less, in all, than what it has.
                    assert!(solver.radiosity().iter().all(|b| b.min_element() > -1e-12), "{:?}", solver.radiosity());
                    true
                })
                .expect("solved");
            assert_eq!(has_taken_back, overshoot);
            assert!(solver.balance().unshot_fraction() <= until);
            solver.state().clone()
        };
        let [plain, over] = [false, true].map(|overshoot| solved(overshoot, 0.03).shots);
        println!("{plain} shots, {over} with overshooting");
        assert!(!is_bright || over * 3 < plain * 2, "{over} shots, {plain} without overshooting");
        // What is left is 1e-11 of the power; five times that after reflections, all on the smallest patch of a hundredth of the area, is less than 1e-7.
        let [plain, over] = [false, true].map(|overshoot| solved(overshoot, 1e-11).radiosity);
        let most = plain.iter().map(|b| b.max_element()).fold(0.0, f64::max);
        let off = plain.iter().zip(&over).map(|(a, b)| (a - b).abs().max_element()).fold(0.0, f64::max);
        assert!(off < 1e-7 * most, "{off} of {most}");
    }
}

#[test]
fn a_lid_over_black_walls_lights_them_by_its_factors() {
    let scene = hollow(material(0.0, 0.0), material(0.0, 1.0));
    let exchange = exchange(&scene, 1e-9);
    let mut solver = Solver::new(&scene, &exchange, SolverOptions::default()).expect("a solver");
    solver.solve(1e-12, |_| true).expect("solved");
    assert!(solver.radiosity()[..5].iter().all(|b| *b == DVec3::ZERO));
    assert_eq!(solver.state().shots, 1);
    // A grey floor reflects half of what arrives: F from lid to floor, of equal areas 2 x 3 at a distance of 1.5.
    let grey = hollow(material(0.5, 0.0), material(0.0, 1.0));
    let exchange = self::exchange(&grey, 1e-9);
    let mut solver = Solver::new(&grey, &exchange, SolverOptions::default()).expect("a solver");
    solver.shoot().expect("shot");
    let (x, y) = (2.0_f64 / 1.5, 3.0_f64 / 1.5);
    let (u, v) = ((1.0 + x * x).sqrt(), (1.0 + y * y).sqrt());
    let factor = 2.0 / (PI * x * y)
        * ((u * v / (1.0 + x * x + y * y).sqrt()).ln() + x * v * (x / v).atan() + y * u * (y / u).atan()
            - x * x.atan()
            - y * y.atan());
    assert!((solver.radiosity()[0].x - 0.5 * PI * factor).abs() < 1e-8, "{} {factor}", solver.radiosity()[0].x);
}

#[test]
fn threads_and_interruptions_do_not_change_a_bit() {
    let scene = generate(Kind::Room, 120, 2).expect("a scene").to_builder().build().expect("a scene");
    let exchange = exchange(&scene, 1e-2);
    let solved = |threads: usize| -> SolverState {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| {
            let mut solver = Solver::new(&scene, &exchange, SolverOptions::default()).expect("a solver");
            solver.solve(1e-3, |_| true).expect("solved");
            solver.state().clone()
        })
    };
    let whole = solved(1);
    assert_eq!(whole, solved(3));
    let mut first = Solver::new(&scene, &exchange, SolverOptions::default()).expect("a solver");
    first.solve(1e-3, |solver| solver.state().shots < 20).expect("stopped");
    assert!(first.balance().unshot_fraction() > 1e-3);
    let mut second = Solver::new(&scene, &exchange, SolverOptions { most_entries: 0, ..SolverOptions::default() })
        .expect("a solver");
    second.resume(first.state().clone()).expect("its own");
    second.solve(1e-3, |_| true).expect("solved");
    assert_eq!(*second.state(), whole);
}

#[test]
fn what_cannot_be_solved_is_refused() {
    let made = |walls: Material, lid: Material| {
        let scene = hollow(walls, lid);
        let exchange = exchange(&scene, 1e-3);
        Solver::new(&scene, &exchange, SolverOptions::default()).map(|solver| solver.radiosity().len())
    };
    let surface = MetallicRoughness { base_colour: [1.5; 3], metallic: 0.0, roughness: 1.0 };
    let bad = Material { metallic_roughness: Some(surface), ..material(1.5, 0.0) };
    assert!(matches!(made(bad, material(0.5, 1.0)), Err(RadiosityError::BadMaterial { polygon: PolygonId(0), .. })));
    assert!(matches!(made(material(0.5, 0.0), material(0.5, 0.0)), Err(RadiosityError::Dark)));
    let scene = hollow(material(1.0, 0.0), material(1.0, 1.0));
    let exchange = exchange(&scene, 1e-2);
    let mut solver = Solver::new(&scene, &exchange, SolverOptions::default()).expect("a solver");
    assert!(matches!(solver.solve(1e-3, |_| true), Err(RadiosityError::Endless { .. })));
    let other = SolverState { radiosity: vec![DVec3::ONE], ..SolverState::default() };
    assert!(matches!(solver.resume(other), Err(RadiosityError::OtherState { found: 1, expected: 6 })));
    let bad = SolverState { radiosity: vec![DVec3::NAN; 6], unshot: vec![DVec3::ONE; 6], ..SolverState::default() };
    assert!(matches!(solver.resume(bad), Err(RadiosityError::BadState { patch: 0 })));
}

#[test]
fn surfaces_are_finer_where_radiosity_changes_and_right_where_they_are_not() {
    // A lamp over a floor, and a plate that casts a shadow on it.
    let mut builder = Scene::builder();
    let square = |z: f64, half: f64| [[-half, -half, z], [half, -half, z], [half, half, z], [-half, half, z]];
    builder = builder.mesh(&square(0.0, 4.0), &[vec![0, 1, 2, 3]], material(0.5, 0.0));
    builder = builder.mesh(&square(1.0, 0.7), &[vec![0, 1, 2, 3]], material(0.0, 0.0));
    builder = builder.mesh(&square(3.0, 0.3), &[vec![3, 2, 1, 0]], material(0.0, 10.0));
    let scene = builder.build().expect("a scene");
    let (patches, of) = mesh_scene(&scene, 1.0).expect("a mesh");
    let exchange = exchange(&patches, 1e-3);
    let mut solver = Solver::new(&patches, &exchange, SolverOptions::default()).expect("a solver");
    solver.solve(1e-2, |_| true).expect("solved");
    let gather = Gather::new(SceneOrder::new(&patches), solver.emission(), solver.reflectance(), solver.radiosity());
    let coarse = SurfaceOptions { depth: 0, ..SurfaceOptions::default() };
    let coarse = Surface::new(&patches, &of, &gather, &coarse).expect("a surface");
    let fine = Surface::new(&patches, &of, &gather, &SurfaceOptions::default()).expect("a surface");
    assert!(fine.triangles.len() > 2 * coarse.triangles.len(), "{} {}", fine.triangles.len(), coarse.triangles.len());
    // Twice the area stays, patch by patch.
    for surface in [&coarse, &fine] {
        let doubled = surface.triangles.iter().map(|triangle| {
            let [a, b, c] = triangle.map(|corner| surface.positions[corner as usize]);
            (b - a).cross(c - a).length()
        });
        assert!((doubled.sum::<f64>() - 2.0 * (64.0 + 1.96 + 0.36)).abs() < 1e-10);
    }
    // In the umbra there is nothing but what comes from elsewhere, here nothing at all.
    let at = |p: DVec3| fine.positions.iter().position(|&q| q.distance(p) < 1e-12).map(|k| fine.radiosity[k].x);
    assert_eq!(at(DVec3::ZERO), Some(0.0));
    let lit = at(DVec3::new(4.0, 4.0, 0.0)).expect("a corner");
    assert!(lit > 0.0 && lit < fine.radiosity.iter().map(|b| b.x).fold(0.0, f64::max));
}
