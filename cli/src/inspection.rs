//! The command `inspect`.

use crate::arguments::Inspect;
use crate::error::Error;
use crate::{UNFINISHED, print, read_setup, say, signals, warn};
use rod_files::{
    InspectOptions, Inspection, OutputError, RodInspected, Staged, inspect as look_at, read_calibrated_rod,
};
use std::path::Path;
use std::process::ExitCode;
use vibrissa_cli::inspection_text;

pub fn inspect(arguments: Inspect) -> Result<ExitCode, Error> {
    let Inspect { files, rod, setup, stage_delay, write_setup, json, written } = arguments;
    signals::end();
    let rod = match rod {
        Some(file) => Some(RodInspected { rod: *read_calibrated_rod(&file)?.rod.at_clamp(), file }),
        None => None,
    };
    let setup = match setup {
        Some(file) => Some((file.clone(), read_setup(&file)?)),
        None => None,
    };
    let options = InspectOptions { rod, read: written.into(), stage_delay, setup, write_setup: write_setup.clone() };
    let found = look_at(&files, &options);
    if let Some(out) = &write_setup {
        write(&found, out, &files)?;
    }
    let code = if found.is_settled() { ExitCode::SUCCESS } else { ExitCode::from(UNFINISHED) };
    if json {
        let text = serde_json::to_string_pretty(&found).unwrap_or_default() + "\n";
        print(text.as_bytes())?;
    } else {
        say(&inspection_text(&found));
    }
    Ok(code)
}

/// Writes the setup of the first command that needs one.
fn write(found: &Inspection, out: &Path, inputs: &[std::path::PathBuf]) -> Result<(), Error> {
    let Some(text) = found.commands.iter().find_map(|command| command.setup.as_ref()) else {
        warn("warning: --write-setup: these files need no setup, none is written\n");
        return Ok(());
    };
    rod_files::output::check_output(out, inputs)?;
    let (staged, name) = Staged::of_file(out)?;
    let staged = staged.keeping(inputs.to_vec());
    staged.write(name, |file| file.write_all(text.as_bytes()))?;
    staged.publish().map_err(|error: OutputError| error.into())
}
