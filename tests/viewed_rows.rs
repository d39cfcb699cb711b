//! Form factors by a few views from each patch, and radiosities gathered with them.

use glam::DVec3;
use nusselt::factors::{Exchange, ExchangeError, ExchangeOptions, PatchMesh, ViewedRows};
use nusselt::radiosity::{Gathered, RadiosityError, Solver, SolverOptions};
use nusselt::samples::{Kind, generate};
use nusselt::scene::{Material, Scene, SceneBuilder};
use std::f64::consts::PI;

const MOST: usize = 1 << 24;

fn exchange(mesh: &PatchMesh, tolerance: f64) -> Exchange {
    Exchange::of_mesh(mesh, ExchangeOptions { tolerance, ..ExchangeOptions::default() }).expect("patches")
}

fn viewed(exchange: &Exchange, spacing: f64) -> ViewedRows {
    exchange.viewed_rows(spacing, MOST, &|_| ()).expect("rows")
}

/// A box with its fronts inside.
fn hollow(diffuse: f64, emission: f64) -> Scene {
    walls(diffuse, emission).build().expect("a scene")
}

fn walls(diffuse: f64, emission: f64) -> SceneBuilder {
    let corner = |k: usize| [0, 1, 2].map(|axis| if k >> axis & 1 == 0 { 0.0 } else { [2.0, 3.0, 1.5][axis] });
    let vertices: Vec<[f64; 3]> = (0..8).map(corner).collect();
    let faces = [[0, 1, 3, 2], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3], [4, 6, 7, 5]];
    let material = Material { diffuse: [diffuse; 3], emission: [emission; 3], ..Material::new("even") };
    Scene::builder().mesh(&vertices, &faces.map(|face| face.to_vec()), material)
}

fn room() -> Scene {
    generate(Kind::Room, 300, 2).expect("a room").to_builder().build().expect("a scene")
}

#[test]
fn rows_come_near_integrals_and_nearer_with_more_views() {
    let scene = room();
    let (mesh, _) = PatchMesh::joined(&scene, 1.0).expect("a mesh");
    let exact = exchange(&mesh, 1e-4);
    // What is sent elsewhere than it goes, on average over all surfaces.
    let astray = |rows: &ViewedRows| {
        let (mut sum, mut areas) = (0.0, 0.0);
        for patch in (0..mesh.len()).step_by(11) {
            let row = exact.row(patch).expect("a row");
            let mut off = vec![0.0; mesh.len()];
            for entry in &row.entries {
                off[entry.column as usize] = entry.share.factor;
            }
            let found = rows.row(patch);
            for &(column, factor) in found {
                off[column as usize] -= factor;
            }
            let area = exact.patches()[patch].area;
            sum += area * off.iter().map(|off| off.abs()).sum::<f64>();
            areas += area;
            let lost = row.backs.factor + row.background.factor;
            let all: f64 = found.iter().map(|entry| entry.1).sum();
            assert!(all <= 1.0 + 1e-12 && (lost > 1e-9 || (all - 1.0).abs() < 1e-12), "{patch}: {all} {lost}");
            assert!(found.is_sorted_by_key(|entry| entry.0) && found.iter().all(|entry| entry.1 > 0.0));
        }
        sum / areas
    };
    let [few, many] = [2.0, 0.5].map(|spacing| viewed(&exact, spacing));
    assert!(few.len() == mesh.len() && few.views() < many.views() && many.views() <= 8 * mesh.len());
    let [few, many] = [few, many].map(|rows| astray(&rows));
    // Measured: 0.080 and 0.025.
    assert!(few < 0.1 && many < 0.035, "{few} {many}");
}

#[test]
fn rows_do_not_depend_on_threads() {
    let (mesh, _) = PatchMesh::joined(&room(), 1.5).expect("a mesh");
    let exchange = exchange(&mesh, 1e-3);
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| {
            let rows = viewed(&exchange, 0.7);
            let found = Gathered::new(&room(), &exchange, &rows, 1e-6).expect("radiosities");
            (rows, found)
        })
    };
    assert_eq!(with(1), with(3));
}

