//! The way in for who wants to know what visitors did: `tamaire report`.

use crate::headless::BAD_USAGE;
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

/// What is asked for.
#[derive(Args)]
pub(super) struct Options {
    /// Logbooks of stands (visits.sqlite)
    #[arg(required = true)]
    files: Vec<PathBuf>,
    /// The folder that the page is written into
    #[arg(long, value_name = "FOLDER", default_value = "report")]
    out: PathBuf,
    /// The language of the page
    #[arg(long, default_value = "en", value_parser = PossibleValuesParser::new(Language::NAMED.map(|(name, _)| name)))]
    language: String,
    /// The first day that counts, as 2026-11-23
    #[arg(long, value_name = "DAY")]
    from: Option<Day>,
    /// The last day that counts
    #[arg(long, value_name = "DAY")]
    to: Option<Day>,
    /// Run all rounds again: what does not come out as it was written is listed and not counted, and where hands moved is
    /// drawn. What is done is kept for a next time
    #[arg(long)]
    rerun: bool,
    /// Write all rows as tables (.csv), too
    #[arg(long)]
    csv: bool,
    /// Write all figures as JSON, too
    #[arg(long)]
    json: bool,
    /// Draw no clips of the day's best
    #[arg(long)]
    no_clips: bool,
}

/// Writes a report, and tells where it is.
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
            println!(
                "{}: {visits} visits, {rounds} rounds{refused}",
                report.page.display()
            );
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("tamaire: {error}");
            ExitCode::from(BAD_USAGE)
        }
    }
}

/// A bar for what is done just now.
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
        Stage::Rerun => "running rounds again",
        Stage::Rounds => "counting rounds",
        Stage::Clips => "drawing clips",
    };
    let bar = ProgressBar::no_length().with_message(name);
    let style = ProgressStyle::with_template("{msg:22} {wide_bar} {human_pos}/{human_len} {eta}");
    bar.with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
}
