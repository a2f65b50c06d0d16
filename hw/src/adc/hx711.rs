//! HX711: one bridge, over two pins.

use super::{Adc, AdcError, FULL_SCALE, counts, quality};
use crate::raw::{Channels, RawSample};
use embedded_hal::delay::DelayNs;
use embedded_hal::digital::{InputPin, OutputPin};

/// The clock line's half period, us: 0.2 to 50.
const HALF: u32 = 1;

/// A clock line high for 60 us switches the chip off, us.
const OFF: u32 = 100;

/// What an [`Hx711`] converts; the number of clock pulses of a readout says it for the next conversion.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Hx711Input {
    /// Channel A with gain 128: 20 mV either way at 5 V.
    #[default]
    A128 = 25,
    /// Channel B with gain 32: 80 mV.
    B32 = 26,
    /// Channel A with gain 64: 40 mV.
    A64 = 27,
}

impl Hx711Input {
    /// Gain of the amplifier.
    pub fn gain(self) -> f64 {
        match self {
            Self::A128 => 128.0,
            Self::B32 => 32.0,
            Self::A64 => 64.0,
        }
    }
}

/// The converter HX711 of Avia Semiconductor: one bridge at 10 or 80 Hz (a pin of the chip says which), 24 bits, over two pins.
///
/// There is no checksum and no ID. What can be seen is checked: after a readout the data line must be high again, which one
/// that is not connected rarely is. A readout takes 50 us or more and must not be held up for 60 us with the clock line high,
/// or the chip switches off: keep longer interrupts away from it.
///
/// A sample has counts of `reference` / gain / 2^24 and is [`SATURATED`](crate::Quality::SATURATED) at the ends of the range.
///
/// Source: datasheet, sections "Serial Interface", "Reset and Power-Down", table 3.
///
/// ```
/// use embedded_hal::{delay::DelayNs, digital::{InputPin, OutputPin}};
/// use rod_hw::adc::{AdcError, AdcSource, DelayClock, Hx711, Hx711Input, Polling, Side};
/// use rod_hw::RawSource;
///
/// /// A base of two bridges, one chip each.
/// fn base<I: InputPin, O: OutputPin<Error = I::Error>, D: DelayNs + Clone>(
///     pins: [(I, O); 2],
///     delay: D,
/// ) -> Result<impl RawSource<Error = AdcError<I::Error>>, AdcError<I::Error>> {
///     let [(data_x, clock_x), (data_y, clock_y)] = pins;
///     let x = Hx711::start(data_x, clock_x, delay.clone(), Hx711Input::A128)?;
///     let y = Hx711::start(data_y, clock_y, delay.clone(), Hx711Input::A128)?;
///     Ok(AdcSource::new(Side::new([x, y]), DelayClock::new(delay), Polling { deadline: 1.0, pause: 1e-3 }))
/// }
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Hx711<I, O, D> {
    data: I,
    clock: O,
    delay: D,
    input: Hx711Input,
    /// What the conversion that is under way is of.
    converts: Hx711Input,
}

impl<I: InputPin, O: OutputPin<Error = I::Error>, D: DelayNs> Hx711<I, O, D> {
    /// Switches the chip off and on, whatever state it was in. Its first conversion is ready 0.4 s later at 10 Hz, 50 ms at 80.
    ///
    /// # Errors
    /// [`AdcError::Bus`].
    pub fn start(data: I, clock: O, delay: D, input: Hx711Input) -> Result<Self, AdcError<I::Error>> {
        let mut chip = Self { data, clock, delay, input, converts: Hx711Input::A128 };
        chip.power_down()?;
        chip.power_up()?;
        Ok(chip)
    }

    /// Switches the chip off, and the bridge where the chip supplies it.
    ///
    /// # Errors
    /// [`AdcError::Bus`].
    pub fn power_down(&mut self) -> Result<(), AdcError<I::Error>> {
        self.clock.set_low().map_err(AdcError::Bus)?;
        self.clock.set_high().map_err(AdcError::Bus)?;
        self.delay.delay_us(OFF);
        Ok(())
    }

