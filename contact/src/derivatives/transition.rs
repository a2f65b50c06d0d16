//! The derivative of the pose of a transition: the implicit function theorem on the equations of the equilibrium together with
//! the one that defines the transition.

use crate::contact_set::{Configuration, Unknown};
use crate::derivatives::motion::{Motion, border_rate, motion};
use crate::derivatives::quantity::Quantity;
use crate::derivatives::restored::Restored;
use crate::derivatives::{MOST_CONDITION, curvature_rate};
use crate::error::ContactError;
use crate::event::{Event, EventKind};
use crate::scene::world::World;
use rod_contours::Composite;
use rod_core::{PathRow, PhysicalRod, Pose, RodParameter, Units};

/// Largest force (E I / L^2), parameter or angle by which the defining unknown of a located transition is off its value.
const LOCATED: f64 = 1e-8;

/// Largest change of the path parameter along a branch, in L per unknown in its natural size, that counts as a fold.
const STATIONARY: f64 = 1e-5;

/// Where the defining unknown of a transition goes when a quantity changes.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Value {
    /// It stays: a force of 0, an arc length of 1.
    Fixed,
    /// With the upper or lower border of a stretch.
    Border { stretch: usize, upper: bool },
    /// With the tangent angle of a wall where it ends.
    Wall { wall: usize, upper: bool },
    /// There is none: the branch turns back, and tau is stationary along it.
    Fold,
}

/// The derivatives of the pose of a transition by all quantities, along a given path.
///
/// At a transition one more equation holds: a force vanishes (`touch`, `first-contact`, `release`), the rod is tangential at its
/// tip (`tip-to-tangent`, `tangent-to-tip`), a contact is at the border of its piece (`piece`, `slip`), or the equilibrium ends in a
/// fold (`snap`, `snap-off`), where the left null vector of the Jacobian gives the derivative. The Jacobian, bordered by the path
/// and that equation, is inverted once.
///
/// ```
/// use rod_contact::{ClampPath, EventKind, Quantity, Sweep, TransitionDerivatives};
/// use rod_contours::{Composite, Parabola};
/// use rod_core::{Pose, Rod};
/// // an upright rod, moved to the left, meets y = 5 x^2 with its tip where 5 x^2 = 1 - 0.4: tau = 1 - x
/// let (rod, object) = (Rod::new(1.0, 1.0)?, Composite::single(Parabola::new([0.0, 0.0], 5.0)?)?);
/// let clamp = |x| Pose { x, y: -0.4, phi: std::f64::consts::FRAC_PI_2 };
/// let path = ClampPath::new(clamp(1.0), clamp(0.0))?;
/// let events = Sweep::new(&rod, &object, path, 0.1)?.run().events;
/// let touch = TransitionDerivatives::new(&rod, &object, &events[0], path.rate())?;
/// let x = 0.12_f64.sqrt();
/// let longer = touch.by(Quantity::Length)?; // 10 x dx = dL
/// assert!((longer + 1.0 / (10.0 * x)).abs() < 1e-14);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct TransitionDerivatives<'a> {
    units: Units,
    world: World<'a>,
    restored: Restored,
    value: Value,
    row: PathRow,
}

impl<'a> TransitionDerivatives<'a> {
    /// Of an event of a sweep of `rod` past `objects` whose clamp moves at `rate` there (m, m and rad per unit of the path's
    /// parameter, as [`ClampPath::rate`](crate::ClampPath::rate)). On a path that bends it is `path.point(t).rate` at the parameter t where
    /// the pose is that of the event; of a [`Chain`](crate::Chain), the rate of the event's leg.
    ///
    /// # Errors
    /// [`ContactError::NotFinite`] and [`ContactError::NoPath`] for a rate that is none; [`ContactError::NotEquilibrium`] and [`ContactError::Guess`] for an event of another rod or of other objects,
    /// [`ContactError::NoCondition`] where no one equation defines the pose: two contacts that part or run together at an inflection
    /// of the contour, a touch along a straight edge after which no contact set goes on.
    pub fn new<R: PhysicalRod>(
        rod: &R,
        objects: &'a (impl AsRef<[Composite]> + ?Sized),
        event: &Event,
        rate: Pose,
    ) -> Result<Self, ContactError> {
        let length = rod.units().length;
        let world = World::new(objects.as_ref(), length);
        let speed = rate.x.hypot(rate.y) / length + rate.phi.abs();
        if !speed.is_finite() {
            return Err(ContactError::NotFinite { what: "rate of the path", value: speed });
        }
        if speed == 0.0 {
            return Err(ContactError::NoPath { pose: event.pose() });
        }
        let rate = Pose { x: rate.x / length, y: rate.y / length, phi: rate.phi };
        let [before, after] = [&event.before, &event.after].map(|state| Restored::new(rod, &world, state));
        let before = before?;
        let defined = match event.kind {
            // a jump leads elsewhere
            EventKind::Snap | EventKind::SnapOff | EventKind::SlipOver => of_jump(&world, before, rate),
            kind => defining(&world, kind, before, after?).and_then(|(set, unknown, value)| {
                let row = row(&set, rate, unknown)?;
                Some((set, value, row))
            }),
        };
        let (restored, value, row) =
            defined.ok_or_else(|| ContactError::NoCondition { event: event.kind.to_string() })?;
        Ok(Self { units: rod.units(), world, restored, value, row })
    }

