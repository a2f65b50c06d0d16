//! The mounting of the sensor at the clamp.

use super::GeometryError;
use super::frame::{Frame, number};
use crate::sample::{Number, OutOfPlane, Quality, ReactionSample, Wrench, WrenchSample};
use rod_core::{Pose, Reactions};

/// How the sensor sits to the clamp: from the wrench that it measures to the reactions of the clamp on the rod, and back.
///
/// The frame leads from the sensor's axes and origin to the scene's axes (x, y in the plane of the rod, z across) with the
/// clamp as origin. What is known of the errors goes along: standard deviations are added in squares, bounds in full.
///
/// ```
/// use rod_core::Pose;
/// use rod_hw::{Frame, Mounting, Wrench, WrenchSample};
/// // the clamp 40 mm above the sensor, known to half a millimetre
/// let mounting: Mounting = Mounting::new(Frame::same().with_origin([0.0, 0.04, 0.0])?).with_lever_tolerance(0.5e-3)?;
/// let pose = Pose { x: 0.08, y: -0.04, phi: 1.571 };
/// // the rod pulls the sensor along +x: the clamp holds the rod back, f0x = -0.386 N
/// let measured = Wrench { force: [0.386, 0.0, 0.0], torque: [0.0, 0.0, -5.44e-3] };
/// let found = mounting.reactions(&WrenchSample::new(1.0, measured), pose);
/// assert_eq!(found.reactions.f0x, -0.386);
/// assert!((found.reactions.m0z + 10e-3).abs() < 1e-12);
/// assert!((found.systematic.ok_or("no bound")?.m0z - 0.193e-3).abs() < 1e-12); // 386 mN at 0.5 mm
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mounting<T = f64> {
    frame: Frame<T>,
    lever_tolerance: T,
    sense: Sense,
    /// Where the sensor turns with the clamp: the clamp angle at which the frame is right.
    turning: Option<T>,
    most_out_of_plane: Option<[T; 2]>,
}

/// The sense of the numbers of a sensor.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Sense {
    /// The load on the sensor: what the rod does to the clamp. The usual one.
    #[default]
    Load,
    /// The reaction: what the clamp does to the rod.
    Reaction,
}

impl<T: Number> Mounting<T> {
    /// A sensor that keeps its axes however the clamp turns, measures the load on it and has an exact lever arm.
    pub fn new(frame: Frame<T>) -> Self {
        let lever_tolerance = T::from_f64(0.0);
        Self { frame, lever_tolerance, sense: Sense::Load, turning: None, most_out_of_plane: None }
    }

    /// A sensor that turns with the clamp; its frame is that at the clamp angle `phi` (rad).
    ///
    /// ```
    /// use rod_core::{Pose, Reactions};
    /// use rod_hw::{Frame, Mounting, OutOfPlane};
    /// let mounting = Mounting::new(Frame::same()).turning_with_clamp(1.5)?;
    /// let pulled = Reactions { f0x: 0.0, f0y: 1.0, m0z: 0.0 };
    /// // a quarter turn on, the scene's y is the sensor's x; it feels the opposite of the reaction
    /// let pose = Pose { x: 0.0, y: 0.0, phi: 1.5 + std::f64::consts::FRAC_PI_2 };
    /// let wrench = mounting.wrench(&pulled, &OutOfPlane::default(), pose);
    /// assert!((wrench.force[0] + 1.0).abs() < 1e-15);
    /// # Ok::<(), rod_hw::GeometryError>(())
    /// ```
    ///
    /// # Errors
    /// [`GeometryError::Value`] where the angle is no number.
    pub fn turning_with_clamp(self, phi: T) -> Result<Self, GeometryError> {
        number("the clamp angle of the mounting", phi)?;
        Ok(Self { turning: Some(phi), ..self })
    }

    /// A sensor that measures in this sense.
    pub fn with_sense(self, sense: Sense) -> Self {
        Self { sense, ..self }
    }

