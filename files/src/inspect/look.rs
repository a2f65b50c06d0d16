//! A look at one file.

use super::InspectOptions;
use super::binary;
use super::layout::layout;
use super::motion::{MOTION, motion};
use super::physics::{Measured, Says, unit_question};
use super::proposal::{Proposal, name_of};
use super::report::{Certainty, InspectedColumn, InspectedFile, Question};
use super::rows::rows;
use super::shell_word::quoted;
use super::tracked::{Tracked, tracked};
use super::unnamed::{behaviour, behaviour_text, mark_open, suppose, with_supposed};
use super::values::{channel, of_scan, poses};
use crate::ReadOptions;
use std::path::{Path, PathBuf};
use vibrissa::hw::recording::{
    ColumnGuess, ColumnMap, Header, Quantity, Role, Sureness, Table, TableGuess, TableKind, guess,
};
use vibrissa::hw::{Dimension, Unit};
use vibrissa::reconstruct::noise_estimate::estimate;

/// Fewest rows of a recording: fewer say nothing of axes, signs and noise.
pub(super) const FEWEST: usize = 16;
/// Fewest rows of a stage: the ends of its motion.
const FEWEST_POSES: usize = 2;

/// What a file is for.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Content {
    /// Reactions with poses.
    Reactions,
    /// Forces and moments of a sensor.
    Wrench,
    /// Poses with times.
    Stage,
    /// Raw values.
    Raw,
    /// Points on a rod.
    Frames,
    /// Body parts in a video.
    Tracked(Tracked),
    /// Wrenches of a topic (MCAP).
    Topic(String),
    /// None of these, or it cannot be read.
    Other,
}

/// A file that was looked at, with what its command needs.
#[derive(Debug)]
pub(super) struct Look {
    pub path: PathBuf,
    pub report: InspectedFile,
    pub content: Content,
    pub table: Option<(Table, TableGuess)>,
    pub proposal: Proposal,
}

impl Look {
    pub fn at(path: &Path, read: &ReadOptions) -> Self {
        let file = path.display().to_string();
        let mut look = Self {
            path: path.to_path_buf(),
            report: InspectedFile { file, ..InspectedFile::default() },
            content: Content::Other,
            table: None,
            proposal: Proposal { layout: read.options.clone(), columns: Vec::new(), units: Vec::new() },
        };
        let starts = |magic: &[u8]| starts_with(path, magic);
        if starts(b"TDSm") {
            look.content = Content::Raw;
            binary::tdms(path, &mut look.report);
        } else if starts(b"\x89MCAP") {
            look.content = binary::mcap(path, &mut look.report).map_or(Content::Other, Content::Topic);
        } else if let Some(tracked) = tracked(path, &mut look.report) {
            look.report.kind = tracked.kind();
            tracked.ask(&mut look.report);
            look.content = Content::Tracked(tracked);
        } else {
            look.table(read);
        }
        look
    }

