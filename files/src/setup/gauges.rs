//! From the table of a sensor to the matrix of its gauges: a calibration file, or rows.

use super::calibration::Gauges;
use super::document::SensorTable;
use super::field::{component, units};
use crate::toml_file::Fault;
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;
use toml::Spanned;
use vibrissa::hw::{
    AtiCalibration, AtiFile, CalibrationDataError, Component, GaugeMatrix, Rails, RatedLoad, WrenchUnits,
};

/// Calls a function for a number of gauges that is known only now.
macro_rules! of_count {
    ($count:expr, $of:ident($($argument:expr),*)) => {
        match $count {
            1 => Some($of::<1>($($argument),*)),
            2 => Some($of::<2>($($argument),*)),
            3 => Some($of::<3>($($argument),*)),
            4 => Some($of::<4>($($argument),*)),
            5 => Some($of::<5>($($argument),*)),
            6 => Some($of::<6>($($argument),*)),
            7 => Some($of::<7>($($argument),*)),
            8 => Some($of::<8>($($argument),*)),
            _ => None,
        }
    };
}

/// Gauges, and what a calibration file says of the largest loads; none where the sensor has neither file nor matrix.
pub(super) fn gauges(
    table: &SensorTable,
    place: Range<usize>,
    directory: &Path,
) -> Result<Option<(Gauges, Option<RatedLoad>)>, Fault> {
    let SensorTable { calibration, part, compensate, matrix, components, bias, .. } = table;
    if calibration.is_none() {
        refuse(part, "expected only beside calibration")?;
        refuse(compensate, "expected only beside calibration")?;
    }
    if matrix.is_none() {
        refuse(components, "expected only beside matrix")?;
    }
    if calibration.is_none() && matrix.is_none() {
        refuse(bias, "expected only beside calibration or matrix")?;
        return Ok(None);
    }
    const INSTEAD: &str = "given beside a calibration or matrix, expected one of the two";
    refuse(&table.counts_per_force_unit, INSTEAD)?;
    refuse(&table.counts_per_torque_unit, INSTEAD)?;
    refuse(&table.channels, INSTEAD)?;
    match (calibration, matrix) {
        (Some(file), None) => {
            refuse(&table.force_unit, "given beside a calibration, which has units of its own")?;
            refuse(&table.torque_unit, "given beside a calibration, which has units of its own")?;
            of_file(table, file, directory).map(|(gauges, rated)| Some((gauges, Some(rated))))
        }
        (None, Some(rows)) => of_rows(table, rows, place).map(|gauges| Some((gauges, None))),
        (_, Some(rows)) => Err(Fault::new(rows.span(), "given beside calibration, expected one of the two")),
        (None, None) => Ok(None),
    }
}

fn refuse<T>(field: &Option<Spanned<T>>, message: &str) -> Result<(), Fault> {
    field.as_ref().map_or(Ok(()), |field| Err(Fault::new(field.span(), message)))
}

fn of_file(table: &SensorTable, file: &Spanned<String>, directory: &Path) -> Result<(Gauges, RatedLoad), Fault> {
    let SensorTable { part, compensate, bias, .. } = table;
    let ati = AtiFile::read(&directory.join(file.get_ref())).map_err(|e| Fault::new(file.span(), e.to_string()))?;
    let found = ati.calibration(part.as_ref().map(|part| part.get_ref().as_str()));
    let found = found.map_err(|e| Fault::new(part.as_ref().unwrap_or(file).span(), e.to_string()))?;
    let compensates = found.compensates() && compensate.as_ref().is_none_or(|compensate| *compensate.get_ref());
    if compensates {
        refuse(
            bias,
            "given beside a file that compensates for temperature; leave it to the tare, or say compensate = false",
        )?;
    }
    let gauges = of_count!(found.gauges, of_calibration(found, compensates, file, bias));
    let many = || Err(Fault::new(file.span(), format!("the sensor has {} gauges, expected 1 to 8", found.gauges)));
    gauges.unwrap_or_else(many).map(|gauges| (gauges, found.rated))
}

