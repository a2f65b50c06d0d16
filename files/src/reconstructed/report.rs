//! report.json: the reconstruction as a whole, in SI units. Rows are counted from 0, as the lines of points.jsonl.

use super::comparison::{Comparison, Transition};
use super::fit::FitRecord;
use super::result::Reconstructed;
use serde::Serialize;
use std::collections::BTreeMap;
use vibrissa::reconstruct::kink::KinkKind;
use vibrissa::reconstruct::noise_estimate::ChannelNoise;
use vibrissa::reconstruct::score::{Deviation, KinkScore};
use vibrissa::reconstruct::{Calibration, Explanation, FrictionEstimate, Gap, Pass, Shares};
use vibrissa::{Label, Pose};

/// report.json.
#[derive(Serialize)]
pub(super) struct ReportRecord {
    recording: String,
    rows: RowsRecord,
    rod: RodRecord,
    /// What is not computed for this rod, in words.
    missing: Option<&'static str>,
    noise: NoiseRecord,
    answered: AnsweredRecord,
    runs: Vec<RunRecord>,
    kinks: Vec<KinkRecord>,
    gaps: Vec<GapRecord>,
    calibration: Option<Calibration>,
    /// Of each pass, where friction was asked for or seems to be there.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    friction: Vec<FrictionRecord>,
    physics: PhysicsRecord,
    /// Whether one contour explains the whole recording; null where that was not looked at.
    fit: Option<FitRecord>,
    truth: Option<TruthRecord>,
}

#[derive(Serialize)]
struct RowsRecord {
    total: usize,
    usable: usize,
    /// By kind of fault.
    faults: BTreeMap<&'static str, usize>,
    warnings: Vec<String>,
}

#[derive(Serialize)]
struct RodRecord {
    length: f64,
    /// At the clamp, where the rod is not uniform.
    bending_stiffness: f64,
    /// Uniform and straight at rest.
    uniform: bool,
}

#[derive(Serialize)]
struct NoiseRecord {
    f0x: ChannelRecord,
    f0y: ChannelRecord,
    m0z: ChannelRecord,
}

#[derive(Serialize)]
struct ChannelRecord {
    sigma: f64,
    lag1: f64,
    long_run: f64,
}

impl From<&ChannelNoise> for ChannelRecord {
    fn from(noise: &ChannelNoise) -> Self {
        Self { sigma: noise.sigma, lag1: noise.lag1, long_run: noise.long_run }
    }
}

/// Samples in contact, and how many of them have their points.
#[derive(Serialize)]
struct AnsweredRecord {
    /// Samples with a single contact.
    single: usize,
    single_answered: usize,
    /// Samples with several contacts.
    several: usize,
    first_answered: usize,
    second_answered: usize,
    /// Share of the samples in contact that have their first point.
    share: Option<f64>,
}

#[derive(Clone, Copy, Serialize)]
struct PoseRecord {
    x0: f64,
    y0: f64,
    phi0: f64,
}

impl From<Pose> for PoseRecord {
    fn from(Pose { x, y, phi }: Pose) -> Self {
        Self { x0: x, y0: y, phi0: phi }
    }
}

#[derive(Serialize)]
struct RunRecord {
    label: Label,
    /// First and last row.
    from: usize,
    to: usize,
    from_pose: PoseRecord,
    to_pose: PoseRecord,
}

#[derive(Serialize)]
struct KinkRecord {
    pose: PoseRecord,
    kind: &'static str,
    /// The row after it.
    before_row: usize,
    /// Standard deviation of its place along the way of (x, y, L phi), m.
    sigma: f64,
    /// Change of f0x, f0y, m0z: of the slopes by the way for a kink, of the values for a jump.
    change: [f64; 3],
    change_sigma: [f64; 3],
    score: f64,
}

#[derive(Serialize)]
struct GapRecord {
    reason: String,
    /// First and last row; none for a leap, which lies between two rows.
    rows: Option<[usize; 2]>,
    from: Option<[f64; 2]>,
    to: Option<[f64; 2]>,
}

/// Friction of a pass: the coefficient that was used, and what the pass tells of it, each positive where the rod is drawn back.
#[derive(Serialize)]
struct FrictionRecord {
    /// First and last row.
    rows: [usize; 2],
    used: f64,
    is_significant: bool,
    is_identified: bool,
    #[serde(flatten)]
    found: FrictionEstimate,
}

