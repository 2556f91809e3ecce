//! Transcendental functions with the same bits on every platform.
//!
//! The standard library forwards these to the platform's C library, whose last bit differs between systems. Results
//! of tigereye must not, so every crate takes them from here (and `clippy.toml` forbids the others). `sqrt`, `abs`,
//! `floor` and `mul_add` are exact in IEEE 754 and may be used directly.

pub use core::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI, TAU};

macro_rules! from_libm {
    ($($(#[$doc:meta])* $name:ident($($arg:ident),+) = $libm:ident;)+) => {
        $($(#[$doc])* #[must_use] pub fn $name($($arg: f64),+) -> f64 { libm::$libm($($arg),+) })+
    };
}

from_libm! {
    /// Sine of an angle in radians.
    sin(x) = sin;
    /// Cosine of an angle in radians.
    cos(x) = cos;
    /// Tangent of an angle in radians.
    tan(x) = tan;
    /// Inverse sine, radians in [-pi/2, pi/2].
    asin(x) = asin;
    /// Inverse cosine, radians in [0, pi].
    acos(x) = acos;
    /// Inverse tangent, radians in (-pi/2, pi/2).
    atan(x) = atan;
    /// Angle of the vector (x, y) in radians, (-pi, pi]; 0 for (0, 0).
    atan2(y, x) = atan2;
    /// Length of the vector (x, y) without overflow or underflow.
    hypot(x, y) = hypot;
    /// e to the x.
    exp(x) = exp;
    /// Natural logarithm.
    ln(x) = log;
    /// Logarithm to base 2.
    log2(x) = log2;
    /// Logarithm to base 10.
    log10(x) = log10;
    /// x to the y.
    pow(x, y) = pow;
    /// Hyperbolic sine.
    sinh(x) = sinh;
    /// Hyperbolic cosine.
    cosh(x) = cosh;
    /// Hyperbolic tangent.
    tanh(x) = tanh;
    /// Round half to even, as NumPy's `round` does.
    round_ties_even(x) = rint;
}

/// The exponent `e` with `0.5 * 2^e <= |x| < 2^e`; 0 for zero. Subnormal numbers included.
#[must_use]
pub fn binary_exponent(x: f64) -> i32 {
    libm::frexp(x).1
}

/// `x * 2^e`, exact unless the result leaves the normal range.
#[must_use]
pub fn scale_by_power_of_two(x: f64, e: i32) -> f64 {
    libm::ldexp(x, e)
}

/// `a*d - b*c` with one rounding error of the result's own size (Kahan's algorithm with fused multiply-add).
#[must_use]
pub fn difference_of_products(a: f64, d: f64, b: f64, c: f64) -> f64 {
    let bc = b * c;
    let error = libm::fma(-b, c, bc);
    libm::fma(a, d, -bc) + error
}

/// Degrees to radians.
#[must_use]
pub fn radians(degrees: f64) -> f64 {
    degrees * (PI / 180.0)
}

/// Radians to degrees.
#[must_use]
pub fn degrees(radians: f64) -> f64 {
    radians * (180.0 / PI)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn difference_of_products_survives_cancellation() {
        let e = f64::EPSILON;
        // (1 + e)(1 - e) - 1 = -e^2 exactly; the naive form gives 0.
        assert_eq!(difference_of_products(1.0 + e, 1.0 - e, 1.0, 1.0), -e * e);
    }

    #[test]
    fn rounding_is_to_even() {
        assert_eq!([0.5, 1.5, 2.5, -0.5].map(round_ties_even), [0.0, 2.0, 2.0, -0.0]);
    }

    #[test]
    fn exponent_brackets_the_value() {
        for x in [1.0, 0.75, 1e-310, 1e300, 5e-324] {
            let m = scale_by_power_of_two(x, -binary_exponent(x));
            assert!((0.5..1.0).contains(&m), "{x}: {m}");
        }
    }
}
