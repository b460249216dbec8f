//! Arcs: circles, helices and spirals between two points.

use core::f64::consts::{FRAC_PI_2, TAU};

use nalgebra::Vector3;

/// An arc in a plane, with what it moves across the plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arc {
    center: Vector3<f64>,
    /// From the centre to the start, across the axis.
    out: Vector3<f64>,
    /// A quarter turn on, as long as `out`.
    on: Vector3<f64>,
    /// The angle that is swept (rad), positive.
    sweep: f64,
    /// The radius at the end as a part of that at the start.
    growth: f64,
    /// What it moves along the axis.
    rise: Vector3<f64>,
    end: Vector3<f64>,
}

/// Radii at both ends differ by no more than this (m), or this share of them: LinuxCNC's limits.
const SAME_RADIUS: f64 = 5e-6;
const SAME_SHARE: f64 = 1e-3;

/// Nor by more than this (m).
const SPIRAL: f64 = 5e-4;

/// Ends that are nearer are the same point (m).
const SAME_POINT: f64 = 1e-9;

/// How an arc is given.
pub struct Given {
    /// Where it begins (m).
    pub from: Vector3<f64>,
    /// Where it ends (m).
    pub to: Vector3<f64>,
    /// Its axis, a unit vector: the arc turns about it by the right-hand rule.
    pub axis: Vector3<f64>,
    /// Whole turns beyond the first.
    pub turns: u32,
}

impl Arc {
    /// The arc about a centre (m). Where it ends above its start, it is a whole turn.
    ///
    /// # Errors
    /// Why there is none.
    pub fn about(given: &Given, center: Vector3<f64>) -> Result<Self, String> {
        let Given { from, to, axis, turns } = given;
        let across = |vector: Vector3<f64>| vector - axis * axis.dot(&vector);
        let (out, last) = (across(from - center), across(to - center));
        let (start, end) = (out.norm(), last.norm());
        if start < SAME_POINT {
            return Err("the centre of the arc is where it begins".to_owned());
        }
        let apart = (start - end).abs();
        if apart > SPIRAL || apart > SAME_RADIUS && apart > SAME_SHARE * start {
            return Err(format!(
                "the arc ends {} mm from its centre and begins {} mm from it",
                millimetres(end),
                millimetres(start)
            ));
        }
        let on = axis.cross(&out);
        let same = (last - out).norm() < SAME_POINT;
        let angle = if same { 0.0 } else { last.dot(&on).atan2(last.dot(&out)) };
        // An end just before the start by rounding is as good as a whole turn.
        let first = if angle > 1e-12 { angle } else { angle + TAU };
        let sweep = first + TAU * f64::from(*turns);
        let rise = axis * axis.dot(&(to - from));
        let center = center + axis * axis.dot(&(from - center));
        Ok(Self { center, out, on, sweep, growth: end / start, rise, end: *to })
    }

    /// The arc of a radius (m): of less than half a turn where that is positive, else of more.
    ///
    /// # Errors
    /// Why there is none.
    pub fn of_radius(given: &Given, radius: f64) -> Result<Self, String> {
        let chord = given.to - given.from;
        let chord = chord - given.axis * given.axis.dot(&chord);
        let half = 0.5 * chord.norm();
        if half < SAME_POINT {
            return Err("an arc given by its radius ends elsewhere than it begins".to_owned());
        }
        let size = radius.abs();
        if half - size > SAME_RADIUS.max(SAME_SHARE * size) {
            return Err(format!(
                "the radius is {} mm, and half of the chord is {} mm",
                millimetres(size),
                millimetres(half)
            ));
        }
        let height = (size * size - half * half).max(0.0).sqrt();
        let side = given.axis.cross(&chord).normalize() * if radius > 0.0 { height } else { -height };
        Self::about(given, given.from + 0.5 * chord + side)
    }

    /// The same arc turning the other way.
    ///
    /// # Errors
    /// Why there is none.
    pub fn reversed(given: &Given, center: Vector3<f64>) -> Result<Self, String> {
        let Given { from, to, axis, turns } = *given;
        Self::about(&Given { from, to, axis: -axis, turns }, center)
    }

    /// The angle that it sweeps (rad).
    pub fn sweep(&self) -> f64 {
        self.sweep
    }

    /// A point of it, from 0 at the start to 1 at the end (m).
    pub fn at(&self, part: f64) -> Vector3<f64> {
        if part >= 1.0 {
            return self.end;
        }
        let (sine, cosine) = (self.sweep * part).sin_cos();
        let scale = 1.0 + (self.growth - 1.0) * part;
        self.center + (self.out * cosine + self.on * sine) * scale + self.rise * part
    }

    /// Its length (m).
    pub fn length(&self) -> f64 {
        let round = self.sweep * self.out.norm() * 0.5 * (1.0 + self.growth);
        round.hypot(self.rise.norm())
    }

    /// In how many parts its chords are within a tolerance of it (m): the height of a segment of
    /// angle a is r (1 - cos a/2). No part is more than a quarter turn.
    pub fn parts(&self, tolerance: f64) -> f64 {
        let radius = self.out.norm() * self.growth.max(1.0);
        let step = 4.0 * (tolerance / (2.0 * radius)).sqrt().min(1.0).asin();
        (self.sweep / step.min(FRAC_PI_2) - 1e-9).ceil().max(1.0)
    }
}

fn millimetres(length: f64) -> String {
    format!("{:.4}", length * 1e3)
}
