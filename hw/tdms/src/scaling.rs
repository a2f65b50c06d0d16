//! From raw values to those the program that wrote the file meant: the `NI_Scale` properties.

use super::contents::ChannelContents;
use super::error::TdmsError;
use super::property::{TdmsProperties, TdmsValue};

/// Scales that take each other's results, the last one being that of the channel.
#[derive(Clone, Debug)]
pub(super) struct Scaling {
    /// None where a scale is not on the way to the last one.
    scales: Vec<Option<Scale>>,
    /// Results, to be used again from value to value.
    results: Vec<f64>,
}

#[derive(Clone, Debug)]
enum Scale {
    /// The values of a DAQmx scaler.
    Series(usize),
    Same(Input),
    Linear {
        slope: f64,
        intercept: f64,
        input: Input,
    },
    Polynomial {
        coefficients: Vec<f64>,
        input: Input,
    },
    Add(Input, Input),
    Subtract(Input, Input),
}

/// The input of a scale.
#[derive(Clone, Copy, Debug)]
enum Input {
    Raw,
    /// The result of an earlier scale.
    Scale(usize),
}

const KNOWN: &str = "Linear, Polynomial, Add, Subtract, AdvancedAPI";

impl Scaling {
    /// By the properties of the channel, its group or the file, whichever first has any; `None` if the values are meant as
    /// they are.
    pub fn new(channel: &ChannelContents, of_all: [&TdmsProperties; 3]) -> Result<Option<Self>, TdmsError> {
        let Some((properties, count)) = of_all.into_iter().find_map(|p| Some((p, count(p)?))) else { return Ok(None) };
        if properties.get("NI_Scaling_Status").and_then(TdmsValue::text) == Some("scaled") {
            return Ok(None);
        }
        let error = |scale: usize, what: String| {
            let channel = channel.name.clone();
            TdmsError::Scaling { channel, scale, what, known: KNOWN }
        };
        // each has a property or is a scaler
        if count > properties.len().saturating_add(channel.series.len()) {
            return Err(error(count, format!("the last of {count}, of which most are not described")));
        }
        let mut scales: Vec<Option<Scale>> = vec![None; count];
        let mut is_needed = vec![false; count];
        if let Some(last) = is_needed.last_mut() {
            *last = true;
        }
        for k in (0..count).rev() {
            if is_needed.get(k) != Some(&true) {
                continue;
            }
            let scale = Scale::read(k, properties, channel).map_err(|what| error(k, what))?;
            for input in scale.inputs() {
                let Input::Scale(source) = input else { continue };
                match is_needed.get_mut(source) {
                    Some(needed) if source < k => *needed = true,
                    _ => return Err(error(k, format!("one that takes scale {source}, which does not come before it"))),
                }
            }
            if let Some(place) = scales.get_mut(k) {
                *place = Some(scale);
            }
        }
        Ok(Some(Self { results: vec![0.0; count], scales }))
    }

    /// The series that it takes raw values of.
    pub fn takes(&self, series: usize) -> bool {
        self.scales.iter().flatten().any(|scale| match scale {
            Scale::Series(index) => *index == series,
            scale => series == 0 && scale.inputs().iter().any(|input| matches!(input, Input::Raw)),
        })
    }

    /// The scaled value of one raw value of each series.
    pub fn apply(&mut self, raw: &[f64]) -> f64 {
        for k in 0..self.scales.len() {
            let Some(Some(scale)) = self.scales.get(k) else { continue };
            let of = |input: &Input| match *input {
                Input::Raw => raw.first().copied(),
                Input::Scale(source) => self.results.get(source).copied(),
            };
            let of = |input: &Input| of(input).unwrap_or(f64::NAN);
            let result = match scale {
                Scale::Series(index) => raw.get(*index).copied().unwrap_or(f64::NAN),
                Scale::Same(input) => of(input),
                Scale::Linear { slope, intercept, input } => of(input) * slope + intercept,
                Scale::Polynomial { coefficients, input } => {
                    let x = of(input);
                    coefficients.iter().rev().fold(0.0, |sum, coefficient| sum * x + coefficient)
                }
                Scale::Add(left, right) => of(left) + of(right),
                // the right operand is the one that is subtracted from, as in NI's own programs
                Scale::Subtract(left, right) => of(right) - of(left),
            };
            if let Some(place) = self.results.get_mut(k) {
                *place = result;
            }
        }
        self.results.last().copied().unwrap_or(f64::NAN)
    }
}

impl Scale {
    fn read(k: usize, properties: &TdmsProperties, channel: &ChannelContents) -> Result<Self, String> {
        let find = |name: &str| properties.get(&format!("NI_Scale[{k}]_{name}"));
        let number = |name: &str| {
            find(name).and_then(TdmsValue::number).ok_or_else(|| format!("without a number NI_Scale[{k}]_{name}"))
        };
        let input = |name: &str| match find(name).map(TdmsValue::count) {
            None => Ok(Input::Raw),
            Some(Some(source)) if source == u32::MAX as usize => Ok(Input::Raw),
            Some(Some(source)) => Ok(Input::Scale(source)),
            Some(None) => Err(format!("with an NI_Scale[{k}]_{name} that is no number of a scale")),
        };
        let Some(kind) = find("Scale_Type") else {
            // the values of a scaler are a scale that the properties do not mention
            let is_it = |id: Option<u32>| id.is_some_and(|id| id as usize == k);
            let found = channel.series.iter().position(|series| is_it(series.id));
            return found.map(Self::Series).ok_or_else(|| "without a type, and no DAQmx scaler either".to_owned());
        };
        Ok(match kind.text().unwrap_or_default() {
            "Linear" => Self::Linear {
                slope: number("Linear_Slope")?,
                intercept: number("Linear_Y_Intercept")?,
                input: input("Linear_Input_Source")?,
            },
            "Polynomial" => {
                let size = find("Polynomial_Coefficients_Size").map_or(Some(4), TdmsValue::count);
                let size = size.filter(|&size| size <= properties.len());
                let size = size.ok_or_else(|| "of type Polynomial without its coefficients".to_owned())?;
                let coefficients = (0..size).map(|i| number(&format!("Polynomial_Coefficients[{i}]")));
                Self::Polynomial {
                    coefficients: coefficients.collect::<Result<_, _>>()?,
                    input: input("Polynomial_Input_Source")?,
                }
            }
            "Add" => Self::Add(input("Add_Left_Operand_Input_Source")?, input("Add_Right_Operand_Input_Source")?),
            "Subtract" => Self::Subtract(
                input("Subtract_Left_Operand_Input_Source")?,
                input("Subtract_Right_Operand_Input_Source")?,
            ),
            "AdvancedAPI" => Self::Same(input("AdvancedAPI_Input_Source")?),
            _ => return Err(format!("of type {kind}")),
        })
    }

    fn inputs(&self) -> Vec<Input> {
        match *self {
            Self::Series(_) => Vec::new(),
            Self::Same(input) | Self::Linear { input, .. } | Self::Polynomial { input, .. } => vec![input],
            Self::Add(left, right) | Self::Subtract(left, right) => vec![left, right],
        }
    }
}

/// The number of scales; `None` if there are no scales.
fn count(properties: &TdmsProperties) -> Option<usize> {
    let count = match properties.get("NI_Number_Of_Scales") {
        Some(value) => value.count()?,
        None => {
            let number =
                |name: &str| name.strip_prefix("NI_Scale[")?.strip_suffix("]_Scale_Type")?.parse::<usize>().ok();
            properties.keys().filter_map(|name| number(name)).max()?.checked_add(1)?
        }
    };
    (count > 0).then_some(count)
}