#[test]
fn a_furnace_is_even_to_rounding() {
    let scene = hollow(0.7, 2.0);
    let mesh = PatchMesh::new(&scene, 0.7).expect("a mesh");
    let exchange = exchange(&mesh, 1e-3);
    let (rows, mut left) = (viewed(&exchange, 0.4), Vec::new());
    let found = Gathered::watched(&scene, &exchange, &rows, 1e-14, |part| left.push(part)).expect("radiosities");
    // What all emit is as much everywhere as what all receive of it, so that one bounce tells all that follow.
    assert_eq!((found.bounces, left.len()), (2, 2));
    // Sums of some hundred factors.
    assert!((left[0] - 0.7).abs() < 1e-13 && left[1] < 1e-14, "{left:?}");
    for radiosity in found.radiosity {
        assert!((radiosity - PI * 2.0 / 0.3).abs().max_element() < 1e-10, "{radiosity}");
    }
}

/// Two boxes beside each other, of different colours, with a lamp in the first, and one in the second if that is lit; with lids, or one without.
fn two_boxes(whites: [[f64; 3]; 2], is_lit: bool, is_open: bool) -> Scene {
    let faces = [[0, 1, 3, 2], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3], [4, 6, 7, 5]];
    let mut builder = Scene::builder();
    for (k, diffuse) in whites.into_iter().enumerate() {
        let side = [2.0, 3.0, 1.5];
        let corner = |c: usize| [0, 1, 2].map(|axis| if c >> axis & 1 == 0 { 0.0 } else { side[axis] });
        let beside = |[x, y, z]: [f64; 3]| [x + 5.0 * k as f64, y, z];
        let vertices: Vec<[f64; 3]> = (0..8).map(corner).map(beside).collect();
        let walls = Material { diffuse, ..Material::new("walls") };
        let faces = &faces[..if is_open { 5 } else { 6 }];
        builder = builder.mesh(&vertices, &faces.iter().map(|face| face.to_vec()).collect::<Vec<_>>(), walls);
        if k == 0 || is_lit {
            let lamp = [[0.5, 0.5, 1.2], [0.5, 1.0, 1.2], [1.1, 1.0, 1.2], [1.1, 0.5, 1.2]].map(beside);
            // Dark itself, and of all colours but one.
            let lamp_material = Material { emission: [3.0, 1e-9, 0.0], ..Material::new("lamp") };
            builder = builder.mesh(&lamp, &[vec![0, 1, 2, 3]], lamp_material);
            // Its back would take what it gets.
            let plate = Material { diffuse, ..Material::new("plate") };
            builder = builder.mesh(&lamp, &[vec![3, 2, 1, 0]], plate);
        }
    }
    builder.build().expect("a scene")
}

/// Solves `b = e + rho F b` for one channel by elimination.
fn solved(rows: &ViewedRows, emission: &[f64], reflectance: &[f64]) -> Vec<f64> {
    let count = emission.len();
    let mut matrix: Vec<Vec<f64>> = (0..count)
        .map(|i| {
            let mut row = vec![0.0; count + 1];
            rows.row(i).iter().for_each(|&(j, f)| row[j as usize] = -reflectance[i] * f);
            row[i] += 1.0;
            row[count] = emission[i];
            row
        })
        .collect();
    for k in 0..count {
        // Rows are diagonally dominant, and stay so.
        let (above, below) = matrix.split_at_mut(k + 1);
        for row in below.iter_mut().filter(|row| row[k] != 0.0) {
            let times = row[k] / above[k][k];
            row[k..].iter_mut().zip(&above[k][k..]).for_each(|(own, other)| *own -= times * other);
        }
    }
    let mut found = vec![0.0; count];
    for k in (0..count).rev() {
        let known: f64 = (k + 1..count).map(|j| matrix[k][j] * found[j]).sum();
        found[k] = (matrix[k][count] - known) / matrix[k][k];
    }
    found
}

