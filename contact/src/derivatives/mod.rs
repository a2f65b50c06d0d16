//! Derivatives of an equilibrium, and of the pose of a transition, by everything that they depend on.

mod motion;
mod quantity;
mod restored;
mod transition;

pub use quantity::Quantity;
pub use transition::TransitionDerivatives;

use crate::error::ContactError;
use crate::friction::sliding::along;
use crate::scene::world::World;
use crate::state::State;
use motion::motion;
use restored::Restored;
use rod_contours::Composite;
use rod_core::{ContactRate, PhysicalRod, Pose, Reactions, Response, RodParameter, SupportRate, Units};

/// Condition number above which derivatives have less than two digits. At a fold, which a sweep locates to 1e-13 of arclength, it is
/// 1e10 or more; 1e-14 L before one it is about 1e7.
const MOST_CONDITION: f64 = 1e7;

/// How the curvature of a rod changes with a parameter.
fn curvature_rate<R: PhysicalRod>(rod: &R, parameter: RodParameter) -> Result<impl Fn(f64, f64) -> f64, ContactError> {
    if rod.curvature_rate(parameter, 0.5, 0.0).is_none() {
        return Err(ContactError::NoQuantity { what: parameter.to_string() });
    }
    Ok(move |s, moment| rod.curvature_rate(parameter, s, moment).unwrap_or(f64::NAN))
}

/// The derivatives of one equilibrium: what its reactions, contact points, arc lengths and forces change by.
///
/// They come from the Jacobian at the state, formed and inverted once: there is no other solve, and each quantity then costs a
/// product with the inverse. The relative error is below 1e-12 for [condition numbers](Self::condition) up to 1,000, and near a fold
/// about the square of the condition number times 1e-16, in the nine scans of Merker et al. (2020) against 31 digits. The contact set
/// stays as it is: at a transition these are the derivatives on the side of the state.
///
/// ```
/// use rod_contact::{ClampPath, Derivatives, Quantity, Sweep};
/// use rod_contours::{Composite, Parabola};
/// use rod_core::{Pose, Rod};
/// let (rod, object) = (Rod::new(0.1, 2e-3)?, Composite::single(Parabola::new([0.0, 0.0], 50.0)?)?);
/// let clamp = |x| Pose { x, y: -0.04, phi: std::f64::consts::FRAC_PI_2 };
/// let states = Sweep::new(&rod, &object, ClampPath::new(clamp(0.05), clamp(0.0))?, 0.01)?.run().states;
/// let state = &states[3];
/// let derivatives = Derivatives::new(&rod, &object, state)?;
/// // frictionless contacts and an elastic rod: forces come from a potential, and the matrix is symmetric
/// let stiffness = derivatives.stiffness()?;
/// assert!((stiffness[0][2] - stiffness[2][0]).abs() < 1e-12 * stiffness[0][2].abs());
/// let sharper = derivatives.by(Quantity::Shape { object: 0, piece: 0, parameter: "coefficient" })?;
/// // the contact stays on y = c x^2: dy = x^2 dc + 2 c x dx
/// let (at, rate) = (state.contacts[0], sharper.contacts[0]);
/// assert!((rate.y - at.x * at.x - 100.0 * at.x * rate.x).abs() < 1e-12 * rate.y.abs());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Derivatives<'a> {
    units: Units,
    world: World<'a>,
    state: &'a State,
    // on the heap, because it is large and is moved
    restored: Box<Restored>,
}

impl<'a> Derivatives<'a> {
    /// Of `state`, an equilibrium of `rod` on `objects` (one [`Composite`] or a list of them) by a sweep or by
    /// [`equilibrium`](crate::equilibrium()).
    ///
    /// # Errors
    /// [`ContactError::NotEquilibrium`] and [`ContactError::Guess`] for a state of another rod or of other objects,
    /// [`ContactError::Fold`] at a fold, where the derivatives are infinite.
    pub fn new<R: PhysicalRod>(
        rod: &R,
        objects: &'a (impl AsRef<[Composite]> + ?Sized),
        state: &'a State,
    ) -> Result<Self, ContactError> {
        let world = World::new(objects.as_ref(), rod.units().length);
        let restored = Box::new(Restored::new(rod, &world, state)?);
        let condition = restored.linear.condition();
        if condition > MOST_CONDITION {
            return Err(ContactError::Fold { condition });
        }
        Ok(Self { units: rod.units(), world, state, restored })
    }

    /// Condition number of the equations, with lengths in L and forces in 4 E I / L^2 (1 + force). It grows towards a fold with the
    /// inverse square root of the distance.
    pub fn condition(&self) -> f64 {
        self.restored.linear.condition()
    }