    /// A lever arm known to this distance, m; the moment that it may cost goes into the systematic bound.
    ///
    /// # Errors
    /// [`GeometryError::Value`] where it is negative or no number.
    pub fn with_lever_tolerance(self, lever_tolerance: T) -> Result<Self, GeometryError> {
        not_negative("the tolerance of the lever arm", lever_tolerance)?;
        Ok(Self { lever_tolerance, ..self })
    }

    /// Marks samples with a force across the plane beyond `force` (N), or a moment in it beyond `moment` (N m), with
    /// [`Quality::OUT_OF_PLANE`]. Without this none are.
    ///
    /// # Errors
    /// [`GeometryError::Value`] where one is negative or no number.
    pub fn with_most_out_of_plane(self, force: T, moment: T) -> Result<Self, GeometryError> {
        not_negative("the bound of the force across the plane", force)?;
        not_negative("the bound of the moments in the plane", moment)?;
        Ok(Self { most_out_of_plane: Some([force, moment]), ..self })
    }

    /// From the sensor to the scene's axes at the clamp, at a clamp angle (rad).
    pub fn frame(&self, phi: T) -> Frame<T> {
        self.turning.map_or(self.frame, |at| self.frame.turned(phi - at))
    }

    /// The reactions of the clamp on the rod from a measurement of the sensor at this pose of the clamp.
    ///
    /// The systematic bound of m0z contains |f| times the tolerance of the lever arm, f the force in the plane. It counts
    /// what is stated: without one in the sample it is that of the lever arm alone, or none.
    pub fn reactions(&self, sample: &WrenchSample<T>, pose: Pose<T>) -> ReactionSample<T> {
        let frame = self.frame(pose.phi);
        let wrench = self.signed(frame.wrench(&sample.wrench));
        let ([f0x, f0y, f0z], [m0x, m0y, m0z]) = (wrench.force, wrench.torque);
        let zero = T::from_f64(0.0);
        let rows = || {
            let [x, y, _, _, _, z] = frame.rows();
            [x, y, z]
        };
        let sigma = sample.sigma.map(|sigma| {
            let squares = sigma.map(|s| s * s).components();
            planar(rows().map(|row| sum(row.map(|r| r * r), squares).sqrt()))
        });
        let lever = (f0x * f0x + f0y * f0y).sqrt() * self.lever_tolerance;
        let systematic = match sample.systematic {
            Some(bound) => {
                let bound = bound.map(absolute).components();
                let [x, y, z] = rows().map(|row| sum(row.map(absolute), bound));
                Some(planar([x, y, z + lever]))
            }
            None => (self.lever_tolerance > zero).then(|| planar([zero, zero, lever])),
        };
        let too_much = self
            .most_out_of_plane
            .is_some_and(|[force, moment]| absolute(f0z) > force || absolute(m0x) > moment || absolute(m0y) > moment);
        let flag = if too_much { Quality::OUT_OF_PLANE } else { Quality::empty() };
        ReactionSample {
            t: sample.t,
            pose,
            reactions: planar([f0x, f0y, m0z]),
            sigma,
            systematic,
            out_of_plane: OutOfPlane { f0z, m0x, m0y },
            quality: sample.quality | flag,
            raw: sample.raw,
        }
    }

    /// What the sensor measures where the clamp stands there and does this to the rod: the inverse of
    /// [`reactions`](Self::reactions).
    pub fn wrench(&self, reactions: &Reactions<T>, out_of_plane: &OutOfPlane<T>, pose: Pose<T>) -> Wrench<T> {
        let force = [reactions.f0x, reactions.f0y, out_of_plane.f0z];
        let torque = [out_of_plane.m0x, out_of_plane.m0y, reactions.m0z];
        self.frame(pose.phi).inverse().wrench(&self.signed(Wrench { force, torque }))
    }

    fn signed(&self, wrench: Wrench<T>) -> Wrench<T> {
        match self.sense {
            Sense::Load => -wrench,
            Sense::Reaction => wrench,
        }
    }
}

fn planar<T>([f0x, f0y, m0z]: [T; 3]) -> Reactions<T> {
    Reactions { f0x, f0y, m0z }
}

