//! Which sides of an object were touched.

use rod_reconstruct::FittedObject;
use std::f64::consts::{FRAC_PI_2, PI};

/// Largest angle (rad) between a direction and the outward normal of a contour that faces it: half of the distance of the angles that are tried by default, so that each
/// normal faces one of them. Larger: sides are taken for known that are not. Smaller: scans of sides that were touched.
const WITHIN: f64 = PI / 12.0;

/// Whether a touched stretch of a contour has its outside in a direction (rad). A corner has its outside in all directions between those of its sides.
pub(super) fn faces(known: &[FittedObject], direction: f64) -> bool {
    known.iter().any(|chain| {
        let outward = |k: usize| {
            let is_touched = chain.known[k - 1].sigma().is_some() && chain.known[k].sigma().is_some();
            let ([x, y], [to_x, to_y]) = (chain.points[k - 1], chain.points[k]);
            // the solid is on the left
            is_touched.then(|| (to_y - y).atan2(to_x - x) - FRAC_PI_2)
        };
        let normals: Vec<Option<f64>> = (1..chain.points.len()).map(outward).collect();
        let mut pairs = normals.iter().zip(normals.iter().skip(1).chain([&None]));
        pairs.any(|(one, next)| {
            one.is_some_and(|one| {
                let turn = next.map_or(0.0, |next| difference(next, one));
                let to = difference(direction, one);
                turn.min(0.0) - WITHIN <= to && to <= turn.max(0.0) + WITHIN
            })
        })
    })
}

/// The difference of two angles, from -pi to pi.
fn difference(one: f64, other: f64) -> f64 {
    let (sin, cos) = (one - other).sin_cos();
    sin.atan2(cos)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rod_reconstruct::Knowledge;

    #[test]
    fn a_corner_faces_what_is_between_its_sides() {
        // the lower right corner of a square
        let touched = Knowledge::Touched { sigma: 1e-4 };
        let mut corner = FittedObject {
            points: vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]],
            vertices: vec![1],
            known: vec![touched; 3],
        };
        let sees = |chain: &FittedObject, degrees: f64| faces(std::slice::from_ref(chain), degrees.to_radians());
        assert!([-90.0, -45.0, 0.0, 14.0, 270.0, -104.0].into_iter().all(|degrees| sees(&corner, degrees)));
        assert!([16.0, 45.0, 90.0, 180.0, -106.0].into_iter().all(|degrees| !sees(&corner, degrees)));
        corner.known[2] = Knowledge::Unknown;
        assert!(sees(&corner, -90.0) && !sees(&corner, 0.0));
    }
}
