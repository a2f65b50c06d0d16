//! A transition of the reactions.

/// The kind of a transition.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum KinkKind {
    /// The channels go on continuously, their slopes do not.
    Kink,
    /// The channels jump: a snap, a slip, a snap-off.
    Jump,
}

/// A kink or a jump.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kink {
    /// Place, in units of the path parameter.
    pub tau: f64,
    /// Standard deviation of `tau` by noise; for a jump, that of a uniform distribution between two samples.
    pub sigma_tau: f64,
    /// Index of the first sample after it.
    pub next: usize,
    /// The kind.
    pub kind: KinkKind,
    /// Change of slope (kink) or value (jump) of each channel.
    pub change: [f64; 3],
    /// Standard deviations of the changes.
    pub sigma: [f64; 3],
    /// Sum over channels of (change / sigma)^2.
    pub score: f64,
}
