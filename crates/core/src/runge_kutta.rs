//! A step of the classical Runge-Kutta method.

/// The state after one step of length `h` from the state `y` at time `t`, where `rate` is its derivative: fourth order.
#[must_use]
pub fn runge_kutta_step<const N: usize>(
    rate: impl Fn(f64, [f64; N]) -> [f64; N],
    t: f64,
    y: [f64; N],
    h: f64,
) -> [f64; N] {
    let shifted = |k: &[f64; N], by: f64| core::array::from_fn(|n| y[n] + by * k[n]);
    let k1 = rate(t, y);
    let k2 = rate(t + 0.5 * h, shifted(&k1, 0.5 * h));
    let k3 = rate(t + 0.5 * h, shifted(&k2, 0.5 * h));
    let k4 = rate(t + h, shifted(&k3, h));
    core::array::from_fn(|n| y[n] + h / 6.0 * (k1[n] + 2.0 * k2[n] + 2.0 * k3[n] + k4[n]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math;

    /// A rotation by one radian that also depends on time, in steps of h and h/2.
    #[test]
    fn the_error_falls_with_the_fourth_power_of_the_step() {
        let off = |steps: u32| {
            let h = 1.0 / f64::from(steps);
            let rate = |t: f64, [x, y, z]: [f64; 3]| [-y, x, t * t * t * z];
            let step = |y, i| runge_kutta_step(rate, h * f64::from(i), y, h);
            let [x, y, z] = (0..steps).fold([1.0, 0.0, 1.0], step);
            let exact = [math::cos(1.0), math::sin(1.0), math::exp(0.25)];
            [x, y, z].iter().zip(exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
        };
        let ratio = off(10) / off(20);
        assert!((14.0..18.0).contains(&ratio), "{ratio}");
    }
}
