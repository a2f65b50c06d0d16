//! ADS131M04: four channels at once, over SPI.

use super::{Adc, AdcError, FULL_SCALE, Gain, counts, quality};
use crate::quality::Quality;
use crate::raw::{Channels, RawSample};
use crc::{CRC_16_IBM_3740, Crc};
use embedded_hal::delay::DelayNs;
use embedded_hal::spi::SpiDevice;

/// Six words of 24 bits: response, four channels, checksum.
const FRAME: usize = 18;

// commands (datasheet, table "Command Definitions")
const NULL: u16 = 0x0000;
const RESET: u16 = 0x0011;
const UNLOCK: u16 = 0x0655;
const READ: u16 = 0xA000;
const WRITE: u16 = 0x6000;
/// The answer to a reset, with the number of channels.
const IS_RESET: u16 = 0xFF24;

// registers
const ID: u8 = 0x00;
const MODE: u8 = 0x02;
const CLOCK: u8 = 0x03;
const GAIN1: u8 = 0x04;

/// The channels in the high byte of the ID; the low byte is the revision.
const FOUR_CHANNELS: u16 = 0x2400;
/// As after a reset (words of 24 bits, CCITT checksum, time-out), with the flag of the reset taken back, so that another one
/// shows.
const NO_RESET: u16 = 0x0110;
/// All channels on, high resolution.
const ALL_CHANNELS: u16 = 0x0F02;

// the status word
const STATUS_RESYNC: u16 = 1 << 14;
const STATUS_REGISTERS_CHANGED: u16 = 1 << 13;
const STATUS_RESET: u16 = 1 << 10;
const STATUS_ALL_READY: u16 = 0x000F;

/// The checksum that is called CCITT in the datasheet: polynomial 0x1021 from 0xFFFF.
const CHECKSUM: Crc<u16> = Crc::<u16>::new(&CRC_16_IBM_3740);

/// How many values of the modulator make one of the output; with the usual 8.192 MHz that is 4.096 MHz divided by it, 32 kHz to
/// 250 Hz.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Oversampling {
    /// 128: 32 kHz.
    X128 = 0,
    /// 256: 16 kHz.
    X256,
    /// 512: 8 kHz.
    X512,
    /// 1024: 4 kHz.
    #[default]
    X1024,
    /// 2048: 2 kHz.
    X2048,
    /// 4096: 1 kHz.
    X4096,
    /// 8192: 500 Hz.
    X8192,
    /// 16384: 250 Hz.
    X16384,
}

/// What an [`Ads131m04`] is set to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Ads131m04Settings {
    /// Of each channel.
    pub gains: [Gain; 4],
    /// And by that the rate.
    pub oversampling: Oversampling,
}

/// The converter ADS131M04 of Texas Instruments: four channels at once, 24 bits, over SPI (mode 1, 8-bit words, up to 25 MHz).
///
/// Every frame's checksum and every register written are checked. A sample has counts of 1.2 V / gain / 2^23, the status word,
/// and is [`Quality::SATURATED`] at the ends of the range. A chip that was reset behind the driver's back, by its supply, say,
/// has forgotten its gains: such samples are [`Quality::DEVICE_ERROR`] and [`Quality::RESTARTED`]; start it again.
///
/// The chip keeps two conversions: after a pause in reading, the first two samples may be old. It counts none, so that ones
/// missed do not show: read as fast as it converts, by its DRDY line for instance.
///
/// Source: datasheet SBAS890, sections on the interface, the commands, the registers.
///
/// ```
/// use embedded_hal::{delay::DelayNs, spi::SpiDevice};
/// use rod_hw::adc::{AdcError, AdcSource, Ads131m04, Ads131m04Settings, Gain, Oversampling, Polling};
/// use rod_hw::{Clock, RawSource};
///
/// /// All four bridges at 1 kHz.
/// fn bridges<S: SpiDevice>(
///     spi: S,
///     delay: &mut impl DelayNs,
///     clock: impl Clock,
/// ) -> Result<impl RawSource<Error = AdcError<S::Error>>, AdcError<S::Error>> {
///     let settings = Ads131m04Settings { gains: [Gain::X128; 4], oversampling: Oversampling::X4096 };
///     let chip = Ads131m04::start(spi, settings, delay)?;
///     Ok(AdcSource::new(chip, clock, Polling::default()))
/// }
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Ads131m04<S> {
    spi: S,
    settings: Ads131m04Settings,
    /// The next frame answers something else than a request for the status.
    answers: bool,
}

