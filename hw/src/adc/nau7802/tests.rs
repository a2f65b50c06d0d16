use super::super::{AdcSource, DelayClock, Polling};
use super::*;
use crate::quality::Quality;
use embedded_hal::i2c::{ErrorKind, NoAcknowledgeSource};
use embedded_hal_mock::eh1::delay::NoopDelay;
use embedded_hal_mock::eh1::i2c::{Mock, Transaction};

const SETTINGS: Nau7802Settings = Nau7802Settings {
    supply: Nau7802Supply::Volts3_0,
    gain: Gain::X128,
    rate: Nau7802Rate::Hz320,
    second: false,
    capacitor: true,
};

fn get(register: u8, bytes: &[u8]) -> Transaction {
    Transaction::write_read(0x2A, vec![register], bytes.to_vec())
}

fn put(register: u8, value: u8) -> Transaction {
    Transaction::write(0x2A, vec![register, value])
}

fn put_and_get(register: u8, value: u8) -> [Transaction; 2] {
    [put(register, value), get(register, &[value])]
}

/// With literal bytes: 3.0 V is number 5, gain 128 number 7, 320 Hz number 7.
fn started() -> Vec<Transaction> {
    let mut script = vec![put(0x00, 0x01), put(0x00, 0x02), get(0x00, &[0x02]), get(0x00, &[0x0A]), get(0x1F, &[0x0F])];
    script.extend([put(0x00, 0x86), get(0x00, &[0x8E])]);
    script.extend([put_and_get(0x01, 0x2F), put_and_get(0x02, 0x70), put_and_get(0x15, 0x30)].concat());
    script.extend([get(0x1C, &[0x00]), put(0x1C, 0x80), get(0x1C, &[0x80])]);
    script.extend([put(0x00, 0x96), get(0x00, &[0x9E])]);
    script
}

fn run<R>(script: &[Transaction], test: impl FnOnce(Mock) -> R) -> R {
    let mut bus = Mock::new(script);
    let result = test(bus.clone());
    bus.done();
    result
}

fn start(bus: Mock) -> Result<Nau7802<Mock>, AdcError<ErrorKind>> {
    Nau7802::start(bus, SETTINGS, &mut NoopDelay::new())
}

#[test]
fn starts_calibrates_and_converts() {
    let calibration = [put(0x02, 0x74), get(0x02, &[0x74]), get(0x02, &[0x74]), get(0x02, &[0x70])];
    let conversions = [get(0x00, &[0x9E]), get(0x00, &[0xBE]), get(0x12, &[0xFF, 0xFF, 0x38])];
    run(&[started(), calibration.into(), conversions.into()].concat(), |bus| {
        let mut chip = start(bus).unwrap();
        chip.calibrate(&mut NoopDelay::new(), 1000).unwrap();
        assert_eq!(chip.poll(0.0), Ok(None));
        let sample = chip.poll(0.1).unwrap().unwrap();
        assert_eq!((*sample.channels).to_vec(), [-200.0]);
        assert_eq!((sample.host_time, sample.status, sample.quality), (0.1, 0xBE, Quality::empty()));
        // full scale is half the reference over the gain
        assert_eq!(chip.volts_per_count(3.0) * 8_388_608.0, 1.5 / 128.0);
    });
}

#[test]
fn other_settings() {
    // 4.5 V is number 0 of the regulator, and the pin AVDD no number
    for (supply, control, control_1) in [
        (Nau7802Supply::External, 0x06, 0x00),
        (Nau7802Supply::Volts4_5, 0x86, 0x00),
        (Nau7802Supply::Volts2_4, 0x86, 0x38),
    ] {
        let settings =
            Nau7802Settings { supply, gain: Gain::X1, rate: Nau7802Rate::Hz40, second: true, capacitor: false };
        let script = [
            vec![put(0x00, 0x01), put(0x00, 0x02), get(0x00, &[0x0A]), get(0x1F, &[0x1F])],
            vec![put(0x00, control), get(0x00, &[control | 8])],
            put_and_get(0x01, control_1).into(),
            put_and_get(0x02, 0xA0).into(),
            put_and_get(0x15, 0x30).into(),
            vec![get(0x1C, &[0xC1]), put(0x1C, 0x41), get(0x1C, &[0x41])],
            // the bit that starts the cycle need not stay
            vec![put(0x00, control | 0x10), get(0x00, &[control | 8])],
        ];
        run(&script.concat(), |bus| Nau7802::start(bus, settings, &mut NoopDelay::new()).map(|_| ())).unwrap();
    }
}

#[test]
fn ends_of_the_range() {
    for (bytes, expected) in [
        ([0x7F, 0xFF, 0xFF], Quality::SATURATED),
        ([0x80, 0, 0], Quality::SATURATED),
        ([0x7F, 0xFF, 0xFE], Quality::empty()),
    ] {
        run(&[started(), vec![get(0x00, &[0xBE]), get(0x12, &bytes)]].concat(), |bus| {
            assert_eq!(start(bus).unwrap().poll(0.0).unwrap().unwrap().quality, expected);
        });
    }
}

#[test]
fn what_can_be_wrong_at_the_start() {
    let refused = ErrorKind::NoAcknowledge(NoAcknowledgeSource::Address);
    let error = run(&[put(0x00, 0x01).with_error(refused)], |bus| start(bus).unwrap_err());
    assert_eq!(error, AdcError::Bus(refused));

    let asleep = [vec![put(0x00, 0x01), put(0x00, 0x02)], vec![get(0x00, &[0x02]); 100]].concat();
    assert_eq!(run(&asleep, |bus| start(bus).unwrap_err()), AdcError::NotReady { waited: 0.1 });

    let mut other = started()[..5].to_vec();
    other[4] = get(0x1F, &[0x06]);
    assert_eq!(run(&other, |bus| start(bus).unwrap_err()), AdcError::WrongId { found: 6, expected: 15 });

    let mut deaf = started()[..9].to_vec();
    deaf[8] = get(0x01, &[0x00]);
    let error = run(&deaf, |bus| start(bus).unwrap_err());
    assert_eq!(error, AdcError::Register { address: 1, written: 0x2F, read: 0 });
}

#[test]
fn calibrations_that_fail() {
    let never = [started(), vec![put(0x02, 0x74)], vec![get(0x02, &[0x74]); 20]].concat();
    let error = run(&never, |bus| start(bus).unwrap().calibrate(&mut NoopDelay::new(), 20).unwrap_err());
    assert_eq!(error, AdcError::NotReady { waited: 0.02 });
    let failed = [started(), vec![put(0x02, 0x74), get(0x02, &[0x78])]].concat();
    let error = run(&failed, |bus| start(bus).unwrap().calibrate(&mut NoopDelay::new(), 20).unwrap_err());
    assert_eq!(error, AdcError::Calibration { status: 0x78 });
}

#[test]
fn a_supply_that_failed_and_a_deadline() {
    let script = [started(), vec![get(0x00, &[0x00])], vec![get(0x00, &[0x9E]); 3]].concat();
    run(&script, |bus| {
        let polling = Polling { deadline: 0.5, pause: 0.25 };
        let mut source = AdcSource::new(start(bus).unwrap(), DelayClock::new(NoopDelay::new()), polling);
        assert_eq!(source.read(), Err(AdcError::Register { address: 0, written: 0x86, read: 0 }));
        assert_eq!(source.read(), Err(AdcError::NotReady { waited: 0.5 }));
    });
}
