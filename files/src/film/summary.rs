//! A film in words.

use super::result::FilmForces;
use crate::table::counted;
use std::collections::BTreeMap;
use std::fmt::Write;
use vibrissa::reconstruct::{Frame, FrameVerdict};

/// Most faults of frames that are told.
const MOST_FAULTS: usize = 5;
/// Noise that is found, as a share of that which is given, from which on it is told.
const LESS_NOISE: f64 = 0.3;
/// Probability of what a pole leaves below which it is told.
const DOUBTFUL: f64 = 0.05;
/// Noise that is found, L, from which on it is told: points of tracked rods have less.
const MUCH_NOISE: f64 = 5e-3;
/// Length of the points along the rod, as a share of that of the rod, from which on they are too long: noise makes them a little longer.
const TOO_LONG: f64 = 1.03;
/// Length of the points along the rod, as a share of the length of the rod, below which it is told which end is taken as seen.
const WHOLE: f64 = 0.97;
/// Change of force or moment with the place of the base, as a share, from which on it is reported. A diameter that is 1 % off changes forces by
/// 4 %: a smaller change is within what is known of the rod.
const MATTERS: f64 = 0.05;

impl FilmForces {
    /// Frames and verdicts, noise, and the shape at rest.
    pub fn summary(&self) -> String {
        let mut text = String::new();
        // Writing to a string cannot fail.
        let _ = self.tell(&mut text);
        text
    }

    fn tell(&self, text: &mut String) -> std::fmt::Result {
        let mut verdicts: BTreeMap<String, usize> = BTreeMap::new();
        for judged in &self.film.frames {
            let verdict = judged.as_ref().map_or_else(|_| "fault".into(), |judged| judged.verdict.to_string());
            *verdicts.entry(verdict).or_default() += 1;
        }
        let verdicts: Vec<String> = verdicts.iter().map(|(verdict, count)| format!("{count} {verdict}")).collect();
        writeln!(text, "{}: {}: {}", self.name, counted(self.frames.len(), "frame"), verdicts.join(", "))?;
        let has_points = |((_, frame), judged): (&(i64, Frame), &Result<_, _>)| {
            frame.points.len() > 2 && frame.points.iter().any(|point| point.sigma.is_none()) && judged.is_ok()
        };
        if self.frames.iter().zip(&self.film.frames).any(has_points) {
            let length = self.rod.rod.length();
            writeln!(
                text,
                "noise of the points: {:.2e} m, {:.1e} of the length",
                self.film.sigma,
                self.film.sigma / length
            )?;
        }
        if let Some(rest) = &self.rest {
            let [base, tip] = [0.0, rest.length].map(|s| rest.curvature(s));
            writeln!(
                text,
                "curvature at rest from {}: {:.4} +- {:.2e} 1/m at the base, {:.4} +- {:.2e} 1/m at the tip",
                counted(rest.frames, "frame"),
                base.0,
                base.1,
                tip.0,
                tip.1
            )?;
        }
        if let Some(pole) = &self.film.pole {
            let [x, y, radius] = pole.sigmas();
            writeln!(
                text,
                "pole: x {:.6} +- {x:.1e} m, y {:.6} +- {y:.1e} m, radius {:.6}{} m; {} at it, {} elsewhere; p {:.2}",
                pole.center[0],
                pole.center[1],
                pole.radius,
                if radius > 0.0 { format!(" +- {radius:.1e}") } else { String::new() },
                counted(pole.frames.len(), "frame"),
                pole.elsewhere.len(),
                pole.p_value
            )?;
        }
        if let Some(families) = self.families() {
            writeln!(text, "{families}")?;
        }
        if !self.rod.is_stiffness_known {
            writeln!(text, "no stiffness is given: forces are in EI/L^2, moments in EI/L, with EI at the base")?;
        }
        Ok(())
    }

