//! Tables as programs write them.

use super::*;
use crate::volume::{PlaneChoice, Reading};
use tigereye_core::Tensor2;

/// 4 x 3 points, xx = x, yy = 10 y, xy = 0.25, one a line.
fn table(header: &str, line: impl Fn(f64, f64) -> String) -> Vec<u8> {
    let at = (0..12).map(|i| (f64::from(i % 4) * 2.0 + 1.0, 3.0 - f64::from(i / 4) * 0.5));
    at.fold(header.to_owned(), |text, (x, y)| text + &line(x, y) + "\n").into_bytes()
}

#[track_caller]
fn is_read(bytes: &[u8]) {
    assert_eq!(super::super::kind(bytes), super::super::Kind::Named);
    let lattice = read(bytes, ArrayChoice::Usual, Wanted::Tensors).unwrap();
    let slice = lattice.tensors(Reading::default()).unwrap().slice(PlaneChoice::default()).unwrap();
    let top = |x: f64| Tensor2::new(x, 0.25, 0.25, 30.0);
    assert_eq!(
        slice.field.values()[..4],
        [top(1.0), top(3.0), top(5.0), top(7.0)],
        "row 0 has the largest y"
    );
    assert_eq!(slice.cut.geometry.corner(), [1.0, 2.0, 0.0]);
    assert_eq!(slice.cut.geometry.spacing(), [2.0, 0.5]);
}

#[test]
fn programs_are_understood() {
    let ten = |y: f64| 10.0 * y;
    is_read(&table("x,y,S11,S22,S12\n", |x, y| format!("{x},{y},{x},{},0.25", ten(y))));
    is_read(&table("Node,X,Y,Z,SX,SY,SZ,SXY,SYZ,SXZ\n", |x, y| {
        format!("7,{x},{y},0,{x},{},5,0.25,0.5,0.75", ten(y))
    }));
    let comsol = "% Model: plate.mph\n% x  y  solid.sx (N/m^2)  solid.sy (N/m^2)  solid.sxy (N/m^2)\n";
    is_read(&table(comsol, |x, y| format!("{x}   {y}   {x:.3e}   {:.3e}   2.5e-1", ten(y))));
    let paraview = "\"Stress:0\",\"Stress:1\",\"Stress:2\",\"Stress:3\",\"Stress:4\",\"Stress:5\",\
                    \"Points:0\",\"Points:1\",\"Points:2\"\n";
    is_read(&table(paraview, |x, y| format!("{x},{},5,0.25,0.5,0.75,{x},{y},0", ten(y))));
    is_read(&table("x [m];y [m];sigma_xx [Pa];sigma_yy [Pa];tau_xy [Pa];part\n", |x, y| {
        format!("{x};{y};{x};{};0,25;plate", ten(y))
    }));
    let tecplot =
        "TITLE=\"a\"\nVARIABLES=\"X\" \"Y\" \"du/dx\" \"du/dy\" \"dv/dx\" \"dv/dy\"\nZONE I=4, J=3\n";
    is_read(&table(tecplot, |x, y| format!("{x} {y} {x} 0.25 0.25 {}", ten(y))));
}

/// Labels, quotes, Fortran's exponents, comments, blank lines and a line of units are passed over.
#[test]
fn what_stands_between_the_numbers_is_passed_over() {
    let ten = |y: f64| 10.0 * y;
    is_read(&table("Part,Node,X,Y,S11,S22,S12\n", |x, y| format!("PLATE-1,4,{x},{y},{x},{},0.25", ten(y))));
    is_read(&table("\"x\",\"y\",\"S11\",\"S22\",\"S12\"\n", |x, y| {
        format!("\"{x}\",\"{y}\",\"{x}\",\"{}\",\"0.25\"", ten(y))
    }));
    is_read(&table("x y sxx syy sxy\n", |x, y| format!("{x} {y} {x} {}D+01 2.5D-01\n# more", y)));
    is_read(&table("x,y,S11,S22,S12\nm,m,Pa,Pa,Pa\n", |x, y| format!("{x},{y},{x},{},0.25\n", ten(y))));
}

