//! Bad input of every kind ends with 2, one message that tells where and what was expected, and no file.

use crate::support::{Place, npy_file, unit_text};

/// A place with a field to read and a result that must survive.
fn place() -> Place {
    let place = Place::new();
    place.write("good.txt", unit_text(4, 4));
    place.write("kept.vti", "an earlier result");
    place
}

/// Refused as the input of every command that takes one.
#[track_caller]
fn refuses_input(place: &Place, input: &str, words: &[&str]) {
    place.refuses(&["ltg", input, "-o", "kept.vti"], words);
    place.refuses(&["ltg", input, "-o", "new.vti"], words);
    place.refuses(&["propagate", input, "--light", "1,1", "-o", "new.npy", "new.png"], words);
    place.refuses(&["info", input, "--json"], words);
    place.refuses(&["compare", input, "inverse"], words);
}

/// Refused whatever the output, existing or not.
#[track_caller]
fn refuses_option(options: &[&str], words: &[&str]) {
    let place = place();
    for output in ["kept.vti", "new.vti"] {
        place.refuses(&[&["ltg", "good.txt", "-o", output], options].concat(), words);
    }
}

#[track_caller]
fn refuses_light(light: &str, words: &[&str]) {
    let place = place();
    for output in ["kept.vti", "new.vti"] {
        place.refuses(&["propagate", "good.txt", "--light", light, "-o", output], words);
    }
}

#[test]
fn text_names_line_and_column() {
    for (text, words) in [
        ("1 0 1 0\n0 1 0\n", &["line 2", "4 numbers", "found 3"][..]),
        ("1 0 1 0\n0 1 0 one\n", &["line 2, column 7", "`one`", "a number"]),
        ("1 0\n0 nan\n", &["line 2, column 3", "`nan`", "finite"]),
        ("1 0\n0 inf\n", &["line 2, column 3", "`inf`", "finite"]),
        ("1 0\n0 1e999\n", &["line 2, column 3", "finite"]),
        ("1 0 1\n0 1 0\n", &["line 1", "even number of columns"]),
        ("1 0\n0 1\n1 0\n", &["line 3", "even number of rows"]),
        ("1 0\n\n0 1\n", &["line 2", "blank"]),
        ("", &["line 1", "empty"]),
        ("\n\n", &["line 1", "empty"]),
        ("\u{fc} 0\n0 1\n", &["line 1, column 1", "number"]),
    ] {
        let place = place();
        place.write("bad.txt", text);
        refuses_input(&place, "bad.txt", &[&["bad.txt"], words].concat());
    }
}

#[test]
fn text_of_arbitrary_bytes_is_refused() {
    let place = place();
    place.write("bad.txt", [0xff, 0xfe, 0, 0x31, 0x80, b'\n', 0xc3]);
    refuses_input(&place, "bad.txt", &["bad.txt", "line 1"]);
}

#[test]
fn arrays_name_the_byte() {
    let good = "{'descr': '<f8', 'fortran_order': False, 'shape': (2, 2, 2, 2), }";
    let mut nan = npy_file(good, 0);
    nan.extend([f64::NAN; 16].iter().flat_map(|x| x.to_le_bytes()));
    for (bytes, words) in [
        (npy_file(good, 100), &["expected"][..]),
        (npy_file(good, 0), &["expected"]),
        (npy_file(good, 128)[..9].to_vec(), &["byte", "header"]),
        (b"\x93NUMPY\x01\x00\xff\xff{}".to_vec(), &["byte"]),
        (npy_file("{'descr': '<f8', 'fortran_order': False, 'shape': (3, 3), }", 72), &["shape", "expected"]),
        (
            npy_file("{'descr': '<f8', 'fortran_order': False, 'shape': (99999999, 99999999, 2, 2), }", 64),
            &["expected"],
        ),
        (
            npy_file("{'descr': '|O', 'fortran_order': False, 'shape': (1, 1, 2, 2), }", 64),
            &["`|O`", "expected f4"],
        ),
        (npy_file("{'descr': '<f8', 'shape': (1, 1, 2, 2)", 64), &["byte", "expected"]),
        (nan, &["cell (0, 0)", "not finite"]),
        (b"no array at all".to_vec(), &["byte 0"]),
        (Vec::new(), &["byte 0"]),
    ] {
        let place = place();
        place.write("bad.npy", &bytes);
        for args in [&["ltg", "bad.npy", "-o", "kept.vti"][..], &["info", "bad.npy"]] {
            place.refuses(args, &[&["bad.npy"], words].concat());
        }
    }
}

