//! The limits of the sweep: lengths, tolerances and budgets of the continuation and of what happens between two branches.
//!
//! Lengths are in L, forces in E I / L^2, angles in rad. Arclength is that of the branch: lengths, angles and forces relative to
//! 4 (1 + force) together (`Tangent`). Where a field names no source (rounding, the order of an error, a time), its value is a choice, and
//! the field states the effect of another one. Constants of one formula or one search stay beside it.

/// All limits of continuation and sweep.
pub(crate) struct Limits {
    pub step: StepLimits,
    pub end: EndLimits,
    pub transition: TransitionLimits,
    pub course: CourseLimits,
    pub merge: MergeLimits,
    pub probe: ProbeLimits,
    pub resume: ResumeLimits,
    pub start: StartLimits,
    pub snap: SnapLimits,
    pub sweep: SweepLimits,
}

/// One step along a branch.
pub(crate) struct StepLimits {
    /// First step on a new branch, arclength. Larger: more rejected steps. Smaller: more steps until the length has doubled often enough.
    pub first: f64,
    /// Longest step, arclength. Larger: more rejected steps, and contacts that begin and end within a step may be missed. Smaller: more steps.
    pub longest: f64,
    /// Longest change of the path parameter in a step of a rod in contact, L. Larger and smaller as `longest`.
    pub longest_way: f64,
    /// Longest way of a free rod in a step beyond its proven gap, L. A contact that begins and ends within it is missed. Smaller: more
    /// steps beside an object.
    pub longest_free: f64,
    /// Shortest step, arclength. Where it is rejected too, the sweep stops with `StepTooSmall`. Larger: sweeps stop earlier. Smaller: the
    /// difference of two points is rounding.
    pub shortest: f64,
    /// Largest distance of the corrected from the predicted point, over the length of the step. Larger: the point may be on another branch.
    /// Smaller: more rejected steps.
    pub largest_correction: f64,
    /// Distance of the corrected from the predicted point that is rounding, whatever the length of the step: 1e4 times the tolerance of Newton's
    /// method. Smaller: the shortest steps are rejected.
    pub correction_rounding: f64,
    /// Largest residual of a solution, L and rad. Newton's method scales its own tolerance by the forces; this limits it. Larger: less exact
    /// states are accepted. Smaller: sweeps under large forces stop.
    pub largest_residual: f64,
    /// Least cosine of the angle between the tangents at both ends of a step: 26 degrees. Larger: more rejected steps. Smaller: the end of a
    /// step may be on another branch.
    pub least_cosine: f64,
    /// Least d tau / d arclength at which a step aims at a pose. Smaller: it aims there closer to a fold, where the pose is
    /// ill-conditioned. Larger: it goes past the pose and comes back more often.
    pub least_tau_rate: f64,
    /// Difference of the path parameters of two poses that count as one: rounding. A pose so little beyond a transition reports the state before
    /// it.
    pub same_pose: f64,
    /// Newton iterations from a point of the same branch. A step that needs more has left the branch. Larger: rejected steps cost
    /// more.
    pub most_iterations: u32,
    /// Newton iterations from a guess. Smaller: fewer guesses are solved.
    pub most_iterations_from_guess: u32,
    /// Distance behind a joint of the rod at which a contact counts as being on its other side, L: above the rounding of a solved arc length.
    pub behind_joint: f64,
}

/// The checks that end a branch.
pub(crate) struct EndLimits {
    /// Length of a step, arclength, below which the end of a contour, or the clamp at an object, that the step meets is accepted as the end of the
    /// sweep. A longer step is halved first. Larger: the sweep stops further before the end. Smaller: more rejected steps.
    pub short_step: f64,
    /// Arc length below which a contact counts as at the clamp, where its force has no lever. Smaller: the force grows with the
    /// inverse of it, and with it its error.
    pub at_clamp: f64,
    /// The same beyond a roller.
    pub at_roller: f64,
    /// Arc length beyond a roller within which a contact is taken for the reason that the branch cannot be followed any more.
    pub near_roller: f64,
    /// Depth of a free rod that is above the rounding of a gap. A deeper one has come around the end of an open contour.
    pub deepest_free: f64,
    /// Length of a step, arclength, below which it is not tested for objects that it passes over. A thinner object than that is not met.
    pub least_swept: f64,
    /// Distance of the tip from two objects below which it counts as caught between them.
    pub between_objects: f64,
    /// Distances (arclength) from a point, tried in order, at which the end of its branch is looked for where stability is lost.
    pub ahead: [f64; 5],
}