/// Two sets of positions, units that differ and commas that may separate thousands are said.
#[test]
fn doubtful_columns_are_warned_of() {
    let warnings = |bytes: &[u8]| read(bytes, ArrayChoice::Usual, Wanted::Tensors).unwrap().warnings;
    let one = |header: &str, line: fn(f64, f64) -> String| {
        let found = warnings(&table(header, line));
        assert_eq!(found.len(), 1, "{header}: {found:?}");
        found.into_iter().next().unwrap()
    };
    let two = one("x,y,X,Y,S11,S22,S12\n", |x, y| format!("{x},{y},{y},{x},1,2,3"));
    assert!(two.contains("positions taken from the columns x, y; X, Y ignored"), "{two}");
    let units = one("x,y,S11 [Pa],S22 [Pa],S12 [kPa]\n", |x, y| format!("{x},{y},1,2,3"));
    assert!(units.contains("Pa, Pa, kPa"), "{units}");
    for line in ["mm,mm,Pa,Pa,kPa", "[mm],[mm],[Pa],[Pa],[kPa]", "\"mm\",\"mm\",(Pa),(Pa),(kPa)"] {
        let units = one(&format!("x,y,S11,S22,S12\n{line}\n"), |x, y| format!("{x},{y},1,2,3"));
        assert!(units.contains("Pa, Pa, kPa"), "{line}: {units}");
    }
    let blanks = one("x [mm] y [mm] S11 [Pa] S22 [Pa] S12 [10^3 Pa]\n", |x, y| format!("{x} {y} 1 2 3"));
    assert!(blanks.contains("Pa, Pa, 10^3 Pa"), "{blanks}");
    let blanks = one("x y S11 S22 S12\n[mm] [mm] [Pa] [Pa] [kPa]\n", |x, y| format!("{x} {y} 1 2 3"));
    assert!(blanks.contains("Pa, Pa, kPa"), "{blanks}");
    let pixels = one("x [px],y [px],exx,eyy,exy\n", |x, y| format!("{x},{y},1,2,3"));
    assert!(pixels.contains("xy has the other sign"), "{pixels}");
    let thousands = one("x\ty\tS11\tS22\tS12\n", |x, y| format!("{x}\t{y}\t1,200\t5,000\t3"));
    assert!(thousands.contains("a thousands separator"), "{thousands}");
}

/// Numbers in quotes may have commas within.
#[test]
fn quotes_hold_decimal_commas_together() {
    let bytes =
        table("x,y,S11,S22,S12\n", |x, y| format!("\"{x}\",{y},\"{x},0\",\"{},0\",\"0,25\"", 10.0 * y));
    is_read(&bytes);
    let lattice = read(&bytes, ArrayChoice::Usual, Wanted::Tensors).unwrap();
    assert!(lattice.remarks.iter().any(|r| r.contains("commas taken as decimal points")));
    is_read(&table("Part,x,y,S11,S22,S12\n", |x, y| format!("5\" plate,{x},{y},{x},{},0.25", 10.0 * y)));
}

#[test]
fn spreadsheets_may_write_utf_16() {
    let bytes = table("x\ty\tS11\tS22\tS12\n", |x, y| format!("{x}\t{y}\t{x}\t{}\t0,25", 10.0 * y));
    let text = String::from_utf8(bytes.clone()).unwrap();
    for (mark, unit) in
        [([0xff, 0xfe], u16::to_le_bytes as fn(u16) -> [u8; 2]), ([0xfe, 0xff], u16::to_be_bytes)]
    {
        let wide: Vec<u8> = mark.into_iter().chain(text.encode_utf16().flat_map(unit)).collect();
        assert_eq!(super::super::utf8(&wide), bytes);
    }
    assert_eq!(super::super::utf8(&bytes), bytes);
}

