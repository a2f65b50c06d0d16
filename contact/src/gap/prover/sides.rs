//! On which side of the objects the rod is, where its intervals leave that open.

use super::{DISCS, Search, holds};
use crate::gap::interval::Knot;
use rod_core::RodModel;

impl<M: RodModel> Search<'_, M> {
    /// Whether the clamp is inside an object: notes it.
    pub(super) fn clamp(&mut self, clamp: &Knot) {
        let (world, at) = (self.world, clamp.at);
        world.objects_at(at.x, at.y, |object| {
            self.object = object;
            if !self.is_point_outside(clamp) {
                self.proof.clamp_inside = true;
                self.proof.seen = self.proof.seen.min(world.object_gap(object, at.x, at.y));
            }
        });
    }

    /// Asks on which side of an object the rod is, where it may have touched it: in the middle of the stretch behind those
    /// intervals, at the tip where nothing is behind, and in an interval that is clear of the run, but on either side. There a rod
    /// that goes in at one end of the run and out at the other, through notches, is inside where it passes the run's middle.
    pub(super) fn sides(&mut self) {
        let mut gates = std::mem::take(&mut self.known.gates);
        gates.sort_unstable();
        let last = self.shape.nodes.len() - 1;
        let mut k = 0;
        while let Some(&(object, i, unsigned)) = gates.get(k) {
            k += 1;
            let next = gates.get(k).filter(|next| next.0 == object).map(|next| next.1);
            self.object = object;
            if self.world.is_one_convex(object) {
                continue;
            }
            let behind = match next {
                Some(next) if next <= i + 1 => None,
                next => Some(i + 1 + (next.unwrap_or(last) - i - 1) / 2),
            };
            let doubts = unsigned.map(|run| [(i, 0.5), (i + 1, 0.0), (i, self.beside_middle(i, run))]);
            let asked = behind.map(|k| (k, 0.0)).into_iter().chain(doubts.into_iter().flatten());
            for (k, share) in asked {
                if !self.is_outside(k, share) {
                    let knot = self.point(k, share);
                    self.refute(&knot);
                }
            }
        }
        self.known.gates = gates;
    }

    /// The share of interval `i` at which the rod passes the middle of a run.
    fn beside_middle(&self, i: usize, run: usize) -> f64 {
        let [Some(a), Some(b)] = self.world.run(run).ends else { return 0.5 };
        let [from, to] = [&self.shape.nodes[i].at, &self.shape.nodes[i + 1].at];
        let (dx, dy) = (to.x - from.x, to.y - from.y);
        let along = (0.5 * (a.x + b.x) - from.x) * dx + (0.5 * (a.y + b.y) - from.y) * dy;
        (along / (dx * dx + dy * dy).max(f64::MIN_POSITIVE)).clamp(0.0, 1.0)
    }

    /// The node `k`, or a point by a share of the way to the next one.
    pub(super) fn point(&self, k: usize, share: f64) -> Knot {
        let node = &self.shape.nodes[k];
        if share == 0.0 {
            return Knot::from(node);
        }
        let s = node.s + share * (self.shape.nodes[k + 1].s - node.s);
        Knot::on(self.rod, &self.shape.segments[node.segment], s)
    }

    /// Whether node `k` is a contact with the object: a point of the contour.
    fn is_touching(&self, k: usize) -> bool {
        self.configuration.is_some_and(|configuration| {
            configuration.contacts.iter().enumerate().any(|(j, held)| {
                self.shape.node_of(j) == k
                    && self.world.object(held.stretch) == self.object
                    && self.world.span(held.stretch).contains(configuration.t(j))
            })
        })
    }

    /// Whether a point of the rod is outside of the object: mostly it is in a disc that is known to be.
    fn is_outside(&mut self, k: usize, share: f64) -> bool {
        if share == 0.0 && self.is_touching(k) {
            return true;
        }
        self.is_point_outside(&self.point(k, share))
    }

    /// The same of a point that is no contact.
    fn is_point_outside(&mut self, Knot { at, .. }: &Knot) -> bool {
        let (world, object) = (self.world, self.object);
        if world.is_far_outside(object, at.x, at.y) {
            return true;
        }
        let discs = &mut self.known.outside[object];
        if discs.iter().any(|disc| holds(disc, (at.x, at.y))) {
            return true;
        }
        let gap = world.object_gap(object, at.x, at.y);
        if gap > 0.0 {
            let disc = (at.x, at.y, gap);
            if discs.len() < DISCS {
                discs.push(disc);
            } else {
                self.known.next = (self.known.next + 1) % DISCS;
                discs[self.known.next] = disc;
            }
            return true;
        }
        !world.is_inside(object, at.x, at.y, self.depth)
    }
}
