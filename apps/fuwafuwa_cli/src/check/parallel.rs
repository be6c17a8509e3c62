//! Distribution of the cases of a check over threads.

use crate::report::Progress;
use anyhow::{Result, anyhow};
use std::sync::atomic::{AtomicUsize, Ordering};

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
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let next = AtomicUsize::new(0);
    let run = || {
        let mut done = Vec::new();
        loop {
            let taken = next.fetch_add(1, Ordering::Relaxed);
            let Some(index) = cases.len().checked_sub(taken + 1) else {
                return done;
            };
            done.push((index, work(&cases[index])));
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
