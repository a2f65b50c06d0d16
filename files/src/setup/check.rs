//! From a document to a setup: every number checked where it stands.

use super::document::{AccuracyTable, MountingTable, SensorTable, SetupDocument, TareTable};
use super::errors::errors;
use super::field::{component, positive, units};
use super::gauges::gauges;
use super::recording::recording;
use super::{SensorCalibration, Setup, TareSetup};
use crate::StageDelay;
use crate::toml_file::{Fault, place_of};
use std::ops::Range;
use std::path::Path;
use toml::Spanned;
use toml::de::DeTable;
use vibrissa::hw::device::rdt::RdtProfile;
use vibrissa::hw::{
    Accuracy, Axis, CalibrationDataError, Component, Dimension, Frame, GeometryError, Mounting, RatedLoad, Scale,
    Sense, Wrench, WrenchUnits,
};

/// The setup of a document; files that it names are in the directory.
pub(super) fn setup(document: &SetupDocument, tree: &DeTable<'_>, directory: &Path) -> Result<Setup, Fault> {
    let SetupDocument { sensor, mounting, accuracy, tare, identification, stage, recording: played, errors: shared } =
        document;
    let table = |name| place_of(tree, name).unwrap_or(0..0);
    let (calibration, rated) = match gauges(sensor, table("sensor"), directory)? {
        Some((gauges, rated)) => (Some(SensorCalibration::Gauges(gauges)), rated),
        None => (scale(sensor, table("sensor"))?.map(SensorCalibration::Scale), None),
    };
    let (rated, class, accuracy) = trust(accuracy, rated, table("accuracy"))?;
    let half_window = identification.half_window.as_ref();
    Ok(Setup {
        profile: profile(sensor)?,
        rate: sensor.rate.as_ref().map(|rate| positive("rate", rate, "Hz")).transpose()?,
        recording: recording(played, calibration.as_ref())?,
        calibration,
        errors: shared.as_ref().map(errors).transpose()?,
        mounting: seat(mounting, table("mounting"))?,
        rated,
        class,
        accuracy,
        tare: window(tare)?,
        half_window: half_window.map(|half| positive("half_window", half, "m")).transpose()?,
        stage_delay: stage.delay.as_ref().map(delay).transpose()?,
        warnings: Vec::new(),
        files: Vec::new(),
    })
}

fn delay(field: &Spanned<f64>) -> Result<StageDelay, Fault> {
    StageDelay::new(*field.get_ref()).map_err(|error| Fault::new(field.span(), error.to_string()))
}

fn profile(table: &SensorTable) -> Result<RdtProfile, Fault> {
    let Some(name) = &table.profile else { return Ok(RdtProfile::NetFt) };
    match name.get_ref().as_str() {
        "netft" => Ok(RdtProfile::NetFt),
        "axia" => Ok(RdtProfile::Axia),
        "onrobot" => Ok(RdtProfile::OnRobot),
        other => Err(Fault::new(name.span(), format!("`{other}` is no profile, expected netft, axia or onrobot"))),
    }
}

fn scale(table: &SensorTable, place: Range<usize>) -> Result<Option<Scale>, Fault> {
    let SensorTable { counts_per_force_unit, counts_per_torque_unit, channels, .. } = table;
    let Some([force, torque]) = units(table)? else {
        let nothing = counts_per_force_unit.is_none() && counts_per_torque_unit.is_none() && channels.is_none();
        let one = table.force_unit.is_some() || table.torque_unit.is_some();
        let message = "expected both units, force_unit and torque_unit, beside counts or channels";
        return if nothing && !one { Ok(None) } else { Err(Fault::new(place, message)) };
    };
    let scale = match (counts_per_force_unit, counts_per_torque_unit) {
        (Some(f), Some(t)) => Scale::from_counts(*f.get_ref(), force, *t.get_ref(), torque).map_err(|error| {
            let of_torque = matches!(error, CalibrationDataError::CountsPerUnit { component, .. }
                if component.dimension() == Dimension::Torque);
            Fault::new(if of_torque { t.span() } else { f.span() }, error.to_string())
        })?,
        (None, None) => Scale::in_units(
            WrenchUnits::new(force, torque).map_err(|error| Fault::new(place.clone(), error.to_string()))?,
        ),
        _ => {
            return Err(Fault::new(
                place,
                "expected both counts_per_force_unit and counts_per_torque_unit, or neither",
            ));
        }
    };
    let Some(channels) = channels else { return Ok(Some(scale)) };
    let of_channel = |name| component(name, channels.span(), "Fx to Tz, or \"\" for a channel that is none").map(Some);
    let components: Result<Vec<Option<Component>>, Fault> =
        channels.get_ref().iter().map(|name| if name.is_empty() { Ok(None) } else { of_channel(name) }).collect();
    let scale = scale.with_channels(&components?).map_err(|error| Fault::new(channels.span(), error.to_string()))?;
    Ok(Some(scale))
}

