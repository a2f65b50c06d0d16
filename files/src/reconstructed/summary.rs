//! The reconstruction in words.

use super::comparison::{Comparison, Transition};
use super::report::Answered;
use super::result::Reconstructed;
use crate::clamp_columns::ClampColumns;
use crate::table::{Table, counted};
use std::fmt::Write;
use vibrissa::reconstruct::score::Deviation;
use vibrissa::reconstruct::{Source, SourceEstimate};

/// Standard deviation of friction, in parts of the coefficient, below which it is well known.
const WELL_KNOWN: f64 = 0.01;

impl Reconstructed {
    /// Rows, noise, labels, points and gaps, and the comparison with the truth where that is known.
    pub fn summary(&self) -> String {
        let mut text = String::new();
        // Writing to a string cannot fail.
        let _ = self.tell(&mut text);
        text
    }

    fn tell(&self, text: &mut String) -> std::fmt::Result {
        let labels: Vec<String> = self.found.runs.iter().map(|run| run.1.to_string()).collect();
        let (rows, usable) = (self.recording.rows.len(), self.rows.len());
        writeln!(text, "{}: {}; {usable} of {rows} rows used", self.name, labels.join(" "))?;
        let [f0x, f0y, m0z] = self.found.noise.each_ref().map(|noise| noise.sigma);
        writeln!(text, "noise: f0x {f0x:.2e} N, f0y {f0y:.2e} N, m0z {m0z:.2e} N m")?;
        let Answered { single, single_answered, several, first_answered, second_answered } = Answered::of(self);
        writeln!(
            text,
            "contact points: in {single_answered} of {single} samples with one contact; of {several} samples with several contacts, the \
             first in {first_answered}, the second in {second_answered}"
        )?;
        let (kinks, gaps) = (self.found.kinks.len(), self.contour.gaps.len());
        writeln!(text, "{}, {}", counted(kinks, "kink"), counted(gaps, "gap"))?;
        if let Some(missing) = self.missing() {
            writeln!(text, "{missing}")?;
        }
        self.tell_friction(text)?;
        self.tell_physics(text)?;
        self.tell_calibration(text)?;
        self.tell_fit(text)?;
        text.push_str(&self.run_table().to_string());
        match &self.comparison {
            Some(comparison) => comparison.tell(self.clamp_columns(), text),
            None => Ok(()),
        }
    }

    /// Friction of each pass, where it was asked for.
    fn tell_friction(&self, text: &mut String) -> std::fmt::Result {
        for (number, pass) in self.found.passes.iter().enumerate() {
            let Some(found) = pass.friction.filter(|_| pass.used_friction != 0.0) else { continue };
            let of = if self.found.passes.len() > 1 { format!(" of pass {}", number + 1) } else { String::new() };
            let way = if found.mu < 0.0 { "pushed forward over" } else { "drawn back over" };
            let told = match (found.is_significant(), found.is_identified()) {
                (true, true) => "",
                (true, false) => "; systematic errors may explain a part of it",
                (false, _) => "; not significant",
            };
            let others = pass.calibration.as_ref().map_or_else(Vec::new, |told| told.confounders(Source::Friction));
            let others = confounders_text(found.mu, found.sigma, &others);
            writeln!(
                text,
                "friction{of}: mu = {:.4} +- {:.1e} (by the noise alone {:.1e}), the rod {way} its contacts{told}{others}",
                found.mu.abs(),
                found.sigma,
                found.sigma_of_noise
            )?;
        }
        Ok(())
    }

    /// What was taken off the samples, and what may be left.
    fn tell_calibration(&self, text: &mut String) -> std::fmt::Result {
        let Some(calibration) = self.found.calibration() else {
            return writeln!(
                text,
                "corrections: {}",
                if self.fits() { "none, as is" } else { "none, because the recording does not fit its rod" }
            );
        };
        let taken: Vec<_> = calibration
            .sources
            .iter()
            .filter(|estimate| estimate.taken != 0.0 && estimate.source != Source::Friction)
            .collect();
        if taken.is_empty() {
            let why = if self.fits() { "none needed" } else { "none, because the recording does not fit its rod" };
            writeln!(text, "corrections: {why}")?;
        }
        for &SourceEstimate { source, taken, sigma, .. } in taken {
            let (name, unit) = source.name();
            let space = if unit.is_empty() { "" } else { " " };
            writeln!(text, "correction: {name} {taken:+.3e}{space}{unit}, known to {sigma:.1e}{space}{unit}")?;
        }
        let touches = self.found.readings.iter().filter_map(|reading| reading.touch.ok());
        let mut systematic: Vec<f64> = touches.map(|touch| touch.sigma_systematic()).collect();
        systematic.sort_unstable_by(f64::total_cmp);
        if let Some(median) = systematic.get(systematic.len() / 2) {
            writeln!(text, "systematic error of the points: {:.1e} mm across the contour, median", 1e3 * median)?;
        }
        let ties = calibration.ties.iter().map(|(a, b, _)| format!("{a} and {b}")).collect::<Vec<_>>();
        if calibration.is_applied() && !ties.is_empty() {
            writeln!(text, "not separated by this scan: {}", ties.join("; "))?;
        }
        Ok(())
    }