/// `T[0][1]` is a name, `strain [1]` a name with a unit.
#[test]
fn indices_in_brackets_are_no_units() {
    is_read(&table("x,y,T[0][0],T[1][0],T[0][1],T[1][1]\n", |x, y| {
        format!("{x},{y},{x},0.25,0.25,{}", 10.0 * y)
    }));
    is_read(&table("x,y,T(11),T(22),T(12)\n", |x, y| format!("{x},{y},{x},{},0.25", 10.0 * y)));
    is_read(&table("x [1],y [1],S11 [1],S22 [1],S12 [1]\n", |x, y| format!("{x},{y},{x},{},0.25", 10.0 * y)));
    let bytes = table("x,y,S[1],S[2],S[4]\n", |x, y| format!("{x},{y},1,2,3"));
    let fault = read(&bytes, ArrayChoice::Usual, Wanted::Tensors).unwrap_err().to_string();
    assert!(fault.contains("`S[1]` (1 component), `S[2]`"), "{fault}");
    let named = crate::volume::ComponentArrays::parse("XX=S[1],YY=S[2],XY=S[4]").unwrap();
    assert!(read(&bytes, ArrayChoice::Components(&named), Wanted::Tensors).is_ok());
}

/// A plane may be that of x and z.
#[test]
fn two_positions_of_three_are_enough() {
    let bytes = table("x,z,sxx,szz,sxz\n", |x, z| format!("{x},{z},{x},{},0.25", 10.0 * z));
    let lattice = read(&bytes, ArrayChoice::Usual, Wanted::Tensors).unwrap();
    assert!(lattice.remarks.iter().any(|r| r.starts_with("z taken to run upwards")), "{:?}", lattice.remarks);
    let slice = lattice.tensors(Reading::default()).unwrap().slice(PlaneChoice::default()).unwrap();
    assert_eq!(slice.field.values()[1], Tensor2::new(3.0, 0.25, 0.25, 30.0));
    assert_eq!((slice.cut.geometry.corner(), slice.cut.geometry.up()), ([1.0, 0.0, 2.0], [0.0, 0.0, 1.0]));
}

#[test]
fn two_rows_at_one_position_are_named() {
    let text = "t,x,y,S11,S22,S12\n0,0,0,1,2,3\n0,1,0,1,2,3\n1,0,0,1,2,3\n1,1,-0.0,1,2,3\n";
    let fault = read(text.as_bytes(), ArrayChoice::Usual, Wanted::Tensors).unwrap_err().to_string();
    assert!(fault.starts_with("line 4: a second row at the position of line 2"), "{fault}");
}

#[test]
fn columns_that_are_not_read_are_named() {
    let line = |x: f64, y: f64| format!("{x},{y},1,2,3,1,7");
    let bytes = table("x,y,S11,S22,S12,Status,Mises\n", line);
    let remarks = read(&bytes, ArrayChoice::Usual, Wanted::Tensors).unwrap().remarks;
    assert!(remarks.iter().any(|r| r.contains("not read") && r.contains("Status, Mises")), "{remarks:?}");
    assert!(remarks.iter().any(|r| r.contains("y taken to run upwards")), "{remarks:?}");
    let bytes = table("x,y,u,v,T\n", |x, y| format!("{x},{y},1,2,3"));
    let vectors = read(&bytes, ArrayChoice::Usual, Wanted::Vectors).unwrap().remarks;
    assert!(vectors.iter().any(|r| r.contains("y taken to run upwards")), "{vectors:?}");
}

/// The vertical axis is that of the plane.
#[test]
fn the_axis_that_is_taken_upwards_is_named() {
    for (names, points, axis) in [
        ("x,y,z", ["0,0,5", "1,0,5", "0,1,5", "1,1,5"], "y"),
        ("x,y,z", ["0,5,0", "1,5,0", "0,5,1", "1,5,1"], "z"),
        ("x,y,z", ["0,5,0", "0,5,1", "1,5,1", "1,5,0"], "z"),
        ("x,y,z", ["5,0,0", "5,1,0", "5,0,1", "5,1,1"], "z"),
    ] {
        let lines = points.map(|at| format!("{at},1,2,3")).join("\n");
        let text = format!("{names},f,g,h\n{lines}\n");
        let lattice = read(text.as_bytes(), ArrayChoice::Named("f"), Wanted::Scalars).unwrap();
        let words = format!("{axis} taken to run upwards");
        assert!(lattice.remarks.iter().any(|r| r.starts_with(&words)), "{points:?}: {:?}", lattice.remarks);
    }
}

