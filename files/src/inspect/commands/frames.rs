//! The command for points on a rod.

use super::{is_answered, refused, rod, start};
use crate::film::check_frames;
use crate::inspect::InspectOptions;
use crate::inspect::look::Look;
use crate::inspect::report::{Question, ReadCommand};
use crate::inspect::tracked::RULER;
use vibrissa::hw::recording::Table;

pub(super) fn frames(look: &mut Look, options: &InspectOptions) -> ReadCommand {
    let mut words = start("forces", &look.path, options);
    if let Some((table, guess)) = &look.table {
        let x = table.columns().iter().position(|column| column.name.eq_ignore_ascii_case("x"));
        let size = x.and_then(|x| guess.columns.get(x)).map_or(0.0, |column| column.values.range());
        let unit = x.and_then(|x| guess.columns.get(x)).and_then(|column| column.unit);
        let length = rod(options).map(|rod| rod.rod.length());
        match length.map(|length| size / length) {
            Some(lengths) if (50.0..1500.0).contains(&lengths) && unit != Some("m") => {
                look.report.fact(
                    "unit",
                    format!(
                        "x spans {size:.4}, {lengths:.0} lengths of the rod in m: it is taken for mm; of pixels, give another --scale"
                    ),
                );
                words.extend(["--scale".into(), "1e-3".into()]);
            }
            Some(lengths) if lengths > 1.5 => {
                let whole = length.zip(longest(table)).map(|(length, points)| {
                    format!("METRES is {:.2e} if the longest frame shows the whole rod", length / points)
                });
                ask(look, size, whole);
                words.extend(["--scale".into(), "METRES".into()]);
            }
            None if size > 2.0 => {
                ask(look, size, Some("--rod FILE compares it with the length of the rod".into()));
                words.extend(["--scale".into(), "METRES".into()]);
            }
            _ => {}
        }
    }
    let reads = is_answered(&look.report)
        && check_frames(&look.path).map_err(|error| refused(&mut look.report, &error.to_string())).is_ok();
    ReadCommand { words, setup: None, reads }
}

/// Asks for the scale of points that cannot be in m.
fn ask(look: &mut Look, size: f64, other: Option<String>) {
    let answers = [
        "of pixels: --scale METRES of the printed command is the size of a pixel, and --image if y counts down"
            .to_owned(),
        RULER.to_owned(),
    ];
    look.report.questions.push(Question {
        text: format!("how long is a unit of x and y? x spans {size:.4}, too far for metres: these may be pixels"),
        answers: answers.into_iter().chain(other).chain(["of mm: --scale 1e-3".to_owned()]).collect(),
    });
}

/// Length of the points of a frame one after the other, of the longest frame.
fn longest(table: &Table) -> Option<f64> {
    let place = |name: &str| table.columns().iter().position(|column| column.name.eq_ignore_ascii_case(name));
    let (frame, x, y) = (place("frame")?, place("x")?, place("y")?);
    let rows = table.rows().filter_map(|row| Some([row.number(frame).ok()?, row.number(x).ok()?, row.number(y).ok()?]));
    let (mut last, mut length, mut longest): (Option<[f64; 3]>, f64, f64) = (None, 0.0, 0.0);
    for [frame, x, y] in rows {
        length = match last {
            Some([before, from_x, from_y]) if before == frame => length + (x - from_x).hypot(y - from_y),
            _ => 0.0,
        };
        longest = longest.max(length);
        last = Some([frame, x, y]);
    }
    (longest > 0.0).then_some(longest)
}