/// Transitions and how they are located.
pub(crate) struct TransitionLimits {
    /// Rounding of arc lengths (L), parameters and angles (rad) at their limits. Smaller: transitions by rounding.
    pub rounding: f64,
    /// Rounding of the arc length of a contact at the tip, L.
    pub at_tip: f64,
    /// Largest distance of a new contact beyond the end of its stretch, relative. A larger one means that its neighbour was met first.
    pub beyond_stretch: f64,
    /// Distance (L) from the tip at which the contact on one wall of a notch counts as met by the tip on the other.
    pub meeting: f64,
    /// Force of a tip that comes to a notch on the one wall, the rod lying on the other one, below which it counts as zero: there it vanishes but
    /// for rounding.
    pub unloaded_tip: f64,
    /// Arclength within which transitions coincide: rounding. The one next to the clamp is taken.
    pub at_once: f64,
    /// Arclength by which a located transition may be outside of its step: this, and the share `relative_slack` of the step. Larger: a
    /// transition of another step may be taken. Smaller: more rejected steps.
    pub slack: f64,
    pub relative_slack: f64,
    /// Arclength by which a touch may lie before the start of the step. The proof at the start leaves a depth of 1e-12 L open, which
    /// a slowly closing gap takes so long to pass.
    pub touch_slack: f64,
    /// Tolerance of a fold, arclength. The path parameter is stationary there, so that its error is about the square of this.
    pub fold: f64,
    /// Path parameter by which a fold may be before the start of the step, because a step may begin at one.
    pub same_fold: f64,
}

/// Conditions that hold at both ends of a step and are violated in between.
pub(crate) struct CourseLimits {
    /// Largest value below zero, relative to 1 + its values at the ends, of the cubic or its slope: about the error of a cubic on a step.
    /// Larger: violations are passed over. Smaller: more rejected steps.
    pub error: f64,
    /// Clearance (1 / L) above which it does not vanish within a step at whose ends it is about the same, unless the contour has a hollow
    /// between them. Larger: more evaluations of it. Smaller: a line contact may be missed.
    pub large_clearance: f64,
    /// Ratio of the contour's curvature halfway to that at the ends below which there is such a hollow.
    pub flatter: f64,
    /// Least clearance within a step, over the larger one at its ends, above which the tangents at the ends exclude a line contact. Larger: more
    /// rejected steps. Smaller: a line contact may be missed.
    pub least_clearance: f64,
}

/// Contacts that become one, and one that becomes two.
pub(crate) struct MergeLimits {
    /// Distance (L) of two contacts on one piece below which they are tried as one. The equations of both lose digits with the third power of
    /// the distance. Larger: the transition comes too early. Smaller: it is lost in rounding.
    pub close: f64,
    /// Ways along the path (L), tried in order, after which the one holds. The distance of two contacts falls with the root of the way that is
    /// left.
    pub ways: [f64; 7],
    /// Distance (L) from the notch at which a contact that slides along its wall to a tip in it counts as about to arrive. The equations
    /// of the two lose digits with the third power of it.
    pub at_notch: f64,
    /// Distance (L) of two contacts beside an inflection from which they are solved for, and below which they are merged. Their forces have
    /// an error of rounding over the third power of it.
    pub at_inflection: f64,
    /// Multiples of that distance, tried in order.
    pub multiples: [f64; 4],
    /// Arc length (L) to either side of the last contact in which an inflection is searched.
    pub search: f64,
    /// Longest way of the path (L) on which the two contacts come so far apart, or together. A longer one is another transition.
    pub longest_way: f64,
    /// Distance (L) from the inflection at which one contact replaces two. On the inflection itself the problem is singular.
    pub beside_inflection: f64,
}

/// Whether the sweep can go on with a new contact set.
pub(crate) struct ProbeLimits {
    /// Way along the path, L, within which the next transition is taken to follow at once; also the longest of `ways`.
    pub way: f64,
    /// Ways along the path, L, longest first: the contact set must hold after one of them. With a shorter one last, contact sets are accepted
    /// by rounding; with fewer, a rod snaps whose next transition follows closely.
    pub ways: [f64; 3],
    /// The same with friction. A contact with hardly any sticks for a short way only; its force changes so fast that a longer probe fails, and
    /// a shorter one tells rounding.
    pub rubbing_ways: [f64; 5],
    /// Longest way along the branch, arclength. Near a fold the pose hardly moves, and a small step of the branch is small enough.
    pub longest: f64,
}

