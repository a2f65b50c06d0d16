#![doc = include_str!("../README.md")]

// The modules have the names of the field, not those of the packages.
#[doc(inline)]
pub use rod_contact as contact;
#[doc(inline)]
pub use rod_contours as contour;
#[doc(inline)]
pub use rod_core as rod;
#[cfg(feature = "hw")]
#[doc(inline)]
pub use rod_hw as hw;
#[cfg(feature = "plan")]
#[doc(inline)]
pub use rod_plan as plan;
#[cfg(feature = "reconstruct")]
#[doc(inline)]
pub use rod_reconstruct as reconstruct;

#[cfg(any(doc, doctest))]
pub mod guide;

// What a first program needs. No globs: a name that one package gains cannot clash with that of another.
#[doc(inline)]
pub use rod_contact::{ClampPath, Event, Follower, State, Sweep, equilibrium};
#[doc(inline)]
pub use rod_contours::{Bezier, CircularArc, Composite, Contour, Curve, EllipticArc, Graph, Line, Parabola, Spline};
#[doc(inline)]
pub use rod_core::{Pose, Rod, Sample};
#[cfg(feature = "reconstruct")]
#[doc(inline)]
pub use rod_reconstruct::{Label, Settings, reconstruct};
