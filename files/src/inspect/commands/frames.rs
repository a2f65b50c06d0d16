//! The command for points on a rod.

use super::{is_answered, refused, rod, start};
use crate::film::check_frames;
use crate::inspect::InspectOptions;
use crate::inspect::look::Look;
use crate::inspect::report::{Question, ReadCommand};

pub(super) fn frames(look: &mut Look, options: &InspectOptions) -> ReadCommand {
    let mut words = start("forces", &look.path, options);
    if let Some((table, guess)) = &look.table {
        let x = table.columns().iter().position(|column| column.name.eq_ignore_ascii_case("x"));
        let size = x.and_then(|x| guess.columns.get(x)).map_or(0.0, |column| column.values.range());
        let unit = x.and_then(|x| guess.columns.get(x)).and_then(|column| column.unit);
        match rod(options).map(|rod| size / rod.rod.length()) {
            Some(lengths) if (50.0..1500.0).contains(&lengths) && unit != Some("m") => {
                look.report.fact(
                    "unit",
                    format!("x spans {size:.4}, {lengths:.0} lengths of the rod in m: it is taken for mm"),
                );
                words.extend(["--scale".into(), "1e-3".into()]);
            }
            Some(lengths) if lengths > 1.5 => look.report.questions.push(Question {
                text: format!("how long is a unit of x and y? x spans {size:.4}"),
                answers: vec!["--scale METRES, as the size of a pixel, of the printed command".into()],
            }),
            None if size > 2.0 => look.report.questions.push(Question {
                text: format!("how long is a unit of x and y? x spans {size:.4}, too far for metres"),
                answers: vec!["--rod FILE compares it with the length of the rod".into()],
            }),
            _ => {}
        }
    }
    let reads = is_answered(&look.report)
        && check_frames(&look.path).map_err(|error| refused(&mut look.report, &error.to_string())).is_ok();
    ReadCommand { words, setup: None, reads }
}
