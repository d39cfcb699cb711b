//! scratch
use super::*;
use crate::scene::{Material, Scene};

#[test]
fn scratch() {
    // floor 12x12, wall partially hidden by block
    let mut v: Vec<[f64; 3]> = Vec::new();
    let mut f: Vec<Vec<usize>> = Vec::new();
    let mut quad = |c: [[f64; 3]; 4]| {
        let k = v.len();
        v.extend(c);
        f.push((k..k + 4).collect());
    };
    quad([[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.]]);
    quad([[4., 0., 0.], [4., 0., 2.], [4., 1., 2.], [4., 1., 0.]]);
    let quad3 = [[2., 0.3, 0.], [2., 0.3, 0.7], [2., 1., 0.7], [2., 1., 0.]];
    quad(quad3);
    let scene = Scene::builder().mesh(&v, &f, Material::new("x")).build().unwrap();
    for tolerance in [1e-3, 1e-4, 1e-5, 1e-6] {
        let e =
            Exchange::new(&scene, PatchPlan::Polygons, ExchangeOptions { tolerance, ..Default::default() }).unwrap();
        println!("{tolerance:e} {:?}", e.row(0));
    }
    panic!();
}
