//! Long paths in few strokes: what is drawn is bounded, and the extremes stay.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

/// Values over arc length as lines, of so many steps between the ends at most. Of the values within a step the
/// least and the largest stay; a value that is missing ends a line.
pub fn lines(values: impl IntoIterator<Item = (f64, Option<f64>)>, ends: [f64; 2], steps: usize) -> Vec<Vec<[f64; 2]>> {
    struct Step {
        number: usize,
        least: (usize, [f64; 2]),
        most: (usize, [f64; 2]),
        begins: bool,
    }
    let span = (ends[1] - ends[0]).max(f64::MIN_POSITIVE);
    let mut drawn: Vec<Step> = Vec::new();
    let mut begins = true;
    for (i, (x, y)) in values.into_iter().enumerate() {
        let Some(y) = y.filter(|y| y.is_finite()) else {
            begins = true;
            continue;
        };
        let number = ((x - ends[0]) / span * steps as f64).clamp(0.0, steps as f64 - 1.0) as usize;
        let value = (i, [x, y]);
        match drawn.last_mut().filter(|step| step.number >= number) {
            Some(step) => {
                if y < step.least.1[1] {
                    step.least = value;
                }
                if y > step.most.1[1] {
                    step.most = value;
                }
            }
            None => drawn.push(Step { number, least: value, most: value, begins }),
        }
        begins = false;
    }
    let mut found: Vec<Vec<[f64; 2]>> = Vec::new();
    for step in drawn {
        if step.begins || found.is_empty() {
            found.push(Vec::new());
        }
        let mut both = [step.least, step.most];
        both.sort_by_key(|(i, _)| *i);
        let line = found.last_mut().expect("one was begun");
        line.push(both[0].1);
        if both[0].0 != both[1].0 {
            line.push(both[1].1);
        }
    }
    found
}

/// A stroke between two points, in pixels.
pub type Stroke = [[f64; 2]; 2];

/// The distance of a point from what is drawn for it, at first (pixels).
const FINE: f64 = 0.5;

/// Points that one stroke may stand for.
const MOST_IN_A_STROKE: usize = 64;

/// A track through points as strokes of one rank each, `most` of them about. A point comes with the rank of the way to
/// it. Where strokes are too many they are drawn on a coarser grid; where several lie on each other, the highest
/// rank stays. By rank, the lowest first.
pub fn strokes(points: &[([f64; 2], u8)], most: usize) -> Vec<(u8, Vec<Stroke>)> {
    let mut grid = FINE;
    loop {
        let found = on_grid(points, grid);
        if found.len() <= most {
            let mut ranks: BTreeMap<u8, Vec<Stroke>> = BTreeMap::new();
            for ([from, to], rank) in found {
                let at = |[x, y]: Cell| [x as f64 * grid, y as f64 * grid];
                ranks.entry(rank).or_default().push([at(from), at(to)]);
            }
            return ranks.into_iter().collect();
        }
        grid *= 1.5;
    }
}

type Cell = [i64; 2];

/// In the order in which they are first drawn.
fn on_grid(points: &[([f64; 2], u8)], grid: f64) -> Vec<([Cell; 2], u8)> {
    let cell = |[x, y]: [f64; 2]| [(x / grid).round() as i64, (y / grid).round() as i64];
    // Points in the same cell are one; the way on has the highest of their ranks.
    let mut visited: Vec<(Cell, u8)> = Vec::new();
    let mut waiting = 0;
    for &(at, rank) in points {
        let at = cell(at);
        match visited.last_mut() {
            None => visited.push((at, 0)),
            Some((last, _)) if *last == at => waiting = waiting.max(rank),
            Some(_) => {
                visited.push((at, rank.max(waiting)));
                waiting = 0;
            }
        }
    }
    match &mut visited[..] {
        // All in one cell: a dot.
        [(at, _)] => {
            let at = *at;
            visited.push((at, waiting));
        }
        [.., (_, rank)] => *rank = waiting.max(*rank),
        [] => {}
    }
    let mut known: BTreeMap<[Cell; 2], usize> = BTreeMap::new();
    let mut strokes: Vec<([Cell; 2], u8)> = Vec::new();
    let mut start = 0;
    while start + 1 < visited.len() {
        let rank = visited[start + 1].1;
        let mut end = start + 1;
        while end + 1 < visited.len()
            && visited[end + 1].1 == rank
            && end - start < MOST_IN_A_STROKE
            && (start + 1..=end).all(|k| is_near(visited[k].0, [visited[start].0, visited[end + 1].0]))
        {
            end += 1;
        }
        let [from, to] = [visited[start].0, visited[end].0];
        match known.entry(if from <= to { [from, to] } else { [to, from] }) {
            Entry::Vacant(entry) => {
                entry.insert(strokes.len());
                strokes.push(([from, to], rank));
            }
            Entry::Occupied(entry) => {
                let known = &mut strokes[*entry.get()].1;
                *known = rank.max(*known);
            }
        }
        start = end;
    }
    strokes
}

/// Whether a cell is between the ends of a stroke, within one cell of it.
fn is_near([x, y]: Cell, [[x1, y1], [x2, y2]]: [Cell; 2]) -> bool {
    let [dx, dy, px, py] = [x2 - x1, y2 - y1, x - x1, y - y1].map(|side| side as f64);
    let (length, along) = (dx.hypot(dy), px * dx + py * dy);
    length > 0.0 && (px * dy - py * dx).abs() <= length && (0.0..=length * length).contains(&along)
}
