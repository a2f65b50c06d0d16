//! The parts of objects that the contacts of a sweep go over.

use crate::{IntervalSet, Outline};
use rod_contact::{ClampPath, Contact, Event, EventKind, Item, State, Sweep};
use rod_contours::Composite;
use rod_core::{PhysicalRod, Pose};

/// States from one before a turning point to one after it, and how often they are set closer: the place where a contact turns is a smooth
/// maximum, so that its error is of the order of the square of their distance, 8 (1/4)^2k of the first one. More: slower.
const STATES: usize = 8;
const ROUNDS: usize = 6;

/// Largest way (rod lengths) between a contact and the two into which it parts at an inflection of the contour, or that run together there:
/// twice the 0.01 of the sweep.
const PARTED: f64 = 0.02;

/// The parts of the outlines of some objects that contacts go over, by arc length (m).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Touched {
    /// By a rod with one contact, for each object.
    pub single: Vec<IntervalSet>,
    /// By a rod with two contacts or more, for each object. A place may be in both.
    pub several: Vec<IntervalSet>,
}

impl Touched {
    /// Nothing of so many objects.
    pub fn nothing(objects: usize) -> Self {
        let none = vec![IntervalSet::default(); objects];
        Self { single: none.clone(), several: none }
    }

    /// What a sweep of `rod` past `objects` touched. Its states and events are given in order ([`Trail`]).
    ///
    /// Contacts move continuously between two transitions. Where a sweep has a transition, the ends of what a contact goes over are exact, and
    /// where a contact turns back between two states, that place is located to about 1e-9 of the way between them, if the rod can be
    /// followed from the state before. Jumps touch nothing.
    pub(crate) fn of<R: PhysicalRod>(trail: &Trail, rod: &R, objects: &[Composite], outlines: &[Outline]) -> Self {
        let mut touched = Self::nothing(objects.len());
        for run in &trail.runs {
            let Some(first) = run.first() else { continue };
            for contact in 0..first.contacts.len() {
                touched.add_run(run, contact, rod, objects, outlines);
            }
        }
        for (before, after) in &trail.parted {
            touched.add_parted([before, after], PARTED * rod.units().length, objects, outlines);
        }
        touched
    }

    /// What both touched.
    pub fn extend(&mut self, other: &Self) {
        for (all, more) in [(&mut self.single, &other.single), (&mut self.several, &other.several)] {
            all.iter_mut().zip(more).for_each(|(all, more)| all.extend(more));
        }
    }

    /// What is touched at all of an object, by its number from 0.
    pub fn all(&self, object: usize) -> IntervalSet {
        let mut all = self.single.get(object).cloned().unwrap_or_default();
        self.several.get(object).iter().for_each(|several| all.extend(several));
        all
    }

    /// The way of one contact of a run of states with the same contacts.
    fn add_run<R: PhysicalRod>(
        &mut self,
        run: &[State],
        contact: usize,
        rod: &R,
        objects: &[Composite],
        outlines: &[Outline],
    ) {
        let object = run[0].contacts[contact].object;
        let (shape, outline) = (&objects[object], &outlines[object]);
        let mut places: Vec<f64> = Vec::with_capacity(run.len());
        for state in run {
            let Some(place) = outline.place(shape, &state.contacts[contact]) else { continue };
            places.push(places.last().map_or(place, |last| outline.nearest_turn(place, *last)));
        }
        let fold = |ends: (f64, f64), place: &f64| (ends.0.min(*place), ends.1.max(*place));
        let (mut from, mut to) = places.iter().fold((f64::INFINITY, f64::NEG_INFINITY), fold);
        if places.len() == run.len() {
            for k in 1..run.len().max(1) - 1 {
                // only the farthest places count
                if places[k] == from || places[k] == to {
                    let sign = if places[k] == to { 1.0 } else { -1.0 };
                    let around = [&run[k - 1], &run[k + 1]].map(|state| (state, state.pose));
                    let turn = turning(rod, objects, around, sign, |state| {
                        Some(outline.nearest_turn(outline.place(shape, state.contacts.get(contact)?)?, places[k]))
                    });
                    turn.iter().for_each(|place| (from, to) = fold((from, to), place));
                }
            }
        }
        outline.wrapped(from, to).into_iter().for_each(|(from, to)| self.add(run[0].contacts.len(), object, from, to));
    }

