//! The desktop's entry to the game.

use clap::Parser;
use std::path::PathBuf;
use std::process::ExitCode;
use tamaire::app::App;
use tamaire::game::Game;
use tamaire::platform::{Files, Pads, Sound};

/// Push a soft body into a basket that is too small for it.
#[derive(Parser)]
#[command(version)]
struct Arguments {
    /// A level (.toml), a picture to make a body of (.png) or a replay (.tamaire)
    file: Option<PathBuf>,
    /// No sound
    #[arg(long)]
    mute: bool,
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let options = eframe::NativeOptions {
        viewport: egui::ViewportBuilder::default()
            .with_title("玉入れ tamaire")
            .with_inner_size([1280.0, 800.0])
            .with_min_inner_size([640.0, 400.0]),
        ..Default::default()
    };
    let opened = eframe::run_native(
        "tamaire",
        options,
        Box::new(move |context| {
            let sound = if arguments.mute {
                Sound::none()
            } else {
                Sound::open()
            };
            let mut game = Game::new(Files::usual(), sound, Pads::open());
            if let Some(file) = &arguments.file {
                game.open(file);
            }
            Ok(Box::new(App::new(context, game)?))
        }),
    );
    match opened {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("tamaire: {error}");
            ExitCode::FAILURE
        }
    }
}
