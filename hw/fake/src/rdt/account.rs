//! The account of a fake sensor.

use super::settings::FakeRdtSettings;
use std::net::SocketAddr;
use std::sync::atomic::AtomicBool;
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

/// The account of a fake sensor. Each of `records` is one of `sent`, `dropped`, `damaged`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FakeRdtAccount {
    /// Records made, with those of a stall.
    pub records: u64,
    /// Records sent at least once, in time or late.
    pub sent: u64,
    /// Records never sent.
    pub dropped: u64,
    /// Records sent with a wrong length.
    pub damaged: u64,
    /// Sent records with the sample of the record before.
    pub stalled: u64,
    /// Sent records that came after later ones.
    pub overtaken: u64,
    /// Sent records with a status other than 0.
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

/// State that the threads share.
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

    /// The state. It stays valid if a thread panics.
    pub(super) fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
