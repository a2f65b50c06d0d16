//! What can be wrong with a sweep, and how one can end before its path does.

use rod_core::Pose;

/// Largest clamp angle, rad, either way: 16 turns. No clamp of an experiment turns further; 90 degrees given for radians
/// passes with a warning, 180 does not. A larger limit would let more such mistakes pass.
pub const LARGEST_ANGLE: f64 = 100.0;

/// Errors in what a sweep is asked to do.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ContactError {
    /// A name that is none of a phase.
    #[error("no phase is called {name:?}, expected free, A, B, BA, BB, ...")]
    Phase {
        /// The name.
        name: String,
    },
    /// A quantity that must be finite is not.
    #[error("{what} is {value}, expected a finite number")]
    NotFinite {
        /// Which quantity.
        what: &'static str,
        /// Its value as given.
        value: f64,
    },
    /// A clamp that has turned so far that its angle is taken for a mistake.
    #[error("{what} is {value} rad, expected at most {LARGEST_ANGLE} rad either way")]
    Angle {
        /// Which angle.
        what: &'static str,
        /// Its value as given, rad.
        value: f64,
    },
    /// The path leads nowhere.
    #[error("the path leads nowhere from ({}, {}) m and {} rad, expected two different poses", pose.x, pose.y, pose.phi)]
    NoPath {
        /// The pose given twice.
        pose: Pose,
    },
    /// A guess of a contact that cannot be.
    #[error("contact {index}: {reason}")]
    Guess {
        /// Number of the contact, from 0 at the clamp.
        index: usize,
        /// What is wrong with it.
        reason: &'static str,
    },
    /// A path without legs, or through fewer than two poses.
    #[error("the path has no legs, expected one leg or two poses at least")]
    NoLegs,
    /// A leg does not begin where the one before ends.
    #[error(
        "leg {leg} starts at ({}, {}) m and {} rad, but the one before ends at ({}, {}) m and {} rad, expected the same pose",
        starts.x, starts.y, starts.phi, ends.x, ends.y, ends.phi
    )]
    Apart {
        /// Number of the leg, from 0.
        leg: usize,
        /// Where the leg before ends.
        ends: Pose,
        /// Where it starts.
        starts: Pose,
    },
    /// A sweep that goes on from a state begins at another pose.
    #[error(
        "the path starts at ({}, {}) m and {} rad, the state's clamp is at ({}, {}) m and {} rad, expected the same pose",
        path.x, path.y, path.phi, state.x, state.y, state.phi
    )]
    Elsewhere {
        /// Where the path starts.
        path: Pose,
        /// Where the clamp is in the state.
        state: Pose,
    },
    /// A state is none of this rod on these objects.
    #[error("the state is no equilibrium of this rod on these objects: {reason}; expected a state of a sweep of them")]
    NotEquilibrium {
        /// What is wrong with it.
        reason: &'static str,
    },
    /// A state where the equilibrium ends, or so near to it that derivatives have no digits.
    #[error(
        "the equilibrium has no derivatives: it is at a fold, or two contacts hold the rod at one place \
         (condition number {condition:e}); take a state before it, or the derivatives of the pose of the event"
    )]
    Fold {
        /// Condition number of the equations.
        condition: f64,
    },
    /// A rod that runs through a roller, of which there are no derivatives by quantities.
    #[error("there are no derivatives of a rod that runs through a roller, expected a rod on a clamp without one")]
    Roller,
    /// Derivatives of a state in which a contact sticks.
    #[error(
        "contact {index} sticks: where it is depends on how it came there, so that it has no derivatives; \
         take a state in which all contacts slip"
    )]
    Sticks {
        /// Number of the contact, from 0 at the clamp.
        index: usize,
    },
    /// A quantity that does not exist.
    #[error("there is no {what}")]
    NoQuantity {
        /// Which quantity.
        what: String,
    },
    /// A transition whose pose no single equation defines.
    #[error(
        "no single regular equation defines the pose of this {event}; differentiate the states on either side of it"
    )]
    NoCondition {
        /// The kind of the transition, by its name.
        event: String,
    },
    /// The rate of a path is not the derivative of its pose by the path's parameter.
    #[error(
        "the rate of {what} of the path is {rate} at the parameter {t}, expected {difference}, by differences of its poses"
    )]
    Rate {
        /// Of x, y (m per unit of the parameter) or the angle (rad).
        what: &'static str,
        /// The parameter.
        t: f64,
        /// The rate as given.
        rate: f64,
        /// The rate by differences.
        difference: f64,
    },
    /// A path has another number of legs than there are steps.
    #[error("there are {steps} steps for a path of {legs} legs, expected one for each leg")]
    Steps {
        /// Number of steps as given.
        steps: usize,
        /// Number of legs of the path.
        legs: usize,
    },
    /// A coefficient of friction that cannot be, or one of an object that there is not.
    #[error("object {object} has the coefficient of friction {value}, expected {expected}")]
    Friction {
        /// Number of the object, from 0.
        object: usize,
        /// The coefficient as given.
        value: f64,
        /// What was expected of it.
        expected: String,
    },
    /// The distance between reported states is no distance, or so small that the path has more than 1e15 of them.
    #[error("step is {value:?}, expected a positive, finite length, not below 1e-15 of the path")]
    Step {
        /// Its value as given.
        value: f64,
    },
}