/// A sweep that goes on from a state.
pub(crate) struct ResumeLimits {
    /// Residual (L, rad) up to which the unknowns of a state stay as they are. One more solve would not improve them, and at a fold,
    /// where the pose alone is ill-conditioned, it would move them.
    pub solved: f64,
    /// Residual up to which they are taken where a solve fails, as it does at a fold. The sweep accepts states with as much
    /// (`StepLimits::largest_residual`).
    pub nearly_solved: f64,
    /// Largest distance (t, s in L; angles in rad; forces relative to 1 + force) between the unknowns of a state and the solution. A
    /// larger one means that the state belongs to another rod or other objects.
    pub same_state: f64,
    /// Largest distance (lengths of the rod plus radians) between the first pose of a path and the pose of the state: the rounding of poses
    /// that were written to a file.
    pub same_pose: f64,
    /// Pulling force up to which a state counts as an equilibrium.
    pub pull: f64,
    /// Least d tau / d arclength at which the tangent of a stable equilibrium is known to lead along the path. Nearer to a fold its
    /// sense is rounding.
    pub least_tau_rate: f64,
}

/// The first equilibrium of a rod in contact.
pub(crate) struct StartLimits {
    /// Bends (rad over the length) given to a straight rod that is let go into contact. Without a bend the chain does not buckle; its
    /// sign decides to which side.
    pub bends: [f64; 4],
    /// Range of the search for a free pose behind a start in contact, in the path parameter (L; half a turn where the clamp only turns), and its
    /// step (L or rad). A larger range takes longer where there is no such pose.
    pub farthest_back: f64,
    pub step_back: f64,
    /// Way (L or rad) along its own path from the nearest free pose up to which a rod in contact is taken to have come that way, whatever its
    /// energy: a straight rod passes a point within two lengths. From further back it may have been rolled up on the way.
    pub own_path: f64,
    /// Relative difference of energies that is rounding, as of an equilibrium and its mirror image: then the approach tried first counts.
    pub same_energy: f64,
}

/// Where a rod lands whose equilibrium has ended.
pub(crate) struct SnapLimits {
    /// Distances (path parameter, L) beyond a fold at which the descent starts, tried in order. The chain has its own fold, up to the
    /// square of a link's length away, and must be beyond it. A longer distance may miss an equilibrium that ends soon.
    pub ahead: [f64; 4],
    /// The same beyond the first touch of a free rod along a straight edge, which has no isolated solution.
    pub ahead_of_touch: [f64; 2],
    /// Bend (rad over the length) given to a straight rod that is met head-on: without one the chain does not buckle.
    pub bend: f64,
    /// Way (path parameter, L) behind the first touch of a flat contour at which the contact begins: its force is about this times 3 E I / L^2.
    pub flat_way: f64,
    /// Force above which the contact there is one of a rod that is pushed along its axis.
    pub flat_force: f64,
    /// Difference of the curvatures of contour and rod (1 / L) at a contact below which the rod touches along a line.
    pub flat_clearance: f64,
    /// Longest way (L) of a tip that slips over a corner. A longer way is reported as a snap.
    pub farthest_slip: f64,
    /// Shortest way (L) of a tip that slips over a corner. A shorter one would lead back at once.
    pub shortest_slip: f64,
    /// Change of an unknown, relative to 1 + its size, below which two configurations are the same equilibrium.
    pub same: f64,
    /// Gain of energy (E I / L), relative to 1 + the energy, that is rounding. Energies of two solutions at one pose agree to 1e-13.
    pub energy_rounding: f64,
    /// First, longest and shortest step (arclength) along the branch to its next fold. The shortest one that fails ends the search.
    pub first_step: f64,
    pub longest_step: f64,
    pub shortest_step: f64,
    /// Steps along the branch to its next fold.
    pub most_steps: usize,
}

