//! The subcommand `tamaire report`, which summarizes the logbooks of stands.

use crate::headless::{self, BAD_USAGE};
use crate::platform::{Kind, Pictures};
use clap::Args;
use clap::builder::PossibleValuesParser;
use indicatif::{ProgressBar, ProgressStyle};
use pollster::block_on;
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::Arc;
use tamaire_play::Replay;
use tamaire_report::{Day, Language, Progress, Stage, report};

/// Arguments of `tamaire report`.
#[derive(Args)]
pub(super) struct Options {
    /// Logbooks of stands (visits.sqlite)
    #[arg(required = true)]
    files: Vec<PathBuf>,
    /// Output folder for the report
    #[arg(long, value_name = "FOLDER", default_value = "report")]
    out: PathBuf,
    /// Language of the report
    #[arg(long, default_value = "en", value_parser = PossibleValuesParser::new(Language::NAMED.map(|(name, _)| name)))]
    language: String,
    /// First day to count, for example 2026-11-23
    #[arg(long, value_name = "DAY")]
    from: Option<Day>,
    /// Last day to count
    #[arg(long, value_name = "DAY")]
    to: Option<Day>,
    /// Simulate all rounds again: rounds with a different result are listed and not counted, and the paths of
    /// the hands are drawn. Results are cached for the next run
    #[arg(long)]
    rerun: bool,
    /// Also write all rows as tables (.csv)
    #[arg(long)]
    csv: bool,
    /// Also write all figures as JSON
    #[arg(long)]
    json: bool,
    /// Leave out the clips of the day's best rounds
    #[arg(long)]
    no_clips: bool,
}

impl Options {
    /// Whether the report has clips, for which pictures are drawn.
    pub(super) fn makes_clips(&self) -> bool {
        !self.no_clips
    }
}

/// Writes a report and prints its path.
pub(super) fn write(options: &Options) -> ExitCode {
    let mut languages = Language::NAMED.into_iter();
    let language = languages.find(|(name, _)| *name == options.language);
    let asked = tamaire_report::Options {
        language: language.map(|(_, language)| language).unwrap_or_default(),
        csv: options.csv,
        json: options.json,
        from: options.from,
        to: options.to,
        rerun: options.rerun,
    };
    let pictures = Pictures::default();
    let clip =
        |replay: &Replay| block_on(pictures.shoot(Kind::Clip, Arc::new(replay.clone()), |_| ()));
    let clip: Option<tamaire_report::Clip<'_>> = match options.no_clips {
        true => None,
        false => Some(&clip),
    };
    let mut bar = Bar::default();
    let written = report(
        &options.files,
        &options.out,
        &asked,
        clip,
        &mut |progress| bar.show(progress),
    );
    bar.finish();
    match written {
        Ok(report) => {
            let refused = match report.figures.basis.refused.len() {
                0 => String::new(),
                refused => format!(", {refused} not counted"),
            };
            let (visits, rounds) = (report.figures.total.visits, report.figures.total.rounds.all);
            headless::print(&format!(
                "{}: {visits} visits, {rounds} rounds{refused}\n",
                report.page.display()
            ))
        }
        Err(error) => {
            output::warn(format_args!("tamaire: {error}"));
            ExitCode::from(BAD_USAGE)
        }
    }
}

/// Progress bar of the current stage.
#[derive(Default)]
struct Bar(Option<(Stage, ProgressBar)>);

impl Bar {
    fn show(&mut self, progress: Progress) {
        let Progress { stage, done, all } = progress;
        if self.0.as_ref().is_none_or(|(known, _)| *known != stage) {
            self.finish();
            self.0 = Some((stage, bar(stage)));
        }
        if let Some((_, bar)) = &self.0 {
            if let Some(all) = all {
                bar.set_length(all);
            }
            bar.set_position(done);
        }
    }

    fn finish(&mut self) {
        if let Some((_, bar)) = self.0.take() {
            bar.finish_and_clear();
        }
    }
}

fn bar(stage: Stage) -> ProgressBar {
    let name = match stage {
        Stage::Visits => "reading visits",
        Stage::Rerun => "simulating rounds",
        Stage::Rounds => "counting rounds",
        Stage::Clips => "drawing clips",
    };
    let bar = ProgressBar::no_length().with_message(name);
    let style = ProgressStyle::with_template("{msg:22} {wide_bar} {human_pos}/{human_len} {eta}");
    bar.with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
}
