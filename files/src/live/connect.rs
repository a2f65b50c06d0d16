//! From an address to samples.

use super::address::SensorAddress;
use super::error::LiveError;
use super::feed::{Fed, Feed, Miss, Sensor};
use super::played;
use crate::{ReadOptions, SensorCalibration, Setup};
use std::error::Error as StdError;
use std::time::Duration;
use vibrissa::hw::device::rdt::{Rdt, RdtSettings, read_scaling};
use vibrissa::hw::{
    Clock, HostClock, Link, LinkCounters, LinkError, LinkSettings, Protocol, Scale, SerialPort, SerialProfile, Spawned,
    Transport, Udp, spawn,
};

/// Longest time that a sensor may take to answer with its scaling.
const PATIENCE: Duration = Duration::from_secs(3);
/// Most samples in the queue from the thread that reads the sensor: more than a second of the fastest sensors. When it is full, samples
/// are lost and counted.
const WAITING: usize = 16_384;

impl Sensor {
    /// Connects to a sensor, or opens a recording: TDMS and MCAP by the end of its name, anything else as a table, in the way
    /// that `how` says.
    ///
    /// # Errors
    /// [`LiveError`].
    pub fn open(address: &SensorAddress, setup: &Setup, how: &ReadOptions) -> Result<Self, LiveError> {
        let failed =
            |source: Box<dyn StdError + Send + Sync>| LiveError::Sensor { address: address.to_string(), source };
        match address {
            SensorAddress::Rdt { host, port, scaling } => {
                let place =
                    |port: u16| if host.contains(':') { format!("[{host}]:{port}") } else { format!("{host}:{port}") };
                let calibration = match &setup.calibration {
                    Some(calibration) => calibration.clone(),
                    None => {
                        let told = read_scaling(&place(*scaling), PATIENCE).map_err(|error| failed(Box::new(error)))?;
                        SensorCalibration::Scale(told.calibration().map_err(|error| failed(Box::new(error)))?)
                    }
                };
                let udp = Udp::connect(&place(*port)).map_err(|error| failed(Box::new(error)))?;
                let protocol = Rdt::new(RdtSettings { clock_rate: setup.rate, ..RdtSettings::new(setup.profile) });
                Ok(Self {
                    feed: open_link(udp, protocol).map_err(|error| failed(Box::new(error)))?,
                    calibration: Some(calibration),
                    name: address.to_string(),
                    epoch: None,
                })
            }
            SensorAddress::Serial { path, profile, baud } => {
                let profile = SerialProfile::parse(profile).map_err(|error| failed(Box::new(error)))?;
                let known = profile.scales().map(|factors| {
                    // one unit is so many N or N m: the inverse of counts per unit
                    Scale::from_counts_per_axis(factors.map(f64::recip), vibrissa::hw::WrenchUnits::SI)
                });
                let calibration = match (&setup.calibration, known) {
                    (Some(calibration), _) => calibration.clone(),
                    (None, Some(scale)) => SensorCalibration::Scale(scale.map_err(|error| failed(Box::new(error)))?),
                    (None, None) => return Err(LiveError::NoScale { address: address.to_string() }),
                };
                let port = SerialPort::open(&path.to_string_lossy(), baud.unwrap_or(profile.baud()))
                    .map_err(|error| failed(Box::new(error)))?;
                Ok(Self {
                    feed: open_link(port, profile.protocol()).map_err(|error| failed(Box::new(error)))?,
                    calibration: Some(calibration),
                    name: address.to_string(),
                    epoch: None,
                })
            }
            SensorAddress::File(file) => played::open(file, setup, how),
        }
    }
}

/// A link, read in a thread of its own.
struct Linked<E> {
    samples: Spawned<E>,
    clock: HostClock,
}

fn open_link<T, P>(transport: T, protocol: P) -> std::io::Result<Box<dyn Feed>>
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
