//! Pseudo-arclength continuation (Keller 1977) of the equilibria with one contact set along the path of the clamp, up to the
//! transition at which the contact set changes.
//!
//! The loop is [`Stepper::attempt`](stepper::Stepper), whose steps are those of `docs/sweep.md`, section 3:
//!
//! | step | file |
//! |---|---|
//! | predict, correct | `correct`; over a joint of the rod `joint` |
//! | refuse what a step may have passed over | `dip` |
//! | end the branch | `ends` |
//! | look for transitions, locate the first | `locate`, by `transition`, `fold` and `inflection` |
//! | merge two contacts | `merge` |
//! | certify a state to report | `between`, `certify` |
//!
//! `probe` tells whether the sweep can go on with another contact set.

mod between;
pub(crate) mod branch;
pub(crate) mod certify;
mod correct;
mod dip;
mod ends;
pub(crate) mod fold;
pub(crate) mod inflection;
mod joint;
mod locate;
mod merge;
mod probe;
pub(crate) mod stepper;
pub(crate) mod transition;

use crate::contact_set::Configuration;
use crate::continuation::branch::Tangent;
use crate::continuation::certify::Quality;
use crate::error::StopReason;
use crate::event::EventKind;
use crate::gap::Scan;
use crate::limits::LIMITS;
use rod_core::SolveReport;

/// A point of the sweep: an equilibrium, its scan, its quality, and the tangent of the branch there.
#[derive(Clone, Debug)]
pub(crate) struct Point {
    pub configuration: Configuration,
    pub scan: Scan,
    pub quality: Quality,
    pub tangent: Tangent,
}

/// A configuration and its scan.
#[derive(Clone, Debug)]
pub(crate) struct Seen {
    pub configuration: Configuration,
    pub scan: Scan,
}

/// A transition, and the scan of the contact set after it.
#[derive(Debug)]
pub(crate) struct Change {
    pub kind: EventKind,
    pub before: Configuration,
    pub after: Seen,
}

/// The result of a step.
#[derive(Debug)]
pub(crate) enum Step {
    /// A new point of the branch.
    Moved(Box<Point>),
    /// A transition before that.
    Changed(Box<Change>),
    /// The branch ends here, in a fold, or loses its stability.
    Ended(Box<Seen>),
    /// The branch can be followed up to here, and no further.
    Stopped(StopReason, Box<Seen>),
}

impl Point {
    /// The step of a branch that ends at this point.
    pub fn end(&self) -> Step {
        Step::Ended(Box::new(Seen { configuration: self.configuration.clone(), scan: self.scan.clone() }))
    }
}

impl Step {
    /// The last configuration of the branch that was followed.
    pub fn last(&self) -> &Configuration {
        match self {
            Self::Moved(next) => &next.configuration,
            Self::Changed(change) => &change.before,
            Self::Ended(last) | Self::Stopped(_, last) => &last.configuration,
        }
    }

    /// The scan at its end: of a transition, with the contact set after it.
    fn scan(&self) -> &Scan {
        match self {
            Self::Moved(next) => &next.scan,
            Self::Changed(change) => &change.after.scan,
            Self::Ended(last) | Self::Stopped(_, last) => &last.scan,
        }
    }

    /// The path parameter at its end.
    pub fn tau(&self) -> f64 {
        self.last().tau()
    }

    /// Distance (path parameter) beyond its end at which a pose still counts as its end: the rounding of a located transition. Beyond a
    /// fold there is no equilibrium, so 0.
    pub fn rounding(&self) -> f64 {
        if let Self::Changed(_) = self { LIMITS.step.same_pose } else { 0.0 }
    }
}

/// The next point of a branch, before it is judged.
struct Corrected {
    pub next: Configuration,
    pub tangent: Tangent,
    pub report: SolveReport,
    /// Arclength of the step along the first tangent.
    pub length: f64,
    /// Whether the branch has a kink there, and `tangent` is that behind it.
    pub kink: bool,
}
