//! Points on the rod from a table `frame,x,y`.

use super::error::FilmError;
use super::options::FilmOptions;
use super::table::{Numbers, is_deviation};
use vibrissa::reconstruct::{Frame, SeenPoint};

const EXPECTED: &str = "frame, x, y, and perhaps sigma: one row a point, in order from the base to the tip";

/// Columns of a table of points that say nothing that is used; a time is not told as one.
pub(super) fn ignored(table: &Numbers) -> Vec<String> {
    let used = ["frame", "x", "y", "sigma", "t"].map(|name| table.column(name));
    table.names_where(|column| !used.contains(&Some(column)))
}

/// Frames with their numbers, in order.
pub(super) fn points(mut table: Numbers, options: &FilmOptions) -> Result<Vec<(i64, Frame)>, FilmError> {
    let [number, x, y] = ["frame", "x", "y"].map(|name| table.needed(name, EXPECTED));
    let (number, x, y, sigma) = (number?, x?, y?, table.column("sigma"));
    let mut frames: Vec<(i64, Frame)> = Vec::new();
    let mut out_of_order = None;
    let turned = if options.image { -1.0 } else { 1.0 };
    for row in 0..table.len() {
        let Some(of) = table.whole(row, number) else { continue };
        let coordinates = [x, y].map(|column| table.number(row, column));
        let sigma = sigma.and_then(|column| table.number(row, column));
        if sigma.is_some_and(|sigma| !is_deviation(sigma)) {
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
            _ => frames.push((of, options.ends.empty())),
        }
        let Some((_, frame)) = frames.last_mut() else { continue };
        let [Some(x), Some(y)] = coordinates else {
            // a point that was not seen, perhaps an end of the rod
            frame.base_is_first &= !frame.points.is_empty();
            frame.tip_is_last = false;
            continue;
        };
        frame.tip_is_last = options.ends.empty().tip_is_last;
        let scale = options.scale;
        frame.points.push(SeenPoint { x: scale * x, y: turned * scale * y, sigma: sigma.map(|sigma| scale * sigma) });
    }
    table.check()?;
    Ok(frames)
}
