//! Bounds of the curvature between two places of a segment, of which arc length and moment are known.

/// A range of numbers: least and largest.
pub(crate) type Range = (f64, f64);

/// The range of the curvature m g + k over `length`, where the moment goes from one end of `moments` to the other under a force of size
/// `force`, and compliance g and natural curvature k stay within their ranges.
///
/// m' = A cos phi + B sin phi, hence |m'| <= P and |m''| <= P |kappa| with the force P = |(A, B)|: the moment leaves the range of its
/// end values by no more than P l / 2, nor than P |kappa| l^2 / 8.
#[inline(always)]
pub(crate) fn curvature_range(moments: [f64; 2], force: f64, length: f64, compliance: Range, natural: Range) -> Range {
    let bent = largest_curvature(moments, force, length, compliance.1, natural);
    let moment = moment_range(moments, force, length, bent);
    let (low, high) = product(moment, compliance);
    (low + natural.0, high + natural.1)
}

/// What |curvature| does not exceed, by |m'| <= P alone.
#[inline(always)]
pub(crate) fn largest_curvature([m0, m1]: [f64; 2], force: f64, length: f64, compliance: f64, natural: Range) -> f64 {
    (m0.abs().max(m1.abs()) + 0.5 * force * length) * compliance + natural.0.abs().max(natural.1.abs())
}

/// The range of the moment where |curvature| is at most `bent`.
#[inline(always)]
pub(crate) fn moment_range([m0, m1]: [f64; 2], force: f64, length: f64, bent: f64) -> Range {
    let slack = (0.5 * force * length).min(0.125 * force * bent * length * length);
    (m0.min(m1) - slack, m0.max(m1) + slack)
}

/// The range of a number of the first range times a positive one of the second.
#[inline(always)]
pub(crate) fn product((low, high): Range, (least, most): Range) -> Range {
    (low * if low < 0.0 { most } else { least }, high * if high < 0.0 { least } else { most })
}

/// The range of both.
pub(crate) fn union(one: Range, other: Range) -> Range {
    (one.0.min(other.0), one.1.max(other.1))
}
