//! The modes of all contacts, chosen anew where something happens: those whose motion, to first order, is admissible.
//!
//! For each combination of modes the rates of all unknowns follow from one linear system: 3 n equations of the elastica, whose unknowns are
//! t, f, s (or the slope angle of the tip) and f_t of each contact, and one equation a contact by its mode.

use crate::contact_set::{Configuration, Unknowns};
use crate::scene::Setup;
use crate::scene::springs::springs;
use nalgebra::{DMatrix, DVector};
use rod_core::{Clamp, Grip, PhysicalRod, Pose, RodModel, System};
use smallvec::SmallVec;

/// Share of the normal force by which |f_t| may be off the friction's limit there.
const ON_CONE: f64 = 1e-9;
/// Rates in the wrong sense that are rounding: of lengths (L) and forces (E I / L^2) per unit of the path, relative to 1 + the largest rate.
/// Rates of a first contact are exact to 1e-13; a limit above 1e-6 would take second-order slips for standing still.
const RATE: f64 = 1e-9;
/// Force (E I / L^2) below which a contact is new, or about to leave: then its mode is open.
pub(crate) const UNLOADED: f64 = 1e-9;
/// Limit of the force along the contour (E I / L^2) below which a contact sticks for too short a way to be followed: it slips back at once.
const NEGLIGIBLE: f64 = 3e-8;
/// Most contacts whose modes are tried in all combinations: 3^6 systems of 24 unknowns.
const MOST_CONTACTS: usize = 6;

/// The contact set with the modes in which it may go on.
#[derive(Debug)]
pub(crate) enum Motion {
    /// In each of these ways: none where no combination of modes is admissible.
    Ways(Vec<Configuration>),
    /// The straight rod is pushed on along its axis and sticks: it cannot move.
    Jams,
    /// There are more contacts than can be tried.
    TooMany,
}

/// A mode to try.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Mode {
    /// Without friction, or with f_t = ratio f.
    Slips(f64),
    Sticks,
}

/// The modes in which the contacts of `configuration` may go on along the path. Contact `stopped` has just come to rest.
pub(crate) fn possible_motions<R: PhysicalRod>(
    setup: &Setup<'_, R>,
    configuration: &Configuration,
    stopped: Option<usize>,
) -> Motion {
    let n = configuration.count();
    if n > MOST_CONTACTS {
        return Motion::TooMany;
    }
    let choices: SmallVec<[SmallVec<[Mode; 3]>; 6]> =
        (0..n).map(|j| choice(setup, configuration, j, stopped)).collect();
    let all = AllRates::new(setup, configuration);
    let first_contact = n == 1 && configuration.force(0).abs() < UNLOADED && all.is_stretched;
    let mut ways = Vec::new();
    let mut modes: SmallVec<[Mode; 6]> = SmallVec::new();
    for mut number in 0..choices.iter().map(SmallVec::len).product() {
        modes.clear();
        for choice in &choices {
            modes.push(choice[number % choice.len()]);
            number /= choice.len();
        }
        if all.rates(&modes).is_some_and(|rates| all.admits(&modes, &rates, first_contact, stopped)) {
            ways.push(with_modes(configuration, &modes, &all.friction));
        }
    }
    let rubs = choices.first().is_some_and(|choice| choice.len() > 1);
    if ways.is_empty() && first_contact && rubs && all.is_pushed_on() { Motion::Jams } else { Motion::Ways(ways) }
}

/// The modes that contact j may be in at this instant.
fn choice<R: PhysicalRod>(
    setup: &Setup<'_, R>,
    configuration: &Configuration,
    j: usize,
    stopped: Option<usize>,
) -> SmallVec<[Mode; 3]> {
    let world = &setup.world;
    let coefficients = world.coefficients(configuration.contacts[j].stretch);
    let (rest, slips) = (coefficients.at_rest, coefficients.slipping);
    let (force, friction) = (configuration.force(j), configuration.friction(j));
    if rest == 0.0 || world.is_notch(configuration.contacts[j].stretch) {
        return SmallVec::from_slice(&[Mode::Slips(0.0)]);
    }
    if rest * force < NEGLIGIBLE && force >= UNLOADED {
        return match configuration.contacts[j].grip {
            // it turns back at once
            Grip::Sticks { .. } if stopped == Some(j) => {
                SmallVec::from_slice(&[Mode::Slips(-slips.copysign(friction))])
            }
            _ => SmallVec::from_slice(&[Mode::Slips(slips), Mode::Slips(-slips)]),
        };
    }
    if stopped == Some(j) {
        return SmallVec::from_slice(&[Mode::Sticks]);
    }
    if force < UNLOADED {
        return SmallVec::from_slice(&[Mode::Slips(slips), Mode::Slips(-slips), Mode::Sticks]);
    }
    // a rod that sticks may be held by more than one that slips
    let limit = if configuration.contacts[j].grip.sticks() { rest } else { slips };
    if friction.abs() < limit * force * (1.0 - ON_CONE) {
        return SmallVec::from_slice(&[Mode::Sticks]);
    }
    SmallVec::from_slice(&[Mode::Slips(slips.copysign(friction)), Mode::Sticks])
}

