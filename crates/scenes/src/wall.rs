//! Where walls send light: specular and diffuse reflection on eight directions.
//!
//! Light that travels at 45 j degrees leaves a mirror whose line lies at angle a in the direction 2 a - 45 j. That is one
//! of the eight directions again where a is a multiple of 22.5 degrees. For other angles the light is split between those of
//! the two nearest such mirrors, so that its mean turns with the mirror; a part that would leave on the mirror's other side
//! goes to the other of the two.

use tigereye_core::math;

/// Cosines below this are rounding: the light runs along the wall.
const ALONG: f64 = 1e-9;

/// Parts of the light that leave in each direction, for each direction it arrives in: `[k][j]`, columns add up to 1.
pub type Parts = [[f64; 8]; 8];

/// A mirror whose line lies at `angle_deg`, the same on both sides. Light that runs along it passes.
#[must_use]
pub fn specular(angle_deg: f64) -> Parts {
    let steps = (angle_deg / 22.5).rem_euclid(8.0);
    let lower = steps.floor();
    let upper_part = steps - lower;
    let mut parts = [[0.0; 8]; 8];
    for j in 0..8 {
        // Direction of the reflected light for a mirror at 22.5 m degrees: m - j.
        let leaving = |m: usize| (m + 16 - j) % 8;
        let (first, second) = (leaving(lower as usize), leaving(lower as usize + 1));
        let stays = |k: usize| side(angle_deg, j) * side(angle_deg, k) <= ALONG;
        let upper_part = match (stays(first), stays(second)) {
            (true, false) => 0.0,
            (false, true) => 1.0,
            _ => upper_part,
        };
        parts[first][j] += 1.0 - upper_part;
        parts[second][j] += upper_part;
    }
    parts
}

/// A matt wall whose line lies at `angle_deg`, the same on both sides: light leaves to the side it came from in parts that go
/// with the cosine of the angle to the normal (Lambert's law). Light that runs along the wall leaves to both sides.
#[must_use]
pub fn diffuse(angle_deg: f64) -> Parts {
    let mut parts = [[0.0; 8]; 8];
    for j in 0..8 {
        let from = side(angle_deg, j);
        let weight = |k: usize| {
            let to = side(angle_deg, k);
            if from.abs() <= ALONG { to.abs() } else { (-to * from.signum()).max(0.0) }
        };
        // Rounding must not let light along the wall into it.
        let weight = |k: usize| if weight(k) <= ALONG { 0.0 } else { weight(k) };
        let sum: f64 = (0..8).map(weight).sum();
        for k in 0..8 {
            parts[k][j] = weight(k) / sum;
        }
    }
    parts
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

/// Closes the wall: light returns the way it came where it would go on into another wall's cell, or to a neighbour that lies
/// beyond the wall.
///
/// Surfaces are stairs on a grid, and at their corners directions alone do not tell which side is which. So the neighbours do:
/// those that follow each other round the cell without a wall between them lie on the same side.
pub(crate) fn closed(mut parts: Parts, beside: impl Fn(usize) -> Beside) -> Parts {
    let beside: [Beside; 8] = std::array::from_fn(beside);
    for j in 0..8 {
        let from = (j + 4) % 8;
        for k in (0..8).filter(|&k| k != from && !same_side(&beside, from, k)) {
            let part = core::mem::take(&mut parts[k][j]);
            parts[from][j] += part;
        }
    }
    parts
}

/// Whether a walk round the cell leads from neighbour `a` to neighbour `b` over open ones alone; both may be the end of it.
fn same_side(beside: &[Beside; 8], a: usize, b: usize) -> bool {
    let walk =
        |from: usize, to: usize| (1..(to + 8 - from) % 8).all(|i| beside[(from + i) % 8] == Beside::Open);
    beside[a] != Beside::Wall && beside[b] != Beside::Wall && (walk(a, b) || walk(b, a))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sent(parts: &Parts, j: usize) -> Vec<(usize, f64)> {
        (0..8).filter(|&k| parts[k][j] > 0.0).map(|k| (k, parts[k][j])).collect()
    }

    #[test]
    fn mirrors_turn_directions_about_their_line() {
        let level = specular(0.0);
        assert_eq!((sent(&level, 1), sent(&level, 6)), (vec![(7, 1.0)], vec![(2, 1.0)]));
        assert_eq!(sent(&level, 4), [(4, 1.0)], "along the mirror");
        let rising = specular(45.0);
        assert_eq!((sent(&rising, 0), sent(&rising, 7)), (vec![(2, 1.0)], vec![(3, 1.0)]));
        assert_eq!(specular(90.0), specular(-90.0));
        assert_eq!(sent(&specular(135.0), 0), [(6, 1.0)]);
        assert_eq!(sent(&specular(22.5), 0), [(1, 1.0)], "half the angle is exact too");
    }

    #[test]
    fn slanted_mirrors_split_between_their_neighbours() {
        // 11.25 degrees lie in the middle between mirrors at 0 and at 22.5 degrees.
        let m = specular(11.25);
        assert_eq!(sent(&m, 6), [(2, 0.5), (3, 0.5)]);
        assert_eq!(sent(&m, 0), [(1, 1.0)], "what would pass through it stays on its side");
    }

    #[test]
    fn nothing_is_lost_and_nothing_passes_through() {
        for step in 0..720 {
            let angle = 0.25 * f64::from(step);
            for parts in [specular(angle), diffuse(angle)] {
                for j in 0..8 {
                    let sum: f64 = (0..8).map(|k| parts[k][j]).sum();
                    assert!((sum - 1.0).abs() < 1e-15, "{angle} degrees, direction {j}: {sum}");
                    let through = (0..8)
                        .filter(|&k| side(angle, j) * side(angle, k) > ALONG)
                        .map(|k| parts[k][j])
                        .fold(0.0, f64::max);
                    assert_eq!(through, 0.0, "{angle} degrees, direction {j}");
                }
            }
        }
    }

    #[test]
    fn matt_walls_follow_lamberts_law() {
        let sent = sent(&diffuse(0.0), 7);
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
        let parts = closed(specular(0.0), |k| if k == 7 { Beside::Wall } else { Beside::Open });
        assert_eq!(sent(&parts, 1), [(5, 1.0)]);
        assert_eq!(sent(&parts, 2), [(6, 1.0)], "downwards nothing is in the way");
    }

    #[test]
    fn closed_walls_let_nothing_round_their_corners() {
        // A level mirror as part of an upright wall: what it would send to the other side returns.
        let parts = closed(specular(0.0), |k| if k % 4 == 2 { Beside::Wall } else { Beside::Open });
        assert_eq!(sent(&parts, 1), [(5, 1.0)]);
        assert_eq!(sent(&parts, 0), [(4, 1.0)]);
        let end = closed(specular(90.0), |k| if k == 6 { Beside::Wall } else { Beside::Open });
        assert_eq!(sent(&end, 7), [(5, 1.0)], "at the end of a wall both sides are one");
    }
}
