//! From an address to samples.

use super::feed::{Fed, Feed, Miss};
use super::{LiveError, SensorAddress};
use crate::{Error, Setup};
use std::error::Error as StdError;
use std::path::Path;
use std::time::Duration;
use vibrissa::hw::rdt::{Rdt, RdtSettings, read_scaling};
use vibrissa::hw::recording::{ColumnMap, Table, TableOptions};
use vibrissa::hw::{
    Clock, HostClock, Link, LinkCounters, LinkError, LinkSettings, Protocol, RawSample, ReactionSample, Scale,
    SerialPort, SerialProfile, Spawned, Transport, Udp, WrenchSample, spawn,
};

/// How long a sensor may take to tell its scaling.
const PATIENCE: Duration = Duration::from_secs(3);
/// Samples that may wait while others are worked on: more than a second of the fastest sensors.
const WAITING: usize = 16_384;

/// A sensor that is connected.
pub struct Sensor {
    /// Its samples.
    pub feed: Box<dyn Feed>,
    /// What its numbers are in N and N m; none where they need no scale.
    pub scale: Option<Scale>,
    /// What it is, for the record.
    pub name: String,
}

impl Sensor {
    /// Connects to a sensor, or opens a recording.
    ///
    /// # Errors
    /// [`Error::Live`].
    pub fn open(address: &SensorAddress, setup: &Setup) -> Result<Self, Error> {
        let failed =
            |source: Box<dyn StdError + Send + Sync>| LiveError::Sensor { address: address.to_string(), source };
        match address {
            SensorAddress::Rdt { host, port, scaling } => {
                let place =
                    |port: u16| if host.contains(':') { format!("[{host}]:{port}") } else { format!("{host}:{port}") };
                let scale = match setup.scale {
                    Some(scale) => scale,
                    None => {
                        let told = read_scaling(&place(*scaling), PATIENCE).map_err(|error| failed(Box::new(error)))?;
                        told.calibration().map_err(|error| failed(Box::new(error)))?
                    }
                };
                let udp = Udp::connect(&place(*port)).map_err(|error| failed(Box::new(error)))?;
                let protocol = Rdt::new(RdtSettings { clock_rate: setup.rate, ..RdtSettings::new(setup.profile) });
                Ok(Self {
                    feed: linked(udp, protocol).map_err(|error| failed(Box::new(error)))?,
                    scale: Some(scale),
                    name: address.to_string(),
                })
            }
            SensorAddress::Serial { path, profile, baud } => {
                let profile = SerialProfile::parse(profile).map_err(|error| failed(Box::new(error)))?;
                let known = profile.scales().map(|factors| {
                    // one unit is so many N or N m: the inverse of counts per unit
                    Scale::from_counts_per_axis(factors.map(f64::recip), vibrissa::hw::WrenchUnits::SI)
                });
                let scale = match (setup.scale, known) {
                    (Some(scale), _) => scale,
                    (None, Some(scale)) => scale.map_err(|error| failed(Box::new(error)))?,
                    (None, None) => return Err(LiveError::NoScale { address: address.to_string() }.into()),
                };
                let port = SerialPort::open(&path.to_string_lossy(), baud.unwrap_or(profile.baud()))
                    .map_err(|error| failed(Box::new(error)))?;
                Ok(Self {
                    feed: linked(port, profile.protocol()).map_err(|error| failed(Box::new(error)))?,
                    scale: Some(scale),
                    name: address.to_string(),
                })
            }
            SensorAddress::File(file) => played(file, setup),
        }
    }
}

/// A link, read in a thread of its own.
struct Linked<E> {
    samples: Spawned<E>,
    clock: HostClock,
}

fn linked<T, P>(transport: T, protocol: P) -> std::io::Result<Box<dyn Feed>>
where
    T: Transport<Error: StdError + Send> + Send + 'static,
    P: Protocol + Send + 'static,
{
    let clock = HostClock::new();
    let samples = spawn(Link::new(transport, protocol, clock, LinkSettings::default()), WAITING)?;
    Ok(Box::new(Linked { samples, clock }))
}

impl<E: StdError> Feed for Linked<E> {
    fn next(&mut self) -> Option<Result<Fed, Miss>> {
        Some(match self.samples.next()? {
            Ok(raw) => Ok(Fed::Raw(raw)),
            Err(error @ LinkError::Timeout { .. }) => Err(Miss::Silence(error.to_string())),
            Err(error) => Err(Miss::Fault(error.to_string())),
        })
    }

    fn counters(&self) -> LinkCounters {
        self.samples.counters()
    }

    fn now(&self) -> Option<f64> {
        let mut clock = self.clock;
        Some(clock.now())
    }
}

/// A recording, played back as fast as it is asked for.
struct Played {
    samples: std::vec::IntoIter<Result<Fed, Miss>>,
    handed: u64,
}

/// The samples of a recording: reactions with poses, wrenches in units that the file tells, or raw values.
fn played(file: &Path, setup: &Setup) -> Result<Sensor, Error> {
    let table = Table::read(file, &TableOptions::default()).map_err(LiveError::Table)?;
    let map = ColumnMap::new();
    let fault = |error: vibrissa::hw::recording::RowFault| Miss::Fault(format!("{}: {error}", file.display()));
    let (samples, scale): (Vec<_>, _) = if let Ok(samples) = table.samples::<ReactionSample>(&map) {
        (samples.map(|row| row.map(Fed::Reactions).map_err(fault)).collect(), None)
    } else if let Ok(samples) = table.samples::<WrenchSample>(&map) {
        // in SI already, as the units of the columns say
        let raw = |sample: WrenchSample| RawSample {
            channels: sample.wrench.components().into(),
            host_time: sample.t,
            quality: sample.quality,
            ..sample.raw
        };
        (samples.map(|row| row.map(|sample| Fed::Raw(raw(sample))).map_err(fault)).collect(), Some(Scale::si()))
    } else {
        let samples = table.samples::<RawSample>(&map).map_err(LiveError::Columns)?;
        let scale = setup.scale.ok_or_else(|| LiveError::NoScale { address: format!("file:{}", file.display()) })?;
        (samples.map(|row| row.map(Fed::Raw).map_err(fault)).collect(), Some(scale))
    };
    let feed = Box::new(Played { samples: samples.into_iter(), handed: 0 });
    Ok(Sensor { feed, scale, name: format!("file:{}", file.display()) })
}

impl Feed for Played {
    fn next(&mut self) -> Option<Result<Fed, Miss>> {
        let next = self.samples.next()?;
        self.handed += u64::from(next.is_ok());
        Some(next)
    }

    fn counters(&self) -> LinkCounters {
        LinkCounters { samples: self.handed, ..LinkCounters::default() }
    }

    fn now(&self) -> Option<f64> {
        None
    }
}
