//! Integrals of BRDF times cosine times radiance over convex spherical polygons, each form in its own way.

use super::seen::Seen;
use super::{Form, Lobe, Range, RgbEstimate};
use crate::integral::{
    Cap, Cubature, CubatureOptions, Harmonics, Peak, Receiver, Smoothness, Weight, ZonalSum, clip, double_axis_moment,
    form_factor, perimeter, solid_angle, unit_outline,
};
use glam::{DMat3, DVec3};
use std::f64::consts::{PI, TAU};
use std::ops::{AddAssign, Mul};

impl AddAssign for RgbEstimate {
    fn add_assign(&mut self, other: Self) {
        self.value += other.value;
        self.error += other.error;
    }
}

/// Times colours that are not negative.
impl Mul<DVec3> for RgbEstimate {
    type Output = Self;

    fn mul(self, factor: DVec3) -> Self {
        Self { value: self.value * factor, error: self.error * factor }
    }
}

/// A convex polygon of directions in the surface's frame, and the radiance that comes from it.
pub(super) struct Lit {
    outline: Vec<DVec3>,
    radiance: DVec3,
}

/// What of a polygon is above the horizon; `None` if nothing is.
pub(super) fn above_horizon(boundary: &[DVec3]) -> Option<Vec<DVec3>> {
    // Most are outlines as they are: unit vectors but for rounding.
    let next = boundary.iter().cycle().skip(1);
    let is_outline = boundary.iter().zip(next).all(|(a, b)| a.z > 0.0 && a != b && a.dot(*b) >= 0.0);
    if is_outline && boundary.len() > 2 {
        return Some(boundary.to_vec());
    }
    let outline = clip(&unit_outline(boundary), DVec3::Z);
    (outline.len() > 2).then_some(outline)
}

impl Lit {
    /// What of a polygon is above the horizon; `None` if nothing is.
    pub(super) fn new(boundary: &[DVec3], radiance: DVec3) -> Option<Self> {
        Some(Self { outline: above_horizon(boundary)?, radiance })
    }
}

/// All that light comes from.
pub(super) struct Surroundings<'a> {
    pub(super) lit: &'a [Lit],
    /// The radiance from one direction.
    pub(super) from: &'a dyn Fn(DVec3) -> RgbEstimate,
}

/// The radiance reflected towards `outgoing` by a BRDF of that form and with those values by incoming direction.
pub(super) fn reflect(
    form: Form<'_>,
    eval: &dyn Fn(DVec3) -> DVec3,
    outgoing: DVec3,
    surroundings: &Surroundings<'_>,
    options: CubatureOptions,
) -> RgbEstimate {
    match form {
        Form::Lobes(lobes) => {
            let mut sum = RgbEstimate::default();
            for lobe in lobes {
                sum += of_lobe(&lobe, surroundings.lit, options);
            }
            sum
        }
        Form::Harmonics(series) => of_harmonics(&series, surroundings.lit, options),
        Form::Transformed { inverse, weight, distance, range } => {
            of_transformed_cosine(inverse, weight, (distance, &*range), surroundings.lit)
        }
        Form::Dirac { direction, reflectance } => (surroundings.from)(direction) * reflectance,
        Form::Sum(parts) => {
            let mut sum = RgbEstimate::default();
            for part in parts {
                let eval = |incoming| part.eval(incoming, outgoing);
                sum += reflect(part.form(outgoing), &eval, outgoing, surroundings, options);
            }
            sum
        }
        Form::General { peaks, creases, smoothness } => {
            by_cubature(eval, (&peaks, &creases, smoothness), constant(surroundings.lit), options)
        }
    }
}

