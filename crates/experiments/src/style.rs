//! Style files.

use crate::fault::{Faults, SpecError};
use crate::form::{Placed, StyleFile, StyleSource};
use crate::parse::parse;
use tigereye_render::Style;

/// The style that a file holds; `file` is its name in faults.
///
/// # Errors
/// The first fault, with line and column.
pub fn style_of_file(file: &str, text: &str) -> Result<Style, SpecError> {
    let read: StyleFile = parse(file, text, |file: &StyleFile| &file.format)?;
    let source: &Placed<StyleSource> = &read.style;
    source.style().map_err(|problem| Faults::new(file, text).fault(source.place(), &problem))
}

#[cfg(test)]
mod tests {
    use super::*;
    use tigereye_render::{ColourMap, Length, ValueRange};

    #[test]
    fn style_files_are_read_strictly() {
        let text =
            "(format: 1, style: (colour_map: RomaO, range: Percentiles(2, 98), width_mm: 85, unit: \"mm\"))";
        let style = style_of_file("paper.ron", text).expect("a style");
        assert_eq!(style.map, Some(ColourMap::RomaO));
        assert_eq!(style.range, Some(ValueRange::Percentiles(2.0, 98.0)));
        assert_eq!((style.width, style.unit.as_deref()), (Some(Length::Millimetres(85.0)), Some("mm")));
        let cases = [
            ("(format: 2, style: ())", "1:2: format 2 is unknown"),
            ("(format: 1, style: (\n colour: Vik))", "2:2: there is no key `colour`"),
            ("(format: 1, style: (colour_map: Jet))", "there is no `Jet` here: expected one of `Bam`"),
            ("(format: 1, style: (range: Values(2, 1)))", "1:20: the range from 2 to 1 is empty"),
            ("(format: 1, style: (range: Percentiles(2, 200)))", "both from 0 to 100"),
            (
                "(format: 1, style: (width_mm: 1e9))",
                "width_mm 1000000000 is out of range: expected 20 to 2000",
            ),
            ("(format: 1, style: (dpi: -1))", "expected a finite number above 0"),
        ];
        for (text, expected) in cases {
            let fault = style_of_file("s.ron", text).expect_err(text).to_string();
            assert!(fault.starts_with("s.ron:") && fault.contains(expected), "{text}: {fault}");
        }
    }
}
