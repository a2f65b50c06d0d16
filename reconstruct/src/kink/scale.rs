//! Settings of the search for kinks, and the lengths of its windows.

/// Settings of the search for kinks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KinkOptions {
    /// Upper bound of the expected number of false alarms in a recording of smooth signals and noise.
    pub false_alarms: f64,
    /// Longest half-window, in units of the path parameter.
    pub widest: f64,
}

impl Default for KinkOptions {
    /// 0.1 false alarms and half-windows up to 0.08, lengths of the rod.
    fn default() -> Self {
        Self { false_alarms: 0.1, widest: 0.08 }
    }
}

/// Half-windows in bins at the finest level, and at the others.
const FINEST: [usize; 4] = [4, 6, 8, 12];
const OTHERS: [usize; 2] = [8, 12];
/// Number of levels: the bins of the coarsest hold 2^23 samples.
const LEVELS: usize = 24;

/// One window length.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WindowLength {
    /// Bins hold 2^level samples.
    pub level: usize,
    /// Bins on either side.
    pub half: usize,
    /// Thresholds of hinge, and of hinge and step.
    pub three: f64,
    pub six: f64,
}

/// Window lengths from the finest to the widest; their thresholds are not set yet.
pub(crate) fn scales(spacing: f64, options: KinkOptions) -> impl Iterator<Item = WindowLength> {
    let reach = options.widest / spacing;
    let reach = if reach.is_finite() { reach.max(FINEST[0] as f64) } else { FINEST[0] as f64 };
    (0..LEVELS).flat_map(move |level| {
        let halves = if level == 0 { &FINEST[..] } else { &OTHERS[..] };
        let scale = move |half: &usize| WindowLength { level, half: *half, three: 0.0, six: 0.0 };
        halves.iter().map(scale).filter(move |scale| (scale.half << level) as f64 <= reach)
    })
}

/// Samples in the longest half-window, and in its bins.
pub(crate) fn reach(spacing: f64, options: KinkOptions) -> (usize, usize) {
    let longest = scales(spacing, options).map(|scale| (scale.half << scale.level, 1 << scale.level)).max();
    longest.unwrap_or((FINEST[0], 1))
}
