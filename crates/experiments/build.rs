//! Rebuilds the crate when a carried experiment or data file is added, changed or removed.

fn main() {
    println!("cargo::rerun-if-changed=../../experiments");
    println!("cargo::rerun-if-changed=../../data");
}
