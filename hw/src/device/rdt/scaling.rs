//! The scale of the counts, from the sensor over TCP.

use crate::calibrate::{CalibrationDataError, Scale};
use crate::sample::{Dimension, Number, Unit};
use std::io::{Error, ErrorKind, Read, Write};
use std::net::{TcpStream, ToSocketAddrs};
use std::time::{Duration, Instant};

/// The scale of the counts, as the sensor reports it. It has no default: sensors differ, and so do the units that are set in
/// them.
///
/// ```
/// use rod_hw::device::rdt::RdtScaling;
/// let bytes = [
///     0x12, 0x34, 2, 4, 0, 0, 0x03, 0xe8, 0, 0, 0, 10, // N, N mm, 1000 and 10 counts
///     0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1,
/// ];
/// let scaling = RdtScaling::from_bytes(&bytes)?;
/// assert_eq!((scaling.force_unit.name, scaling.torque_unit.name), ("N", "N mm"));
/// assert_eq!((scaling.counts_per_force, scaling.counts_per_torque), (1000.0, 10.0));
/// assert_eq!(scaling.to_bytes(), bytes);
/// # Ok::<(), rod_hw::device::rdt::RdtError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RdtScaling {
    /// Unit of the forces.
    pub force_unit: Unit,
    /// Unit of the torques.
    pub torque_unit: Unit,
    /// Counts of one unit of force.
    pub counts_per_force: f64,
    /// Counts of one unit of torque.
    pub counts_per_torque: f64,
}

/// Why the scaling is not known.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RdtError {
    /// No connection.
    #[error(
        "no TCP connection to `{host}` ({cause}), expected host:port like `192.168.1.1:49151`; is the device on, its address \
         right?"
    )]
    Connect {
        /// The requested address.
        host: String,
        /// The reason.
        cause: Error,
    },
    /// The answer did not come, or ended early.
    #[error("{found} of 24 bytes with the scaling came from `{host}` ({cause}); is this port the one for TCP (49151)?")]
    Answer {
        /// The host that was asked.
        host: String,
        /// How many bytes came.
        found: usize,
        /// Why no more bytes arrived.
        cause: Error,
    },
    /// The answer is not a scaling.
    #[error(
        "the scaling has {length} bytes and begins with {header:#06x}, expected 24 and 0x1234; is this the right port?"
    )]
    Header {
        /// Its first two bytes, or 0 if there are none.
        header: u16,
        /// How many bytes it has.
        length: usize,
    },
    /// No unit is set.
    #[error("the sensor sends counts without a unit of {dimension} (code 0); set N and N m on its web page")]
    NoUnit {
        /// The quantity, force or torque.
        dimension: Dimension,
    },
    /// A unit of unknown code.
    #[error(
        "unit of {dimension} with code {code}, expected 1 to 6 (force: lbf, N, klbf, kN, kgf, gf; torque: lbf in, lbf ft, N m, \
         N mm, kgf cm, kN m)"
    )]
    UnitCode {
        /// The quantity, force or torque.
        dimension: Dimension,
        /// Its code.
        code: u8,
    },
    /// Counts per unit that cannot be.
    #[error("{counts} counts per unit of {dimension}, expected more than 0; set the scaling on the sensor's web page")]
    Counts {
        /// The quantity, force or torque.
        dimension: Dimension,
        /// How many.
        counts: f64,
    },
}

const FORCE: [&str; 6] = ["lbf", "N", "klbf", "kN", "kgf", "gf"];
const TORQUE: [&str; 6] = ["lbf in", "lbf ft", "N m", "N mm", "kgf cm", "kN m"];

/// Factor of its 16-bit readings over TCP, which this crate does not use.
const READINGS: [[u8; 2]; 6] = [[0, 1]; 6];

/// How long the answer is.
const ANSWER: usize = 24;

