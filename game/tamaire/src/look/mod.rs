//! Appearance of a round: drawn faces of the bodies, effects, and thumbnails of levels.

mod confetti;
mod draw_options;
mod effects;
mod face;
mod face_anchor;
mod feelings;
mod glow;
mod hint;
mod maps;
mod opening;
mod rest_frame;
mod room_parts;
mod ropes;
mod stage;

pub use confetti::Confetti;
pub(crate) use draw_options::view_of_level;
pub use draw_options::{DrawOptions, Hint};
pub use effects::Effects;
pub use face::{Face, Mood};
pub use feelings::Feeling;
pub use maps::Maps;
pub use opening::Cutaway;
pub use stage::Stage;