    /// Switches the chip on.
    ///
    /// # Errors
    /// [`AdcError::Bus`].
    pub fn power_up(&mut self) -> Result<(), AdcError<I::Error>> {
        self.clock.set_low().map_err(AdcError::Bus)?;
        // a chip that comes up has forgotten what it was told
        self.converts = Hx711Input::A128;
        Ok(())
    }

    /// Converts something else from now on. The conversion under way is dropped.
    pub fn select(&mut self, input: Hx711Input) {
        self.input = input;
    }

    /// One count, V, at a supply of the bridge (pin AVDD) of `reference`, V.
    pub fn volts_per_count(&self, reference: f64) -> f64 {
        reference / (2.0 * self.input.gain() * FULL_SCALE)
    }

    /// The pins again.
    pub fn release(self) -> (I, O) {
        (self.data, self.clock)
    }

    /// Clocks out what is ready and says what is to be converted next.
    fn readout(&mut self) -> Result<[u8; 3], I::Error> {
        let mut bits = 0_u32;
        for pulse in 0..self.input as u32 {
            self.clock.set_high()?;
            self.delay.delay_us(HALF);
            if pulse < 24 {
                bits = bits << 1 | u32::from(self.data.is_high()?);
            }
            self.clock.set_low()?;
            self.delay.delay_us(HALF);
        }
        let [_, high, middle, low] = bits.to_be_bytes();
        Ok([high, middle, low])
    }
}

impl<I: InputPin, O: OutputPin<Error = I::Error>, D: DelayNs> Adc for Hx711<I, O, D> {
    type Bus = I::Error;
    const CHANNELS: usize = 1;

    fn poll(&mut self, now: f64) -> Result<Option<RawSample>, AdcError<I::Error>> {
        if self.data.is_high().map_err(AdcError::Bus)? {
            return Ok(None);
        }
        let counts = counts(self.readout().map_err(AdcError::Bus)?);
        let converted = core::mem::replace(&mut self.converts, self.input);
        if self.data.is_low().map_err(AdcError::Bus)? {
            return Err(AdcError::StuckLine);
        }
        if converted != self.input {
            return Ok(None);
        }
        let channels = Channels::from([f64::from(counts)]);
        Ok(Some(RawSample { quality: quality(counts), ..RawSample::new(now, channels) }))
    }
}

#[cfg(test)]
mod tests {
    use super::super::{AdcSource, DelayClock, Polling, Side};
    use super::*;
    use crate::quality::Quality;
    use embedded_hal_mock::eh1::MockError;
    use embedded_hal_mock::eh1::delay::NoopDelay;
    use embedded_hal_mock::eh1::digital::{Mock, State, Transaction};

    /// The data line: ready, 24 bits, high again.
    fn converted(counts: i32) -> Vec<Transaction> {
        let bit = |bit: u32| if counts >> (23 - bit) & 1 == 1 { State::High } else { State::Low };
        let mut line = vec![Transaction::get(State::Low)];
        line.extend((0..24).map(|i| Transaction::get(bit(i))));
        line.push(Transaction::get(State::High));
        line
    }

    fn pulses(count: usize) -> Vec<Transaction> {
        vec![[Transaction::set(State::High), Transaction::set(State::Low)]; count].concat()
    }

    fn started() -> Vec<Transaction> {
        [State::Low, State::High, State::Low].map(Transaction::set).into()
    }

    type Chip = Hx711<Mock, Mock, NoopDelay>;

    fn run<R>(data: &[Transaction], clock: &[Transaction], input: Hx711Input, test: impl FnOnce(Chip) -> R) -> R {
        let (mut data, mut clock) = (Mock::new(data), Mock::new(clock));
        let result = test(Hx711::start(data.clone(), clock.clone(), NoopDelay::new(), input).unwrap());
        data.done();
        clock.done();
        result
    }

    #[test]
    fn conversions() {
        for counts in [0, 1, -1, 0x55_AA55, -0x12_3456, 8_388_606, -8_388_607, 8_388_607, -8_388_608] {
            let line = [vec![Transaction::get(State::High)], converted(counts)].concat();
            run(&line, &[started(), pulses(25)].concat(), Hx711Input::A128, |mut chip| {
                assert_eq!(chip.poll(0.0), Ok(None));
                let sample = chip.poll(0.1).unwrap().unwrap();
                assert_eq!((*sample.channels).to_vec(), [f64::from(counts)]);
                let end = counts == 8_388_607 || counts == -8_388_608;
                assert_eq!(sample.quality.contains(Quality::SATURATED), end);
                // full scale is half the supply over the gain
                assert_eq!(chip.volts_per_count(5.0) * 8_388_608.0, 2.5 / 128.0);
            });
        }
    }

