//! From bins to the points of a trace: in order along the contour, and no more of them than its shape needs.

use super::bins::PointBin;
use super::simplify::simplify;
use super::smooth::BinEstimate;
use super::trace::TracePoint;
use crate::numeric::wrap_angle;
use nalgebra::Vector2;
use std::f64::consts::PI;
use std::ops::Range;

/// A point is ahead of another one where it is farther along the contour by this many standard deviations of their distance. Smaller:
/// points may be in the wrong order by noise.
const AHEAD: f64 = 3.0;
/// The contact turns back where it has gone back by this many standard deviations.
const BACK: f64 = 6.0;
/// Ratio of standard deviations along the contour below which the new point replaces the old one.
const BETTER: f64 = 0.5;
/// Bins on either side from which a direction is computed.
const BESIDE: usize = 4;
/// Largest departure of a point that is left out from the chord, in its standard deviations.
const LEFT_OUT: f64 = 0.5;

/// Bins with their estimates, and how far each is along the contour.
pub(super) struct BinLine {
    points: Vec<TracePoint>,
    /// Path length along the tangents, growing in the direction of the contour.
    way: Vec<f64>,
    /// Standard deviation of each point along the tangent.
    along: Vec<f64>,
    samples: Vec<Range<usize>>,
    /// Whether the tangents are those of the contour.
    tangents: bool,
}

impl BinLine {
    pub fn new(bins: &[PointBin], estimates: &[BinEstimate], tangents: bool) -> Self {
        let mut line = Self { points: Vec::new(), way: Vec::new(), along: Vec::new(), samples: Vec::new(), tangents };
        let mut before: Option<(Vector2<f64>, Vector2<f64>)> = None;
        let mut way = 0.0;
        for (k, (bin, (at, covariance))) in bins.iter().zip(estimates).enumerate() {
            let tangent = bin.tangent;
            // where the tangents are not those of the contour, the error that matters is that across the chord
            let along = if tangents { tangent } else { chord(estimates, k).unwrap_or(tangent) };
            let normal = Vector2::new(-along.y, along.x);
            let variance = |side: &Vector2<f64>| side.dot(&(covariance * side)).max(0.0);
            if let Some((last, direction)) = before {
                let mean = (tangent + direction).try_normalize(1e-6).unwrap_or(tangent);
                way += mean.dot(&(at - last));
            }
            let sigma = variance(&normal).sqrt().hypot(bin.bias);
            line.points.push(TracePoint { x: at.x, y: at.y, alpha: angle(&tangent), sigma, systematic: 0.0 });
            line.along.push(variance(&along).sqrt());
            line.way.push(way);
            line.samples.push(bin.from..bin.to);
            before = Some((*at, tangent));
        }
        line
    }

    /// The samples, the direction and the points of each part in which the contact went one way.
    pub fn parts(&self, tolerance: f64) -> Vec<(Range<usize>, bool, Vec<TracePoint>)> {
        self.one_way().into_iter().filter_map(|part| self.part(part, tolerance)).collect()
    }

    /// Parts in which the path length only grows or only shrinks, but for noise. Neighbouring parts share the bin at which it turns.
    fn one_way(&self) -> Vec<Range<usize>> {
        let count = self.points.len();
        if !self.tangents {
            return std::iter::once(0..count).collect();
        }
        let mut parts = Vec::new();
        let (mut from, mut least, mut most) = (0, 0, 0);
        // 0: not known yet.
        let mut direction = 0.0;
        for k in 0..count {
            if self.way[k] >= self.way[most] {
                most = k;
            }
            if self.way[k] <= self.way[least] {
                least = k;
            }
            let down = self.way[most] - self.way[k] > BACK * self.along[most].hypot(self.along[k]);
            let up = self.way[k] - self.way[least] > BACK * self.along[least].hypot(self.along[k]);
            if direction == 0.0 {
                direction = if down { -1.0 } else { f64::from(u8::from(up)) };
                if direction != 0.0 {
                    (least, most) = (k, k);
                }
                continue;
            }
            let turn = if direction > 0.0 && down {
                Some(most)
            } else if direction < 0.0 && up {
                Some(least)
            } else {
                None
            };
            if let Some(turn) = turn {
                parts.push(from..turn + 1);
                from = turn;
                direction = -direction;
                (least, most) = (k, k);
            }
        }
        parts.push(from..count);
        parts
    }

    fn part(&self, part: Range<usize>, tolerance: f64) -> Option<(Range<usize>, bool, Vec<TracePoint>)> {
        let (first, last) = (part.start, part.end.checked_sub(1)?);
        let samples = self.samples.get(first)?.start..self.samples.get(last)?.end;
        let reversed = self.way[last] < self.way[first];
        let mut kept = if self.tangents { self.ahead(part) } else { part.collect() };
        if reversed {
            kept.reverse();
        }
        let mut points: Vec<TracePoint> = kept.iter().map(|&k| self.points[k]).collect();
        if self.tangents {
            self.to_the_ends(&kept, &mut points);
        }
        points.dedup_by(|a, b| a.x == b.x && a.y == b.y);
        Some((samples, reversed, simplify(&points, LEFT_OUT, tolerance)))
    }

