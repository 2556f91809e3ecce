//! Runs the built program in folders of its own and looks at everything it leaves.

use serde_json::Value;
use std::ops::Deref;
use std::process::{Command, Stdio};
use tigereye_io::{ImageData, vti};
use tigereye_test_support::Folder;
pub(crate) use tigereye_test_support::Run;

/// A folder for the program to work in, emptied at the end.
pub(crate) struct Place(Folder);

impl Deref for Place {
    type Target = Folder;

    fn deref(&self) -> &Folder {
        &self.0
    }
}

impl Place {
    pub(crate) fn new() -> Self {
        Self(Folder::new())
    }

    pub(crate) fn image(&self, name: &str) -> ImageData {
        vti::read(&self.read(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
    }

    /// The program, ready to start in this folder.
    pub(crate) fn command(&self, args: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_tigereye"));
        command.args(args).current_dir(self.root());
        command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
        command
    }

    #[track_caller]
    pub(crate) fn tigereye(&self, args: &[&str]) -> Run {
        Run::of(self.command(args).output().unwrap())
    }

    /// Runs a command that must end with 0 and say nothing on standard error but the share of thin cells.
    #[track_caller]
    pub(crate) fn succeeds(&self, args: &[&str]) -> Run {
        let run = self.tigereye(args);
        assert_eq!((run.code, beside_thin_cells(&run.stderr).as_str()), (0, ""), "{args:?}");
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
}

/// What is said beside the share of totally anisotropic cells, which many fields have and `first_light` is about.
pub(crate) fn beside_thin_cells(stderr: &str) -> String {
    stderr.split_inclusive('\n').filter(|line| !line.contains(" totally anisotropic (")).collect()
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

/// A NIfTI file of double precision: lengths of the axes after their number, steps along the first three in a world
/// right-anterior-superior, the code of the intent, and the numbers, x fastest.
pub(crate) fn nifti_file(shape: [i16; 8], steps: [f32; 3], intent: i16, values: &[f64]) -> Vec<u8> {
    let mut bytes = vec![0_u8; 352];
    let mut put = |at: usize, field: &[u8]| bytes[at..at + field.len()].copy_from_slice(field);
    put(0, &348_i32.to_le_bytes());
    shape.iter().enumerate().for_each(|(i, n)| put(40 + 2 * i, &n.to_le_bytes()));
    put(68, &intent.to_le_bytes());
    put(70, &64_i16.to_le_bytes());
    put(72, &64_i16.to_le_bytes());
    put(108, &352_f32.to_le_bytes());
    put(254, &1_i16.to_le_bytes());
    steps.iter().enumerate().for_each(|(axis, step)| put(280 + 20 * axis, &step.to_le_bytes()));
    put(344, b"n+1\0");
    bytes.extend(values.iter().flat_map(|v| v.to_le_bytes()));
    bytes
}
