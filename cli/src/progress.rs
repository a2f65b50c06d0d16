//! How far a command has come, on standard error.

use crate::QUIET;
use indicatif::ProgressBar;
use rod_files::Interrupt;
use std::io::{self, IsTerminal};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, JoinHandle};
use std::time::Duration;

/// Time between two looks.
const TICK: Duration = Duration::from_millis(100);

/// Whether people look: at a terminal, and not with `--quiet`.
fn is_watched() -> bool {
    !QUIET.load(Ordering::Relaxed) && io::stderr().is_terminal()
}

/// Names what is being done.
pub fn stage(text: &str) {
    if is_watched() {
        crate::warn(&format!("{text}\n"));
    }
}

/// A bar that shows percents until it is dropped.
pub struct Progress {
    ended: Arc<AtomicBool>,
    shown: Option<JoinHandle<()>>,
}

impl Progress {
    /// Of the command that has this interrupt.
    pub fn of(interrupt: &Interrupt) -> Self {
        let ended = Arc::new(AtomicBool::new(false));
        let (interrupt, told) = (interrupt.clone(), Arc::clone(&ended));
        let show = move || {
            let bar = ProgressBar::new(100);
            while !told.load(Ordering::Relaxed) {
                bar.set_position(interrupt.passed().into());
                thread::park_timeout(TICK);
            }
            bar.finish_and_clear();
        };
        Self { ended, shown: is_watched().then(|| thread::spawn(show)) }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.ended.store(true, Ordering::Relaxed);
        if let Some(shown) = self.shown.take() {
            shown.thread().unpark();
            let _ = shown.join();
        }
    }
}
