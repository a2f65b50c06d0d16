//! Axes, signs and units of a recording, by the physics, in words and as options.

use super::frame::{
    Before, Candidate, DIMENSIONS, Hypothesis, MARGIN, NEAR, Rated, ReactionFrame, UNLIKELY, Verdict, slope, verdict,
};
use super::motion::{MOTION, motion};
use super::proposal::Proposal;
use super::report::{Certainty, InspectedFile, Question};
use super::shell_word::quoted;
use std::f64::consts::TAU;
use vibrissa::hw::Unit;
use vibrissa::hw::recording::Role;
use vibrissa::rod::Reactions;
use vibrissa::{Pose, Rod, Sample};

/// Relative difference between the stiffness by the recording and that of the rod from which on it is reported.
const STIFFNESS: f64 = 0.03;

/// Logarithm of the prior probability that x and y of the clamp are exchanged.
const EXCHANGED: f64 = -4.0;

/// Begin of the sentence on columns that are loads.
const LOADS: &str = "the columns are loads on the sensor, the opposite of reactions on the rod:";

/// Units that files have, of lengths, angles, forces and moments, and the logarithms of their prior probabilities.
const UNITS: [&[(&str, f64)]; DIMENSIONS] = [
    &[("m", 0.0), ("mm", 0.0), ("cm", -1.0), ("in", -2.0), ("um", -3.0)],
    &[("rad", 0.0), ("deg", 0.0)],
    &[("N", 0.0), ("mN", 0.0), ("cN", -1.5)],
    &[("N m", 0.0), ("N mm", 0.0), ("N cm", -1.5), ("uN m", -1.0)],
];
/// Logarithms of the prior probabilities of loads, of a sensor turned by quarter turns and of a mirrored one: where the columns have the names of
/// reactions along the axes of the scene, and where they have not.
const OWN_NAMES: [f64; 3] = [-2.3, -2.0, -5.0];
const ANY_NAMES: [f64; 3] = [0.0, -1.0, -2.0];

/// What the reactions are of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Source {
    /// Columns with the names of reactions along the axes of the scene, or given as such.
    OwnNames,
    /// Other columns beside poses.
    OtherNames,
    /// A sensor whose mounting states axes and sense.
    Setup,
    /// A sensor of unknown mounting: the columns are the opposite of what it measures.
    Sensor,
}

impl Source {
    /// Logarithms of the prior probabilities of loads, turns and mirrors.
    fn frames(self) -> [f64; 3] {
        match self {
            Self::OwnNames | Self::Setup => OWN_NAMES,
            Self::OtherNames | Self::Sensor => ANY_NAMES,
        }
    }
}

/// What says the unit of a column.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub(super) enum Says {
    Nothing,
    /// Its values.
    Values,
    /// Its own name, which stands for SI.
    Name,
    /// The file.
    File,
    /// The user.
    User,
}

/// A column of a pose or of reactions.
#[derive(Clone, Debug)]
pub(super) struct Measured {
    pub role: Role,
    pub name: String,
    /// Its number in the table.
    pub column: usize,
    pub unit: Option<&'static str>,
    pub is_turned: bool,
    pub says: Says,
}

impl Measured {
    /// Of [`DIMENSIONS`].
    fn dimension(&self) -> usize {
        match self.role {
            Role::X0 | Role::Y0 => 0,
            Role::Phi0 => 1,
            Role::F0x | Role::F0y => 2,
            _ => 3,
        }
    }
}

/// The units that columns of one dimension may have.
fn candidates(columns: &[Measured; 6], samples: &[Sample], dimension: usize) -> Vec<Candidate> {
    let of = || columns.iter().filter(|column| column.dimension() == dimension);
    let says = of().map(|column| column.says).fold(Says::Nothing, |a, b| if b > a { b } else { a });
    let now = of().find(|column| column.says == says).and_then(|column| column.unit);
    // numbers without a unit are in SI so far
    let known = now.unwrap_or(UNITS[dimension][0].0);
    let one = |unit: &str| Unit::find(unit).map_or(1.0, |unit| unit.factor);
    let less = match says {
        Says::Nothing => 0.0,
        Says::Values => -1.0,
        Says::Name => -3.5,
        Says::File => -8.0,
        Says::User => f64::NEG_INFINITY,
    };
    let first = Candidate { unit: now.unwrap_or(known), factor: 1.0, prior: 0.0 };
    let others = UNITS[dimension].iter().filter(|(unit, _)| (one(unit) / one(known) - 1.0).abs() > 1e-9);
    let others = others.map(|(unit, prior)| Candidate { unit, factor: one(unit) / one(known), prior: prior + less });
    // a clamp does not turn further than once
    let angle = samples.iter().map(|sample| sample.pose.phi.abs()).fold(0.0, f64::max);
    let may_be = |other: &Candidate| other.prior.is_finite() && (dimension != 1 || other.factor * angle <= 1.01 * TAU);
    std::iter::once(first).chain(others.filter(may_be)).collect()
}