fn with_modes(configuration: &Configuration, modes: &[Mode], friction: &[f64]) -> Configuration {
    let mut chosen = configuration.clone();
    for (j, mode) in modes.iter().enumerate() {
        match *mode {
            Mode::Slips(ratio) => chosen.set_slipping(j, ratio),
            Mode::Sticks => chosen.set_sticking(j, friction[j]),
        }
    }
    chosen
}

/// Whether a clamp gives way to a force in the direction `phi`.
fn gives_way(clamp: impl Clamp, phi: f64) -> bool {
    let (sin, cos) = phi.sin_cos();
    springs(clamp.law()).iter().any(|spring| (spring.way[0] * cos + spring.way[1] * sin).abs() > RATE)
}

/// The equations of an equilibrium and their derivatives with all contacts sticking.
struct AllRates {
    n: usize,
    /// 4 n columns: t, f, s or slope angle of each contact, then f_t of each. The last n rows are the slip coordinates.
    matrix: DMatrix<f64>,
    /// How the equations of the clamp change along the path.
    by_tau: [f64; 3],
    force: SmallVec<[f64; 6]>,
    friction: SmallVec<[f64; 6]>,
    limit: SmallVec<[f64; 6]>,
    /// cos(slope angle - tangent angle) at the first contact, and the velocity of the clamp along the rod.
    cos_chi: f64,
    pushed: f64,
    /// Whether the rod is straight up to the first contact and its clamp does not give way along it: then it cannot become longer.
    is_stretched: bool,
}

impl AllRates {
    fn new<R: PhysicalRod>(setup: &Setup<'_, R>, configuration: &Configuration) -> Self {
        let n = configuration.count();
        let mut stuck = configuration.clone();
        for j in 0..n {
            stuck.set_sticking(j, configuration.friction(j));
        }
        let supports = stuck.supports(&setup.world);
        let problem = setup.problem(&supports, stuck.tau());
        let size = 4 * n;
        let (mut residual, mut matrix) = (Unknowns::from_elem(0.0, size), vec![0.0; size * size]);
        problem.evaluate(stuck.of_contacts(), &mut residual, Some(&mut matrix));
        let rate = setup.path.rate(configuration.tau());
        let (mut cos_chi, mut pushed, mut is_stretched) = (1.0, 0.0, false);
        if n > 0 {
            let support = setup.world.support(configuration.contacts[0].stretch, configuration.t(0));
            let phi = configuration.slope_along(0, &support);
            cos_chi = (phi - support.alpha).cos();
            let Pose { x, y, .. } = rate;
            pushed = x * phi.cos() + y * phi.sin();
            is_stretched = setup.rod.model().is_straight() && !gives_way(setup.clamp(configuration.tau()), phi);
        }
        let limit = |j: usize| setup.world.coefficients(configuration.contacts[j].stretch).at_rest;
        Self {
            n,
            matrix: DMatrix::from_vec(size, size, matrix),
            by_tau: [rate.x, rate.y, rate.phi],
            force: (0..n).map(|j| configuration.force(j)).collect(),
            friction: (0..n).map(|j| configuration.friction(j)).collect(),
            limit: (0..n).map(limit).collect(),
            cos_chi,
            pushed,
            is_stretched,
        }
    }

    /// The equations with these modes, and the rates of all unknowns by the path parameter; none where they are singular.
    fn rates(&self, modes: &[Mode]) -> Option<DVector<f64>> {
        let mut matrix = self.matrix.clone();
        for (j, mode) in modes.iter().enumerate() {
            if let Mode::Slips(ratio) = mode {
                let row = 3 * self.n + j;
                matrix.row_mut(row).fill(0.0);
                matrix[(row, row)] = 1.0;
                matrix[(row, 3 * j + 1)] = -ratio;
            }
        }
        let mut right = DVector::zeros(4 * self.n);
        for (i, rate) in self.by_tau.iter().enumerate() {
            right[i] = *rate;
        }
        let rates = matrix.lu().solve(&right)?;
        rates.iter().all(|rate| rate.is_finite()).then_some(rates)
    }

    /// The rate of the slip coordinate of contact j.
    fn slip(&self, rates: &DVector<f64>, j: usize) -> f64 {
        let row = self.matrix.row(3 * self.n + j);
        row.iter().zip(rates.iter()).map(|(entry, rate)| entry * rate).sum()
    }

