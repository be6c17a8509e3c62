//! Drawing of a round: world, particles, and drawn faces of the bodies.

use super::feelings::Feeling;
use super::rest_frame::{camera, face_at_rest, frame};
use super::{DrawOptions, Face, Maps, Mood, glow, hint, room_parts, ropes};
use app_shell::pass::{PaintCallback, lock, pixels};
use app_shell::{SpaceStage, Theme, View};
use eframe::egui_wgpu::{Callback, RenderState};
use egui::{Color32, Painter, Shape, Stroke, Ui};
use fuwafuwa::inspect::{hands, moving_obstacles};
use fuwafuwa::{Dim, Dim2, Dim3, DimVector, Vec3, World};
use fuwafuwa_render::{Ages, Cost, Frame, Outlines, Particle, Renderer, Sticker, space};
use std::sync::{Arc, Mutex};
use tamaire_play::{AnyRound, Level, Round};

/// Line colour of a ghost in 2D.
const GHOST: Color32 = Color32::from_rgba_premultiplied(42, 38, 56, 120);
/// Line width of a ghost in 2D [points].
const GHOST_LINE: f32 = 3.0;

/// Sine of the camera's elevation above which the cutaway view removes the upper part of bodies instead of the
/// front part.
const DOWN: f32 = 0.8;

/// Draws rounds in an egui window.
pub struct Stage {
    state: RenderState,
    renderer: Arc<Mutex<Renderer>>,
    space: SpaceStage,
    ages: Ages,
    /// Round whose elements `ages` follows: its level and the last tick seen.
    followed: Option<(Arc<Level>, u64)>,
    maps: Maps,
    /// Outlines of a ghost in 2D.
    ghost: Outlines,
    time: f64,
}

impl Stage {
    /// Creates a stage for the window with this render state.
    pub fn new(state: &RenderState) -> Self {
        let renderer = Renderer::new(&state.device, state.target_format);
        Self {
            state: state.clone(),
            renderer: Arc::new(Mutex::new(renderer)),
            space: SpaceStage::new(state),
            ages: Ages::default(),
            followed: None,
            maps: Maps::default(),
            ghost: Default::default(),
            time: 0.0,
        }
    }

    /// Returns the thumbnails of levels, after rendering at most one that is missing.
    pub fn maps(&mut self, levels: &[Arc<Level>], theme: &Theme) -> &Maps {
        self.maps.make_one(&self.state, levels, theme);
        &self.maps
    }

    /// Returns the GPU cost of drawing since the last call, and resets it.
    pub fn take_cost(&self) -> Cost {
        let plane = lock(&self.renderer).take_cost();
        [plane, self.maps.take_cost(), self.space.take_cost()]
            .into_iter()
            .sum()
    }

    /// Frees the images that worlds were drawn into. Call it only between frames; the next frame creates them
    /// again.
    pub fn release_images(&self) {
        let device = &self.state.device;
        lock(&self.renderer).release_images(device);
        self.space.release_images();
    }

    /// Draws a round.
    pub fn draw(&mut self, ui: &Ui, round: &AnyRound, look: &DrawOptions) {
        match round {
            AnyRound::Plane(round) => self.draw_plane(ui, round, look),
            AnyRound::Space(round) => self.draw_space(ui, round, look),
        }
    }

    fn draw_space(&mut self, ui: &Ui, round: &Round<Dim3>, look: &DrawOptions) {
        let Some(camera) = look.view.space else {
            return;
        };
        let camera = space::Camera {
            cut: look.elements.map(|_| cut(&camera, look.cut_share)),
            ..camera
        };
        self.follow_ages(round, look);
        let specks = particles(look, round.level());
        let stickers: Vec<Sticker> = faces(round, look).iter().map(Face::sticker).collect();
        let frame = Frame {
            look: shown(look, &self.ages),
            particles: &specks,
            stickers: &stickers,
            ghost: match look.ghost {
                Some(AnyRound::Space(ghost)) => Some(ghost.world()),
                _ => None,
            },
            seconds: if look.reduced_motion { 0.0 } else { look.time },
            ..frame(camera, round, look.theme)
        };
        self.space.resolution = look.resolution;
        self.space.draw(ui, look.view.rect, round.world(), &frame);
        let painter = ui.painter();
        room_parts::draw(painter, round, look);
        ropes::draw(painter, round.world(), look);
        if let Some(AnyRound::Space(ghost)) = look.ghost {
            paint_joints(painter, &look.view, ghost.world());
        }
        hint::draw_ring_of_space(painter, round, look);
        look.effects.confetti.draw(painter, &look.view.flat());
    }

