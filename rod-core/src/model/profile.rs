//! How stiffness and natural curvature of a rod vary along it.

/// Bending stiffness and natural curvature along a rod, dimensionless: s from 0 (clamp) to 1 (tip), stiffness in that at the clamp,
/// curvature in 1/L. [`Smooth`](crate::Smooth) makes a rod of it.
///
/// Both are smooth, analytic at best, except at borders that [`Smooth::with_borders`](crate::Smooth::with_borders) is told. They are
/// asked for within a rod only, never at a border itself.
///
/// ```
/// use rod_core::{Profile, Smooth};
/// /// A tube that is clamped at its thick end and bent more and more at rest.
/// struct Tube;
/// impl Profile for Tube {
///     fn stiffness(&self, s: f64) -> f64 { 1.0 - 0.5 * s }
///     fn natural_curvature(&self, s: f64) -> f64 { 0.3 + s * s }
/// }
/// let rod = Smooth::new(Tube)?;
/// # Ok::<(), rod_core::RodError>(())
/// ```
pub trait Profile {
    /// Bending stiffness at arc length `s`, positive.
    fn stiffness(&self, s: f64) -> f64;

    /// Curvature at rest at arc length `s`: 0 unless it says otherwise.
    fn natural_curvature(&self, _s: f64) -> f64 {
        0.0
    }

    /// Whether the stiffness nowhere grows, or nowhere falls, between two borders: false unless it says otherwise. On it rest proofs, which
    /// are sharper and cheaper where it is so: then the least stiffness of a part is at one of its ends.
    fn is_monotonic(&self) -> bool {
        false
    }
}

/// A cone: the diameter falls linearly, E I = (1 - `taper` s)^4, as a whisker's does (its tip has 1 - `taper` of the diameter at the
/// clamp). A negative taper makes the tip the thick end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    /// 1 - diameter at the tip / diameter at the clamp, less than 1.
    pub taper: f64,
}

impl Profile for Cone {
    #[inline(always)]
    fn stiffness(&self, s: f64) -> f64 {
        let square = (1.0 - self.taper * s) * (1.0 - self.taper * s);
        square * square
    }
    #[inline(always)]
    fn is_monotonic(&self) -> bool {
        true
    }
}

/// A profile with the natural curvature of a function of s.
///
/// ```
/// use rod_core::{Bent, Cone, Profile, Smooth};
/// let whisker = Smooth::new(Bent::new(Cone { taper: 0.8 }, |s| 0.5 + s))?;
/// # Ok::<(), rod_core::RodError>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Bent<P, K> {
    straight: P,
    natural_curvature: K,
}

impl<P: Profile, K: Fn(f64) -> f64> Bent<P, K> {
    /// The stiffness of one profile, and a natural curvature in place of its own.
    pub fn new(straight: P, natural_curvature: K) -> Self {
        Self { straight, natural_curvature }
    }
}

impl<P: Profile, K: Fn(f64) -> f64> Profile for Bent<P, K> {
    #[inline(always)]
    fn stiffness(&self, s: f64) -> f64 {
        self.straight.stiffness(s)
    }
    #[inline(always)]
    fn natural_curvature(&self, s: f64) -> f64 {
        (self.natural_curvature)(s)
    }
    #[inline(always)]
    fn is_monotonic(&self) -> bool {
        self.straight.is_monotonic()
    }
}

/// A closure is the stiffness of a rod that is straight at rest.
impl<F: Fn(f64) -> f64> Profile for F {
    #[inline(always)]
    fn stiffness(&self, s: f64) -> f64 {
        self(s)
    }
}
