//! Calibration files of ATI.

use rod_hw::*;
use std::path::Path;

/// Of no real sensor; written by the script beside it, which knows another way to `UserAxis`.
const TURNED: &str = include_str!("../../data/turned.cal");

fn parse(change: impl Fn(&str) -> String) -> Result<AtiFile, String> {
    AtiFile::parse(&change(TURNED)).map_err(|error| error.to_string())
}

fn refused(from: &str, to: &str) -> String {
    assert!(TURNED.contains(from), "{from}");
    parse(|text| text.replacen(from, to, 1)).unwrap_err()
}

fn without(lines: &str) -> String {
    TURNED.lines().filter(|line| !line.contains(lines)).map(|line| format!("{line}\n")).collect()
}

fn wrench(file: &AtiFile) -> [f64; 6] {
    let matrix = file.calibration(None).unwrap().matrix::<6, f64>().unwrap();
    matrix.wrench(&RawSample::new(0.0, Channels::from([0.1, -0.2, 0.3, -0.4, 0.5, -0.6]))).unwrap().wrench.components()
}

fn assert_near(found: [f64; 6], tolerance: [f64; 2]) {
    for (i, (found, expected)) in found.iter().zip(PRINTED).enumerate() {
        assert!((found - expected).abs() < tolerance[i / 3], "{i}: {found} {expected}");
    }
}

/// What the script prints.
const PRINTED: [f64; 6] =
    [-3.04329784198, -9.20003380537, -31.2924297802, 0.617398126367, -1.22857376309, 0.0708333174159];

#[test]
fn forces_are_those_of_the_script() {
    let file = AtiFile::parse(TURNED).unwrap();
    assert_near(wrench(&file), [1e-9, 1e-11]);
    let calibration = file.calibration(Some("SI-12-0.12")).unwrap();
    assert_eq!((file.serial.as_str(), calibration.date.as_str(), calibration.gauges), ("FT00000", "1/2/2003", 6));
    assert_eq!(calibration.rated.largest().components(), [12.0, 12.0, 17.0, 0.12, 0.12, 0.12]);
    assert_eq!((calibration.rails, calibration.compensates()), (Some([-10.0, 10.0]), false));
    // `UserAxis` alone, as some files have it, is the same to its digits; so is `Axis` alone, as version 1.0 has it
    let user = without("<Axis").replace("BasicTransform", "Other");
    assert_near(wrench(&AtiFile::parse(&user).unwrap()), [2e-5, 2e-8]);
    assert_near(wrench(&AtiFile::parse(&without("<UserAxis")).unwrap()), [1e-9, 1e-11]);
    // of a file that says N-m, torques are a thousand times as large, if the shift does not tell that this is wrong
    let error = refused("N-mm", "N-m");
    assert!(error.starts_with("line 15: `UserAxis` Tx of gauge 1 is"), "{error}");
    let metres = AtiFile::parse(&user.replace("N-mm", "N-m")).unwrap();
    assert_eq!(metres.calibrations[0].rated.largest().torque[2], 120.0);
    assert!((wrench(&metres)[5] / wrench(&AtiFile::parse(&user).unwrap())[5] - 1000.0).abs() < 1e-9);
}

