//! Where walls send light: specular and diffuse reflection on eight directions.
//!
//! Light that travels at 45 j degrees leaves a mirror whose line lies at angle a in the direction 2 a - 45 j. That is
//! one of the eight directions again where a is a multiple of 22.5 degrees. For other angles the light is split between
//! those of the two nearest such mirrors, so that its mean turns with the mirror; a part that would leave on the
//! mirror's other side goes to the other of the two.

use tigereye_core::math;

/// Cosines below this are rounding: the light runs along the wall.
const ALONG: f64 = 1e-9;

/// Shares of the light that leave in each direction, for each direction it arrives in: `[k][j]`, columns add up to
/// exactly 1.
pub(crate) type Matrix = [[f64; 8]; 8];

/// A mirror whose line lies at `angle_deg`, the same on both sides. Light that runs along it passes.
///
/// Without a direction, as in a cell that is free all round, it faces the light and sends it back.
pub(crate) fn specular(angle_deg: Option<f64>) -> Matrix {
    let mut matrix = [[0.0; 8]; 8];
    for j in 0..8 {
        let angle_deg = angle_deg.unwrap_or_else(|| facing(j));
        let steps = (angle_deg / 22.5).rem_euclid(8.0);
        let lower = steps.floor();
        let upper_share = steps - lower;
        // Direction of the reflected light for a mirror at 22.5 m degrees: m - j.
        let leaving = |m: usize| (m + 16 - j) % 8;
        let (first, second) = (leaving(lower as usize), leaving(lower as usize + 1));
        let stays = |k: usize| side(angle_deg, j) * side(angle_deg, k) <= ALONG;
        let upper_share = match (stays(first), stays(second)) {
            (true, false) => 0.0,
            (false, true) => 1.0,
            _ => upper_share,
        };
        let mut column = [0.0; 8];
        column[first] += 1.0 - upper_share;
        column[second] += upper_share;
        set_column(&mut matrix, j, column);
    }
    matrix
}

/// A diffuse wall whose line lies at `angle_deg`, the same on both sides: light leaves to the side it came from in
/// shares that go with the cosine of the angle to the normal (Lambert's law). Light that runs along the wall leaves to
/// both sides.
///
/// Without a direction it faces the light.
pub(crate) fn diffuse(angle_deg: Option<f64>) -> Matrix {
    let mut matrix = [[0.0; 8]; 8];
    for j in 0..8 {
        let angle_deg = angle_deg.unwrap_or_else(|| facing(j));
        let from = side(angle_deg, j);
        let weight = |k: usize| {
            let to = side(angle_deg, k);
            let weight = if from.abs() <= ALONG { to.abs() } else { -to * from.signum() };
            // Rounding must not let light along the wall into it.
            if weight <= ALONG { 0.0 } else { weight }
        };
        let weights: [f64; 8] = std::array::from_fn(weight);
        let sum: f64 = weights.iter().sum();
        set_column(&mut matrix, j, weights.map(|w| w / sum));
    }
    matrix
}

/// Line of a wall that light travelling in direction `j` meets at a right angle, degrees.
fn facing(j: usize) -> f64 {
    45.0 * j as f64 + 90.0
}

/// Sets a column, rounded so that its shares add up to exactly 1 in any order.
///
/// Between closed walls light is reflected thousands of times, and a sum beside 1 by a single unit in the last place is
/// a growth or a loss each time. Multiples of 2^-53 up to 1 are added without rounding.
fn set_column(matrix: &mut Matrix, j: usize, shares: [f64; 8]) {
    const UNIT: f64 = f64::EPSILON / 2.0;
    let mut shares = shares.map(|share| math::round_ties_even(share / UNIT) * UNIT);
    let largest = (1..8).fold(0, |best, k| if shares[k] > shares[best] { k } else { best });
    let others: f64 = (0..8).filter(|&k| k != largest).map(|k| shares[k]).sum();
    shares[largest] = 1.0 - others;
    for k in 0..8 {
        matrix[k][j] = shares[k];
    }
}

/// Cosine between direction `k` and the normal of the wall, that a quarter turn from its line: positive for light that
/// travels to the wall's upper side.
fn side(angle_deg: f64, k: usize) -> f64 {
    math::cos(math::radians(angle_deg + 90.0 - 45.0 * k as f64))
}

/// What lies beside a wall's cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Beside {
    /// Cells that light passes.
    Open,
    /// Where light may go, but no way leads on: absorbing walls, and the outside of the grid.
    End,
    /// Walls that send light back.
    Wall,
}

/// Closes the wall: light returns the way it came where it would go on into another wall's cell, or to a neighbour that
/// lies beyond the wall.
///
/// Surfaces are stairs on a grid, and at their corners directions alone do not tell which side is which. So the
/// neighbours do: those that follow each other round the cell without a wall between them lie on the same side.
pub(crate) fn closed(mut matrix: Matrix, beside: impl Fn(usize) -> Beside) -> Matrix {
    let beside: [Beside; 8] = std::array::from_fn(beside);
    for j in 0..8 {
        let from = (j + 4) % 8;
        for k in (0..8).filter(|&k| k != from && !same_side(&beside, from, k)) {
            let share = core::mem::take(&mut matrix[k][j]);
            matrix[from][j] += share;
        }
    }
    matrix
}

