//! Loaded nodes of the chain at rest as contacts of the rod.

use super::near::Near;
use super::{Chain, LINK, LINKS, Place};
use crate::contact_set::notch::into_notch;
use crate::contact_set::{ActiveContact, Configuration, tangent_hold};
use crate::scene::corner::Corner;
use crate::scene::world::World;
use rod_core::{Hold, Section};
use smallvec::{SmallVec, smallvec};

/// Force (E I / L^2) below which a node of the chain at rest counts as free.
const LEAST_FORCE: f64 = 1e-4;
/// Length (links) above which loaded neighbours may stand for two contacts.
const WIDE: f64 = 1.5;
/// Largest distance (links) of loaded neighbours.
const NEIGHBOURS: f64 = 1.5;

/// Loaded neighbouring nodes on one stretch.
#[derive(Clone, Copy)]
pub(super) struct Cluster {
    stretch: usize,
    force: f64,
    /// Sum of force times arc length, in links.
    moment: f64,
    /// Arc lengths of the first and the last of them, in links.
    from: f64,
    to: f64,
}

impl Cluster {
    pub fn is_wide(&self) -> bool {
        self.to - self.from > WIDE
    }

    /// The two forces at its ends that are worth as much; the cluster itself where it is not wide.
    pub fn ends(&self) -> SmallVec<[Self; 2]> {
        if !self.is_wide() {
            return smallvec![*self];
        }
        let last = (self.moment - self.force * self.from) / (self.to - self.from);
        let end = |s: f64, force: f64| Self { force, moment: force * s, from: s, to: s, ..*self };
        smallvec![end(self.from, self.force - last), end(self.to, last)]
    }
}

/// Clusters of loaded neighbouring nodes, along the chain.
pub(super) fn clusters(mut forces: Vec<(Near, f64)>) -> Vec<Cluster> {
    forces.retain(|(_, force)| *force > LEAST_FORCE);
    forces.sort_by(|(a, _), (b, _)| a.s.total_cmp(&b.s).then(a.stretch.cmp(&b.stretch)));
    let mut clusters: Vec<Cluster> = Vec::new();
    for (Near { s, stretch, .. }, force) in forces {
        let moment = force * s;
        match clusters.iter_mut().rev().find(|c| c.stretch == stretch && s - c.to < NEIGHBOURS) {
            Some(cluster) => {
                cluster.force += force;
                cluster.moment += moment;
                cluster.to = s;
            }
            None => clusters.push(Cluster { stretch, force, moment, from: s, to: s }),
        }
    }
    clusters
}

/// Clusters as contacts, as a guess for the boundary-value problem at `tau`.
pub(super) fn contacts(chain: &Chain, world: &World<'_>, clusters: &[Cluster], tau: f64) -> Configuration {
    let Place { nodes, angles } = chain.place();
    let mut configuration = Configuration::free(tau);
    for &Cluster { stretch, force, moment, .. } in clusters {
        let middle = moment / force;
        let node = (middle.round() as usize).clamp(1, LINKS);
        let [x, y] = nodes[node];
        let foot = world.foot(stretch, x, y);
        if configuration.ends_at_tip() {
            into_notch(world, &mut configuration, stretch, foot.alpha, force);
            continue;
        }
        let phi = if node < LINKS { 0.5 * (angles[node - 1] + angles[node]) } else { angles[LINKS - 1] };
        let corner = world.is_corner(stretch).then(|| Corner::new(world, stretch));
        let passing = corner.and_then(|corner| corner.passing(&Section { x, y, phi, kappa: 0.0 }));
        let (t, alpha) = passing.map_or((foot.t, foot.alpha), |passing| (passing.t, passing.alpha));
        let tip = middle > LINKS as f64 - 0.75 && corner.is_none();
        let (hold, third) = if tip { (Hold::Tip, phi) } else { (tangent_hold(phi - alpha), middle * LINK) };
        configuration.insert(configuration.count(), ActiveContact::smooth(stretch, hold), [t, force, third]);
    }
    configuration
}
