//! A plan in words.

use super::Planned;
use super::direction_degrees;
use super::files::median_sigma;
use std::fmt::Write;
use vibrissa::plan::Forecast;

impl Planned {
    /// The report, lengths in mm.
    pub fn report(&self) -> String {
        let mut text = String::new();
        // writing to a String cannot fail
        let _ = self.write_report(&mut text);
        text
    }

    fn write_report(&self, text: &mut String) -> std::fmt::Result {
        let (name, hypotheses) = (&self.name, self.plan.hypotheses.len());
        writeln!(text, "{name}: {} candidate scans, {hypotheses} hypotheses about the object", self.candidates)?;
        match (self.most_stress, self.plan.forecasts.iter().any(|forecast| forecast.largest_stress.is_some())) {
            (Some(limit), _) => writeln!(text, "largest stress: {:.0} MPa", 1e-6 * limit)?,
            (None, true) => writeln!(text, "warning: no largest stress: whether the rod yields is not checked")?,
            (None, false) => writeln!(text, "the rod has no diameter: whether it yields is not known")?,
        }
        let left_out = self.plan.hypotheses.first().map_or(0, |one| one.left_out.len());
        if left_out > 0 {
            writeln!(text, "left out: {left_out} touched points at which the contour would cross itself")?;
        }
        let is_ruled_out = |forecast: &&Forecast| forecast.gain.is_none();
        let ruled_out = self.plan.forecasts.iter().filter(is_ruled_out).count();
        if ruled_out > 0 {
            let blocked = self.plan.forecasts.iter().filter(|forecast| forecast.is_blocked).count();
            writeln!(
                text,
                "ruled out: {ruled_out} scans, {blocked} of them because the clamp may run into the object, the others by the stress"
            )?;
        }
        for (place, choice) in self.choices.iter().enumerate() {
            let forecast = &self.plan.forecasts[choice.candidate];
            let [from, to] = forecast.candidate.ends();
            write!(
                text,
                "scan {}: clamp from ({:.2}, {:.2}) to ({:.2}, {:.2}) mm, angle {:.2} deg: {:.2} mm of new contour, {:.0} s",
                place + 1,
                1e3 * from.x,
                1e3 * from.y,
                1e3 * to.x,
                1e3 * to.y,
                direction_degrees(from.phi),
                1e3 * choice.gain,
                forecast.time
            )?;
            if let Some(stress) = forecast.largest_stress {
                write!(text, ", at most {:.0} MPa", 1e-6 * stress)?;
            }
            if let Some(sigma) = median_sigma(forecast) {
                write!(text, ", sigma {:.1} um", 1e6 * sigma)?;
            }
            writeln!(text)?;
        }
        if self.choices.is_empty() {
            writeln!(text, "no scan touches anything new, stays clear of the object and within the largest stress")?;
        }
        Ok(())
    }
}
