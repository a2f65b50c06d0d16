//! NAU7802: one bridge of two, over I2C.

use super::{Adc, AdcError, FULL_SCALE, Gain, counts, quality};
use crate::raw::{Channels, RawSample};
use embedded_hal::delay::DelayNs;
use embedded_hal::i2c::I2c;

/// Its address, always.
const ADDRESS: u8 = 0x2A;

// registers
const CONTROL: u8 = 0x00;
const CONTROL_1: u8 = 0x01;
const CONTROL_2: u8 = 0x02;
const RESULT: u8 = 0x12;
const CHOPPER: u8 = 0x15;
const POWER: u8 = 0x1C;
const REVISION: u8 = 0x1F;

// bits of the control register
const RESET: u8 = 1;
const DIGITAL_ON: u8 = 1 << 1;
const ANALOGUE_ON: u8 = 1 << 2;
const POWERED: u8 = 1 << 3;
const CONVERT: u8 = 1 << 4;
const READY: u8 = 1 << 5;
const OWN_SUPPLY: u8 = 1 << 7;
/// Those that stay as they were written.
const KEPT: u8 = RESET | DIGITAL_ON | ANALOGUE_ON | OWN_SUPPLY;

// bits of the second one
const CALIBRATE: u8 = 1 << 2;
const CALIBRATION_FAILED: u8 = 1 << 3;
const SECOND: u8 = 1 << 7;

/// The chopper's clock off, as the power-up sequence of the datasheet has it.
const CHOPPER_OFF: u8 = 0x30;
/// The capacitor at the second input steadies the amplifier of the first.
const CAPACITOR: u8 = 1 << 7;

/// The low half of the revision register.
const REVISION_CODE: u8 = 0x0F;

/// The digital part is up after some 0.2 ms, ms.
const WAKE: u32 = 100;
/// Supply and amplifier are steady after that, ms.
const SETTLE: u32 = 600;

/// Conversions a second.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Nau7802Rate {
    /// 10 Hz.
    #[default]
    Hz10 = 0,
    /// 20 Hz.
    Hz20 = 1,
    /// 40 Hz.
    Hz40 = 2,
    /// 80 Hz.
    Hz80 = 3,
    /// 320 Hz.
    Hz320 = 7,
}

/// Where the supply of the analogue part, and of a bridge that hangs on it, comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Nau7802Supply {
    /// The pin AVDD.
    External,
    /// The chip's own regulator, 4.5 V of it.
    Volts4_5,
    /// 4.2 V of it.
    Volts4_2,
    /// 3.9 V of it.
    Volts3_9,
    /// 3.6 V of it.
    Volts3_6,
    /// 3.3 V of it.
    Volts3_3,
    /// 3.0 V of it.
    Volts3_0,
    /// 2.7 V of it.
    Volts2_7,
    /// 2.4 V of it.
    Volts2_4,
}

impl Nau7802Supply {
    /// The regulator's number, where it is on.
    fn regulator(self) -> Option<u8> {
        (self as u8).checked_sub(1)
    }
}

/// What an [`Nau7802`] is set to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Nau7802Settings {
    /// Of the analogue part; the regulator needs 0.3 V more than it gives.
    pub supply: Nau7802Supply,
    /// Of the amplifier.
    pub gain: Gain,
    /// How often.
    pub rate: Nau7802Rate,
    /// The second input instead of the first.
    pub second: bool,
    /// Whether the board has the capacitor at the second input that steadies the amplifier, as breakout boards do.
    pub capacitor: bool,
}

impl Default for Nau7802Settings {
    /// 3.0 V of its own, gain 128, 80 Hz, the first input, with the capacitor.
    fn default() -> Self {
        Self {
            supply: Nau7802Supply::Volts3_0,
            gain: Gain::X128,
            rate: Nau7802Rate::Hz80,
            second: false,
            capacitor: true,
        }
    }
}

/// The converter NAU7802 of Nuvoton: one bridge of two, 10 to 320 Hz, 24 bits, over I2C.
///
/// Every register written is read back. A sample has counts of `reference` / gain / 2^24, the control register as status,
/// and is [`SATURATED`](crate::Quality::SATURATED) at the ends of the range. A chip that lost its supply for a moment is an
/// [`AdcError::Register`]; start it again.
///
/// All these chips have the same address: several of them ([`Side`](super::Side)) need a bus each, or a multiplexer.
///
/// Registers as in Nuvoton's datasheet, as far as it was at hand, and in the drivers of SparkFun and Adafruit. These differ on when
/// a calibration has ended: it is taken to have when its bit is 0. No chip was at hand.
///
/// ```
/// use embedded_hal::{delay::DelayNs, i2c::I2c};
/// use rod_hw::adc::{AdcError, AdcSource, Nau7802, Nau7802Settings, Polling};
/// use rod_hw::{Clock, RawSource};
///
/// fn bridge<B: I2c>(
///     bus: B,
///     delay: &mut impl DelayNs,
///     clock: impl Clock,
/// ) -> Result<impl RawSource<Error = AdcError<B::Error>>, AdcError<B::Error>> {
///     let mut chip = Nau7802::start(bus, Nau7802Settings::default(), delay)?;
///     chip.calibrate(delay, 1000)?;
///     Ok(AdcSource::new(chip, clock, Polling { deadline: 0.2, pause: 1e-3 }))
/// }
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Nau7802<B> {
    bus: B,
    settings: Nau7802Settings,
}

