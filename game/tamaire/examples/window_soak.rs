//! Soak test of the game in a window: two players with random input on every level and all screens, with
//! dropped files and a changing window size.
//!
//! The game's clock starts ten days ahead. Each minute is reported. The test fails if memory or the GPU cost
//! of a frame grows.
//!
//! ```text
//! xvfb-run -a cargo run --release -p tamaire --example window_soak -- 60
//! ```

use app_shell::Pads;
use egui::epaint::Primitive;
use egui::{
    DroppedFile, Event, FullOutput, Key, Modifiers, PointerButton, RawInput, ViewportCommand, pos2,
};
use fuwafuwa_render::Cost;
use std::cell::RefCell;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::rc::Rc;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;
use sticks::{Device, DeviceId, DeviceInfo, Labels, Pad, PadButton, Snapshot};
use tamaire::app::App;
use tamaire::game::{Game, Screen};
use tamaire::input::{Action, InputSource};
use tamaire::platform::{Files, Sound};

/// Initial time of the game [s].
const AHEAD: f64 = 10.0 * 86_400.0;
/// Minimum settling time [min]. Settling also lasts until each level was started and photographed once.
const SETTLED: usize = 15;
/// Permitted growth of a measured figure after settling, as a fraction.
const GROWTH: f64 = 0.05;
/// Keys that are pressed at random.
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

/// File dropped onto the window.
type AnyFile = Arc<dyn DroppedFile + Send + Sync>;

/// Game with simulated players.
struct Soak {
    app: App,
    random: fastrand::Rng,
    files: Vec<AnyFile>,
    pad: Device,
    began: Instant,
    frames: u64,
    of_egui: OfEgui,
    figures: Rc<RefCell<[Figure; 4]>>,
    minutes: usize,
    minute: usize,
    /// Number of levels started.
    begun: usize,
}

/// Measured figure that must not grow.
#[derive(Default)]
struct Figure {
    name: &'static str,
    /// Samples of this minute.
    samples: Vec<f64>,
    /// Median of each minute since everything has settled.
    medians: Vec<f64>,
}

impl Figure {
    fn new(name: &'static str) -> Self {
        Self {
            name,
            ..Self::default()
        }
    }

    /// Ends a minute and returns the median of its samples. Stores the median if `has_settled`.
    fn pass_minute(&mut self, has_settled: bool) -> f64 {
        let median = median(std::mem::take(&mut self.samples));
        if has_settled {
            self.medians.push(median);
        }
        median
    }

    /// Relative growth of the median from the first to the last quarter of the settled time; NaN without
    /// samples.
    fn growth(&self) -> f64 {
        let quarter = self.medians.len().div_ceil(4);
        let last = self.medians.len() - quarter;
        let (first, last) = (&self.medians[..quarter], &self.medians[last..]);
        median(last.to_vec()) / median(first.to_vec()) - 1.0
    }
}

/// Returns the median; NaN without values.
fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    output::quantile(&values, 0.5).unwrap_or(f64::NAN)
}

/// GPU cost of egui in the last frame.
#[derive(Clone, Default)]
struct OfEgui(Arc<Mutex<Cost>>);

impl egui::Plugin for OfEgui {
    fn debug_name(&self) -> &'static str {
        "cost"
    }

    fn output_hook(&mut self, ctx: &egui::Context, output: &mut FullOutput) {
        let shapes = ctx.tessellate(output.shapes.clone(), output.pixels_per_point);
        let meshes = shapes.iter().filter_map(|shape| match &shape.primitive {
            Primitive::Mesh(mesh) => Some(mesh),
            Primitive::Callback(_) => None,
        });
        let meshes = meshes.map(|mesh| Cost {
            draws: 1,
            bytes: (size_of_val(&*mesh.vertices) + size_of_val(&*mesh.indices)) as u64,
        });
        let pictures = output.textures_delta.set.values().flatten();
        let pictures = pictures.map(|change| Cost {
            draws: 0,
            bytes: (change.image.width() * change.image.height() * size_of::<egui::Color32>())
                as u64,
        });
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = meshes.chain(pictures).sum();
    }
}