    /// The frames whose contact is not determined, and what may determine it.
    fn families(&self) -> Option<String> {
        let count = self.family_count();
        let pole = match self.settings.pole {
            None => "; if all frames touch one round pole, --pole finds it, and with it the forces",
            Some(_) => "",
        };
        (count > 0).then(|| {
            format!(
                "{} of verdict family without a force of their own: many places of the contact, each with its force, explain them{pole}",
                counted(count, "frame")
            )
        })
    }

    /// What may be wrong: frames with faults, frames that nothing explains, a rod of which the points show a part.
    pub fn warnings(&self) -> Vec<String> {
        let mut warnings = Vec::new();
        let numbered = || self.frames.iter().map(|(number, _)| *number).zip(&self.film.frames);
        let faults: Vec<String> = numbered()
            .filter_map(|(number, judged)| judged.as_ref().err().map(|fault| format!("frame {number}: {fault}")))
            .collect();
        warnings.extend(faults.iter().take(MOST_FAULTS).cloned());
        if faults.len() > MOST_FAULTS {
            warnings.push(format!("and {} more", counted(faults.len() - MOST_FAULTS, "frame")));
        }
        let worst = numbered()
            .filter_map(|(number, judged)| Some((number, judged.as_ref().ok()?)))
            .filter(|(_, judged)| judged.verdict == FrameVerdict::NotExplained)
            .min_by(|a, b| a.1.p_value.total_cmp(&b.1.p_value));
        if let Some((number, judged)) = worst {
            let (_, count) = self.failures();
            warnings.push(format!(
                "{} of {} fit no shape with the allowed contacts; the worst is frame {number} with chi squared {:.0} for {} degrees of freedom: \
                 check friction, shape at rest, noise, and whether all points are on the rod",
                count, counted(self.frames.len(), "frame"), judged.chi_squared, judged.freedom
            ));
        }
        if let Some(frame) = self.other_at_rest {
            warnings.push(format!(
                "the frames of the free rod have no common shape: frame {frame} differs most; is the rod free in all of them, and are the points in \
                 order from the base?"
            ));
        }
        warnings.extend(self.pole_in_doubt());
        warnings.extend(self.less_noise());
        warnings.extend(self.much_noise());
        warnings.extend(self.base_in_doubt(["--visible tip", "--channels"]).or_else(|| self.part_of_the_rod()));
        if !self.ignored.is_empty() {
            warnings.push(format!("not used: column {}", self.ignored.join(", ")));
        }
        warnings
    }

    /// A pole that does not explain the frames, or hardly.
    fn pole_in_doubt(&self) -> Vec<String> {
        let Some(prior) = self.settings.pole else { return Vec::new() };
        let Some(pole) = self.film.pole.as_ref() else {
            let alone = "each frame is explained without a pole";
            let has_contacts = self.film.frames.iter().flatten().any(|judged| !judged.contacts.is_empty());
            return match (has_contacts, prior.center.is_some() || prior.radius.is_some()) {
                (false, _) => vec!["no frame has a contact, so that no pole is found".into()],
                (true, true) => vec![format!(
                    "the frames contradict the given pole: {alone}; --pole without numbers looks for the pole of the frames"
                )],
                (true, false) => vec![format!(
                    "no pole explains nine tenths of the frames with a contact: {alone}; is there one round object, and is it fixed?"
                )],
            };
        };
        let numbers = pole.elsewhere.iter().filter_map(|index| Some(self.frames.get(*index)?.0.to_string()));
        let elsewhere: Vec<String> = numbers.collect();
        let elsewhere = (!elsewhere.is_empty())
            .then(|| format!("the contact is not at the pole in frame {}", elsewhere.join(", ")));
        let doubtful = (pole.p_value < DOUBTFUL)
            .then(|| format!("the pole explains the frames with p = {:.3} only: does it move?", pole.p_value));
        elsewhere.into_iter().chain(doubtful).collect()
    }

