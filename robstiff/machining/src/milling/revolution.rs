//! The integrals of the tooth forces, in closed form.
//!
//! A tooth's chip is `h = a sin phi + d` on each of a few [`Piece`]s of its way:
//! one piece with `a = c`, `d = 0` without runout. Over a stretch of angles with
//! its middle at `m` and the width `w`, the mean of `sin phi` is
//! `sinc(w / 2) sin m`, of `sin^2 phi` it is `(1 - sinc(w) cos 2m) / 2`, and so
//! on. Means instead of differences of antiderivatives serve every helix, down to
//! none, where the stretch shrinks to a point.

use core::f64::consts::{PI, TAU};

use nalgebra::Vector3;

use super::cut::{Cut, EndMill};
use super::{Coefficients, Engagement};

/// A stretch of a tooth's way with one formula for its chip.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    pub from: f64,
    pub to: f64,
    /// The feed since the last tooth was here (m), `a`.
    pub feed: f64,
    /// How much further out this tooth is than that one (m), `d`.
    pub extra: f64,
}

/// A helix that lags by less than this over the whole depth (rad) is straight.
const STRAIGHT: f64 = 1e-9;

/// As near to an edge as counts as beside it (rad).
const BESIDE: f64 = 1e-7;

/// The pieces of each tooth's way through the material. The chip of a tooth
/// reaches to the surface that whichever of the teeth before it left deepest.
pub(super) fn pieces(mill: &EndMill, engagement: Engagement, feed: f64) -> Vec<Vec<Piece>> {
    let Engagement { entry, exit } = engagement;
    if mill.runout.iter().all(|&out| out == 0.0) {
        return std::vec![std::vec![Piece { from: entry, to: exit, feed, extra: 0.0 }]; mill.teeth];
    }
    (0..mill.teeth).map(|tooth| tooth_pieces(mill, tooth, engagement, feed)).collect()
}

fn tooth_pieces(mill: &EndMill, tooth: usize, Engagement { entry, exit }: Engagement, feed: f64) -> Vec<Piece> {
    let teeth = mill.teeth;
    // Against the surface left `k` teeth ago.
    let against = |k: usize| {
        let before = (tooth + teeth * k - k) % teeth;
        (k as f64 * feed, mill.runout[tooth] - mill.runout[before])
    };
    let chips: Vec<(f64, f64)> = (1..=teeth).map(against).collect();
    let mut bounds = std::vec![entry, exit];
    // Where two of them are equal, or one is zero.
    let mut bound = |feed: f64, extra: f64| {
        let sine = -extra / feed;
        if sine.abs() <= 1.0 {
            bounds.extend([sine.asin(), PI - sine.asin()]);
        }
    };
    for (index, &(a, d)) in chips.iter().enumerate() {
        bound(a, d);
        chips[..index].iter().for_each(|&(other_a, other_d)| bound(a - other_a, d - other_d));
    }
    bounds.retain(|bound| (entry..=exit).contains(bound));
    bounds.sort_by(f64::total_cmp);
    let thinnest = |stretch: &[f64]| {
        let (from, to) = (stretch[0], stretch[1]);
        let sine = (0.5 * (from + to)).sin();
        let chip = |&(a, d): &(f64, f64)| a * sine + d;
        let &(feed, extra) = chips.iter().min_by(|one, other| chip(one).total_cmp(&chip(other)))?;
        (to > from && chip(&(feed, extra)) > 0.0).then_some(Piece { from, to, feed, extra })
    };
    bounds.windows(2).filter_map(thinnest).collect()
}

pub(super) fn mean_force(cut: &Cut, pieces: &[Vec<Piece>]) -> Vector3<f64> {
    let coefficients = cut.inclined();
    let whole = |piece: &Piece| mean_over(&coefficients, piece, piece.from, piece.to) * (piece.to - piece.from);
    pieces.iter().flatten().map(whole).sum::<Vector3<f64>>() * (cut.depth / TAU)
}

