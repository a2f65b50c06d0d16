//! Simple shapes that explain a recording as well as the free contour does.
//!
//! Near the best contour the cost is a quadratic form of its offsets, so the best shape of a kind costs no evaluation of the model. What it comes to is
//! then looked at with the model itself.

use super::curve::Curve;
use super::family::{Family, Place, ShapeKind, in_order};
use super::knowledge::Knowledge;
use super::prior::Prior;
use super::problem::Fit;
use super::verdict::{Goodness, UNLIKELY, probability};
use crate::least_squares::{Damped, NormalMatrix, Problem, iterate};
use nalgebra::{DMatrix, DVector, Vector2};
use rod_core::PhysicalRod;
use std::ops::Range;

/// Step of differences by the parameters, rod lengths or radians.
const STEP: f64 = 1e-6;
/// Most steps of the search, and the relative decrease of the cost at which it has settled.
const STEPS: usize = 60;
const SETTLED: f64 = 1e-6;
/// Most times that the quadratic form is made anew at the shape that was found, and the decrease of chi squared at which it need not be.
const ROUNDS: usize = 8;
const GAIN: f64 = 0.05;
/// Chi squared over the number of residuals of a shape that may explain them, by the first form, and the ratio by which what it has more than the free contour falls
/// from one to the next.
const MOST: f64 = 1000.0;
const HOPEFUL: f64 = 2.0;
/// Standard deviations by which the size of a curve must differ from 0, and which the extent of what is touched must have of each place, radius and (per
/// radian) rotation. Smaller: shapes are reported that the recording does not determine.
const KNOWN: f64 = 3.0;

/// A simple shape that explains what a recording tells of a part of the contour.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SimpleShape {
    /// Number of the object of the fit, from 0.
    pub object: usize,
    /// The points of the object of which it tells: all that are touched, or a run of these.
    pub points: Range<usize>,
    /// What it is.
    pub kind: ShapeKind,
    /// Its parameters with their standard deviations, named as the fields of scene files; m, 1/m and rad. `points` of straight edges are their vertices and the
    /// ends of what is touched of them.
    pub parameters: Vec<(String, f64, f64)>,
    /// By how much chi squared is larger than that of the free contour, and the probability of so much or more for the unknowns that it saves.
    pub chi_squared: f64,
    /// See `chi_squared`.
    pub p_value: f64,
    /// Bayesian information criterion (Schwarz 1978) less that of the best one for these points; 0 for the best.
    pub evidence: f64,
}

impl SimpleShape {
    /// For a rod that is longer by a factor.
    pub(super) fn scaled(mut self, longer: f64) -> Self {
        for (name, value, sigma) in &mut self.parameters {
            let factor = longer.powi(power_of(name));
            (*value, *sigma) = (*value * factor, *sigma * factor);
        }
        self
    }
}

/// The power of the length in the unit of a parameter.
fn power_of(name: &str) -> i32 {
    match name {
        "rotation" => 0,
        "coefficient" => -1,
        _ => 1,
    }
}

/// Whether a parameter is the size of a curve.
fn is_size(name: &str) -> bool {
    ["radius", "radii[0]", "radii[1]", "coefficient"].contains(&name)
}

/// Whether a recording determines a parameter of a shape of which it tells a part of this extent (m).
///
/// The size of a curve must differ from 0. A centre, vertex, corner or radius must be known better than the extent of the part: on a short stretch many
/// curves explain the recording as well as each other, with centres far beyond it, and the best one says nothing of the object. So must a rotation, which
/// moves the ends of the part by as much.
fn is_determined((name, value, sigma): &(String, f64, f64), extent: f64) -> bool {
    let most = match power_of(name) {
        0 => 1.0,
        1 => extent,
        // nothing but the size itself compares with a curvature
        _ => f64::INFINITY,
    };
    KNOWN * sigma < most && (!is_size(name) || value.abs() > KNOWN * sigma)
}

/// The best contour of a fit.
pub(super) struct Best<'a> {
    pub x: &'a DVector<f64>,
    pub covariance: &'a DMatrix<f64>,
    pub goodness: &'a Goodness,
    /// Number of residuals.
    pub residuals: f64,
    pub known: &'a [Vec<Knowledge>],
}

/// A chain of the contour, or the part of it around a run of touched nodes.
struct Part {
    object: usize,
    /// The touched nodes, from the first to after the last.
    touched: Range<usize>,
    /// The whole contour.
    curve: Curve,
    places: Vec<Place>,
    unknowns: Vec<usize>,
}

