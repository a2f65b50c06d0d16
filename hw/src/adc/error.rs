//! Why there is no conversion.

/// Why there is no conversion, or no chip. `E` is what the bus says.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum AdcError<E> {
    /// The bus, or a pin, fails.
    #[error("the bus of the converter fails ({0:?}); check its wiring, power and address")]
    Bus(E),
    /// Nothing was ready in time.
    #[error(
        "the converter was not ready within {waited:.3} s; check its power, its clock and the deadline against its rate"
    )]
    NotReady {
        /// How long, s.
        waited: f64,
    },
    /// Something else answers.
    #[error(
        "the converter says it is {found:#06x}, expected {expected:#06x}; check wiring, SPI mode and which chip it is"
    )]
    WrongId {
        /// What it says.
        found: u16,
        /// What the chip says.
        expected: u16,
    },
    /// A register is not what was written to it: the chip did not take it, or has lost it since.
    #[error(
        "register {address:#04x} of the converter is {read:#06x}, expected {written:#06x} as written; check power and wiring, start it again"
    )]
    Register {
        /// Which one.
        address: u8,
        /// What was written.
        written: u16,
        /// What it is.
        read: u16,
    },
    /// A frame came damaged.
    #[error(
        "a frame of the converter with checksum {found:#06x}, expected {expected:#06x}; check cable and clock rate"
    )]
    Checksum {
        /// What the frame says.
        found: u16,
        /// What its bytes give.
        expected: u16,
    },
    /// The chip could not calibrate itself.
    #[error(
        "the converter could not calibrate itself (control register {status:#04x}); check that its input is within its range"
    )]
    Calibration {
        /// The register that says so.
        status: u8,
    },
    /// The data line is low after a conversion was read, where the chip holds it high.
    #[error("the data line of the converter stays low after a conversion; is it connected, and the clock line?")]
    StuckLine,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn say_what_was_found_and_what_to_do() {
        type Error = AdcError<embedded_hal::i2c::ErrorKind>;
        for (error, message) in [
            (Error::NotReady { waited: 0.5 }, "not ready within 0.500 s; check its power, its clock"),
            (Error::WrongId { found: 0xFF28, expected: 0xFF24 }, "says it is 0xff28, expected 0xff24; check wiring"),
            (
                Error::Register { address: 4, written: 0x7610, read: 0 },
                "0x04 of the converter is 0x0000, expected 0x7610",
            ),
            (Error::Bus(embedded_hal::i2c::ErrorKind::ArbitrationLoss), "fails (ArbitrationLoss); check its wiring"),
        ] {
            assert!(error.to_string().contains(message), "{error}");
        }
    }
}
