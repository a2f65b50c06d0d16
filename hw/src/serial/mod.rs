//! Serial ports.

#[cfg(feature = "serial")]
mod port;
mod profile;
#[cfg(all(feature = "serial", unix))]
mod pty;

#[cfg(feature = "serial")]
pub use port::{SerialError, SerialPort};
pub use profile::{SerialProfile, SerialProfileError};
#[cfg(all(feature = "serial", unix))]
pub use pty::{Pty, open_pty};
