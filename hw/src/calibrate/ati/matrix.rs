//! The matrix of a calibration file.

use super::element::Element;
use super::{AtiFileError, CalibrationDataError};
use crate::calibrate::WrenchUnits;
use crate::sample::{Channels, Component, Dimension, Wrench};
use core::array::from_fn;
use nalgebra::{Rotation3, Vector3};

type Row = [f64; Channels::MOST];
/// Rows, and the largest loads.
type Matrix = (Vec<(Component, Row)>, [f64; 6]);

/// The rows of `Axis` or of `UserAxis`, in the units of the file.
struct Rows {
    rows: [Option<(u32, Row)>; 6],
    /// To how much the rows are rounded: half a unit of the last decimal.
    rounding: [f64; 6],
    largest: [f64; 6],
}

impl Rows {
    fn of(element: Element<'_>, name: &'static str, gauges: usize) -> Result<Self, AtiFileError> {
        let mut found = Self { rows: [None; 6], rounding: [0.0; 6], largest: [f64::INFINITY; 6] };
        for axis in element.children(name) {
            let component = axis.attribute("Name").and_then(Component::parse);
            let component = component.ok_or_else(|| axis.wrong("Name", "one of Fx, Fy, Fz, Tx, Ty, Tz"))?;
            let scale = axis.number("scale")?.unwrap_or(1.0);
            if scale <= 0.0 {
                return Err(axis.wrong("scale", "a positive number"));
            }
            let (values, decimals) = axis.numbers("values", gauges)?;
            let row = from_fn(|i| values.get(i).map_or(0.0, |value| value / scale));
            let i = component.index();
            if found.rows[i].replace((axis.line(), row)).is_some() {
                let error = CalibrationDataError::Twice { component };
                return Err(AtiFileError::Data { line: axis.line(), error });
            }
            found.rounding[i] = 0.5 * 10_f64.powi(-decimals) / scale;
            // ATI's own library takes a missing rating for 0
            match axis.number("max")? {
                Some(largest) if largest < 0.0 => return Err(axis.wrong("max", "a number that is not negative")),
                Some(largest) if largest > 0.0 => found.largest[i] = largest,
                _ => {}
            }
        }
        Ok(found)
    }

    fn components(&self) -> impl Iterator<Item = Component> {
        Component::ALL.into_iter().filter(|c| self.rows[c.index()].is_some())
    }

    fn values(&self) -> [Row; 6] {
        self.rows.map(|row| row.map_or([0.0; Channels::MOST], |(_, row)| row))
    }
}

/// Rows per volt in SI, and rated loads in the units of the file. The rows are those of `Axis` over `scale`, moved by
/// `BasicTransform`, which have more digits than `UserAxis`; where that is there, too, it must say the same.
pub(super) fn rows(element: Element<'_>, gauges: usize, units: WrenchUnits) -> Result<Matrix, AtiFileError> {
    let (axes, user) = (Rows::of(element, "Axis", gauges)?, Rows::of(element, "UserAxis", gauges)?);
    let si = |rows: [Row; 6]| Component::ALL.map(|c| rows[c.index()].map(|v| v * units.factor(c)));
    let listed = |rows: [Row; 6], of: &Rows| of.components().map(|c| (c, rows[c.index()])).collect();
    let largest = from_fn(|i| user.largest[i].min(axes.largest[i]));
    if axes.components().next().is_none() {
        if user.components().next().is_none() {
            let found = "`Calibration` has neither `Axis` nor `UserAxis`".to_owned();
            return Err(AtiFileError::Element { line: element.line(), found, expected: "rows of a matrix" });
        }
        return Ok((listed(si(user.values()), &user), largest));
    }
    let transform = Transform::of(element)?;
    if transform != Transform::NONE && axes.components().count() < 6 {
        let found = "a `BasicTransform` of a sensor with less than six axes".to_owned();
        return Err(AtiFileError::Element { line: element.line(), found, expected: "six `Axis`" });
    }
    let moved = transform.applied(si(axes.values()));
    for component in user.components() {
        let (i, unit) = (component.index(), units.factor(component));
        let Some((line, found)) = user.rows[i] else { continue };
        let rounding = user.rounding[i] + transform.rounding(component, &axes.rounding, units) / unit;
        for (gauge, (&found, expected)) in found.iter().zip(moved[i]).enumerate() {
            let expected = expected / unit;
            // twice: numbers of a calibration are rounded in single precision, too
            if (found - expected).abs() > 2.0 * rounding {
                return Err(AtiFileError::UserAxis { line, component, gauge: gauge + 1, found, expected });
            }
        }
    }
    Ok((listed(moved, &axes), largest))
}

/// From the origin that a sensor is calibrated at to that of its user.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Transform {
    /// m
    shift: [f64; 3],
    /// rad, about x, then y, then z.
    turn: [f64; 3],
}

impl Transform {
    const NONE: Self = Self { shift: [0.0; 3], turn: [0.0; 3] };

    fn of(element: Element<'_>) -> Result<Self, AtiFileError> {
        let Some(child) = element.child("BasicTransform")? else { return Ok(Self::NONE) };
        let mut transform = Self::NONE;
        for (place, name) in transform.shift.iter_mut().zip(["Dx", "Dy", "Dz"]) {
            *place = child.number(name)?.unwrap_or(0.0);
        }
        for (place, name) in transform.turn.iter_mut().zip(["Rx", "Ry", "Rz"]) {
            *place = child.number(name)?.unwrap_or(0.0);
        }
        if transform == Self::NONE {
            return Ok(transform);
        }
        let metres = element.unit("DistUnits", Dimension::Length, None)?.factor;
        let radians = element.unit("AngleUnits", Dimension::Angle, Some("degrees"))?.factor;
        Ok(Self { shift: transform.shift.map(|d| d * metres), turn: transform.turn.map(|r| r * radians) })
    }

    /// Forces R F, torques R (M - d x F).
    fn applied(&self, rows: [Row; 6]) -> [Row; 6] {
        let [x, y, z] = self.turn.map(|angle| -angle);
        let turn = Rotation3::from_euler_angles(x, y, z);
        let columns: [[f64; 6]; Channels::MOST] = from_fn(|j| {
            let Wrench { force, torque } = Wrench::from_components(rows.map(|row| row[j])).about(self.shift);
            let [force, torque] = [force, torque].map(|vector| (turn * Vector3::from(vector)).into());
            Wrench { force, torque }.components()
        });
        from_fn(|i| columns.map(|column| column[i]))
    }

    /// How far a row may be off, in SI, where the rows before are rounded to so much in their units.
    fn rounding(&self, component: Component, rows: &[f64; 6], units: WrenchUnits) -> f64 {
        let of = |dimension| {
            let same = Component::ALL.into_iter().filter(move |c| c.dimension() == dimension);
            same.map(|c| rows[c.index()] * units.factor(c)).sum::<f64>()
        };
        // without a turn a row is not mixed with its like
        let own = rows[component.index()] * units.factor(component);
        let alike = if self.turn == [0.0; 3] { own } else { of(component.dimension()) };
        let lever: f64 = self.shift.iter().map(|d| d.abs()).sum();
        if component.dimension() == Dimension::Torque { alike + lever * of(Dimension::Force) } else { alike }
    }
}
