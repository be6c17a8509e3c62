//! Who owns all sinks, a thread or where there is none the caller, and how the game speaks to it.

use crate::{Ability, Feel, Felt, Mail, Output, Settings, Sink, State, Stop, Watchdog};
use std::collections::BTreeMap;
use std::ops::RangeInclusive;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::Duration;
use web_time::Instant;

/// How often a second the devices may be updated. Slower is felt as steps; most devices take no more.
pub const RATES: RangeInclusive<u32> = 125..=250;
/// What stays the same is told again after this time, well before [`LENGTH`](crate::LENGTH) is over.
const AGAIN: Duration = Duration::from_millis(200);

/// Owns all sinks, or the thread that does. Dropping it stops everything and waits for that.
#[must_use = "nothing is felt any more when it is dropped"]
pub struct Force {
    shared: Arc<Shared>,
    thread: Option<JoinHandle<()>>,
    /// Those that no thread owns.
    outlets: Vec<Outlet>,
}

/// Leads to one device. Dropping it, as a panic does, is to let go of the device.
#[must_use = "nothing is felt any more when it is dropped"]
pub struct Line {
    shared: Arc<Shared>,
    key: u64,
}

/// What happens on a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Report {
    /// What the device can do.
    pub ability: Ability,
    /// What it plays.
    pub output: Output,
    /// What there would be to feel [N], before it is made safe.
    pub newtons: [f32; 2],
    /// Why nothing is played, if something forbids it.
    pub silent: Option<Stop>,
}

struct Shared {
    start: Instant,
    desk: Mutex<Desk>,
    news: Condvar,
}

/// What both sides read and write; locked for no longer than it takes to copy. It holds the latest of everything, and no
/// queue.
#[derive(Default)]
struct Desk {
    watchdog: Watchdog,
    posts: BTreeMap<u64, Post>,
    arrivals: Vec<Outlet>,
    next_key: u64,
    /// Something must not wait until the next update.
    is_urgent: bool,
    is_closing: bool,
    has_ended: bool,
}

/// What the game said about a device, and what came of it.
#[derive(Clone, Copy)]
struct Post {
    mail: Mail,
    tear: f32,
    settings: Settings,
    report: Report,
}

/// A device, on the thread.
struct Outlet {
    key: u64,
    sink: Box<dyn Sink>,
    feel: Feel,
    told: Output,
    told_at: Duration,
}

impl Force {
    /// Starts the thread; `rate` is how often a second it updates the devices, see [`RATES`].
    ///
    /// # Errors
    /// The system has no thread left.
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

    /// The same where there are no threads, as in a browser: devices are updated by [`Force::update`] alone.
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

    /// Updates the devices once, where no thread does.
    pub fn update(&mut self) {
        if self.thread.is_none() {
            self.shared.update(self.shared.desk(), &mut self.outlets);
        }
    }

    /// Takes a device over.
    pub fn add(&self, sink: Box<dyn Sink>, settings: Settings) -> Line {
        let report = Report {
            ability: sink.ability(),
            output: Output::zero(sink.ability()),
            newtons: [0.0; 2],
            silent: Some(Stop::Unheard),
        };
        let mut desk = self.shared.desk();
        let key = desk.next_key;
        desk.next_key += 1;
        let post = Post {
            mail: Mail::default(),
            tear: 0.0,
            settings,
            report,
        };
        desk.posts.insert(key, post);
        desk.arrivals.push(Outlet {
            key,
            sink,
            feel: Feel::default(),
            told: report.output,
            told_at: Duration::ZERO,
        });
        Line {
            shared: self.shared.clone(),
            key,
        }
    }

    /// Stops all devices, until the next state is told to each.
    pub fn stop(&self, why: Stop) {
        let mail = self.shared.mail(Err(why));
        let mut desk = self.shared.desk();
        for post in desk.posts.values_mut() {
            post.mail = mail;
        }
        self.shared.hurry(desk);
    }

    /// Stops all devices, whatever is told to them, until [`Force::release`].
    pub fn emergency_stop(&self) {
        let mut desk = self.shared.desk();
        desk.watchdog.latch();
        self.shared.hurry(desk);
    }

    /// Ends an emergency stop. What was told during it is forgotten.
    pub fn release(&self) {
        let mut desk = self.shared.desk();
        desk.watchdog.release();
        for post in desk.posts.values_mut() {
            post.mail = Mail::default();
        }
    }
}

impl Drop for Force {
    fn drop(&mut self) {
        let mut desk = self.shared.desk();
        desk.is_closing = true;
        self.shared.hurry(desk);
        if let Some(thread) = self.thread.take() {
            // If it panicked, it said so, and the sinks are at zero.
            let _ = thread.join();
        }
    }
}

impl Line {
    /// What there is to feel now. Say it after each step of the simulation.
    pub fn feel(&self, state: State) {
        let mail = self.shared.mail(Ok(state));
        self.post(|post| post.mail = mail);
    }

    /// Something tore; 1 is as large as a tear gets.
    pub fn tear(&self, size: f32) {
        self.post(|post| post.tear = post.tear.max(size));
    }

    /// Stops this device until the next state is told. To say it again costs next to nothing.
    pub fn stop(&self, why: Stop) {
        let mail = self.shared.mail(Err(why));
        let before = self.post(|post| std::mem::replace(&mut post.mail, mail));
        if before.wish != mail.wish {
            self.shared.hurry(self.shared.desk());
        }
    }

    /// Goes on with other settings.
    pub fn set(&self, settings: Settings) {
        self.post(|post| post.settings = settings);
    }

    /// What happens, as of the last update.
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
        act(post.expect("a line takes its post away when it is dropped, and nobody else does"))
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
    fn desk(&self) -> MutexGuard<'_, Desk> {
        self.desk.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn mail(&self, wish: Result<State, Stop>) -> Mail {
        let at = self.start.elapsed();
        Mail { wish, at }
    }

    /// Has the thread look at once.
    fn hurry(&self, mut desk: MutexGuard<'_, Desk>) {
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
            // What was missed is not made up for.
            next = (next + period).max(now);
        }
    }

    /// Updates all devices, as of now.
    fn update(&self, mut desk: MutexGuard<'_, Desk>, outlets: &mut Vec<Outlet>) -> Duration {
        desk.is_urgent = false;
        outlets.append(&mut desk.arrivals);
        let watchdog = desk.watchdog;
        // A post that has gone leaves a stop behind, and its outlet is dropped outside the lock.
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

/// Tells the lines that nobody plays any more, however the thread ends.
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
        let felt = match self.sink.aim() {
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

    /// Tells the device, if it is news or the last was long ago. Nothing need not be told twice.
    fn tell(&mut self, felt: Felt, now: Duration) -> Felt {
        let Felt { output, .. } = felt;
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

/// However it ends, by unwinding too, the device is let go.
impl Drop for Outlet {
    fn drop(&mut self) {
        if !self.told.is_zero() {
            // If it has gone, there is nothing to let go of.
            let _ = self.sink.play(Output::zero(self.sink.ability()));
        }
    }
}