#[test]
fn bright_rooms_take_few_bounces_and_have_the_solution() {
    let bright = [0.99999, 0.9, 0.5];
    // The rooms, whether the second one is lit, whether they are open, and how many bounces are enough.
    let cases = [
        ([bright, [0.5; 3]], false, false, 25),
        ([bright, [0.999_99, 0.9999, 0.7]], true, false, 40),
        ([[0.5, 0.3, 0.1], [0.999_99; 3]], false, false, 25),
        ([[1.0, 0.9, 0.8], [0.7, 1.0, 0.0]], true, true, 40),
    ];
    for (whites, is_lit, is_open, most) in cases {
        let scene = two_boxes(whites, is_lit, is_open);
        let mesh = PatchMesh::new(&scene, 0.6).expect("a mesh");
        let exchange = exchange(&mesh, 1e-3);
        let rows = viewed(&exchange, 0.5);
        for until in [1e-4, 1e-10] {
            let found = Gathered::new(&scene, &exchange, &rows, until).expect("radiosities");
            assert!(found.bounces <= most, "{whites:?} {until}: {} bounces", found.bounces);
            for channel in 0..3 {
                let of_patch = |patch: usize| scene.polygon(exchange.patches()[patch].polygon).material();
                let reflectance: Vec<f64> = (0..mesh.len()).map(|patch| of_patch(patch).diffuse[channel]).collect();
                let emission: Vec<f64> = found.emission.iter().map(|e| e[channel]).collect();
                let expected = solved(&rows, &emission, &reflectance);
                let area = |patch: usize| exchange.patches()[patch].area;
                let sum = |of: &dyn Fn(usize) -> f64| (0..mesh.len()).map(|k| of(k) * area(k)).sum::<f64>();
                let whole = sum(&|k| expected[k]);
                let emitted = sum(&|k| found.emission[k].element_sum());
                let off = sum(&|k| (found.radiosity[k][channel] - expected[k]).abs());
                // What is left may bounce as often as all light does, in the brightest room; the rest is rounding, that both have.
                let reflected = reflectance.iter().copied().fold(0.0, f64::max);
                let often = if is_open { 20.0 } else { 1.0 / (1.0 - reflected) };
                let bound = until * emitted * often + 1e-15 * often * whole;
                assert!(off <= bound, "{whites:?} {channel} {until}: {off} {bound} of {whole}");
                for (patch, &least) in emission.iter().enumerate() {
                    let own = found.radiosity[patch][channel];
                    assert!(own >= least, "{patch}: {own} {least}");
                    // No light comes from one room to the other.
                    assert!(is_lit || is_open || mesh.polygon(patch).index() < 8 || own == 0.0, "{patch}: {own}");
                }
            }
        }
    }
}

#[test]
fn dim_and_bright_emissions_bounce_alike() {
    let of = |emission: f64| {
        let lamp = Material { emission: [emission, 0.5 * emission, emission], ..Material::new("lamp") };
        let vertices = [[0.5, 0.5, 1.2], [0.5, 1.0, 1.2], [1.1, 1.0, 1.2], [1.1, 0.5, 1.2]];
        let scene = walls(0.99, 0.0).mesh(&vertices, &[vec![0, 1, 2, 3]], lamp).build().expect("a scene");
        let mesh = PatchMesh::new(&scene, 0.9).expect("a mesh");
        let exchange = exchange(&mesh, 1e-3);
        Gathered::new(&scene, &exchange, &viewed(&exchange, 0.5), 1e-9).expect("radiosities")
    };
    // A power of two, but for the rounding of pi times it.
    let one = of(1.0);
    for scale in [2.0_f64.powi(-1000), 2.0_f64.powi(-520), 2.0_f64.powi(900)] {
        let other = of(scale);
        assert_eq!(one.bounces, other.bounces);
        for (own, other) in one.radiosity.iter().zip(&other.radiosity) {
            assert!((*own - *other / scale).abs().max_element() <= 1e-12 * own.max_element(), "{own} {other}");
        }
    }
}

#[test]
fn gathering_finds_what_shooting_finds() {
    let scene = room();
    let (mesh, _) = PatchMesh::joined(&scene, 1.0).expect("a mesh");
    let exchange = exchange(&mesh, 5e-3);
    let mut solver = Solver::new(&scene, &exchange, SolverOptions::default()).expect("something emits");
    solver.solve(1e-4, |_| true).expect("a solution");
    let found = Gathered::new(&scene, &exchange, &viewed(&exchange, 0.5), 1e-4).expect("radiosities");
    assert_eq!(found.emission, solver.emission());
    let (mut off, mut whole, mut powers) = (0.0, 0.0, [0.0; 2]);
    for (patch, info) in exchange.patches().iter().enumerate() {
        let emitted = found.emission[patch];
        let [shot, gathered] = [solver.radiosity()[patch], found.radiosity[patch]].map(|b| (b - emitted).element_sum());
        off += info.area * (shot - gathered).powi(2);
        whole += info.area * shot.powi(2);
        powers[0] += info.area * shot;
        powers[1] += info.area * gathered;
    }
    let (error, power) = ((off / whole).sqrt(), powers[1] / powers[0] - 1.0);
    // Measured: 0.054 and -0.004, against factors to 1e-3.
    assert!(error < 0.08 && power.abs() < 0.015, "{error} {power}");
}

