//! The fit of one contour to the whole recording: its record in report.json, and what it says.

use super::result::Reconstructed;
use serde::Serialize;
use std::fmt::Write;
use std::ops::Range;
use vibrissa::Label;
use vibrissa::reconstruct::{ContourFit, Finding, FittedObject, Goodness, Knowledge, ShapeKind, SimpleShape, Source};

/// Share of the samples in contact from which on such places are told: fewer are next to a transition.
const DOUBTED: f64 = 0.01;
/// Standard deviations of its budget beyond which an error of the contour is told as doubtful. Of 26 independent errors one is beyond by chance in 7 % of the
/// recordings; of those that a recording determines less often.
const FAR_OFF: f64 = 3.0;

impl Reconstructed {
    /// Adds whether one contour explains the recording; nothing where that was not looked at.
    pub(super) fn tell_fit(&self, text: &mut String) -> std::fmt::Result {
        let fit = match &self.fit {
            Some(Ok(fit)) => fit,
            Some(Err(why)) => return writeln!(text, "fit: none; {why}"),
            None => return Ok(()),
        };
        let Goodness { chi_squared, degrees_of_freedom, explains, .. } = &fit.goodness;
        let of = format!("chi squared {chi_squared:.0} of {degrees_of_freedom:.0} degrees of freedom");
        if *explains {
            writeln!(text, "fit: one contour explains the recording, {of}; labels, points and errors are its own")?;
            return tell_shapes(&fit.shapes, text);
        }
        let label =
            |run: &(Range<usize>, Option<Label>)| run.1.map_or_else(|| "?".to_owned(), |label| label.to_string());
        let labels: Vec<String> = fit.runs().iter().map(label).collect();
        let worst = fit.goodness.unlikely_window().map_or_else(String::new, |worst| {
            let [from, to] = self.rows_of(&worst.samples);
            format!(" ({:.0} of {} in rows {from} to {to})", worst.chi_squared, worst.residuals)
        });
        writeln!(text, "fit: no contour explains the recording, {of}{worst}; its phases: {}", labels.join(" "))
    }

    /// The contour that was fitted; none where there is none.
    pub fn fitted(&self) -> Option<&ContourFit> {
        self.fit.as_ref()?.as_ref().ok()
    }

    /// What of a contour that explains the recording is in doubt, in words.
    pub fn doubts(&self) -> impl Iterator<Item = String> {
        self.several_in_doubt().into_iter().chain(self.error_in_doubt())
    }

    /// An error far off what is known of it: another contour may explain the recording with smaller ones.
    fn error_in_doubt(&self) -> Option<String> {
        let (source, off) = self.fitted().filter(|fit| fit.goodness.explains)?.goodness.farthest_error?;
        (off.abs() > FAR_OFF).then(|| {
            format!(
                "the contour that explains the recording needs a {source} that is {:.1} standard deviations away from the known value; measure it: if it \
                 is as known, the contour and some labels are wrong",
                off.abs()
            )
        })
    }

    /// Where the contour of the fit has several contacts though each sample alone was answered by one: a contact that passes fast along a flank looks
    /// like two.
    fn several_in_doubt(&self) -> Option<String> {
        let count: usize = self.several_only_in_fit.iter().map(Range::len).sum();
        let in_contact = self.found.readings.iter().filter(|reading| reading.label != Label::Free).count();
        if (count as f64) < DOUBTED * in_contact as f64 {
            return None;
        }
        let [from, to] = self.rows_of(self.several_only_in_fit.iter().max_by_key(|run| run.len())?);
        Some(format!(
            "several contacts only in the fit: in {count} samples, for example in rows {from} to {to}, the fitted contour has several contacts where \
             each sample alone has one; a contact that moves fast along a flank resembles two at its ends: if the object is convex, the points \
             there are wrong"
        ))
    }

    /// Whether recording, units and rod fit together: by the physics, whose findings are of the local answer, or because one contour explains the recording.
    pub fn fits(&self) -> bool {
        self.check.findings.iter().all(|finding| !finding.is_misfit() || self.is_answered(finding))
    }

    /// Whether a contour that explains the recording answers a misfit: any, if it needs no errors besides friction, and else those of the line of tangential
    /// contacts. It does not answer that it has friction which was not asked for.
    fn is_answered(&self, finding: &Finding) -> bool {
        let answers = |fit: &ContourFit| {
            let is_friction = |error: &(Source, f64, f64)| error.0 == Source::Friction;
            let tells = matches!(finding, Finding::Friction { .. }) && fit.friction_beside_errors().is_some();
            let is_of_line = || fit.errors.iter().all(is_friction) || finding.is_of_line();
            fit.goodness.explains && !tells && is_of_line()
        };
        self.fitted().is_some_and(answers)
    }

    /// What the physics find, without the misfits that the contour answers.
    pub fn findings(&self) -> impl Iterator<Item = &Finding> {
        // samples that are left out stay left out
        let is_told = |finding: &&Finding| matches!(finding, Finding::Frozen { .. }) || !finding.is_misfit();
        self.check.findings.iter().filter(move |finding| is_told(finding) || !self.is_answered(finding))
    }

