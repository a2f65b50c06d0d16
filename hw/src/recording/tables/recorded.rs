//! Samples as rows: which columns they have, and there and back.

use super::columns::Columns;
use super::fault::RowProblem;
use super::recorder::Contents;
use super::role::Role;
use super::table::Row;
use crate::sample::{OutOfPlane, Quality, RawSample, ReactionSample, Wrench, WrenchSample};
use rod_core::{Pose, Reactions, Sample};

/// A sample that tables are read into and recorders write: [`RawSample`], [`WrenchSample`], [`ReactionSample`].
///
/// Needed of a row are, besides a time: of a raw sample its channels, of a wrench all six components, of reactions x0, y0, phi0,
/// f0x, f0y, m0z. Whatever else a table has of a sample is read, too.
pub trait Recorded: Sized + sealed::Sealed {
    /// Columns that must be there.
    const NEEDED: &'static [Role];
    /// Whether the raw values must be there.
    const CHANNELS: bool = false;

    /// From a row.
    ///
    /// # Errors
    /// [`RowProblem`].
    fn from_row(row: &Row<'_>, columns: &Columns) -> Result<Self, RowProblem>;

    /// Time, s.
    fn time(&self) -> f64;

    /// What is written, in order, the raw values aside; of everything, what is read where it is there.
    fn roles(contents: &Contents) -> Vec<Role>;

    /// A number in SI units, where it is known.
    fn value(&self, role: Role) -> Option<f64>;

    /// Flags.
    fn quality(&self) -> Quality;

    /// What the device said.
    fn raw(&self) -> &RawSample;
}

mod sealed {
    pub trait Sealed {}
    impl Sealed for crate::sample::RawSample {}
    impl Sealed for crate::sample::WrenchSample {}
    impl Sealed for crate::sample::ReactionSample {}
}

/// Of a raw sample, the channels aside.
const RAW: [Role; 6] =
    [Role::HostTime, Role::DeviceTime, Role::Sequence, Role::Status, Role::Temperature, Role::RawQuality];
const REACTIONS: [Role; 7] = [Role::Time, Role::X0, Role::Y0, Role::Phi0, Role::F0x, Role::F0y, Role::M0z];
const SIGMA: [Role; 3] = [Role::SigmaF0x, Role::SigmaF0y, Role::SigmaM0z];
const SYSTEMATIC: [Role; 3] = [Role::SystematicF0x, Role::SystematicF0y, Role::SystematicM0z];
const ACROSS: [Role; 3] = [Role::F0z, Role::M0x, Role::M0y];

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

fn of_raw(raw: &RawSample, role: Role) -> Option<f64> {
    match role {
        Role::HostTime => Some(raw.host_time),
        Role::DeviceTime => raw.device_time,
        Role::Sequence => raw.sequence.map(|n| n as f64),
        Role::Status => Some(f64::from(raw.status)),
        Role::Temperature => raw.temperature,
        _ => None,
    }
}

impl Recorded for RawSample {
    const NEEDED: &'static [Role] = &[];
    const CHANNELS: bool = true;

    fn from_row(row: &Row<'_>, columns: &Columns) -> Result<Self, RowProblem> {
        let quality = columns.quality(row, Role::Quality)?;
        raw(row, columns, columns.value(row, Role::Time)?, quality)
    }

    fn time(&self) -> f64 {
        Self::time(self)
    }

    fn roles(_: &Contents) -> Vec<Role> {
        [Role::HostTime, Role::DeviceTime, Role::Sequence, Role::Status, Role::Temperature, Role::Quality].to_vec()
    }

    fn value(&self, role: Role) -> Option<f64> {
        of_raw(self, role)
    }

    fn quality(&self) -> Quality {
        self.quality
    }

    fn raw(&self) -> &RawSample {
        self
    }
}

impl Recorded for WrenchSample {
    const NEEDED: &'static [Role] = &[Role::Time, Role::Fx, Role::Fy, Role::Fz, Role::Tx, Role::Ty, Role::Tz];