impl<S: SpiDevice> Ads131m04<S> {
    /// Resets the chip and sets it up. It needs its clock for that.
    ///
    /// # Errors
    /// [`AdcError::WrongId`] where something else answers or nothing, [`AdcError::Register`], [`AdcError::Checksum`],
    /// [`AdcError::Bus`].
    pub fn start(spi: S, settings: Ads131m04Settings, delay: &mut impl DelayNs) -> Result<Self, AdcError<S::Error>> {
        let mut chip = Self { spi, settings, answers: true };
        // a locked chip ignores the reset
        chip.transfer(&[UNLOCK])?;
        chip.transfer(&[RESET])?;
        // registers are there after 5 us
        delay.delay_us(10);
        let reset = word(&chip.transfer(&[NULL])?);
        if reset != IS_RESET {
            return Err(AdcError::WrongId { found: reset, expected: IS_RESET });
        }
        let id = chip.read_register(ID)?;
        if id & 0xFF00 != FOUR_CHANNELS {
            return Err(AdcError::WrongId { found: id, expected: FOUR_CHANNELS });
        }
        chip.write_register(MODE, NO_RESET)?;
        let gains = settings.gains.iter().rev().fold(0, |word, &gain| word << 4 | gain as u16);
        chip.write_register(GAIN1, gains)?;
        chip.write_register(CLOCK, ALL_CHANNELS | (settings.oversampling as u16) << 2)?;
        Ok(chip)
    }

    /// What a register holds.
    ///
    /// # Errors
    /// [`AdcError::Checksum`], [`AdcError::Bus`].
    pub fn read_register(&mut self, address: u8) -> Result<u16, AdcError<S::Error>> {
        self.command(&[READ | place(address)])
    }

    /// Writes a register and reads it back: offsets, phases, gains of single channels, as the datasheet has them.
    ///
    /// # Errors
    /// [`AdcError::Register`] where it holds something else then, [`AdcError::Checksum`], [`AdcError::Bus`].
    pub fn write_register(&mut self, address: u8, value: u16) -> Result<(), AdcError<S::Error>> {
        self.command(&[WRITE | place(address), value])?;
        let read = self.read_register(address)?;
        if read == value { Ok(()) } else { Err(AdcError::Register { address, written: value, read }) }
    }

    /// One count of each channel, V.
    pub fn volts_per_count(&self) -> [f64; 4] {
        self.settings.gains.map(|gain| 1.2 / gain.factor() / FULL_SCALE)
    }

    /// The bus again.
    pub fn release(self) -> S {
        self.spi
    }

    /// Sends a command and returns its response, which comes with the next frame.
    fn command(&mut self, words: &[u16]) -> Result<u16, AdcError<S::Error>> {
        self.answers = true;
        self.checked(words)?;
        let response = word(&self.checked(&[NULL])?);
        self.answers = false;
        Ok(response)
    }

    /// A frame whose checksum is right.
    fn checked(&mut self, words: &[u16]) -> Result<[u8; FRAME], AdcError<S::Error>> {
        let frame = self.transfer(words)?;
        let (content, checksum) = frame.split_at(FRAME - 3);
        let (found, expected) = (word(checksum), CHECKSUM.checksum(content));
        if found == expected { Ok(frame) } else { Err(AdcError::Checksum { found, expected }) }
    }

    fn transfer(&mut self, words: &[u16]) -> Result<[u8; FRAME], AdcError<S::Error>> {
        let (mut sent, mut came) = ([0; FRAME], [0; FRAME]);
        for (place, word) in sent.chunks_exact_mut(3).zip(words) {
            let [high, low] = word.to_be_bytes();
            place.copy_from_slice(&[high, low, 0]);
        }
        self.spi.transfer(&mut came, &sent).map_err(AdcError::Bus)?;
        Ok(came)
    }
}

/// Where a register's address stands in a command.
fn place(address: u8) -> u16 {
    u16::from(address & 0x3F) << 7
}

/// The 16 bits that stand first in a word.
fn word(bytes: &[u8]) -> u16 {
    bytes.iter().take(2).fold(0, |word, &byte| word << 8 | u16::from(byte))
}

impl<S: SpiDevice> Adc for Ads131m04<S> {
    type Bus = S::Error;
    const CHANNELS: usize = 4;

    fn poll(&mut self, now: f64) -> Result<Option<RawSample>, AdcError<S::Error>> {
        if self.answers {
            // a command broke off, and its response, not the status, comes now
            self.transfer(&[NULL])?;
            self.answers = false;
        }
        let frame = self.checked(&[NULL])?;
        let status = word(&frame);
        if status & STATUS_ALL_READY != STATUS_ALL_READY {
            return Ok(None);
        }
        let mut sample = RawSample { status: u32::from(status), ..RawSample::new(now, Channels::default()) };
        let mut values = [0.0; 4];
        for (value, bytes) in values.iter_mut().zip(frame[3..].chunks_exact(3)) {
            if let &[high, middle, low] = bytes {
                let counts = counts([high, middle, low]);
                *value = f64::from(counts);
                sample.quality |= quality(counts);
            }
        }
        sample.channels = Channels::from(values);
        if status & STATUS_RESET != 0 {
            sample.quality |= Quality::DEVICE_ERROR | Quality::RESTARTED;
        }
        if status & (STATUS_RESYNC | STATUS_REGISTERS_CHANGED) != 0 {
            sample.quality |= Quality::DEVICE_WARNING;
        }
        Ok(Some(sample))
    }
}

#[cfg(test)]
mod tests;