/// The same from what varies. A mirror looks it up with the rest.
pub(super) fn reflect_varying(
    form: Form<'_>,
    eval: &dyn Fn(DVec3) -> DVec3,
    outgoing: DVec3,
    seen: &Seen,
    options: CubatureOptions,
) -> RgbEstimate {
    match form {
        Form::Dirac { .. } => RgbEstimate::default(),
        Form::Sum(parts) => {
            let mut sum = RgbEstimate::default();
            for part in parts {
                let eval = |incoming| part.eval(incoming, outgoing);
                sum += reflect_varying(part.form(outgoing), &eval, outgoing, seen, options);
            }
            sum
        }
        Form::Lobes(lobes) => {
            let peaks: Vec<Peak> = lobes.iter().filter(|lobe| lobe.power > 0).map(Lobe::peak).collect();
            let creases: Vec<DVec3> = peaks.iter().map(|peak| peak.axis).collect();
            varying_by_cubature(seen, eval, (&peaks, &creases, Smoothness::Smooth), options)
        }
        Form::Harmonics(series) => {
            let waves = Smoothness::Waves { band: series.band().saturating_add(1) };
            varying_by_cubature(seen, eval, (&[], &[], waves), options)
        }
        Form::Transformed { inverse, distance, .. } => {
            // The lobe is about what is turned to z, and not narrower than this.
            let axis = inverse.inverse() * DVec3::Z;
            let narrowest = 1.0 / (frobenius(inverse) * axis.length());
            let peaks = [Peak { axis, width: narrowest.min(1.0) }];
            let mut sum = varying_by_cubature(seen, eval, (&peaks, &[], Smoothness::Smooth), options);
            let most = seen.linear.iter().map(|(_, linear)| linear.most());
            let most = most.chain(seen.skies.iter().map(|(sky, _)| sky.most()));
            sum.error += distance * most.fold(DVec3::ZERO, DVec3::max);
            sum
        }
        Form::General { peaks, creases, smoothness } => {
            varying_by_cubature(seen, eval, (&peaks, &creases, smoothness), options)
        }
    }
}

fn varying_by_cubature(
    seen: &Seen,
    eval: &dyn Fn(DVec3) -> DVec3,
    (peaks, creases, smoothness): Shape<'_>,
    options: CubatureOptions,
) -> RgbEstimate {
    let mut sum = RgbEstimate::default();
    if !seen.linear.is_empty() {
        let parts = seen.linear.iter().map(|(outline, linear)| (&outline[..], Weight::Linear(*linear)));
        sum += by_cubature(eval, (peaks, creases, smoothness), parts, options);
    }
    for (sky, outlines) in &seen.skies {
        let peaks: Vec<Peak> = peaks.iter().copied().chain(sky.peak()).collect();
        let product = |incoming| eval(incoming) * sky.radiance(incoming);
        let parts = outlines.iter().map(|outline| (&outline[..], Weight::Constant(DVec3::ONE)));
        sum += by_cubature(&product, (&peaks, creases, smoothness), parts, options);
    }
    sum
}

/// By moments; by cubature where the bound on their error, which is absolute, is more than what is allowed and than cubature's.
fn of_lobe(lobe: &Lobe, lit: &[Lit], options: CubatureOptions) -> RgbEstimate {
    let mut sum = RgbEstimate::default();
    let receiver = Receiver::new(DVec3::Z);
    let mut corners = Vec::new();
    for part in lit {
        let (value, error) = if lobe.power == 0 {
            let factor = receiver.factor_of(part.outline.iter().copied(), &mut corners);
            // No arc is longer than 90 degrees, nor 1.12 times its chord.
            let rim: f64 = corners.windows(2).map(|ends| 1.12 * ends[0].distance(ends[1])).sum();
            // As both ways to compute it are off at most (docs/integrals.md), and for corners rounded to units of f64.
            let error = 4e-16 * PI * (factor + rim * rim.min(PI)) + 3.0 * f64::EPSILON * rim;
            (PI * factor, error)
        } else {
            // Of the lobe's tail a bound is enough.
            let [_, largest] = Cap::around(&part.outline).cosines(lobe.axis);
            let bound = TAU * largest.max(0.0).powi(i32::from(lobe.power));
            if bound < NOTHING {
                (0.0, bound)
            } else {
                let moment = double_axis_moment(&part.outline, lobe.axis, lobe.power, DVec3::Z);
                (moment.value, moment.error)
            }
        };
        sum += RgbEstimate { value: DVec3::splat(value), error: DVec3::splat(error) } * (part.radiance * lobe.weight);
    }
    let allowed = options.absolute.max(options.relative * sum.value.max_element());
    if lobe.power == 0 || sum.error.max_element() <= allowed {
        return sum;
    }
    let shape: Shape<'_> = (&[lobe.peak()], &[lobe.axis], Smoothness::Smooth);
    let other = by_cubature(&|incoming| lobe.eval(incoming), shape, constant(lit), options);
    if other.error.max_element() < sum.error.max_element() { other } else { sum }
}

/// A moment below that is not computed: less than the error of one that is.
const NOTHING: f64 = 1e-18;

