//! Table of force feedback: the forces on each hand in every substep, and the output of a stick and of a pad.
//! `docs/force-log.md` describes the columns.

use crate::haptics;
use crate::settings::Settings;
use app_shell::direction::to_user;
use force_feedback::{Ability, Command, ForceController, Output, State, StickMode, Watchdog};
use fuwafuwa::{DEFAULT_TICK, Vec3};
use output::Draft;
use std::io::{self, Write};
use std::path::Path;
use std::time::Duration;
use tamaire_play::{AnyRound, PLAYERS};

/// Time between two updates of a device [s].
const PERIOD: f64 = 0.004;

/// First line of the table, with the names of the columns.
const COLUMNS: &str = "seconds,row,player,\
    contact_x_N,contact_y_N,contact_z_N,coupling_x_N,coupling_y_N,coupling_z_N,\
    aim_x,aim_y,felt_x_N,felt_y_N,stick_x,stick_y,pad_slow,pad_fast,silent";

/// Table of force feedback that grows with each tick: first the substeps of the tick, then the device updates
/// during the next tick. The simulated sticks are at the goals of the hands, as real force-feedback sticks
/// are.
pub struct ForceLog {
    /// The file, under a temporary name until the end.
    file: Draft,
    /// Rows of the current tick. They are written together, so that the file of a killed run ends with a
    /// complete tick.
    rows: Vec<u8>,
    /// Simulated stick and pad of each player.
    feels: [[ForceController; 2]; PLAYERS],
    /// Position of each stick at the end of the previous tick.
    aims: [Option<[f32; 2]>; PLAYERS],
    /// Default force settings.
    settings: force_feedback::Settings,
    /// Number of device updates since the start, one in each [`PERIOD`].
    updates: u64,
    /// First write error, if any. Nothing is written after this error.
    written: io::Result<()>,
}

impl ForceLog {
    /// Starts a file with an empty table. Until [`ForceLog::finish`], the file has a temporary name.
    pub fn create(path: &Path) -> io::Result<Self> {
        let mut file = Draft::begin(path)?;
        writeln!(file, "{COLUMNS}")?;
        Ok(Self {
            file,
            rows: Vec::new(),
            feels: Default::default(),
            aims: Default::default(),
            settings: Settings::default().force("").unwrap_or_default(),
            updates: 0,
            written: Ok(()),
        })
    }

    /// Adds the last tick of a round, and the device updates during the next tick.
    pub fn note(&mut self, round: &AnyRound) {
        if self.written.is_ok() {
            self.written = self.write(round);
            self.rows.clear();
        }
    }

    /// Gives the file its name, or returns the first write error, if any.
    pub fn finish(self) -> io::Result<()> {
        self.written?;
        self.file.keep()
    }

    fn write(&mut self, round: &AnyRound) -> io::Result<()> {
        self.collect(round)?;
        self.file.write_all(&self.rows)?;
        self.file.flush()
    }

    fn collect(&mut self, round: &AnyRound) -> io::Result<()> {
        let hands = round.hands();
        let tick = f64::from(DEFAULT_TICK);
        let end = round.ticks() as f64 * tick;
        let count = hands.iter().map(|hand| hand.reactions.len()).max();
        let count = count.unwrap_or(0);
        for substep in 0..count {
            let seconds = end - tick * (1.0 - (substep + 1) as f64 / count as f64);
            for (player, hand) in hands.iter().enumerate() {
                let Some(reaction) = hand.reactions.get(substep) else {
                    continue;
                };
                let contact = numbers(reaction.contact.as_ref());
                let coupling = numbers(reaction.coupling.as_ref());
                writeln!(
                    self.rows,
                    "{seconds:.6},substep,{player},{contact},{coupling},,,,,,,,,"
                )?;
            }
        }
        let tears = haptics::tears(round);
        for (feels, size) in self.feels.iter_mut().zip(tears) {
            feels.iter_mut().for_each(|feel| feel.tear(size));
        }
        let before = self.aims;
        for (aim, hand) in self.aims.iter_mut().zip(&hands) {
            *aim = Some(aim_at(hand.target, round));
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
            for (player, before) in before.iter().enumerate().take(hands.len()) {
                // The stick moves evenly from its previous to its new position during the tick.
                let share = ((seconds - end) / tick) as f32;
                let now = self.aims[player].unwrap_or_default();
                let before = before.unwrap_or(now);
                let aim = [0, 1].map(|axis| before[axis] + share * (now[axis] - before[axis]));
                self.update(round, player, aim, seconds, end)?;
            }
        }
    }