/// Both sides of the angles at which a tooth's tip or its other end comes to the bounds of its
/// pieces (rad, within a revolution).
pub(super) fn edges(cut: &Cut, pieces: &[Vec<Piece>]) -> impl Iterator<Item = f64> {
    let lag = lag(cut);
    let step = TAU / cut.mill.teeth as f64;
    let of_tooth = move |(tooth, pieces): (usize, &Vec<Piece>)| {
        let bounds: Vec<f64> = pieces.iter().flat_map(|piece| [piece.from, piece.to]).collect();
        bounds.into_iter().map(move |bound| bound + step * tooth as f64)
    };
    let tips: Vec<f64> = pieces.iter().enumerate().flat_map(of_tooth).collect();
    let both = tips.into_iter().flat_map(move |tip| [tip, tip + lag]);
    both.flat_map(|edge| [edge - BESIDE, edge + BESIDE]).map(|angle| angle.rem_euclid(TAU))
}

/// By how much the upper end of a tooth lags behind its tip (rad).
fn lag(cut: &Cut) -> f64 {
    2.0 * cut.mill.helix.tan() / cut.mill.diameter * cut.depth
}

pub(super) fn force_at(cut: &Cut, pieces: &[Vec<Piece>], angle: f64) -> Vector3<f64> {
    let (lag, coefficients) = (lag(cut), cut.inclined());
    let mut force = Vector3::zeros();
    for (tooth, pieces) in pieces.iter().enumerate() {
        let tip = (angle - TAU * tooth as f64 / cut.mill.teeth as f64).rem_euclid(TAU);
        // What is above the tip lags behind it.
        let (low, high) = if lag >= 0.0 { (tip - lag, tip) } else { (tip, tip - lag) };
        for piece in pieces {
            if high - low < STRAIGHT {
                if (piece.from..piece.to).contains(&tip) {
                    force += mean_over(&coefficients, piece, tip, tip) * cut.depth;
                }
                continue;
            }
            // The flute may go round the tool more than once.
            let (first, last) = ((low - piece.to) / TAU, (high - piece.from) / TAU);
            for turn in first.ceil() as i64..=last.floor() as i64 {
                let turned = turn as f64 * TAU;
                let (from, to) = ((low - turned).max(piece.from), (high - turned).min(piece.to));
                if to > from {
                    let length = cut.depth * (to - from) / (high - low);
                    force += mean_over(&coefficients, piece, from, to) * length;
                }
            }
        }
    }
    force
}

/// The force on a tooth per axial length (N/m) along feed, normal and axis, in
/// the mean over angles from one to another.
fn mean_over(coefficients: &Coefficients, piece: &Piece, from: f64, to: f64) -> Vector3<f64> {
    let Coefficients { ktc, kte, krc, kre, kac, kae } = *coefficients;
    let (a, d) = (piece.feed, piece.extra);
    let (middle, width) = (0.5 * (from + to), to - from);
    let (sine, cosine) = middle.sin_cos();
    let (sine2, cosine2) = (2.0 * middle).sin_cos();
    let (once, twice) = (sinc(0.5 * width), sinc(width));
    let (s, c) = (once * sine, once * cosine);
    let (ss, sc) = (0.5 * (1.0 - twice * cosine2), 0.5 * twice * sine2);
    Vector3::new(
        -ktc * (a * sc + d * c) - kte * c - krc * (a * ss + d * s) - kre * s,
        ktc * (a * ss + d * s) + kte * s - krc * (a * sc + d * c) - kre * c,
        kac * (a * s + d) + kae,
    )
}

/// `sin x / x`.
fn sinc(x: f64) -> f64 {
    // Below, the series' next term is beyond the last digit.
    if x.abs() < 1e-4 { 1.0 - x * x / 6.0 } else { x.sin() / x }
}
