//! Where the least squares begin.

use super::candidate::Candidate;
use super::observation::{Axis, Measurand};
use super::observed::Observed;
use super::problem::{FrameProblem, Start};
use super::shape::{Place, unknowns};
use super::sight::Sight;
use crate::least_squares::{Damped, iterate};
use nalgebra::DVector;
use rod_core::{Cut, RodModel};

/// Number of dots from which on they show a shape.
const SHAPE: usize = 3;
/// Arc lengths (L) at which a contact is tried where no shape is seen.
const PLACES: [f64; 10] = [0.1, 0.2, 0.32, 0.44, 0.56, 0.68, 0.78, 0.86, 0.93, 0.985];
/// How far the rod turns there, rad.
const TURNS: [f64; 6] = [-1.2, -0.5, -0.1, 0.1, 0.5, 1.2];
/// Steps with the contact held at its place, by which such starts are compared.
const HELD_STEPS: usize = 3;

/// Starts of the least squares of a frame.
pub(super) struct Starts<'a> {
    observed: &'a Observed,
    sight: Option<Sight>,
}

impl<'a> Starts<'a> {
    pub fn of<M: RodModel>(model: &M, observed: &'a Observed) -> Self {
        let sight = (observed.dots.len() >= SHAPE).then(|| Sight::of(model, observed));
        Self { observed, sight }
    }

    /// Whether no shape is seen, so that nothing leads to one solution.
    pub fn is_blind(&self) -> bool {
        self.sight.is_none()
    }

    /// Those of `starts` that may explain as much as the best of them, by what they leave at first sight, the best first.
    pub fn plausible(&self, mut starts: Vec<Start>) -> Vec<Start> {
        if let Some(sight) = &self.sight {
            let least = starts.iter().fold(f64::INFINITY, |least, start| least.min(start.chi_squared));
            starts.retain(|start| !sight.is_hopeless(start.chi_squared, least));
            starts.sort_by(|a, b| a.chi_squared.total_cmp(&b.chi_squared));
        }
        starts
    }

    /// The rod without contacts.
    pub fn free<M: RodModel>(&self, model: &M) -> Start {
        match &self.sight {
            Some(sight) => sight.free(model),
            None => {
                let base = self.base();
                let u = DVector::from_column_slice(&[base.x, base.y, base.phi]);
                Start { contacts: Vec::new(), u, feet: self.feet(), chi_squared: f64::NAN }
            }
        }
    }

    /// Starts with one contact, the best first.
    pub fn one<M: RodModel>(&self, model: &M, place: Place) -> Vec<Start> {
        self.sight.as_ref().map_or_else(|| self.one_unseen(model, place), |sight| sight.one(place))
    }

    /// Starts with two contacts, the best first; where no shape is seen, from one contact.
    pub fn two<M: RodModel>(&self, model: &M, side: Place, from: &[Candidate]) -> Vec<Start> {
        match &self.sight {
            Some(sight) => sight.two(side),
            None => from.iter().flat_map(|one| second(model, one, side)).collect(),
        }
    }

    /// Position and direction of the base by its channels.
    fn base(&self) -> Cut {
        let judged = |axis| {
            let of = |quantity| self.observed.channel(quantity);
            of(Measurand::Base(axis)).or_else(|| of(Measurand::Support(axis))).unwrap_or(0.0)
        };
        Cut { x: judged(Axis::X), y: judged(Axis::Y), phi: judged(Axis::Angle), moment: 0.0 }
    }

    /// Dots that show no shape: somewhere in the middle, but for ends.
    fn feet(&self) -> Vec<f64> {
        let count = self.observed.dots.len();
        (0..count).map(|k| (k as f64 + 0.5) / count as f64).collect()
    }