/// The best hypothesis, decided or not, as a search for the delay of the stage's clock needs it.
pub(super) struct InFrame {
    best: Rated,
    units: [Vec<Candidate>; DIMENSIONS],
    stiffness: f64,
}

impl InFrame {
    /// Of samples; none where too few are in contact, or no hypothesis explains them.
    pub fn of(samples: &[Sample], columns: &[Measured; 6], source: Source, rod: Option<&Rod>) -> Option<Self> {
        let units = [0, 1, 2, 3].map(|dimension| candidates(columns, samples, dimension));
        let found = verdict(samples, &Before { rod, units: units.clone(), frames: source.frames() })?;
        if !found.best.fits() {
            return None;
        }
        let offset = found.offset.unwrap_or_default();
        let mut frame = Self { best: found.best, units, stiffness: 1.0 };
        let in_si = |sample: &Sample| Sample {
            pose: frame.pose(sample.pose),
            reactions: frame.reactions(less(sample.reactions, offset)),
            ..*sample
        };
        frame.stiffness = match rod {
            Some(rod) if (1.0 / NEAR..NEAR).contains(&frame.best.stiffness) => {
                frame.best.stiffness * rod.bending_stiffness()
            }
            _ => slope(&samples.iter().map(in_si).collect::<Vec<_>>()).filter(|slope| *slope > 0.0)?,
        };
        Some(frame)
    }

    /// How probable it is, but for a constant.
    pub fn score(&self) -> f64 {
        self.best.score()
    }

    /// Bending stiffness of the rod by these samples, N m^2.
    pub fn stiffness(&self) -> f64 {
        self.stiffness
    }

    fn factor(&self, of: usize) -> f64 {
        self.units[of][self.best.hypothesis.units[of]].factor
    }

    /// A pose in SI, m and rad.
    pub fn pose(&self, Pose { x, y, phi }: Pose) -> Pose {
        let [a, b, c] = self.best.hypothesis.reversed.map(|reversed| if reversed { -1.0 } else { 1.0 });
        Pose { x: a * self.factor(0) * x, y: b * self.factor(0) * y, phi: c * self.factor(1) * phi }
    }

    /// Reactions without an offset in SI and in the axes of the scene.
    pub fn reactions(&self, reactions: Reactions) -> Reactions {
        let Reactions { f0x, f0y, m0z } = self.best.hypothesis.frame.of(reactions);
        let (force, moment) = (self.factor(2), self.factor(3));
        Reactions { f0x: force * f0x, f0y: force * f0y, m0z: moment * m0z }
    }

    /// The same of standard deviations: of forces and of moments.
    pub fn noise(&self, [x, y, z]: [f64; 3]) -> [f64; 2] {
        [self.factor(2) * x.max(y), self.factor(3) * z]
    }
}

fn less(Reactions { f0x, f0y, m0z }: Reactions, [x, y, z]: [f64; 3]) -> Reactions {
    Reactions { f0x: f0x - x, f0y: f0y - y, m0z: m0z - z }
}

/// The hypothesis that the physics prefers, where it is decided.
pub(super) struct Preferred {
    pub frame: ReactionFrame,
    hypothesis: Hypothesis,
    units: [Vec<Candidate>; DIMENSIONS],
    are_units_decided: [bool; DIMENSIONS],
}

