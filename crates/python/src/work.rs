//! Work without the interpreter: other threads of Python run meanwhile, Ctrl-C ends it, and progress is told.

use crate::error::Fault;
use pyo3::prelude::*;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{RecvTimeoutError, sync_channel};
use std::thread;
use std::time::Duration;

/// How long an interrupt waits at most before anybody looks.
const LOOK: Duration = Duration::from_millis(50);

/// What work says about itself, and whether it is to end.
#[derive(Debug, Default)]
pub(crate) struct Watch {
    stop: AtomicBool,
    done: AtomicU64,
    total: AtomicU64,
}

impl Watch {
    /// Tells how far the work is; `total` is 0 where nobody knows. Whether it is to end.
    pub(crate) fn told(&self, done: u64, total: u64) -> bool {
        // Threads tell in any order: the bar must not run backwards.
        self.done.fetch_max(done, Ordering::Relaxed);
        self.total.store(total, Ordering::Relaxed);
        self.stop.load(Ordering::Relaxed)
    }
}

/// Runs `work` on a thread of its own, with `threads` more for what it does in parallel (all processors: `None`).
///
/// Python's signal handlers run on the calling thread, which therefore must not be the one that computes. Threads are
/// started for every call, because those of a pool that outlives it would be missing in a forked process.
pub(crate) fn run<T: Send>(
    py: Python<'_>,
    threads: Option<usize>,
    progress: Option<&Bound<'_, PyAny>>,
    work: impl FnOnce(&Watch) -> Result<T, Fault> + Send,
) -> PyResult<T> {
    if threads.is_some_and(|n| !(1..=1024).contains(&n)) {
        return Err(Fault::option("threads", "expected 1 to 1024").into());
    }
    let progress = progress.map(|p| p.clone().unbind());
    let in_pool = |watch: &Watch| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads.unwrap_or(0))
            .build()
            .map_err(|e| Fault::Program(format!("cannot start the threads: {e}")))?;
        pool.install(|| work(watch))
    };
    py.detach(|| watched(progress.as_ref(), in_pool))
}

/// Runs work that has no parallel parts, as [`run`] does.
pub(crate) fn run_single<T: Send>(
    py: Python<'_>,
    progress: Option<&Bound<'_, PyAny>>,
    work: impl FnOnce(&Watch) -> Result<T, Fault> + Send,
) -> PyResult<T> {
    let progress = progress.map(|p| p.clone().unbind());
    py.detach(|| watched(progress.as_ref(), work))
}

fn watched<T: Send>(
    progress: Option<&Py<PyAny>>,
    work: impl FnOnce(&Watch) -> Result<T, Fault> + Send,
) -> PyResult<T> {
    let watch = Watch::default();
    thread::scope(|scope| {
        let (sender, receiver) = sync_channel(1);
        let shared = &watch;
        scope.spawn(move || {
            let result = catch_unwind(AssertUnwindSafe(|| work(shared)));
            // Nobody listens only if the calling thread has panicked.
            let _ = sender.send(result);
        });
        let mut raised = None;
        let mut last = u64::MAX;
        let result = loop {
            match receiver.recv_timeout(LOOK) {
                Ok(result) => break result,
                Err(RecvTimeoutError::Timeout) if raised.is_none() => {
                    let looked = Python::attach(|py| {
                        py.check_signals()?;
                        told(py, progress, &watch, &mut last)
                    });
                    if let Err(error) = looked {
                        watch.stop.store(true, Ordering::Relaxed);
                        raised = Some(error);
                    }
                }
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => {
                    return Err(Fault::Program("the work ended without a result".to_owned()).into());
                }
            }
        };
        if let Some(error) = raised {
            return Err(error);
        }
        let result =
            result.map_err(|_| Fault::Program("a fault of tigereye, please report it".to_owned()))?;
        let result = result.map_err(PyErr::from)?;
        Python::attach(|py| told(py, progress, &watch, &mut last))?;
        Ok(result)
    })
}

/// Calls `progress(done, total)`, where anything has changed.
fn told(py: Python<'_>, progress: Option<&Py<PyAny>>, watch: &Watch, last: &mut u64) -> PyResult<()> {
    let (done, total) = (watch.done.load(Ordering::Relaxed), watch.total.load(Ordering::Relaxed));
    match progress {
        Some(progress) if done != *last => {
            *last = done;
            progress.call1(py, (done, total)).map(drop)
        }
        _ => Ok(()),
    }
}
