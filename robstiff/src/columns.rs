//! The columns of homogeneous matrices, each in the lanes of a vector.
//!
//! A turn mixes two axes of a frame in the same way in x, y and z: side by side
//! that is four instructions, whatever the axes. Gain: `benches/README.md`.

use crate::Real;

/// Entry by entry.
#[inline(always)]
pub(crate) fn scaled<T: Real>(column: [T; 4], factor: T) -> [T; 4] {
    column.map(|entry| entry * factor)
}

/// Entry by entry.
#[inline(always)]
pub(crate) fn plus_scaled<T: Real>(column: [T; 4], other: [T; 4], factor: T) -> [T; 4] {
    let [x, y, z, w] = column;
    let [a, b, c, d] = other;
    [a.mul_add(factor, x), b.mul_add(factor, y), c.mul_add(factor, z), d.mul_add(factor, w)]
}

/// Entry by entry.
#[inline(always)]
pub(crate) fn product<T: Real>(column: [T; 4], other: [T; 4]) -> [T; 4] {
    let [x, y, z, w] = column;
    let [a, b, c, d] = other;
    [x * a, y * b, z * c, w * d]
}

/// Entry by entry.
#[inline(always)]
pub(crate) fn plus_product<T: Real>(column: [T; 4], other: [T; 4], by: [T; 4]) -> [T; 4] {
    let [x, y, z, w] = column;
    let [a, b, c, d] = other;
    let [e, f, g, h] = by;
    [a.mul_add(e, x), b.mul_add(f, y), c.mul_add(g, z), d.mul_add(h, w)]
}

/// The first three entries.
#[inline(always)]
pub(crate) fn direction<T: Real>([x, y, z, _]: [T; 4]) -> [T; 4] {
    [x, y, z, T::zero()]
}

#[cfg(not(all(target_feature = "avx", target_feature = "fma")))]
pub(crate) mod f32 {
    pub(crate) use super::{direction, plus_product, plus_scaled, product, scaled};
}

#[cfg(not(all(target_feature = "avx", target_feature = "fma")))]
pub(crate) mod f64 {
    pub(crate) use super::{direction, plus_product, plus_scaled, product, scaled};
}

#[cfg(all(target_feature = "avx", target_feature = "fma"))]
macro_rules! in_lanes {
    ($float:ident, $vector:ident, $bits:ident) => {
        pub(crate) mod $float {
            use wide::{$bits, $vector};

            #[inline(always)]
            pub(crate) fn scaled(column: [$float; 4], factor: $float) -> [$float; 4] {
                ($vector::new(column) * $vector::splat(factor)).to_array()
            }

            #[inline(always)]
            pub(crate) fn plus_scaled(column: [$float; 4], other: [$float; 4], factor: $float) -> [$float; 4] {
                $vector::splat(factor).mul_add($vector::new(other), $vector::new(column)).to_array()
            }

            #[inline(always)]
            pub(crate) fn product(column: [$float; 4], other: [$float; 4]) -> [$float; 4] {
                ($vector::new(column) * $vector::new(other)).to_array()
            }

            #[inline(always)]
            pub(crate) fn plus_product(column: [$float; 4], other: [$float; 4], by: [$float; 4]) -> [$float; 4] {
                $vector::new(other).mul_add($vector::new(by), $vector::new(column)).to_array()
            }

            #[inline(always)]
            pub(crate) fn direction(column: [$float; 4]) -> [$float; 4] {
                let bits = $vector::new(column).to_bits() & $bits::new([!0, !0, !0, 0]);
                $vector::from_bits(bits).to_array()
            }
        }
    };
}

#[cfg(all(target_feature = "avx", target_feature = "fma"))]
in_lanes!(f32, f32x4, u32x4);
#[cfg(all(target_feature = "avx", target_feature = "fma"))]
in_lanes!(f64, f64x4, u64x4);

#[cfg(test)]
mod tests {
    use crate::Real;

    #[test]
    fn entries_are_multiplied_and_moved_on() {
        let (column, other, by) = ([1.0, -2.0, 0.5, 1.0], [4.0, 0.25, -8.0, 0.0], [0.5, -1.0, 2.0, 3.0]);
        assert_eq!(f64::product(column, other), [4.0, -0.5, -4.0, 0.0]);
        assert_eq!(f64::plus_product(column, other, by), [3.0, -2.25, -15.5, 1.0]);
        assert_eq!(f64::cycled(column), [-2.0, 0.5, 1.0, 1.0]);
        let [column, other, by] = [column, other, by].map(|column| column.map(|entry| entry as f32));
        assert_eq!(f32::product(column, other), [4.0, -0.5, -4.0, 0.0]);
        assert_eq!(f32::plus_product(column, other, by), [3.0, -2.25, -15.5, 1.0]);
        assert_eq!(f32::cycled(column), [-2.0, 0.5, 1.0, 1.0]);
    }

    #[test]
    fn every_entry_is_scaled_and_added() {
        let (column, other) = ([1.0, -2.0, 0.5, 1.0], [4.0, 0.25, -8.0, 0.0]);
        assert_eq!(f64::scaled(column, -2.0), [-2.0, 4.0, -1.0, -2.0]);
        assert_eq!(f64::plus_scaled(column, other, 0.5), [3.0, -1.875, -3.5, 1.0]);
        assert_eq!(f64::direction(column).map(f64::to_bits), [1.0, -2.0, 0.5, 0.0].map(f64::to_bits));
        let (column, other) = (column.map(|entry| entry as f32), other.map(|entry| entry as f32));
        assert_eq!(f32::scaled(column, -2.0), [-2.0, 4.0, -1.0, -2.0]);
        assert_eq!(f32::plus_scaled(column, other, 0.5), [3.0, -1.875, -3.5, 1.0]);
    }
}
