//! The meanings of columns.

use crate::sample::Dimension;
use std::fmt;

/// What a column means. Its own name ([`Display`](fmt::Display), as `f0x`) stands for SI units, N, N m, m, rad, s and degC,
/// where no unit is written; other names that it goes by (`Fx`, `Mx`, `time`) need a unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Role {
    /// Time of the sample.
    Time,
    /// When it arrived, by the host's clock.
    HostTime,
    /// Time by the device's clock.
    DeviceTime,
    /// Number by the device's counter; up to 2^53 it is exact.
    Sequence,
    /// Status word.
    Status,
    /// Temperature of the sensor.
    Temperature,
    /// Flags by name.
    Quality,
    /// Flags of the raw sample by name.
    RawQuality,
    /// The clamp.
    X0,
    /// The clamp.
    Y0,
    /// Angle of the clamp.
    Phi0,
    /// Reaction of the clamp on the rod.
    F0x,
    /// Reaction of the clamp on the rod.
    F0y,
    /// Reaction of the clamp on the rod, about the clamp.
    M0z,
    /// Standard deviation.
    SigmaF0x,
    /// Standard deviation.
    SigmaF0y,
    /// Standard deviation.
    SigmaM0z,
    /// Bound of the systematic error.
    SystematicF0x,
    /// Bound of the systematic error.
    SystematicF0y,
    /// Bound of the systematic error.
    SystematicM0z,
    /// Force across the plane.
    F0z,
    /// Moment out of the plane.
    M0x,
    /// Moment out of the plane.
    M0y,
    /// Force on the sensor.
    Fx,
    /// Force on the sensor.
    Fy,
    /// Force on the sensor.
    Fz,
    /// Torque on the sensor, about its origin.
    Tx,
    /// Torque on the sensor, about its origin.
    Ty,
    /// Torque on the sensor, about its origin.
    Tz,
}

use Dimension::{Angle, Force, Length, Temperature, Time, Torque};

