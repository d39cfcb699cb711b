//! Radiosity: energy is conserved, furnaces are even, and results do not depend on threads or interruptions.

use glam::DVec3;
use nusselt::factors::{Exchange, ExchangeOptions, PatchMesh, PatchPlan, RowsOnce, mesh_scene};
use nusselt::radiosity::{
    Balance, Gather, RadiosityError, Solver, SolverOptions, SolverState, Surface, SurfaceOptions, uneven_patches,
};
use nusselt::samples::{Kind, cornell_box, generate};
use nusselt::scene::{Material, MetallicRoughness, PolygonId, PolygonRef, Scene};
use std::collections::HashMap;
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
    let gather = Gather::new(&exchange, solver.emission(), solver.reflectance(), solver.radiosity());
    for (polygon, near) in [(0, DVec3::new(0.7, 0.9, 0.0)), (30, DVec3::new(1e-6, 0.3, 1.0)), (50, DVec3::ONE)] {
        let found = gather.at(PolygonId(polygon), near).expect("a view").x;
        assert!((found / expected - 1.0).abs() < bound, "{found} {expected}");
    }
}

/// A furnace with a block that stands on its floor.
fn furnace_with_block(even: &Material) -> Scene {
    let corner = |k: usize| [0, 1, 2].map(|axis| [[0.5, 1.0, 0.0][axis], [1.0, 1.5, 0.5][axis]][k >> axis & 1]);
    let block: Vec<[f64; 3]> = (0..8).map(corner).collect();
    let faces = [[0, 2, 3, 1], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5], [4, 5, 7, 6]];
    let room = hollow(even.clone(), even.clone());
    let vertices: Vec<[f64; 3]> = room.vertices().iter().map(DVec3::to_array).collect();
    let rings = room.polygons().map(|polygon| polygon.rings()[0].iter().map(|v| v.index()).collect());
    let builder = Scene::builder().mesh(&vertices, &rings.collect::<Vec<_>>(), even.clone());
    builder.mesh(&block, &faces.map(|face| face.to_vec()), even.clone()).build().expect("a scene")
}

