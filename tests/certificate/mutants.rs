//! Changes to evidence: those that change what is claimed are refused by the rule that they break, the others pass.

use super::common::scenes::{Case, generated, odd, soups};
use super::common::{Faces, Random, cluttered_room};
use super::image;
use glam::DVec3;
use nusselt::contour::{Domain, Viewpoint};
use nusselt::exact::{self, CircleRelation, Kernel, Sign};
use nusselt::scene::{Material, PieceId, PolygonId, Scene, Side, Splitter};
use nusselt::verify::{Arithmetic, Defect, Evidence, EvidenceCell, EvidenceDomain, HalfSphere, Rule};

/// Evidence of a few hundred cells from scenes of all kinds.
fn subjects() -> Vec<(String, Scene, Evidence)> {
    let cases = generated(150, 1, 1).into_iter().chain(odd()).chain(soups(12));
    cases
        .map(|Case { name, scene, eyes }| {
            let evidence = image(&scene, &Viewpoint::free(eyes[0]), &Domain::Sphere).evidence();
            (name, scene, evidence)
        })
        .collect()
}

/// The defect found; both arithmetics find the same rule broken.
fn refused(scene: &Scene, evidence: &Evidence, what: &str) -> Defect {
    let [fast, slow] = [Arithmetic::Kernel, Arithmetic::Rational].map(|arithmetic| {
        evidence.check(scene, arithmetic).expect_err(&format!("{what} must be refused by {arithmetic:?}"))
    });
    assert_eq!(fast.rule(), slow.rule(), "{what}");
    fast
}

fn passes(scene: &Scene, evidence: &Evidence, what: &str) {
    for arithmetic in [Arithmetic::Kernel, Arithmetic::Rational] {
        evidence.check(scene, arithmetic).unwrap_or_else(|defect| panic!("{what}, {arithmetic:?}: {defect}"));
    }
}

/// Changes some random cell of every subject in place.
fn of_each_subject(seed: u64, mut change: impl FnMut(&Scene, &Evidence, usize, &str)) {
    let mut random = Random(seed);
    for (name, scene, evidence) in subjects() {
        for _ in 0..3 {
            change(&scene, &evidence, random.below(evidence.cells.len()), &name);
        }
    }
}

/// A normal of a splitter in floating point, for changes that make something new of it.
fn rounded(scene: &Scene, evidence: &Evidence, splitter: Splitter) -> Option<DVec3> {
    match splitter {
        Splitter::Edge([a, b]) => Some((scene.vertex(a) - evidence.eye).cross(scene.vertex(b) - evidence.eye)),
        Splitter::Points([a, b]) => Some((a - evidence.eye).cross(b - evidence.eye)),
        Splitter::Given(normal) => Some(normal),
        Splitter::Crease(_) | Splitter::Parallel(_) => None,
    }
}

/// Another normal: a component that is not the largest one step of the last place further up.
fn nudged(normal: DVec3) -> DVec3 {
    let mut normal = normal;
    let axis = (normal.abs().max_position() + 1) % 3;
    normal[axis] = normal[axis].next_up();
    normal
}

#[test]
fn a_cell_left_out_or_given_twice_unbalances_its_sides() {
    of_each_subject(1, |scene, evidence, cell, name| {
        let mut without = evidence.clone();
        without.cells.remove(cell);
        let defect = refused(scene, &without, &format!("{name}: without cell {cell}"));
        assert_eq!(defect.rule(), Rule::Balance, "{name}: {defect}");
        let mut twice = evidence.clone();
        twice.cells.push(twice.cells[cell].clone());
        let defect = refused(scene, &twice, &format!("{name}: cell {cell} twice"));
        assert_eq!(defect.rule(), Rule::Balance, "{name}: {defect}");
        let Defect::Unbalanced { count, expected: 0, cells, .. } = &defect else { panic!("{defect:?}") };
        assert!(cells.contains(&(cell as u32)) && count.abs() == 1, "{name}: {defect}");
    });
}

