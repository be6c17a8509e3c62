//! Measures whether a level asks for more than a straight push, and whether its ways win.
//!
//! `cargo run --release -p tamaire_play --example ways -- FOLDER` reads `level.toml` and `ways.toml` in a folder. It
//! prints
//!
//! - for each way, its result without trembling and with the seeds 1 to `--shakes`,
//! - for each straight bot of `--bots` at each of `--speeds`, the number of rounds of a minute that it wins, out of
//!   `--starts`.
//!
//! `--stretch` slows the ways down and `--shift` moves them, as a person would vary them.
//! `--save FOLDER` writes a replay of each way and of the first round of each straight bot.

use clap::Parser;
use std::error::Error;
use std::fs;
use std::path::PathBuf;
use std::sync::Arc;
use std::thread;
use tamaire_play::bot::StraightPush;
use tamaire_play::{AnyRound, Level, Outcome, Ways};

/// Time limit of a round [ticks].
const MINUTE: usize = 60 * 60;

/// Measures whether a level asks for more than a straight push, and whether its ways win.
#[derive(Parser)]
struct Options {
    /// Folder of the level.
    folder: PathBuf,
    /// Number of rounds of each straight bot at each speed.
    #[arg(long, default_value_t = 4)]
    starts: u64,
    /// Straight bots to try.
    #[arg(long, value_delimiter = ',', default_values = ["line", "chase"])]
    bots: Vec<Bot>,
    /// Speeds of the straight bots [m/s].
    #[arg(long, value_delimiter = ',', default_values_t = [0.3, 0.7, 3.0])]
    speeds: Vec<f32>,
    /// Factor by which the times of the ways are multiplied.
    #[arg(long, default_value_t = 1.0)]
    stretch: f32,
    /// Distance by which the paths are moved: x,y,z [m].
    #[arg(long, value_delimiter = ',', allow_hyphen_values = true)]
    shift: Vec<f32>,
    /// Number of trembling rounds of each way.
    #[arg(long, default_value_t = 2)]
    shakes: u64,
    /// Plays only the way with this number, and prints its progress each half second.
    #[arg(long)]
    way: Option<usize>,
    /// Folder for replays.
    #[arg(long)]
    save: Option<PathBuf>,
}

/// A bot that only pushes straight.
#[derive(Copy, Clone, Debug, clap::ValueEnum)]
enum Bot {
    Line,
    Chase,
}

fn main() -> Result<(), Box<dyn Error>> {
    let options = Options::parse();
    let level = options.folder.join("level.toml");
    let level = Level::read(&level.display().to_string(), &fs::read(&level)?, &|name| {
        fs::read(options.folder.join(name))
    })?;
    let level = Arc::new(level);
    let mut ways = Ways::read(&fs::read_to_string(options.folder.join("ways.toml"))?)?;
    let paths = ways.way.iter_mut();
    let points = paths.flat_map(|way| way.path.iter_mut().chain(&mut way.second));
    for point in points {
        point[0] *= options.stretch;
        for (position, shift) in point[1..].iter_mut().zip(&options.shift) {
            *position += shift;
        }
    }
    let save = |name: String, round: &AnyRound| -> Result<(), Box<dyn Error>> {
        if let Some(folder) = &options.save {
            fs::create_dir_all(folder)?;
            fs::write(folder.join(name), round.replay().text())?;
        }
        Ok(())
    };
    for (index, way) in ways.way.iter().enumerate() {
        let number = index + 1;
        match options.way {
            Some(chosen) if chosen != number => continue,
            Some(_) => watch(&level, way),
            None => {}
        }
        for shake in 0..=options.shakes {
            let mut round = AnyRound::new(level.clone());
            let outcome = way.play(&mut round, (shake > 0).then_some(shake));
            println!(
                "way {number}, shake {shake}: {}",
                told(&level, &round, outcome)
            );
            if shake == 0 {
                save(format!("way-{number}.tamaire"), &round)?;
            }
        }
    }
    if options.way.is_none() {
        straight(&level, &options, save)?;
    }
    Ok(())
}

/// Prints the progress of a way each half second.
fn watch(level: &Arc<Level>, way: &tamaire_play::Way) {
    let mut round = AnyRound::new(level.clone());
    for tick in 0..((way.seconds() + 4.0) * 60.0) as u64 {
        round.step(way.frame(tick));
        if tick % 30 == 29 {
            let progress = round.progress();
            let hands = round.hands();
            println!(
                "{:5.1} s: hand {:.2?}, in {:.2} (rests {:.2}, touched {}), kept {:.2}, {} pieces",
                (tick + 1) as f32 / 60.0,
                hands[0].position.to_array(),
                progress.within,
                progress.inside,
                progress.touched,
                progress.kept,
                progress.pieces
            );
        }
    }
}

fn told(level: &Level, round: &AnyRound, outcome: Option<Outcome>) -> String {
    let progress = round.progress();
    match outcome {
        None => format!(
            "lost, in {:.2} (rests {:.2}), kept {:.2}, {} pieces",
            progress.within, progress.inside, progress.kept, progress.pieces
        ),
        Some(won) => {
            let wishes = won.wishes(level.game());
            format!(
                "won after {:.1} s, {:?}, kept {:.2}, in {:.2}, {} pieces, {} lost, wishes {wishes:?}",
                won.seconds(),
                won.route,
                won.kept,
                won.inside,
                won.pieces,
                won.lost
            )
        }
    }
}

type Save<'a> = dyn Fn(String, &AnyRound) -> Result<(), Box<dyn Error>> + 'a;

fn straight(
    level: &Arc<Level>,
    options: &Options,
    save: impl Fn(String, &AnyRound) -> Result<(), Box<dyn Error>>,
) -> Result<(), Box<dyn Error>> {
    let save: &Save = &save;
    let starts = options.starts;
    for bot in &options.bots {
        let name = format!("{bot:?}").to_lowercase();
        for &speed in &options.speeds {
            let play = |seed: u64| {
                let mut round = AnyRound::new(level.clone());
                let mut bot = StraightPush::new(matches!(bot, Bot::Chase), speed, seed);
                round.push_straight(&mut bot, MINUTE);
                round
            };
            let rounds = thread::scope(|scope| {
                let half = |first: u64| {
                    let play = &play;
                    scope.spawn(move || (first..starts).step_by(2).map(play).collect::<Vec<_>>())
                };
                let halves = [half(0), half(1)];
                halves.map(|half| half.join().expect("a round panicked"))
            });
            let rounds: Vec<_> = rounds.into_iter().flatten().collect();
            let won = rounds
                .iter()
                .filter(|round| round.progress().outcome.is_some());
            println!("{name} at {speed} m/s: won {} of {starts}", won.count());
            if let Some(round) = rounds.first() {
                save(format!("{name}-{speed}.tamaire"), round)?;
            }
        }
    }
    Ok(())
}