/// In a furnace too, what is covered by a block has no light to show beside it, whether the block stands on whole patches or not.
#[test]
fn what_stands_on_a_floor_does_not_darken_it() {
    let (reflectance, emission) = (0.5, 1.0);
    let scene = furnace_with_block(&material(reflectance, emission));
    let under = DVec3::new(0.75, 1.25, 0.0);
    let is_bottom = |p: DVec3| p.z.abs() < 1e-9 && (p - under).abs().max_element() < 0.25 + 1e-9;
    for longest in [0.5, 0.8] {
        let mesh = PatchMesh::new(&scene, longest).expect("a mesh");
        let patches = mesh.patches().expect("a scene");
        let tolerance = 1e-6;
        let options = ExchangeOptions { tolerance, ..ExchangeOptions::default() };
        let exchange = Exchange::of_mesh(&mesh, options).expect("patches");
        let mut solver = Solver::new(&scene, &exchange, SolverOptions::default()).expect("a solver");
        solver.solve(1e-10, |_| true).expect("solved");
        assert!(solver.balance().defect() < 1e-9);
        let rings: Vec<Vec<DVec3>> =
            patches.polygons().map(|patch| patch.rings()[0].iter().map(|&v| patches.vertex(v)).collect()).collect();
        let is_covered = |patch: PolygonId| rings[patch.index()].iter().all(|&p| is_bottom(p));
        let expected = PI * emission / (1.0 - reflectance);
        // As in the furnace above, with 31 square units; cuts make smaller patches than a quarter of the square of the edge.
        let least = exchange.patches().iter().map(|patch| patch.area).fold(f64::INFINITY, f64::min);
        let bound = tolerance * 31.0 / least / (1.0 - reflectance);
        assert!(bound < 1e-2, "{least}");
        let mut free = 0.0;
        for (patch, radiosity) in patches.polygons().zip(solver.radiosity()) {
            if is_covered(patch.id()) {
                // The bottom of the block sees nothing, and what it stands on sees the bottom at no distance.
                continue;
            }
            assert!(
                (radiosity.x / expected - 1.0).abs() < bound,
                "{longest}: {radiosity} of {:?}",
                rings[patch.id().index()]
            );
            free += exchange.patches()[patch.id().index()].area;
        }
        assert!((free - (27.0 + 1.0)).abs() < 1e-9, "all but the bottom and what is below it: {free}");
        let gather = Gather::new(&exchange, solver.emission(), solver.reflectance(), solver.radiosity());
        let covered = patches
            .polygons()
            .map(PolygonRef::id)
            .find(|&patch| is_covered(patch) && mesh.polygon(patch.index()).0 == 0);
        let covered = covered.expect("a patch under the block");
        let at = rings[covered.index()].iter().sum::<DVec3>() / rings[covered.index()].len() as f64;
        assert!((gather.at(covered, at).expect("a view").x - PI * emission).abs() < 1e-12, "it emits into the block");
        let surface = Surface::new(&patches, &mesh.regions(), &gather, &SurfaceOptions::default()).expect("a surface");
        assert!(surface.positions.iter().any(|&p| p.distance(DVec3::new(0.5, 1.0, 0.0)) < 1e-3), "a foot of the block");
        let mut below = 0;
        for (triangle, &patch) in surface.triangles.iter().zip(&surface.patches) {
            // The floor below the block has what it emits into it: seen from inside, nothing of what is outside.
            let is_below = is_covered(patch) && mesh.polygon(patch.index()).0 == 0;
            if is_covered(patch) && !is_below {
                continue;
            }
            below += usize::from(is_below);
            let (expected, bound) = if is_below { (PI * emission, 1e-12) } else { (expected, bound) };
            for corner in triangle {
                let (radiosity, position) = (surface.radiosity[*corner as usize], surface.positions[*corner as usize]);
                assert!((radiosity.x / expected - 1.0).abs() < bound, "{longest}: {radiosity} at {position}");
            }
        }
        assert!(below >= 2);
        // No corner is left over.
        let used: std::collections::HashSet<&u32> = surface.triangles.iter().flatten().collect();
        assert_eq!(used.len(), surface.positions.len());
    }
}

/// A closed room of 4 x 3 x 2.5 with a small lamp below its ceiling and a table in it.
fn room_with_table() -> Scene {
    let cuboid = |low: [f64; 3], high: [f64; 3]| -> Vec<[f64; 3]> {
        (0..8).map(|k: usize| [0, 1, 2].map(|axis| if k >> axis & 1 == 0 { low[axis] } else { high[axis] })).collect()
    };
    let inwards = [[0, 1, 3, 2], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3], [4, 6, 7, 5]];
    let outwards = inwards.map(|face| [face[3], face[2], face[1], face[0]].to_vec());
    let builder = Scene::builder().mesh(
        &cuboid([0.0; 3], [4.0, 3.0, 2.5]),
        &inwards.map(|face| face.to_vec()),
        material(0.6, 0.0),
    );
    let builder = builder.mesh(&cuboid([1.1, 0.7, 0.6], [2.7, 1.6, 0.7]), &outwards, material(0.5, 0.0));
    let lamp = [[1.3, 1.9, 2.4], [1.9, 1.9, 2.4], [1.9, 2.4, 2.4], [1.3, 2.4, 2.4]];
    builder.mesh(&lamp, &[vec![3, 2, 1, 0]], material(0.0, 5.0)).build().expect("a scene")
}

struct Solved {
    mesh: PatchMesh,
    radiosity: Vec<DVec3>,
    shots: usize,
}

