//! How a round looks: the camera, the face, what flies about, the colours.

mod camera;
mod effects;
mod face;
mod stage;
mod theme;

pub use camera::{Camera, View};
pub use effects::Effects;
pub use face::{Mood, draw_face};
pub use stage::{Look, Stage};
pub use theme::Theme;
