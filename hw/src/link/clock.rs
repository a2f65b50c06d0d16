//! The time of the host.

/// A clock that can wait. A microcontroller needs its own implementation.
pub trait Clock {
    /// Time, s, from any origin; never earlier than before.
    fn now(&mut self) -> f64;
    /// Waits for about this time, s.
    fn wait(&mut self, seconds: f64);
}

/// The host's steady clock, from its creation on.
///
/// ```
/// use rod_hw::{Clock, HostClock};
/// let mut clock = HostClock::new();
/// let before = clock.now();
/// clock.wait(1e-3);
/// assert!(clock.now() - before >= 1e-3);
/// ```
#[cfg(feature = "std")]
#[derive(Clone, Copy, Debug)]
pub struct HostClock(std::time::Instant);

#[cfg(feature = "std")]
impl HostClock {
    /// Starts at 0 now.
    pub fn new() -> Self {
        Self(std::time::Instant::now())
    }
}

#[cfg(feature = "std")]
impl Default for HostClock {
    fn default() -> Self {
        Self::new()
    }
}

#[cfg(feature = "std")]
impl Clock for HostClock {
    fn now(&mut self) -> f64 {
        self.0.elapsed().as_secs_f64()
    }

    fn wait(&mut self, seconds: f64) {
        // also where it is no number
        if let Ok(time) = std::time::Duration::try_from_secs_f64(seconds) {
            std::thread::sleep(time);
        }
    }
}