    fn draw_plane(&mut self, ui: &Ui, round: &Round<Dim2>, look: &DrawOptions) {
        let view = &look.view;
        let size = pixels(ui, view.rect).map(|side| {
            let side = (side as f32 * look.resolution).round();
            (side as u32).max(1)
        });
        self.follow_ages(round, look);
        let specks = particles(look, round.level());
        let frame = Frame {
            look: shown(look, &self.ages),
            particles: &specks,
            seconds: if look.reduced_motion { 0.0 } else { look.time },
            ..frame(camera(view), round, look.theme)
        };
        let RenderState { device, queue, .. } = &self.state;
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        lock(&self.renderer).prepare(device, queue, &mut encoder, round.world(), &frame, size);
        let painter = ui.painter();
        let add = |callback| painter.add(Callback::new_paint_callback(view.rect, callback));
        let callback = |paint| PaintCallback::new(&self.renderer, paint);
        add(callback(Renderer::paint_bodies).with_commands(encoder.finish()));
        room_parts::draw(painter, round, look);
        ropes::draw(painter, round.world(), look);
        // Faces are drawn over the knots of ropes.
        for face in faces(round, look) {
            face.paint(painter, view);
        }
        add(callback(Renderer::paint_rigid));
        glow::draw(painter, round, look);
        if let Some(AnyRound::Plane(ghost)) = look.ghost {
            self.draw_ghost(painter, ghost, look);
        }
        hint::draw(painter, round, look);
        look.effects.confetti.draw(painter, view);
    }

    /// Draws an earlier round: the outlines of its bodies, as smooth as their skin, of what moves, and its joints and
    /// hands.
    fn draw_ghost(&mut self, painter: &Painter, round: &Round<Dim2>, look: &DrawOptions) {
        let (view, stroke) = (&look.view, Stroke::new(GHOST_LINE, GHOST));
        let rings = &mut self.ghost;
        for (_, body) in round.world().soft_bodies() {
            rings.trace(body);
            for span in &rings.spans {
                let points = rings.points[span.start..span.end].iter();
                let points = points.map(|point| view.to_screen(point.at.extend(0.0)));
                painter.add(Shape::closed_line(points.collect(), stroke));
            }
        }
        let world = round.world();
        for body in moving_obstacles(world) {
            paint_shape(painter, view, &body.shape(), Color32::TRANSPARENT, stroke);
        }
        paint_joints(painter, view, world);
        for (player, hand) in hands(world) {
            let tone = look.theme.hand(player).gamma_multiply(0.35);
            paint_shape(painter, view, &hand.shape(), tone, stroke);
        }
    }

    /// Updates the ages of elements for the element view. The ages restart with each round, since a new world
    /// has no remodelled elements.
    fn follow_ages<D: Dim>(&mut self, round: &Round<D>, look: &DrawOptions) {
        let ticks = round.world().ticks();
        let goes_on = self
            .followed
            .as_ref()
            .is_some_and(|(level, before)| Arc::ptr_eq(level, round.level()) && *before <= ticks);
        if !goes_on {
            self.ages = Ages::default();
        }
        self.followed = Some((round.level().clone(), ticks));
        let seconds = (look.time - self.time).max(0.0) as f32;
        self.ages.update(round.world(), seconds);
        self.time = look.time;
    }
}

/// Draws the joints of an earlier round as lines.
fn paint_joints<D: Dim>(painter: &Painter, view: &View, world: &World<D>) {
    for (handle, _) in world.joints() {
        if let Ok(Some(anchors)) = world.joint_anchor_positions(handle) {
            let ends = anchors.map(|at| view.to_screen(at.to_vec3()));
            painter.line_segment(ends, Stroke::new(GHOST_LINE, GHOST));
        }
    }
}