/// Solved in patches of that length, and again with uneven ones halved, some times.
fn subdivided(scene: &Scene, longest: f64, gradient: f64, times: usize) -> Solved {
    let mut mesh = PatchMesh::new(scene, longest).expect("a mesh");
    let mut guess = Vec::new();
    let options = ExchangeOptions { tolerance: 1e-3, ..ExchangeOptions::default() };
    for time in 0..=times {
        let exchange = Exchange::of_mesh(&mesh, options).expect("patches");
        let mut solver = Solver::new(scene, &exchange, SolverOptions::default()).expect("a solver");
        solver.start_from(guess).or_else(|_| solver.start_from(Vec::new())).expect("started");
        solver.solve(1e-4, |_| true).expect("solved");
        let balance = solver.balance();
        // Rounding of some thousands of shots.
        assert!(balance.defect() < 1e-11, "{balance:?}");
        let radiosity = solver.radiosity().to_vec();
        if time == times {
            return Solved { mesh, radiosity, shots: solver.state().shots };
        }
        let patches = mesh.patches().expect("a scene");
        let gather = Gather::new(&exchange, solver.emission(), solver.reflectance(), solver.radiosity());
        let uneven = uneven_patches(&patches, &mesh.regions(), &gather, gradient, &|_| ()).expect("views");
        let (finer, parents) = mesh.halved(|patch| uneven[patch]);
        guess = parents.iter().map(|&parent| radiosity[parent]).collect();
        mesh = finer;
    }
    unreachable!()
}

/// The root of the mean square of differences to a finer solution, by area, over the root of its mean square; of what reflects.
fn difference(scene: &Scene, coarse: &Solved, fine: &Solved) -> f64 {
    let rings = |solved: &Solved| -> Vec<Vec<DVec3>> {
        let patches = solved.mesh.patches().expect("a scene");
        patches.polygons().map(|patch| patch.rings()[0].iter().map(|&v| patches.vertex(v)).collect()).collect()
    };
    let (own, its) = (rings(coarse), rings(fine));
    let mut of_polygon: HashMap<PolygonId, Vec<usize>> = HashMap::new();
    (0..own.len()).for_each(|patch| of_polygon.entry(coarse.mesh.polygon(patch)).or_default().push(patch));
    // How far a point of its plane is outside of a convex ring, as a part of its sides.
    let outside = |ring: &[DVec3], p: DVec3| {
        let normal = (ring[1] - ring[0]).cross(ring[2] - ring[0]).normalize();
        let sides = ring.iter().zip(ring.iter().cycle().skip(1));
        sides.map(|(&a, &b)| normal.dot((p - a).cross(b - a)) / (b - a).length()).fold(f64::NEG_INFINITY, f64::max)
    };
    let (mut off, mut whole) = (0.0, 0.0);
    for (patch, ring) in its.iter().enumerate() {
        let polygon = fine.mesh.polygon(patch);
        if scene.polygon(polygon).material().diffuse[0] == 0.0 {
            continue;
        }
        let middle = ring.iter().sum::<DVec3>() / ring.len() as f64;
        let area = (ring[1] - ring[0]).cross(ring[2] - ring[0]).length() * if ring.len() == 4 { 1.0 } else { 0.5 };
        let nearest = of_polygon[&polygon]
            .iter()
            .min_by(|&&a, &&b| outside(&own[a], middle).total_cmp(&outside(&own[b], middle)));
        let found = coarse.radiosity[*nearest.expect("a patch")];
        off += area * (found - fine.radiosity[patch]).length_squared();
        whole += area * fine.radiosity[patch].length_squared();
    }
    (off / whole).sqrt()
}

#[test]
fn halving_where_light_changes_is_better_than_finer_patches_everywhere() {
    let scene = room_with_table();
    let fine = subdivided(&scene, 0.2, 1.0, 0);
    let even = subdivided(&scene, 0.4, 1.0, 0);
    let halved = subdivided(&scene, 0.8, 0.8, 2);
    let [of_even, of_halved] = [&even, &halved].map(|solved| difference(&scene, solved, &fine));
    println!("{} of {} even patches, {of_halved} of {} halved ones", of_even, even.mesh.len(), halved.mesh.len());
    assert!(halved.mesh.len() < even.mesh.len() && of_halved < 0.9 * of_even, "{of_halved} {of_even}");
    assert!(halved.shots * 2 < even.shots, "{} {}", halved.shots, even.shots);
}