    /// The short way between contacts that part or run together.
    fn add_parted(&mut self, [before, after]: [&State; 2], most: f64, objects: &[Composite], outlines: &[Outline]) {
        let place = |contact: &Contact| outlines[contact.object].place(&objects[contact.object], contact);
        for one in &before.contacts {
            for other in after.contacts.iter().filter(|other| other.object == one.object) {
                let (Some(from), Some(to)) = (place(one), place(other)) else { continue };
                let outline = &outlines[one.object];
                let to = outline.nearest_turn(to, from);
                if (to - from).abs() <= most {
                    let ways = outline.wrapped(from.min(to), from.max(to));
                    ways.into_iter().for_each(|(from, to)| self.add(2, one.object, from, to));
                }
            }
        }
    }

    fn add(&mut self, contacts: usize, object: usize, from: f64, to: f64) {
        let sets = if contacts == 1 { &mut self.single } else { &mut self.several };
        sets[object].insert(from, to);
    }
}

/// The farthest place of a contact between two states, in the sense of `sign`; none where the rod cannot be followed from one to the other.
fn turning<R: PhysicalRod>(
    rod: &R,
    objects: &[Composite],
    [from, to]: [(&State, Pose); 2],
    sign: f64,
    place: impl Fn(&State) -> Option<f64>,
) -> Option<f64> {
    let (mut start, mut end) = (from.0.clone(), to.1);
    let mut farthest = None;
    for _ in 0..ROUNDS {
        let path = ClampPath::new(start.pose, end).ok()?;
        let step = path.length() / STATES as f64;
        let sweep = Sweep::from_state(rod, objects, &start, path, step).ok()?;
        let state = |item| match item {
            Ok(Item::State(state)) => Some(state),
            _ => None,
        };
        // what comes after a transition is of no use
        let Some(states) = sweep.map(state).collect::<Option<Vec<_>>>().filter(|states| states.len() > 2) else {
            break;
        };
        let places: Vec<f64> = states.iter().map(&place).collect::<Option<_>>()?;
        let (best, value) =
            places.iter().enumerate().max_by(|one, other| (sign * one.1).total_cmp(&(sign * other.1)))?;
        farthest = Some(*value);
        if best == 0 || best == states.len() - 1 {
            break;
        }
        end = states[best + 1].pose;
        start = states.into_iter().nth(best - 1)?;
    }
    farthest
}

impl Outline {
    /// A place of a closed outline on the turn that brings it nearest to another one.
    fn nearest_turn(&self, place: f64, to: f64) -> f64 {
        if self.is_closed() { place + self.length() * ((to - place) / self.length()).round() } else { place }
    }

    /// The parts between 0 and the length of an interval that may go on beyond the end of a closed outline.
    fn wrapped(&self, from: f64, to: f64) -> Vec<(f64, f64)> {
        let length = self.length();
        if !self.is_closed() {
            return vec![(from, to)];
        }
        if to - from >= length {
            return vec![(0.0, length)];
        }
        let start = from.rem_euclid(length);
        let end = start + (to - from);
        if end <= length { vec![(start, end)] } else { vec![(start, length), (0.0, end - length)] }
    }
}

/// The states of a sweep, as they come, cut at its transitions.
#[derive(Clone, Debug, Default)]
pub(crate) struct Trail {
    /// Along each the rod has the same contacts.
    runs: Vec<Vec<State>>,
    /// States between which contacts parted or ran together, at an inflection of a contour.
    parted: Vec<(State, State)>,
}

impl Trail {
    pub fn state(&mut self, state: State) {
        let objects = |state: &State| state.contacts.iter().map(|contact| contact.object).collect::<Vec<_>>();
        match self.runs.last_mut() {
            Some(run) if run.last().is_none_or(|last| objects(last) == objects(&state)) => run.push(state),
            _ => self.runs.push(vec![state]),
        }
    }

    pub fn event(&mut self, event: Event) {
        let Event { kind, before, after, .. } = event;
        if matches!(kind, EventKind::Touch | EventKind::Release) && before.pose != after.pose {
            self.parted.push((before.clone(), after.clone()));
        }
        self.state(before);
        self.runs.push(vec![after]);
    }
}
