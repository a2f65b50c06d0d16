//! Which contacts a frame shows: none, one on the side or at the tip, or two.

use super::candidate::{Candidate, FEW_STEPS, MOST_STEPS, deviation, solve};
use super::observed::Observed;
use super::problem::Start;
use super::settings::ForceSettings;
use super::shape::Place;
use super::start::Sight;
use crate::numeric::chi_squared::{upper_tail, wilson_hilferty};
use nalgebra::DVector;
use rod_core::RodModel;

/// Quantile of the standard normal distribution for a contact to be told: one in a thousand frames without it shows it by chance. The same
/// probability below which a shape does not explain its frame.
pub(super) const BEYOND_CHANCE: f64 = 3.0902;
const CHANCE: f64 = 1e-3;
/// Standard deviations that the force of each of two contacts has at least.
const LOADED: f64 = 2.0;
/// Where on a free rod a force is looked for that is not seen, L.
const MIDDLE: f64 = 0.5;
/// Probability from which on a solution is taken without a look for a better one: there may be another minimum.
const SETTLES: f64 = 0.1;
/// How many times the chi squared of what explains a frame another explanation may have after a few steps.
const NEAR: f64 = 5.0;
/// How many starts are tried where the first ones do not explain the frame.
const MOST_STARTS: usize = 5;

/// What may touch the rod.
#[derive(Clone, Copy)]
pub(super) struct Allowed {
    /// Largest number of contacts.
    pub contacts: usize,
    /// Coefficient of friction.
    pub friction: f64,
}

impl Allowed {
    pub fn of(settings: &ForceSettings) -> Self {
        Self { contacts: settings.most_contacts, friction: settings.friction.max(0.0) }
    }

    /// How much the force along the rod is of that across it: unknown with friction.
    fn rub(&self) -> Option<f64> {
        (self.friction <= 0.0).then_some(0.0)
    }

    /// A contact on the side.
    fn side(&self) -> Place {
        Place::Side { s: None, rub: self.rub() }
    }
}

/// The shape that a frame shows, and the others that explain it as well.
pub(super) struct Chosen {
    pub best: Candidate,
    pub rivals: Vec<Candidate>,
    /// Of a free rod the contact that chance shows at its middle: how large a force may be there unseen.
    pub unseen: Option<Candidate>,
}

impl Candidate {
    /// The probability that chance leaves as much.
    pub fn p_value(&self) -> f64 {
        // as many unknowns as numbers leave nothing
        let left = self.freedom.max(1) as f64;
        upper_tail(self.chi_squared, left)
    }

    pub fn explains(&self) -> bool {
        self.p_value() > CHANCE
    }

    /// Whether this one explains so much more than `simpler` that chance does not.
    fn is_worth(&self, simpler: &Self) -> bool {
        self.worth(simpler) > 1.0
    }

    /// Whether it explains half as much more after a few steps: then the rest may come.
    fn is_half_worth(&self, simpler: &Self) -> bool {
        self.worth(simpler) > 0.5
    }

    /// How much more this one explains than `simpler`, in what chance does.
    fn worth(&self, simpler: &Self) -> f64 {
        let more = (simpler.freedom - self.freedom).max(1) as usize;
        (simpler.chi_squared - self.chi_squared) / wilson_hilferty(more, BEYOND_CHANCE)
    }
}

/// Solves for no contact, one, and two, and takes the fewest that explain the frame. None where the observations are too few for any shape.
pub(super) fn choose<M: RodModel>(model: &M, observed: &Observed, allowed: Allowed) -> Option<Chosen> {
    let sight = Sight::of(observed);
    let friction = allowed.friction;
    let free = solve(model, observed, &[], &sight.free(model), friction, MOST_STEPS);
    if allowed.contacts == 0 {
        return free.map(|best| Chosen { best, rivals: Vec::new(), unseen: None });
    }
    let mut singles = one(model, observed, &sight, allowed.side(), friction, MOST_STEPS);
    let known = singles.iter().filter(|one| one.explains()).map(|one| one.chi_squared).reduce(f64::min);
    singles.extend(match known {
        None => one(model, observed, &sight, Place::Tip, friction, MOST_STEPS),
        Some(known) => {
            let near = one(model, observed, &sight, Place::Tip, friction, FEW_STEPS);
            let near = near.into_iter().filter(|tip| tip.chi_squared < NEAR * (known + tip.freedom as f64));
            near.filter_map(|tip| solve(model, observed, &[Place::Tip], &tip.start(), friction, FEW_STEPS)).collect()
        }
    });
    singles.sort_by(|a, b| a.chi_squared.total_cmp(&b.chi_squared));
    let Some(free) = free else { return settle(singles) };
    if !singles.first().is_some_and(|one| one.is_worth(&free)) {
        let unseen = held_at(model, observed, &sight, MIDDLE, allowed);
        return Some(Chosen { best: free, rivals: Vec::new(), unseen });
    }
    if singles[0].p_value() > SETTLES || allowed.contacts == 1 {
        return settle(singles);
    }
    let mut pairs: Vec<Candidate> = Vec::new();
    for (contacts, start) in sight.two(model, observed, allowed.side(), &singles).iter().take(MOST_STARTS) {
        let solve_for = |start: &Start, steps| solve(model, observed, contacts, start, friction, steps);
        let pair = if singles[0].explains() {
            // a second contact that is not needed has no place, along which the steps go on for ever
            let near = solve_for(start, FEW_STEPS).filter(|pair| pair.is_half_worth(&singles[0]));
            near.and_then(|pair| solve_for(&pair.start(), MOST_STEPS))
        } else {
            solve_for(start, MOST_STEPS)
        };
        pairs.extend(pair.filter(|pair| pair.is_ordered() && pair.is_loaded()));
    }
    pairs.sort_by(|a, b| a.chi_squared.total_cmp(&b.chi_squared));
    if pairs.first().is_some_and(|pair| pair.is_worth(&singles[0])) { settle(pairs) } else { settle(singles) }
}