#[test]
fn a_guess_changes_the_way_and_not_the_solution() {
    let scene = room_with_table();
    let mesh = PatchMesh::new(&scene, 1.0).expect("a mesh");
    let exchange =
        Exchange::of_mesh(&mesh, ExchangeOptions { tolerance: 1e-2, ..ExchangeOptions::default() }).expect("patches");
    let solved = |guess: Vec<DVec3>, stop: usize| {
        let mut solver = Solver::new(&scene, &exchange, SolverOptions::default()).expect("a solver");
        solver.start_from(guess).expect("one for each patch");
        solver.solve(1e-11, |solver| solver.state().shots < stop).expect("solved");
        assert!(solver.balance().defect() < 1e-12, "{:?}", solver.balance());
        solver.state().clone()
    };
    let plain = solved(Vec::new(), usize::MAX);
    let wild = (0..mesh.len()).map(|k| DVec3::new(1.0, -0.5, (k % 7) as f64)).collect();
    let near = plain.radiosity.iter().map(|b| b * 1.01).collect::<Vec<_>>();
    let most = plain.radiosity.iter().map(|b| b.max_element()).fold(0.0, f64::max);
    for (guess, is_near) in [(wild, false), (near, true)] {
        let found: SolverState = solved(guess, usize::MAX);
        // As with overshooting above.
        let off =
            plain.radiosity.iter().zip(&found.radiosity).map(|(a, b)| (a - b).abs().max_element()).fold(0.0, f64::max);
        assert!(off < 1e-7 * most, "{off} of {most}");
        assert!(!is_near || found.shots < plain.shots, "{} {}", found.shots, plain.shots);
        // Interrupted while it guesses, it comes to the same bits.
        let first = solved(found.guess.clone(), 20);
        assert!(first.guessed < first.guess.len());
        let mut second = Solver::new(&scene, &exchange, SolverOptions::default()).expect("a solver");
        second.resume(first).expect("its own");
        second.solve(1e-11, |_| true).expect("solved");
        assert_eq!(*second.state(), found);
    }
    let mut solver = Solver::new(&scene, &exchange, SolverOptions::default()).expect("a solver");
    assert!(matches!(solver.start_from(vec![DVec3::ONE; 3]), Err(RadiosityError::OtherState { found: 3, .. })));
    let bad = vec![DVec3::INFINITY; mesh.len()];
    assert!(matches!(solver.start_from(bad), Err(RadiosityError::BadState { patch: 0 })));
}

#[test]
fn rows_in_any_order_have_the_same_bits() {
    let scene = room_with_table();
    let mesh = PatchMesh::new(&scene, 0.8).expect("a mesh");
    let exchange = Exchange::of_mesh(&mesh, ExchangeOptions::default()).expect("patches");
    let rows = RowsOnce::new(&exchange);
    // 59 and the number of patches have no common divisor, and some are asked for twice.
    assert!(!mesh.len().is_multiple_of(59));
    for k in 0..mesh.len() + 9 {
        let patch = k * 59 % mesh.len();
        assert_eq!(rows.row(patch), exchange.row(patch));
    }
    assert!(rows.row(mesh.len()).is_err());
}

