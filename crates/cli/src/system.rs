//! The machine: memory, threads, time.

use crate::error::CliError;
use tigereye_transport::Level;

/// Half of the machine's memory, bytes; 4 GiB where it cannot be found out.
pub(crate) fn half_of_memory() -> u64 {
    let text = std::fs::read_to_string("/proc/meminfo").unwrap_or_default();
    kilobytes(&text, "MemTotal:").map_or(4 << 30, |kb| kb * 1024 / 2)
}

/// Largest memory this process has had, bytes, where the system tells.
pub(crate) fn peak_memory() -> Option<u64> {
    let text = std::fs::read_to_string("/proc/self/status").ok()?;
    kilobytes(&text, "VmHWM:").map(|kb| kb * 1024)
}

fn kilobytes(text: &str, key: &str) -> Option<u64> {
    let line = text.lines().find_map(|l| l.strip_prefix(key))?;
    line.split_whitespace().next()?.parse().ok()
}

/// The environment variable that may name an instruction set to use instead of the widest one.
const LEVEL: &str = "TIGEREYE_SIMD";

/// The instruction set of the hot loops: the widest there is, or the one that the environment names.
pub(crate) fn level() -> Result<Level, CliError> {
    let Some(name) = std::env::var_os(LEVEL) else { return Ok(Level::detect()) };
    let name = name.to_string_lossy();
    Level::named(&name).ok_or_else(|| {
        let names: Vec<&str> = Level::available().iter().map(|l| l.name()).collect();
        CliError::input(LEVEL, format!("`{name}`: expected one of {}", names.join(", ")))
    })
}

/// What the system calls the processor.
pub(crate) fn processor() -> String {
    let text = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name = text.lines().find_map(|l| l.strip_prefix("model name")?.split_once(':').map(|(_, name)| name));
    name.map_or_else(|| "an unnamed processor".to_owned(), |name| name.trim().to_owned())
}

/// Runs `work` on a pool of `threads` threads (all processors: `None`).
pub(crate) fn on_threads<T: Send>(
    threads: Option<usize>,
    work: impl FnOnce() -> Result<T, CliError> + Send,
) -> Result<T, CliError> {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads.unwrap_or(0))
        .build()
        .map_err(|e| CliError::Input(format!("cannot start the threads: {e}")))?;
    pool.install(work)
}