/// Tests all hypotheses, reports which one the physics prefers, and asks where it does not decide.
pub(super) fn physics(
    file: &mut InspectedFile,
    samples: &[Sample],
    columns: &[Measured; 6],
    source: Source,
    rod: Option<&Rod>,
) -> Option<Preferred> {
    let units = [0, 1, 2, 3].map(|dimension| candidates(columns, samples, dimension));
    let frames = source.frames();
    let is_own = frames == OWN_NAMES;
    let is_given = columns[3..].iter().all(|column| column.says == Says::User);
    let names = [3, 4, 5].map(|k: usize| columns[k].name.as_str());
    let before = Before { rod, units: units.clone(), frames };
    let Some(found) = verdict(samples, &before) else {
        file.fact(
            "frame",
            "not checked: too few samples in contact beyond the noise, or no line of tangential contacts",
        );
        if !is_own {
            ask(file, names);
        } else if rod.is_none() && !is_given {
            untested(file, columns);
        }
        return None;
    };
    if let Some([x, y, z]) = found.offset {
        let [a, b, c] = names;
        let text = format!(
            "{a} {x:.3e}, {b} {y:.3e}, {c} {z:.3e} at the start, where nothing changes: not tared; subtracted for the frame, and \
             estimated by `reconstruct`"
        );
        file.fact("offset", text);
    }
    report(file, &found, columns, source, rod.is_some());
    for (column, of) in columns.iter().zip([|pose: &Pose| pose.x, |pose: &Pose| pose.y]) {
        let first = samples.first().map_or(0.0, |sample| of(&sample.pose));
        if first != 0.0 && column.says < Says::Name && samples.iter().all(|sample| of(&sample.pose) == first) {
            let text = format!(
                "the unit of `{}`: it stays the same, so that nothing tests it; it is taken for that of the other coordinate",
                column.name
            );
            file.fact("not checked", text);
        }
    }
    let best = &found.best;
    if !best.fits() {
        if !is_given {
            misfit(file, best, columns);
            exchange(file, samples, &before, best, columns);
        }
        return None;
    }
    stiffness(file, best, rod);
    if let Some(degrees) = found.oblique
        && !is_given
    {
        turned(file, degrees, columns);
        return None;
    }
    if !found.is_decided {
        if !is_given {
            choose(file, &found, columns, &units);
            exchange(file, samples, &before, best, columns);
        }
        return None;
    }
    for dimension in 0..DIMENSIONS {
        let of = || columns.iter().filter(move |column| column.dimension() == dimension);
        let says = of().map(|column| column.says).fold(Says::Nothing, |a, b| if b > a { b } else { a });
        let asked = |question: &Question| of().any(|column| question.text.starts_with(&unit_question(&column.name)));
        // without a rod the size of forces and moments says nothing but their ratio
        if found.are_units_decided[dimension] && (dimension < 2 || rod.is_some()) {
            file.questions.retain(|question| !asked(question));
            let unit = units[dimension][best.hypothesis.units[dimension]].unit;
            if best.hypothesis.units[dimension] != 0 && says == Says::File {
                contradicted(file, of().map(|column| column.name.as_str()).collect(), unit);
            }
        } else if (!found.are_units_decided[dimension] || best.hypothesis.units[dimension] != 0)
            && says > Says::Nothing
            && !is_given
        {
            for column in of() {
                if !file.questions.iter().any(|question| question.text.starts_with(&unit_question(&column.name))) {
                    let text = format!("{} the physics fits others, too, or better", unit_question(&column.name));
                    let answer =
                        |one: &Candidate| format!("--unit {}", quoted(&format!("{}={}", column.name, one.unit)));
                    let answers = units[dimension].iter().map(answer).collect();
                    file.questions.push(Question { text, answers });
                }
            }
        }
    }
    if best.prior < UNLIKELY && file.questions.is_empty() && !is_given {
        choose(file, &found, columns, &units);
        exchange(file, samples, &before, best, columns);
        return None;
    }
    if let Some(rod) = rod
        && !(1.0 / NEAR..NEAR).contains(&best.stiffness)
        && !is_given
    {
        file.questions.push(other_rod(names, best.stiffness, rod));
    }
    if rod.is_some() && [2, 3].iter().any(|of| best.hypothesis.units[*of] != 0) {
        let [force, moment] = [2, 3].map(|of: usize| units[of][best.hypothesis.units[of]].unit);
        file.fact("units", format!("the stiffness of the rod fits forces in {force} and moments in {moment}"));
    }
    let mut are_units_decided = found.are_units_decided;
    if rod.is_none() {
        (are_units_decided[2], are_units_decided[3]) = (false, false);
    }
    Some(Preferred { frame: best.hypothesis.frame, hypothesis: best.hypothesis, units, are_units_decided })
}

