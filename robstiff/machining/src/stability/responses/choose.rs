//! How many modes, and what stands for those outside the band.

use super::FitError;
use super::linear::Linear;
use super::lines::Lines;
use super::model::{Mode, Model};
use super::poles::{Pole, least_lines, stable};

/// Modes that are looked for, at the most, where none are asked for: an arm has fewer in a band in which each
/// can be told from the others.
const MOST: usize = 12;
/// What tables leave of a value by the digits that they have.
const DIGITS: f64 = 1e-6;

/// The model with as many modes as are asked for, or as the criterion takes.
pub fn model(lines: &Lines, asked: Option<usize>) -> Result<Model, FitError> {
    let most = asked.unwrap_or(0).max(MOST);
    let mut poles = stable(lines);
    poles.truncate(most);
    let (stable, mut fewer) = (poles.len(), 0);
    let mut found: Vec<(Model, f64)> = Vec::new();
    while !poles.is_empty() && asked.is_none_or(|asked| poles.len() >= asked) {
        if lines.frequencies.len() >= least_lines(poles.len())
            && let Some((model, left)) = Linear::new(lines, &poles).model(lines).map(|model| model.refined(lines))
        {
            if asked.is_none_or(|asked| model.modes.len() >= asked) {
                let pole = |mode: &Mode| Pole { frequency: mode.frequency, damping: mode.damping };
                poles = model.modes.iter().map(pole).collect();
                found.push((model, left));
            } else {
                fewer = fewer.max(model.modes.len());
            }
        }
        match Linear::new(lines, &poles).least() {
            Some(least) => drop(poles.remove(least)),
            None => break,
        }
    }
    found.retain(|(model, _)| !model.modes.is_empty() && asked.is_none_or(|asked| model.modes.len() == asked));
    if let (true, Some(asked)) = (found.is_empty(), asked) {
        // Of the stable poles, those that are modes of a real structure.
        let found = if stable < asked { stable } else { fewer };
        return Err(if found > 0 { FitError::TooManyModes { found, asked } } else { FitError::NoMode });
    }
    let by_criterion = |found: Vec<(Model, f64)>| {
        let rated = found.into_iter().map(|(model, left)| (criterion(lines, &model, left), model));
        rated.min_by(|(one, _), (other, _)| one.total_cmp(other)).map(|(_, model)| model)
    };
    let whole = by_criterion(found).ok_or(FitError::NoMode)?;
    let variants = [
        Model { below: None, ..whole.clone() },
        Model { above: None, ..whole.clone() },
        Model { below: None, above: None, ..whole.clone() },
    ];
    let mut all: Vec<(Model, f64)> = variants.into_iter().map(|model| model.refined(lines)).collect();
    let left = whole.left(lines);
    all.push((whole, left));
    by_criterion(all).ok_or(FitError::NoMode)
}

/// Schwarz's criterion: the less, the better.
fn criterion(lines: &Lines, model: &Model, left: f64) -> f64 {
    let numbers = lines.numbers() as f64;
    let left = left.max(DIGITS * DIGITS * lines.power());
    numbers * (left / numbers).ln() + model.parameters() as f64 * numbers.ln()
}
