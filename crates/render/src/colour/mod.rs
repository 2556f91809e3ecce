//! Colours, colour maps and the palette of series.

mod bam;
mod bam_o;
mod batlow;
mod berlin;
mod cork_o;
mod imola;
mod inferno;
mod lajolla;
mod magma;
mod plasma;
mod roma;
mod roma_o;
mod vanimo;
mod vik;
mod viridis;

use tigereye_core::choice;

/// An sRGB colour with opacity.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Rgba {
    /// Red, 0 to 255.
    pub r: u8,
    /// Green, 0 to 255.
    pub g: u8,
    /// Blue, 0 to 255.
    pub b: u8,
    /// Opacity, 0 (invisible) to 255.
    pub a: u8,
}

impl Rgba {
    /// White, the ground of every picture.
    pub const WHITE: Self = Self::hex(0xffffff);
    /// The near-black of titles and frames.
    pub const INK: Self = Self::hex(0x1a1a1a);
    /// The grey of axis numbers and secondary text.
    pub const MUTED: Self = Self::hex(0x555555);
    /// The light grey of grid lines.
    pub const HAIRLINE: Self = Self::hex(0xd9d9d9);
    /// Transmission, as in the thesis's figures: red.
    pub const TRANSMISSION: Self = Self::hex(0xc8281e);
    /// Light, as in the thesis's figures: blue.
    pub const LIGHT: Self = Self::hex(0x1f5fbf);
    /// Cells without light, and values at or below the bottom of a logarithmic scale.
    pub const NO_LIGHT: Self = Self::hex(0xefece6);
    /// Cells without a tensor: no material, or a zero tensor.
    pub const MASKED: Self = Self::hex(0xbdbdbd);
    /// Cells whose value is not finite; hatched if cells are large enough.
    pub const NOT_FINITE: Self = Self::hex(0xa8a8a8);

    /// Opaque colour from `0xrrggbb`.
    #[must_use]
    pub const fn hex(rgb: u32) -> Self {
        Self { r: (rgb >> 16) as u8, g: (rgb >> 8) as u8, b: rgb as u8, a: 255 }
    }

    /// The same colour with opacity `alpha` in [0, 1].
    #[must_use]
    pub fn with_opacity(self, alpha: f64) -> Self {
        Self { a: (alpha.clamp(0.0, 1.0) * 255.0).round() as u8, ..self }
    }

    /// The colour at `t` in [0, 1] on the straight sRGB line from `self` to `other`.
    #[must_use]
    pub fn mixed(self, other: Self, t: f64) -> Self {
        let t = if t.is_nan() { 0.0 } else { t.clamp(0.0, 1.0) };
        let mix = |a: u8, b: u8| (f64::from(a) + (f64::from(b) - f64::from(a)) * t).round() as u8;
        Self {
            r: mix(self.r, other.r),
            g: mix(self.g, other.g),
            b: mix(self.b, other.b),
            a: mix(self.a, other.a),
        }
    }

    /// Red, green, blue and opacity.
    #[must_use]
    pub const fn to_array(self) -> [u8; 4] {
        [self.r, self.g, self.b, self.a]
    }
}

/// The colour maps, 256 entries each.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ColourMap {
    /// Sequential, dark purple to yellow.
    #[default]
    Viridis,
    /// Sequential, black over purple to pale yellow.
    Magma,
    /// Sequential, black over red to pale yellow.
    Inferno,
    /// Sequential, dark blue over pink to yellow.
    Plasma,
    /// Sequential, dark blue over green to pink.
    Batlow,
    /// Sequential, black over orange to pale yellow.
    Lajolla,
    /// Sequential, blue over green to yellow.
    Imola,
    /// Diverging, blue over near-white to red-brown; for values around 0.
    Vik,
    /// Diverging, red-brown over pale yellow to blue.
    Roma,
    /// Diverging, magenta over near-white to green.
    Bam,
    /// Diverging, light blue over black to light red.
    Berlin,
    /// Diverging, pink over black to light green.
    Vanimo,
    /// Cyclic; for directions.
    RomaO,
    /// Cyclic, magenta over grey to green and back.
    BamO,
    /// Cyclic, blue over grey to green and back.
    CorkO,
}

