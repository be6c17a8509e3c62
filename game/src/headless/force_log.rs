//! What a round would be felt like: the forces on each hand in every substep, and what a stick and a pad would be told.

use crate::felt;
use crate::settings::Settings;
use force_feedback::{Ability, Feel, Mail, Manner, Output, State, Watchdog};
use fuwafuwa::Vector;
use fuwafuwa::world::TICK;
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;
use std::time::Duration;
use tamaire_play::{AnyRound, PLAYERS};

/// From one update of a device to the next [s].
const PERIOD: f64 = 0.004;

/// The first line: what stands below it.
const COLUMNS: &str = "seconds,row,player,\
    contact_x_N,contact_y_N,contact_z_N,coupling_x_N,coupling_y_N,coupling_z_N,\
    aim_x,aim_y,felt_x_N,felt_y_N,stick_x,stick_y,pad_slow,pad_fast,silent";

/// A table that grows tick by tick: the substeps of a tick, then the updates from its end to that of the next. Sticks in it
/// point at the goals of the hands, as those do that push back.
pub struct ForceLog {
    file: BufWriter<File>,
    /// Each player's stick and pad.
    feels: [[Feel; 2]; PLAYERS],
    /// As a new player finds them.
    settings: force_feedback::Settings,
    /// Updates so far.
    updates: u64,
    /// The first thing that could not be written.
    written: io::Result<()>,
}

impl ForceLog {
    /// An empty table in a new file.
    pub fn create(path: &Path) -> io::Result<Self> {
        let mut file = BufWriter::new(File::create(path)?);
        writeln!(file, "{COLUMNS}")?;
        Ok(Self {
            file,
            feels: Default::default(),
            settings: Settings::default().force("").unwrap_or_default(),
            updates: 0,
            written: Ok(()),
        })
    }

    /// Adds the last tick of a round, and the updates from its end to that of the next.
    pub fn note(&mut self, round: &AnyRound) {
        if self.written.is_ok() {
            self.written = self.write(round);
        }
    }

    /// Whether all of it is in the file.
    pub fn finish(mut self) -> io::Result<()> {
        self.written?;
        self.file.flush()
    }

    fn write(&mut self, round: &AnyRound) -> io::Result<()> {
        let hands = round.hands();
        let tick = f64::from(TICK);
        let end = round.ticks() as f64 * tick;
        let count = hands.iter().map(|hand| hand.reactions().len()).max();
        let count = count.unwrap_or(0);
        for substep in 0..count {
            let seconds = end - tick * (1.0 - (substep + 1) as f64 / count as f64);
            for (player, hand) in hands.iter().enumerate() {
                let Some(reaction) = hand.reactions().get(substep) else {
                    continue;
                };
                let [x, y, z] = reaction.contact;
                let [u, v, w] = reaction.coupling;
                let row = format!("{seconds:.6},substep,{player},{x},{y},{z},{u},{v},{w},,,,,,,,,");
                writeln!(self.file, "{row}")?;
            }
        }
        let tears = felt::tears(round);
        for (feels, size) in self.feels.iter_mut().zip(tears) {
            feels.iter_mut().for_each(|feel| feel.tear(size));
        }
        loop {
            let seconds = self.updates as f64 * PERIOD;
            if seconds >= end + tick {
                return Ok(());
            }
            self.updates += 1;
            if seconds < end {
                continue;
            }
            for player in 0..hands.len().min(PLAYERS) {
                self.update(round, player, seconds, end)?;
            }
        }
    }

    /// One update of one player's devices, `seconds` after the start, when the game said something last at `end`.
    fn update(
        &mut self,
        round: &AnyRound,
        player: usize,
        seconds: f64,
        end: f64,
    ) -> io::Result<()> {
        let hand = &round.hands()[player];
        let [x, y, z] = felt::contact(hand);
        let state = State {
            contact: [x, y],
            manner: Manner::Places,
        };
        let mail = Mail {
            wish: felt::silence(round).map_or(Ok(state), Err),
            at: Duration::from_secs_f64(end),
        };
        let aim = aim_at(hand.goal(), round.level().arena());
        let watchdog = Watchdog::default();
        let now = Duration::from_secs_f64(seconds);
        let [stick, pad] = &mut self.feels[player];
        let stick = stick.step(&watchdog, &mail, (aim, Ability::Force), &self.settings, now);
        let pad = pad.step(
            &watchdog,
            &mail,
            (aim, Ability::Rumble),
            &self.settings,
            now,
        );
        let pair = |output| match output {
            Output::Force([x, y]) => (x, y),
            Output::Rumble { low, high } => (low, high),
        };
        let ([u, v], [felt_x, felt_y]) = (aim, stick.newtons);
        let ((right, up), (slow, fast)) = (pair(stick.output), pair(pad.output));
        let silent = stick.silent.map_or(String::new(), |why| why.to_string());
        writeln!(
            self.file,
            "{seconds:.6},device,{player},{x},{y},{z},,,,\
             {u},{v},{felt_x},{felt_y},{right},{up},{slow},{fast},{silent}"
        )
    }
}

/// Where a stick points that points at a place in the arena [m].
fn aim_at(place: Vector, [low, high]: [Vector; 2]) -> [f32; 2] {
    [0, 1].map(|axis| {
        let middle = 0.5 * (low[axis] + high[axis]);
        (place[axis] - middle) / (0.5 * (high[axis] - low[axis]))
    })
}
