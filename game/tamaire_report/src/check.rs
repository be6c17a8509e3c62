//! Runs all rounds again, on all cores, and says of each whether it counts.

use crate::Error;
use crate::figures::Reason;
use crate::kept::Kept;
use crate::rerun::Rerun;
use std::cell::Cell;
use std::sync::mpsc::{Receiver, Sender, channel, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use tamaire_logbook::{End, Round};

/// Why what a row says cannot all be true.
pub fn contradiction(round: &Round) -> Option<(Reason, String)> {
    let is_won = round.end == End::Won;
    let what = if is_won && round.route.is_none() {
        "won, but by no route"
    } else if !is_won && round.route.is_some() {
        "not won, but by a route"
    } else if !round.seconds.is_finite() || round.seconds < 0.0 {
        "it took no time that there is"
    } else if round.number == 0 {
        "it is round 0 of its visit"
    } else {
        return None;
    };
    Some((Reason::Contradictory, what.into()))
}

/// Runs the rounds again that `each` hands over and that nothing is kept about; what comes of them is kept.
///
/// # Errors
/// [`Error`], also what `each` returns.
pub fn run_all(
    kept: &mut Kept,
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
        // Threads end when nobody hands them rounds any more, or nobody hears them.
        drop((jobs, tell));
        let all = each(&mut |round| {
            for (round, result) in results.try_iter() {
                keep(kept, &round, result)?;
                is_done();
            }
            if round.replay.is_empty() || !kept.lacks(&round) {
                is_done();
            } else {
                send.send(round).expect("threads wait for rounds");
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

fn keep(kept: &mut Kept, round: &Round, result: Rerun) -> Result<(), Error> {
    match result {
        // Another program may know its level.
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