/// How the question for the unit of a column begins.
pub(super) fn unit_question(name: &str) -> String {
    format!("in which unit is `{name}`?")
}

/// The hypothesis in words, with how well it agrees.
fn agreement(rated: &Rated, columns: &[Measured; 6]) -> String {
    let names = [3, 4, 5].map(|k: usize| columns[k].name.as_str());
    let reversed = (0..3).filter(|k| rated.hypothesis.reversed[*k]);
    let reversed: String = reversed.map(|k| format!(", {} reversed", columns[k].name)).collect();
    let (explained, energy) = (100.0 * rated.explained, rated.energy);
    format!(
        "{}{reversed}: a rod with one contact explains {explained:.0} % of the samples in contact, and the work of the clamp follows the elastic energy by {energy:+.2} \
         (1: wholly, 0: not at all)",
        rated.hypothesis.frame.text(names)
    )
}

fn report(file: &mut InspectedFile, found: &Verdict, columns: &[Measured; 6], source: Source, has_rod: bool) {
    let best = &found.best;
    let of = if has_rod { "" } else { ", with stiffness and length as the recording suggests" };
    let next =
        found.others.first().map_or_else(String::new, |next| format!("; next best {}", agreement(next, columns)));
    let Hypothesis { frame, reversed, .. } = best.hypothesis;
    let is_as_is = frame.is_as_is() && reversed == [false; 3];
    let is_load = frame.is_load() && reversed == [false; 3];
    let begin = match (best.fits(), found.is_decided) {
        (false, _) => "no axes, signs and units agree with the physics, see the questions below; the best",
        (true, false) => "the physics does not determine axes and signs, see the questions below: it fits",
        (true, true) if is_as_is && source == Source::Sensor => LOADS,
        (true, true) if is_load && source == Source::Sensor => "the columns are reactions on the rod:",
        (true, true) if is_as_is => "the physics confirms, nothing to correct:",
        (true, true) if is_load => LOADS,
        (true, true) => "the physics prefers",
    };
    file.fact("frame", format!("{begin} {}{next}{of}", agreement(best, columns)));
}

fn stiffness(file: &mut InspectedFile, best: &Rated, rod: Option<&Rod>) {
    let Some(rod) = rod else { return };
    let ratio = best.stiffness;
    if (ratio - 1.0).abs() > STIFFNESS {
        let found = format!(
            "{:.4e} N m^2 by the line of tangential contacts, {ratio:.3} times that of the rod",
            ratio * rod.bending_stiffness()
        );
        file.fact("stiffness", found);
    }
}

/// The question where nothing explains the reactions.
fn misfit(file: &mut InspectedFile, best: &Rated, columns: &[Measured; 6]) {
    let text = format!(
        "no axes, signs and units explain the reactions (at best {:.0} % of the contact, and a concordance of work and energy of {:+.2}): is the sensor \
         turned by no multiple of 90 degrees, its origin not at the clamp, phi0 not the angle of the rod at the clamp, another rod in it, \
         an offset, much friction?",
        100.0 * best.explained,
        best.energy
    );
    file.questions.push(Question { text, answers: vec![as_they_are(columns)] });
}

/// The question where forces that are turned explain more.
fn turned(file: &mut InspectedFile, degrees: f64, columns: &[Measured; 6]) {
    let [x, y] = [3, 4].map(|k: usize| columns[k].name.as_str());
    let text = format!(
        "is the sensor turned about z by no multiple of 90 degrees? The physics fits better if the forces `{x}`, `{y}` are turned by about {degrees:.0} degrees \
         counter-clockwise into the axes of the scene; friction and a rod that tapers may seem so, too"
    );
    let answers = vec![
        "--setup FILE with angle = DEGREES in [mounting] (of a sensor with --stage), or forces in the axes of the poses".to_owned(),
        as_they_are(columns),
    ];
    file.questions.push(Question { text, answers });
}

/// The question where nothing tests the names of the columns.
fn untested(file: &mut InspectedFile, columns: &[Measured; 6]) {
    let text = "do the forces and the moment lie along the axes of the poses, as their names state? Without the rod nothing tests axes, signs and units".to_owned();
    file.questions.push(Question { text, answers: vec!["--rod FILE".to_owned(), as_they_are(columns)] });
}

