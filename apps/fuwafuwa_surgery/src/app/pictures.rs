//! Picture of the organ on its table, with the tool and the force of the tissue on the tool.

use super::session::Session;
use app_shell::{SpaceStage, View};
use egui::{Align2, Color32, FontId, Painter, Rect, Stroke, Ui, vec2};
use fuwafuwa_render::palette::rgb;
use fuwafuwa_render::{Frame, Palette, Prop};

/// Length of the force arrow per newton, as a fraction of the camera distance.
const LONG: f32 = 0.045;
/// Force below which no arrow is shown [N].
const WEAK: f32 = 0.02;
/// Colour of the tools.
const STEEL: u32 = 0xbfc8d2;
/// Colour of the force arrow.
pub const RED: Color32 = Color32::from_rgb(200, 52, 52);

/// Colours of flesh on a green cloth. Material colours are in the order of the materials of
/// [`crate::phantom`] and repeat after the last.
pub fn palette() -> Palette {
    Palette {
        floor: [rgb(0xbfdcd4), rgb(0x8fbab2)],
        frame: rgb(0x7fa8a2),
        materials: [0xe0a49a, 0xf0dcc0, 0x8a5a9c, 0xb8434a, 0x9fb4d0, 0xa8bf94]
            .map(rgb)
            .to_vec(),
        fresh: rgb(0xc2454f),
        hands: vec![rgb(STEEL)],
        ..Palette::candy()
    }
}

/// Draws organ, table and tool into a part of the window and returns the view.
pub fn show(
    ui: &Ui,
    rect: Rect,
    stage: &mut SpaceStage,
    session: &Session,
    colours: &Palette,
) -> View {
    let view = session.camera.view_of_space(rect, session.seen);
    let procedure = session.procedure();
    if let Some(camera) = view.space {
        let looks = procedure.held().looks(procedure.world());
        let colour = rgb(STEEL);
        let props: Vec<Prop> = looks
            .into_iter()
            .map(|shape| Prop { shape, colour })
            .collect();
        let frame = Frame {
            props: &props,
            ..Frame::new(camera, colours)
        };
        stage.draw(ui, rect, procedure.world(), &frame);
    }
    let painter = ui.painter().with_clip_rect(rect);
    draw_force(&painter, session, &view);
    view
}

/// Draws an arrow for the force of the tissue on the tool, with its magnitude.
fn draw_force(painter: &Painter, session: &Session, view: &View) {
    let sample = session.last();
    let newtons = sample.force.length();
    if newtons < WEAK {
        return;
    }
    let metres = view.space.map_or(1.0, |camera| camera.distance) * LONG;
    let tip = sample.at + sample.force * metres;
    let (from, to) = (view.to_screen(sample.at), view.to_screen(tip));
    let way = to - from;
    for (wide, colour) in [(9.0, Color32::from_white_alpha(200)), (5.0, RED)] {
        painter.line_segment([from, to], Stroke::new(wide, colour));
        if way.length() > 4.0 {
            let along = way.normalized();
            let across = vec2(-along.y, along.x);
            let wide = 1.6 * wide;
            let head = [
                to + 1.6 * wide * along,
                to + wide * across,
                to - wide * across,
            ];
            painter.add(egui::Shape::convex_polygon(
                head.to_vec(),
                colour,
                Stroke::NONE,
            ));
        }
    }
    let at = to + vec2(14.0, -18.0);
    let text = format!("{newtons:.2} N");
    let font = FontId::proportional(24.0);
    let galley = painter.layout_no_wrap(text.clone(), font.clone(), RED);
    let paper = Rect::from_min_size(at, galley.size()).expand2(vec2(8.0, 3.0));
    painter.rect_filled(paper, 10.0, Color32::from_white_alpha(215));
    painter.text(at, Align2::LEFT_TOP, text, font, RED);
}
