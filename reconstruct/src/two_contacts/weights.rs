//! The weights of the two-contact least squares: a standard deviation for each residual, and the reason for it.
//!
//! All numbers are dimensionless (lengths in L, forces in EI/L^2). The reactions need no entry here: their weight is the inverse
//! of their covariance as it was measured. The other weights say how smooth a scan is. The reasons compare them with the eleven
//! stretches of BB and BA in the nine scans of Merker et al. (2020), which were used during development. A smaller standard
//! deviation draws the solution towards the assumption; with a larger one a series oscillates where the conditions hardly
//! determine it.

/// Mean of an arc length before anything is known: the middle of the rod.
pub(super) const MEAN_ARC_LENGTH: f64 = 0.5;
/// Standard deviation of the constant and the linear term of an arc length: the whole rod, hence no restriction.
const FREE_ARC_LENGTH: f64 = 1.0;
/// Standard deviation of the quadratic term of an arc length. Contacts slide along the rod almost uniformly: the term is 0.0063 at
/// most in the nine scans.
const CURVED_ARC_LENGTH: f64 = 0.03;
/// Standard deviation of the constant and the linear term of the first force, relative to 1 + the force at the clamp. They are 0.75
/// and 0.6 at most in the nine scans, but where the two forces nearly cancel each is much larger than that at the clamp.
const FREE_FORCE: f64 = 10.0;
/// Standard deviation of the quadratic term of the first force, relative to the same: 0.21 at most in the nine scans.
const CURVED_FORCE: f64 = 0.3;
/// Factor from each term to the next, from the quadratic one on. The series of a smooth function converges geometrically; this
/// factor allows for a singularity an eighth of the stretch beyond its ends (Bernstein ellipse of parameter 2). In the nine scans
/// terms fall by a factor of 5 and more.
const DECAY: f64 = 0.5;

/// Standard deviation of term `j` of the series of an arc length.
pub(super) fn arc_length_term(j: usize) -> f64 {
    term(j, FREE_ARC_LENGTH, CURVED_ARC_LENGTH)
}

/// Standard deviation of term `j` of the series of the first force, where the clamp bears a force of this size.
pub(super) fn force_term(j: usize, at_clamp: f64) -> f64 {
    term(j, FREE_FORCE, CURVED_FORCE) * (1.0 + at_clamp)
}

fn term(j: usize, free: f64, curved: f64) -> f64 {
    if j < 2 { free } else { curved * DECAY.powi(j as i32 - 2) }
}

/// Standard deviation of the difference of the linear terms of the two arc lengths: half of the difference of the lengths by which
/// the rod slides past its contacts in a stretch. The rod is inextensible and slides past both by nearly the same length: the
/// term is 0.023 at most in the nine scans.
pub(super) const SLIDING: f64 = 0.05;

/// Rounding of a number that goes on unchanged from one stretch to the next.
const CONTINUED: f64 = 1e-6;
/// Rate of an arc length per path length of the clamp, as a standard deviation: 1.1 at most in the nine scans.
const ARC_LENGTH_RATE: f64 = 2.0;
/// Rate of the first force per path length of the clamp, as a standard deviation: 40 in the median of the nine scans, 350 at most,
/// for contacts near the clamp.
const FORCE_RATE: f64 = 50.0;

/// Standard deviation of the change of an arc length over a path length `way` of the clamp; `floor` is the tolerance of the
/// conditions.
pub(super) fn arc_length_step(way: f64, floor: f64) -> f64 {
    (ARC_LENGTH_RATE * way.abs() + CONTINUED).hypot(floor)
}

/// Standard deviation of the change of the first force over a path length `way` of the clamp; `floor` as above.
pub(super) fn force_step(way: f64, floor: f64) -> f64 {
    (FORCE_RATE * way.abs() + CONTINUED).hypot(floor)
}

/// Standard deviation of a place on the contour as a share of the tolerance of the conditions: those contain rates, which are known
/// less well than places.
pub(super) const PLACE_SHARE: f64 = 0.1;
/// Rounding of a place.
const PLACE: f64 = 1e-10;
/// Path length of a contact along the contour per path length of the clamp, at most: 1.2 in the nine scans.
const CONTACT_RATE: f64 = 3.0;
/// Departure of a chord from the mean of the tangents at its ends, over the third power of its length: a twelfth of the rate of the
/// curvature, which is 6.5 at most on the parabolas of the paper.
const CUBIC: f64 = 10.0;

/// Standard deviation of a contact's chord across the contour, over a path length `way` of the clamp, where the place at which it
/// starts has the standard deviation `sigma`.
pub(super) fn chord(way: f64, sigma: f64) -> f64 {
    (sigma * sigma + (PLACE + CUBIC * (CONTACT_RATE * way).abs().powi(3)).powi(2)).sqrt()
}

/// How tightly the conditions are kept. Tight conditions make the least squares stiff: they are tightened from a rough start on.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tolerance {
    /// Standard deviation of a condition as a share of that which the noise of the reactions gives it.
    pub share: f64,
    /// The same absolutely.
    pub floor: f64,
    /// Most steps of the iteration.
    pub steps: usize,
}
