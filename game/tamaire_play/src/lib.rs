//! The game without a window: push a soft body into a basket that is smaller than the body.
//!
//! The modules, each of which uses only those above it:
//!
//! - [`input`]: input of the players in a tick
//! - [`level`]: levels and their checks
//! - [`assists`]: easier variants of levels
//! - [`rules`]: conditions and routes of a win
//! - [`round`]: a round of a level
//! - [`playground`]: what players change in a level without a basket
//! - [`any`]: a round with its dimension chosen at run time
//! - [`replay`]: recorded rounds
//! - [`link`]: rounds and levels as links
//! - [`bot`]: players that are programs
//! - [`rewind`]: time that runs back in a round
//! - [`way`]: ways to win a level
//! - [`daily`]: the level of the day
//! - [`pack`]: many levels in one archive or folder
//!
//! A window, a bot and a replay play in the same way: they pass one [`InputFrame`] per tick to
//! [`Round::step`] and read the resulting state. A 2D round is a `Round<Dim2>`, a 3D round a `Round<Dim3>`;
//! [`AnyRound`] has the dimension of its level:
//!
//! ```
//! use fuwafuwa::Vec3;
//! use std::sync::Arc;
//! use tamaire_play::{AnyRound, Bot, BotKind, InputFrame, Level};
//!
//! let level = Arc::new(Level::open("hoop")?);
//! assert_eq!(level.scene().dim, 3);
//! let mut round = AnyRound::new(level);
//! // x to the right, y up, z towards the player [m].
//! round.step(InputFrame::towards(Vec3::new(-1.0, 1.2, 0.0)));
//! let mut bot = Bot::new(BotKind::Squeeze, 1);
//! for _ in 0..5 {
//!     let frame = round.ask(&mut bot);
//!     let report = round.step(frame);
//!     assert_eq!(report.quarantined, 0);
//! }
//! assert_eq!((round.ticks(), round.progress().pieces), (6, 1));
//! # Ok::<(), tamaire_play::level::LevelError>(())
//! ```
#![forbid(unsafe_code)]
#![warn(missing_docs)]
#![allow(rustdoc::broken_intra_doc_links)] // units in brackets, such as [m], are no links
#![allow(clippy::needless_range_loop)] // an axis indexes several vectors at once

pub mod any;
pub mod assists;
pub mod bot;
pub mod daily;
pub mod input;
pub mod level;
pub mod link;
pub mod pack;
pub mod playground;
pub mod replay;
pub mod rewind;
pub mod round;
pub mod rules;
pub mod way;

pub use any::AnyRound;
pub use bot::{Bot, BotKind};
pub use fuwafuwa_scenes::scene::{
    AssistText as Assist, JointsText as Joints, LocalizedText, RouteText as Route,
    WishText as Wish, shortened,
};
pub use input::{InputFrame, PLAYERS};
pub use level::Level;
pub use link::{Link, LinkError};
pub use pack::Pack;
pub use replay::{Playback, Replay, ReplayError};
pub use rewind::Rewind;
pub use round::{Hand, Round};
pub use rules::{Basket, Outcome, Progress, WishState};
pub use way::{Way, Ways};