/// An image that declares so many points along x and holds one number.
fn boastful(points: u64) -> String {
    let extent = format!("0 {} 0 0 0 0", points - 1);
    format!(
        "<VTKFile type=\"ImageData\" byte_order=\"LittleEndian\"><ImageData WholeExtent=\"{extent}\">\
         <Piece Extent=\"{extent}\"><PointData><DataArray type=\"Float64\" Name=\"a\" NumberOfComponents=\"9\" \
         format=\"ascii\">1</DataArray></PointData></Piece></ImageData></VTKFile>"
    )
}

#[test]
fn images_name_the_byte() {
    let cut = boastful(4);
    for (text, words) in [
        ("garbage", &["byte 0"][..]),
        ("", &["byte 0"]),
        ("<VTKFile type=\"PolyData\"></VTKFile>", &["byte", "ImageData"]),
        (&cut, &["byte", "`a`", "expected 36"]),
        (&cut[..200], &["byte"]),
    ] {
        let place = place();
        place.write("bad.vti", text);
        refuses_input(&place, "bad.vti", &[&["bad.vti"], words].concat());
    }
}

#[test]
fn an_image_that_declares_a_million_million_points_is_refused_at_once() {
    let place = place();
    place.write("bad.vti", boastful(1_000_000_000_000));
    assert!(place.read("bad.vti").len() < 500);
    refuses_input(&place, "bad.vti", &["bad.vti", "byte", "1000000000000 cells", "limit"]);
    // Also within an address space of 256 MiB. The shell sets the bound for the program only.
    #[cfg(unix)]
    {
        let script = format!("ulimit -v 262144; exec {} info bad.vti", env!("CARGO_BIN_EXE_tigereye"));
        let output = std::process::Command::new("sh")
            .args(["-c", &script])
            .current_dir(place.root())
            .output()
            .unwrap();
        assert_eq!(output.status.code(), Some(2), "{}", String::from_utf8_lossy(&output.stderr));
    }
}

#[test]
fn a_result_is_described_but_is_no_tensor_field() {
    let place = place();
    place.succeeds(&["ltg", "x:size=4", "--directions", "8", "-o", "v.vti"]);
    assert!(place.succeeds(&["info", "v.vti"]).stdout.contains("LTG"));
    place.refuses(&["ltg", "v.vti", "-o", "new.vti"], &["v.vti", "LTG"]);
    place.succeeds(&["propagate", "x:size=4", "--light", "1,1", "-o", "l.vti"]);
    place.refuses(&["info", "l.vti", "--array", "nothing"], &["l.vti", "nothing", "energy"]);
}

#[test]
fn generators_name_what_they_do_not_have() {
    let place = place();
    for (spec, words) in [
        ("inverze", &["`inverze`", "did you mean `inverse`"][..]),
        ("inverse:sice=5", &["`sice`", "expected size"]),
        ("inverse:size=five", &["`size`", "`five`", "integer"]),
        ("inverse:size=0", &["`size`", "`0`", "from 1"]),
        ("inverse:size=-1", &["`size`", "`-1`"]),
        ("inverse:size=1.5", &["`size`", "`1.5`", "integer"]),
        ("inverse:size=99999999999999999999", &["`size`", "to"]),
        ("inverse:size=1000000000", &["`size`", "to"]),
        ("inverse:anisotropy=nan", &["`anisotropy`", "`nan`"]),
        ("inverse:anisotropy=inf", &["`anisotropy`", "`inf`"]),
        ("inverse:size=5,size=6", &["`size`", "twice"]),
        ("inverse:size=", &["`size=`", "NAME:key=value"]),
        ("inverse:=5", &["`=5`", "NAME:key=value"]),
        ("inverse:", &["inverse:", "NAME:key=value"]),
        ("inverse:size=5,", &["NAME:key=value"]),
        (":", &["NAME:key=value"]),
        ("", &["NAME:key=value"]),
        (" ", &["NAME:key=value"]),
        ("rings:size=-1", &["`size`", "`-1`"]),
        ("rings:total=maybe", &["`total`", "true or false"]),
        ("f\u{fc}nf", &["f\u{fc}nf"]),
        ("\u{1f98a}:\u{1f98a}=\u{1f98a}", &["\u{1f98a}"]),
    ] {
        place.refuses(&["ltg", spec, "-o", "kept.vti"], words);
        place.refuses(&["info", spec], words);
    }
}

