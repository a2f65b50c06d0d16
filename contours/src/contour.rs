//! The trait every shape implements.

use std::fmt::Debug;

use crate::nearest::{cuts, search};
use crate::proof::limits;
use crate::{Bounds, Closest, Frame, FrameRate, Range};

/// The border of a solid in the plane, travelled with the solid on its left.
///
/// # For users
///
/// Ask for [`closest`](Self::closest) (one point, everything about it) or [`gap`](Self::gap) (one number). A contour
/// need not be closed. It has no inside beyond its ends: `interior` is false if an end is the nearest point.
///
/// # For shape authors
///
/// Write [`frame`](Self::frame), and [`range`](Self::range) unless it is 0 to 1. Let `frame` continue smoothly a little
/// beyond the range, since iterations step there. Override [`closest_in`](Self::closest_in) and
/// [`bounds_in`](Self::bounds_in) where the shape has a closed form; the other methods call these two. Then put the
/// shape through [`contract::check`](crate::contract::check), which tests these lines under the same numbers
/// (`docs/add-a-shape.md` in the repository goes all the way, with a package to copy):
///
/// 1. The frame is finite everywhere on the range.
/// 2. `dr/dt = speed (cos alpha, sin alpha)`.
/// 3. `d alpha/dt = turning`, and alpha is continuous: it has no jumps, not even by whole turns.
/// 4. `speed >= 0` and `speed + |turning| > 0`.
/// 5. The closest point's `t` lies in the range, its `frame` is `frame(t)`, and `|gap|` is the distance to it.
/// 6. No point of the contour is nearer than the closest point.
/// 7. A small step from the contour against its normal leads outside (gap > 0), along its normal inside (gap < 0).
/// 8. The gap changes no faster than the point moves: always in absolute value, and in sign too along a way on which
///    every closest point is interior.
/// 9. The bounds contain the contour.
/// 10. A contour, or a part between two neighbouring [`cuts`](Self::cuts), that [`is_convex`](Self::is_convex) lies on one
///     side of each of its tangents.
/// 11. [`curvature_in`](Self::curvature_in) contains the curvature everywhere in the range.
/// 12. Where [`closest_is_exact`](Self::closest_is_exact), no point of any part is nearer than the closest point of that
///     part, to rounding.
/// 13. Where [`frame_rate`](Self::frame_rate) knows a parameter, its alpha is the angle by which its point turns the tangent:
///     `normal . d(x, y)/dt = speed alpha`.
///
/// ```
/// use rod_contours::{Contour, Frame, contract};
///
/// /// A disc of radius 1 about the origin, three quarters of it, counterclockwise: the solid is inside.
/// #[derive(Debug)]
/// struct Disc;
///
/// impl Contour for Disc {
///     fn frame(&self, t: f64) -> Frame {
///         let turn = 1.5 * std::f64::consts::PI;
///         let (sin, cos) = (turn * t).sin_cos();
///         let alpha = turn * t + std::f64::consts::FRAC_PI_2;
///         Frame { x: cos, y: sin, alpha, speed: turn, turning: turn }
///     }
/// }
///
/// assert!((Disc.gap(0.0, 3.0) - 2.0).abs() < 1e-14);
/// contract::check(&Disc, &[0.0, 0.3, 0.77, 1.0])?;
/// # Ok::<(), String>(())
/// ```
pub trait Contour: Send + Sync + Debug {
    /// Point, tangent angle and their rates at the parameter `t`, continued smoothly a little beyond the range.
    fn frame(&self, t: f64) -> Frame;

    /// The values of the parameter that belong to the contour; by default 0 to 1.
    fn range(&self) -> Range {
        Range::UNIT
    }

    /// The point of the contour nearest to `(x, y)`; of several, one.
    fn closest(&self, x: f64, y: f64) -> Closest {
        self.closest_in(self.range(), x, y)
    }

    /// The nearest point of the part of the contour in `range`, whose ends count as the ends of the contour.
    ///
    /// By default the range is cut into 96 equal cells (an infinite one into 512 unequal ones, see [`Range::at`]) and
    /// in each cell where the distance turns from falling to rising the minimum is refined to rounding by a safeguarded
    /// Newton iteration on `(r - p) . tangent = 0`. A part of a finite contour gets its share of the 96 cells, at least
    /// 2, so that a short part costs little. What this misses are several nearest points within one cell: cut such a
    /// shape into pieces, or override the method. A point that is not finite gives a gap that is not finite.
    fn closest_in(&self, range: Range, x: f64, y: f64) -> Closest {
        search::closest(|t| self.frame(t), self.range(), range, x, y)
    }

    /// Signed distance of the point `(x, y)` from the contour, a length: positive outside the solid.
    fn gap(&self, x: f64, y: f64) -> f64 {
        self.closest(x, y).gap
    }

    /// A box that contains the contour.
    fn bounds(&self) -> Bounds {
        self.bounds_in(self.range())
    }

    /// A box that contains the part of the contour in `range`.
    ///
    /// By default the box of 97 samples, widened cell by cell by what the change of `dr/dt` across the cell allows the
    /// curve to leave its chord, times two; the whole plane for an infinite range.
    fn bounds_in(&self, range: Range) -> Bounds {
        search::bounds(|t| self.frame(t), range)
    }