#[test]
fn a_flipped_cell_is_refused() {
    of_each_subject(2, |scene, evidence, cell, name| {
        let flip = |side: &mut HalfSphere| side.inside = -side.inside;
        // One side: the cell is empty, or not bounded by all of its sides.
        let mut one = evidence.clone();
        flip(&mut one.cells[cell].sides[0]);
        assert_eq!(refused(scene, &one, name).rule(), Rule::Convex, "{name}");
        // All of them: no corner is inside.
        let mut all = evidence.clone();
        all.cells[cell].sides.iter_mut().for_each(flip);
        assert_eq!(refused(scene, &all, name).rule(), Rule::Convex, "{name}");
        // And in reverse: the same cell on the other side of the sphere.
        all.cells[cell].sides.reverse();
        assert_eq!(refused(scene, &all, name).rule(), Rule::Balance, "{name}");
    });
}

#[test]
fn a_relabelled_cell_is_refused_for_its_label() {
    let mut rules = std::collections::HashMap::new();
    let mut random = Random(3);
    for (name, scene, evidence) in subjects() {
        // All cells of small scenes, among them those with coplanar, crossing and edge-on polygons.
        let few = scene.piece_count() > 12;
        let cells: Vec<usize> =
            if few { vec![random.below(evidence.cells.len())] } else { (0..evidence.cells.len()).collect() };
        let mut changed = evidence.clone();
        for cell in cells {
            let own = evidence.cells[cell].piece;
            for piece in scene.pieces().map(|piece| Some(piece.id())).chain([None]).filter(|piece| *piece != own) {
                changed.cells[cell].piece = piece;
                let defect = changed.check(&scene, Arithmetic::Kernel).expect_err(&name);
                *rules.entry(defect.rule()).or_insert(0) += 1;
                assert!(matches!(defect.rule(), Rule::Cone | Rule::Depth), "{name}: {defect}");
                assert_eq!(defect.cells(), [cell as u32], "{name}");
                if piece.is_none() {
                    assert!(matches!(defect, Defect::NotBackground { .. }), "{name}: {defect}");
                }
                if let Defect::Hidden { by, .. } = defect {
                    assert_ne!(Some(by), piece, "{name}");
                }
            }
            changed.cells[cell].piece = own;
        }
    }
    assert!(rules[&Rule::Depth] > 100 && rules[&Rule::Cone] > 1000, "{rules:?}");
}

#[test]
fn a_side_of_one_cell_moved_by_a_unit_in_the_last_place_is_refused() {
    let mut moved = 0;
    of_each_subject(4, |scene, evidence, cell, name| {
        for side in 0..evidence.cells[cell].sides.len() {
            let splitter = evidence.splitters[evidence.cells[cell].sides[side].splitter as usize];
            let Some(normal) = rounded(scene, evidence, splitter) else { continue };
            let (before, after) = (scene.resolve_splitter(splitter), exact::Splitter::Given(nudged(normal)));
            if Kernel::new([], evidence.eye).compare_circles(&before, &after) != CircleRelation::Different {
                // What was rounded before was moved back to what it was.
                continue;
            }
            let mut changed = evidence.clone();
            changed.cells[cell].sides[side].splitter = changed.splitters.len() as u32;
            changed.splitters.push(Splitter::Given(nudged(normal)));
            let defect = refused(scene, &changed, name);
            assert!(matches!(defect.rule(), Rule::Balance | Rule::Convex), "{name}: {defect}");
            moved += 1;
        }
    });
    assert!(moved > 100, "{moved}");
}

#[test]
fn a_silhouette_moved_in_all_its_cells_is_refused() {
    let mut by_labels = 0;
    for (name, scene, evidence) in subjects() {
        for (k, splitter) in evidence.splitters.iter().enumerate() {
            let (Splitter::Edge(_), Some(normal)) = (splitter, rounded(&scene, &evidence, *splitter)) else { continue };
            // Only where it parts two different labels it is a silhouette.
            let labels: Vec<_> = evidence
                .cells
                .iter()
                .filter(|cell| cell.sides.iter().any(|side| side.splitter == k as u32))
                .map(|cell| cell.piece)
                .collect();
            if labels.iter().all(|label| *label == labels[0]) {
                continue;
            }
            let mut changed = evidence.clone();
            let across = normal.normalize().any_orthonormal_vector();
            changed.splitters[k] = Splitter::Given(normal.normalize() + across * 1e-6);
            // In scenes on a grid three great circles that met in one direction no longer do.
            let Err(defect) = changed.check(&scene, Arithmetic::Kernel) else {
                panic!("{name}: silhouette {k} {splitter:?} moved, labels {labels:?}");
            };
            by_labels += usize::from(matches!(defect.rule(), Rule::Cone | Rule::Depth));
        }
    }
    assert!(by_labels > 20, "only {by_labels} were refused for what the cells show");
}