    fn tell_physics(&self, text: &mut String) -> std::fmt::Result {
        if let Some(line) = &self.check.line {
            let stiffness = self.rod.at_clamp().bending_stiffness();
            let verdict = if self.fits() {
                "the reactions fit the rod, nothing to do"
            } else {
                "the reactions do not fit the rod, see the next lines for the cause"
            };
            writeln!(
                text,
                "physics: {verdict}; where the rod touches along its side ({:.0} % of the scan in contact), m0z^2 = a + 2 b EI (f0y sin phi0 + f0x cos \
                 phi0) with a = {:.1e} +- {:.1e} N^2 m^2, expected 0, and b = {:.4} +- {:.4}, expected 1",
                100.0 * line.share,
                line.intercept,
                line.intercept_sigma,
                line.slope / stiffness,
                line.slope_sigma / stiffness
            )?;
        }
        self.findings().try_for_each(|finding| writeln!(text, "physics: {finding}"))?;
        self.explained().map_or(Ok(()), |causes| writeln!(text, "physics: {causes}"))
    }

    /// The coordinates of the clamp that change along the recording.
    fn clamp_columns(&self) -> ClampColumns {
        ClampColumns::of(self.samples.iter().map(|sample| sample.pose), self.rod.length())
    }

    fn run_table(&self) -> Table {
        let clamp = self.clamp_columns();
        let columns = ["label", "samples"].into_iter().chain(clamp.names()).chain(["median probability"]);
        let mut table = Table::new(columns);
        for (run, label) in self.runs() {
            let pose = self.samples[run.start].pose;
            let mut sure: Vec<f64> = self.found.readings[run.clone()].iter().map(|r| r.probability).collect();
            sure.sort_unstable_by(f64::total_cmp);
            let median = sure.get(sure.len() / 2).map_or_else(|| "-".into(), |sure| format!("{sure:.3}"));
            table.row(
                [label.to_string(), run.len().to_string()].into_iter().chain(clamp.cells(pose, 4)).chain([median]),
            );
        }
        table
    }
}

/// The sources that are poorly separated from friction, in words, with their shares of its variance. Empty where friction is well known.
pub fn confounders_text(mu: f64, sigma: f64, others: &[(Source, f64)]) -> String {
    let named: Vec<String> =
        others.iter().map(|(source, part)| format!("{source} ({:.0} % of its variance)", 100.0 * part)).collect();
    if named.is_empty() || sigma < WELL_KNOWN * mu.abs() {
        String::new()
    } else {
        format!("; poorly separated from {}", named.join(", "))
    }
}

impl Comparison {
    fn tell(&self, clamp: ClampColumns, text: &mut String) -> std::fmt::Result {
        let Self { scene, confusion, either, off_path, kinks, .. } = self;
        writeln!(text, "\nagainst {}: {} samples compared, {off_path} off its path", scene.name, confusion.total())?;
        if let Some(stop) = &self.stop {
            writeln!(text, "its sweep stopped early, samples beyond are not compared: {stop}")?;
        }
        writeln!(text, "{confusion}\nwrong labels within 1e-4 rod lengths of a transition: {either}")?;
        let mut table = Table::new(["distance from the contour", "points", "median mm", "95 % mm", "largest mm"]);
        for (name, deviation) in [
            ("one contact", &self.single),
            ("first of several", &self.first),
            ("second of several", &self.second),
            ("naive: one contact assumed", &self.naive),
        ] {
            let Some(Deviation { count, median, percentile_95, largest, .. }) = deviation else { continue };
            let mm = [median, percentile_95, largest].map(|distance| format!("{:.2e}", 1e3 * distance));
            table.row([name.to_owned(), count.to_string()].into_iter().chain(mm));
        }
        text.push_str(&table.to_string());
        let real = self.kinks_of_events.matches.len();
        let [unit, error] = if scene.turns_only() { ["mrad", "error mrad"] } else { ["mm", "error mm"] };
        writeln!(
            text,
            "kinks of the reactions: of {} changes of contact that cause one, {} were found within 1 {unit} of the clamp's way; \
             of {} kinks found, {real} belong to a change of contact and {} to none",
            kinks.truth,
            kinks.matches.len(),
            kinks.found,
            kinks.found - real.min(kinks.found)
        )?;
        let mut table = Table::new(["transition", "kind"].into_iter().chain(clamp.names()).chain([error]));
        for Transition { from, to, kind, pose, error } in &self.transitions {
            let error = error.map_or_else(|| "-".into(), |error| format!("{:.4}", 1e3 * error));
            let transition = [format!("{from} -> {to}"), kind.to_string()];
            table.row(transition.into_iter().chain(clamp.cells(*pose, 4)).chain([error]));
        }
        write!(text, "{table}")
    }
}