#[test]
fn unreadable_inputs_are_named() {
    let place = place();
    std::fs::create_dir(place.path("folder.txt")).unwrap();
    refuses_input(&place, "folder.txt", &["folder.txt", "reading"]);
    refuses_input(&place, "missing.npy", &["missing.npy", "reading", "No such file"]);
    refuses_input(&place, "good.xls", &["good.xls", ".npy, .npz, .vti"]);
    refuses_input(&place, "./good", &["./good", "expected .txt"]);
    place.refuses(&["info", "."], &["expected .txt"]);
    place.refuses(&["info", ".."], &["expected .txt"]);
}

#[test]
fn a_folder_does_not_hide_the_generator_of_its_name() {
    let place = place();
    std::fs::create_dir(place.path("inverse")).unwrap();
    place.succeeds(&["info", "inverse"]);
}

#[test]
#[cfg(unix)]
fn names_that_are_no_text_are_names_too() {
    use std::os::unix::ffi::OsStrExt;
    let place = place();
    let odd = std::ffi::OsStr::from_bytes(b"\xff.vti");
    let mut command = place.command(&["ltg", "good.txt", "--directions", "8", "-o"]);
    let output = command.arg(odd).output().unwrap();
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert!(!stderr.contains("panicked"), "{stderr}");
    // Written, or refused by name.
    match output.status.code() {
        Some(0) => assert!(place.root().join(odd).exists()),
        code => assert!(code == Some(2) && stderr.contains("--output"), "{code:?}: {stderr}"),
    }
}

#[test]
#[cfg(unix)]
fn a_file_without_permission_is_named() {
    use std::os::unix::fs::PermissionsExt;
    let place = place();
    place.write("secret.txt", "1 0\n0 1\n");
    std::fs::set_permissions(place.path("secret.txt"), std::fs::Permissions::from_mode(0o000)).unwrap();
    if std::fs::read(place.path("secret.txt")).is_ok() {
        println!("skipped: this user reads everything");
        return;
    }
    place.refuses(&["info", "secret.txt"], &["secret.txt", "reading", "denied"]);
}

#[test]
#[cfg(target_os = "linux")]
fn a_file_that_fails_while_it_is_read_is_named() {
    let place = place();
    // Page 0 of every process is unmapped: opening works, reading does not, whoever asks.
    std::os::unix::fs::symlink("/proc/self/mem", place.path("bad.txt")).unwrap();
    place.refuses(&["ltg", "bad.txt", "-o", "kept.vti"], &["bad.txt", "reading"]);
}

#[test]
fn options_out_of_range_name_the_option() {
    refuses_option(&["--directions", "12"], &["--directions", "12", "multiple of 8"]);
    refuses_option(&["--directions", "0"], &["--directions", "multiple of 8"]);
    refuses_option(&["--directions", "99999999999"], &["--directions", "multiple of 8"]);
    refuses_option(&["--directions", "many"], &["--directions", "multiple of 8"]);
    refuses_option(&["--threshold=-1"], &["--threshold", "finite number from 0"]);
    refuses_option(&["--threshold", "nan"], &["--threshold", "finite number from 0"]);
    refuses_option(&["--threshold", "inf"], &["--threshold", "finite number from 0"]);
    refuses_option(&["--max-iterations=-5"], &["--max-iterations"]);
    refuses_option(&["--normalization", "local-above:2"], &["--normalization", "0 to 1"]);
    refuses_option(&["--normalization", "local-above:nan"], &["--normalization", "0 to 1"]);
    refuses_option(&["--normalization", "some"], &["--normalization", "global, local"]);
    refuses_option(&["--omega-step", "x"], &["--omega-step"]);
    refuses_option(&["--threads", "0"], &["--threads", "1 to"]);
    refuses_option(&["--memory", "0"], &["--memory", "bytes"]);
    refuses_option(&["--memory", "much"], &["--memory", "bytes"]);
    refuses_option(&["--slices", "1,x"], &["--slices"]);
    refuses_option(&["--precision", "f16"], &["--precision"]);
    refuses_option(&["--nonsense"], &["--nonsense"]);
}

#[test]
fn options_out_of_range_of_this_sweep_name_the_option() {
    refuses_option(&["--omega-step", "0"], &["--omega-step", "1 to 16"]);
    refuses_option(&["--slices", "32"], &["--slices", "0 to 31"]);
    refuses_option(&["--memory", "1K"], &["--memory", "needs at least", "1024"]);
}

