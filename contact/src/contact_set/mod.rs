//! A contact set with its unknowns at a pose: one point on a branch of equilibria.

pub(crate) mod edit;
pub(crate) mod guess;
pub(crate) mod notch;

use crate::limits::LIMITS;
use crate::scene::Setup;
use crate::scene::rod::Segment;
use crate::scene::world::World;
use crate::state::ContactKind;
use notch::straddles;
use rod_contours::{Range, StretchKind};
use rod_core::{Grip, Hold, PhysicalRod, Support, Supports};
use smallvec::SmallVec;
use std::f64::consts::PI;

/// Pulling force (E I / L^2) that counts as zero: a hundred times the error of a solved force.
pub(crate) const FORCE_TOLERANCE: f64 = 1e-12;

/// Way (L; rad at a corner) beyond the end of a piece that is rounding.
const BEYOND_PIECE: f64 = 1e-9;

/// A contact of the contact set: the stretch of the contour on which it is, how it holds the rod, and whether the rod slips or sticks there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ActiveContact {
    pub stretch: usize,
    pub hold: Hold,
    pub grip: Grip,
}

impl ActiveContact {
    /// A contact without friction, or whose friction is still to be chosen.
    pub const fn smooth(stretch: usize, hold: Hold) -> Self {
        Self { stretch, hold, grip: Grip::SMOOTH }
    }
}

/// An unknown of the boundary-value problem along the path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Unknown {
    /// Parameter of contact j along its stretch.
    Parameter(usize),
    /// Force of contact j.
    Force(usize),
    /// Arc length of contact j, where the rod is tangential.
    ArcLength(usize),
    /// Slope angle of the rod at contact j, where that is the tip's.
    Slope(usize),
    /// Parameter of the clamp's path; behind those of all contacts.
    Path,
}

impl Unknown {
    /// Its index among `size` unknowns, the path parameter included.
    pub const fn index(self, size: usize) -> usize {
        match self {
            Self::Parameter(j) => 3 * j,
            Self::Force(j) => 3 * j + 1,
            Self::ArcLength(j) | Self::Slope(j) => 3 * j + 2,
            Self::Path => size - 1,
        }
    }
}

/// Contacts of a set. Up to four are on the stack, which nearly all sets have. Room for more there would cost more, because sets are moved
/// often.
pub(crate) type Contacts = SmallVec<[ActiveContact; 4]>;

/// Unknowns of the boundary-value problem, three a contact, then the tangential force of each contact that sticks, and the path
/// parameter behind them.
pub(crate) type Unknowns = SmallVec<[f64; 13]>;

/// Contacts from the clamp to the tip, and z = (t_1, f_1, s_1, ..., tau), where the last third of a tip contact is the
/// slope angle instead of the arc length.
#[derive(Clone, Debug)]
pub(crate) struct Configuration {
    pub contacts: Contacts,
    pub z: Unknowns,
}

impl Configuration {
    pub fn free(tau: f64) -> Self {
        Self { contacts: SmallVec::new(), z: SmallVec::from_slice(&[tau]) }
    }

    pub fn count(&self) -> usize {
        self.contacts.len()
    }

    pub fn get(&self, unknown: Unknown) -> f64 {
        self.z[unknown.index(self.z.len())]
    }

    pub fn set(&mut self, unknown: Unknown, value: f64) {
        let index = unknown.index(self.z.len());
        self.z[index] = value;
    }

    pub fn tau(&self) -> f64 {
        self.get(Unknown::Path)
    }

    pub fn set_tau(&mut self, tau: f64) {
        self.set(Unknown::Path, tau);
    }

    pub fn t(&self, j: usize) -> f64 {
        self.get(Unknown::Parameter(j))
    }

    pub fn force(&self, j: usize) -> f64 {
        self.get(Unknown::Force(j))
    }

    /// Slope angle of the rod at its tip, where contact j is.
    pub fn slope(&self, j: usize) -> f64 {
        self.get(Unknown::Slope(j))
    }

    /// The unknowns of the contacts.
    pub fn of_contacts(&self) -> &[f64] {
        &self.z[..self.z.len() - 1]
    }

    pub fn is_tip(&self, j: usize) -> bool {
        self.contacts[j].hold == Hold::Tip
    }

    /// Whether the last contact is at the tip.
    pub fn ends_at_tip(&self) -> bool {
        self.contacts.last().is_some_and(|c| c.hold == Hold::Tip)
    }

    pub fn s(&self, j: usize) -> f64 {
        if self.is_tip(j) { 1.0 } else { self.get(Unknown::ArcLength(j)) }
    }

