//! Contacts of a reconstruction as the guess of a forward solve.

use crate::pipeline::Reading;
use crate::point::Touch;
use rod_contact::{Contact, ContactKind};
use rod_contours::{Composite, Contour, StretchKind};

/// The tangential contact at the same place, with the same force (m, N): a guess for
/// [`equilibrium`](rod_contact::equilibrium) on an object of one piece. Object and piece are 0, since reactions do not tell them;
/// [`Reading::guess`] finds them, and tells contacts of the tip.
///
/// ```
/// use rod_contact::{Contact, ContactKind, equilibrium};
/// use rod_contours::{Composite, Parabola};
/// use rod_core::{Pose, Rod};
/// use rod_reconstruct::{nalgebra::Matrix3, single};
/// let (rod, object) = (Rod::new(0.1, 6.3e-4)?, Composite::single(Parabola::new([0.0, 0.0], 50.0)?)?); // m, N m^2; m, 1/m
/// let clamp = |x| Pose { x, y: -0.04, phi: std::f64::consts::FRAC_PI_2 };
/// let rough = Contact { object: 0, piece: 0, kind: ContactKind::Tangent, s: 0.06, x: 0.025, y: 0.03, alpha: 1.2, force: 0.06, friction: None };
/// let felt = equilibrium(&rod, &object, clamp(0.01), &[rough])?.state.reactions;
///
/// // from the reactions to the contact, and from there to the reactions at the next pose
/// let touch = single(&rod, clamp(0.01), felt, &Matrix3::zeros())?;
/// let next = equilibrium(&rod, &object, clamp(0.0105), &[Contact::from(touch)])?;
/// next.is_admissible()?;
/// assert!(next.report.iterations <= 3 && (next.state.reactions.m0z - felt.m0z).abs() < 0.05 * felt.m0z.abs());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
impl From<Touch> for Contact {
    fn from(touch: Touch) -> Self {
        let Touch { s, x, y, alpha, force, .. } = touch;
        Self { object: 0, piece: 0, kind: ContactKind::Tangent, s, x, y, alpha, force, friction: None }
    }
}

impl Reading {
    /// The contacts of this sample, from the clamp to the tip, as a guess for [`equilibrium`](rod_contact::equilibrium) on `objects`:
    /// each on the piece, corner or notch that is closest to it, of the tip where the label says so; m and N. Empty for a free rod.
    /// None where a contact of the label is not known, or there is no object.
    ///
    /// ```
    /// use rod_contact::{ClampPath, Sweep, equilibrium};
    /// use rod_contours::{Composite, Parabola};
    /// use rod_core::{Pose, Rod};
    /// use rod_reconstruct::{Label, Sample, Settings, reconstruct};
    /// let (rod, left, right) = (Rod::new(0.1, 6.3e-4)?, Parabola::new([0.0, 0.0], 50.0)?, Parabola::new([0.03, 0.0], 50.0)?);
    /// let object = Composite::joined(vec![Box::new(left), Box::new(right)])?;
    /// let clamp = |x| Pose { x, y: -0.04, phi: std::f64::consts::FRAC_PI_2 };
    /// let states = Sweep::new(&rod, &object, ClampPath::new(clamp(0.08), clamp(-0.09))?, 2e-5)?.run().states;
    /// let samples: Vec<_> = states.iter().map(|state| Sample::new(state.pose, state.reactions)).collect();
    /// let found = reconstruct(&rod, &samples, &Settings::default())?;
    ///
    /// let k = found.readings.iter().position(|reading| reading.label == Label::BA).ok_or("no BA")? + 10;
    /// let guess = found.readings[k].guess(&object).ok_or("not resolved")?;
    /// let again = equilibrium(&rod, &object, states[k].pose, &guess)?;
    /// again.is_admissible()?;
    /// assert!((again.state.reactions.f0x - states[k].reactions.f0x).abs() < 1e-12);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn guess(&self, objects: &(impl AsRef<[Composite]> + ?Sized)) -> Option<Vec<Contact>> {
        self.touches()?.into_iter().map(|(touch, tip)| on(objects.as_ref(), touch, tip)).collect()
    }

    /// The contact points of this sample, from the clamp to the tip, each with whether it is the tip's; none where one of them is not known.
    pub(crate) fn touches(&self) -> Option<Vec<(Touch, bool)>> {
        match (self.touch, self.second) {
            _ if self.label == crate::Label::Free => Some(Vec::new()),
            (Ok(touch), None) if !self.label.several() => Some(vec![(touch, self.label.tip())]),
            (Ok(first), Some(Ok(second))) => Some(vec![(first, false), (second, self.label.tip())]),
            _ => None,
        }
    }
}

/// A contact where the closest of the objects is closest to it.
fn on(objects: &[Composite], touch: Touch, tip: bool) -> Option<Contact> {
    let closest = objects.iter().map(|object| object.closest(touch.x, touch.y)).enumerate();
    let (object, at) = closest.min_by(|(_, a), (_, b)| a.gap.abs().total_cmp(&b.gap.abs()))?;
    let smooth = if tip { ContactKind::Tip } else { ContactKind::Tangent };
    let (piece, kind) = match objects[object].kind(objects[object].stretch_at(at.t)) {
        StretchKind::Piece(piece) => (piece, smooth),
        StretchKind::Corner { before } => (before, if tip { ContactKind::Tip } else { ContactKind::Corner }),
        StretchKind::Notch { before } => (before, if tip { ContactKind::Notch } else { ContactKind::Tangent }),
    };
    Some(Contact { object, piece, kind, ..touch.into() })
}
