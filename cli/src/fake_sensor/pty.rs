//! A fake sensor on a pseudo-terminal.

use super::FakeError;
use rod_fake_sensor::FakeDevice;
#[cfg(unix)]
use rod_fake_sensor::{FakeSensor, Pace, open_pty};
use std::sync::mpsc::Receiver;
#[cfg(unix)]
use std::{thread, time::Duration};

/// Bytes kept for a program that does not read: half a minute of 6 floats at 1 kHz. More would only delay what it reads next.
#[cfg(unix)]
const ROOM: usize = 1 << 20;

/// Plays on a new pseudo-terminal until all samples are sent or `stopped` says so, however often a program opens it.
#[cfg(unix)]
pub(super) fn play_pty<D: FakeDevice>(
    device: D,
    name: &'static str,
    pace: f64,
    samples: Receiver<[f64; 6]>,
    playing: &str,
    tell: &mut dyn FnMut(&str),
    stopped: &dyn Fn() -> bool,
) -> Result<u64, FakeError> {
    let failed = |source| FakeError::Place { place: "a pseudo-terminal".into(), source };
    let mut pty = open_pty().map_err(failed)?;
    tell(&format!("serial:{}:{name}: {playing}", pty.path()));
    let sensor = FakeSensor::new(device, samples.into_iter()).with_pace(Pace::Rate(pace));
    let mut sensor = sensor.with_room(ROOM);
    loop {
        let end = sensor.serve(&mut pty, |_| !stopped()).map_err(failed)?;
        if end != rod_fake_sensor::End::Closed {
            // what the other side has not read yet would be gone with the pseudo-terminal
            thread::sleep(Duration::from_millis(500));
            return Ok(sensor.served().frames);
        }
    }
}

/// Fails: only Unix systems have pseudo-terminals.
#[cfg(not(unix))]
pub(super) fn play_pty<D: FakeDevice>(
    _: D,
    protocol: &'static str,
    _: f64,
    _: Receiver<[f64; 6]>,
    _: &str,
    _: &mut dyn FnMut(&str),
    _: &dyn Fn() -> bool,
) -> Result<u64, FakeError> {
    Err(FakeError::NoPty { protocol })
}