choice!(ColourMap {
    Viridis = "viridis": "Sequential, dark purple to yellow.",
    Magma = "magma": "Sequential, black over purple to pale yellow.",
    Inferno = "inferno": "Sequential, black over red to pale yellow.",
    Plasma = "plasma": "Sequential, dark blue over pink to yellow.",
    Batlow = "batlow": "Sequential, dark blue over green to pink.",
    Lajolla = "lajolla": "Sequential, black over orange to pale yellow.",
    Imola = "imola": "Sequential, blue over green to yellow.",
    Vik = "vik": "Diverging, blue over near-white to red-brown.",
    Roma = "roma": "Diverging, red-brown over pale yellow to blue.",
    Bam = "bam": "Diverging, magenta over near-white to green.",
    Berlin = "berlin": "Diverging, light blue over black to light red.",
    Vanimo = "vanimo": "Diverging, pink over black to light green.",
    RomaO = "romaO": "Cyclic, for directions.",
    BamO = "bamO": "Cyclic, magenta over grey to green and back.",
    CorkO = "corkO": "Cyclic, blue over grey to green and back.",
});

impl ColourMap {
    /// Whether the ends have the same colour.
    #[must_use]
    pub const fn is_cyclic(self) -> bool {
        matches!(self, Self::RomaO | Self::BamO | Self::CorkO)
    }

    /// The 256 entries.
    #[must_use]
    pub const fn entries(self) -> &'static [[u8; 3]; 256] {
        match self {
            Self::Viridis => &VIRIDIS,
            Self::Magma => &MAGMA,
            Self::Inferno => &INFERNO,
            Self::Plasma => &PLASMA,
            Self::Batlow => &BATLOW,
            Self::Lajolla => &LAJOLLA,
            Self::Imola => &IMOLA,
            Self::Vik => &VIK,
            Self::Roma => &ROMA,
            Self::Bam => &BAM,
            Self::Berlin => &BERLIN,
            Self::Vanimo => &VANIMO,
            Self::RomaO => &ROMA_O,
            Self::BamO => &BAM_O,
            Self::CorkO => &CORK_O,
        }
    }

    /// The nearest entry at `t`; outside [0, 1] the end colour, the first one for NaN.
    #[must_use]
    pub fn sample(self, t: f64) -> Rgba {
        let index = if t.is_nan() { 0 } else { (t.clamp(0.0, 1.0) * 255.0).round() as usize };
        let [r, g, b] = self.entries()[index];
        Rgba { r, g, b, a: 255 }
    }
}

static VIRIDIS: [[u8; 3]; 256] = decoded(viridis::TABLE);
static MAGMA: [[u8; 3]; 256] = decoded(magma::TABLE);
static INFERNO: [[u8; 3]; 256] = decoded(inferno::TABLE);
static PLASMA: [[u8; 3]; 256] = decoded(plasma::TABLE);
static BATLOW: [[u8; 3]; 256] = decoded(batlow::TABLE);
static LAJOLLA: [[u8; 3]; 256] = decoded(lajolla::TABLE);
static IMOLA: [[u8; 3]; 256] = decoded(imola::TABLE);
static VIK: [[u8; 3]; 256] = decoded(vik::TABLE);
static ROMA: [[u8; 3]; 256] = decoded(roma::TABLE);
static BAM: [[u8; 3]; 256] = decoded(bam::TABLE);
static BERLIN: [[u8; 3]; 256] = decoded(berlin::TABLE);
static VANIMO: [[u8; 3]; 256] = decoded(vanimo::TABLE);
static ROMA_O: [[u8; 3]; 256] = decoded(roma_o::TABLE);
static BAM_O: [[u8; 3]; 256] = decoded(bam_o::TABLE);
static CORK_O: [[u8; 3]; 256] = decoded(cork_o::TABLE);

const fn decoded(table: &str) -> [[u8; 3]; 256] {
    let bytes = table.as_bytes();
    assert!(bytes.len() == 6 * 256, "a colour table has 256 entries of six digits");
    let mut entries = [[0; 3]; 256];
    let mut i = 0;
    while i < 3 * 256 {
        entries[i / 3][i % 3] = 16 * digit(bytes[2 * i]) + digit(bytes[2 * i + 1]);
        i += 1;
    }
    entries
}

const fn digit(c: u8) -> u8 {
    match c {
        b'0'..=b'9' => c - b'0',
        b'a'..=b'f' => c - b'a' + 10,
        _ => panic!("a colour table holds lower-case hexadecimal digits"),
    }
}

/// Colours for series, distinguishable with every common colour vision (Okabe and Ito 2008, their yellow left out
/// because it vanishes on white).
pub const SERIES_PALETTE: [Rgba; 7] = [
    Rgba::hex(0x0072b2),
    Rgba::hex(0xd55e00),
    Rgba::hex(0x009e73),
    Rgba::hex(0xcc79a7),
    Rgba::hex(0x000000),
    Rgba::hex(0xe69f00),
    Rgba::hex(0x56b4e9),
];
