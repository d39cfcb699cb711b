//! Brute force for tests: product rules on fine triangles, the finer the nearer to an axis.

use super::clip::unit_outline;
use glam::DVec3;

/// Ten points and weights of Gauss and Legendre on 0..1.
pub(crate) fn gauss() -> [(f64, f64); 10] {
    let half = [
        (0.148_874_338_981_631_2, 0.295_524_224_714_752_87),
        (0.433_395_394_129_247_2, 0.269_266_719_309_996_4),
        (0.679_409_568_299_024_4, 0.219_086_362_515_982_04),
        (0.865_063_366_688_984_5, 0.149_451_349_150_580_6),
        (0.973_906_528_517_171_7, 0.066_671_344_308_688_14),
    ];
    std::array::from_fn(|k| {
        let (x, weight) = half[k / 2];
        (if k % 2 == 0 { 0.5 + 0.5 * x } else { 0.5 - 0.5 * x }, 0.5 * weight)
    })
}

/// The integral of `f` over a polygon, by 100 points in every triangle: one may be as long as a third of `width` plus
/// its distance from `axis`, and 0.3.
pub(crate) fn brute(boundary: &[DVec3], axis: DVec3, width: f64, f: &impl Fn(DVec3) -> DVec3) -> DVec3 {
    let outline = unit_outline(boundary);
    if outline.is_empty() {
        return DVec3::ZERO;
    }
    let middle = outline.iter().sum::<DVec3>();
    assert!(middle.length() > 1e-6, "a whole hemisphere has to be cut first");
    let middle = middle.normalize();
    let arcs = (0..outline.len()).map(|k| [outline[k], outline[(k + 1) % outline.len()]]);
    arcs.map(|[a, b]| triangle([middle, a, b], axis.normalize(), width, f)).sum()
}

fn triangle([a, b, c]: [DVec3; 3], axis: DVec3, width: f64, f: &impl Fn(DVec3) -> DVec3) -> DVec3 {
    let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
    let centre = (a + b + c) / 3.0;
    if longest > 0.3 || longest > (width + (centre.distance(axis) - longest).max(0.0)) / 3.0 {
        let [d, e, g] = [(a + b).normalize(), (b + c).normalize(), (c + a).normalize()];
        return [[a, d, g], [d, b, e], [g, e, c], [d, e, g]].map(|part| triangle(part, axis, width, f)).iter().sum();
    }
    over_triangle([a, b, c], f)
}

/// The integral of a function over a spherical triangle by 100 points.
pub(crate) fn over_triangle([a, b, c]: [DVec3; 3], f: &impl Fn(DVec3) -> DVec3) -> DVec3 {
    let area = a.dot((b - a).cross(c - a));
    let mut sum = DVec3::ZERO;
    for (s, weight_s) in gauss() {
        for (t, weight_t) in gauss() {
            let p = a + (b - a) * (s * (1.0 - t)) + (c - a) * (s * t);
            let length = p.length();
            sum += f(p / length) * (weight_s * weight_t * s / length.powi(3));
        }
    }
    sum * area
}
