//! What is written while the game goes on.

use std::io;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread::{self, JoinHandle};

/// Something to write, and what is to be told of it.
type Job<T> = Box<dyn FnOnce() -> T + Send>;

/// Does one thing after the other on a thread of its own; where the system has none to give, at once.
pub struct Writer<T> {
    thread: Option<(Sender<Job<T>>, JoinHandle<()>)>,
    results: Receiver<T>,
    teller: Sender<T>,
    /// How many results are still to come.
    open: usize,
}

impl<T: Send + 'static> Writer<T> {
    /// Nothing to do yet, and no thread.
    pub fn new() -> Self {
        let (teller, results) = channel();
        Self {
            thread: None,
            results,
            teller,
            open: 0,
        }
    }

    /// Does this after what was asked for before; `told` makes of it what is to be told.
    pub fn write<V: 'static>(
        &mut self,
        job: impl FnOnce() -> io::Result<V> + Send + 'static,
        told: fn(io::Result<V>) -> T,
    ) {
        self.begin(Box::new(move || told(job())));
    }

    fn begin(&mut self, job: Job<T>) {
        self.open += 1;
        if self.thread.is_none() {
            self.thread = start(self.teller.clone());
        }
        let refused = match &self.thread {
            Some((jobs, _)) => jobs.send(job).err().map(|refused| refused.0),
            None => Some(job),
        };
        if let Some(job) = refused {
            // This end of it is ours, so somebody hears.
            let _heard = self.teller.send(job());
        }
    }

    /// Does this too, which may have to wait for a device.
    pub fn develop<W: Future<Output = T>>(&mut self, job: impl FnOnce() -> W + Send + 'static) {
        self.begin(Box::new(move || pollster::block_on(job())));
    }

    /// What came of what was done, without waiting.
    pub fn results(&mut self) -> Vec<T> {
        let results: Vec<T> = self.results.try_iter().collect();
        self.open -= results.len();
        results
    }

    /// Waits until all is done; what came of it.
    pub fn finish(&mut self) -> Vec<T> {
        let mut results = self.results();
        if let Some((jobs, thread)) = self.thread.take() {
            drop(jobs);
            // One that panicked has told so itself.
            let _ended = thread.join();
            results.extend(self.results());
            self.open = 0;
        }
        results
    }

    /// Whether something is still to be done.
    pub fn is_busy(&self) -> bool {
        self.open > 0
    }
}

fn start<T: Send + 'static>(teller: Sender<T>) -> Option<(Sender<Job<T>>, JoinHandle<()>)> {
    let (jobs, waiting) = channel::<Job<T>>();
    let work = move || {
        for job in waiting {
            if teller.send(job()).is_err() {
                break;
            }
        }
    };
    let thread = thread::Builder::new().name("writer".into()).spawn(work);
    Some((jobs, thread.ok()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_is_done_in_its_order_and_waited_for() {
        let mut writer = Writer::new();
        let told = |number: io::Result<i32>| number.expect("it is there");
        for number in 0..100 {
            writer.write(move || Ok(number), told);
        }
        let mut done = writer.results();
        done.extend(writer.finish());
        assert_eq!(done, (0..100).collect::<Vec<_>>());
        writer.write(|| Ok(100), told);
        assert_eq!(writer.finish(), [100]);
        assert!(!writer.is_busy());
    }
}
