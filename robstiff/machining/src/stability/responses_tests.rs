//! Modes from frequency responses: of known structures.

use core::f64::consts::TAU;

use nalgebra::{Complex, Vector3};
use proptest::prelude::*;

use super::responses::{Fit, FitError, FittedModes, Motion, Response, Responses};
use super::tests::cut;
use super::*;
use crate::milling::{CutFrame, Direction, Engagement};

const MOTIONS: [Motion; 3] = [Motion::Receptance, Motion::Mobility, Motion::Accelerance];

fn mode(hertz: f64, damping: f64, stiffness: f64, direction: [f64; 3]) -> MeasuredMode {
    MeasuredMode { frequency: TAU * hertz, damping, stiffness, direction: Vector3::from(direction) }
}

/// Two modes that are closer than they are wide.
fn close() -> Vec<MeasuredMode> {
    Vec::from([mode(14.6, 0.03, 1.1e6, [0.7, 0.6, 0.26]), mode(15.2, 0.03, 1.6e6, [0.7, -0.5, 0.58])])
}

/// Modes as an arm has them.
fn arm() -> Vec<MeasuredMode> {
    Vec::from([
        mode(14.6, 0.031, 1.1e6, [0.5, 0.93, 0.26]),
        mode(17.9, 0.024, 1.6e6, [0.81, -0.12, 0.58]),
        mode(28.3, 0.018, 3.9e6, [-0.52, 0.31, 0.8]),
    ])
}

fn all() -> Vec<[usize; 2]> {
    (0..9).map(|k| [k % 3, k / 3]).collect()
}

/// A force along one direction.
fn column(force: usize) -> Vec<[usize; 2]> {
    (0..3).map(|response| [response, force]).collect()
}

/// 5 to 60 Hz, in steps of an eighth.
fn band() -> Vec<f64> {
    (0..=440).map(|k| 5.0 + 0.125 * f64::from(k)).collect()
}

/// Numbers that are normally distributed, the same for a seed.
struct Noise(u64);

