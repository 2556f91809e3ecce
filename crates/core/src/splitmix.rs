//! SplitMix64, a pseudo-random generator that is the same everywhere.
//!
//! Source: Steele, Lea and Flood, "Fast splittable pseudorandom number generators", OOPSLA 2014; constants after
//! Vigna's public-domain version. One 64-bit state, period 2^64.

/// The generator, at a state.
#[derive(Clone, Debug)]
pub struct SplitMix64(u64);

impl SplitMix64 {
    /// Distance of states from each other, 2^64 over the golden ratio.
    pub const STEP: u64 = 0x9e37_79b9_7f4a_7c15;

    /// The generator of a seed.
    #[must_use]
    pub const fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// The next 64 random bits.
    pub const fn next_bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(Self::STEP);
        Self::mixed(self.0)
    }

    /// Uniform in [0, 1), a multiple of 2^-53.
    pub fn unit(&mut self) -> f64 {
        unit(self.next_bits())
    }

    /// Uniform in [-1, 1), a multiple of 2^-52.
    pub fn symmetric_unit(&mut self) -> f64 {
        2.0 * self.unit() - 1.0
    }

    /// The number of a state, uniform in [0, 1): a hash of it, for numbers in any order.
    #[must_use]
    pub fn unit_at(state: u64) -> f64 {
        unit(Self::mixed(state))
    }

    const fn mixed(mut z: u64) -> u64 {
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }
}

fn unit(bits: u64) -> f64 {
    (bits >> 11) as f64 / (1_u64 << 53) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_the_published_ones() {
        // First outputs for seed 1234567, as other implementations list them.
        let mut rng = SplitMix64::new(1_234_567);
        let expected = [6_457_827_717_110_365_317, 3_203_168_211_198_807_973, 9_817_491_932_198_370_423];
        assert_eq!([rng.next_bits(), rng.next_bits(), rng.next_bits()], expected);
    }
}