    /// What the command warns of: findings that cast doubt on the results, and all of them where no contour explains the recording.
    pub fn warnings(&self) -> impl Iterator<Item = &Finding> {
        let is_contradicted = self.fitted().is_some_and(|fit| !fit.goodness.explains);
        self.findings().filter(move |finding| is_contradicted || finding.is_misfit() || finding.is_warning())
    }

    /// The points of the contour of the fit, as in fitted.csv; none where there is no fit.
    pub fn fitted_contour(&self) -> Option<impl Iterator<Item = FittedPoint>> {
        Some(FittedPoint::all(&self.fitted()?.objects))
    }

    /// First and last row of some samples.
    fn rows_of(&self, samples: &Range<usize>) -> [usize; 2] {
        [self.rows[samples.start], self.rows[samples.end - 1]]
    }

    /// Why no contour explains the recording; none where one does, or where none was fitted.
    pub fn contradiction(&self) -> Option<String> {
        let fit = self.fitted().filter(|fit| !fit.goodness.explains)?;
        let mut why = "no contour was found that explains the whole recording".to_owned();
        if let Some(worst) = fit.goodness.unlikely_window() {
            let [from, to] = self.rows_of(&worst.samples);
            why += &format!("; it fails worst in {} at rows {from} to {to}", worst.channel);
        }
        let missing = fit.runs().into_iter().filter(|run| run.1.is_none()).map(|run| self.rows_of(&run.0));
        if let Some([from, to]) = missing.max_by_key(|[from, to]| to - from).filter(|_| fit.goodness.is_unreached()) {
            let share = 100.0 * fit.goodness.unreached;
            why += &format!(
                "; in {share:.0} % of the samples, for example in rows {from} to {to}, the rod has no equilibrium on it"
            );
        }
        // where there is friction, the estimates of errors contain it
        let rubs = self.check.findings.iter().any(|finding| matches!(finding, Finding::Friction { .. }));
        if let Some((source, off)) = fit.goodness.error_beyond_budget().filter(|_| !rubs) {
            why += &format!("; its {source} is {:.0} standard deviations away from the known value", off.abs());
        }
        Some(
            why + ": the contact points there may be wrong, the object, the rod or the sensor changed, or the fit had a poor start; compare the \
                   labels in phases.svg with `fit.runs` in report.json",
        )
    }
}

/// Adds the simple shape that explains each object best, and what others do.
fn tell_shapes(shapes: &[SimpleShape], text: &mut String) -> std::fmt::Result {
    for of_object in shapes.chunk_by(|one, other| (one.object, &one.points) == (other.object, &other.points)) {
        let [best, others @ ..] = of_object else { continue };
        // lengths in mm, angles in degrees
        let number = |(name, value, sigma): &(String, f64, f64)| match &name[..] {
            "coefficient" => format!("{name} {value:.2} +- {sigma:.1e} 1/m"),
            "rotation" => format!("{name} {:.3} +- {:.1e} deg", value.to_degrees(), sigma.to_degrees()),
            _ => format!("{name} {:.4} +- {:.1e} mm", 1e3 * value, 1e3 * sigma),
        };
        let numbers: Vec<String> = best.parameters.iter().map(number).collect();
        let [object, first, last] = [best.object, best.points.start, best.points.end.saturating_sub(1)];
        write!(text, "shape of object {object}, points {first} to {last}: {}, {}", best.kind, numbers.join(", "))?;
        let others: Vec<String> = others.iter().map(|other| other.kind.to_string()).collect();
        if others.is_empty() { writeln!(text)? } else { writeln!(text, "; or: {}", others.join(", "))? }
    }
    Ok(())
}

/// Columns of fitted.csv.
pub(super) const FITTED_COLUMNS: [&str; 7] = ["object", "x", "y", "known", "sigma", "room", "vertex"];

/// A point of the contour of a fit.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct FittedPoint {
    /// Number of the object, from 0.
    pub object: usize,
    /// Position, m.
    pub x: f64,
    /// Position, m.
    pub y: f64,
    /// `touched`: the rod touches the contour there, or nearer to it than to its neighbours; `bounded`: it passed outside; `unknown`: it was not there.
    pub known: &'static str,
    /// Standard deviation across the contour, m; none where it is not touched.
    pub sigma: Option<f64>,
    /// How far the object may reach beyond the point at most, across the contour, m; none where it is not bounded.
    pub room: Option<f64>,
    /// Whether smooth pieces meet at an angle there.
    pub vertex: bool,
}

impl FittedPoint {
    /// The points of some contours.
    pub fn all(objects: &[FittedObject]) -> impl Iterator<Item = Self> {
        objects.iter().enumerate().flat_map(|(object, fitted)| {
            let point = move |k: usize| Self {
                object,
                x: fitted.points[k][0],
                y: fitted.points[k][1],
                known: match fitted.known[k] {
                    Knowledge::Touched { .. } => "touched",
                    Knowledge::Bounded { .. } => "bounded",
                    Knowledge::Unknown => "unknown",
                },
                sigma: fitted.known[k].sigma(),
                room: fitted.known[k].room(),
                vertex: fitted.vertices.contains(&k),
            };
            (0..fitted.points.len()).map(point)
        })
    }
}

