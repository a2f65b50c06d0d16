//! A sensor that is a program: `cargo run -p rod-fake-sensor --features pty --example fake_serial -- gsv8 100` prints the path of a
//! serial port, on which a GSV-8 of six channels sends 0, 1, 2, ... 999, again and again, 1, 2, 3, 4, 5. To be ended by Ctrl-C.
#![allow(clippy::print_stdout)]

use rod_fake_sensor::{FakeSensor, Pace, of_profile, open_pty};
use rod_hw::SerialProfile;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let profile = SerialProfile::parse(&arguments.next().unwrap_or_else(|| "gsv8".to_owned()))?;
    let rate: Option<f64> = arguments.next().map(|rate| rate.parse()).transpose()?;
    let device = of_profile(profile, rate.unwrap_or(100.0));
    let mut pty = open_pty()?;
    println!("{}", pty.path());
    let source = (0..1000).cycle().map(|i| [f64::from(i), 1.0, 2.0, 3.0, 4.0, 5.0]);
    let pace = rate.map_or(Pace::Device, Pace::Rate);
    FakeSensor::new(device, source).with_pace(pace).serve(&mut pty, |_| true)?;
    Ok(())
}