/// The best of candidates in the order of their chi squared, and those that differ from it and explain the frame as well.
fn settle(mut candidates: Vec<Candidate>) -> Option<Chosen> {
    if candidates.is_empty() {
        return None;
    }
    let best = candidates.remove(0);
    let mut rivals: Vec<Candidate> = Vec::new();
    for other in candidates {
        let more = other.chi_squared - best.chi_squared;
        let is_new = other.differs(&best) && rivals.iter().all(|rival| other.differs(rival));
        if is_new && other.explains() && more < wilson_hilferty(1, BEYOND_CHANCE) {
            rivals.push(other);
        }
    }
    Some(Chosen { best, rivals, unseen: None })
}

/// Distance of contacts (L), and share of a force, from which two shapes are told apart.
const DISTINCT: f64 = 1e-3;

impl Candidate {
    /// Whether this is another explanation: contacts of another number, another kind with another force, or at other places, beyond their standard
    /// deviations.
    fn differs(&self, other: &Self) -> bool {
        let (own, others) = (&self.shape.contacts, &other.shape.contacts);
        own.len() != others.len()
            || own.iter().zip(others).any(|(a, b)| {
                let way = (a.node.cut.x - b.node.cut.x).hypot(a.node.cut.y - b.node.cut.y);
                let way = way.max((a.node.s - b.node.s).abs());
                if a.is_tip != b.is_tip {
                    let ([ax, ay], [bx, by]) = (a.force.ab, b.force.ab);
                    return way > DISTINCT || (ax - bx).hypot(ay - by) > DISTINCT * ax.hypot(ay);
                }
                let variance = a.node.s_unknown.zip(self.covariance.as_ref()).map(|(k, covariance)| covariance[(k, k)]);
                way > DISTINCT + variance.unwrap_or_default().max(0.0).sqrt()
            })
    }

    /// Whether each contact has a force that chance does not show.
    fn is_loaded(&self) -> bool {
        let Some(covariance) = &self.covariance else { return false };
        self.shape.contacts.iter().all(|contact| {
            let [a, b] = contact.force.ab;
            let size = a.hypot(b);
            let rate = |k: usize, _| (a * contact.force.by[k][0] + b * contact.force.by[k][1]) / size;
            let gradient = DVector::from_fn(self.u.len(), rate);
            size > LOADED * deviation(covariance, &gradient)
        })
    }

    /// Whether two contacts are at two places.
    fn is_ordered(&self) -> bool {
        self.shape.contacts.windows(2).all(|pair| pair[1].node.s < pair[0].node.s - DISTINCT)
    }
}

/// All different solutions with one contact at a kind of place, from several starts where the first does not explain the frame.
fn one<M: RodModel>(
    model: &M,
    observed: &Observed,
    sight: &Sight,
    place: Place,
    friction: f64,
    most_steps: usize,
) -> Vec<Candidate> {
    let starts = sight.one(model, observed, place);
    // without points on the rod nothing leads to one solution
    let blind = observed.dots.len() < 3;
    let mut found: Vec<Candidate> = Vec::new();
    for start in starts.iter().take(if blind { usize::MAX } else { MOST_STARTS }) {
        let Some(candidate) = solve(model, observed, &[place], start, friction, most_steps) else { continue };
        let is_told = candidate.p_value() > SETTLES;
        if found.iter().all(|other| candidate.differs(other)) {
            found.push(candidate);
        }
        if is_told && !blind {
            break;
        }
    }
    found
}

/// The shape with its single contact at the arc length `s`.
pub(super) fn held_at<M: RodModel>(
    model: &M,
    observed: &Observed,
    sight: &Sight,
    s: f64,
    allowed: Allowed,
) -> Option<Candidate> {
    let place = Place::Side { s: Some(s), rub: allowed.rub() };
    let starts = sight.one(model, observed, place);
    let solved = starts
        .iter()
        .take(MOST_STARTS)
        .filter_map(|start| solve(model, observed, &[place], start, allowed.friction, MOST_STEPS));
    solved.min_by(|a, b| a.chi_squared.total_cmp(&b.chi_squared))
}
