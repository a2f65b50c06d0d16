//! How a film is judged.

use super::pole::PolePrior;

/// What is known of a film beside its frames.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ForceSettings {
    /// Largest coefficient of Coulomb friction: the force of a contact on the side is within its cone.
    pub friction: f64,
    /// Standard deviation of each coordinate of the points, m; found from the film where it is not given.
    pub sigma: Option<f64>,
    /// Largest number of contacts, 0 to 2.
    pub most_contacts: usize,
    /// A pole that the rod touches in all frames that have a contact: then no frame has more than one.
    pub pole: Option<PolePrior>,
    /// Largest apparent shortening of a rod of which both ends are seen, as a share of its length.
    pub most_shortening: f64,
}

impl Default for ForceSettings {
    fn default() -> Self {
        Self { friction: 0.0, sigma: None, most_contacts: 2, pole: None, most_shortening: 0.05 }
    }
}
