//! What Ctrl-C and a request to terminate do to a command.

use rod_files::Interrupt;
use rod_files::output::abandon;
use std::io::Write;
use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicU8, Ordering};

/// Number of SIGINT: what Ctrl-C sends.
const SIGINT: u8 = 2;

/// What has been caught so far.
pub struct Caught {
    /// Raised by the first signal.
    pub interrupt: Interrupt,
    signal: Arc<AtomicU8>,
}

impl Caught {
    /// The exit status of a command that was ended by the signal, as shells count: 128 and its number.
    pub fn status(&self) -> ExitCode {
        ExitCode::from(128 + self.signal.load(Ordering::Relaxed))
    }
}

/// From here on the first signal asks the command to end with what it has, and the second ends it.
pub fn ask() -> Caught {
    let (interrupt, signal) = (Interrupt::default(), Arc::new(AtomicU8::new(SIGINT)));
    let caught = Caught { interrupt: interrupt.clone(), signal: Arc::clone(&signal) };
    on_signal(move |number| {
        signal.store(number, Ordering::Relaxed);
        if interrupt.raise() {
            leave(number);
        }
    });
    caught
}

/// From here on the first signal ends the command: half of its results would say something wrong.
pub fn end() {
    on_signal(leave);
}

/// Ends the process, and leaves no stray files behind.
fn leave(signal: u8) {
    let published = abandon();
    let what = if published { "the results are written" } else { "nothing is written" };
    let _ = writeln!(std::io::stderr(), "warning: interrupted; {what}");
    std::process::exit(128 + i32::from(signal));
}

/// Where no handler can be set, a signal ends the process as it does by default: then a staging directory may stay.
#[cfg(unix)]
fn on_signal(act: impl Fn(u8) + Send + 'static) {
    use signal_hook::consts::{SIGINT, SIGTERM};
    if let Ok(mut signals) = signal_hook::iterator::Signals::new([SIGINT, SIGTERM]) {
        std::thread::spawn(move || signals.forever().for_each(|signal| act(signal as u8)));
    }
}

#[cfg(not(unix))]
fn on_signal(act: impl Fn(u8) + Send + 'static) {
    let _ = ctrlc::set_handler(move || act(SIGINT));
}
