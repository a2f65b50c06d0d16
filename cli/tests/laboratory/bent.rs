//! One equilibrium of a rod with constant natural curvature in an elastic clamp, with friction at all contacts, for a given set of
//! contacts: Newton's method on a shooting problem.
//!
//! Units: lengths in L, forces in EI/L^2, moments in EI/L. The curvature phi' of such a rod follows the equation of the straight
//! rod; only the moment is EI (phi' - natural curvature), so that phi' is the natural curvature beyond the last contact.

use super::world::World;
use nalgebra::{DMatrix, DVector};
use vibrissa::rod::{Section, advance};
use vibrissa::{Composite, Contour, Pose};

/// Points along the rod at which its distance from the objects is looked at.
const POINTS: usize = 64;
/// A minimum of the distance at these points is refined if it is less than this.
const NEAR: f64 = 0.02;
/// Penetration that is rounding.
const ROUNDING: f64 = 1e-9;
/// Part of the rod beside a contact at which no other contact is looked for.
const BESIDE: f64 = 2e-3;
/// Residual at which Newton's method has converged, and the largest one that is accepted.
const RESIDUAL: (f64, f64) = (1e-12, 1e-9);
const ITERATIONS: usize = 12;
/// Step of the numerical derivatives.
const DIFFERENCE: f64 = 1e-7;

/// A contact.
#[derive(Clone, Copy, Debug)]
pub struct Touch {
    pub object: usize,
    /// Piece or corner of the object, and the parameter on it.
    pub stretch: usize,
    pub t: f64,
    /// Arc length of the rod.
    pub s: f64,
    pub force: f64,
    /// Whether the tip touches; else the rod is tangential.
    pub tip: bool,
}

/// A shape of the rod: its curvature at the clamp and its contacts in order.
#[derive(Clone, Debug)]
pub struct Shape {
    pub kappa: f64,
    pub touches: Vec<Touch>,
}

/// Why a solution is no equilibrium.
#[derive(Clone, Copy, Debug)]
pub enum Fault {
    /// This contact pulls.
    Pulls(usize),
    /// The last contact is beyond the tip.
    BeyondTip,
    /// The rod goes through the object beside the tip.
    Overturned,
    /// A contact is beyond the end, or before the start, of its stretch.
    OffStretch { touch: usize, after: bool },
    /// The rod goes through an object at this arc length.
    Through { object: usize, t: f64, s: f64 },
}

/// The rod, its clamp and the objects.
pub struct Bent<'a> {
    pub objects: &'a [Composite],
    /// Length of the rod, m.
    pub length: f64,
    pub world: World,
}

