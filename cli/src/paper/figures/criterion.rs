//! The phase criterion along several scans (Merker et al. 2020, fig. 7).

use crate::figure::canvas::{FigureError, HPos, PAGE, TITLE, svg, write};
use crate::figure::palette::INK;
use crate::figure::trace::{self, Along, TraceChart};
use rod_files::Scan;
use vibrissa::State;

const WIDTH: u32 = PAGE;
const PLOT: u32 = 300;
const HEAD: u32 = 110;
/// Height of a scan's name above its plot.
const NAME: u32 = 50;

/// Draws K = m0z^2 - 2 E I (f0y sin phi0 + f0x cos phi0) along each scan, in (N mm)^2.
pub(crate) fn criterion(scans: &[&Scan]) -> Result<String, FigureError> {
    let last = scans.len().saturating_sub(1);
    let rows = |index: usize| NAME + PLOT + trace::trimmings(true, index == last);
    let height = HEAD + (0..scans.len()).map(rows).sum::<u32>();
    svg((WIDTH, height), |root| {
        let (head, mut rest) = root.split_vertically(HEAD);
        let line = "Phase criterion K = m_{0z}² − 2 EI (f_{0y} sin φ_{0} + f_{0x} cos φ_{0}):";
        write(&head, line, (24, 36), HPos::Left, TITLE, INK)?;
        let line = "zero where the last contact is tangential (B, BB), not where the tip is in contact (A, BA)";
        write(&head, line, (24, 80), HPos::Left, TITLE, INK)?;
        for (index, scan) in scans.iter().enumerate() {
            let (part, below) = rest.split_vertically(rows(index));
            let (name, plot) = part.split_vertically(NAME);
            write(&name, &scan.scene.name, (24, 26), HPos::Left, TITLE, INK)?;
            let stiffness = scan.scene.rod.at_clamp().bending_stiffness();
            let quantity = |state: &State| 1e6 * state.reactions.phase_criterion(state.pose.phi, stiffness);
            let (parts, foot) = (trace::parts(scan, quantity), index == last);
            trace::draw(
                root,
                &plot,
                &TraceChart { along: &Along::of(scan), parts, name: "K in (N mm)²", phases: true, foot },
            )?;
            rest = below;
        }
        Ok(())
    })
}
