//! Running the library: without the interpreter, but with the errors of what it calls back.

use pyo3::prelude::*;
use rod_files::Interrupt;
use std::cell::RefCell;
use std::time::{Duration, Instant};

thread_local! {
    /// The first exception of a function in Python that the library has called from this thread.
    static RAISED: RefCell<Option<PyErr>> = const { RefCell::new(None) };
}

/// Interval between two looks for Ctrl-C: short for a person, and long against the time that taking the interpreter costs.
const LOOK: Duration = Duration::from_millis(50);

/// Interval between two looks whether the work of another thread is done.
const NAP: Duration = Duration::from_millis(2);

/// Computes without the interpreter. An exception of a function in Python that was called on the way is raised.
pub fn run<T: Send>(py: Python<'_>, compute: impl FnOnce() -> T + Send) -> PyResult<T> {
    RAISED.take();
    let result = py.detach(compute);
    RAISED.take().map_or(Ok(result), Err)
}

/// Computes without the interpreter on a thread of its own, while this one looks for Ctrl-C, which ends the work early and is raised.
pub fn interruptible<T: Send>(py: Python<'_>, compute: impl FnOnce(&Interrupt) -> T + Send) -> PyResult<T> {
    let interrupt = Interrupt::default();
    run(py, || {
        std::thread::scope(|scope| {
            let worker = scope.spawn(|| compute(&interrupt));
            let mut watch = Watch::new();
            while !worker.is_finished() {
                if watch.should_end() {
                    interrupt.raise();
                }
                std::thread::sleep(NAP);
            }
            worker.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
        })
    })
}

/// Keeps an exception until the library returns.
pub fn raise(error: PyErr) {
    RAISED.with_borrow_mut(|raised| {
        raised.get_or_insert(error);
    });
}

/// Whether a function in Python has raised an exception.
pub fn has_raised() -> bool {
    RAISED.with_borrow(Option::is_some)
}

/// Looks for Ctrl-C every now and then, in a loop that runs without the interpreter.
pub struct Watch {
    last: Instant,
}

impl Watch {
    pub fn new() -> Self {
        Self { last: Instant::now() }
    }

    /// Whether to end: Ctrl-C, or an exception of a function that was called back. [`run`] raises it.
    pub fn should_end(&mut self) -> bool {
        if has_raised() {
            return true;
        }
        if self.last.elapsed() < LOOK {
            return false;
        }
        self.last = Instant::now();
        if let Err(error) = Python::attach(|py| py.check_signals()) {
            raise(error);
        }
        has_raised()
    }
}