/// Dropped file as the window reports it.
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
    /// Adds random input in a frame.
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

    /// Samples the memory, and the cost of the last frame.
    fn measure(&mut self) {
        let of_egui = *self
            .of_egui
            .0
            .lock()
            .unwrap_or_else(PoisonError::into_inner);
        let cost: Cost = [self.app.take_cost(), of_egui].into_iter().sum();
        let [resident, used, draws, bytes] = &mut *self.figures.borrow_mut();
        if self.frames.is_multiple_of(30) {
            for (figure, memory) in [resident, used]
                .into_iter()
                .zip(memory().into_iter().flatten())
            {
                figure.samples.push(memory);
            }
        }
        draws.samples.push(cost.draws as f64);
        bytes.samples.push(cost.bytes as f64 / 1000.0);
    }

    /// Performs occasional actions that are not input events, for example changing the screen or the window
    /// size.
    fn manage(&mut self, ctx: &egui::Context) {
        let game = &mut self.app.game;
        let mut plugged = vec![self.pad.clone()];
        // The pad is unplugged for one second in each minute.
        plugged.retain(|_| !self.began.elapsed().as_secs().is_multiple_of(60));
        game.controls.pads = Pads::of(Snapshot { devices: plugged });
        if self.frames % 400 == 399 {
            let is_first = self.begun < game.levels.len();
            match if is_first { 5 } else { self.random.u32(..12) } {
                0 => game.go(Screen::Title),
                1 => game.go(Screen::Replays),
                2 => game.go(Screen::Settings),
                3 => game.keep_replay(),
                4 => game.keep_clip(),
                _ => {
                    // The first photo of a level allocates memory that later photos reuse, so it is taken
                    // while the memory settles.
                    if is_first {
                        game.keep_photo();
                    }
                    self.begun += 1;
                    game.start(self.begun % game.levels.len());
                    game.act(Action::Join, InputSource::Stick(self.pad.id));
                }
            }
            // Deletes old files, so that saved data do not count as a leak.
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
        if minute > self.minute {
            self.minute = minute;
            let has_settled = minute > SETTLED && self.begun > game.levels.len();
            let [resident, used, draws, bytes] = { self.figures.borrow_mut() }
                .each_mut()
                .map(|figure| figure.pass_minute(has_settled));
            println!(
                "{minute:3} min: {resident:6.1} MB resident, {used:.1} MB of it in use, {draws} draw calls and {bytes:.1} kB per frame, {} frames, clock {:.0} s, {} own levels, {:?}{}",
                self.frames,
                game.time,
                (0..game.levels.len())
                    .filter(|&place| game.is_own(place))
                    .count(),
                game.screen(),
                if has_settled { "" } else { ", settling" }
            );
        }
        if minute >= self.minutes {
            ctx.send_viewport_cmd(ViewportCommand::Close);
        } else if ctx.input(|input| input.viewport().close_requested()) {
            // The simulated player pressed Quit, but the window stays open until the end of the test.
            ctx.send_viewport_cmd(ViewportCommand::CancelClose);
        }
    }
}

impl eframe::App for Soak {
    fn raw_input_hook(&mut self, _: &egui::Context, input: &mut RawInput) {
        self.play(input);
    }

    fn ui(&mut self, ui: &mut egui::Ui, frame: &mut eframe::Frame) {
        self.measure();
        self.manage(&ui.ctx().clone());
        self.app.ui(ui, frame);
        self.frames += 1;
    }

    fn on_exit(&mut self) {
        self.app.on_exit();
    }
}

/// Memory of this process [MB], where available: resident, and resident without memory that the allocator
/// keeps for reuse.
fn memory() -> Option<[f64; 2]> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmRSS:"))?;
    let kilobytes: f64 = line.split_whitespace().nth(1)?.parse().ok()?;
    let resident = kilobytes / 1000.0;
    Some([resident, resident - free() as f64 / 1e6])
}

/// Memory that the allocator keeps for reuse [bytes].
#[cfg(all(target_os = "linux", target_env = "gnu"))]
fn free() -> usize {
    /// `struct mallinfo2` of malloc.h, whose ninth field is `fordblks`.
    #[repr(C)]
    struct Mallinfo2([usize; 10]);
    unsafe extern "C" {
        safe fn mallinfo2() -> Mallinfo2;
    }
    mallinfo2().0[8]
}

#[cfg(not(all(target_os = "linux", target_env = "gnu")))]
fn free() -> usize {
    0
}

/// Files to drop: two levels, a picture, a model, and an invalid level.
fn files(folder: &Path) -> std::io::Result<Vec<AnyFile>> {
    let levels = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tamaire_play/levels");
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
    let figures = ["memory", "memory in use", "draw calls", "bytes written"].map(Figure::new);
    let figures = Rc::new(RefCell::new(figures));
    let told = figures.clone();
    let folder = tempfile::tempdir().expect("a temporary folder can be created");
    let files = files(folder.path()).expect("a temporary folder can be created");
    let kept = folder.path().join("kept");
    let about = DeviceInfo {
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
        "tamaire soak test",
        options,
        Box::new(move |context| {
            let mut game = Game::new(Files::in_folder(kept), Sound::none(), Pads::none());
            game.time = AHEAD;
            let of_egui = OfEgui::default();
            context.egui_ctx.add_plugin(of_egui.clone());
            Ok(Box::new(Soak {
                app: App::new(context, game)?,
                random: fastrand::Rng::with_seed(7),
                files,
                pad,
                began: Instant::now(),
                frames: 0,
                of_egui,
                figures: told,
                minutes,
                minute: 0,
                begun: 0,
            }))
        }),
    );
    match ended {
        Ok(()) => {
            let growths = figures.borrow().each_ref().map(|figure| {
                let growth = figure.growth();
                println!("{} grew by {:.1} %", figure.name, 100.0 * growth);
                growth
            });
            // If nothing was measured, the growth is NaN, which fails the test.
            let is_flat = growths.iter().all(|growth| *growth <= GROWTH);
            ExitCode::from(u8::from(!is_flat))
        }
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}
