//! Appearance of a round: camera, faces, effects, colours, fonts, and thumbnails of levels.

mod calm;
mod camera;
mod confetti;
mod dress;
mod effects;
mod face;
mod feelings;
mod glow;
mod hint;
mod maps;
mod opening;
mod pass;
mod perch;
mod showing;
mod space_stage;
mod stage;
mod theme;

pub use camera::{CameraRig, View};
pub use confetti::Confetti;
pub use dress::{add_letters, dress};
pub use effects::Effects;
pub use face::{Face, Mood};
pub use feelings::Feeling;
pub use maps::Maps;
pub use opening::Cutaway;
pub use showing::{DrawOptions, Hint};
pub use space_stage::SpaceStage;
pub use stage::Stage;
pub use theme::Theme;