    /// The stiffness of the clamp: rows f0x, f0y (N) and m0z (N m), columns x0, y0 (m) and phi0 (rad). It is symmetric.
    ///
    /// # Errors
    /// [`ContactError::Fold`].
    pub fn stiffness(&self) -> Result<[[f64; 3]; 3], ContactError> {
        let (linear, units) = (&self.restored.linear, self.units);
        let [along_x, along_y] = [(1.0, 0.0), (0.0, 1.0)].map(|(x, y)| Pose { x, y, phi: 0.0 });
        let mut matrix = [[0.0; 3]; 3];
        let moves = [(along_x, units.length), (along_y, units.length), (Pose { x: 0.0, y: 0.0, phi: 1.0 }, 1.0)];
        for (column, (clamp, unit)) in moves.into_iter().enumerate() {
            let rates = linear.reactions_to_clamp(clamp);
            let Reactions { f0x, f0y, m0z } = rates.ok_or(ContactError::Fold { condition: linear.condition() })?;
            for (row, rate) in matrix.iter_mut().zip([f0x * units.force, f0y * units.force, m0z * units.moment]) {
                row[column] = rate / unit;
            }
        }
        Ok(matrix)
    }

    /// The change of everything per unit of one quantity, SI units.
    ///
    /// # Errors
    /// [`ContactError::NoQuantity`] where there is no such object, piece, or parameter of its shape.
    pub fn by(&self, quantity: Quantity<'_>) -> Result<Response, ContactError> {
        let linear = &self.restored.linear;
        let motion = motion(&self.world, &self.restored, &self.units, quantity)?;
        let rates = linear.response(motion.clamp, &motion.supports);
        let mut rates = self.in_units(rates.ok_or(ContactError::Fold { condition: linear.condition() })?);
        self.add_change_of_units(quantity, &mut rates);
        Ok(rates)
    }

    /// The change of everything where the contours at the contacts move in a given way: for contours with parameters of one's own. `rates`
    /// gives, for each contact (from the clamp to the tip), how the point of its contour (m) and the tangent angle there (radians) change per
    /// unit, at a fixed parameter of the curve.
    ///
    /// ```
    /// use rod_contact::{ClampPath, Derivatives, Quantity, SupportRate, Sweep};
    /// use rod_contours::{Composite, Parabola};
    /// use rod_core::{Pose, Rod};
    /// let (rod, object) = (Rod::new(0.1, 2e-3)?, Composite::single(Parabola::new([0.0, 0.0], 50.0)?)?);
    /// let clamp = |x| Pose { x, y: -0.04, phi: std::f64::consts::FRAC_PI_2 };
    /// let states = Sweep::new(&rod, &object, ClampPath::new(clamp(0.05), clamp(0.0))?, 0.01)?.run().states;
    /// let derivatives = Derivatives::new(&rod, &object, &states[3])?;
    /// // a contour that moves along x moves as the object does
    /// let moved = derivatives.by_contours(|_| SupportRate { x: 1.0, y: 0.0, alpha: 0.0 })?;
    /// assert_eq!(moved, derivatives.by(Quantity::ObjectX(0))?);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`ContactError::Fold`].
    pub fn by_contours(&self, rates: impl Fn(usize) -> SupportRate) -> Result<Response, ContactError> {
        let (linear, per_length) = (&self.restored.linear, 1.0 / self.units.length);
        let scaled = |SupportRate { x, y, alpha }| SupportRate { x: x * per_length, y: y * per_length, alpha };
        let supports: Vec<SupportRate> = (0..self.state.contacts.len()).map(|contact| scaled(rates(contact))).collect();
        let rates = linear.response(Pose { x: 0.0, y: 0.0, phi: 0.0 }, &supports);
        Ok(self.in_units(rates.ok_or(ContactError::Fold { condition: linear.condition() })?))
    }

