//! What a command says when it is done.

use crate::Scan;
use crate::clamp_columns::ClampColumns;
use crate::table::{Table, counted};
use vibrissa::contact::{Contact, Start, StartCandidate};
use vibrissa::{Rod, State};

/// From this gap on, lengths of the rod, all along the path, rod, objects or path are most likely in another unit than m.
const FAR: f64 = 10.0;

impl Scan {
    /// A line on the phases, one on each thing a user should know, and the table of events.
    pub fn report(&self) -> String {
        let (states, events) = (self.outcome.states.len(), self.outcome.events.len());
        let incomplete = if self.is_complete() { "" } else { "incomplete, " };
        let phases = if self.is_empty() { "no phase".to_owned() } else { self.titled_phases() };
        let mut text = format!("{}: {incomplete}{phases};", self.scene.name);
        text += &format!(" {}, {}\n", counted(states, "state"), counted(events, "event"));
        if let Some(note) = self.touches_nothing() {
            text += &note;
        }
        if let Some(start) = self.start_in_contact() {
            text += &start;
        }
        if let (Some(limit), Some(most)) = (self.scene.rod.uniform().and_then(Rod::yield_stress), self.largest_stress())
            && most > limit
        {
            text += &format!("the rod yields: its bending stress reaches {most:.4e} Pa, the limit is {limit:.4e} Pa\n");
        }
        if events > 0 {
            text += &self.event_table();
        }
        text
    }

    /// The phases, and the name of their cycle if there is one, as in `free A B BB B A free (cycle C1 of Merker et al. 2020)`.
    fn titled_phases(&self) -> String {
        let name = self.cycle().name();
        name.map_or_else(|| self.phases(), |name| format!("{} (cycle {name} of Merker et al. 2020)", self.phases()))
    }

    /// A line where the rod is free all along.
    fn touches_nothing(&self) -> Option<String> {
        let states = &self.outcome.states;
        let is_free = self.outcome.events.is_empty() && states.iter().all(|state| state.contacts.is_empty());
        let gap = states.iter().map(|state| state.certificate.min_gap.seen).reduce(f64::min)?;
        let length = self.scene.rod.length();
        let hint = if gap > FAR * length { "; are all lengths in m?" } else { "" };
        (is_free && self.is_complete()).then(|| {
            let [gap, length] = [gap, length].map(|length| 1e3 * length);
            format!("note: no contact on the whole path; the rod of {length:.6} mm comes as near to the objects as {gap:.6} mm{hint}\n")
        })
    }

    /// A line on how a start in contact was found, and what else there was.
    fn start_in_contact(&self) -> Option<String> {
        let Some(Start::InContact(found)) = &self.outcome.start else { return None };
        let (taken, others) = found.split_first()?;
        let named = |one: &StartCandidate| format!("{} by {} ({:.4e} J)", one.phase, one.approach, one.energy);
        let mut text = format!("starts in contact: {}", named(taken));
        if !others.is_empty() {
            let others: Vec<_> = others.iter().map(named).collect();
            text += &format!("; also reached: {}", others.join(", "));
        }
        Some(text + "\n")
    }

    /// The largest bending stress of the scan, Pa, where it is known.
    fn largest_stress(&self) -> Option<f64> {
        self.outcome.states.iter().filter_map(|state| state.max_stress).reduce(f64::max)
    }

    fn event_table(&self) -> String {
        // which contact slips or sticks, where there is friction
        let rubs = self.scene.friction.is_some();
        let length = self.scene.rod.length();
        let states = self.outcome.states.iter().map(|state| state.pose);
        let clamp = ClampColumns::of(states.chain(self.outcome.events.iter().map(vibrissa::Event::pose)), length);
        let in_lengths = clamp.in_lengths();
        let pose = clamp.names().chain(in_lengths.map(|column| column.0));
        let columns = ["kind", "from", "to"].into_iter().chain(pose).chain(["f0x N", "f0y N", "m0z N mm"]);
        let mut table = Table::new(columns.chain(rubs.then_some("contacts, clamp to tip")));
        let felt = || self.outcome.events.iter().map(|event| event.before.reactions);
        let forces = felt().map(|reactions| reactions.f0x.hypot(reactions.f0y)).fold(0.0, f64::max);
        let moments = felt().map(|reactions| 1e3 * reactions.m0z.abs()).fold(0.0, f64::max);
        for event in &self.outcome.events {
            let (pose, reactions) = (event.pose(), event.before.reactions);
            let phases = [event.kind.to_string(), event.from().to_string(), event.to().to_string()];
            let pose = clamp
                .cells(pose, 9)
                .chain(in_lengths.map(|(_, coordinate)| format!("{:.12}", coordinate(pose) / length)));
            let reactions =
                [of_size(reactions.f0x, forces), of_size(reactions.f0y, forces), of_size(1e3 * reactions.m0z, moments)];
            let modes = rubs.then(|| format!("{} -> {}", modes(&event.before), modes(&event.after)));
            table.row(phases.into_iter().chain(pose).chain(reactions).chain(modes));
        }
        table.to_string()
    }
}

/// What the contacts do, from the clamp to the tip.
fn modes(state: &State) -> String {
    let mode =
        |contact: &Contact| contact.friction.map_or("no friction".to_owned(), |friction| friction.mode.to_string());
    let modes: Vec<String> = state.contacts.iter().map(mode).collect();
    if modes.is_empty() { "free".to_owned() } else { modes.join(", ") }
}

/// A number in a column whose largest one is `largest`: as it is, or with an exponent where six decimals would leave nothing of it.
fn of_size(value: f64, largest: f64) -> String {
    let plain = value == 0.0 || largest >= 1e-2;
    if plain { format!("{value:.6}") } else { format!("{value:.4e}") }
}

#[cfg(test)]
mod tests {
    use super::of_size;

    #[test]
    fn small_forces_keep_their_digits() {
        assert_eq!([of_size(0.5, 0.7), of_size(1e-7, 0.7)], ["0.500000", "0.000000"]);
        assert_eq!([of_size(4.7e-5, 5e-5), of_size(0.0, 0.0)], ["4.7000e-5", "0.000000"]);
    }
}
