//! Options of all commands that read a recording: how the clamp moves, and how the file is written.

use crate::values::{Meaning, Place, STAGE, meaning, number, pair};
use clap::Args;
use clap::builder::PossibleValuesParser;
use rod_files::{ReadOptions, StageDelay, StageSpec};
use std::path::PathBuf;
use vibrissa::hw::recording::{ColumnMap, Decimal, Delimiter, Header, TableOptions};

/// How the clamp moves, where the samples have no poses.
#[derive(Debug, Args)]
pub struct Moved {
    /// How the clamp moves: constant:SPEED (m/s, or rad/s where it only turns) or table:FILE (t,x0,y0,phi0)
    #[arg(long, value_name = "STAGE")]
    pub stage: Option<StageSpec>,
    /// Delay of the clock of the stage's table, as "120 ms": a pose that the table has at time t is that of the clamp at t + TIME on the sensor's
    /// clock. Positive: the stage's clock began later [default: that of --setup, or 0]
    #[arg(long, value_name = "TIME", requires = "stage", allow_hyphen_values = true)]
    pub stage_delay: Option<StageDelay>,
    /// The scene whose path a constant speed is along [default: that of --rod]
    #[arg(long, value_name = "SCENE")]
    pub path: Option<PathBuf>,
}

/// Format of a recording, or of the table of a stage, where the file does not state it.
#[derive(Debug, Args)]
#[command(next_help_heading = "Format of the recording, where the file does not state it")]
pub struct Written {
    /// Separator of the cells
    #[arg(long, value_parser = PossibleValuesParser::new(["comma", "semicolon", "tab", "blanks"]))]
    delimiter: Option<String>,
    /// Decimal mark
    #[arg(long, value_parser = PossibleValuesParser::new(["point", "comma"]))]
    decimal: Option<String>,
    /// The line that names its columns, from 1; or none: the columns are called 1, 2, ...
    #[arg(long, value_name = "LINE", allow_negative_numbers = true, value_parser = header)]
    header: Option<Header>,
    /// The unit of a column; with a minus before it, as `f0x=-N`, the sign of the column is reversed. For the table of a stage: stage:COLUMN=UNIT
    #[arg(long, value_name = "COLUMN=UNIT", value_parser = pair)]
    unit: Vec<(String, String)>,
    /// Which column is x0, y0, phi0, f0x, f0y, m0z, t, ... For the table of a stage: stage:MEANING=COLUMN. A number with a unit is the value of
    /// an x0, y0 or phi0 that stays the same and has no column, as `phi0=90deg`
    #[arg(long, value_name = "MEANING=COLUMN", value_parser = meaning)]
    column: Vec<Meaning>,
    /// Which of the segments of an LVM file, from 1
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = number)]
    segment: Option<usize>,
}

impl From<Written> for ReadOptions {
    fn from(written: Written) -> Self {
        let delimiter = written.delimiter.map(|name| match name.as_str() {
            "comma" => Delimiter::Comma,
            "semicolon" => Delimiter::Semicolon,
            "tab" => Delimiter::Tab,
            _ => Delimiter::Blanks,
        });
        let decimal = written.decimal.map(|name| if name == "comma" { Decimal::Comma } else { Decimal::Point });
        let header = written.header.unwrap_or_default();
        let (stage_units, units): (Vec<_>, Vec<_>) =
            written.unit.into_iter().partition(|unit| unit.0.starts_with(STAGE));
        let stage_units: Vec<(String, String)> =
            stage_units.into_iter().map(|(name, unit)| (name.trim_start_matches(STAGE).to_owned(), unit)).collect();
        let (stage_columns, columns): (Vec<Meaning>, Vec<Meaning>) =
            written.column.into_iter().partition(|meaning| meaning.of_stage);
        let map = |columns: Vec<Meaning>| {
            let (mut map, mut constants) = (ColumnMap::new(), Vec::new());
            for Meaning { role, place, .. } in columns {
                match place {
                    Place::Column(column) => map = map.with(role, column),
                    Place::Constant(constant) => constants.push(constant),
                }
            }
            (map, constants)
        };
        let is_apart = !stage_units.is_empty() || !stage_columns.is_empty();
        let stage = is_apart.then(|| {
            // its layout is detected: it may be written in another way
            let (columns, constants) = map(stage_columns);
            let options = TableOptions { units: stage_units, constants, ..TableOptions::default() };
            Box::new(Self { options, columns, stage: None })
        });
        let (columns, constants) = map(columns);
        let segment = written.segment;
        let options = TableOptions { delimiter, decimal, header, units, constants, segment, ..TableOptions::default() };
        Self { options, columns, stage }
    }
}

/// A line of the header, or that there is none.
fn header(text: &str) -> Result<Header, String> {
    match text {
        "none" => Ok(Header::None),
        _ => text.parse().map(Header::Line).map_err(|_| "expected the number of a line, from 1, or none".to_owned()),
    }
}
