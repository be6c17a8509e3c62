//! The game in a window for a long time: two players who do anything, on every level, through all screens, with files
//! that are dropped and a window that is pulled about. Its clock stands ten days ahead at the start. It tells each minute
//! how it goes, and fails when its memory grows.
//!
//! ```text
//! xvfb-run -a cargo run --release -p tamaire --example window_soak -- 60
//! ```

use egui::{DroppedFile, Event, Key, Modifiers, PointerButton, RawInput, ViewportCommand, pos2};
use std::cell::Cell;
use std::path::{Path, PathBuf};

use std::process::ExitCode;
use std::rc::Rc;
use std::sync::Arc;
use std::time::Instant;
use sticks::{About, Device, DeviceId, Labels, Pad, PadButton, Snapshot};
use tamaire::app::App;
use tamaire::game::{Game, Screen};
use tamaire::input::{Action, Seat};
use tamaire::platform::{Files, Pads, Sound};

/// How far the clock of the game is ahead [s].
const AHEAD: f64 = 10.0 * 86_400.0;
/// Memory settles for so many minutes, and may grow by such a share afterwards.
const SETTLED: usize = 5;
const GROWTH: f64 = 0.05;
/// Keys that a hand on a keyboard finds.
const KEYS: [Key; 16] = [
    Key::ArrowUp,
    Key::ArrowDown,
    Key::ArrowLeft,
    Key::ArrowRight,
    Key::Enter,
    Key::Space,
    Key::Tab,
    Key::Escape,
    Key::R,
    Key::E,
    Key::F,
    Key::Period,
    Key::J,
    Key::Q,
    Key::Z,
    Key::X,
];

/// A file that is dropped.
type AnyFile = Arc<dyn DroppedFile + Send + Sync>;

/// The game, and whoever plays it.
struct Soak {
    app: App,
    random: fastrand::Rng,
    files: Vec<AnyFile>,
    pad: Device,
    began: Instant,
    frames: u64,
    /// Memory after each minute [MB].
    memory: Vec<f64>,
    minutes: usize,
    /// By what share it grew after it had settled.
    growth: Rc<Cell<f64>>,
    level: usize,
}

/// A file as a window tells of it.
#[derive(Debug)]
struct Dropped(PathBuf);

impl DroppedFile for Dropped {
    fn path(&self) -> &Path {
        &self.0
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        std::fs::read(&self.0).map_err(|error| error.to_string())
    }
}

impl Soak {
    /// What somebody does in a frame.
    fn play(&mut self, input: &mut RawInput) {
        let random = &mut self.random;
        let size = input
            .screen_rect
            .map_or(egui::vec2(900.0, 600.0), |rect| rect.size());
        let at = pos2(size.x * random.f32(), size.y * random.f32());
        match random.u32(..40) {
            0..8 => input.events.push(Event::PointerMoved(at)),
            8 => {
                input.events.push(Event::PointerMoved(at));
                for pressed in [true, false] {
                    input.events.push(Event::PointerButton {
                        pos: at,
                        button: PointerButton::Primary,
                        pressed,
                        modifiers: Modifiers::NONE,
                    });
                }
            }
            9..12 => {
                let key = KEYS[random.usize(..KEYS.len())];
                for pressed in [true, false] {
                    input.events.push(Event::Key {
                        key,
                        physical_key: None,
                        pressed,
                        repeat: false,
                        modifiers: Modifiers::NONE,
                    });
                }
            }
            12..16 => {
                let pad = self.pad.pad.get_or_insert_default();
                pad.left = [2.0 * random.f32() - 1.0, 2.0 * random.f32() - 1.0];
                pad.triggers = [random.f32(), random.f32()];
            }
            16 => {
                let button = PadButton::ALL[random.usize(..PadButton::ALL.len())];
                let pad = self.pad.pad.get_or_insert_default();
                pad.button_mut(button).press();
                pad.button_mut(button).down = false;
            }
            _ => {}
        }
        if random.u32(..1200) == 0 {
            let file = &self.files[random.usize(..self.files.len())];
            input.dropped_files.push(file.clone());
        }
    }

