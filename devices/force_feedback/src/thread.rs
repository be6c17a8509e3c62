//! Thread that owns all sinks, and its interface to the game. Where there are no threads, as in a browser,
//! [`ForceThread`] owns the sinks itself.

use crate::{
    Ability, Command, ForceController, Output, Settings, Sink, State, StepOutput, Stop, Watchdog,
};
use std::collections::BTreeMap;
use std::ops::RangeInclusive;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::Duration;
use web_time::Instant;

/// Allowed update rates of devices [Hz]. Below 125 Hz players feel steps; most devices accept at most 250 Hz.
pub const RATES: RangeInclusive<u32> = 125..=250;
/// Interval at which an unchanged output is repeated, well below [`OUTPUT_DURATION`](crate::OUTPUT_DURATION).
const AGAIN: Duration = Duration::from_millis(200);

/// Owner of all sinks, or of the thread that owns them. Dropping it stops all devices and returns once they
/// have stopped.
#[must_use = "dropping it stops the force feedback"]
pub struct ForceThread {
    shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
    /// Sinks with their state if there is no thread; empty if a thread owns them.
    outlets: Vec<Outlet>,
}

/// Connection to one device. Dropping it, also by a panic, stops and releases the device.
#[must_use = "dropping it stops the force feedback"]
pub struct Line {
    shared: Arc<Shared>,
    key: u64,
}

/// State of a device and of its connection to the game.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Report {
    /// Capability of the device.
    pub ability: Ability,
    /// Output that the device plays now.
    pub output: Output,
    /// Force before the safety chain [N].
    pub newtons: [f32; 2],
    /// Reason why no force is output; `None` while forces are allowed.
    pub silent: Option<Stop>,
}

struct Shared {
    start: Instant,
    desk: Mutex<SharedState>,
    news: Condvar,
}

/// Data shared by the game and the thread. The lock is held only for copying. Holds the latest values, no
/// queue.
#[derive(Default)]
struct SharedState {
    watchdog: Watchdog,
    posts: BTreeMap<u64, Post>,
    arrivals: Vec<Outlet>,
    next_key: u64,
    /// Whether the thread must update the devices now, before its next update is due.
    is_urgent: bool,
    is_closing: bool,
    has_ended: bool,
}

/// Last commands of the game for a device, and the resulting state.
#[derive(Clone, Copy)]
struct Post {
    mail: Command,
    tear: f32,
    settings: Settings,
    report: Report,
}

/// Device and its force calculation, owned by the thread.
struct Outlet {
    key: u64,
    sink: Box<dyn Sink>,
    feel: ForceController,
    told: Output,
    told_at: Duration,
}

impl ForceThread {
    /// Starts the thread; `rate` is its update rate [Hz], clamped to [`RATES`].
    ///
    /// # Errors
    /// Returns an error if the system cannot start a thread.
    pub fn start(rate: u32) -> std::io::Result<Self> {
        let mut force = Self::without_thread();
        let period = Duration::from_secs(1) / rate.clamp(*RATES.start(), *RATES.end());
        let on_thread = force.shared.clone();
        let thread = std::thread::Builder::new()
            .name("force".into())
            .spawn(move || on_thread.run(period))?;
        force.thread = Some(thread);
        Ok(force)
    }

    /// Creates an owner without a thread, for platforms such as browsers. Then only [`ForceThread::update`]
    /// updates the devices.
    pub fn without_thread() -> Self {
        Self {
            shared: Arc::new(Shared {
                start: Instant::now(),
                desk: Mutex::default(),
                news: Condvar::new(),
            }),
            thread: None,
            outlets: Vec::new(),
        }
    }

    /// Updates all devices once. Does nothing if there is a thread, because the thread updates the devices.
    pub fn update(&mut self) {
        if self.thread.is_none() {
            self.shared.update(self.shared.desk(), &mut self.outlets);
        }
    }

