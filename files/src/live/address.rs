//! The address of a sensor.

use std::fmt;
use std::path::PathBuf;
use std::str::FromStr;

/// UDP port of RDT, and TCP port of the scaling (ATI Net F/T manual).
const RDT_PORT: u16 = 49_152;
const SCALING_PORT: u16 = 49_151;

/// The forms of an address, for messages.
const EXPECTED: &str = "rdt://HOST[:PORT][?scaling=PORT], serial:PATH:PROFILE[:BAUD] or file:RECORDING";

/// The address of a sensor: `rdt://HOST[:PORT][?scaling=PORT]`, `serial:PATH:PROFILE[:BAUD]` or `file:RECORDING`.
///
/// ```
/// use rod_files::SensorAddress;
/// let address: SensorAddress = "rdt://192.168.1.1".parse()?;
/// assert_eq!(address, SensorAddress::Rdt { host: "192.168.1.1".into(), port: 49152, scaling: 49151 });
/// let wrong = "udp://there".parse::<SensorAddress>().unwrap_err();
/// assert!(wrong.to_string().starts_with("`udp://there` is no address of a sensor, expected rdt://HOST"));
/// # Ok::<(), rod_files::AddressError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SensorAddress {
    /// A network sensor that speaks RDT over UDP.
    Rdt {
        /// Name or address.
        host: String,
        /// UDP port of the samples.
        port: u16,
        /// TCP port of the scaling.
        scaling: u16,
    },
    /// A serial port.
    Serial {
        /// The device.
        path: PathBuf,
        /// The name of its protocol.
        profile: String,
        /// Bits per second, if not those of the profile.
        baud: Option<u32>,
    },
    /// A recording, played back.
    File(PathBuf),
}

/// Why a text is not an address of a sensor.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum AddressError {
    /// Its form is unknown.
    #[error("`{text}` is no address of a sensor, expected {EXPECTED}")]
    Form {
        /// The text.
        text: String,
    },
    /// A number in it is not possible.
    #[error("{what} in `{text}` is `{found}`, expected a whole number from 1 to {most}")]
    Number {
        /// The text.
        text: String,
        /// Which number.
        what: &'static str,
        /// The text in its place.
        found: String,
        /// The largest one.
        most: u32,
    },
}

impl FromStr for SensorAddress {
    type Err = AddressError;

    fn from_str(text: &str) -> Result<Self, AddressError> {
        let form = || AddressError::Form { text: text.to_owned() };
        let number = |what: &'static str, found: &str, most: u32| match found.parse::<u32>() {
            Ok(number) if (1..=most).contains(&number) => Ok(number),
            _ => Err(AddressError::Number { text: text.to_owned(), what, found: found.to_owned(), most }),
        };
        let port = |what, found: &str| number(what, found, u32::from(u16::MAX)).map(|port| port as u16);
        if let Some(rest) = text.strip_prefix("rdt://") {
            let (place, query) = rest.trim_end_matches('/').split_once('?').unwrap_or((rest.trim_end_matches('/'), ""));
            let scaling = match query.strip_prefix("scaling=") {
                Some(found) => port("the scaling port", found)?,
                None if query.is_empty() => SCALING_PORT,
                None => return Err(form()),
            };
            // an IPv6 address stands in brackets, for its colons
            let (host, after) = match place.strip_prefix('[').and_then(|place| place.split_once(']')) {
                Some((host, after)) => (host, after.strip_prefix(':')),
                None => place.split_once(':').map_or((place, None), |(host, port)| (host, Some(port))),
            };
            if host.is_empty() {
                return Err(form());
            }
            let port = after.map_or(Ok(RDT_PORT), |found| port("the port", found))?;
            return Ok(Self::Rdt { host: host.to_owned(), port, scaling });
        }
        if let Some(rest) = text.strip_prefix("serial:") {
            // from the right: a path may have colons
            let (before, last) = rest.rsplit_once(':').ok_or_else(form)?;
            let (path, profile, baud) = match (before.rsplit_once(':'), last.starts_with(|c: char| c.is_ascii_digit()))
            {
                (Some((path, profile)), true) => (path, profile, Some(number("the baud rate", last, 100_000_000)?)),
                _ => (before, last, None),
            };
            if path.is_empty() || profile.is_empty() {
                return Err(form());
            }
            return Ok(Self::Serial { path: path.into(), profile: profile.to_owned(), baud });
        }
        match text.strip_prefix("file:") {
            Some(file) if !file.is_empty() => Ok(Self::File(file.into())),
            _ => Err(form()),
        }
    }
}

impl fmt::Display for SensorAddress {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Rdt { host, port, .. } if host.contains(':') => write!(f, "rdt://[{host}]:{port}"),
            Self::Rdt { host, port, .. } => write!(f, "rdt://{host}:{port}"),
            Self::Serial { path, profile, .. } => write!(f, "serial:{}:{profile}", path.display()),
            Self::File(file) => write!(f, "file:{}", file.display()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn forms() {
        let rdt = |host: &str, port, scaling| SensorAddress::Rdt { host: host.into(), port, scaling };
        let serial = |path: &str, baud| SensorAddress::Serial { path: path.into(), profile: "gsv8".into(), baud };
        for (text, address) in [
            ("rdt://sensor", rdt("sensor", 49_152, 49_151)),
            ("rdt://10.0.0.2:5000/", rdt("10.0.0.2", 5000, 49_151)),
            ("rdt://[::1]:5000?scaling=5001", rdt("::1", 5000, 5001)),
            ("rdt://[::1]", rdt("::1", 49_152, 49_151)),
            ("serial:/dev/ttyUSB0:gsv8", serial("/dev/ttyUSB0", None)),
            ("serial:COM3:gsv8:230400", serial("COM3", Some(230_400))),
            ("serial:/dev/serial/by-path/pci-0:14:gsv8", serial("/dev/serial/by-path/pci-0:14", None)),
            ("file:a:b.csv", SensorAddress::File("a:b.csv".into())),
        ] {
            assert_eq!(text.parse(), Ok(address), "{text}");
        }
        for (text, message) in [
            ("", "`` is no address of a sensor"),
            ("file:", "`file:` is no address"),
            ("rdt://", "`rdt://` is no address"),
            ("rdt://a?b=3", "`rdt://a?b=3` is no address"),
            ("serial:/dev/tty", "`serial:/dev/tty` is no address"),
            ("rdt://a:0", "the port in `rdt://a:0` is `0`, expected a whole number from 1 to 65535"),
            ("rdt://a:70000", "the port in `rdt://a:70000` is `70000`"),
            ("serial:a:b:9600bd", "the baud rate in `serial:a:b:9600bd` is `9600bd`"),
        ] {
            let error = text.parse::<SensorAddress>().unwrap_err().to_string();
            assert!(error.starts_with(message), "{error}");
        }
    }
}
