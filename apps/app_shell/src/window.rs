//! Opens the window of a program and reports why it ended.

use crate::{GpuWatch, NoGpu, with_small_memory_blocks};
use eframe::egui_wgpu::WgpuSetup;
use pollster::block_on;
use std::any::Any;
use std::cell::RefCell;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::rc::Rc;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Minimum running time before a lost GPU leads to a restart. After a shorter run, the restarted program
/// would probably lose the GPU again.
const LEAST_LIFE: Duration = Duration::from_secs(10);

/// Outcome of a window.
pub enum WindowOutcome {
    /// The window was closed.
    Closed,
    /// The GPU was lost. The whole program has to restart, because window systems do not release the failed
    /// window.
    LostGpu,
    /// The window opened and ended with this error.
    Failed(String),
    /// The window opened and the program panicked.
    Broken(Box<dyn Any + Send>),
    /// The window never opened, for this reason.
    Never(String),
}

/// App to run in a window and the monitor of its GPU, or an error if there is no GPU.
pub type Made = Result<(Box<dyn eframe::App>, GpuWatch), NoGpu>;

/// Opens a window of a program. Returns when the window is closed.
pub fn open(
    name: &str,
    viewport: egui::ViewportBuilder,
    make: impl FnOnce(&eframe::CreationContext<'_>) -> Made + 'static,
) -> WindowOutcome {
    let gpu = Rc::new(RefCell::new(None::<GpuWatch>));
    let seen = gpu.clone();
    let began = Instant::now();
    // The call panics if a library of the window system is missing, and may panic after the GPU was lost.
    let closed = catch_unwind(AssertUnwindSafe(|| run_window(name, viewport, seen, make)));
    let gpu = gpu.take();
    let is_open = gpu.is_some();
    let is_lost = gpu.is_some_and(|gpu| match closed {
        Ok(_) => gpu.is_lost(),
        Err(_) => gpu.probe_is_lost(),
    });
    match closed {
        _ if is_lost && began.elapsed() > LEAST_LIFE => WindowOutcome::LostGpu,
        Ok(Ok(())) if is_lost => WindowOutcome::Failed("the GPU was lost".into()),
        Ok(Ok(())) => WindowOutcome::Closed,
        Ok(Err(error)) if is_open => WindowOutcome::Failed(error.to_string()),
        Ok(Err(error)) => WindowOutcome::Never(trouble(&error)),
        Err(panic) if is_open => WindowOutcome::Broken(panic),
        Err(_) => WindowOutcome::Never("opening a window failed".into()),
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
    let setup = with_small_memory_blocks(options.wgpu_options.wgpu_setup);
    options.wgpu_options.wgpu_setup = on_what_lives(setup);
    let create = move |context: &eframe::CreationContext<'_>| {
        let (app, watch) = make(context)?;
        gpu.replace(Some(watch));
        Ok(app)
    };
    eframe::run_native(name, options, Box::new(create))
}

/// Makes wgpu select the best adapter on which a device can be created. One driver may be broken while
/// another one works, for example Direct3D 12 and Vulkan under Wine.
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
        // Leaves out the last adapter: it is used in any case if no other works, and eframe reports its
        // errors.
        let (last, others) = fitting
            .split_last()
            .ok_or("no graphics adapter was found")?;
        Ok((*others.iter().find(lives).unwrap_or(last)).clone())
    }));
    setup
}

/// Rank of a kind of adapter, 0 is best; the order is that of wgpu.
fn rank(kind: wgpu::DeviceType, saves_power: bool) -> u8 {
    match kind {
        wgpu::DeviceType::DiscreteGpu => u8::from(saves_power),
        wgpu::DeviceType::IntegratedGpu => u8::from(!saves_power),
        wgpu::DeviceType::Other => 2,
        wgpu::DeviceType::VirtualGpu => 3,
        wgpu::DeviceType::Cpu => 4,
    }
}

/// Returns the reason why the window did not open, as text for the user.
fn trouble(error: &eframe::Error) -> String {
    let text = error.to_string();
    match error {
        eframe::Error::Wgpu(_) => format!(
            "no graphics adapter: neither Vulkan nor OpenGL is available, not even in software ({text})"
        ),
        // Removes the line of winit's source code that precedes the reason.
        eframe::Error::WinitEventLoop(_) | eframe::Error::Winit(_) => {
            let reason = text.rsplit(": ").next().unwrap_or(&text);
            format!("opening a window failed ({reason})")
        }
        _ => format!("opening a window failed ({text})"),
    }
}

/// Returns whether there is a display to open a window on. Only Unix systems with X11 or Wayland tell in
/// advance; on other systems the result is always true.
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
