//! What is written while the game goes on: each thing while no other tab writes, and told once the browser has it.

use super::host;
use super::kept::refused;
use std::cell::Cell;
use std::io;
use std::rc::Rc;
use std::sync::mpsc::{Receiver, Sender, channel};
use wasm_bindgen::JsCast;
use wasm_bindgen::closure::Closure;
use wasm_bindgen_futures::{JsFuture, spawn_local};

/// Something to write that was not begun yet.
type Job = Rc<Cell<Option<Box<dyn FnOnce()>>>>;

/// Does one thing after the other.
pub struct Writer<T> {
    waiting: Vec<Job>,
    results: Receiver<T>,
    teller: Sender<T>,
    /// How many results are still to come.
    open: usize,
}

impl<T: 'static> Writer<T> {
    /// Nothing to do yet.
    pub fn new() -> Self {
        let (teller, results) = channel();
        Self {
            waiting: Vec::new(),
            results,
            teller,
            open: 0,
        }
    }

    /// Does this after what was asked for before; `told` makes of it what is to be told.
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

    /// Does this between frames: it may have to wait for a device.
    pub fn develop<W: Future<Output = T>>(&mut self, job: impl FnOnce() -> W + 'static) {
        self.open += 1;
        let teller = self.teller.clone();
        spawn_local(async move {
            // The game may have begun anew.
            let _ = teller.send(job().await);
        });
    }

    /// What came of what was done, without waiting.
    pub fn results(&mut self) -> Vec<T> {
        let results: Vec<T> = self.results.try_iter().collect();
        self.open -= results.len();
        self.waiting.retain(|job| Rc::strong_count(job) > 1);
        results
    }

    /// Begins at once what waits: the page may not come back. A browser lets nobody wait for more.
    pub fn finish(&mut self) -> Vec<T> {
        for job in self.waiting.drain(..) {
            begin(&job);
        }
        self.results()
    }

    /// Whether something is still to be done.
    pub fn is_busy(&self) -> bool {
        self.open > 0
    }
}

fn begin(job: &Job) {
    if let Some(job) = job.take() {
        job();
    }
}