/// Cohen et al. 1988, by hand.
#[test]
fn the_ambient_term_is_that_of_the_paper_and_comes_nearer_to_the_solution() {
    let coloured = |diffuse: [f64; 3], emission: f64| Material { diffuse, ..material(0.0, emission) };
    let scene = hollow(coloured([0.8, 0.5, 0.2], 0.0), coloured([0.1, 0.3, 0.0], 1.0));
    let exchange = exchange(&scene, 1e-6);
    let mut solver =
        Solver::new(&scene, &exchange, SolverOptions { batch: 1, ..SolverOptions::default() }).expect("a solver");
    let (lid, walls) = (6.0, 2.0 * (3.0 + 4.5) + 6.0);
    for k in 0..3 {
        let mean = (walls * [0.8, 0.5, 0.2][k] + lid * [0.1, 0.3, 0.0][k]) / (walls + lid);
        let irradiance = PI * lid / (walls + lid) / (1.0 - mean);
        assert!((solver.ambient()[0][k] - [0.8, 0.5, 0.2][k] * irradiance).abs() < 1e-13);
        assert!((solver.ambient()[5][k] - [0.1, 0.3, 0.0][k] * irradiance).abs() < 1e-13);
    }
    // After the first shot what is unshot is on the walls.
    solver.shoot().expect("shot");
    let areas = [6.0, 3.0, 3.0, 4.5, 4.5, 6.0];
    let unshot: DVec3 = solver.state().unshot.iter().zip(areas).map(|(&b, area)| b * area).sum();
    let mean = (walls * 0.8 + lid * 0.1) / (walls + lid);
    let ambient = solver.ambient();
    assert!((ambient[2].x - 0.8 * unshot.x / (walls + lid) / (1.0 - mean)).abs() < 1e-13);
    let (before, balance) = (solver.radiosity().to_vec(), solver.balance());
    solver.solve(1e-12, |_| true).expect("solved");
    let power = |off: &mut dyn Iterator<Item = DVec3>| {
        off.zip(areas).map(|(b, area)| b.abs().element_sum() * area).sum::<f64>()
    };
    let without = power(&mut before.iter().zip(solver.radiosity()).map(|(b, end)| end - b));
    let with = power(&mut before.iter().zip(&ambient).zip(solver.radiosity()).map(|((b, more), end)| end - b - more));
    assert!(with < 0.2 * without, "{with} {without}");
    assert!(balance.defect() < 1e-12 && solver.ambient()[0].max_element() < 1e-11);
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
        // In a closed room fronts absorb all, whatever stands on what.
        let left = 1.0 - balance.absorbed.element_sum() / balance.emitted.element_sum();
        assert!(if is_closed { left.abs() < 1e-9 } else { left > 0.05 }, "{left}");
    }
}