    fn one_unseen<M: RodModel>(&self, model: &M, place: Place) -> Vec<Start> {
        let places: &[f64] = match &place {
            Place::Tip => &[1.0],
            Place::Side { s: Some(s), .. } => std::slice::from_ref(s),
            Place::Side { .. } => &PLACES,
        };
        let (base, feet) = (self.base(), self.feet());
        let mut starts: Vec<Start> = Vec::new();
        for &s in places {
            let cut = model.carry(0.0, &base, 0.0, 0.0, s);
            let unit = turn_per_force(model, s);
            for turn in TURNS {
                // along the rod a small force has many places: pose and force that go with this one tell them apart
                let held = [match place {
                    Place::Side { .. } => Place::Side { s: Some(s), rub: Some(0.0) },
                    Place::Tip => Place::Tip,
                }];
                let u = with_contact(cut, held[0], turn / unit);
                let mut problem = FrameProblem::new(model, self.observed, &held, feet.clone());
                let (at, _) = iterate(&mut problem, u, Damped::lightly(), HELD_STEPS);
                let chi_squared = at.equations.cost;
                if chi_squared.is_finite() {
                    let (pose, force) = (&at.x.as_slice()[..3], &at.x.as_slice()[3..]);
                    let own = matches!(place, Place::Side { s: None, .. }).then_some(s);
                    let mut u: Vec<f64> = pose.iter().copied().chain(own).chain(force.iter().copied()).collect();
                    u.resize(unknowns(&[place]), 0.0);
                    let (contacts, u, feet) = (vec![place], DVector::from_vec(u), feet.clone());
                    starts.push(Start { contacts, u, feet, chi_squared });
                }
            }
        }
        starts.sort_by(|a, b| a.chi_squared.total_cmp(&b.chi_squared));
        starts
    }
}

/// The unknowns of one contact at `cut`, held at its arc length, with a force across the rod.
fn with_contact(cut: Cut, place: Place, force: f64) -> DVector<f64> {
    let mut u = vec![cut.x, cut.y, cut.phi];
    match place {
        Place::Tip => u.extend([force * cut.phi.cos(), force * cut.phi.sin()]),
        Place::Side { .. } => u.push(force),
    }
    DVector::from_vec(u)
}

/// By how much a small force across the straight rod at the arc length `s` turns it there, rad per E I / L^2.
fn turn_per_force<M: RodModel>(model: &M, s: f64) -> f64 {
    let at = Cut { x: 0.0, y: 0.0, phi: 0.0, moment: 0.0 };
    model.carry_with_sensitivities(s, &at, 0.0, 0.0, -s).1.by_a[2].abs().max(f64::MIN_POSITIVE)
}

/// Shares of the way to the contact, or from it to the tip, at which a second one is tried.
const SHARES: [f64; 3] = [0.3, 0.55, 0.8];

/// Starts with a second contact that carries no force yet: on either side of the one that is known, and at the tip.
fn second<M: RodModel>(model: &M, one: &Candidate, side: Place) -> Vec<Start> {
    let Some(contact) = one.shape.contacts.first() else { return Vec::new() };
    let mut starts = Vec::new();
    let mut add = |contacts: Vec<Place>, mut u: Vec<f64>| {
        u.resize(unknowns(&contacts), 0.0);
        starts.push(one.start_with(contacts, DVector::from_vec(u)));
    };
    let known = one.contacts[0];
    for share in SHARES {
        let inner = one.u.iter().copied().chain([share * contact.node.s]).collect();
        add(vec![known, side], inner);
    }
    if contact.is_tip {
        return starts;
    }
    let s = contact.node.s;
    for share in SHARES.into_iter().chain([1.0]) {
        let outer = s + share * (1.0 - s);
        let cut = model.carry(s, &contact.node.cut, 0.0, 0.0, outer - s);
        let (place, own) = if share < 1.0 { (side, vec![outer]) } else { (Place::Tip, Vec::new()) };
        let mut u = [cut.x, cut.y, cut.phi].into_iter().chain(own).collect::<Vec<_>>();
        u.resize(3 + place.unknowns(), 0.0);
        u.extend(&one.u.as_slice()[3..]);
        add(vec![place, known], u);
    }
    starts
}
