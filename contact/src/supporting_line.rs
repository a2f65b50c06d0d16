//! The line that separates a rod from a convex part of a contour.

use crate::shape::Node;
use crate::world::Foot;

/// The tangent at the closest point of a convex part that bends outwards, which lies behind it: what is outside of the line by
/// some distance is as far from the part, or farther.
pub(crate) struct SupportingLine {
    x: f64,
    y: f64,
    /// The outward normal.
    normal: (f64, f64),
}

impl SupportingLine {
    /// The line at the `foot` of a node that is outside of a convex part; none where that does not bend outwards there.
    pub fn new(node: &Node, foot: &Foot) -> Option<Self> {
        let outside = foot.interior && foot.gap > 0.0 && foot.curvature >= 0.0;
        outside.then(|| Self { x: foot.x, y: foot.y, normal: foot.uphill(node.at.x, node.at.y) })
    }

    fn height(&self, Node { at, .. }: &Node) -> f64 {
        (at.x - self.x) * self.normal.0 + (at.y - self.y) * self.normal.1
    }

    /// How many of these nodes the rod is farther than `least` from the line, from the first one on.
    pub fn clears(&self, nodes: &[Node], least: f64) -> usize {
        let mut height = f64::INFINITY;
        let mut bulge = 0.0;
        let clear = |node: &&Node| {
            let after = self.height(node);
            let clear = height.min(after) - bulge > least;
            (height, bulge) = (after, node.bulge);
            clear
        };
        nodes.iter().take_while(clear).count()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::configuration::{Configuration, Held};
    use crate::path::ClampPath;
    use crate::shape::Shape;
    use crate::world::World;
    use rod_contours::{Bounds, CircularArc, Composite, Contour, Parabola};
    use rod_core::{Hold, Pose, advance};

    /// Numbers from 0 to 1, in an order that looks random.
    fn numbers(seed: u64) -> impl FnMut() -> f64 {
        let mut state = seed;
        move || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        }
    }

    #[test]
    fn what_is_cleared_is_farther() {
        let shapes: [Box<dyn Contour>; 2] = [
            Box::new(Parabola::new([0.4, 0.0], 5.0).unwrap()),
            Box::new(CircularArc::new([0.4, 0.1], 0.2, -2.5, -0.3).unwrap()),
        ];
        let (mut cleared, mut looked_at) = (0, 0);
        for contour in shapes.map(|shape| Composite::single(shape).unwrap()) {
            let world = World::new(contour.as_ref(), 1.0);
            for seed in 0..400 {
                let mut number = numbers(seed);
                let mut within = |size: f64| size * (2.0 * number() - 1.0);
                let pose = Pose { x: within(1.0), y: -0.4 + within(0.3), phi: within(3.0) };
                // some shape: that it meets the support it does not ask for
                let mut some = Configuration::free(0.0);
                some.insert(0, Held { stretch: 0, hold: Hold::Tip }, [within(0.2), within(20.0), within(3.0)]);
                let mut shape = Shape::default();
                shape.follow(&world, &ClampPath::standing(pose), &some);
                let least = within(0.1).max(0.0);
                let mut check = |part| {
                    for (i, node) in shape.nodes.iter().enumerate() {
                        let foot = world.foot_in(part, node.at.x, node.at.y);
                        let Some(line) = SupportingLine::new(node, &foot) else { continue };
                        let from = i / 2;
                        let count = line.clears(&shape.nodes[from..], least);
                        (cleared, looked_at) = (cleared + count, looked_at + shape.nodes.len() - from);
                        for pair in shape.nodes[from..from + count].windows(2) {
                            for k in 0..=8 {
                                let s = pair[0].s + (pair[1].s - pair[0].s) * f64::from(k) / 8.0;
                                let span = &shape.spans[pair[0].span];
                                let at = advance(&span.start, span.a, span.b, s - span.s);
                                let foot = world.foot_in(part, at.x, at.y);
                                assert!(foot.gap.abs() > least - 1e-12, "{seed}: {s} {foot:?}");
                                assert!(!foot.interior || foot.gap > 0.0, "{seed}: {s} {foot:?}");
                            }
                        }
                    }
                };
                let mut parts = Vec::new();
                world.parts_near(Bounds::ALL, |part| parts.push(part));
                parts.into_iter().for_each(&mut check);
            }
        }
        // and much of it is
        assert!(cleared * 3 > looked_at, "{cleared} of {looked_at}");
    }
}
