//! References: closed forms from the catalogue of Howell, and cubature of the factor from a point to a polygon, where all kinks are known.

use glam::DVec3;
use std::f64::consts::{PI, TAU};

/// Directly opposed rectangles a x b at distance c (C-11).
pub(crate) fn opposed(a: f64, b: f64, c: f64) -> f64 {
    let (x, y) = (a / c, b / c);
    let (x1, y1) = ((1.0 + x * x).sqrt(), (1.0 + y * y).sqrt());
    2.0 / (PI * x * y)
        * ((x1 * y1 / (1.0 + x * x + y * y).sqrt()).ln() + x * y1 * (x / y1).atan() + y * x1 * (y / x1).atan()
            - x * x.atan()
            - y * y.atan())
}

/// From a rectangle w x l to one h x l at a right angle, along the common edge l (C-14).
pub(crate) fn perpendicular(w: f64, h: f64, l: f64) -> f64 {
    let (w, h) = (w / l, h / l);
    let (w2, h2) = (w * w, h * h);
    let logarithm = ((1.0 + w2) * (1.0 + h2) / (1.0 + w2 + h2)).ln()
        + w2 * (w2 * (1.0 + w2 + h2) / ((1.0 + w2) * (w2 + h2))).ln()
        + h2 * (h2 * (1.0 + h2 + w2) / ((1.0 + h2) * (h2 + w2))).ln();
    let diagonal = (h2 + w2).sqrt();
    (w * (1.0 / w).atan() + h * (1.0 / h).atan() - diagonal * (1.0 / diagonal).atan() + 0.25 * logarithm) / (PI * w)
}

/// From a point with a unit normal to a polygon wholly above its horizon, counter-clockwise seen from the point's side of it (Lambert).
pub(crate) fn lambert(x: DVec3, n: DVec3, polygon: &[DVec3]) -> f64 {
    let pairs = polygon.iter().zip(polygon.iter().cycle().skip(1));
    let terms = pairs.map(|(&a, &b)| {
        let (a, b) = (a - x, b - x);
        let cross = b.cross(a);
        let s = cross.length();
        if s == 0.0 { 0.0 } else { s.atan2(a.dot(b)) / s * cross.dot(n) }
    });
    terms.sum::<f64>() / TAU
}

/// Points and weights of Gauss and Legendre of order 10 on 0..1.
fn gauss() -> [(f64, f64); 10] {
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

/// The mean over the unit square, between these places.
pub(crate) fn mean(us: &[f64], vs: &[f64], f: impl Fn(f64, f64) -> f64) -> f64 {
    let mut sum = 0.0;
    for u in us.windows(2) {
        for v in vs.windows(2) {
            for (s, weight_s) in gauss() {
                for (t, weight_t) in gauss() {
                    let (width, height) = (u[1] - u[0], v[1] - v[0]);
                    sum += weight_s * weight_t * width * height * f(u[0] + s * width, v[0] + t * height);
                }
            }
        }
    }
    sum
}

/// From a regular polygon about the z axis to another one, both in planes of constant z: all sectors of the first see alike. In a sector, points are between
/// the centre and a side.
pub(crate) fn between_rings(from: &[[f64; 3]], to: &[[f64; 3]]) -> f64 {
    let target: Vec<DVec3> = to.iter().map(|&p| DVec3::from(p)).collect();
    let [a, b] = [from[0], from[1]].map(DVec3::from);
    let centre = DVec3::new(0.0, 0.0, a.z);
    let places: Vec<f64> = (0..=8).map(|k| f64::from(k) / 8.0).collect();
    // The area grows with the distance from the centre.
    mean(&places, &[0.0, 1.0], |s, t| 2.0 * s * lambert(centre.lerp(a.lerp(b, t), s), DVec3::Z, &target).abs())
}

/// Places from 0 to 1 that come closer and closer to both ends, to where a function of the distance is smooth between them.
pub(crate) fn graded() -> Vec<f64> {
    let halves = (0..40).map(|k| 0.5_f64.powi(40 - k));
    let low: Vec<f64> = std::iter::once(0.0).chain(halves).collect();
    let high = low.iter().rev().skip(1).map(|x| 1.0 - x);
    low.iter().copied().chain(high).collect()
}

/// A rectangle in a plane of constant z: x from, x to, y from, y to.
type Extent = [f64; 4];

fn corners([x0, x1, y0, y1]: Extent, z: f64) -> [DVec3; 4] {
    [[x0, y0], [x1, y0], [x1, y1], [x0, y1]].map(|[x, y]| DVec3::new(x, y, z))
}

/// From a rectangle at height 0 to one at height `top`, with one at height `middle` between, all parallel to the axes.
pub(crate) fn behind_a_plate(from: Extent, blocker: Extent, middle: f64, to: Extent, top: f64) -> f64 {
    let whole = corners(to, top);
    over_shadows(from, blocker, middle, to, top, |x, shadow| {
        (lambert(x, DVec3::Z, &whole) - lambert(x, DVec3::Z, shadow)).abs()
    })
}

/// The mean over a rectangle of a function of a point and of the shadow there, of one on another one: the shadow from each point
/// is a rectangle again, and it comes over the edges of the receiver where the emitter's points are on known lines.
pub(crate) fn over_shadows(
    from: Extent,
    blocker: Extent,
    middle: f64,
    to: Extent,
    top: f64,
    visible: impl Fn(DVec3, &[DVec3]) -> f64,
) -> f64 {
    let ratio = top / middle;
    let places = |k: usize| {
        let (low, high) = (from[2 * k], from[2 * k + 1]);
        // x + (b - x) ratio = t.
        let crossing = |b: f64, t: f64| (b * ratio - t) / (ratio - 1.0);
        let mut places = vec![low, high];
        for b in &blocker[2 * k..2 * k + 2] {
            places.extend(to[2 * k..2 * k + 2].iter().map(|&t| crossing(*b, t)).filter(|p| (low..high).contains(p)));
        }
        places.sort_by(f64::total_cmp);
        // In four parts each, so that the rule of 10 points has all its digits.
        let quarters = |pair: &[f64]| [0.0, 0.25, 0.5, 0.75].map(|t| pair[0] + (pair[1] - pair[0]) * t);
        let mut fine: Vec<f64> = places.windows(2).flat_map(quarters).collect();
        fine.push(high);
        fine.iter().map(|p| (p - low) / (high - low)).collect::<Vec<f64>>()
    };
    mean(&places(0), &places(1), |u, v| {
        let x = DVec3::new(from[0] + u * (from[1] - from[0]), from[2] + v * (from[3] - from[2]), 0.0);
        let shadow: Extent = std::array::from_fn(|k| {
            let (x, b) = (x[k / 2], blocker[k]);
            (x + (b - x) * ratio).clamp(to[k / 2 * 2], to[k / 2 * 2 + 1])
        });
        visible(x, &corners(shadow, top))
    })
}
