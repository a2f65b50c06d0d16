//! Where the least squares begin.

use super::candidate::Candidate;
use super::observation::{Axis, Measurand};
use super::observed::Observed;
use super::problem::{FrameProblem, Start};
use super::shape::{Place, trace, unknowns};
use crate::least_squares::{Damped, iterate};
use nalgebra::DVector;
use rod_core::{Cut, RodModel};

/// Arc lengths (L) at which a contact is tried first.
const PLACES: [f64; 10] = [0.1, 0.2, 0.32, 0.44, 0.56, 0.68, 0.78, 0.86, 0.93, 0.985];
/// Steps with the contact held at its place, by which starts are compared.
const HELD_STEPS: usize = 3;
/// Turns of the rod (rad) that are tried where no point on the rod tells how far it turns.
const TURNS: [f64; 6] = [-1.2, -0.5, -0.1, 0.1, 0.5, 1.2];
/// Arc lengths (L) at which the outer and the inner one of two contacts are tried, the inner one within this share of the way to the outer one, and
/// the steps by which such starts are compared.
const OUTER: [f64; 4] = [0.44, 0.68, 0.86, 1.0];
const INNER: [f64; 5] = [0.1, 0.2, 0.32, 0.56, 0.78];
const MOST_INNER: f64 = 0.9;
const PAIR_STEPS: usize = 12;
/// Number of points by which starts are compared.
const FEW: usize = 14;
/// Newton steps for the force that turns the base as the points say.
const STEPS: usize = 6;
/// Largest change of an angle in such a step, rad.
const MOST_TURN: f64 = 0.6;

/// What the observations say of the shape at first sight.
pub(super) struct Sight {
    /// Arc lengths of the dots by the length of their chords.
    feet: Vec<f64>,
    dots: Vec<[f64; 2]>,
    /// Position and direction of the base, where no dots tell.
    base: Cut,
}

impl Sight {
    pub fn of(observed: &Observed) -> Self {
        let dots: Vec<[f64; 2]> = observed.dots.iter().map(|dot| dot.at).collect();
        let mut feet = Vec::with_capacity(dots.len());
        let mut along = 0.0;
        for (k, dot) in dots.iter().enumerate() {
            if k > 0 {
                along += (dot[0] - dots[k - 1][0]).hypot(dot[1] - dots[k - 1][1]);
            }
            feet.push(along);
        }
        let shift = match observed.ends {
            [true, _] => 0.0,
            [false, true] => 1.0 - along,
            [false, false] => 0.5 * (1.0 - along),
        };
        let feet = feet.into_iter().map(|foot| (foot + shift).clamp(0.0, 1.0)).collect();
        let told = |axis| {
            let of = |quantity| observed.channel(quantity);
            of(Measurand::Base(axis)).or_else(|| of(Measurand::Support(axis))).unwrap_or(0.0)
        };
        let base = Cut { x: told(Axis::X), y: told(Axis::Y), phi: told(Axis::Angle), moment: 0.0 };
        Self { feet, dots, base }
    }

    fn has_shape(&self) -> bool {
        self.dots.len() >= 3
    }

    /// Position and direction of the rod at an arc length.
    fn at<M: RodModel>(&self, model: &M, s: f64) -> Cut {
        if !self.has_shape() {
            return model.carry(0.0, &self.base, 0.0, 0.0, s);
        }
        let last = self.dots.len() - 1;
        let k = self.feet.partition_point(|foot| *foot < s).clamp(1, last);
        let around = self.dots.len() / 10;
        let (from, to) = ((k - 1).saturating_sub(around), (k + around).min(last));
        let phi = (self.dots[to][1] - self.dots[from][1]).atan2(self.dots[to][0] - self.dots[from][0]);
        let (before, after) = (self.feet[k - 1], self.feet[k]);
        let share = if after > before { (s - before) / (after - before) } else { 0.0 };
        let [x, y] = [0, 1].map(|c| self.dots[k - 1][c] + share * (self.dots[k][c] - self.dots[k - 1][c]));
        Cut { x, y, phi, moment: 0.0 }
    }

    /// The free rod.
    pub fn free<M: RodModel>(&self, model: &M) -> Start {
        let middle = self.at(model, 0.5);
        // back to the base as the rod is at rest
        let base = if self.has_shape() { model.carry(0.5, &middle, 0.0, 0.0, -0.5) } else { self.base };
        Start { u: DVector::from_column_slice(&[base.x, base.y, base.phi]), feet: self.feet.clone() }
    }

    /// Starts with one contact, at many places, the best first.
    pub fn one<M: RodModel>(&self, model: &M, observed: &Observed, place: Place) -> Vec<Start> {
        let places: &[f64] = match &place {
            Place::Tip => &[1.0],
            Place::Side { s: Some(s), .. } => std::slice::from_ref(s),
            Place::Side { .. } => &PLACES,
        };
        let contacts = [place];
        let (few, feet) = self.thinned(observed);
        let mut starts: Vec<(f64, Start)> = Vec::new();
        for &s in places {
            let cut = self.at(model, s);
            let unit = turn_per_force(model, s);
            let forces: Vec<f64> = if self.has_shape() {
                vec![self.force(model, s, cut)]
            } else {
                TURNS.iter().map(|turn| turn / unit).collect()
            };
            for force in forces {
                // along the rod a small force has many places: pose and force that go with this one tell them apart
                let held = [match place {
                    Place::Side { .. } => Place::Side { s: Some(s), rub: Some(0.0) },
                    Place::Tip => Place::Tip,
                }];
                let u = with_contact(cut, held[0], s, force, unknowns(&held));
                let mut problem = FrameProblem::new(model, &few, &held, feet.clone());
                let (at, _) = iterate(&mut problem, u, Damped::lightly(), HELD_STEPS);
                let cost = at.equations.cost;
                if cost.is_finite() {
                    let (pose, force) = (&at.x.as_slice()[..3], &at.x.as_slice()[3..]);
                    let own = matches!(place, Place::Side { s: None, .. }).then_some(s);
                    let mut u: Vec<f64> = pose.iter().copied().chain(own).chain(force.iter().copied()).collect();
                    u.resize(unknowns(&contacts), 0.0);
                    starts.push((cost, Start { u: DVector::from_vec(u), feet: self.feet.clone() }));
                }
            }
        }
        starts.sort_by(|a, b| a.0.total_cmp(&b.0));
        starts.into_iter().map(|start| start.1).collect()
    }