/// The check by the physics: m0z^2 = 2 EI (f0y sin phi0 + f0x cos phi0) in tangential contact.
#[derive(Serialize)]
struct PhysicsRecord {
    fits: bool,
    /// The line of m0z^2 over 2 (f0y sin phi0 + f0x cos phi0).
    line: Option<LineRecord>,
    /// Shares of the scan in contact by what a single contact makes of them; null where the rod is not uniform or not straight.
    explained: Option<f64>,
    beyond_tip: Option<f64>,
    pulling: Option<f64>,
    no_moment_zero: Option<f64>,
    findings: Vec<String>,
    /// What explains a recording that does not fit.
    causes: Vec<CauseRecord>,
}

#[derive(Serialize)]
struct CauseRecord {
    cause: String,
    likelihood: f64,
}

#[derive(Serialize)]
struct LineRecord {
    slope: f64,
    slope_sigma: f64,
    slope_by_bending_stiffness: f64,
    intercept: f64,
    intercept_sigma: f64,
    share: f64,
}

impl PhysicsRecord {
    fn of(found: &Reconstructed) -> Self {
        let Reconstructed { check, rod, .. } = found;
        let line = check.line.map(|line| LineRecord {
            slope: line.slope,
            slope_sigma: line.slope_sigma,
            slope_by_bending_stiffness: line.slope / rod.at_clamp().bending_stiffness(),
            intercept: line.intercept,
            intercept_sigma: line.intercept_sigma,
            share: line.share,
        });
        let Shares { explained, beyond_tip, pulling, no_moment_zero } = check.shares;
        let [explained, beyond_tip, pulling, no_moment_zero] =
            [explained, beyond_tip, pulling, no_moment_zero].map(|share| rod.uniform().map(|_| share));
        let findings = check.findings.iter().map(ToString::to_string).collect();
        let cause =
            |(what, likelihood): &(Explanation, f64)| CauseRecord { cause: what.to_string(), likelihood: *likelihood };
        let causes = found.explanations.iter().map(cause).collect();
        Self { fits: found.fits(), line, explained, beyond_tip, pulling, no_moment_zero, findings, causes }
    }
}

#[derive(Serialize)]
struct TruthRecord {
    scene: String,
    stopped: Option<String>,
    compared: u64,
    off_path: usize,
    accuracy: Option<f64>,
    /// Wrong labels within 1e-4 rod lengths of a transition.
    wrong_at_transitions: u64,
    several_recall: Option<f64>,
    several_precision: Option<f64>,
    single_kept: Option<f64>,
    labels: [Label; 5],
    /// By true label, then by the label found.
    confusion: Vec<Vec<u64>>,
    single: Option<DeviationRecord>,
    first: Option<DeviationRecord>,
    second: Option<DeviationRecord>,
    naive: Option<DeviationRecord>,
    kinks: KinkScoreRecord,
    transitions: Vec<TransitionRecord>,
}

/// Distances from the contour, m.
#[derive(Serialize)]
struct DeviationRecord {
    points: usize,
    bias: f64,
    median: f64,
    percentile_95: f64,
    largest: f64,
}

impl From<&Deviation> for DeviationRecord {
    fn from(deviation: &Deviation) -> Self {
        let Deviation { count, bias, median, percentile_95, largest } = *deviation;
        Self { points: count, bias, median, percentile_95, largest }
    }
}

#[derive(Serialize)]
struct KinkScoreRecord {
    truth: usize,
    found: usize,
    recall: Option<f64>,
    precision: Option<f64>,
    median_error: Option<f64>,
    largest_error: Option<f64>,
}

impl KinkScoreRecord {
    fn of(kinks: &KinkScore, of_events: &KinkScore) -> Self {
        Self {
            truth: kinks.truth,
            found: kinks.found,
            recall: kinks.recall(),
            precision: of_events.precision(),
            median_error: kinks.median_error(),
            largest_error: kinks.largest_error(),
        }
    }
}

#[derive(Serialize)]
struct TransitionRecord {
    from: Label,
    to: Label,
    kind: String,
    pose: PoseRecord,
    error: Option<f64>,
}

impl From<&Transition> for TransitionRecord {
    fn from(transition: &Transition) -> Self {
        let Transition { from, to, kind, pose, error } = transition;
        Self { from: *from, to: *to, kind: kind.to_string(), pose: (*pose).into(), error: *error }
    }
}

