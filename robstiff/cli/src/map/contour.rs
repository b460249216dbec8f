//! Contour lines of a grid of values: marching squares, joined to lines.

use std::collections::HashMap;

/// An edge of the grid: its lower or left corner, and whether it goes up.
type Edge = (usize, usize, bool);

/// The lines along which a grid of `width` values a row takes a value, in units of
/// the grid's steps from the first value. There are none where a value is NaN.
pub fn contours(values: &[f64], width: usize, level: f64) -> Vec<Vec<[f64; 2]>> {
    let height = values.len() / width.max(1);
    let value = |x: usize, y: usize| values[x + width * y];
    let mut ends: HashMap<Edge, Vec<usize>> = HashMap::new();
    let mut segments: Vec<[Edge; 2]> = Vec::new();
    for y in 0..height.saturating_sub(1) {
        for x in 0..width.saturating_sub(1) {
            // Around the square: below, right, above, left.
            let corners = [value(x, y), value(x + 1, y), value(x + 1, y + 1), value(x, y + 1)];
            if corners.iter().any(|corner| !corner.is_finite()) {
                continue;
            }
            let edges = [(x, y, false), (x + 1, y, true), (x, y + 1, false), (x, y, true)];
            let above = corners.map(|corner| corner > level);
            let mut crossed: Vec<Edge> = (0..4).filter(|&k| above[k] != above[(k + 1) % 4]).map(|k| edges[k]).collect();
            // A saddle: its middle says which corners belong together.
            if crossed.len() == 4 && (corners.iter().sum::<f64>() / 4.0 > level) == above[0] {
                crossed.rotate_left(1);
            }
            for pair in crossed.chunks_exact(2) {
                for edge in pair {
                    ends.entry(*edge).or_default().push(segments.len());
                }
                segments.push([pair[0], pair[1]]);
            }
        }
    }
    let point = |&(x, y, up): &Edge| {
        let (from, to) = (value(x, y), if up { value(x, y + 1) } else { value(x + 1, y) });
        let share = (level - from) / (to - from);
        if up { [x as f64, y as f64 + share] } else { [x as f64 + share, y as f64] }
    };
    let mut used = vec![false; segments.len()];
    let mut lines = Vec::new();
    for first in 0..segments.len() {
        if used[first] {
            continue;
        }
        used[first] = true;
        let [start, end] = segments[first];
        let mut follow = |from: Edge| {
            let (mut at, mut passed) = (from, Vec::new());
            while let Some(&next) = ends[&at].iter().find(|&&segment| !used[segment]) {
                used[next] = true;
                let [one, other] = segments[next];
                at = if one == at { other } else { one };
                passed.push(at);
            }
            passed
        };
        let (forwards, mut backwards) = (follow(end), follow(start));
        backwards.reverse();
        let line = backwards.iter().chain([&start, &end]).chain(&forwards);
        lines.push(line.map(point).collect());
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cone_has_circles() {
        let (width, height) = (41, 31);
        let values: Vec<f64> =
            (0..width * height).map(|i| ((i % width) as f64 - 20.0).hypot((i / width) as f64 - 15.0)).collect();
        let lines = contours(&values, width, 8.3);
        assert_eq!(lines.len(), 1);
        assert_eq!(lines[0].first(), lines[0].last());
        for [x, y] in &lines[0] {
            assert!(((x - 20.0).hypot(y - 15.0) - 8.3).abs() < 0.05);
        }
        assert_eq!(contours(&values, width, 18.0).len(), 2);
        assert!(contours(&values, width, 60.0).is_empty());
    }

    #[test]
    fn lines_end_at_holes_and_saddles_do_not_cross() {
        let values = [1.0, 2.0, 3.0, 1.0, f64::NAN, 3.0, 1.0, 2.0, 3.0];
        assert!(contours(&values, 3, 1.5).is_empty());
        let saddle = contours(&[1.0, 0.0, 0.0, 1.0], 2, 0.4);
        assert_eq!(saddle.len(), 2);
        // What lies above is one piece through the middle.
        assert!(saddle.iter().all(|line| line.iter().map(|[x, y]| x + y).sum::<f64>() / 2.0 != 1.0));
    }
}
