//! What of the chain could meet a contour within a step.

use super::{LINK, LINKS, Place, REACH};
use crate::scene::corner::Corner;
use crate::scene::world::{Foot, World};
use rod_contours::{Bounds, StretchKind};
use rod_core::Section;

/// Largest number of stretches that a link is kept out of in one step: of fine teeth the nearest. More make the programme larger.
const MOST_A_LINK: usize = 6;

/// Curvature (1 / L) of the contour above which a link may rest on it between two nodes: a radius of two links.
const SHARPEST: f64 = 0.5 * LINKS as f64;

/// A point of the chain near the contour: a node, or the point of a link that is next to a corner.
pub(super) struct Near {
    /// Arc length, in links.
    pub s: f64,
    /// The point.
    pub x: f64,
    pub y: f64,
    pub stretch: usize,
    pub gap: f64,
    pub alpha: f64,
}

/// What could meet a contour within a step that moves nothing further than `reach`: nodes, and links at corners. `room` is a lower bound of the
/// distance of each node but the first from all contours, and is renewed, up to `horizon`, where it does not tell that nothing is near.
pub(super) fn near(
    world: &World<'_>,
    Place { nodes, angles }: &Place,
    room: &mut [f64; LINKS],
    (reach, horizon): (f64, f64),
) -> Vec<Near> {
    let mut near: Vec<Near> = Vec::new();
    for (link, &[x, y]) in nodes[1..].iter().enumerate() {
        // a point of the link is as near as its end, but for the length of the link
        if room[link] > reach + LINK {
            continue;
        }
        room[link] = horizon;
        let first = near.len();
        world.parts_near(Bounds::EMPTY.with(x, y).grown(horizon), |part| {
            let [from_x, from_y] = nodes[link];
            let start = Section { x: from_x, y: from_y, phi: angles[link], kappa: 0.0 };
            let corner = match world.kind(part.stretch) {
                // what holds the tip in a notch are the two pieces that end there
                StretchKind::Notch { .. } => None,
                StretchKind::Corner { .. } => Some(Corner::new(world, part.stretch)),
                StretchKind::Piece(_) => {
                    let foot = world.foot_in(part, x, y);
                    room[link] = room[link].min((x - foot.x).hypot(y - foot.y));
                    near.extend(at_piece(world, part.stretch, &foot, (link + 1, x, y), reach));
                    let close = foot.gap.abs() <= LINK + reach;
                    close.then(|| Corner::of_bend(world, part, start.phi, SHARPEST)).flatten()
                }
            };
            near.extend(corner.and_then(|corner| at_corner(world, &corner, part.stretch, link, &start, reach)));
        });
        if near.len() - first > MOST_A_LINK {
            near[first..].sort_by(|a, b| a.gap.total_cmp(&b.gap));
            near.truncate(first + MOST_A_LINK);
        }
    }
    near
}

/// A node whose closest point of a part of a piece is `foot`.
fn at_piece(
    world: &World<'_>,
    stretch: usize,
    foot: &Foot,
    (node, x, y): (usize, f64, f64),
    reach: f64,
) -> Option<Near> {
    if foot.gap > reach || foot.gap < -REACH {
        return None;
    }
    let at = |gap| Near { s: node as f64, x, y, stretch, gap, alpha: foot.alpha };
    if world.ends_in_notch(stretch, foot) {
        // beyond its end a piece goes on as its tangent
        return Some(at((x - foot.x) * foot.alpha.sin() - (y - foot.y) * foot.alpha.cos()));
    }
    let outside = foot.gap >= -1e-9 || world.goes_through(stretch, foot, x, y);
    (foot.interior && outside).then(|| at(foot.gap))
}

/// A link (its number, and where it starts) next to a corner of a stretch that it may come to lie on.
fn at_corner(
    world: &World<'_>,
    corner: &Corner,
    stretch: usize,
    link: usize,
    start: &Section,
    reach: f64,
) -> Option<Near> {
    let (sin, cos) = start.phi.sin_cos();
    let way = (corner.x - start.x) * cos + (corner.y - start.y) * sin;
    if !(0.0..LINK).contains(&way) {
        return None;
    }
    let at = Section { x: start.x + way * cos, y: start.y + way * sin, ..*start };
    let passing = corner.passing(&at).filter(|passing| passing.gap.abs() <= reach)?;
    let s = link as f64 + way / LINK;
    let rest = (s * LINK, (LINKS as f64 - s) * LINK);
    (passing.gap >= -1e-9 || corner.is_cut(world, &at, &passing, rest)).then_some(Near {
        s,
        x: at.x,
        y: at.y,
        stretch,
        gap: passing.gap,
        alpha: passing.alpha,
    })
}