/// Why a sweep could not go on. Everything before it stands.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Stop {
    /// Where the clamp was.
    pub pose: Pose,
    /// Way along the path so far (m, or radians for a path that only turns).
    pub tau: f64,
    /// Why.
    pub reason: StopReason,
}

/// Why a sweep could not go on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum StopReason {
    /// No equilibrium was found for the first pose of the path.
    NoStart,
    /// The equilibrium could not be followed: also the smallest step met an obstacle.
    StepTooSmall(Obstacle),
    /// The rod snaps, and no stable equilibrium was found for it to land in.
    NoLanding,
    /// A contact ran off the end of an open contour, or the rod came upon such an end from the side.
    EndOfContour,
    /// The rod is bent around the contour so tightly that it touches along a line, not at a point.
    LineContact,
    /// The tip slides along one object into another one that overlaps it: the notch between them belongs to no contour.
    BetweenObjects,
    /// The clamp itself runs into the object, or is inside it in the first pose.
    ClampInside,
    /// The rod comes upon an object between its clamp and the roller ahead of that, or a contact slides to there.
    BeforeRoller,
    /// The objects have friction, and the rod runs through a roller: this is not computed.
    RollerFriction,
    /// More events at one pose than a rod can have.
    Chatter,
    /// The pose to go to has a number that is not finite, or an angle beyond [`LARGEST_ANGLE`].
    NoPose,
    /// The straight rod is pushed on against an object, along its axis or at an angle to it, and friction holds its tip: it carries any force
    /// until it buckles.
    Jammed,
    /// Friction allows two motions of the contacts that hold for as long, or there are more than six contacts.
    Undetermined,
    /// The contact stays on the smooth border of a rougher piece: on that piece the rod would roll back, on the other one slip forward. The
    /// force along the contour is between the limits of the two, and is not computed.
    RougherPiece,
    /// The rod lies down on a wall of a notch, which is only followed without friction.
    FrictionInNotch,
    /// The steps that the sweep may take are used up ([`Sweep::with_most_steps`](crate::Sweep::with_most_steps)).
    StepBudget,
    /// The rod jumps, and was to be followed no further ([`Follower::without_jumps`](crate::Follower::without_jumps)).
    Jump,
}

/// Why a step along a branch of equilibria is refused, and tried at half its length.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum Obstacle {
    /// Newton's method did not converge, or to a point too far from the predicted one.
    NotConverged,
    /// The branch turns by more than 26 degrees within the step.
    Turns,
    /// The rod goes through an object, and no first contact with it was located within the step.
    Touch,
    /// A condition of the contact set is broken, and where it broke was not located within the step.
    NotLocated,
    /// The rod or its tip would pass over a thin object.
    PassesOver,
    /// The next equilibrium is not stable, and no fold was located.
    Unstable,
}