impl Noise {
    fn uniform(&mut self) -> f64 {
        // Marsaglia, Xorshift RNGs, Journal of Statistical Software 8/14 (2003).
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn normal(&mut self) -> f64 {
        (-2.0 * self.uniform().max(1e-300).ln()).sqrt() * (TAU * self.uniform()).cos()
    }
}

/// What modes answer, with noise as a share of the root mean square of all of it.
fn responses(
    modes: &[MeasuredMode],
    frequencies: &[f64],
    directions: &[[usize; 2]],
    motion: Motion,
    (noise, seed): (f64, u64),
) -> Responses {
    let value = |frequency: f64, [i, j]: [usize; 2]| -> Complex<f64> {
        let w = TAU * frequency;
        let of = |mode: &MeasuredMode| {
            let along = mode.direction.normalize();
            let ratio = w / mode.frequency;
            let dynamic = Complex::new(1.0 - ratio * ratio, 2.0 * mode.damping * ratio) * mode.stiffness;
            dynamic.inv() * (along[i] * along[j])
        };
        let order = MOTIONS.iter().position(|one| *one == motion).unwrap() as i32;
        modes.iter().map(of).sum::<Complex<f64>>() * Complex::new(0.0, w).powi(order)
    };
    let response = |&directions: &[usize; 2]| Response {
        directions,
        values: frequencies.iter().map(|&frequency| value(frequency, directions)).collect(),
    };
    let mut all: Vec<Response> = directions.iter().map(response).collect();
    let count = (all.len() * frequencies.len()) as f64;
    let sum: f64 = all.iter().flat_map(|one| &one.values).map(|value| value.norm_sqr()).sum();
    let part = noise * (0.5 * sum / count).sqrt();
    let mut random = Noise(0x9e37_79b9_7f4a_7c15 ^ (seed + 1));
    for value in all.iter_mut().flat_map(|one| &mut one.values) {
        *value += Complex::new(random.normal(), random.normal()) * part;
    }
    Responses { motion, frequencies: frequencies.to_vec(), all }
}

/// How far modes are at most from the true ones: frequency, damping and stiffness as shares, direction (degrees).
fn apart(fitted: &FittedModes, truth: &[MeasuredMode]) -> [f64; 4] {
    assert_eq!(fitted.modes.len(), truth.len(), "{fitted:?}");
    let mut worst = [0.0_f64; 4];
    for (found, mode) in fitted.modes.iter().zip(truth) {
        let turned = found.direction.normalize().dot(&mode.direction.normalize()).abs().min(1.0).acos();
        let each = [
            (found.frequency / mode.frequency - 1.0).abs(),
            (found.damping / mode.damping - 1.0).abs(),
            (found.stiffness / mode.stiffness - 1.0).abs(),
            turned.to_degrees(),
        ];
        worst = core::array::from_fn(|k| worst[k].max(each[k]));
    }
    worst
}

fn assert_near(found: [f64; 4], most: [f64; 4], of: &str) {
    assert!((0..4).all(|k| found[k] <= most[k]), "{of}: {found:?}");
}

#[test]
fn modes_without_noise_are_found_exactly() {
    for motion in MOTIONS {
        for directions in [all(), column(0), column(1)] {
            for truth in [close(), arm()] {
                let measured = responses(&truth, &band(), &directions, motion, (0.0, 0));
                for asked in [None, Some(truth.len())] {
                    let fitted = measured.fit(asked).unwrap();
                    let what = format!("{motion:?} {directions:?}");
                    assert_near(apart(&fitted, &truth), [1e-6, 1e-5, 1e-5, 1e-3], &what);
                    assert!(fitted.fit.left < 1e-5 && fitted.massless.is_empty(), "{what}: {fitted:?}");
                }
            }
        }
    }
}

#[test]
fn close_modes_are_found_in_noise() {
    for (noise, most) in [(0.01, [5e-3, 0.1, 0.1, 3.0]), (0.05, [5e-3, 0.1, 0.2, 5.0])] {
        for motion in [Motion::Receptance, Motion::Accelerance] {
            for directions in [all(), column(0)] {
                for seed in 0..4 {
                    for truth in [close(), arm()] {
                        let measured = responses(&truth, &band(), &directions, motion, (noise, seed));
                        let fitted = measured.fit(None).unwrap();
                        let what = format!("{noise} {motion:?} {directions:?} {seed}");
                        assert_near(apart(&fitted, &truth), most, &what);
                        // What they leave is the noise.
                        assert!((fitted.fit.left / noise - 1.0).abs() < 0.15, "{what}: {:?}", fitted.fit);
                    }
                }
            }
        }
    }
}

/// What is cut with the responses is cut with the table they were made from. A mode far above the band is a spring in
/// it, which does not chatter itself.
#[test]
fn limits_are_those_of_the_modes_behind_the_responses() {
    let (stiffness, direction) = (9e6, [0.3, 0.3, 0.9]);
    let spring = Spring { stiffness, direction: Vector3::from(direction) };
    let table = Modes::measured(&arm()).unwrap().with_massless(&[spring]).unwrap();
    let truth = [arm(), Vec::from([mode(2000.0, 0.02, stiffness, direction)])].concat();
    for directions in [all(), column(0)] {
        let measured = responses(&truth, &band(), &directions, Motion::Accelerance, (0.01, 3));
        let fitted = measured.fit(None).unwrap();
        assert_eq!((fitted.modes.len(), fitted.massless.is_empty()), (3, false), "{fitted:?}");
        let modes = Modes::measured(&fitted.modes).unwrap().with_massless(&fitted.massless).unwrap();
        for feed in [Vector3::x(), Vector3::y(), Vector3::new(1.0, -2.0, 0.0)] {
            let down = Engagement::of_width(Direction::Down, 0.005, 0.02).unwrap();
            let process = process(&cut(down), &CutFrame::new(&-Vector3::z(), &feed).unwrap());
            let [found, expected] = [&modes, &table].map(|modes| Lobes::new(modes, &process, 0.02).unwrap());
            let limits = [&found, &expected].map(|lobes| lobes.at_any_speed().unwrap());
            assert!((limits[0] / limits[1] - 1.0).abs() < 0.05, "{feed} {limits:?}");
            for rpm in [300.0, 3000.0, 9000.0] {
                let limits = [&found, &expected].map(|lobes| lobes.limits(60.0 / (4.0 * rpm)).limiting());
                match limits {
                    [Some(found), Some(expected)] => {
                        assert!((found / expected - 1.0).abs() < 0.05, "{feed} {rpm} {found} {expected}");
                    }
                    limits => assert_eq!(limits, [None, None], "{feed} {rpm}"),
                }
            }
        }
    }
}

/// The arm on a soft floor, of which only the inertia is seen: it is no mode, but it does not spoil the others.
#[test]
fn modes_below_the_band_are_told() {
    let mut all_modes = arm();
    all_modes.push(mode(2.0, 0.05, 0.5e6, [0.5, 0.5, 0.26]));
    let measured = responses(&all_modes, &band(), &all(), Motion::Receptance, (0.01, 1));
    let fitted = measured.fit(None).unwrap();
    assert_near(apart(&fitted, &arm()), [5e-3, 0.1, 0.1, 3.0], "below");
    let Fit { below, left, .. } = fitted.fit;
    assert!(below > 0.015 && (left / below.hypot(0.01) - 1.0).abs() < 0.05, "{below} {left}");
}

#[test]
fn responses_that_tell_no_modes_are_refused() {
    let fit = |measured: &Responses, asked: Option<usize>| measured.fit(asked).map(|fitted| fitted.modes.len());
    let measured = |frequencies: &[f64]| responses(&arm(), frequencies, &column(2), Motion::Mobility, (0.01, 0));
    assert_eq!(fit(&measured(&band()), Some(3)), Ok(3));
    let few = FitError::TooFewLines { lines: 10, needed: 13, modes: 4 };
    assert_eq!(fit(&measured(&band()[..10]), Some(4)), Err(few));
    assert!(matches!(fit(&measured(&band()), Some(30)), Err(FitError::TooManyModes { asked: 30, .. })));
    let mut incomplete = measured(&band());
    incomplete.all.pop();
    assert_eq!(fit(&incomplete, None), Err(FitError::Incomplete));
    // Nothing but noise; nothing at all.
    let noise = responses(&arm(), &band(), &column(2), Motion::Mobility, (300.0, 0));
    assert!(matches!(fit(&noise, None), Err(FitError::Unexplained(_) | FitError::NoMode)), "{:?}", noise.fit(None));
    let mut still = measured(&band());
    still.all.iter_mut().flat_map(|one| &mut one.values).for_each(|value| *value *= 0.0);
    assert_eq!(fit(&still, None), Err(FitError::NoMode));
}

const HEADER: &str = "frequency [Hz],xx_re [m/s2/N],xx_im [m/s2/N],yx_re,yx_im,zx_re,zx_im\n";

fn parsed(text: &str) -> Result<(Responses, Vec<String>), String> {
    Responses::parse("hammer.csv", text, Motion::Accelerance, [0.0, 50.0]).map_err(|problems| problems.to_string())
}

#[test]
fn responses_are_read_in_the_forms_that_tables_have() {
    // At 0 Hz some write what they divided by nothing, and beyond the band is what it may.
    let text = format!("{HEADER}0,nan,nan,0,0,0,0\n10,1,2,0.5,0,0,3\n20.5,-1,2,0,0,0,3\n60,,,,,,\n");
    let (responses, warnings) = parsed(&text).unwrap();
    assert_eq!((responses.frequencies.as_slice(), warnings.len()), (&[10.0, 20.5][..], 0));
    assert_eq!(responses.all[0].values, [Complex::new(1.0, 2.0), Complex::new(-1.0, 2.0)]);
    assert_eq!(responses.all[2].directions, [2, 0]);
    let german = text.replace(',', ";").replace("20.5", "20,5").replace("0.5", "0,5");
    assert_eq!(parsed(&german).unwrap().0, responses);
    let g = text.replace("xx_re [m/s2/N]", "xx_re [g/N]").replace("10,1,", "10,0.101971621,");
    assert!((parsed(&g).unwrap().0.all[0].values[0].re - 1.0).abs() < 1e-6);
    let polar = "frequency [Hz],xz_mag,xz_phase [deg],yz_mag,yz_phase [deg],zz_mag,zz_phase [deg],coherence\n\
                 10,1,0,2,90,3,90,0.9\n";
    let (responses, warnings) = parsed(polar).unwrap();
    assert_eq!(responses.all[1].directions, [1, 2]);
    assert!((responses.all[1].values[0] - Complex::new(0.0, 2.0)).norm() < 1e-12);
    assert!(warnings[0].contains("`coherence` is not used"), "{warnings:?}");
}

#[test]
fn mistakes_in_tables_of_responses_are_shown_where_they_are() {
    let good = format!("{HEADER}10,1,2,0.5,0,0,3\n20,-1,2,0,0,0,3\n");
    for (from, to, place, part) in [
        ("frequency [Hz]", "f [Hz]", "hammer.csv:1:1", "`frequency` is missing"),
        ("frequency [Hz]", "frequency [s]", "hammer.csv:1:1", "`s` is a time, a frequency is expected here"),
        ("xx_re [m/s2/N]", "xx_re [m/N]", "hammer.csv:1:16", "an accelerance is expected here"),
        (",xx_im [m/s2/N]", ",xx_in [m/s2/N]", "hammer.csv:1:", "`xx_im` is missing"),
        (",yx_re,yx_im", ",cxy,pxy", "hammer.csv:1:1", "of no force all three responses are there, only xx and zx"),
        (HEADER, "frequency [Hz],a,b,c,d,e,f\n", "hammer.csv:1:1", "there is no column of a response"),
        (",yx_re,yx_im", ",xx_mag,xx_phase", "hammer.csv:1:1", "the response xx is there twice"),
        ("\n20,", "\n10,", "hammer.csv:3:1", "not above that of the row before"),
        ("\n10,", "\n-10,", "hammer.csv:2:1", "a frequency below zero"),
        ("\n20,-1", "\n20,high", "hammer.csv:3:4", "`high` is not a number"),
    ] {
        assert!(good.contains(from), "{from}");
        let error = parsed(&good.replace(from, to)).unwrap_err();
        assert!(error.contains(place) && error.contains(part), "{from} -> {to}: {error}");
    }
    // A sensor the other way round; two lines of noise say nothing.
    let turned = |lines: usize| (1..=lines).map(|k| format!("{k},1,-2,0.5,0,0,3\n")).collect::<String>();
    let error = parsed(&format!("{HEADER}{}", turned(8))).unwrap_err();
    assert!(error.contains("hammer.csv:1:16") && error.contains("by `xx` the structure would give power"), "{error}");
    assert!(parsed(&format!("{HEADER}{}", turned(2))).is_ok());
    let error = parsed(&good.replace("\n10,", "\n110,").replace("\n20,", "\n120,")).unwrap_err();
    assert!(error.contains("no line is above 0 Hz and below 50 Hz"), "{error}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// Any modes that stand apart, and that the force moves.
    #[test]
    fn random_modes_are_found(
        first in 8.0..14.0_f64,
        steps in prop::collection::vec(1.15..1.5_f64, 0..4),
        dampings in prop::array::uniform4(0.01..0.05_f64),
        stiffnesses in prop::array::uniform4(1e6..3e6_f64),
        directions in prop::array::uniform4(prop::array::uniform3(0.3..1.0_f64)),
        signs in prop::array::uniform4(prop::array::uniform2(prop::bool::ANY)),
        motion in 0..3_usize,
        is_column in prop::bool::ANY,
    ) {
        let mut hertz = first;
        let mut truth = Vec::new();
        for k in 0..=steps.len() {
            let [x, y, z] = directions[k];
            let [turns_y, turns_z] = signs[k];
            let along = [x, if turns_y { -y } else { y }, if turns_z { -z } else { z }];
            truth.push(mode(hertz, dampings[k], stiffnesses[k], along));
            hertz *= steps.get(k).copied().unwrap_or(1.0);
        }
        let directions = if is_column { column(0) } else { all() };
        let measured = responses(&truth, &band(), &directions, MOTIONS[motion], (0.01, 5));
        let fitted = measured.fit(None).unwrap();
        assert_near(apart(&fitted, &truth), [5e-3, 0.1, 0.2, 6.0], &format!("{truth:?}"));
    }
}