fn of_calibration<const N: usize>(
    calibration: &AtiCalibration,
    compensates: bool,
    file: &Spanned<String>,
    bias: &Option<Spanned<Vec<f64>>>,
) -> Result<Gauges, Fault> {
    let matrix = if compensates { calibration.matrix::<N, f64>() } else { calibration.without_temperature() };
    let matrix = matrix.map_err(|error| Fault::new(file.span(), error.to_string()))?;
    // the thermometer comes last, and has no rails
    let channels = N + usize::from(compensates);
    let rails = calibration.rails.map(|[low, high]| {
        let ends: Vec<(f64, f64)> =
            (0..channels).map(|i| if i < N { (low, high) } else { (f64::NEG_INFINITY, f64::INFINITY) }).collect();
        Rails::new(&ends).map_err(|error| Fault::new(file.span(), error.to_string()))
    });
    gauges_with_bias(matrix, bias, channels, rails.transpose()?.unwrap_or_else(Rails::none))
}

type Rows = Spanned<Vec<Spanned<Vec<f64>>>>;

fn of_rows(table: &SensorTable, rows: &Rows, place: Range<usize>) -> Result<Gauges, Fault> {
    let [force, torque] = units(table)?
        .ok_or_else(|| Fault::new(place.clone(), "expected both units, force_unit and torque_unit, beside matrix"))?;
    let units = WrenchUnits::new(force, torque).map_err(|error| Fault::new(place, error.to_string()))?;
    let names = table.components.as_ref().ok_or_else(|| {
        Fault::new(rows.span(), "expected components = [..] beside it: which of Fx to Tz each of its rows is")
    })?;
    let components: Vec<Component> =
        names.get_ref().iter().map(|name| component(name, names.span(), "Fx to Tz")).collect::<Result<_, _>>()?;
    if components.len() != rows.get_ref().len() {
        let (found, expected) = (components.len(), rows.get_ref().len());
        return Err(Fault::new(
            names.span(),
            format!("found {found} components, expected {expected}: one of each row"),
        ));
    }
    let gauges = rows.get_ref().first().map_or(0, |row| row.get_ref().len());
    if let Some(other) = rows.get_ref().iter().find(|row| row.get_ref().len() != gauges) {
        let found = other.get_ref().len();
        return Err(Fault::new(other.span(), format!("found {found} numbers, expected {gauges}, as in the first row")));
    }
    let gauges = of_count!(gauges, of_matrix(rows, &components, units, &table.bias));
    gauges.unwrap_or_else(|| Err(Fault::new(rows.span(), "expected rows of 1 to 8 numbers: one of each gauge")))
}

fn of_matrix<const N: usize>(
    rows: &Rows,
    components: &[Component],
    units: WrenchUnits,
    bias: &Option<Spanned<Vec<f64>>>,
) -> Result<Gauges, Fault> {
    let elements =
        rows.get_ref().iter().map(|row| std::array::from_fn(|i| row.get_ref().get(i).copied().unwrap_or(0.0)));
    let listed: Vec<(Component, [f64; N])> = components.iter().copied().zip(elements).collect();
    let matrix = GaugeMatrix::new(&listed, units).map_err(|error| {
        let row = match error {
            CalibrationDataError::Element { component, .. }
            | CalibrationDataError::NoGauge { component }
            | CalibrationDataError::Twice { component }
            | CalibrationDataError::Dependent { component, .. } => components.iter().rposition(|c| *c == component),
            _ => None,
        };
        let span = row.and_then(|row| rows.get_ref().get(row)).map_or(rows.span(), Spanned::span);
        Fault::new(span, error.to_string())
    })?;
    gauges_with_bias(matrix, bias, N, Rails::none())
}

