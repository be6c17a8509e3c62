//! A round on the screen: the world, what flies about, the face.

use super::camera::View;
use super::face::Place;
use super::{Effects, Theme, draw_face};
use eframe::egui_wgpu::{Callback, CallbackResources, CallbackTrait, RenderState};
use egui::epaint::PathShape;
use egui::{Color32, PaintCallbackInfo, Painter, Pos2, Stroke, Ui, vec2};
use fuwafuwa::Dim2;
use fuwafuwa_render::frame::ElementColour;
use fuwafuwa_render::{Ages, Basket, Camera, Frame, Particle, Renderer, anchor};
use std::sync::{Arc, Mutex, PoisonError};
use tamaire_play::Round;

/// How to show a round.
#[derive(Copy, Clone, Debug)]
pub struct Look<'a> {
    /// Where.
    pub view: View,
    /// In which colours.
    pub theme: &'a Theme,
    /// Whether to show the elements instead of the skin.
    pub elements: Option<ElementColour>,
    /// What flies about.
    pub effects: &'a Effects,
    /// Seconds since the game began, for blinking.
    pub time: f32,
    /// The same level as somebody played it before.
    pub ghost: Option<&'a Round<Dim2>>,
}

/// Where rounds are drawn: a part of a window of egui's.
pub struct Stage {
    state: RenderState,
    renderer: Arc<Mutex<Renderer>>,
    ages: Ages,
    time: f32,
}

/// Puts the picture that was made ready into egui's pass.
struct Paint(Arc<Mutex<Renderer>>);

impl CallbackTrait for Paint {
    fn paint(
        &self,
        _: PaintCallbackInfo,
        pass: &mut wgpu::RenderPass<'static>,
        _: &CallbackResources,
    ) {
        // A panic elsewhere left at worst an unfinished picture.
        let renderer = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        renderer.paint(pass);
    }
}

impl Stage {
    /// A stage in the window whose GPU this is.
    pub fn new(state: &RenderState) -> Self {
        let renderer = Renderer::new(&state.device, state.target_format);
        Self {
            state: state.clone(),
            renderer: Arc::new(Mutex::new(renderer)),
            ages: Ages::default(),
            time: 0.0,
        }
    }

    /// Draws a round.
    pub fn draw(&mut self, ui: &Ui, round: &Round<Dim2>, look: &Look) {
        let view = &look.view;
        let scale = ui.ctx().pixels_per_point();
        let size = (view.rect.size() * scale).max(vec2(1.0, 1.0));
        let size = [size.x.round() as u32, size.y.round() as u32];
        self.ages
            .follow(round.world(), (look.time - self.time).max(0.0));
        self.time = look.time;
        let specks = look.effects.specks.iter().map(|speck| Particle {
            at: speck.at,
            radius: speck.radius,
            colour: {
                let [red, green, blue] = look.theme.world.material(speck.material);
                [red, green, blue, speck.strength()]
            },
        });
        let specks: Vec<Particle> = specks.collect();
        let rules = round.level().game();
        let basket = round.basket().map(|&region| Basket {
            region,
            fill: (round.progress().inside / rules.share).clamp(0.0, 1.0),
        });
        let frame = Frame {
            camera: Camera {
                centre: [view.centre[0], view.centre[1], 0.0],
                height: view.height(),
                tilt: 0.0,
                shake: [0.0; 3],
            },
            theme: &look.theme.world,
            look: match look.elements {
                None => fuwafuwa_render::Look::Skin,
                Some(colour) => fuwafuwa_render::Look::Elements {
                    colour,
                    ages: &self.ages.seconds,
                    nodes: false,
                },
            },
            basket,
            particles: &specks,
            seconds: look.time,
        };
        let RenderState { device, queue, .. } = &self.state;
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let mut renderer = self.renderer.lock().unwrap_or_else(PoisonError::into_inner);
        renderer.prepare(device, queue, &mut encoder, round.world(), &frame, size);
        queue.submit([encoder.finish()]);
        let paint = Paint(self.renderer.clone());
        ui.painter()
            .add(Callback::new_paint_callback(view.rect, paint));
        if let Some(ghost) = look.ghost {
            draw_ghost(ui.painter(), ghost, view);
        }
        if look.elements.is_none() {
            draw_faces(ui.painter(), round, look);
        }
    }
}

fn draw_faces(painter: &Painter, round: &Round<Dim2>, look: &Look) {
    let world = round.world();
    let view = &look.view;
    let hand = world.manipulators().first();
    let look_at = hand.map_or(Pos2::ZERO, |hand| view.on_screen(hand.position()));
    // Blinks every four seconds or so.
    let phase = look.time.rem_euclid(3.7);
    let blink = (1.0 - (phase - 0.1).abs() / 0.1).clamp(0.0, 1.0);
    for body in world.bodies() {
        let anchor = anchor(body);
        let size = 0.55 * anchor.scale * view.scale;
        let place = Place {
            at: view.on_screen([anchor.position[0], anchor.position[1], 0.0]),
            right: size * vec2(anchor.right[0], -anchor.right[1]),
            up: size * vec2(anchor.up[0], -anchor.up[1]),
            look_at,
        };
        draw_face(painter, &place, look.effects.mood(round), blink);
    }
}

/// The lines of a round that was played before.
fn draw_ghost(painter: &Painter, round: &Round<Dim2>, view: &View) {
    let stroke = Stroke::new(2.5, Color32::from_rgba_unmultiplied(90, 80, 120, 120));
    for body in round.world().bodies() {
        for outline in body.outlines() {
            let points = outline.points.iter().map(|&at| view.on_screen(at));
            painter.add(PathShape::closed_line(points.collect(), stroke));
        }
    }
    for hand in round.world().manipulators() {
        painter.circle_stroke(
            view.on_screen(hand.position()),
            view.scale * hand.radius,
            stroke,
        );
    }
}
