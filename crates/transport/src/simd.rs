//! The hot loops compiled for several instruction sets, chosen once at run time.
//!
//! The code is the same for all: plain loops over lanes that the compiler turns into vector instructions. No operation is
//! fused or reordered, so every level gives the same bits.
//!
//! Invariant behind the one kind of `unsafe` here: a function compiled for an instruction set is only called when
//! [`Level::detect`] has found that set on this processor, and `Level`'s fields cannot be set from outside.
#![allow(unsafe_code)]

use crate::kernel::{Buffers, Specials, Window};
use crate::pulses::{LaneOf, PulseBlock};
use crate::scattering::Scattering;
use crate::sectors::Sectors;

/// Instruction set of the hot loops.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Level(Kind);

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Baseline,
    #[cfg(target_arch = "x86_64")]
    Avx2,
    #[cfg(target_arch = "x86_64")]
    Avx512,
}

impl Level {
    /// What every processor of the target has.
    pub const BASELINE: Self = Self(Kind::Baseline);

    /// The widest set this processor has.
    #[must_use]
    pub fn detect() -> Self {
        Self::available().pop().unwrap_or(Self::BASELINE)
    }

    /// All sets this processor has, narrowest first.
    #[must_use]
    pub fn available() -> Vec<Self> {
        let mut levels = vec![Self::BASELINE];
        #[cfg(target_arch = "x86_64")]
        {
            if is_x86_feature_detected!("avx2") {
                levels.push(Self(Kind::Avx2));
            }
            if is_x86_feature_detected!("avx512f") && is_x86_feature_detected!("avx512dq") {
                levels.push(Self(Kind::Avx512));
            }
        }
        levels
    }

    /// Name for reports: `baseline`, `avx2` or `avx512`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self.0 {
            Kind::Baseline => "baseline",
            #[cfg(target_arch = "x86_64")]
            Kind::Avx2 => "avx2",
            #[cfg(target_arch = "x86_64")]
            Kind::Avx512 => "avx512",
        }
    }
}

/// Defines `$name`, which runs the expression compiled for the given level.
macro_rules! for_every_level {
    ($(#[$doc:meta])* fn $name:ident<const $n:ident: usize>($($arg:ident: $ty:ty),* $(,)?) -> $ret:ty $body:block) => {
        $(#[$doc])*
        pub(crate) fn $name<const $n: usize>(level: Level, $($arg: $ty),*) -> $ret {
            #[inline(always)]
            fn plain<const $n: usize>($($arg: $ty),*) -> $ret $body

            #[cfg(target_arch = "x86_64")]
            #[target_feature(enable = "avx2")]
            fn avx2<const $n: usize>($($arg: $ty),*) -> $ret { plain::<$n>($($arg),*) }

            #[cfg(target_arch = "x86_64")]
            #[target_feature(enable = "avx512f,avx512dq")]
            fn avx512<const $n: usize>($($arg: $ty),*) -> $ret { plain::<$n>($($arg),*) }

            match level.0 {
                Kind::Baseline => plain::<$n>($($arg),*),
                // SAFETY: a level beyond the baseline exists only where the processor has the instructions.
                #[cfg(target_arch = "x86_64")]
                Kind::Avx2 => unsafe { avx2::<$n>($($arg),*) },
                // SAFETY: as above.
                #[cfg(target_arch = "x86_64")]
                Kind::Avx512 => unsafe { avx512::<$n>($($arg),*) },
            }
        }
    };
}

for_every_level! {
    /// [`Buffers::step`].
    fn step<const N: usize>(
        buffers: &mut Buffers<N>,
        field: &Scattering<'_>,
        window: Window,
        specials: &Specials<N>,
    ) -> [f64; N] {
        buffers.step(field, window, specials)
    }
}

for_every_level! {
    /// `sum over cells and samples of |b1 - b2|`, W/rad, as if all samples were lobes; rows first.
    fn l1_blocks<const N: usize>(
        sectors: &Sectors,
        width: usize,
        b1: &PulseBlock<N>,
        b2: &PulseBlock<N>,
    ) -> [f64; N] {
        l1_by_rows(sectors, width, b1.lobes.len(), |i| {
            let (a1, a2) = (&b1.lobes[i], &b2.lobes[i]);
            let mut difference = [[0.0; N]; 8];
            for j in 0..8 {
                for l in 0..N {
                    difference[j][l] = a1[j][l] - a2[j][l];
                }
            }
            difference
        })
    }
}

for_every_level! {
    /// The same between any lanes of several blocks.
    fn l1_lanes<const N: usize>(
        sectors: &Sectors,
        width: usize,
        blocks: &[&PulseBlock<N>],
        pairs: &[(LaneOf, LaneOf); N],
    ) -> [f64; N] {
        let cells = blocks.first().map_or(0, |b| b.lobes.len());
        l1_by_rows(sectors, width, cells, |i| {
            let mut difference = [[0.0; N]; 8];
            for l in 0..N {
                let (p, q) = pairs[l];
                let (a1, a2) = (&blocks[p.block].lobes[i], &blocks[q.block].lobes[i]);
                for j in 0..8 {
                    difference[j][l] = a1[j][p.lane] - a2[j][q.lane];
                }
            }
            difference
        })
    }
}

/// Each row alone, then rows in order.
#[inline(always)]
fn l1_by_rows<const N: usize>(
    sectors: &Sectors,
    width: usize,
    cells: usize,
    difference: impl Fn(usize) -> [[f64; N]; 8],
) -> [f64; N] {
    let mut total = [0.0; N];
    for start in (0..cells).step_by(width) {
        let mut row = [0.0; N];
        for i in start..start + width {
            let l1 = sectors.l1(&difference(i));
            for l in 0..N {
                row[l] += l1[l];
            }
        }
        for l in 0..N {
            total[l] += row[l];
        }
    }
    total
}
