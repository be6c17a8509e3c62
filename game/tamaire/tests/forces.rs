//! Force output to sticks and pads, and every condition that ends it. No window is open, but the device
//! thread is real.

use app_shell::Pads;
use force_feedback::{Ability, Calibration, Output, Recording, Stop};
use fuwafuwa::{DEFAULT_TICK, Vec3};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::{Duration, Instant};
use sticks::{Device, DeviceId, DeviceInfo, Snapshot};
use tamaire::game::trial::Trial;
use tamaire::game::{Game, Screen};
use tamaire::input::{Action, InputSource};
use tamaire::platform::{Files, Sound};

/// Timeout, long enough for a busy machine.
const PATIENCE: Duration = Duration::from_secs(60);

/// Game with devices that record their output.
struct Table {
    game: Game,
    devices: Vec<Device>,
    notes: Vec<Recording>,
}

impl Table {
    fn with(count: u32) -> Self {
        let devices: Vec<Device> = (0..count).map(stick).collect();
        let notes = devices.iter().map(|_| Recording::default()).collect();
        let mut table = Self {
            game: Game::new(Files::nowhere(), Sound::none(), Pads::none()),
            devices,
            notes,
        };
        table.plug_in();
        table
    }

    /// Connects exactly the devices in `devices`.
    fn plug_in(&mut self) {
        let devices = self.devices.clone();
        for (device, note) in devices.iter().zip(&self.notes) {
            note.lean(Ok(device.aim()));
        }
        let notes = devices.iter().map(|device| device.id);
        let notes = notes.zip(self.notes.iter().cloned()).collect();
        self.game.controls.pads = Pads::of(Snapshot { devices }).noting(notes);
    }

    /// Sets the deflection of a stick to the right, −1 to 1.
    fn lean(&mut self, stick: usize, right: f32) {
        self.devices[stick].axes[0] = right;
        self.plug_in();
    }

    fn frame(&mut self) {
        std::thread::sleep(Duration::from_millis(4));
        self.game.hear_sticks();
        self.game.update(DEFAULT_TICK);
    }

    /// Runs frames until a condition holds.
    fn until(&mut self, what: &str, mut is_so: impl FnMut(&mut Self) -> bool) {
        let start = Instant::now();
        while !is_so(self) {
            assert!(start.elapsed() < PATIENCE, "never {what}");
            self.frame();
        }
    }

    /// Returns the last output to a stick since the previous call.
    fn told(&self, stick: usize) -> Option<Output> {
        self.notes[stick].take().last().map(|played| played.output)
    }

    /// Moves a stick slowly from left to right across the body until it is pushed, repeatedly if necessary.
    fn until_pushed(&mut self, stick: usize) {
        self.until_pushed_along(stick, |share| [0.8 * share - 0.6, 0.0]);
    }

    fn until_pushed_along(&mut self, stick: usize, way: fn(f32) -> [f32; 2]) {
        let mut frame = 0;
        self.until("pushed", |table| {
            frame += 1;
            let [x, y] = way(frame as f32 / 60.0 % 1.0);
            table.devices[stick].axes = vec![x, -y];
            table.plug_in();
            table.told(stick).is_some_and(|output| !output.is_zero())
        });
    }

    fn until_let_go(&mut self, stick: usize) {
        self.until("let go", |table| {
            table.told(stick).is_some_and(|output| output.is_zero())
        });
    }

    /// Waits until the device thread reports no force on the first stick.
    fn until_at_rest(&mut self) {
        self.until("let go", |table| {
            let report = table.game.forces.report(table.devices[0].id);
            report.is_some_and(|report| report.output.is_zero())
        });
    }

    /// Waits until the force on the first stick is zero, without running frames. Returns the time since
    /// `start`.
    fn zero_since(&self, start: Instant) -> Duration {
        while !self.told(0).is_some_and(|output| output.is_zero()) {
            assert!(start.elapsed() < PATIENCE, "the force never ended");
            std::thread::yield_now();
        }
        start.elapsed()
    }

    /// Checks that a stick gets no output for 60 frames.
    fn hears_nothing(&mut self, stick: usize) {
        self.notes[stick].take();
        for _frame in 0..60 {
            self.frame();
        }
        assert_eq!(self.told(stick), None);
    }

    fn silent(&self, stick: usize) -> Option<Stop> {
        let report = self.game.forces.report(self.devices[stick].id);
        report.expect("the device is open").silent
    }

