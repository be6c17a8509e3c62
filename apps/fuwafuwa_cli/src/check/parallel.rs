//! Distribution of the cases of a check over threads.

use crate::report::Progress;
use anyhow::{Result, anyhow};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Condvar, Mutex, PoisonError};

/// Number of running cases of all checks, and the signal that one has ended.
static RUNNING: (Mutex<usize>, Condvar) = (Mutex::new(0), Condvar::new());

/// Permission to run a case. At most as many exist as the machine has threads, so that checks which run side by side
/// do not hold each other up.
struct Permit;

impl Permit {
    /// Waits for a permission.
    fn wait() -> Self {
        let (running, ended) = &RUNNING;
        let count = running.lock().unwrap_or_else(PoisonError::into_inner);
        let count = ended.wait_while(count, |count| *count >= threads());
        *count.unwrap_or_else(PoisonError::into_inner) += 1;
        Self
    }
}

impl Drop for Permit {
    fn drop(&mut self) {
        let (running, ended) = &RUNNING;
        *running.lock().unwrap_or_else(PoisonError::into_inner) -= 1;
        ended.notify_one();
    }
}

/// Returns the number of threads of the machine.
pub fn threads() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// Returns the results of `work` for all cases, in the order of the cases. Starts with the last cases, which
/// are usually the slowest.
///
/// # Errors
/// The first error of a case, or an error if a case panicked.
pub fn each<Case: Sync, Outcome: Send>(
    cases: &[Case],
    progress: &Progress,
    work: impl Fn(&Case) -> Result<Outcome> + Sync,
) -> Result<Vec<Outcome>> {
    progress.expect(cases.len() as u64);
    let threads = threads().min(cases.len());
    let next = AtomicUsize::new(0);
    let run = || {
        let mut done = Vec::new();
        loop {
            let taken = next.fetch_add(1, Ordering::Relaxed);
            let Some(index) = cases.len().checked_sub(taken + 1) else {
                return done;
            };
            let permit = Permit::wait();
            done.push((index, work(&cases[index])));
            drop(permit);
            progress.step();
        }
    };
    let mut all = Vec::new();
    std::thread::scope(|scope| -> Result<()> {
        let workers: Vec<_> = (0..threads).map(|_| scope.spawn(run)).collect();
        for worker in workers {
            all.extend(worker.join().map_err(|_| anyhow!("a case panicked"))?);
        }
        Ok(())
    })?;
    all.sort_by_key(|&(index, _)| index);
    all.into_iter().map(|(_, found)| found).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_keep_the_order_of_cases() {
        let cases: Vec<u32> = (0..100).collect();
        let squares = each(&cases, &Progress::new(), |case| Ok(case * case)).unwrap();
        assert!(
            squares
                .iter()
                .zip(&cases)
                .all(|(found, case)| *found == case * case)
        );
        let failed = each(&cases, &Progress::new(), |&case| {
            anyhow::ensure!(case != 7, "seven");
            Ok(())
        });
        assert!(failed.is_err());
    }
}
