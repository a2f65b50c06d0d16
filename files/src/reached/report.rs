//! What scans reach, in words.

use super::{Reached, Touch};
use std::fmt::Write;

impl Reached {
    /// The report, lengths in mm.
    pub fn report(&self) -> String {
        let mut text = String::new();
        // writing to a String cannot fail
        let _ = self.write_report(&mut text);
        text
    }

    fn write_report(&self, text: &mut String) -> std::fmt::Result {
        let (name, scans) = (&self.name, self.found.scans.len());
        writeln!(text, "{name}: {scans} scans, outline of {:.1} mm", 1e3 * self.found.length())?;
        let [single, several, never] =
            [Touch::Single, Touch::Several, Touch::Never].map(|touch| 100.0 * self.share(touch));
        writeln!(
            text,
            "touched with one contact {single:.1} %, only with several contacts {several:.1} %, never {never:.1} %"
        )?;
        if let Some((scan, share)) = self.most() {
            let (distance, angle) = (1e3 * scan.distance, scan.angle.to_degrees());
            writeln!(
                text,
                "one scan touches at most {:.1} %: distance {distance:.1} mm, angle {angle:.1} deg, pass {}",
                100.0 * share,
                scan.pass
            )?;
        }
        match self.several_up_to() {
            Some(distance) => writeln!(text, "several contacts up to a distance of {:.1} mm", 1e3 * distance)?,
            None => writeln!(text, "no scan has several contacts")?,
        }
        let stopped = self.found.scans.iter().filter(|one| one.found.stop.is_some());
        if let Some(stop) = stopped.clone().find_map(|one| one.found.stop.as_ref()) {
            writeln!(text, "{} scans stopped early, the first one: {stop}", stopped.count())?;
        }
        Ok(())
    }
}
