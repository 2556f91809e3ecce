//! Memory is allocated for what a file holds, not for what it declares.
//!
//! The only test of its program: the peak of the address space is the process's own.

#![allow(clippy::unwrap_used, reason = "a failed helper is a failed test")]

#[path = "files/support.rs"]
mod support;

use std::io::Write as _;
use support::{ARRAY, LZ4, ZLIB, bomb, declaring, nifti_file, npy_file, words};
use tigereye_io::{Limits, Wanted, legacy, nifti, npy, nrrd, vti};

/// Every file here declares or expands to at least 1 GiB.
const ALLOWED: u64 = 256 << 20;

/// Largest address space so far, in bytes; Linux only. Counts allocations that were never touched.
fn peak() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|l| l.strip_prefix("VmPeak:"))?;
    Some(1024 * line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()?)
}

fn hostile_images() -> Vec<Vec<u8>> {
    let points = 1 << 27;
    let bytes = 8 * points;
    let one_block = |bomb: Vec<u8>| [words(&[1, 800, 0, bomb.len() as u64]), bomb].concat();
    let wide = ARRAY.replace("Name", "NumberOfComponents=\"65536\" Name");
    vec![
        declaring(1_000_000_000_000, "", ARRAY, &words(&[8])),
        declaring(1_000_000_000_000, ZLIB, ARRAY, &words(&[8])),
        declaring(points, "", ARRAY, &words(&[bytes])),
        declaring(points, "", &wide, &words(&[bytes << 16])),
        declaring(points, ZLIB, ARRAY, &words(&[1, bytes, 0, 16, 0, 0])),
        declaring(points, ZLIB, ARRAY, &words(&[bytes / 8, 8, 0, 1, 1, 1, 1])),
        declaring(points, ZLIB, ARRAY, &words(&[u64::MAX, bytes, 0, 16])),
        declaring(points, LZ4, ARRAY, &words(&[1, bytes, 0, 16, 0, 0])),
        declaring(100, ZLIB, ARRAY, &one_block(bomb(ZLIB, 1 << 30))),
        declaring(100, LZ4, ARRAY, &one_block(bomb(LZ4, 1 << 30))),
    ]
}

/// Volumes whose headers promise more than there is, and gzip streams that hold more than the header says.
fn hostile_volumes() -> [Vec<Vec<u8>>; 3] {
    let zeros = {
        let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
        let head = nifti_file(false, &[10, 10, 10, 7], 16, 32, 1005, 3.0, &[]);
        encoder.write_all(&head).unwrap();
        (0..1 << 14).for_each(|_| encoder.write_all(&[0; 1 << 16]).unwrap());
        encoder.finish().unwrap()
    };
    let nrrd = |encoding: &str, data: &[u8]| {
        let head = format!(
            "NRRD0004\ntype: double\ndimension: 4\nsizes: 6 400 400 400\nkinds: 3D-symmetric-matrix space space space\n\
             endian: little\nencoding: {encoding}\n\n"
        );
        [head.as_bytes(), data].concat()
    };
    let small = zeros[..zeros.len().min(20_000)].to_vec();
    let vtk = |encoding: &str| {
        format!(
            "# vtk DataFile Version 3.0\n\n{encoding}\nDATASET STRUCTURED_POINTS\nDIMENSIONS 400 400 400\n\
             POINT_DATA 64000000\nTENSORS t double\n1 2 3"
        )
    };
    [
        vec![nrrd("raw", b"1"), nrrd("gzip", &small), nrrd("ascii", b"1 2 3")],
        vec![zeros, nifti_file(false, &[2000, 2000, 60, 6], 64, 64, 0, 0.0, &[0; 40])],
        vec![vtk("ASCII").into_bytes(), vtk("BINARY").into_bytes()],
    ]
}

#[test]
fn allocation_follows_the_bytes_there() {
    let images = hostile_images();
    let shapes = ["(100000, 100000, 2, 2)", "(268435456,)"];
    let header = |shape: &str| format!("{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}, }}");
    let mut arrays: Vec<Vec<u8>> = shapes.iter().map(|s| npy_file(1, &header(s), 16)).collect();
    let mut long = npy_file(2, "{}", 0);
    long[8..12].fill(0xff);
    arrays.push(long);
    let [nrrd_files, nifti_files, legacy_files] = hostile_volumes();
    let Some(before) = peak() else {
        println!("skipped: /proc/self/status tells no VmPeak here");
        return;
    };
    for limits in [Limits::default(), Limits { cells: u64::MAX, values: u64::MAX }] {
        for image in &images {
            assert!(vti::read_with_limits(image, limits).is_err());
        }
    }
    for limits in [Limits::default(), Limits { cells: u64::MAX, values: u64::MAX }] {
        assert!(nrrd_files.iter().all(|f| nrrd::read_with_limits(f, None, Wanted::Tensors, limits).is_err()));
        assert!(nifti_files.iter().all(|f| nifti::read_with_limits(f, limits).is_err()));
        assert!(legacy_files.iter().all(|f| legacy::read_with_limits(f, limits).is_err()));
    }
    for array in &arrays {
        assert!(npy::read_array(array).is_err());
    }
    let grown = peak().unwrap_or(before) - before;
    assert!(grown < ALLOWED, "{grown} bytes more");
}
