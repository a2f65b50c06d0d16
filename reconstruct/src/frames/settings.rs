//! How a film is judged.

/// What is known of a film beside its frames.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ForceSettings {
    /// Largest coefficient of Coulomb friction: the force of a contact on the side is within its cone.
    pub friction: f64,
    /// Standard deviation of each coordinate of the points, m; found from the film where it is not given.
    pub sigma: Option<f64>,
    /// Largest number of contacts, 0 to 2.
    pub most_contacts: usize,
    /// Largest apparent shortening of a rod of which both ends are seen, as a share of its length.
    pub most_shortening: f64,
}

impl Default for ForceSettings {
    fn default() -> Self {
        Self { friction: 0.0, sigma: None, most_contacts: 2, most_shortening: 0.05 }
    }
}