    fn table(&mut self, read: &ReadOptions) {
        "no table".clone_into(&mut self.report.kind);
        let Some((table, header, read)) = layout(&self.path, read, &mut self.report) else { return };
        let read = &read;
        self.proposal.layout.header = header;
        self.proposal.layout.units.clear();
        self.proposal.layout.constants.clone_from(&read.options.constants);
        let is_named = self.proposal.layout.header != Header::None;
        let mut found = guess(&table, is_named, &read.columns);
        let supposed = suppose(&table, &found);
        if !supposed.is_empty() {
            found = guess(&table, is_named, &with_supposed(&read.columns, &table, &supposed));
            mark_open(&mut found, &supposed);
        }
        let without_poses = wrench_of_reactions(&table, &found, &read.columns);
        if let Some(map) = without_poses {
            let known = found;
            found = guess(&table, is_named, &map);
            // their names stand for SI units, as beside poses
            for (column, known) in found.columns.iter_mut().zip(known.columns) {
                if column.unit.is_none() && known.is_unit_known {
                    (column.unit, column.unit_basis, column.is_unit_known) = (known.unit, known.unit_basis, true);
                }
            }
        }
        let guess = found;
        self.content = match guess.kind {
            TableKind::Reactions => Content::Reactions,
            TableKind::Wrench => Content::Wrench,
            TableKind::Stage => Content::Stage,
            TableKind::Raw => Content::Raw,
            TableKind::Frames => Content::Frames,
            TableKind::Other => Content::Other,
        };
        self.report.kind = match self.content {
            Content::Reactions => "forces and moments with the poses of the clamp",
            Content::Wrench => "forces and moments of a sensor, without poses",
            Content::Stage => "poses of the clamp, without forces: a stage",
            Content::Raw => "raw values of a sensor",
            Content::Frames => "points on the rod, frame by frame",
            Content::Topic(_) | Content::Tracked(_) | Content::Other => "no columns that are understood",
        }
        .to_owned();
        rows(&mut self.report, &table, &guess);
        if let Some(path) = poses(&table, &guess).and_then(|poses| motion(&poses)) {
            self.report.fact(MOTION, path);
        }
        let of_scan = of_scan(&table, &guess);
        self.report.columns = guess.columns.iter().map(|column| described(&table, &of_scan, column)).collect();
        if guess.columns.iter().any(|column| column.role.is_none() || column.meaning.sureness == Sureness::Open) {
            let times = channel(&table, &guess, Role::Time);
            for (described, column) in self.report.columns.iter_mut().zip(&guess.columns) {
                let found = behaviour(&table, column);
                described.behaviour = found.map(|found| behaviour_text(&found, times.as_deref()));
            }
        }
        if self.content == Content::Frames {
            of_frames(&mut self.report, &guess);
        }
        self.propose(&table, &guess, read);
        let needs_rows = matches!(self.content, Content::Reactions | Content::Wrench | Content::Raw | Content::Stage);
        let fewest = if self.content == Content::Stage { FEWEST_POSES } else { FEWEST };
        if needs_rows && table.len() < fewest {
            let expected = format!("at least {fewest} rows of numbers below the names");
            self.report.prevents(table.header_line(), "rows", table.len().to_string(), expected);
        }
        if self.content == Content::Other {
            let found: Vec<&str> = table.columns().iter().map(|column| column.heading.as_str()).take(20).collect();
            let expected =
                "times with poses, forces and moments, raw values, or points; name them with --column MEANING=COLUMN";
            self.report.prevents(table.header_line(), "columns", found.join(", "), expected);
        }
        self.table = Some((table, guess));
    }

    /// The options for the columns, and the questions that remain.
    fn propose(&mut self, table: &Table, guess: &TableGuess, read: &ReadOptions) {
        let is_given = |name: &str| read.options.units.iter().any(|(column, _)| column == name);
        for column in guess.columns.iter().filter(|column| column.role.is_some()) {
            let Some(role) = column.role else { continue };
            let name = name_of(table, column.column);
            let is_given_role = read.columns.assigned().any(|(assigned, _)| assigned == role);
            // a reader takes reactions for what their own names say, and a wrench beside poses for nothing
            if !column.is_recognized || is_given_role {
                self.proposal.set_column(role, &name);
            }
            if column.meaning.sureness == Sureness::Open {
                let why =
                    if column.meaning.why.is_empty() { String::new() } else { format!(" {}", column.meaning.why) };
                let text = format!("is `{name}` {role}?{why}");
                self.report
                    .questions
                    .push(Question { text, answers: vec![format!("--column {}", quoted(&format!("{role}={name}")))] });
            }
            // no recording needs a temperature
            let Some(dimension) = role.dimension().filter(|of| *of != Dimension::Temperature) else { continue };
            match column.unit {
                Some(unit) if !column.is_unit_known && !is_given(&name) => {
                    self.proposal.set_unit(&name, unit.to_owned())
                }
                Some(_) => {}
                None => self.report.questions.push(ask_unit(column, &name, dimension)),
            }
        }
        for (name, unit) in &read.options.units {
            self.proposal.set_unit(name, unit.clone());
        }
        let needed: &[Role] = match self.content {
            Content::Reactions => &[Role::X0, Role::Y0, Role::Phi0, Role::F0x, Role::F0y, Role::M0z],
            Content::Stage => &[Role::Time, Role::X0, Role::Y0, Role::Phi0],
            Content::Wrench => &[Role::Time],
            _ => &[],
        };
        let missing: Vec<&str> =
            needed.iter().filter(|role| guess.of(**role).is_none()).map(|role| role.name()).collect();
        if !missing.is_empty() {
            let found: Vec<&str> = table.columns().iter().map(|column| column.heading.as_str()).take(20).collect();
            let expected = format!(
                "a column for each of {}; name it with --column {}=COLUMN, or add it{}",
                missing.join(", "),
                missing[0],
                if missing.iter().any(|name| matches!(*name, "x0" | "y0" | "phi0")) {
                    format!(
                        "; a coordinate or angle that stays the same needs no column: --column {}",
                        if missing.contains(&"phi0") { "phi0=90deg" } else { "y0=-40mm" }
                    )
                } else {
                    String::new()
                }
            );
            self.report.prevents(
                table.header_line(),
                missing.join(", "),
                format!("found {}", found.join(", ")),
                expected,
            );
        }
    }

