//! The pieces of a rod between its joints, in the order in which an interval passes them.

/// Shows the pieces that the interval from `from` to `to` (either way) passes, each with its number and the part of it that belongs
/// to the interval: piece i lies between joint i - 1 and joint i, the first and the last have no end. An interval that starts at a
/// joint starts in the piece on its side; one without length counts as going to the tip.
#[inline]
pub(crate) fn pieces(joints: &[f64], from: f64, to: f64, mut show: impl FnMut(usize, f64, f64)) {
    let mut at = from;
    if to >= from {
        for i in joints.partition_point(|&joint| joint <= from)..=joints.len() {
            let end = joints.get(i).map_or(to, |&joint| joint.min(to));
            show(i, at, end);
            at = end;
            if at >= to {
                return;
            }
        }
    } else {
        for i in (0..=joints.partition_point(|&joint| joint < from)).rev() {
            // an end that is no number stays so
            let end = if i > 0 && joints[i - 1] > to { joints[i - 1] } else { to };
            show(i, at, end);
            at = end;
            if at <= to || at.is_nan() {
                return;
            }
        }
    }
}

/// The piece at an arc length: at a joint that on the side of the tip.
pub(crate) fn piece_at(joints: &[f64], s: f64) -> usize {
    joints.partition_point(|&joint| joint <= s)
}
