//! The game in an offscreen window, drawn by a software adapter (Mesa's llvmpipe): input, texts, appearance,
//! and robustness.

mod back;
mod clicks;
mod contrast;
mod editing;
mod fingers;
mod finish;
mod help;
mod hostile;
mod kept;
mod legible;
mod links;
mod making;
mod models;
mod own;
mod packs;
mod pads;
mod pictures;
mod rewind;
mod shelf;
mod space;
mod stand;
mod ties;
mod told;
mod toys;
mod window;
