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
mod tests {
    use super::*;
    use embedded_hal::spi::{ErrorKind, ErrorType, Operation};
    use embedded_hal_mock::eh1::delay::NoopDelay;
    use embedded_hal_mock::eh1::spi::{Mock, Transaction};

    const SETTINGS: Ads131m04Settings =
        Ads131m04Settings { gains: [Gain::X1, Gain::X2, Gain::X64, Gain::X128], oversampling: Oversampling::X4096 };

    /// Bit by bit, as in the datasheet.
    fn checksum(bytes: &[u8]) -> u16 {
        bytes.iter().fold(0xFFFF, |sum, &byte| {
            (0..8)
                .fold(sum ^ u16::from(byte) << 8, |sum, _| if sum & 0x8000 == 0 { sum << 1 } else { sum << 1 ^ 0x1021 })
        })
    }

    /// What the chip sends: a response and four channels.
    fn frame(response: u16, channels: [u32; 4]) -> Vec<u8> {
        let mut bytes = [response.to_be_bytes().as_slice(), &[0]].concat();
        bytes.extend(channels.iter().flat_map(|channel| channel.to_be_bytes().into_iter().skip(1)));
        let sum = checksum(&bytes);
        bytes.extend(sum.to_be_bytes());
        bytes.push(0);
        bytes
    }

    /// A frame of commands for one of the chip.
    fn exchange(words: &[u16], came: Vec<u8>) -> [Transaction<u8>; 3] {
        let mut sent: Vec<u8> = words.iter().flat_map(|word| [word.to_be_bytes().as_slice(), &[0]].concat()).collect();
        sent.resize(FRAME, 0);
        [Transaction::transaction_start(), Transaction::transfer(sent, came), Transaction::transaction_end()]
    }

    fn answer(words: &[u16], response: u16) -> [Transaction<u8>; 3] {
        exchange(words, frame(response, [0; 4]))
    }

    /// Writing and reading back, in the literal words of the datasheet.
    fn written(write: u16, read: u16, value: u16, back: u16) -> Vec<Transaction<u8>> {
        [answer(&[write, value], 0x0500), answer(&[0], 0x4000), answer(&[read], 0x0500), answer(&[0], back)].concat()
    }

    fn started(id: u16) -> Vec<Transaction<u8>> {
        [
            // whatever was in its output before
            exchange(&[0x0655], vec![0xA5; FRAME]),
            exchange(&[0x0011], vec![0x5A; FRAME]),
            answer(&[0], 0xFF24),
            answer(&[0xA000], 0x0500),
            answer(&[0], id),
        ]
        .concat()
    }

    fn all(clock: u16) -> Vec<Transaction<u8>> {
        [
            started(0x2403),
            written(0x6100, 0xA100, 0x0110, 0x0110),
            written(0x6200, 0xA200, 0x7610, 0x7610),
            written(0x6180, 0xA180, clock, clock),
        ]
        .concat()
    }

    fn run<R>(script: Vec<Transaction<u8>>, test: impl FnOnce(Mock<u8>) -> R) -> R {
        let mut spi = Mock::new(&script);
        let result = test(spi.clone());
        spi.done();
        result
    }

    /// Fails once, after so many frames.
    struct Breaks(Mock<u8>, i32);

    impl ErrorType for Breaks {
        type Error = ErrorKind;
    }

