//! Runs all rounds again on all cores and checks each result.

use crate::Error;
use crate::figures::Reason;
use crate::kept::RerunCache;
use crate::rerun::Rerun;
use std::cell::Cell;
use std::sync::mpsc::{Receiver, Sender, channel, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use tamaire_logbook::{Round, RoundEnd};

/// Returns the reason why a row contradicts itself, if it does.
pub fn contradiction(round: &Round) -> Option<(Reason, String)> {
    let is_won = round.end == RoundEnd::Won;
    let what = if is_won && round.route.is_none() {
        "won, but without a route"
    } else if !is_won && round.route.is_some() {
        "not won, but with a route"
    } else if !round.seconds.is_finite() || round.seconds < 0.0 {
        "seconds is negative or not finite"
    } else if round.number == 0 {
        "number is 0, expected 1 or more"
    } else {
        return None;
    };
    Some((Reason::Contradictory, what.into()))
}

/// Runs rounds again and stores their results. Skips rounds without a replay and rounds with a stored result.
/// `each` receives a function, to which it must pass every round. `done` receives the number of finished
/// rounds.
///
/// # Errors
/// [`Error`], also an error of `each`.
pub fn run_all(
    kept: &mut RerunCache,
    mut done: impl FnMut(u64),
    each: impl FnOnce(&mut dyn FnMut(Round) -> Result<(), Error>) -> Result<(), Error>,
) -> Result<(), Error> {
    let threads = thread::available_parallelism().map_or(1, usize::from);
    let (send, jobs) = sync_channel::<Round>(2 * threads);
    let jobs = Arc::new(Mutex::new(jobs));
    let (tell, results) = channel();
    let count = Cell::new(0);
    let mut is_done = || {
        count.set(count.get() + 1);
        done(count.get());
    };
    thread::scope(|scope| {
        for _ in 0..threads {
            let (jobs, tell) = (jobs.clone(), tell.clone());
            scope.spawn(move || work(&jobs, &tell));
        }
        // Drops the main thread's copies of these channel ends, so that the channels close when the worker
        // threads end.
        drop((jobs, tell));
        let all = each(&mut |round| {
            for (round, result) in results.try_iter() {
                keep(kept, &round, result)?;
                is_done();
            }
            if round.replay.is_empty() || !kept.lacks(&round) {
                is_done();
            } else {
                send.send(round)
                    .expect("the worker threads receive until the channel is closed");
            }
            Ok(())
        });
        drop(send);
        all?;
        for (round, result) in results {
            keep(kept, &round, result)?;
            is_done();
        }
        Ok(())
    })
}

fn keep(kept: &mut RerunCache, round: &Round, result: Rerun) -> Result<(), Error> {
    match result {
        // Does not store this result, because another version of the program may support the rules and the
        // level of the replay.
        Rerun::Foreign(_) => Ok(()),
        result => kept.add(round, result),
    }
}

fn work(jobs: &Mutex<Receiver<Round>>, tell: &Sender<(Round, Rerun)>) {
    loop {
        let job = jobs.lock().unwrap_or_else(PoisonError::into_inner).recv();
        let Ok(round) = job else {
            return;
        };
        let result = Rerun::of(&round.replay);
        if tell.send((round, result)).is_err() {
            return;
        }
    }
}