impl RdtScaling {
    /// The scaling in the answer to the request for calibration info over TCP (command 1), 24 bytes.
    ///
    /// # Errors
    /// [`RdtError`].
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, RdtError> {
        let be = |at: usize, count: usize| {
            bytes.iter().skip(at).take(count).fold(0_u32, |word, byte| word << 8 | u32::from(*byte))
        };
        let (header, length) = (be(0, 2) as u16, bytes.len());
        if (header, length) != (0x1234, ANSWER) {
            return Err(RdtError::Header { header, length });
        }
        let unit = |at: usize, dimension, names: [&str; 6]| {
            let code = be(at, 1) as u8;
            if code == 0 {
                return Err(RdtError::NoUnit { dimension });
            }
            let name = names.get(usize::from(code) - 1);
            name.and_then(|name| Unit::find(name)).ok_or(RdtError::UnitCode { dimension, code })
        };
        let counts = |at: usize, dimension| match be(at, 4) {
            0 => Err(RdtError::Counts { dimension, counts: 0.0 }),
            counts => Ok(f64::from(counts)),
        };
        Ok(Self {
            force_unit: unit(2, Dimension::Force, FORCE)?,
            torque_unit: unit(3, Dimension::Torque, TORQUE)?,
            counts_per_force: counts(4, Dimension::Force)?,
            counts_per_torque: counts(8, Dimension::Torque)?,
        })
    }

    /// As a sensor answers. A unit that it does not know is sent as 0, counts as whole numbers.
    pub fn to_bytes(&self) -> [u8; ANSWER] {
        let code =
            |unit: Unit, names: [&str; 6]| (1..).zip(names).find(|(_, n)| *n == unit.name).map_or(0, |(code, _)| code);
        let mut bytes = [0; ANSWER];
        let head = [0x12, 0x34, code(self.force_unit, FORCE), code(self.torque_unit, TORQUE)];
        let counts = [self.counts_per_force, self.counts_per_torque].map(|counts| (counts as u32).to_be_bytes());
        let all = head.iter().chain(counts.as_flattened()).chain(READINGS.as_flattened());
        bytes.iter_mut().zip(all).for_each(|(byte, value)| *byte = *value);
        bytes
    }

    /// From the counts of the records to a wrench.
    ///
    /// ```
    /// use rod_fake_sensor::FakeRdtSettings;
    /// use rod_hw::{Calibration, Channels, RawSample, WrenchSample};
    /// let scaling = FakeRdtSettings::default().scaling; // of a sensor: read_scaling
    /// let raw = RawSample::new(0.0, Channels::from([250_000.0, 0.0, 0.0, 0.0, 0.0, -1000.0]));
    /// let sample: WrenchSample = scaling.calibration()?.wrench(&raw)?;
    /// assert_eq!((sample.wrench.force[0], sample.wrench.torque[2]), (0.25, -1e-3));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`CalibrationDataError`] where the fields were set to what is no scaling.
    pub fn calibration<T: Number>(&self) -> Result<Scale<T>, CalibrationDataError> {
        Scale::from_counts(self.counts_per_force, self.force_unit, self.counts_per_torque, self.torque_unit)
    }
}

/// Asks a sensor for its scaling over TCP, at `host:49151`, and waits for at most so long.
///
/// ```no_run
/// use std::time::Duration;
/// let scaling = rod_hw::device::rdt::read_scaling("192.168.1.1:49151", Duration::from_secs(2))?;
/// # Ok::<(), rod_hw::device::rdt::RdtError>(())
/// ```
///
/// # Errors
/// [`RdtError`].
pub fn read_scaling(host: &str, wait: Duration) -> Result<RdtScaling, RdtError> {
    let since = Instant::now();
    let left = || match wait.saturating_sub(since.elapsed()) {
        Duration::ZERO => Err(Error::from(ErrorKind::TimedOut)),
        left => Ok(left),
    };
    let failed = |cause| RdtError::Connect { host: host.into(), cause };
    let mut stream = Err(ErrorKind::AddrNotAvailable.into());
    for address in host.to_socket_addrs().map_err(failed)? {
        stream = left().and_then(|left| TcpStream::connect_timeout(&address, left));
        if stream.is_ok() {
            break;
        }
    }
    let mut stream = stream.map_err(failed)?;
    let (mut bytes, mut found) = ([0; ANSWER], 0);
    let mut read = || -> Result<(), Error> {
        let mut request = [0; 20];
        request[0] = 1;
        stream.set_write_timeout(Some(left()?))?;
        stream.write_all(&request)?;
        while found < ANSWER {
            stream.set_read_timeout(Some(left()?))?;
            match stream.read(&mut bytes[found..]) {
                Ok(0) => return Err(ErrorKind::UnexpectedEof.into()),
                Ok(count) => found += count,
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) => return Err(error),
            }
        }
        Ok(())
    };
    read().map_err(|cause| RdtError::Answer { host: host.into(), found, cause })?;
    RdtScaling::from_bytes(&bytes)
}