    /// Starts with two contacts, at many pairs of places: from a first one that bends the rod as the points say, and a second one without a force. With
    /// `from`, those from one contact besides. The best first, after a few steps.
    pub fn two<M: RodModel>(
        &self,
        model: &M,
        observed: &Observed,
        side: Place,
        from: &[Candidate],
    ) -> Vec<(Vec<Place>, Start)> {
        let (few, feet) = self.thinned(observed);
        let mut starts: Vec<(Vec<Place>, Start)> = from.iter().flat_map(|one| second(model, one, side)).collect();
        for outer in OUTER {
            let cut = self.at(model, outer);
            let force = self.force(model, outer, cut);
            let place = if outer < 1.0 { side } else { Place::Tip };
            for inner in INNER.into_iter().filter(|inner| *inner < MOST_INNER * outer) {
                let contacts = vec![place, side];
                let mut u = with_contact(cut, place, outer, force, 3 + place.unknowns()).as_slice().to_vec();
                u.push(inner);
                u.resize(unknowns(&contacts), 0.0);
                starts.push((contacts, Start { u: DVector::from_vec(u), feet: self.feet.clone() }));
            }
        }
        let mut ranked: Vec<(f64, (Vec<Place>, Start))> = Vec::new();
        for (contacts, start) in starts {
            let mut problem = FrameProblem::new(model, &few, &contacts, feet.clone());
            let (at, _) = iterate(&mut problem, start.u, Damped::default(), PAIR_STEPS);
            if at.equations.cost.is_finite() {
                ranked.push((at.equations.cost, (contacts, Start { u: at.x, feet: self.feet.clone() })));
            }
        }
        ranked.sort_by(|a, b| a.0.total_cmp(&b.0));
        ranked.into_iter().map(|start| start.1).collect()
    }

    /// A few of the dots, by which starts are compared, with their arc lengths.
    fn thinned(&self, observed: &Observed) -> (Observed, Vec<f64>) {
        let stride = observed.dots.len().div_ceil(FEW).max(1);
        let few = Observed {
            dots: observed.dots.iter().copied().step_by(stride).collect(),
            channels: observed.channels.clone(),
            ..*observed
        };
        (few, self.feet.iter().copied().step_by(stride).collect())
    }

    /// The force across the rod at `cut`, at the arc length `s`, that turns the rod there from its direction at the base.
    fn force<M: RodModel>(&self, model: &M, s: f64, cut: Cut) -> f64 {
        let first = self.feet.first().copied().unwrap_or(0.0).min(s);
        let phi = self.at(model, first).phi;
        let contacts = [Place::Side { s: Some(s), rub: Some(0.0) }];
        let mut force = 0.0;
        for _ in 0..STEPS {
            let mut step = 0.0;
            let u = [cut.x, cut.y, cut.phi, force];
            trace(model, &contacts, &u, &[first], |_, node| {
                let turn = crate::numeric::wrap_angle(phi - node.cut.phi);
                step = turn.clamp(-MOST_TURN, MOST_TURN) / node.by[3][2];
            });
            if !step.is_finite() {
                return 0.0;
            }
            force += step;
        }
        force
    }
}

/// The unknowns of one contact at `cut`, with a force across the rod.
fn with_contact(cut: Cut, place: Place, s: f64, force: f64, count: usize) -> DVector<f64> {
    let mut u = vec![cut.x, cut.y, cut.phi];
    match place {
        Place::Tip => u.extend([force * cut.phi.cos(), force * cut.phi.sin()]),
        Place::Side { s: Some(_), .. } => u.push(force),
        Place::Side { s: None, .. } => u.extend([s, force]),
    }
    u.resize(count, 0.0);
    DVector::from_vec(u)
}

/// By how much a small force across the straight rod at the arc length `s` turns it there, rad per E I / L^2.
fn turn_per_force<M: RodModel>(model: &M, s: f64) -> f64 {
    let at = Cut { x: 0.0, y: 0.0, phi: 0.0, moment: 0.0 };
    model.carry_with_sensitivities(s, &at, 0.0, 0.0, -s).1.by_a[2].abs().max(f64::MIN_POSITIVE)
}

/// Shares of the way to the contact, or from it to the tip, at which a second one is tried.
const SHARES: [f64; 3] = [0.3, 0.55, 0.8];

/// Starts with a second contact that carries no force yet: on either side of the one that is known, and at the tip; each with its contacts.
fn second<M: RodModel>(model: &M, one: &Candidate, side: Place) -> Vec<(Vec<Place>, Start)> {
    let Some(contact) = one.shape.contacts.first() else { return Vec::new() };
    let mut starts = Vec::new();
    let mut add = |contacts: Vec<Place>, mut u: Vec<f64>| {
        u.resize(unknowns(&contacts), 0.0);
        starts.push((contacts, Start { u: DVector::from_vec(u), feet: one.feet.clone() }));
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
