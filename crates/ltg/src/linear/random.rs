//! Cauchy numbers that are a function of where they are used: no generator has a state, so neither threads nor shards
//! nor interruptions change them.
//!
//! Bits come from Philox-4x32-10 (Salmon, Moraes, Dror, Shaw: *Parallel random numbers: as easy as 1, 2, 3*, 2011).

/// Counters that are computed side by side.
pub(crate) const WIDTH: usize = 8;
/// Numbers per sample of a cell: those of one batch of sketches.
pub(crate) const BATCH: usize = 4 * WIDTH;

const MULTIPLIERS: [u32; 2] = [0xD251_1F53, 0xCD9E_8D57];
const WEYL: [u32; 2] = [0x9E37_79B9, 0xBB67_AE85];
const ROUNDS: usize = 10;

/// One round per step, on several counters at once. (Loops instead of closures throughout: closures may be compiled
/// apart, for processors without vectors.)
#[inline(always)]
pub(crate) fn philox(mut counter: [[u32; WIDTH]; 4], mut key: [u32; 2]) -> [[u32; WIDTH]; 4] {
    for round in 0..ROUNDS {
        if round > 0 {
            key[0] = key[0].wrapping_add(WEYL[0]);
            key[1] = key[1].wrapping_add(WEYL[1]);
        }
        for i in 0..WIDTH {
            let first = u64::from(counter[0][i]) * u64::from(MULTIPLIERS[0]);
            let second = u64::from(counter[2][i]) * u64::from(MULTIPLIERS[1]);
            counter[0][i] = (second >> 32) as u32 ^ counter[1][i] ^ key[0];
            counter[2][i] = (first >> 32) as u32 ^ counter[3][i] ^ key[1];
            counter[1][i] = second as u32;
            counter[3][i] = first as u32;
        }
    }
    counter
}

/// The Cauchy numbers of batch `batch` of sketches at sample `index` of the field (cell times S plus sample).
#[inline(always)]
pub(crate) fn cauchy_numbers(seed: u64, batch: u32, index: u64) -> [f32; BATCH] {
    let mut counter = [[index as u32; WIDTH], [(index >> 32) as u32; WIDTH], [batch; WIDTH], [0; WIDTH]];
    for i in 0..WIDTH {
        counter[3][i] = i as u32;
    }
    let bits = philox(counter, [seed as u32, (seed >> 32) as u32]);
    let mut numbers = [0.0; BATCH];
    for part in 0..4 {
        for i in 0..WIDTH {
            numbers[part * WIDTH + i] = cauchy(bits[part][i]);
        }
    }
    numbers
}

/// The tangent of an angle that is uniform over half a turn. Thirty bits give an angle `a` from 0 to 45 degrees, one
/// says whether `tan a` or `tan(90 degrees - a)` is meant, one gives the sign.
#[inline(always)]
fn cauchy(bits: u32) -> f32 {
    // From 0 to 1; half a step is added, so that it is never 0.
    let u = ((bits >> 2) as f32 + 0.5) * (1.0 / (1 << 30) as f32);
    let (sine, cosine) = sine_and_cosine_of_eighths(u);
    let (above, below) = if bits & 1 == 0 { (sine, cosine) } else { (cosine, sine) };
    let magnitude = above / below;
    f32::from_bits(magnitude.to_bits() | (bits & 2) << 30)
}

/// Sine and cosine of `u` times 45 degrees for `u` from 0 to 1, to single precision: Taylor series to the ninth and
/// eighth power.
#[inline(always)]
fn sine_and_cosine_of_eighths(u: f32) -> (f32, f32) {
    let x = u * core::f32::consts::FRAC_PI_4;
    let y = x * x;
    let mut sine = 1.0 / 362_880.0;
    for c in [-1.0 / 5040.0, 1.0 / 120.0, -1.0 / 6.0, 1.0] {
        sine = f32::mul_add(sine, y, c);
    }
    let mut cosine = 1.0 / 40_320.0;
    for c in [-1.0 / 720.0, 1.0 / 24.0, -0.5, 1.0] {
        cosine = f32::mul_add(cosine, y, c);
    }
    (sine * x, cosine)
}

#[cfg(test)]
mod tests {
    use super::*;
    use tigereye_core::math;

    #[test]
    fn bits_are_those_of_the_published_generator() {
        // Known answers of the authors' distribution (Random123, kat_vectors).
        let of = |counter: [u32; 4], key: [u32; 2]| philox(counter.map(|c| [c; WIDTH]), key).map(|c| c[3]);
        assert_eq!(of([0; 4], [0; 2]), [0x6627_e8d5, 0xe169_c58d, 0xbc57_ac4c, 0x9b00_dbd8]);
        assert_eq!(of([u32::MAX; 4], [u32::MAX; 2]), [0x408f_276d, 0x41c8_3b0e, 0xa20b_c7c6, 0x6d54_51fd]);
        let pi = [0x243f_6a88, 0x85a3_08d3, 0x1319_8a2e, 0x0370_7344];
        assert_eq!(of(pi, [0xa409_3822, 0x299f_31d0]), [0xd16c_fe09, 0x94fd_cceb, 0x5001_e420, 0x2412_6ea1]);
    }

    #[test]
    fn cauchy_numbers_are_tangents() {
        for i in 0..4096_u32 {
            let bits = i.wrapping_mul(0x9E37_79B9);
            let angle = (f64::from(bits >> 2) + 0.5) / f64::from(1 << 30) * core::f64::consts::FRAC_PI_4;
            let tangent = if bits & 1 == 0 { math::tan(angle) } else { 1.0 / math::tan(angle) };
            let expected = if bits & 2 == 0 { tangent } else { -tangent };
            assert!((f64::from(cauchy(bits)) - expected).abs() < 4e-7 * tangent, "{bits}");
        }
        assert!(cauchy(0).is_finite() && cauchy(1).is_finite() && cauchy(u32::MAX).is_finite());
    }

    #[test]
    fn quartiles_are_those_of_the_standard_cauchy_distribution() {
        let numbers: Vec<f32> = (0..8192).flat_map(|i| cauchy_numbers(7, 3, i)).collect();
        let share = |test: &dyn Fn(f32) -> bool| {
            numbers.iter().filter(|v| test(**v)).count() as f64 / numbers.len() as f64
        };
        // Standard error of a share of one in two is 0.001 here.
        assert!((share(&|v| v.abs() < 1.0) - 0.5).abs() < 0.004);
        assert!((share(&|v| v > 0.0) - 0.5).abs() < 0.004);
        let beyond_ten = 1.0 - 2.0 / core::f64::consts::PI * math::atan(10.0);
        assert!((share(&|v| v.abs() > 10.0) - beyond_ten).abs() < 0.002);
    }
}
