//! Samples from rows.

use super::columns::Columns;
use super::fault::RowProblem;
use super::role::Role;
use super::table::Row;
use crate::sample::{OutOfPlane, Quality, RawSample, ReactionSample, Wrench, WrenchSample};
use rod_core::{Pose, Reactions};

/// A sample that tables are read into: [`RawSample`], [`WrenchSample`], [`ReactionSample`].
///
/// Needed of a row are, besides a time: of a raw sample its channels, of a wrench all six components, of reactions x0, y0, phi0,
/// f0x, f0y, m0z. Whatever else a table has of a sample is read, too.
pub trait Recorded: Sized + sealed::Sealed {
    /// Columns that must be there.
    const NEEDED: &'static [Role];
    /// Columns that are read where they are there.
    const WELCOME: &'static [&'static [Role]];
    /// Whether the raw values must be there.
    const CHANNELS: bool = false;

    /// From a row.
    ///
    /// # Errors
    /// [`RowProblem`].
    fn from_row(row: &Row<'_>, columns: &Columns) -> Result<Self, RowProblem>;

    /// Time, s.
    fn time(&self) -> f64;
}

mod sealed {
    pub trait Sealed {}
    impl Sealed for crate::sample::RawSample {}
    impl Sealed for crate::sample::WrenchSample {}
    impl Sealed for crate::sample::ReactionSample {}
}

/// Of the raw sample behind another one.
pub(super) const RAW: [Role; 6] =
    [Role::HostTime, Role::DeviceTime, Role::Sequence, Role::Status, Role::Temperature, Role::RawQuality];
const WRENCH: [Role; 6] = [Role::Fx, Role::Fy, Role::Fz, Role::Tx, Role::Ty, Role::Tz];
pub(super) const SIGMA: [Role; 3] = [Role::SigmaF0x, Role::SigmaF0y, Role::SigmaM0z];
pub(super) const SYSTEMATIC: [Role; 3] = [Role::SystematicF0x, Role::SystematicF0y, Role::SystematicM0z];
pub(super) const ACROSS: [Role; 3] = [Role::F0z, Role::M0x, Role::M0y];

/// The raw sample of a row; where its own time or quality are not there, those of the sample.
fn raw(row: &Row<'_>, columns: &Columns, t: Option<f64>, quality: Quality) -> Result<RawSample, RowProblem> {
    let device_time = columns.value(row, Role::DeviceTime)?;
    let host_time = match columns.value(row, Role::HostTime)?.or(t).or(device_time) {
        Some(time) => time,
        None => columns.needed(row, if columns.has(Role::HostTime) { Role::HostTime } else { Role::Time })?,
    };
    let own = if columns.has(Role::RawQuality) { columns.quality(row, Role::RawQuality)? } else { quality };
    Ok(RawSample {
        sequence: columns.count(row, Role::Sequence)?,
        device_time,
        host_time,
        status: columns.count(row, Role::Status)?.and_then(|status| u32::try_from(status).ok()).unwrap_or_default(),
        temperature: columns.value(row, Role::Temperature)?,
        channels: columns.channels(row)?,
        quality: own,
    })
}

impl Recorded for RawSample {
    const NEEDED: &'static [Role] = &[];
    const WELCOME: &'static [&'static [Role]] = &[&[
        Role::Time,
        Role::HostTime,
        Role::DeviceTime,
        Role::Sequence,
        Role::Status,
        Role::Temperature,
        Role::Quality,
    ]];
    const CHANNELS: bool = true;

    fn from_row(row: &Row<'_>, columns: &Columns) -> Result<Self, RowProblem> {
        let quality = columns.quality(row, Role::Quality)?;
        raw(row, columns, columns.value(row, Role::Time)?, quality)
    }

    fn time(&self) -> f64 {
        Self::time(self)
    }
}

impl Recorded for WrenchSample {
    const NEEDED: &'static [Role] = &[Role::Time, Role::Fx, Role::Fy, Role::Fz, Role::Tx, Role::Ty, Role::Tz];
    const WELCOME: &'static [&'static [Role]] = &[&[Role::Quality], &RAW];

    fn from_row(row: &Row<'_>, columns: &Columns) -> Result<Self, RowProblem> {
        let t = columns.needed(row, Role::Time)?;
        let quality = columns.quality(row, Role::Quality)?;
        let mut wrench = [0.0; 6];
        for (value, role) in wrench.iter_mut().zip(WRENCH) {
            *value = columns.needed(row, role)?;
        }
        let raw = raw(row, columns, Some(t), quality)?;
        Ok(Self { quality, raw, ..Self::new(t, Wrench::from_components(wrench)) })
    }

    fn time(&self) -> f64 {
        self.t
    }
}

impl Recorded for ReactionSample {
    const NEEDED: &'static [Role] = &[Role::Time, Role::X0, Role::Y0, Role::Phi0, Role::F0x, Role::F0y, Role::M0z];
    const WELCOME: &'static [&'static [Role]] = &[&SIGMA, &SYSTEMATIC, &ACROSS, &[Role::Quality], &RAW];

    fn from_row(row: &Row<'_>, columns: &Columns) -> Result<Self, RowProblem> {
        let need = |role| columns.needed(row, role);
        let reactions = |[f0x, f0y, m0z]: [f64; 3]| Reactions { f0x, f0y, m0z };
        let t = need(Role::Time)?;
        let quality = columns.quality(row, Role::Quality)?;
        let [f0z, m0x, m0y] = columns.all(row, ACROSS)?.unwrap_or_default();
        Ok(Self {
            t,
            pose: Pose { x: need(Role::X0)?, y: need(Role::Y0)?, phi: need(Role::Phi0)? },
            reactions: reactions([need(Role::F0x)?, need(Role::F0y)?, need(Role::M0z)?]),
            sigma: columns.all(row, SIGMA)?.map(reactions),
            systematic: columns.all(row, SYSTEMATIC)?.map(reactions),
            out_of_plane: OutOfPlane { f0z, m0x, m0y },
            quality,
            raw: raw(row, columns, Some(t), quality)?,
        })
    }

    fn time(&self) -> f64 {
        self.t
    }
}