/// The fit of one contour to the whole recording.
#[derive(Default, Serialize)]
pub(super) struct FitRecord {
    /// Whether the contour explains the recording; none where there is no fit.
    explains: Option<bool>,
    /// Why there is no fit.
    missing: Option<String>,
    chi_squared: Option<f64>,
    degrees_of_freedom: Option<f64>,
    p_value: Option<f64>,
    /// Relative variance of the variance of the noise.
    noise_spread: Option<f64>,
    /// Share of the blocks of samples at whose poses the model has no state.
    unreached: Option<f64>,
    /// Samples that are left out because the free rod rings after a jump.
    ringing: Option<usize>,
    /// The error that is farthest off what is known of it.
    farthest_error: Option<FarthestErrorRecord>,
    worst: Option<WorstRecord>,
    /// First and last rows of several contacts where each row alone was answered by one.
    several_only_in_fit: Vec<[usize; 2]>,
    runs: Vec<FittedRunRecord>,
    shapes: Vec<ShapeRecord>,
    errors: Vec<FittedErrorRecord>,
}

/// The place at which the fit explains the recording worst.
#[derive(Serialize)]
struct WorstRecord {
    /// First and last row.
    rows: [usize; 2],
    channel: String,
    chi_squared: f64,
    residuals: usize,
    p_value: f64,
}

/// How far an error is off what is known of it, in standard deviations of its budget.
#[derive(Serialize)]
struct FarthestErrorRecord {
    source: Source,
    standard_deviations: f64,
}

/// Rows along which the model has one phase; null where it has no state.
#[derive(Serialize)]
struct FittedRunRecord {
    label: Option<Label>,
    from: usize,
    to: usize,
}

/// A simple shape that explains an object as well as the free contour does.
#[derive(Serialize)]
struct ShapeRecord {
    /// Number of the object, from 0.
    object: usize,
    /// The first and the last point of the object of which it tells, from 0.
    points: [usize; 2],
    shape: ShapeKind,
    parameters: Vec<ParameterRecord>,
    chi_squared: f64,
    p_value: f64,
    evidence: f64,
}

#[derive(Serialize)]
struct ParameterRecord {
    name: String,
    value: f64,
    sigma: f64,
}

impl ShapeRecord {
    fn of(shape: &SimpleShape) -> Self {
        let SimpleShape { object, points, kind, parameters, chi_squared, p_value, evidence } = shape;
        let parameter = |(name, value, sigma): &(String, f64, f64)| ParameterRecord {
            name: name.clone(),
            value: *value,
            sigma: *sigma,
        };
        Self {
            object: *object,
            points: [points.start, points.end.saturating_sub(1)],
            shape: *kind,
            parameters: parameters.iter().map(parameter).collect(),
            chi_squared: *chi_squared,
            p_value: *p_value,
            evidence: *evidence,
        }
    }
}

#[derive(Serialize)]
struct FittedErrorRecord {
    source: Source,
    value: f64,
    sigma: f64,
}

impl FitRecord {
    pub fn of(found: &Reconstructed) -> Option<Self> {
        let fit = match found.fit.as_ref()? {
            Ok(fit) => fit,
            Err(error) => return Some(Self { missing: Some(error.to_string()), ..Self::default() }),
        };
        let goodness = &fit.goodness;
        let run = |(samples, label): (Range<usize>, Option<Label>)| {
            let [from, to] = found.rows_of(&samples);
            FittedRunRecord { label, from, to }
        };
        Some(Self {
            explains: Some(goodness.explains),
            missing: None,
            chi_squared: Some(goodness.chi_squared),
            degrees_of_freedom: Some(goodness.degrees_of_freedom),
            p_value: Some(goodness.p_value),
            noise_spread: Some(goodness.noise_spread),
            unreached: Some(goodness.unreached),
            ringing: Some(fit.ringing),
            farthest_error: goodness
                .farthest_error
                .map(|(source, off)| FarthestErrorRecord { source, standard_deviations: off }),
            worst: goodness.worst.as_ref().map(|worst| WorstRecord {
                rows: found.rows_of(&worst.samples),
                channel: worst.channel.clone(),
                chi_squared: worst.chi_squared,
                residuals: worst.residuals,
                p_value: worst.p_value,
            }),
            several_only_in_fit: found.several_only_in_fit.iter().map(|run| found.rows_of(run)).collect(),
            runs: fit.runs().into_iter().map(run).collect(),
            shapes: fit.shapes.iter().map(ShapeRecord::of).collect(),
            errors: fit
                .errors
                .iter()
                .map(|&(source, value, sigma)| FittedErrorRecord { source, value, sigma })
                .collect(),
        })
    }
}