fn absolute<T: Number>(value: T) -> T {
    if value < T::from_f64(0.0) { -value } else { value }
}

fn sum<T: Number>(a: [T; 6], b: [T; 6]) -> T {
    a.iter().zip(b).fold(T::from_f64(0.0), |sum, (&a, b)| sum + a * b)
}

fn not_negative<T: Number>(what: &'static str, value: T) -> Result<(), GeometryError> {
    let value = value.to_f64();
    let expected = "a finite number, 0 or more";
    if value.is_finite() && value >= 0.0 { Ok(()) } else { Err(GeometryError::Value { what, value, expected }) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::frame::tests::{close, cross, frames, wrenches};
    use proptest::prelude::*;

    fn mountings() -> impl Strategy<Value = Mounting> {
        (frames(), any::<bool>(), proptest::option::of(-3.0..3.0)).prop_map(|(frame, reaction, turning)| {
            let mounting = Mounting::new(frame).with_sense(if reaction { Sense::Reaction } else { Sense::Load });
            turning.map_or(mounting, |phi| mounting.turning_with_clamp(phi).unwrap())
        })
    }

    fn poses() -> impl Strategy<Value = Pose> {
        [-0.1..0.1, -0.1..0.1, -3.2..3.2].prop_map(|[x, y, phi]| Pose { x, y, phi })
    }

    proptest! {
        #[test]
        fn there_and_back(mounting in mountings(), pose in poses(), wrench in wrenches()) {
            let found = mounting.reactions(&WrenchSample::new(0.0, wrench), pose);
            prop_assert!(close(&mounting.wrench(&found.reactions, &found.out_of_plane, pose), &wrench));
        }

        #[test]
        fn turning_the_clamp_of_a_sensor_that_turns_along_turns_the_reactions(
            frame in frames(), pose in poses(), phi in -3.0..3.0, wrench in wrenches(),
        ) {
            let sample = WrenchSample::new(0.0, wrench);
            let fixed = Mounting::new(frame).reactions(&sample, pose).reactions;
            let turned = Mounting::new(frame).turning_with_clamp(phi).unwrap().reactions(&sample, pose).reactions;
            let (sin, cos) = (pose.phi - phi).sin_cos();
            prop_assert!((turned.f0x - (cos * fixed.f0x - sin * fixed.f0y)).abs() < 1e-14);
            prop_assert!((turned.f0y - (sin * fixed.f0x + cos * fixed.f0y)).abs() < 1e-14);
            prop_assert!((turned.m0z - fixed.m0z).abs() < 1e-14);
        }

        /// Any lever arm within the tolerance and any wrench within its bound stay within the bound.
        #[test]
        fn the_bound_holds(
            frame in frames(), pose in poses(), wrench in wrenches(),
            shift in proptest::array::uniform3(-1.0_f64..1.0), error in wrenches(),
        ) {
            let length = shift.iter().map(|c| c * c).sum::<f64>().sqrt();
            let mounting = Mounting::new(frame).with_lever_tolerance(length).unwrap();
            let stated = WrenchSample { systematic: Some(error), ..WrenchSample::new(0.0, wrench) };
            let found = mounting.reactions(&stated, pose);
            let bound = found.systematic.unwrap();
            let d = frame.origin();
            let moved = frame.with_origin([d[0] + shift[0], d[1] + shift[1], d[2] + shift[2]]).unwrap();
            let truth = Mounting::new(moved).reactions(&WrenchSample::new(0.0, wrench), pose).reactions;
            let off = Mounting::new(frame).reactions(&WrenchSample::new(0.0, wrench + error), pose).reactions;
            for (other, lever) in [(truth, 0.0), (off, 1.0)] {
                prop_assert!((other.f0x - found.reactions.f0x).abs() <= bound.f0x + 1e-13);
                prop_assert!((other.f0y - found.reactions.f0y).abs() <= bound.f0y + 1e-13);
                let part = bound.m0z - lever * found.reactions.f0x.hypot(found.reactions.f0y) * length;
                prop_assert!((other.m0z - found.reactions.m0z).abs() <= part + 1e-13);
            }
        }
    }

    #[test]
    fn standard_deviations_add_in_squares() {
        // turned by 60 degrees, clamp 0.1 m along the sensor's y
        let frame = Frame::planar(core::f64::consts::FRAC_PI_3).unwrap().with_origin([0.0, 0.1, 0.0]).unwrap();
        let sigma = Wrench { force: [3e-3, 4e-3, 1.0], torque: [1.0, 1.0, 1e-4] };
        let sample = WrenchSample { sigma: Some(sigma), ..WrenchSample::new(0.0, Wrench::default()) };
        let found = Mounting::new(frame).reactions(&sample, Pose { x: 0.0, y: 0.0, phi: 0.0 }).sigma.unwrap();
        assert!((found.f0x - (0.25_f64 * 9e-6 + 0.75 * 16e-6).sqrt()).abs() < 1e-15);
        assert!((found.f0y - (0.75_f64 * 9e-6 + 0.25 * 16e-6).sqrt()).abs() < 1e-15);
        // m_z' = m_z + 0.1 f_x
        assert!((found.m0z - (1e-8_f64 + 9e-8).sqrt()).abs() < 1e-15);
    }

    #[test]
    fn what_leaves_the_plane() {
        let mounting = Mounting::new(Frame::same()).with_most_out_of_plane(0.05, 2e-3).unwrap();
        let pose = Pose { x: 0.0, y: 0.0, phi: 0.0 };
        for (force, torque, flagged) in [
            ([1.0, 1.0, 0.05], [2e-3, -2e-3, 1.0], false),
            ([0.0, 0.0, -0.051], [0.0; 3], true),
            ([0.0; 3], [2.1e-3, 0.0, 0.0], true),
            ([0.0; 3], [0.0, -2.1e-3, 0.0], true),
        ] {
            let found = mounting.reactions(&WrenchSample::new(0.0, Wrench { force, torque }), pose);
            assert_eq!(found.quality.contains(Quality::OUT_OF_PLANE), flagged);
            assert_eq!(found.out_of_plane.f0z, -force[2]);
            assert!(found.sigma.is_none() && found.systematic.is_none());
        }
    }

    /// A weight at the free end of a rod that sticks out along x: the clamp lifts it, and turns against it.
    #[test]
    fn signs_of_a_hanging_weight() {
        let (weight, length) = (0.2, 0.1);
        let load = Wrench { force: [0.0, -weight, 0.0], torque: cross([length, 0.0, 0.0], [0.0, -weight, 0.0]) };
        let found = Mounting::new(Frame::same())
            .reactions(&WrenchSample::new(0.0, load), Pose { x: 0.0, y: 0.0, phi: 0.0 })
            .reactions;
        // m0z = -E I kappa(0), and it bends down: kappa < 0
        assert_eq!((found.f0y, found.m0z), (weight, length * weight));
    }

    #[test]
    fn refuses() {
        let mounting = Mounting::new(Frame::same());
        for error in [
            mounting.with_lever_tolerance(-1e-3).unwrap_err(),
            mounting.with_most_out_of_plane(f64::NAN, 1.0).unwrap_err(),
            mounting.with_most_out_of_plane(1.0, -1.0).unwrap_err(),
            mounting.turning_with_clamp(f64::INFINITY).unwrap_err(),
        ] {
            assert!(matches!(error, GeometryError::Value { .. }));
        }
    }

    #[test]
    fn single_precision() {
        let mounting = Mounting::<f32>::new(Frame::planar(0.3_f32).unwrap().with_origin([0.0, 0.04, 0.0]).unwrap());
        let wrench = Wrench { force: [0.3_f32, -0.2, 0.0], torque: [0.0, 0.0, 0.01] };
        let pose = Pose { x: 0.0, y: 0.0, phi: 1.5 };
        let found = mounting.reactions(&WrenchSample::new(0.0, wrench), pose);
        let back = mounting.wrench(&found.reactions, &found.out_of_plane, pose);
        assert!((back - wrench).components().iter().all(|c| c.abs() < 1e-7));
    }
}