/// As beside vectors: what a column of validity leaves out is masked, and said.
#[test]
fn columns_of_validity_are_masks() {
    let read = |bytes: &[u8]| read(bytes, ArrayChoice::Usual, Wanted::Tensors).unwrap();
    for (name, out, kept, convention) in [
        ("isValid", "False", "True", "is below 1"),
        ("valid", "no", "yes", "is below 1"),
        ("CHC", "-2", "1", "is below 1"),
        ("Vector type [-]", "0", "1", "is below 1"),
        ("mask", "1", "0", "is not 0"),
        ("vtkValidPointMask", "0", "1", "is below 1"),
        ("vtkGhostType", "2", "1", "marks hidden points"),
    ] {
        let word = |x: f64| if x < 2.0 { out } else { kept };
        // Positions in any order are masked at the same points.
        for reversed in [false, true] {
            let bytes =
                table("", |x, y| format!("{x},{y},{},2,3,{}", if x < 2.0 { f64::NAN } else { 1.0 }, word(x)));
            let mut lines: Vec<&str> = std::str::from_utf8(&bytes).unwrap().lines().collect();
            if reversed {
                lines.swap(0, 7);
                lines.swap(2, 5);
            }
            let text = format!("x,y,S11,S22,S12,{name}\n{}\n", lines.join("\n"));
            let lattice = read(text.as_bytes());
            let mask = lattice.mask.clone().unwrap();
            assert!(mask.iter().enumerate().all(|(i, m)| (*m == 0.0) == (i % 4 == 0)), "{name}: {mask:?}");
            let name = name.split(" [").next().unwrap();
            let words = format!("3 of 12 points left out by the column `{name}`, where it {convention}");
            assert!(lattice.remarks.contains(&words), "{:?}", lattice.remarks);
            assert!(!lattice.remarks.iter().any(|r| r.contains("not read")), "{:?}", lattice.remarks);
        }
    }
    let flagged = read(&table("x,y,S11,S22,S12,flags\n", |x, y| format!("{x},{y},1,2,3,{}", x - 1.0)));
    assert_eq!(flagged.mask, None);
    assert!(flagged.remarks.iter().any(|r| r.starts_with("9 points with a flag")), "{:?}", flagged.remarks);
}

/// COMSOL's columns of several times, read one time after the user's choice.
#[test]
fn one_time_of_several_is_read() {
    let header = "% x  y  solid.sx (N/m^2) @ t=0  solid.sy (N/m^2) @ t=0  solid.sxy (N/m^2) @ t=0 \
                  solid.sx (N/m^2) @ t=1  solid.sy (N/m^2) @ t=1  solid.sxy (N/m^2) @ t=1\n";
    let bytes = table(header, |x, y| format!("{x} {y} 1 2 3 4 5 6"));
    let fault = read(&bytes, ArrayChoice::Usual, Wanted::Tensors).unwrap_err().to_string();
    assert!(
        fault.starts_with("line 1: ") && fault.contains("several times or parameters (t=0; t=1)"),
        "{fault}"
    );
    let full = "XX=solid.sx @ t=1,YY=solid.sy @ t=1,XY=solid.sxy @ t=1";
    let full = crate::volume::ComponentArrays::parse(full).unwrap();
    for choice in [ArrayChoice::Named("t=1"), ArrayChoice::Named("@ t=1"), ArrayChoice::Components(&full)] {
        let lattice = read(&bytes, choice, Wanted::Tensors);
        let lattice = lattice.unwrap_or_else(|e| panic!("{choice:?}: {e}"));
        assert_eq!(lattice.values[..3], [4.0, 5.0, 6.0], "{choice:?}");
    }
    // Of the only time nobody has to say anything, whatever separates the columns.
    let at = "@ t=0, Q=2";
    for mark in ["  ", ","] {
        let names =
            ["x", "y", &format!("S11 (Pa) {at}"), &format!("S22 (Pa) {at}"), &format!("S12 (Pa) {at}")]
                .join(mark);
        let bytes =
            table(&format!("% {names}\n"), |x, y| [x, y, 1.0, 2.0, 3.0].map(|v| v.to_string()).join(mark));
        let lattice = read(&bytes, ArrayChoice::Usual, Wanted::Tensors).unwrap();
        assert_eq!(lattice.values[..3], [1.0, 2.0, 3.0]);
        assert!(lattice.notes.iter().any(|n| n.contains("columns at t=0, Q=2")), "{:?}", lattice.notes);
    }
}