/// Two cells on the two sides of one splitter as one, if that may be convex.
fn merged(cells: [&EvidenceCell; 2]) -> Option<Vec<HalfSphere>> {
    let [first, second] = cells;
    let (i, j) = first.sides.iter().enumerate().find_map(|(i, side)| {
        let opposite = HalfSphere { inside: -side.inside, ..*side };
        second.sides.iter().position(|other| *other == opposite).map(|j| (i, j))
    })?;
    let after = |cell: &EvidenceCell, k: usize| {
        let sides = cell.sides.iter().cycle().skip(k + 1);
        sides.take(cell.sides.len() - 1).copied().collect::<Vec<_>>()
    };
    let mut all = after(first, i);
    all.extend(after(second, j));
    // Where the common side ended on one great circle that goes on, the two parts of it are one.
    all.dedup();
    if all.first() == all.last() {
        all.pop();
    }
    Some(all)
}

#[test]
fn cells_merged_across_a_silhouette_are_refused_and_others_pass() {
    let (mut across, mut within) = (0, 0);
    for (name, scene, evidence) in subjects() {
        for a in 0..evidence.cells.len().min(60) {
            for b in 0..a {
                let Some(sides) = merged([&evidence.cells[a], &evidence.cells[b]]) else { continue };
                let labels = [a, b].map(|cell| evidence.cells[cell].piece);
                let mut changed = evidence.clone();
                changed.cells[b].sides = sides;
                changed.cells.remove(a);
                match changed.check(&scene, Arithmetic::Kernel) {
                    // Not convex, or more than a whole side in common: no merger at all.
                    Err(defect) if matches!(defect.rule(), Rule::Convex | Rule::Balance) => {}
                    Err(defect) => {
                        assert!(matches!(defect.rule(), Rule::Cone | Rule::Depth), "{name}: {defect}");
                        assert_ne!(labels[0], labels[1], "{name}: {defect}");
                        across += 1;
                    }
                    Ok(_) => {
                        assert_eq!(labels[0], labels[1], "{name}: cells {a} and {b}");
                        within += 1;
                    }
                }
            }
        }
    }
    assert!(across > 30 && within > 30, "{across} across, {within} within");
}

/// The scene and one polygon more, which comes last.
fn with_one_more(loops: &[&[[f64; 3]]], last: &[[f64; 3]]) -> [Scene; 2] {
    let build = |loops: &[&[[f64; 3]]]| {
        let vertices: Vec<[f64; 3]> = loops.concat();
        let mut next = 0;
        let faces: Vec<Vec<usize>> = loops
            .iter()
            .map(|corners| {
                next += corners.len();
                (next - corners.len()..next).collect()
            })
            .collect();
        Scene::builder().mesh(&vertices, &faces, Material::new("grey")).build().expect("a valid scene")
    };
    [build(loops), build(&[loops, &[last]].concat())]
}