    /// A column of a pose or of reactions; none where there is no such column.
    pub fn measured(&self, role: Role, options: &InspectOptions) -> Option<Measured> {
        let (table, guess) = self.table.as_ref()?;
        let column = guess.of(role)?;
        let name = name_of(table, column.column);
        let heading = &table.columns()[column.column];
        let read = [Some(&options.read), options.read.stage.as_deref()];
        let mut given = read.into_iter().flatten().flat_map(|read| &read.options.units);
        let says = if given.any(|(name, _)| heading.name == *name || heading.heading == *name) {
            Says::User
        } else if column.is_unit_written {
            Says::File
        } else if column.is_unit_known {
            Says::Name
        } else if column.unit.is_some() {
            Says::Values
        } else {
            Says::Nothing
        };
        Some(Measured { role, name, column: column.column, unit: column.unit, is_turned: column.is_turned, says })
    }

    /// First and last time, s; none where they are not known.
    pub fn times(&self) -> Option<[f64; 2]> {
        let unit = self.table.as_ref()?.1.of(Role::Time)?.unit;
        self.times_in(unit.unwrap_or("s"))
    }

    /// The same if the times are in this unit.
    pub fn times_in(&self, unit: &str) -> Option<[f64; 2]> {
        let values = &self.table.as_ref()?.1.of(Role::Time)?.values;
        let factor = Unit::find(unit)?.factor;
        (values.numbers > 0).then_some([factor * values.least, factor * values.most])
    }

    /// The units that times may have: that which is written, or else the guess and all others.
    pub fn time_units(&self) -> Vec<&'static str> {
        let Some(column) = self.table.as_ref().and_then(|table| table.1.of(Role::Time)) else { return Vec::new() };
        let guess = column.unit.into_iter();
        if column.is_unit_written {
            return guess.collect();
        }
        guess.chain(["s", "ms", "us"].into_iter().filter(|unit| Some(*unit) != column.unit)).collect()
    }

    /// Sets the unit of the times, by those of another file.
    pub fn set_time_unit(&mut self, unit: &'static str) {
        let Some((table, guess)) = &mut self.table else { return };
        let Some(column) = guess.columns.iter_mut().find(|column| column.role == Some(Role::Time)) else { return };
        let name = name_of(table, column.column);
        let asked = unit_question(&name);
        self.report.questions.retain(|question| !question.text.starts_with(&asked));
        if column.unit == Some(unit) {
            return;
        }
        column.unit = Some(unit);
        self.proposal.set_unit(&name, unit.to_owned());
        if let Some(described) = self.report.columns.get_mut(column.column) {
            (described.unit, described.unit_certainty) = (Some(unit.to_owned()), Certainty::Likely);
            "the times of the other file".clone_into(&mut described.unit_why);
        }
        self.report.facts.retain(|fact| fact.what != "rate");
        let step = Unit::find(unit).map_or(1.0, |unit| unit.factor) * column.values.step;
        self.report.fact("rate", format!("{:.6} Hz, by `{name}` in {unit}", 1.0 / step));
    }
}