    #[test]
    fn pulses_choose_the_next_input() {
        // the chip comes up with A128; the first readout asks for B32, then for A64
        let line = [converted(1), converted(2), converted(3), converted(4)].concat();
        let clock = [started(), pulses(26), pulses(26), pulses(27), pulses(27)].concat();
        run(&line, &clock, Hx711Input::B32, |mut chip| {
            assert_eq!(chip.poll(0.0), Ok(None), "that was A128");
            assert_eq!(chip.poll(0.0).unwrap().unwrap().channels[0], 2.0);
            chip.select(Hx711Input::A64);
            assert_eq!(chip.poll(0.0), Ok(None), "that was B32");
            assert_eq!(chip.poll(0.0).unwrap().unwrap().channels[0], 4.0);
        });
    }

    #[test]
    fn off_and_on() {
        let clock = [started(), pulses(26), started(), pulses(26)].concat();
        run(&[converted(1), converted(2)].concat(), &clock, Hx711Input::B32, |mut chip| {
            assert_eq!(chip.poll(0.0), Ok(None));
            chip.power_down().unwrap();
            chip.power_up().unwrap();
            assert_eq!(chip.poll(0.0), Ok(None), "A128 again");
        });
    }

    #[test]
    fn not_ready_until_the_deadline_and_the_gap_after_it() {
        let line = [vec![Transaction::get(State::High); 5], converted(7), converted(8)].concat();
        run(&line, &[started(), pulses(25), pulses(25)].concat(), Hx711Input::A128, |chip| {
            let polling = Polling { deadline: 1.0, pause: 0.25 };
            let mut source = AdcSource::new(chip, DelayClock::new(NoopDelay::new()), polling);
            assert_eq!(source.next().unwrap(), Err(AdcError::NotReady { waited: 1.0 }));
            assert_eq!(source.next().unwrap().unwrap().quality, Quality::GAP_BEFORE);
            assert_eq!(source.next().unwrap().unwrap().quality, Quality::empty());
        });
    }

    #[test]
    fn a_line_that_is_not_connected_and_pins_that_fail() {
        let mut line = converted(0);
        line[25] = Transaction::get(State::Low);
        run(&line, &[started(), pulses(25)].concat(), Hx711Input::A128, |mut chip| {
            assert_eq!(chip.poll(0.0), Err(AdcError::StuckLine));
        });
        let fault = MockError::Io(std::io::ErrorKind::NotConnected);
        let mut clock = [started(), pulses(1)].concat();
        clock[3] = Transaction::set(State::High).with_error(fault.clone());
        run(&[Transaction::get(State::Low)], &clock[..4], Hx711Input::A128, |mut chip| {
            assert_eq!(chip.poll(0.0), Err(AdcError::Bus(fault)));
        });
    }

    #[test]
    fn side_by_side() {
        // the second chip is late by one look, when the first has nothing new
        let lines = [
            [converted(-5), vec![Transaction::get(State::High)]].concat(),
            [vec![Transaction::get(State::High)], converted(8_388_607)].concat(),
        ];
        let mut data = lines.map(|line| Mock::new(&line));
        let mut clocks = [(); 2].map(|()| Mock::new(&[started(), pulses(25)].concat()));
        let [first, second] = [0, 1]
            .map(|i| Hx711::start(data[i].clone(), clocks[i].clone(), NoopDelay::new(), Hx711Input::A128).unwrap());
        let mut base = Side::new([first, second]);
        assert_eq!(base.poll(0.1), Ok(None));
        let sample = base.poll(0.2).unwrap().unwrap();
        assert_eq!((*sample.channels).to_vec(), [-5.0, 8_388_607.0]);
        assert_eq!((sample.host_time, sample.quality), (0.2, Quality::SATURATED));
        for pin in data.iter_mut().chain(&mut clocks) {
            pin.done();
        }
    }
}
