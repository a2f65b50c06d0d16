//! Settings of the search for kinks.

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
