//! The window's own pictures without a window: egui, the stage and both renderers, drawn into images.

use super::device;
use crate::look::{CameraRig, Effects, Hint, Look, Stage, Theme, dress};
use eframe::egui_wgpu::{RenderState, RendererOptions, ScreenDescriptor};
use egui::{Align2, FontId, RawInput, Rect, Ui, Vec2, vec2};
use fuwafuwa_render::{ImageError, Step};
use tamaire_play::AnyRound;
use wgpu::PollType;

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
    pub camera: &'a CameraRig,
    /// Seconds since the film began.
    pub time: f64,
    /// What stands below it, if anything does.
    pub caption: Option<&'a str>,
}

impl Studio {
    /// A studio; none where there is nothing to draw with, not even software.
    pub fn open() -> Option<Self> {
        let options = RendererOptions {
            dithering: false,
            ..RendererOptions::default()
        };
        device::open(options).map(Self::of)
    }

    fn of(state: RenderState) -> Self {
        let context = egui::Context::default();
        dress(&context);
        Self {
            stage: Stage::new(&state),
            state,
            context,
            theme: Theme::of(false),
        }
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
    pub async fn shoot(
        &mut self,
        moment: &Moment<'_>,
        size: [u32; 2],
    ) -> Result<Vec<u8>, ImageError> {
        let size_in_pixels = Self::size(moment, size);
        let points = |size: [u32; 2]| {
            Rect::from_min_size(egui::Pos2::ZERO, Vec2::from(size.map(|side| side as f32)))
        };
        let input = RawInput {
            screen_rect: Some(points(size_in_pixels)),
            time: Some(moment.time),
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
        let target = (*target_format, size_in_pixels);
        let draw = |step: Step<'_>| match step {
            Step::Before(encoder) => {
                { renderer.write() }.update_buffers(device, queue, encoder, &shapes, &screen);
            }
            Step::Inside(pass) => renderer.read().render(pass, &shapes, &screen),
        };
        #[cfg(not(target_family = "wasm"))]
        let drawn = fuwafuwa_render::image(device, queue, target, draw);
        #[cfg(target_family = "wasm")]
        let drawn = fuwafuwa_render::image_later(device, queue, target, draw).await;
        for id in output.textures_delta.free.drain() {
            renderer.write().free_texture(&id);
        }
        drawn
    }

    /// Gives back the images that it draws into until the next picture: after a photo of the plane they take 20 MB.
    pub fn rest(&self) {
        self.stage.forget_images();
        // What is no longer used goes when the device is asked how it does. One that has failed tells so at the next picture.
        let _polled = self.state.device.poll(PollType::Poll);
    }
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

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Arc;
    use tamaire_play::Level;

    const SIZE: [u32; 2] = [480, 300];

    /// How many pixels from one row up to another are nearly of a colour.
    fn count(picture: &[u8], rows: std::ops::Range<usize>, colour: [u8; 3]) -> usize {
        let row = 4 * SIZE[0] as usize;
        let pixels = picture[rows.start * row..rows.end * row].chunks(4);
        let is_near = |pixel: &&[u8]| (0..3).all(|k| pixel[k].abs_diff(colour[k]) < 12);
        pixels.filter(is_near).count()
    }

    #[test]
    fn a_moment_has_a_face_a_basket_and_its_caption_in_both_dimensions() {
        let Some(mut studio) = Studio::open() else {
            let is_ci = std::env::var("CI").is_ok_and(|value| value == "1" || value == "true");
            assert!(!is_ci, "mesa-vulkan-drivers brings an adapter");
            return;
        };
        for id in ["classic", "classic-3d"] {
            let round = AnyRound::new(Arc::new(Level::open(id).expect("it comes along")));
            let moment = Moment {
                round: &round,
                effects: &Effects::default(),
                camera: &CameraRig::default(),
                time: 1.0,
                caption: Some("hello"),
            };
            let [width, height] = Studio::size(&moment, SIZE);
            let picture = pollster::block_on(studio.shoot(&moment, SIZE)).expect("it is small");
            assert_eq!(picture.len() as u32, 4 * width * height);
            assert!(picture.chunks(4).all(|pixel| pixel[3] == 255), "{id}");
            let (world, below) = (0..300, 300..height as usize);
            let [eyes, wood, letters] = [[74, 44, 42], [216, 171, 110], [74, 54, 52]];
            assert!(count(&picture, world.clone(), eyes) > 30, "{id}: no eyes");
            assert!(count(&picture, world, wood) > 200, "{id}: no bars");
            assert!(count(&picture, below, letters) > 20, "{id}: no letters");
        }
    }
}