    /// Points that are far less noisy than they are said to be.
    fn less_noise(&self) -> Option<String> {
        let judged = self.film.frames.iter().flatten().filter(|judged| judged.freedom > 0);
        let mut shares: Vec<f64> = judged.map(|judged| (judged.chi_squared / judged.freedom as f64).sqrt()).collect();
        shares.sort_unstable_by(f64::total_cmp);
        let share = *shares.get(shares.len() / 2)?;
        (self.settings.sigma.is_some() && share < LESS_NOISE).then(|| {
            format!(
                "the noise of the points is {:.0} times smaller than the given standard deviation of {:.2e} m, so that forces may be taken for noise; --sigma is in m, also with --scale",
                1.0 / share.max(1e-9),
                self.film.sigma
            )
        })
    }

    /// Noise that is no noise.
    fn much_noise(&self) -> Option<String> {
        let share = self.film.sigma / self.rod.rod.length();
        (self.settings.sigma.is_none() && share > MUCH_NOISE && self.frames.iter().any(|(_, frame)| frame.points.len() > 3)).then(|| {
            format!(
                "the residuals of the points are {:.1} % of the length, more than the noise of tracked points: are length, shape at rest and scale right?",
                1e2 * share
            )
        })
    }

    /// Forces that depend on whether the first point is the base of the rod: none if the points show that, the base was measured, or neither force
    /// nor moment changes by more than 5 %. A front end has its own names for what states that the tip is seen, and for the measured channels.
    pub fn base_in_doubt(&self, [tip, channels]: [&str; 2]) -> Option<String> {
        let others = self.film.frames.iter().flatten().filter_map(|judged| Some((judged, judged.if_hidden?)));
        let [mut forces, mut moments, mut lengths] = [(); 3].map(|()| Vec::new());
        for (judged, other) in others {
            forces.push(other.force / judged.contacts.first()?.force - 1.0);
            moments.push(other.m0z / judged.reactions.m0z - 1.0);
            lengths.push(1e3 * other.length);
        }
        let count = counted(lengths.len(), "frame");
        let [force, moment, length] = [forces, moments, lengths].map(|mut all| {
            all.sort_unstable_by(f64::total_cmp);
            all.get(all.len() / 2).copied()
        });
        let (force, moment, length) = (force?, moment?, length?);
        (force.abs().max(moment.abs()) > MATTERS).then(|| {
            format!(
                "the first point is taken for the base. If it is not, and the {length:.2} mm of the rod that no point shows are before it, the force \
                 changes by {:+.0} % and the moment at the base by {:+.0} % (medians of {count}). Then use {tip}, or measure the base \
                 (base_x, base_y with {channels}, and an empty first row of each frame)",
                1e2 * force,
                1e2 * moment
            )
        })
    }

    /// A rod of which the points show a part only, or more than there is.
    fn part_of_the_rod(&self) -> Option<String> {
        let mut shares: Vec<f64> = self
            .frames
            .iter()
            .filter(|(_, frame)| frame.points.len() > 2)
            .map(|(_, frame)| {
                let chords = frame.points.windows(2).map(|pair| (pair[1].x - pair[0].x).hypot(pair[1].y - pair[0].y));
                chords.sum::<f64>() / self.rod.rod.length()
            })
            .collect();
        shares.sort_unstable_by(f64::total_cmp);
        let share = *shares.get(shares.len() / 2)?;
        if share > TOO_LONG {
            return Some(format!(
                "the points cover {:.0} % of the rod: are its length and the scale right?",
                1e2 * share
            ));
        }
        let first = &self.frames.iter().find(|(_, frame)| frame.points.len() > 2)?.1;
        let taken = match (first.base_is_first, first.tip_is_last) {
            (true, false) => {
                "the first point is taken for the base, and the tip for hidden; if the base is hidden, use --visible tip; if neither is, the rod is shorter than in its file"
            }
            (false, true) => "the last point is taken for the tip, and the base for hidden",
            _ => return None,
        };
        (share < WHOLE).then(|| format!("the points cover {:.0} % of the rod: {taken}", 1e2 * share))
    }
}
