//! What a command says when it is done.

use crate::paper::{DISTANCES, OBJECTS};
use crate::table::Table;
use crate::{Paper, Scan};

impl Scan {
    /// A line on the phases, one on each thing a user should know, and the table of events.
    pub fn report(&self) -> String {
        let (states, events) = (self.outcome.states.len(), self.outcome.events.len());
        let incomplete = if self.is_complete() { "" } else { "incomplete, " };
        let phases = if self.is_empty() { "no phase".to_owned() } else { self.cycle().titled() };
        let mut text = format!("{}: {incomplete}{phases}; {states} states, {events} events\n", self.scene.name);
        if let (Some(limit), Some(most)) = (self.scene.rod.yield_stress(), self.largest_stress())
            && most > limit
        {
            text += &format!("the rod yields: its bending stress reaches {most:.4e} Pa, the limit is {limit:.4e} Pa\n");
        }
        if events > 0 {
            text += &self.event_table();
        }
        text
    }

    /// The largest bending stress of the scan, Pa, where it is known.
    fn largest_stress(&self) -> Option<f64> {
        self.outcome.states.iter().filter_map(|state| state.max_stress).reduce(f64::max)
    }

    fn event_table(&self) -> String {
        let mut table =
            Table::new(["kind", "from", "to", "x0 mm", "y0 mm", "phi0 deg", "x0/L", "f0x N", "f0y N", "m0z N mm"]);
        for event in &self.outcome.events {
            let (pose, reactions) = (event.pose(), event.before.reactions);
            table.row([
                event.kind.to_string(),
                event.from().to_string(),
                event.to().to_string(),
                format!("{:.9}", 1e3 * pose.x),
                format!("{:.9}", 1e3 * pose.y),
                format!("{:.9}", pose.phi.to_degrees()),
                format!("{:.12}", pose.x / self.scene.rod.length()),
                format!("{:.6}", reactions.f0x),
                format!("{:.6}", reactions.f0y),
                format!("{:.6}", 1e3 * reactions.m0z),
            ]);
        }
        table.to_string()
    }
}

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
