//! The window's own pictures without a window: egui, the stage and both renderers, drawn into images.

use crate::look::{Camera, Effects, Hint, Look, Stage, Theme, dress};
use eframe::egui_wgpu::{
    RenderState, RendererOptions, ScreenDescriptor, WgpuConfiguration, WgpuSetup,
    WgpuSetupCreateNew,
};
use egui::{Align2, FontId, RawInput, Rect, Ui, Vec2, vec2};
use fuwafuwa_render::{ImageError, Step, image};
use pollster::block_on;
use tamaire_play::AnyRound;
use wgpu::Backends;

/// Height of the paper below a picture that has a caption, and of the letters on it [px].
const CAPTION: f32 = 34.0;
const LETTERS: f32 = 17.0;

/// Draws rounds as the window does.
pub struct Studio {
    state: RenderState,
    context: egui::Context,
    stage: Stage,
    theme: Theme,
}

/// A moment of a round, and from where it is seen.
#[derive(Copy, Clone)]
pub struct Moment<'a> {
    /// The round as it is now.
    pub round: &'a AnyRound,
    /// What flies about, and how bodies feel.
    pub effects: &'a Effects,
    /// From where.
    pub camera: &'a Camera,
    /// Seconds since the film began.
    pub time: f32,
    /// What stands below it, if anything does.
    pub caption: Option<&'a str>,
}

impl Studio {
    /// A studio; none where there is nothing to draw with, not even software.
    pub fn open() -> Option<Self> {
        // OpenGL comes last: where there is no display its driver complains to the terminal.
        let state = [Backends::PRIMARY, Backends::GL]
            .into_iter()
            .find_map(state_of)?;
        let context = egui::Context::default();
        dress(&context);
        Some(Self {
            stage: Stage::new(&state),
            state,
            context,
            theme: Theme::of(false),
        })
    }

    /// The size of the picture of a moment that is so large without its caption [px].
    pub fn size(moment: &Moment, [width, height]: [u32; 2]) -> [u32; 2] {
        let below = if moment.caption.is_some() {
            CAPTION
        } else {
            0.0
        };
        [width, height + below as u32]
    }

    /// A picture of [`Studio::size`]: red, green, blue and opacity of each pixel, row by row from the upper left corner.
    ///
    /// # Errors
    /// When it is too large for the device, or when that fails.
    pub fn shoot(&mut self, moment: &Moment, size: [u32; 2]) -> Result<Vec<u8>, ImageError> {
        let size_in_pixels = Self::size(moment, size);
        let points = |size: [u32; 2]| {
            Rect::from_min_size(egui::Pos2::ZERO, Vec2::from(size.map(|side| side as f32)))
        };
        let input = RawInput {
            screen_rect: Some(points(size_in_pixels)),
            time: Some(f64::from(moment.time)),
            ..RawInput::default()
        };
        let (stage, theme) = (&mut self.stage, &self.theme);
        let mut output = self.context.run_ui(input, |ui| {
            draw(ui, points(size), moment, stage, theme);
        });
        let RenderState {
            device,
            queue,
            target_format,
            renderer,
            ..
        } = &self.state;
        let pixels_per_point = output.pixels_per_point;
        let screen = ScreenDescriptor {
            size_in_pixels,
            pixels_per_point,
        };
        let shapes = self.context.tessellate(output.shapes, pixels_per_point);
        for (id, changes) in output.textures_delta.set.drain() {
            for change in changes {
                renderer.write().update_texture(device, queue, id, &change);
            }
        }
        let drawn = image(
            device,
            queue,
            (*target_format, size_in_pixels),
            |step| match step {
                Step::Before(encoder) => {
                    renderer
                        .write()
                        .update_buffers(device, queue, encoder, &shapes, &screen);
                }
                Step::Inside(pass) => renderer.read().render(pass, &shapes, &screen),
            },
        );
        for id in output.textures_delta.free.drain() {
            renderer.write().free_texture(&id);
        }
        drawn
    }
}

/// What egui needs to draw with one of some interfaces; none where there is no adapter for any.
fn state_of(backends: Backends) -> Option<RenderState> {
    let mut setup = WgpuSetupCreateNew::without_display_handle();
    // Somebody may have chosen by `WGPU_BACKEND`.
    setup.instance_descriptor.backends &= backends;
    if setup.instance_descriptor.backends.is_empty() {
        return None;
    }
    let wgpu_setup = WgpuSetup::CreateNew(setup);
    let instance = block_on(wgpu_setup.new_instance());
    let configuration = WgpuConfiguration {
        wgpu_setup,
        ..WgpuConfiguration::default()
    };
    let options = RendererOptions {
        dithering: false,
        ..RendererOptions::default()
    };
    block_on(RenderState::create(
        &configuration,
        &instance,
        None,
        options,
    ))
    .ok()
}

/// Draws a moment, and below `rect` what is said of it.
fn draw(ui: &Ui, rect: Rect, moment: &Moment, stage: &mut Stage, theme: &Theme) {
    let look = Look {
        view: moment.camera.view(rect, moment.round.level()),
        theme,
        elements: None,
        left: 1.0,
        effects: moment.effects,
        time: moment.time,
        ghost: None,
        hint: Hint::None,
        still: false,
    };
    stage.draw(ui, moment.round, &look);
    if let Some(caption) = moment.caption {
        let painter = ui.painter();
        let paper = Rect::from_min_size(rect.left_bottom(), vec2(rect.width(), CAPTION));
        painter.rect_filled(paper, 0.0, theme.paper);
        painter.text(
            paper.center(),
            Align2::CENTER_CENTER,
            caption,
            FontId::proportional(LETTERS),
            theme.ink,
        );
    }
}