#[test]
fn options_out_of_range_of_this_sweep_are_refused() {
    refuses_option(&["--omega-step", "0"], &["angular step", "0", "1 to 16"]);
    refuses_option(&["--omega-step", "17"], &["angular step", "17", "1 to 16"]);
    refuses_option(&["--slices", "32"], &["slice 32", "0 to 31"]);
    refuses_option(&["--slices", "0,99999999999"], &["slice 99999999999", "0 to 31"]);
    refuses_option(&["--memory", "1K"], &["needs at least", "1024"]);
}

#[test]
fn no_slice_at_all_is_refused() {
    refuses_option(&["--slices", ""], &["--slices"]);
}

#[test]
#[cfg(unix)]
fn a_field_that_does_not_fit_is_refused_before_it_is_prepared() {
    // The field takes 128 MiB, its transmission 1 GiB: with an address space of 1 GiB only the first can be made.
    let place = place();
    let script = format!(
        "ulimit -v 1048576; exec {} ltg isotropic:size=2048 --threads 1 --memory 1M -o new.vti",
        env!("CARGO_BIN_EXE_tigereye")
    );
    let before = place.files();
    let output =
        std::process::Command::new("sh").args(["-c", &script]).current_dir(place.root()).output().unwrap();
    let stderr = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{stderr}");
    assert!(stderr.contains("needs at least") && stderr.contains("1048576"), "{stderr}");
    place.same_files(&before);
}

#[test]
fn lights_name_the_option_and_the_place() {
    refuses_light("0,99999999999999999999", &["--light", "row"]);
    refuses_light("1", &["--light 1", "row", "X,Y"]);
    refuses_light("", &["--light", "column", "X,Y"]);
    refuses_light(",,", &["--light ,,", "column", "X,Y"]);
    refuses_light("1.5,1", &["--light 1.5,1", "`1.5`", "column"]);
    refuses_light("1,1,", &["--light 1,1,", "line 1, column 1", "expected"]);
    refuses_light("1,1,cos(thet)", &["--light", "line 1, column 5", "did you mean `theta`"]);
    refuses_light("1,1,cos(theta", &["--light", "line 1, column 10", "expected"]);
    refuses_light("1,1,1/0", &["--light", "finite"]);
    refuses_light("1,1,\u{3b8}", &["--light", "line 1, column 1"]);
    refuses_light(&format!("1,1,{}", "1+".repeat(60_000)), &["--light", "characters", "at most"]);
    refuses_light(&format!("1,1,{}1", "(".repeat(3000)), &["--light", "nested"]);
}

#[test]
fn lights_that_cannot_shine_are_refused() {
    refuses_light("4,0", &["(4, 0)", "4 x 4"]);
    refuses_light("1,1,0", &["(1, 1)", "0 in every direction"]);
    refuses_light("1,1,-1", &["(1, 1)", "0 in every direction"]);
}

#[test]
fn lights_that_cannot_shine_name_the_option() {
    refuses_light("4,0", &["--light", "(4, 0)", "4 x 4"]);
    refuses_light("1,1,0", &["--light", "(1, 1)", "0 in every direction"]);
}

#[test]
fn negative_numbers_are_refused_by_the_option_not_as_options() {
    refuses_option(&["--threshold", "-1"], &["--threshold", "finite number from 0"]);
    refuses_option(&["--max-iterations", "-5"], &["--max-iterations", "expected"]);
    refuses_option(&["--omega-step", "-1"], &["--omega-step", "expected"]);
    refuses_light("-1,0", &["--light -1,0", "`-1`", "column"]);
}

#[test]
fn whole_numbers_say_what_was_expected() {
    refuses_option(&["--max-iterations", "few"], &["--max-iterations", "expected"]);
    refuses_option(&["--omega-step", "x"], &["--omega-step", "expected"]);
    refuses_option(&["--slices", "1,x"], &["--slices", "expected"]);
    let place = place();
    let steps = ["propagate", "good.txt", "--light", "1,1", "--steps", "x", "-o", "kept.vti"];
    place.refuses(&steps, &["--steps", "expected"]);
}

#[test]
fn messages_are_short_whatever_the_command_line_holds() {
    let long = "1+".repeat(60_000);
    for args in [
        &["propagate", "good.txt", "--light", &format!("1,1,{long}"), "-o", "kept.vti"][..],
        &["info", &format!("inverse:{long}")],
        &["info", &long],
    ] {
        let run = place().tigereye(args);
        assert_eq!(run.code, 2);
        assert!(run.stderr.len() < 4000, "a message of {} bytes: {}", run.stderr.len(), &run.stderr[..100]);
    }
}

