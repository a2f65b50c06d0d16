//! What a fake sensor did.

use super::settings::FakeRdtSettings;
use std::net::SocketAddr;
use std::sync::atomic::AtomicBool;
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

/// What a fake sensor did so far. Each of `records` is one of `sent`, `dropped`, `damaged`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FakeRdtAccount {
    /// Records made, with those of a stall.
    pub records: u64,
    /// Of these: sent, once or more, in time or late.
    pub sent: u64,
    /// Of these: never sent.
    pub dropped: u64,
    /// Of these: sent with a wrong length.
    pub damaged: u64,
    /// Of those sent: with the sample of the record before.
    pub stalled: u64,
    /// Of those sent: after later ones.
    pub overtaken: u64,
    /// Of those sent: with a status that is not 0.
    pub flagged: u64,
    /// Sent once more.
    pub repeated: u64,
    /// Datagrams without meaning, and damaged ones.
    pub malformed: u64,
    /// Records from another sensor.
    pub foreign: u64,
    /// Requests to start that were answered.
    pub starts: u64,
    /// Requests that got lost: to start, as told, and any without power.
    pub ignored: u64,
    /// Requests to stop.
    pub stops: u64,
    /// Requests that are not known.
    pub unknown: u64,
    /// Answers over TCP.
    pub answers: u64,
}

/// What the threads know of each other.
#[derive(Debug)]
pub(super) struct Shared {
    state: Mutex<State>,
    /// Whether there is somebody to send to.
    pub(super) changed: Condvar,
    /// To end.
    pub(super) stop: AtomicBool,
}

#[derive(Debug)]
pub(super) struct State {
    /// Who started it, if it runs.
    pub(super) client: Option<SocketAddr>,
    /// So many records are still to be sent.
    pub(super) left: Option<u32>,
    /// Number of the start.
    pub(super) start: u64,
    /// Without power.
    pub(super) off: bool,
    /// Requests to start that are still to be lost.
    pub(super) to_ignore: u32,
    pub(super) account: FakeRdtAccount,
}

impl Shared {
    pub(super) fn new(settings: &FakeRdtSettings) -> Self {
        let state = State {
            client: None,
            left: None,
            start: 0,
            off: false,
            to_ignore: settings.ignored_starts,
            account: FakeRdtAccount::default(),
        };
        Self { state: Mutex::new(state), changed: Condvar::new(), stop: AtomicBool::new(false) }
    }

    /// The state; what a thread that panicked left of it is good, too.
    pub(super) fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
