//! Points on the rod from a table `frame,x,y`.

use super::error::FilmError;
use super::result::{Ends, FilmOptions};
use super::table::Numbers;
use vibrissa::reconstruct::{Frame, SeenPoint};

const EXPECTED: &str = "frame, x, y, and perhaps sigma: one row a point, in order from the base to the tip";

/// Frames with their numbers, in order.
pub(super) fn points(mut table: Numbers, options: &FilmOptions) -> Result<Vec<(i64, Frame)>, FilmError> {
    let [number, x, y] = ["frame", "x", "y"].map(|name| table.needed(name, EXPECTED));
    let (number, x, y, sigma) = (number?, x?, y?, table.column("sigma"));
    let mut frames: Vec<(i64, Frame)> = Vec::new();
    let mut out_of_order = None;
    let turned = if options.image { -1.0 } else { 1.0 };
    for row in 0..table.len() {
        let Some(of) = whole(&mut table, row, number) else { continue };
        let coordinates = [x, y].map(|column| table.number(row, column));
        let sigma = sigma.and_then(|column| table.number(row, column));
        if sigma.is_some_and(|sigma| !(sigma > 0.0 && sigma.is_finite())) {
            table.fault(row, "sigma is not larger than 0, expected a standard deviation, or an empty cell");
        }
        match frames.last() {
            Some((last, _)) if of == *last => {}
            Some((last, _)) if of < *last => {
                // the rest of the frame is told as one
                if out_of_order.replace(of) != Some(of) {
                    table.fault(row, &format!("frame {of} after frame {last}, expected frames in order"));
                }
            }
            _ => frames.push((of, empty(options.ends))),
        }
        let Some((_, frame)) = frames.last_mut() else { continue };
        let ends = empty(options.ends);
        let [Some(x), Some(y)] = coordinates else {
            // a point that was not seen, perhaps an end of the rod
            frame.base_is_first &= !frame.points.is_empty();
            frame.tip_is_last = false;
            continue;
        };
        frame.tip_is_last = ends.tip_is_last;
        let scale = options.scale;
        frame.points.push(SeenPoint { x: scale * x, y: turned * scale * y, sigma: sigma.map(|sigma| scale * sigma) });
    }
    table.check()?;
    Ok(frames)
}

/// A frame without points.
pub(super) fn empty(ends: Ends) -> Frame {
    Frame {
        base_is_first: matches!(ends, Ends::Base | Ends::Both),
        tip_is_last: matches!(ends, Ends::Tip | Ends::Both),
        ..Frame::default()
    }
}

/// The number of a frame.
pub(super) fn whole(table: &mut Numbers, row: usize, column: usize) -> Option<i64> {
    let number = table.number(row, column);
    match number {
        Some(number) if number.fract() == 0.0 && number.abs() < 9e15 => Some(number as i64),
        Some(number) => {
            table.fault(row, &format!("frame is {number}, expected a whole number"));
            None
        }
        None => {
            if table.is_empty(row, column) {
                table.fault(row, "frame is empty, expected a whole number");
            }
            None
        }
    }
}