/// What the recording tells of the unknowns of a part near a contour, in rod lengths.
struct Near {
    /// Half of the first and the second derivatives of the cost by the unknowns, where the others follow them; without the smoothness of the part.
    gradient: DVector<f64>,
    information: DMatrix<f64>,
    /// How the others follow.
    others: Vec<usize>,
    follow: (DVector<f64>, DMatrix<f64>),
    /// Cost of the blocks.
    cost: f64,
}

impl<R: PhysicalRod> Fit<'_, R> {
    /// The simple shapes that explain each object, the best first; where none does, those that explain runs of its touched nodes. The fit has the best
    /// contour and its states.
    pub fn shapes(&self, best: &Best<'_>) -> Vec<SimpleShape> {
        let of = |object: usize| {
            let runs = runs(&best.known[object]);
            let whole = runs.first()?.start..runs.last()?.end;
            let shapes = self.shapes_of(best, object, &whole);
            let is_done = !shapes.is_empty() || runs.len() == 1;
            let of_runs = || runs.iter().flat_map(|run| self.shapes_of(best, object, run)).collect();
            Some(if is_done { shapes } else { of_runs() })
        };
        (0..best.known.len()).filter_map(of).flatten().collect()
    }

    /// The simple shapes that explain some touched nodes, the best first.
    fn shapes_of(&self, best: &Best<'_>, object: usize, touched: &Range<usize>) -> Vec<SimpleShape> {
        let Some(part) = self.part(best, best.x, object, touched) else { return Vec::new() };
        let Some(near) = self.near(best.x, &part) else { return Vec::new() };
        let determined = self.determined(best, &part);
        let kinds = [ShapeKind::Line, ShapeKind::Polygon, ShapeKind::Arc, ShapeKind::Parabola, ShapeKind::Ellipse];
        let mut found: Vec<SimpleShape> =
            kinds.into_iter().filter_map(|kind| self.shape(best, (&near, determined), &part, kind)).collect();
        found.sort_by(|a, b| a.evidence.total_cmp(&b.evidence));
        let least = found.first().map_or(0.0, |shape| shape.evidence);
        found.iter_mut().for_each(|shape| shape.evidence -= least);
        found
    }

    /// Touched nodes of an object of the contour with unknowns `x`, and those around them that are not.
    fn part(&self, best: &Best<'_>, x: &DVector<f64>, object: usize, touched: &Range<usize>) -> Option<Part> {
        let length = self.rod.units().length;
        let curve = self.curve.moved(x.rows(0, self.curve.count()).into_owned())?;
        let chain: Vec<_> = curve.chains().nth(object)?.collect();
        let is_touched = |k: &usize| best.known[object][*k].sigma().is_some();
        let first = (0..touched.start).rev().find(is_touched).map_or(0, |k| k + 1);
        let last = (touched.end..chain.len()).find(is_touched).unwrap_or(chain.len());
        let (mut places, mut unknowns) = (Vec::new(), Vec::new());
        for k in first..last {
            let (node, here) = chain[k];
            let (ways, unknown) = curve.ways_of(node);
            let along = chain[(k + 1).min(chain.len() - 1)].1.at - chain[k.saturating_sub(1)].1.at;
            let normal = if let [way] = ways { *way } else { Vector2::new(-along.y, along.x).try_normalize(0.0)? };
            places.push(Place {
                at: here.at / length,
                ways: ways.to_vec(),
                normal,
                is_vertex: here.is_vertex,
                is_touched: is_touched(&k),
            });
            unknowns.extend(unknown..unknown + ways.len());
        }
        Some(Part { object, touched: touched.clone(), curve, places, unknowns })
    }

    /// The cost near the unknowns `x`, which are those of a part and others.
    fn near(&self, x: &DVector<f64>, part: &Part) -> Option<Near> {
        let (normal, prior) = (self.clone().equations(x), Prior::of(x, &part.curve).at(self.bend));
        let own = &part.unknowns;
        let others: Vec<usize> = (0..x.len()).filter(|i| !own.contains(i)).collect();
        // the smoothness of the part is not asked for
        let matrix = &normal.matrix - &prior.matrix;
        let slope = &normal.gradient - &prior.gradient;
        let block = |of: &DMatrix<f64>, rows: &[usize], columns: &[usize]| of.select_rows(rows).select_columns(columns);
        let across = block(&matrix, &others, own);
        let kept = block(&normal.matrix, &others, &others).cholesky()?;
        let follow = (-kept.solve(&normal.gradient.select_rows(&others)), -kept.solve(&across));
        let length = self.rod.units().length;
        let gradient = slope.select_rows(own) + across.transpose() * &follow.0;
        let information = block(&matrix, own, own) + across.transpose() * &follow.1;
        Some(Near {
            gradient: gradient * length,
            information: information * (length * length),
            others,
            follow: (follow.0, follow.1 * length),
            cost: normal.cost - prior.cost,
        })
    }

    /// Number of unknowns of a part that the recording determines, not its smoothness alone.
    fn determined(&self, best: &Best<'_>, part: &Part) -> f64 {
        let told = best.covariance * Prior::of(best.x, &part.curve).at(self.bend).matrix;
        part.unknowns.iter().map(|i| 1.0 - told[(*i, *i)]).sum()
    }

    /// The best shape of a kind, if it explains a part, of which so many unknowns are determined.
    fn shape(
        &self,
        best: &Best<'_>,
        (near, determined): (&Near, f64),
        part: &Part,
        kind: ShapeKind,
    ) -> Option<SimpleShape> {
        let each = best.residuals.ln();
        let mut found = Found::simplest(Family::of(kind, &part.places)?, near, each)?;
        let free = found.parameters.len() as f64;
        let freedom = (determined - free).max(1.0);
        // far off the quadratic form is a rough one, and is soon a better one
        let is_hopeful = |found: &Found, before: f64| {
            let more = found.cost - near.cost;
            probability(more, freedom, best.goodness.noise_spread) >= UNLIKELY || more < (before - near.cost) / HOPEFUL
        };
        if !is_hopeful(&found, MOST * best.residuals) {
            return None;
        }
        let mut x = self.moved(best.x, near, part, &found)?;
        for _ in 0..ROUNDS {
            let there = self.part(best, &x, part.object, &part.touched)?;
            let closer = self.near(&x, &there)?;
            let next = found.again(&there.places, &closer)?;
            if !is_hopeful(&next, found.cost) {
                return None;
            }
            x = self.moved(&x, &closer, &there, &next)?;
            let gain = closer.cost - next.cost;
            found = next;
            if gain < GAIN {
                break;
            }
        }
        let explained = self.explained(&self.model(&x)?);
        let others = best.residuals - best.goodness.degrees_of_freedom - determined;
        let goodness = Goodness::of(&explained, &self.blocks.blocks, others + free, best.goodness.farthest_error);
        let chi_squared = goodness.chi_squared - best.goodness.chi_squared;
        let p_value = probability(chi_squared, freedom, best.goodness.noise_spread);
        let there = self.part(best, &x, part.object, &part.touched)?;
        let family = found.family(&there.places);
        let parameters = found.named(&family, self.rod.units().length)?;
        let extent = family.extent() * self.rod.units().length;
        let is_one = p_value >= UNLIKELY
            && goodness.explains
            && family.is_shape(&found.parameters)
            && parameters.iter().all(|parameter| is_determined(parameter, extent));
        let (object, points) = (part.object, part.touched.clone());
        let evidence = chi_squared + free * each;
        is_one.then_some(SimpleShape { object, points, kind, parameters, chi_squared, p_value, evidence })
    }

    /// The unknowns `x`, moved so that a part is on a shape, and the others follow.
    fn moved(&self, x: &DVector<f64>, near: &Near, part: &Part, found: &Found) -> Option<DVector<f64>> {
        let length = self.rod.units().length;
        let offsets = DVector::from_vec(found.family(&part.places).offsets(&found.parameters)?);
        let mut x = x.clone();
        part.unknowns.iter().zip(&offsets).for_each(|(i, offset)| x[*i] += offset * length);
        let follow = &near.follow.0 + &near.follow.1 * &offsets;
        near.others.iter().zip(&follow).for_each(|(i, offset)| x[*i] += offset);
        Some(x)
    }
}