#[test]
fn what_has_no_solution_is_said() {
    let white = hollow(1.0, 1.0);
    let mesh = PatchMesh::new(&white, 2.0).expect("a mesh");
    let all = exchange(&mesh, 1e-3);
    assert_eq!(all.viewed_rows(1.0, 10, &|_| ()), Err(ExchangeError::TooManyFactors { limit: 10 }));
    let rows = viewed(&all, 1.0);
    let found = Gathered::new(&white, &all, &rows, 1e-3);
    assert!(matches!(found, Err(RadiosityError::Endless { .. })), "{found:?}");
    let dark = hollow(0.5, 0.0);
    let mesh = PatchMesh::new(&dark, 2.0).expect("a mesh");
    let all = exchange(&mesh, 1e-3);
    assert_eq!(Gathered::new(&dark, &all, &viewed(&all, 1.0), 1e-3), Err(RadiosityError::Dark));
    let nothing = Scene::builder().build().expect("a scene");
    let mesh = PatchMesh::new(&nothing, 1.0).expect("a mesh");
    assert!(viewed(&exchange(&mesh, 1e-3), 1.0).is_empty());
}

#[test]
fn a_small_patch_beside_a_large_one_gets_what_it_sees() {
    // A floor that emits in one piece, and a small black tile beside one of the points that it is seen from.
    let floor = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    let at = [0.22, 0.22, 0.004];
    let tile: Vec<[f64; 3]> =
        [[0.0, 0.0], [0.0, 0.01], [0.01, 0.01], [0.01, 0.0]].map(|[x, y]| [at[0] + x, at[1] + y, at[2]]).to_vec();
    let lamp = Material { emission: [1.0; 3], ..Material::new("lamp") };
    let scene = Scene::builder()
        .mesh(&floor, &[vec![0, 1, 2, 3]], lamp)
        .mesh(&tile, &[vec![0, 1, 2, 3]], Material { diffuse: [0.5; 3], ..Material::new("tile") })
        .build()
        .expect("a scene");
    let exchange =
        Exchange::new(&scene, nusselt::factors::PatchPlan::Polygons, ExchangeOptions::default()).expect("patches");
    let found = Gathered::new(&scene, &exchange, &viewed(&exchange, 0.5), 1e-9).expect("radiosities");
    // Nearly all of what it sees is the floor; from the floor's points alone it would seem to get many times that.
    let expected = 0.5 * PI;
    assert!((found.radiosity[1] - DVec3::splat(expected)).abs().max_element() < 0.02 * expected, "{found:?}");
}

/// A bright room and a dim one beside it: each is solved to the same part of its own light.
#[test]
fn a_dim_room_is_gathered_as_if_there_were_no_bright_one() {
    let corner = |k: usize, from: f64| [0, 1, 2].map(|axis| if k >> axis & 1 == 0 { from } else { from + 2.0 });
    let faces = [[0, 1, 3, 2], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3], [4, 6, 7, 5]];
    let (dim_reflectance, dim) = (0.9, 1e-9);
    let mut builder = Scene::builder();
    for (from, diffuse, emission) in [(0.0, 0.5, 100.0), (5.0, dim_reflectance, dim)] {
        let vertices: Vec<[f64; 3]> = (0..8).map(|k| corner(k, from)).collect();
        let material = Material { diffuse: [diffuse; 3], emission: [emission; 3], ..Material::new("even") };
        builder = builder.mesh(&vertices, &faces.map(|face| face.to_vec()), material);
    }
    let scene = builder.build().expect("a scene");
    let mesh = PatchMesh::new(&scene, 1.0).expect("a mesh");
    let exchange = exchange(&mesh, 1e-3);
    let found = Gathered::new(&scene, &exchange, &viewed(&exchange, 0.5), 1e-4).expect("radiosities");
    for (patch, b) in exchange.patches().iter().zip(&found.radiosity) {
        if patch.polygon.index() >= 6 {
            let expected = PI * dim / (1.0 - dim_reflectance);
            assert!((b.x / expected - 1.0).abs() < 1e-4, "{} {expected}", b.x);
        }
    }
}