/// Draws the outline of a shape.
fn paint_shape(
    painter: &Painter,
    view: &View,
    shape: &fuwafuwa::Shape<Dim2>,
    fill: Color32,
    stroke: Stroke,
) {
    let screen = |at: Vec3| view.to_screen(at.with_z(0.0));
    let [low, high] = shape.bounds().map(DimVector::to_vec3);
    match *shape {
        fuwafuwa::Shape::HalfSpace { .. } => {}
        fuwafuwa::Shape::Ball { centre, radius } => {
            painter.circle(screen(centre.to_vec3()), view.scale * radius, fill, stroke);
        }
        fuwafuwa::Shape::Box { .. } => {
            let rect = egui::Rect::from_two_pos(screen(low), screen(high));
            painter.rect(rect, 0.0, fill, stroke, egui::StrokeKind::Middle);
        }
        fuwafuwa::Shape::OrientedBox {
            centre,
            half,
            rotation,
        } => {
            let corners = glow::corners(view, centre, half, rotation);
            painter.add(Shape::convex_polygon(corners, fill, stroke));
        }
        fuwafuwa::Shape::Capsule { from, to, radius } => {
            let [from, to] = [from, to].map(|end| screen(end.to_vec3()));
            let outline = glow::bar(from, to, view.scale * radius);
            painter.add(Shape::convex_polygon(outline, fill, stroke));
        }
    }
}

/// Returns the cut through bodies for the element view: towards the camera, or from above if the camera looks
/// down.
fn cut(camera: &space::Camera, share: f32) -> space::Cut {
    let towards = camera.axes()[2];
    let level = towards.with_y(0.0);
    let direction = match towards.y > DOWN {
        true => Vec3::Y,
        false => level / level.length(),
    };
    space::Cut { direction, share }
}

/// Returns what the renderer shows: the skin, or elements with the chosen colouring.
fn shown<'a>(look: &DrawOptions, ages: &'a Ages) -> fuwafuwa_render::Look<'a> {
    match look.elements {
        None => fuwafuwa_render::Look::Skin,
        Some(colour) => fuwafuwa_render::Look::Elements {
            colour,
            ages: &ages.seconds,
            nodes: false,
        },
    }
}

fn particles(look: &DrawOptions, level: &Level) -> Vec<Particle> {
    let world = &look.theme.world;
    let specks = look.effects.specks.iter().map(|speck| {
        let own = world.tinted_material(speck.material, level.colours());
        // Particles of fresh material get the same share of the fresh colour as torn surfaces.
        let share = if speck.is_fresh { 0.7 } else { 0.0 };
        let [red, green, blue] = [0, 1, 2].map(|k| own[k] + share * (world.fresh[k] - own[k]));
        Particle {
            at: speck.at,
            radius: speck.radius,
            colour: [red, green, blue, speck.strength()],
        }
    });
    specks.collect()
}

/// Returns the drawn faces of all bodies, and none in the element view.
fn faces<D: Dim>(round: &Round<D>, look: &DrawOptions) -> Vec<Face> {
    if look.elements.is_some() {
        return Vec::new();
    }
    let bodies = round.world().soft_bodies().map(|(_, body)| body);
    // Before the first tick there are no feelings yet.
    let fresh: Vec<Feeling>;
    let feelings = match look.effects.feelings.len() == bodies.clone().count() {
        true => &look.effects.feelings,
        false => {
            let eye = look.view.space.map(|camera| camera.eye());
            let level = round.level();
            let feeling = |(place, body)| Feeling::new(body, eye, level.is_drawing(place));
            fresh = bodies.enumerate().map(feeling).collect();
            &fresh
        }
    };
    let face = |(number, feeling): (usize, &Feeling)| {
        // Blinks every 3.7 s, each body at a different time.
        let phase = (look.time + 1.3 * number as f64).rem_euclid(3.7) as f32;
        let hands = round.hands().map(|hand| hand.position().to_vec3());
        let away = |hand: &Vec3| (*hand - feeling.at).length();
        let nearest = hands.min_by(|a, b| away(a).total_cmp(&away(b)));
        let start = match look.reduced_motion || matches!(feeling.mood, Mood::Calm | Mood::Sad) {
            true => 0.0,
            false => 0.16 * (-9.0 * feeling.age).exp(),
        };
        let face = face_at_rest(number, feeling, 1.0 + start);
        Face {
            mood: if look.calm {
                face.mood.happy()
            } else {
                face.mood
            },
            blink: (1.0 - (phase - 0.1).abs() / 0.1).clamp(0.0, 1.0),
            look_at: nearest.unwrap_or(feeling.at),
            ..face
        }
    };
    feelings.iter().enumerate().map(face).collect()
}