    /// Starts the first level and pushes the hand against the body.
    fn pushing() -> Self {
        let mut table = Self::with(1);
        table.game.start(0);
        table.until_pushed(0);
        assert_eq!(table.silent(0), None);
        table
    }
}

fn stick(id: u32) -> Device {
    let about = DeviceInfo {
        name: "Stick".into(),
        guid: format!("{id:032}"),
        ..DeviceInfo::default()
    };
    Device::at_rest(DeviceId(id), about, 2, 12, 1)
}

#[test]
fn stick_is_pushed_back_by_body() {
    let mut table = Table::with(1);
    table.game.start(0);
    table.hears_nothing(0);
    // The stick sets the position of the hand. Beyond the body's surface, the stick is pushed back more the
    // further it goes. On a busy machine the device thread may miss a whole push, so the round is repeated.
    let mut frame = 0;
    table.until("pushed to the left", |table| {
        if frame == 100 {
            table.game.start(0);
            frame = 0;
        }
        table.lean(0, 0.01 * frame as f32 - 0.8);
        frame += 1;
        match table.told(0) {
            Some(Output::Force([x, y])) => {
                assert!((-0.9..=0.01).contains(&x) && y.abs() <= 0.9, "{x} {y}");
                x < -0.02
            }
            _ => false,
        }
    });
}

#[test]
fn stick_force_3d_follows_camera_orientation() {
    // The ball is behind the hand. Seen from the front, the hand pushes away from the player and is pushed
    // towards the player; seen from the right, it pushes to the right and is pushed to the left.
    for (turn, axis) in [(0.0, 1), (std::f32::consts::FRAC_PI_2, 0)] {
        let mut table = Table::with(1);
        let mut levels = table.game.levels.iter();
        let classic = levels.position(|level| level.id == "classic-3d");
        table.game.start(classic.expect("the level is built in"));
        table.game.bout.camera.orbit(turn, 0.0);
        let mut share = 0.0;
        table.until("pushed back", |table| {
            // The hand glides to the stick's position first.
            let begins = table.game.controls.players.is_picked_up(0) && share < 1.0;
            share += if begins { 0.01 } else { 0.0 };
            // Path of the hand from in front of the ball to the ball's centre [m], and the deflection of the
            // stick that moves the hand there.
            let [x, z] = [-0.6, 0.7 - 1.1 * share];
            let [right, away]: [f32; 2] = [[-z, -x / 1.6], [x / 1.6, -z]][axis];
            let long = right.hypot(away);
            // Compensates the dead zone of the stick.
            let more = (0.15 + 0.8 * long) / long;
            table.devices[0].axes = vec![more * right, -more * away];
            table.plug_in();
            match table.told(0) {
                Some(Output::Force(force)) => {
                    force[axis] < -0.05 && force[axis].abs() > 2.0 * force[1 - axis].abs()
                }
                _ => false,
            }
        });
    }
}

#[test]
fn force_ends_on_pause_menu_new_round_and_lost_focus() {
    type Way = fn(&mut Game);
    let ways: [(Way, Stop); 5] = [
        (
            |game| game.act(Action::Pause, InputSource::Keys),
            Stop::Paused,
        ),
        (|game| game.go(Screen::Title), Stop::Menu),
        (|game| game.start(0), Stop::Reset),
        (|game| game.is_away = true, Stop::FocusLost),
        (
            |game| game.act(Action::Step, InputSource::Keys),
            Stop::Paused,
        ),
    ];
    for (way, reason) in ways {
        check_quick(|| {
            let mut table = Table::pushing();
            let start = Instant::now();
            way(&mut table.game);
            table.game.update(0.0);
            assert_eq!(table.silent(0), Some(reason));
            table.zero_since(start)
        });
    }
}

/// Checks that a force ends within 20 ms in at least one of 20 tries. A busy machine may delay the other
/// tries.
fn check_quick(mut once: impl FnMut() -> Duration) {
    let most = Duration::from_millis(20);
    let quick = (0..20).map(|_| once()).find(|time| *time <= most);
    assert!(quick.is_some(), "the force never ended within {most:?}");
}