/// Tecplot's variables one a line, and its zones that are no table.
#[test]
fn tecplot_zones_are_understood_or_refused() {
    let variables = "VARIABLES = \"X [m]\"\n\"Y [m]\"\n\"S11\"\n\"S22\"\n\"S12\"\n";
    let with = |zone: &str| {
        table(&format!("TITLE = \"a\"\n{variables}{zone}\n"), |x, y| format!("{x} {y} {x} {} 0.25", 10.0 * y))
    };
    is_read(&with(
        "ZONE T=\"BLOCK 1\", I=4, J=3, DATAPACKING=POINT\n DT=(SINGLE SINGLE SINGLE SINGLE SINGLE)",
    ));
    #[track_caller]
    fn refused(bytes: &[u8], words: &str) {
        let fault = read(bytes, ArrayChoice::Usual, Wanted::Tensors).unwrap_err().to_string();
        assert!(fault.contains(words), "{fault}");
        assert_eq!(super::super::kind(bytes), super::super::Kind::Named);
    }
    refused(&with("ZONE I=4, J=3\n DATAPACKING=BLOCK"), "line 8: the zone has one variable after the other");
    refused(&with("ZONE I=4, J=3, F=BLOCK"), "expected DATAPACKING=POINT");
    refused(
        &with("ZONE N=12, E=6, F=FEPOINT, ET=QUADRILATERAL"),
        "line 7: the zone is one of finite elements",
    );
    let two = [with("ZONE I=4, J=3"), b"ZONE I=4, J=3\n1 2 3 4 5\n".to_vec()].concat();
    refused(&two, "line 20: a second zone begins");
}

#[test]
fn numbers_at_positions_are_an_image() {
    let lattice = read(&table("", |x, y| format!("{x} {y} {}", x + y)), ArrayChoice::Usual, Wanted::Scalars);
    let lattice = lattice.unwrap();
    assert_eq!((lattice.size, lattice.components), ([4, 3, 1], 1));
}

#[test]
fn what_is_missing_is_said() {
    #[track_caller]
    fn refused(text: &str, words: &str) {
        let fault = read(text.as_bytes(), ArrayChoice::Usual, Wanted::Tensors).unwrap_err().to_string();
        assert!(fault.contains(words), "{text:?}: {fault}");
    }
    refused("1 2 3 4 5\n", "line 1: the columns `5 columns without names`");
    refused("a,y,S11,S22,S12\n1,2,3,4,5\n", "line 1: the columns `a, y, S11, S22, S12`");
    refused("x,y,S11,S22\n1,2,3,4\n", "`S11` (1 component)");
    refused("x,y,S11,S22,S12\n1,2,3,4,5\n1,b,3,4,5\n", "line 3, column 3: expected a number");
    refused(
        "x,y,S11,S22,S12,valid\n1,2,3,4,5,ok\n",
        "line 2, column 11: expected a number, true or false, found `ok`",
    );
    refused("x,y,S11,S22,S12\n1,2,3,4,5\n2,2,3,4\n", "line 3, column 8: found 4 numbers, expected 5");
}
