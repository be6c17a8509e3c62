//! Off-screen rendering of rounds: egui and the renderers of the window draw into images instead.

use super::device;
use crate::look::{DrawOptions, Effects, Hint, Stage, view_of_level};
use app_shell::{CameraRig, Theme, style};
use eframe::egui_wgpu::{RenderState, RendererOptions, ScreenDescriptor};
use egui::{Align2, FontId, RawInput, Rect, Ui, Vec2, vec2};
use fuwafuwa_render::{ImageError, ImageStage};
use tamaire_play::AnyRound;
use wgpu::PollType;

/// Height of the caption strip below a picture [px].
const CAPTION: f32 = 34.0;
/// Font size of the caption [px].
const LETTERS: f32 = 17.0;

/// Off-screen renderer of rounds. Its pictures look the same as in the window.
pub struct Studio {
    state: RenderState,
    context: egui::Context,
    stage: Stage,
    theme: Theme,
}

/// A moment of a round, with its camera.
#[derive(Copy, Clone)]
pub struct Moment<'a> {
    /// The round in its current state.
    pub round: &'a AnyRound,
    /// Particles, and facial expressions of bodies.
    pub effects: &'a Effects,
    /// Camera.
    pub camera: &'a CameraRig,
    /// Time since the start of the round [s].
    pub time: f64,
    /// Caption below the picture.
    pub caption: Option<&'a str>,
}

impl Studio {
    /// Opens a studio. `None` if there is no graphics adapter, not even in software.
    pub fn open() -> Option<Self> {
        let options = RendererOptions {
            dithering: false,
            ..RendererOptions::default()
        };
        device::open(options).map(Self::of)
    }

    fn of(state: RenderState) -> Self {
        let context = egui::Context::default();
        style::apply(&context);
        Self {
            stage: Stage::new(&state),
            state,
            context,
            theme: Theme::of(false),
        }
    }

    /// Size of the picture of a moment [px]: the given size, plus the caption strip if the moment has a
    /// caption.
    pub fn size(moment: &Moment, [width, height]: [u32; 2]) -> [u32; 2] {
        let below = if moment.caption.is_some() {
            CAPTION
        } else {
            0.0
        };
        [width, height + below as u32]
    }

    /// Draws a picture of [`Studio::size`]. Returns red, green, blue and opacity of each pixel, row by row
    /// from the upper left corner.
    ///
    /// # Errors
    /// If the picture is too large for the device, or if drawing fails.
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
        let draw = |step: ImageStage<'_>| match step {
            ImageStage::Prepare(encoder) => {
                let mut renderer = renderer.write();
                // The world, which is drawn before egui's shapes.
                queue.submit(renderer.update_buffers(device, queue, encoder, &shapes, &screen));
            }
            ImageStage::Paint(pass) => renderer.read().render(pass, &shapes, &screen),
        };
        #[cfg(not(target_family = "wasm"))]
        let drawn = fuwafuwa_render::image(device, queue, target, draw);
        #[cfg(target_family = "wasm")]
        let drawn = fuwafuwa_render::image_async(device, queue, target, draw).await;
        for id in output.textures_delta.free.drain() {
            renderer.write().free_texture(&id);
        }
        drawn
    }

    /// Releases the render targets until the next picture. After a photo of a 2D world they take 20 MB.
    pub fn rest(&self) {
        self.stage.release_images();
        // Polling the device frees unused resources. A failed device reports its error at the next picture.
        let _polled = self.state.device.poll(PollType::Poll);
    }
}

/// Draws a moment into `rect`, and its caption below.
fn draw(ui: &Ui, rect: Rect, moment: &Moment, stage: &mut Stage, theme: &Theme) {
    let look = DrawOptions {
        view: view_of_level(moment.camera, rect, moment.round.level()),
        theme,
        elements: None,
        cut_share: 1.0,
        effects: moment.effects,
        time: moment.time,
        ghost: None,
        hint: Hint::None,
        calm: false,
        resolution: 1.0,
        reduced_motion: false,
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

    /// Counts the pixels with nearly this colour in a range of rows.
    fn count(picture: &[u8], rows: std::ops::Range<usize>, colour: [u8; 3]) -> usize {
        let row = 4 * SIZE[0] as usize;
        let pixels = picture[rows.start * row..rows.end * row].chunks(4);
        let is_near = |pixel: &&[u8]| (0..3).all(|k| pixel[k].abs_diff(colour[k]) < 12);
        pixels.filter(is_near).count()
    }

    #[test]
    #[ignore = "needs a graphics adapter, such as that of mesa-vulkan-drivers; `cargo xtask test` runs it"]
    fn picture_shows_body_face_basket_and_caption_in_both_dimensions() {
        let mut studio = Studio::open().expect("a graphics adapter");
        for id in ["classic", "classic-3d"] {
            let round = AnyRound::new(Arc::new(Level::open(id).expect("built-in level opens")));
            let moment = Moment {
                round: &round,
                effects: &Effects::default(),
                camera: &CameraRig::default(),
                time: 1.0,
                caption: Some("hello"),
            };
            let [width, height] = Studio::size(&moment, SIZE);
            let picture = pollster::block_on(studio.shoot(&moment, SIZE)).expect("drawing works");
            assert_eq!(picture.len() as u32, 4 * width * height);
            assert!(picture.chunks(4).all(|pixel| pixel[3] == 255), "{id}");
            let (world, below) = (0..300, 300..height as usize);
            let [eyes, wood, letters] = [[74, 44, 42], [216, 171, 110], [74, 54, 52]];
            let red = picture
                .chunks(4)
                .filter(|pixel| pixel[0] > pixel[1].saturating_add(60));
            assert!(red.count() > 3000, "{id}: no body");
            assert!(count(&picture, world.clone(), eyes) > 30, "{id}: no eyes");
            assert!(count(&picture, world, wood) > 200, "{id}: no bars");
            assert!(count(&picture, below, letters) > 20, "{id}: no letters");
        }
    }
}
