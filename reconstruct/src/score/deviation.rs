//! Distances of points from the true contour.

use rod_contours::{Composite, Contour};

/// Distance of a point (m) from the contours of several objects, m: positive outside the solid, negative in it. Of all
/// objects it is that of the contour which is nearest.
///
/// None without objects, and for a point or a distance that is not finite.
///
/// ```
/// use rod_contours::{Composite, Parabola};
/// use rod_reconstruct::score::signed_distance;
/// let floors = [0.0, 0.1].map(|y| Parabola::new([0.0, y], 0.0).and_then(Composite::single)); // the solid is above
/// let floors = floors.into_iter().collect::<Result<Vec<_>, _>>()?;
/// assert_eq!(signed_distance(&floors, 3.0, -0.02), Some(0.02));
/// assert_eq!(signed_distance(&floors[..1], 3.0, 0.02), Some(-0.02));
/// # Ok::<(), rod_contours::ContourError>(())
/// ```
pub fn signed_distance(objects: &[Composite], x: f64, y: f64) -> Option<f64> {
    if !(x.is_finite() && y.is_finite()) {
        return None;
    }
    let gaps = objects.iter().map(|object| object.closest(x, y).gap);
    gaps.min_by(|a, b| a.abs().total_cmp(&b.abs())).filter(|gap| gap.is_finite())
}

/// Statistics of the distances of points from the contour, in the unit of the distances.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Deviation {
    /// How many points.
    pub count: usize,
    /// Mean of the signed distances, in which scatter to both sides cancels.
    pub bias: f64,
    /// Median of the absolute distances.
    pub median: f64,
    /// The 95 % quantile of the absolute distances.
    pub percentile_95: f64,
    /// The largest absolute distance.
    pub largest: f64,
}

impl Deviation {
    /// From signed distances. The quantile p of n distances is number p (n - 1) in their order, counted from 0 and interpolated
    /// between neighbours.
    ///
    /// None without distances, and where one of them is not finite.
    ///
    /// ```
    /// use rod_reconstruct::score::Deviation;
    /// let deviation = Deviation::of([1.0, -2.0, 3.0, -4.0]).ok_or("no distances")?;
    /// assert_eq!((deviation.median, deviation.largest, deviation.bias), (2.5, 4.0, -0.5));
    /// # Ok::<(), &str>(())
    /// ```
    pub fn of(distances: impl IntoIterator<Item = f64>) -> Option<Self> {
        let mut distances: Vec<f64> = distances.into_iter().collect();
        let count = distances.len();
        if count == 0 || !distances.iter().all(|distance| distance.is_finite()) {
            return None;
        }
        let bias = distances.iter().map(|distance| distance / count as f64).sum();
        distances.iter_mut().for_each(|distance| *distance = distance.abs());
        distances.sort_unstable_by(f64::total_cmp);
        let [median, percentile_95, largest] = [0.5, 0.95, 1.0].map(|share| quantile(&distances, share));
        Some(Self { count, bias, median, percentile_95, largest })
    }
}

/// A quantile of ordered values, at least one.
fn quantile(ordered: &[f64], share: f64) -> f64 {
    let last = ordered.len() - 1;
    let place = share * last as f64;
    let (below, part) = (place as usize, place.fract());
    let (low, high) = (ordered[below.min(last)], ordered[(below + 1).min(last)]);
    low + part * (high - low)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use rod_contours::Parabola;

    fn floor(height: f64) -> Composite {
        Composite::single(Parabola::new([0.0, height], 0.0).unwrap()).unwrap()
    }

    #[test]
    fn a_hundred_points_by_hand() {
        let deviation = Deviation::of((0..=100).map(|k| f64::from(if k % 2 == 0 { k } else { -k }))).unwrap();
        assert_eq!((deviation.count, deviation.median, deviation.percentile_95), (101, 50.0, 95.0));
        assert_eq!(deviation.largest, 100.0);
        assert!((deviation.bias - 50.0 / 101.0).abs() < 1e-12);
        let one = Deviation::of([-3.0]).unwrap();
        assert_eq!((one.bias, one.median, one.percentile_95, one.largest), (-3.0, 3.0, 3.0, 3.0));
    }

    #[test]
    fn the_nearest_of_several_contours_counts() {
        let objects = [floor(0.0), floor(1.0)];
        assert_eq!(signed_distance(&objects, 0.0, 0.25), Some(-0.25));
        assert_eq!(signed_distance(&objects, 0.0, 0.75), Some(0.25), "in the first one, but nearer to the second");
        assert_eq!(signed_distance(&objects, 2.0, -0.5), Some(0.5));
    }

    #[test]
    fn what_cannot_be_said_is_none() {
        assert_eq!(Deviation::of([]), None);
        assert_eq!(Deviation::of([1.0, f64::NAN]), None);
        assert_eq!(signed_distance(&[], 0.0, 0.0), None);
        assert_eq!(signed_distance(&[floor(0.0)], f64::NAN, 0.0), None);
    }

    proptest! {
        #[test]
        fn points_moved_off_the_contour_are_as_far_as_they_were_moved(
            vertex in (-1.0..1.0_f64, -1.0..1.0_f64), coefficient in 0.1..5.0_f64,
            places in prop::collection::vec((-1.0..1.0_f64, 0.0..1.0_f64), 1..30), turn in 0..30_usize,
        ) {
            let contour = [Composite::single(Parabola::new([vertex.0, vertex.1], coefficient).unwrap()).unwrap()];
            let moved = |(t, distance): &(f64, f64)| {
                let frame = contour[0].frame(contour[0].range().clamp(*t));
                [frame.x + distance * frame.alpha.sin(), frame.y - distance * frame.alpha.cos()]
            };
            let mut points: Vec<[f64; 2]> = places.iter().map(moved).collect();
            let of = |points: &[[f64; 2]]| {
                Deviation::of(points.iter().map(|[x, y]| signed_distance(&contour, *x, *y).unwrap())).unwrap()
            };
            let deviation = of(&points);
            let expected = Deviation::of(places.iter().map(|place| place.1)).unwrap();
            for (a, b) in [
                (deviation.bias, expected.bias),
                (deviation.median, expected.median),
                (deviation.percentile_95, expected.percentile_95),
                (deviation.largest, expected.largest),
            ] {
                prop_assert!((a - b).abs() < 1e-9, "{deviation:?} {expected:?}");
            }
            points.rotate_left(turn % places.len());
            let turned = of(&points);
            prop_assert!((turned.bias - deviation.bias).abs() < 1e-12);
            prop_assert_eq!(Deviation { bias: deviation.bias, ..turned }, deviation);
        }
    }
}