#[test]
fn temperature_needs_the_thermistor() {
    let slopes =
        "<BiasSlope values=\"1e-3 0 0 0 0 0\"/><GainSlope values=\"0 0 0 0.01 0 0\"/><Thermistor value=\"2.5\"/>";
    let with = |slopes: &str| parse(|text| text.replace("<BasicTransform", &format!("{slopes}<BasicTransform")));
    let file = with(slopes).unwrap();
    let calibration = file.calibration(None).unwrap();
    let matrix = calibration.matrix::<6, f64>().unwrap();
    let gauges = [0.1, -0.2, 0.3, -0.4, 0.5, -0.6];
    let of = |t: f64| {
        let channels = [gauges[0], gauges[1], gauges[2], gauges[3], gauges[4], gauges[5], t];
        matrix.wrench(&RawSample::new(0.0, Channels::from(channels))).unwrap().wrench.components()
    };
    assert_near(of(2.5), [1e-9, 1e-11]);
    // by the formula of the maker's library
    let compensated = [0.1 + 1e-3 * 2.0, -0.2, 0.3, -0.4 / (1.0 - 0.01 * 2.0), 0.5, -0.6];
    let plain = calibration.without_temperature::<6, f64>().unwrap();
    let expected = plain.wrench(&RawSample::new(0.0, Channels::from(compensated))).unwrap().wrench.components();
    for (found, expected) in of(4.5).iter().zip(expected) {
        assert!((found - expected).abs() < 1e-12, "{found} {expected}");
    }
    let six = RawSample::new(0.0, Channels::from(gauges));
    assert_eq!(matrix.wrench(&six), Err(CalibrationError::Channels { found: 6, expected: 7 }));
    assert_near(plain.wrench(&six).unwrap().wrench.components(), [1e-9, 1e-11]);
    let zeros = "<BiasSlope values=\"0 0 0 0 0 0\"/><Thermistor value=\"0\"/>";
    assert!(!with(zeros).unwrap().calibrations[0].compensates());
    let error = with("<GainSlope values=\"0 0 0 0.01 0 0\"/>").unwrap_err();
    assert!(error.starts_with("line 4: slopes of temperature without a `Thermistor`, expected its value"), "{error}");
    let error = with("<GainSlope values=\"0 0 0 0.01 0\"/>").unwrap_err();
    assert!(error.contains("`values` of `GainSlope` is `0 0 0 0.01 0`, expected 6 numbers"), "{error}");
}

