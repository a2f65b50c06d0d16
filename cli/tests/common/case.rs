//! Whether a reported state is an equilibrium of its scene, from its numbers and the outlines alone: any shapes, any
//! number of objects, on either side of the rod.

use super::golden::golden;
use super::outline::{End, Outline, Vertex, wrapped};
use super::rod::{At, Load, Rod};
use rod_files::Scene;
use std::f64::consts::PI;
use vibrissa::State;
use vibrissa::contact::{Contact, ContactKind};

/// What falls short, in dimensionless units.
#[derive(Clone, Debug)]
pub struct Bad {
    pub what: &'static str,
    pub off: f64,
}

/// What everything must hold to; forces and moments, this times one plus the contact forces.
pub const TOLERANCE: f64 = 1e-9;
/// The same for the direction of a force: the nearest point is known to rounding of the coordinates, its angle to that
/// over the radius.
const ANGLE: f64 = 1e-8;
/// Shortest way between two points of the rod that are looked at.
const FINE: f64 = 2e-3;

/// A state in dimensionless units, and the rod that follows from it.
pub struct Case<'a> {
    pub state: &'a State,
    pub loads: Vec<Load>,
    /// Contact points.
    pub points: Vec<[f64; 2]>,
    pub rod: Rod,
    tolerance: f64,
    /// Length of the rod, m.
    length: f64,
    total: f64,
    reactions: [f64; 3],
}

impl<'a> Case<'a> {
    pub fn new(scene: &Scene, state: &'a State) -> Self {
        let units = scene.rod.units();
        let (l, f) = (units.length, units.force);
        let load = |c: &Contact| Load { s: c.s / l, force: c.force / f, alpha: c.alpha };
        let loads: Vec<Load> = state.contacts.iter().map(load).collect();
        let points = state.contacts.iter().map(|c| [c.x / l, c.y / l]).collect();
        let r = &state.reactions;
        let reactions = [r.f0x / f, r.f0y / f, r.m0z / units.moment];
        let total = loads.iter().map(|load| load.force.abs()).sum::<f64>();
        let clamp = At { x: state.pose.x / l, y: state.pose.y / l, phi: state.pose.phi, kappa: -reactions[2] };
        let rod = Rod::new(clamp, force(&reactions), &loads);
        Self { state, loads, points, rod, tolerance: TOLERANCE, length: l, total, reactions }
    }