    /// The change of the path parameter at the transition (m, or rad where the clamp only turns) per unit of one quantity. The path
    /// stays as it is, or is moved as a whole by a quantity of the clamp.
    ///
    /// # Errors
    /// [`ContactError::NoQuantity`] where there is no such object, piece, or parameter of its shape, or where that does not tell
    /// how the end of a piece moves at which the transition is.
    pub fn by(&self, quantity: Quantity<'_>) -> Result<f64, ContactError> {
        let linear = &self.restored.linear;
        let Motion { clamp, supports } = motion(&self.world, &self.restored, &self.units, quantity)?;
        let missing = || ContactError::NoQuantity { what: quantity.to_string() };
        let rates = linear.residual_rates(clamp, &supports).ok_or_else(missing)?;
        let value = match self.value {
            Value::Fixed | Value::Fold => 0.0,
            Value::Border { stretch, upper } => border_rate(&self.world, stretch, upper, quantity)?,
            Value::Wall { wall, upper } => self.world_angle_rate(wall, upper, quantity)?,
        };
        Ok(self.row.by_value * value - self.by_residual(&rates))
    }

    /// The same by a parameter of the rod. `rod` is the rod of the event.
    ///
    /// # Errors
    /// [`ContactError::NoQuantity`] where the rod has no such parameter, [`ContactError::NotEquilibrium`] for another rod.
    pub fn by_rod<R: PhysicalRod>(&self, rod: &R, parameter: RodParameter) -> Result<f64, ContactError> {
        let rates = self.restored.linear.bend_rates(rod.model(), curvature_rate(rod, parameter)?);
        Ok(-self.by_residual(&rates.ok_or(ContactError::NotEquilibrium { reason: "it is of another rod" })?))
    }

    fn by_residual(&self, rates: &[f64]) -> f64 {
        self.row.by_residual.iter().zip(rates).map(|(row, rate)| row * rate).sum()
    }

    /// The change of the tangent angle of a wall where it ends.
    fn world_angle_rate(&self, wall: usize, upper: bool, quantity: Quantity<'_>) -> Result<f64, ContactError> {
        match quantity {
            Quantity::ObjectAngle(object) if self.world.object(wall) == object => Ok(1.0),
            Quantity::Shape { object, piece, parameter } if self.world.object(wall) == object => {
                let t = self.world.border(wall, upper);
                let fixed = self.world.support_rate(wall, t, piece, parameter);
                let missing = || ContactError::NoQuantity { what: quantity.to_string() };
                let turning = self.world.support(wall, t).turning;
                Ok(fixed.ok_or_else(missing)?.alpha + turning * border_rate(&self.world, wall, upper, quantity)?)
            }
            _ => Ok(0.0),
        }
    }
}

/// The row of d tau where the defining unknown has a value; none where that does not define a pose, as where the rod lies along a
/// straight edge.
fn row(set: &Restored, rate: Pose, unknown: Unknown) -> Option<PathRow> {
    let row = set.linear.path_row(rate, unknown.index(set.configuration.count()));
    row.filter(|row| row.condition < MOST_CONDITION)
}

