//! Laws of colour maps, of the embedded font and of number labels.

use tigereye_core::Choice;
use tigereye_render::{ColourMap, Rgba, has_glyph, number, text_width};

/// CIELAB L*, a*, b* (D65) of an sRGB colour.
fn lab(c: Rgba) -> [f64; 3] {
    let linear = |v: u8| {
        let v = f64::from(v) / 255.0;
        if v <= 0.04045 { v / 12.92 } else { tigereye_core::math::pow((v + 0.055) / 1.055, 2.4) }
    };
    let (r, g, b) = (linear(c.r), linear(c.g), linear(c.b));
    let f = |t: f64| if t > 0.008_856 { t.cbrt() } else { 7.787 * t + 16.0 / 116.0 };
    let x = f((0.4124 * r + 0.3576 * g + 0.1805 * b) / 0.9505);
    let y = f(0.2126 * r + 0.7152 * g + 0.0722 * b);
    let z = f((0.0193 * r + 0.1192 * g + 0.9505 * b) / 1.089);
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

fn distance(a: Rgba, b: Rgba) -> f64 {
    let (a, b) = (lab(a), lab(b));
    (0..3).map(|i| (a[i] - b[i]) * (a[i] - b[i])).sum::<f64>().sqrt()
}

const SEQUENTIAL: [ColourMap; 7] = [
    ColourMap::Viridis,
    ColourMap::Magma,
    ColourMap::Inferno,
    ColourMap::Plasma,
    ColourMap::Batlow,
    ColourMap::Lajolla,
    ColourMap::Imola,
];

#[test]
fn sequential_maps_grow_lighter() {
    for map in SEQUENTIAL {
        let lightness: Vec<f64> = (0..256).map(|i| lab(map.sample(f64::from(i) / 255.0))[0]).collect();
        // Rounding to eight bits moves lightness by up to 0.3.
        assert!(lightness.windows(2).all(|w| w[1] > w[0] - 0.3), "{}", map.word());
        assert!(lightness[255] - lightness[0] > 60.0, "{}", map.word());
    }
}

#[test]
fn diverging_map_is_lightest_in_the_middle_and_balanced() {
    let lightness = |t: f64| lab(ColourMap::Vik.sample(t))[0];
    let lightest =
        (0..256).map(|i| f64::from(i) / 255.0).max_by(|a, b| lightness(*a).total_cmp(&lightness(*b)));
    assert!((lightest.unwrap() - 0.5).abs() < 0.02);
    assert!((lightness(0.0) - lightness(1.0)).abs() < 12.0);
}

#[test]
fn cyclic_maps_close() {
    for &map in ColourMap::ALL.iter().filter(|map| map.is_cyclic()) {
        let step = |i: u32| distance(map.sample(f64::from(i) / 255.0), map.sample(f64::from(i + 1) / 255.0));
        let largest = (0..255).map(step).fold(0.0, f64::max);
        let closing = distance(map.sample(0.0), map.sample(1.0));
        assert!(closing <= largest, "{}: {closing} against {largest}", map.word());
    }
}

#[test]
fn sampling_stays_in_the_table() {
    for map in ColourMap::ALL {
        let ends = [map.sample(0.0), map.sample(1.0)];
        assert_eq!([map.sample(-3.0), map.sample(f64::INFINITY)], ends);
        assert_eq!(map.sample(f64::NAN), ends[0]);
    }
}

#[test]
fn cells_without_a_value_cannot_be_taken_for_one() {
    for map in SEQUENTIAL {
        for i in 0..256 {
            let colour = map.sample(f64::from(i) / 255.0);
            assert!(distance(colour, Rgba::NO_LIGHT) > 15.0, "{} {i}", map.word());
            assert!(distance(colour, Rgba::NOT_FINITE) > 15.0, "{} {i}", map.word());
            assert!(distance(colour, Rgba::MASKED) > 15.0, "{} {i}", map.word());
        }
    }
}

#[test]
fn font_has_the_characters_of_labels() {
    let needed = "AZaz09 äöüÄÖÜß éèñ αβγδθλμπστφχψω ΓΔΘΛΞΠΣΦΨΩ ⁰¹²³⁴⁵⁶⁷⁸⁹⁺⁻ ₀₁₂₃₄₅₆₇₈₉ ←↑→↓ −×÷·±≤≥≈≠∞√∇∫∂∑∝° …–—‘’“”„";
    let missing: String = needed.chars().filter(|c| !has_glyph(*c)).collect();
    assert_eq!(missing, "");
    assert!(!has_glyph('漢'));
}

#[test]
fn text_grows_with_size_and_length() {
    assert_eq!(text_width("", 12.0), 0.0);
    assert_eq!(text_width("light", 24.0), 2.0 * text_width("light", 12.0));
    assert!(text_width("light light", 12.0) > text_width("light", 12.0));
    assert_eq!(text_width("0", 10.0), text_width("8", 10.0), "digits are equally wide");
}

#[test]
fn numbers_read_as_people_write_them() {
    let cases = [
        (0.0, 1.0, "0"),
        (-0.25, 0.25, "−0.25"),
        (0.30000000000000004, 0.1, "0.3"),
        (14000.0, 2000.0, "14000"),
        (5e-4, 2.5e-4, "5·10⁻⁴"),
        (2.5e-4, 2.5e-4, "2.5·10⁻⁴"),
        (1e-11, 1e-11, "10⁻¹¹"),
        (-1e9, 1e9, "−10⁹"),
        (-1e-17, 0.1, "−10⁻¹⁷"),
        (f64::INFINITY, 1.0, "∞"),
        (f64::NAN, 1.0, "not a number"),
    ];
    for (value, step, expected) in cases {
        assert_eq!(number::label(value, step), expected);
    }
    assert_eq!(number::significant(1.0 / 3.0, 3), "0.333");
    assert_eq!(number::significant(123_456_789.0, 2), "1.2·10⁸");
    assert_eq!(number::power_label(-30), "10⁻³⁰");
}
