//! What sweep.json says of a sweep as a whole.

use crate::Scan;
use serde::Serialize;
use vibrissa::Pose;
use vibrissa::contact::{Start, StartCandidate};

/// sweep.json: whether the other files hold the whole path of the clamp, and if not, why and where they end.
#[derive(Serialize)]
pub(super) struct SweepRecord<'a> {
    scene: &'a str,
    complete: bool,
    stop: Option<StopRecord>,
    /// None without a first equilibrium.
    start: Option<StartRecord<'a>>,
    states: usize,
    events: usize,
    /// None without a single state.
    phases: Option<String>,
    /// What friction and jumps have taken, J; none without friction.
    #[serde(skip_serializing_if = "Option::is_none")]
    dissipated: Option<f64>,
}

/// How the first equilibrium was found.
#[derive(Serialize)]
struct StartRecord<'a> {
    /// `free`, `in-contact` or `given`.
    kind: &'static str,
    /// Of a start in contact, the one taken first.
    reached: &'a [StartCandidate],
}

impl<'a> StartRecord<'a> {
    fn new(start: &'a Start) -> Self {
        let (kind, reached): (_, &[_]) = match start {
            Start::InContact(reached) => ("in-contact", reached),
            Start::Given => ("given", &[]),
            _ => ("free", &[]),
        };
        Self { kind, reached }
    }
}

/// Where and why a sweep ended before its path; SI units.
#[derive(Serialize)]
struct StopRecord {
    /// `interrupted` by the user, or the [reason](vibrissa::contact::StopReason) why the sweep could not go on.
    kind: String,
    x0: Option<f64>,
    y0: Option<f64>,
    phi0: Option<f64>,
    message: String,
}

impl StopRecord {
    fn new(kind: String, pose: Option<Pose>, message: String) -> Self {
        let [x0, y0, phi0] = [pose.map(|pose| pose.x), pose.map(|pose| pose.y), pose.map(|pose| pose.phi)];
        Self { kind, x0, y0, phi0, message }
    }
}

impl<'a> From<&'a Scan> for SweepRecord<'a> {
    fn from(scan: &'a Scan) -> Self {
        let interrupted = scan.interrupted.map(|at| StopRecord::new("interrupted".into(), at.pose, at.to_string()));
        let stop = scan.outcome.stop.as_ref();
        let stopped = || stop.map(|stop| StopRecord::new(stop.reason.to_string(), Some(stop.pose), stop.to_string()));
        Self {
            scene: &scan.scene.name,
            complete: scan.is_complete(),
            stop: interrupted.or_else(stopped),
            start: scan.outcome.start.as_ref().map(StartRecord::new),
            states: scan.outcome.states.len(),
            events: scan.outcome.events.len(),
            phases: (!scan.is_empty()).then(|| scan.phases()),
            dissipated: scan.outcome.dissipated,
        }
    }
}