#[test]
fn force_ends_on_win() {
    let mut table = Table::with(1);
    table.game.start(0);
    let mut pushed = false;
    let bot = tamaire_play::BotKind::NAMED[0].1;
    let mut bot = tamaire_play::Bot::new(bot, 1);
    table.until("won", |table| {
        // The bot plays with the stick, whose position sets the position of the hand.
        pushed |= table.told(0).is_some_and(|output| !output.is_zero());
        let round = table.game.bout.round();
        let [low, high] = round.level().arena();
        let goal = round.ask(&mut bot).goal(0).expect("the bot has a target");
        let middle = 0.5 * (low + high);
        let Vec3 { x, y, .. } = (goal - middle) / (0.5 * (high - low));
        // Compensates the dead zone of the stick.
        let lean = x.hypot(y).max(1e-3);
        let share = (0.15 + 0.8 * lean) / lean;
        table.devices[0].axes = vec![share * x, -share * y];
        table.plug_in();
        table.game.bout.round().progress().outcome.is_some()
    });
    assert!(pushed);
    assert_eq!(table.silent(0), Some(Stop::Won));
    table.until_at_rest();
    table.hears_nothing(0);
}

#[test]
fn force_ends_and_round_pauses_when_stick_is_unplugged() {
    let mut table = Table::pushing();
    let note = table.notes[0].clone();
    let device = table.devices.remove(0);
    table.plug_in();
    table.frame();
    assert_eq!(table.game.screen(), Screen::Paused);
    assert_eq!(table.game.forces.report(device.id), None);
    table.until("let go", |_| {
        let told = note.take().last().map(|played| played.output);
        told.is_some_and(|output| output.is_zero())
    });
    // A reconnected device gets another id and continues to play.
    table.devices.push(stick(7));
    table.notes = vec![Recording::default()];
    table.plug_in();
    table.frame();
    table.game.go(Screen::Play);
    table.until_pushed(0);
}

#[test]
fn force_ends_when_game_panics_or_closes() {
    let mut table = Table::pushing();
    let note = table.notes[0].clone();
    let panicked = catch_unwind(AssertUnwindSafe(move || {
        table.frame();
        panic!("on purpose");
    }));
    assert!(panicked.is_err());
    let last = note.take().last().map(|played| played.output);
    assert!(last.is_some_and(|output| output.is_zero()), "{last:?}");

    let mut table = Table::pushing();
    let note = table.notes[0].clone();
    table.frame();
    drop(table);
    let last = note.take().last().map(|played| played.output);
    assert!(last.is_some_and(|output| output.is_zero()), "{last:?}");
}

#[test]
fn emergency_key_cuts_force_until_restored() {
    let mut table = Table::pushing();
    table.game.act(Action::CutForces, InputSource::Keys);
    table.until_let_go(0);
    table.hears_nothing(0);
    assert!(table.game.forces.is_cut() && table.game.notices.iter().next().is_some());
    // A new round does not restore the force.
    table.game.start(0);
    table.hears_nothing(0);
    table.game.forces.restore();
    table.until_pushed(0);
}

#[test]
fn zero_strength_opens_no_device_and_sends_nothing() {
    let mut table = Table::with(1);
    table.game.settings.haptics = 0.0;
    table.game.start(0);
    table.lean(0, 0.2);
    table.hears_nothing(0);
    assert_eq!(table.game.forces.report(table.devices[0].id), None);
    table.game.settings.haptics = 0.5;
    table.until_pushed(0);
    table.game.settings.haptics = 0.0;
    table.frame();
    table.until_let_go(0);
}

#[test]
fn force_of_each_hand_goes_to_its_player() {
    let mut table = Table::with(2);
    table.game.start(0);
    table
        .game
        .act(Action::Join, InputSource::Stick(DeviceId(1)));
    // The second hand stays at its start position, far above the body, so its stick gets no force.
    table.until_pushed(0);
    assert_eq!(table.told(1), None);
    // The second hand pushes into the body from above.
    table.until_pushed_along(1, |share| [-0.35, 0.9 - 0.8 * share]);
}

#[test]
fn unused_stick_gets_no_force() {
    let mut table = Table::pushing();
    table.game.controls.devices.keys.insert(egui::Key::D);
    table.lean(0, 0.0);
    table.until("left alone", |table| table.silent(0) == Some(Stop::Idle));
    table.until_at_rest();
    table.hears_nothing(0);
}

#[test]
fn unused_pad_stops_rumbling_while_hand_presses() {
    let mut table = Table::with(1);
    table.notes = vec![Recording::new(Ability::Rumble)];
    table.game.start(0);
    table.lean(0, 1.0);
    // Plays until the hand has pushed the body against the far wall.
    let mut hummed = false;
    table.until("pushed", |table| {
        hummed |= table.told(0).is_some_and(|output| !output.is_zero());
        table.game.bout.round().ticks() > 150
    });
    assert!(hummed);
    table.lean(0, 0.0);
    table.until("left alone", |table| table.silent(0) == Some(Stop::Idle));
    table.until_at_rest();
    let hand = &table.game.bout.round().hands()[0];
    let Vec3 { x, y, .. } = tamaire::haptics::contact(hand);
    assert!(x.hypot(y) > 10.0, "{x} {y}");
    table.hears_nothing(0);
}