fn seat(table: &MountingTable, place: Range<usize>) -> Result<Mounting, Fault> {
    let MountingTable { angle, axes, lever, lever_tolerance, sense, turns_from, .. } = table;
    let at = |span: Range<usize>| move |error: GeometryError| Fault::new(span, error.to_string());
    let frame = match (angle, axes) {
        (Some(_), Some(axes)) => {
            return Err(Fault::new(axes.span(), "given beside angle, expected one of the two"));
        }
        (Some(angle), None) => Frame::planar(angle.get_ref().to_radians()).map_err(at(angle.span()))?,
        (None, Some(names)) => {
            let axes: Result<Vec<Axis>, GeometryError> = names.get_ref().iter().map(|name| name.parse()).collect();
            let axes: [Axis; 3] = axes.map_err(at(names.span()))?.try_into().map_err(|axes: Vec<Axis>| {
                let found = axes.len();
                Fault::new(
                    names.span(),
                    format!("found {found} axes, expected three: where the sensor's x, y, z lie along"),
                )
            })?;
            Frame::from_axes(axes).map_err(at(names.span()))?
        }
        (None, None) => Frame::same(),
    };
    let frame = match lever {
        Some(lever) => {
            let origin: [f64; 3] = lever.get_ref().clone().try_into().map_err(|numbers: Vec<f64>| {
                let found = numbers.len();
                Fault::new(lever.span(), format!("found {found} numbers, expected three: [x, y, z] in m"))
            })?;
            frame.with_origin(origin).map_err(at(lever.span()))?
        }
        None => frame,
    };
    let mut mounting = Mounting::new(frame);
    if let Some(tolerance) = lever_tolerance {
        mounting = mounting.with_lever_tolerance(*tolerance.get_ref()).map_err(at(tolerance.span()))?;
    }
    if let Some(phi) = turns_from {
        mounting = mounting.turning_with_clamp(phi.get_ref().to_radians()).map_err(at(phi.span()))?;
    }
    if let Some(sense) = sense {
        mounting = mounting.with_sense(match sense.get_ref().as_str() {
            "load" => Sense::Load,
            "reaction" => Sense::Reaction,
            other => {
                let message = format!(
                    "`{other}` is no sense, expected load (what the rod does to the sensor) or reaction (what it does to the rod)"
                );
                return Err(Fault::new(sense.span(), message));
            }
        });
    }
    match (&table.most_force_across, &table.most_moment_across) {
        (Some(force), Some(moment)) => {
            mounting.with_most_out_of_plane(*force.get_ref(), *moment.get_ref()).map_err(at(force.span()))
        }
        (None, None) => Ok(mounting),
        _ => Err(Fault::new(place, "expected both most_force_across and most_moment_across, or neither")),
    }
}

type Trust = (Option<RatedLoad>, Wrench, Option<Accuracy>);

