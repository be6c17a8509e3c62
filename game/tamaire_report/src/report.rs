//! All steps from logbooks to a finished report.

use crate::check::{contradiction, run_all};
use crate::clips::Clips;
use crate::drafts::Drafts;
use crate::figures::{Figures, Reason, Refused};
use crate::heat::Heats;
use crate::kept::RerunCache;
use crate::page::page;
use crate::rerun::Rerun;
use crate::room::Stroke;
use crate::tables::Tables;
use crate::tally::Tally;
use crate::visits::Visits;
use crate::{Clip, Error, Language, Options, Progress, Stage, words};
use std::collections::HashSet;
use std::path::{Path, PathBuf};
use tamaire_logbook::{Id, Logbook, Round};

/// Number of rows between two calls of the progress function.
const OFTEN: u64 = 1000;

/// A finished report.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// Path of the page, to be opened in a browser.
    pub page: PathBuf,
    /// All files that were written, including the page.
    pub files: Vec<PathBuf>,
    /// Figures of the report.
    pub figures: Figures,
}

/// Writes a report on logbooks into the folder `out`, which is created if it does not exist: `index.html`,
/// and the files chosen by the options. A row that occurs in several logbooks counts once. With `clip`, the
/// page shows the best rounds of the last day as animated GIFs.
///
/// # Errors
/// [`Error`]; then the files in the folder are unchanged, except for `reruns.jsonl`, from which the next
/// report continues.
pub fn report(
    files: &[PathBuf],
    out: &Path,
    options: &Options,
    clip: Option<Clip<'_>>,
    progress: &mut dyn FnMut(Progress),
) -> Result<Report, Error> {
    check(options)?;
    let books = open(files)?;
    let mut drafts = Drafts::new(out)?;
    let mut visits = read_visits(&books, options, progress)?;
    let mut kept = None;
    if options.rerun {
        let kept = kept.insert(RerunCache::open(&out.join("reruns.jsonl"))?);
        run_again(&books, &mut visits, kept, progress)?;
    }
    let tables = options.csv.then(|| Tables::begin(&drafts)).transpose()?;
    let mut count = Count {
        tally: Tally::new(),
        kept,
        tables,
        heats: Heats::default(),
        refused: Vec::new(),
        ran: [0; 2],
        keeps_replays: clip.is_some(),
    };
    let repeated = count.rounds(&books, &mut visits, progress)?;
    let repeated_events = count.events(&books, &visits)?;
    let Count {
        tally,
        mut tables,
        mut heats,
        refused,
        ran: [rerun, not_rerun],
        ..
    } = count;
    let told = |note: &_, story: &_| match &mut tables {
        Some(tables) => tables.visit(&visits, note, story),
        None => Ok(()),
    };
    let (mut figures, replays) = tally.finish(&visits, told)?;
    (figures.from, figures.to) = (options.from, options.to);
    let basis = &mut figures.basis;
    basis.files = books.len() as u64;
    basis.repeated_rows = visits.repeated + repeated + repeated_events;
    basis.is_rerun = options.rerun;
    (basis.rerun, basis.not_rerun, basis.refused) = (rerun, not_rerun, refused);
    let strokes = draw(&mut figures, &mut heats);
    let clips = clip.map(|clip| {
        let done = |done| progress(Progress::of(Stage::Clips, done));
        Clips::of(&figures, &replays, clip, done)
    });
    let words = match options.language {
        Language::English => &words::ENGLISH,
        Language::Japanese => &words::JAPANESE,
    };
    let text = page(words, &figures, &strokes, &clips.unwrap_or_default());
    write(&mut drafts, "index.html", text.as_bytes())?;
    if options.json {
        let text = serde_json::to_vec_pretty(&figures).expect("figures can be serialized");
        write(&mut drafts, "report.json", &text)?;
    }
    if let Some(tables) = tables {
        tables.finish(&mut drafts)?;
    }
    Ok(Report {
        page: out.join("index.html"),
        files: drafts.keep()?,
        figures,
    })
}

/// State while rounds and events are counted.
struct Count {
    tally: Tally,
    kept: Option<RerunCache>,
    tables: Option<Tables>,
    heats: Heats,
    refused: Vec<Refused>,
    /// Number of rounds that gave the recorded result, and number of rounds that were not run again.
    ran: [u64; 2],
    keeps_replays: bool,
}

impl Count {
    /// Counts each round once. Returns the number of repeated rows.
    fn rounds(
        &mut self,
        books: &[Logbook],
        visits: &mut Visits,
        progress: &mut dyn FnMut(Progress),
    ) -> Result<u64, Error> {
        let mut done = 0;
        let repeated = each_round(books, |round| {
            done += 1;
            if done % OFTEN == 0 {
                progress(Progress::of(Stage::Rounds, done));
            }
            match visits.of(&round) {
                Some(place) => self.round(&round, place, visits),
                None => Ok(()),
            }
        })?;
        progress(Progress::of(Stage::Rounds, done));
        Ok(repeated)
    }

