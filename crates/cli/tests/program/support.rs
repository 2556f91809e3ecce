//! Runs the built program in folders of its own and looks at everything it leaves.

use serde_json::Value;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};
use tempfile::TempDir;
use tigereye_io::{ImageData, vti};

/// No command of these tests takes longer.
const DEADLINE: Duration = Duration::from_secs(60);

/// What a run of the program left.
#[derive(Debug)]
pub(crate) struct Run {
    /// Exit code; -1 for a program killed by a signal.
    pub(crate) code: i32,
    pub(crate) stdout: String,
    pub(crate) stderr: String,
}

impl Run {
    pub(crate) fn of(output: Output) -> Self {
        Self {
            code: output.status.code().unwrap_or(-1),
            stdout: String::from_utf8(output.stdout).unwrap(),
            stderr: String::from_utf8(output.stderr).unwrap(),
        }
    }

    /// Standard output, which must be one JSON value and nothing else.
    #[track_caller]
    pub(crate) fn json(&self) -> Value {
        serde_json::from_str(&self.stdout)
            .unwrap_or_else(|e| panic!("standard output is no JSON: {e}\n{}", self.stdout))
    }
}

/// A folder to work in, emptied at the end.
pub(crate) struct Place(TempDir);

impl Place {
    pub(crate) fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub(crate) fn folder(&self) -> &Path {
        self.0.path()
    }

    pub(crate) fn write(&self, name: &str, bytes: impl AsRef<[u8]>) {
        let path = self.path(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, bytes).unwrap();
    }

    pub(crate) fn read(&self, name: &str) -> Vec<u8> {
        std::fs::read(self.path(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
    }

    pub(crate) fn json(&self, name: &str) -> Value {
        serde_json::from_slice(&self.read(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
    }

    pub(crate) fn image(&self, name: &str) -> ImageData {
        vti::read(&self.read(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
    }

    /// The program, ready to start in this folder.
    pub(crate) fn command(&self, args: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_tigereye"));
        command.args(args).current_dir(self.folder());
        command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
        command
    }

    #[track_caller]
    pub(crate) fn tigereye(&self, args: &[&str]) -> Run {
        let start = Instant::now();
        let run = Run::of(self.command(args).output().unwrap());
        assert!(start.elapsed() < DEADLINE, "{args:?} took {:?}", start.elapsed());
        run
    }

    /// Runs a command that must end with 0 and say nothing on standard error.
    #[track_caller]
    pub(crate) fn succeeds(&self, args: &[&str]) -> Run {
        let run = self.tigereye(args);
        assert_eq!((run.code, run.stderr.as_str()), (0, ""), "{args:?}");
        run
    }

    /// Runs a command that must succeed and say some words on standard error.
    #[track_caller]
    pub(crate) fn says(&self, args: &[&str], words: &str) -> Run {
        let run = self.tigereye(args);
        assert!(
            run.code == 0 && run.stderr.contains(words),
            "{args:?} says\n{}\nbut not {words:?}",
            run.stderr
        );
        run
    }

    /// Runs a command that must be refused: exit code 2, one message on standard error that holds all of `words`,
    /// nothing on standard output, and every file as it was.
    #[track_caller]
    pub(crate) fn refuses(&self, args: &[&str], words: &[&str]) {
        let before = self.files();
        let run = self.tigereye(args);
        assert_eq!(run.code, 2, "exit code of {args:?}; standard error:\n{}", run.stderr);
        assert_eq!(run.stdout, "", "standard output of {args:?}");
        let messages =
            run.stderr.lines().filter(|l| l.starts_with("tigereye: ") || l.starts_with("error: ")).count();
        assert_eq!(messages, 1, "messages of {args:?}:\n{}", run.stderr);
        let missing: Vec<_> = words.iter().filter(|w| !run.stderr.contains(*w)).collect();
        assert!(missing.is_empty(), "{args:?} says\n{}but not {missing:?}", run.stderr);
        self.same_files(&before);
    }

    /// Every file below the folder, hidden and temporary ones too, by name.
    pub(crate) fn files(&self) -> BTreeMap<PathBuf, Vec<u8>> {
        let mut found = BTreeMap::new();
        let mut folders = vec![self.folder().to_path_buf()];
        while let Some(folder) = folders.pop() {
            for entry in std::fs::read_dir(folder).unwrap() {
                let path = entry.unwrap().path();
                let kind = path.symlink_metadata().unwrap().file_type();
                if kind.is_dir() {
                    folders.push(path);
                } else {
                    let bytes =
                        if kind.is_file() { std::fs::read(&path).unwrap_or_default() } else { Vec::new() };
                    found.insert(path, bytes);
                }
            }
        }
        found
    }

    #[track_caller]
    pub(crate) fn same_files(&self, before: &BTreeMap<PathBuf, Vec<u8>>) {
        let after = self.files();
        let names = |files: &BTreeMap<PathBuf, Vec<u8>>| files.keys().cloned().collect::<Vec<_>>();
        assert_eq!(names(&after), names(before), "files left behind or lost");
        let changed: Vec<_> = after.iter().filter(|(k, v)| before[*k] != **v).map(|(k, _)| k).collect();
        assert!(changed.is_empty(), "changed: {changed:?}");
    }
}

/// Keys of a JSON object that must be there.
#[track_caller]
pub(crate) fn has_keys(value: &Value, keys: &[&str]) {
    let missing: Vec<_> = keys.iter().filter(|k| value.get(k).is_none()).collect();
    assert!(missing.is_empty(), "no {missing:?} in {value:#}");
}

/// The header of a `.npy` file.
pub(crate) fn npy_header(bytes: &[u8]) -> String {
    assert_eq!(&bytes[..6], b"\x93NUMPY");
    let end = bytes.iter().position(|&b| b == b'\n').unwrap();
    String::from_utf8_lossy(&bytes[10..end]).into_owned()
}

/// A `.npy` file of version 1 with this header and as many bytes of data.
pub(crate) fn npy_file(dictionary: &str, data: usize) -> Vec<u8> {
    let size = u16::try_from(dictionary.len() + 1).unwrap().to_le_bytes();
    [b"\x93NUMPY\x01\x00", &size[..], dictionary.as_bytes(), b"\n", &vec![0; data]].concat()
}

/// 2x2 blocks of text: `width` x `height` unit tensors.
pub(crate) fn unit_text(width: usize, height: usize) -> String {
    (0..height).map(|_| format!("{}\n{}\n", "1 0 ".repeat(width), "0 1 ".repeat(width))).collect()
}