/// The option that settles everything: all units of the reactions.
fn as_they_are(columns: &[Measured; 6]) -> String {
    let units = columns[3..].iter().map(|column| {
        let sign = if column.is_turned { "-" } else { "" };
        let unit = column.unit.map_or_else(|| "UNIT".to_owned(), |unit| format!("{sign}{unit}"));
        format!("--unit {}", quoted(&format!("{}={unit}", column.name)))
    });
    format!("{} (all is as it is written)", units.collect::<Vec<_>>().join(" "))
}

/// The question where several hypotheses are about as probable.
fn choose(file: &mut InspectedFile, found: &Verdict, columns: &[Measured; 6], units: &[Vec<Candidate>; DIMENSIONS]) {
    let near = found.others.iter().take_while(|other| found.best.score() - other.score() < MARGIN);
    let all: Vec<&Rated> = std::iter::once(&found.best).chain(near).collect();
    let answers = all.iter().map(|rated| {
        let options = options(columns, &rated.hypothesis, units);
        let options = if options.is_empty() { as_they_are(columns) } else { options.join(" ") };
        format!("{}: {options}", agreement(rated, columns))
    });
    let text = "which is it? The physics does not determine, or hardly, which columns are reversed".to_owned();
    file.questions.push(Question { text, answers: answers.collect() });
}

/// Offers the exchange of x and y of the clamp, as the first answer to the last question, where that explains the samples better than the best
/// hypothesis, its smaller prior probability included.
fn exchange(file: &mut InspectedFile, samples: &[Sample], before: &Before<'_>, best: &Rated, columns: &[Measured; 6]) {
    let exchanged = |sample: &Sample| {
        let Pose { x, y, phi } = sample.pose;
        Sample { pose: Pose { x: y, y: x, phi }, ..*sample }
    };
    let samples: Vec<Sample> = samples.iter().map(exchanged).collect();
    let Some(found) = verdict(&samples, before) else { return };
    let Hypothesis { frame, reversed, .. } = found.best.hypothesis;
    // two mistakes at once explain much
    let is_alone = (frame.is_as_is() || frame.is_load()) && reversed == [false; 3];
    if !is_alone || !found.best.fits() || found.best.score() + EXCHANGED <= best.score() {
        return;
    }
    let mut swapped = columns.clone();
    let [x, y] = [0, 1].map(|k: usize| columns[k].name.clone());
    (swapped[0].name, swapped[1].name) = (y.clone(), x.clone());
    let Some(question) = file.questions.last_mut() else { return };
    let mut words =
        vec![format!("--column {}", quoted(&format!("x0={y}"))), format!("--column {}", quoted(&format!("y0={x}")))];
    words.extend(options(&swapped, &found.best.hypothesis, &before.units));
    let text = format!("`{x}` and `{y}` exchanged, {}: {}", agreement(&found.best, &swapped), words.join(" "));
    question.answers.insert(0, text);
}

/// Options for axes and signs of a hypothesis, and for the units that it changes.
fn options(columns: &[Measured; 6], hypothesis: &Hypothesis, units: &[Vec<Candidate>; DIMENSIONS]) -> Vec<String> {
    let mut options = Vec::new();
    for (place, (column, is_turned, unit)) in as_hypothesis(columns, hypothesis, units).into_iter().enumerate() {
        if column.name != columns[place].name {
            options.push(format!("--column {}", quoted(&format!("{}={}", column.role, column.name))));
        }
        if is_turned != column.is_turned || Some(unit) != column.unit || column.name != columns[place].name {
            let sign = if is_turned { "-" } else { "" };
            options.push(format!("--unit {}", quoted(&format!("{}={sign}{unit}", column.name))));
        }
    }
    options
}

/// The columns with their roles, signs and units under a hypothesis.
fn as_hypothesis(
    columns: &[Measured; 6],
    hypothesis: &Hypothesis,
    units: &[Vec<Candidate>; DIMENSIONS],
) -> Vec<(Measured, bool, &'static str)> {
    let order = if hypothesis.frame.swapped { [0, 1, 2, 4, 3, 5] } else { [0, 1, 2, 3, 4, 5] };
    let turns = [hypothesis.reversed, hypothesis.frame.turned].concat();
    let of = |(place, turned): (usize, bool)| {
        let role = columns[place].role;
        let column = Measured { role, ..columns[order[place]].clone() };
        let of = column.dimension();
        let chosen = hypothesis.units[of];
        let unit = if chosen == 0 { column.unit.unwrap_or(units[of][0].unit) } else { units[of][chosen].unit };
        let is_turned = turned != column.is_turned;
        (column, is_turned, unit)
    };
    turns.into_iter().enumerate().map(of).collect()
}

