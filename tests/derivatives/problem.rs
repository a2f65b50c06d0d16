//! A rod against shapes in double-double numbers, solved by itself: shot from the clamp by Taylor series of the differential
//! equation, the unknowns by Newton's method with differences. It shares nothing with the library, which goes backwards from the
//! contacts by a closed form. Its derivatives are central differences, exact to 1e-17.

use super::double::{Double, double, root, sin_cos};
use nalgebra::{DMatrix, DVector};
use vibrissa::contact::{ContactKind, Quantity};
use vibrissa::{Rod, State};

/// Terms of the series, and longest step (L).
const TERMS: usize = 22;
const LONGEST: f64 = 0.06;
/// Step of the differences of the Jacobian.
const JACOBIAN: f64 = 1e-13;
/// Step of the differences that are compared.
pub const STEP: f64 = 1e-9;

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Curve {
    /// vertex_x, vertex_y, coefficient
    Parabola,
    /// center_x, center_y, radius; counterclockwise
    Disc,
    /// from_x, from_y, to_x, to_y
    Line,
}

#[derive(Clone, Debug)]
pub struct Shape {
    pub curve: Curve,
    pub parameters: Vec<Double>,
}

impl Shape {
    pub fn new(curve: Curve, parameters: &[f64]) -> Self {
        Self { curve, parameters: parameters.iter().copied().map(double).collect() }
    }

    pub fn names(&self) -> &'static [&'static str] {
        match self.curve {
            Curve::Parabola => &["vertex_x", "vertex_y", "coefficient"],
            Curve::Disc => &["center_x", "center_y", "radius"],
            Curve::Line => &["from_x", "from_y", "to_x", "to_y"],
        }
    }

    /// Point and tangent, of any length, at a parameter.
    fn at(&self, t: Double) -> ([Double; 2], [Double; 2]) {
        let p = &self.parameters;
        match self.curve {
            Curve::Parabola => ([p[0] + t, p[1] + p[2] * t * t], [double(1.0), p[2] * t * 2.0]),
            Curve::Disc => {
                let (sin, cos) = sin_cos(t);
                ([p[0] + p[2] * cos, p[1] + p[2] * sin], [-sin, cos])
            }
            Curve::Line => {
                let along = [p[2] - p[0], p[3] - p[1]];
                ([p[0] + along[0] * t, p[1] + along[1] * t], along)
            }
        }
    }

    /// The parameter next to a point.
    fn near(&self, x: f64, y: f64) -> f64 {
        let p: Vec<f64> = self.parameters.iter().map(|p| f64::from(*p)).collect();
        match self.curve {
            Curve::Parabola => x - p[0],
            Curve::Disc => (y - p[1]).atan2(x - p[0]),
            Curve::Line => {
                let (dx, dy) = (p[2] - p[0], p[3] - p[1]);
                ((x - p[0]) * dx + (y - p[1]) * dy) / (dx * dx + dy * dy)
            }
        }
    }
}

#[derive(Clone, Debug)]
pub struct Object {
    /// Translation, angle and scale, these about the origin.
    motion: [Double; 4],
    pub pieces: Vec<Shape>,
}

impl Object {
    pub fn new(pieces: Vec<Shape>) -> Self {
        let [zero, one] = [0.0, 1.0].map(double);
        Self { motion: [zero, zero, zero, one], pieces }
    }

    /// Point and unit tangent of a piece.
    fn at(&self, piece: usize, t: Double) -> ([Double; 2], [Double; 2]) {
        let ([x, y], [u, v]) = self.pieces[piece].at(t);
        let [dx, dy, angle, scale] = self.motion;
        let (sin, cos) = sin_cos(angle);
        let length = root(u * u + v * v);
        let point = [dx + scale * (x * cos - y * sin), dy + scale * (x * sin + y * cos)];
        (point, [(u * cos - v * sin) / length, (u * sin + v * cos) / length])
    }