/// By zonal integrals; by cubature where the bound on their error is more than what is allowed and than cubature's.
fn of_harmonics(series: &Harmonics, lit: &[Lit], options: CubatureOptions) -> RgbEstimate {
    let mut closed = None;
    if let Some(zonal) = ZonalSum::new(&series.times_z()) {
        let mut sum = RgbEstimate::default();
        for part in lit {
            let integral = zonal.integral(&part.outline);
            sum += RgbEstimate { value: integral.value, error: integral.error } * part.radiance;
        }
        let allowed = options.absolute.max(options.relative * sum.value.abs().max_element());
        if sum.error.max_element() <= allowed {
            return sum;
        }
        closed = Some(sum);
    }
    let waves = Smoothness::Waves { band: series.band().saturating_add(1) };
    let other = by_cubature(&|incoming| series.eval(incoming), (&[], &[], waves), constant(lit), options);
    closed.filter(|closed| closed.error.max_element() <= other.error.max_element()).unwrap_or(other)
}

/// By the form factors of transformed polygons (Heitz, Dupuy, Hill and Neubelt, "Real-time polygonal-light shading with linearly transformed cosines", 2016).
///
/// Polygons do not overlap, so the distance to what the cosine stands for counts once, with the brightest of them. Or what each of them reflects is bounded by
/// the range of the true values over it, if that tells more.
fn of_transformed_cosine(
    inverse: DMat3,
    weight: DVec3,
    (distance, range): (DVec3, &Range<'_>),
    lit: &[Lit],
) -> RgbEstimate {
    // By how much a turn of a direction, such as a corner's rounding, may grow.
    let growth = frobenius(inverse) * frobenius(inverse.inverse());
    let mut sum = RgbEstimate::default();
    let (mut brightest, mut one_by_one) = (DVec3::ZERO, DVec3::ZERO);
    for part in lit {
        let moved: Vec<DVec3> = part.outline.iter().map(|&corner| inverse * corner).collect();
        let outline = clip(&unit_outline(&moved), DVec3::Z);
        let rounding = f64::EPSILON * (1.0 + (4.0 + growth) * perimeter(&outline));
        let factor =
            RgbEstimate { value: DVec3::splat(form_factor(&outline, DVec3::Z)), error: DVec3::splat(rounding) };
        sum += factor * (weight * part.radiance);
        brightest = brightest.max(part.radiance);
        let omega = solid_angle(&part.outline);
        let [least, most] = range(&part.outline).map(|value| value * omega);
        let value = weight * factor.value;
        one_by_one += (most - value).max(value - least) * part.radiance;
    }
    sum.error += (distance * brightest).min(one_by_one);
    sum
}

/// A bound on how much a matrix stretches.
fn frobenius(m: DMat3) -> f64 {
    m.to_cols_array().iter().map(|v| v * v).sum::<f64>().sqrt()
}

/// Where a function is large, normals of great circles at which it has kinks, and whether it has others.
type Shape<'a> = (&'a [Peak], &'a [DVec3], Smoothness);

/// Polygons with what they are weighted by.
fn constant(lit: &[Lit]) -> impl Iterator<Item = (&[DVec3], Weight)> {
    lit.iter().map(|part| (&part.outline[..], Weight::Constant(part.radiance)))
}

fn by_cubature<'a>(
    eval: &dyn Fn(DVec3) -> DVec3,
    (peaks, creases, smoothness): Shape<'_>,
    parts: impl Iterator<Item = (&'a [DVec3], Weight)>,
    options: CubatureOptions,
) -> RgbEstimate {
    let mut cubature = Cubature::new(|incoming: DVec3| eval(incoming) * incoming.z.max(0.0), peaks, smoothness);
    for (outline, weight) in parts {
        let mut outlines = vec![outline.to_vec()];
        for &crease in creases {
            outlines = outlines.iter().flat_map(|outline| [clip(outline, crease), clip(outline, -crease)]).collect();
        }
        for outline in &outlines {
            cubature.add_weighted(outline, weight);
        }
    }
    let integral = cubature.run(options);
    RgbEstimate { value: integral.value, error: integral.error }
}

/// The radiance reflected from a white hemisphere.
pub(super) fn white_furnace(
    form: Form<'_>,
    eval: &dyn Fn(DVec3) -> DVec3,
    outgoing: DVec3,
    options: CubatureOptions,
) -> RgbEstimate {
    let hemisphere = [DVec3::X, DVec3::Y, DVec3::NEG_X, DVec3::NEG_Y];
    let lit: Vec<Lit> = Lit::new(&hemisphere, DVec3::ONE).into_iter().collect();
    let white = |_| RgbEstimate { value: DVec3::ONE, error: DVec3::ZERO };
    reflect(form, eval, outgoing, &Surroundings { lit: &lit, from: &white }, options)
}
