//! Answers to samples as rows of an array.

use crate::array::{Column, Get};
use std::borrow::Cow;
use vibrissa::reconstruct::{Basis, Reading, Reason, Touch};
use vibrissa::{Label, Pose};

/// The answer to a sample; none where the sample cannot be used.
pub struct Answer {
    pub pose: Pose,
    pub reading: Option<Reading>,
    /// What decided on the label, where that is known.
    pub basis: Option<Basis>,
}

impl Answer {
    fn first(&self) -> Option<&Touch> {
        self.reading.as_ref()?.touch.as_ref().ok()
    }

    fn second(&self) -> Option<&Touch> {
        self.reading.as_ref()?.second.as_ref()?.as_ref().ok()
    }

    fn reason(&self) -> Option<&Reason> {
        self.reading.as_ref()?.touch.as_ref().err()
    }

    fn second_reason(&self) -> Option<&Reason> {
        self.reading.as_ref()?.second.as_ref()?.as_ref().err()
    }
}

fn of(touch: Option<&Touch>, number: impl Fn(&Touch) -> f64) -> f64 {
    touch.map_or(f64::NAN, number)
}

fn text(reason: Option<&Reason>) -> Cow<'static, str> {
    reason.map_or(Cow::Borrowed(""), |reason| reason.to_string().into())
}

/// The name of a label, without making a text of its own for each of many rows.
fn label_name(label: Label) -> &'static str {
    match label {
        Label::Free => "free",
        Label::A => "A",
        Label::B => "B",
        Label::BA => "BA",
        Label::BB => "BB",
    }
}

fn deviation(variance: f64) -> f64 {
    variance.max(0.0).sqrt()
}

/// The columns of the command's `points.jsonl`; those of the second contact begin with `second_`. The reasons come last.
pub const ANSWER: &[Column<Answer>] = &[
    Column { name: "x0", get: Get::Float(|row| row.pose.x) },
    Column { name: "y0", get: Get::Float(|row| row.pose.y) },
    Column { name: "phi0", get: Get::Float(|row| row.pose.phi) },
    Column { name: "label", get: Get::Text(|row| row.reading.map_or("", |reading| label_name(reading.label)).into()) },
    Column { name: "probability", get: Get::Float(|row| row.reading.map_or(f64::NAN, |reading| reading.probability)) },
    Column {
        name: "basis",
        get: Get::Text(|row| row.basis.map_or(Cow::Borrowed(""), |basis| basis.to_string().into())),
    },
    Column { name: "x", get: Get::Float(|row| of(row.first(), |touch| touch.x)) },
    Column { name: "y", get: Get::Float(|row| of(row.first(), |touch| touch.y)) },
    Column { name: "s", get: Get::Float(|row| of(row.first(), |touch| touch.s)) },
    Column { name: "alpha", get: Get::Float(|row| of(row.first(), |touch| touch.alpha)) },
    Column { name: "force", get: Get::Float(|row| of(row.first(), |touch| touch.force)) },
    Column { name: "sigma_x", get: Get::Float(|row| of(row.first(), |touch| deviation(touch.covariance[(0, 0)]))) },
    Column { name: "sigma_y", get: Get::Float(|row| of(row.first(), |touch| deviation(touch.covariance[(1, 1)]))) },
    Column {
        name: "systematic_x",
        get: Get::Float(|row| of(row.first(), |touch| deviation(touch.systematic[(0, 0)]))),
    },
    Column {
        name: "systematic_y",
        get: Get::Float(|row| of(row.first(), |touch| deviation(touch.systematic[(1, 1)]))),
    },
    Column { name: "second_x", get: Get::Float(|row| of(row.second(), |touch| touch.x)) },
    Column { name: "second_y", get: Get::Float(|row| of(row.second(), |touch| touch.y)) },
    Column { name: "second_s", get: Get::Float(|row| of(row.second(), |touch| touch.s)) },
    Column { name: "second_alpha", get: Get::Float(|row| of(row.second(), |touch| touch.alpha)) },
    Column { name: "second_force", get: Get::Float(|row| of(row.second(), |touch| touch.force)) },
    Column {
        name: "second_sigma_x",
        get: Get::Float(|row| of(row.second(), |touch| deviation(touch.covariance[(0, 0)]))),
    },
    Column {
        name: "second_sigma_y",
        get: Get::Float(|row| of(row.second(), |touch| deviation(touch.covariance[(1, 1)]))),
    },
    Column { name: "reason", get: Get::Text(|row| text(row.reason())) },
    Column { name: "second_reason", get: Get::Text(|row| text(row.second_reason())) },
];

/// The columns of [`ANSWER`] in two parts. The second tells why there is no contact point. Its texts are wide: of many rows, they are made only
/// when they are asked for.
pub fn numbers_and_reasons() -> (&'static [Column<Answer>], &'static [Column<Answer>]) {
    ANSWER.split_at(ANSWER.len() - 2)
}