#[test]
fn lights_are_one_a_cell_and_at_least_one() {
    let place = place();
    let twice = ["propagate", "good.txt", "--light", "1,1", "--light", "1,1,cos(theta)", "-o", "kept.vti"];
    place.refuses(&twice, &["(1, 1)", "one light per cell"]);
    place.refuses(&["propagate", "good.txt", "-o", "kept.vti"], &["--light"]);
}

#[test]
fn outputs_are_refused_before_anything_is_computed() {
    let place = place();
    std::fs::create_dir(place.path("folder.vti")).unwrap();
    place.write("file", "");
    for (output, words) in [
        ("a.xyz", &["a.xyz", "expected .vti"][..]),
        ("a", &["a: ", "expected .vti"]),
        ("", &["output"]),
        (".vti", &[".vti", "expected"]),
        ("nowhere/a.vti", &["nowhere/a.vti", "there is no folder nowhere"]),
        ("file/a.vti", &["file/a.vti", "there is no folder file"]),
        ("folder.vti", &["folder.vti", "is a folder"]),
        ("/proc/a.vti", &["/proc/a.vti", "writing"]),
        ("/dev/full", &["/dev/full", "expected .vti"]),
    ] {
        // This sweep would take hours.
        place.refuses(&["ltg", "inverse:size=301", "-o", output], words);
        place.refuses(&["propagate", "inverse:size=301", "--light", "1,1", "-o", output], words);
    }
}

#[test]
fn one_bad_output_of_several_leaves_none() {
    let place = place();
    for bad in ["b.xyz", "nowhere/b.npy"] {
        place.refuses(&["propagate", "good.txt", "--light", "1,1", "-o", "a.vti", "kept.vti", bad], &[bad]);
    }
}

#[test]
fn an_output_named_twice_is_refused() {
    let place = place();
    place
        .refuses(&["propagate", "good.txt", "--light", "1,1", "-o", "a.npy", "./a.npy"], &["a.npy", "twice"]);
}

#[test]
fn usage_errors_name_what_is_missing() {
    let place = place();
    place.refuses(&["ltg", "inverse"], &["--output"]);
    place.refuses(&["ltg", "-o", "a.vti"], &["<INPUT>"]);
    place.refuses(&["nothing"], &["nothing"]);
    place.refuses(&["field", "nothing"], &["nothing"]);
    place.refuses(&["check"], &["<FILE.ron>"]);
    place.refuses(&["run"], &["<FILE.ron>"]);
    place.refuses(&["compare", "inverse"], &["<B>"]);
    place.refuses(&["compare", "inverse", "gyre", "--tolerance=-1"], &["--tolerance"]);
    place.refuses(&["compare", "inverse", "gyre", "--tolerance", "nan"], &["--tolerance"]);
}

#[test]
fn usage_without_a_command_ends_with_2() {
    let run = place().tigereye(&[]);
    assert_eq!((run.code, run.stdout.as_str()), (2, ""));
    assert!(run.stderr.contains("Usage"), "{}", run.stderr);
}

#[test]
fn unlike_results_are_not_compared() {
    let place = place();
    place.succeeds(&["ltg", "x:size=4", "--directions", "8", "-o", "a.vti"]);
    place.succeeds(&["ltg", "x:size=4", "--directions", "8", "--slices", "1", "-o", "b.vti"]);
    place.succeeds(&["ltg", "x:size=4", "--directions", "8", "--slices", "2", "-o", "c.vti"]);
    place.refuses(&["compare", "a.vti", "b.vti"], &["[8, 4, 4]", "[1, 4, 4]", "same shape"]);
    place.refuses(&["compare", "b.vti", "c.vti"], &["b.vti", "[1]", "c.vti", "[2]"]);
    place.refuses(&["compare", "x:size=4", "x:size=5"], &["same shape"]);
    place.refuses(&["compare", "a.vti", "good.txt"], &["same shape"]);
    place.refuses(&["compare", "a.vti", "kept.vti"], &["kept.vti", "byte 0"]);
}

#[test]
fn slices_that_a_comparison_leaves_out_must_exist() {
    let place = place();
    place.succeeds(&["ltg", "x:size=4", "--directions", "8", "-o", "a.vti"]);
    place.refuses(&["compare", "a.vti", "a.vti", "--except-slices", "8"], &["--except-slices", "8"]);
}