/// What is said of the accuracy; ranges that are not are those of the calibration file.
fn trust(table: &AccuracyTable, of_file: Option<RatedLoad>, place: Range<usize>) -> Result<Trust, Fault> {
    let AccuracyTable { force_range, torque_range, force_class, torque_class, force_sigma, torque_sigma } = table;
    let of = |force: &Option<Spanned<f64>>, torque: &Option<Spanned<f64>>, missing: f64| {
        let [force, torque] = [force, torque].map(|field| field.as_ref().map_or(missing, |field| *field.get_ref()));
        Wrench { force: [force; 3], torque: [torque; 3] }
    };
    // of the two fields of a pair the one that the component is of
    let pair = |force: &Option<Spanned<f64>>, torque: &Option<Spanned<f64>>, error: CalibrationDataError| {
        let dimension = match error {
            CalibrationDataError::OfComponent { component, .. } => component.dimension(),
            _ => Dimension::Force,
        };
        let field = if dimension == Dimension::Torque { torque } else { force };
        Fault::new(field.as_ref().map_or(place.clone(), Spanned::span), error.to_string())
    };
    let class = of(force_class, torque_class, 0.0);
    let mut largest = of(force_range, torque_range, f64::INFINITY);
    if let Some(Wrench { force, torque }) = of_file.map(|rated| rated.largest()) {
        largest.force = if force_range.is_some() { largest.force } else { force };
        largest.torque = if torque_range.is_some() { largest.torque } else { torque };
    }
    let rated = RatedLoad::new(largest).map_err(|error| pair(force_range, torque_range, error))?;
    let accuracy = Accuracy::of_class(&rated, class).map_err(|error| pair(force_class, torque_class, error))?;
    let sigma = match (force_sigma, torque_sigma) {
        (None, None) => None,
        (Some(_), Some(_)) => Some(of(force_sigma, torque_sigma, 0.0)),
        _ => return Err(Fault::new(place, "expected both force_sigma and torque_sigma, or neither")),
    };
    let known = force_range.is_some() || torque_range.is_some() || of_file.is_some();
    let classed = force_class.is_some() || torque_class.is_some();
    let accuracy = match sigma {
        Some(sigma) => Some(accuracy.with_sigma(sigma).map_err(|error| pair(force_sigma, torque_sigma, error))?),
        None => classed.then_some(accuracy),
    };
    Ok((known.then_some(rated), class, accuracy))
}

fn window(table: &TareTable) -> Result<TareSetup, Fault> {
    let mut tare = Setup::default().tare;
    if let Some(seconds) = &table.seconds {
        let value = *seconds.get_ref();
        if !(value.is_finite() && value >= 0.0) {
            let message = format!("seconds is {value}, expected a number of seconds, 0 for no tare");
            return Err(Fault::new(seconds.span(), message));
        }
        tare.seconds = value;
    }
    tare.change = match (&table.force_change, &table.torque_change) {
        (None, None) => None,
        (Some(force), Some(torque)) => {
            let (force, torque) = (positive("force_change", force, "N")?, positive("torque_change", torque, "N m")?);
            Some(Wrench { force: [force; 3], torque: [torque; 3] })
        }
        (Some(one), None) | (None, Some(one)) => {
            return Err(Fault::new(one.span(), "expected both force_change and torque_change, or neither"));
        }
    };
    Ok(tare)
}

#[cfg(test)]
mod tests {
    use crate::{RecordingSetup, RecordingTime, Setup};

    fn parse(text: &str) -> Result<Setup, String> {
        Setup::parse("s.toml".as_ref(), text).map_err(|error| error.to_string())
    }

    #[test]
    fn nothing_is_the_default_and_everything_is_taken() {
        let nothing = Setup { files: vec!["s.toml".into()], ..Setup::default() };
        assert_eq!(format!("{:?}", parse("").unwrap()), format!("{nothing:?}"));
        let text = "
            [sensor]\nprofile = 'axia'\nrate = 7e3\nforce_unit = 'N'\ntorque_unit = 'N mm'
            counts_per_force_unit = 1e6\ncounts_per_torque_unit = 1e3\nchannels = ['', 'Fx', 'Fy', 'Tz']
            [mounting]\nangle = 90\nlever = [0, 0.01, 0]\nlever_tolerance = 1e-4\nsense = 'reaction'\nturns_from = 90
            most_force_across = 0.1\nmost_moment_across = 1e-3
            [accuracy]\nforce_range = 2\ntorque_range = 0.05\nforce_class = 0.5\ntorque_class = 0.1
            force_sigma = 1e-3\ntorque_sigma = 1e-5
            [identification]\nhalf_window = 1e-3
            [recording]\ncolumns = ['a', 'b']\ngroup = 'g'\ntime = { rate = 500 }\ntopic = '/ft'
            [tare]\nseconds = 0\nforce_change = 1e-2\ntorque_change = 1e-3";
        let setup = parse(text).unwrap();
        assert!(
            setup.calibration.is_some()
                && setup.rated.is_some()
                && setup.accuracy.is_some()
                && setup.tare.change.is_some()
        );
        let RecordingSetup { columns, group, time, topic } = setup.recording;
        assert_eq!((columns.unwrap().len(), group.unwrap().len(), topic.unwrap().len()), (2, 1, 3));
        assert_eq!((time, setup.half_window), (RecordingTime::Rate(500.0), Some(1e-3)));
        assert_eq!((setup.rate, setup.tare.seconds, setup.class.force[0]), (Some(7e3), 0.0, 0.5));
    }