    /// The same to a tolerance that numbers known to 1e-12 of their size can meet, where the rod is sensitive to them.
    pub fn allowing_for_sensitivity(self) -> Self {
        let nudge = 1e-12 * (1.0 + self.total);
        let (clamp, force) = (self.rod.at(0.0), force(&self.reactions));
        let mut off: f64 = 0.0;
        for [k, a, b] in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] {
            let clamp = At { kappa: clamp.kappa + k * nudge, ..clamp };
            let other = Rod::new(clamp, (force.0 + a * nudge, force.1 + b * nudge), &self.loads);
            for s in [0.25, 0.5, 0.75, 1.0] {
                let (p, q) = (self.rod.at(s), other.at(s));
                off = off.max((p.x - q.x).hypot(p.y - q.y)).max((p.phi - q.phi).abs());
            }
        }
        Self { tolerance: TOLERANCE.max(100.0 * off), ..self }
    }

    /// Everything that falls short.
    pub fn judge(&self, outlines: &[Outline<'_>]) -> Vec<Bad> {
        let mut bad = self.equilibrium();
        self.certified(&mut bad);
        for (j, contact) in self.state.contacts.iter().enumerate() {
            match outlines.get(contact.object) {
                Some(outline) => self.on_contour(j, outline, &mut bad),
                None => bad.push(Bad { what: "no such object", off: 1.0 }),
            }
        }
        for outline in outlines {
            self.outside(outline, &mut bad);
        }
        bad
    }

    /// What falls short of an equilibrium of the rod, whatever the objects are.
    pub fn equilibrium(&self) -> Vec<Bad> {
        let mut bad = Vec::new();
        self.balance(&mut bad);
        self.lies_on_contacts(&mut bad);
        bad
    }

    /// How far off the rod may be, in its lengths.
    pub fn tolerance(&self) -> f64 {
        self.tolerance
    }

    /// The certificate says that it is one.
    fn certified(&self, bad: &mut Vec<Bad>) {
        let certificate = &self.state.certificate;
        need(bad, "a residual is left", certificate.residual, 1e-10);
        need(bad, "the certificate knows of a penetration", -certificate.min_gap.lower / self.length, TOLERANCE);
    }

    fn balance(&self, bad: &mut Vec<Bad>) {
        let tolerance = TOLERANCE * (1.0 + self.total);
        let [mut fx, mut fy, mut m] = self.reactions;
        let pose = self.rod.at(0.0);
        for (load, [x, y]) in self.loads.iter().zip(&self.points) {
            let (sin, cos) = load.alpha.sin_cos();
            fx += load.force * sin;
            fy -= load.force * cos;
            m -= load.force * ((x - pose.x) * cos + (y - pose.y) * sin);
            need(bad, "a contact pulls", -load.force, 1e-11);
        }
        need(bad, "the forces do not balance", fx.hypot(fy), tolerance);
        need(bad, "the moments do not balance", m.abs(), tolerance);
        need(bad, "the tip carries a moment", self.rod.tip().kappa.abs(), self.tolerance * (1.0 + self.total));
    }

    fn lies_on_contacts(&self, bad: &mut Vec<Bad>) {
        let mut before = 0.0;
        let last = self.loads.len().saturating_sub(1);
        for (j, (load, [x, y])) in self.loads.iter().zip(&self.points).enumerate() {
            // where a rod in a notch lies down on a wall, both forces are at the tip
            let in_notch = j == last && j > 0 && self.state.contacts[j].kind == ContactKind::Tip && before == 1.0;
            if !((load.s > before || (in_notch && load.s == before)) && load.s <= 1.0 + 1e-12) {
                bad.push(Bad { what: "contacts out of order", off: load.s - before });
            }
            before = load.s;
            let at = self.rod.at(load.s);
            need(bad, "the rod misses a contact", (at.x - x).hypot(at.y - y), self.tolerance);
            match self.state.contacts[j].kind {
                ContactKind::Tangent | ContactKind::Corner => {
                    let turned = at.phi - load.alpha;
                    let off = turned - PI * (turned / PI).round();
                    need(bad, "the rod crosses a contact at an angle", off.abs(), self.tolerance);
                }
                ContactKind::Tip | ContactKind::Notch => {
                    need(bad, "a tip contact is not at the tip", (load.s - 1.0).abs(), 1e-12);
                    if j != last {
                        bad.push(Bad { what: "a tip contact is not the last", off: 1.0 });
                    }
                }
                _ => bad.push(Bad { what: "a contact of an unknown kind", off: 1.0 }),
            }
        }
    }

    fn on_contour(&self, j: usize, outline: &Outline<'_>, bad: &mut Vec<Bad>) {
        let (contact, [x, y], alpha) = (&self.state.contacts[j], self.points[j], self.loads[j].alpha);
        let vertex = outline.vertices.iter().find(|v| v.before == contact.piece);
        match contact.kind {
            ContactKind::Tangent | ContactKind::Tip => {
                let Some(strip) = outline.strips.iter().position(|s| s.piece == contact.piece) else {
                    return bad.push(Bad { what: "no such piece", off: 1.0 });
                };
                let foot = outline.foot_on(strip, x, y);
                need(bad, "a contact is off the contour", foot.gap.abs(), TOLERANCE);
                let off = wrapped(alpha - foot.alpha).abs();
                let on_vertex = vertex.filter(|v| (v.x - x).hypot(v.y - y) < 1e-9);
                // at the end of a piece, within its joint
                if off > ANGLE && on_vertex.is_some_and(|v| inside(v, alpha) < ANGLE) {
                    return bad.push(Bad { what: "the tip rests on a corner", off: contact.force });
                }
                need(bad, "a force is not normal", off, ANGLE);
            }
            ContactKind::Corner | ContactKind::Notch => {
                let Some(vertex) = vertex.filter(|v| (v.turn > 0.0) == (contact.kind == ContactKind::Corner)) else {
                    return bad.push(Bad { what: "no such corner or notch", off: 1.0 });
                };
                need(bad, "a contact is off its vertex", (vertex.x - x).hypot(vertex.y - y), TOLERANCE);
                need(bad, "a force is outside its cone", inside(vertex, alpha), ANGLE);
            }
            _ => bad.push(Bad { what: "a contact of an unknown kind", off: 1.0 }),
        }
    }

    /// The deepest point of the rod inside an object.
    fn outside(&self, outline: &Outline<'_>, bad: &mut Vec<Bad>) {
        let (deepest, unsure) = self.deepest(outline);
        need(bad, "the rod goes through the contour", -deepest, self.tolerance);
        if unsure {
            bad.push(Bad { what: "JUDGE: inside or not?", off: 1.0 });
        }
    }

    /// The smallest gap, and whether two tests for the side disagree.
    pub fn deepest(&self, outline: &Outline<'_>) -> (f64, bool) {
        let look = |s: f64| {
            let at = self.rod.at(s);
            outline.foot(at.x, at.y)
        };
        let (mut places, mut points): (Vec<(f64, f64)>, Vec<At>) = (Vec::new(), Vec::new());
        // behind an open contour a rod that came round its end is not inside
        let (mut inside, mut s) = (false, 0.0);
        let (mut least, mut unsure) = (f64::INFINITY, false);
        let mut before: Option<(f64, f64)> = None;
        loop {
            let at = self.rod.at(s);
            let foot = outline.foot(at.x, at.y);
            let jumps = before.is_some_and(|(was_s, was)| was.abs() + foot.gap.abs() > 1.01 * (s - was_s) + 1e-9);
            match before {
                None => inside = foot.gap < 0.0,
                Some((_, was)) if (was < 0.0) != (foot.gap < 0.0) && !jumps => inside = foot.gap < 0.0,
                Some(_) => {}
            }
            if let Some(closed) = outline.encloses(at.x, at.y) {
                unsure |= foot.gap.abs() > 2e-3 && closed != (foot.gap < 0.0);
                inside = foot.gap < 0.0;
            }
            let gap = if inside { -foot.gap.abs() } else { foot.gap.abs() };
            least = least.min(gap);
            places.push((s, gap));
            points.push(at);
            before = Some((s, foot.gap));
            if s >= 1.0 {
                break;
            }
            s = (s + foot.gap.abs().clamp(FINE, 0.1)).min(1.0);
        }
        for k in 0..places.len() {
            let near = |i: usize| places.get(i).copied();
            let ((s, gap), (left, right)) = (places[k], (k.checked_sub(1).and_then(near), near(k + 1)));
            let lower = |other: Option<(f64, f64)>| other.is_none_or(|(_, g)| g >= gap);
            if gap < FINE && gap > -FINE && lower(left) && lower(right) {
                let (from, to) = (left.map_or(s, |p| p.0), right.map_or(s, |p| p.0));
                least = least.min(look(golden(from, to, |s| look(s).gap)).gap);
            }
        }
        // what is too sharp to be seen from the rod
        for vertex in outline.vertices.iter().filter(|v| v.turn > 0.0) {
            let distances = points.iter().map(|at| (at.x - vertex.x).hypot(at.y - vertex.y)).enumerate();
            let (nearest, distance) = distances.min_by(|a, b| a.1.total_cmp(&b.1)).unwrap();
            if distance < 0.05 {
                let mut s = places[nearest].0;
                for _ in 0..8 {
                    let at = self.rod.at(s);
                    let (sin, cos) = at.phi.sin_cos();
                    s = (s - (at.x - vertex.x) * cos - (at.y - vertex.y) * sin).clamp(0.0, 1.0);
                }
                let foot = look(s);
                if foot.gap.abs() < 0.05 && foot.end != Some(End::Open) {
                    least = least.min(foot.gap);
                }
            }
        }
        (least, unsure)
    }
}

/// The force (A, B) in the rod at its clamp.
fn force([f0x, f0y, _]: &[f64; 3]) -> (f64, f64) {
    (*f0y, -f0x)
}

/// How far an angle is outside of the cone of a vertex.
fn inside(vertex: &Vertex, alpha: f64) -> f64 {
    let half = 0.5 * vertex.turn;
    wrapped(alpha - vertex.alpha - half).abs() - half.abs()
}

fn need(bad: &mut Vec<Bad>, what: &'static str, off: f64, tolerance: f64) {
    if off > tolerance || off.is_nan() {
        bad.push(Bad { what, off });
    }
}
