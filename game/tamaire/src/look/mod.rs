//! Appearance of a round: faces, effects, and thumbnails of levels.

mod calm;
mod confetti;
mod effects;
mod face;
mod feelings;
mod glow;
mod hint;
mod maps;
mod opening;
mod perch;
mod showing;
mod stage;

pub use confetti::Confetti;
pub use effects::Effects;
pub use face::{Face, Mood};
pub use feelings::Feeling;
pub use maps::Maps;
pub use opening::Cutaway;
pub(crate) use showing::view_of_level;
pub use showing::{DrawOptions, Hint};
pub use stage::Stage;