/// Runs of nodes that are touched.
fn runs(known: &[Knowledge]) -> Vec<Range<usize>> {
    let mut runs: Vec<Range<usize>> = Vec::new();
    for k in (0..known.len()).filter(|k| known[*k].sigma().is_some()) {
        match runs.last_mut().filter(|run| run.end == k) {
            Some(run) => run.end = k + 1,
            None => runs.push(k..k + 1),
        }
    }
    runs
}

/// The best shape of a family.
struct Found {
    kind: ShapeKind,
    corners: Vec<usize>,
    parameters: DVector<f64>,
    covariance: DMatrix<f64>,
    cost: f64,
}

impl Found {
    /// Of a family without the corners that are not worth what `each` parameter costs.
    fn simplest(family: Family<'_>, near: &Near, each: f64) -> Option<Self> {
        let value = |found: &Self| found.cost + found.parameters.len() as f64 * each;
        let (mut found, mut family) = (Self::of(&family, near)?, family);
        loop {
            let simpler = family.simpler().filter_map(|family| Some((Self::of(&family, near)?, family)));
            match simpler.min_by(|a, b| value(&a.0).total_cmp(&value(&b.0))) {
                Some(simpler) if value(&simpler.0) < value(&found) => (found, family) = simpler,
                _ => return Some(found),
            }
        }
    }