fn gauges_with_bias<const N: usize>(
    matrix: GaugeMatrix<N>,
    bias: &Option<Spanned<Vec<f64>>>,
    channels: usize,
    rails: Rails,
) -> Result<Gauges, Fault> {
    let matrix = match bias {
        None => matrix,
        Some(bias) => {
            let found = bias.get_ref().len();
            let values: [f64; N] = bias.get_ref().clone().try_into().map_err(|_| {
                Fault::new(bias.span(), format!("found {found} numbers, expected {N}: one of each gauge"))
            })?;
            matrix.with_bias(values).map_err(|error| Fault::new(bias.span(), error.to_string()))?
        }
    };
    Ok(Gauges { matrix: Arc::new(matrix), channels, rails })
}

#[cfg(test)]
mod tests {
    use crate::{SensorCalibration, Setup};
    use vibrissa::hw::{Calibration, Channels, Quality, RawSample, Wrench};

    /// Beside the calibration file `turned.cal`, of which there are 12 N and 0.12 N m, -10 V to 10 V.
    fn parse(text: &str) -> Result<Setup, String> {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../hw/tests/data/s.toml");
        Setup::parse(file.as_ref(), text).map_err(|error| {
            error.to_string().split_once("s.toml:").map_or_else(String::new, |(_, end)| end.to_owned())
        })
    }

    fn wrench(setup: &Setup, volts: &[f64]) -> Wrench {
        let raw = RawSample::new(0.0, Channels::new(volts).unwrap());
        setup.calibration.as_ref().unwrap().wrench(&raw).unwrap().wrench
    }

    #[test]
    fn a_calibration_file_tells_matrix_rails_and_loads() {
        let setup = parse("[sensor]\ncalibration = 'turned.cal'").unwrap();
        assert_eq!(setup.rated.unwrap().largest().components(), [12.0, 12.0, 17.0, 0.12, 0.12, 0.12]);
        let calibration = setup.calibration.as_ref().unwrap();
        let quality = |volts: f64| {
            let channels = Channels::from([0.0, 0.0, 0.0, volts, 0.0, 0.0]);
            calibration.rails().check(&RawSample::new(0.0, channels)).unwrap()
        };
        assert_eq!((quality(9.99), quality(-10.0)), (Quality::empty(), Quality::SATURATED));
        // the first column of its UserAxis, in N and N mm
        let expected = [-14.62065, -10.36122, -2.94501, -192.73072, -483.63970, 387.17245];
        for ((found, expected), unit) in wrench(&setup, &[1.0, 0.0, 0.0, 0.0, 0.0, 0.0])
            .components()
            .iter()
            .zip(expected)
            .zip([1.0, 1.0, 1.0, 1e-3, 1e-3, 1e-3])
        {
            // the file is rounded: scales have three digits
            assert!((found / unit - expected).abs() < 1e-3 * expected.abs().max(10.0), "{found} {expected}");
        }
        let ranged = parse(
            "[sensor]\ncalibration = 'turned.cal'\nbias = [1, 0, 0, 0, 0, 0]\n[accuracy]\ntorque_range = 0.05\nforce_class = 1",
        );
        let ranged = ranged.unwrap();
        assert_eq!(ranged.rated.unwrap().largest().components(), [12.0, 12.0, 17.0, 0.05, 0.05, 0.05]);
        assert_eq!(wrench(&ranged, &[1.0, 0.0, 0.0, 0.0, 0.0, 0.0]), Wrench::default());
    }

    #[test]
    fn rows_of_one_to_eight_gauges() {
        for gauges in 1..=8 {
            let row = vec!["2.0"; gauges].join(", ");
            let text =
                format!("[sensor]\nforce_unit = 'N'\ntorque_unit = 'mN m'\nmatrix = [[{row}]]\ncomponents = ['Tz']");
            let setup = parse(&text).unwrap();
            assert!(matches!(setup.calibration, Some(SensorCalibration::Gauges(ref g)) if g.channels() == gauges));
            let found = wrench(&setup, &vec![0.5; gauges]).torque[2];
            assert!((found - 1e-3 * gauges as f64).abs() < 1e-15, "{found}");
        }
    }

