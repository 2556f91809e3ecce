//! Sentences of experiment files, in which backticks set off code.

use maud::{Markup, html};

/// A sentence; what stands between backticks is code.
pub(super) fn words(text: &str) -> Markup {
    // An open backtick at the end sets nothing off.
    let pairs = text.matches('`').count() / 2 * 2;
    let parts = text.splitn(pairs + 1, '`');
    html! {
        @for (i, part) in parts.enumerate() {
            @if i % 2 == 1 { code { (part) } } @else { (part) }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn backticks_set_off_code() {
        assert_eq!(words("see `a b` and `c`.").into_string(), "see <code>a b</code> and <code>c</code>.");
        assert_eq!(words("a lone ` stays").into_string(), "a lone ` stays");
        assert_eq!(words("`a` ` b").into_string(), "<code>a</code> ` b");
        assert_eq!(words("<b>").into_string(), "&lt;b&gt;");
    }
}
