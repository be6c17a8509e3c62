//! The game in a window that nobody sees, drawn by software (Mesa's llvmpipe): what can be clicked,
//! pressed and read, how it looks, and what it puts up with.

mod clicks;
mod fingers;
mod help;
mod hostile;
mod kept;
mod links;
mod models;
mod own;
mod pads;
mod pictures;
mod shelf;
mod space;
mod stand;
mod told;
mod window;