    #[test]
    fn mistakes_have_their_places() {
        let rows = |matrix: &str| {
            format!("[sensor]\nforce_unit = 'N'\ntorque_unit = 'N m'\ncomponents = ['Fx', 'Tz']\nmatrix = {matrix}")
        };
        let file = "[sensor]\ncalibration = 'turned.cal'\n";
        for (text, message) in [
            ("[sensor]\npart = 'x'".to_owned(), "2:8: sensor.part: expected only beside calibration"),
            ("[sensor]\nbias = [1]".to_owned(), "2:8: sensor.bias: expected only beside calibration or matrix"),
            ("[sensor]\ncomponents = ['Fx']".to_owned(), "2:14: sensor.components: expected only beside matrix"),
            (
                "[sensor]\nmatrix = [[1]]".to_owned(),
                "1:1: sensor: expected both units, force_unit and torque_unit, beside matrix",
            ),
            (rows("[[1, 2], [3]]"), "5:19: sensor.matrix[2]: found 1 numbers, expected 2, as in the first row"),
            (rows("[[1, 2]]"), "4:14: sensor.components: found 2 components, expected 1: one of each row"),
            (rows("[[1, 2], [2, 4]]"), "5:11: sensor.matrix[1]: the row of Fx is a combination of the other rows"),
            (rows("[[0, 0], [2, 4]]"), "5:11: sensor.matrix[1]: the row of Fx is zero throughout"),
            (rows("[[1], [2]]"), "5:10: sensor.matrix: 1 gauges for 2 components"),
            (rows("[[], []]"), "5:10: sensor.matrix: expected rows of 1 to 8 numbers"),
            (rows("[[1, 0], [0, 1]]\nbias = [0]"), "6:8: sensor.bias: found 1 numbers, expected 2: one of each gauge"),
            (
                rows("[[1, 0], [0, 1]]\nchannels = ['Fx']"),
                "6:12: sensor.channels: given beside a calibration or matrix",
            ),
            (rows("[[1, 0], [0, 1]]\n[recording]\ncolumns = ['a']"), "7:11: recording.columns: 1 columns, expected 2"),
            (
                rows("[[1, 0], [0, 1]]").replace("Fx", "Fw"),
                "4:14: sensor.components: `Fw` is no component, expected Fx to Tz",
            ),
            (
                format!("{file}counts_per_force_unit = 3"),
                "3:25: sensor.counts_per_force_unit: given beside a calibration",
            ),
            (format!("{file}force_unit = 'N'"), "3:14: sensor.force_unit: given beside a calibration, which has units"),
            (format!("{file}matrix = [[1]]"), "3:10: sensor.matrix: given beside calibration, expected one of the two"),
            (
                format!("{file}part = 'SI-9'"),
                "3:8: sensor.part: the file has calibrations of the part numbers SI-12-0.12, expected `SI-9`",
            ),
            ("[sensor]\ncalibration = 'turned_cal.py'".to_owned(), "2:15: sensor.calibration: "),
            ("[sensor]\ncalibration = 'none.cal'".to_owned(), "2:15: sensor.calibration: "),
            ("[recording]\ntime = { rate = -1 }".to_owned(), "2:8: recording.time: rate is -1, expected a positive"),
            ("[recording]\ntime = 3".to_owned(), "2:8: recording.time: expected \"waveform\", the name of a channel"),
            (
                "[identification]\nhalf_window = 0".to_owned(),
                "2:15: identification.half_window: half_window is 0, expected a positive",
            ),
        ] {
            let error = parse(&text).unwrap_err();
            assert!(error.starts_with(message), "{text}: {error}");
        }
    }
}