    fn round(&mut self, round: &Round, place: u32, visits: &Visits) -> Result<(), Error> {
        let rerun = match &mut self.kept {
            Some(kept) => kept.get(round)?,
            None => None,
        };
        let objection = rerun.as_ref().and_then(|rerun| rerun.objection(round));
        if let Some((reason, detail)) = contradiction(round).or(objection) {
            self.refuse(round, reason, detail);
            return Ok(());
        }
        match rerun {
            Some(Rerun::Ran(ran)) => {
                self.ran[0] += 1;
                self.heats.add(round, &ran);
            }
            _ => self.ran[1] += 1,
        }
        let note = &visits.notes[place as usize];
        self.tally.round(round, (place, note), self.keeps_replays);
        match &mut self.tables {
            Some(tables) => tables.round(round),
            None => Ok(()),
        }
    }

    fn refuse(&mut self, round: &Round, reason: Reason, detail: String) {
        self.refused.push(Refused {
            round: round.id,
            stand: round.stand.clone(),
            reason,
            detail,
        });
    }

    /// Counts each event once. Returns the number of repeated rows.
    fn events(&mut self, books: &[Logbook], visits: &Visits) -> Result<u64, Error> {
        let mut known = HashSet::new();
        let mut repeated = 0;
        for book in books {
            book.events::<Error>(.., |event| {
                if !known.insert(event.id) {
                    repeated += 1;
                    return Ok(());
                }
                if !visits.is_selected(event.at) {
                    return Ok(());
                }
                self.tally.event(&event);
                match &mut self.tables {
                    Some(tables) => tables.event(&event),
                    None => Ok(()),
                }
            })?;
        }
        Ok(repeated)
    }
}

fn check(options: &Options) -> Result<(), Error> {
    match (options.from, options.to) {
        (Some(from), Some(to)) if from > to => Err(Error::Days { from, to }),
        _ => Ok(()),
    }
}

fn open(files: &[PathBuf]) -> Result<Vec<Logbook>, Error> {
    if files.is_empty() {
        return Err(Error::NoFiles);
    }
    let open = |file: &PathBuf| match file.try_exists() {
        Ok(false) => Err(Error::Missing(file.clone())),
        // An error means that the file cannot be accessed, which the logbook reports with the reason.
        _ => Ok(Logbook::read(file)?),
    };
    files.iter().map(open).collect()
}

fn read_visits(
    books: &[Logbook],
    options: &Options,
    progress: &mut dyn FnMut(Progress),
) -> Result<Visits, Error> {
    let mut visits = Visits::new(options);
    let mut done = 0;
    for book in books {
        book.visits::<Error>(.., |visit| {
            visits.add(&visit);
            done += 1;
            if done % OFTEN == 0 {
                progress(Progress::of(Stage::Visits, done));
            }
            Ok(())
        })?;
    }
    progress(Progress::of(Stage::Visits, done));
    Ok(visits)
}

fn run_again(
    books: &[Logbook],
    visits: &mut Visits,
    kept: &mut RerunCache,
    progress: &mut dyn FnMut(Progress),
) -> Result<(), Error> {
    let mut all = 0;
    each_round(books, |round| {
        all += u64::from(visits.of(&round).is_some());
        Ok(())
    })?;
    let done = |done| {
        progress(Progress {
            all: Some(all),
            ..Progress::of(Stage::Rerun, done)
        });
    };
    run_all(kept, done, |run| {
        let asked = |round: Round| match visits.of(&round) {
            Some(_) => run(round),
            None => Ok(()),
        };
        each_round(books, asked).map(|_| ())
    })
}

/// Calls `each` once for every round of the logbooks. Returns the number of repeated rows.
fn each_round(
    books: &[Logbook],
    mut each: impl FnMut(Round) -> Result<(), Error>,
) -> Result<u64, Error> {
    let mut known: HashSet<Id> = HashSet::new();
    let mut repeated = 0;
    for book in books {
        book.rounds::<Error>(.., |round| match known.insert(round.id) {
            true => each(round),
            false => {
                repeated += 1;
                Ok(())
            }
        })?;
    }
    Ok(repeated)
}

/// Moves the maps of hand positions to the figures of their levels. Returns the objects in the room of each
/// level.
fn draw(figures: &mut Figures, heats: &mut Heats) -> Vec<Vec<Stroke>> {
    let levels = figures.levels.iter_mut();
    let drawn = levels.map(|level| match heats.take(&level.level, &level.level_hash) {
        Some((heat, strokes)) => {
            level.hands = Some(heat);
            strokes
        }
        None => Vec::new(),
    });
    drawn.collect()
}

fn write(drafts: &mut Drafts, name: &str, bytes: &[u8]) -> Result<(), Error> {
    let mut draft = drafts.begin(name)?;
    draft.write(bytes)?;
    drafts.add(draft)
}