/// Role, its own name, what it is measured in, other names.
type Line = (Role, &'static str, Option<Dimension>, &'static [&'static str]);

/// In the order of [`Role`].
const ROLES: [Line; Role::COUNT] = [
    (Role::Time, "t", Some(Time), &["time", "Time", "timestamp", "Timestamp", "Zeit", "X_Value"]),
    (Role::HostTime, "host_time", Some(Time), &[]),
    (Role::DeviceTime, "device_time", Some(Time), &[]),
    (
        Role::Sequence,
        "sequence",
        None,
        &["seq", "Sequence", "ft_sequence", "rdt_sequence", "RDT Sequence", "FT Sequence"],
    ),
    (Role::Status, "status", None, &["Status"]),
    (Role::Temperature, "temperature", Some(Temperature), &["Temperature", "temp", "Temp"]),
    (Role::Quality, "quality", None, &[]),
    (Role::RawQuality, "raw_quality", None, &[]),
    (Role::X0, "x0", Some(Length), &["x_0"]),
    (Role::Y0, "y0", Some(Length), &["y_0"]),
    (Role::Phi0, "phi0", Some(Angle), &["phi_0"]),
    (Role::F0x, "f0x", Some(Force), &["F0x", "f_0x"]),
    (Role::F0y, "f0y", Some(Force), &["F0y", "f_0y"]),
    (Role::M0z, "m0z", Some(Torque), &["M0z", "m_0z"]),
    (Role::SigmaF0x, "sigma_f0x", Some(Force), &[]),
    (Role::SigmaF0y, "sigma_f0y", Some(Force), &[]),
    (Role::SigmaM0z, "sigma_m0z", Some(Torque), &[]),
    (Role::SystematicF0x, "systematic_f0x", Some(Force), &[]),
    (Role::SystematicF0y, "systematic_f0y", Some(Force), &[]),
    (Role::SystematicM0z, "systematic_m0z", Some(Torque), &[]),
    (Role::F0z, "f0z", Some(Force), &["F0z"]),
    (Role::M0x, "m0x", Some(Torque), &["M0x"]),
    (Role::M0y, "m0y", Some(Torque), &["M0y"]),
    (Role::Fx, "fx", Some(Force), &["Fx", "FX", "F_x", "Force X", "force_x", "force.x", "wrench.force.x"]),
    (Role::Fy, "fy", Some(Force), &["Fy", "FY", "F_y", "Force Y", "force_y", "force.y", "wrench.force.y"]),
    (Role::Fz, "fz", Some(Force), &["Fz", "FZ", "F_z", "Force Z", "force_z", "force.z", "wrench.force.z"]),
    (
        Role::Tx,
        "tx",
        Some(Torque),
        &["Tx", "TX", "T_x", "Mx", "mx", "MX", "M_x", "Torque X", "torque_x", "torque.x", "wrench.torque.x"],
    ),
    (
        Role::Ty,
        "ty",
        Some(Torque),
        &["Ty", "TY", "T_y", "My", "my", "MY", "M_y", "Torque Y", "torque_y", "torque.y", "wrench.torque.y"],
    ),
    (
        Role::Tz,
        "tz",
        Some(Torque),
        &["Tz", "TZ", "T_z", "Mz", "mz", "MZ", "M_z", "Torque Z", "torque_z", "torque.z", "wrench.torque.z"],
    ),
];

impl Role {
    pub(super) const COUNT: usize = 29;

    /// All of them.
    pub fn all() -> impl Iterator<Item = Self> {
        ROLES.iter().map(|line| line.0)
    }

    /// Its own name, which stands for SI units.
    pub fn name(self) -> &'static str {
        ROLES[self as usize].1
    }

    /// The role of this name.
    ///
    /// ```
    /// use rod_hw::recording::Role;
    /// assert_eq!((Role::of_name("m0z"), Role::of_name("moment")), (Some(Role::M0z), None));
    /// ```
    pub fn of_name(name: &str) -> Option<Self> {
        ROLES.iter().find(|line| line.1 == name).map(|line| line.0)
    }

    /// Its dimension; `None` for numbers and flags.
    pub fn dimension(self) -> Option<Dimension> {
        ROLES[self as usize].2
    }

    /// Other names, which need a unit.
    pub(super) fn aliases(self) -> &'static [&'static str] {
        ROLES[self as usize].3
    }

    /// Whether negative values are invalid.
    pub(super) fn is_spread(self) -> bool {
        self.name().starts_with("sigma_") || self.name().starts_with("systematic_")
    }
}

impl fmt::Display for Role {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// The unit of a dimension in SI, as it is written.
pub(super) fn si(dimension: Dimension) -> &'static str {
    match dimension {
        Force => "N",
        Torque => "N m",
        Length => "m",
        Angle => "rad",
        Time => "s",
        Temperature => "degC",
        Dimension::Stress => "Pa",
        Dimension::Curvature => "1/m",
        Dimension::BendingStiffness => "N m^2",
        Dimension::Stiffness => "N/m",
        Dimension::RotationalStiffness => "N m/rad",
    }
}

/// Both names that a heading is made of, if it is made of two that are known: `FzTx`.
pub(super) fn parted(heading: &str) -> Option<(&str, &str)> {
    let known = |name: &str| ROLES.iter().any(|line| line.1 == name || line.3.contains(&name));
    let cuts = heading.char_indices().skip(1).map(|(at, _)| heading.split_at(at));
    let mut both = cuts.map(|(a, b)| (a.trim(), b.trim())).filter(|(a, b)| known(a) && known(b));
    both.next()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_told_apart() {
        let mut all: Vec<&str> = ROLES.iter().flat_map(|line| line.3.iter().copied().chain([line.1])).collect();
        let count = all.len();
        all.sort_unstable();
        all.dedup();
        assert_eq!(all.len(), count);
        for (i, line) in ROLES.iter().enumerate() {
            assert_eq!(line.0 as usize, i);
        }
        assert_eq!(parted("FzTx"), Some(("Fz", "Tx")));
        assert_eq!(parted("x0y0"), Some(("x0", "y0")));
        assert_eq!(parted("Force"), None);
        assert!(Role::SigmaM0z.is_spread() && !Role::Sequence.is_spread() && Role::SystematicF0x.is_spread());
    }
}