    fn of(family: &Family<'_>, near: &Near) -> Option<Self> {
        let starts = family.starts().into_iter();
        starts.filter_map(|start| Self::from(family, near, start)).min_by(|a, b| a.cost.total_cmp(&b.cost))
    }

    fn from(family: &Family<'_>, near: &Near, start: DVector<f64>) -> Option<Self> {
        let mut quadratic = Quadratic { family, near };
        let found = iterate(&mut quadratic, start, Damped::until(SETTLED), STEPS).0.x;
        let parameters = in_order(family.kind, found);
        let equations = quadratic.equations(&parameters);
        let (cost, covariance) = (equations.cost, equations.covariance()?);
        let (kind, corners) = (family.kind, family.corners.clone());
        cost.is_finite().then_some(Self { kind, corners, parameters, covariance, cost })
    }

    /// The best one of the same kind for places that are on this one.
    fn again(&self, places: &[Place], near: &Near) -> Option<Self> {
        let family = self.family(places);
        let start = family.arrived(&self.parameters);
        Self::from(&family, near, start)
    }

    fn family<'a>(&self, places: &'a [Place]) -> Family<'a> {
        Family { kind: self.kind, places, corners: self.corners.clone() }
    }

    /// What it is called, with standard deviations, for a rod of this length.
    fn named(&self, family: &Family<'_>, length: f64) -> Option<Vec<(String, f64, f64)>> {
        let parameters = family.arrived(&self.parameters);
        let values = family.values(&parameters);
        let rates = by_parameters(&parameters, |p| Some(family.values(p)))?;
        let spread = &rates * &self.covariance * rates.transpose();
        let named = |(i, name): (usize, String)| {
            let unit = length.powi(power_of(&name));
            (name, values[i] * unit, spread[(i, i)].max(0.0).sqrt() * unit)
        };
        Some(family.names().into_iter().enumerate().map(named).collect())
    }
}

/// The cost near the best contour for the shapes of a family.
struct Quadratic<'a> {
    family: &'a Family<'a>,
    near: &'a Near,
}

impl Problem for Quadratic<'_> {
    type Equations = NormalMatrix;

    fn equations(&mut self, parameters: &DVector<f64>) -> NormalMatrix {
        let Near { information, gradient, cost, .. } = self.near;
        let offsets = |p: &DVector<f64>| self.family.offsets(p).map(DVector::from_vec);
        let none = NormalMatrix { cost: f64::INFINITY, ..NormalMatrix::empty(parameters.len()) };
        let Some((at, by)) = offsets(parameters).zip(by_parameters(parameters, offsets)) else { return none };
        let slope = gradient + information * &at;
        NormalMatrix {
            cost: cost + at.dot(&(gradient + &slope)),
            gradient: by.transpose() * slope,
            matrix: by.transpose() * information * by,
        }
    }
}

/// Derivatives of a function by its parameters.
fn by_parameters(
    parameters: &DVector<f64>,
    of: impl Fn(&DVector<f64>) -> Option<DVector<f64>>,
) -> Option<DMatrix<f64>> {
    let difference = |i: usize| {
        let moved = |step: f64| {
            let mut other = parameters.clone();
            other[i] += step;
            of(&other)
        };
        Some((moved(STEP)? - moved(-STEP)?) / (2.0 * STEP))
    };
    let columns: Vec<DVector<f64>> = (0..parameters.len()).map(difference).collect::<Option<_>>()?;
    Some(DMatrix::from_columns(&columns))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shape_is_determined_where_it_is_known_better_than_the_extent_of_what_is_touched() {
        let of = |name: &str, value, sigma| is_determined(&(name.to_owned(), value, sigma), 0.01);
        assert!(of("radius", 0.02, 0.003) && of("center.x", 0.0, 0.003));
        // known to a hundredth, and nevertheless any curve along 10 mm
        assert!(!of("radius", 0.4, 0.004) && !of("vertex.y", 0.0, 0.004));
        assert!(of("rotation", 0.0, 0.3) && !of("rotation", 0.0, 0.4));
        assert!(of("coefficient", 50.0, 10.0) && !of("coefficient", 50.0, 20.0));
    }
}
