//! The loop of an exploration.

use super::abort::largest_moment;
use super::approach::{DEPTH, approach};
use super::contour::{best_scan, is_drawn, left_out};
use super::facing::faces;
use super::free_space::FreeSpace;
use super::fused::fused;
use super::measured::Measured;
use super::{Abort, ExploreError, ExplorerSettings};
use crate::{Forecast, scanned};
use rod_contact::ClampPath;
use rod_core::{Rod, Sample};
use rod_reconstruct::FittedObject;
use std::f64::consts::PI;

/// Distance (rod lengths) of the poses of two scans below which they are the same: what the first did not find, the second does not either.
const SAME: f64 = 0.02;

/// What a scan is for.
#[derive(Clone, Debug)]
pub enum Purpose {
    /// To find the object in space of which nothing is known, or from a side that no touched part of it faces.
    Approach,
    /// To touch more of the contour, or to know it better: what is expected, and the length (m) that it adds.
    Contour {
        /// What is expected.
        forecast: Box<Forecast>,
        /// Length newly touched, and length that gets as certain as asked for, m.
        value: f64,
    },
}

/// The next scan.
#[derive(Clone, Debug)]
pub struct Proposal {
    /// The way of the clamp.
    pub path: ClampPath,
    /// What it is for.
    pub purpose: Purpose,
    /// When the rig must stop.
    pub abort: Abort,
}

/// Why an exploration is finished.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Finish {
    /// Everything that was touched is known as well as asked for, and no scan is expected to add anything worth it.
    Precise,
    /// No scan that may be made is expected to add anything worth it, though some of the contour is less certain than asked for.
    NothingLeft,
    /// No object can be drawn through what was touched, so that nothing is known of what is left.
    NoObject,
    /// As many scans were made as allowed.
    MostScans,
}

/// Proposes scans of an object, takes what was measured on them, and proposes the next one.
///
/// The clamp of a proposed path stays outside the box, or where the rod has been by the contours that were fitted so far: it does not enter the object if that is in its box
/// and these contours are right. The rod bends no further at its clamp than the largest stress if the rig stops by [`Abort`]. Expected only, from the hypotheses
/// about the object: that the stress elsewhere in the rod is below the largest one, and what a scan adds.
#[derive(Clone, Debug)]
pub struct Explorer {
    rod: Rod,
    settings: ExplorerSettings,
    scans: Vec<Vec<FittedObject>>,
    made: Vec<ClampPath>,
    known: Vec<FittedObject>,
    space: FreeSpace,
    proposed: Option<Proposal>,
    finished: Option<Finish>,
}

impl Explorer {
    /// An exploration of which nothing is done yet.
    ///
    /// # Errors
    /// [`ExploreError`] where a setting is not possible.
    pub fn new(rod: Rod, settings: ExplorerSettings) -> Result<Self, ExploreError> {
        settings.check(&rod)?;
        let space = FreeSpace::new(settings.object, rod.length());
        let (scans, made, known) = (Vec::new(), Vec::new(), Vec::new());
        Ok(Self { rod, settings, scans, made, known, space, proposed: None, finished: None })
    }

    /// The next scan; none where the exploration is [`finished`](Self::finished). The same one until there is an [`update`](Self::update).
    ///
    /// # Errors
    /// [`ExploreError`].
    pub fn propose(&mut self) -> Result<Option<Proposal>, ExploreError> {
        if self.proposed.is_none() && self.finished.is_none() {
            self.proposed = self.next()?;
            if self.proposed.is_none() {
                self.finished = Some(self.why_nothing_is_proposed()?);
            }
        }
        Ok(self.proposed.clone())
    }

    fn why_nothing_is_proposed(&self) -> Result<Finish, ExploreError> {
        let Self { rod, settings, known, space, .. } = self;
        if !known.is_empty() && !is_drawn(rod, settings, known, space)? {
            return Ok(Finish::NoObject);
        }
        Ok(if self.is_precise() { Finish::Precise } else { Finish::NothingLeft })
    }

    fn next(&self) -> Result<Option<Proposal>, ExploreError> {
        let Self { rod, settings, known, space, .. } = self;
        let is_allowed = |path: ClampPath| self.is_within_stage(path) && !self.is_made(path);
        let (path, purpose, force) = match best_scan(rod, settings, known, space, is_allowed)? {
            Some((forecast, path, value)) => {
                let force = forecast.largest_force;
                (path, Purpose::Contour { forecast: Box::new(forecast), value }, force)
            }
            None => match approach(
                rod,
                settings,
                space,
                |path| is_allowed(path) && self.is_from_new_side(path),
                |path| self.came_from(path),
            ) {
                // the largest moment, by the shortest lever: no object is nearer to the path
                Some(path) => {
                    let moment = largest_moment(rod, settings.largest_stress).unwrap_or(0.0);
                    (path, Purpose::Approach, moment / ((1.0 - DEPTH) * rod.length()))
                }
                None => return Ok(None),
            },
        };
        Ok(Abort::of(rod, settings.largest_stress, force).map(|abort| Proposal { path, purpose, abort }))
    }