#[test]
fn a_polygon_left_out_whose_cells_show_what_is_behind_is_refused_for_its_depth() {
    // A wall, and a small triangle in front of it. All but E, and most rays, agree.
    let wall: &[[f64; 3]] = &[[-9.0, -9.0, 5.0], [9.0, -9.0, 5.0], [9.0, 9.0, 5.0], [-9.0, 9.0, 5.0]];
    let small: &[[f64; 3]] = &[[0.125, 0.25, 4.0], [0.126, 0.25, 4.0], [0.125, 0.251, 4.5]];
    let [without, with] = with_one_more(&[wall], small);
    let evidence = image(&without, &Viewpoint::free(DVec3::ZERO), &Domain::Sphere).evidence();
    passes(&without, &evidence, "the wall alone");
    let defect = refused(&with, &evidence, "the triangle left out");
    let Defect::Hidden { by: PieceId(1), piece: PieceId(0), towards, .. } = defect else { panic!("{defect}") };
    assert!((towards / towards.z - DVec3::new(0.030, 0.061, 1.0)).length() < 0.003, "{towards}");
    // In front of nothing it is the background that is refused.
    let [without, with] = with_one_more(&[&[[1.0, 0.0, -5.0], [2.0, 0.0, -5.0], [2.0, 1.0, -5.0]]], small);
    let evidence = image(&without, &Viewpoint::free(DVec3::ZERO), &Domain::Sphere).evidence();
    assert!(matches!(refused(&with, &evidence, "left out"), Defect::NotBackground { piece: PieceId(1), .. }));
    // And behind the wall it makes no difference.
    let hidden: &[[f64; 3]] = &[[0.125, 0.25, 6.0], [0.126, 0.25, 6.0], [0.125, 0.251, 6.5]];
    let [without, with] = with_one_more(&[wall], hidden);
    passes(&with, &image(&without, &Viewpoint::free(DVec3::ZERO), &Domain::Sphere).evidence(), "hidden");
    // Through the wall, half of it is in front.
    let through: &[[f64; 3]] = &[[0.125, 0.25, 4.0], [0.126, 0.25, 6.0], [0.125, 0.251, 6.5]];
    let [without, with] = with_one_more(&[wall], through);
    let evidence = image(&without, &Viewpoint::free(DVec3::ZERO), &Domain::Sphere).evidence();
    assert_eq!(refused(&with, &evidence, "through the wall").rule(), Rule::Depth);
}

#[test]
fn of_coplanar_polygons_only_the_right_one_is_proved() {
    // Two overlapping triangles in the slanted plane x + y + z = 6, in different definitions of that plane; and two in
    // the plane z = 3.
    let slanted: [&[[f64; 3]]; 2] =
        [&[[0.0, 0.0, 6.0], [6.0, 0.0, 0.0], [0.0, 6.0, 0.0]], &[[1.0, 1.0, 4.0], [4.0, 1.0, 1.0], [1.0, 4.0, 1.0]]];
    let level: [&[[f64; 3]]; 2] =
        [&[[0.0, 0.0, 3.0], [6.0, 0.0, 3.0], [0.0, 6.0, 3.0]], &[[1.0, 1.0, 3.0], [4.0, 1.0, 3.0], [1.0, 4.0, 3.0]]];
    let ways = [[false, false], [true, false], [false, true], [true, true]];
    for ([large, small], reversed) in [slanted, level].into_iter().flat_map(|pair| ways.map(|way| (pair, way))) {
        let mut loops = [large.to_vec(), small.to_vec()];
        loops.iter_mut().zip(reversed).filter(|(_, reversed)| *reversed).for_each(|(corners, _)| corners.reverse());
        let [_, scene] = with_one_more(&[&loops[0]], &loops[1]);
        let evidence = image(&scene, &Viewpoint::free(DVec3::ZERO), &Domain::Sphere).evidence();
        passes(&scene, &evidence, "coplanar");
        // Where the cone of the small one is filled, the other label is wrong.
        let mut changed = evidence;
        let in_both = |cell: &EvidenceCell| cell.piece == Some(PieceId(1));
        let small_wins = changed.cells.iter().any(in_both);
        let (from, to) = if small_wins { (1, 0) } else { (0, 1) };
        for cell in &mut changed.cells {
            if cell.piece == Some(PieceId(from)) {
                cell.piece = Some(PieceId(to));
            }
        }
        let rule = refused(&scene, &changed, "the other of two coplanar polygons").rule();
        assert_eq!(rule, if small_wins { Rule::Depth } else { Rule::Cone }, "{reversed:?}");
    }
}

/// The eight octants, as background.
fn octants() -> Evidence {
    let splitters = DVec3::AXES.map(Splitter::Given).to_vec();
    let sign = |negative: bool| if negative { Sign::Negative } else { Sign::Positive };
    let cells = (0..8).map(|k: u32| {
        let mut sides: Vec<HalfSphere> =
            (0..3).map(|axis| HalfSphere { splitter: axis, inside: sign(k >> axis & 1 == 1) }).collect();
        if k.count_ones() % 2 == 1 {
            sides.reverse();
        }
        EvidenceCell { piece: None, sides }
    });
    Evidence {
        eye: DVec3::ZERO,
        domain: EvidenceDomain::Sphere,
        epsilon: 0.0,
        slivers: Vec::new(),
        splitters,
        cells: cells.collect(),
    }
}

