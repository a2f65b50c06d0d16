//! Problems made from their solution: the rod is laid out from its last contact back to the clamp, and what it is to lie on is
//! put where it runs.

use super::exact::{Problem, Shape};
use std::f64::consts::PI;
use vibrissa::Pose;
use vibrissa::rod::{Hold, Section, advance};

/// What holds the rod at a contact.
#[derive(Clone, Copy, Debug)]
pub enum By {
    /// A contour with this curvature.
    Bend(f64),
    /// A convex corner.
    Vertex,
}

/// A tangential contact that is to be.
#[derive(Clone, Copy, Debug)]
pub struct Wanted {
    pub s: f64,
    pub force: f64,
    /// Whether the solid is on the left of the rod.
    pub left: bool,
    pub by: By,
}

/// A contact on the left.
pub fn left(s: f64, force: f64, by: By) -> Wanted {
    Wanted { s, force, left: true, by }
}

/// A contact on the right.
pub fn right(s: f64, force: f64, by: By) -> Wanted {
    Wanted { s, force, left: false, by }
}

/// Where the rod ends, and in which direction.
const END: Section = Section { x: 0.1, y: 0.2, phi: 0.7, kappa: 0.0 };

/// The problem that tangential contacts, from the clamp to the tip, solve, and their unknowns.
pub fn lying(wanted: &[Wanted]) -> (Problem, Vec<f64>) {
    laid_out(wanted, None)
}

/// The same with the tip as the last contact: a force on a contour, `lean` less steep than the rod there.
pub fn with_tip(wanted: &[Wanted], force: f64, lean: f64, by: By) -> (Problem, Vec<f64>) {
    laid_out(wanted, Some((force, lean, by)))
}

fn laid_out(wanted: &[Wanted], tip: Option<(f64, f64, By)>) -> (Problem, Vec<f64>) {
    let (mut held, mut u) = (Vec::new(), Vec::new());
    let (mut at, mut a, mut b, mut s) = (END, 0.0, 0.0, 1.0);
    if let Some((force, lean, by)) = tip {
        let alpha = at.phi - lean;
        let (t, shape) = put(by, &at, alpha);
        held.push((shape, Hold::Tip));
        u.push([t, force, at.phi]);
        (a, b) = (force * alpha.cos(), force * alpha.sin());
    } else if let Some(last) = wanted.last() {
        s = last.s;
    }
    for contact in wanted.iter().rev() {
        at = advance(&at, a, b, contact.s - s);
        s = contact.s;
        let (alpha, offset) = if contact.left { (at.phi, 0.0) } else { (at.phi - PI, PI) };
        let (t, shape) = put(contact.by, &at, alpha);
        held.push((shape, Hold::Tangent { offset }));
        u.push([t, contact.force, s]);
        a += contact.force * alpha.cos();
        b += contact.force * alpha.sin();
    }
    let Section { x, y, phi, .. } = advance(&at, a, b, -s);
    held.reverse();
    u.reverse();
    (Problem { clamp: Pose { x, y, phi }, held }, u.concat())
}

/// A contour through a point of the rod with a tangent angle there, and the parameter of the point.
fn put(by: By, at: &Section, alpha: f64) -> (f64, Shape) {
    match by {
        By::Vertex => (alpha, Shape::Vertex([at.x, at.y])),
        By::Bend(curvature) => {
            // not at the vertex of the parabola
            let t = 0.3 / (1.0 + curvature.abs());
            let angle = alpha - (curvature * t).atan();
            let (sin, cos) = angle.sin_cos();
            let rise = 0.5 * curvature * t * t;
            (t, Shape::Bend { vertex: [at.x - t * cos + rise * sin, at.y - t * sin - rise * cos], angle, curvature })
        }
    }
}
