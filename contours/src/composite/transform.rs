//! A whole contour moved, reversed, or given back in pieces.

use super::piece::Piece;
use crate::{Composite, ContourError, Motion, Moved, Reversed};

impl Composite {
    /// The contour after a motion: every piece [`Moved`], the joints between them as they were.
    ///
    /// The parameter is kept, except that a mirrored contour is travelled backwards (by `-t`), so that the solid stays on
    /// its left.
    ///
    /// ```
    /// use rod_contours::{Composite, Contour, Motion};
    ///
    /// let square = Composite::polygon(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])?;
    /// let moved = square.moved(Motion { translation: [3.0, 0.0], scale: 2.0, mirror: true, ..Motion::IDENTITY })?;
    /// assert!(moved.is_closed() && !moved.is_cavity());
    /// assert_eq!((moved.gap(4.0, 0.5), moved.gap(4.0, -0.5)), (0.5, -0.5));
    /// # Ok::<(), rod_contours::ContourError>(())
    /// ```
    ///
    /// # Errors
    ///
    /// Those of [`Moved::new`].
    pub fn moved(self, motion: Motion) -> Result<Self, ContourError> {
        let motion = motion.check()?;
        if motion == Motion::IDENTITY {
            return Ok(self);
        }
        let (pieces, turns) = self.into_placed_pieces();
        let joints: Vec<f64> = pieces.iter().map(Piece::turn).collect();
        let moved = |piece: Piece| -> Result<Piece, ContourError> {
            let Piece { range, offset, turns, .. } = piece;
            let range = if motion.mirror { range.backwards() } else { range };
            let mut moved = Piece::new(Box::new(Moved::new(piece.shape, motion)?), range);
            (moved.offset, moved.turns) = if motion.mirror { (-offset, -turns) } else { (offset, turns) };
            Ok(moved)
        };
        let mut pieces = pieces.into_iter().map(moved).collect::<Result<Vec<_>, _>>()?;
        if motion.mirror {
            pieces.reverse();
            set_joints(&mut pieces, &joints_backwards(joints));
        } else {
            set_joints(&mut pieces, &joints);
        }
        Ok(Self::from_placed_pieces(pieces, turns))
    }

    /// The contour travelled the other way, by `-t`: solid and outside are exchanged, corners become notches.
    ///
    /// ```
    /// use rod_contours::{Composite, Contour};
    ///
    /// let hole = Composite::polygon(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])?.reversed();
    /// assert!(hole.is_cavity());
    /// assert_eq!((hole.gap(0.5, 0.25), hole.gap(0.5, -0.25)), (0.25, -0.25));
    /// # Ok::<(), rod_contours::ContourError>(())
    /// ```
    pub fn reversed(self) -> Self {
        let (pieces, turns) = self.into_placed_pieces();
        let joints = pieces.iter().map(|piece| -piece.turn()).collect();
        let reversed = |piece: Piece| {
            let mut reversed = Piece::new(Box::new(Reversed::new(piece.shape)), piece.range.backwards());
            (reversed.offset, reversed.turns) = (-piece.offset, piece.turns);
            reversed
        };
        let mut pieces: Vec<Piece> = pieces.into_iter().rev().map(reversed).collect();
        set_joints(&mut pieces, &joints_backwards(joints));
        Self::from_placed_pieces(pieces, -turns)
    }
}

/// The turns after each piece, seen the other way: the last one is that of the closed contour's end either way.
fn joints_backwards(mut joints: Vec<f64>) -> Vec<f64> {
    let inner = joints.len() - 1;
    joints[..inner].reverse();
    joints
}

fn set_joints(pieces: &mut [Piece], joints: &[f64]) {
    for (piece, &turn) in pieces.iter_mut().zip(joints) {
        if turn != 0.0 {
            piece.set_turn(turn);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{CircularArc, Contour, Line, Parabola, StretchKind, contract};

    /// A shape with a corner, a notch, a smooth joint and a corner where it closes.
    fn closed() -> Composite {
        let line = |from, to| Box::new(Line::new(from, to).unwrap()) as Box<dyn Contour>;
        let half = CircularArc::new([1.0, 1.0], 1.0, 0.0, std::f64::consts::PI).unwrap();
        let pieces = vec![
            line([0.0, 0.0], [1.0, 0.5]),
            line([1.0, 0.5], [2.0, 0.0]),
            line([2.0, 0.0], [2.0, 1.0]),
            Box::new(half),
        ];
        Composite::joined(pieces.into_iter().chain([line([0.0, 1.0], [0.0, 0.0])]).collect()).unwrap()
    }

    fn fractions() -> Vec<f64> {
        (0..64).map(|k| (f64::from(k) + 0.3) / 64.0).collect()
    }

    #[test]
    fn a_moved_contour_is_a_contour() {
        for mirror in [false, true] {
            let motion = Motion { rotation: 0.7, translation: [1.0, -2.0], scale: 1.5, mirror };
            let (before, after) = (closed(), closed().moved(motion).unwrap());
            assert!(after.is_closed() && !after.is_cavity());
            assert_eq!(after.stretches().len(), before.stretches().len());
            contract::check(&after, &fractions()).unwrap();
            for k in 0..100 {
                let (x, y) = ((f64::from(k) * 0.7).sin() * 3.0, (f64::from(k) * 1.3).cos() * 3.0);
                let [to_x, to_y] = motion.apply([x, y]);
                let (one, two) = (before.closest(x, y), after.closest(to_x, to_y));
                assert!((1.5 * one.gap - two.gap).abs() < 1e-14 && one.interior == two.interior, "{one:?} {two:?}");
            }
        }
        let nan = Motion { rotation: f64::NAN, ..Motion::IDENTITY };
        assert!(closed().moved(nan).is_err());
    }

    #[test]
    fn a_reversed_contour_is_a_contour() {
        let (before, after) = (closed(), closed().reversed());
        assert!(after.is_cavity());
        contract::check(&after, &fractions()).unwrap();
        for k in 0..100 {
            let (x, y) = ((f64::from(k) * 0.7).sin() * 2.0, (f64::from(k) * 1.3).cos() * 2.0);
            assert_eq!(before.gap(x, y), -after.gap(x, y));
        }
        let twice = closed().reversed().reversed();
        assert_eq!(twice.stretches().map(|stretch| stretch.kind).collect::<Vec<_>>(), kinds(&before));
    }

    fn kinds(contour: &Composite) -> Vec<StretchKind> {
        contour.stretches().map(|stretch| stretch.kind).collect()
    }

    #[test]
    fn open_contours_that_go_on_for_ever() {
        let bumps = || {
            let pieces = [0.0, 0.3].map(|x| Box::new(Parabola::new([x, 0.0], 5.0).unwrap()) as Box<dyn Contour>);
            Composite::joined(pieces.into()).unwrap()
        };
        let mirrored =
            bumps().moved(Motion { rotation: std::f64::consts::PI, mirror: true, ..Motion::IDENTITY }).unwrap();
        assert_eq!(kinds(&mirrored), kinds(&bumps()));
        assert!((mirrored.gap(-0.3, -0.2) - 0.2).abs() < 1e-15);
        let below = bumps().reversed();
        assert_eq!(below.kind(1), StretchKind::Corner { before: 0 });
        assert!((below.gap(0.3, -0.2) + 0.2).abs() < 1e-15);
    }
}