#[test]
fn a_double_cover_is_refused_though_all_its_sides_match() {
    let empty = Scene::builder().build().unwrap();
    let once = octants();
    passes(&empty, &once, "the octants");
    // Around the z axis twice: every side has a twin, and seen as a surface it is a sphere, branched at
    // two points. As cells it is all octants twice.
    let mut twice = once.clone();
    twice.cells.extend(once.cells.clone());
    let defect = refused(&empty, &twice, "the sphere twice");
    assert!(matches!(&defect, Defect::Covered { cells, expected: 1, .. } if cells.len() == 2), "{defect}");
    let nothing = Evidence { cells: Vec::new(), ..once };
    let defect = refused(&empty, &nothing, "no cells at all");
    assert!(matches!(&defect, Defect::Covered { cells, expected: 1, .. } if cells.is_empty()), "{defect}");
    for (name, scene, evidence) in subjects().into_iter().take(6) {
        let mut twice = evidence.clone();
        twice.cells.extend(evidence.cells);
        assert_eq!(refused(&scene, &twice, &name).rule(), Rule::Witness, "{name}");
    }
}

#[test]
fn another_domain_is_refused() {
    for (name, scene, evidence) in subjects() {
        let hemisphere = Evidence { domain: EvidenceDomain::Hemisphere(DVec3::Z), ..evidence.clone() };
        assert_eq!(refused(&scene, &hemisphere, &name).rule(), Rule::Balance, "{name}");
        let upper = image(&scene, &Viewpoint::free(evidence.eye), &Domain::Hemisphere(DVec3::Z)).evidence();
        let down = Evidence { domain: EvidenceDomain::Hemisphere(-DVec3::Z), ..upper.clone() };
        assert_eq!(refused(&scene, &down, &name).rule(), Rule::Balance, "{name}");
        let nudged = Evidence { domain: EvidenceDomain::Hemisphere(DVec3::new(0.0, 5e-324, 1.0)), ..upper.clone() };
        assert_eq!(refused(&scene, &nudged, &name).rule(), Rule::Balance, "{name}");
        // The length of the normal does not matter.
        passes(&scene, &Evidence { domain: EvidenceDomain::Hemisphere(DVec3::Z * 0.3), ..upper }, &name);
    }
}

#[test]
fn what_does_not_change_the_subdivision_passes() {
    let mut random = Random(7);
    for (name, scene, evidence) in subjects() {
        let mut changed = evidence.clone();
        // Another order of the cells, other starts of their boundaries, sides given in two stretches, splitters that
        // nothing uses.
        for k in (1..changed.cells.len()).rev() {
            changed.cells.swap(k, random.below(k + 1));
        }
        for cell in &mut changed.cells {
            let start = random.below(cell.sides.len());
            cell.sides.rotate_left(start);
            if random.below(3) == 0 {
                let side = cell.sides[0];
                cell.sides.insert(0, side);
            }
        }
        changed.splitters.push(Splitter::Given(DVec3::ZERO));
        changed.splitters.push(Splitter::Given(DVec3::new(1.0, 2.0, 3.0)));
        passes(&scene, &changed, &name);
        // Splitters defined with ends in the other order, and used with the other sign.
        for splitter in &mut changed.splitters {
            *splitter = match *splitter {
                Splitter::Edge([a, b]) => Splitter::Edge([b, a]),
                Splitter::Points([a, b]) => Splitter::Points([b, a]),
                Splitter::Crease([p, q]) => Splitter::Crease([q, p]),
                Splitter::Given(normal) => Splitter::Given(-normal),
                parallel @ Splitter::Parallel(_) => parallel,
            };
        }
        for side in changed.cells.iter_mut().flat_map(|cell| &mut cell.sides) {
            side.inside = -side.inside;
        }
        passes(&scene, &changed, &name);
    }
}

#[test]
fn a_quadtree_splitter_moved_in_all_its_cells_passes() {
    let mut moved = 0;
    for seed in 1..4 {
        // Seen from here no edge of the scene is in the plane of a quadtree splitter.
        let (scene, eye) = (cluttered_room(6, seed).build(), DVec3::new(0.3, 0.21, -0.17));
        let evidence = image(&scene, &Viewpoint::free(eye), &Domain::Sphere).evidence();
        for (k, splitter) in evidence.splitters.iter().enumerate() {
            let Splitter::Given(normal) = splitter else { continue };
            let mut changed = evidence.clone();
            changed.splitters[k] = Splitter::Given(*normal + DVec3::new(1e-7, -2e-7, 3e-7));
            // Others that met it in one direction may be in the way: then the tiling is refused, but never a label.
            match changed.check(&scene, Arithmetic::Kernel) {
                Ok(_) => moved += 1,
                Err(defect) => assert!(matches!(defect.rule(), Rule::Convex | Rule::Balance), "{defect}"),
            }
        }
    }
    assert!(moved > 3, "only {moved} could be moved");
}