    /// Takes over a device and returns the connection to it. There is no force before the first
    /// [`Line::set_state`].
    pub fn add(&self, sink: Box<dyn Sink>, settings: Settings) -> Line {
        let report = Report {
            ability: sink.ability(),
            output: Output::zero(sink.ability()),
            newtons: [0.0; 2],
            silent: Some(Stop::NoState),
        };
        let mut desk = self.shared.desk();
        let key = desk.next_key;
        desk.next_key += 1;
        let post = Post {
            mail: Command::default(),
            tear: 0.0,
            settings,
            report,
        };
        desk.posts.insert(key, post);
        desk.arrivals.push(Outlet {
            key,
            sink,
            feel: ForceController::default(),
            told: report.output,
            told_at: Duration::ZERO,
        });
        Line {
            shared: self.shared.clone(),
            key,
        }
    }

    /// Stops all devices. Each one resumes with its next [`Line::set_state`].
    pub fn stop(&self, why: Stop) {
        let mail = self.shared.mail(Err(why));
        let mut desk = self.shared.desk();
        for post in desk.posts.values_mut() {
            post.mail = mail;
        }
        self.shared.hurry(desk);
    }

    /// Stops all devices and ignores new states until [`ForceThread::release`].
    pub fn emergency_stop(&self) {
        let mut desk = self.shared.desk();
        desk.watchdog.latch();
        self.shared.hurry(desk);
    }

    /// Ends an emergency stop. States reported during the stop are discarded.
    pub fn release(&self) {
        let mut desk = self.shared.desk();
        desk.watchdog.release();
        for post in desk.posts.values_mut() {
            post.mail = Command::default();
        }
    }
}

impl Drop for ForceThread {
    fn drop(&mut self) {
        let mut desk = self.shared.desk();
        desk.is_closing = true;
        self.shared.hurry(desk);
        if let Some(thread) = self.thread.take() {
            // An error means that the thread panicked. The panic was already printed and has set all sinks to
            // zero.
            let _ = thread.join();
        }
    }
}

impl Line {
    /// Reports the current state. Call it after each step of the simulation: the device stops if the last
    /// state is older than [`MAX_STATE_AGE`](crate::MAX_STATE_AGE).
    pub fn set_state(&self, state: State) {
        let mail = self.shared.mail(Ok(state));
        self.post(|post| post.mail = mail);
    }

    /// Reports a tear with a size from 0 to 1, which is felt as a short drop of the force.
    pub fn tear(&self, size: f32) {
        self.post(|post| post.tear = post.tear.max(size));
    }

    /// Stops this device until the next [`Line::set_state`]. Repeated calls are cheap, so callers need not
    /// check first.
    pub fn stop(&self, why: Stop) {
        let mail = self.shared.mail(Err(why));
        let before = self.post(|post| std::mem::replace(&mut post.mail, mail));
        if before.wish != mail.wish {
            self.shared.hurry(self.shared.desk());
        }
    }

    /// Changes the settings, from the next update on.
    pub fn set(&self, settings: Settings) {
        self.post(|post| post.settings = settings);
    }

    /// Returns the state of the device after its last update.
    pub fn report(&self) -> Report {
        let has_ended = self.shared.desk().has_ended;
        let mut report = self.post(|post| Report {
            silent: post.mail.wish.err().or(post.report.silent),
            ..post.report
        });
        if has_ended {
            report.silent = Some(Stop::Ended);
        }
        report
    }

    fn post<R>(&self, act: impl FnOnce(&mut Post) -> R) -> R {
        let mut desk = self.shared.desk();
        let post = desk.posts.get_mut(&self.key);
        act(post.expect("only dropping the line removes its post"))
    }
}

impl Drop for Line {
    fn drop(&mut self) {
        let mut desk = self.shared.desk();
        desk.posts.remove(&self.key);
        self.shared.hurry(desk);
    }
}

impl Shared {
    fn desk(&self) -> MutexGuard<'_, SharedState> {
        self.desk.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn mail(&self, wish: Result<State, Stop>) -> Command {
        let at = self.start.elapsed();
        Command { wish, at }
    }

