//! How large files may be that are read.

/// Largest summary, snapshot or picture, bytes.
pub const MAX_FILE: u64 = 64 << 20;
