//! Rigid transforms of wrenches between the sensor's frame and the scene's.

use super::GeometryError;
use crate::sample::{Number, Wrench};
use core::array::from_fn;
use core::str::FromStr;
use nalgebra::{Matrix3, Vector3};

/// How axes and their origin lie to others: from the sensor's to those of the scene at the clamp, say.
///
/// A vector v becomes R v. A wrench (F, M) becomes (R F, R (M - d x F)), d the new origin as seen from the old one, in the old axes.
///
/// ```
/// use rod_hw::{Axis, Frame, Wrench};
/// // the sensor's x points down, its z along the scene's z; the clamp sits 12 mm in front of it
/// let frame: Frame = Frame::from_axes([Axis::MinusY, Axis::X, Axis::Z])?.with_origin([0.0, 0.012, 0.0])?;
/// let found = frame.wrench(&Wrench { force: [-0.5, 0.0, 0.0], torque: [0.0, 0.0, 7e-3] });
/// assert_eq!(found.force, [0.0, 0.5, 0.0]);
/// assert!((found.torque[2] - 1e-3).abs() < 1e-12); // 7 mN m less 0.5 N at 12 mm
/// # Ok::<(), rod_hw::GeometryError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame<T = f64> {
    rotation: Matrix3<T>,
    origin: Vector3<T>,
}

/// One of the scene's axes, or its opposite. As text: `x`, `-x`, `y`, ...
///
/// ```
/// use rod_hw::Axis;
/// assert_eq!("-y".parse(), Ok(Axis::MinusY));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// Along x.
    X,
    /// Against x.
    MinusX,
    /// Along y.
    Y,
    /// Against y.
    MinusY,
    /// Along z.
    Z,
    /// Against z.
    MinusZ,
}

impl<T: Number> Frame<T> {
    /// The axes and the origin themselves.
    pub fn same() -> Self {
        Self { rotation: Matrix3::identity(), origin: Vector3::zeros() }
    }

    /// Old axes that are the new ones turned by `angle` (rad) about z: the planar case.
    ///
    /// ```
    /// use rod_hw::{Frame, Wrench};
    /// let frame = Frame::planar(std::f64::consts::FRAC_PI_2)?;
    /// let along_x = Wrench { force: [1.0, 0.0, 0.0], torque: [0.0; 3] };
    /// assert!((frame.wrench(&along_x).force[1] - 1.0).abs() < 1e-15); // the sensor's x is the scene's y
    /// # Ok::<(), rod_hw::GeometryError>(())
    /// ```
    ///
    /// # Errors
    /// [`GeometryError::Value`] where the angle is no number.
    pub fn planar(angle: T) -> Result<Self, GeometryError> {
        number("the angle", angle)?;
        Ok(Self::same().turned(angle))
    }

    /// Old axes x, y, z that point along these new ones.
    ///
    /// # Errors
    /// [`GeometryError::SameAxis`], [`GeometryError::LeftHanded`].
    pub fn from_axes(axes: [Axis; 3]) -> Result<Self, GeometryError> {
        let [x, y, z] = axes.map(|axis| Vector3::from(axis.direction()));
        match x.cross(&y).dot(&z) {
            0.0 => Err(GeometryError::SameAxis),
            ..0.0 => Err(GeometryError::LeftHanded),
            _ => Ok(Self { rotation: Matrix3::from_columns(&[x, y, z]).map(T::from_f64), ..Self::same() }),
        }
    }

    /// With the new origin here, m, as seen from the old one and in the old axes: the lever arm.
    ///
    /// # Errors
    /// [`GeometryError::Value`] where it is no number.
    pub fn with_origin(self, origin: [T; 3]) -> Result<Self, GeometryError> {
        for component in origin {
            number("a component of the lever arm", component)?;
        }
        Ok(Self { origin: origin.into(), ..self })
    }

    /// The new origin as seen from the old one, in the old axes, m.
    pub fn origin(&self) -> [T; 3] {
        self.origin.into()
    }

    /// A wrench in the old axes about the old origin, in the new axes about the new one.
    pub fn wrench(&self, old: &Wrench<T>) -> Wrench<T> {
        let Wrench { force, torque } = old.about(self.origin());
        let [force, torque] = [force, torque].map(|vector| (self.rotation * Vector3::from(vector)).into());
        Wrench { force, torque }
    }

    /// The way back.
    ///
    /// ```
    /// use rod_hw::{Axis, Frame, Wrench};
    /// let frame: Frame = Frame::from_axes([Axis::Z, Axis::X, Axis::Y])?.with_origin([0.1, 0.2, 0.3])?;
    /// let wrench = Wrench::from_components([1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
    /// let back = frame.inverse().wrench(&frame.wrench(&wrench));
    /// assert!((back - wrench).components().iter().all(|c| c.abs() < 1e-14));
    /// # Ok::<(), rod_hw::GeometryError>(())
    /// ```
    pub fn inverse(&self) -> Self {
        let origin = (self.rotation * self.origin).map(|c| -c);
        Self { rotation: self.rotation.transpose(), origin }
    }

    /// All of it turned by `angle` (rad) about the new z axis at the new origin.
    pub(super) fn turned(&self, angle: T) -> Self {
        let (sin, cos) = angle.sin_cos();
        let [x, y, z] = [0, 1, 2].map(|i| self.rotation.row(i).into_owned());
        Self { rotation: Matrix3::from_rows(&[x * cos - y * sin, x * sin + y * cos, z]), ..*self }
    }

    /// The six rows that take (F, M) to the new components.
    pub(crate) fn rows(&self) -> [[T; 6]; 6] {
        let zero = T::from_f64(0.0);
        from_fn(|i| {
            let row = self.rotation.row(i % 3).transpose();
            if i < 3 {
                return [row[0], row[1], row[2], zero, zero, zero];
            }
            // r . (M - d x F) = r . M - (r x d) . F
            let lever = row.cross(&self.origin);
            [-lever[0], -lever[1], -lever[2], row[0], row[1], row[2]]
        })
    }
}

impl Axis {
    fn direction(self) -> [f64; 3] {
        match self {
            Self::X => [1.0, 0.0, 0.0],
            Self::MinusX => [-1.0, 0.0, 0.0],
            Self::Y => [0.0, 1.0, 0.0],
            Self::MinusY => [0.0, -1.0, 0.0],
            Self::Z => [0.0, 0.0, 1.0],
            Self::MinusZ => [0.0, 0.0, -1.0],
        }
    }
}

impl FromStr for Axis {
    type Err = GeometryError;

    fn from_str(text: &str) -> Result<Self, GeometryError> {
        Ok(match text {
            "x" | "+x" => Self::X,
            "-x" => Self::MinusX,
            "y" | "+y" => Self::Y,
            "-y" => Self::MinusY,
            "z" | "+z" => Self::Z,
            "-z" => Self::MinusZ,
            _ => return Err(GeometryError::NoAxis),
        })
    }
}

pub(crate) fn number<T: Number>(what: &'static str, value: T) -> Result<(), GeometryError> {
    let value = value.to_f64();
    if value.is_finite() { Ok(()) } else { Err(GeometryError::Value { what, value, expected: "a finite number" }) }
}

#[cfg(test)]
pub(crate) mod tests;