impl<B: I2c> Nau7802<B> {
    /// Resets the chip, sets it up and lets it convert, which takes 0.6 s. Calibrate it then.
    ///
    /// # Errors
    /// [`AdcError::NotReady`], [`AdcError::WrongId`], [`AdcError::Register`], [`AdcError::Bus`].
    pub fn start(bus: B, settings: Nau7802Settings, delay: &mut impl DelayNs) -> Result<Self, AdcError<B::Error>> {
        let mut chip = Self { bus, settings };
        chip.write(CONTROL, RESET)?;
        delay.delay_ms(1);
        chip.write(CONTROL, DIGITAL_ON)?;
        chip.wait(delay, WAKE, CONTROL, |control| control & POWERED != 0)?;
        let revision = chip.read(REVISION)?;
        if revision & REVISION_CODE != REVISION_CODE {
            return Err(AdcError::WrongId { found: u16::from(revision), expected: u16::from(REVISION_CODE) });
        }
        let regulator = settings.supply.regulator();
        chip.set(CONTROL, KEPT, chip.control())?;
        chip.set(CONTROL_1, 0xFF, regulator.unwrap_or(0) << 3 | settings.gain as u8)?;
        chip.set(CONTROL_2, !CALIBRATION_FAILED, chip.control_2())?;
        chip.set(CHOPPER, CHOPPER_OFF, CHOPPER_OFF)?;
        let power = chip.read(POWER)?;
        let capacitor = if settings.capacitor { CAPACITOR } else { 0 };
        chip.set(POWER, CAPACITOR, power & !CAPACITOR | capacitor)?;
        delay.delay_ms(SETTLE);
        chip.set(CONTROL, KEPT, chip.control() | CONVERT)?;
        Ok(chip)
    }

    /// Lets the chip find its own offset, within so many ms; it takes some 0.35 s. Once after the start, and when it has become
    /// warmer.
    ///
    /// # Errors
    /// [`AdcError::NotReady`], [`AdcError::Calibration`], [`AdcError::Bus`].
    pub fn calibrate(&mut self, delay: &mut impl DelayNs, deadline: u32) -> Result<(), AdcError<B::Error>> {
        self.write(CONTROL_2, self.control_2() | CALIBRATE)?;
        let status = self.wait(delay, deadline, CONTROL_2, |control| control & CALIBRATE == 0)?;
        if status & CALIBRATION_FAILED == 0 { Ok(()) } else { Err(AdcError::Calibration { status }) }
    }

    /// One count, V, at a reference of `reference`, V, which mostly is the supply of the bridge.
    pub fn volts_per_count(&self, reference: f64) -> f64 {
        reference / (2.0 * self.settings.gain.factor() * FULL_SCALE)
    }

    /// The bus again.
    pub fn release(self) -> B {
        self.bus
    }

    fn control(&self) -> u8 {
        let supply = if self.settings.supply.regulator().is_some() { OWN_SUPPLY } else { 0 };
        DIGITAL_ON | ANALOGUE_ON | supply
    }

    fn control_2(&self) -> u8 {
        (self.settings.rate as u8) << 4 | if self.settings.second { SECOND } else { 0 }
    }

    /// Looks at a register every ms until it is as it should be.
    fn wait(
        &mut self,
        delay: &mut impl DelayNs,
        most: u32,
        register: u8,
        done: impl Fn(u8) -> bool,
    ) -> Result<u8, AdcError<B::Error>> {
        for _ in 0..most {
            let value = self.read(register)?;
            if done(value) {
                return Ok(value);
            }
            delay.delay_ms(1);
        }
        Err(AdcError::NotReady { waited: 1e-3 * f64::from(most) })
    }

    /// Writes a register and reads back the bits of the mask.
    fn set(&mut self, address: u8, mask: u8, value: u8) -> Result<(), AdcError<B::Error>> {
        self.write(address, value)?;
        let read = self.read(address)?;
        Self::compare(address, mask, value, read)
    }

    fn compare(address: u8, mask: u8, written: u8, read: u8) -> Result<(), AdcError<B::Error>> {
        if read & mask == written & mask {
            Ok(())
        } else {
            Err(AdcError::Register { address, written: u16::from(written), read: u16::from(read) })
        }
    }

    fn read(&mut self, register: u8) -> Result<u8, AdcError<B::Error>> {
        let mut value = [0];
        self.bus.write_read(ADDRESS, &[register], &mut value).map_err(AdcError::Bus)?;
        let [value] = value;
        Ok(value)
    }

    fn write(&mut self, register: u8, value: u8) -> Result<(), AdcError<B::Error>> {
        self.bus.write(ADDRESS, &[register, value]).map_err(AdcError::Bus)
    }
}

impl<B: I2c> Adc for Nau7802<B> {
    type Bus = B::Error;
    const CHANNELS: usize = 1;

    fn poll(&mut self, now: f64) -> Result<Option<RawSample>, AdcError<B::Error>> {
        let control = self.read(CONTROL)?;
        Self::compare(CONTROL, KEPT, self.control(), control)?;
        if control & READY == 0 {
            return Ok(None);
        }
        let mut result = [0; 3];
        self.bus.write_read(ADDRESS, &[RESULT], &mut result).map_err(AdcError::Bus)?;
        let counts = counts(result);
        let sample = RawSample::new(now, Channels::from([f64::from(counts)]));
        Ok(Some(RawSample { status: u32::from(control), quality: quality(counts), ..sample }))
    }
}

#[cfg(test)]
mod tests;