    /// The parameters of two neighbouring pieces where they cross, near `guess`, which is a point.
    fn crossing(&self, piece: usize, (x, y): (f64, f64)) -> [Double; 2] {
        let next = (piece + 1) % self.pieces.len();
        let mut t = [piece, next].map(|piece| double(self.pieces[piece].near(x, y)));
        for _ in 0..6 {
            let ends = [self.at(piece, t[0]), self.at(next, t[1])];
            let speed = [0, 1].map(|k| {
                // along the unit tangent by the way the parameter makes
                let ahead = self.at([piece, next][k], t[k] + 1e-12).0;
                let (dx, dy) = (ahead[0] - ends[k].0[0], ahead[1] - ends[k].0[1]);
                root(dx * dx + dy * dy) / 1e-12
            });
            let apart = [ends[1].0[0] - ends[0].0[0], ends[1].0[1] - ends[0].0[1]];
            let cross = |p: [Double; 2], q: [Double; 2]| p[0] * q[1] - p[1] * q[0];
            let across = cross(ends[0].1, ends[1].1);
            t[0] += cross(apart, ends[1].1) / across / speed[0];
            t[1] += cross(apart, ends[0].1) / across / speed[1];
        }
        t
    }
}

/// A contact.
#[derive(Clone, Copy, Debug)]
struct Touch {
    object: usize,
    piece: usize,
    kind: ContactKind,
    /// About where it is.
    about: (f64, f64),
}

/// The equation that defines a transition.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Defining {
    /// The force of this contact vanishes.
    Force(usize),
    /// The last contact is at the tip.
    AtTip,
    /// This contact is where its piece and the next one (or, if not `upper`, the one before) cross.
    Vertex { contact: usize, upper: bool },
    /// The force of this contact, on a vertex, is across the piece.
    Across { contact: usize, piece: usize },
    /// The rod, with its tip on a vertex, is along the piece.
    Along { contact: usize, piece: usize },
    /// The path parameter is stationary along the branch.
    Fold,
}

/// A rod held by contacts. Unknown are, contact by contact, (t, f, s), at the tip (t, f), on a vertex (A, B, s), at the tip (A, B).
#[derive(Clone, Debug)]
pub struct Problem {
    length: Double,
    stiffness: Double,
    clamp: [Double; 3],
    objects: Vec<Object>,
    touches: Vec<Touch>,
}

/// What is compared: reactions, and of each contact x, y, s, force, and the direction of the contour.
#[derive(Clone, Debug)]
pub struct Found {
    pub reactions: [Double; 3],
    pub contacts: Vec<([Double; 4], [Double; 2])>,
    /// The direction of the rod at the last contact.
    end: [Double; 2],
}

fn is_tip(kind: ContactKind) -> bool {
    matches!(kind, ContactKind::Tip | ContactKind::Notch)
}

fn is_vertex(kind: ContactKind) -> bool {
    matches!(kind, ContactKind::Corner | ContactKind::Notch)
}

impl Problem {
    /// The problem that a state of the library solves, and the unknowns there.
    pub fn new(rod: &Rod, objects: &[Object], state: &State) -> (Self, Vec<Double>) {
        let mut unknowns = Vec::new();
        let mut touches = Vec::new();
        for contact in &state.contacts {
            let (sin, cos) = contact.alpha.sin_cos();
            let shape = &objects[contact.object].pieces[contact.piece];
            let (first, second) = if is_vertex(contact.kind) {
                (contact.force * cos, contact.force * sin)
            } else {
                (shape.near(contact.x, contact.y), contact.force)
            };
            unknowns.extend([first, second].map(double));
            if !is_tip(contact.kind) {
                unknowns.push(double(contact.s));
            }
            let about = (contact.x, contact.y);
            touches.push(Touch { object: contact.object, piece: contact.piece, kind: contact.kind, about });
        }
        let clamp = [state.pose.x, state.pose.y, state.pose.phi].map(double);
        let [length, stiffness] = [rod.length(), rod.bending_stiffness()].map(double);
        (Self { length, stiffness, clamp, objects: objects.to_vec(), touches }, unknowns)
    }

    /// The same problem where a quantity is larger by `change`.
    pub fn changed(&self, quantity: Quantity<'_>, change: Double) -> Self {
        let mut changed = self.clone();
        let number = match quantity {
            Quantity::ClampX => &mut changed.clamp[0],
            Quantity::ClampY => &mut changed.clamp[1],
            Quantity::ClampAngle => &mut changed.clamp[2],
            Quantity::Stiffness => &mut changed.stiffness,
            Quantity::Length => &mut changed.length,
            Quantity::ObjectX(object) => &mut changed.objects[object].motion[0],
            Quantity::ObjectY(object) => &mut changed.objects[object].motion[1],
            Quantity::ObjectAngle(object) => &mut changed.objects[object].motion[2],
            Quantity::ObjectScale(object) => &mut changed.objects[object].motion[3],
            Quantity::Shape { object, piece, parameter } => {
                let shape = &mut changed.objects[object].pieces[piece];
                let place = shape.names().iter().position(|name| *name == parameter).expect("a name");
                &mut shape.parameters[place]
            }
            _ => panic!("{quantity}"),
        };
        *number += change;
        changed
    }

