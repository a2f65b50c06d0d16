//! Bounds of a curvature: pairs of the least and the largest value, one over a length.

/// Nothing known.
pub(crate) const ANY: (f64, f64) = (f64::NEG_INFINITY, f64::INFINITY);

/// No value at all, to begin a union with.
pub(crate) const NONE: (f64, f64) = (f64::INFINITY, f64::NEG_INFINITY);

/// The bounds of what is within either.
pub(crate) fn union(one: (f64, f64), other: (f64, f64)) -> (f64, f64) {
    (one.0.min(other.0), one.1.max(other.1))
}

/// The bounds of two values, widened by `relative` of each.
pub(crate) fn of_values(values: impl IntoIterator<Item = f64>, relative: f64) -> (f64, f64) {
    values.into_iter().fold(NONE, |bounds, value| {
        let margin = relative * value.abs();
        union(bounds, (value - margin, value + margin))
    })
}
