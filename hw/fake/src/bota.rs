//! A Bota sensor that is a program.

use super::{FakeDevice, padded};
use crc::{CRC_16_IBM_SDLC, Crc};
use rod_hw::Quality;

/// X.25: polynomial 0x1021 reflected, begins with FFFF, inverted.
const CRC: Crc<u16> = Crc::<u16>::new(&CRC_16_IBM_SDLC);

/// A Bota Systems sensor: it sends from the beginning, and hears nothing.
///
/// ```
/// use rod_hw::Quality;
/// use rod_fake_sensor::{FakeBota, FakeDevice};
/// let (mut device, mut bytes) = (FakeBota::new(200.0).with_time(123_456).with_temperature(31.5), Vec::new());
/// device.measure(&[1.0, -2.0, 0.5, 0.01, -0.02, 0.003], Quality::empty(), &mut bytes);
/// assert_eq!((bytes.len(), &bytes[35..]), (37, &[0xd2, 0xd3][..]));
/// ```
#[derive(Clone, Debug)]
pub struct FakeBota {
    rate: f64,
    /// us.
    time: f64,
    temperature: f32,
}

impl FakeBota {
    /// A sensor of this rate (Hz), at 25 degrees Celsius, switched on now.
    pub fn new(rate: f64) -> Self {
        Self { rate, time: 0.0, temperature: 25.0 }
    }

    /// With its clock at so many us.
    #[must_use]
    pub fn with_time(mut self, microseconds: u32) -> Self {
        self.time = microseconds.into();
        self
    }

    /// At this temperature, degrees Celsius.
    #[must_use]
    pub fn with_temperature(mut self, celsius: f32) -> Self {
        self.temperature = celsius;
        self
    }
}

impl FakeDevice for FakeBota {
    fn hear(&mut self, _: &[u8], _: &mut Vec<u8>) {}

    fn measure(&mut self, values: &[f64], quality: Quality, frame: &mut Vec<u8>) {
        let flags = [(Quality::DEVICE_WARNING, 1), (Quality::SATURATED, 2), (Quality::DEVICE_ERROR, 4)];
        let status: u16 = flags.into_iter().filter(|(flag, _)| quality.contains(*flag)).map(|(_, bit)| bit).sum();
        let mut bytes = status.to_le_bytes().to_vec();
        padded::<6>(values).iter().for_each(|value| bytes.extend((*value as f32).to_le_bytes()));
        bytes.extend(((self.time.round() % 4_294_967_296.0) as u32).to_le_bytes());
        bytes.extend(self.temperature.to_le_bytes());
        let check = CRC.checksum(&bytes);
        frame.push(0xaa);
        frame.extend(bytes);
        frame.extend(check.to_le_bytes());
        self.time += 1e6 / self.rate;
    }

    fn restart(&mut self) {
        self.time = 0.0;
    }

    fn is_sending(&self) -> bool {
        true
    }

    fn rate(&self) -> f64 {
        self.rate
    }
}
