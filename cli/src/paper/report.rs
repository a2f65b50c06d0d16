//! The tables of the nine scans.

use super::scans::{DISTANCES, OBJECTS, Paper};
use rod_files::table::Table;

impl Paper {
    /// The cycles beside the paper's, and the events of every scan.
    pub fn report(&self) -> String {
        let (done, all) = (self.scans.len(), Self::SCANS);
        let incomplete =
            if self.is_complete() { String::new() } else { format!("incomplete: {done} of {all} scans\n") };
        format!("{incomplete}phase cycles (the paper's beside them)\n{}\n{}", self.cycle_table(), self.event_tables())
    }

    fn cycle_table(&self) -> Table {
        let header: Vec<String> = DISTANCES.iter().map(|distance| format!("q = {distance} mm")).collect();
        let mut table = Table::new(std::iter::once("object").chain(header.iter().map(String::as_str)));
        for object in OBJECTS {
            let cells = DISTANCES.iter().map(|&distance| {
                self.find(object, distance).map_or_else(String::new, |scan| {
                    let cycle = scan.scan.cycle();
                    let verdict = if scan.matches() { "match" } else { "MISMATCH" };
                    format!("{cycle} = {} ({}: {verdict})", cycle.name().unwrap_or("?"), scan.expected)
                })
            });
            table.row(std::iter::once(object.to_owned()).chain(cells));
        }
        table
    }

    fn event_tables(&self) -> String {
        let mut table = Table::new(["scan", "event", "from", "to", "x0 mm", "x0/L"]);
        for scan in self.scans.iter().map(|scan| &scan.scan) {
            for event in &scan.outcome.events {
                let x0 = event.pose().x;
                table.row([
                    scan.scene.name.clone(),
                    event.kind.to_string(),
                    event.from().to_string(),
                    event.to().to_string(),
                    format!("{:.10}", 1e3 * x0),
                    format!("{:.12}", x0 / scan.scene.rod.length()),
                ]);
            }
        }
        table.to_string()
    }
}
