//! The zero of a function whose derivative is known.

use crate::Range;

/// Largest number of steps; bisection alone reaches rounding in about 60.
const STEPS: usize = 80;

/// The zero, to `resolution`, of a function that is negative where the range begins and not where it ends. `function`
/// gives value and derivative; it is called with `start`, a place in the range, and at last with the zero.
pub(crate) fn zero(range: Range, start: f64, resolution: f64, mut function: impl FnMut(f64) -> [f64; 2]) -> f64 {
    let Range { from: mut low, to: mut high } = range;
    let mut t = start;
    let mut step_before = range.length();
    let [mut value, mut rate] = function(t);
    for _ in 0..STEPS {
        if value < 0.0 {
            low = t;
        } else {
            high = t;
        }
        if value == 0.0 || high - low <= resolution {
            break;
        }
        let mut step = -value / rate;
        let mut next = t + step;
        // Newton only while it stays inside and converges faster than halving would.
        if !(next > low && next < high && step.abs() <= 0.5 * step_before.abs()) {
            next = 0.5 * (low + high);
            step = next - t;
        }
        if next == t {
            break;
        }
        t = next;
        [value, rate] = function(t);
        if step.abs() <= resolution {
            break;
        }
        step_before = step;
    }
    t
}