    #[test]
    fn mistakes_have_their_places() {
        for (text, message) in [
            (
                "[sensor]\nprofile = 'net'",
                "s.toml:2:11: sensor.profile: `net` is no profile, expected netft, axia or onrobot",
            ),
            ("[sensor]\nrate = 0", "s.toml:2:8: sensor.rate: rate is 0, expected a positive, finite number of Hz"),
            ("[sensor]\nforce_unit = 'N'", "s.toml:1:1: sensor: expected both units"),
            ("[sensor]\ncounts_per_force_unit = 1", "s.toml:1:1: sensor: expected both units"),
            (
                "[sensor]\nforce_unit = 'N'\ntorque_unit = 'N'",
                "s.toml:3:15: sensor.torque_unit: `N` is a unit of force, expected one of torque: N m",
            ),
            (
                "[sensor]\nforce_unit = 'N'\ntorque_unit = 'N m'\ncounts_per_force_unit = 1\ncounts_per_torque_unit = 0",
                "s.toml:5:26: sensor.counts_per_torque_unit: counts per unit of Tx are 0, expected a positive",
            ),
            (
                "[sensor]\nforce_unit = 'N'\ntorque_unit = 'N m'\nchannels = ['Fx', 'Fw']",
                "s.toml:4:12: sensor.channels: `Fw` is no component, expected Fx to Tz",
            ),
            ("[mounting]\naxes = ['x', 'y']", "s.toml:2:8: mounting.axes: found 2 axes, expected three"),
            ("[mounting]\naxes = ['x', 'y', 'w']", "s.toml:2:8: mounting.axes: no axis of this name"),
            ("[mounting]\naxes = ['x', 'y', '-z']", "s.toml:2:8: mounting.axes: the axes are left-handed"),
            ("[mounting]\naxes = ['x', 'y', 'z']\nangle = 3", "s.toml:2:8: mounting.axes: given beside angle"),
            ("[mounting]\nlever = [1]", "s.toml:2:9: mounting.lever: found 1 numbers, expected three"),
            (
                "[mounting]\nlever_tolerance = -1",
                "s.toml:2:19: mounting.lever_tolerance: the tolerance of the lever arm is -1",
            ),
            ("[mounting]\nsense = 'up'", "s.toml:2:9: mounting.sense: `up` is no sense"),
            ("[accuracy]\ntorque_range = -1", "s.toml:2:16: accuracy.torque_range: the rated load of Tx is -1"),
            ("[accuracy]\nforce_class = 1", "s.toml:2:15: accuracy.force_class: the rated load of Fx is inf, expected"),
            ("[accuracy]\nforce_sigma = 1", "s.toml:1:1: accuracy: expected both force_sigma and torque_sigma"),
            ("[tare]\nseconds = -1", "s.toml:2:11: tare.seconds: seconds is -1, expected"),
            ("[tare]\nforce_change = 1", "s.toml:2:16: tare.force_change: expected both"),
            ("[tares]", "s.toml:1:2: tares: unknown field `tares`, expected one of `sensor`"),
        ] {
            let error = parse(text).unwrap_err();
            assert!(error.starts_with(message), "{error}");
        }
    }
}