/// The contact set that holds at a transition between two of them, the unknown that defines where it is, and its value.
fn defining(
    world: &World<'_>,
    kind: EventKind,
    before: Restored,
    after: Restored,
) -> Option<(Restored, Unknown, Value)> {
    let (n, last) = (before.configuration.count(), after.configuration.count().checked_sub(1));
    match kind {
        EventKind::FirstContact | EventKind::Touch => {
            if let Some(j) = without_force(&after.configuration) {
                return Some((after, Unknown::Force(j), Value::Fixed));
            }
            // the tip in a notch lies down on a wall, and parts into two contacts
            on_wall(world, &before.configuration).map(|(unknown, value)| (before, unknown, value))
        }
        EventKind::Release => {
            if let Some(j) = without_force(&before.configuration) {
                return Some((before, Unknown::Force(j), Value::Fixed));
            }
            // a contact on one wall of a notch meets the tip on the other
            let (j, value) = at_border(world, &before.configuration)?;
            Some((before, Unknown::Parameter(j), value))
        }
        EventKind::TipToTangent => Some((after, Unknown::ArcLength(last?), Value::Fixed)),
        EventKind::TangentToTip => Some((before, Unknown::ArcLength(n.checked_sub(1)?), Value::Fixed)),
        EventKind::Piece => {
            let (j, value) = at_border(world, &before.configuration)?;
            Some((before, Unknown::Parameter(j), value))
        }
        // where a mode changes the rod has no derivatives, and its equation is not that of one unknown
        EventKind::Stick | EventKind::Slip => None,
        EventKind::Snap | EventKind::SnapOff | EventKind::SlipOver => None,
    }
}

/// The contact whose force is about 0, if there is one.
fn without_force(configuration: &Configuration) -> Option<usize> {
    let forces = (0..configuration.count()).map(|j| (j, configuration.force(j).abs()));
    forces.min_by(|one, other| one.1.total_cmp(&other.1)).filter(|least| least.1 < LOCATED).map(|least| least.0)
}

/// The contact that is at a border of its stretch, if there is one, and that border.
fn at_border(world: &World<'_>, configuration: &Configuration) -> Option<(usize, Value)> {
    (0..configuration.count()).find_map(|j| {
        let (stretch, t) = (configuration.contacts[j].stretch, configuration.t(j));
        let near = |upper: &bool| (t - world.border(stretch, *upper)).abs() < LOCATED * (1.0 + t.abs());
        let upper = [false, true].into_iter().find(near)?;
        Some((j, Value::Border { stretch, upper }))
    })
}

/// The wall that a rod with its tip in a notch lies on, if it does.
fn on_wall(world: &World<'_>, configuration: &Configuration) -> Option<(Unknown, Value)> {
    let last = configuration.count().checked_sub(1).filter(|last| configuration.is_tip(*last))?;
    let notch = configuration.contacts[last].stretch;
    let lies_on = |(wall, upper): (Option<usize>, bool)| {
        let wall = wall.filter(|_| world.is_notch(notch))?;
        let alpha = world.support(wall, world.border(wall, upper)).alpha;
        let angle = configuration.slope(last) - alpha;
        (angle.sin().abs() < LOCATED).then_some((Unknown::Slope(last), Value::Wall { wall, upper }))
    };
    world.walls(notch).into_iter().zip([true, false]).find_map(lies_on)
}

/// The last contact where it is tangential and at s = 1.
fn at_tip(configuration: &Configuration) -> Option<(Unknown, Value)> {
    let last = configuration.count().checked_sub(1).filter(|last| !configuration.is_tip(*last))?;
    let is_at_tip = (configuration.s(last) - 1.0).abs() < LOCATED;
    is_at_tip.then_some((Unknown::ArcLength(last), Value::Fixed))
}

/// The same where the rod jumps, with the row of d tau: where no contact set goes on after a transition, or at a fold.
fn of_jump(world: &World<'_>, before: Restored, rate: Pose) -> Option<(Restored, Value, PathRow)> {
    let configuration = &before.configuration;
    let located = at_border(world, configuration)
        .map(|(j, value)| (Unknown::Parameter(j), value))
        .or_else(|| on_wall(world, configuration))
        .or_else(|| at_tip(configuration));
    if let Some((unknown, value)) = located {
        let row = row(&before, rate, unknown)?;
        return Some((before, value, row));
    }
    // At a fold any unknown that changes along the branch will do.
    let size = configuration.of_contacts().len();
    let rows = (0..size).filter_map(|unknown| before.linear.path_row(rate, unknown));
    let row = rows.min_by(|one, other| one.condition.total_cmp(&other.condition))?;
    (row.by_value.abs() < STATIONARY && row.condition < MOST_CONDITION).then_some((before, Value::Fold, row))
}