    /// The bins of a part that are ahead of the one kept before, and the last one in any case. A bin that is much better known
    /// replaces those before that it is not ahead of: where the force is about to vanish, a point is so uncertain along the contour
    /// that no other would be ahead of it for a long distance.
    fn ahead(&self, part: Range<usize>) -> Vec<usize> {
        let mut kept: Vec<usize> = Vec::new();
        let last = part.end - 1;
        let apart = |a: usize, b: usize| (self.way[a] - self.way[b]).abs() > AHEAD * self.along[a].hypot(self.along[b]);
        let up = self.way[last] >= self.way[part.start];
        for k in part {
            let onward = |before: usize| (self.way[k] > self.way[before]) == up && apart(k, before);
            while kept.last().is_some_and(|&before| !onward(before) && self.along[k] < BETTER * self.along[before]) {
                kept.pop();
            }
            if kept.last().is_none_or(|&before| onward(before)) {
                kept.push(k);
            }
        }
        // The end of the stretch is kept instead of the point just before it, unless it is known much worse.
        if kept.last().is_some_and(|&before| before != last && BETTER * self.along[last] <= self.along[before]) {
            while kept.len() > 1
                && kept.last().is_some_and(|&before| (self.way[last] > self.way[before]) != up || !apart(last, before))
            {
                kept.pop();
            }
            if kept.last().is_none_or(|&before| (self.way[last] > self.way[before]) == up && apart(last, before)) {
                kept.push(last);
            }
        }
        kept
    }

    /// Moves the end points, which are means over bins, to the ends of their bins.
    fn to_the_ends(&self, kept: &[usize], points: &mut [TracePoint]) {
        if kept.len() < 3 {
            return;
        }
        for (end, inner, sign) in [(0, 2, -1.0), (kept.len() - 1, kept.len() - 3, 1.0)] {
            let (k, beside) = (kept[end], kept[inner]);
            let samples = (self.samples[k].start + self.samples[k].end)
                .abs_diff(self.samples[beside].start + self.samples[beside].end);
            let half = 0.5 * (self.samples[k].len() - 1) as f64;
            let beyond = (self.way[k] - self.way[beside]).abs() * half / (0.5 * samples as f64);
            let turned = wrap_angle(self.points[k].alpha - self.points[beside].alpha);
            let turned = turned * beyond / (self.way[k] - self.way[beside]).abs().max(f64::MIN_POSITIVE);
            let alpha = points[end].alpha + 0.5 * turned;
            points[end].x += sign * beyond * alpha.cos();
            points[end].y += sign * beyond * alpha.sin();
            points[end].alpha = wrap_angle(points[end].alpha + turned);
        }
    }
}

/// The direction of the points about one of them; none where they are all in one place.
fn chord(estimates: &[BinEstimate], k: usize) -> Option<Vector2<f64>> {
    let (from, to) = (k.saturating_sub(BESIDE), (k + BESIDE).min(estimates.len() - 1));
    (estimates[to].0 - estimates[from].0).try_normalize(0.0)
}

/// The angle of a direction in (-pi, pi].
fn angle(direction: &Vector2<f64>) -> f64 {
    let angle = direction.y.atan2(direction.x);
    if angle == -PI { PI } else { angle }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_that_is_hardly_known_does_not_hide_better_ones() {
        let ways: Vec<i32> = (0..20).collect();
        let mut sigmas = vec![1e-5; 20];
        // 2 cm at first, a third of that with each step
        sigmas.iter_mut().enumerate().take(6).for_each(|(k, sigma)| *sigma = 2e-2 / 3_f64.powi(k as i32));
        let parts = uneven(&ways, &sigmas).parts(1e-9);
        let kept: Vec<f64> = parts[0].2.iter().map(|p| (1e3 * p.x).round()).collect();
        assert!(parts.len() == 1 && kept.first().is_some_and(|x| (3.0..7.0).contains(x)), "{kept:?}");
        assert_eq!(kept.last(), Some(&19.0));
        // and so at the other end
        sigmas.reverse();
        let parts = uneven(&ways, &sigmas).parts(1e-9);
        let kept: Vec<f64> = parts[0].2.iter().map(|p| (1e3 * p.x).round()).collect();
        assert!(kept[0] == 0.0 && kept.last().is_some_and(|x| (12.0..17.0).contains(x)), "{kept:?}");
    }

    /// A contact that goes to and fro along a line, in steps of 1 mm.
    fn line(ways: &[i32], sigma: f64) -> BinLine {
        uneven(ways, &vec![sigma; ways.len()])
    }

    fn uneven(ways: &[i32], sigmas: &[f64]) -> BinLine {
        let bin = |(k, (&way, &sigma)): (usize, (&i32, &f64))| {
            let at = Vector2::new(1e-3 * f64::from(way), 0.0);
            let covariance = nalgebra::Matrix2::identity() * sigma * sigma;
            (
                PointBin { from: k, to: k + 1, at, covariance, bias: 0.0, tangent: Vector2::x(), sigma_tangent: 0.0 },
                (at, covariance),
            )
        };
        let (bins, estimates): (Vec<_>, Vec<_>) = ways.iter().zip(sigmas).enumerate().map(bin).unzip();
        BinLine::new(&bins, &estimates, true)
    }

    #[test]
    fn a_contact_that_turns_back_makes_two_parts() {
        let parts = line(&[0, -1, -2, -3, -4, -3, -2, -1, 0, 1, 2], 1e-5).parts(1e-6);
        let ends: Vec<_> = parts.iter().map(|(samples, reversed, _)| (samples.clone(), *reversed)).collect();
        assert_eq!(ends, [(0..5, true), (4..11, false)]);
        assert_eq!((parts[0].2[0].x, parts[1].2.last().unwrap().x), (-4e-3, 2e-3));
        // Within noise it goes on.
        assert_eq!(line(&[0, 1, 2, 1, 2, 3, 5, 4, 6, 7], 5e-4).parts(1e-6).len(), 1);
        // A contact that stands still is a point.
        assert_eq!(line(&[3; 9], 1e-5).parts(1e-6)[0].2.len(), 1);
        assert!(line(&[], 1e-5).parts(1e-6).is_empty());
    }
}
