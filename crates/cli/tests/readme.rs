//! The commands of the README and of the tutorial work as they stand.
#![allow(clippy::unwrap_used, reason = "a failed helper is a failed test")]

use std::path::Path;
use std::process::Command;

/// What a reader of the README would do: write files and run commands.
#[derive(Debug, Default, PartialEq)]
struct Instructions {
    /// Name and text of each file.
    files: Vec<(String, String)>,
    /// Words of each command line, the program's name left out, and the exit code it must have.
    commands: Vec<(Vec<String>, i32)>,
}

impl Instructions {
    /// Commands are the lines of ```sh blocks that start with `tigereye `; files the ```ron blocks whose last line of
    /// text before names a `NAME.ron`.
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
                "ron" => {
                    if let Some(name) = ron_name(text_before) {
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

/// `NAME.ron` in backticks.
fn ron_name(line: &str) -> Option<String> {
    let name = line.split('`').skip(1).step_by(2).find(|code| code.ends_with(".ron"))?;
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

#[test]
fn readme_commands_succeed_in_their_order() {
    follow_page("README.md");
}

#[test]
fn tutorial_commands_succeed_in_their_order() {
    follow_page("docs/tutorial.md");
}

fn follow_page(name: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(name);
    let markdown = std::fs::read_to_string(&path)
        .unwrap_or_else(|e| panic!("{}: {e}: the page whose commands are tested is missing", path.display()));
    let instructions = Instructions::of(&markdown);
    assert!(!instructions.commands.is_empty(), "{name} has no line `tigereye ...` in a ```sh block");
    let folder = tempfile::tempdir().unwrap();
    follow(&instructions, folder.path()).unwrap_or_else(|problem| panic!("{name}: {problem}"));
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