impl From<&Comparison> for TruthRecord {
    fn from(truth: &Comparison) -> Self {
        let confusion = &truth.confusion;
        let counts = Label::ALL.map(|of| Label::ALL.map(|found| confusion.count(of, found)).to_vec()).to_vec();
        Self {
            scene: truth.scene.name.clone(),
            stopped: truth.stop.as_ref().map(ToString::to_string),
            compared: confusion.total(),
            off_path: truth.off_path,
            accuracy: confusion.accuracy(),
            wrong_at_transitions: truth.either,
            several_recall: confusion.several_recall(),
            several_precision: confusion.several_precision(),
            single_kept: confusion.single_kept(),
            labels: Label::ALL,
            confusion: counts,
            single: truth.single.as_ref().map(Into::into),
            first: truth.first.as_ref().map(Into::into),
            second: truth.second.as_ref().map(Into::into),
            naive: truth.naive.as_ref().map(Into::into),
            kinks: KinkScoreRecord::of(&truth.kinks, &truth.kinks_of_events),
            transitions: truth.transitions.iter().map(Into::into).collect(),
        }
    }
}

/// How many samples there are of a kind, and how many have their points.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Answered {
    pub single: usize,
    pub single_answered: usize,
    pub several: usize,
    pub first_answered: usize,
    pub second_answered: usize,
}

impl Answered {
    pub fn of(found: &Reconstructed) -> Self {
        let mut count = Self::default();
        for reading in &found.found.readings {
            let (touch, second) = (reading.touch.is_ok(), reading.second.is_some_and(|second| second.is_ok()));
            match reading.label {
                Label::Free => {}
                label if label.several() => {
                    count.several += 1;
                    count.first_answered += usize::from(touch);
                    count.second_answered += usize::from(second);
                }
                _ => {
                    count.single += 1;
                    count.single_answered += usize::from(touch);
                }
            }
        }
        count
    }

    /// Share of the samples in contact that have their first point.
    pub fn share(&self) -> Option<f64> {
        let all = self.single + self.several;
        (all > 0).then(|| (self.single_answered + self.first_answered) as f64 / all as f64)
    }
}

impl ReportRecord {
    pub fn of(found: &Reconstructed) -> Self {
        let Reconstructed { recording, rod, rows, found: result, .. } = found;
        let rod = rod.at_clamp();
        let mut faults = BTreeMap::new();
        for fault in recording.faults() {
            *faults.entry(fault.problem.name()).or_insert(0) += 1;
        }
        let runs = found.runs().map(|(run, label)| RunRecord {
            label,
            from: rows[run.start],
            to: rows[run.end - 1],
            from_pose: found.pose(run.start).into(),
            to_pose: found.pose(run.end - 1).into(),
        });
        let kinks = result.kinks.iter().zip(found.kink_poses()).map(|(kink, pose)| KinkRecord {
            pose: pose.into(),
            kind: if kink.kind == KinkKind::Jump { "jump" } else { "kink" },
            before_row: rows[kink.next],
            sigma: kink.sigma_tau,
            change: kink.change,
            change_sigma: kink.sigma,
            score: kink.score,
        });
        let gap = |gap: &Gap| GapRecord {
            reason: gap.reason.to_string(),
            rows: (!gap.samples.is_empty()).then(|| [rows[gap.samples.start], rows[gap.samples.end - 1]]),
            from: gap.from,
            to: gap.to,
        };
        let friction = |pass: &Pass| {
            let found = pass.friction?;
            Some(FrictionRecord {
                rows: [rows[pass.samples.start], rows[pass.samples.end - 1]],
                used: pass.used_friction,
                is_significant: found.is_significant(),
                is_identified: found.is_identified(),
                found,
            })
        };
        let answered = Answered::of(found);
        let [f0x, f0y, m0z] = result.noise.each_ref().map(ChannelRecord::from);
        Self {
            recording: recording.file.display().to_string(),
            rows: RowsRecord {
                total: recording.rows.len(),
                usable: rows.len(),
                faults,
                warnings: recording.warnings(),
            },
            rod: RodRecord {
                length: rod.length(),
                bending_stiffness: rod.bending_stiffness(),
                uniform: found.rod.uniform().is_some(),
            },
            missing: found.missing(),
            noise: NoiseRecord { f0x, f0y, m0z },
            answered: AnsweredRecord {
                single: answered.single,
                single_answered: answered.single_answered,
                several: answered.several,
                first_answered: answered.first_answered,
                second_answered: answered.second_answered,
                share: answered.share(),
            },
            runs: runs.collect(),
            kinks: kinks.collect(),
            gaps: found.contour.gaps.iter().map(gap).collect(),
            calibration: result.calibration().cloned(),
            friction: result.passes.iter().filter_map(friction).collect(),
            physics: PhysicsRecord::of(found),
            fit: FitRecord::of(found),
            truth: found.comparison.as_ref().map(Into::into),
        }
    }
}
