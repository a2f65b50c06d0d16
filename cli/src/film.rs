//! The command `forces`.

use crate::arguments::{Forces, Visible};
use crate::error::{Error, OptionError};
use crate::progress::stage;
use crate::{UNFINISHED, read_setup, say, signals, warn};
use rod_files::{Ends, FilmForces, FilmOptions, Staged, read_filmed_rod};
use std::path::Path;
use std::process::ExitCode;
use vibrissa::reconstruct::{ForceSettings, PolePrior};
use vibrissa_cli::write_film;

/// Share of frames that chance alone may leave unexplained, with room: one in a thousand is expected.
const BY_CHANCE: f64 = 0.01;

pub fn forces(arguments: Forces) -> Result<ExitCode, Error> {
    let Forces {
        frames,
        rod,
        rest,
        length,
        channels,
        setup,
        scale,
        image,
        visible,
        sigma,
        friction,
        contacts,
        pole,
        pole_radius,
        pole_sigma,
        shortening,
        out,
    } = arguments;
    signals::end();
    let filmed = read_filmed_rod(&rod, length)?;
    let settings = ForceSettings {
        friction,
        sigma,
        most_contacts: contacts.into(),
        pole: None,
        most_shortening: shortening / 1e2,
    };
    if pole.is_some_and(|pole| pole.0.is_none()) && pole_sigma.is_some() {
        return Err(OptionError {
            option: "--pole-sigma",
            why: "is that of a centre, expected --pole X,Y with it".into(),
        }
        .into());
    }
    let pole = pole.map(|center| PolePrior { center: center.0, sigma: pole_sigma, radius: pole_radius });
    let ends = match visible {
        Visible::Base => Ends::Base,
        Visible::Tip => Ends::Tip,
        Visible::Both => Ends::Both,
        Visible::Neither => Ends::Neither,
    };
    let mounting = setup.as_deref().map(read_setup).transpose()?.map(|setup| setup.mounting);
    let named = rest.clone().into_iter().chain(channels.clone()).chain(setup);
    let inputs = [frames.clone(), rod].into_iter().chain(named).collect();
    let options = FilmOptions { scale, image, ends, channels, mounting, rest, pole, settings };
    stage(&format!("{}: finding the forces", frames.display()));
    let found = FilmForces::read(&frames, filmed, &options)?;
    let out = out.unwrap_or_else(|| Path::new("out").join(&found.name));
    let staged = Staged::new(&out)?.keeping(inputs);
    write_film(&found, &staged)?;
    staged.publish()?;
    say(&found.summary());
    say(&format!("written to {}\n", out.display()));
    for warning in found.warnings() {
        warn(&format!("warning: {}: {warning}\n", frames.display()));
    }
    let (faults, unexplained) = found.failures();
    let by_chance = BY_CHANCE * found.frames.len() as f64;
    let is_fine = faults == 0
        && unexplained as f64 <= by_chance
        && found.other_at_rest.is_none()
        && (found.settings.pole.is_none() || found.film.pole.is_some());
    Ok(if is_fine { ExitCode::SUCCESS } else { ExitCode::from(UNFINISHED) })
}