    /// Takes the samples of the scan that was proposed last, as far as it was made.
    ///
    /// # Errors
    /// [`ExploreError`]; then nothing has changed.
    pub fn update(&mut self, samples: &[Sample]) -> Result<(), ExploreError> {
        let proposal = self.proposed.as_ref().ok_or(ExploreError::NotProposed)?;
        let path = proposal.path;
        let (from, length) = (path.at(0.0), self.rod.length());
        if let Some(Sample { pose, .. }) = samples.first()
            && (pose.x - from.x).hypot(pose.y - from.y) > scanned::STEP * length
        {
            return Err(ExploreError::Elsewhere { x: pose.x, y: pose.y, from_x: from.x, from_y: from.y });
        }
        let measured = Measured::of(&self.rod, &self.settings, samples)?;
        self.made.push(path);
        self.take(samples, &measured);
        self.proposed = None;
        self.finished = (self.made.len() >= self.settings.most_scans).then_some(Finish::MostScans);
        Ok(())
    }

    /// Takes the samples of a scan that was made before the exploration, or beside it. It is none of the scans of which [`ExplorerSettings::most_scans`] allows some. A
    /// proposal that was not made yet is withdrawn.
    ///
    /// # Errors
    /// [`ExploreError::Reconstruct`]; then nothing has changed.
    pub fn add(&mut self, samples: &[Sample]) -> Result<(), ExploreError> {
        let measured = Measured::of(&self.rod, &self.settings, samples)?;
        self.add_measured(samples, &measured);
        Ok(())
    }

    /// [`add`](Self::add) of a scan that is reconstructed already: `objects` are the contours that explain its samples.
    pub fn add_known(&mut self, samples: &[Sample], objects: Vec<FittedObject>) {
        self.add_measured(samples, &Measured { objects, is_explained: true });
    }

    fn add_measured(&mut self, samples: &[Sample], measured: &Measured) {
        self.take(samples, measured);
        self.proposed = None;
        self.finished = self.finished.filter(|finish| *finish == Finish::MostScans);
    }

    fn take(&mut self, samples: &[Sample], measured: &Measured) {
        let length = self.rod.length();
        if measured.is_explained {
            for pair in measured.shapes(&self.rod, samples, scanned::STEP * length).windows(2) {
                self.space.pass(&pair[0], &pair[1], length);
            }
        }
        self.scans.push(measured.objects.clone());
        self.known = fused(&self.scans, length);
    }

    /// Why the exploration is finished; none while it is not.
    pub fn finished(&self) -> Option<Finish> {
        self.finished
    }

    /// What is known of the contour.
    pub fn known(&self) -> &[FittedObject] {
        &self.known
    }

    /// Touched points (m) of which the proposals know nothing: no object is drawn through them, because its contour would cross itself there. Scans that disagree are the cause.
    pub fn left_out(&self) -> Vec<[f64; 2]> {
        let Self { rod, settings, known, space, .. } = self;
        left_out(rod, settings, known, space)
    }

    /// What each scan told of the contour, in the order in which they were made.
    pub fn scans(&self) -> &[Vec<FittedObject>] {
        &self.scans
    }

    fn is_precise(&self) -> bool {
        let mut sigmas = self.known.iter().flat_map(|one| &one.known).filter_map(|known| known.sigma()).peekable();
        sigmas.peek().is_some() && sigmas.all(|sigma| sigma <= self.settings.sigma)
    }

    fn is_within_stage(&self, path: ClampPath) -> bool {
        let ends = [path.at(0.0), path.at(path.length())];
        self.settings.stage.is_none_or(|stage| ends.iter().all(|end| stage.bounds.contains([end.x, end.y])))
    }

    /// Whether no touched part of the contour faces the clamp, and no scan came from there.
    fn is_from_new_side(&self, path: ClampPath) -> bool {
        self.known.is_empty() || !(self.came_from(path) || faces(&self.known, path.at(0.0).phi + PI))
    }

    /// Whether a scan was made from the side of this one.
    fn came_from(&self, path: ClampPath) -> bool {
        self.made.iter().any(|made| (made.at(0.0).phi - path.at(0.0).phi).abs() < 1e-6)
    }

    fn is_made(&self, path: ClampPath) -> bool {
        let ends = |path: ClampPath| [path.at(0.0), path.at(path.length())];
        let (near, angle) = (SAME * self.rod.length(), path.at(0.0).phi);
        let is_same = |made: &ClampPath| {
            // across both: the lengths of the paths may differ
            let ([from, to], [other, _]) = (ends(path), ends(*made));
            let (dx, dy) = ((to.x - from.x) / path.length(), (to.y - from.y) / path.length());
            let apart = (other.x - from.x) * dy - (other.y - from.y) * dx;
            let rate = made.rate();
            (angle - other.phi).abs() < 1e-6 && apart.abs() < near && rate.x * dx + rate.y * dy > 0.0
        };
        self.made.iter().any(is_same)
    }
}
