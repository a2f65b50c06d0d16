//! Quality flags of a sample.

bitflags::bitflags! {
    /// Quality flags of a sample; empty if it is good. Flags are added along the signal chain and never removed.
    ///
    /// ```
    /// use rod_hw::Quality;
    /// let quality = Quality::SATURATED | Quality::GAP_BEFORE;
    /// assert_eq!(quality.to_string(), "saturated, gap before");
    /// assert!(!quality.is_usable() && Quality::GAP_BEFORE.is_usable());
    /// ```
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
    pub struct Quality: u16 {
        /// A raw value at its rail, an overload bit of the device, or a component beyond the rated load.
        const SATURATED = 1;
        /// The device warns.
        const DEVICE_WARNING = 1 << 1;
        /// The device reports an error.
        const DEVICE_ERROR = 1 << 2;
        /// Samples before it are missing.
        const GAP_BEFORE = 1 << 3;
        /// The first sample after a restart of the device or the connection.
        const RESTARTED = 1 << 4;
        /// Interpolated, not measured.
        const INTERPOLATED = 1 << 5;
        /// An outlier among its neighbours.
        const SPIKE = 1 << 6;
        /// The tare is not that of this run of the device.
        const TARE_STALE = 1 << 7;
        /// The force or moments out of the plane of the rod are large.
        const OUT_OF_PLANE = 1 << 8;
    }
}

/// Names of the flags, in the order of their bits.
const NAMES: [&str; 9] = [
    "saturated",
    "device warning",
    "device error",
    "gap before",
    "restarted",
    "interpolated",
    "spike",
    "tare stale",
    "out of plane",
];

impl Quality {
    /// Whether the values can be used: not if the sensor was saturated or reported an error, and not of a spike.
    pub fn is_usable(self) -> bool {
        !self.intersects(Self::SATURATED | Self::DEVICE_ERROR | Self::SPIKE)
    }

    /// The flags of their names, with commas or bars between them, as they are displayed; `good` where there are none.
    ///
    /// ```
    /// use rod_hw::Quality;
    /// assert_eq!(Quality::parse("saturated | gap before"), Some(Quality::SATURATED | Quality::GAP_BEFORE));
    /// assert_eq!((Quality::parse("good"), Quality::parse("fine")), (Some(Quality::empty()), None));
    /// ```
    pub fn parse(text: &str) -> Option<Self> {
        if text.trim() == "good" {
            return Some(Self::empty());
        }
        text.split([',', '|']).map(str::trim).try_fold(Self::empty(), |flags, name| {
            let bit = NAMES.iter().position(|known| *known == name)?;
            Some(flags | Self::from_bits_truncate(1 << bit))
        })
    }

    /// The flags that are set, by name.
    pub fn names(self) -> impl Iterator<Item = &'static str> {
        NAMES.iter().enumerate().filter(move |(bit, _)| self.bits() >> bit & 1 == 1).map(|(_, name)| *name)
    }
}

impl core::fmt::Display for Quality {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        if self.is_empty() {
            return f.write_str("good");
        }
        for (i, name) in self.names().enumerate() {
            f.write_str(if i == 0 { "" } else { ", " })?;
            f.write_str(name)?;
        }
        Ok(())
    }
}
