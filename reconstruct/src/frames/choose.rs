//! Which contacts a frame shows: none, one on the side or at the tip, or two.

use super::candidate::{Candidate, FEW_STEPS, MOST_STEPS, SOME_STEPS, solve};
use super::observed::Observed;
use super::problem::Start;
use super::settings::ForceSettings;
use super::shape::Place;
use super::start::Starts;
use crate::numeric::chi_squared::{upper_tail, wilson_hilferty};
use rod_core::RodModel;

/// Quantile of the standard normal distribution for a contact to be told: one in a thousand frames without it shows it by chance. The same for a frame
/// to contradict a pole. And the same probability, below which a shape does not explain its frame, or a pole its film.
pub(super) const BEYOND_CHANCE: f64 = 3.0902;
pub(super) const CHANCE: f64 = 1e-3;
/// Where on a free rod a force is looked for that is not seen, L.
const MIDDLE: f64 = 0.5;
/// Probability that chance leaves as much, from which on a solution is taken without a look for a better one: there may be another minimum.
const SETTLES: f64 = 0.1;
/// How many times the chi squared of what explains a frame another explanation may have after a few steps.
const NEAR: f64 = 5.0;
/// How many starts are tried, and how many where none of them explains the frame so well that chance often leaves as much.
const FEW_STARTS: usize = 5;
const MOST_STARTS: usize = 15;

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
        Self {
            contacts: settings.most_contacts.min(if settings.pole.is_some() { 1 } else { 2 }),
            friction: settings.friction.max(0.0),
        }
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

impl Chosen {
    fn of(best: Candidate) -> Self {
        Self { best, rivals: Vec::new(), unseen: None }
    }
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

    /// How much more this one explains than `simpler`, in what chance does.
    fn worth(&self, simpler: &Self) -> f64 {
        let more = (simpler.freedom - self.freedom).max(1) as usize;
        (simpler.chi_squared - self.chi_squared) / wilson_hilferty(more, BEYOND_CHANCE)
    }
}

/// Solves for no contact, one, and two, and takes the fewest that explain the frame. None where the observations are too few for any shape.
pub(super) fn choose<M: RodModel>(model: &M, observed: &Observed, allowed: Allowed) -> Option<Chosen> {
    let search = Search::of(model, observed, allowed);
    let free = search.starts.free(model);
    if allowed.contacts == 0 {
        return settle(search.solve(&free, MOST_STEPS).into_iter().collect());
    }
    let ones = [allowed.side(), Place::Tip].map(|place| search.starts.one(model, place)).concat();
    let plausible = search.starts.plausible([ones, vec![free.clone()]].concat());
    let (of_free, ones): (Vec<Start>, Vec<Start>) = plausible.into_iter().partition(|start| start.contacts.is_empty());
    // at first sight a free rod may look worse than it is: it has the direction of its middle
    let free = search.solve(&free, if of_free.is_empty() { FEW_STEPS } else { MOST_STEPS });
    let singles = sorted(search.all(&ones, None));
    let is_free = |free: &Candidate| singles.first().is_none_or(|single| !single.is_worth(free));
    if let Some(free) = free.filter(is_free) {
        let unseen = match observed.pole {
            None => search.held_at(MIDDLE),
            // no contact with the pole: a force that is not seen is another one
            Some(_) => Search::of(model, &Observed { pole: None, ..observed.clone() }, allowed).held_at(MIDDLE),
        };
        return Some(Chosen { unseen, ..Chosen::of(free) });
    }
    let single = singles.first()?;
    if single.p_value() > SETTLES || allowed.contacts == 1 {
        return settle(singles);
    }
    let starts = search.starts.plausible(search.starts.two(model, allowed.side(), &singles));
    let pairs = search.all(&starts, Some(single).filter(|single| single.explains()));
    let pairs = sorted(pairs.into_iter().filter(Candidate::is_ordered).collect());
    if pairs.first().is_some_and(|pair| pair.is_worth(single)) { settle(pairs) } else { settle(singles) }
}

/// The search for shapes that explain a frame.
pub(super) struct Search<'a, M> {
    model: &'a M,
    observed: &'a Observed,
    allowed: Allowed,
    starts: Starts<'a>,
}

impl<'a, M: RodModel> Search<'a, M> {
    pub fn of(model: &'a M, observed: &'a Observed, allowed: Allowed) -> Self {
        Self { model, observed, allowed, starts: Starts::of(model, observed) }
    }

    fn solve(&self, start: &Start, most_steps: usize) -> Option<Candidate> {
        solve(self.model, self.observed, start, self.allowed.friction, most_steps)
    }

    /// The different shapes from these starts, the best of which come first. As soon as one leaves no more than chance often does, the others are given
    /// up after a few steps that do not come near to it, and no more than a few are tried; with a shape of fewer contacts that explains
    /// the frame, `simpler`, those are given up that are not worth their contact.
    fn all(&self, starts: &[Start], simpler: Option<&Candidate>) -> Vec<Candidate> {
        let mut found: Vec<Candidate> = Vec::new();
        let is_blind = self.starts.is_blind();
        for (number, start) in starts.iter().enumerate() {
            let known = found.iter().filter(|one| one.p_value() > SETTLES).map(|one| one.chi_squared).reduce(f64::min);
            let most = if known.is_some() || simpler.is_some() { FEW_STARTS } else { MOST_STARTS };
            if number >= most && !is_blind {
                break;
            }
            let goes_on = |near: &Candidate, worth: f64| {
                known.is_none_or(|known| near.chi_squared < NEAR * (known + near.freedom as f64))
                    && simpler.is_none_or(|simpler| near.worth(simpler) > worth)
            };
            let is_sought = is_blind || (known.is_none() && simpler.is_none());
            let shape = if is_sought {
                self.solve(start, MOST_STEPS)
            } else {
                // contacts that are not needed have no place, along which the steps go on for ever
                let near = self.solve(start, FEW_STEPS).filter(|near| goes_on(near, 0.5));
                let near =
                    near.and_then(|near| self.solve(&near.start(), SOME_STEPS)).filter(|near| goes_on(near, 1.0));
                near.and_then(|near| self.solve(&near.start(), MOST_STEPS))
            };
            found.extend(shape.filter(|shape| found.iter().all(|other| shape.differs(other))));
        }
        found
    }

    /// The shape with its single contact at the arc length `s`.
    pub fn held_at(&self, s: f64) -> Option<Candidate> {
        let starts = self.starts.one(self.model, Place::Side { s: Some(s), rub: self.allowed.rub() });
        let solved = starts.iter().take(FEW_STARTS).filter_map(|start| self.solve(start, MOST_STEPS));
        solved.min_by(|a, b| a.chi_squared.total_cmp(&b.chi_squared))
    }
}

fn sorted(mut shapes: Vec<Candidate>) -> Vec<Candidate> {
    shapes.sort_by(|a, b| a.chi_squared.total_cmp(&b.chi_squared));
    shapes
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
    Some(Chosen { rivals, ..Chosen::of(best) })
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

    /// Whether two contacts are at two places.
    fn is_ordered(&self) -> bool {
        self.shape.contacts.windows(2).all(|pair| pair[1].node.s < pair[0].node.s - DISTINCT)
    }
}
