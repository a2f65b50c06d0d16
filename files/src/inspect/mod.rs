//! A look at files of unknown layout: what they hold, what must be mended, and the command that reads them.
//!
//! `look` describes one file: `layout` how it is written, `rows` its times and cells, `unnamed` columns whose names say too little, `motion` the path of the clamp, `binary` files of
//! other programs, `tracked` those of trackers of video. `physics` finds axes, signs and units (`frame`, `agreement`), `clock` the delay of a stage's clock, which must not let reactions change while the clamp is `standing`. `commands` puts files together and tries the readers with
//! the options of `proposal` and the `setup_text`. `shell_word` quotes words of commands.

mod agreement;
mod binary;
mod clock;
mod commands;
mod frame;
mod layout;
mod look;
mod motion;
mod physics;
mod proposal;
mod report;
mod rows;
mod setup_text;
mod shell_word;
mod stage_log;
mod standing;
mod timed;
mod tracked;
mod unnamed;
mod values;

pub use report::{Certainty, Fact, InspectFault, InspectedColumn, InspectedFile, Inspection, Question, ReadCommand};
pub use shell_word::quoted;

use crate::{ReadOptions, Setup, StageDelay};
use look::Look;
use std::path::PathBuf;
use vibrissa::Rod;

/// A rod and its file.
#[derive(Clone, Debug)]
pub struct RodInspected {
    /// The file.
    pub file: PathBuf,
    /// The rod, as it is at its clamp.
    pub rod: Rod,
}

/// What is known before a look.
#[derive(Clone, Debug, Default)]
pub struct InspectOptions {
    /// The rod of the recordings.
    pub rod: Option<RodInspected>,
    /// What the user said of layout, columns and units.
    pub read: ReadOptions,
    /// Delay of the clock of a stage's table.
    pub stage_delay: Option<StageDelay>,
    /// A setup, with its file.
    pub setup: Option<(PathBuf, Setup)>,
    /// Where a setup is to be written.
    pub write_setup: Option<PathBuf>,
}

/// Looks at files.
pub fn inspect(files: &[PathBuf], options: &InspectOptions) -> Inspection {
    let mut looks: Vec<Look> = files.iter().map(|file| Look::at(file, &options.read)).collect();
    let commands = commands::commands(&mut looks, options);
    Inspection { files: looks.into_iter().map(|look| look.report).collect(), commands }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn looked_at(name: &str, bytes: &[u8]) -> Inspection {
        let directory = tempfile::tempdir().unwrap();
        let file = directory.path().join(name);
        std::fs::write(&file, bytes).unwrap();
        let rod = Rod::new(0.1, 6.3e-4).unwrap();
        let rod = Some(RodInspected { file: "rod.toml".into(), rod });
        inspect(&[file], &InspectOptions { rod, ..InspectOptions::default() })
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 24, ..ProptestConfig::default() })]

        #[test]
        fn any_bytes_are_looked_at(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
            for start in [&b""[..], b"PK\x03\x04", b"TDSm", b"\x89MCAP0\r\n", b"LabVIEW Measurement\n", b"t,Fx,x0\n"] {
                let found = looked_at("a.csv", &[start, &bytes].concat());
                prop_assert!(found.files.len() == 1);
            }
        }

        #[test]
        fn any_table_is_looked_at(
            names in "([a-zA-Z0-9 \\[\\]_(),;äµ]{0,8}[,;\t]){0,9}",
            rows in prop::collection::vec("([-0-9.e]{0,7}[,;\t]){0,9}", 0..20),
        ) {
            let found = looked_at("a.csv", format!("{names}\n{}\n", rows.join("\n")).as_bytes());
            prop_assert!(found.files[0].faults.len() + found.files[0].questions.len() + found.commands.len() > 0);
        }
    }

    /// No frame is decided for random forces.
    #[test]
    fn chance_has_no_frame() {
        for seed in 1..5_u32 {
            let mut state = seed.wrapping_mul(2_654_435_769) | 1;
            let mut next = || {
                state ^= state << 13;
                state ^= state >> 17;
                state ^= state << 5;
                f64::from(state) / f64::from(u32::MAX) - 0.5
            };
            let mut text = "t,x0,y0,phi0,f0x,f0y,m0z\n".to_owned();
            for k in 0..200 {
                text += &format!("{},{},-0.04,1.57,{},{},{}\n", k, 1e-3 * f64::from(k), next(), next(), 0.1 * next());
            }
            let found = looked_at("a.csv", text.as_bytes());
            let frame = found.files[0].facts.iter().find(|fact| fact.what == "frame").unwrap();
            assert!(
                frame.found.contains("no axes")
                    || frame.found.contains("does not determine")
                    || frame.found.contains("not checked"),
                "{}",
                frame.found
            );
        }
    }
}
