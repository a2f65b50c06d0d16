//! Options of all commands that read a recording: how the clamp moves, and how the file is written.

use crate::values::{meaning, number, pair};
use clap::Args;
use clap::builder::PossibleValuesParser;
use rod_files::{ReadOptions, StageSpec};
use std::path::PathBuf;
use vibrissa::hw::recording::{ColumnMap, Decimal, Delimiter, Header, Role, TableOptions};

/// How the clamp moves, where the samples have no poses.
#[derive(Debug, Args)]
pub struct Moved {
    /// How the clamp moves: constant:SPEED (m/s, or rad/s where it only turns) or table:FILE (t,x0,y0,phi0)
    #[arg(long, value_name = "STAGE")]
    pub stage: Option<StageSpec>,
    /// The scene whose path a constant speed is along [default: that of --rod]
    #[arg(long, value_name = "SCENE")]
    pub path: Option<PathBuf>,
}

/// How a recording, or the table of a stage, is written, where the file alone does not tell.
#[derive(Debug, Args)]
#[command(next_help_heading = "How the recording is written, where the file does not tell")]
pub struct Written {
    /// What separates its cells
    #[arg(long, value_parser = PossibleValuesParser::new(["comma", "semicolon", "tab", "blanks"]))]
    delimiter: Option<String>,
    /// The mark before fractions
    #[arg(long, value_parser = PossibleValuesParser::new(["point", "comma"]))]
    decimal: Option<String>,
    /// The line that names its columns, from 1
    #[arg(long, value_name = "LINE", allow_negative_numbers = true)]
    header: Option<u64>,
    /// The unit of a column
    #[arg(long, value_name = "COLUMN=UNIT", value_parser = pair)]
    unit: Vec<(String, String)>,
    /// Which column is x0, y0, phi0, f0x, f0y, m0z, t, ...
    #[arg(long, value_name = "MEANING=COLUMN", value_parser = meaning)]
    column: Vec<(Role, String)>,
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
        let header = written.header.map_or(Header::Find, Header::Line);
        let (units, segment) = (written.unit, written.segment);
        let columns = written.column.into_iter().fold(ColumnMap::new(), |map, (role, name)| map.with(role, name));
        Self {
            options: TableOptions { delimiter, decimal, header, units, segment, ..TableOptions::default() },
            columns,
        }
    }
}
