//! The phase diagram of Merker et al. (2020, fig. 8b): which phase may follow which, and how likely.

use super::label::Label;

/// A kink or a jump of the reactions between two samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Break {
    /// The first sample after it.
    pub index: usize,
    /// Whether the reactions themselves jump, or only their rates.
    pub jump: bool,
    /// Its chi-squared, with 3 degrees of freedom.
    pub score: f64,
}

/// Log-odds of a change of phase at a break of the reactions.
const AT_BREAK: f64 = -3.0;
/// The same without a break between A and B, where the reactions hardly break.
const SMOOTH: f64 = -7.0;
/// The same without a break between any other phases, where the reactions always break.
const UNSEEN: f64 = -60.0;
/// Added for a change that the diagram does not have. Larger: a wrong label at one place is followed by wrong ones.
const STRANGE: f64 = -12.0;
/// Chi-squared at which a break is as likely a false alarm as real.
const DOUBTFUL: f64 = 30.0;
/// Increase of chi-squared that makes a break more likely by a factor of e.
const SCALE: f64 = 4.0;
/// Largest log-odds of a break: a vertex breaks the reactions, too, without a change of phase.
const SUREST: f64 = 8.0;

/// Whether the phase diagram joins two phases: one contact comes or goes, or moves between the tip and the side of the rod. This is
/// fig. 8b with the free rod, read in both directions.
fn neighbours(from: Label, to: Label) -> bool {
    use Label::{A, B, BA, BB, Free};
    let either = |u, v| (from, to) == (u, v) || (from, to) == (v, u);
    either(Free, A)
        || either(Free, B)
        || either(A, B)
        || either(A, BA)
        || either(B, BA)
        || either(B, BB)
        || either(BB, BA)
}

/// Log-odds of the transition from one label to another between two places, with a break between them or none.
pub(crate) fn transition_log_odds(from: Label, to: Label, between: Option<Break>) -> f64 {
    use Label::{A, B};
    let sure = between.map_or(0.0, |here| ((here.score - DOUBTFUL) / SCALE).clamp(-SUREST, SUREST));
    if from == to {
        // a rod that snaps or slips may land in the phase it left, and a third contact keeps the label of two
        let again = from.several() || between.is_some_and(|here| here.jump);
        let lowest = if again { AT_BREAK } else { f64::NEG_INFINITY };
        return (-sure.max(0.0)).max(lowest);
    }
    let strange = if neighbours(from, to) { 0.0 } else { STRANGE };
    match between {
        Some(Break { jump: true, .. }) => AT_BREAK,
        Some(_) => AT_BREAK + sure.min(0.0) + strange,
        None if matches!((from, to), (A, B) | (B, A)) => SMOOTH,
        None => UNSEEN + strange,
    }
}
