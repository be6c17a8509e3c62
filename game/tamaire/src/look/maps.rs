//! Thumbnails of levels at their start, drawn by the renderers of rounds.

use super::feelings::Feeling;
use super::rest_frame::{camera, face_at_rest, frame};
use super::ropes::{JointFigure, figures};
use super::{Face, view_of_level};
use app_shell::{CameraRig, Theme, View};
use eframe::egui_wgpu::RenderState;
use egui::{Color32, Painter, Rect, TextureId, pos2};
use fuwafuwa::{Dim, Vec3};
use fuwafuwa_render::{Cost, Frame, Renderer, Sticker, new_image, pass_into, space};
use std::sync::Arc;
use tamaire_play::{AnyRound, Level, Round};
use wgpu::{FilterMode, TextureFormat, TextureUsages};

/// Pixel format of a thumbnail.
const FORMAT: TextureFormat = TextureFormat::Rgba8Unorm;
/// Size of a thumbnail [px].
const SIZE: [u32; 2] = [480, 320];

/// Thumbnails of levels.
#[derive(Default)]
pub struct Maps {
    pictures: Vec<Picture>,
    theme: Option<Theme>,
    renderer: Option<Renderer>,
    space: Option<space::Renderer>,
}

struct Picture {
    level: Arc<Level>,
    texture: TextureId,
    /// Drawn faces of the bodies in a 2D level. In 3D they are part of the texture.
    faces: Vec<Face>,
    joints: Vec<JointFigure>,
}

impl Maps {
    /// Draws the thumbnail of a level, if it has been rendered.
    pub fn draw(&self, painter: &Painter, rect: Rect, level: &Arc<Level>) {
        let known = |picture: &&Picture| Arc::ptr_eq(&picture.level, level);
        let Some(picture) = self.pictures.iter().find(known) else {
            return;
        };
        let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
        painter.image(picture.texture, rect, whole, Color32::WHITE);
        let view = view(rect, level);
        for joint in &picture.joints {
            joint.draw(painter, &view);
        }
        for face in &picture.faces {
            face.paint(painter, &view);
        }
    }

    /// Renders at most one missing thumbnail; rendering all at once would stall the game.
    pub fn make_one(&mut self, state: &RenderState, levels: &[Arc<Level>], theme: &Theme) {
        if self.theme.as_ref() != Some(theme) {
            self.theme = Some(theme.clone());
            self.forget(state, |_| true);
        }
        let is_gone = |level: &Arc<Level>| !levels.iter().any(|known| Arc::ptr_eq(known, level));
        self.forget(state, is_gone);
        let is_known = |level: &Arc<Level>| {
            let mut pictures = self.pictures.iter();
            pictures.any(|picture| Arc::ptr_eq(&picture.level, level))
        };
        if let Some(level) = levels.iter().find(|level| !is_known(level)) {
            let picture = self.picture(state, level, theme);
            self.pictures.push(picture);
        }
    }

    /// Returns the GPU cost of drawing since the last call, and resets it.
    pub fn take_cost(&self) -> Cost {
        let plane = self.renderer.as_ref().map(Renderer::take_cost);
        let space = self.space.as_ref().map(space::Renderer::take_cost);
        plane.into_iter().chain(space).sum()
    }

    fn forget(&mut self, state: &RenderState, which: impl Fn(&Arc<Level>) -> bool) {
        self.pictures.retain(|picture| {
            let stays = !which(&picture.level);
            if !stays {
                state.renderer.write().free_texture(&picture.texture);
            }
            stays
        });
    }

    /// Renders the thumbnail of a level.
    fn picture(&mut self, state: &RenderState, level: &Arc<Level>, theme: &Theme) -> Picture {
        let RenderState { device, queue, .. } = state;
        let usage = TextureUsages::RENDER_ATTACHMENT | TextureUsages::TEXTURE_BINDING;
        let target = new_image(device, "map", SIZE, 1, FORMAT, usage);
        let rect = Rect::from_min_max(pos2(0.0, 0.0), pos2(SIZE[0] as f32, SIZE[1] as f32));
        let view = view(rect, level);
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let (faces, joints) = match AnyRound::new(level.clone()) {
            AnyRound::Plane(round) => {
                let renderer = self
                    .renderer
                    .get_or_insert_with(|| Renderer::new(device, FORMAT));
                let frame = frame(camera(&view), &round, theme);
                renderer.prepare(device, queue, &mut encoder, round.world(), &frame, SIZE);
                renderer.paint(&mut pass_into(&mut encoder, &target));
                (faces(&round, None), figures(round.world()).collect())
            }
            AnyRound::Space(round) => {
                let new = || space::Renderer::new(device, FORMAT);
                let renderer = self.space.get_or_insert_with(new);
                let camera = view.space.expect("the view of a 3D level has a 3D camera");
                let stickers: Vec<Sticker> = faces(&round, Some(camera.eye()))
                    .iter()
                    .map(Face::sticker)
                    .collect();
                let frame = Frame {
                    stickers: &stickers,
                    ..frame(camera, &round, theme)
                };
                renderer.prepare(device, queue, &mut encoder, round.world(), &frame, SIZE);
                renderer.paint(&mut pass_into(&mut encoder, &target));
                (Vec::new(), figures(round.world()).collect())
            }
        };
        queue.submit([encoder.finish()]);
        let mut textures = state.renderer.write();
        Picture {
            level: level.clone(),
            texture: textures.register_native_texture(device, &target, FilterMode::Linear),
            faces,
            joints,
        }
    }
}

fn faces<D: Dim>(round: &Round<D>, eye: Option<Vec3>) -> Vec<Face> {
    let bodies = round.world().soft_bodies().enumerate();
    bodies
        .map(|(number, (_, body))| {
            let feeling = Feeling::new(body, eye, round.level().is_drawing(number));
            face_at_rest(number, &feeling, 1.0)
        })
        .collect()
}

fn view(rect: Rect, level: &Level) -> View {
    view_of_level(&CameraRig::default(), rect, level)
}