    pub fn insert(&mut self, j: usize, held: ActiveContact, unknowns: [f64; 3]) {
        self.contacts.insert(j, held);
        self.z.insert_from_slice(3 * j, &unknowns);
    }

    pub fn remove(&mut self, j: usize) {
        self.set_slipping(j, 0.0);
        self.contacts.remove(j);
        self.z.drain(3 * j..3 * j + 3);
    }

    /// The place of the tangential force of contact j, where that sticks.
    pub fn friction_index(&self, j: usize) -> usize {
        3 * self.count() + self.contacts[..j].iter().filter(|held| held.grip.sticks()).count()
    }

    /// The force on the rod along the contour at contact j.
    pub fn friction(&self, j: usize) -> f64 {
        match self.contacts[j].grip {
            Grip::Slips { ratio } => ratio * self.force(j),
            Grip::Sticks { .. } => self.z[self.friction_index(j)],
        }
    }

    /// The force along the contour over the normal one, where contact j slips; else 0.
    pub fn ratio(&self, j: usize) -> f64 {
        match self.contacts[j].grip {
            Grip::Slips { ratio } => ratio,
            Grip::Sticks { .. } => 0.0,
        }
    }

    /// Lets contact j slip with this part of its normal force along the contour.
    pub fn set_slipping(&mut self, j: usize, ratio: f64) {
        if self.contacts[j].grip.sticks() {
            let index = self.friction_index(j);
            self.z.remove(index);
        }
        self.contacts[j].grip = Grip::Slips { ratio };
    }

    /// Lets contact j stick where it is, with this force along the contour.
    pub fn set_sticking(&mut self, j: usize, friction: f64) {
        let index = self.friction_index(j);
        if self.contacts[j].grip.sticks() {
            self.z[index] = friction;
        } else {
            self.z.insert(index, friction);
        }
        self.contacts[j].grip = Grip::Sticks { t: self.t(j), s: self.s(j) };
    }

    /// Gives contact j the force along the contour that a state has there.
    pub fn rub(&mut self, j: usize, friction: f64, sticks: bool) {
        let force = self.force(j);
        if sticks {
            self.set_sticking(j, friction);
        } else if force != 0.0 {
            self.set_slipping(j, friction / force);
        }
    }

    /// Whether friction acts at any contact.
    pub fn rubs(&self) -> bool {
        self.contacts.iter().any(|held| held.grip != Grip::SMOOTH)
    }

    /// Slope angle of the rod at contact j, whose support is given.
    pub fn slope_along(&self, j: usize, support: &Support) -> f64 {
        match self.contacts[j].hold {
            Hold::Tangent { offset } => support.alpha + offset,
            Hold::Tip => self.slope(j),
        }
    }

    /// The contacts as supports of the rod.
    pub fn supports<'a>(&'a self, world: &'a World<'a>) -> ActiveSupports<'a> {
        ActiveSupports { world, contacts: &self.contacts }
    }

    /// The rod's segments from the clamp to the tip; the last one is free.
    pub fn segments<R: PhysicalRod>(&self, setup: &Setup<'_, R>) -> Segments {
        let mut segments = Segments::new();
        let supports = self.supports(&setup.world);
        let problem = setup.problem(&supports, self.tau());
        problem.cuts(self.of_contacts(), |segment| segments.push(segment));
        segments
    }

    pub fn kind(&self, world: &World<'_>, j: usize) -> ContactKind {
        let ActiveContact { stretch, hold, .. } = self.contacts[j];
        match (world.kind(stretch), hold) {
            (StretchKind::Notch { .. }, _) => ContactKind::Notch,
            (_, Hold::Tip) => ContactKind::Tip,
            (StretchKind::Corner { .. }, _) => ContactKind::Corner,
            _ => ContactKind::Tangent,
        }
    }

    /// Whether the contacts follow each other along the rod. Two that straddle a notch may run past each other: their meeting
    /// is a transition of its own.
    pub fn is_ordered(&self, world: &World<'_>) -> bool {
        let n = self.count() - usize::from(straddles(world, self));
        (0..n).all(|j| self.s(j) > if j == 0 { 0.0 } else { self.s(j - 1) })
    }

    /// The first contact that lies beyond the end of its piece, where the equations follow the curve on which the piece lies. At a corner:
    /// whose force points out of the cone of its normals.
    pub fn off_piece(&self, world: &World<'_>) -> Option<usize> {
        (0..self.count()).find(|j| {
            let (stretch, t) = (self.contacts[*j].stretch, self.t(*j));
            let Range { from, to } = world.span(stretch);
            let beyond = (from - t).max(t - to);
            let speed = world.support(stretch, t.clamp(from, to)).speed;
            beyond * if speed > 0.0 { speed } else { 1.0 } > BEYOND_PIECE
        })
    }

    /// Whether another configuration at the same pose is the same equilibrium: the parameters of a closed curve may differ by rounds.
    pub fn is_same_equilibrium(&self, other: &Self, world: &World<'_>) -> bool {
        let near = |u: f64, v: f64| (u - v).abs() < LIMITS.snap.same * (1.0 + v.abs());
        let alike = |j: usize| {
            let (mine, its) = (&self.contacts[j], &other.contacts[j]);
            let [p, q] = [(self, mine), (other, its)].map(|(set, held)| world.support(held.stretch, set.t(j)));
            let grips = match (mine.grip, its.grip) {
                (Grip::Sticks { .. }, Grip::Sticks { .. }) => true,
                (mine, its) => mine == its,
            };
            mine.stretch == its.stretch && self.is_tip(j) == other.is_tip(j) && grips && near(p.x, q.x) && near(p.y, q.y)
                // on a joint the parameter is the direction of the force
                && (p.speed != 0.0 || near(self.t(j), other.t(j)))
        };
        let is_parameter = |i: &usize| i.is_multiple_of(3) && *i < 3 * self.count();
        self.count() == other.count()
            && (0..self.count()).all(alike)
            && (0..self.z.len()).filter(|i| !is_parameter(i)).all(|i| near(self.z[i], other.z[i]))
    }
}