    /// Where a contact is, the direction of the contour, and its share of (A, B).
    fn contact(&self, touch: &Touch, unknowns: &[Double]) -> ([Double; 2], [Double; 2], [Double; 2]) {
        let object = &self.objects[touch.object];
        if is_vertex(touch.kind) {
            let [t, _] = object.crossing(touch.piece, touch.about);
            let force = [unknowns[0], unknowns[1]];
            let size = root(force[0] * force[0] + force[1] * force[1]);
            return (object.at(touch.piece, t).0, force.map(|v| v / size), force);
        }
        let (point, along) = object.at(touch.piece, unknowns[0]);
        (point, along, along.map(|v| v * unknowns[1]))
    }

    /// Each contact with its own unknowns.
    fn split<'u>(&self, mut unknowns: &'u [Double]) -> Vec<(Touch, &'u [Double])> {
        let mut all = Vec::new();
        for touch in &self.touches {
            let (own, rest) = unknowns.split_at(if is_tip(touch.kind) { 2 } else { 3 });
            all.push((*touch, own));
            unknowns = rest;
        }
        all
    }

    fn shoot(&self, unknowns: &[Double]) -> (Vec<Double>, Found) {
        let contacts = self.split(unknowns);
        let held: Vec<_> = contacts.iter().map(|(touch, own)| self.contact(touch, own)).collect();
        let (mut a, mut b, mut moment) = (double(0.0), double(0.0), double(0.0));
        for (point, _, force) in &held {
            a += force[0];
            b += force[1];
            // theory: m0z = sum f ((x - x0) cos alpha + (y - y0) sin alpha)
            moment += (point[0] - self.clamp[0]) * force[0] + (point[1] - self.clamp[1]) * force[1];
        }
        let reactions = [-b, a, moment];
        let (sin, cos) = sin_cos(self.clamp[2]);
        let mut rod = [self.clamp[0], self.clamp[1], cos, sin, -moment / self.stiffness];
        let (mut s, mut residual, mut found) = (double(0.0), Vec::new(), Vec::new());
        for ((touch, own), (point, along, force)) in contacts.iter().zip(&held) {
            let at = if is_tip(touch.kind) { self.length } else { own[2] };
            rod = self.advanced(rod, [a, b], at - s);
            residual.extend([rod[0] - point[0], rod[1] - point[1]]);
            if !is_tip(touch.kind) {
                residual.push(rod[2] * along[1] - rod[3] * along[0]);
            }
            let size = if is_vertex(touch.kind) { root(own[0] * own[0] + own[1] * own[1]) } else { own[1] };
            found.push(([point[0], point[1], at, size], *along));
            (s, a, b) = (at, a - force[0], b - force[1]);
        }
        (residual, Found { reactions, contacts: found, end: [rod[2], rod[3]] })
    }

    /// x, y, cos phi, sin phi, kappa after a length under a constant force, by Taylor series.
    fn advanced(&self, mut rod: [Double; 5], [a, b]: [Double; 2], length: Double) -> [Double; 5] {
        let (a, b) = (a / self.stiffness, b / self.stiffness);
        let steps = (f64::from(length / self.length).abs() / LONGEST).ceil().max(1.0);
        let h = length / steps;
        for _ in 0..steps as usize {
            let [x, y, c, s, k] = rod;
            let (mut cos, mut sin, mut kappa) = (vec![c], vec![s], vec![k]);
            let (mut sum, mut power) = ([x, y, c, s, k], h);
            for n in 0..TERMS {
                let product = |u: &[Double]| (0..=n).fold(double(0.0), |sum, i| sum + kappa[i] * u[n - i]);
                let over = double(1.0) / (n + 1) as f64;
                let rates = [cos[n], sin[n], -product(&sin), product(&cos), a * cos[n] + b * sin[n]].map(|v| v * over);
                for (sum, rate) in sum.iter_mut().zip(rates) {
                    *sum += rate * power;
                }
                cos.push(rates[2]);
                sin.push(rates[3]);
                kappa.push(rates[4]);
                power = power * h;
            }
            rod = sum;
        }
        rod
    }

    /// The solution near `unknowns`.
    pub fn solved(&self, unknowns: &[Double]) -> (Vec<Double>, Found) {
        let unknowns = newton(unknowns, |u| self.shoot(u).0);
        let found = self.shoot(&unknowns).1;
        (unknowns, found)
    }

    /// The problem with its clamp further along a straight path.
    fn along(&self, rate: [f64; 3], tau: Double) -> Self {
        let mut moved = self.clone();
        moved.clamp.iter_mut().zip(rate).for_each(|(clamp, rate)| *clamp += tau * rate);
        moved
    }

    /// The path parameter, from the pose of the problem, where a transition is; `unknowns` are nearly those there.
    pub fn transition(&self, unknowns: &[Double], rate: [f64; 3], defining: Defining) -> Double {
        if defining == Defining::Fold {
            return self.fold(unknowns, rate);
        }
        let mut start = unknowns.to_vec();
        start.push(double(0.0));
        let end = newton(&start, |u| {
            let (tau, own) = u.split_last().expect("tau");
            let moved = self.along(rate, *tau);
            let mut residual = moved.shoot(own).0;
            residual.push(moved.defect(own, defining));
            residual
        });
        end[end.len() - 1]
    }

    fn defect(&self, unknowns: &[Double], defining: Defining) -> Double {
        let contacts = self.split(unknowns);
        match defining {
            Defining::Force(j) => contacts[j].1[1],
            Defining::AtTip => contacts[contacts.len() - 1].1[2] - self.length,
            Defining::Vertex { contact, upper } => {
                let (touch, own) = contacts[contact];
                let object = &self.objects[touch.object];
                let count = object.pieces.len();
                if upper {
                    own[0] - object.crossing(touch.piece, touch.about)[0]
                } else {
                    own[0] - object.crossing((touch.piece + count - 1) % count, touch.about)[1]
                }
            }
            Defining::Across { contact, piece } | Defining::Along { contact, piece } => {
                let (touch, own) = contacts[contact];
                let object = &self.objects[touch.object];
                let [before, after] = object.crossing(touch.piece, touch.about);
                let (_, wall) = object.at(piece, if piece == touch.piece { before } else { after });
                let is_along = matches!(defining, Defining::Along { .. });
                let direction = if is_along { self.shoot(unknowns).1.end } else { [own[0], own[1]] };
                wall[0] * direction[1] - wall[1] * direction[0]
            }
            Defining::Fold => panic!("a fold has no equation of its own"),
        }
    }

    /// The largest path parameter of a branch, by its derivative along the branch, which the first force counts.
    fn fold(&self, unknowns: &[Double], rate: [f64; 3]) -> Double {
        const APART: f64 = 1e-6;
        let mut start = unknowns.to_vec();
        start.push(double(0.0));
        let mut force = unknowns[1];
        let tau = |force: Double, start: &[Double]| {
            let end = newton(start, |u| {
                let (tau, own) = u.split_last().expect("tau");
                let mut residual = self.along(rate, *tau).shoot(own).0;
                residual.push(own[1] - force);
                residual
            });
            end[end.len() - 1]
        };
        for _ in 0..4 {
            let [before, here, after] = [-APART, 0.0, APART].map(|d| tau(force + d, &start));
            let (slope, bend) = ((after - before) / (2.0 * APART), (after - here * 2.0 + before) / (APART * APART));
            force = force - slope / bend;
        }
        tau(force, &start)
    }
}

/// Newton's method with one Jacobian, by differences: the start is a solution of a problem that differs by 1e-6 or less, so that each
/// correction brings six digits or more.
fn newton(start: &[Double], residual: impl Fn(&[Double]) -> Vec<Double>) -> Vec<Double> {
    const CORRECTIONS: usize = 6;
    let mut unknowns = start.to_vec();
    let n = unknowns.len();
    let here = residual(&unknowns);
    let mut jacobian = DMatrix::zeros(n, n);
    for column in 0..n {
        let mut moved = unknowns.clone();
        moved[column] += JACOBIAN;
        for (row, (there, here)) in residual(&moved).into_iter().zip(&here).enumerate() {
            jacobian[(row, column)] = f64::from((there - *here) / JACOBIAN);
        }
    }
    let lu = jacobian.lu();
    for _ in 0..CORRECTIONS {
        let here = residual(&unknowns);
        let right = DVector::from_iterator(n, here.iter().map(|r| f64::from(*r)));
        let change = lu.solve(&right).expect("a regular problem");
        unknowns.iter_mut().zip(change.iter()).for_each(|(u, change)| *u -= *change);
        if change.amax() < 1e-24 {
            break;
        }
    }
    unknowns
}
