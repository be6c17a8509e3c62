//! Pictures of a round without a GPU: draws the elements of its bodies, as the engine's command line does.

use fuwafuwa::inspect::vector::{plus, scaled};
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
    let middle = [0, 1, 2].map(|axis| 0.5 * (low[axis] + high[axis]));
    let [across, up] = [0, 1].map(|axis| high[axis] - low[axis]);
    match round {
        AnyRound::Plane(round) => {
            let size = [width, height].map(|side| side as f32);
            let unit = (size[0] / across).min(size[1] / up);
            let origin = [
                0.5 * size[0] - unit * middle[0],
                0.5 * size[1] + unit * middle[1],
            ];
            let frame = PaperTransform { origin, unit };
            worlds::plane(&mut painter, frame, round.world(), worlds::plane_elements);
        }
        AnyRound::Space(round) => {
            let mut solid = Scene3d::new(Camera {
                eye: plus(middle, scaled([0.0, 1.1, 1.5], across)),
                target: middle,
                across: 1.1 * across,
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
