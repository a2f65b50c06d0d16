//! The six components of a wrench, by name.

use super::unit::Dimension;
use super::wrench::Wrench;

/// One of the six components of a wrench.
///
/// ```
/// use rod_hw::{Component, Wrench};
/// let wrench = Wrench { force: [1.0, 2.0, 3.0], torque: [0.0, 0.0, 0.5] };
/// assert_eq!(Component::Tz.of(&wrench), 0.5);
/// assert_eq!(Component::parse("Mz"), Some(Component::Tz));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Component {
    /// Force along x.
    Fx,
    /// Force along y.
    Fy,
    /// Force along z.
    Fz,
    /// Torque about x.
    Tx,
    /// Torque about y.
    Ty,
    /// Torque about z.
    Tz,
}

impl Component {
    /// All of them, in the order of [`Wrench::components`].
    pub const ALL: [Self; 6] = [Self::Fx, Self::Fy, Self::Fz, Self::Tx, Self::Ty, Self::Tz];

    /// The component of this name: `Fx` to `Tz`, `Mx` to `Mz` for torques; capitals do not matter.
    pub fn parse(name: &str) -> Option<Self> {
        let named = |names: [&str; 6]| names.iter().position(|n| n.eq_ignore_ascii_case(name.trim()));
        let place = named(["Fx", "Fy", "Fz", "Tx", "Ty", "Tz"]).or_else(|| named(["", "", "", "Mx", "My", "Mz"]));
        place.filter(|_| !name.trim().is_empty()).and_then(|i| Self::ALL.get(i).copied())
    }

    /// Its place in [`Wrench::components`].
    pub fn index(self) -> usize {
        self as usize
    }

    /// Force or torque.
    pub fn dimension(self) -> Dimension {
        if self.index() < 3 { Dimension::Force } else { Dimension::Torque }
    }

    /// Its unit in SI: `N` or `N m`.
    pub fn si(self) -> &'static str {
        if self.index() < 3 { "N" } else { "N m" }
    }

    /// This component of a wrench, N or N m.
    pub fn of<T: Copy>(self, wrench: &Wrench<T>) -> T {
        let ([fx, fy, fz], [tx, ty, tz]) = (wrench.force, wrench.torque);
        [fx, fy, fz, tx, ty, tz][self.index()]
    }
}

impl core::fmt::Display for Component {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        core::fmt::Debug::fmt(self, f)
    }
}
