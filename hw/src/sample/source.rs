//! Where samples come from.

use super::raw::RawSample;
use super::wrench_sample::WrenchSample;

/// A source of raw samples: any iterator of results of them. `None` is the end of a recording; after an error a source may
/// go on.
pub trait RawSource: Iterator<Item = Result<RawSample, <Self as RawSource>::Error>> {
    /// Why there may be no sample.
    type Error;
}

impl<I, E> RawSource for I
where
    I: Iterator<Item = Result<RawSample, E>>,
{
    type Error = E;
}

/// A source of wrenches: any iterator of results of them. A sensor of your own is an `Iterator`, or a closure:
///
/// ```
/// use rod_hw::{Wrench, WrenchSample, WrenchSource};
/// struct Constant(u32);
/// impl Iterator for Constant {
///     type Item = Result<WrenchSample, std::io::Error>; // your driver's error
///     fn next(&mut self) -> Option<Self::Item> {
///         self.0 += 1;
///         Some(Ok(WrenchSample::new(1e-3 * f64::from(self.0), Wrench::default())))
///     }
/// }
/// fn last_time<S: WrenchSource>(source: S) -> Option<f64> {
///     source.take(5).filter_map(Result::ok).last().map(|sample| sample.t)
/// }
/// let mut sensor = Constant(0);
/// assert_eq!(last_time(&mut sensor), Some(5e-3));
/// let boxed: Box<dyn Iterator<Item = _>> = Box::new(sensor);
/// assert_eq!(last_time(boxed), Some(1e-2));
/// let closure = std::iter::from_fn(|| Some(Ok::<_, std::io::Error>(WrenchSample::<f64>::new(1.0, Wrench::default()))));
/// assert_eq!(last_time(closure), Some(1.0));
/// ```
pub trait WrenchSource<T = f64>: Iterator<Item = Result<WrenchSample<T>, <Self as WrenchSource<T>>::Error>> {
    /// Why there may be no sample.
    type Error;
}

impl<I, T, E> WrenchSource<T> for I
where
    I: Iterator<Item = Result<WrenchSample<T>, E>>,
{
    type Error = E;
}
