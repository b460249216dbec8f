//! Drilling cycles.

/// A hole, by coordinates along the axis that it is drilled (m).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hole {
    /// The number of the code: 73, 81, 82, 83, 85, 86, 89.
    pub code: u32,
    /// Where the feed begins.
    pub r: f64,
    /// The bottom.
    pub z: f64,
    /// How deep the drill goes at a time, of 73 and 83.
    pub peck: f64,
    /// Where the tool goes at last.
    pub back: f64,
}

/// A step along the axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Step {
    /// Rapid to a coordinate (m).
    Rapid(f64),
    /// With feed to a coordinate (m).
    Feed(f64),
}

/// How far a drill stays off the bottom when it comes back, and how far 73 lifts it (m): the 0.01 in
/// of LinuxCNC.
const CLEARANCE: f64 = 0.254e-3;

/// Pecks of a hole.
const MOST_PECKS: f64 = 1e4;

/// The steps from R on.
///
/// # Errors
/// Why the cycle is none.
pub fn steps(hole: &Hole) -> Result<Vec<Step>, &'static str> {
    let Hole { code, r, z, peck, back } = *hole;
    if z > r {
        return Err("the bottom Z of the hole is above R");
    }
    let mut steps = vec![Step::Rapid(r)];
    match code {
        73 | 83 => {
            if peck <= 0.0 {
                return Err("the depth of a peck, Q, is missing or not above zero");
            }
            let count = ((r - z) / peck - 1e-9).ceil().max(1.0);
            if count > MOST_PECKS {
                return Err("the hole has more than 10000 pecks");
            }
            for k in 1..=count as usize {
                let (before, to) = (r - peck * (k - 1) as f64, (r - peck * k as f64).max(z));
                if k > 1 && code == 83 {
                    steps.push(Step::Rapid(r));
                    steps.push(Step::Rapid((before + CLEARANCE).min(r)));
                } else if k > 1 {
                    steps.push(Step::Rapid((before + CLEARANCE).min(r)));
                }
                steps.push(Step::Feed(to));
            }
            steps.push(Step::Rapid(back));
        }
        85 | 89 => steps.extend([Step::Feed(z), Step::Feed(back)]),
        _ => steps.extend([Step::Feed(z), Step::Rapid(back)]),
    }
    Ok(steps)
}
