//! Relative paths of the files beside the page, and their addresses in links.

/// Path of a file of an experiment, relative to the results folder.
pub(crate) fn path(slug: &str, file: &str) -> String {
    format!("{slug}/{file}")
}

/// `path` as the address of a link: everything but plain characters in percent notation. A leading `./` keeps
/// a colon in the name from being read as a scheme.
pub(crate) fn address(path: &str) -> String {
    let mut out = String::from("./");
    for byte in path.bytes() {
        match byte {
            b'a'..=b'z' | b'A'..=b'Z' | b'0'..=b'9' | b'-' | b'_' | b'.' | b'~' | b'/' => {
                out.push(char::from(byte))
            }
            _ => out.push_str(&format!("%{byte:02X}")),
        }
    }
    out
}

/// `id` as the address of a place on the page.
pub(crate) fn place(id: &str) -> String {
    format!("#{}", &address(id)[2..])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn awkward_names_stay_one_path() {
        assert_eq!(address("drain/slice-90.png"), "./drain/slice-90.png");
        assert_eq!(address("a b/50 %#1?.png"), "./a%20b/50%20%25%231%3F.png");
        assert_eq!(place("a b"), "#a%20b");
    }
}