/// The sweep as a whole.
pub(crate) struct SweepLimits {
    /// Steps along branches, rejected ones included: one to two minutes. A sweep of the paper takes about 50. `Sweep::with_most_steps`
    /// changes it.
    pub most_steps: u64,
    /// Reported states on a leg. With more, neighbouring poses differ by less than the rounding of the path parameter.
    pub most_states: f64,
    /// Way (path parameter) by which a transition at the last pose of a path may be beyond it: the error of a located transition. The
    /// state after it is that of the last pose.
    pub at_end: f64,
    /// Transitions in sequence at one pose. A rod that comes to lie on the edges of a comb needs several; more are a contact
    /// that comes and goes by rounding. Smaller: `Chatter` on combs.
    pub most_at_one_pose: usize,
    /// Path parameter by which transitions at one pose differ at most.
    pub one_pose: f64,
    /// Distance (L) from an end of an open contour. Where contacts come and go closer to it, the sweep stops with `EndOfContour`,
    /// farther away with `Chatter`.
    pub at_open_end: f64,
    /// Change of a force along the contour, relative to 1 + normal force, above which an equilibrium is solved anew.
    pub friction_change: f64,
}

/// Longest way along the path of a probe, L.
const PROBE: f64 = 1e-6;

/// The limits of every sweep.
pub(crate) const LIMITS: Limits = Limits {
    step: StepLimits {
        first: 0.02,
        longest: 0.3,
        longest_way: 0.05,
        longest_free: 2e-3,
        shortest: 1e-9,
        largest_correction: 0.3,
        correction_rounding: 1e-9,
        largest_residual: 1e-9,
        least_cosine: 0.9,
        least_tau_rate: 1e-3,
        same_pose: 1e-13,
        most_iterations: 12,
        most_iterations_from_guess: 60,
        behind_joint: 1e-11,
    },
    end: EndLimits {
        short_step: 1e-3,
        at_clamp: 1e-4,
        at_roller: 1e-2,
        near_roller: 6e-2,
        deepest_free: 1e-9,
        least_swept: 1e-8,
        between_objects: 1e-6,
        ahead: [1e-6, 1e-5, 1e-4, 1e-3, 1e-2],
    },
    transition: TransitionLimits {
        rounding: 1e-13,
        at_tip: 1e-12,
        beyond_stretch: 1e-12,
        meeting: 1e-7,
        unloaded_tip: 1e-7,
        at_once: 1e-12,
        slack: 1e-9,
        relative_slack: 1e-6,
        touch_slack: 1e-6,
        fold: 1e-13,
        same_fold: 1e-10,
    },
    course: CourseLimits { error: 1e-6, large_clearance: 1.0, flatter: 0.9, least_clearance: 0.1 },
    merge: MergeLimits {
        close: 4e-3,
        ways: [0.0, 1e-7, 3e-7, 1e-6, 3e-6, 1e-5, 3e-5],
        at_notch: 2e-3,
        at_inflection: 0.01,
        multiples: [1.0, 2.0, 4.0, 8.0],
        search: 0.02,
        longest_way: 0.05,
        beside_inflection: 1e-4,
    },
    probe: ProbeLimits {
        way: PROBE,
        ways: [PROBE, 1e-8, 1e-10],
        rubbing_ways: [PROBE, 1e-7, 1e-8, 1e-10, 1e-12],
        longest: 1e-3,
    },
    resume: ResumeLimits {
        solved: 1e-12,
        nearly_solved: 1e-9,
        same_state: 1e-6,
        same_pose: 1e-9,
        pull: 1e-9,
        least_tau_rate: 1e-4,
    },
    start: StartLimits {
        bends: [0.05, -0.05, 0.5, -0.5],
        farthest_back: 4.0,
        step_back: 0.05,
        own_path: 2.0,
        same_energy: 1e-9,
    },
    snap: SnapLimits {
        ahead: [2e-3, 8e-3, 2e-2, 5e-2],
        ahead_of_touch: [1e-4, 5e-4],
        bend: 0.05,
        flat_way: 1e-9,
        flat_force: 1e-5,
        flat_clearance: 1e-6,
        farthest_slip: 0.05,
        shortest_slip: 1e-9,
        same: 1e-4,
        energy_rounding: 1e-11,
        first_step: 0.02,
        longest_step: 0.1,
        shortest_step: 1e-4,
        most_steps: 100,
    },
    sweep: SweepLimits {
        most_steps: 2_000_000,
        most_states: 1e15,
        at_end: 1e-10,
        most_at_one_pose: 12,
        one_pose: 1e-9,
        at_open_end: 1e-3,
        friction_change: 1e-9,
    },
};
