//! Contact phases, named from the clamp to the tip: B a tangential contact, A a contact of the tip.

use crate::error::ContactError;
use std::fmt;
use std::str::FromStr;

/// Which contacts a rod has. Only the last one can be at the tip, so that their number and kind of the last say it all.
/// With the feature `serde` it is serialised as its name.
///
/// ```
/// use rod_contact::Phase;
/// assert_eq!(Phase { contacts: 0, tip: false }.to_string(), "free");
/// assert_eq!(Phase { contacts: 3, tip: true }.to_string(), "BBA");
/// assert_eq!("BBA".parse(), Ok(Phase { contacts: 3, tip: true }));
/// assert!(Phase::FREE < Phase { contacts: 1, tip: false });
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(into = "String", try_from = "String")
)]
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

impl FromStr for Phase {
    type Err = ContactError;

    /// The phase by its name as it displays: `free`, or a letter B for each tangential contact and, at the end, A for one of the
    /// tip.
    ///
    /// # Errors
    /// [`ContactError::Phase`].
    fn from_str(name: &str) -> Result<Self, ContactError> {
        if name == "free" {
            return Ok(Self::FREE);
        }
        let tangential = name.strip_suffix('A').unwrap_or(name);
        if name.is_empty() || !tangential.bytes().all(|letter| letter == b'B') {
            return Err(ContactError::Phase { name: name.into() });
        }
        Ok(Self { contacts: name.len(), tip: tangential.len() < name.len() })
    }
}

#[cfg(feature = "serde")]
impl From<Phase> for String {
    fn from(phase: Phase) -> Self {
        phase.to_string()
    }
}

#[cfg(feature = "serde")]
impl TryFrom<String> for Phase {
    type Error = ContactError;

    fn try_from(name: String) -> Result<Self, ContactError> {
        name.parse()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_read_as_they_are_written() {
        for contacts in 0..5 {
            for tip in [false, contacts > 0] {
                let phase = Phase { contacts, tip };
                assert_eq!(phase.to_string().parse(), Ok(phase));
            }
        }
        for wrong in ["", "AB", "AA", "b", "Free", "B "] {
            let error = wrong.parse::<Phase>().unwrap_err().to_string();
            assert_eq!(error, format!("no phase is called {wrong:?}, expected free, A, B, BA, BB, ..."));
        }
    }
}