    /// The change of everything per unit of a parameter of the rod, SI units. `rod` is the rod of the state.
    ///
    /// It takes an integral along the rod, by Gauss points that are halved until they agree to 1e-14; none for the natural curvature of a uniform rod.
    ///
    /// ```
    /// use rod_contact::{ClampPath, Derivatives, Sweep};
    /// use rod_contours::{CircularArc, Composite};
    /// use rod_core::{Pose, Rod, RodParameter};
    /// let rod = Rod::tapered(0.1, 1e-3, 4e-4, 3e9)?;
    /// let peg = Composite::single(CircularArc::new([0.0, 0.08], 0.005, 0.0, std::f64::consts::TAU)?)?;
    /// let clamp = |x| Pose { x, y: 0.0, phi: std::f64::consts::FRAC_PI_2 };
    /// let states = Sweep::new(&rod, &peg, ClampPath::new(clamp(0.02), clamp(-0.02))?, 0.01)?.run().states;
    /// let last = &states[4];
    /// // a rod with more taper is softer: it presses less
    /// let tapers = Derivatives::new(&rod, &peg, last)?.by_rod(&rod, RodParameter::Taper)?;
    /// assert!(tapers.contacts[0].force < 0.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`ContactError::NoQuantity`] where the rod has no such parameter, [`ContactError::NotEquilibrium`] for another rod.
    pub fn by_rod<R: PhysicalRod>(&self, rod: &R, parameter: RodParameter) -> Result<Response, ContactError> {
        let (rate, linear) = (curvature_rate(rod, parameter)?, &self.restored.linear);
        let rates = match parameter {
            // the same all along
            RodParameter::NaturalCurvature => linear.response_to_even_bend(rod.model(), rate(0.5, 0.0)),
            _ => linear.response_to_bend(rod.model(), rate),
        };
        Ok(self.in_units(rates.ok_or(ContactError::NotEquilibrium { reason: "it is of another rod" })?))
    }

    /// The change of everything per unit of the coefficient with which all contacts slide the same way along the rod, as
    /// [`Follower::sliding`](crate::Follower::sliding) lets them; a rod that rests in a notch does not slide there.
    ///
    /// ```
    /// use rod_contact::{ClampPath, Contact, Derivatives, Sweep, sliding_equilibrium};
    /// use rod_contours::{Composite, Parabola};
    /// use rod_core::{Pose, Rod};
    /// let (rod, object) = (Rod::new(0.1, 2e-3)?, Composite::single(Parabola::new([0.0, 0.0], 50.0)?)?);
    /// let clamp = |x| Pose { x, y: -0.04, phi: std::f64::consts::FRAC_PI_2 };
    /// let states = Sweep::new(&rod, &object, ClampPath::new(clamp(0.05), clamp(0.0))?, 0.01)?.run().states;
    /// let state = &states[3];
    /// let there = |mu| sliding_equilibrium(&rod, &object, state.pose, &state.contacts, mu).map(|found| found.state.reactions.f0y);
    /// let rate = Derivatives::new(&rod, &object, state)?.by_sliding()?.reactions.f0y;
    /// assert!(((there(1e-4)? - there(-1e-4)?) / 2e-4 - rate).abs() < 1e-7 * rate.abs());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`ContactError::Fold`].
    pub fn by_sliding(&self) -> Result<Response, ContactError> {
        let Restored { linear, configuration, .. } = &*self.restored;
        let ratios: Vec<f64> = (0..configuration.count()).map(|j| along(&self.world, configuration, j)).collect();
        Ok(self
            .in_units(linear.response_to_grips(&ratios).ok_or(ContactError::Fold { condition: linear.condition() })?))
    }

    /// Dimensionless rates per SI unit of a quantity, in SI.
    fn in_units(&self, mut rates: Response) -> Response {
        let units = self.units;
        let Reactions { f0x, f0y, m0z } = &mut rates.reactions;
        (*f0x, *f0y, *m0z) = (*f0x * units.force, *f0y * units.force, *m0z * units.moment);
        for ContactRate { x, y, s, force, .. } in &mut rates.contacts {
            (*x, *y, *s, *force) = (*x * units.length, *y * units.length, *s * units.length, *force * units.force);
        }
        rates
    }

    /// Adds what comes from the units of length, force (E I / L^2) and moment (E I / L) alone.
    fn add_change_of_units(&self, quantity: Quantity<'_>, rates: &mut Response) {
        let (length, stiffness) = (self.units.length, self.units.moment * self.units.length);
        let [by_length, by_force, by_moment] = match quantity {
            Quantity::Stiffness => [0.0, 1.0 / stiffness, 1.0 / stiffness],
            Quantity::Length => [1.0 / length, -2.0 / length, -1.0 / length],
            _ => return,
        };
        let Reactions { f0x, f0y, m0z } = self.state.reactions;
        rates.reactions.f0x += f0x * by_force;
        rates.reactions.f0y += f0y * by_force;
        rates.reactions.m0z += m0z * by_moment;
        for (rate, contact) in rates.contacts.iter_mut().zip(&self.state.contacts) {
            rate.x += contact.x * by_length;
            rate.y += contact.y * by_length;
            rate.s += contact.s * by_length;
            rate.force += contact.force * by_force;
        }
    }
}
