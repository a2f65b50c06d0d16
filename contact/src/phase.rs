//! Contact phases, named from the clamp to the tip: B a tangential contact, A a contact of the tip.

use std::fmt;

/// Which contacts a rod has. Only the last one can be at the tip, so that their number and kind of the last say it all.
///
/// ```
/// use rod_contact::Phase;
/// assert_eq!(Phase { contacts: 0, tip: false }.to_string(), "free");
/// assert_eq!(Phase { contacts: 3, tip: true }.to_string(), "BBA");
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Phase {
    /// Number of contacts.
    pub contacts: usize,
    /// Whether the last one is at the tip (letter A).
    pub tip: bool,
}

impl Phase {
    /// The rod touches nothing.
    pub const FREE: Self = Self { contacts: 0, tip: false };
}

impl fmt::Display for Phase {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.contacts == 0 {
            return f.pad("free");
        }
        let tangential = self.contacts - usize::from(self.tip);
        f.pad(&("B".repeat(tangential) + if self.tip { "A" } else { "" }))
    }
}