    /// Adds an update of the devices of a player, `seconds` after the start of the round. `end` is the end of
    /// the last tick [s], when the devices got their last command.
    fn update(
        &mut self,
        round: &AnyRound,
        player: usize,
        aim: [f32; 2],
        seconds: f64,
        end: f64,
    ) -> io::Result<()> {
        let hand = &round.hands()[player];
        let contact = haptics::contact(hand);
        let state = State {
            contact: to_user(turn(round), contact),
            manner: StickMode::Position,
        };
        let mail = Command {
            wish: haptics::silence(round).map_or(Ok(state), Err),
            at: Duration::from_secs_f64(end),
        };
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
        let both = |output| match output {
            Output::Force(both) => both,
            Output::Rumble { low, high } => [low, high],
        };
        let (contact, aim) = (numbers(contact.as_ref()), numbers(&aim));
        let felt = numbers(&stick.newtons);
        let (pushed, shaken) = (numbers(&both(stick.output)), numbers(&both(pad.output)));
        let silent = stick.silent.map_or(String::new(), |why| why.to_string());
        writeln!(
            self.rows,
            "{seconds:.6},device,{player},{contact},,,,{aim},{felt},{pushed},{shaken},{silent}"
        )
    }
}

/// Joins numbers with commas, rounded to five decimal places.
fn numbers(all: &[f32]) -> String {
    let rounded = all
        .iter()
        .map(|k| (1e5 * f64::from(*k)).round() / 1e5 + 0.0);
    rounded.map(|k| k.to_string()).collect::<Vec<_>>().join(",")
}

/// Rotation of the camera for the conversion of forces [rad]: 0 (from the front) in 3D, `None` in 2D.
fn turn(round: &AnyRound) -> Option<f32> {
    matches!(round, AnyRound::Space(_)).then_some(0.0)
}

/// Returns the stick position (right, up; -1 to 1) for a position in the arena [m].
fn aim_at(position: Vec3, round: &AnyRound) -> [f32; 2] {
    let [low, high] = round.level().arena();
    let middle = 0.5 * (low + high);
    let half = 0.5 * (high - low);
    let share = (position - middle) / half.max(Vec3::splat(1e-3));
    to_user(turn(round), share)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Arc;
    use tamaire_play::{InputFrame, Level};

    #[test]
    fn file_contains_whole_ticks_after_each_tick() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("forces.csv");
        let mut log = ForceLog::create(&path).unwrap();
        let mut round = AnyRound::new(Arc::new(Level::open("classic").unwrap()));
        for tick in 1..=3 {
            round.step(InputFrame::default());
            log.note(&round);
            // The table is read before `finish`, as if the program were killed now.
            let mut files = std::fs::read_dir(folder.path()).unwrap();
            let part = files.next().unwrap().unwrap();
            let name = part.file_name().into_string().unwrap();
            assert!(name.starts_with("forces.csv.") && name.ends_with(".part"));
            let table = std::fs::read_to_string(part.path()).unwrap();
            let last = format!(
                "\n{:.6},substep,0,",
                f64::from(tick) * f64::from(DEFAULT_TICK)
            );
            assert!(table.contains(&last), "tick {tick}: {table}");
            let commas = COLUMNS.matches(',').count();
            let is_whole = |line: &str| line.matches(',').count() == commas;
            assert!(table.ends_with('\n') && table.lines().all(is_whole));
        }
        log.finish().unwrap();
        assert!(path.is_file());
    }
}