    /// Wakes the thread for an immediate update.
    fn hurry(&self, mut desk: MutexGuard<'_, SharedState>) {
        desk.is_urgent = true;
        drop(desk);
        self.news.notify_one();
    }

    fn run(&self, period: Duration) {
        let _end = End(self);
        let mut outlets: Vec<Outlet> = Vec::new();
        let mut next = self.start.elapsed();
        loop {
            let wait = next.saturating_sub(self.start.elapsed());
            let waited = self
                .news
                .wait_timeout_while(self.desk(), wait, |desk| !desk.is_urgent);
            let (desk, _) = waited.unwrap_or_else(PoisonError::into_inner);
            if desk.is_closing {
                return;
            }
            let now = self.update(desk, &mut outlets);
            // Skips missed updates instead of making up for them.
            next = (next + period).max(now);
        }
    }

    /// Updates all devices and returns the time of the update.
    fn update(&self, mut desk: MutexGuard<'_, SharedState>, outlets: &mut Vec<Outlet>) -> Duration {
        desk.is_urgent = false;
        outlets.append(&mut desk.arrivals);
        let watchdog = desk.watchdog;
        // A device without a post was removed by the game. Its outlet is dropped below, outside the lock.
        let posts: Vec<Option<Post>> = outlets
            .iter()
            .map(|outlet| {
                let post = desk.posts.get_mut(&outlet.key)?;
                let copy = *post;
                post.tear = 0.0;
                Some(copy)
            })
            .collect();
        drop(desk);

        let now = self.start.elapsed();
        let mut posts = posts.into_iter();
        let mut reports = Vec::new();
        outlets.retain_mut(|outlet| {
            let post = posts.next().flatten();
            let report = post.map(|post| outlet.update(&watchdog, &post, now));
            reports.extend(report.map(|report| (outlet.key, report)));
            post.is_some()
        });
        let mut desk = self.desk();
        for (key, report) in reports {
            if let Some(post) = desk.posts.get_mut(&key) {
                post.report = report;
            }
        }
        now
    }
}

/// Guard that marks the thread as ended when dropped, also after a panic. All lines then report the end.
struct End<'a>(&'a Shared);

impl Drop for End<'_> {
    fn drop(&mut self) {
        let mut desk = self.0.desk();
        desk.has_ended = true;
        desk.arrivals.clear();
    }
}

impl Outlet {
    fn update(&mut self, watchdog: &Watchdog, post: &Post, now: Duration) -> Report {
        let ability = self.sink.ability();
        self.feel.tear(post.tear);
        let felt = match self.sink.stick_position() {
            Ok(aim) => {
                let lean = (aim, ability);
                self.feel
                    .step(watchdog, &post.mail, lean, &post.settings, now)
            }
            Err(_) => self.feel.rest(ability, Stop::Unplugged),
        };
        let felt = self.tell(felt, now);
        Report {
            ability,
            output: felt.output,
            newtons: felt.newtons,
            silent: felt.silent,
        }
    }

    /// Sends an output to the device if the output has changed. Also repeats a nonzero output each `AGAIN`.
    fn tell(&mut self, felt: StepOutput, now: Duration) -> StepOutput {
        let StepOutput { output, .. } = felt;
        let is_news = output.levels() != self.told.levels();
        let is_due = now.saturating_sub(self.told_at) >= AGAIN && !output.is_zero();
        if !is_news && !is_due {
            return felt;
        }
        (self.told, self.told_at) = (output, now);
        match self.sink.play(output) {
            Ok(()) => felt,
            Err(_) => self.feel.rest(self.sink.ability(), Stop::Unplugged),
        }
    }
}

/// Releases the device: plays a zero output, also while a panic unwinds.
impl Drop for Outlet {
    fn drop(&mut self) {
        if !self.told.is_zero() {
            // Ignores the error: an unplugged device needs no release.
            let _ = self.sink.play(Output::zero(self.sink.ability()));
        }
    }
}
