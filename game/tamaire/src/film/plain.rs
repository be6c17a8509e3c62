//! Pictures of a round without a GPU: draws the elements of its bodies, as the engine's command line does.

use fuwafuwa::Vec3;
use fuwafuwa_painter::solid::{Camera, Scene3d};
use fuwafuwa_painter::{PaintError, Painter, PaperTransform, Pixmap, worlds};
use tamaire_play::AnyRound;

/// Draws a picture of the current state of a round. The given width and height [px] exclude the caption.
pub fn picture(
    round: &AnyRound,
    [width, height]: [u32; 2],
    caption: Option<&str>,
) -> Result<Pixmap, PaintError> {
    let mut painter = Painter::new(width, height);
    let [low, high] = round.level().arena();
    let middle = (low + high) * 0.5;
    let room = high - low;
    match round {
        AnyRound::Plane(round) => {
            let size = [width, height].map(|side| side as f32);
            let unit = (size[0] / room.x).min(size[1] / room.y);
            let origin = [
                0.5 * size[0] - unit * middle.x,
                0.5 * size[1] + unit * middle.y,
            ];
            let frame = PaperTransform { origin, unit };
            worlds::plane(&mut painter, frame, round.world(), worlds::plane_elements);
        }
        AnyRound::Space(round) => {
            let mut solid = Scene3d::new(Camera {
                eye: middle + Vec3::new(0.0, 1.1, 1.5) * room.x,
                target: middle,
                across: 1.1 * room.x,
            });
            worlds::space(&mut solid, round.world(), |solid, body| {
                worlds::space_elements(solid, body, |_| true);
            });
            painter.image([0.0; 2], solid.pixels(width, height)?);
        }
    }
    if let Some(caption) = caption {
        painter.caption(caption);
    }
    painter.pixels()
}
