//! The range of the parameter of a contour.

/// Smallest distance from the finite end (or from 0) that the spread of an infinite range resolves, in units of the
/// parameter: small against rods of micrometres given in metres.
const FINEST: f64 = 1e-9;

/// Largest distance that the spread of an infinite range reaches, in units of the parameter.
const REACH: f64 = 1e4;

/// An interval of a contour's parameter, either end of which may be infinite.
///
/// ```
/// use rod_contours::Range;
///
/// let range = Range { from: 0.0, to: f64::INFINITY };
/// assert!(range.contains(7.0) && !range.is_finite());
/// assert_eq!(range.clamp(-1.0), 0.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// Where the contour starts, possibly minus infinity.
    pub from: f64,
    /// Where the contour ends, possibly infinity; larger than `from`.
    pub to: f64,
}

impl Range {
    /// From 0 to 1.
    pub const UNIT: Self = Self { from: 0.0, to: 1.0 };

    /// All numbers.
    pub const ALL: Self = Self { from: f64::NEG_INFINITY, to: f64::INFINITY };

    /// Whether `t` lies in the range, ends included; false for NaN.
    pub fn contains(&self, t: f64) -> bool {
        self.from <= t && t <= self.to
    }

    /// Whether `t` lies between the ends, neither of which counts.
    pub(crate) fn is_interior(&self, t: f64) -> bool {
        self.from < t && t < self.to
    }

    /// The number of the range that is nearest to `t`. Unlike [`f64::clamp`] it accepts any ends.
    pub fn clamp(&self, t: f64) -> f64 {
        t.max(self.from).min(self.to)
    }

    /// Whether both ends are finite.
    pub fn is_finite(&self) -> bool {
        self.from.is_finite() && self.to.is_finite()
    }

    /// `to - from`.
    pub fn length(&self) -> f64 {
        self.to - self.from
    }

    /// The intersection of both ranges. If it is empty: an end of this range.
    pub fn within(&self, other: Self) -> Self {
        let from = self.clamp(other.from);
        Self { from, to: self.clamp(other.to).max(from) }
    }

    /// The range moved by `offset`.
    pub fn shifted(&self, offset: f64) -> Self {
        Self { from: self.from + offset, to: self.to + offset }
    }

    /// The range travelled the other way, by `-t`.
    pub(crate) fn backwards(&self) -> Self {
        Self { from: -self.to, to: -self.from }
    }

    /// A finite part of the range: itself if finite, else at most `width` from its finite end, or from 0.
    ///
    /// ```
    /// # use rod_contours::Range;
    /// assert_eq!(Range::ALL.window(2.0), Range { from: -2.0, to: 2.0 });
    /// ```
    pub fn window(&self, width: f64) -> Self {
        match (self.from.is_finite(), self.to.is_finite()) {
            (true, true) => *self,
            (true, false) => Self { from: self.from, to: self.from + width },
            (false, true) => Self { from: self.to - width, to: self.to },
            (false, false) => Self { from: -width, to: width },
        }
    }

    /// The parameter at the fraction `u` of the range, `u` from 0 to 1: evenly spread over a finite range, and over an
    /// infinite one by a hyperbolic sine from 1e-9 to 1e4 away from its finite end (or from 0), so that a few hundred
    /// values see small and large shapes alike. Always finite.
    ///
    /// ```
    /// # use rod_contours::Range;
    /// assert_eq!(Range { from: 2.0, to: 4.0 }.at(0.25), 2.5);
    /// assert_eq!(Range::ALL.at(0.5), 0.0);
    /// assert!((Range::ALL.at(1.0) - 1e4).abs() < 1e-6);
    /// ```
    pub fn at(&self, u: f64) -> f64 {
        let away = |u: f64| FINEST * ((REACH / FINEST).asinh() * u).sinh();
        match (self.from.is_finite(), self.to.is_finite()) {
            // Both ends come out exactly.
            (true, true) => self.from * (1.0 - u) + self.to * u,
            (true, false) => self.from + away(u),
            (false, true) => self.to - away(1.0 - u),
            (false, false) => away(2.0 * u - 1.0),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_that_do_not_meet_share_an_end() {
        let range = Range::UNIT;
        let later = Range { from: 3.0, to: 4.0 };
        assert_eq!(range.within(later), Range { from: 1.0, to: 1.0 });
        assert_eq!(Range::ALL.within(later), later);
    }

    #[test]
    fn the_spread_keeps_finite_ends() {
        let half = Range { from: f64::NEG_INFINITY, to: 0.7 };
        assert_eq!(half.at(1.0), 0.7);
        assert_eq!(Range { from: 0.1, to: 0.7 }.at(1.0), 0.7);
        assert_eq!(half.window(2.0).to, 0.7);
    }
}
