//! Colours: phases have those of Okabe and Ito (2008), near the ones of Merker et al. (2020), fig. 4, everything else has others.

use vibrissa::Label;
use vibrissa::contact::{Phase, SlipMode};

/// Red, green and blue, to 255.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct RGBColor(pub u8, pub u8, pub u8);

pub(crate) const WHITE: RGBColor = RGBColor(255, 255, 255);
pub(crate) const INK: RGBColor = RGBColor(0, 0, 0);
pub(crate) const MUTED: RGBColor = RGBColor(90, 90, 90);
pub(crate) const SOLID: RGBColor = RGBColor(230, 230, 230);
pub(crate) const FAINT: RGBColor = RGBColor(205, 205, 205);

/// Shapes and poses at a transition: not the black of the contour.
pub(crate) const TRANSITION: RGBColor = RGBColor(51, 34, 136);
/// The first and the second of two contacts. The distance of the first from the second, from the phases of one and two contacts, from black and from the greys
/// is at least 34 in CIELAB, also with red-green blindness (Machado et al. 2009, full severity); that of a wine red from [`MUTED`] is 3.
pub(crate) const FIRST: RGBColor = RGBColor(119, 51, 238);
pub(crate) const SECOND: RGBColor = RGBColor(153, 153, 51);
/// Things that are none of these.
pub(crate) const OTHERS: [RGBColor; 3] = [RGBColor(51, 34, 136), RGBColor(153, 153, 51), RGBColor(136, 34, 85)];

/// The colour of a phase. Phases of more than three contacts share colours; their labels tell them apart.
pub(crate) fn colour(phase: Phase) -> RGBColor {
    match (phase.contacts, phase.tip) {
        (0, _) => RGBColor(150, 150, 150),
        (1, true) => RGBColor(0, 158, 115),
        (1, false) => RGBColor(0, 114, 178),
        (2, true) => RGBColor(230, 159, 0),
        (2, false) => RGBColor(213, 94, 0),
        (_, true) => RGBColor(204, 121, 167),
        (_, false) => RGBColor(86, 180, 233),
    }
}

/// The colour of a label: that of the phases it stands for.
pub(crate) fn label_colour(label: Label) -> RGBColor {
    let contacts = match label {
        Label::Free => 0,
        Label::A | Label::B => 1,
        Label::BA | Label::BB => 2,
    };
    colour(Phase { contacts, tip: label.tip() })
}

/// The colour of a contact that slips or sticks.
pub(crate) fn mode_colour(mode: SlipMode) -> RGBColor {
    match mode {
        SlipMode::Forward => SECOND,
        SlipMode::Backward => FIRST,
        _ => RGBColor(180, 180, 180),
    }
}

/// Black or white, whichever is read more easily on a colour (relative luminance, sRGB).
pub(crate) fn ink_on(RGBColor(red, green, blue): RGBColor) -> RGBColor {
    let light = 0.299 * f64::from(red) + 0.587 * f64::from(green) + 0.114 * f64::from(blue);
    if light > 115.0 { INK } else { RGBColor(255, 255, 255) }
}