/// The question where the units that the file states contradict the physics.
fn contradicted(file: &mut InspectedFile, names: Vec<&str>, unit: &str) {
    let listed = names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
    let text = format!("the file states another unit, but the physics fits {listed} in {unit}: which is right?");
    let answer = |name: &&str| format!("--unit {} (or the unit as it is written)", quoted(&format!("{name}={unit}")));
    file.questions.push(Question { text, answers: names.iter().map(answer).collect() });
}

/// The question where the stiffness is not that of the rod.
fn other_rod([x, y, z]: [&str; 3], ratio: f64, rod: &Rod) -> Question {
    let stiffness = rod.bending_stiffness();
    Question {
        text: format!(
            "the reactions give {ratio:.3e} times the bending stiffness of the rod ({stiffness:.4e} N m^2): is it another rod, or is a unit wrong? \
             Forces in mN taken for N give 1e-3, moments in N mm taken for N m give 1e6"
        ),
        answers: vec![format!(
            "{} (as they are, if the rod is another one)",
            [x, y, z].map(|name| format!("--unit {}", quoted(&format!("{name}=...")))).join(" ")
        )],
    }
}

/// The question for axes and signs.
fn ask(file: &mut InspectedFile, [x, y, z]: [&str; 3]) {
    file.questions.push(Question {
        text: format!("are `{x}`, `{y}`, `{z}` reactions of the clamp on the rod, along the axes of the poses, or loads on the sensor?"),
        answers: vec![
            format!("reactions: --column {}", quoted(&format!("f0x={x}"))),
            format!(
                "loads: --column {} --unit {} (and so on: a minus turns the sign)",
                quoted(&format!("f0x={x}")),
                quoted(&format!("{x}=-N"))
            ),
        ],
    });
}

impl Preferred {
    /// Puts roles, signs and units of some of the columns into the options of their table.
    pub fn apply(
        &self,
        file: &mut InspectedFile,
        proposal: &mut Proposal,
        columns: &[Measured; 6],
        samples: &[Sample],
        only: std::ops::Range<usize>,
    ) {
        let mut changed = Vec::new();
        for (place, (column, is_turned, unit)) in
            as_hypothesis(columns, &self.hypothesis, &self.units).into_iter().enumerate()
        {
            let of = column.dimension();
            if !only.contains(&place) {
                continue;
            }
            // a column that is not what its own name says has no unit without a word
            let is_renamed = self.hypothesis.frame.swapped && of == 2;
            let is_sign = is_turned != column.is_turned;
            let is_unit = self.are_units_decided[of] && Some(unit) != column.unit;
            if is_renamed {
                proposal.set_column(column.role, &column.name);
            }
            let Some(unit) = (if self.are_units_decided[of] { Some(unit) } else { column.unit }) else { continue };
            if !(is_renamed || is_sign || is_unit) {
                continue;
            }
            let signed = format!("{}{unit}", if is_turned { "-" } else { "" });
            if let Some(described) = file.columns.get_mut(column.column) {
                described.meaning = Some(column.role.to_string());
                described.unit = Some(signed.clone());
                described.unit_certainty = Certainty::Likely;
                if is_unit {
                    "the physics of the contacts".clone_into(&mut described.unit_why);
                }
            }
            if column.says >= Says::Name {
                changed.push(format!("{} = {signed} of `{}`", column.role, column.name));
            }
            proposal.set_unit(&column.name, signed);
        }
        let pose = |sample: &Sample| {
            let sign = |k: usize| if self.hypothesis.reversed[k] { -1.0 } else { 1.0 };
            let one = |of: usize| self.units[of][self.hypothesis.units[of]].factor;
            let Pose { x, y, phi } = sample.pose;
            Pose { x: sign(0) * one(0) * x, y: sign(1) * one(0) * y, phi: sign(2) * one(1) * phi }
        };
        let path = motion(&samples.iter().map(pose).collect::<Vec<_>>());
        if let Some(fact) = file.facts.iter_mut().find(|fact| fact.what == MOTION)
            && let Some(path) = path
        {
            fact.found = path;
        }
        if !changed.is_empty() {
            file.fact("CHANGED", format!("against the names and units of the columns: {}", changed.join(", ")));
        }
    }
}
