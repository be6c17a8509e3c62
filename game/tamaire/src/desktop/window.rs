//! The window of a program, and what becomes of it.

use crate::app::{App, NoGpu};
use crate::game::Game;
use crate::platform::{GpuWatch, in_small_blocks};
use crate::screens::Attendant;
use eframe::egui_wgpu::WgpuSetup;
use pollster::block_on;
use std::any::Any;
use std::cell::RefCell;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::rc::Rc;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Whose GPU is lost so soon does not begin anew: it would be lost again and again.
const LEAST_LIFE: Duration = Duration::from_secs(10);

/// By this a desktop knows whose window it is: the name of its entry in the menu.
const APP: &str = "tamaire";

/// What became of a window.
pub enum Opened {
    /// It was closed.
    Closed,
    /// What it was drawn with was lost. No window system lets go of a window that broke down: the program has to begin anew.
    LostGpu,
    /// It was open, and ended so.
    Failed(String),
    /// It was open, and panicked.
    Broken(Box<dyn Any + Send>),
    /// It never opened, for this reason.
    Never(String),
}

/// What a window shows, and an eye on what it is drawn with; or why there is nothing.
pub type Made = Result<(Box<dyn eframe::App>, GpuWatch), NoGpu>;

/// Opens a window for a game and what leads it, if anything; returns when it is closed.
pub(super) fn open_game(
    viewport: egui::ViewportBuilder,
    make: impl FnOnce() -> (Game, Option<Box<dyn Attendant>>) + 'static,
) -> Opened {
    open(
        APP,
        viewport
            .with_title("玉入れ tamaire")
            .with_app_id(APP)
            .with_icon(icon()),
        |context| {
            let (game, attendant) = make();
            let mut app = App::new(context, game)?;
            app.attendant = attendant;
            let watch = app.gpu.clone();
            Ok((Box::new(app), watch))
        },
    )
}

/// Opens a window of a program; returns when it is closed.
pub fn open(
    name: &str,
    viewport: egui::ViewportBuilder,
    make: impl FnOnce(&eframe::CreationContext<'_>) -> Made + 'static,
) -> Opened {
    let gpu = Rc::new(RefCell::new(None::<GpuWatch>));
    let seen = gpu.clone();
    let began = Instant::now();
    // A library of the window system that is not installed makes it panic, and so does what is left of a lost GPU.
    let closed = catch_unwind(AssertUnwindSafe(|| run_window(name, viewport, seen, make)));
    let gpu = gpu.take();
    let is_open = gpu.is_some();
    let is_lost = gpu.is_some_and(|gpu| match closed {
        Ok(_) => gpu.is_lost(),
        Err(_) => gpu.tried_is_lost(),
    });
    match closed {
        _ if is_lost && began.elapsed() > LEAST_LIFE => Opened::LostGpu,
        Ok(Ok(())) if is_lost => Opened::Failed("the GPU was lost".into()),
        Ok(Ok(())) => Opened::Closed,
        Ok(Err(error)) if is_open => Opened::Failed(error.to_string()),
        Ok(Err(error)) => Opened::Never(trouble(&error)),
        Err(panic) if is_open => Opened::Broken(panic),
        Err(_) => Opened::Never("no window opens".into()),
    }
}

fn run_window(
    name: &str,
    viewport: egui::ViewportBuilder,
    gpu: Rc<RefCell<Option<GpuWatch>>>,
    make: impl FnOnce(&eframe::CreationContext<'_>) -> Made + 'static,
) -> eframe::Result {
    let mut options = eframe::NativeOptions {
        viewport: viewport
            .with_inner_size([1280.0, 800.0])
            .with_min_inner_size([640.0, 400.0]),
        ..Default::default()
    };
    let setup = in_small_blocks(options.wgpu_options.wgpu_setup);
    options.wgpu_options.wgpu_setup = on_what_lives(setup);
    let create = move |context: &eframe::CreationContext<'_>| {
        let (app, watch) = make(context)?;
        gpu.replace(Some(watch));
        Ok(app)
    };
    eframe::run_native(name, options, Box::new(create))
}

/// The same, on the best adapter whose device lives: one driver may be broken where the next is not, as that of
/// Direct3D 12 beside Vulkan under Wine.
fn on_what_lives(mut setup: WgpuSetup) -> WgpuSetup {
    let WgpuSetup::CreateNew(new) = &mut setup else {
        return setup;
    };
    let described = new.device_descriptor.clone();
    let saves_power = new.power_preference == wgpu::PowerPreference::LowPower;
    new.native_adapter_selector = Some(Arc::new(move |adapters, surface| {
        let fits = |adapter: &&wgpu::Adapter| {
            surface.is_none_or(|surface| adapter.is_surface_supported(surface))
        };
        let mut fitting: Vec<&wgpu::Adapter> = adapters.iter().filter(fits).collect();
        fitting.sort_by_key(|adapter| rank(adapter.get_info().device_type, saves_power));
        let lives = |adapter: &&&wgpu::Adapter| {
            block_on(adapter.request_device(&described(adapter))).is_ok()
        };
        // The last needs no trial: where it does not live either, it says why.
        let (last, others) = fitting
            .split_last()
            .ok_or("no graphics adapter was found")?;
        Ok((*others.iter().find(lives).unwrap_or(last)).clone())
    }));
    setup
}

/// How far behind the best a kind of adapter is, as wgpu ranks them.
fn rank(kind: wgpu::DeviceType, saves_power: bool) -> u8 {
    match kind {
        wgpu::DeviceType::DiscreteGpu => u8::from(saves_power),
        wgpu::DeviceType::IntegratedGpu => u8::from(!saves_power),
        wgpu::DeviceType::Other => 2,
        wgpu::DeviceType::VirtualGpu => 3,
        wgpu::DeviceType::Cpu => 4,
    }
}

/// What stands for the game in lists of windows.
fn icon() -> egui::IconData {
    let picture = include_bytes!("../../web/icon-192.png");
    eframe::icon_data::from_png_bytes(picture).expect("a test looks at the picture")
}

/// Why no window opens.
fn trouble(error: &eframe::Error) -> String {
    let text = error.to_string();
    match error {
        eframe::Error::Wgpu(_) => format!(
            "there is nothing to draw with, neither Vulkan nor OpenGL, not even in software ({text})"
        ),
        // Before its reason it names a line of its source.
        eframe::Error::WinitEventLoop(_) | eframe::Error::Winit(_) => {
            let reason = text.rsplit(": ").next().unwrap_or(&text);
            format!("no window opens ({reason})")
        }
        _ => format!("no window opens ({text})"),
    }
}

/// Whether there is a screen to open a window on: only some systems tell beforehand.
pub fn has_display() -> bool {
    let says_so = cfg!(all(
        unix,
        not(any(
            target_os = "macos",
            target_os = "ios",
            target_os = "android"
        ))
    ));
    let is_set = |name| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    !says_so
        || ["WAYLAND_DISPLAY", "WAYLAND_SOCKET", "DISPLAY"]
            .into_iter()
            .any(is_set)
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_window_has_a_picture() {
        assert_eq!(super::icon().width, 192);
    }
}