/// Reactions without poses are components of a wrench: the setup states that they are reactions. None where a table has none.
fn wrench_of_reactions(table: &Table, guess: &TableGuess, map: &ColumnMap) -> Option<ColumnMap> {
    let pairs = [(Role::F0x, Role::Fx), (Role::F0y, Role::Fy), (Role::M0z, Role::Tz)];
    let found: Vec<(Role, String)> = pairs
        .iter()
        .filter(|(_, component)| guess.of(*component).is_none())
        .filter_map(|(reaction, component)| Some((*component, name_of(table, guess.of(*reaction)?.column))))
        .collect();
    let is_wrench = guess.kind == TableKind::Wrench && !found.is_empty();
    is_wrench.then(|| {
        let others = map.assigned().filter(|(role, _)| pairs.iter().all(|pair| pair.0 != *role));
        let others = others.fold(ColumnMap::new(), |map, (role, name)| map.with(role, name));
        found.into_iter().fold(others, |map, (role, name)| map.with(role, name))
    })
}

fn starts_with(path: &Path, magic: &[u8]) -> bool {
    use std::io::Read;
    let mut start = vec![0; magic.len()];
    std::fs::File::open(path).and_then(|mut file| file.read_exact(&mut start)).is_ok() && start == magic
}

fn ask_unit(column: &ColumnGuess, name: &str, dimension: Dimension) -> Question {
    let units: &[&str] = match dimension {
        Dimension::Force => &["N", "mN"],
        Dimension::Torque => &["N m", "mN m", "N mm"],
        Dimension::Length => &["m", "mm", "cm", "in"],
        Dimension::Angle => &["rad", "deg"],
        Dimension::Time => &["s", "ms"],
        // no column of a recording is measured in the others
        _ => &[],
    };
    let text = format!("{} {}", unit_question(name), column.unit_basis.why);
    Question {
        text,
        answers: units.iter().map(|unit| format!("--unit {}", quoted(&format!("{name}={unit}")))).collect(),
    }
}

pub(super) fn certainty(sureness: Sureness) -> Certainty {
    match sureness {
        Sureness::Sure => Certainty::Sure,
        Sureness::Likely => Certainty::Likely,
        Sureness::Open => Certainty::Open,
    }
}

/// The meanings of columns of points.
fn of_frames(file: &mut InspectedFile, guess: &TableGuess) {
    for (described, column) in file.columns.iter_mut().zip(&guess.columns) {
        // the unit of x and y is an option of the command, treated separately
        (described.unit, described.unit_why) = (None, String::new());
        described.unit_certainty = Certainty::Sure;
        described.meaning = match (column.quantity, column.axis) {
            (Some(Quantity::Frame), _) => Some("frame".to_owned()),
            (Some(Quantity::Position), Some(0)) => Some("x".to_owned()),
            (Some(Quantity::Position), Some(1)) => Some("y".to_owned()),
            _ => None,
        };
    }
}

fn described(table: &Table, of_scan: &[bool], column: &ColumnGuess) -> InspectedColumn {
    let values = &column.values;
    let rows = table.rows().zip(of_scan).filter(|(_, is_of_scan)| **is_of_scan);
    let numbers: Vec<f64> = rows.filter_map(|(row, _)| row.number(column.column).ok()).collect();
    let has_numbers = !numbers.is_empty();
    let (least, most) = numbers.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(*v), b.max(*v)));
    let is_load = matches!(column.quantity, Some(Quantity::Force | Quantity::Torque | Quantity::Raw));
    let noise = (is_load && values.numbers > 8).then(|| {
        let count: Vec<f64> = (0..numbers.len()).map(|k| k as f64).collect();
        estimate(&count, &numbers).sigma
    });
    let unit = column.unit.and_then(Unit::find).map(|unit| unit.name.to_owned());
    InspectedColumn {
        name: table.columns()[column.column].heading.clone(),
        meaning: column.role.map(|role| role.name().to_owned()),
        meaning_certainty: certainty(column.meaning.sureness),
        meaning_why: column.meaning.why.clone(),
        unit: unit.map(|unit| if column.is_turned { format!("-{unit}") } else { unit }),
        unit_certainty: certainty(column.unit_basis.sureness),
        unit_why: column.unit_basis.why.clone(),
        least: has_numbers.then_some(least),
        most: has_numbers.then_some(most),
        noise,
        behaviour: None,
    }
}