    /// What happens now and then.
    fn manage(&mut self, ctx: &egui::Context) {
        let game = &mut self.app.game;
        let mut plugged = vec![self.pad.clone()];
        // It is unplugged for a while each minute.
        plugged.retain(|_| !self.began.elapsed().as_secs().is_multiple_of(60));
        game.controls.pads = Pads::of(Snapshot { devices: plugged });
        if self.frames % 400 == 399 {
            match self.random.u32(..12) {
                0 => game.go(Screen::Title),
                1 => game.go(Screen::Replays),
                2 => game.go(Screen::Settings),
                3 => game.keep_replay(),
                4 => game.keep_clip(),
                _ => {
                    self.level = (self.level + 1) % game.levels.len();
                    game.start(self.level);
                    game.act(Action::Join, Seat::Stick(self.pad.id));
                }
            }
            // Somebody tidies up: what is kept is no leak.
            let old: Vec<_> = game
                .shelf
                .iter()
                .skip(8)
                .map(|kept| kept.entry.clone())
                .collect();
            old.iter().for_each(|entry| game.delete(entry));
            while game.levels.len() > 20 {
                game.take_out(game.levels.len() - 1);
            }
        }
        if self.random.u32(..900) == 0 {
            let size = egui::vec2(
                640.0 + 400.0 * self.random.f32(),
                400.0 + 300.0 * self.random.f32(),
            );
            ctx.send_viewport_cmd(ViewportCommand::InnerSize(size));
        }
        let minute = self.began.elapsed().as_secs() as usize / 60;
        if minute > self.memory.len() {
            let memory = resident().unwrap_or_default();
            println!(
                "{minute:3} min: {memory:6.1} MB, {} frames, clock {:.0} s, {} own levels, {:?}",
                self.frames,
                game.time,
                (0..game.levels.len())
                    .filter(|&place| game.is_own(place))
                    .count(),
                game.screen()
            );
            self.memory.push(memory);
        }
        if minute >= self.minutes {
            ctx.send_viewport_cmd(ViewportCommand::Close);
        } else if ctx.input(|input| input.viewport().close_requested()) {
            // Somebody pressed Quit.
            ctx.send_viewport_cmd(ViewportCommand::CancelClose);
        }
    }
}

impl eframe::App for Soak {
    fn raw_input_hook(&mut self, _: &egui::Context, input: &mut RawInput) {
        self.play(input);
    }

    fn ui(&mut self, ui: &mut egui::Ui, frame: &mut eframe::Frame) {
        self.manage(&ui.ctx().clone());
        self.app.ui(ui, frame);
        self.frames += 1;
    }

    fn on_exit(&mut self) {
        self.app.on_exit();
        if let (Some(settled), Some(last)) = (self.memory.get(SETTLED), self.memory.last()) {
            self.growth.set(last / settled - 1.0);
        }
    }
}

/// Memory of this program [MB], where the system tells.
fn resident() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmRSS:"))?;
    let kilobytes: f64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(kilobytes / 1000.0)
}

/// Files that somebody may drop: two levels, a picture, a model, and one that is nothing.
fn files(folder: &Path) -> std::io::Result<Vec<AnyFile>> {
    let levels = Path::new(env!("CARGO_MANIFEST_DIR")).join("../crates/tamaire_play/levels");
    let broken = folder.join("broken.toml");
    std::fs::write(&broken, "dim = 7\n")?;
    let named = ["classic.toml", "hoop.toml", "cat.png", "pudding.vox"];
    let paths = named.iter().map(|name| levels.join(name)).chain([broken]);
    Ok(paths
        .map(|path| Arc::new(Dropped(path)) as AnyFile)
        .collect())
}

fn main() -> ExitCode {
    let minutes = std::env::args().nth(1).and_then(|word| word.parse().ok());
    let minutes = minutes.unwrap_or(60);
    let growth = Rc::new(Cell::new(f64::NAN));
    let told = growth.clone();
    let folder = tempfile::tempdir().expect("there is a place for files");
    let files = files(folder.path()).expect("there is a place for files");
    let kept = folder.path().join("kept");
    let about = About {
        name: "Pad".into(),
        guid: "pad".into(),
        labels: Labels::Letters,
    };
    let mut pad = Device::at_rest(DeviceId(1), about, 6, 0, 0);
    pad.pad = Some(Pad::default());
    let options = eframe::NativeOptions {
        viewport: egui::ViewportBuilder::default().with_inner_size([800.0, 500.0]),
        ..Default::default()
    };
    let ended = eframe::run_native(
        "tamaire, for a long time",
        options,
        Box::new(move |context| {
            let mut game = Game::new(Files::in_folder(kept), Sound::none(), Pads::none());
            game.time = AHEAD;
            Ok(Box::new(Soak {
                app: App::new(context, game)?,
                random: fastrand::Rng::with_seed(7),
                files,
                pad,
                began: Instant::now(),
                frames: 0,
                memory: Vec::new(),
                minutes,
                growth: told,
                level: 0,
            }))
        }),
    );
    match ended {
        Ok(()) => {
            println!(
                "memory grew by {:.1} % after it had settled",
                100.0 * growth.get()
            );
            // What was never measured is no number.
            let is_flat = growth.get() <= GROWTH;
            ExitCode::from(u8::from(!is_flat))
        }
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}