/// Whether a walk round the cell leads from neighbour `a` to neighbour `b` over open ones alone; both may be the end of
/// it.
fn same_side(beside: &[Beside; 8], a: usize, b: usize) -> bool {
    let walk =
        |from: usize, to: usize| (1..(to + 8 - from) % 8).all(|i| beside[(from + i) % 8] == Beside::Open);
    beside[a] != Beside::Wall && beside[b] != Beside::Wall && (walk(a, b) || walk(b, a))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sent(matrix: &Matrix, j: usize) -> Vec<(usize, f64)> {
        (0..8).filter(|&k| matrix[k][j] > 0.0).map(|k| (k, matrix[k][j])).collect()
    }

    #[test]
    fn mirrors_turn_directions_about_their_line() {
        let level = specular(Some(0.0));
        assert_eq!((sent(&level, 1), sent(&level, 6)), (vec![(7, 1.0)], vec![(2, 1.0)]));
        assert_eq!(sent(&level, 4), [(4, 1.0)], "along the mirror");
        let rising = specular(Some(45.0));
        assert_eq!((sent(&rising, 0), sent(&rising, 7)), (vec![(2, 1.0)], vec![(3, 1.0)]));
        assert_eq!(specular(Some(90.0)), specular(Some(-90.0)));
        assert_eq!(sent(&specular(Some(135.0)), 0), [(6, 1.0)]);
        assert_eq!(sent(&specular(Some(22.5)), 0), [(1, 1.0)], "half the angle is exact too");
    }

    #[test]
    fn slanted_mirrors_split_between_their_neighbours() {
        // 11.25 degrees lie in the middle between mirrors at 0 and at 22.5 degrees.
        let m = specular(Some(11.25));
        assert_eq!(sent(&m, 6), [(2, 0.5), (3, 0.5)]);
        assert_eq!(sent(&m, 0), [(1, 1.0)], "what would pass through it stays on its side");
    }

    #[test]
    fn nothing_is_lost_and_nothing_passes_through() {
        for step in 0..720 {
            let angle = 0.25 * f64::from(step);
            for matrix in [specular(Some(angle)), diffuse(Some(angle))] {
                for j in 0..8 {
                    let sum: f64 = (0..8).map(|k| matrix[k][j]).sum();
                    assert_eq!(sum, 1.0, "{angle} degrees, direction {j}");
                    let backwards: f64 = (0..8).rev().map(|k| matrix[k][j]).sum();
                    assert_eq!(backwards, 1.0, "{angle} degrees, direction {j}: exact in any order");
                    let through = (0..8)
                        .filter(|&k| side(angle, j) * side(angle, k) > ALONG)
                        .map(|k| matrix[k][j])
                        .fold(0.0, f64::max);
                    assert_eq!(through, 0.0, "{angle} degrees, direction {j}");
                }
            }
        }
    }

    #[test]
    fn diffuse_walls_follow_lamberts_law() {
        let sent = sent(&diffuse(Some(0.0)), 7);
        let whole = 1.0 + core::f64::consts::SQRT_2;
        let expected =
            [(1, core::f64::consts::FRAC_1_SQRT_2), (2, 1.0), (3, core::f64::consts::FRAC_1_SQRT_2)];
        for (got, (k, cosine)) in sent.iter().zip(expected) {
            assert!(got.0 == k && (got.1 - cosine / whole).abs() < 1e-15, "{got:?}");
        }
        assert_eq!(sent.len(), 3);
    }

    #[test]
    fn closed_walls_send_back_what_would_enter_a_neighbour() {
        let matrix = closed(specular(Some(0.0)), |k| if k == 7 { Beside::Wall } else { Beside::Open });
        assert_eq!(sent(&matrix, 1), [(5, 1.0)]);
        assert_eq!(sent(&matrix, 2), [(6, 1.0)], "downwards nothing is in the way");
    }

    #[test]
    fn closed_walls_let_nothing_round_their_corners() {
        // A level mirror as part of an upright wall: what it would send to the other side returns.
        let matrix = closed(specular(Some(0.0)), |k| if k % 4 == 2 { Beside::Wall } else { Beside::Open });
        assert_eq!(sent(&matrix, 1), [(5, 1.0)]);
        assert_eq!(sent(&matrix, 0), [(4, 1.0)]);
        let end = closed(specular(Some(90.0)), |k| if k == 6 { Beside::Wall } else { Beside::Open });
        assert_eq!(sent(&end, 7), [(5, 1.0)], "at the end of a wall both sides are one");
    }

    #[test]
    fn walls_without_a_direction_face_the_light() {
        let (mirror, wall) = (specular(None), diffuse(None));
        for j in 0..8 {
            assert_eq!(sent(&mirror, j), [((j + 4) % 8, 1.0)]);
            // Lambert's law about the way back: nothing ahead, nothing to the sides.
            let back = sent(&wall, j);
            assert_eq!(back.len(), 3);
            assert!((wall[(j + 4) % 8][j] - diffuse(Some(0.0))[2][6]).abs() < 1e-15, "direction {j}");
            assert!((wall[(j + 3) % 8][j] - wall[(j + 5) % 8][j]).abs() < 1e-15);
        }
    }
}