    fn from_row(row: &Row<'_>, columns: &Columns) -> Result<Self, RowProblem> {
        let t = columns.needed(row, Role::Time)?;
        let quality = columns.quality(row, Role::Quality)?;
        let mut wrench = [0.0; 6];
        for (value, role) in wrench.iter_mut().zip(Role::WRENCH) {
            *value = columns.needed(row, role)?;
        }
        Ok(Self {
            t,
            wrench: Wrench::from_components(wrench),
            sigma: columns.all(row, Role::SIGMAS)?.map(Wrench::from_components),
            systematic: columns.all(row, Role::SYSTEMATICS)?.map(Wrench::from_components),
            quality,
            raw: raw(row, columns, Some(t), quality)?,
        })
    }

    fn time(&self) -> f64 {
        self.t
    }

    fn roles(contents: &Contents) -> Vec<Role> {
        let mut roles = vec![Role::Time];
        roles.extend(Role::WRENCH);
        roles.extend(contents.sigma.then_some(Role::SIGMAS).into_iter().flatten());
        roles.extend(contents.systematic.then_some(Role::SYSTEMATICS).into_iter().flatten());
        roles.push(Role::Quality);
        roles.extend(contents.raw.is_some().then_some(RAW).into_iter().flatten());
        roles
    }

    fn value(&self, role: Role) -> Option<f64> {
        let of = |roles: [Role; 6], wrench: Option<Wrench>| {
            let at = roles.iter().position(|known| *known == role)?;
            wrench?.components().get(at).copied()
        };
        let own = of(Role::WRENCH, Some(self.wrench)).or_else(|| of(Role::SIGMAS, self.sigma));
        let own = own.or_else(|| of(Role::SYSTEMATICS, self.systematic));
        own.or_else(|| if role == Role::Time { Some(self.t) } else { of_raw(&self.raw, role) })
    }

    fn quality(&self) -> Quality {
        self.quality
    }

    fn raw(&self) -> &RawSample {
        &self.raw
    }
}

impl Recorded for ReactionSample {
    const NEEDED: &'static [Role] = &REACTIONS;

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

    fn roles(contents: &Contents) -> Vec<Role> {
        let mut roles = REACTIONS.to_vec();
        roles.extend(contents.sigma.then_some(SIGMA).into_iter().flatten());
        roles.extend(contents.systematic.then_some(SYSTEMATIC).into_iter().flatten());
        roles.extend(contents.out_of_plane.then_some(ACROSS).into_iter().flatten());
        roles.push(Role::Quality);
        roles.extend(contents.raw.is_some().then_some(RAW).into_iter().flatten());
        roles
    }

    fn value(&self, role: Role) -> Option<f64> {
        let Sample { pose: Pose { x, y, phi }, reactions: Reactions { f0x, f0y, m0z }, .. } = self.sample();
        let OutOfPlane { f0z, m0x, m0y } = self.out_of_plane;
        match role {
            Role::Time => Some(self.t),
            Role::X0 => Some(x),
            Role::Y0 => Some(y),
            Role::Phi0 => Some(phi),
            Role::F0x => Some(f0x),
            Role::F0y => Some(f0y),
            Role::M0z => Some(m0z),
            Role::SigmaF0x => self.sigma.map(|sigma| sigma.f0x),
            Role::SigmaF0y => self.sigma.map(|sigma| sigma.f0y),
            Role::SigmaM0z => self.sigma.map(|sigma| sigma.m0z),
            Role::SystematicF0x => self.systematic.map(|bound| bound.f0x),
            Role::SystematicF0y => self.systematic.map(|bound| bound.f0y),
            Role::SystematicM0z => self.systematic.map(|bound| bound.m0z),
            Role::F0z => Some(f0z),
            Role::M0x => Some(m0x),
            Role::M0y => Some(m0y),
            _ => of_raw(&self.raw, role),
        }
    }

    fn quality(&self) -> Quality {
        self.quality
    }

    fn raw(&self) -> &RawSample {
        &self.raw
    }
}
