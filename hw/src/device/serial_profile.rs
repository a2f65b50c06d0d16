//! Framed sensors by name.

use crate::device::framed::{Bota, Framed, Gsv, OptoForce, Robotiq};
use crate::link::{Protocol, TransportError};

/// A framed sensor by name, set to what it needs no settings for.
///
/// ```
/// use rod_hw::{Protocol, SerialProfile};
/// let profile = SerialProfile::parse("bota")?;
/// assert_eq!((profile.name(), profile.baud()), ("bota", 460_800));
/// let mut protocol: Box<dyn Protocol> = profile.protocol();
/// assert_eq!(protocol.request(0.0), None); // it sends by itself
/// let wrong = SerialProfile::parse("botta").unwrap_err().to_string();
/// assert_eq!(wrong, "`botta` is not a known serial sensor, expected one of: gsv8, gsv6, bota, optoforce, robotiq");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum SerialProfile {
    /// ME-Messsysteme GSV-8: asked for f32, started.
    Gsv8,
    /// ME-Messsysteme GSV-6: the same.
    Gsv6,
    /// Bota Systems: as it sends by itself.
    Bota,
    /// OptoForce, OnRobot by USB: as it sends by itself.
    OptoForce,
    /// Robotiq FT 300: started.
    Robotiq,
}

impl SerialProfile {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::Gsv8, Self::Gsv6, Self::Bota, Self::OptoForce, Self::Robotiq];

    /// The one of this name.
    ///
    /// # Errors
    /// [`TransportError::Profile`], with the names that there are.
    pub fn parse(name: &str) -> Result<Self, TransportError> {
        let found = Self::ALL.into_iter().find(|profile| profile.name() == name);
        found.ok_or_else(|| TransportError::Profile {
            name: name.to_owned(),
            known: Self::ALL.map(Self::name).join(", "),
        })
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Gsv8 => "gsv8",
            Self::Gsv6 => "gsv6",
            Self::Bota => "bota",
            Self::OptoForce => "optoforce",
            Self::Robotiq => "robotiq",
        }
    }

    /// Bits a second that these devices are delivered with.
    pub fn baud(self) -> u32 {
        match self {
            Self::Gsv8 => 115_200,
            Self::Gsv6 => 230_400,
            Self::Bota => 460_800,
            Self::OptoForce => 1_000_000,
            Self::Robotiq => 19_200,
        }
    }

    /// One unit of each channel in N and N m, where that is the same for all devices of the kind: not for the GSV, which
    /// sends in the unit it is set to, nor for OptoForce, whose sensors differ.
    pub fn scales(self) -> Option<[f64; 6]> {
        match self {
            Self::Bota => Some([1.0; 6]),
            Self::Robotiq => Some(Robotiq::SCALES),
            _ => None,
        }
    }

    /// The protocol, for a [`Link`](crate::Link).
    pub fn protocol(self) -> Box<dyn Protocol + Send> {
        match self {
            Self::Gsv8 | Self::Gsv6 => Box::new(Framed::new(Gsv)),
            Self::Bota => Box::new(Framed::new(Bota)),
            Self::OptoForce => Box::new(Framed::new(OptoForce)),
            Self::Robotiq => Box::new(Framed::new(Robotiq)),
        }
    }
}
