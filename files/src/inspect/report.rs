//! The result of a look at files.

use serde::Serialize;

/// How sure a statement is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Certainty {
    /// The file or the user says so.
    Sure,
    /// It is suggested, and nothing contradicts.
    Likely,
    /// It must be answered.
    Open,
}

/// What was found, and why.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Fact {
    /// Of what.
    pub what: String,
    /// What was found.
    pub found: String,
}

/// A column of a table.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct InspectedColumn {
    /// What stands above it.
    pub name: String,
    /// Its meaning, as `f0x`; none where it is not used.
    pub meaning: Option<String>,
    /// How sure the meaning is.
    pub meaning_certainty: Certainty,
    /// Why.
    pub meaning_why: String,
    /// Its unit, perhaps with a minus that turns its sign.
    pub unit: Option<String>,
    /// How sure the unit is.
    pub unit_certainty: Certainty,
    /// Why.
    pub unit_why: String,
    /// Least number.
    pub least: Option<f64>,
    /// Largest number.
    pub most: Option<f64>,
    /// Standard deviation of the noise of a force or moment, in the unit of the column.
    pub noise: Option<f64>,
    /// How its values go on, as `linear`, `constant` or `at rest until 3.2 s`, where the meaning of a column of the table is not known.
    pub behaviour: Option<String>,
}

/// Something to be mended in a file.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct InspectFault {
    /// Its line, where one is to blame.
    pub line: Option<u64>,
    /// The column or part of the file.
    pub field: String,
    /// What is there.
    pub value: String,
    /// What is expected.
    pub expected: String,
    /// Whether the file cannot be read before it is mended; otherwise rows are left out.
    pub prevents: bool,
}

/// Something that only the user knows.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Question {
    /// The question.
    pub text: String,
    /// The options that answer it.
    pub answers: Vec<String>,
}

/// A file that was looked at.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct InspectedFile {
    /// Its name.
    pub file: String,
    /// What it is of, in words.
    pub kind: String,
    /// Layout, rate, gaps, motion, frame.
    pub facts: Vec<Fact>,
    /// Its columns.
    pub columns: Vec<InspectedColumn>,
    /// What must be mended.
    pub faults: Vec<InspectFault>,
    /// What must be answered.
    pub questions: Vec<Question>,
    /// Line of a second table, below which the rows are those of that.
    #[serde(skip)]
    pub(super) first_other: Option<u64>,
}

impl InspectedFile {
    pub(super) fn fact(&mut self, what: &str, found: impl Into<String>) {
        self.facts.push(Fact { what: what.to_owned(), found: found.into() });
    }

    pub(super) fn fault(
        &mut self,
        line: impl Into<Option<u64>>,
        field: impl Into<String>,
        value: impl Into<String>,
        expected: impl Into<String>,
    ) {
        let (line, field, value, expected) = (line.into(), field.into(), value.into(), expected.into());
        let is_of_other = line.zip(self.first_other).is_some_and(|(line, other)| line >= other) && field != "table";
        if is_of_other {
            return;
        }
        self.faults.push(InspectFault { line, field, value, expected, prevents: false });
    }

    pub(super) fn prevents(
        &mut self,
        line: impl Into<Option<u64>>,
        field: impl Into<String>,
        value: impl Into<String>,
        expected: impl Into<String>,
    ) {
        let count = self.faults.len();
        self.fault(line, field, value, expected);
        self.faults[count..].iter_mut().for_each(|fault| fault.prevents = true);
    }
}

/// A command line that reads files.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ReadCommand {
    /// Its words.
    pub words: Vec<String>,
    /// The text of the setup file that it names, if it needs one that does not exist.
    pub setup: Option<String>,
    /// Whether it reads the files.
    pub reads: bool,
}

/// The result of a look at files.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Inspection {
    /// The files, in the order given.
    pub files: Vec<InspectedFile>,
    /// Commands that read them.
    pub commands: Vec<ReadCommand>,
}

impl Inspection {
    /// Whether each file is read by a command, and nothing must be mended or answered.
    pub fn is_settled(&self) -> bool {
        !self.commands.is_empty()
            && self.commands.iter().all(|command| command.reads)
            && self
                .files
                .iter()
                .all(|file| file.questions.is_empty() && file.faults.iter().all(|fault| !fault.prevents))
    }
}
