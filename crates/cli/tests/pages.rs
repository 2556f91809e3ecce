//! The commands of the README and of the documentation work as they stand, and the reference of commands is the
//! program's own help.
#![allow(clippy::unwrap_used, reason = "a failed helper is a failed test")]

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;

/// What a reader of a page would do: write files and run commands.
#[derive(Debug, Default, PartialEq)]
struct Instructions {
    /// Name and text of each file.
    files: Vec<(String, String)>,
    /// Words of each command line, the program's name left out, and the exit code it must have.
    commands: Vec<(Vec<String>, i32)>,
}

impl Instructions {
    /// Commands are the lines of ```sh blocks that start with `tigereye `; files the ```ron and ```text blocks whose
    /// last line of text before names a `NAME.ron` or `NAME.txt`.
    fn of(markdown: &str) -> Self {
        let mut found = Self::default();
        let (mut text_before, mut lines) = ("", markdown.lines());
        while let Some(line) = lines.next() {
            let Some(language) = line.trim().strip_prefix("```") else {
                if !line.trim().is_empty() {
                    text_before = line;
                }
                continue;
            };
            let indent = line.len() - line.trim_start().len();
            let block: Vec<&str> = lines
                .by_ref()
                .take_while(|l| l.trim() != "```")
                .map(|l| l.get(indent..).unwrap_or_default())
                .collect();
            match language.trim() {
                "sh" => found.commands.extend(joined(&block).iter().filter_map(|l| command(l))),
                language @ ("ron" | "text") => {
                    if let Some(name) = file_name(text_before, language) {
                        found.files.push((name, block.join("\n") + "\n"));
                    }
                }
                _ => {}
            }
        }
        found
    }
}

/// Lines that end in a backslash with their successors.
fn joined(block: &[&str]) -> Vec<String> {
    let mut lines = vec![String::new()];
    for line in block {
        let last = lines.last_mut().unwrap();
        match line.strip_suffix('\\') {
            Some(more) => last.push_str(more),
            None => {
                last.push_str(line);
                lines.push(String::new());
            }
        }
    }
    lines
}

/// A line that ends in `# ends with 1` is to find a difference.
fn command(line: &str) -> Option<(Vec<String>, i32)> {
    let line = line.trim();
    let code = i32::from(line.ends_with("# ends with 1"));
    let rest = line.strip_prefix("$ ").unwrap_or(line).strip_prefix("tigereye ")?;
    let words = words(rest);
    // The whole reproduction has a test of its own.
    let words = if words == ["reproduce"] {
        ["reproduce", "--only", "fig-3-1-emitters"].map(String::from).to_vec()
    } else {
        words
    };
    Some((words, code))
}

/// `NAME.ron` in backticks, or `NAME.txt` before a text.
fn file_name(line: &str, language: &str) -> Option<String> {
    let extension = if language == "ron" { ".ron" } else { ".txt" };
    let name = line.split('`').skip(1).step_by(2).find(|code| code.ends_with(extension))?;
    Some(name.to_owned())
}

/// Words as a POSIX shell splits them: blanks, single and double quotes, backslash, comment.
fn words(line: &str) -> Vec<String> {
    let (mut words, mut word, mut quote) = (Vec::new(), None::<String>, None::<char>);
    let mut characters = line.chars();
    while let Some(c) = characters.next() {
        match (quote, c) {
            (Some(q), c) if c == q => quote = None,
            (Some(_), c) => word.get_or_insert_default().push(c),
            (None, '\'' | '"') => {
                quote = Some(c);
                word.get_or_insert_default();
            }
            (None, '\\') => word.get_or_insert_default().extend(characters.next()),
            (None, '#') if word.is_none() => break,
            (None, c) if c.is_whitespace() => words.extend(word.take()),
            (None, c) => word.get_or_insert_default().push(c),
        }
    }
    assert!(quote.is_none(), "a quote is not closed: {line}");
    words.extend(word);
    words
}

