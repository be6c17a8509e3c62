//! Background writer. It runs each job while no other tab writes, and reports the job once the browser has
//! stored the changes.

use super::host;
use super::kept::refused;
use std::cell::Cell;
use std::io;
use std::rc::Rc;
use std::sync::mpsc::{Receiver, Sender, channel};
use wasm_bindgen::JsCast;
use wasm_bindgen::closure::Closure;
use wasm_bindgen_futures::{JsFuture, spawn_local};

/// Job that has not started yet.
type Job = Rc<Cell<Option<Box<dyn FnOnce()>>>>;

/// Runs jobs one after the other.
pub struct Writer<T> {
    waiting: Vec<Job>,
    results: Receiver<T>,
    teller: Sender<T>,
    /// Number of results not yet received.
    open: usize,
}

impl<T: 'static> Writer<T> {
    /// Creates a writer without jobs.
    pub fn new() -> Self {
        let (teller, results) = channel();
        Self {
            waiting: Vec::new(),
            results,
            teller,
            open: 0,
        }
    }

    /// Adds a job. `told` converts the job's return value to a result of the writer.
    pub fn write<V: 'static>(
        &mut self,
        job: impl FnOnce() -> io::Result<V> + 'static,
        told: fn(io::Result<V>) -> T,
    ) {
        let outcome = Rc::new(Cell::new(None));
        let found = outcome.clone();
        let job: Box<dyn FnOnce()> = Box::new(move || found.set(Some(job())));
        let job = Rc::new(Cell::new(Some(job)));
        self.waiting.push(job.clone());
        self.develop(move || async move {
            let begun = Closure::<dyn FnMut()>::new(move || begin(&job));
            let ended = JsFuture::from(host().alone(begun.as_ref().unchecked_ref())).await;
            let failure = ended.ok().and_then(|failure| failure.as_string());
            told(match (failure.map(refused), outcome.take()) {
                (None, Some(outcome)) => outcome,
                (failure, _) => Err(failure.unwrap_or_else(|| io::ErrorKind::Interrupted.into())),
            })
        });
    }

    /// Adds an asynchronous job, for example one that waits for a GPU. It runs between frames.
    pub fn develop<W: Future<Output = T>>(&mut self, job: impl FnOnce() -> W + 'static) {
        self.open += 1;
        let teller = self.teller.clone();
        spawn_local(async move {
            // Sending fails if a new game has started.
            let _ = teller.send(job().await);
        });
    }

    /// Returns the results of finished jobs, without waiting.
    pub fn results(&mut self) -> Vec<T> {
        let results: Vec<T> = self.results.try_iter().collect();
        self.open -= results.len();
        self.waiting.retain(|job| Rc::strong_count(job) > 1);
        results
    }

    /// Starts all waiting jobs at once, because a hidden page may be closed. Does not wait for their end,
    /// because browsers do not allow waiting. Returns the results of finished jobs.
    pub fn finish(&mut self) -> Vec<T> {
        for job in self.waiting.drain(..) {
            begin(&job);
        }
        self.results()
    }

    /// Whether jobs are unfinished.
    pub fn is_busy(&self) -> bool {
        self.open > 0
    }
}

fn begin(job: &Job) {
    if let Some(job) = job.take() {
        job();
    }
}
