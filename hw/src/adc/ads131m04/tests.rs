//! The chip by scripts of its bus, and as the datasheet tells of it.

use super::*;
use embedded_hal::spi::{ErrorKind, ErrorType, Operation};
use embedded_hal_mock::eh1::delay::NoopDelay;
use embedded_hal_mock::eh1::spi::{Mock, Transaction};

const SETTINGS: Ads131m04Settings =
    Ads131m04Settings { gains: [Gain::X1, Gain::X2, Gain::X64, Gain::X128], oversampling: Oversampling::X4096 };

/// Bit by bit, as in the datasheet.
fn checksum(bytes: &[u8]) -> u16 {
    bytes.iter().fold(0xFFFF, |sum, &byte| {
        (0..8).fold(sum ^ u16::from(byte) << 8, |sum, _| if sum & 0x8000 == 0 { sum << 1 } else { sum << 1 ^ 0x1021 })
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
        [started(0x2403), written(0x6100, 0xA100, 0x0110, 0x0110), written(0x6200, 0xA200, 0x7610, 0x0000)].concat();
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
