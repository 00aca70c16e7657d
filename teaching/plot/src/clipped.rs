//! Clips curves of bounds that exceed the axes, and makes the labels at the edges.

use crate::elements::Curve;
use crate::scale::significant;

/// Largest ratio of the length of the axes to the range of the curves, so that near bounds are visible.
const ROOM: f64 = 2.0;

/// Returns the ends of the range that axes should show: that of the curves, extended to bounds that are not too far.
pub(crate) fn room(curves: impl Iterator<Item = f64>, bounds: impl Iterator<Item = f64>) -> Vec<f64> {
    let ends = |(low, high): (f64, f64), value: f64| (low.min(value), high.max(value));
    let (low, high) = curves.filter(|value| value.is_finite()).fold((0.0, 0.0), ends);
    let more = (ROOM - 1.0) / 2.0 * (high - low);
    let (least, most) = bounds.filter(|value| value.is_finite()).fold((low, high), ends);
    // if all curves are zero, the axes show the bounds
    if more > 0.0 { vec![least.max(low - more), most.min(high + more)] } else { vec![least, most] }
}

/// Returns the parts of a curve between the values `low` and `high`, each with its times. A part begins and ends where
/// the curve crosses one of them.
pub(crate) fn clipped(time: &[f64], values: &[f64], [low, high]: [f64; 2]) -> Vec<(Vec<f64>, Vec<f64>)> {
    let mut parts: Vec<(Vec<f64>, Vec<f64>)> = Vec::new();
    let mut is_open = false;
    let points: Vec<(f64, f64)> = time.iter().copied().zip(values.iter().copied()).collect();
    for pair in points.windows(2) {
        let [(t0, v0), (t1, v1)] = [pair[0], pair[1]];
        // the position between two points, 0 to 1, at which a value is crossed
        let at = |value: f64| (value - v0) / (v1 - v0);
        let (from, to) = match (v0 == v1, v1 > v0) {
            (true, _) if (low..=high).contains(&v0) => (0.0, 1.0),
            (true, _) => (1.0, 0.0),
            (_, true) => (f64::max(0.0, at(low)), f64::min(1.0, at(high))),
            (_, false) => (f64::max(0.0, at(high)), f64::min(1.0, at(low))),
        };
        // NaN interrupts the curve
        if !(from <= to && v0.is_finite() && v1.is_finite()) {
            is_open = false;
            continue;
        }
        let point = |part: f64| (t0 + part * (t1 - t0), (v0 + part * (v1 - v0)).clamp(low, high));
        if !is_open || from > 0.0 {
            let (time, value) = point(from);
            parts.push((vec![time], vec![value]));
        }
        if let Some((times, values)) = parts.last_mut() {
            let (time, value) = point(to);
            times.push(time);
            values.push(value);
        }
        is_open = to == 1.0;
    }
    parts
}

/// Returns labels for the edges that bounds exceed: whether it is the upper edge, and the most distant values.
pub(crate) fn edges(bounds: &[Curve<'_>], [low, high]: [f64; 2]) -> Vec<(bool, String)> {
    let farthest = |is_above: bool| {
        let values = |bound: &Curve<'_>| {
            let finite = bound.values.iter().copied().filter(|value| value.is_finite());
            finite.reduce(if is_above { f64::max } else { f64::min })
        };
        let extremes = bounds.iter().filter_map(|bound| Some((bound.name, values(bound)?)));
        let beyond = extremes.filter(|(_, value)| if is_above { *value > high } else { *value < low });
        beyond.reduce(|a, b| if (a.1 < b.1) == is_above { b } else { a })
    };
    let said = |is_above: bool| {
        let (name, value) = farthest(is_above)?;
        let way = if is_above { "up" } else { "down" };
        Some((is_above, format!("{name} {way} to {}", significant(value, 3))))
    };
    [true, false].into_iter().filter_map(said).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_curve_is_cut_where_it_leaves_the_axes() {
        let time = [0.0, 1.0, 2.0, 3.0, 4.0];
        let whole = clipped(&time, &[1.0, -1.0, 0.0, 0.5, 1.0], [-2.0, 2.0]);
        assert_eq!(whole, [(time.to_vec(), vec![1.0, -1.0, 0.0, 0.5, 1.0])]);
        // from 0 to 4 and back: the curve crosses 2 halfway
        let cut = clipped(&time, &[0.0, 4.0, 0.0, 0.0, 0.0], [-2.0, 2.0]);
        assert_eq!(cut, [(vec![0.0, 0.5], vec![0.0, 2.0]), (vec![1.5, 2.0, 3.0, 4.0], vec![2.0, 0.0, 0.0, 0.0])]);
        // from below to above within a step
        assert_eq!(clipped(&[0.0, 1.0], &[-4.0, 4.0], [-2.0, 2.0]), [(vec![0.25, 0.75], vec![-2.0, 2.0])]);
        assert_eq!(clipped(&time, &[9.0; 5], [-2.0, 2.0]), []);
        let torn = clipped(&time, &[0.0, 1.0, f64::NAN, 1.0, 0.0], [-2.0, 2.0]);
        assert_eq!(torn, [(vec![0.0, 1.0], vec![0.0, 1.0]), (vec![3.0, 4.0], vec![1.0, 0.0])]);
    }

    #[test]
    fn axes_have_room_for_near_bounds_only() {
        let near = room([-1.0, 3.0].into_iter(), [4.0, -2.5].into_iter());
        assert_eq!(near, [-2.5, 4.0]);
        let far = room([-1.0, 3.0].into_iter(), [80.0, -80.0].into_iter());
        assert_eq!(far, [-3.0, 5.0]);
        assert_eq!(room([0.0].into_iter(), [80.0, -80.0].into_iter()), [-80.0, 80.0]);
        let bound = |values: Vec<f64>| Curve { name: "threshold", colour: "", dash: "", width: 1.0, values };
        let bounds = [bound(vec![2.0, 80.0]), bound(vec![-2.0, -2.0])];
        assert_eq!(edges(&bounds, [-4.0, 6.0]), [(true, "threshold up to 80".to_owned())]);
    }
}