/// What stands on a floor exchanges with the floor below it alone: also what both emit, and whether or not the floor is cut where it stands.
#[test]
fn nothing_is_lost_below_what_stands_in_a_closed_room() {
    let scene = furnace_with_block(&material(0.5, 1.0));
    let options = ExchangeOptions { tolerance: 1e-3, ..ExchangeOptions::default() };
    let cut = PatchMesh::new(&scene, f64::INFINITY).expect("a mesh");
    for exchange in [exchange(&scene, 1e-3), Exchange::of_mesh(&cut, options).expect("patches")] {
        let mut solver = Solver::new(&scene, &exchange, SolverOptions::default()).expect("a solver");
        solver.solve(1e-11, |_| true).expect("solved");
        let Balance { emitted, absorbed, .. } = solver.balance();
        assert!((absorbed / emitted - 1.0).abs().max_element() < 1e-9, "{:?}", solver.balance());
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

/// The form factor between equal parallel rectangles opposite each other, with sides x and y times their distance.
fn between_rectangles(x: f64, y: f64) -> f64 {
    let (u, v) = ((1.0 + x * x).sqrt(), (1.0 + y * y).sqrt());
    2.0 / (PI * x * y)
        * ((u * v / (1.0 + x * x + y * y).sqrt()).ln() + x * v * (x / v).atan() + y * u * (y / u).atan()
            - x * x.atan()
            - y * y.atan())
}

/// A lamp over a sheet of the same size that shows it its back, or its front.
#[test]
fn power_that_backs_get_and_power_that_leaves_are_told_apart() {
    let square = |z: f64| [[0.0, 0.0, z], [2.0, 0.0, z], [2.0, 3.0, z], [0.0, 3.0, z]];
    let (up, down) = (vec![vec![0, 1, 2, 3]], vec![vec![3, 2, 1, 0]]);
    for (sheet, is_back) in [(&down, true), (&up, false)] {
        let scene = Scene::builder()
            .mesh(&square(0.0), sheet, material(0.0, 0.0))
            .mesh(&square(1.5), &down, material(0.0, 1.0))
            .build()
            .expect("a scene");
        let exchange = exchange(&scene, 1e-9);
        let mut solver = Solver::new(&scene, &exchange, SolverOptions::default()).expect("a solver");
        solver.solve(1e-12, |_| true).expect("solved");
        let factor = between_rectangles(2.0 / 1.5, 3.0 / 1.5);
        let power = 6.0 * PI;
        let (arrives, leaves) = (power * factor, power * (1.0 - factor));
        let (absorbed, backs) = if is_back { (0.0, arrives) } else { (arrives, 0.0) };
        let balance = solver.balance();
        // Factors are right to 1e-9.
        for (found, expected) in [(balance.absorbed, absorbed), (balance.backs, backs), (balance.background, leaves)] {
            assert!((found - expected).abs().max_element() < 1e-9 * power, "{is_back}: {balance:?} {expected}");
        }
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
    let factor = between_rectangles(2.0 / 1.5, 3.0 / 1.5);
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
    // What is emitted, a product with pi or with an area, or a sum of these may be too large.
    for bright in [1e308, 5e307, 1e303] {
        let refused = made(material(0.5, 0.0), material(0.5, bright));
        assert!(matches!(refused, Err(RadiosityError::TooBright { polygon: PolygonId(5) })), "{bright:e}: {refused:?}");
    }
    // Of a floor of infinite area, whatever emits.
    let corners = [[0.0, 0.0, 0.0], [1e200, 0.0, 0.0], [0.0, 1e200, 0.0], [0.0, 0.0, 1.0]];
    for (emission, is_dark) in [(0.0, true), (1.0, false)] {
        let builder = Scene::builder().mesh(&corners, &[vec![0, 1, 2]], material(0.5, 0.0));
        let scene = builder.mesh(&corners, &[vec![1, 2, 3]], material(0.5, emission)).build().expect("a scene");
        let exchange = exchange(&scene, 1e-3);
        let refused = Solver::new(&scene, &exchange, SolverOptions::default()).err();
        let expected = if is_dark { RadiosityError::Dark } else { RadiosityError::TooLarge { polygon: PolygonId(0) } };
        assert_eq!(refused, Some(expected));
    }
    // Parts of it may be too small, or all of it.
    for dim in [1e-301, 1e-320] {
        let refused = made(material(0.5, dim / 3.0), material(0.5, dim));
        assert!(matches!(refused, Err(RadiosityError::TooDim { polygon: PolygonId(5) })), "{dim:e}: {refused:?}");
    }
    // Areas may be too small for any power at all, which is not dark.
    let tiny = [[0.0, 0.0, 0.0], [1e-170, 0.0, 0.0], [0.0, 1e-170, 0.0], [0.0, 0.0, 1e-170]];
    let builder = Scene::builder().mesh(&tiny, &[vec![0, 1, 2]], material(0.5, 0.0));
    let scene = builder.mesh(&tiny, &[vec![1, 2, 3]], material(0.5, 1.0)).build().expect("a scene");
    let refused = Solver::new(&scene, &exchange(&scene, 1e-3), SolverOptions::default()).err();
    assert_eq!(refused, Some(RadiosityError::TooDim { polygon: PolygonId(1) }));
    let scene = hollow(material(0.5, 0.0), material(0.5, 1e-298));
    let exchange_of_dim = exchange(&scene, 1e-3);
    let mut solver = Solver::new(&scene, &exchange_of_dim, SolverOptions::default()).expect("a solver");
    solver.solve(1e-6, |_| true).expect("solved");
    assert!(solver.balance().defect() < 1e-12, "{}", solver.balance().defect());
    let all = made(material(0.5, 1e299), material(0.5, 1e299));
    assert_eq!(all, Ok(6), "numbers hold that");
    let scene = hollow(material(1.0, 0.0), material(1.0, 1.0));
    let exchange = exchange(&scene, 1e-2);
    let mut solver = Solver::new(&scene, &exchange, SolverOptions::default()).expect("a solver");
    assert!(matches!(solver.solve(1e-3, |_| true), Err(RadiosityError::Endless { .. })));
    let other = SolverState { radiosity: vec![DVec3::ONE], ..SolverState::default() };
    assert!(matches!(solver.resume(other), Err(RadiosityError::OtherState { found: 1, expected: 6 })));
    for bad in [DVec3::NAN, DVec3::splat(1e307)] {
        let bad = SolverState { radiosity: vec![bad; 6], unshot: vec![DVec3::ONE; 6], ..SolverState::default() };
        assert!(matches!(solver.resume(bad), Err(RadiosityError::BadState { patch: 0 })));
    }
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
    let gather = Gather::new(&exchange, solver.emission(), solver.reflectance(), solver.radiosity());
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

/// A bright room and a dim one beside it: each is solved to the same part of its own light.
#[test]
fn a_dim_room_is_solved_as_if_there_were_no_bright_one() {
    let corner = |k: usize, from: f64| [0, 1, 2].map(|axis| if k >> axis & 1 == 0 { from } else { from + 2.0 });
    let faces = [[0, 1, 3, 2], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3], [4, 6, 7, 5]];
    let faces = faces.map(|face| face.to_vec());
    let (dim_reflectance, dim) = (0.9, 1e-7);
    let mut builder = Scene::builder();
    for (from, material) in [(0.0, material(0.5, 100.0)), (5.0, material(dim_reflectance, dim))] {
        let vertices: Vec<[f64; 3]> = (0..8).map(|k| corner(k, from)).collect();
        builder = builder.mesh(&vertices, &faces, material);
    }
    let scene = builder.build().expect("a scene");
    let exchange = exchange(&scene, 1e-6);
    let mut solver = Solver::new(&scene, &exchange, SolverOptions::default()).expect("a solver");
    let until = 1e-4;
    solver.solve(until, |_| true).expect("solved");
    assert!(solver.is_settled(until) && !solver.is_settled(1e-3 * until));
    for b in &solver.radiosity()[6..] {
        // What is left of what is emitted, times what it would become at most.
        let expected = PI * dim / (1.0 - dim_reflectance);
        assert!((b.x / expected - 1.0).abs() < until, "{} {expected}", b.x);
    }
    // And gone on with from what was kept of it, with the same bits.
    let mut first = Solver::new(&scene, &exchange, SolverOptions::default()).expect("a solver");
    first.solve(until, |solver| solver.state().shots < 30).expect("stopped");
    let mut second = Solver::new(&scene, &exchange, SolverOptions::default()).expect("a solver");
    second.resume(first.state().clone()).expect("resumed");
    second.solve(until, |_| true).expect("solved");
    assert_eq!(second.radiosity(), solver.radiosity());
}

/// Rooms of which hardly any light is taken, with all rows: shooting would take a thousand million bounces.
#[test]
fn bright_rooms_are_settled_at_once() {
    for absorbed in [0.3, 1e-3, 1e-6, 1e-9] {
        let reflectance = 1.0 - absorbed;
        let scene = hollow(material(reflectance, 0.0), material(reflectance, 2.0));
        let exchange = exchange(&scene, 1e-6);
        let mut solver = Solver::new(&scene, &exchange, SolverOptions::default()).expect("a solver");
        assert!(!solver.settle(), "there are no rows yet");
        solver.compute_rows(0, |_| Ok::<(), RadiosityError>(())).expect("rows");
        assert!(solver.settle());
        assert!(solver.is_settled(1e-12) && solver.balance().defect() < 1e-6, "{:?}", solver.balance());
        // All that is emitted is absorbed: of the lid's 6 square units.
        let arrives: f64 = solver
            .radiosity()
            .iter()
            .zip(solver.emission())
            .zip(exchange.patches())
            .map(|((b, emission), patch)| (b.x - emission.x) / reflectance * patch.area)
            .sum();
        let expected = 6.0 * 2.0 * PI / (1.0 - reflectance);
        // Sums of rows are 1 up to some 1e-16, which bounces multiply.
        assert!((arrives / expected - 1.0).abs() < 1e-14 + 1e-15 / absorbed, "{absorbed:e}: {arrives} {expected}");
    }
    // Nothing is found where nothing is absorbed.
    let scene = hollow(material(1.0, 0.0), material(1.0, 2.0));
    let exchange = exchange(&scene, 1e-6);
    let mut solver = Solver::new(&scene, &exchange, SolverOptions::default()).expect("a solver");
    solver.compute_rows(0, |_| Ok::<(), RadiosityError>(())).expect("rows");
    let before = solver.state().clone();
    assert!(!solver.settle());
    assert_eq!(solver.state(), &before);
}