#[test]
fn damaged_evidence_is_refused_with_a_reason() {
    let (_, scene, evidence) = subjects().swap_remove(0);
    let malformed = |change: &dyn Fn(&mut Evidence), what: &str| {
        let mut changed = evidence.clone();
        change(&mut changed);
        let defect = refused(&scene, &changed, what);
        assert!(matches!(defect, Defect::Malformed { .. }), "{what}: {defect}");
    };
    malformed(&|e| e.eye.x = f64::NAN, "eye");
    malformed(&|e| e.epsilon = f64::INFINITY, "epsilon");
    malformed(&|e| e.domain = EvidenceDomain::Hemisphere(DVec3::ZERO), "domain");
    malformed(&|e| e.splitters[0] = Splitter::Given(DVec3::NAN), "normal");
    malformed(&|e| e.splitters[0] = Splitter::Edge([0, u32::MAX].map(nusselt::scene::VertexId)), "vertex");
    malformed(&|e| e.cells[0].piece = Some(PieceId(u32::MAX)), "piece");
    malformed(&|e| e.cells[0].sides[0].splitter = u32::MAX, "splitter");
    malformed(&|e| e.cells[0].sides[0].inside = Sign::Zero, "sign");
    let mut flat = evidence.clone();
    flat.cells[0].sides.truncate(2);
    assert_eq!(refused(&scene, &flat, "two sides").rule(), Rule::Convex);
    flat.cells[0].sides.clear();
    assert_eq!(refused(&scene, &flat, "no sides").rule(), Rule::Convex);
}

#[test]
fn an_eye_behind_the_surface_it_is_said_to_be_on_is_refused() {
    let mut faces = Faces::default();
    faces.face(&[[0.0, 0.0, 1.0], [4.0, 0.0, 1.0], [0.0, 4.0, 1.0]].map(DVec3::from));
    let scene = faces.build();
    let near = DVec3::new(1.0, 1.0, 1.0);
    for (side, behind, before) in [(Side::Front, 0.5, 1.5), (Side::Back, 1.5, 0.5)] {
        let viewpoint = Viewpoint::on_surface(&scene, PolygonId(0), side, near).unwrap();
        let mut evidence = image(&scene, &viewpoint, &Domain::Above).evidence();
        passes(&scene, &evidence, "on the surface");
        evidence.eye.z = before;
        passes(&scene, &evidence, "above the surface nothing else is seen");
        evidence.eye.z = behind;
        let defect = refused(&scene, &evidence, "behind the surface");
        assert!(matches!(defect, Defect::BehindSurface { piece: PieceId(0) }), "{defect}");
    }
}

#[test]
fn a_horizon_without_cells_is_named_by_what_it_is_defined_from() {
    let mut faces = Faces::default();
    faces.face(&[[0.0, 0.0, 1.0], [4.0, 0.0, 1.0], [0.0, 4.0, 1.0]].map(DVec3::from));
    let scene = faces.build();
    let viewpoint = Viewpoint::on_surface(&scene, PolygonId(0), Side::Front, DVec3::ONE).unwrap();
    let mut evidence = image(&scene, &viewpoint, &Domain::Above).evidence();
    evidence.cells.clear();
    evidence.splitters.clear();
    let named = |evidence: &Evidence| match refused(&scene, evidence, "no cells") {
        Defect::Unbalanced { circle, count: 0, expected: 1, .. } => *circle,
        defect => panic!("{defect}"),
    };
    let plane = scene.piece(PieceId(0)).plane();
    assert_eq!(named(&evidence), Splitter::Parallel(plane));
    let normal = DVec3::new(1.0, 2.0, 5.0);
    evidence.domain = EvidenceDomain::Hemisphere(normal);
    assert_eq!(named(&evidence), Splitter::Given(normal));
}