/// Follows the instructions in a folder; the first failure as text.
fn follow(instructions: &Instructions, folder: &Path) -> Result<(), String> {
    for (name, text) in &instructions.files {
        let path = folder.join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    }
    for (words, code) in &instructions.commands {
        let output =
            Command::new(env!("CARGO_BIN_EXE_tigereye")).args(words).current_dir(folder).output().unwrap();
        if output.status.code() != Some(*code) {
            return Err(format!(
                "tigereye {}\nends with {}, not {code}:\n{}",
                words.join(" "),
                output.status,
                String::from_utf8_lossy(&output.stderr)
            ));
        }
    }
    Ok(())
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// The README and all pages below `docs`, by their paths from the root.
fn pages() -> Vec<String> {
    let mut pages = vec!["README.md".to_owned()];
    for folder in ["docs", "docs/guide", "docs/reference"] {
        let entries = std::fs::read_dir(root().join(folder)).unwrap();
        let names = entries.map(|e| e.unwrap().file_name().into_string().unwrap());
        pages.extend(names.filter(|name| name.ends_with(".md")).map(|name| format!("{folder}/{name}")));
    }
    pages.sort();
    pages
}

/// Every page is followed in a folder of its own.
#[test]
fn commands_of_every_page_succeed_in_their_order() {
    let follow_page = |name: &str| {
        let instructions = Instructions::of(&std::fs::read_to_string(root().join(name)).unwrap());
        let folder = tempfile::tempdir().unwrap();
        follow(&instructions, folder.path()).map_err(|problem| format!("{name}: {problem}"))?;
        Ok(instructions.commands.len())
    };
    let followed: Vec<(String, Result<usize, String>)> = std::thread::scope(|scope| {
        let started: Vec<_> =
            pages().into_iter().map(|name| (name.clone(), scope.spawn(move || follow_page(&name)))).collect();
        started.into_iter().map(|(name, page)| (name, page.join().unwrap())).collect()
    });
    let problems: Vec<&String> = followed.iter().filter_map(|(_, result)| result.as_ref().err()).collect();
    assert!(problems.is_empty(), "{problems:#?}");
    for page in [
        "README.md",
        "docs/guide/tutorial.md",
        "docs/guide/classical-methods.md",
        "docs/guide/pictures.md",
        "docs/guide/scenes.md",
    ] {
        let commands = followed.iter().find(|(name, _)| name == page).and_then(|(_, r)| r.as_ref().ok());
        assert!(commands.is_some_and(|n| *n > 0), "{page} has no line `tigereye ...` in a ```sh block");
    }
}

/// What the program prints of itself.
fn help(words: &[&str]) -> String {
    let output = Command::new(env!("CARGO_BIN_EXE_tigereye")).args(words).arg("--help").output().unwrap();
    assert!(output.status.success(), "{words:?}");
    String::from_utf8(output.stdout).unwrap()
}

/// The names of commands in a help text, without `help`.
fn commands_in(text: &str) -> Vec<&str> {
    let list =
        text.lines().skip_while(|line| *line != "Commands:").skip(1).take_while(|line| !line.is_empty());
    // Descriptions go on in lines that are indented further.
    let names =
        list.filter(|line| !line.starts_with("    ")).filter_map(|line| line.split_whitespace().next());
    names.filter(|name| *name != "help").collect()
}

/// The page of all commands.
fn commands_page() -> String {
    let mut page = "# Commands\n\n<!-- Made from the program's help by `TIGEREYE_BLESS=1 cargo test -p tigereye-cli --test pages`. -->\n\n\
                    What `tigereye COMMAND --help` prints.\n"
        .to_owned();
    let mut add = |words: &[&str], text: &str| {
        let _ = write!(page, "\n## {}\n\n```text\n{}\n```\n", words.join(" "), text.trim_end());
    };
    for command in commands_in(&help(&[])) {
        let text = help(&[command]);
        add(&[command], &text);
        for inner in commands_in(&text) {
            add(&[command, inner], &help(&[command, inner]));
        }
    }
    page
}

#[test]
fn the_reference_of_commands_is_the_help() {
    let path = root().join("docs/reference/commands.md");
    let page = commands_page();
    if std::env::var_os("TIGEREYE_BLESS").is_some() {
        std::fs::write(&path, &page).unwrap();
    }
    let found = std::fs::read_to_string(&path).unwrap();
    assert!(found == page, "{} is stale: TIGEREYE_BLESS=1 makes it anew", path.display());
    assert!(page.contains("## field new") && page.contains("## ltg") && page.contains("--normalization"));
}

const SAMPLE: &str = "\
# Title

```sh
# a comment
cargo run --release -- reproduce
tigereye reproduce   # everything
  tigereye info 'a b' \"c d\"  it\\'s ''
tigereye field \\
    list
tigereye compare a b # ends with 1
```

tigereye not a command

Write `swirl.ron`:

```ron
(a: 1)
```

Some other text

```ron
(ignored: true)
```

```text
tigereye ignored
```

1. a list with a file `deep/b.ron`

   ```ron
   (
       b: 2,
   )
   ```

   ```sh
   tigereye check b.ron
   ```
";

#[test]
fn instructions_are_found_in_blocks_only() {
    let found = Instructions::of(SAMPLE);
    let commands: [(&[&str], i32); 5] = [
        (&["reproduce", "--only", "fig-3-1-emitters"], 0),
        (&["info", "a b", "c d", "it's", ""], 0),
        (&["field", "list"], 0),
        (&["compare", "a", "b"], 1),
        (&["check", "b.ron"], 0),
    ];
    let words = |words: &[&str]| words.iter().map(ToString::to_string).collect::<Vec<_>>();
    assert_eq!(found.commands, commands.map(|(command, code)| (words(command), code)));
    let files = [("swirl.ron", "(a: 1)\n"), ("deep/b.ron", "(\n    b: 2,\n)\n")];
    assert_eq!(found.files, files.map(|(name, text)| (name.to_owned(), text.to_owned())));
}

#[test]
fn instructions_that_fail_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let good = Instructions::of("```sh\ntigereye field list\ntigereye ltg x:size=4 -o a.vti\n```\n");
    assert_eq!(follow(&good, folder.path()), Ok(()));
    assert!(folder.path().join("a.vti").exists());
    let bad = Instructions::of("```sh\ntigereye info nothing\n```\n");
    let problem = follow(&bad, folder.path()).unwrap_err();
    assert!(problem.contains("tigereye info nothing") && problem.contains("`nothing`"), "{problem}");
    let same = Instructions::of("```sh\ntigereye compare x:size=4 x:size=4 # ends with 1\n```\n");
    assert!(follow(&same, folder.path()).unwrap_err().contains("not 1"));
}

#[test]
#[should_panic(expected = "a quote is not closed")]
fn open_quotes_are_refused() {
    words("info 'a");
}