    impl SpiDevice for Breaks {
        fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), ErrorKind> {
            self.1 -= 1;
            if self.1 == -1 { Err(ErrorKind::ModeFault) } else { self.0.transaction(operations) }
        }
    }

    #[test]
    fn a_frame_of_a_real_chip() {
        // sent by a locked chip after 0x8100, by a user of e2e.ti.com
        let bytes = [0x81, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xB4, 0x2D, 0];
        assert_eq!((checksum(&bytes[..15]), CHECKSUM.checksum(&bytes[..15])), (0xB42D, 0xB42D));
        assert_eq!(frame(0x8100, [0; 4]), bytes);
    }

    #[test]
    fn starts_and_converts() {
        let script = [
            all(0x0F16),
            exchange(&[0], frame(0x0107, [1, 2, 3, 4])).into(),
            exchange(&[0], frame(0x010F, [1, 0xFF_FFFF, 0x7F_FFFE, 0x80_0001])).into(),
        ]
        .concat();
        run(script, |spi| {
            let mut chip = Ads131m04::start(spi, SETTINGS, &mut NoopDelay::new()).unwrap();
            assert_eq!(chip.poll(0.1).unwrap(), None, "channel 3 is not ready");
            let sample = chip.poll(0.2).unwrap().unwrap();
            assert_eq!(*sample.channels, [1.0, -1.0, 8_388_606.0, -8_388_607.0]);
            assert_eq!((sample.host_time, sample.status, sample.quality), (0.2, 0x010F, Quality::empty()));
            assert_eq!(chip.volts_per_count()[3], 1.2 / 128.0 / 8_388_608.0);
        });
    }

    #[test]
    fn ends_of_the_range_and_flags() {
        let flagged = |status, channels| {
            run([all(0x0F16), exchange(&[0], frame(status, channels)).into()].concat(), |spi| {
                let mut chip = Ads131m04::start(spi, SETTINGS, &mut NoopDelay::new()).unwrap();
                chip.poll(0.0).unwrap().unwrap().quality
            })
        };
        assert_eq!(flagged(0x010F, [0, 0x7F_FFFF, 0, 0]), Quality::SATURATED);
        assert_eq!(flagged(0x010F, [0, 0, 0, 0x80_0000]), Quality::SATURATED);
        assert_eq!(flagged(0x050F, [0; 4]), Quality::DEVICE_ERROR | Quality::RESTARTED);
        assert_eq!(flagged(0x410F, [0; 4]), Quality::DEVICE_WARNING);
    }

    #[test]
    fn something_else_answers() {
        let found = |script| run(script, |spi| Ads131m04::start(spi, SETTINGS, &mut NoopDelay::new()).unwrap_err());
        // the one of eight channels, a two-channel one by its ID alone, nothing at all
        let start = [exchange(&[0x0655], vec![0; FRAME]), exchange(&[0x0011], vec![0; FRAME])].concat();
        let eight = [start.clone(), answer(&[0], 0xFF28).into()].concat();
        assert_eq!(found(eight), AdcError::WrongId { found: 0xFF28, expected: 0xFF24 });
        assert_eq!(found(started(0x2203)), AdcError::WrongId { found: 0x2203, expected: 0x2400 });
        let none = [start, exchange(&[0], vec![0xFF; FRAME]).into()].concat();
        assert_eq!(found(none), AdcError::WrongId { found: 0xFFFF, expected: 0xFF24 });
    }

    #[test]
    fn registers_are_read_back() {
        let script =
            [started(0x2403), written(0x6100, 0xA100, 0x0110, 0x0110), written(0x6200, 0xA200, 0x7610, 0x0000)]
                .concat();
        run(script, |spi| {
            let error = Ads131m04::start(spi, SETTINGS, &mut NoopDelay::new()).unwrap_err();
            assert_eq!(error, AdcError::Register { address: 4, written: 0x7610, read: 0 });
        });
    }

    #[test]
    fn damaged_frames() {
        let mut damaged = frame(0x010F, [1, 2, 3, 4]);
        let found = checksum(&damaged[..15]);
        damaged[7] ^= 0x10;
        let expected = checksum(&damaged[..15]);
        run([all(0x0F16), exchange(&[0], damaged).into(), answer(&[0], 0x010F).into()].concat(), |spi| {
            let mut chip = Ads131m04::start(spi, SETTINGS, &mut NoopDelay::new()).unwrap();
            assert_eq!(chip.poll(0.0), Err(AdcError::Checksum { found, expected }));
            assert!(chip.poll(0.0).unwrap().is_some());
        });
    }

    #[test]
    fn a_bus_that_breaks_between_command_and_response() {
        let script = [answer(&[0xA200], 0x0100), answer(&[0], 0x761F), answer(&[0], 0x0100)];
        let frames = all(0x0F16).len() as i32 / 3 + 1;
        run([all(0x0F16), script.concat()].concat(), |spi| {
            let mut chip = Ads131m04::start(Breaks(spi, frames), SETTINGS, &mut NoopDelay::new()).unwrap();
            assert_eq!(chip.read_register(GAIN1), Err(AdcError::Bus(ErrorKind::ModeFault)));
            assert_eq!(chip.poll(0.0), Ok(None), "the gains that come late are no status");
        });
    }

    /// The chip as the datasheet tells: commands, lock, registers, frames.
    struct Chip {
        registers: [u16; 64],
        locked: bool,
        response: u16,
    }

    impl Chip {
        fn new(locked: bool) -> Self {
            let mut chip = Self { registers: [0; 64], locked, response: 0x0500 };
            chip.reset();
            chip
        }

        fn reset(&mut self) {
            self.registers = [0; 64];
            for (register, value) in [(0, 0x2403), (1, 0x0500), (2, 0x0510), (3, 0x0F0E)] {
                self.registers[register] = value;
            }
        }

        fn obey(&mut self, command: u16, data: u16) {
            let address = usize::from(command >> 7 & 0x3F);
            self.response = match (command, command >> 13) {
                (0x0655, _) => {
                    self.locked = false;
                    0x0655
                }
                (_, 0b101) => self.registers[address],
                (0x0011, _) if !self.locked => {
                    self.reset();
                    0xFF24
                }
                (_, 0b011) if !self.locked => {
                    self.registers[address] = data;
                    0x4000 | command & 0x1FFF
                }
                // the status: lock, what the mode register says of reset and word length, all channels ready
                _ => u16::from(self.locked) << 15 | self.registers[2] & 0x0700 | 0x000F,
            };
        }
    }

    impl ErrorType for Chip {
        type Error = ErrorKind;
    }

    impl SpiDevice for Chip {
        fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), ErrorKind> {
            for operation in operations {
                let Operation::Transfer(came, sent) = operation else { return Err(ErrorKind::Other) };
                came.copy_from_slice(&frame(self.response, [5; 4]));
                // words of 24 bits are what the chip was set to
                assert_eq!(self.registers[2] >> 8 & 0b11, 0b01);
                self.obey(word(sent), word(&sent[3..]));
            }
            Ok(())
        }
    }

    /// Each of these was found in published drivers, or in their logs.
    mod bugs_of_others {
        use super::*;

        #[test]
        fn a_chip_left_locked_ignores_the_reset() {
            let mut chip = Ads131m04::start(Chip::new(true), SETTINGS, &mut NoopDelay::new()).unwrap();
            let sample = chip.poll(0.0).unwrap().unwrap();
            assert_eq!(*sample.channels, [5.0; 4]);
            assert_eq!((sample.status, sample.quality), (0x010F, Quality::empty()));
        }

        #[test]
        fn mode_0_makes_words_of_16_bits() {
            let chip = Ads131m04::start(Chip::new(false), SETTINGS, &mut NoopDelay::new()).unwrap().release();
            // as after a reset but for its flag
            assert_eq!(chip.registers[2], 0x0510 & !0x0400);
            assert_eq!(chip.registers[4], 0x7610);
        }

        #[test]
        fn oversampling_stands_at_bit_2() {
            use Oversampling::*;
            for (i, oversampling) in [X128, X256, X512, X1024, X2048, X4096, X8192, X16384].into_iter().enumerate() {
                let settings = Ads131m04Settings { oversampling, ..SETTINGS };
                let chip = Ads131m04::start(Chip::new(false), settings, &mut NoopDelay::new()).unwrap().release();
                let clock = chip.registers[3];
                assert_eq!((clock & 0xFF00, clock >> 2 & 0b111, clock & 0b11), (0x0F00, i as u16, 0b10));
                // 1024, in high resolution, is what the chip starts with
                assert_eq!(clock == Chip::new(false).registers[3], oversampling == X1024);
            }
        }
    }
}
