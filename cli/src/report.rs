//! What a command says when it is done.

use crate::Scan;
use crate::table::Table;

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
