//! The turn of a compliance about z.
//!
//! `M <- R M R^T` is the same for each of the four 3 x 3 blocks, but that the
//! two that couple are each other's transposes. With `t = s (xx - yy) +
//! c (xy + yx)`, `s^2 + c^2 = 1` leaves no double angle: `xx - s t`,
//! `c t - yx`, `yy + s t`. Gain: `benches/README.md`.

use crate::Real;

/// The lane of each block's transpose. The two that change places are in one
/// half of a vector, which takes a cycle; across the halves it takes four.
const TRANSPOSED: [usize; 4] = [0, 1, 3, 2];

/// Lane by lane, with as few multiplications as can be: batches wait for those.
#[inline(always)]
pub(crate) fn turn<T: Real>(rows: [[T; 4]; 5], (s, c): (T, T)) -> [[T; 4]; 5] {
    let [xx, xy, yy, xz, yz] = rows;
    let mut out = rows;
    for lane in 0..4 {
        let yx = xy[TRANSPOSED[lane]];
        let t = c.mul_add(xy[lane] + yx, s * (xx[lane] - yy[lane]));
        let along = s * t;
        out[0][lane] = xx[lane] - along;
        out[1][lane] = c.mul_add(t, -yx);
        out[2][lane] = yy[lane] + along;
        out[3][lane] = c.mul_add(xz[lane], -(s * yz[lane]));
        out[4][lane] = s.mul_add(xz[lane], c * yz[lane]);
    }
    out
}

#[cfg(not(all(target_feature = "avx", target_feature = "fma")))]
pub(crate) use {turn as turn_f32, turn as turn_f64};

#[cfg(all(target_feature = "avx", target_feature = "fma"))]
pub(crate) use in_lanes::{turn_f32, turn_f64};

/// The blocks in the lanes of one vector.
#[cfg(all(target_feature = "avx", target_feature = "fma"))]
mod in_lanes {
    use super::TRANSPOSED;

    macro_rules! in_lanes {
        ($name:ident, $float:ident, $vector:ident) => {
            #[inline(always)]
            pub(crate) fn $name(rows: [[$float; 4]; 5], (s, c): ($float, $float)) -> [[$float; 4]; 5] {
                use wide::$vector;
                let [xx, xy, yy, xz, yz] = rows;
                let yx = $vector::new(TRANSPOSED.map(|lane| xy[lane]));
                let [xx, xy, yy] = [$vector::new(xx), $vector::new(xy), $vector::new(yy)];
                let [xz, yz] = [$vector::new(xz), $vector::new(yz)];
                let [s, c] = [$vector::splat(s), $vector::splat(c)];
                let t = c.mul_add(xy + yx, s * (xx - yy));
                [
                    s.mul_neg_add(t, xx).to_array(),
                    c.mul_sub(t, yx).to_array(),
                    s.mul_add(t, yy).to_array(),
                    c.mul_sub(xz, s * yz).to_array(),
                    s.mul_add(xz, c * yz).to_array(),
                ]
            }
        };
    }

    in_lanes!(turn_f32, f32, f32x4);
    in_lanes!(turn_f64, f64, f64x4);
}

#[cfg(test)]
mod tests {
    use nalgebra::{Matrix3, Rotation3, Vector3};

    use super::*;

    /// Entries xx, xy, yy, xz and yz, the blocks side by side.
    fn rows(blocks: &[Matrix3<f64>; 4]) -> [[f64; 4]; 5] {
        [(0, 0), (0, 1), (1, 1), (0, 2), (1, 2)].map(|place| blocks.map(|block| block[place]))
    }

    #[test]
    fn every_block_is_turned() {
        let tr = Matrix3::new(0.3, -0.7, 1.1, 0.2, 0.9, -0.4, 0.6, -1.3, 0.8);
        let tt = Matrix3::new(2.0, 0.5, -0.3, 0.5, 1.5, 0.7, -0.3, 0.7, 1.0);
        let rr = Matrix3::new(0.4, 0.1, 0.2, 0.1, 0.8, -0.6, 0.2, -0.6, 1.2);
        let blocks = [tt, rr, tr, tr.transpose()];
        for angle in [0.0, 0.4, -2.0, 3.0] {
            let turn_about_z = Rotation3::from_axis_angle(&Vector3::z_axis(), angle);
            let turned = blocks.map(|block| turn_about_z * block * turn_about_z.inverse());
            let (s, c) = Real::sin_cos(angle);
            let in_lanes = f64::turn_blocks(rows(&blocks), (s, c));
            let one_by_one = turn(rows(&blocks), (s, c));
            let in_lanes_of_f32 =
                f32::turn_blocks(rows(&blocks).map(|row| row.map(|entry| entry as f32)), (s as f32, c as f32));
            let expected = rows(&turned);
            for (row, lane) in (0..5).flat_map(|row| (0..4).map(move |lane| (row, lane))) {
                for (how, turned) in [("in lanes", in_lanes), ("one by one", one_by_one)] {
                    let off = (turned[row][lane] - expected[row][lane]).abs();
                    assert!(off < 1e-15, "{how}, {angle} rad, row {row}, lane {lane}: off by {off:e}");
                }
                let off = (f64::from(in_lanes_of_f32[row][lane]) - expected[row][lane]).abs();
                assert!(off < 1e-6, "f32, {angle} rad, row {row}, lane {lane}: off by {off:e}");
            }
        }
    }
}