#[test]
fn pad_rumbles_low_when_pushing_and_high_when_tearing() {
    let mut table = Table::with(1);
    table.notes = vec![Recording::new(Ability::Rumble)];
    table.game.start(0);
    table.lean(0, 1.0);
    let (mut hummed, mut rattled) = (false, false);
    table.until("torn", |table| {
        // The stick moves back and forth at full deflection.
        let to_and_fro = table.game.bout.round().ticks() / 20 % 3;
        table.lean(0, if to_and_fro == 2 { -1.0 } else { 1.0 });
        for played in table.notes[0].take() {
            let Output::Rumble { low, high } = played.output else {
                panic!("the device is a pad")
            };
            hummed |= low > 0.1;
            rattled |= high > 0.1;
        }
        hummed && rattled
    });
}

#[test]
fn stick_can_be_tried_and_measured() {
    let mut table = Table::with(1);
    table.game.go(Screen::Forces);
    table.lean(0, 0.5);
    table.hears_nothing(0);
    table.game.trial = Some(Trial::spring(DeviceId(0)));
    table.until_pushed(0);
    table.game.go(Screen::Title);
    table.until_let_go(0);
    assert!(table.game.trial.is_none());

    // A measurement stops when forces are switched off.
    table.game.go(Screen::Forces);
    table.game.trial = Some(Trial::measure(DeviceId(0)));
    table.frame();
    table.game.settings.haptics = 0.0;
    (0..2).for_each(|_| table.frame());
    assert!(table.game.trial.is_none());
    table.game.settings.haptics = 0.5;
    table.frame();

    // The simulated stick has swapped and reversed motors, and moves as it is pushed.
    table.game.go(Screen::Forces);
    table.lean(0, 0.0);
    table.game.trial = Some(Trial::measure(DeviceId(0)));
    table.until("measured", |table| {
        if let Some(Output::Force([x, y])) = table.told(0) {
            table.devices[0].axes = vec![-y, -x];
            table.plug_in();
        }
        table.game.trial.is_none()
    });
    let guid = &table.devices[0].about.guid.clone();
    let known = table.game.settings.calibrations.get(guid);
    let wanted = Calibration {
        swap: true,
        invert: [false, true],
        ..Calibration::IDENTITY
    };
    assert_eq!(known, Some(&wanted));
}

/// Tests the whole path through SDL with a virtual pad.
#[test]
#[cfg(feature = "haptic")]
fn virtual_pad_plays_rumbles_and_unplugs() {
    use sticks::{PadButton, Sticks};

    let sticks = Sticks::open_for_puppets().expect("SDL starts");
    let pad = sticks
        .plug_in_pad("Pad")
        .expect("the virtual pad can be plugged in");
    let mut game = Game::new(Files::nowhere(), Sound::none(), Pads::through(sticks));
    game.start(0);
    let until = |game: &mut Game, what: &str, is_so: &dyn Fn(&Game) -> bool| {
        let start = Instant::now();
        while !is_so(game) {
            assert!(start.elapsed() < PATIENCE, "never {what}");
            std::thread::sleep(Duration::from_millis(4));
            for change in game.hear_sticks() {
                if let sticks::Change::Pressed { device, control } = change
                    && let Some(action) = game.settings.bindings.of_button(control)
                {
                    game.act(action, InputSource::Stick(device));
                }
            }
            game.update(DEFAULT_TICK);
        }
    };
    assert!(pad.axis(0, 1.0));
    until(&mut game, "felt", &|_| pad.rumble()[0] > 0);
    assert!(pad.pad_button(PadButton::Start, true));
    until(&mut game, "paused", &|game| game.screen() == Screen::Paused);
    until(&mut game, "let go", &|_| pad.rumble() == [0; 2]);
    game.go(Screen::Play);
    until(&mut game, "felt again", &|_| pad.rumble()[0] > 0);
    drop(pad);
    until(&mut game, "unplugged", &|game| {
        game.screen() == Screen::Paused && game.controls.devices.sticks.devices.is_empty()
    });
}