#[test]
fn bad_files_are_refused_with_line_and_element() {
    for (from, to, expected) in [
        ("  3.63015 ", "  3.63025 ", "line 12: `UserAxis` Fx of gauge 2 is 3.63025, but `Axis`, `scale` and "),
        ("<FTSensor", "<Sensor", "line 19: "),
        // 3 kB of entities of entities would be 100 MB of text
        (
            "<FTSensor",
            "<!DOCTYPE FTSensor [<!ENTITY a \"&b;&b;\">]><FTSensor",
            "line 3: an entity is declared, expected none; is it a .cal file",
        ),
        (
            "NumGages=\"6\"",
            "NumGages=\"17\"",
            "line 3: `NumGages` of `FTSensor` is `17`, expected a number from 1 to 16",
        ),
        ("NumGages=\"6\"", "", "line 3: `NumGages` of `FTSensor` is missing, expected a number from 1 to 16"),
        ("NumGages=\"6\"", "NumGages=\"5\"", "line 5: `values` of `Axis` is `"),
        ("Serial=\"FT00000\" ", "", "line 3: `Serial` of `FTSensor` is missing, expected a text"),
        (
            "\"N-mm\"",
            "\"mm\"",
            "line 4: `TorqueUnits` of `Calibration` is `mm`, expected a unit: `mm` is a unit of length, ",
        ),
        (
            "ForceUnits=\"N\" ",
            "",
            "line 4: `ForceUnits` of `Calibration` is missing, expected a unit: `` is not a known unit",
        ),
        (
            "DistUnits=\"mm\"",
            "DistUnits=\"furlong\"",
            "line 4: `DistUnits` of `Calibration` is `furlong`, expected a unit: ",
        ),
        ("scale=\"0.748\"", "scale=\"0\"", "line 7: `scale` of `Axis` is `0`, expected a positive number"),
        (
            "scale=\"0.748\"",
            "scale=\"0,748\"",
            "line 7: `scale` of `Axis` is `0,748`, expected a number with a decimal point",
        ),
        ("scale=\"0.748\"", "scale=\"nan\"", "line 7: `scale` of `Axis` is `nan`, expected a number"),
        ("max=\"17\"", "max=\"-17\"", "line 7: `max` of `Axis` is `-17`, expected a number that is not negative"),
        (
            "Axis Name=\"Ty\"",
            "Axis Name=\"Tq\"",
            "line 9: `Name` of `Axis` is `Tq`, expected one of Fx, Fy, Fz, Tx, Ty, Tz",
        ),
        ("Axis Name=\"Ty\"", "Axis Name=\"Tx\"", "line 9: Tx is given twice, expected at most once"),
        ("Dz=\"12.0142\"", "Dz=\"12.1\"", "line 15: `UserAxis` Tx of gauge 1 is "),
        (
            "OutputRange=\"20\"",
            "OutputRange=\"-20\"",
            "line 4: `OutputRange` of `Calibration` is `-20`, expected a positive",
        ),
        (
            "<BasicTransform",
            "<BasicTransform/><BasicTransform",
            "line 11: a second `BasicTransform`, expected one at most",
        ),
        ("</Calibration>", "", "line 19: "),
    ] {
        let error = refused(from, to);
        assert!(error.starts_with(expected), "{from} to {to}: {error}");
    }
    let error = parse(|text| text.replace("FTSensor", "netft")).unwrap_err();
    assert_eq!(error, "line 3: the file is of a `netft`, expected `FTSensor`, as in .cal files of ATI");
    let error = parse(|text| text.replace("Calibration", "Other")).unwrap_err();
    assert_eq!(error, "line 3: `FTSensor` has no `Calibration`, expected at least one");
    let error = AtiFile::parse(&without("Axis Name")).unwrap_err().to_string();
    assert_eq!(error, "line 4: `Calibration` has neither `Axis` nor `UserAxis`, expected rows of a matrix");
    let error = AtiFile::parse(&without("Axis Name=\"Tz")).unwrap_err().to_string();
    assert_eq!(error, "line 4: a `BasicTransform` of a sensor with less than six axes, expected six `Axis`");
    // two rows the same, where nothing else tells
    let fx = TURNED.lines().find(|line| line.contains("<Axis Name=\"Fx\"")).unwrap();
    let same =
        without("UserAxis").replace("Name=\"Fy\"", "Name=\"\"").replace(fx, &format!("{fx}{}", fx.replace("Fx", "Fy")));
    let same: String =
        same.lines().filter(|line| !line.contains("Name=\"\"")).map(|line| format!("{line}\n")).collect();
    let error = AtiFile::parse(&same).unwrap_err().to_string();
    assert!(
        error.starts_with("line 4: the row of ") && error.contains("is a combination of the other rows"),
        "{error}"
    );
    assert!(AtiFile::parse("").unwrap_err().to_string().starts_with("line 1: "));
    // a byte order mark is none of the text
    assert!(AtiFile::parse(&format!("\u{feff}{TURNED}")).is_ok());
    assert!(parse(|text| text.replace("<FTSensor", "<!DOCTYPE FTSensor>\n<FTSensor")).is_ok());
}

#[test]
fn one_of_several_is_named() {
    let calibration = TURNED.split_once("\t<Calibration").unwrap().1.split_once("</FTSensor>").unwrap().0;
    let second = calibration.replace("SI-12-0.12", "SI-25-0.25");
    let file = parse(|text| text.replace("</FTSensor>", &format!("\t<Calibration{second}</FTSensor>"))).unwrap();
    assert_eq!(file.calibration(Some("SI-25-0.25")).unwrap().part_number, "SI-25-0.25");
    let message = |part| file.calibration(part).unwrap_err().to_string();
    assert_eq!(
        message(None),
        "the file has calibrations of the part numbers SI-12-0.12, SI-25-0.25, expected one of them by its part number"
    );
    assert_eq!(
        message(Some("US-3-1")),
        "the file has calibrations of the part numbers SI-12-0.12, SI-25-0.25, expected `US-3-1`"
    );
    let error = file.calibrations[0].matrix::<7, f64>().unwrap_err().to_string();
    assert_eq!(error, "the sensor has 6 gauges, expected 7");
}

#[test]
fn files_that_are_not_there() {
    let error = AtiFile::read(Path::new("/no/such.cal")).unwrap_err().to_string();
    assert!(error.starts_with("/no/such.cal: cannot be read: "), "{error}");
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/turned.cal");
    assert_eq!(AtiFile::read(&file), AtiFile::parse(TURNED));
    let foot = Unit::find("ft").unwrap();
    assert_eq!(foot.factor, 0.3048);
}