    /// Parameters inside `range`, in order, that part it into simple arcs: each bends one way only (no inflection
    /// inside) and turns by at most a right angle, so that a small piece of a rod meets it once.
    ///
    /// By default the sign of the turning at 97 samples shows the inflections, each refined by bisection; what turns by
    /// more between two of them is parted evenly by angle. Two inflections within one cell go unseen, and a range that
    /// is infinite is not parted. A shape whose closest points are exact on any arc may return none.
    fn cuts(&self, range: Range) -> Vec<f64> {
        cuts::from_samples(|t| self.frame(t), range)
    }

    /// Whether the whole part in `range` lies on one side of each of its tangents. A point on the outer side of the
    /// tangent at its closest point is then outside of the whole part.
    ///
    /// By default false: then the sense of bending is taken from samples, and gaps to the part are not proven. Returning true
    /// wrongly makes a sweep miss contacts.
    fn is_convex(&self, range: Range) -> bool {
        let _ = range;
        false
    }

    /// The least and the largest signed curvature `d alpha/ds = turning / speed` over a range, one over a length: positive
    /// where the contour bends to the left, toward the solid. These are bounds: every value lies between them, and
    /// the shorter the range, the closer they are to the true least and largest value.
    ///
    /// By default minus infinity and infinity, which is no bound. Finite bounds let a solver prove that a rod stays
    /// outside; with wrong bounds its proofs are wrong.
    fn curvature_in(&self, range: Range) -> (f64, f64) {
        let _ = range;
        limits::ANY_CURVATURE
    }

    /// Whether [`closest_in`](Self::closest_in) always gives the true nearest point, to rounding, and
    /// [`cuts`](Self::cuts), [`bounds_in`](Self::bounds_in) and [`is_convex`](Self::is_convex) are proven: by a closed form, or
    /// by a search that isolates every minimum.
    ///
    /// By default false, since the default search only looks at samples. A solver can prove that a rod stays outside only
    /// of a contour that says true.
    fn closest_is_exact(&self) -> bool {
        false
    }

    /// How the frame at `t` changes with a parameter of the shape, given by its name, at this fixed `t`; `None` if the shape has
    /// no such parameter.
    ///
    /// By default `None`. With the rate a solver computes the derivatives of its results by the parameter. The rate is exact, not a
    /// difference. The names are the shape's own and belong to its documentation. Where the range depends on the parameter, a
    /// composite takes an inner end for the point where the two pieces, continued, cross.
    fn frame_rate(&self, t: f64, parameter: &str) -> Option<FrameRate> {
        let _ = (t, parameter);
        None
    }

    /// The parts of the contract that need no test when the shape becomes a piece of a composite. For shapes of this crate alone:
    /// others cannot name the argument, and are tested.
    #[doc(hidden)]
    fn trust(&self, _: Seal) -> Trust {
        Trust::NONE
    }
}

/// Properties that a shape has by construction. [`Contour::trust`](crate::Contour::trust) returns them.
#[derive(Clone, Copy, Debug)]
pub struct Trust {
    /// Its methods keep the contract.
    pub(crate) contract: bool,
    /// It does not cross itself.
    pub(crate) simple: bool,
}

impl Trust {
    /// No property is known: a shape from outside this crate.
    pub(crate) const NONE: Self = Self { contract: false, simple: false };
    /// Its methods are tested here, its data may let it cross itself.
    pub(crate) const TESTED: Self = Self { contract: true, simple: false };
    /// The same, and no data let it cross itself.
    pub(crate) const SIMPLE: Self = Self { contract: true, simple: true };
}

/// An argument that no other crate can name, so that no other crate can write the method that takes it.
#[derive(Clone, Copy, Debug)]
pub struct Seal(pub(crate) ());

/// A shape behind a pointer, or another thing with a `Deref` to it, is that shape.
macro_rules! behind_pointer {
    ($($head:tt)*) => {
        $($head)* {
            fn frame(&self, t: f64) -> Frame {
                (**self).frame(t)
            }

            fn range(&self) -> Range {
                (**self).range()
            }

            fn closest(&self, x: f64, y: f64) -> Closest {
                (**self).closest(x, y)
            }

            fn closest_in(&self, range: Range, x: f64, y: f64) -> Closest {
                (**self).closest_in(range, x, y)
            }

            fn gap(&self, x: f64, y: f64) -> f64 {
                (**self).gap(x, y)
            }

            fn bounds(&self) -> Bounds {
                (**self).bounds()
            }

            fn bounds_in(&self, range: Range) -> Bounds {
                (**self).bounds_in(range)
            }

            fn cuts(&self, range: Range) -> Vec<f64> {
                (**self).cuts(range)
            }

            fn is_convex(&self, range: Range) -> bool {
                (**self).is_convex(range)
            }

            fn curvature_in(&self, range: Range) -> (f64, f64) {
                (**self).curvature_in(range)
            }

            fn closest_is_exact(&self) -> bool {
                (**self).closest_is_exact()
            }

            fn frame_rate(&self, t: f64, parameter: &str) -> Option<FrameRate> {
                (**self).frame_rate(t, parameter)
            }

            fn trust(&self, seal: Seal) -> Trust {
                (**self).trust(seal)
            }
        }
    };
}

pub(crate) use behind_pointer;

behind_pointer!(impl<C: Contour + ?Sized> Contour for Box<C>);
