//! Thread that does slow work, such as writing files, in the background.

use std::io;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread::{self, JoinHandle};

/// Job that returns its result.
type Job<T> = Box<dyn FnOnce() -> T + Send>;

/// Runs jobs one after the other on a thread, or at once if the system cannot start a thread.
pub struct Writer<T> {
    thread: Option<(Sender<Job<T>>, JoinHandle<()>)>,
    results: Receiver<T>,
    teller: Sender<T>,
    /// Number of results not yet received.
    open: usize,
}

impl<T: Send + 'static> Writer<T> {
    /// Creates a writer without jobs. The thread starts with the first job.
    pub fn new() -> Self {
        let (teller, results) = channel();
        Self {
            thread: None,
            results,
            teller,
            open: 0,
        }
    }

    /// Adds a job. `told` converts the job's return value to a result of the writer.
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
            // The receiver is a field of `self`, so sending cannot fail.
            let _heard = self.teller.send(job());
        }
    }

    /// Adds an asynchronous job, for example one that waits for a GPU.
    pub fn develop<W: Future<Output = T>>(&mut self, job: impl FnOnce() -> W + Send + 'static) {
        self.begin(Box::new(move || pollster::block_on(job())));
    }

    /// Returns the results of finished jobs, without waiting.
    pub fn results(&mut self) -> Vec<T> {
        let results: Vec<T> = self.results.try_iter().collect();
        self.open -= results.len();
        results
    }

    /// Waits for all jobs and returns their results.
    pub fn finish(&mut self) -> Vec<T> {
        let mut results = self.results();
        if let Some((jobs, thread)) = self.thread.take() {
            drop(jobs);
            // Ignores a panic of the thread, which has printed its message already.
            let _ended = thread.join();
            results.extend(self.results());
            self.open = 0;
        }
        results
    }

    /// Whether jobs are unfinished.
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
    fn jobs_run_in_order_and_finish_waits_for_them() {
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
