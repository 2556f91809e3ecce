//! Logarithms of many numbers, by the bits of their exponents.

use super::random::BATCH;
use core::f32::consts::SQRT_2;

/// Groups of sketches in a batch: sketches l and l + 16 of a batch are one group.
pub(crate) const GROUPS: usize = BATCH / 2;
/// Logarithms are added up as whole numbers, so that the order does not matter: steps per octave.
pub(crate) const STEPS: f32 = 4096.0;
/// What the logarithm of 0 is taken for, in octaves per sketch.
pub(crate) const OF_ZERO: i32 = -127;

/// `log2 |v_l| + log2 |v_(l+16)|` of each group, in steps.
#[inline(always)]
pub(crate) fn log2_of_groups(values: &[f32; BATCH]) -> [i32; GROUPS] {
    let mut logarithms = [0; GROUPS];
    for g in 0..GROUPS {
        logarithms[g] = log2_of_product(values[g], values[g + GROUPS]);
    }
    logarithms
}

/// `log2 |a b|` in steps. The product is taken of the significands alone, so it neither overflows nor vanishes.
#[inline(always)]
fn log2_of_product(a: f32, b: f32) -> i32 {
    let product = significand(a) * significand(b);
    // From 1 to 4; the series wants numbers near 1.
    let whole = i32::from(product >= SQRT_2) + i32::from(product >= 2.0 * SQRT_2);
    let m = f32::from_bits((product.to_bits() as i32 - (whole << 23)) as u32);
    // 2 artanh((m - 1) / (m + 1)).
    let s = (m - 1.0) / (m + 1.0);
    let y = s * s;
    let mut series = 1.0 / 9.0;
    for c in [1.0 / 7.0, 1.0 / 5.0, 1.0 / 3.0, 1.0] {
        series = f32::mul_add(series, y, c);
    }
    let fraction = series * s * (2.0 * core::f32::consts::LOG2_E * STEPS);
    let steps = (exponent(a) + exponent(b) + whole) * STEPS as i32;
    // The nearest whole number without a call: adding 1.5 * 2^23 leaves it in the low bits.
    let shifted = fraction + 12_582_912.0;
    steps + (shifted.to_bits() as i32 - 12_582_912.0_f32.to_bits() as i32)
}

/// The power of 2 in a number, [`OF_ZERO`] for 0.
#[inline(always)]
fn exponent(v: f32) -> i32 {
    (v.to_bits() >> 23 & 0xFF) as i32 + OF_ZERO
}

/// A number without its sign and power of 2: from 1 to 2.
#[inline(always)]
fn significand(v: f32) -> f32 {
    f32::from_bits(v.to_bits() & 0x007F_FFFF | 0x3F80_0000)
}

#[cfg(test)]
mod tests {
    use super::*;
    use tigereye_core::math;

    #[test]
    fn logarithms_are_right_to_half_a_step_or_little_more() {
        for i in 0..20_000_u32 {
            let number = |i: u32| {
                let bits = i.wrapping_mul(0x9E37_79B9);
                f32::from_bits(bits % 0x7F00_0000).max(f32::MIN_POSITIVE)
            };
            let (a, b) = (number(i), number(i + 77_777));
            let expected = f64::from(STEPS) * (math::log2(f64::from(a)) + math::log2(f64::from(b)));
            let got = f64::from(log2_of_product(-a, b));
            assert!((got - expected).abs() < 0.51, "{a} {b}: {got} and {expected}");
        }
    }

    #[test]
    fn nothing_has_the_lowest_logarithm() {
        assert_eq!(log2_of_product(0.0, -0.0), 2 * OF_ZERO * STEPS as i32);
        assert_eq!(log2_of_product(1.0, 1.0), 0);
    }
}
