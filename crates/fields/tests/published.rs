//! The generators against the thesis author's published matrices.
//!
//! The matrices lie outside the project, in `fields/` of the folder named by `TIGEREYE_REFERENCE` or in
//! `shared/reference` beside the workspace; without them the test is skipped.

use std::collections::BTreeSet;
use tigereye_core::{Field, Grid, Tensor2};
use tigereye_test_support::{field, reference_folder};

/// Largest difference of a component, relative to the largest component of the field. The files hold 12 digits.
const TOLERANCE: f64 = 1e-11;

/// Every published file with the field it is.
const FILES: [(&str, &str); 25] = [
    ("X.txt", "x:size=7,anisotropy=4"),
    ("Y.txt", "y:size=7,anisotropy=4"),
    ("absorb13.txt", "absorb:size=13"),
    ("bow13.txt", "bow:size=13,anisotropy=4"),
    ("bow51.txt", "bow:size=51"),
    ("cone.txt", "cone:size=7"),
    ("corner13.txt", "corner:size=13,anisotropy=4"),
    ("crossX13.txt", "cross_x:size=13"),
    ("diagDrain13.txt", "diag_drain:size=13,anisotropy=4"),
    ("drain13.txt", "drain:size=13,anisotropy=4"),
    ("drain51.txt", "drain:size=51"),
    ("drain_alt13.txt", "drain_alt:size=13"),
    ("drain_old13.txt", "drain_old:size=13,anisotropy=4"),
    ("drain_old51.txt", "drain_old:size=51,anisotropy=4"),
    ("gyre13.txt", "gyre:size=13"),
    ("inverse13.txt", "inverse:size=13,anisotropy=4"),
    ("inverse29.txt", "inverse:size=29"),
    ("inverse51.txt", "inverse:size=51,anisotropy=4"),
    ("rings13.txt", "rings:size=13,anisotropy=4"),
    ("rings13_total.txt", "rings:size=13,total=true"),
    ("rings51.txt", "rings:size=51"),
    ("spiral13.txt", "spiral:size=13,anisotropy=4"),
    ("spiral29.txt", "spiral:size=29,anisotropy=4"),
    ("star13.txt", "star:size=13,anisotropy=4"),
    ("step13.txt", "step:size=13,anisotropy=4"),
];

/// 2H rows of 2W numbers, cell (x, y) the 2x2 block at row 2y, column 2x.
fn parse_blocks(text: &str) -> Field<Tensor2> {
    let rows: Vec<Vec<f64>> = text
        .lines()
        .map(|line| line.split_whitespace().map(|n| n.parse().expect("a number")).collect())
        .filter(|row: &Vec<f64>| !row.is_empty())
        .collect();
    let grid = Grid::new(rows[0].len() / 2, rows.len() / 2).expect("a grid");
    Field::from_fn(grid, |c| {
        let (top, bottom, k) = (&rows[2 * c.y], &rows[2 * c.y + 1], 2 * c.x);
        Tensor2::new(top[k], top[k + 1], bottom[k], bottom[k + 1])
    })
}

#[test]
fn generators_equal_the_published_matrices() {
    let Some(folder) = reference_folder("fields") else { return };
    for (file, spec) in FILES {
        let path = folder.join(file);
        let text = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        let published = parse_blocks(&text);
        let field = field(spec);
        assert_eq!(field.grid(), published.grid(), "{file}");
        let largest = published.values().iter().fold(0.0, |m: f64, t| m.max(t.max_abs()));
        for (cell, t) in field.iter() {
            let difference = (*t + published.at(cell).scaled(-1.0)).max_abs() / largest;
            assert!(difference <= TOLERANCE, "{file} as {spec}, {cell:?}: {difference:e}");
        }
    }
}

#[test]
fn every_published_file_is_compared() {
    let Some(folder) = reference_folder("fields") else { return };
    let there: BTreeSet<String> = std::fs::read_dir(folder)
        .expect("a folder")
        .map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned())
        .collect();
    let compared: BTreeSet<String> = FILES.iter().map(|(file, _)| (*file).to_owned()).collect();
    assert_eq!(there, compared);
}