    /// Whether the motion by these modes holds for all contacts.
    fn admits(&self, modes: &[Mode], rates: &DVector<f64>, first_contact: bool, stopped: Option<usize>) -> bool {
        (0..self.n).all(|j| {
            let (force_rate, friction_rate) = (rates[3 * j + 1], rates[3 * self.n + j]);
            // next to a fold rates are large, and so is their rounding
            let rounding = |rates: [f64; 2]| RATE * (1.0 + rates[0].abs() + rates[1].abs());
            let is_new = self.force[j] < UNLOADED;
            if is_new && force_rate <= 0.0 {
                return false;
            }
            match modes[j] {
                Mode::Slips(0.0) => true,
                Mode::Slips(ratio) => {
                    let slip = self.slip(rates, j);
                    // a straight rod that is moved sideways draws its tip back, to second order only
                    if first_contact && slip.abs() < RATE {
                        return ratio.signum() == 1.0_f64.copysign(self.cos_chi);
                    }
                    ratio.signum() * slip <= rounding([rates[3 * j], rates[3 * j + 2]])
                }
                // a straight rod cannot stretch: its axial force is not determined, and what the equations give for it is rounding
                Mode::Sticks if first_contact => false,
                // as it stops, its force moves along the border of the cone: to first order it moves as if it slipped on
                Mode::Sticks if stopped == Some(j) => true,
                Mode::Sticks if is_new => friction_rate.abs() <= self.limit[j] * force_rate,
                Mode::Sticks => {
                    let (limit, friction) = (self.limit[j] * self.force[j], self.friction[j]);
                    let inside = friction.abs() < limit * (1.0 - ON_CONE);
                    // on a smoother piece than the one from which it comes it cannot stick with that force
                    if friction.abs() > limit * (1.0 + ON_CONE) + UNLOADED {
                        return false;
                    }
                    // a coefficient at rest larger than that of slipping lets the rod stick as it stops
                    let leaves = 1.0_f64.copysign(friction) * friction_rate - self.limit[j] * force_rate;
                    inside || leaves <= rounding([friction_rate, self.limit[j] * force_rate])
                }
            }
        })
    }

    /// Whether the clamp moves on along a straight rod.
    fn is_pushed_on(&self) -> bool {
        self.pushed > RATE
    }
}

/// The same without the contacts that bear nothing; none where all bear something.
pub(crate) fn without_unloaded(configuration: &Configuration) -> Option<Configuration> {
    let bears = |j: usize| configuration.force(j) >= UNLOADED;
    if (0..configuration.count()).all(bears) {
        return None;
    }
    let mut loaded = configuration.clone();
    (0..configuration.count()).rev().filter(|j| !bears(*j)).for_each(|j| loaded.remove(j));
    Some(loaded)
}

/// Whether friction holds the rod in one way only: with g the slip coordinates of the contacts that slip, the matrix of d (f_t - ratio f) / dg at
/// a fixed clamp has positive principal minors (a P-matrix; Klarbring 1990). It is singular at the fold of a branch on which the rod slips.
pub(crate) fn resists<R: PhysicalRod>(setup: &Setup<'_, R>, configuration: &Configuration) -> bool {
    // a contact that bears nothing holds nothing back
    if let Some(loaded) = without_unloaded(configuration) {
        return resists(setup, &loaded);
    }
    let n = configuration.count();
    let slipping: SmallVec<[(usize, f64); 6]> = (0..n)
        .filter_map(|j| match configuration.contacts[j].grip {
            Grip::Slips { ratio } => Some((j, ratio)),
            Grip::Sticks { .. } => None,
        })
        .collect();
    let k = slipping.len();
    if k == 0 {
        return true;
    }
    let all = AllRates::new(setup, configuration);
    let decomposed = all.matrix.clone().lu();
    let mut stiffness = DMatrix::zeros(k, k);
    for (column, (other, _)) in slipping.iter().enumerate() {
        let mut right = DVector::zeros(4 * n);
        right[3 * n + other] = 1.0;
        let Some(rates) = decomposed.solve(&right) else { return false };
        for (row, (j, ratio)) in slipping.iter().enumerate() {
            stiffness[(row, column)] = rates[3 * n + j] - ratio * rates[3 * j + 1];
        }
    }
    // of more contacts only the leading minors: the others cost too much
    let subsets = if k <= MOST_CONTACTS { 1_u32 << k } else { 0 };
    let leading = (1..=k).map(|size| (0..size).collect::<SmallVec<[usize; 6]>>());
    let others = (1..subsets).map(|set| (0..k).filter(|j| set >> j & 1 == 1).collect::<SmallVec<[usize; 6]>>());
    leading.chain(others).all(|set| {
        DMatrix::from_fn(set.len(), set.len(), |row, column| stiffness[(set[row], set[column])]).determinant() > 0.0
    })
}