/// Segments of a rod with four contacts and a roller. More are on the heap.
pub(crate) const USUAL_SEGMENTS: usize = 6;

/// The segments of a rod.
pub(crate) type Segments = SmallVec<[Segment; USUAL_SEGMENTS]>;

/// The hold of a rod that lies on a contour. `angle` is its slope angle less the contour's, near a multiple of pi.
pub(crate) fn tangent_hold(angle: f64) -> Hold {
    Hold::Tangent { offset: PI * (angle / PI).round() }
}

/// The contacts of a set as the supports of the boundary-value problem.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ActiveSupports<'a> {
    pub world: &'a World<'a>,
    pub contacts: &'a [ActiveContact],
}

impl Supports for ActiveSupports<'_> {
    fn count(&self) -> usize {
        self.contacts.len()
    }
    fn hold(&self, j: usize) -> Hold {
        self.contacts[j].hold
    }
    fn support(&self, j: usize, t: f64) -> Support {
        self.world.support(self.contacts[j].stretch, t)
    }
    #[inline(always)]
    fn grip(&self, j: usize) -> Grip {
        self.contacts[j].grip
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rod_contours::{Composite, Parabola};

    #[test]
    fn contacts_follow_each_other_from_the_clamp_on() {
        let contour = Composite::single(Parabola::new([0.0, 0.0], 1.0).unwrap()).unwrap();
        let world = World::new(contour.as_ref(), 1.0);
        let at = |places: &[f64]| {
            let mut set = Configuration::free(0.0);
            for (j, s) in places.iter().enumerate() {
                set.insert(j, ActiveContact::smooth(0, Hold::Tangent { offset: 0.0 }), [0.0, 1.0, *s]);
            }
            set.is_ordered(&world)
        };
        assert!(at(&[]) && at(&[0.3]) && at(&[0.3, 0.7]));
        assert!(!at(&[0.7, 0.3]) && !at(&[0.3, 0.3]) && !at(&[-0.1]));
    }

    #[test]
    fn an_edge_ends_at_its_corners() {
        let square = Composite::polygon(&[[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]]).unwrap();
        let world = World::new(square.as_ref(), 1.0);
        let off = |stretch: usize, t: f64| {
            let mut set = Configuration::free(0.0);
            set.insert(0, ActiveContact::smooth(stretch, Hold::Tip), [t, 1.0, 0.0]);
            set.off_piece(&world)
        };
        for stretch in 0..square.stretches().len() {
            let [from, to] = [false, true].map(|upper| world.border(stretch, upper));
            assert!(
                off(stretch, from).is_none() && off(stretch, 0.5 * (from + to)).is_none() && off(stretch, to).is_none()
            );
            assert!(off(stretch, from - 1e-3) == Some(0) && off(stretch, to + 1e-3) == Some(0), "{stretch}");
        }
    }
}