impl Obstacle {
    /// Whether the rod goes through an object, where that is known.
    pub(crate) fn touches(self) -> Option<bool> {
        match self {
            Self::NotConverged | Self::Turns => None,
            Self::Touch => Some(true),
            Self::NotLocated | Self::PassesOver | Self::Unstable => Some(false),
        }
    }
}

impl std::fmt::Display for Obstacle {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::NotConverged => "Newton's method does not converge",
            Self::Turns => "the branch turns too sharply",
            Self::Touch => "a new contact cannot be located",
            Self::NotLocated => "a transition cannot be located",
            Self::PassesOver => "the rod would pass over a thin object",
            Self::Unstable => "the equilibrium loses its stability",
        })
    }
}

/// A name in small letters with hyphens, such as `no-landing`.
impl std::fmt::Display for StopReason {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(match self {
            Self::NoStart => "no-start",
            Self::StepTooSmall(_) => "step-too-small",
            Self::NoLanding => "no-landing",
            Self::EndOfContour => "end-of-contour",
            Self::LineContact => "line-contact",
            Self::BetweenObjects => "between-objects",
            Self::ClampInside => "clamp-inside",
            Self::BeforeRoller => "before-roller",
            Self::RollerFriction => "roller-friction",
            Self::Chatter => "chatter",
            Self::NoPose => "no-pose",
            Self::Jammed => "jammed",
            Self::Undetermined => "undetermined",
            Self::RougherPiece => "rougher-piece",
            Self::FrictionInNotch => "friction-in-notch",
            Self::StepBudget => "step-budget",
            Self::Jump => "jump",
        })
    }
}

impl std::fmt::Display for Stop {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Pose { x, y, phi } = self.pose;
        write!(f, "the sweep stopped at clamp ({x:.9}, {y:.9}) m, {phi:.9} rad: ")?;
        let why = match self.reason {
            StopReason::NoStart => "no equilibrium found for the first pose; start where the rod is free",
            StopReason::StepTooSmall(obstacle) => {
                return write!(
                    f,
                    "the equilibrium could not be followed, {obstacle}; look at the last states, or start beyond"
                );
            }
            StopReason::NoLanding => "the rod snaps and no stable equilibrium was found; start a new sweep beyond",
            StopReason::EndOfContour => {
                "the rod came to the end of an open contour; make the contour longer, or close it"
            }
            StopReason::LineContact => {
                "the rod wraps around the contour and would touch it along a line; end the path before it"
            }
            StopReason::BetweenObjects => {
                "the tip is caught between two objects that overlap; join them into one contour, or take one of them away"
            }
            StopReason::ClampInside if self.tau == 0.0 => {
                "the clamp is inside an object in the first pose; start with the clamp outside of all objects"
            }
            StopReason::ClampInside => "the clamp itself runs into the object; end the path before it",
            StopReason::BeforeRoller => {
                "the rod comes upon an object between the clamp and its roller; end the path before it, or put the roller nearer to the clamp"
            }
            StopReason::RollerFriction => {
                "the friction of a rod that runs through a roller is not computed; take away the friction or the roller"
            }
            StopReason::NoPose => {
                "the pose to go to has a number that is not finite, or an angle beyond 100 rad; give m, m and rad"
            }
            StopReason::Jammed => {
                "the rod is pushed on against an object and friction holds its tip; move the clamp across the rod, or lower the friction"
            }
            StopReason::Undetermined => {
                "friction leaves the motion of the contacts undetermined; start a new sweep beyond, or lower the friction"
            }
            StopReason::RougherPiece => {
                "the side of the rod stays on the border of a rougher piece, between slipping and rolling back, which is not computed; give both pieces the same friction, or start a new sweep beyond"
            }
            StopReason::FrictionInNotch => {
                "the rod lies down in a notch, which is only followed without friction; end the path before it"
            }
            StopReason::StepBudget => "the sweep has taken all the steps it may take; allow more, or sweep in parts",
            StopReason::Jump => "the rod jumps; follow it without `without_jumps` to see where it lands",
            StopReason::Chatter => "contacts come and go at one pose without end; start a new sweep beyond",
        };
        f.write_str(why)
    }
}

impl std::error::Error for Stop {}