impl Bent<'_> {
    /// The rod without contacts.
    pub fn free(&self) -> Shape {
        Shape { kappa: self.world.curvature, touches: Vec::new() }
    }

    /// Reactions f0x, f0y, m0z.
    pub fn reactions(&self, shape: &Shape) -> [f64; 3] {
        let [a, b] = self.forces(&shape.touches);
        [-b, a, self.world.curvature - shape.kappa]
    }

    fn force(&self, touch: &Touch) -> [f64; 2] {
        // the rod slides against the direction of the contour
        let alpha = self.frame(touch)[2] + self.world.friction.atan();
        [touch.force * alpha.cos(), touch.force * alpha.sin()]
    }

    fn forces(&self, touches: &[Touch]) -> [f64; 2] {
        touches.iter().map(|touch| self.force(touch)).fold([0.0; 2], |sum, one| [sum[0] + one[0], sum[1] + one[1]])
    }

    /// Place and tangent of the contour at a contact.
    fn frame(&self, touch: &Touch) -> [f64; 3] {
        let frame = self.objects[touch.object].frame_on(touch.stretch, touch.t);
        [frame.x / self.length, frame.y / self.length, frame.alpha]
    }

    /// The parts of the rod between clamp, contacts and tip: arc length and section of the start, and the force.
    fn parts(&self, pose: &Pose, shape: &Shape) -> Vec<(f64, Section, [f64; 2])> {
        let turned = (shape.kappa - self.world.curvature) * self.world.compliance + self.world.turned;
        let start = Section { x: pose.x, y: pose.y, phi: pose.phi + turned, kappa: shape.kappa };
        let mut parts = vec![(0.0, start, self.forces(&shape.touches))];
        for (k, touch) in shape.touches.iter().enumerate() {
            let (s, section, [a, b]) = parts[k];
            let end = advance(&section, a, b, touch.s - s);
            parts.push((touch.s, end, self.forces(&shape.touches[k + 1..])));
        }
        parts
    }

    fn residual(&self, pose: &Pose, shape: &Shape) -> DVector<f64> {
        let parts = self.parts(pose, shape);
        let mut residual = Vec::with_capacity(1 + 3 * shape.touches.len());
        for (touch, (_, section, _)) in shape.touches.iter().zip(&parts[1..]) {
            let [x, y, alpha] = self.frame(touch);
            residual.extend([section.x - x, section.y - y]);
            if !touch.tip {
                residual.push((section.phi - alpha).sin());
            }
        }
        residual.push(parts[parts.len() - 1].1.kappa - self.world.curvature);
        DVector::from_vec(residual)
    }

    /// The equilibrium near a shape with the same contacts.
    pub fn solve(&self, pose: &Pose, guess: &Shape) -> Option<Shape> {
        let mut unknowns = guess.unknowns();
        let mut shape = guess.clone();
        let mut residual = self.residual(pose, &shape);
        for _ in 0..ITERATIONS {
            if residual.amax() < RESIDUAL.0 {
                break;
            }
            let mut jacobian = DMatrix::zeros(unknowns.len(), unknowns.len());
            for k in 0..unknowns.len() {
                let mut moved = unknowns.clone();
                moved[k] += DIFFERENCE;
                jacobian.set_column(k, &((self.residual(pose, &shape.with(&moved)) - &residual) / DIFFERENCE));
            }
            unknowns -= jacobian.lu().solve(&residual)?;
            shape = shape.with(&unknowns);
            residual = self.residual(pose, &shape);
        }
        (residual.amax() < RESIDUAL.1).then_some(shape)
    }

    /// What is wrong with a solution, if anything is.
    pub fn fault(&self, pose: &Pose, shape: &Shape) -> Option<Fault> {
        let touches = &shape.touches;
        let parts = self.parts(pose, shape);
        if let Some(touch) = touches.iter().position(|touch| touch.force < -ROUNDING) {
            return Some(Fault::Pulls(touch));
        }
        if let Some(last) = touches.last() {
            if !last.tip && last.s > 1.0 {
                return Some(Fault::BeyondTip);
            }
            let phi = parts[parts.len() - 1].1.phi;
            if last.tip && (phi - self.frame(last)[2]).sin() < -ROUNDING {
                return Some(Fault::Overturned);
            }
        }
        for (number, touch) in touches.iter().enumerate() {
            let range = self.objects[touch.object].stretch(touch.stretch).range;
            if !range.contains(touch.t) {
                return Some(Fault::OffStretch { touch: number, after: touch.t > range.to });
            }
        }
        self.through(shape, &parts)
    }

    fn through(&self, shape: &Shape, parts: &[(f64, Section, [f64; 2])]) -> Option<Fault> {
        let at = |s: f64| {
            let (from, section, [a, b]) = &parts[parts.partition_point(|part| part.0 <= s).max(1) - 1];
            advance(section, *a, *b, s - from)
        };
        for (object, contour) in self.objects.iter().enumerate() {
            let closest = |s: f64| {
                let section = at(s);
                contour.closest(section.x * self.length, section.y * self.length)
            };
            let gap = |s: f64| closest(s).gap / self.length;
            let place = |k: usize| k as f64 / POINTS as f64;
            let gaps: Vec<f64> = (0..=POINTS).map(|k| gap(place(k))).collect();
            for k in 1..=POINTS {
                let lowest = gaps[k] <= gaps[k - 1] && gaps.get(k + 1).is_none_or(|next| gaps[k] <= *next);
                if !lowest || gaps[k] > NEAR {
                    continue;
                }
                let s = minimum(place(k - 1), place((k + 1).min(POINTS)), gap);
                let known = shape.touches.iter().any(|touch| touch.object == object && (touch.s - s).abs() < BESIDE);
                if !known && gap(s) < -ROUNDING {
                    return Some(Fault::Through { object, t: closest(s).t, s });
                }
            }
        }
        None
    }
}

/// Golden section search.
fn minimum(mut from: f64, mut to: f64, value: impl Fn(f64) -> f64) -> f64 {
    const GOLDEN: f64 = 0.618_033_988_749_894_8;
    let end = to;
    let (mut a, mut b) = (to - GOLDEN * (to - from), from + GOLDEN * (to - from));
    let (mut at_a, mut at_b) = (value(a), value(b));
    for _ in 0..26 {
        if at_a < at_b {
            (to, b, at_b) = (b, a, at_a);
            a = to - GOLDEN * (to - from);
            at_a = value(a);
        } else {
            (from, a, at_a) = (a, b, at_b);
            b = from + GOLDEN * (to - from);
            at_b = value(b);
        }
    }
    let s = 0.5 * (from + to);
    if value(end) < value(s) { end } else { s }
}

impl Shape {
    fn unknowns(&self) -> DVector<f64> {
        let of_touch = |touch: &Touch| [touch.t, touch.force].into_iter().chain((!touch.tip).then_some(touch.s));
        let values: Vec<f64> = [self.kappa].into_iter().chain(self.touches.iter().flat_map(of_touch)).collect();
        DVector::from_vec(values)
    }

    fn with(&self, unknowns: &DVector<f64>) -> Self {
        let mut next = unknowns.iter().copied();
        let mut shape = self.clone();
        shape.kappa = next.next().unwrap();
        for touch in &mut shape.touches {
            (touch.t, touch.force) = (next.next().unwrap(), next.next().unwrap());
            touch.s = if touch.tip { 1.0 } else { next.next().unwrap() };
        }
        shape
    }
}
