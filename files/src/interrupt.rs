//! Ending a command early, with what it has; and how far it has come.

use std::fmt;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use vibrissa::Pose;

/// Asks a command to end early, and hears how far it has come. All clones are one: what is asked of one is asked of all.
#[derive(Clone, Debug, Default)]
pub struct Interrupt(Arc<Line>);

#[derive(Debug, Default)]
struct Line {
    raised: AtomicBool,
    /// Percent.
    passed: AtomicU32,
}

impl Interrupt {
    /// Asks for the end; returns whether that had been asked before.
    pub fn raise(&self) -> bool {
        self.0.raised.swap(true, Ordering::Relaxed)
    }

    /// Tells that this part of the work is done, 0 to 1.
    pub fn pass(&self, part: f64) {
        self.0.passed.store((100.0 * part) as u32, Ordering::Relaxed);
    }

    /// How much of the work is done, percent.
    pub fn passed(&self) -> u32 {
        self.0.passed.load(Ordering::Relaxed).min(100)
    }

    /// Whether the end is asked for.
    pub fn is_raised(&self) -> bool {
        self.0.raised.load(Ordering::Relaxed)
    }
}

/// How far a command had come when it was interrupted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interrupted {
    /// The clamp at the last state or event; none where there is none yet.
    pub pose: Option<Pose>,
}

impl fmt::Display for Interrupted {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.pose {
            Some(Pose { x, y, phi }) => write!(f, "interrupted at clamp ({x:.9}, {y:.9}) m, {phi:.9} rad"),
            None => write!(f, "interrupted before the first state"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clones_are_one() {
        let interrupt = Interrupt::default();
        let clone = interrupt.clone();
        assert!(!clone.is_raised());
        assert!(!interrupt.raise() && clone.is_raised() && clone.raise());
    }

    #[test]
    fn how_far_it_has_come_is_heard() {
        let interrupt = Interrupt::default();
        for (part, percent) in [(0.0, 0), (0.504, 50), (1.0, 100), (1.2, 100), (f64::NAN, 0)] {
            interrupt.pass(part);
            assert_eq!(interrupt.clone().passed(), percent);
        }
    }

    #[test]
    fn the_place_is_told() {
        let at = Interrupted { pose: Some(Pose { x: 0.07, y: -0.04, phi: 1.5 }) };
        assert_eq!(at.to_string(), "interrupted at clamp (0.070000000, -0.040000000) m, 1.500000000 rad");
        assert_eq!(Interrupted { pose: None }.to_string(), "interrupted before the first state");
    }
}
